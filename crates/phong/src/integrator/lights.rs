//! What lights add to the surfaces met, eight at a time.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};
use phong_bvh::{Kernel, Rays8, lanes, offset_origins};
use phong_scene::Rgb;

use super::Integrator;
use super::bundle::Radiance8;
use super::met::{Met, is_above, material, same_material, to_eye};
use crate::light::{Light, LightSample, Reach};
use crate::math::Dir3;
use crate::math::lanes::{Lanes3, direction, dot, get, load3, select3, store3};
use crate::sampling::{Samplers8, Use};
use crate::terms::{Term, Terms};
use crate::witness::{LightTold, Witness};

/// What a light sends to the surfaces met.
#[derive(Default)]
pub(super) struct Light8s {
    sent: Vec<Sent>,
    /// The way to the light, from each surface met: `dir` is L, 0 where the surface is where the light
    /// is, and `t_max` the distance. The rays that are there ask whether it is seen.
    ways: Vec<Rays8>,
    blocked: Vec<u32>,
}

/// What a light sends to eight surfaces.
#[derive(Clone, Copy)]
#[repr(align(32))]
struct Sent {
    /// The share of its colours that is left.
    share: [f32; 8],
    /// The surfaces that the light is above, a bit each.
    above: u32,
    /// Of these the ones that get any of its light, and that it is seen from.
    seen: u32,
}

impl Sent {
    const NONE: Self = Self { share: [0.0; 8], above: 0, seen: 0 };

    /// What is sent to one surface, in colours; `None` where the light is.
    fn sample(&self, ways: &Rays8, light: &Light, lane: usize) -> Option<LightSample> {
        let reach = Reach {
            l: direction(&ways.dir, lane),
            distance: ways.t_max[lane],
            share: self.share[lane],
        };
        (get(&ways.dir, lane) != [0.0; 3]).then(|| light.colored(reach))
    }
}

impl Integrator<'_> {
    /// What a light sends to every surface met, and where it is seen from; how many asked that.
    pub(super) fn send(
        &self,
        number: usize,
        rays: &[Rays8],
        met: &Met,
        samplers: &[Samplers8],
        to: &mut Light8s,
    ) -> u64 {
        let light = &self.scene.lights()[number];
        let Light8s { sent, ways, blocked } = to;
        sent.resize(rays.len(), Sent::NONE);
        ways.resize(rays.len(), Rays8::NONE);
        let casts = self.shadows && light.shadows;
        let purpose = Use::Light(number as u32);
        let bvh = self.scene.world();
        let count = bvh.run(Send { light, purpose, casts, rays, met, samplers, sent, ways });
        if casts {
            blocked.resize(rays.len(), 0);
            bvh.occluded_eights(ways, blocked);
            for (sent, blocked) in sent.iter_mut().zip(blocked) {
                sent.seen &= !*blocked;
            }
        }
        count
    }

    /// Adds the light sent to the surfaces it is seen from.
    pub(super) fn shade(
        &self,
        number: usize,
        rays: &[Rays8],
        met: &Met,
        from: &Light8s,
        out: &mut [Radiance8],
    ) {
        self.scene.world().run(Shade { integrator: self, number, rays, met, from, out });
    }

    /// Tells of what [`Integrator::shade`] is about to add.
    pub(super) fn tell<W: Witness>(
        &self,
        number: usize,
        rays: &[Rays8],
        met: &Met,
        from: &Light8s,
        witness: &mut W,
    ) {
        let light = &self.scene.lights()[number];
        let mut alone = vec![Radiance8::NONE; rays.len()];
        self.shade(number, rays, met, from, &mut alone);
        for (i, (sent, ways)) in from.sent.iter().zip(&from.ways).enumerate() {
            for lane in lanes(met.hits[i].met) {
                let at = met.at(rays, i, lane, self.scene.materials().len());
                let has = |mask: u32| mask >> lane & 1 != 0;
                let sample = sent.sample(ways, light, lane);
                let Terms { diffuse, specular, .. } = alone[i].terms.get(lane);
                let of = met.dressed[i].material[lane] as usize;
                let material = material(self.scene, &met.made, of);
                witness.lit(&LightTold {
                    light: number,
                    sample,
                    incident: sample.map(|sample| material.incident(at.n, at.color, &sample)),
                    above: has(sent.above),
                    shadow: has(ways.there).then(|| ways.get(lane)),
                    visible: has(sent.seen),
                    terms: Terms { diffuse, specular, ..Terms::default() },
                });
            }
        }
    }

    /// Adds what a light adds to the ambient term, where a material's rule is per light.
    pub(super) fn ambient_of_light(
        &self,
        number: usize,
        met: &Met,
        from: &Light8s,
        out: &mut [Radiance8],
    ) {
        let light = &self.scene.lights()[number];
        for ((i, sent), out) in from.sent.iter().enumerate().zip(out) {
            for lane in lanes(met.hits[i].met) {
                let dressed = &met.dressed[i];
                let number = dressed.material[lane] as usize;
                let material = material(self.scene, &met.made, number);
                if material.takes_ambient_per_light()
                    && let Some(sample) = sent.sample(&from.ways[i], light, lane)
                {
                    let color = Rgb::from(get(&dressed.color, lane));
                    let more = material.ambient_of_light(color, self.scene.ambient(), &sample);
                    out.terms.add(Term::Ambient, lane, more);
                }
            }
        }
    }
}

