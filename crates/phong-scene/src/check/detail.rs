//! Meshes, clouds and bundles whose parts lie so far apart that f32 cannot hold where all of them are.

use glam::Vec3;

use super::at;
use crate::diagnostic::Diagnostic;
use crate::scene::{Object, Scene};
use crate::shape::Shape;

/// The most primitives of an object that are looked at, evenly spread over their numbers.
const SAMPLE: usize = 1024;
/// What rounding to f32 costs at most, relative.
const ROUNDING: f32 = f32::EPSILON / 2.0;
/// The share of its size by which a primitive may be misplaced unsaid.
const UNSEEN: f32 = 1.0 / 64.0;

/// Says of which objects the picture loses detail, and how much.
pub(super) fn check(scene: &Scene, say: &mut dyn FnMut(Diagnostic)) {
    scene.all_objects().for_each(|object| lost(object, say));
}

fn lost(object: &Object, say: &mut dyn FnMut(Diagnostic)) {
    let (name, primitives) = match &object.shape {
        Shape::Mesh(mesh) => {
            let triangle = |i: usize| {
                let [a, b, c] = mesh.indices[i].map(|corner| mesh.positions[corner as usize]);
                (a, (b - a).abs().max((c - a).abs()).max_element())
            };
            ("triangles", sample(mesh.indices.len(), triangle))
        }
        Shape::Points(points) => {
            let ball = |i: usize| ball(points.spheres[i]);
            ("points", sample(points.spheres.len(), ball))
        }
        Shape::Cylinders(cylinders) => {
            let end = |i: usize| ball(cylinders.segments[i][0]);
            ("cylinders", sample(cylinders.segments.len(), end))
        }
        _ => return,
    };
    // Each is drawn about its median.
    let middle = Vec3::from_array([0, 1, 2].map(|axis| {
        let mut all: Vec<f32> = primitives.iter().map(|(p, _)| p[axis]).collect();
        let half = all.len() / 2;
        if all.is_empty() { 0.0 } else { *all.select_nth_unstable_by(half, f32::total_cmp).1 }
    }));
    let error = |p: Vec3| (p - middle).abs().max_element() * ROUNDING;
    let lost = primitives.iter().filter(|(p, size)| *size > 0.0 && error(*p) > UNSEEN * size);
    let (count, worst) =
        lost.fold((0, 0.0_f32), |(count, worst), (p, _)| (count + 1, worst.max(error(*p))));
    // What strays alone is not what the picture is of.
    if count * 100 <= primitives.len() {
        return;
    }
    let share = 100 * count / primitives.len();
    let message = format!(
        "{share} % of the {name} of `{}` lie so far from the others that they are misplaced by up to {worst:.0e}, \
         which is more than 1/64 of their size",
        object.name
    );
    let help = "write what is far apart as objects of their own";
    say(Diagnostic::warning(message, at(&object.place)).with_help(help));
}

fn ball([x, y, z, radius]: [f32; 4]) -> (Vec3, f32) {
    (Vec3::new(x, y, z), radius)
}

fn sample(count: usize, at: impl Fn(usize) -> (Vec3, f32)) -> Vec<(Vec3, f32)> {
    (0..count).step_by(count.div_ceil(SAMPLE).max(1)).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Points;

    fn said(far: f32, radius: f32) -> Vec<String> {
        let spheres: Vec<[f32; 4]> =
            (0..200).map(|i| [if i < 120 { 0.0 } else { far }, i as f32, 0.0, radius]).collect();
        let cloud = Points { spheres: spheres.into(), ..Points::default() };
        let object = Object { name: "cloud".to_owned(), ..Object::from(Shape::from(cloud)) };
        let mut said = Vec::new();
        check(&Scene { objects: vec![object], ..Scene::default() }, &mut |d| {
            said.push(d.to_string());
        });
        said
    }

    #[test]
    fn two_clusters_far_apart_are_told_with_what_is_lost() {
        let [told] = &said(1e7, 0.01)[..] else { panic!("one warning") };
        assert!(told.contains("40 % of the points of `cloud`"), "{told}");
        assert!(told.contains("misplaced by up to 6e-1"), "{told}");
    }

    #[test]
    fn clusters_that_f32_can_hold_are_not_told() {
        assert_eq!(said(1e4, 1.0), [""; 0]);
    }
}
