//! Where samples fall, and the rays that go there.

use std::ops::Range;

use fearless_simd::{Simd, f32x8, f64x4, prelude::*};
use glam::DVec2;
use phong_bvh::{Kernel, Rays8, lanes};
use phong_scene::Background;

use super::RenderOptions;
use crate::camera::{Camera, across_screen, up_screen};
use crate::filter::Filter;
use crate::integrator::{Bundle, CameraRay, Integrator};
use crate::sampling::{Places8, Sampler, Samplers8, Use};

/// Up to eight pixels of a row, side by side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pixels8 {
    /// The leftmost.
    pub(super) first: [u32; 2],
    /// How many, 1 to 8.
    pub(super) len: u32,
    /// Where their samples come from.
    samplers: Samplers8,
    places: Places8,
    /// Those whose samples all weigh 1, a bit each.
    uneven: u32,
}

impl Pixels8 {
    /// `each`: whether the samplers of all pixels are asked for, though they have one sample each.
    pub(super) fn new(
        [x, y]: [u32; 2],
        len: u32,
        options: &RenderOptions,
        filter: &Filter,
        each: bool,
    ) -> Self {
        let sampler = |x: u32| Sampler::new([x, y], 0, options.samples(), options.seed());
        let mut samplers = Samplers8::splat(sampler(x));
        // The middle of the pixel, of the lens and of lights is the same for all.
        if options.samples() > 1 || each {
            (0..len).for_each(|lane| samplers.set(lane as usize, sampler(x + lane)));
        }
        let is_uneven = |lane: &u32| filter.is_uneven(sampler(x + lane), options.samples());
        let uneven = (0..len).filter(is_uneven).fold(0, |all, lane| all | 1 << lane);
        let places = Places8::new(&samplers, Use::Pixel);
        Self { first: [x, y], len, samplers, places, uneven }
    }

    /// The weights of samples, one of each pixel, of which the filter has these.
    #[inline(always)]
    fn weights(&self, mut drawn: [f32; 8]) -> [f32; 8] {
        lanes(self.uneven).for_each(|lane| drawn[lane] = 1.0);
        drawn
    }

    fn pixel(&self, lane: usize) -> [u32; 2] {
        [self.first[0] + lane as u32, self.first[1]]
    }
}

/// Samples of some pixels.
#[derive(Debug, Default)]
pub(super) struct Samples {
    pub(super) bundle: Bundle,
    /// Of each sample its weight in the pixel's sum.
    pub(super) weights: Vec<[f32; 8]>,
}

impl Samples {
    /// Draws the samples `indices` of the first eight pixels, then those of the next, and so on: rays that follow
    /// one another are near one another, and are traced together.
    pub(super) fn draw(
        &mut self,
        integrator: &Integrator<'_>,
        options: &RenderOptions,
        filter: &Filter,
        pixels: &[Pixels8],
        indices: Range<u32>,
    ) {
        let soft = integrator.scene.asks_for_samplers();
        let (camera, is_far) = (integrator.scene.camera(), integrator.scene.is_far(options.size()));
        if camera.is_projective() && !is_far {
            self.bundle.samplers.clear();
            self.bundle.heights.clear();
            let (to, bvh) = (self, integrator.scene.world());
            let gradient = matches!(integrator.scene.background(), Background::Gradient { .. });
            bvh.run(ProjectiveRays {
                camera,
                options,
                filter,
                pixels,
                indices,
                soft,
                gradient,
                to,
            });
            return;
        }
        self.bundle.clear();
        self.weights.clear();
        for pixels in pixels {
            for index in indices.clone() {
                let samplers = pixels.samplers.at(index);
                let (mut rays, mut heights, mut weights) = (Rays8::NONE, [0.0; 8], [0.0; 8]);
                for lane in 0..pixels.len as usize {
                    let (pixel, sampler) = (pixels.pixel(lane), samplers.get(lane));
                    let drawn = camera_ray(integrator, options, filter, pixel, sampler);
                    weights[lane] = drawn.weight;
                    if let Some(CameraRay { ray, height, .. }) = drawn.ray {
                        rays.set(lane, &ray);
                        heights[lane] = height;
                    }
                }
                self.bundle.rays.push(rays);
                self.bundle.samplers.extend(soft.then_some(samplers));
                self.bundle.heights.push(heights);
                self.weights.push(pixels.weights(weights));
            }
        }
    }
}

