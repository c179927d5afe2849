//! The solids that rays meet in f64: canonical shapes, each under a transform.

use glam::{DAffine3, DMat3, DVec3};
use phong_bvh::{Canonical, Solid};
use phong_scene::Shape;

/// The canonical shape that a scene's shape is, placed; `None` for shapes that are none.
pub(super) fn canonical(shape: &Shape, to_world: DAffine3) -> Option<Solid> {
    let (shape, own) = match *shape {
        Shape::Disc { center, normal, radius } => {
            (Canonical::Disc, along(center, normal, radius, 1.0))
        }
        Shape::Box { min, max } => {
            let (middle, half) = ((min + max) / 2.0, (max - min) / 2.0);
            (Canonical::Box, DAffine3::from_translation(middle) * DAffine3::from_scale(half))
        }
        Shape::Cylinder { from, to, radius, capped } => {
            let axis = to - from;
            (Canonical::Cylinder { capped }, along(from, axis, radius, axis.length()))
        }
        Shape::Cone { from, to, radius, radius_to, capped } => {
            let axis = to - from;
            // In units of the larger radius.
            let unit = radius.max(radius_to);
            let cone =
                Canonical::Cone { radius: radius / unit, radius_to: radius_to / unit, capped };
            (cone, along(from, axis, unit, axis.length()))
        }
        Shape::Torus { center, axis, radius, tube } => {
            (Canonical::Torus { tube: tube / radius }, along(center, axis, radius, radius))
        }
        Shape::Sphere { .. }
        | Shape::Plane { .. }
        | Shape::Triangle { .. }
        | Shape::Mesh(_)
        | Shape::Points(_)
        | Shape::Cylinders(_)
        | Shape::Instance(_) => return None,
    };
    Some(Solid { shape, to_world: to_world * own })
}

/// The frame whose origin is `from` and whose z axis is along `axis`: x and y scaled by `radius`,
/// z by `height`.
fn along(from: DVec3, axis: DVec3, radius: f64, height: f64) -> DAffine3 {
    let z = axis.normalize_or(DVec3::Z);
    let (x, y) = z.any_orthonormal_pair();
    // A right-handed frame, so that no shape is mirrored.
    let (x, y) = if x.cross(y).dot(z) < 0.0 { (y, x) } else { (x, y) };
    DAffine3 { matrix3: DMat3::from_cols(x * radius, y * radius, z * height), translation: from }
}

/// A sphere under any transform: an ellipsoid.
pub(super) fn sphere(center: DVec3, radius: f64, to_world: DAffine3) -> Solid {
    let own = DAffine3 { matrix3: DMat3::from_diagonal(DVec3::splat(radius)), translation: center };
    Solid { shape: Canonical::Sphere, to_world: to_world * own }
}

/// A triangle among solids; `None` if it has no area. Under a mirror image its front is what was its back.
pub(super) fn facet([a, b, c]: [DVec3; 3], mirrored: bool) -> Option<Solid> {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac).try_normalize()?;
    let normal = if mirrored { -normal } else { normal };
    let to_world = DAffine3 { matrix3: DMat3::from_cols(ab, ac, normal), translation: a };
    Some(Solid { shape: Canonical::Triangle, to_world })
}
