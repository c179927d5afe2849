//! Ambient occlusion: the share of rays over a surface that meet nothing nearby.
//!
//! The rays are spread by the cosine to the normal, so that the share is of the light that a sky of one
//! colour sends, as a matt surface weighs it. They start where shadow rays start. Where there are many of each surface,
//! all those of some neighbouring surfaces are traced together; else one of each surface of a bundle at a time.

use std::ops::Range;

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};
use phong_bvh::{Kernel, Rays8, lanes};
use phong_scene::Rgb;

use super::Integrator;
use super::bundle::Radiance8;
use super::interactions::{Interactions, is_above};
use super::shadow_rays::Starts;
use crate::light::across;
use crate::math::lanes::{Lanes3, add, get, load3, normalize, scale, set, store3};
use crate::sampling::{Samplers8, Use, concentric_disc};
use crate::sky::Sky;
use crate::terms::Term;
use crate::view::Occlusion;

/// From so many rays of a surface on all those of some surfaces are traced together.
const MANY: u32 = 16;
/// The rays that are traced together then, in eights.
const TOGETHER: u32 = 512;

/// How open the surroundings of surfaces are.
#[derive(Default)]
pub(super) struct Openness {
    /// Where the rays of each surface start.
    starts: Vec<Rays8>,
    /// A ray of each of some surfaces, then the next of each.
    rays: Vec<Rays8>,
    blocked: Vec<u32>,
    /// The share of rays that meet nothing, eight surfaces for eight; empty where it is not asked for.
    shares: Vec<[f32; 8]>,
    /// The mean of the sky's light that finds its way, eight surfaces for eight; empty without a sky.
    light: Vec<Lanes3>,
}

impl Openness {
    /// Forgets what was found out.
    pub(super) fn begin(&mut self) {
        self.shares.clear();
        self.light.clear();
    }

    /// The mean of the sky's light that finds its way to a surface; `None` without a sky.
    #[inline]
    pub(super) fn light(&self, i: usize, lane: usize) -> Option<Rgb> {
        self.light.get(i).map(|light| Rgb::from(get(light, lane)))
    }

    /// The share of the ambient light that finds its way to a surface; `None` where that is not asked for.
    #[inline]
    pub(super) fn share(&self, i: usize, lane: usize) -> Option<f32> {
        self.shares.get(i).map(|shares| shares[lane])
    }

    /// Takes from the ambient terms what does not find its way.
    pub(super) fn dim(&self, out: &mut [Radiance8]) {
        for (out, light) in out.iter_mut().zip(&self.light) {
            for (channel, light) in out.terms[Term::Ambient].iter_mut().zip(light) {
                channel.iter_mut().zip(light).for_each(|(value, light)| *value *= light);
            }
        }
        if !self.light.is_empty() {
            return;
        }
        for (out, shares) in out.iter_mut().zip(&self.shares) {
            for channel in &mut out.terms[Term::Ambient] {
                channel.iter_mut().zip(shares).for_each(|(value, share)| *value *= share);
            }
        }
    }
}

