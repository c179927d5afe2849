//! The hierarchy finds what brute force finds, bit for bit: every level, every preset, every thread
//! count, and whatever the input.

mod random;

use glam::{DAffine3, DVec3, Vec3};
use phong_bvh::{
    BuildOptions, Canonical, Caps, Cylinder, Hit, Hits8, Level, Plane, Preset, Primitives, Ray,
    Rays8, Solid, Sphere, World,
};
use proptest::prelude::*;

use random::Random;

impl Random {
    fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// In [−1, 1); now and then on a coarse lattice, so that things coincide and align.
    fn signed(&mut self) -> f32 {
        if self.below(3) == 0 {
            self.below(5) as f32 / 2.0 - 1.0
        } else {
            (self.bits() >> 40) as f32 / 8_388_608.0 - 1.0
        }
    }

    fn point(&mut self) -> Vec3 {
        Vec3::new(self.signed(), self.signed(), self.signed())
    }

    /// A factor, from tiny to huge.
    fn scale(&mut self) -> f32 {
        self.of(&[1e-6, 1e-3, 0.1, 1.0, 1.0, 30.0, 1e4, 1e9])
    }
}

/// A cylinder: often with one radius, along an axis, without length, or long and thin.
fn cylinder(numbers: &mut Random, scale: f32, from: Vec3) -> Cylinder {
    let away = match numbers.below(4) {
        0 => Vec3::new(0.0, numbers.signed(), 0.0),
        1 => [Vec3::ZERO, Vec3::X, Vec3::NEG_Z][numbers.below(3)],
        _ => numbers.point(),
    };
    let thick = [1e-4, 0.01, 0.3, 2.0][numbers.below(4)];
    let radius = scale * thick * (0.01 + numbers.signed().abs());
    let radius_to = radius * [1.0, 1.0, 0.5, 4.0][numbers.below(4)];
    Cylinder { from, radius, to: from + scale * away, radius_to }
}

/// Some triangles, spheres, cylinders, planes and solids: many coincide, are flat, thin, huge or tiny.
fn geometry(numbers: &mut Random, most: usize) -> Vec<Primitives> {
    let mut all = Vec::new();
    for _ in 0..numbers.below(4) {
        let (scale, at) = (numbers.scale(), numbers.point());
        let size = numbers.scale().min(1.0);
        let count = numbers.below(most);
        all.push(match numbers.below(11) {
            8..=10 => {
                let caps = [Caps::Round, Caps::Round, Caps::Flat, Caps::Open][numbers.below(4)];
                let one_radius = numbers.below(2) == 0;
                let cylinders = (0..count).map(|_| {
                    let from = scale * (at + size * numbers.point());
                    let cylinder = cylinder(numbers, scale * size, from);
                    let same = Cylinder { radius_to: cylinder.radius, ..cylinder };
                    if one_radius { same } else { cylinder }
                });
                Primitives::cylinders(cylinders.collect::<Vec<_>>(), caps)
            }
            0..=3 => {
                let vertices = 3 + count / 2;
                let positions = (0..vertices).map(|_| scale * (at + size * numbers.point()));
                let positions: Vec<_> = positions.collect();
                let indices: Vec<_> = (0..count)
                    .map(|_| [0; 3].map(|_: u32| numbers.below(vertices) as u32))
                    .collect();
                Primitives::triangles(positions, indices)
            }
            4 | 5 => Primitives::spheres(
                (0..count)
                    .map(|_| Sphere {
                        center: scale * (at + size * numbers.point()),
                        radius: scale * size * (0.01 + numbers.signed().abs()),
                    })
                    .collect::<Vec<_>>(),
            ),
            6 => Primitives::Plane(Plane {
                point: numbers.point().as_dvec3(),
                normal: [DVec3::X, DVec3::Y, DVec3::new(0.6, 0.0, 0.8)][numbers.below(3)],
            }),
            _ => Primitives::Solid(Solid {
                shape: [
                    Canonical::Sphere,
                    Canonical::Disc,
                    Canonical::Box,
                    Canonical::Cylinder { capped: true },
                    Canonical::Cone { radius: 1.0, radius_to: 0.0, capped: false },
                    Canonical::Torus { tube: 0.25 },
                ][numbers.below(6)],
                to_world: DAffine3::from_scale_rotation_translation(
                    DVec3::splat(0.5),
                    glam::DQuat::from_rotation_x(f64::from(numbers.signed())),
                    numbers.point().as_dvec3(),
                ),
            }),
        });
    }
    all
}