struct Send<'a> {
    light: &'a Light,
    purpose: Use,
    /// Whether things stand in its way.
    casts: bool,
    rays: &'a [Rays8],
    met: &'a Met,
    samplers: &'a [Samplers8],
    sent: &'a mut [Sent],
    ways: &'a mut [Rays8],
}

impl Kernel for Send<'_> {
    type Output = u64;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> u64 {
        let Self { light, purpose, casts, rays, met, samplers, sent, ways } = self;
        let brightest = f32x8::splat(simd, light.brightest());
        let mut count = 0;
        let Met { hits, surfaces, dressed, .. } = met;
        let eights = rays.iter().zip(hits).zip(surfaces).zip(dressed).zip(sent).zip(ways);
        for (i, (((((rays, hits), surface), dressed), sent), ways)) in eights.enumerate() {
            (sent.above, sent.seen, ways.there) = (0, 0, 0);
            if hits.met == 0 {
                continue;
            }
            let place = light.soft.then(|| samplers[i].pair(purpose));
            let reach = light.reach8(simd, &surface.p, place.as_ref());
            let (n, ng) = (load3(simd, &dressed.n), load3(simd, &surface.ng));
            let above = is_above(reach.l, n, ng, to_eye(simd, rays));
            // Nothing comes from a spot beyond its edge: nobody need look.
            let bright = (reach.share * brightest).simd_gt(f32x8::splat(simd, 0.0));
            let lit = hits.met & (above & bright).to_bitmask() as u32;
            sent.share = reach.share.into();
            (sent.above, sent.seen) = (hits.met & above.to_bitmask() as u32, lit);
            ways.dir = store3(reach.l);
            ways.t_max = reach.distance.into();
            if casts && lit != 0 {
                ways.origin = offset_origins(simd, surface, reach.l);
                ways.there = lit;
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
    met: &'a Met,
    from: &'a Light8s,
    out: &'a mut [Radiance8],
}

impl Kernel for Shade<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { integrator, number, rays, met, from, out } = self;
        let light = &integrator.scene.lights()[number];
        for (i, ((sent, ways), out)) in from.sent.iter().zip(&from.ways).zip(out).enumerate() {
            let dressed = &met.dressed[i];
            let mut left = sent.seen;
            while left != 0 {
                // Neighbours are mostly of one material.
                let (number, same) = same_material(simd, &dressed.material, left);
                left &= !same;
                let material = material(integrator.scene, &met.made, number);
                let (n, l) = (load3(simd, &dressed.n), load3(simd, &ways.dir));
                let e = material.eye_of(to_eye(simd, &rays[i]));
                if let Some([diffuse, specular]) = material.reflectance.weights(n, e, l) {
                    let color = load3(simd, &dressed.color);
                    let share = f32x8::load_array(simd, sent.share);
                    let [diffuse_color, specular_color] = light.colors();
                    let arriving = [
                        [share * diffuse_color.r, share * diffuse_color.g, share * diffuse_color.b],
                        [
                            share * specular_color.r,
                            share * specular_color.g,
                            share * specular_color.b,
                        ],
                    ];
                    let [c_d, c_s] = material.tint(dot(n, l), color, arriving);
                    let same = mask32x8::from_bitmask(simd, same.into());
                    let terms = &mut out.terms;
                    add(simd, &mut terms[Term::Diffuse], same, diffuse, c_d);
                    add(simd, &mut terms[Term::Specular], same, specular, c_s);
                    continue;
                }
                for lane in lanes(same) {
                    let Some(sample) = sent.sample(ways, light, lane) else { continue };
                    let (n, e) = (direction(&dressed.n, lane), -direction(&rays[i].dir, lane));
                    let color = Rgb::from(get(&dressed.color, lane));
                    let tangent = if material.reflectance.is_brushed() {
                        let (ray, hit) = (rays[i].get(lane), met.hits[i].get(lane));
                        Dir3::from_unit(integrator.scene.coordinates(&ray, &hit).tangent)
                    } else {
                        Dir3::X
                    };
                    let terms = material.shade_light(n, tangent, e, color, &sample);
                    out.terms.add(Term::Diffuse, lane, terms.diffuse);
                    out.terms.add(Term::Specular, lane, terms.specular);
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
    let more = [so_far[0] + weight * r, so_far[1] + weight * g, so_far[2] + weight * b];
    *sum = store3(select3(same, more, so_far));
}
