//! Flat faces of two objects that lie in one plane, look the same way and overlap: which of them is seen is
//! left to rounding, pixel by pixel. Only what is certain is said, of shapes written one by one.

use glam::{DAffine3, DVec3};

use super::at;

use crate::diagnostic::{Diagnostic, Label};
use crate::material::Material;
use crate::scene::{Object, Scene};
use crate::shape::Shape;
use crate::transform::cofactor;

/// Most warnings of this kind: a wall of tiles would have one for each pair.
const MOST: usize = 5;

/// Most faces about as far from the origin that each face is held against.
const MOST_NEIGHBOURS: usize = 64;

/// How far apart two planes may be to count as one, relative to the size of their coordinates: a few of the
/// last digits of an f32, in which hits are found.
const NEAR: f64 = 2e-7;

/// Says which faces overlap in one plane.
pub(super) fn check(scene: &Scene, say: &mut dyn FnMut(Diagnostic)) {
    let mut faces: Vec<Face> = Vec::new();
    for (number, object) in scene.objects.iter().enumerate() {
        faces_of(number, &object.shape, object.transform, &mut faces);
    }
    faces.sort_by(|a, b| a.offset.total_cmp(&b.offset));
    let mut told: Vec<(usize, usize)> = Vec::new();
    for (i, a) in faces.iter().enumerate() {
        for b in faces[i + 1..].iter().take(MOST_NEIGHBOURS) {
            let near = NEAR * a.size.max(b.size);
            if b.offset - a.offset > near {
                break;
            }
            let pair = (a.object.min(b.object), a.object.max(b.object));
            let [first, second] = [pair.0, pair.1].map(|number| &scene.objects[number]);
            if pair.0 != pair.1
                && a.is_level_with(b)
                && is_chance(scene, first, second)
                && !told.contains(&pair)
                && (a.overlaps(b) || b.overlaps(a))
            {
                told.push(pair);
                if told.len() > MOST {
                    return;
                }
                say(warning(first, second));
            }
        }
    }
}

fn warning(first: &Object, second: &Object) -> Diagnostic {
    let message = format!(
        "faces of {} and {} overlap in one plane: which is seen is left to rounding",
        first.name, second.name
    );
    let mut warning = Diagnostic::warning(message, at(&second.place));
    let label =
        at(&first.place).map(|span| Label { message: format!("{} is here", first.name), span });
    warning.labels.extend(label);
    warning
        .with_help("give the material that is to be seen a higher `priority`, or move one a little")
}

/// Whether neither the materials nor their priorities say which is seen.
fn is_chance(scene: &Scene, first: &Object, second: &Object) -> bool {
    let material = |object: &Object| scene.materials.get(object.material.0 as usize);
    let (Some(a), Some(b)) = (material(first), material(second)) else { return false };
    let is_opaque = |material: &Material| material.transmission.is_black();
    first.material != second.material && a.priority == b.priority && is_opaque(a) && is_opaque(b)
}

/// A flat face.
struct Face {
    object: usize,
    /// Outwards; unit.
    normal: DVec3,
    /// Whether both of its sides are to be seen.
    two_sided: bool,
    outline: Outline,
    /// A point of it.
    middle: DVec3,
    /// The distance of its plane from the origin.
    offset: f64,
    /// The size of its coordinates.
    size: f64,
}

enum Outline {
    /// It has no end.
    Endless,
    /// The points `middle + s u + t v` for s and t in [−1, 1].
    Parallelogram(DVec3, DVec3),
    /// Those for s² + t² ≤ 1.
    Ellipse(DVec3, DVec3),
    /// Those for s, t ≥ −1/3 and s + t ≤ 1/3.
    Triangle(DVec3, DVec3),
}

impl Face {
    /// Whether it lies in the plane of `other` and is seen from the same side.
    fn is_level_with(&self, other: &Self) -> bool {
        let cos = self.normal.dot(other.normal);
        let apart = (other.middle - self.middle).dot(self.normal).abs();
        let one_way = cos > 0.0 || self.two_sided || other.two_sided;
        one_way && cos.abs() > 1.0 - 1e-12 && apart <= NEAR * self.size.max(other.size)
    }

