//! What lights add to the surfaces met, eight at a time.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};
use phong_bvh::{Kernel, Ray};
use phong_scene::Rgb;

use super::Integrator;
use super::met::{Eight, Met, direction, get, set, shadow_ray};
use crate::light::{Light, LightSample, Reach};
use crate::math::Dir3;
use crate::math::lanes::{Lanes3, dot, load3, store3};
use crate::reflectance::Terms;
use crate::sampling::{Sampler, Use};
use crate::witness::{LightTold, Witness};

/// What a light sends to eight surfaces.
#[repr(align(32))]
pub(super) struct Sent {
    /// To the light; 0 where the surface is where the light is.
    l: Lanes3,
    distance: [f32; 8],
    /// The share of its colours that is left.
    share: [f32; 8],
    /// The surfaces that the light is above, a bit each.
    above: u32,
    /// Of these the ones that get any of its light: those that ask whether it is seen.
    lit: u32,
    /// Of these the ones it is seen from.
    seen: u32,
}

impl Sent {
    /// What is sent to one surface, in colours; `None` where the light is.
    fn sample(&self, light: &Light, lane: usize) -> Option<LightSample> {
        let reach = Reach {
            l: direction(&self.l, lane),
            distance: self.distance[lane],
            share: self.share[lane],
        };
        (get(&self.l, lane) != [0.0; 3]).then(|| light.colored(reach))
    }
}

/// The bits of a mask that are set, lowest first.
fn lanes(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (mask != 0).then(|| {
            let lane = mask.trailing_zeros();
            mask &= mask - 1;
            lane as usize
        })
    })
}

impl Integrator<'_> {
    /// What a light sends to every surface met, and the rays that ask whether it is seen, those of
    /// each eight in order.
    pub(super) fn send(
        &self,
        number: usize,
        met: &Met,
        samplers: &[Sampler],
    ) -> (Vec<Sent>, Vec<Ray>) {
        let light = &self.scene.lights()[number];
        let place = |lane: usize, eight: usize| {
            let ray = met.rays.get(8 * eight + lane).copied().unwrap_or(0);
            samplers[ray as usize].pair(Use::Light(number as u32))
        };
        let casts = self.shadows && light.shadows;
        self.scene.bvh().run(Send { light, met, place, casts })
    }

    /// Adds the light sent to the surfaces it is seen from.
    pub(super) fn shade(&self, number: usize, rays: &[Ray], sent: &[Sent], met: &mut Met) {
        let Met { rays: of, hits, eights } = met;
        let tangent = |k: usize| {
            let of = of[k] as usize;
            Dir3::from_unit(self.scene.coordinates(&rays[of], &hits[of]).tangent)
        };
        self.scene.bvh().run(Shade { integrator: self, number, sent, eights, tangent });
    }

    /// Tells of what [`Integrator::shade`] is about to add.
    pub(super) fn tell<W: Witness>(
        &self,
        number: usize,
        rays: &[Ray],
        sent: &[Sent],
        shadow_rays: &[Ray],
        met: &Met,
        witness: &mut W,
    ) {
        let light = &self.scene.lights()[number];
        let mut alone = met.without_light();
        self.shade(number, rays, sent, &mut alone);
        let mut shadow_rays = shadow_rays.iter();
        for k in 0..met.len() {
            let (at, sent, lane) = (met.at(k), &sent[k / 8], k % 8);
            let has = |mask: u32| mask >> lane & 1 != 0;
            let sample = sent.sample(light, lane);
            let given = &alone.eights[k / 8];
            witness.lit(&LightTold {
                light: number,
                sample,
                incident: sample.map(|sample| self.material(&at).incident(at.n, at.color, &sample)),
                above: has(sent.above),
                shadow: if has(sent.lit) { shadow_rays.next().copied() } else { None },
                visible: has(sent.seen),
                terms: Terms {
                    diffuse: Rgb::from(get(&given.diffuse, lane)),
                    specular: Rgb::from(get(&given.specular, lane)),
                    ..Terms::default()
                },
            });
        }
    }

    /// What a light adds to the ambient term, where a material's rule is per light.
    pub(super) fn ambient_of_light(
        &self,
        number: usize,
        sent: &[Sent],
        met: &Met,
        k: usize,
    ) -> Rgb {
        let material = &self.scene.materials()[met.material(k)];
        let sample = sent[k / 8].sample(&self.scene.lights()[number], k % 8);
        sample.filter(|_| material.takes_ambient_per_light()).map_or(Rgb::BLACK, |sample| {
            material.ambient_of_light(met.at(k).color, self.scene.ambient(), &sample)
        })
    }
}

/// Takes away the light that something stands in the way of.
pub(super) fn take_away(sent: &mut [Sent], blocked: &[bool]) {
    let mut blocked = blocked.iter();
    for sent in sent {
        for lane in lanes(sent.lit) {
            sent.seen &= !(u32::from(blocked.next().copied().unwrap_or(false)) << lane);
        }
    }
}

struct Send<'a, P> {
    light: &'a Light,
    met: &'a Met,
    place: P,
    casts: bool,
}