/// Where a sample was drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawn {
    /// In the picture, pixels: x to the right and y down from the upper left corner.
    pub(crate) place: DVec2,
    /// Its weight: +1, or −1 where a filter is negative.
    pub(crate) weight: f32,
    /// Its ray; `None` outside the image circle of a fisheye.
    pub(crate) ray: Option<CameraRay>,
}

/// The place and the ray of one sample of a pixel, which is within `options.size`.
pub(crate) fn camera_ray(
    integrator: &Integrator<'_>,
    options: &RenderOptions,
    filter: &Filter,
    [x, y]: [u32; 2],
    sampler: Sampler,
) -> Drawn {
    let drawn = filter.sample(sampler.pair(Use::Pixel));
    let place = DVec2::new(
        f64::from(x) + 0.5 + f64::from(drawn.offset[0]),
        f64::from(y) + 0.5 + f64::from(drawn.offset[1]),
    );
    let camera = integrator.scene.camera();
    let lens = if camera.has_lens() { sampler.pair(Use::Lens) } else { [0.5; 2] };
    let height = height(place.y, options.size());
    let ray = integrator.scene.camera_ray(place, options.size(), lens);
    let ray = ray.map(|started| CameraRay { ray: started.ray, sampler, height });
    Drawn { place, weight: drawn.weight, ray }
}

/// [`camera_ray`] of eight samples at once, of a projective camera.
struct ProjectiveRays<'a> {
    camera: &'a Camera,
    options: &'a RenderOptions,
    filter: &'a Filter,
    pixels: &'a [Pixels8],
    indices: Range<u32>,
    /// Whether samplers are asked for.
    soft: bool,
    /// Whether the heights of rays are asked for.
    gradient: bool,
    to: &'a mut Samples,
}

impl Kernel for ProjectiveRays<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { camera, options, filter, pixels, indices, soft, gradient, to } = self;
        let low: f64x4<S> = [0.0, 1.0, 2.0, 3.0].simd_into(simd);
        let high: f64x4<S> = [4.0, 5.0, 6.0, 7.0].simd_into(simd);
        let lens = camera.has_lens();
        let size = options.size();
        // A picture of one sample has it in the middle of each pixel.
        let middle = (options.samples() == 1).then(|| filter.sample8([[0.5; 8]; 2]));
        let Samples { bundle: Bundle { rays, samplers, heights }, weights } = to;
        // What is there is written over.
        let len = indices.len() * pixels.len();
        rays.resize(len, Rays8::NONE);
        weights.resize(len, [0.0; 8]);
        let mut eights = rays.iter_mut().zip(weights);
        for pixels in pixels {
            let [left, top] = [f64::from(pixels.first[0]), f64::from(pixels.first[1]) + 0.5];
            for (index, (rays, weights)) in indices.clone().zip(&mut eights) {
                let [dx, dy, own] = match middle {
                    Some(middle) => middle,
                    None => filter.sample8(pixels.places.at([index; 8])),
                };
                *weights = pixels.weights(own);
                let dx = f32x8::load_array(simd, dx).widen();
                let x = [low + left + 0.5 + dx.0, high + left + 0.5 + dx.1];
                let x = [across_screen(x[0], size), across_screen(x[1], size)];
                let (y, up);
                if middle.is_some() {
                    // One height, of all of them.
                    let row = f64::from(dy[0]) + top;
                    y = [SimdBase::splat(simd, row); 2];
                    up = [SimdBase::splat(simd, up_screen(row, size)); 2];
                } else {
                    let dy = f32x8::load_array(simd, dy).widen();
                    y = [dy.0 + top, dy.1 + top];
                    up = [up_screen(y[0], size), up_screen(y[1], size)];
                }
                let on_lens = lens.then(|| pixels.samplers.at(index).pair(Use::Lens));
                camera.projective_rays(simd, [x, up], on_lens.as_ref(), rays);
                rays.there = (1 << pixels.len) - 1;
                samplers.extend(soft.then(|| pixels.samplers.at(index)));
                if gradient {
                    let mut at = [0.0; 8];
                    for lane in lanes(rays.there) {
                        at[lane] = height(y[lane / 4][lane % 4], size);
                    }
                    heights.push(at);
                }
            }
        }
    }
}

