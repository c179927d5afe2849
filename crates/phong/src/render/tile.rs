//! One tile: its samples in index order, and its variables from centre rays.

use fearless_simd::Simd;
use glam::DVec2;
use phong_bvh::{Hit, Kernel};
use phong_scene::Rgb;

use super::draw::{Pixels8, Samples};
use super::sums::{Sums8, coverage};
use super::{Cancel, Cancelled, RenderOptions};
use crate::aov::Aov;
use crate::film::{LayerKind, Window};
use crate::filter::Filter;
use crate::integrator::{CameraRay, Integrator, RayCounts, Work};
use crate::math::lanes::{Lanes3, store3};
use crate::sampling::Sampler;
use crate::terms::{Terms, Terms8};
use crate::witness::{Branch, LightTold, Witness};

/// Pixels are visited in squares of this edge within a tile: rays near one another in a bundle
/// are near one another in space.
const SQUARE: u32 = 8;

/// Eights of pixels in a bundle of several samples each: a square's.
const LOT: usize = SQUARE as usize;

/// Samples of each pixel in a bundle.
const LOTS: u32 = 2;

/// Paints tiles.
pub(super) struct Painter<'a> {
    integrator: Integrator<'a>,
    options: &'a RenderOptions,
    layers: Vec<LayerKind>,
    filter: Filter,
}

/// A thread's room for painting, used again from tile to tile.
#[derive(Default)]
pub(super) struct Desk {
    pixels: Vec<Pixels8>,
    drawn: Samples,
    work: Work,
    sums: Vec<Sums8>,
    /// For each layer the tile's rows.
    values: Vec<Vec<f32>>,
}

impl Desk {
    /// What was painted last: the values of the tile's pixels, for each layer its rows.
    pub(super) fn values(&self) -> &[Vec<f32>] {
        &self.values
    }
}

impl<'a> Painter<'a> {
    pub(super) fn new(integrator: Integrator<'a>, options: &'a RenderOptions) -> Self {
        Self { integrator, options, layers: options.layers(), filter: Filter::new(options.filter) }
    }