/// A ray towards a corner, a middle or nothing in particular; often along an axis or within a plane.
fn ray(numbers: &mut Random, geometry: &[Primitives]) -> Ray {
    let target = match geometry.get(numbers.below(geometry.len() + 1)) {
        Some(Primitives::Triangles { positions, indices }) if !indices.is_empty() => {
            let [a, b, c] = indices[numbers.below(indices.len())].map(|i| positions[i as usize]);
            [a, (a + b) / 2.0, a.lerp(b, 0.25), (a + b + c) / 3.0][numbers.below(4)]
        }
        Some(Primitives::Spheres(spheres)) if !spheres.is_empty() => {
            let sphere = spheres.get(numbers.below(spheres.len()));
            sphere.center + sphere.radius * [Vec3::ZERO, Vec3::Y, numbers.point()][numbers.below(3)]
        }
        Some(Primitives::Cylinders { cylinders, .. }) if !cylinders.is_empty() => {
            let Cylinder { from, radius, to, .. } = cylinders[numbers.below(cylinders.len())];
            let axis = from.lerp(to, [0.0, 1.0, 0.5, 1.0 + numbers.signed()][numbers.below(4)]);
            axis + radius * [Vec3::ZERO, Vec3::Y, numbers.point()][numbers.below(3)]
        }
        _ => numbers.point(),
    };
    let axis = [Vec3::X, Vec3::NEG_Y, Vec3::Z, Vec3::new(-0.0, 1.0, 0.0)][numbers.below(4)];
    let away = match numbers.below(4) {
        0 => axis,
        1 => Vec3::new(numbers.signed(), numbers.signed(), 0.0),
        _ => numbers.point(),
    };
    let mut dir = away.try_normalize().unwrap_or(Vec3::X);
    if numbers.below(20) == 0 {
        dir = Vec3::new(f32::MIN_POSITIVE / 4.0, 0.6, -0.8);
    }
    let distance = [0.0, 1e-3, 1.0, 3.0, 1000.0][numbers.below(5)] * numbers.scale().max(1.0);
    let mut ray = Ray::new(target - distance * dir, dir);
    match numbers.below(6) {
        0 => ray.t_max = distance,
        1 => ray.t_min = distance,
        2 => ray.t_max = distance * 1.5,
        _ => {}
    }
    ray
}

fn bits(hit: Hit) -> [u32; 5] {
    [hit.t.to_bits(), hit.part, hit.prim, hit.u.to_bits(), hit.v.to_bits()]
}

fn levels() -> impl Iterator<Item = Level> {
    Level::ALL.into_iter().filter(|level| level.is_available())
}

const PRESETS: [Preset; 4] = [Preset::Fast, Preset::Balanced, Preset::Best, Preset::Compact];

