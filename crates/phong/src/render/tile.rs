//! One tile: its samples in index order, and its variables from centre rays.

use glam::DVec2;
use phong_bvh::Hit;
use phong_scene::Rgb;

use super::draw::Samples;
use super::sums::{Sums, coverage};
use super::{Cancel, Cancelled, RenderOptions};
use crate::aov::Aov;
use crate::film::{LayerKind, Window};
use crate::filter::Filter;
use crate::integrator::{CameraRay, Integrator, Radiance, RayCounts};
use crate::reflectance::Terms;
use crate::sampling::Sampler;
use crate::witness::{Branch, LightTold, Witness};

/// Pixels are visited in squares of this edge within a tile: rays near one another in a bundle
/// are near one another in space.
const SQUARE: u32 = 8;

/// Pixels of a bundle of several samples each: a square's.
const LOT: usize = (SQUARE * SQUARE) as usize;

/// Samples of each pixel in a bundle.
const LOTS: u32 = 4;

/// Paints tiles.
pub(super) struct Painter<'a> {
    integrator: Integrator<'a>,
    options: &'a RenderOptions,
    layers: Vec<LayerKind>,
    filter: Filter,
}

impl<'a> Painter<'a> {
    pub(super) fn new(integrator: Integrator<'a>, options: &'a RenderOptions) -> Self {
        Self { integrator, options, layers: options.layers(), filter: Filter::new(options.filter) }
    }

    /// The values of a tile's pixels, for each layer its rows.
    pub(super) fn paint(
        &self,
        window: Window,
        counts: &mut RayCounts,
        cancel: &Cancel,
    ) -> Result<Vec<Vec<f32>>, Cancelled> {
        let pixels = pixels(window);
        let samples = self.options.samples;
        let mut out: Vec<Vec<f32>> =
            self.layers.iter().map(|kind| vec![0.0; pixels.len() * kind.channels()]).collect();
        // A bundle is about a tile's worth of rays: one sample of each pixel, or, where there are
        // more, a few of each pixel of a square.
        let (square, lot) = if samples == 1 { (pixels.len(), 1) } else { (LOT, LOTS.min(samples)) };
        let mut drawn = Samples::with_capacity(square * lot as usize);
        for pixels in pixels.chunks(square) {
            let own: Vec<Sampler> = pixels
                .iter()
                .map(|&pixel| Sampler::new(pixel, 0, samples, self.options.seed))
                .collect();
            let mut sums = vec![Sums::default(); if samples == 1 { 0 } else { pixels.len() }];
            for from in (0..samples).step_by(lot as usize) {
                if cancel.is_cancelled() {
                    return Err(Cancelled);
                }
                let indices = from..samples.min(from + lot);
                let (integrator, filter) = (&self.integrator, &self.filter);
                drawn.draw(integrator, self.options, filter, pixels, &own, indices);
                let mut brought = self.integrator.trace(&drawn.bundle, counts, &mut ());
                // Behind the rays come the samples outside the image circle: they bring nothing.
                brought.resize(drawn.numbers.len(), Radiance::default());
                for ((&number, &weight), radiance) in
                    drawn.numbers.iter().zip(&drawn.weights).zip(&brought)
                {
                    if let Some(sums) = sums.get_mut(number as usize) {
                        sums.add(radiance, weight);
                    } else {
                        // One sample, which weighs 1, is its pixel: nothing to sum.
                        let share = f32::from(u8::from(radiance.met));
                        let resolved = (&radiance.terms, coverage(share, self.options.background));
                        self.put(of_window(window, pixels[number as usize]), resolved, &mut out);
                    }
                }
            }
            for (&pixel, sums) in pixels.iter().zip(&sums) {
                let (terms, alpha) = sums.resolve(samples, self.options.background);
                self.put(of_window(window, pixel), (&terms, alpha), &mut out);
            }
        }
        if !self.options.aovs.is_empty() {
            for &pixel in &pixels {
                self.variables(pixel, of_window(window, pixel), &mut out);
            }
        }
        Ok(out)
    }

    /// Puts what a pixel is into the layers, at its place in the tile.
    #[inline]
    fn put(&self, place: usize, (terms, alpha): (&Terms, f32), out: &mut [Vec<f32>]) {
        for (kind, values) in self.layers.iter().zip(out) {
            match kind {
                LayerKind::Picture => put(values, place, terms.total().to_array()),
                LayerKind::Alpha => values[place] = alpha,
                LayerKind::Term(term) => put(values, place, terms.to_array()[*term].to_array()),
                LayerKind::Aov(_) => {}
            }
        }
    }

