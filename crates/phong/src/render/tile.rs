//! One tile in one pass: its samples in index order, and its variables from centre rays.

use fearless_simd::Simd;
use glam::DVec2;
use phong_bvh::{Hit, Kernel};
use phong_scene::Rgb;

use super::draw::{Pixels8, Samples};
use super::{Cancel, Cancelled, Pass, RenderOptions};
use crate::aov::Aov;
use crate::film::{LayerKind, Sums8, TileSums, Window, coverage};
use crate::filter::Filter;
use crate::integrator::{CameraRay, Integrator, RayCounts, ScratchBuffer, Shares, first_seen};
use crate::math::lanes::{Lanes3, store3};
use crate::sampling::Sampler;
use crate::terms::{Terms, Terms8};
use crate::witness::{Branch, Cut, LightContribution, Witness};

/// Pixels are visited in squares of this edge within a tile: rays near one another in a bundle
/// are near one another in space.
const SQUARE: u32 = 8;

/// Eights of pixels in a bundle of several samples each: a square's.
const EIGHTS_PER_BUNDLE: usize = SQUARE as usize;

/// Samples of each pixel in a bundle. More share what is done once for a bundle.
const SAMPLES_PER_BUNDLE: u32 = 8;

/// The most eights of pixels in a bundle of one sample each, so that a large tile notices in the
/// middle that it is cancelled.
const MOST_EIGHTS: usize = 128;

/// The most shares of the light that are kept beside all of it at once, so that a thread's memory is bounded:
/// for more the rays are traced again.
const MOST_SHARES: u32 = 16;

/// Renders tiles.
pub(super) struct TileRenderer<'a> {
    integrator: Integrator<'a>,
    options: &'a RenderOptions,
    cancel: &'a Cancel,
    layers: Vec<LayerKind>,
    filter: Filter,
}

/// A thread's memory for rendering a tile, used again for the next one.
#[derive(Default)]
pub(super) struct TileBuffers {
    pixels: Vec<Pixels8>,
    drawn: Samples,
    scratch: ScratchBuffer,
    sums: Vec<Sums8>,
    /// For each share of the light its sums.
    share_sums: Vec<Vec<Sums8>>,
    /// For each layer the tile's rows.
    values: Vec<Vec<f32>>,
}

impl TileBuffers {
    /// The values of the tile that was rendered last: for each layer its rows of pixels.
    pub(super) fn values(&self) -> &[Vec<f32>] {
        &self.values
    }

    pub(super) fn values_mut(&mut self) -> &mut [Vec<f32>] {
        &mut self.values
    }
}

impl<'a> TileRenderer<'a> {
    pub(super) fn new(
        integrator: Integrator<'a>,
        options: &'a RenderOptions,
        cancel: &'a Cancel,
    ) -> Self {
        let filter = Filter::new(options.filter());
        Self { integrator, options, cancel, layers: options.layers(), filter }
    }

    /// Renders a tile. Returns the sums from which a later pass goes on, unless this is the last one.
    pub(super) fn render(
        &self,
        window: Window,
        pass: Pass,
        earlier: Option<&TileSums>,
        buffers: &mut TileBuffers,
        counts: &mut RayCounts,
    ) -> Result<Option<TileSums>, Cancelled> {
        let values = &mut buffers.values;
        values.resize_with(self.layers.len(), Vec::new);
        for (kind, values) in self.layers.iter().zip(values) {
            if matches!(kind, LayerKind::Aov(_) | LayerKind::Light(_) | LayerKind::Unlit) {
                // Only pixels that show a surface get a value.
                values.clear();
            }
            let len = window.width() as usize * window.height() as usize;
            values.resize(len * kind.channels(), 0.0);
        }
        let samples = match pass {
            Pass::Coarse => return self.coarse(window, buffers, counts).map(|()| None),
            Pass::UpTo(samples) => samples,
        };
        let each = self.integrator.scene.occlusion().is_some();
        cut(window, self.options, &self.filter, each, &mut buffers.pixels);
        let kept = if self.options.samples() == 1 {
            self.one_sample(window, buffers, counts)?;
            None
        } else {
            self.samples(window, samples, earlier, buffers, counts)?
        };
        // Variables are of the centre ray, and do not change from pass to pass.
        if earlier.is_none() && self.options.has_variables() {
            for y in window.y0..window.y1 {
                for x in window.x0..window.x1 {
                    self.check_cancelled()?;
                    self.variables([x, y], of_window(window, [x, y]), &mut buffers.values);
                }
            }
        }
        Ok(kept)
    }

