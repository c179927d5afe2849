//! Instances: the same bits on every road through a world, and the places and normals that f64 says.

mod random;

use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};
use phong_bvh::{
    BuildError, BuildOptions, Hit, Hits8, Level, Part, Plane, Primitives, Ray, Rays8, Sphere,
    Surfaces8, Tree, World, offset_origin,
};
use proptest::prelude::*;

use random::Random;

impl Random {
    /// In [−1, 1); now and then on a coarse lattice, so that things coincide and align.
    fn signed(&mut self) -> f64 {
        if self.bits().is_multiple_of(4) {
            self.of(&[-1.0, -0.5, 0.0, 0.5])
        } else {
            (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }

    fn direction(&mut self) -> DVec3 {
        self.point().try_normalize().unwrap_or(DVec3::Y)
    }

    /// Turned, mirrored, uneven and sheared; the product of two now and then.
    fn placement(&mut self, spread: f64) -> DAffine3 {
        let turn = DQuat::from_axis_angle(self.direction(), 3.0 * self.signed());
        let size = self.of(&[1.0, 1.0, 0.3, 1e-4, 40.0]);
        let uneven = DVec3::new(
            self.of(&[1.0, -1.0, 0.2]),
            self.of(&[1.0, 1.0, 3.0, 1e-3]),
            self.of(&[1.0, 1.0, -0.5]),
        );
        let mut matrix = DMat3::from_quat(turn) * DMat3::from_diagonal(size * uneven);
        match self.bits() % 5 {
            0 => matrix = DMat3::IDENTITY,
            1 => matrix *= DMat3::from_cols(DVec3::X, DVec3::new(0.7, 1.0, 0.0), DVec3::Z),
            2 => matrix *= DMat3::from_quat(DQuat::from_rotation_x(self.signed())),
            _ => {}
        }
        DAffine3 { matrix3: matrix, translation: spread * self.point() }
    }

    /// A few triangles or spheres of about unit size.
    fn object(&mut self) -> Primitives {
        let count = self.of(&[1, 3, 8, 60]);
        if self.bits().is_multiple_of(2) {
            let sphere = |_| Sphere {
                center: self.point().as_vec3(),
                radius: (0.01 + 0.3 * self.signed().abs()) as f32,
            };
            return Primitives::spheres((0..count).map(sphere).collect::<Vec<_>>());
        }
        let positions: Vec<Vec3> = (0..count + 2).map(|_| self.point().as_vec3()).collect();
        let indices: Vec<_> = (0..count as u32).map(|i| [i, i + 1, i + 2]).collect();
        Primitives::triangles(positions, indices)
    }

    /// Up to `most` instances of up to three objects, and other things between them.
    fn parts(&mut self, most: u64, options: BuildOptions) -> Vec<Part> {
        let trees: Vec<Arc<Tree>> = (0..3)
            .map(|_| Arc::new(Tree::build(self.object(), options).expect("few primitives")))
            .collect();
        let spread = self.of(&[0.0, 1.0, 5.0, 300.0]);
        let (count, mut parts) = (1 + self.bits() % most, Vec::new());
        for _ in 0..count {
            let tree = Arc::clone(&trees[(self.bits() % 3) as usize]);
            let to_world = self.placement(spread);
            let twice = self.bits().is_multiple_of(6);
            for _ in 0..=u64::from(twice) {
                let tree = Arc::clone(&tree);
                parts.push(Part::Instance { tree, to_world });
            }
            match self.bits() % 6 {
                0 => parts.push(Part::Own(self.object())),
                1 => {
                    let plane = Plane { point: self.point(), normal: self.direction() };
                    parts.push(Part::Own(Primitives::Plane(plane)));
                }
                _ => {}
            }
        }
        parts
    }

    /// Rays to where things may be, from near and far; a bundle of a kind, or any.
    fn rays(&mut self, parts: &[Part]) -> Vec<Ray> {
        let coherent = self.bits().is_multiple_of(2);
        let spread = if coherent { 0.01 } else { 1.0 };
        let first = self.ray(parts);
        let ray = |_| {
            if !coherent {
                return self.ray(parts);
            }
            let dir = first.dir.as_dvec3() + spread * self.point();
            Ray { dir: dir.normalize_or(DVec3::X).as_vec3(), ..first }
        };
        (0..90).map(ray).collect()
    }

    fn ray(&mut self, parts: &[Part]) -> Ray {
        let target = match &parts[(self.bits() % parts.len() as u64) as usize] {
            Part::Instance { to_world, .. } => to_world.transform_point3(self.point()),
            Part::Own(_) => self.point(),
        };
        let distance = self.of(&[0.0, 0.5, 3.0, 100.0, 1e5]);
        let dir = self.direction().as_vec3();
        let mut ray = Ray::new(target - distance * dir.as_dvec3(), dir);
        match self.bits() % 6 {
            0 => ray.t_max = distance as f32,
            1 => ray.t_min = distance as f32,
            2 => ray.t_max = 1.5 * distance as f32,
            _ => {}
        }
        ray
    }
}

fn levels() -> impl Iterator<Item = Level> {
    Level::ALL.into_iter().filter(|level| level.is_available())
}

fn world(parts: &[Part], options: BuildOptions) -> World {
    World::build(parts.to_vec(), DVec3::ZERO, options).expect("few parts that have inverses")
}

fn bits(hit: Hit) -> [u32; 5] {
    [hit.t.to_bits(), hit.part, hit.prim, hit.u.to_bits(), hit.v.to_bits()]
}

/// Every way to ask gives what brute force gives.
fn agrees(world: &World, rays: &[Ray], expected: &[Hit]) {
    let eights = Rays8::of(rays);
    let mut hits = vec![Hits8::NONE; eights.len()];
    let mut blocked = vec![0; eights.len()];
    let mut surfaces = vec![Surfaces8::default(); eights.len()];
    world.intersect_eights(&eights, &mut hits);
    world.occluded_eights(&eights, &mut blocked);
    world.surface_eights(&eights, &hits, &mut surfaces);
    let mut every = Vec::new();
    for (i, (ray, want)) in rays.iter().zip(expected).enumerate() {
        assert_eq!(bits(world.intersect(ray)), bits(*want), "{ray:?}");
        world.every(ray, &mut every);
        // Within a part distances are compared before they are rounded in the world.
        let nearest = every.iter().map(|hit| hit.t).fold(f32::INFINITY, f32::min);
        assert_eq!(nearest.to_bits(), want.t.to_bits(), "every: {ray:?}");
        let is_among = every.iter().any(|hit| bits(*hit) == bits(*want));
        assert_eq!(is_among, want.is_some(), "every: {ray:?}");
        assert_eq!(bits(hits[i / 8].get(i % 8)), bits(*want), "of eight: {ray:?}");
        assert_eq!(world.occluded(ray), want.is_some(), "occluded: {ray:?}");
        let blocked = blocked[i / 8] >> (i % 8) & 1 != 0;
        assert_eq!(blocked, want.is_some(), "occluded, of eight: {ray:?}");
        if want.is_some() {
            let (one, lane) = (world.surface(ray, want), i % 8);
            let Surfaces8 { p, p_error, ng, .. } = &surfaces[i / 8];
            for axis in 0..3 {
                let eight = (p[axis][lane], p_error[axis][lane], ng[axis][lane]);
                assert_eq!(eight, (one.p[axis], one.p_error[axis], one.ng[axis]), "{ray:?}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_world_of_instances_has_the_bits_of_brute_force(seed: u64) {
        let mut numbers = Random(seed);
        let most = numbers.of(&[4, 8, 30]);
        let parts = numbers.parts(most, BuildOptions::default());
        let rays = numbers.rays(&parts);
        let mut expected: Option<Vec<Hit>> = None;
        for level in levels() {
            let options = BuildOptions { level: Some(level), ..BuildOptions::default() };
            let world = world(&parts, options);
            let expected = expected
                .get_or_insert_with(|| rays.iter().map(|r| world.intersect_brute_force(r)).collect());
            agrees(&world, &rays, expected);
        }
    }

    #[test]
    fn few_instances_and_a_tree_over_many_have_the_same_bits(seed: u64) {
        let mut numbers = Random(seed);
        let mut parts = numbers.parts(5, BuildOptions::default());
        let rays = numbers.rays(&parts);
        let few = world(&parts, BuildOptions::default());
        let expected: Vec<Hit> = rays.iter().map(|ray| few.intersect(ray)).collect();
        // Nothing is in them, but they are more than are asked one by one.
        let empty = Primitives::spheres(vec![]);
        let tree = Arc::new(Tree::build(empty, BuildOptions::default()).expect("no primitives"));
        let nothing = Part::Instance { tree, to_world: DAffine3::IDENTITY };
        parts.extend(vec![nothing; 20]);
        agrees(&world(&parts, BuildOptions::default()), &rays, &expected);
    }

    #[test]
    fn a_triangle_of_an_instance_is_where_f64_says(seed: u64) {
        let mut numbers = Random(seed);
        let corners = [0; 3].map(|_| numbers.point().as_vec3());
        let mesh = Primitives::triangles(corners.to_vec(), vec![[0, 1, 2]]);
        let tree = Arc::new(Tree::build(mesh, BuildOptions::default()).expect("one triangle"));
        let to_world = numbers.placement(1e6);
        let parts = [Part::Instance { tree, to_world }];
        let world = world(&parts, BuildOptions::default());
        let [a, b, c] = corners.map(|v| to_world.transform_point3(v.as_dvec3()));
        let size = (b - a).length().max((c - a).length());
        let normal = (b - a).cross(c - a);
        // Well within, and no sliver.
        let u = 0.2 + 0.2 * numbers.signed().abs();
        let v = 0.2 + 0.2 * numbers.signed().abs();
        let target = a + u * (b - a) + v * (c - a);
        let distance = size * numbers.of(&[1.0, 30.0, 1e4, 1e6]);
        let dir = numbers.direction();
        let origin = target - distance * dir;
        let ray = Ray::new(origin, dir.as_vec3());
        // The direction is rounded: where the line of the ray really goes.
        let d = ray.dir.as_dvec3();
        let cos = (normal.dot(d) / normal.length()).abs();
        let sliver = normal.length() / (size * size);
        if cos > 0.2 && sliver > 0.2 {
            let t = (a - origin).dot(normal) / d.dot(normal);
            let p = origin + t * d;
            let weight = |q: DVec3, r: DVec3| (q - p).cross(r - p).dot(normal);
            let inside = [weight(a, b), weight(b, c), weight(c, a)];
            let (least, margin) = (inside.iter().copied().fold(f64::INFINITY, f64::min),
                1e-2 * normal.length_squared());
            let hit = world.intersect(&ray);
            if least > margin {
                prop_assert!(hit.is_some(), "missed at {t}");
                prop_assert!((f64::from(hit.t) - t).abs() < 2e-7 * t + 2e-3 * size, "{} {t}", hit.t);
                let surface = world.surface(&ray, &hit);
                let off = (surface.p - p).length();
                prop_assert!(off < 1e-2 * size, "{off} of {size} off");
                let off = (surface.p - a).dot(normal).abs() / normal.length();
                let bound = surface.ng.as_dvec3().abs().dot(surface.p_error.as_dvec3());
                prop_assert!(off <= bound, "{off} off the plane, over {bound}");
                // Outwards stays outwards under a mirror image.
                let want = normal / normal.length() * to_world.matrix3.determinant().signum();
                prop_assert!((surface.ng.as_dvec3() - want).length() < 1e-4);
            } else if least < -margin {
                prop_assert!(!hit.is_some(), "a hit at {}, not at {t}", hit.t);
            }
        }
    }

    #[test]
    fn a_ray_that_leaves_an_instance_does_not_meet_it_where_it_left(seed: u64) {
        let mut numbers = Random(seed);
        let sphere = numbers.bits().is_multiple_of(2);
        let object = if sphere {
            let center = numbers.point().as_vec3();
            Primitives::spheres(vec![Sphere { center, radius: 0.3 }])
        } else {
            let corners = [0; 3].map(|_| numbers.point().as_vec3());
            Primitives::triangles(corners.to_vec(), vec![[0, 1, 2]])
        };
        let tree = Arc::new(Tree::build(object, BuildOptions::default()).expect("one primitive"));
        let to_world = numbers.placement(1.0);
        let spread = numbers.of(&[0.0, 10.0, 1e4, 1e8]);
        let moved = DAffine3::from_translation(spread * numbers.point()) * to_world;
        let parts = [Part::Instance { tree, to_world: moved }];
        let world = world(&parts, BuildOptions::default());
        for _ in 0..20 {
            let ray = numbers.ray(&parts);
            let hit = world.intersect(&ray);
            if !hit.is_some() {
                continue;
            }
            let surface = world.surface(&ray, &hit);
            let side = if sphere { 1.0 } else { numbers.of(&[1.0, -1.0]) };
            let aside = numbers.direction().as_vec3();
            let dir = (side * surface.ng + 0.9 * aside).normalize_or(surface.ng);
            let origin = offset_origin(surface.p, surface.p_error, surface.ng, dir);
            let away = Ray::new(origin, dir);
            let again = world.intersect(&away);
            prop_assert!(!again.is_some(), "{ray:?} {surface:?} again at {}", again.t);
        }
    }
}

#[test]
fn of_two_instances_at_one_place_the_lower_part_is_hit() {
    let ball = Primitives::spheres(vec![Sphere { center: Vec3::ZERO, radius: 1.0 }]);
    let tree = Arc::new(Tree::build(ball.clone(), BuildOptions::default()).unwrap());
    let instance = Part::Instance { tree, to_world: DAffine3::IDENTITY };
    for count in [2, 20] {
        let mut parts = vec![instance.clone(); count];
        parts.insert(1, Part::Own(ball.clone()));
        let ray = Ray::new(Vec3::new(0.0, 0.0, 5.0), Vec3::NEG_Z);
        let world = World::build(parts, DVec3::ZERO, BuildOptions::default()).unwrap();
        let hit = world.intersect(&ray);
        assert_eq!((hit.part, hit.prim, hit.t), (0, 0, 4.0));
        let stats = world.stats();
        assert_eq!(stats.primitives, count as u64 + 1);
        assert!(stats.bytes < 40_000, "one tree for all: {stats:?}");
    }
}

#[test]
fn an_instance_that_is_not_moved_has_the_bits_of_the_primitives_themselves() {
    let mut numbers = Random(3);
    for _ in 0..200 {
        let object = numbers.object();
        let own = World::of(vec![object.clone()], BuildOptions::default()).unwrap();
        let tree = Arc::new(Tree::build(object, BuildOptions::default()).unwrap());
        let parts = [Part::Instance { tree, to_world: DAffine3::IDENTITY }];
        let placed = world(&parts, BuildOptions::default());
        for _ in 0..20 {
            let ray = numbers.ray(&parts);
            let hit = own.intersect(&ray);
            assert_eq!(bits(placed.intersect(&ray)), bits(hit));
            if hit.is_some() {
                assert_eq!(placed.surface(&ray, &hit), own.surface(&ray, &hit));
                assert_eq!(placed.coordinates(&ray, &hit), own.coordinates(&ray, &hit));
            }
        }
    }
}

#[test]
fn a_small_thing_seen_from_ten_million_away_is_where_it_is() {
    let mut numbers = Random(5);
    let sphere = Sphere { center: Vec3::new(0.25, 0.5, -0.125), radius: 0.5 };
    let (center, radius) = (sphere.center.as_dvec3(), 0.5);
    let tree = Tree::build(Primitives::spheres(vec![sphere]), BuildOptions::default()).unwrap();
    let tree = Arc::new(tree);
    let at = DVec3::new(3e6, -1e7, 2e7);
    let to_world = DAffine3::from_translation(at);
    let placed =
        World::build(vec![Part::Instance { tree, to_world }], DVec3::ZERO, BuildOptions::default());
    let worlds = [
        (
            World::of(vec![Primitives::spheres(vec![sphere])], BuildOptions::default()).unwrap(),
            DVec3::ZERO,
        ),
        (placed.unwrap(), at),
    ];
    let mut count = 0;
    for (world, at) in &worlds {
        for _ in 0..2000 {
            let center = center + *at;
            // The line that the rounded direction really has goes through the target.
            let dir = numbers.direction().as_vec3();
            let target = center + 0.6 * numbers.point();
            let origin = target - 1e7 * dir.as_dvec3();
            let ray = Ray::new(origin, dir);
            let d = dir.as_dvec3();
            let off = origin - center;
            let b = off.dot(d) / d.length_squared();
            let q = (off - b * d).length();
            let hit = world.intersect(&ray);
            assert_eq!(world.occluded(&ray), hit.is_some());
            if q < radius - 1e-5 {
                assert!(hit.is_some(), "{q} off the middle");
                let surface = world.surface(&ray, &hit);
                let along = (radius * radius - q * q).sqrt() / d.length();
                let p = origin + (-b - along) * d;
                // Where it grazes, along the ray more than aside.
                let bound = 1e-6 * radius / (1.0 - q / radius).max(1e-4);
                assert!((surface.p - p).length() < bound, "{} is not {p}", surface.p);
                count += 1;
            } else if q > radius + 1e-5 {
                assert!(!hit.is_some(), "{q} off the middle");
            }
        }
    }
    assert!(count > 800, "{count}");
}

#[test]
fn an_object_written_far_from_its_own_origin_is_met_where_it_stands() {
    let mut numbers = Random(9);
    let far = Vec3::new(524_288.0, -262_144.0, 1024.0);
    let corner = |_| (16.0 * numbers.point()).round().as_vec3() / 16.0;
    let corners: Vec<Vec3> = (0..300).map(corner).collect();
    let moved: Vec<Vec3> = corners.iter().map(|p| p + far).collect();
    let indices: Vec<[u32; 3]> = (0..100).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let placed = |positions: Vec<Vec3>, to_world: DAffine3| {
        let mesh = Primitives::triangles(positions, indices.clone());
        let tree = Arc::new(Tree::build(mesh, BuildOptions::default()).unwrap());
        world(&[Part::Instance { tree, to_world }], BuildOptions::default())
    };
    let turn = DAffine3::from_rotation_y(0.7);
    let here = placed(corners, turn);
    let there = placed(moved, turn * DAffine3::from_translation(-far.as_dvec3()));
    let mut count = 0;
    for _ in 0..2000 {
        let ray = Ray::new(3.0 * numbers.point(), numbers.direction().as_vec3());
        let (near, far) = (here.intersect(&ray), there.intersect(&ray));
        assert_eq!((near.part, near.prim), (far.part, far.prim), "{ray:?}");
        if near.is_some() {
            assert!((near.t - far.t).abs() <= 1e-5 * (1.0 + near.t), "{} {}", near.t, far.t);
            count += 1;
        }
    }
    assert!(count > 100, "{count}");
}

#[test]
fn a_transform_without_an_inverse_is_an_error() {
    let ball = Primitives::spheres(vec![Sphere { center: Vec3::ZERO, radius: 1.0 }]);
    let tree = Arc::new(Tree::build(ball, BuildOptions::default()).unwrap());
    for matrix in [DMat3::ZERO, DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0)), DMat3::NAN] {
        let to_world = DAffine3 { matrix3: matrix, translation: DVec3::ZERO };
        let parts = vec![Part::Instance { tree: Arc::clone(&tree), to_world }];
        let error = World::build(parts, DVec3::ZERO, BuildOptions::default()).unwrap_err();
        assert_eq!(error, BuildError::NoInverse(0));
    }
}

#[test]
fn a_plane_has_no_tree() {
    let plane = Plane { point: DVec3::ZERO, normal: DVec3::Y };
    let error = Tree::build(Primitives::Plane(plane), BuildOptions::default()).unwrap_err();
    assert_eq!(error, BuildError::Unbounded);
}