fn agrees_with_brute_force(geometry: &[Primitives], rays: &[Ray]) {
    let mut expected: Option<Vec<Hit>> = None;
    for (level, preset) in levels()
        .zip(PRESETS.iter().cycle())
        .chain(PRESETS.iter().map(|preset| (Level::detect(), preset)))
    {
        let options = BuildOptions { preset: *preset, level: Some(level) };
        let bvh = World::of(geometry.to_vec(), options).expect("a tree");
        let expected = expected
            .get_or_insert_with(|| rays.iter().map(|r| bvh.intersect_brute_force(r)).collect());
        let mut eights = Rays8::of(rays);
        // A gap in each, with numbers that nothing may come of.
        for rays in &mut eights {
            rays.there &= !0b100;
            (rays.t_min[2], rays.t_max[2]) = (f32::NEG_INFINITY, f32::NAN);
            (rays.origin[1][2], rays.dir[0][2]) = (f64::NAN, f32::INFINITY);
        }
        let mut hits8 = vec![Hits8::NONE; eights.len()];
        let mut blocked8 = vec![0; eights.len()];
        bvh.intersect_eights(&eights, &mut hits8);
        bvh.occluded_eights(&eights, &mut blocked8);
        let mut scattered = vec![0; eights.len()];
        bvh.occluded_scattered(&eights, &mut scattered);
        assert_eq!(scattered, blocked8, "occluded scattered: {options:?}");
        for (i, (ray, want)) in rays.iter().zip(expected).enumerate() {
            let one = bvh.intersect(ray);
            assert_eq!(bits(one), bits(*want), "{ray:?} {one:?} {want:?} {options:?}");
            assert_eq!(bits(bvh.intersect_counted(ray).0), bits(*want), "counted");
            assert_eq!(bvh.occluded(ray), want.is_some(), "occluded: {ray:?} {options:?}");
            let want = if i % 8 == 2 { Hit::NONE } else { *want };
            assert_eq!(bits(hits8[i / 8].get(i % 8)), bits(want), "eights: {ray:?} {options:?}");
            let blocked = blocked8[i / 8] >> (i % 8) & 1 != 0;
            assert_eq!(blocked, want.is_some(), "occluded eights: {ray:?} {options:?}");
        }
    }
}

/// Other cases in every run; unoptimized, eight times fewer, since kernels are slow there.
const CASES: u32 = if cfg!(debug_assertions) { 50 } else { 400 };

