//! Where surface coordinates begin, where they run, and which way normals point.

use glam::{DQuat, DVec3, Vec2, Vec3};
use phong_bvh::{
    BuildOptions, Canonical, Coordinates, Plane, Primitives, Ray, Sphere, Surface, World,
};
use proptest::prelude::*;

use crate::oracle::{Placed, directions, shapes};

type Seen = (Surface, Coordinates);

fn seen(geometry: Primitives, origin: [f32; 3], dir: [f32; 3]) -> Seen {
    let bvh = World::of(vec![geometry], BuildOptions::default()).expect("few primitives");
    let ray = Ray::new(Vec3::from(origin), Vec3::from(dir));
    let hit = bvh.intersect(&ray);
    assert!(hit.is_some(), "{ray:?} meets nothing");
    (bvh.surface(&ray, &hit), bvh.coordinates(&ray, &hit))
}

fn solid(shape: Canonical, origin: [f32; 3], dir: [f32; 3]) -> Seen {
    let placed = Placed::new(shape, DVec3::ONE, DQuat::IDENTITY, DVec3::ZERO);
    seen(Primitives::Solid(placed.solid), origin, dir)
}

#[track_caller]
fn expect((surface, at): &Seen, ng: Vec3, tangent: Vec3, uv: [f32; 2]) {
    let is_near = |a: Vec3, b: Vec3| (a - b).length() < 1e-6;
    assert!(is_near(surface.ng, ng), "the normal is {}", surface.ng);
    assert!(is_near(at.tangent, tangent), "the tangent is {}", at.tangent);
    assert!((at.uv - Vec2::from(uv)).length() < 1e-6, "the coordinates are {}", at.uv);
}

