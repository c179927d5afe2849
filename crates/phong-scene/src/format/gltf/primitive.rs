//! Primitives: attributes and indices become triangles, spheres and capsules.

use std::sync::Arc;

use glam::{DAffine3, DMat4, DVec3, DVec4, Vec3, Vec4};

use super::buffer::Buffers;
use super::json::{At, Result};
use super::material::Surface;
use crate::color::Rgb;
use crate::format::faces::Faces;
use crate::format::text::{Findings, whole};
use crate::format::triangles::{has_room, tidy};
use crate::limits::Limits;
use crate::mesh::{Cylinders, Mesh, NO_INDEX, Points};
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
    /// The shape of a primitive; `None`: nothing is left of it, which is told.
    pub(super) fn shape(
        &self,
        at: &At<'_>,
        surface: &Surface,
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
        let mut mesh = Mesh {
            positions: self.buffers.rows(root, &place, limits)?.vectors().into(),
            ..Mesh::default()
        };
        let count = mesh.positions.len();
        let mut own = |key: &str| -> Result<_> {
            let Some(at) = attributes.get(key) else { return Ok(None) };
            let rows = self.buffers.rows(root, &at, limits)?;
            if rows.count == count {
                return Ok(Some(rows));
            }
            findings.warning(
                "attributes of another length",
                || whole(&self.file),
                || format!("{}: there are {} for {count} places; not used", at.pointer, rows.count),
            );
            Ok(None)
        };
        let normals = own("NORMAL")?;
        let uvs = own("TEXCOORD_0")?;
        let colors = own("COLOR_0")?;
        let weights = (own("JOINTS_0")?, own("WEIGHTS_0")?);
        mesh.normals = normals.map(|rows| rows.vectors()).unwrap_or_default().into();
        // The second coordinate grows down the image here, and up everywhere else.
        let up = |uv: glam::Vec2| glam::Vec2::new(uv.x, 1.0 - uv.y);
        let pairs = uvs.map(|rows| rows.pairs()).unwrap_or_default();
        mesh.uvs = pairs.into_iter().map(up).collect();
        let is_bad = |c: &f32| !c.is_finite();
        mesh.uvs.iter_mut().filter(|uv| !uv.is_finite()).for_each(|uv| *uv = glam::Vec2::ZERO);
        let imaged = surface.material.color.constant().is_none();
        if colors.is_some() && imaged {
            findings.warning(
                "colours of vertices",
                || whole(&self.file),
                || {
                    format!(
                        "{}: an image gives the colour; those of vertices are left out",
                        at.pointer
                    )
                },
            );
        }
        if let Some(rows) = colors.filter(|_| !imaged) {
            // As the format says, linear whatever they are stored as; an alpha is not drawn.
            let tint = |c: Vec3| Rgb::new(c.x, c.y, c.z) * surface.color;
            let sound = |c: Vec3| c.max(Vec3::ZERO);
            let colors = rows.vectors().into_iter();
            let colors =
                colors.map(|c| if c.to_array().iter().any(is_bad) { Vec3::ONE } else { c });
            mesh.colors = colors.map(|c| tint(sound(c))).collect();
        }
        if let (Some(pose), (Some(joints), Some(weights))) = (pose, weights) {
            bend(&mut mesh, pose, &joints.quadruples(), &weights.quadruples());
        }
        let numbers = match at.get("indices") {
            Some(indices) => self.buffers.indices(root, &indices, limits)?,
            None => (0..count as u32).collect(),
        };
        let (triangles, vertices) = (numbers.len() as u64 / 3, count as u64);
        if !has_room(triangles, vertices, mesh.bytes(), limits, &self.file, findings) {
            return Ok(None);
        }
        let unplaced = mesh.take_unplaced();
        let placed = |i: u32| !unplaced.as_ref().is_some_and(|all| all[i as usize]);
        let mode = at.get("mode").map_or(Ok(4), |mode| mode.whole())?;
        let elements = elements(mode, &numbers)
            .ok_or_else(|| at.fault(format!("{mode} is no mode of a primitive")))?;
        let mut kept = Vec::with_capacity(elements.len());
        let (mut outside, mut unsaid) = (0_u64, 0_u64);
        for element in elements {
            let corners = element.as_slice();
            if corners.iter().any(|i| *i as usize >= count) {
                outside += 1;
            } else if corners.iter().all(|i| placed(*i)) {
                kept.push(element);
            } else {
                unsaid += 1;
            }
        }
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
        if kept.is_empty() {
            findings.warning(
                "empty primitives",
                || whole(&self.file),
                || format!("{}: there is nothing to draw in it", at.pointer),
            );
            return Ok(None);
        }
        Ok(match mode {
            0 => Some(self.points(&mesh, &kept).into()),
            1..=3 => Some(lines(&mesh, &kept).into()),
            _ => self.triangles(mesh, &kept, findings).map(Shape::from),
        })
    }

    /// Whether a primitive has places that are not packed: such as name no part of a buffer are all zeros.
    fn has_places(&self, at: &At<'_>) -> Result<bool> {
        let Some(number) = at.need("attributes")?.get("POSITION") else { return Ok(false) };
        let places = self.root.item("accessors", number.index()?)?;
        Ok(places.get("bufferView").is_some() || places.get("sparse").is_some())
    }

    fn triangles(&self, mut mesh: Mesh, kept: &[Element], findings: &mut Findings) -> Option<Mesh> {
        let triangle = |element: &Element| match element {
            Element::Triangle(corners) => *corners,
            Element::Point([a]) | Element::Line([a, _]) => [*a; 3],
        };
        mesh.indices = kept.iter().map(triangle).collect();
        if mesh.normals.is_empty() {
            // The format wants them flat: a normal that no corner uses says so.
            mesh.normals = [Vec3::Z].into();
            mesh.normal_indices = vec![[NO_INDEX; 3]; kept.len()].into();
        }
        tidy(&mut mesh, 0, findings, &self.file);
        (!mesh.indices.is_empty()).then_some(mesh)
    }

    fn points(&self, mesh: &Mesh, kept: &[Element]) -> Points {
        let numbers = || kept.iter().map(|element| element.as_slice()[0] as usize);
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
fn lines(mesh: &Mesh, kept: &[Element]) -> Cylinders {
    let ends = || kept.iter().map(Element::as_slice);
    let places = ends().flatten().map(|i| mesh.positions[*i as usize]);
    let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = places.fold(start, |(low, high), p| (low.min(p), high.max(p)));
    let radius = (LINE * (high - low).as_dvec3().length()) as f32;
    let radius = if radius.is_normal() { radius } else { 1.0 };
    let end = |i: u32| {
        let p = mesh.positions[i as usize];
        [p.x, p.y, p.z, radius]
    };
    let segments = ends().map(|e| [end(e[0]), end(e[e.len() - 1])]).collect();
    let color = |i: u32| mesh.colors.get(i as usize).copied();
    let colors = ends().filter_map(|e| Some([color(e[0])?, color(e[e.len() - 1])?])).collect();
    Cylinders { segments, colors, guessed: Some(radius), ..Cylinders::default() }
}

/// The vertices of one thing that is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Element {
    Point([u32; 1]),
    Line([u32; 2]),
    Triangle([u32; 3]),
}

