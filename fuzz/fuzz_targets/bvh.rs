//! The hierarchy finds what brute force finds, bit for bit, at every level and preset:
//! `cargo +nightly fuzz run bvh`.
//!
//! The bytes are numbers: how many spheres and vertices, their coordinates, then rays.

#![no_main]

use glam::Vec3;
use libfuzzer_sys::fuzz_target;
use phong_bvh::{BuildOptions, Bvh, Geometry, Level, Preset, Ray, Sphere};

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

fn read(numbers: &mut Numbers<'_>) -> Option<(Vec<Geometry>, Vec<Ray>)> {
    let (spheres, vertices) = (numbers.byte()?, numbers.byte()?);
    let sphere = |numbers: &mut Numbers<'_>| {
        let (center, radius) = (numbers.point()?, numbers.number()?.abs());
        Some(Sphere { center, radius: if radius > 0.0 { radius } else { 1.0 } })
    };
    let spheres = (0..spheres).map_while(|_| sphere(numbers)).collect();
    let positions: Vec<Vec3> = (0..vertices).map_while(|_| numbers.point()).collect();
    let indices = (2..positions.len() as u32).map(|i| [i - 2, i - 1, i]).collect();
    let mut rays = Vec::new();
    while let (Some(origin), Some(dir)) = (numbers.point(), numbers.point()) {
        if let Some(dir) = dir.try_normalize() {
            rays.push(Ray::new(origin, dir));
        }
    }
    Some((vec![Geometry::Spheres(spheres), Geometry::Triangles { positions, indices }], rays))
}

fuzz_target!(|bytes: &[u8]| {
    let Some((geometry, rays)) = read(&mut Numbers(bytes)) else { return };
    for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
        for preset in [Preset::Fast, Preset::Balanced, Preset::Best, Preset::Compact] {
            let options = BuildOptions { preset, level: Some(level) };
            let bvh = Bvh::build(geometry.clone(), options).expect("few primitives, a known level");
            for ray in &rays {
                let expected = bvh.intersect_brute_force(ray);
                assert_eq!(bvh.intersect(ray), expected, "{ray:?} {options:?}");
                assert_eq!(bvh.occluded(ray), expected.is_some(), "{ray:?} {options:?}");
            }
        }
    }
});
