//! What happens to a ray: intersect → interaction → material → lights and shadows → [`Terms`]. Mirror
//! and glass rays are traced the same way, to a maximal depth.
//!
//! Rays are traced in bundles of about a tile's worth, eight side by side, so that vector code can load
//! them as they are and the hierarchy can use what they have in common. A single ray takes the same
//! steps with seven lanes idle; `explain` traces its rays like that.
//!
//! [`Terms`]: crate::terms::Terms

mod bundle;
mod crossing;
mod filtered;
mod fog;
mod interactions;
mod lamps;
mod lights;
mod openness;
mod optics;
mod shadow_rays;
mod shares;
mod widths;

pub use bundle::RayCounts;
pub(crate) use bundle::{Bundle, CameraRay, Radiance8};
pub(crate) use crossing::first_seen;
pub(crate) use shares::Shares;
pub(crate) use widths::SampleGrid;

use std::sync::atomic::{AtomicBool, Ordering};

use phong_bvh::{Ray, Rays8, lanes};
use phong_scene::{Background, Rgb};

use crate::sampling::{Sampler, Samplers8};
use crate::texture::Cone;
use crate::view::View;
use crate::witness::{Branch, Cut, CutReason, Witness};
use bundle::count;
use crossing::Departure;
use fog::Way;
use interactions::Interactions;
use lights::LightSamples;
use openness::Openness;
use optics::{Scatter, Scattered8};

/// Traces rays through a scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Integrator<'a> {
    /// What rays meet.
    pub(crate) scene: &'a View,
    /// Mirror and glass bounces; beyond it a ray brings black.
    pub(crate) depth: u32,
    /// The least product of weights, in the largest channel, for which a ray is followed.
    pub(crate) min_weight: f32,
    /// Whether things stand in the way of lights at all.
    pub(crate) shadows: bool,
    /// Whether shadow rays from meshes with smooth normals start above the face.
    pub(crate) terminator: bool,
    /// The picture that rays are samples of.
    pub(crate) grid: SampleGrid,
    /// Which shares of the light are kept beside all of it.
    pub(crate) shares: Shares,
    /// Once true, whatever is under way ends soon, and what it brought is unspecified. `None`:
    /// nothing stops it.
    pub(crate) stop: Option<&'a AtomicBool>,
}

/// Memory for tracing a bundle, used again for the next one.
#[derive(Default)]
pub(crate) struct ScratchBuffer {
    interactions: Interactions,
    openness: Openness,
    /// How far rays went; empty where there is no fog.
    ways: Vec<[Way; 8]>,
    lights: LightSamples,
    out: Vec<Radiance8>,
    /// The shares of that light which are kept beside it, in their order.
    shares: Vec<Vec<Radiance8>>,
    /// The mirror or refracted rays of this bundle, and the memory for tracing them.
    deeper: Option<Box<(SecondaryRays, ScratchBuffer)>>,
}

impl ScratchBuffer {
    /// The shares of what the bundle brought that was traced last, in the order of [`Shares`]: each result is
    /// in its ray's lane.
    pub(crate) fn shares(&self) -> &[Vec<Radiance8>] {
        &self.shares
    }
}

/// The mirror rays, or the refracted rays, of a bundle.
#[derive(Default)]
struct SecondaryRays {
    rays: Vec<Rays8>,
    samplers: Vec<Samplers8>,
    /// Where each ray came from, in the same order.
    from: Vec<Parent>,
    /// What each has behind it, in the same order.
    paths: Paths,
    /// The rays of each surface, in its lane, before they are packed.
    scattered: Vec<Scattered8>,
}

/// What rays have behind them, in their order. Empty: they come from the camera.
#[derive(Default)]
struct Paths {
    /// The product of all weights from the camera on.
    weights: Vec<Rgb>,
    /// Where each starts; empty where no scene asks for it.
    departures: Vec<Departure>,
    /// How far each has gone in fog; empty where there is none.
    ways: Vec<Way>,
    /// How wide each is; empty where no image asks for it.
    cones: Vec<Cone>,
}

/// How far rays are followed.
#[derive(Clone, Copy, Debug)]
struct Steps {
    /// How many mirror and glass bounces more are allowed.
    bounces: u32,
    /// How many see-through surfaces they have passed in a straight line.
    passed: u32,
}

impl Steps {
    /// The most see-through surfaces that are passed; beyond them a ray brings black.
    const MOST_PASSED: u32 = 100;

    fn are_over(self, branch: Branch) -> bool {
        match branch {
            Branch::Reflection | Branch::Transmission => self.bounces == 0,
            Branch::Through => self.passed >= Self::MOST_PASSED,
        }
    }

    /// Those of rays that went on this way.
    fn after(self, branch: Branch) -> Self {
        match branch {
            Branch::Reflection | Branch::Transmission => Self { bounces: self.bounces - 1, ..self },
            Branch::Through => Self { passed: self.passed + 1, ..self },
        }
    }
}

/// The ray that a mirror or refracted ray came from.
struct Parent {
    /// The number of its eight, and its lane.
    ray: (usize, usize),
    /// How much of the new ray's light is added to it.
    weight: Rgb,
    fresnel: Option<f32>,
}