    fn check_cancelled(&self) -> Result<(), Cancelled> {
        if self.cancel.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }

    /// A picture of one sample a pixel.
    fn one_sample(
        &self,
        window: Window,
        TileBuffers { pixels, drawn, scratch, values, .. }: &mut TileBuffers,
        counts: &mut RayCounts,
    ) -> Result<(), Cancelled> {
        let (integrator, background) = (&self.integrator, self.integrator.scene.background());
        let world = integrator.scene.world();
        for pixels in pixels.chunks(MOST_EIGHTS) {
            drawn.draw(integrator, self.options, &self.filter, pixels, 0..1);
            for (round, integrator) in self.rounds().enumerate() {
                let counts = if round == 0 { &mut *counts } else { &mut RayCounts::default() };
                let brought = integrator.trace(&drawn.bundle, scratch, counts, &mut ());
                // What was cut short is not to be seen.
                self.check_cancelled()?;
                // One sample, which weighs 1, is its pixel: nothing to sum.
                if round == 0 {
                    let one = brought.iter().map(|sample| {
                        let covered = |lane| coverage(sample.covers(lane), background);
                        (&sample.terms, std::array::from_fn(covered))
                    });
                    let (resolved, layers) = (pixels.iter().zip(one), &self.layers);
                    world.run(WriteLayers { window, layers, resolved, values });
                }
                let first = self.first_share() + round * MOST_SHARES as usize;
                for (share, values) in scratch.shares().iter().zip(&mut values[first..]) {
                    let one = share.iter().map(|sample| (&sample.terms, [0.0; 8]));
                    let resolved = pixels.iter().zip(one);
                    world.run(WriteLayers::share(window, resolved, values));
                }
            }
        }
        Ok(())
    }

    /// Where the layers of the light's shares begin among the layers.
    fn first_share(&self) -> usize {
        let is_share = |kind: &LayerKind| matches!(kind, LayerKind::Light(_) | LayerKind::Unlit);
        self.layers.iter().position(is_share).unwrap_or(self.layers.len())
    }

    /// How many layers are of the light's shares.
    fn share_count(&self) -> u32 {
        self.options.lights().map_or(0, |lights| lights.saturating_add(1))
    }

    /// What traces the rays: for all light, and so many of its shares in each round.
    fn rounds(&self) -> impl Iterator<Item = Integrator<'a>> + use<'a> {
        let (count, lights) = (self.share_count(), self.options.lights().unwrap_or(0));
        let integrator = self.integrator;
        (0..count.max(1)).step_by(MOST_SHARES as usize).map(move |first| {
            let end = count.min(first + MOST_SHARES);
            let shares = Shares { first, lights: lights.min(end) - first, unlit: end > lights };
            Integrator { shares, ..integrator }
        })
    }

