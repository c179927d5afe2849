//! One tile: its samples in index order, summed in f64, and its variables from centre rays.

use std::ops::Range;

use fearless_simd::Simd;
use glam::DVec2;
use phong_bvh::{Hit, Kernel};
use phong_scene::{Background, Rgb};

use super::{Cancel, Cancelled, RenderOptions};
use crate::aov::Aov;
use crate::film::{LayerKind, Window};
use crate::filter::Filter;
use crate::integrator::{Bundle, CameraRay, Integrator, Radiance, RayCounts};
use crate::reflectance::Terms;
use crate::sampling::{Sampler, Use};
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

/// The sums of one pixel.
#[derive(Clone, Copy, Default)]
pub(crate) struct Sums {
    terms: [[f64; 3]; 6],
    alpha: f64,
    weight: f64,
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
                self.draw(pixels, &own, from..samples.min(from + lot), &mut drawn);
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

    /// Draws some samples of each pixel; `own` are the pixels' samplers.
    fn draw(&self, pixels: &[[u32; 2]], own: &[Sampler], indices: Range<u32>, drawn: &mut Samples) {
        drawn.clear();
        let scene = self.integrator.scene;
        let lanes = pixels.iter().zip(own).enumerate().flat_map(|(number, (&pixel, sampler))| {
            indices.clone().map(move |index| (number as u32, pixel, sampler.at(index)))
        });
        if scene.camera().is_pinhole() {
            for (number, pixel, sampler) in lanes {
                drawn.numbers.push(number);
                drawn.pixels.push(pixel);
                drawn.bundle.samplers.push(sampler);
            }
            scene.bvh().run(Fall { filter: &self.filter, drawn });
            if matches!(self.options.background, Background::Gradient { .. }) {
                let heights = drawn.places.iter().map(|&place| height(place, self.options.size));
                drawn.bundle.heights.extend(heights);
            }
            let rays = &mut drawn.bundle.rays;
            scene.camera().pinhole_rays(scene.bvh(), &drawn.places, self.options.size, rays);
            return;
        }
        let mut outside = Vec::new();
        for (number, pixel, sampler) in lanes {
            let Drawn { weight, ray, .. } =
                camera_ray(&self.integrator, self.options, &self.filter, pixel, sampler);
            match ray {
                Some(ray) => {
                    drawn.bundle.push(ray);
                    drawn.numbers.push(number);
                    drawn.weights.push(weight);
                }
                None => outside.push((number, weight)),
            }
        }
        drawn.numbers.extend(outside.iter().map(|&(number, _)| number));
        drawn.weights.extend(outside.iter().map(|&(_, weight)| weight));
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

/// Where a sample was drawn.
pub(crate) struct Drawn {
    /// In the picture, pixels.
    pub(crate) place: DVec2,
    /// Its weight in the pixel's sum.
    pub(crate) weight: f32,
    /// Its ray; none outside the image circle of a fisheye.
    pub(crate) ray: Option<CameraRay>,
}

/// Draws a sample of a pixel.
pub(crate) fn camera_ray(
    integrator: &Integrator<'_>,
    options: &RenderOptions,
    filter: &Filter,
    pixel: [u32; 2],
    sampler: Sampler,
) -> Drawn {
    let (place, weight) = fall(filter, pixel, sampler.pair(Use::Pixel));
    let camera = integrator.scene.camera();
    let lens = if camera.has_lens() { sampler.pair(Use::Lens) } else { [0.5; 2] };
    let height = height(place, options.size);
    let ray = camera.ray(place, options.size, lens);
    let ray = ray.map(|ray| CameraRay { ray, sampler, height });
    Drawn { place, weight, ray }
}

/// Where in the picture a sample falls, in pixels, and its weight there.
#[inline(always)]
fn fall(filter: &Filter, [x, y]: [u32; 2], pair: [f32; 2]) -> (DVec2, f32) {
    let drawn = filter.sample(pair);
    let place = DVec2::new(
        f64::from(x) + 0.5 + f64::from(drawn.offset[0]),
        f64::from(y) + 0.5 + f64::from(drawn.offset[1]),
    );
    (place, drawn.weight)
}

/// [`fall`] of all samples drawn.
struct Fall<'a> {
    filter: &'a Filter,
    drawn: &'a mut Samples,
}

impl Kernel for Fall<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        let Self { filter, drawn } = self;
        let (eights, rest) = drawn.bundle.samplers.as_chunks::<8>();
        for (i, samplers) in eights.iter().enumerate() {
            let [u, v] = Sampler::pair8(samplers, Use::Pixel);
            for (lane, &pixel) in drawn.pixels[8 * i..][..8].iter().enumerate() {
                let (place, weight) = fall(filter, pixel, [u[lane], v[lane]]);
                drawn.places.push(place);
                drawn.weights.push(weight);
            }
        }
        for (sampler, &pixel) in rest.iter().zip(&drawn.pixels[8 * eights.len()..]) {
            let (place, weight) = fall(filter, pixel, sampler.pair(Use::Pixel));
            drawn.places.push(place);
            drawn.weights.push(weight);
        }
    }
}

