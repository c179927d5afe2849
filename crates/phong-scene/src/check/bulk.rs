//! Meshes, points and cylinders: lengths of arrays, indices, numbers.

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::fault::{Faults, not_held};
use crate::color::Rgb;
use crate::limits::{LARGEST, Range};
use crate::mesh::{Caps, Cylinders, Mesh, NO_INDEX, Points};

/// Items that one task looks through.
const PIECE: usize = 1 << 12;

/// Judges a mesh, whose faces may be of so many materials.
pub(super) fn mesh(mesh: &Mesh, materials: usize, faults: &mut Faults) {
    faults.vector("origin", mesh.origin);
    let (vertices, triangles) = (mesh.positions.len(), mesh.indices.len());
    let most = u64::from(u32::MAX) - 1;
    for (field, count) in [("positions", vertices), ("indices", triangles)] {
        if count == 0 {
            faults.say(field, format!("`{field}` is empty"));
        } else if count as u64 > most {
            faults.say(field, format!("`{field}` holds {count}; the most are {most}"));
        }
    }
    first(&mesh.positions, "positions", |p| wrong_numbers(&p.to_array()), faults);
    first(&mesh.normals, "normals", |n| wrong_numbers(&n.to_array()), faults);
    first(&mesh.uvs, "uvs", |uv: &Vec2| wrong_numbers(&uv.to_array()), faults);
    colors(&mesh.colors, "positions", vertices, faults);
    corners(&mesh.indices, "indices", vertices, triangles, false, faults);
    let kinds = [
        ("normals", mesh.normals.len(), "normal_indices", &mesh.normal_indices),
        ("uvs", mesh.uvs.len(), "uv_indices", &mesh.uv_indices),
    ];
    for (values, count, field, indices) in kinds {
        if !indices.is_empty() {
            corners(indices, field, count, triangles, true, faults);
        } else if count > 0 && count != vertices {
            let message = format!(
                "`{values}` holds {count} for {vertices} positions; without `{field}` it is one each"
            );
            faults.say(values, message);
        }
    }
    directions(mesh, faults);
    let faces = &mesh.face_materials;
    if !faces.is_empty() && faces.len() != triangles {
        let message = format!("`face_materials` holds {} for {triangles} triangles", faces.len());
        faults.say("face_materials", message);
    }
    let outside = |&m: &u32| {
        (m as usize >= materials).then(|| format!("is {m}, but there are {materials} materials"))
    };
    first(faces, "face_materials", outside, faults);
}

/// Judges points.
pub(super) fn points(points: &Points, faults: &mut Faults) {
    faults.vector("origin", points.origin);
    if points.spheres.is_empty() {
        faults.say("spheres", "`spheres` is empty");
    }
    first(&points.spheres, "spheres", wrong_ball, faults);
    colors(&points.colors, "spheres", points.spheres.len(), faults);
}

/// Judges cylinders.
pub(super) fn cylinders(cylinders: &Cylinders, faults: &mut Faults) {
    let Cylinders { origin, segments, colors: pairs, caps } = cylinders;
    faults.vector("origin", *origin);
    if segments.is_empty() {
        faults.say("segments", "`segments` is empty");
    }
    let wrong = |ends: &[[f32; 4]; 2]| {
        let empty = || {
            let without_length = *caps != Caps::Round && Cylinders::is_empty(ends);
            without_length.then(|| "has no length, and its ends are not round".to_owned())
        };
        wrong_ball(&ends[0]).or_else(|| wrong_ball(&ends[1])).or_else(empty)
    };
    first(segments, "segments", wrong, faults);
    colors(pairs.as_flattened(), "ends of segments", 2 * segments.len(), faults);
}

/// What is wrong with `[x, y, z, radius]`.
fn wrong_ball(ball: &[f32; 4]) -> Option<String> {
    wrong_numbers(ball).or_else(|| {
        let radius = f64::from(ball[3]);
        let held = Range::POSITIVE.holds(radius);
        (!held).then(|| format!("has the radius {radius}; it must be above 0"))
    })
}

/// Says what is wrong with the first value of which something is, and how many more there are.
fn first<T: Sync>(
    values: &[T],
    field: &'static str,
    wrong: impl Fn(&T) -> Option<String> + Sync,
    faults: &mut Faults,
) {
    let all = values.par_iter().with_min_len(PIECE);
    let Some(number) = all.position_first(|value| wrong(value).is_some()) else { return };
    let count = values[number..].par_iter().with_min_len(PIECE);
    let count = count.filter(|value| wrong(value).is_some()).count();
    let what = wrong(&values[number]).unwrap_or_default();
    let more = if count > 1 { format!(", and {} more", count - 1) } else { String::new() };
    faults.say(field, format!("`{field}` {number} {what}{more}"));
}

fn wrong_numbers(values: &[f32]) -> Option<String> {
    // One comparison each where all is well.
    let held = values.iter().all(|v| v.abs() <= LARGEST as f32);
    if held { None } else { values.iter().find_map(|&v| not_held(v.into())) }
}

fn colors(colors: &[Rgb], per: &str, count: usize, faults: &mut Faults) {
    if !colors.is_empty() && colors.len() != count {
        faults.say("colors", format!("`colors` holds {} for {count} {per}", colors.len()));
    }
    let wrong = |color: &Rgb| {
        let negative = || {
            let below = color.to_array().iter().any(|&channel| channel < 0.0);
            below.then(|| "is negative; there is no light below 0".to_owned())
        };
        wrong_numbers(&color.to_array()).or_else(negative)
    };
    first(colors, "colors", wrong, faults);
}

/// Three indices a triangle, each below `count`, or none where that is `optional`.
fn corners(
    indices: &[[u32; 3]],
    field: &'static str,
    count: usize,
    triangles: usize,
    optional: bool,
    faults: &mut Faults,
) {
    if indices.len() != triangles {
        let message = format!("`{field}` holds {} for {triangles} triangles", indices.len());
        faults.say(field, message);
    }
    let wrong = |corners: &[u32; 3]| {
        let bad = |&&i: &&u32| i as usize >= count && !(optional && i == NO_INDEX);
        let index = corners.iter().find(bad)?;
        Some(format!("holds the index {index}, but there are {count}"))
    };
    first(indices, field, wrong, faults);
}

/// Normals that corners use must have a direction.
fn directions(mesh: &Mesh, faults: &mut Faults) {
    let used = if mesh.normal_indices.is_empty() { &mesh.indices } else { &mesh.normal_indices };
    let none = |i: &u32| {
        // What is out of range or no number has been said.
        mesh.normals.get(*i as usize).is_some_and(|n: &Vec3| *n == Vec3::ZERO)
    };
    if mesh.normals.is_empty() {
        return;
    }
    let wrong = |corners: &[u32; 3]| {
        let index = corners.iter().find(|i| none(i))?;
        Some(format!("uses the normal {index}, which is [0, 0, 0] and has no direction"))
    };
    let field = if mesh.normal_indices.is_empty() { "indices" } else { "normal_indices" };
    first(used, field, wrong, faults);
}
