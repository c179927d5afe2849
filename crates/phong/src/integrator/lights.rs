//! What lights add to the surfaces that rays hit, eight at a time.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};
use phong_bvh::{Hit, Hits8, Kernel, Rays8, lanes};
use phong_scene::Rgb;

use super::Integrator;
use super::bundle::Radiance8;
use super::interactions::{Interactions, add_in, is_above, material, same_material, to_eye};
use super::openness::Openness;
use super::shadow_rays::{Starts, aim};
use crate::light::{Light, LightSample, Reach};
use crate::math::Dir3;
use crate::math::lanes::{Lanes3, direction, dot, get, load3, scale, set, store3};
use crate::sampling::{Samplers8, Use, pairs};
use crate::terms::{Term, Terms};
use crate::view::Fixture;
use crate::witness::{LightContribution, Witness};

/// What one light sends to each surface that a bundle's rays hit.
#[derive(Default)]
pub(super) struct LightSamples {
    samples: Vec<LightSample8>,
    /// The places of a soft light that they are of, in the unit square.
    places: Vec<[[f32; 8]; 2]>,
    /// The rays that are needed to find out whether the light is visible.
    shadow_rays: Vec<Rays8>,
    /// Whether they are put to where they start, which is the same for all lights.
    started: bool,
    blocked: Vec<u32>,
    /// What they hit, where that matters.
    hits: Vec<Hits8>,
    /// What is left of the light on its way, channel by channel; empty where things take all of it or
    /// nothing.
    left: Vec<Lanes3>,
}

/// What one light sends to eight surfaces.
#[derive(Clone, Copy)]
#[repr(align(32))]
struct LightSample8 {
    /// L; 0 where the surface point is the light's own position.
    l: Lanes3,
    distance: [f32; 8],
    /// The share of the light's colours that arrives.
    share: [f32; 8],
    /// The surfaces above whose horizon the light is, one bit each: that of N, and where things cast
    /// shadows, of faces as well that stand for no smooth surface.
    above: u32,
    /// The surfaces that receive light: the light is above the horizon, is not 0 there, and nothing
    /// blocks it. One bit each.
    visible: u32,
}

impl LightSamples {
    /// What is left of the light on its way to a surface that it is seen from.
    fn left_of(&self, i: usize, lane: usize) -> Rgb {
        self.left.get(i).map_or(Rgb::WHITE, |left| Rgb::from(get(left, lane)))
    }

    /// Forgets where the surfaces of another bundle are.
    pub(super) fn begin(&mut self) {
        self.started = false;
    }
}

impl LightSample8 {
    const NONE: Self =
        Self { l: [[0.0; 8]; 3], distance: [0.0; 8], share: [0.0; 8], above: 0, visible: 0 };

    /// What is sent to one surface; `None` where the surface point is the light's position.
    fn get(&self, light: &Light, lane: usize) -> Option<LightSample> {
        let (l, distance) = (direction(&self.l, lane), self.distance[lane]);
        let reach = Reach { l, distance, share: self.share[lane] };
        (get(&self.l, lane) != [0.0; 3]).then(|| light.colored(reach))
    }
}