    /// Each pixel's samples up to `to`, those of earlier passes included.
    fn samples(
        &self,
        window: Window,
        to: u32,
        earlier: Option<&TileSums>,
        TileBuffers { pixels, drawn, scratch, sums, share_sums, values }: &mut TileBuffers,
        counts: &mut RayCounts,
    ) -> Result<Option<TileSums>, Cancelled> {
        let (integrator, background) = (&self.integrator, self.integrator.scene.background());
        let bvh = integrator.scene.world();
        let begin = earlier.map_or(0, TileSums::samples);
        let mut kept = (to < self.options.samples()).then(|| Vec::with_capacity(pixels.len()));
        for (chunk, pixels) in pixels.chunks(EIGHTS_PER_BUNDLE).enumerate() {
            sums.clear();
            match earlier {
                Some(earlier) => {
                    sums.extend_from_slice(
                        &earlier.eights()[chunk * EIGHTS_PER_BUNDLE..][..pixels.len()],
                    );
                }
                None => sums.resize(pixels.len(), Sums8::NONE),
            }
            share_sums.resize_with(self.share_count() as usize, Vec::new);
            for sums in &mut *share_sums {
                sums.clear();
                sums.resize(pixels.len(), Sums8::NONE);
            }
            for from in (begin..to).step_by(SAMPLES_PER_BUNDLE as usize) {
                let indices = from..to.min(from + SAMPLES_PER_BUNDLE);
                drawn.draw(integrator, self.options, &self.filter, pixels, indices);
                for (round, integrator) in self.rounds().enumerate() {
                    let counts = if round == 0 { &mut *counts } else { &mut RayCounts::default() };
                    let brought = integrator.trace(&drawn.bundle, scratch, counts, &mut ());
                    self.check_cancelled()?;
                    if round == 0 {
                        Sums8::add(bvh, sums, brought, &drawn.weights);
                    }
                    let sums = share_sums.iter_mut().skip(round * MOST_SHARES as usize);
                    for (share, sums) in scratch.shares().iter().zip(sums) {
                        Sums8::add(bvh, sums, share, &drawn.weights);
                    }
                }
            }
            let shares = values.iter_mut().skip(self.first_share());
            for (sums, values) in share_sums.iter().zip(shares) {
                for (pixels, sums) in pixels.iter().zip(sums) {
                    let (terms, alpha) = sums.resolve(bvh, to, background);
                    let resolved = std::iter::once((pixels, (&terms, alpha)));
                    bvh.run(WriteLayers::share(window, resolved, values));
                }
            }
            for (pixels, sums) in pixels.iter().zip(&*sums) {
                let (terms, alpha) = sums.resolve(bvh, to, background);
                let resolved = std::iter::once((pixels, (&terms, alpha)));
                bvh.run(WriteLayers { window, layers: &self.layers, resolved, values });
            }
            if let Some(kept) = &mut kept {
                kept.extend_from_slice(sums);
            }
        }
        Ok(kept.map(|eights| TileSums::new(to, eights)))
    }

