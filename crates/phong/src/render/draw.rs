//! Where samples fall, and the rays that go there.

use std::ops::Range;

use fearless_simd::Simd;
use glam::DVec2;
use phong_bvh::Kernel;
use phong_scene::Background;

use super::RenderOptions;
use crate::filter::Filter;
use crate::integrator::{Bundle, CameraRay, Integrator};
use crate::sampling::{Sampler, Use};

/// Samples of the pixels of a square.
pub(super) struct Samples {
    pub(super) bundle: Bundle,
    /// For each sample the number of its pixel in the square, and its weight there: first those of
    /// the rays, then those outside the image circle of a fisheye.
    pub(super) numbers: Vec<u32>,
    pub(super) weights: Vec<f32>,
    /// Of a pinhole's rays the pixels, and where they go through the picture.
    pixels: Vec<[u32; 2]>,
    places: Vec<DVec2>,
}

impl Samples {
    pub(super) fn with_capacity(len: usize) -> Self {
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

    /// Draws some samples of each pixel anew; `own` are the pixels' samplers.
    pub(super) fn draw(
        &mut self,
        integrator: &Integrator<'_>,
        options: &RenderOptions,
        filter: &Filter,
        pixels: &[[u32; 2]],
        own: &[Sampler],
        indices: Range<u32>,
    ) {
        self.clear();
        let scene = integrator.scene;
        let lanes = pixels.iter().zip(own).enumerate().flat_map(|(number, (&pixel, sampler))| {
            indices.clone().map(move |index| (number as u32, pixel, sampler.at(index)))
        });
        if scene.camera().is_pinhole() {
            for (number, pixel, sampler) in lanes {
                self.numbers.push(number);
                self.pixels.push(pixel);
                self.bundle.samplers.push(sampler);
            }
            scene.bvh().run(Fall { filter, drawn: self });
            if matches!(options.background, Background::Gradient { .. }) {
                let heights = self.places.iter().map(|&place| height(place, options.size));
                self.bundle.heights.extend(heights);
            }
            let rays = &mut self.bundle.rays;
            scene.camera().pinhole_rays(scene.bvh(), &self.places, options.size, rays);
            return;
        }
        let mut outside = Vec::new();
        for (number, pixel, sampler) in lanes {
            let Drawn { weight, ray, .. } = camera_ray(integrator, options, filter, pixel, sampler);
            match ray {
                Some(ray) => {
                    self.bundle.push(ray);
                    self.numbers.push(number);
                    self.weights.push(weight);
                }
                None => outside.push((number, weight)),
            }
        }
        self.numbers.extend(outside.iter().map(|&(number, _)| number));
        self.weights.extend(outside.iter().map(|&(_, weight)| weight));
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
