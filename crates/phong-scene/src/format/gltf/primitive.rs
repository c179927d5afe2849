//! Primitives: attributes and indices become triangles, spheres and capsules.

use std::sync::Arc;

use glam::{DAffine3, DMat4, DVec3, DVec4, Vec2, Vec3};
use rayon::prelude::*;

use super::buffer::Buffers;
use super::json::{At, Result};
use crate::color::Rgb;
use crate::format::faces::Faces;
use crate::format::text::{Findings, whole};
use crate::format::triangles::{has_room, tidy};
use crate::limits::Limits;
use crate::mesh::{Cylinders, Mesh, NO_INDEX, PIECE, Points};
use crate::shape::Shape;

/// The radius of lines, as a share of how large they are together.
const LINE: f64 = 0.002;

/// What all primitives are read with.
pub(super) struct Reader<'a> {
    pub(super) root: At<'a>,
    pub(super) buffers: Buffers,
    pub(super) file: Arc<str>,
    pub(super) limits: &'a Limits,
    /// Radius of points, where somebody gives one.
    pub(super) radius: Option<f32>,
}

/// Where the bones of a skin stand, as matrices of its vertices.
#[derive(Debug)]
pub(super) struct Pose(pub(super) Vec<DMat4>);

impl Reader<'_> {
    /// The shape of a primitive, with texture coordinates of this set; `None`: nothing is left of it, which is told.
    pub(super) fn shape(
        &self,
        (at, set): (&At<'_>, u64),
        pose: Option<&Pose>,
        findings: &mut Findings,
    ) -> Result<Option<Shape>> {
        for name in ["KHR_draco_mesh_compression", "EXT_meshopt_compression"] {
            if at.extension(name).is_some() && !self.has_places(at)? {
                return Err(at.fault(format!("it is packed by `{name}`, which is not understood")));
            }
        }
        let attributes = at.need("attributes")?;
        let Some(place) = attributes.get("POSITION") else {
            findings.warning(
                "primitives without places",
                || whole(&self.file),
                || format!("{}: there is no `POSITION`; it is left out", at.pointer),
            );
            return Ok(None);
        };
        let (root, limits) = (&self.root, self.limits);
        // What becomes vectors of as many numbers keeps its memory.
        let vectors = |rows: Vec<[f32; 3]>| rows.into_iter().map(Vec3::from).collect();
        let mut mesh = Mesh {
            positions: vectors(self.buffers.rows(root, &place, limits)?),
            ..Mesh::default()
        };
        let count = mesh.positions.len();
        let normals = self.rows(&attributes, "NORMAL", count, findings)?;
        let set = format!("TEXCOORD_{set}");
        let uvs = self.rows::<2>(&attributes, &set, count, findings)?;
        let colors = self.rows::<3>(&attributes, "COLOR_0", count, findings)?;
        let joints = self.rows(&attributes, "JOINTS_0", count, findings)?;
        let weights = (joints, self.rows(&attributes, "WEIGHTS_0", count, findings)?);
        mesh.normals = normals.map(vectors).unwrap_or_default();
        // The second coordinate grows down the image here, and up everywhere else.
        let up = |[u, v]: [f32; 2]| {
            let uv = Vec2::new(u, 1.0 - v);
            if uv.is_finite() { uv } else { Vec2::ZERO }
        };
        mesh.uvs = uvs.unwrap_or_default().into_iter().map(up).collect();
        // As the format says, linear whatever they are stored as; an alpha is not drawn.
        let sound = |c: [f32; 3]| {
            if Vec3::from(c).is_finite() { c.map(|c| c.max(0.0)) } else { [1.0; 3] }
        };
        mesh.colors = colors.into_iter().flatten().map(|c| Rgb::from(sound(c))).collect();
        if let (Some(pose), (Some(joints), Some(weights))) = (pose, weights) {
            bend(&mut mesh, pose, &joints, &weights);
        }
        let mode = at.get("mode").map_or(Ok(4), |mode| mode.whole());
        let indices = at.get("indices");
        // Triangles that are told one by one, of which there may be many, are read as what they are.
        let (mut triangles, mut others) = (Vec::new(), Vec::new());
        match (&mode, indices) {
            (Ok(4), Some(indices)) => triangles = self.buffers.indices(root, &indices, limits)?,
            (Ok(4), None) => {
                let corners = |i: u32| [3 * i, 3 * i + 1, 3 * i + 2];
                triangles = (0..count as u32 / 3).map(corners).collect();
            }
            (_, Some(indices)) => others = self.buffers.indices(root, &indices, limits)?,
            (_, None) => others = (0..count as u32).map(|i| [i]).collect(),
        }
        let (most, vertices) = (triangles.len().max(others.len() / 3) as u64, count as u64);
        if !has_room(most, vertices, mesh.bytes(), limits, &self.file, findings) {
            return Ok(None);
        }
        let mode = mode?;
        let mut elements = match mode {
            4 => Elements::Triangles(triangles),
            _ => elements(mode, others.as_flattened())
                .ok_or_else(|| at.fault(format!("{mode} is no mode of a primitive")))?,
        };
        drop(others);
        let unplaced = mesh.take_unplaced();
        let [outside, unsaid] = elements.sift(count, unplaced.as_deref());
        if outside > 0 {
            let lenient = limits.lenient;
            let end = if lenient { "; left out" } else { "" };
            findings.damage(
                lenient,
                "indices out of range",
                || whole(&self.file),
                || {
                    format!(
                        "{}: {outside} use a vertex beyond the {count} there are{end}",
                        at.pointer
                    )
                },
            );
        }
        if unsaid > 0 {
            findings.warning(
                "places that are no numbers",
                || whole(&self.file),
                || {
                    format!(
                        "{}: {unsaid} use a place that is NaN or infinite; left out",
                        at.pointer
                    )
                },
            );
        }
        if elements.is_empty() {
            findings.warning(
                "empty primitives",
                || whole(&self.file),
                || format!("{}: there is nothing to draw in it", at.pointer),
            );
            return Ok(None);
        }
        Ok(match elements {
            Elements::Points(kept) => Some(self.points(&mesh, &kept).into()),
            Elements::Lines(kept) => Some(lines(&mesh, &kept).into()),
            Elements::Triangles(kept) => self.triangles(mesh, kept, findings).map(Shape::from),
        })
    }

    /// The numbers of an attribute, if there are as many as places.
    fn rows<const N: usize>(
        &self,
        attributes: &At<'_>,
        key: &str,
        count: usize,
        findings: &mut Findings,
    ) -> Result<Option<Vec<[f32; N]>>> {
        let Some(at) = attributes.get(key) else { return Ok(None) };
        let rows = self.buffers.rows(&self.root, &at, self.limits)?;
        if rows.len() == count {
            return Ok(Some(rows));
        }
        findings.warning(
            "attributes of another length",
            || whole(&self.file),
            || format!("{}: there are {} for {count} places; not used", at.pointer, rows.len()),
        );
        Ok(None)
    }

    /// Whether a primitive has places that are not packed: such as name no part of a buffer are all zeros.
    fn has_places(&self, at: &At<'_>) -> Result<bool> {
        let Some(number) = at.need("attributes")?.get("POSITION") else { return Ok(false) };
        let places = self.root.item("accessors", number.index()?)?;
        Ok(places.get("bufferView").is_some() || places.get("sparse").is_some())
    }

    fn triangles(
        &self,
        mut mesh: Mesh,
        kept: Vec<[u32; 3]>,
        findings: &mut Findings,
    ) -> Option<Mesh> {
        mesh.indices = kept.into();
        if mesh.normals.is_empty() {
            // The format wants them flat: a normal that no corner uses says so.
            mesh.normals = [Vec3::Z].into();
            mesh.normal_indices = vec![[NO_INDEX; 3]; mesh.indices.len()].into();
        }
        tidy(&mut mesh, 0, findings, &self.file);
        (!mesh.indices.is_empty()).then_some(mesh)
    }

    fn points(&self, mesh: &Mesh, kept: &[[u32; 1]]) -> Points {
        let numbers = || kept.iter().map(|[i]| *i as usize);
        let sphere = |p: Vec3| [p.x, p.y, p.z, self.radius.unwrap_or(0.0)];
        let mut points = Points {
            spheres: numbers().map(|i| sphere(mesh.positions[i])).collect(),
            colors: numbers().filter_map(|i| mesh.colors.get(i).copied()).collect(),
            ..Points::default()
        };
        if self.radius.is_none() {
            points.guess_radius();
        }
        points
    }
}

