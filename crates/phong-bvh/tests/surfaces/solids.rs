//! Solids against an oracle that knows them only by a sign.

use glam::{DQuat, DVec3, Vec3};
use phong_bvh::{BuildOptions, Canonical, Primitives, Ray, Solid, World};
use proptest::prelude::*;

use crate::oracle::{Placed, directions, placed, ray_at};

fn alone(solid: Solid) -> World {
    World::of(vec![Primitives::Solid(solid)], BuildOptions::default()).expect("one primitive")
}

/// The distance at which a ray first meets a solid, or none.
fn meet(solid: &Solid, ray: &Ray) -> Option<f32> {
    let hit = alone(*solid).intersect(ray);
    hit.is_some().then_some(hit.t)
}

/// A hit the oracle found nothing of must at least be a point of the surface.
fn is_on_surface(placed: &Placed, local: DVec3) -> bool {
    placed.side(local).abs() < 1e-6 && placed.belongs(local) > -1e-6
}

fn agrees(placed: &Placed, ray: &Ray) -> Result<(), TestCaseError> {
    if placed.is_within_plane(ray) {
        return Ok(());
    }
    let (_, radius) = placed.bounding_sphere();
    let hit = meet(&placed.solid, ray).map(f64::from);
    // `t` itself is rounded to f32: what is left of the error must be as small.
    let slack = |t: f64| 2e-7 * t.abs() + 1e-9 * radius;
    let expected = placed.march(ray).into_iter().find(|&t| t > 1e-6 * radius);
    let is_sure = |t: f64| placed.belongs(placed.local_at(ray, t)) > 1e-6;
    match (hit, expected) {
        (Some(t), Some(sought)) if (t - sought).abs() <= slack(t) => {}
        (Some(t), Some(sought)) if t > sought => {
            prop_assert!(!is_sure(sought), "passed through {sought}, hit {t}");
        }
        (Some(t), _) => {
            let exact = placed.on_surface(ray, t);
            prop_assert!(
                is_on_surface(placed, placed.local_at(ray, exact)),
                "a phantom hit at {t}, not {expected:?}"
            );
        }
        (None, Some(sought)) => prop_assert!(!is_sure(sought), "missed the surface at {sought}"),
        (None, None) => {}
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, ..ProptestConfig::default() })]

    #[test]
    fn a_ray_from_afar_or_within_meets_a_solid_where_the_oracle_does(
        placed in placed(),
        from in directions(),
        to in directions(),
        distance in prop_oneof![0.0..2.0_f64, 2.0..1000.0_f64],
    ) {
        agrees(&placed, &ray_at(&placed, from, to, distance))?;
    }

    #[test]
    fn a_normal_seen_from_a_thousand_radii_is_right_to_a_thousandth(
        placed in placed(),
        from in directions(),
        to in directions(),
    ) {
        let ray = ray_at(&placed, from, to, 1000.0);
        let bvh = alone(placed.solid);
        let hit = bvh.intersect(&ray);
        if hit.is_some() {
            let surface = bvh.surface(&ray, &hit);
            let exact = placed.on_surface(&ray, f64::from(hit.t));
            let p = ray.origin + exact * ray.dir.as_dvec3();
            let (normal, _) = placed.normal(p);
            // Differences straddle an edge, an apex: there they are no gradient.
            let h = 1e-4 * placed.bounding_sphere().1;
            let smooth = DVec3::AXES.iter().all(|&axis| {
                [h, -h].iter().all(|&h| (placed.normal(p + h * axis).0 - normal).length() < 0.02)
            });
            if smooth {
                let off = surface.ng.as_dvec3() - normal;
                prop_assert!(off.length() < 1e-3, "{} is not {normal} at {p}", surface.ng);
            }
        }
    }

    #[test]
    fn the_bounds_of_a_solid_hold_all_of_it(placed in placed(), toward in directions()) {
        let [low, high] = placed.solid.bounds();
        let ray = ray_at(&placed, toward, -toward, 3.0);
        if let Some(t) = meet(&placed.solid, &ray) {
            let p = ray.origin + placed.on_surface(&ray, f64::from(t)) * ray.dir.as_dvec3();
            let slack = 1e-9 * placed.bounding_sphere().1;
            prop_assert!((p + slack).cmpge(low.as_dvec3()).all(), "{p} is below {low}");
            prop_assert!((p - slack).cmple(high.as_dvec3()).all(), "{p} is above {high}");
        }
    }
}

#[test]
fn a_small_disc_far_from_the_origin_is_met_almost_in_its_plane() {
    // Rounding a point of the ray to the world's coordinates moves the crossing by more than f32 does.
    let at = DVec3::new(0.316_741_305_394_386_4, 0.0, 0.715_179_682_041_759_3);
    let scale = DVec3::splat(0.005_297_389_065_623_604);
    let placed = Placed::new(Canonical::Disc, scale, DQuat::IDENTITY, at);
    let ray = ray_at(&placed, DVec3::X, DVec3::X, 1.356_085_389_689_843);
    assert!(!placed.is_within_plane(&ray) && meet(&placed.solid, &ray).is_some());
    agrees(&placed, &ray).unwrap();
}