#[test]
fn a_sphere_has_longitude_and_latitude() {
    let spheres = || Primitives::spheres(vec![Sphere { center: Vec3::ZERO, radius: 1.0 }]);
    for looks in [seen, |_, o, d| solid(Canonical::Sphere, o, d)] {
        let front = looks(spheres(), [5.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
        expect(&front, Vec3::X, Vec3::Y, [0.0, 0.5]);
        let side = looks(spheres(), [0.0, 5.0, 0.0], [0.0, -1.0, 0.0]);
        expect(&side, Vec3::Y, Vec3::NEG_X, [0.25, 0.5]);
        // From within the normal points outwards as well.
        let back = looks(spheres(), [0.0, 0.0, 0.0], [0.0, -1.0, 0.0]);
        expect(&back, Vec3::NEG_Y, Vec3::X, [0.75, 0.5]);
    }
}

#[test]
fn the_poles_of_a_sphere_have_some_tangent() {
    let pole = solid(Canonical::Sphere, [0.0, 0.0, 5.0], [0.0, 0.0, -1.0]);
    let (surface, Coordinates { uv, tangent }) = pole;
    assert_eq!((surface.ng, uv.y), (Vec3::Z, 1.0));
    assert!(tangent.is_normalized() && tangent.z.abs() < 1e-6, "{tangent}");
}

#[test]
fn a_box_shows_no_face_mirrored() {
    for (from, tangent) in [
        (Vec3::X, Vec3::Y),
        (Vec3::Y, Vec3::Z),
        (Vec3::Z, Vec3::X),
        (Vec3::NEG_X, Vec3::NEG_Y),
        (Vec3::NEG_Y, Vec3::NEG_Z),
        (Vec3::NEG_Z, Vec3::NEG_X),
    ] {
        let across = from.cross(tangent);
        let origin = 5.0 * from + 0.5 * tangent + 0.25 * across;
        let face = solid(Canonical::Box, origin.to_array(), (-from).to_array());
        expect(&face, from, tangent, [0.75, 0.625]);
    }
}

#[test]
fn a_cylinder_and_its_caps_have_their_own_coordinates() {
    for shape in [
        Canonical::Cylinder { capped: true },
        Canonical::Cone { radius: 1.0, radius_to: 1.0, capped: true },
    ] {
        let side = solid(shape, [0.0, 5.0, 0.25], [0.0, -1.0, 0.0]);
        expect(&side, Vec3::Y, Vec3::NEG_X, [0.25, 0.25]);
        let top = solid(shape, [0.5, 0.0, 5.0], [0.0, 0.0, -1.0]);
        expect(&top, Vec3::Z, Vec3::X, [0.75, 0.5]);
        let bottom = solid(shape, [0.5, 0.0, -5.0], [0.0, 0.0, 1.0]);
        expect(&bottom, Vec3::NEG_Z, Vec3::X, [0.75, 0.5]);
    }
}

#[test]
fn an_open_cylinder_seen_from_within_still_has_its_normal_outwards() {
    let shape = Canonical::Cylinder { capped: false };
    let within = solid(shape, [0.0, 0.0, 0.5], [0.0, 1.0, 0.0]);
    expect(&within, Vec3::Y, Vec3::NEG_X, [0.25, 0.5]);
}

#[test]
fn the_side_of_a_cone_leans_by_its_slope() {
    let shape = Canonical::Cone { radius: 1.0, radius_to: 0.0, capped: true };
    let side = solid(shape, [5.0, 0.0, 0.5], [-1.0, 0.0, 0.0]);
    let half = 0.5_f32.sqrt();
    expect(&side, Vec3::new(half, 0.0, half), Vec3::Y, [0.0, 0.5]);
}

#[test]
fn the_angle_around_the_tube_of_a_torus_begins_outside() {
    let shape = Canonical::Torus { tube: 0.25 };
    let outside = solid(shape, [5.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
    expect(&outside, Vec3::X, Vec3::Y, [0.0, 0.0]);
    let crown = solid(shape, [0.0, 1.0, 5.0], [0.0, 0.0, -1.0]);
    expect(&crown, Vec3::Z, Vec3::NEG_X, [0.25, 0.25]);
}

#[test]
fn a_plane_is_measured_from_its_point() {
    let plane = Plane { point: DVec3::new(1.0, 7.0, 1.0), normal: DVec3::Y };
    let surface = seen(Primitives::Plane(plane), [4.0, 9.0, 3.0], [0.0, -1.0, 0.0]);
    expect(&surface, Vec3::Y, Vec3::X, [3.0, -2.0]);
    assert_eq!(surface.0.p, DVec3::new(4.0, 7.0, 3.0));
}

#[test]
fn a_triangle_has_its_weights_and_the_normal_of_its_turning() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let geometry = Primitives::triangles(positions, vec![[0, 1, 2]]);
    for (height, dir) in [(2.0, -1.0), (-2.0, 1.0)] {
        let surface = seen(geometry.clone(), [0.25, 0.5, height], [0.0, 0.0, dir]);
        expect(&surface, Vec3::Z, Vec3::X, [0.25, 0.5]);
        assert_eq!(surface.0.p, DVec3::new(0.25, 0.5, 0.0));
    }
}

#[test]
fn a_mirrored_solid_keeps_its_normals_outwards() {
    let scale = DVec3::new(1.0, 1.0, -1.0);
    let shape = Canonical::Cylinder { capped: true };
    let mirrored = Placed::new(shape, scale, DQuat::IDENTITY, DVec3::ZERO);
    let end = seen(Primitives::Solid(mirrored.solid), [0.0, 0.0, -5.0], [0.0, 0.0, 1.0]);
    expect(&end, Vec3::NEG_Z, Vec3::X, [0.5, 0.5]);
}

proptest! {
    #[test]
    fn coordinates_are_shares_and_the_first_grows_along_the_tangent(
        shape in shapes(), stretch in [0.5..2.0_f64, 0.5..2.0, 0.5..2.0],
        axis in directions(), angle in 0.0..6.3_f64, from in directions(), to in directions(),
    ) {
        let turn = DQuat::from_axis_angle(axis, angle);
        let placed = Placed::new(shape, DVec3::from_array(stretch), turn, DVec3::ZERO);
        let geometry = vec![Primitives::Solid(placed.solid)];
        let bvh = World::of(geometry, BuildOptions::default()).expect("one primitive");
        let look = |at: Vec3, dir: Vec3| {
            let ray = Ray::new(at - dir, dir);
            let hit = bvh.intersect(&ray);
            hit.is_some().then(|| (bvh.surface(&ray, &hit), bvh.coordinates(&ray, &hit)))
        };
        let (middle, size) = placed.bounding_sphere();
        let Some((first, at)) = look((middle + 0.6 * size * to).as_vec3(), from.as_vec3()) else {
            return Ok(());
        };
        prop_assert!(at.uv.min_element() >= 0.0 && at.uv.max_element() <= 1.0);
        let next = look(first.p.as_vec3() + 1e-3 * at.tangent, -first.ng);
        // On past a seam or over an edge it may begin again.
        let Some((next, there)) = next.filter(|(next, _)| next.ng.dot(first.ng) > 0.999) else {
            return Ok(());
        };
        if (there.uv.x - at.uv.x).abs() < 0.5 && (next.p - first.p).length() < 2e-3 {
            prop_assert!(there.uv.x > at.uv.x, "{} to {}", at.uv, there.uv);
        }
    }
}
