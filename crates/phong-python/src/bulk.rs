//! Spheres, triangles and cylinders in bulk, of arrays.

use glam::{DVec3, Vec3};
use phong_scene::{Caps, Cylinders, Field, Mesh, Points, Rgb, Shared};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{self, Column, Numbers, RADIUS, coordinates, directions, is_radius, points};
use crate::errors::value_error;

/// A sphere at every centre.
pub(crate) fn spheres(
    centers: &Bound<'_, PyAny>,
    radii: &Bound<'_, PyAny>,
    colors: Option<&Bound<'_, PyAny>>,
    fields: Option<&Bound<'_, PyDict>>,
) -> PyResult<Points> {
    let (origin, spheres) = balls(centers, radii)?;
    let colors = sphere_colors(colors, spheres.len())?;
    let fields = self::fields(fields, spheres.len(), 1)?;
    Ok(Points { origin, spheres: spheres.into(), colors, fields, guessed: None })
}

/// The same spheres elsewhere, or of other sizes or colours; what is not given stays.
pub(crate) fn moved(
    old: Points,
    centers: Option<&Bound<'_, PyAny>>,
    radii: Option<&Bound<'_, PyAny>>,
    colors: Option<&Bound<'_, PyAny>>,
    fields: Option<&Bound<'_, PyDict>>,
) -> PyResult<Points> {
    let (origin, spheres) = match (centers, radii) {
        (None, None) => (old.origin, old.spheres),
        (None, Some(radii)) => {
            let radii = Numbers::of("radii", radii)?;
            let mut spheres = old.spheres.to_vec();
            fill_radii(&radii.column(spheres.len())?, &mut spheres)?;
            (old.origin, spheres.into())
        }
        (Some(centers), Some(radii)) => {
            let (origin, spheres) = balls(centers, radii)?;
            (origin, spheres.into())
        }
        (Some(centers), None) => {
            let (origin, mut moved) = sphere_centers(centers)?;
            let first = old.spheres.first().map_or(1.0, |sphere| sphere[3]);
            let alike = old.spheres.iter().all(|sphere| sphere[3] == first);
            if moved.len() != old.spheres.len() && !alike {
                return Err(value_error(format!(
                    "radii must be given: there are {} centers now, and were {} of different radii",
                    moved.len(),
                    old.spheres.len()
                )));
            }
            for (index, sphere) in moved.iter_mut().enumerate() {
                sphere[3] = old.spheres.get(index).map_or(first, |old| old[3]);
            }
            (origin, moved.into())
        }
    };
    let colors = match colors {
        Some(_) => sphere_colors(colors, spheres.len())?,
        None if old.colors.is_empty() || old.colors.len() == spheres.len() => old.colors,
        None => {
            return Err(value_error(format!(
                "colors must be given: there are {} spheres now, and {} have colors",
                spheres.len(),
                old.colors.len()
            )));
        }
    };
    let fields = match fields {
        Some(_) => self::fields(fields, spheres.len(), 1)?,
        None => match old.fields.iter().find(|field| field.values.len() != spheres.len()) {
            None => old.fields,
            Some(Field { name, values }) => {
                return Err(value_error(format!(
                    "fields must be given: there are {} spheres now, and {name:?} is of {}",
                    spheres.len(),
                    values.len()
                )));
            }
        },
    };
    Ok(Points { origin, spheres, colors, fields, guessed: None })
}

/// Numbers of `count` things, of which each has so many points; what is not finite is unknown.
fn fields(fields: Option<&Bound<'_, PyDict>>, count: usize, points: usize) -> PyResult<Vec<Field>> {
    let Some(fields) = fields else { return Ok(Vec::new()) };
    let mut all = Vec::with_capacity(fields.len());
    for (name, numbers) in fields {
        let name: String = name.extract()?;
        if name.is_empty() {
            return Err(value_error("fields: a name is empty"));
        }
        if !Field::is_name(&name) {
            let message = format!(
                "fields: {name:?} is no name for numbers of points: it must be one word without blanks, \
                 and not that of a place, normal, colour or radius"
            );
            return Err(value_error(&message));
        }
        let named = |error: PyErr| {
            let message = format!("fields[{name:?}]: {}", error.value(fields.py()));
            value_error(message)
        };
        let numbers = Numbers::of("fields", &numbers).map_err(named)?;
        let values: Vec<f32> = if points > 1 && numbers.shape() == [count, points] {
            numbers.flat()?.into_iter().map(|v| v as f32).collect()
        } else {
            let mut values = vec![0.0; count * points];
            let column = numbers.column(count).map_err(named)?;
            let put = |i: usize, v: f32| values[i * points..(i + 1) * points].fill(v);
            column.fill(count, |_| true, "a number", put)?;
            values
        };
        all.push(Field { name: name.into(), values: values.into() });
    }
    Ok(all)
}

