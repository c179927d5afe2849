//! The road of a ray: intersect → interaction → material → lights and shadows → [`Terms`]; mirror
//! and glass rays go the same road, to a depth.
//!
//! Rays travel in bundles, a tile's worth at a time, eight side by side, so that vector code finds
//! them in order and the hierarchy can use what they have in common. One ray takes this very road
//! too, with seven lanes idle, which is how `explain` is told.
//!
//! [`Terms`]: crate::terms::Terms

mod bundle;
mod lights;
mod met;
mod optics;

pub use bundle::RayCounts;
pub(crate) use bundle::{Bundle, CameraRay, Radiance8};

use std::sync::atomic::{AtomicBool, Ordering};

use phong_bvh::{Ray, Rays8, lanes};
use phong_scene::{Background, Rgb};

use crate::math::lanes::set;
use crate::sampling::{Sampler, Samplers8};
use crate::view::View;
use crate::witness::{Branch, Witness};
use bundle::count;
use lights::Light8s;
use met::Met;
use optics::{Part, Parting8};

/// Traces rays through a scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Integrator<'a> {
    /// What rays meet.
    pub(crate) scene: &'a View,
    /// What rays see that meet nothing.
    pub(crate) background: Background,
    /// Mirror and glass bounces; beyond it a ray brings black.
    pub(crate) depth: u32,
    /// Whether things stand in the way of lights at all.
    pub(crate) shadows: bool,
    /// Once true, whatever is under way ends soon, and what it brought is unspecified. `None`:
    /// nothing stops it.
    pub(crate) stop: Option<&'a AtomicBool>,
}

/// Room for the work on a bundle, used again for the next one.
#[derive(Default)]
pub(crate) struct Work {
    met: Met,
    lights: Light8s,
    out: Vec<Radiance8>,
    /// For the rays that go on from the surfaces met.
    deeper: Option<Box<(Onward, Work)>>,
}

/// Rays that go on from surfaces.
#[derive(Default)]
struct Onward {
    rays: Vec<Rays8>,
    samplers: Vec<Samplers8>,
    /// For each of them, in order, where it came from.
    from: Vec<Step>,
    /// What goes on from each of the surfaces met, before it is put in order.
    partings: Vec<Parting8>,
}

/// Where a ray came from that goes on.
struct Step {
    /// The eight and the lane of the bundle's ray.
    parent: (usize, usize),
    weight: Rgb,
    fresnel: Option<f32>,
}

impl Onward {
    fn clear(&mut self) {
        self.rays.clear();
        self.samplers.clear();
        self.from.clear();
    }

    fn push(&mut self, step: Step, ray: &Ray, sampler: Option<Sampler>) {
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
        self.from.push(step);
    }
}