    /// Whether it holds the middle of `other`, or a point well within its edge.
    fn overlaps(&self, other: &Self) -> bool {
        other.samples().into_iter().any(|p| self.holds(p))
    }

    fn samples(&self) -> Vec<DVec3> {
        let places: &[[f64; 2]] = match self.outline {
            Outline::Endless => &[],
            Outline::Parallelogram(..) => {
                &[[0.0, 0.0], [0.9, 0.9], [-0.9, 0.9], [0.9, -0.9], [-0.9, -0.9]]
            }
            Outline::Ellipse(..) => &[[0.0, 0.0], [0.9, 0.0], [-0.9, 0.0], [0.0, 0.9], [0.0, -0.9]],
            Outline::Triangle(..) => &[[0.0, 0.0], [-0.3, -0.3], [0.6, -0.3], [-0.3, 0.6]],
        };
        let (u, v) = self.axes();
        places.iter().map(|[s, t]| self.middle + *s * u + *t * v).collect()
    }

    fn axes(&self) -> (DVec3, DVec3) {
        match self.outline {
            Outline::Endless => (DVec3::ZERO, DVec3::ZERO),
            Outline::Parallelogram(u, v) | Outline::Ellipse(u, v) | Outline::Triangle(u, v) => {
                (u, v)
            }
        }
    }

    /// Whether a point of its plane is within its outline.
    fn holds(&self, p: DVec3) -> bool {
        let (u, v) = self.axes();
        let (across, off) = (u.cross(v), p - self.middle);
        let per = across.length_squared().recip();
        let s = off.cross(v).dot(across) * per;
        let t = u.cross(off).dot(across) * per;
        match self.outline {
            Outline::Endless => true,
            Outline::Parallelogram(..) => s.abs() < 1.0 && t.abs() < 1.0,
            Outline::Ellipse(..) => s * s + t * t < 1.0,
            Outline::Triangle(..) => s.min(t) > -1.0 / 3.0 && s + t < 1.0 / 3.0,
        }
    }
}

