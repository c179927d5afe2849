//! How fast rays are traced.

use std::hint::black_box;
use std::time::Instant;

use glam::DVec2;
use phong::film::{Film, Window};
use phong::render::RenderOptions;
use phong::view::View;
use phong_bvh::{Hits8, Ray, Rays8, lanes};
use rayon::prelude::*;

/// How long it took to trace so many rays, in the current rayon pool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaySpeed {
    /// How many rays there are; 0 where nothing sends any.
    pub rays: u64,
    /// The shortest time they took, in seconds.
    pub seconds: f64,
}

impl RaySpeed {
    /// Rays per second.
    pub fn per_second(&self) -> f64 {
        self.rays as f64 / self.seconds
    }
}

/// How fast the rays of a picture with one sample a pixel are traced, by what they are for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speeds {
    /// From the camera through the middle of every pixel.
    pub primary: RaySpeed,
    /// From where those meet a surface to every light.
    pub shadow: RaySpeed,
    /// From there on as off a mirror.
    pub secondary: RaySpeed,
}

impl Speeds {
    /// Those of a picture of `size`. Takes three seconds or a little more.
    pub fn of(view: &View, size: [u32; 2]) -> Self {
        let bundles = Bundles::of(view, size);
        Self {
            primary: best(&bundles.primary, |rays| closest(view, rays)),
            shadow: best(&bundles.shadow, |rays| any(view, rays)),
            secondary: best(&bundles.secondary, |rays| closest(view, rays)),
        }
    }
}

/// Rays that are traced together, by tile.
#[derive(Debug, Default)]
struct Bundles {
    /// Through the middle of every pixel.
    primary: Vec<Vec<Rays8>>,
    /// From where those meet a surface to every light.
    shadow: Vec<Vec<Rays8>>,
    /// From there on as off a mirror.
    secondary: Vec<Vec<Rays8>>,
}

impl Bundles {
    fn of(scene: &View, size: [u32; 2]) -> Self {
        let film = Film::new(size, Window::full(size), RenderOptions::TILE, &[]);
        let mut bundles = Self::default();
        for tile in 0..film.tiles() {
            let Window { x0, y0, x1, y1 } = film.tile_window(tile);
            let pixels = (y0..y1).flat_map(|y| (x0..x1).map(move |x| (x, y)));
            let rays: Vec<Ray> = pixels
                .filter_map(|(x, y)| {
                    let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                    scene.camera().ray(middle, size, [0.5; 2])
                })
                .collect();
            let rays = Rays8::of(&rays);
            let mut hits = vec![Hits8::NONE; rays.len()];
            scene.world().intersect_eights(&rays, &mut hits);
            let met: Vec<_> = rays
                .iter()
                .zip(&hits)
                .flat_map(|(rays, hits)| lanes(hits.met).map(|i| (rays.get(i), hits.get(i))))
                .map(|(ray, hit)| scene.interaction(&ray, &hit))
                .collect();
            for light in scene.lights() {
                let shadow = met.iter().filter_map(|at| {
                    let sample = light.sample(at.p, [0.5; 2])?;
                    (sample.l.dot(at.facing_ng()) > 0.0)
                        .then(|| at.spawn(sample.l, sample.distance))
                });
                bundles.shadow.push(Rays8::of(&shadow.collect::<Vec<_>>()));
            }
            let mirror = met.iter().map(|at| at.spawn(at.n.mirror(at.e), f32::INFINITY));
            bundles.secondary.push(Rays8::of(&mirror.collect::<Vec<_>>()));
            bundles.primary.push(rays);
        }
        bundles
    }
}

/// The shortest of as many runs over all bundles as fit into a second, three at least.
fn best(bundles: &[Vec<Rays8>], trace: impl Fn(&[Rays8]) + Sync) -> RaySpeed {
    let rays = bundles.iter().flatten().map(|rays| u64::from(rays.there.count_ones())).sum();
    let begun = Instant::now();
    let mut seconds = f64::INFINITY;
    let mut runs = 0;
    while runs < 3 || begun.elapsed().as_secs_f64() < 1.0 {
        let run = Instant::now();
        bundles.par_iter().for_each(|rays| trace(rays));
        seconds = seconds.min(run.elapsed().as_secs_f64());
        runs += 1;
    }
    RaySpeed { rays, seconds }
}

fn closest(scene: &View, rays: &[Rays8]) {
    let mut hits = vec![Hits8::NONE; rays.len()];
    scene.world().intersect_eights(rays, &mut hits);
    black_box(hits);
}

fn any(scene: &View, rays: &[Rays8]) {
    let mut blocked = vec![0; rays.len()];
    scene.world().occluded_eights(rays, &mut blocked);
    black_box(blocked);
}