proptest! {
    #![proptest_config(ProptestConfig::with_cases(CASES))]

    #[test]
    fn a_handful_of_spheres_loses_no_ray_that_grazes_them(seed: u64) {
        let mut numbers = Random(seed);
        let scale = numbers.scale();
        let spheres: Vec<Sphere> = (0..=numbers.below(8))
            .map(|_| Sphere {
                center: scale * numbers.point(),
                radius: scale * 0.3 * numbers.signed().abs().max(1e-3),
            })
            .collect();
        // Together, as a camera's or a light's rays are, at rims.
        let (eye, spread) = (3.0 * scale * numbers.point(), [0.0, 0.01, 1.0][numbers.below(3)]);
        let rays: Vec<Ray> = (0..150)
            .map(|i| {
                let Sphere { center, radius } = spheres[i / 40 % spheres.len()];
                let origin = eye + spread * scale * numbers.point();
                let around = numbers.point().cross(center - origin).normalize_or(Vec3::X);
                let rim = center + radius * (1.0 - 1e-3 * numbers.signed()) * around;
                Ray::new(origin, (rim - origin).try_normalize().unwrap_or(Vec3::X))
            })
            .collect();
        agrees_with_brute_force(&[Primitives::spheres(spheres)], &rays);
    }

    #[test]
    fn the_hierarchy_finds_what_brute_force_finds(seed: u64) {
        let mut numbers = Random(seed);
        let geometry = geometry(&mut numbers, 120);
        let rays: Vec<Ray> = (0..70).map(|_| ray(&mut numbers, &geometry)).collect();
        agrees_with_brute_force(&geometry, &rays);
    }

    #[test]
    fn cylinders_alone_are_found_as_brute_force_finds_them(seed: u64) {
        let mut numbers = Random(seed);
        let (scale, size) = (numbers.scale(), numbers.scale().min(1.0));
        let caps = [Caps::Round, Caps::Round, Caps::Flat, Caps::Open][numbers.below(4)];
        let cylinders = (0..=numbers.below(200)).map(|_| {
            let from = scale * numbers.point();
            cylinder(&mut numbers, scale * size, from)
        });
        let geometry = [Primitives::cylinders(cylinders.collect::<Vec<_>>(), caps)];
        let mut rays: Vec<Ray> = (0..70).map(|_| ray(&mut numbers, &geometry)).collect();
        // Along the axes and beside them by little.
        if let [Primitives::Cylinders { cylinders, .. }] = &geometry {
            rays.extend((0..40).map(|i| {
                let Cylinder { from, radius, to, .. } = cylinders[i % cylinders.len()];
                let along = (to - from).normalize_or(Vec3::X);
                let aside = [0.0, 1e-4, 0.03][numbers.below(3)] * numbers.point();
                let dir = (along + aside).normalize_or(Vec3::X);
                let beside = radius * 1.2 * numbers.signed() * numbers.point().cross(along);
                Ray::new(from.lerp(to, 0.5) + beside - dir * scale * numbers.scale(), dir)
            }));
        }
        agrees_with_brute_force(&geometry, &rays);
    }

    #[test]
    fn a_coherent_bundle_among_cylinders_finds_what_brute_force_finds(seed: u64) {
        let mut numbers = Random(seed);
        let (scale, size) = (numbers.scale(), numbers.scale().min(1.0));
        let caps = [Caps::Round, Caps::Round, Caps::Flat, Caps::Open][numbers.below(4)];
        let tapered = numbers.below(2) == 0;
        let cylinders: Vec<Cylinder> = (0..=numbers.below(200))
            .map(|_| {
                let from = scale * numbers.point();
                let cylinder = cylinder(&mut numbers, scale * size, from);
                let radius_to = if tapered { cylinder.radius_to } else { cylinder.radius };
                Cylinder { radius_to, ..cylinder }
            })
            .collect();
        // As a camera's rays are: to one of them and around it, some at its rim.
        let away = [0.0, 3.0, 300.0][numbers.below(3)];
        let (eye, spread) = (away * scale * numbers.point(), [0.0, 1e-3, 0.02][numbers.below(3)]);
        let aim = cylinders[numbers.below(cylinders.len())];
        let straight = (aim.from.lerp(aim.to, 0.5) - eye).normalize_or(Vec3::X);
        let rays: Vec<Ray> = (0..192)
            .map(|i| {
                let Cylinder { from, radius, to, .. } = cylinders[i % cylinders.len()];
                let at = from.lerp(to, 0.5 + 0.6 * numbers.signed());
                let rim = (at - eye).cross(to - from).normalize_or(Vec3::Y);
                let rim = at + radius * (1.0 - 1e-3 * numbers.signed()) * rim;
                let to_rim = (rim - eye).normalize_or(straight);
                let near = to_rim.abs_diff_eq(straight, 0.04) && i % 3 == 0;
                let dir = if near { to_rim } else { straight + spread * numbers.point() };
                Ray::new(eye, dir.normalize_or(straight))
            })
            .collect();
        agrees_with_brute_force(&[Primitives::cylinders(cylinders, caps)], &rays);
    }

    #[test]
    fn rays_that_go_everywhere_among_spheres_find_what_brute_force_finds(seed: u64) {
        let mut numbers = Random(seed);
        let (scale, size) = (numbers.scale(), [0.02, 0.1, 0.4][numbers.below(3)]);
        let spheres: Vec<Sphere> = (0..=numbers.below(300))
            .map(|_| Sphere {
                center: scale * numbers.point(),
                radius: scale * size * (0.01 + numbers.signed().abs()),
            })
            .collect();
        // From about one point to all sides or to some, a third of them to rims.
        let start = [0.5, 1.0, 2.0, 500.0][numbers.below(4)] * scale * numbers.point();
        let (apart, spread) = ([0.0, 0.01, 0.3][numbers.below(3)], [0.1, 1.0, 5.0][numbers.below(3)]);
        let ahead = if numbers.below(2) == 0 { -start } else { numbers.point() };
        let ahead = ahead.normalize_or(Vec3::NEG_Y);
        let t_max = [f32::INFINITY, f32::INFINITY, 0.7 * scale][numbers.below(3)];
        let rays: Vec<Ray> = (0..600)
            .map(|i| {
                let origin = start + apart * scale * numbers.point();
                let Sphere { center, radius } = spheres[i / 3 % spheres.len()];
                let around = numbers.point().cross(center - origin).normalize_or(Vec3::X);
                let rim = center + radius * (1.0 - 1e-3 * numbers.signed()) * around;
                let away = if i % 3 == 0 { rim - origin } else { ahead + spread * numbers.point() };
                Ray { t_max, ..Ray::new(origin, away.try_normalize().unwrap_or(Vec3::X)) }
            })
            .collect();
        agrees_with_brute_force(&[Primitives::spheres(spheres)], &rays);
    }

    #[test]
    fn a_coherent_bundle_finds_what_brute_force_finds(seed: u64) {
        let mut numbers = Random(seed);
        let geometry = geometry(&mut numbers, 400);
        let (first, spread) = (ray(&mut numbers, &geometry), numbers.scale().min(0.3));
        let same_origin = numbers.below(2) == 0;
        let rays: Vec<Ray> = (0..256).map(|_| {
            let dir = (first.dir + spread * numbers.point()).try_normalize().unwrap_or(Vec3::Y);
            let away = (spread * numbers.point()).as_dvec3();
            let origin = if same_origin { first.origin } else { first.origin + away };
            Ray { origin, dir, ..first }
        }).collect();
        agrees_with_brute_force(&geometry, &rays);
    }

    #[test]
    fn rays_that_meet_at_a_light_find_what_brute_force_finds(seed: u64) {
        let mut numbers = Random(seed);
        let geometry = geometry(&mut numbers, 400);
        let (first, spread) = (ray(&mut numbers, &geometry), numbers.scale().min(0.05));
        let length = [0.5, 3.0, 200.0][numbers.below(3)];
        let light = first.at(length);
        let rays: Vec<Ray> = (0..200).map(|_| {
            let origin = first.origin + (length * spread * numbers.point()).as_dvec3();
            let (dir, length) = (light - origin).as_vec3().normalize_and_length();
            let dir = if length > 0.0 { dir } else { first.dir };
            Ray { t_max: length * 0.999, ..Ray::new(origin, dir) }
        }).collect();
        agrees_with_brute_force(&geometry, &rays);
    }
}