impl<P: Fn(usize, usize) -> [f32; 2]> Kernel for Send<'_, P> {
    type Output = (Vec<Sent>, Vec<Ray>);

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Self::Output {
        let Self { light, met, place, casts } = self;
        let brightest = f32x8::splat(simd, light.brightest());
        let mut sent = Vec::with_capacity(met.eights.len());
        let mut shadow_rays = Vec::with_capacity(if casts { met.len() } else { 0 });
        for (i, eight) in met.eights.iter().enumerate() {
            let reach = if light.soft {
                one_by_one(simd, light, eight, |lane| place(lane, i))
            } else {
                light.reach8(simd, load3(simd, &eight.p))
            };
            let (l, distance, share) = (store3(reach.l), reach.distance.into(), reach.share.into());
            let above = eight.is_above(simd, reach.l);
            // Nothing comes from a spot beyond its edge: nobody need look.
            let bright = (reach.share * brightest).simd_gt(f32x8::splat(simd, 0.0));
            let (above, lit) = (above.to_bitmask() as u32, (above & bright).to_bitmask() as u32);
            if casts && lit != 0 {
                let origins = store3(eight.origins(simd, reach.l));
                for lane in lanes(lit) {
                    let distance: &[f32; 8] = &distance;
                    shadow_rays.push(shadow_ray(&origins, &l, distance[lane], lane));
                }
            }
            sent.push(Sent { l, distance, share, above, lit, seen: lit });
        }
        (sent, shadow_rays)
    }
}

/// What a soft light sends to eight surfaces: to each from a point of its own.
#[inline(always)]
fn one_by_one<S: Simd>(
    simd: S,
    light: &Light,
    eight: &Eight,
    place: impl Fn(usize) -> [f32; 2],
) -> Reach<[f32x8<S>; 3], f32x8<S>> {
    let (mut l, mut distance, mut share) = ([[0.0; 8]; 3], [0.0; 8], [0.0; 8]);
    for lane in 0..8 {
        if let Some(reach) = light.reach(get(&eight.p, lane).into(), place(lane)) {
            set(&mut l, lane, reach.l.to_array());
            (distance[lane], share[lane]) = (reach.distance, reach.share);
        }
    }
    Reach {
        l: load3(simd, &l),
        distance: f32x8::load_array(simd, distance),
        share: f32x8::load_array(simd, share),
    }
}

struct Shade<'a, T> {
    integrator: &'a Integrator<'a>,
    number: usize,
    sent: &'a [Sent],
    eights: &'a mut [Eight],
    tangent: T,
}

impl<T: Fn(usize) -> Dir3> Kernel for Shade<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { integrator, number, sent, eights, tangent } = self;
        let light = &integrator.scene.lights()[number];
        for (i, (eight, sent)) in eights.iter_mut().zip(sent).enumerate() {
            let mut left = sent.seen;
            while left != 0 {
                // Neighbours are mostly of one material.
                let number = eight.material[left.trailing_zeros() as usize];
                let mut same = 0;
                for (lane, &other) in eight.material.iter().enumerate() {
                    same |= u32::from(other == number) << lane;
                }
                same &= left;
                left &= !same;
                let material = &integrator.scene.materials()[number as usize];
                let (n, e, l) =
                    (load3(simd, &eight.n), load3(simd, &eight.e), load3(simd, &sent.l));
                if let Some([diffuse, specular]) =
                    material.reflectance.weights8(n, material.eye8(e), l)
                {
                    let color = load3(simd, &eight.color);
                    let share = f32x8::load_array(simd, sent.share);
                    let [c_d, c_s] = material.incident8(dot(n, l), color, light.colors(), share);
                    let same = mask32x8::from_bitmask(simd, same.into());
                    add(simd, &mut eight.diffuse, same, diffuse, c_d);
                    add(simd, &mut eight.specular, same, specular, c_s);
                    continue;
                }
                for lane in lanes(same) {
                    let Some(sample) = sent.sample(light, lane) else { continue };
                    let (n, e) = (direction(&eight.n, lane), direction(&eight.e, lane));
                    let color = Rgb::from(get(&eight.color, lane));
                    let brushed = material.reflectance.is_brushed();
                    let tangent = if brushed { tangent(8 * i + lane) } else { Dir3::X };
                    let terms = material.shade_light(n, tangent, e, color, &sample);
                    let so_far = Rgb::from(get(&eight.diffuse, lane));
                    set(&mut eight.diffuse, lane, (so_far + terms.diffuse).to_array());
                    let so_far = Rgb::from(get(&eight.specular, lane));
                    set(&mut eight.specular, lane, (so_far + terms.specular).to_array());
                }
            }
        }
    }
}

/// Adds `weight · color` to the lanes of `same`.
#[inline(always)]
fn add<S: Simd>(
    simd: S,
    sum: &mut Lanes3,
    same: mask32x8<S>,
    weight: f32x8<S>,
    [r, g, b]: [f32x8<S>; 3],
) {
    let so_far = load3(simd, sum);
    let plus = |so_far: f32x8<S>, color: f32x8<S>| same.select(so_far + weight * color, so_far);
    *sum = store3([plus(so_far[0], r), plus(so_far[1], g), plus(so_far[2], b)]);
}