impl Element {
    fn as_slice(&self) -> &[u32] {
        match self {
            Self::Point(corners) => corners,
            Self::Line(corners) => corners,
            Self::Triangle(corners) => corners,
        }
    }
}

/// What vertices in this order are; `None`: there is no such mode.
fn elements(mode: u64, numbers: &[u32]) -> Option<Vec<Element>> {
    let line = |pair: &[u32]| Element::Line([pair[0], pair[1]]);
    Some(match mode {
        0 => numbers.iter().map(|i| Element::Point([*i])).collect(),
        1 => numbers.chunks_exact(2).map(line).collect(),
        2 | 3 => {
            let closing = match (mode, numbers) {
                (2, [first, .., last]) => Some(Element::Line([*last, *first])),
                _ => None,
            };
            numbers.windows(2).map(line).chain(closing).collect()
        }
        4 => numbers.chunks_exact(3).map(|t| Element::Triangle([t[0], t[1], t[2]])).collect(),
        5 | 6 => {
            let mut faces = Faces::default();
            if mode == 5 {
                faces.push_strip(numbers);
            } else {
                faces.push(numbers);
            }
            faces.indices.into_iter().map(Element::Triangle).collect()
        }
        _ => return None,
    })
}

/// Moves the vertices of a skinned mesh to where its bones are.
fn bend(mesh: &mut Mesh, Pose(bones): &Pose, joints: &[Vec4], weights: &[Vec4]) {
    for (i, (joints, weights)) in joints.iter().zip(weights).enumerate() {
        let mut matrix = DMat4::ZERO;
        let mut sum = 0.0;
        for (joint, weight) in joints.to_array().into_iter().zip(weights.to_array()) {
            if let Some(bone) = bones.get(joint as usize).filter(|_| weight > 0.0) {
                matrix += *bone * f64::from(weight);
                sum += f64::from(weight);
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
        let count = |mode| elements(mode, &[0, 1, 2, 3, 4, 5]).map(|all| all.len());
        let counts = [0, 1, 2, 3, 4, 5, 6, 7].map(count);
        let expected = [6, 3, 6, 5, 2, 4, 4].map(Some);
        assert_eq!((&counts[..7], counts[7]), (&expected[..], None));
        let fan = elements(6, &[9, 1, 2, 3]).unwrap_or_default();
        assert_eq!(fan, [Element::Triangle([9, 1, 2]), Element::Triangle([9, 2, 3])]);
    }
}