/// Triangles.
pub(crate) fn mesh(
    vertices: &Bound<'_, PyAny>,
    faces: &Bound<'_, PyAny>,
    normals: Option<&Bound<'_, PyAny>>,
    uv: Option<&Bound<'_, PyAny>>,
    colors: Option<&Bound<'_, PyAny>>,
    smooth: Option<&Bound<'_, PyAny>>,
    fields: Option<&Bound<'_, PyDict>>,
) -> PyResult<Mesh> {
    let crease = crease(smooth)?;
    let (origin, positions) = points(&[&Numbers::of("vertices", vertices)?], "one vertex a row")?;
    let positions = positions.into_iter().next().unwrap_or_default();
    let count = positions.len();
    if count == 0 {
        return Err(value_error("vertices is empty: there is nothing to draw"));
    }
    let indices = arrays::faces(&Numbers::of("faces", faces)?, count)?;
    if indices.is_empty() {
        return Err(value_error("faces is empty: there is nothing to draw"));
    }
    let of_vertices = |name: &str, len: usize| {
        if len == count {
            return Ok(());
        }
        Err(value_error(format!("{name} has {len} rows, and there are {count} vertices")))
    };
    let normals = match normals {
        None => Shared::default(),
        Some(normals) => {
            let normals = directions(&Numbers::of("normals", normals)?, "one for each vertex")?;
            of_vertices("normals", normals.len())?;
            normals.into()
        }
    };
    let uvs = match uv {
        None => Shared::default(),
        Some(uv) => {
            let uvs = coordinates(&Numbers::of("uv", uv)?, "one pair for each vertex")?;
            of_vertices("uv", uvs.len())?;
            uvs.into()
        }
    };
    let colors = match colors {
        None => Shared::default(),
        Some(colors) => arrays::colors("colors", colors, count, "one for each vertex")?.into(),
    };
    let mut mesh = Mesh {
        origin,
        positions: positions.into(),
        indices: indices.into(),
        normals,
        uvs,
        colors,
        fields: self::fields(fields, count, 1)?,
        ..Mesh::default()
    };
    if let (true, Some(degrees)) = (mesh.normals.is_empty(), crease) {
        mesh.smooth(degrees);
    }
    Ok(mesh)
}

/// A cylinder from every start to every end.
pub(crate) fn cylinders(
    starts: &Bound<'_, PyAny>,
    ends: &Bound<'_, PyAny>,
    radii: &Bound<'_, PyAny>,
    colors: Option<&Bound<'_, PyAny>>,
    caps: &str,
    fields: Option<&Bound<'_, PyDict>>,
) -> PyResult<Cylinders> {
    let caps = caps_of(caps)?;
    let (starts, ends) = (Numbers::of("starts", starts)?, Numbers::of("ends", ends)?);
    let (origin, mut both) = points(&[&starts, &ends], "one point a row")?;
    let (ends, starts) = (both.pop().unwrap_or_default(), both.pop().unwrap_or_default());
    let count = starts.len();
    if ends.len() != count {
        let (ends, starts) = (ends.len(), count);
        return Err(value_error(format!("ends has {ends} rows, and starts has {starts}")));
    }
    if count == 0 {
        return Err(value_error("starts is empty: there is nothing to draw"));
    }
    let mut segments: Vec<[[f32; 4]; 2]> = starts
        .iter()
        .zip(&ends)
        .map(|(a, b)| [a.extend(0.0).into(), b.extend(0.0).into()])
        .collect();
    if caps != Caps::Round
        && let Some(index) =
            starts.iter().zip(&ends).position(|(a, b)| (*b - *a).try_normalize().is_none())
    {
        return Err(value_error(format!(
            "ends[{index}] is where starts[{index}] is: without length only caps = \"round\" can be seen"
        )));
    }
    let radii = Numbers::of("radii", radii)?;
    if radii.shape() == [count, 2] {
        let wanted = |pair: [f64; 2]| {
            let right = pair.iter().all(|&r| is_radius(r));
            right.then(|| pair.map(|r| r as f32)).ok_or(RADIUS)
        };
        for (segment, pair) in segments.iter_mut().zip(radii.map_rows(wanted)?) {
            (segment[0][3], segment[1][3]) = (pair[0], pair[1]);
        }
    } else {
        let put = |index: usize, radius: f32| {
            segments[index].iter_mut().for_each(|end| end[3] = radius);
        };
        radii.column(count)?.fill(count, is_radius, RADIUS, put)?;
    }
    let colors = match colors {
        None => Shared::default(),
        Some(colors) => cylinder_colors(colors, count)?,
    };
    let fields = self::fields(fields, count, 2)?;
    Ok(Cylinders { origin, segments: segments.into(), colors, caps, guessed: None, fields })
}