    /// The variables of a pixel, from the ray through its centre.
    fn variables(&self, [x, y]: [u32; 2], place: usize, out: &mut [Vec<f32>]) {
        let scene = self.integrator.scene;
        let size = self.options.size;
        let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let ray = scene.camera().ray(centre, size, [0.5; 2]);
        let (hit, cost) = ray.map_or((Hit::NONE, 0), |ray| {
            let (hit, cost) = scene.bvh().intersect_counted(&ray);
            (hit, cost.nodes)
        });
        let at = ray.filter(|_| hit.is_some()).map(|ray| scene.interaction(&ray, &hit));
        for (kind, values) in self.layers.iter().zip(out) {
            let LayerKind::Aov(aov) = kind else { continue };
            match (aov, &at) {
                (Aov::Cost, _) => values[place] = cost as f32,
                (Aov::Depth, None) => values[place] = f32::INFINITY,
                (_, None) => {}
                (Aov::Depth, Some(at)) => values[place] = at.hit.t,
                (Aov::Normal, Some(at)) => put(values, place, at.n.to_array()),
                (Aov::Position, Some(at)) => {
                    put(values, place, scene.to_world(at.p).as_vec3().to_array());
                }
                (Aov::Albedo, Some(at)) => put(values, place, at.color.to_array()),
                (Aov::Uv, Some(at)) => {
                    let uv = ray.map(|ray| scene.coordinates(&ray, &at.hit).uv);
                    put(values, place, uv.unwrap_or_default().to_array());
                }
                (Aov::Object, Some(at)) => {
                    values[place] = (scene.object(at.hit.prim) + 1) as f32;
                }
                (Aov::Material, Some(at)) => values[place] = (at.material + 1) as f32,
                (Aov::Shadow, Some(_)) => {
                    let mut seen = LightsSeen::default();
                    let sampler = Sampler::new([x, y], 0, 1, self.options.seed);
                    let camera = ray.map(|ray| CameraRay { ray, sampler, height: 0.0 }.into());
                    let first_hit = Integrator { depth: 0, ..self.integrator };
                    first_hit.trace(
                        &camera.unwrap_or_default(),
                        &mut RayCounts::default(),
                        &mut seen,
                    );
                    values[place] = seen.share();
                }
            }
        }
    }
}

/// Counts the lights seen from the surface met.
#[derive(Default)]
struct LightsSeen {
    seen: u32,
    lights: u32,
}

impl LightsSeen {
    fn share(&self) -> f32 {
        if self.lights == 0 { 0.0 } else { self.seen as f32 / self.lights as f32 }
    }
}

impl Witness for LightsSeen {
    fn missed(&mut self, _: &phong_bvh::Ray, _: Rgb) {}
    fn met(&mut self, _: &phong_bvh::Ray, _: &crate::interaction::SurfaceInteraction, _: Rgb) {}
    fn lit(&mut self, told: &LightTold) {
        self.lights += 1;
        self.seen += u32::from(told.visible);
    }
    fn entered(&mut self, _: Branch, _: Rgb, _: Option<f32>, _: &phong_bvh::Ray) {}
    fn left(&mut self, _: Branch, _: Rgb) {}
    fn cut(&mut self, _: Branch, _: Rgb, _: Option<f32>) {}
}

/// A tile's pixels in squares, so that a bundle's neighbours are neighbours.
fn pixels(window: Window) -> Vec<[u32; 2]> {
    let mut pixels = Vec::with_capacity((window.width() * window.height()) as usize);
    for y0 in (window.y0..window.y1).step_by(SQUARE as usize) {
        for x0 in (window.x0..window.x1).step_by(SQUARE as usize) {
            for y in y0..window.y1.min(y0 + SQUARE) {
                for x in x0..window.x1.min(x0 + SQUARE) {
                    pixels.push([x, y]);
                }
            }
        }
    }
    pixels
}

/// The number of a pixel within a tile's rows.
fn of_window(window: Window, [x, y]: [u32; 2]) -> usize {
    (y - window.y0) as usize * window.width() as usize + (x - window.x0) as usize
}

fn put<const N: usize>(values: &mut [f32], place: usize, value: [f32; N]) {
    values[place * N..][..N].copy_from_slice(&value);
}
