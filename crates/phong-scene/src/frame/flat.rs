//! Models that are flat: which way, and what they look like from an edge.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::{DMat3, DVec3};

use crate::scene::Scene;
use crate::shape::Shape;

/// Points that are looked at, at most, of every object.
const SAMPLES: usize = 4096;

/// How thin a flat model is at most, in its own largest extent.
const THIN: f64 = 0.01;

/// Sine of the angle to its plane below which a flat model is seen from its edge.
const EDGE: f64 = 0.1;

/// The direction in which a model reaches least, and how far in its largest extent; `None`: it has
/// no extent at all.
pub(super) fn thinnest(scene: &Scene) -> Option<(DVec3, f64)> {
    let points = samples(scene);
    let count = points.len() as f64;
    let middle = points.iter().map(|p| *p / count).sum::<DVec3>();
    let mut spread = DMat3::ZERO;
    for p in &points {
        let d = *p - middle;
        spread += DMat3::from_cols(d * d.x, d * d.y, d * d.z);
    }
    let axes = axes_of(spread);
    let [x, y, z] = axes;
    let reach = scene.reach([x, y, z, -x, -y, -z]);
    let extents = [0, 1, 2].map(|i| reach[i] + reach[i + 3]);
    let largest = extents.into_iter().fold(0.0, f64::max);
    let least = (0..3).min_by(|a, b| extents[*a].total_cmp(&extents[*b]))?;
    (largest > 0.0 && largest.is_finite()).then(|| (axes[least], extents[least] / largest))
}

/// The direction to the eye, turned so that a flat model is not seen from its edge; `None`: it is
/// not.
pub(super) fn turned(to_eye: DVec3, up: DVec3, thinnest: Option<(DVec3, f64)>) -> Option<DVec3> {
    let (normal, thickness) = thinnest?;
    let edge_on = thickness <= THIN && normal.dot(to_eye).abs() < EDGE;
    if !edge_on {
        return None;
    }
    // From above rather than from below, and from the right rather than from the left.
    let upward = normal.dot(up);
    let side = if upward.abs() > EDGE { upward } else { normal.dot(up.cross(to_eye)) };
    let normal = if side < 0.0 { -normal } else { normal };
    let along = to_eye - normal * normal.dot(to_eye);
    Some((along.normalize_or(to_eye) + normal) * FRAC_1_SQRT_2)
}

/// Some points of everything that has an end.
fn samples(scene: &Scene) -> Vec<DVec3> {
    let mut points = Vec::new();
    for object in &scene.objects {
        let place = |p: DVec3| object.transform.transform_point3(p);
        match &object.shape {
            Shape::Mesh(mesh) => {
                let step = mesh.indices.len().div_ceil(SAMPLES).max(1);
                let corners = mesh.indices.iter().step_by(step).flatten();
                let corners = corners.filter_map(|&i| mesh.positions.get(i as usize));
                points.extend(corners.map(|p| place(mesh.origin + p.as_dvec3())));
            }
            Shape::Points(cloud) => {
                let step = cloud.spheres.len().div_ceil(SAMPLES).max(1);
                let centers = cloud.spheres.iter().step_by(step);
                points.extend(centers.map(|&[x, y, z, _]| {
                    place(cloud.origin + DVec3::new(x.into(), y.into(), z.into()))
                }));
            }
            _ => {
                let bounds = object.bounds(&[]);
                points.extend(bounds.corners().into_iter().filter(|p| p.is_finite()));
            }
        }
    }
    points
}

/// The axes of a symmetric matrix: its eigenvectors, by Jacobi's rotations.
fn axes_of(mut m: DMat3) -> [DVec3; 3] {
    let mut axes = DMat3::IDENTITY;
    for _ in 0..16 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let off = m.col(q)[p];
            if off == 0.0 || !off.is_finite() {
                continue;
            }
            let theta = 0.5 * (m.col(q)[q] - m.col(p)[p]) / off;
            let tangent = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let cosine = (tangent * tangent + 1.0).sqrt().recip();
            let sine = tangent * cosine;
            let mut turn = DMat3::IDENTITY;
            turn.col_mut(p)[p] = cosine;
            turn.col_mut(q)[q] = cosine;
            turn.col_mut(q)[p] = sine;
            turn.col_mut(p)[q] = -sine;
            m = turn.transpose() * m * turn;
            axes *= turn;
        }
    }
    [axes.x_axis, axes.y_axis, axes.z_axis]
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, Vec3};

    use super::*;
    use crate::mesh::Mesh;
    use crate::scene::Object;

    /// A plate of 20 by 10, turned.
    fn plate(turn: DQuat) -> Scene {
        let corner = |x: f64, y: f64| (turn * DVec3::new(x, y, 0.0)).as_vec3();
        let positions: [Vec3; 4] =
            [corner(-10.0, -5.0), corner(10.0, -5.0), corner(10.0, 5.0), corner(-10.0, 5.0)];
        let (positions, indices) = (positions.into(), [[0, 1, 2], [0, 2, 3]].into());
        let mesh = Mesh { positions, indices, ..Mesh::default() };
        Scene { objects: vec![Object::from(mesh)], ..Scene::default() }
    }

    #[test]
    fn a_flat_model_is_thin_along_its_normal_however_it_is_turned() {
        for axis in [DVec3::X, DVec3::Y, DVec3::ONE, DVec3::new(1.0, -2.0, 0.5)] {
            let axis = axis.normalize_or(DVec3::X);
            let turn = DQuat::from_rotation_arc(DVec3::Z, axis);
            let (normal, thickness) = thinnest(&plate(turn)).expect("an extent");
            assert!(normal.dot(axis).abs() > 0.999 && thickness < 1e-5, "{normal} {thickness}");
        }
    }

    #[test]
    fn a_plate_seen_from_its_edge_is_turned_to_show_its_upper_side() {
        let lying = thinnest(&plate(DQuat::from_rotation_arc(DVec3::Z, DVec3::Y)));
        let eye = turned(DVec3::Z, DVec3::Y, lying).expect("it is seen from its edge");
        assert!(eye.y > 0.7 && eye.z > 0.7, "{eye}");
        assert_eq!(turned(DVec3::Y, DVec3::NEG_Z, lying), None);
        assert_eq!(turned(DVec3::Z, DVec3::Y, thinnest(&Scene::default())), None);
    }
}