fn plain(shape: Canonical) -> Placed {
    Placed::new(shape, DVec3::ONE, DQuat::IDENTITY, DVec3::ZERO)
}

#[test]
fn a_ray_along_the_axis_meets_both_caps_and_no_open_end() {
    let down = Ray::new(Vec3::new(0.25, 0.5, 7.0), Vec3::NEG_Z);
    let inside = Ray::new(Vec3::new(0.25, 0.5, 0.75), Vec3::NEG_Z);
    for (capped, from_above, from_within) in [(true, Some(6.0), Some(0.75)), (false, None, None)] {
        let cylinder = plain(Canonical::Cylinder { capped }).solid;
        assert_eq!(meet(&cylinder, &down), from_above);
        assert_eq!(meet(&cylinder, &inside), from_within);
        let straight = plain(Canonical::Cone { radius: 1.0, radius_to: 1.0, capped }).solid;
        assert_eq!(meet(&straight, &down), from_above);
        assert_eq!(meet(&straight, &inside), from_within);
    }
}

#[test]
fn a_ray_onto_the_apex_of_a_cone_meets_it() {
    let cone = plain(Canonical::Cone { radius: 1.0, radius_to: 0.0, capped: true }).solid;
    assert_eq!(meet(&cone, &Ray::new(Vec3::new(0.0, 0.0, 4.0), Vec3::NEG_Z)), Some(3.0));
    assert_eq!(meet(&cone, &Ray::new(Vec3::new(0.0, 0.0, -4.0), Vec3::Z)), Some(4.0));
    // The other half of the double cone is no part of it.
    assert_eq!(meet(&cone, &Ray::new(Vec3::new(-4.0, 0.0, 1.5), Vec3::X)), None);
}

#[test]
fn a_ray_through_the_hole_of_a_torus_misses_and_one_across_meets_it_four_times() {
    let torus = plain(Canonical::Torus { tube: 0.25 }).solid;
    assert_eq!(meet(&torus, &Ray::new(Vec3::new(0.5, 0.0, 9.0), Vec3::NEG_Z)), None);
    let mut ray = Ray::new(Vec3::new(-5.0, 0.0, 0.0), Vec3::X);
    for expected in [3.75, 4.25, 5.75, 6.25] {
        ray.t_min = meet(&torus, &ray).unwrap();
        assert!((ray.t_min - expected).abs() < 1e-6, "{} is not {expected}", ray.t_min);
    }
    assert_eq!(meet(&torus, &ray), None);
}

#[test]
fn a_ray_that_touches_the_crown_of_a_torus_from_above_is_a_graze_at_most() {
    let torus = plain(Canonical::Torus { tube: 0.25 }).solid;
    let along = |z: f32| meet(&torus, &Ray::new(Vec3::new(-5.0, 1.0, z), Vec3::X));
    assert_eq!(along(0.250_001), None);
    assert!((along(0.249_999).unwrap() - 5.0).abs() < 0.05);
}

#[test]
fn the_bounds_of_a_solid_hold_no_more_than_it() {
    let half = 0.5_f64.sqrt();
    let tilted = |shape, scale| {
        let turn = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_4);
        Placed::new(shape, scale, turn, DVec3::new(5.0, -6.0, 7.0)).solid
    };
    let long = DVec3::new(1.0, 1.0, 4.0);
    let cone = Canonical::Cone { radius: 2.0, radius_to: 0.0, capped: false };
    let torus = Canonical::Torus { tube: 0.25 };
    let reach = 8.5_f64.sqrt();
    for (solid, low, high) in [
        (tilted(Canonical::Disc, long), [-half, -1.0, -half], [half, 1.0, half]),
        (
            tilted(Canonical::Box, long),
            [-5.0 * half, -1.0, -5.0 * half],
            [5.0 * half, 1.0, 5.0 * half],
        ),
        (tilted(Canonical::Sphere, long), [-reach, -1.0, -reach], [reach, 1.0, reach]),
        (
            tilted(Canonical::Cylinder { capped: true }, long),
            [-half, -1.0, -half],
            [5.0 * half, 1.0, 5.0 * half],
        ),
        (tilted(cone, long), [-2.0 * half, -2.0, -2.0 * half], [4.0 * half, 2.0, 4.0 * half]),
        (
            tilted(torus, DVec3::ONE),
            [-half - 0.25, -1.25, -half - 0.25],
            [half + 0.25, 1.25, half + 0.25],
        ),
    ] {
        let at = DVec3::new(5.0, -6.0, 7.0);
        for (bound, expected) in solid.bounds().into_iter().zip([low, high]) {
            let off = bound.as_dvec3() - (at + DVec3::from_array(expected));
            assert!(off.abs().max_element() < 1e-6, "{bound} of {solid:?} is {off} off");
        }
    }
}
