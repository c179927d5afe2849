//! The hierarchy finds what brute force finds, bit for bit, one ray at a time and in bundles, at
//! every level and preset:
//! `cargo +nightly fuzz run bvh`.
//!
//! The bytes are numbers: how many spheres and vertices, how often they are repeated, their
//! coordinates, then rays.

#![no_main]

use glam::Vec3;
use libfuzzer_sys::fuzz_target;
use phong_bvh::{BuildOptions, World, Primitives, Hits8, Level, Preset, Ray, Rays8, Sphere};

const PRESETS: &[Preset] = &[Preset::Fast, Preset::Balanced, Preset::Best, Preset::Compact];

/// Numbers out of bytes: finite, and of a size whose squares f32 can hold.
struct Numbers<'a>(&'a [u8]);

impl Numbers<'_> {
    fn byte(&mut self) -> Option<u8> {
        let (&first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(first)
    }

    fn number(&mut self) -> Option<f32> {
        let (bytes, rest) = self.0.split_first_chunk::<4>()?;
        self.0 = rest;
        let x = f32::from_le_bytes(*bytes);
        let fits = x == 0.0 || (1e-12..=1e12).contains(&x.abs());
        Some(if fits { x } else { f32::from(bytes[0]) - 128.0 })
    }

    fn point(&mut self) -> Option<Vec3> {
        Some(Vec3::new(self.number()?, self.number()?, self.number()?))
    }
}

/// The same again and again, each time moved by another multiple of `step`, until there are `most`
/// primitives: few bytes make what all threads partition, which begins at 16,385. A multiple comes
/// up more than once, and the multiples are in no order.
fn repeat(shapes: &mut (Vec<Sphere>, Vec<Vec3>), step: Vec3, most: usize) {
    let (spheres, corners) = (shapes.0.len(), shapes.1.len());
    let copies = most / (spheres + corners).max(1);
    for copy in 1..copies {
        let moved = step * (copy * 7919 % 1021) as f32;
        for i in 0..spheres {
            let Sphere { center, radius } = shapes.0[i];
            shapes.0.push(Sphere { center: center + moved, radius });
        }
        for i in 0..corners {
            shapes.1.push(shapes.1[i] + moved);
        }
    }
}

fn read(numbers: &mut Numbers<'_>) -> Option<(Vec<Primitives>, Vec<Ray>, &'static [Preset])> {
    let (spheres, vertices, repeated) = (numbers.byte()?, numbers.byte()?, numbers.byte()?);
    let large = repeated >= 240;
    let most = if large { 128 * usize::from(numbers.byte()?) } else { 0 };
    let step = if large { numbers.point()? } else { Vec3::ZERO };
    let sphere = |numbers: &mut Numbers<'_>| {
        let (center, radius) = (numbers.point()?, numbers.number()?.abs());
        Some(Sphere { center, radius: if radius > 0.0 { radius } else { 1.0 } })
    };
    let spheres = (0..spheres).map_while(|_| sphere(numbers)).collect();
    let mut shapes = (spheres, (0..vertices).map_while(|_| numbers.point()).collect());
    repeat(&mut shapes, step, most);
    let (spheres, positions) = shapes;
    let indices: Vec<_> = (2..positions.len() as u32).map(|i| [i - 2, i - 1, i]).collect();
    let mut rays = Vec::new();
    while let (Some(origin), Some(dir)) = (numbers.point(), numbers.point()) {
        if let Some(dir) = dir.try_normalize() {
            rays.push(Ray::new(origin, dir));
        }
    }
    let mut presets = PRESETS;
    if large {
        // What is large takes a second as it is: each ray meets all primitives one by one.
        rays.truncate(32);
        presets = std::slice::from_ref(&PRESETS[usize::from(repeated) % PRESETS.len()]);
    }
    let geometry = vec![Primitives::spheres(spheres), Primitives::triangles(positions, indices)];
    Some((geometry, rays, presets))
}

fuzz_target!(|bytes: &[u8]| {
    let Some((geometry, rays, presets)) = read(&mut Numbers(bytes)) else { return };
    let mut expected = Vec::new();
    let eights = Rays8::of(&rays);
    let mut hits8 = vec![Hits8::NONE; eights.len()];
    let mut blocked8 = vec![0; eights.len()];
    for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
        for &preset in presets {
            let options = BuildOptions { preset, level: Some(level) };
            let bvh = World::of(geometry.clone(), options).expect("few primitives, a known level");
            if expected.is_empty() {
                expected = rays.iter().map(|ray| bvh.intersect_brute_force(ray)).collect();
            }
            bvh.intersect_eights(&eights, &mut hits8);
            bvh.occluded_eights(&eights, &mut blocked8);
            for (i, ray) in rays.iter().enumerate() {
                let expected = expected[i];
                assert_eq!(bvh.intersect(ray), expected, "{ray:?} {options:?}");
                assert_eq!(bvh.occluded(ray), expected.is_some(), "{ray:?} {options:?}");
                assert_eq!(hits8[i / 8].get(i % 8), expected, "{ray:?} of eight, {options:?}");
                let blocked = blocked8[i / 8] >> (i % 8) & 1 != 0;
                assert_eq!(blocked, expected.is_some(), "{ray:?} of eight, {options:?}");
            }
        }
    }
});