/// The flat faces of a shape under a transform.
fn faces_of(object: usize, shape: &Shape, transform: DAffine3, to: &mut Vec<Face>) {
    let normals = cofactor(transform.matrix3);
    let mirrored = transform.matrix3.determinant() < 0.0;
    let mut add = |middle: DVec3, normal: DVec3, two_sided: bool, outline: Outline| {
        let middle = transform.transform_point3(middle);
        let Some(normal) = (normals * normal).try_normalize() else { return };
        let normal = if mirrored { -normal } else { normal };
        let turn = |v: DVec3| transform.matrix3 * v;
        let outline = match outline {
            Outline::Endless => Outline::Endless,
            Outline::Parallelogram(u, v) => Outline::Parallelogram(turn(u), turn(v)),
            Outline::Ellipse(u, v) => Outline::Ellipse(turn(u), turn(v)),
            Outline::Triangle(u, v) => Outline::Triangle(turn(u), turn(v)),
        };
        let offset = normal.dot(middle).abs();
        let size = middle.abs().max_element();
        to.push(Face { object, normal, two_sided, outline, middle, offset, size });
    };
    let disc = |axis: DVec3, radius: f64| {
        let (u, v) = axis.normalize_or(DVec3::Z).any_orthonormal_pair();
        Outline::Ellipse(radius * u, radius * v)
    };
    match *shape {
        Shape::Plane { point, normal } => add(point, normal, false, Outline::Endless),
        Shape::Disc { center, normal, radius } => add(center, normal, true, disc(normal, radius)),
        Shape::Triangle { points: [a, b, c], .. } => {
            let (u, v) = (b - a, c - a);
            add((a + b + c) / 3.0, u.cross(v), true, Outline::Triangle(u, v));
        }
        Shape::Box { min, max } => {
            let (middle, half) = ((min + max) / 2.0, (max - min) / 2.0);
            for axis in 0..3 {
                let along = DVec3::AXES[axis] * half[axis];
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let (u, v) = (DVec3::AXES[u] * half[u], DVec3::AXES[v] * half[v]);
                add(middle + along, along, false, Outline::Parallelogram(u, v));
                add(middle - along, -along, false, Outline::Parallelogram(u, v));
            }
        }
        Shape::Cylinder { from, to, radius, capped: true } => {
            add(from, from - to, false, disc(to - from, radius));
            add(to, to - from, false, disc(to - from, radius));
        }
        Shape::Cone { from, to, radius, radius_to, capped: true } => {
            for (end, normal, radius) in [(from, from - to, radius), (to, to - from, radius_to)] {
                if radius > 0.0 {
                    add(end, normal, false, disc(normal, radius));
                }
            }
        }
        // Without a flat face of its own.
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::Light;
    use crate::material::MaterialId;

    const FLOOR: Shape = Shape::Plane { point: DVec3::ZERO, normal: DVec3::Y };

    fn block(min: [f64; 3], max: [f64; 3]) -> Shape {
        Shape::Box { min: min.into(), max: max.into() }
    }

    fn label(normal: DVec3) -> Shape {
        Shape::Disc { center: DVec3::ZERO, normal, radius: 1.0 }
    }

    /// How many pairs are told of two shapes, the second of which is of another material.
    fn told(first: Shape, second: Shape, change: impl FnOnce(&mut Material)) -> usize {
        let mut other = Material { name: "other".to_owned(), ..Material::default() };
        change(&mut other);
        let second = Object { material: MaterialId(1), ..Object::from(second) };
        let scene = Scene {
            materials: vec![Material::default(), other],
            objects: vec![Object::from(first), second],
            lights: vec![Light::default()],
            ..Scene::default()
        };
        let mut count = 0;
        check(&scene, &mut |_| count += 1);
        count
    }

    #[test]
    fn faces_that_overlap_in_one_plane_are_told() {
        assert_eq!(told(FLOOR, label(DVec3::Y), |_| {}), 1);
        assert_eq!(told(FLOOR, label(DVec3::NEG_Y), |_| {}), 1, "a disc has two sides");
        let (one, other) = (block([0.0; 3], [2.0; 3]), block([1.0, -1.0, 1.0], [3.0, 2.0, 3.0]));
        assert_eq!(told(one, other, |_| {}), 1, "tops of two blocks");
        let sunk = block([-1.0, -1.0, -1.0], [1.0, 0.0, 1.0]);
        assert_eq!(told(FLOOR, sunk, |_| {}), 1, "a block sunk into the floor up to its top");
    }

    #[test]
    fn what_stands_on_or_beside_something_is_not_told() {
        assert_eq!(told(FLOOR, block([-1.0, 0.0, -1.0], [1.0, 2.0, 1.0]), |_| {}), 0);
        let (one, beside) = (block([0.0; 3], [2.0; 3]), block([2.0, 0.0, 0.0], [4.0, 2.0, 2.0]));
        assert_eq!(told(one, beside, |_| {}), 0, "side by side");
        assert_eq!(told(FLOOR, Shape::Sphere { center: DVec3::Y, radius: 1.0 }, |_| {}), 0);
        let above = Shape::Disc { center: 1e-3 * DVec3::Y, normal: DVec3::Y, radius: 1.0 };
        assert_eq!(told(FLOOR, above, |_| {}), 0, "a hair above");
    }

    #[test]
    fn where_glass_or_a_priority_decides_nothing_is_told() {
        assert_eq!(told(FLOOR, label(DVec3::Y), |other| other.priority = 1), 0);
        let glass = |other: &mut Material| other.transmission = crate::color::Rgb::WHITE.into();
        assert_eq!(told(FLOOR, label(DVec3::Y), glass), 0);
    }
}