/// Lines as capsules.
fn lines(mesh: &Mesh, kept: &[[u32; 2]]) -> Cylinders {
    let places = kept.iter().flatten().map(|i| mesh.positions[*i as usize]);
    let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = places.fold(start, |(low, high), p| (low.min(p), high.max(p)));
    let radius = (LINE * (high - low).as_dvec3().length()) as f32;
    let radius = if radius.is_normal() { radius } else { 1.0 };
    let end = |i: u32| {
        let p = mesh.positions[i as usize];
        [p.x, p.y, p.z, radius]
    };
    let segments = kept.iter().map(|ends| ends.map(end)).collect();
    let color = |i: u32| mesh.colors.get(i as usize).copied();
    let colors = kept.iter().filter_map(|[a, b]| Some([color(*a)?, color(*b)?])).collect();
    Cylinders { segments, colors, guessed: Some(radius), ..Cylinders::default() }
}

/// The vertices of each thing that is drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Elements {
    Points(Vec<[u32; 1]>),
    Lines(Vec<[u32; 2]>),
    Triangles(Vec<[u32; 3]>),
}

impl Elements {
    fn is_empty(&self) -> bool {
        match self {
            Self::Points(all) => all.is_empty(),
            Self::Lines(all) => all.is_empty(),
            Self::Triangles(all) => all.is_empty(),
        }
    }