impl Integrator<'_> {
    /// Finds out how open the surroundings of every surface are. Returns the number of rays
    /// that were traced.
    pub(super) fn look_around(
        &self,
        occlusion: Occlusion,
        interactions: &Interactions,
        samplers: &[Samplers8],
        to: &mut Openness,
    ) -> u64 {
        let world = self.scene.world();
        let Openness { starts, rays, blocked, shares, light } = to;
        let sky = self.scene.sky();
        let len = samplers.len();
        shares.clear();
        light.clear();
        if sky.is_some() {
            light.resize(len, [[0.0; 8]; 3]);
        } else if !self.shadows {
            // Nothing stands in the way of any light.
            shares.resize(len, [1.0; 8]);
            return 0;
        }
        shares.resize(len, [0.0; 8]);
        starts.resize(len, Rays8::NONE);
        world.run(Starts { interactions, to: &mut *starts });
        let samples = occlusion.samples;
        let many = samples >= MANY;
        // Of so many eights of surfaces so many rays each.
        let across = if many { (TOGETHER / samples).max(8) as usize } else { len.max(1) };
        let along = if many { samples.min(TOGETHER / 8) } else { 1 };
        let mut count = 0;
        for first in (0..len).step_by(across) {
            let eights = first..(first + across).min(len);
            for number in (0..samples).step_by(along as usize) {
                if self.is_stopped() {
                    return count;
                }
                let numbers = number..(number + along).min(samples);
                let (eights, starts) = (eights.clone(), &starts[eights.clone()]);
                rays.resize(eights.len() * numbers.len(), Rays8::NONE);
                blocked.resize(rays.len(), 0);
                let (samplers, to) = (&samplers[eights.clone()], &mut rays[..]);
                let sent =
                    Spread { occlusion, numbers, eights, interactions, samplers, starts, to };
                let sent = world.run(sent);
                if !self.shadows {
                    blocked.fill(0);
                } else if many {
                    count += sent;
                    self.scene.occluded_scattered(rays, blocked);
                } else {
                    count += sent;
                    self.scene.occluded_eights(rays, blocked);
                }
                let (width, end) = (starts.len(), first + starts.len());
                for (rays, blocked) in rays.chunks(width).zip(blocked.chunks(width)) {
                    if let Some(sky) = sky {
                        self.add_light(sky, rays, blocked, &mut light[first..end]);
                    }
                    self.add_shares(rays, blocked, &mut shares[first..end]);
                }
            }
        }
        let all = occlusion.samples as f32;
        for share in shares.as_flattened_mut() {
            *share /= all;
        }
        for value in light.as_flattened_mut().as_flattened_mut() {
            *value /= all;
        }
        count
    }

    /// Adds to the light of some surfaces what comes along a ray of each.
    fn add_light(&self, sky: &Sky, rays: &[Rays8], blocked: &[u32], light: &mut [Lanes3]) {
        for ((light, rays), blocked) in light.iter_mut().zip(rays).zip(blocked) {
            for lane in lanes(rays.there) {
                let ray = rays.get(lane);
                let left = match blocked >> lane & 1 {
                    0 => Rgb::WHITE,
                    _ if self.scene.has_filters() => self.left_of_light(&ray, |_| true),
                    _ => continue,
                };
                let more = left * sky.light(ray.dir);
                set(light, lane, (Rgb::from(get(light, lane)) + more).to_array());
            }
        }
    }

    /// Adds to the shares of some surfaces what is left along a ray of each.
    fn add_shares(&self, rays: &[Rays8], blocked: &[u32], shares: &mut [[f32; 8]]) {
        for ((shares, rays), blocked) in shares.iter_mut().zip(rays).zip(blocked) {
            let free = rays.there & !blocked;
            for (lane, share) in shares.iter_mut().enumerate() {
                *share += (free >> lane & 1) as f32;
            }
            if self.scene.has_filters() {
                for lane in lanes(rays.there & blocked) {
                    let Rgb { r, g, b } = self.left_of_light(&rays.get(lane), |_| true);
                    shares[lane] += (r + g + b) / 3.0;
                }
            }
        }
    }
}

/// Sends some rays from each of some surfaces, where they are above its horizon. The others count as met: as with
/// lights, that is the horizon of N, and of faces as well that stand for no smooth surface.
struct Spread<'a> {
    occlusion: Occlusion,
    /// Which of the rays of a surface.
    numbers: Range<u32>,
    /// Which of the surfaces.
    eights: Range<usize>,
    interactions: &'a Interactions,
    /// Those of these surfaces.
    samplers: &'a [Samplers8],
    starts: &'a [Rays8],
    /// One ray of each surface, then the next of each.
    to: &'a mut [Rays8],
}

impl Kernel for Spread<'_> {
    type Output = u64;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> u64 {
        let Self { occlusion: Occlusion { samples, distance }, numbers, eights, .. } = self;
        let Self { interactions: Interactions { hits, shading, .. }, samplers, starts, to, .. } =
            self;
        let (hits, shading) = (&hits[eights.clone()], &shading[eights]);
        let one = f32x8::splat(simd, 1.0);
        let zero = f32x8::splat(simd, 0.0);
        let width = starts.len();
        let mut count = 0;
        for (i, ((samplers, starts), (hits, shading))) in
            samplers.iter().zip(starts).zip(hits.iter().zip(shading)).enumerate()
        {
            let to = to.iter_mut().skip(i).step_by(width.max(1));
            if hits.met == 0 {
                to.for_each(|to| to.there = 0);
                continue;
            }
            let places = samplers.several(Use::Around);
            let (n, front) = (load3(simd, &shading.n), load3(simd, &shading.front));
            let smooth = mask32x8::from_bitmask(simd, shading.smooth.into());
            for (number, to) in numbers.clone().zip(to) {
                let [u, v] = places.at(number, samples);
                let place = [f32x8::load_array(simd, u), f32x8::load_array(simd, v)];
                let [u, v] = concentric_disc(place);
                let up = one - u * u - v * v;
                let up = up.simd_gt(zero).select(up, zero).sqrt();
                let dir = normalize(add(across(one, n, [u, v]), scale(up, n)));
                let above = is_above(dir, n) & (is_above(dir, front) | smooth);
                to.there = hits.met & above.to_bitmask() as u32;
                to.origin = starts.origin;
                to.dir = store3(dir);
                to.t_max = [distance; 8];
                count += u64::from(to.there.count_ones());
            }
        }
        count
    }
}