#[test]
fn nothing_is_hit_where_there_is_nothing() {
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    let flat = Primitives::triangles(vec![Vec3::X; 3], vec![[0, 1, 2]; 40]);
    for geometry in [
        vec![],
        vec![Primitives::spheres(vec![])],
        vec![Primitives::triangles(vec![], vec![])],
        vec![flat],
    ] {
        let bvh = World::of(geometry, BuildOptions::default()).unwrap();
        assert_eq!(bvh.intersect(&ray), Hit::NONE);
        assert!(!bvh.occluded(&ray));
    }
}

#[test]
fn of_thousands_of_coincident_primitives_the_lowest_number_is_hit() {
    let corners =
        vec![Vec3::new(-1.0, -1.0, 2.0), Vec3::new(1.0, -1.0, 2.0), Vec3::new(0.0, 1.0, 2.0)];
    let indices = vec![[0, 1, 2]; 20_000];
    let spheres = vec![Sphere { center: Vec3::new(0.0, 0.0, 3.0), radius: 1.0 }; 20_000];
    let geometry = vec![Primitives::spheres(spheres), Primitives::triangles(corners, indices)];
    let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    for preset in PRESETS {
        let bvh = World::of(geometry.clone(), BuildOptions { preset, level: None }).unwrap();
        let hit = bvh.intersect(&ray);
        assert_eq!((hit.t, hit.prim), (2.0, 0), "sphere and triangle at one distance");
        assert!(bvh.occluded(&ray));
    }
}

#[test]
fn a_thousand_sizes_from_tiny_to_huge_make_no_tree_too_deep() {
    let sphere = |i: i32| {
        let size = libm::exp2f(i as f32 * 0.14 - 50.0);
        Sphere { center: Vec3::new(size, 0.0, size), radius: 0.4 * size }
    };
    let geometry = vec![Primitives::spheres((0..700).map(sphere).collect::<Vec<_>>())];
    let rays: Vec<Ray> = (0..700)
        .map(|i| {
            let Sphere { center, radius } = sphere(i);
            Ray::new(center - 3.0 * radius * Vec3::Y, Vec3::Y)
        })
        .collect();
    agrees_with_brute_force(&geometry, &rays);
}