    /// Paints a tile.
    pub(super) fn paint(
        &self,
        window: Window,
        desk: &mut Desk,
        counts: &mut RayCounts,
        cancel: &Cancel,
    ) -> Result<(), Cancelled> {
        let Desk { pixels, drawn, work, sums, values } = desk;
        cut(window, self.options, pixels);
        values.resize_with(self.layers.len(), Vec::new);
        for (kind, values) in self.layers.iter().zip(&mut *values) {
            if matches!(kind, LayerKind::Aov(_)) {
                // A variable is put where there is something to say.
                values.clear();
            }
            let len = window.width() as usize * window.height() as usize;
            values.resize(len * kind.channels(), 0.0);
        }
        let (samples, background) = (self.options.samples, self.options.background);
        let (integrator, filter) = (&self.integrator, &self.filter);
        let bvh = integrator.scene.bvh();
        if samples == 1 {
            if cancel.is_cancelled() {
                return Err(Cancelled);
            }
            drawn.draw(integrator, self.options, filter, pixels, 0..1);
            let brought = integrator.trace(&drawn.bundle, work, counts, &mut ());
            // One sample, which weighs 1, is its pixel: nothing to sum.
            let one = brought.iter().map(|sample| {
                let covered = |lane| coverage((sample.met >> lane & 1) as f32, background);
                (&sample.terms, std::array::from_fn(covered))
            });
            let layers = &self.layers;
            bvh.run(Put { window, layers, resolved: pixels.iter().zip(one), values });
        } else {
            for pixels in pixels.chunks(LOT) {
                sums.clear();
                sums.resize(pixels.len(), Sums8::NONE);
                for from in (0..samples).step_by(LOTS as usize) {
                    if cancel.is_cancelled() {
                        return Err(Cancelled);
                    }
                    let indices = from..samples.min(from + LOTS);
                    drawn.draw(integrator, self.options, filter, pixels, indices);
                    let brought = integrator.trace(&drawn.bundle, work, counts, &mut ());
                    Sums8::add(bvh, sums, brought, &drawn.weights);
                }
                for (pixels, sums) in pixels.iter().zip(&*sums) {
                    let (terms, alpha) = sums.resolve(bvh, samples, background);
                    let resolved = std::iter::once((pixels, (&terms, alpha)));
                    let layers = &self.layers;
                    bvh.run(Put { window, layers, resolved, values });
                }
            }
        }
        if !self.options.aovs.is_empty() {
            for y in window.y0..window.y1 {
                for x in window.x0..window.x1 {
                    self.variables([x, y], of_window(window, [x, y]), values);
                }
            }
        }
        Ok(())
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
                    let first_hit = Integrator { depth: 0, ..self.integrator };
                    if let Some(ray) = ray {
                        let ray = CameraRay { ray, sampler, height: 0.0 };
                        first_hit.trace_one(ray, &mut RayCounts::default(), &mut seen);
                    }
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
    fn met(&mut self, _: &phong_bvh::Ray, _: &crate::interaction::SurfaceInteraction, _: Terms) {}
    fn lit(&mut self, told: &LightTold) {
        self.lights += 1;
        self.seen += u32::from(told.visible);
    }
    fn entered(&mut self, _: Branch, _: Rgb, _: Option<f32>, _: &phong_bvh::Ray) {}
    fn left(&mut self, _: Branch, _: Rgb) {}
    fn cut(&mut self, _: Branch, _: Rgb, _: Option<f32>) {}
}

/// Cuts a tile into squares, so that a bundle's neighbours are neighbours.
fn cut(window: Window, options: &RenderOptions, pixels: &mut Vec<Pixels8>) {
    pixels.clear();
    for y0 in (window.y0..window.y1).step_by(SQUARE as usize) {
        for x0 in (window.x0..window.x1).step_by(SQUARE as usize) {
            let len = SQUARE.min(window.x1 - x0);
            for y in y0..window.y1.min(y0 + SQUARE) {
                pixels.push(Pixels8::new([x0, y], len, options));
            }
        }
    }
}

/// Puts what pixels are into the layers, at their places in the tile.
struct Put<'a, R> {
    window: Window,
    layers: &'a [LayerKind],
    resolved: R,
    values: &'a mut [Vec<f32>],
}

impl<'a, R: Iterator<Item = (&'a Pixels8, (&'a Terms8, [f32; 8]))>> Kernel for Put<'a, R> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { window, layers, resolved, values } = self;
        for (pixels, (terms, alpha)) in resolved {
            let (place, len) = (of_window(window, pixels.first), pixels.len as usize);
            for (kind, values) in layers.iter().zip(&mut *values) {
                let at = place * kind.channels();
                match kind {
                    LayerKind::Picture => {
                        put_colors(&mut values[at..][..3 * len], &store3(terms.total(simd)));
                    }
                    LayerKind::Alpha => values[at..][..len].copy_from_slice(&alpha[..len]),
                    LayerKind::Term(term) => {
                        put_colors(&mut values[at..][..3 * len], &terms[*term]);
                    }
                    LayerKind::Aov(_) => {}
                }
            }
        }
    }
}

/// Puts colours one behind the other that lie side by side.
#[inline(always)]
fn put_colors(to: &mut [f32], [r, g, b]: &Lanes3) {
    for (lane, to) in to.as_chunks_mut::<3>().0.iter_mut().enumerate() {
        *to = [r[lane], g[lane], b[lane]];
    }
}

/// The number of a pixel within a tile's rows.
fn of_window(window: Window, [x, y]: [u32; 2]) -> usize {
    (y - window.y0) as usize * window.width() as usize + (x - window.x0) as usize
}

fn put<const N: usize>(values: &mut [f32], place: usize, value: [f32; N]) {
    values[place * N..][..N].copy_from_slice(&value);
}