/// Centres, with no radius yet.
fn sphere_centers(centers: &Bound<'_, PyAny>) -> PyResult<(DVec3, Vec<[f32; 4]>)> {
    let numbers = Numbers::of("centers", centers)?;
    let (origin, rows) = points(&[&numbers], "one centre a row")?;
    let spheres: Vec<[f32; 4]> =
        rows.into_iter().flatten().map(|v: Vec3| v.extend(0.0).into()).collect();
    if spheres.is_empty() {
        return Err(value_error("centers is empty: there is nothing to draw"));
    }
    Ok((origin, spheres))
}

fn fill_radii(radii: &Column<'_, '_>, spheres: &mut [[f32; 4]]) -> PyResult<()> {
    let count = spheres.len();
    radii.fill(count, is_radius, RADIUS, |index, radius| spheres[index][3] = radius)
}

fn balls(centers: &Bound<'_, PyAny>, radii: &Bound<'_, PyAny>) -> PyResult<(DVec3, Vec<[f32; 4]>)> {
    let (origin, mut spheres) = sphere_centers(centers)?;
    let radii = Numbers::of("radii", radii)?;
    fill_radii(&radii.column(spheres.len())?, &mut spheres)?;
    Ok((origin, spheres))
}

fn sphere_colors(colors: Option<&Bound<'_, PyAny>>, count: usize) -> PyResult<Shared<Rgb>> {
    let Some(colors) = colors else { return Ok(Shared::default()) };
    Ok(arrays::colors("colors", colors, count, "one for each sphere")?.into())
}

/// Colours of cylinders: one for each, or two for its halves.
fn cylinder_colors(given: &Bound<'_, PyAny>, count: usize) -> PyResult<Shared<[Rgb; 2]>> {
    let halves = given.getattr("shape").and_then(|shape| shape.extract::<Vec<usize>>());
    if halves.is_ok_and(|shape| shape == [count, 2, 3]) {
        let flat = given.call_method1("reshape", (2 * count, 3))?;
        let all = arrays::colors("colors", &flat, 2 * count, "one for each half")?;
        return Ok(all.as_chunks::<2>().0.to_vec().into());
    }
    let all = arrays::colors("colors", given, count, "one for each cylinder")?;
    Ok(all.into_iter().map(|color| [color; 2]).collect())
}

fn caps_of(caps: &str) -> PyResult<Caps> {
    match caps {
        "round" => Ok(Caps::Round),
        "flat" => Ok(Caps::Flat),
        "none" => Ok(Caps::Open),
        _ => {
            Err(value_error(format!("caps = {caps:?}: it must be \"round\", \"flat\" or \"none\"")))
        }
    }
}

/// Under which angle faces are smoothed, degrees; `None`: they are not.
fn crease(smooth: Option<&Bound<'_, PyAny>>) -> PyResult<Option<f64>> {
    let Some(smooth) = smooth else { return Ok(Some(60.0)) };
    if let Ok(flag) = smooth.extract::<bool>() {
        return Ok(flag.then_some(60.0));
    }
    match smooth.extract::<f64>() {
        Ok(degrees) if (0.0..=180.0).contains(&degrees) => Ok(Some(degrees)),
        _ => Err(value_error("smooth must be True, False, or an angle from 0 to 180 degrees")),
    }
}