    /// What the centre of each coarse square's middle pixel brings, all over the square.
    fn coarse(
        &self,
        window: Window,
        buffers: &mut TileBuffers,
        counts: &mut RayCounts,
    ) -> Result<(), Cancelled> {
        let centres = self.options.one_sample();
        let middle = |square: &Window| middle_of(*square, self.options.size());
        let TileBuffers { pixels, drawn, scratch, values, .. } = buffers;
        for squares in coarse_squares(window).chunks(MOST_EIGHTS) {
            pixels.clear();
            pixels.extend(
                squares
                    .iter()
                    .map(|square| Pixels8::new(middle(square), 1, &centres, &self.filter, false)),
            );
            drawn.draw(&self.integrator, &centres, &self.filter, pixels, 0..1);
            let brought = self.integrator.trace(&drawn.bundle, scratch, counts, &mut ());
            self.check_cancelled()?;
            for (square, sample) in squares.iter().zip(brought) {
                let terms = sample.terms.get(0);
                let alpha = coverage(sample.covers(0), self.integrator.scene.background());
                // First the square's first pixel in this tile, then all the others.
                let part = square.intersection(&window);
                let place = of_window(window, [part.x0, part.y0]);
                for (kind, values) in self.layers.iter().zip(&mut *values) {
                    match kind {
                        LayerKind::Picture => put(values, place, terms.total().to_array()),
                        LayerKind::Alpha => values[place] = alpha,
                        LayerKind::Term(term) => {
                            put(values, place, terms[*term].to_array());
                        }
                        // A coarse picture has none of its lights.
                        LayerKind::Aov(_) | LayerKind::Light(_) | LayerKind::Unlit => {}
                    }
                }
                if self.options.has_variables() {
                    self.variables(middle(square), place, values);
                }
                for (kind, values) in self.layers.iter().zip(&mut *values) {
                    let n = kind.channels();
                    for y in part.y0..part.y1 {
                        for x in part.x0..part.x1 {
                            let to = of_window(window, [x, y]) * n;
                            values.copy_within(place * n..(place + 1) * n, to);
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// The variables of a pixel, from the ray through its centre.
    fn variables(&self, [x, y]: [u32; 2], place: usize, out: &mut [Vec<f32>]) {
        let scene = self.integrator.scene;
        let size = self.options.size();
        let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let started = scene.camera_ray(centre, size, [0.5; 2]);
        let ray = started.map(|started| started.ray);
        let (hit, cost) = ray.map_or((Hit::NONE, 0), |ray| {
            let (hit, cost) = scene.world().intersect_counted(&ray);
            (scene.first_kept(&ray, hit, &mut Vec::new()), cost.nodes)
        });
        let (ray, hit) = match ray {
            Some(ray) if hit.is_some() => {
                let (ray, hit) = first_seen(scene, ray, hit);
                (Some(ray), hit)
            }
            ray => (ray, hit),
        };
        let before = if hit.is_some() { hit.t } else { f32::INFINITY };
        let lamp = ray.filter(|_| scene.has_lamps()).and_then(|ray| scene.lamp(&ray, before));
        // A lamp is no object: of what it hides there is nothing to tell.
        let hit = if lamp.is_some() { Hit::NONE } else { hit };
        let at = ray.filter(|_| hit.is_some()).map(|ray| scene.interaction(&ray, &hit));
        for (kind, values) in self.layers.iter().zip(out) {
            let LayerKind::Aov(aov) = kind else { continue };
            match (aov, &at) {
                (Aov::Cost, _) => values[place] = cost as f32,
                (Aov::Depth, None) => {
                    let start = started.map_or(0.0, |started| started.start);
                    let depth = lamp.map_or(f64::INFINITY, |t| start + f64::from(t));
                    values[place] = depth as f32;
                }
                (_, None) => {}
                (Aov::Depth, Some(at)) => {
                    let start = started.map_or(0.0, |started| started.start);
                    values[place] = (start + f64::from(at.hit.t)) as f32;
                }
                (Aov::Normal, Some(at)) => put(values, place, at.n.to_array()),
                (Aov::Position, Some(at)) => {
                    put(values, place, at.p.as_vec3().to_array());
                }
                (Aov::Albedo, Some(at)) => put(values, place, at.color.to_array()),
                (Aov::Uv, Some(at)) => {
                    let uv = ray.map(|ray| scene.coordinates(&ray, &at.hit).uv);
                    put(values, place, uv.unwrap_or_default().to_array());
                }
                (Aov::Object, Some(at)) => {
                    values[place] = (scene.object(&at.hit) + 1) as f32;
                }
                (Aov::Material, Some(at)) => values[place] = (at.material + 1) as f32,
                (Aov::Shadow | Aov::Openness, Some(_)) => {
                    let mut seen = Reached::default();
                    let sampler = Sampler::new([x, y], 0, 1, self.options.seed());
                    let first_hit = Integrator { depth: 0, ..self.integrator };
                    if let Some(ray) = ray {
                        let ray = CameraRay { ray, sampler, height: 0.0 };
                        first_hit.trace_one(ray, &mut RayCounts::default(), &mut seen);
                    }
                    values[place] = match aov {
                        Aov::Openness => seen.openness.unwrap_or(1.0),
                        _ => seen.share(),
                    };
                }
            }
        }
    }
}

/// What light reaches the surface met.
#[derive(Default)]
struct Reached {
    /// The lights that are seen, of so many.
    seen: u32,
    lights: u32,
    /// The share of the ambient light, where that is asked for.
    openness: Option<f32>,
    /// How many rays lie between the surface and the one being told of.
    beyond: u32,
}

impl Reached {
    /// The share of the lights that are seen.
    fn share(&self) -> f32 {
        if self.lights == 0 { 0.0 } else { self.seen as f32 / self.lights as f32 }
    }
}

impl Witness for Reached {
    fn missed(&mut self, _: &phong_bvh::Ray, _: Rgb) {}
    fn met(&mut self, _: &phong_bvh::Ray, _: &crate::interaction::SurfaceInteraction, _: Terms) {}
    fn opened(&mut self, share: f32) {
        if self.beyond == 0 {
            self.openness = Some(share);
        }
    }
    fn lit(&mut self, light: &LightContribution) {
        if self.beyond == 0 {
            self.lights += 1;
            self.seen += u32::from(light.visible);
        }
    }
    fn entered(&mut self, _: Branch, _: Rgb, _: Option<f32>, _: &phong_bvh::Ray) {
        self.beyond += 1;
    }
    fn left(&mut self, _: Branch, _: Rgb) {
        self.beyond -= 1;
    }
    fn cut(&mut self, _: Branch, _: &Cut) {}
}

/// The coarse squares that have a pixel in the window, whole.
fn coarse_squares(window: Window) -> Vec<Window> {
    let edge = Pass::COARSE;
    let [first_x, first_y] = [window.x0, window.y0].map(|from| from / edge * edge);
    let mut squares = Vec::new();
    for y0 in (first_y..window.y1).step_by(edge as usize) {
        for x0 in (first_x..window.x1).step_by(edge as usize) {
            squares.push(Window { x0, y0, x1: x0 + edge, y1: y0 + edge });
        }
    }
    squares
}

/// The pixel in the middle of a coarse square, of which a part may lie outside the picture.
fn middle_of(square: Window, [width, height]: [u32; 2]) -> [u32; 2] {
    let half = Pass::COARSE / 2;
    [(square.x0 + half).min(width - 1), (square.y0 + half).min(height - 1)]
}

/// Cuts a tile into squares, so that a bundle's neighbours are neighbours.
fn cut(
    window: Window,
    options: &RenderOptions,
    filter: &Filter,
    each: bool,
    pixels: &mut Vec<Pixels8>,
) {
    pixels.clear();
    for y0 in (window.y0..window.y1).step_by(SQUARE as usize) {
        for x0 in (window.x0..window.x1).step_by(SQUARE as usize) {
            let len = SQUARE.min(window.x1 - x0);
            for y in y0..window.y1.min(y0 + SQUARE) {
                pixels.push(Pixels8::new([x0, y], len, options, filter, each));
            }
        }
    }
}

/// Writes pixels into the layers, at their places in the tile.
struct WriteLayers<'a, R> {
    window: Window,
    layers: &'a [LayerKind],
    resolved: R,
    values: &'a mut [Vec<f32>],
}

impl<'a, R> WriteLayers<'a, R> {
    /// Writes pixels into the layer of a share, which is the sum of the terms as the picture is.
    fn share(window: Window, resolved: R, values: &'a mut Vec<f32>) -> Self {
        let values = std::slice::from_mut(values);
        Self { window, layers: &[LayerKind::Picture], resolved, values }
    }
}

impl<'a, R: Iterator<Item = (&'a Pixels8, (&'a Terms8, [f32; 8]))>> Kernel for WriteLayers<'a, R> {
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
                    LayerKind::Aov(_) | LayerKind::Light(_) | LayerKind::Unlit => {}
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