impl Integrator<'_> {
    /// Works out what a light sends to every surface and whether it is visible from there. Returns the
    /// number of shadow rays.
    pub(super) fn sample_light(
        &self,
        number: usize,
        rays: &[Rays8],
        interactions: &Interactions,
        samplers: &[Samplers8],
        to: &mut LightSamples,
    ) -> u64 {
        let light = &self.scene.lights()[number];
        let LightSamples { samples, places, shadow_rays, started, blocked, hits, left } = to;
        left.clear();
        samples.resize(rays.len(), LightSample8::NONE);
        shadow_rays.resize(rays.len(), Rays8::NONE);
        let casts = self.shadows && light.shadows;
        let purpose = Use::Light(number as u32);
        let (bvh, fixture) = (self.scene.world(), self.scene.fixture(number));
        if casts && !*started {
            bvh.run(Starts { interactions, to: &mut *shadow_rays });
            *started = true;
        }
        let count = bvh.run(SampleLight {
            light,
            fixture,
            purpose,
            casts,
            interactions,
            samplers,
            samples,
            places,
            shadow_rays,
        });
        if self.scene.has_filters() {
            left.resize(rays.len(), [[1.0; 8]; 3]);
        }
        if casts && fixture.has_bodies() {
            hits.resize(rays.len(), Hits8::NONE);
            self.scene.intersect_eights(shadow_rays, hits);
            blocked.resize(rays.len(), 0);
            for ((samples, hits), blocked) in samples.iter_mut().zip(hits).zip(&mut *blocked) {
                // What is seen first may be the luminous body that the light is in.
                let blocks = |&lane: &usize| !fixture.is_body(&hits.get(lane));
                *blocked = lanes(hits.met).filter(blocks).fold(0, |all, lane| all | 1 << lane);
                samples.visible &= !*blocked;
            }
        } else if casts {
            blocked.resize(rays.len(), 0);
            self.scene.occluded_eights(shadow_rays, blocked);
            for (samples, blocked) in samples.iter_mut().zip(&*blocked) {
                samples.visible &= !*blocked;
            }
        }
        if casts {
            for (i, left) in left.iter_mut().enumerate() {
                let rays = &shadow_rays[i];
                for lane in lanes(rays.there & blocked[i]) {
                    let counts = |hit: &Hit| !fixture.is_body(hit);
                    let passes = self.left_of_light(&rays.get(lane), counts);
                    if !passes.is_black() {
                        set(left, lane, passes.to_array());
                        samples[i].visible |= 1 << lane;
                    }
                }
            }
        }
        count
    }

    /// Adds the light to the surfaces from which it is visible.
    pub(super) fn shade(
        &self,
        number: usize,
        rays: &[Rays8],
        interactions: &Interactions,
        from: &LightSamples,
        out: &mut [Radiance8],
    ) {
        self.scene.world().run(Shade { integrator: self, number, rays, interactions, from, out });
    }

    /// Reports what [`Integrator::shade`] is about to add.
    pub(super) fn report_light<W: Witness>(
        &self,
        number: usize,
        rays: &[Rays8],
        interactions: &Interactions,
        from: &LightSamples,
        witness: &mut W,
    ) {
        let light = &self.scene.lights()[number];
        let mut alone = vec![Radiance8::NONE; rays.len()];
        self.shade(number, rays, interactions, from, &mut alone);
        for (i, (samples, shadow_rays)) in from.samples.iter().zip(&from.shadow_rays).enumerate() {
            for lane in lanes(interactions.hits[i].met) {
                let at = interactions.at(rays, i, lane, self.scene.materials().len());
                let has = |mask: u32| mask >> lane & 1 != 0;
                let sample = samples.get(light, lane);
                let left = from.left_of(i, lane);
                let Terms { diffuse, specular, .. } = alone[i].terms.get(lane);
                let of = interactions.shading[i].material[lane] as usize;
                let material = material(self.scene, &interactions.made, of);
                witness.lit(&LightContribution {
                    light: number,
                    sample,
                    incident: sample
                        .map(|sample| material.incident(at.n, at.color, &sample.filtered(left))),
                    visibility: if has(samples.visible) { left } else { Rgb::BLACK },
                    above: has(samples.above),
                    shadow: has(shadow_rays.there).then(|| shadow_rays.get(lane)),
                    lifted: has(shadow_rays.there & interactions.shading[i].smooth),
                    visible: has(samples.visible),
                    terms: Terms { diffuse, specular, ..Terms::default() },
                });
            }
        }
    }

    /// Adds what a light adds to the ambient term, where a material's rule is per light.
    pub(super) fn ambient_of_light(
        &self,
        number: usize,
        interactions: &Interactions,
        from: &LightSamples,
        openness: &Openness,
        out: &mut [Radiance8],
    ) {
        let light = &self.scene.lights()[number];
        for ((i, samples), out) in from.samples.iter().enumerate().zip(out) {
            for lane in lanes(interactions.hits[i].met) {
                let shading = &interactions.shading[i];
                let number = shading.material[lane] as usize;
                let material = material(self.scene, &interactions.made, number);
                if material.takes_ambient_per_light()
                    && let Some(sample) = samples.get(light, lane)
                {
                    let color = Rgb::from(get(&shading.color, lane));
                    let more = material.ambient_of_light(color, self.scene.ambient(), &sample);
                    let cover = interactions.covers.get(i).map_or(1.0, |covers| covers[lane]);
                    let share = openness.share(i, lane).unwrap_or(1.0);
                    out.terms.add(Term::Ambient, lane, more * cover * share);
                }
            }
        }
    }
}

struct SampleLight<'a> {
    light: &'a Light,
    fixture: &'a Fixture,
    purpose: Use,
    /// Whether objects can block it.
    casts: bool,
    interactions: &'a Interactions,
    samplers: &'a [Samplers8],
    samples: &'a mut [LightSample8],
    places: &'a mut Vec<[[f32; 8]; 2]>,
    shadow_rays: &'a mut [Rays8],
}