/// Where a row of the picture crosses its height: 0 the upper edge, 1 the lower.
fn height(y: f64, size: [u32; 2]) -> f32 {
    (y / f64::from(size[1])).clamp(0.0, 1.0) as f32
}

#[cfg(test)]
mod tests {
    use phong_scene::{CameraKind, FilterKind, Image, Light, LightKind, Rgb, Scene};

    use super::*;
    use crate::integrator::{SampleGrid, Shares};
    use crate::view::View;

    #[test]
    fn samples_drawn_eight_at_a_time_have_the_bits_of_those_drawn_one_by_one() {
        let kinds =
            [CameraKind::Perspective { fov: 40.0 }, CameraKind::Orthographic { height: 3.0 }];
        let background = Background::Gradient { top: Rgb::WHITE, bottom: Rgb::BLACK };
        for (kind, aperture) in kinds.into_iter().flat_map(|kind| [(kind, 0.0), (kind, 0.2)]) {
            for filter in [FilterKind::Box, FilterKind::Mitchell] {
                let image =
                    Image { size: [21, 9], samples: 3, filter, background, ..Image::default() };
                let camera = phong_scene::Camera { kind, aperture, ..Default::default() };
                let kind = LightKind::Distant { direction: -glam::DVec3::Y, angle: 1.0 };
                let lights = vec![Light { kind, ..Light::default() }];
                let scene = Scene { image, camera, lights, ..Scene::default() };
                let options = RenderOptions::of(&scene.image).expect("as by default but for a few");
                let view = View::of(&scene).expect("a scene of nothing but a light");
                let integrator = Integrator {
                    scene: &view,
                    depth: 0,
                    min_weight: 0.0,
                    shadows: true,
                    terminator: true,
                    grid: SampleGrid { size: scene.image.size, samples: 3 },
                    shares: Shares::NONE,
                    stop: None,
                };
                let filter = Filter::new(filter);
                let pixels = [[0, 8], [16, 5]]
                    .map(|[x, len]| Pixels8::new([x, 3 + x / 16], len, &options, &filter, false));
                let mut drawn = Samples::default();
                drawn.draw(&integrator, &options, &filter, &pixels, 0..3);
                for (i, rays) in drawn.bundle.rays.iter().enumerate() {
                    let (index, pixels) = (i as u32 % 3, &pixels[i / 3]);
                    assert_eq!(rays.there, (1 << pixels.len) - 1);
                    for lane in lanes(rays.there) {
                        let sampler = drawn.bundle.samplers[i].get(lane);
                        let expected = pixels.samplers.at(index).get(lane);
                        assert_eq!(sampler.pair(Use::Light(0)), expected.pair(Use::Light(0)));
                        let pixel = pixels.pixel(lane);
                        let one = camera_ray(&integrator, &options, &filter, pixel, sampler);
                        let ray = one.ray.expect("every place of a projective picture has a ray");
                        assert_eq!(rays.get(lane), ray.ray, "{pixel:?}, {index}");
                        let is_uneven = filter.is_uneven(sampler, 3);
                        let weight = if is_uneven { 1.0 } else { one.weight };
                        assert_eq!(drawn.weights[i][lane], weight);
                        assert_eq!(drawn.bundle.heights[i][lane], ray.height);
                    }
                }
                assert_eq!(drawn.bundle.rays.len(), 6);
            }
        }
    }
}
