use super::*;

const MIDDLE: [f32; 2] = [0.5, 0.5];

fn light(kind: LightKind) -> Light {
    let color = Rgb::grey(2.0);
    let light = phong_scene::Light { kind, color, ..phong_scene::Light::default() };
    Light::new(&light, DVec3::ZERO)
}

#[test]
fn a_distant_light_is_looked_for_against_the_way_it_travels() {
    let sun = light(LightKind::Distant { direction: DVec3::new(0.0, -3.0, 0.0), angle: 0.0 });
    let a = sun.sample(DVec3::ZERO, MIDDLE).unwrap();
    assert_eq!((a.l, a.distance, a.color), (Dir3::Y, f32::INFINITY, Rgb::grey(2.0)));
    assert_eq!(sun.sample(DVec3::splat(7.0), MIDDLE), Some(a), "the same everywhere");
}

#[test]
fn a_point_light_is_divided_by_its_attenuation() {
    let position = DVec3::new(0.0, 3.0, 0.0);
    let lamp = light(LightKind::Point { position, attenuation: [1.0, 2.0, 3.0], radius: 0.0 });
    let sample = lamp.sample(DVec3::new(0.0, 1.0, 0.0), MIDDLE).unwrap();
    assert_eq!((sample.l, sample.distance), (Dir3::Y, 2.0));
    assert_eq!(sample.color, Rgb::grey(2.0) * (1.0 / 17.0));
    assert_eq!(lamp.sample(DVec3::new(0.0, 3.0, 0.0), MIDDLE), None, "at the light itself");
}

#[test]
fn eight_points_are_reached_with_the_bits_of_one() {
    let simd = fearless_simd::Fallback::new();
    let position = DVec3::new(0.3, 2.0, -0.4);
    let attenuation = [0.5, 0.1, 0.03];
    let kinds = |size: f64| {
        [
            LightKind::Distant { direction: DVec3::new(0.2, -3.0, 1.0), angle: 9.0 * size },
            LightKind::Point { position, attenuation, radius: size },
            LightKind::Spot {
                position,
                target: DVec3::ZERO,
                cone: 20.0,
                edge: 40.0,
                attenuation,
                radius: size,
            },
            LightKind::Rectangle {
                position,
                direction: DVec3::new(0.3, -1.0, 0.2),
                up: None,
                width: 1.0 + size,
                height: 0.5,
                attenuation,
            },
            LightKind::Disc {
                position,
                direction: DVec3::new(0.3, -1.0, 0.2),
                radius: 0.4 + size,
                attenuation,
            },
            LightKind::Sphere { position, radius: 0.4 + size, attenuation },
        ]
    };
    for kind in [0.0, 0.5].into_iter().flat_map(kinds) {
        let light = light(kind);
        let x = |i: usize, k: usize| ((i * 37 + k * 61) % 83) as f32 / 41.5 - 1.0;
        // The last one is where the lamp is.
        let lamp = position.as_vec3();
        let at = |i: usize| if i == 7 { lamp } else { Vec3::new(x(i, 0), x(i, 1), x(i, 2)) };
        let p = std::array::from_fn(|k| std::array::from_fn(|i| at(i)[k].into()));
        let place = |i: usize| [0.1 * i as f32, 0.93 - 0.12 * i as f32];
        let places = [0, 1].map(|k| std::array::from_fn(|i| place(i)[k]));
        let eight = light.reach8(simd, &p, light.soft.then_some(&places));
        for i in 0..8 {
            let at = at(i);
            let l = [eight.l[0][i], eight.l[1][i], eight.l[2][i]];
            match light.reach(at.as_dvec3(), place(i)) {
                Some(one) => {
                    assert_eq!(l, one.l.to_array());
                    let eight = [eight.distance[i], eight.share[i]];
                    assert_eq!(eight, [one.distance, one.share], "{at}");
                }
                None => assert_eq!(l, [0.0; 3]),
            }
        }
    }
}

#[test]
fn a_spot_fades_from_its_cone_to_its_edge() {
    let spot = light(LightKind::Spot {
        position: DVec3::Y,
        target: DVec3::ZERO,
        cone: 20.0,
        edge: 40.0,
        attenuation: [1.0, 0.0, 0.0],
        radius: 0.0,
    });
    let at = |degrees: f64| {
        let x = wide::tan(degrees.to_radians()) as f32;
        spot.sample(DVec3::new(x.into(), 0.0, 0.0), MIDDLE).unwrap().specular_color.r
    };
    assert_eq!((at(0.0), at(19.9), at(40.1)), (1.0, 1.0, 0.0));
    // Half way between the cosines smoothstep is a half.
    let half = wide::acos(f64::midpoint(
        wide::cos(20.0_f64.to_radians()),
        wide::cos(40.0_f64.to_radians()),
    ));
    assert!((at(half.to_degrees()) - 0.5).abs() < 1e-5);
}

#[test]
fn a_soft_light_is_the_sphere_that_cannot_be_seen() {
    let (position, attenuation) = (DVec3::new(0.0, 4.0, 0.0), [1.0, 0.0, 0.0]);
    let soft = light(LightKind::Point { position, attenuation, radius: 1.0 });
    let sphere = light(LightKind::Sphere { position, attenuation, radius: 1.0 });
    assert_eq!(soft.sample(DVec3::ZERO, MIDDLE).unwrap().l, Dir3::Y);
    let rim = soft.sample(DVec3::ZERO, [0.0, 0.5]).unwrap();
    let sin = (1.0 - rim.l.dot(Dir3::Y) * rim.l.dot(Dir3::Y)).sqrt();
    assert!((sin - 0.25).abs() < 1e-6, "it is seen out to where rays touch it");
    for (at, place) in [(DVec3::ZERO, [0.2, 0.7]), (DVec3::X, [0.9, 0.4]), (position, MIDDLE)] {
        assert_eq!(soft.sample(at, place), sphere.sample(at, place));
    }
}