#[test]
fn a_tree_does_not_depend_on_the_number_of_threads() {
    let mut numbers = Random(7);
    let center = |numbers: &mut Random| 100.0 * numbers.point();
    let spheres: Vec<Sphere> =
        (0..60_000).map(|_| Sphere { center: center(&mut numbers), radius: 0.5 }).collect();
    let rays: Vec<Ray> = (0..300)
        .map(|_| Ray::new(center(&mut numbers), numbers.point().try_normalize().unwrap_or(Vec3::X)))
        .collect();
    let costs = [1, 2, 7].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let geometry = vec![Primitives::spheres(spheres.clone())];
        let bvh = pool.install(|| World::of(geometry, BuildOptions::default())).unwrap();
        let counted: Vec<_> = rays.iter().map(|ray| bvh.intersect_counted(ray)).collect();
        (bvh.stats(), counted)
    });
    assert!(costs.iter().all(|cost| *cost == costs[0]));
}

#[test]
fn a_hundred_thousand_primitives_in_order_are_all_found() {
    // Heaps of as many boxes as one thread parts, here and there, as the pieces of a mesh may be.
    let place = |i: usize| {
        let (heap, within) = (i >> 14, i & 0x3fff);
        let (row, column) = (within >> 7, within & 0x7f);
        Vec3::new((heap * 3 % 8) as f32 + row as f32 * 0.007, column as f32 * 0.01, 0.0)
    };
    let count = 120_000;
    let spheres: Vec<_> = (0..count).map(|i| Sphere { center: place(i), radius: 0.004 }).collect();
    let geometry = vec![Primitives::spheres(spheres)];
    for preset in [Preset::Fast, Preset::Balanced] {
        let options = BuildOptions { preset, level: None };
        let bvh = World::of(geometry.clone(), options).expect("few primitives");
        for i in 0..count {
            let ray = Ray::new(place(i) + Vec3::Z, Vec3::NEG_Z);
            assert_eq!(bvh.intersect(&ray).prim, i as u32, "{preset:?}");
        }
    }
}

#[test]
fn no_ray_slips_between_the_triangles_of_a_closed_mesh() {
    // An octahedron, split four times: rays from within towards corners, edges and middles.
    let mut triangles = Vec::new();
    for s in 0..8 {
        let sign = |bit: u32| if s >> bit & 1 == 0 { 1.0 } else { -1.0 };
        triangles.push([Vec3::X * sign(0), Vec3::Y * sign(1), Vec3::Z * sign(2)]);
    }
    for _ in 0..4 {
        let split = |[a, b, c]: [Vec3; 3]| {
            let [d, e, f] = [(a, b), (b, c), (c, a)].map(|(p, q)| ((p + q) * 0.7).normalize_or(p));
            [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
        };
        triangles = triangles.into_iter().flat_map(split).collect();
    }
    let positions: Vec<Vec3> = triangles.iter().flatten().copied().collect();
    let indices: Vec<[u32; 3]> =
        (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let bvh = World::of(vec![Primitives::triangles(positions, indices)], BuildOptions::default())
        .unwrap();
    for origin in [Vec3::ZERO, Vec3::new(0.1, 0.2, -0.3), Vec3::new(0.0, 0.5, 0.0)] {
        for [a, b, c] in &triangles {
            for target in [*a, (a + b) / 2.0, a.lerp(*c, 0.3), (b + c) / 2.0, (a + b + c) / 3.0] {
                let dir = (target - origin).normalize_or(Vec3::X);
                assert!(bvh.intersect(&Ray::new(origin, dir)).is_some(), "{origin} {target}");
            }
        }
    }
}

#[test]
fn few_rays_ask_for_a_tree_that_is_soon_built_and_many_for_a_better_one() {
    assert_eq!(Preset::for_rays(0, 0), Preset::Balanced, "nothing to build");
    assert_eq!(Preset::for_rays(1000, 0), Preset::Fast);
    assert_eq!(Preset::for_rays(1000, 1999), Preset::Fast);
    assert_eq!(Preset::for_rays(1000, 2000), Preset::Balanced);
    assert_eq!(Preset::for_rays(u64::MAX, u64::MAX), Preset::Fast, "no overflow");
}

#[test]
fn a_level_this_machine_lacks_is_an_error() {
    let missing = Level::ALL.into_iter().find(|level| !level.is_available()).unwrap();
    let options = BuildOptions { level: Some(missing), ..BuildOptions::default() };
    let error = World::of(vec![], options).unwrap_err();
    assert!(error.to_string().contains("leave the level"), "{error}");
}
