//! One tile: its samples in index order, summed in f64, and its variables from centre rays.

use glam::DVec2;
use phong_bvh::Hit;
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
        let mut out: Vec<Vec<f32>> =
            self.layers.iter().map(|kind| vec![0.0; pixels.len() * kind.channels()]).collect();
        let mut samples = Samples::with_capacity(pixels.len());
        // One sample, which weighs 1, is its pixel: nothing to sum.
        let alone = self.options.samples == 1;
        let mut sums = vec![Sums::default(); if alone { 0 } else { pixels.len() }];
        for index in 0..self.options.samples {
            if cancel.is_cancelled() {
                return Err(Cancelled);
            }
            self.draw(&pixels, index, &mut samples);
            let mut brought = self.integrator.trace(&samples.bundle, counts, &mut ());
            // Behind the rays come the samples outside the image circle: they bring nothing.
            brought.resize(samples.numbers.len(), Radiance::default());
            for ((&number, &weight), radiance) in
                samples.numbers.iter().zip(&samples.weights).zip(&brought)
            {
                if alone {
                    let share = f32::from(u8::from(radiance.met));
                    let resolved = (&radiance.terms, coverage(share, self.options.background));
                    self.put(of_window(window, pixels[number as usize]), resolved, &mut out);
                } else {
                    sums[number as usize].add(radiance, weight);
                }
            }
        }
        for (&pixel, sums) in pixels.iter().zip(&sums) {
            let (terms, alpha) = sums.resolve(self.options.samples, self.options.background);
            self.put(of_window(window, pixel), (&terms, alpha), &mut out);
        }
        if !self.options.aovs.is_empty() {
            for &pixel in &pixels {
                self.variables(pixel, of_window(window, pixel), &mut out);
            }
        }
        Ok(out)
    }

    /// Draws sample `index` of each pixel.
    fn draw(&self, pixels: &[[u32; 2]], index: u32, samples: &mut Samples) {
        samples.clear();
        let camera = self.integrator.scene.camera();
        if !camera.is_pinhole() {
            let mut outside = Vec::new();
            for (number, &pixel) in pixels.iter().enumerate() {
                let Drawn { weight, ray, .. } =
                    camera_ray(&self.integrator, self.options, &self.filter, pixel, index);
                match ray {
                    Some(ray) => {
                        samples.bundle.push(ray);
                        samples.numbers.push(number as u32);
                        samples.weights.push(weight);
                    }
                    None => outside.push((number as u32, weight)),
                }
            }
            samples.numbers.extend(outside.iter().map(|&(number, _)| number));
            samples.weights.extend(outside.iter().map(|&(_, weight)| weight));
            return;
        }
        let gradient = matches!(self.options.background, Background::Gradient { .. });
        for (number, &pixel) in pixels.iter().enumerate() {
            let Fallen { sampler, place, weight } = fall(self.options, &self.filter, pixel, index);
            samples.places.push(place);
            samples.bundle.samplers.push(sampler);
            if gradient {
                samples.bundle.heights.push(height(place, self.options.size));
            }
            samples.numbers.push(number as u32);
            samples.weights.push(weight);
        }
        let (bvh, rays) = (self.integrator.scene.bvh(), &mut samples.bundle.rays);
        camera.pinhole_rays(bvh, &samples.places, self.options.size, rays);
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

/// Draws sample `index` of a pixel.
pub(crate) fn camera_ray(
    integrator: &Integrator<'_>,
    options: &RenderOptions,
    filter: &Filter,
    pixel: [u32; 2],
    index: u32,
) -> Drawn {
    let Fallen { sampler, place, weight } = fall(options, filter, pixel, index);
    let camera = integrator.scene.camera();
    let lens = if camera.has_lens() { sampler.pair(Use::Lens) } else { [0.5; 2] };
    let ray = camera.ray(place, options.size, lens);
    let height = height(place, options.size);
    let ray = ray.map(|ray| CameraRay { ray, sampler, height });
    Drawn { place, weight, ray }
}

/// Where a sample falls.
struct Fallen {
    sampler: Sampler,
    /// In the picture, pixels.
    place: DVec2,
    weight: f32,
}

#[inline]
fn fall(options: &RenderOptions, filter: &Filter, [x, y]: [u32; 2], index: u32) -> Fallen {
    let sampler = Sampler::new([x, y], index, options.samples, options.seed);
    let drawn = filter.sample(sampler.pair(Use::Pixel));
    let place = DVec2::new(
        f64::from(x) + 0.5 + f64::from(drawn.offset[0]),
        f64::from(y) + 0.5 + f64::from(drawn.offset[1]),
    );
    Fallen { sampler, place, weight: drawn.weight }
}

/// Where a place of the picture crosses its height: 0 the upper edge, 1 the lower.
fn height(place: DVec2, size: [u32; 2]) -> f32 {
    (place.y / f64::from(size[1])).clamp(0.0, 1.0) as f32
}

/// One sample of each pixel of a tile.
struct Samples {
    bundle: Bundle,
    /// For each sample the number of its pixel in the tile, and its weight there: first those of the
    /// rays, then those outside the image circle of a fisheye.
    numbers: Vec<u32>,
    weights: Vec<f32>,
    /// Where pinhole rays go through the picture.
    places: Vec<DVec2>,
}

impl Samples {
    fn with_capacity(len: usize) -> Self {
        Self {
            bundle: Bundle::with_capacity(len),
            numbers: Vec::with_capacity(len),
            weights: Vec::with_capacity(len),
            places: Vec::with_capacity(len),
        }
    }

    fn clear(&mut self) {
        self.bundle.clear();
        self.numbers.clear();
        self.weights.clear();
        self.places.clear();
    }
}

impl Sums {
    /// Adds a sample; outside a fisheye's image circle, one that brought nothing.
    #[inline]
    pub(crate) fn add(&mut self, radiance: &Radiance, weight: f32) {
        let weight = f64::from(weight);
        self.weight += weight;
        for (sum, term) in self.terms.iter_mut().zip(radiance.terms.to_array()) {
            // Most samples bring two or three of the six.
            if !term.is_black() {
                sum[0] += weight * f64::from(term.r);
                sum[1] += weight * f64::from(term.g);
                sum[2] += weight * f64::from(term.b);
            }
        }
        self.alpha += weight * f64::from(u8::from(radiance.met));
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