    /// Takes those away that use a vertex beyond the `count` there are, or one whose place is no number: how
    /// many of each kind there were.
    fn sift(&mut self, count: usize, unplaced: Option<&[bool]>) -> [u64; 2] {
        match self {
            Self::Points(all) => sift(all, count, unplaced),
            Self::Lines(all) => sift(all, count, unplaced),
            Self::Triangles(all) => sift(all, count, unplaced),
        }
    }
}

fn sift<const N: usize>(
    all: &mut Vec<[u32; N]>,
    count: usize,
    unplaced: Option<&[bool]>,
) -> [u64; 2] {
    let is_inside = |piece: &[u32]| {
        let highest = piece.iter().fold(0, |highest: u32, i| highest.max(*i));
        piece.is_empty() || (highest as usize) < count
    };
    if unplaced.is_none() && all.as_flattened().par_chunks(PIECE).all(is_inside) {
        return [0; 2];
    }
    let (mut outside, mut unsaid) = (0, 0);
    all.retain(|corners| {
        let beyond = corners.iter().any(|i| *i as usize >= count);
        let is_unplaced = |i: &u32| unplaced.is_some_and(|all| all[*i as usize]);
        let nowhere = !beyond && corners.iter().any(is_unplaced);
        outside += u64::from(beyond);
        unsaid += u64::from(nowhere);
        !beyond && !nowhere
    });
    [outside, unsaid]
}

/// What vertices in this order are; `None`: there is no such mode.
fn elements(mode: u64, numbers: &[u32]) -> Option<Elements> {
    Some(match mode {
        0 => Elements::Points(numbers.as_chunks().0.to_vec()),
        1 => Elements::Lines(numbers.as_chunks().0.to_vec()),
        2 | 3 => {
            let closing = match (mode, numbers) {
                (2, [first, .., last]) => Some([*last, *first]),
                _ => None,
            };
            Elements::Lines(numbers.array_windows().copied().chain(closing).collect())
        }
        4 => Elements::Triangles(numbers.as_chunks().0.to_vec()),
        5 | 6 => {
            let mut faces = Faces::default();
            if mode == 5 {
                faces.push_strip(numbers);
            } else {
                faces.push(numbers);
            }
            Elements::Triangles(faces.indices)
        }
        _ => return None,
    })
}

/// Moves the vertices of a skinned mesh to where its bones are.
fn bend(mesh: &mut Mesh, Pose(bones): &Pose, joints: &[[f32; 4]], weights: &[[f32; 4]]) {
    for (i, (joints, weights)) in joints.iter().zip(weights).enumerate() {
        let mut matrix = DMat4::ZERO;
        let mut sum = 0.0;
        for (joint, weight) in joints.iter().zip(weights) {
            if let Some(bone) = bones.get(*joint as usize).filter(|_| *weight > 0.0) {
                matrix += *bone * f64::from(*weight);
                sum += f64::from(*weight);
            }
        }
        if sum <= 0.0 {
            continue;
        }
        let matrix = matrix * sum.recip();
        if let Some(p) = mesh.positions.get_mut(i) {
            *p = matrix.transform_point3(p.as_dvec3()).as_vec3();
        }
        if let Some(n) = mesh.normals.get_mut(i) {
            let affine = DAffine3::from_mat4(matrix);
            let turned: DVec3 = crate::transform::cofactor(affine.matrix3) * n.as_dvec3();
            *n = turned.normalize_or_zero().as_vec3();
        }
    }
}

/// A matrix of an accessor.
pub(super) fn matrix(numbers: [f32; 16]) -> DMat4 {
    let column = |k: usize| DVec4::from_array([0, 1, 2, 3].map(|i| f64::from(numbers[4 * k + i])));
    DMat4::from_cols(column(0), column(1), column(2), column(3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mode_makes_its_elements() {
        let count = |mode| match elements(mode, &[0, 1, 2, 3, 4, 5])? {
            Elements::Points(all) => Some(all.len()),
            Elements::Lines(all) => Some(all.len()),
            Elements::Triangles(all) => Some(all.len()),
        };
        let counts = [0, 1, 2, 3, 4, 5, 6, 7].map(count);
        let expected = [6, 3, 6, 5, 2, 4, 4].map(Some);
        assert_eq!((&counts[..7], counts[7]), (&expected[..], None));
        let fan = elements(6, &[9, 1, 2, 3]);
        assert_eq!(fan, Some(Elements::Triangles(vec![[9, 1, 2], [9, 2, 3]])));
    }
}