/// Where a place of the picture crosses its height: 0 the upper edge, 1 the lower.
fn height(place: DVec2, size: [u32; 2]) -> f32 {
    (place.y / f64::from(size[1])).clamp(0.0, 1.0) as f32
}

/// Samples of the pixels of a square.
struct Samples {
    bundle: Bundle,
    /// For each sample the number of its pixel in the square, and its weight there: first those of
    /// the rays, then those outside the image circle of a fisheye.
    numbers: Vec<u32>,
    weights: Vec<f32>,
    /// Of a pinhole's rays the pixels, and where they go through the picture.
    pixels: Vec<[u32; 2]>,
    places: Vec<DVec2>,
}

impl Samples {
    fn with_capacity(len: usize) -> Self {
        Self {
            bundle: Bundle::with_capacity(len),
            numbers: Vec::with_capacity(len),
            weights: Vec::with_capacity(len),
            pixels: Vec::with_capacity(len),
            places: Vec::with_capacity(len),
        }
    }

    fn clear(&mut self) {
        self.bundle.clear();
        self.numbers.clear();
        self.weights.clear();
        self.pixels.clear();
        self.places.clear();
    }
}

impl Sums {
    /// Adds a sample; outside a fisheye's image circle, one that brought nothing.
    #[inline]
    pub(crate) fn add(&mut self, radiance: &Radiance, weight: f32) {
        let weight = f64::from(weight);
        self.weight += weight;
        let Terms { background, ambient, diffuse, specular, reflection, transmission } =
            radiance.terms;
        let [to_background, to_ambient, to_diffuse, to_specular, to_reflection, to_transmission] =
            &mut self.terms;
        // A ray brings the background or a surface's terms; what is black changes no sum.
        if !radiance.met {
            add(to_background, weight, background);
            return;
        }
        add(to_ambient, weight, ambient);
        add(to_diffuse, weight, diffuse);
        add(to_specular, weight, specular);
        if !(reflection.is_black() && transmission.is_black()) {
            add(to_reflection, weight, reflection);
            add(to_transmission, weight, transmission);
        }
        self.alpha += weight;
    }

    /// The terms, each resolved to f32, and the coverage.
    #[inline]
    pub(crate) fn resolve(&self, samples: u32, background: Background) -> (Terms, f32) {
        // Signed weights that all but cancel would blow up what little is left.
        let total = self.weight.max(0.25 * f64::from(samples));
        let terms = self
            .terms
            .map(|[r, g, b]| Rgb::new((r / total) as f32, (g / total) as f32, (b / total) as f32));
        let alpha = (self.alpha / total).clamp(0.0, 1.0) as f32;
        (Terms::from_array(terms), coverage(alpha, background))
    }
}

#[inline]
fn add(sum: &mut [f64; 3], weight: f64, term: Rgb) {
    sum[0] += weight * f64::from(term.r);
    sum[1] += weight * f64::from(term.g);
    sum[2] += weight * f64::from(term.b);
}

/// The alpha of a pixel of which surfaces cover `share`.
fn coverage(share: f32, background: Background) -> f32 {
    match background {
        Background::Transparent => share,
        Background::Color(_) | Background::Gradient { .. } => 1.0,
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