impl Integrator<'_> {
    /// Traces a ray from the camera, and all that follow from it. It is in the first lane.
    pub(crate) fn trace_one<W: Witness>(
        &self,
        ray: CameraRay,
        counts: &mut RayCounts,
        witness: &mut W,
    ) -> Radiance8 {
        self.trace(&ray.into(), &mut Work::default(), counts, witness)[0]
    }

    /// Traces rays from the camera, and all that follow from them; what each brings, in its lane.
    pub(crate) fn trace<'w, W: Witness>(
        &self,
        bundle: &Bundle,
        work: &'w mut Work,
        counts: &mut RayCounts,
        witness: &mut W,
    ) -> &'w [Radiance8] {
        counts.primary += count(&bundle.rays);
        let height = |i: usize, lane: usize| bundle.heights[i][lane];
        self.follow(&bundle.rays, &bundle.samplers, &height, self.depth, work, counts, witness);
        &work.out
    }

    /// The road itself. `height` tells where in the background's height a ray ends that meets
    /// nothing; `bounces` are left. What the rays bring is in `work.out`.
    #[expect(clippy::too_many_arguments, reason = "the state of the road, handed on as it is")]
    fn follow<W: Witness>(
        &self,
        rays: &[Rays8],
        samplers: &[Samplers8],
        height: &dyn Fn(usize, usize) -> f32,
        bounces: u32,
        work: &mut Work,
        counts: &mut RayCounts,
        witness: &mut W,
    ) {
        let Work { met, lights, out, deeper } = work;
        if self.is_stopped() {
            out.resize(rays.len(), Radiance8::NONE);
            return;
        }
        met.meet(self, rays, height, out);
        if W::LISTENS {
            for (i, (rays8, out)) in rays.iter().zip(&*out).enumerate() {
                for lane in lanes(rays8.there) {
                    let terms = out.terms.get(lane);
                    if out.met >> lane & 1 != 0 {
                        witness.met(
                            &rays8.get(lane),
                            &met.at(rays, i, lane, self.scene.materials().len()),
                            terms,
                        );
                    } else {
                        witness.missed(&rays8.get(lane), terms.background);
                    }
                }
            }
        }
        for light in 0..self.scene.lights().len() {
            if self.is_stopped() {
                return;
            }
            counts.shadow += self.send(light, rays, met, samplers, lights);
            if self.scene.has_ambient_per_light() {
                self.ambient_of_light(light, met, lights, out);
            }
            if W::LISTENS {
                self.tell(light, rays, met, lights, witness);
            }
            self.shade(light, rays, met, lights, out);
        }
        if !self.scene.has_bounces() {
            return;
        }
        for branch in [Branch::Reflection, Branch::Transmission] {
            let (onward, work) = &mut **deeper.get_or_insert_default();
            self.go_on(branch, rays, met, samplers, bounces, onward, witness);
            if onward.from.is_empty() {
                continue;
            }
            for (k, Step { weight, fresnel, .. }) in onward.from.iter().enumerate() {
                witness.entered(branch, *weight, *fresnel, &onward.rays[k / 8].get(k % 8));
            }
            counts.secondary += onward.from.len() as u64;
            let up = self.scene.camera().up();
            let height = |i: usize, lane: usize| 0.5 - 0.5 * onward.rays[i].get(lane).dir.dot(up);
            let Onward { rays, samplers, from, .. } = &*onward;
            self.follow(rays, samplers, &height, bounces - 1, work, counts, witness);
            for (k, &Step { parent: (i, lane), weight, .. }) in from.iter().enumerate() {
                let light = work.out[k / 8].terms.get(k % 8).total();
                witness.left(branch, light);
                let term = branch.term();
                set(&mut out[i].terms[term], lane, (weight * light).to_array());
                out[i].brought = out[i].brought.with(term);
            }
        }
    }

    fn is_stopped(&self) -> bool {
        self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
    }

    /// The mirror rays, or the refracted ones, that go on from the surfaces met.
    #[expect(clippy::too_many_arguments, reason = "the state of the road, handed on as it is")]
    fn go_on<W: Witness>(
        &self,
        branch: Branch,
        rays: &[Rays8],
        met: &Met,
        samplers: &[Samplers8],
        bounces: u32,
        onward: &mut Onward,
        witness: &mut W,
    ) {
        onward.clear();
        let mut partings = std::mem::take(&mut onward.partings);
        partings.resize(rays.len(), Parting8::NONE);
        let to = &mut *partings;
        self.scene.world().run(Part { scene: self.scene, branch, rays, met, to });
        for (i, parting) in partings.iter().enumerate() {
            for lane in lanes(parting.goes) {
                let (weight, fresnel) = parting.weight(lane);
                if bounces == 0 {
                    witness.cut(branch, weight, fresnel);
                    continue;
                }
                let sampler = samplers.get(i).map(|s| s.get(lane).branch(branch as u32));
                let step = Step { parent: (i, lane), weight, fresnel };
                onward.push(step, &parting.ray(lane), sampler);
            }
        }
        onward.partings = partings;
    }
}
