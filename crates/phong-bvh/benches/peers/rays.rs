//! What is asked: rays of a picture, and the rays that leave what they hit.

use glam::{DVec3, Vec3};
use phong_bvh::{Hit, Hits8, Primitives, Ray, Rays8, World, offset_origin};

use crate::scenes::Random;

/// The names of all sets of rays.
pub(crate) const NAMES: [&str; 5] = ["primary", "shadow", "ao", "bounce", "shuffled"];

/// One set of rays.
pub(crate) struct Set {
    pub(crate) name: &'static str,
    pub(crate) rays: Vec<Ray>,
    /// Whether any hit will do.
    pub(crate) any: bool,
}

/// A pinhole camera's rays for `side`² pixels, tile by tile of 8 × 8, in rows within each.
pub(crate) fn primary(geometry: &Primitives, side: u32) -> Vec<Ray> {
    let (low, high) = bounds(geometry);
    let (middle, size) = (0.5 * (low + high), (high - low).max_element());
    let eye = middle + size * Vec3::new(0.35, 0.55, 0.9);
    let forward = (middle - eye).normalize_or(Vec3::NEG_Z);
    let right = forward.cross(Vec3::Y).normalize_or(Vec3::X);
    let up = right.cross(forward);
    let pixel = |x: u32, y: u32| {
        let on_film = |k: u32| 0.9 * ((k as f32 + 0.5) / side as f32 - 0.5);
        let dir = forward + on_film(x) * right - on_film(y) * up;
        Ray::new(eye, dir.normalize_or(forward))
    };
    let tiles = side / 8;
    (0..tiles * tiles)
        .flat_map(|tile| (0..64).map(move |i| (tile % tiles * 8 + i % 8, tile / tiles * 8 + i / 8)))
        .map(|(x, y)| pixel(x, y))
        .collect()
}

/// The set `name`, from the hits of the primary rays, up to `most` rays: whole tiles, evenly spread.
pub(crate) fn set(name: &'static str, bvh: &World, seen: &[(Ray, Hit)], most: usize) -> Set {
    let mut random = Random(7);
    let (low, high) = bounds(bvh.primitives(0));
    let (middle, size) = (0.5 * (low + high), (high - low).max_element());
    let lights = [Vec3::new(0.9, 1.3, 0.4), Vec3::new(-1.2, 0.8, 0.9)].map(|l| middle + size * l);
    let a_hit = match name {
        "shadow" => lights.len(),
        "ao" => 8,
        _ => 1,
    };
    let hits = seen.iter().filter(|(_, hit)| name == "primary" || hit.is_some()).count();
    let step = (hits * a_hit).div_ceil(most).max(1);
    let mut rays = Vec::with_capacity(most);
    for tile in seen.chunks(64).step_by(step) {
        let hits: Vec<Start> = tile
            .iter()
            .filter(|(_, hit)| hit.is_some())
            .map(|s| Start::of(bvh, s, 1e-6 * size))
            .collect();
        match name {
            "primary" => rays.extend(tile.iter().map(|(ray, _)| *ray)),
            // A light at a time, so that neighbours in the set go the same way.
            "shadow" => rays.extend(
                lights.iter().flat_map(|&light| hits.iter().map(move |hit| hit.toward(light))),
            ),
            "ao" => {
                rays.extend(hits.iter().flat_map(|hit| [hit; 8]).map(|h| h.cosine(&mut random)));
            }
            _ => rays.extend(hits.iter().map(|hit| hit.cosine(&mut random))),
        }
    }
    if name == "shuffled" {
        for i in (1..rays.len()).rev() {
            rays.swap(i, random.bits() as usize % (i + 1));
        }
    }
    Set { name, rays, any: matches!(name, "shadow" | "ao") }
}

/// A point to leave from, its normal on the side it was seen from.
struct Start {
    p: DVec3,
    error: Vec3,
    n: Vec3,
    /// Embree's default mode meets again what a ray leaves (up to 4 % of those off the sticks, at
    /// `t` of 10⁻⁷; ours does not): it would be spared their way, which is what is measured.
    t_min: f32,
}

impl Start {
    fn of(bvh: &World, (ray, hit): &(Ray, Hit), t_min: f32) -> Self {
        let surface = bvh.surface(ray, hit);
        let n = if surface.ng.dot(ray.dir) > 0.0 { -surface.ng } else { surface.ng };
        Self { p: surface.p, error: surface.p_error, n, t_min }
    }

    fn leave(&self, dir: Vec3, t_max: f32) -> Ray {
        let origin = offset_origin(self.p, self.error, self.n, dir);
        Ray { origin, t_min: self.t_min, dir, t_max }
    }

    fn toward(&self, light: Vec3) -> Ray {
        let way = (light.as_dvec3() - self.p).as_vec3();
        self.leave(way.normalize_or(self.n), 0.999 * way.length())
    }

    /// Cosine-distributed about the normal: the normal plus a point of the unit sphere.
    fn cosine(&self, random: &mut Random) -> Ray {
        let dir = (self.n + random.direction()).normalize_or(self.n);
        self.leave(dir, f32::INFINITY)
    }
}

/// The closest hit of each ray, in bundles.
pub(crate) fn intersect(bvh: &World, rays: &[Ray], hits: &mut [Hit]) {
    for (rays, hits) in rays.chunks(256).zip(hits.chunks_mut(256)) {
        let rays = Rays8::of(rays);
        let mut eights = vec![Hits8::NONE; rays.len()];
        bvh.intersect_eights(&rays, &mut eights);
        for (i, hit) in hits.iter_mut().enumerate() {
            *hit = eights[i / 8].get(i % 8);
        }
    }
}

fn bounds(geometry: &Primitives) -> (Vec3, Vec3) {
    let around = |points: &mut dyn Iterator<Item = (Vec3, f32)>| {
        points.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), (p, r)| {
            (low.min(p - r), high.max(p + r))
        })
    };
    match geometry {
        Primitives::Triangles { positions, .. } => around(&mut positions.iter().map(|&p| (p, 0.0))),
        Primitives::Spheres(spheres) => around(&mut spheres.iter().map(|s| (s.center, s.radius))),
        Primitives::Cylinders { cylinders, .. } => {
            around(&mut cylinders.iter().flat_map(|c| [(c.from, c.radius), (c.to, c.radius_to)]))
        }
        Primitives::Plane(_) | Primitives::Solid(_) => (Vec3::NEG_ONE, Vec3::ONE),
    }
}