impl Kernel for SampleLight<'_> {
    type Output = u64;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> u64 {
        let Self { light, fixture, purpose, casts, interactions, .. } = self;
        let Self { samplers, samples, places, shadow_rays, .. } = self;
        if light.soft {
            pairs(samplers, purpose, places);
        }
        let brightest = f32x8::splat(simd, light.brightest());
        let mut count = 0;
        let Interactions { hits, surfaces, shading, .. } = interactions;
        let len = samples.len();
        let (hits, surfaces, shading) = (&hits[..len], &surfaces[..len], &shading[..len]);
        let shadow_rays = &mut shadow_rays[..len];
        for (i, samples) in samples.iter_mut().enumerate() {
            let (hits, surface, shading) = (&hits[i], &surfaces[i], &shading[i]);
            let shadow_rays = &mut shadow_rays[i];
            (samples.above, samples.visible, shadow_rays.there) = (0, 0, 0);
            if hits.met == 0 {
                continue;
            }
            let place = light.soft.then(|| &places[i]);
            let reach = light.reach8(simd, &surface.p, place);
            let mut above = is_above(reach.l, load3(simd, &shading.n));
            if casts {
                // Smooth meshes have no horizon but N's: what else is below meets the mesh.
                let smooth = mask32x8::from_bitmask(simd, shading.smooth.into());
                above &= is_above(reach.l, load3(simd, &shading.front)) | smooth;
            }
            // A spot sends nothing beyond its edge: no shadow ray is needed.
            let bright = (reach.share * brightest).simd_gt(f32x8::splat(simd, 0.0));
            let lit = hits.met & (above & bright).to_bitmask() as u32;
            samples.share = reach.share.into();
            (samples.above, samples.visible) = (hits.met & above.to_bitmask() as u32, lit);
            samples.l = store3(reach.l);
            samples.distance = reach.distance.into();
            if casts && lit != 0 {
                aim(simd, (surface, shading), &reach, fixture, shadow_rays);
                shadow_rays.there = lit;
                count += u64::from(lit.count_ones());
            }
        }
        count
    }
}

struct Shade<'a> {
    integrator: &'a Integrator<'a>,
    number: usize,
    rays: &'a [Rays8],
    interactions: &'a Interactions,
    from: &'a LightSamples,
    out: &'a mut [Radiance8],
}

impl Kernel for Shade<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { integrator, number, rays, interactions, from, out } = self;
        let light = &integrator.scene.lights()[number];
        for (i, (samples, out)) in from.samples.iter().zip(out).enumerate() {
            let shading = &interactions.shading[i];
            let mut left = samples.visible;
            while left != 0 {
                // Neighbours are mostly of one material.
                let (number, same) = same_material(simd, &shading.material, left);
                left &= !same;
                let material = material(integrator.scene, &interactions.made, number);
                let (n, l) = (load3(simd, &shading.n), load3(simd, &samples.l));
                let e = material.eye_of(to_eye(simd, &rays[i]));
                if let Some([diffuse, specular]) = material.reflectance.weights(n, e, l) {
                    let color = load3(simd, &shading.color);
                    let share = f32x8::load_array(simd, samples.share);
                    let [diffuse_color, specular_color] = light.colors();
                    let mut arriving = [
                        [share * diffuse_color.r, share * diffuse_color.g, share * diffuse_color.b],
                        [
                            share * specular_color.r,
                            share * specular_color.g,
                            share * specular_color.b,
                        ],
                    ];
                    if let Some(left) = from.left.get(i) {
                        let left = load3(simd, left);
                        for [r, g, b] in &mut arriving {
                            (*r, *g, *b) = (*r * left[0], *g * left[1], *b * left[2]);
                        }
                    }
                    let [c_d, c_s] = material.tint(dot(n, l), color, arriving);
                    let same = mask32x8::from_bitmask(simd, same.into());
                    let (mut diffuse, mut specular) = (scale(diffuse, c_d), scale(specular, c_s));
                    if let Some(covers) = interactions.covers.get(i) {
                        let cover = f32x8::load_array_ref(simd, covers);
                        (diffuse, specular) = (scale(cover, diffuse), scale(cover, specular));
                    }
                    add_in(simd, &mut out.terms[Term::Diffuse], same, diffuse);
                    add_in(simd, &mut out.terms[Term::Specular], same, specular);
                    continue;
                }
                for lane in lanes(same) {
                    let Some(sample) = samples.get(light, lane) else { continue };
                    let (n, e) = (direction(&shading.n, lane), -direction(&rays[i].dir, lane));
                    let color = Rgb::from(get(&shading.color, lane));
                    let tangent = if material.reflectance.is_brushed() {
                        let (ray, hit) = (rays[i].get(lane), interactions.hits[i].get(lane));
                        Dir3::from_unit(integrator.scene.coordinates(&ray, &hit).tangent)
                    } else {
                        Dir3::X
                    };
                    let sample = sample.filtered(from.left_of(i, lane));
                    let terms = material.shade_light(n, tangent, e, color, &sample);
                    let cover = interactions.covers.get(i).map_or(1.0, |covers| covers[lane]);
                    out.terms.add(Term::Diffuse, lane, terms.diffuse * cover);
                    out.terms.add(Term::Specular, lane, terms.specular * cover);
                }
            }
        }
    }
}