impl SecondaryRays {
    fn clear(&mut self) {
        self.rays.clear();
        self.samplers.clear();
        self.from.clear();
        self.paths.weights.clear();
        self.paths.departures.clear();
        self.paths.ways.clear();
        self.paths.cones.clear();
    }

    fn push(&mut self, parent: Parent, path_weight: Rgb, ray: &Ray, sampler: Option<Sampler>) {
        let lane = self.from.len() % 8;
        if lane == 0 {
            self.rays.push(Rays8::NONE);
            self.samplers.extend(sampler.map(Samplers8::splat));
        }
        if let Some(rays) = self.rays.last_mut() {
            rays.set(lane, ray);
        }
        if let (Some(samplers), Some(sampler)) = (self.samplers.last_mut(), sampler) {
            samplers.set(lane, sampler);
        }
        self.from.push(parent);
        self.paths.weights.push(path_weight);
    }
}

impl Integrator<'_> {
    /// Traces a ray from the camera and its mirror and refracted rays. The result is in the first lane.
    pub(crate) fn trace_one<W: Witness>(
        &self,
        ray: CameraRay,
        counts: &mut RayCounts,
        witness: &mut W,
    ) -> Radiance8 {
        self.trace(&ray.into(), &mut ScratchBuffer::default(), counts, witness)[0]
    }

    /// Traces rays from the camera and their mirror and refracted rays. Each result is in its ray's lane.
    pub(crate) fn trace<'w, W: Witness>(
        &self,
        bundle: &Bundle,
        scratch: &'w mut ScratchBuffer,
        counts: &mut RayCounts,
        witness: &mut W,
    ) -> &'w [Radiance8] {
        counts.primary += count(&bundle.rays);
        let height = |i: usize, lane: usize| bundle.heights[i][lane];
        self.trace_bundle(
            &bundle.rays,
            &bundle.samplers,
            &height,
            &Paths::default(),
            Steps { bounces: self.depth, passed: 0 },
            scratch,
            counts,
            witness,
        );
        &scratch.out
    }

    /// Traces a bundle. `height` gives the place in a gradient background, 0 to 1, of a ray that hits
    /// nothing. `paths` are what the rays have behind them. The results are in `scratch.out`, and what is kept
    /// beside them in `scratch.shares`.
    #[expect(clippy::too_many_arguments, reason = "the state of the recursion")]
    fn trace_bundle<W: Witness>(
        &self,
        rays: &[Rays8],
        samplers: &[Samplers8],
        height: &dyn Fn(usize, usize) -> f32,
        paths: &Paths,
        steps: Steps,
        scratch: &mut ScratchBuffer,
        counts: &mut RayCounts,
        witness: &mut W,
    ) {
        let ScratchBuffer { interactions, openness, ways, lights, out, shares, deeper } = scratch;
        if self.is_stopped() {
            out.resize(rays.len(), Radiance8::NONE);
            self.shares.begin(interactions, out, shares);
            return;
        }
        interactions.intersect(self, rays, paths, steps.passed, height, out);
        if let Some(fog) = self.scene.fog() {
            fog::measure(fog, rays, interactions, paths, ways);
        }
        openness.begin();
        if let Some(occlusion) = self.scene.occlusion() {
            counts.shadow += self.look_around(occlusion, interactions, samplers, openness);
            openness.dim(out);
        }
        self.shares.begin(interactions, out, shares);
        lights.begin();
        if W::LISTENS {
            for (i, (rays8, out)) in rays.iter().zip(&*out).enumerate() {
                for lane in lanes(rays8.there) {
                    let terms = out.terms.get(lane);
                    if let Some((light, distance)) = interactions.lamp(i, lane) {
                        witness.saw(&rays8.get(lane), light, distance, terms.emission);
                    } else if out.met >> lane & 1 != 0 {
                        witness.met(
                            &rays8.get(lane),
                            &interactions.at(rays, i, lane, self.scene.materials().len()),
                            terms,
                        );
                        if let Some(covers) = interactions.covers.get(i) {
                            witness.covered(covers[lane]);
                        }
                        if let Some(share) = openness.share(i, lane) {
                            witness.opened(share);
                        }
                        if let Some(light) = openness.light(i, lane) {
                            witness.lit_by_sky(light);
                        }
                    } else {
                        witness.missed(&rays8.get(lane), terms.background);
                    }
                }
            }
        }
        // A witness is told of every light, so then none is skipped.
        let bounds = (self.scene.has_ends() && !W::LISTENS).then(|| interactions.bounds());
        for light in 0..self.scene.lights().len() {
            if self.is_stopped() {
                return;
            }
            if let Some(bounds) = bounds
                && !bounds.is_some_and(|bounds| self.scene.lights()[light].may_reach(bounds))
            {
                continue;
            }
            counts.shadow += self.sample_light(light, rays, interactions, samplers, lights);
            if W::LISTENS {
                self.report_light(light, rays, interactions, lights, witness);
            }
            let share = self.shares.place(light).and_then(|place| shares.get_mut(place));
            for out in std::iter::once(&mut *out).chain(share) {
                if self.scene.has_ambient_per_light() {
                    self.ambient_of_light(light, interactions, lights, openness, out);
                }
                self.shade(light, rays, interactions, lights, out);
            }
        }
        let is_transparent = self.scene.background() == Background::Transparent;
        for branch in [Branch::Reflection, Branch::Transmission, Branch::Through] {
            let is_asked_for = match branch {
                Branch::Reflection | Branch::Transmission => self.scene.has_bounces(),
                Branch::Through => self.scene.has_see_through(),
            };
            if !is_asked_for {
                continue;
            }
            let (secondary, scratch) = &mut **deeper.get_or_insert_default();
            self.scatter(
                branch,
                rays,
                interactions,
                samplers,
                paths,
                ways,
                steps,
                secondary,
                witness,
            );
            if secondary.from.is_empty() {
                continue;
            }
            for (k, Parent { weight, fresnel, .. }) in secondary.from.iter().enumerate() {
                witness.entered(branch, *weight, *fresnel, &secondary.rays[k / 8].get(k % 8));
            }
            counts.secondary += secondary.from.len() as u64;
            let up = self.scene.camera().up();
            let height = |i: usize, lane: usize| match branch {
                Branch::Reflection | Branch::Transmission => {
                    0.5 - 0.5 * secondary.rays[i].get(lane).dir.dot(up)
                }
                // It is where the ray was going anyway.
                Branch::Through => {
                    let (i, lane) = secondary.from[8 * i + lane].ray;
                    height(i, lane)
                }
            };
            let SecondaryRays { rays, samplers, from, paths, .. } = &*secondary;
            self.trace_bundle(
                rays,
                samplers,
                &height,
                paths,
                steps.after(branch),
                scratch,
                counts,
                witness,
            );
            for (k, &Parent { ray: (i, lane), weight, .. }) in from.iter().enumerate() {
                let light = scratch.out[k / 8].terms.get(k % 8).total();
                witness.left(branch, light);
                out[i].take(branch, lane, weight * light);
                for (to, from) in shares.iter_mut().zip(&scratch.shares) {
                    let light = from[k / 8].terms.get(k % 8).total();
                    to[i].take(branch, lane, weight * light);
                }
                if branch != Branch::Reflection && is_transparent {
                    for to in std::iter::once(&mut *out).chain(&mut *shares) {
                        to[i].see_through(lane, weight, (&scratch.out[k / 8], k % 8));
                    }
                }
            }
        }
        if let Some(fog) = self.scene.fog() {
            fog::fade(self.scene, fog, true, rays, ways, out, witness);
            for (place, share) in shares.iter_mut().enumerate() {
                let glows = self.shares.is_unlit(place);
                fog::fade(self.scene, fog, glows, rays, ways, share, &mut ());
            }
        }
    }

    fn is_stopped(&self) -> bool {
        self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
    }

    /// Collects the mirror rays, or the refracted ones, of the surfaces.
    #[expect(clippy::too_many_arguments, reason = "the state of the recursion")]
    fn scatter<W: Witness>(
        &self,
        branch: Branch,
        rays: &[Rays8],
        interactions: &Interactions,
        samplers: &[Samplers8],
        paths: &Paths,
        ways: &[[Way; 8]],
        steps: Steps,
        secondary: &mut SecondaryRays,
        witness: &mut W,
    ) {
        secondary.clear();
        let mut scattered = std::mem::take(&mut secondary.scattered);
        scattered.resize(rays.len(), Scattered8::NONE);
        let to = &mut *scattered;
        self.scene.world().run(Scatter { scene: self.scene, branch, rays, interactions, to });
        for (i, scattered) in scattered.iter().enumerate() {
            for lane in lanes(scattered.there) {
                let (weight, fresnel) = scattered.weight(lane);
                let so_far = paths.weights.get(8 * i + lane).copied().unwrap_or(Rgb::WHITE);
                let path_weight = so_far * weight;
                let reason = if steps.are_over(branch) {
                    Some(CutReason::Depth)
                } else if path_weight.max_channel() < self.min_weight {
                    Some(CutReason::Weight(self.min_weight))
                } else {
                    None
                };
                if let Some(reason) = reason {
                    witness.cut(branch, &Cut { weight, fresnel, path_weight, reason });
                    continue;
                }
                let sampler = samplers.get(i).map(|s| s.get(lane).branch(branch as u32));
                if !interactions.widths.is_empty() {
                    let behind = paths.cones.get(8 * i + lane).copied();
                    let on = (branch, scattered);
                    let cone = self.cone_on(&rays[i], interactions, behind, (i, lane), on);
                    secondary.paths.cones.push(cone);
                }
                secondary.paths.ways.extend(ways.get(i).map(|ways| ways[lane].on(branch)));
                let parent = Parent { ray: (i, lane), weight, fresnel };
                let mut ray = scattered.ray(lane);
                if self.scene.coincidences().is_some() {
                    let departure = interactions.depart(branch, i, lane, &mut ray);
                    secondary.paths.departures.push(departure);
                }
                secondary.push(parent, path_weight, &ray, sampler);
            }
        }
        secondary.scattered = scattered;
    }
}
