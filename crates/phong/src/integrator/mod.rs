//! The road of a ray: intersect → interaction → material → lights and shadows → [`Terms`]; mirror
//! and glass rays go the same road, to a depth.
//!
//! Rays travel in bundles, a tile's worth at a time, so that the hierarchy can use what they have
//! in common. A bundle of one ray takes this very road too, which is how `explain` is told.

mod lights;
mod met;
mod optics;

use phong_bvh::{Hit, Ray};
use phong_scene::{Background, Rgb};

use crate::compile::CompiledScene;
use crate::interaction::SurfaceInteraction;
use crate::material::Material;
use crate::reflectance::Terms;
use crate::sampling::Sampler;
use crate::witness::{Branch, Witness};
use met::Met;
use optics::{mirrored, refracted};

/// Traces rays through a scene.
#[derive(Clone, Copy, Debug)]
pub struct Integrator<'a> {
    /// What rays meet.
    pub scene: &'a CompiledScene,
    /// What rays see that meet nothing.
    pub background: Background,
    /// Mirror and glass bounces; beyond it a ray brings black.
    pub depth: u32,
    /// Whether things stand in the way of lights at all.
    pub shadows: bool,
}

/// A ray from the camera.
#[derive(Clone, Copy, Debug)]
pub struct CameraRay {
    /// The ray.
    pub ray: Ray,
    /// Where its samples come from.
    pub sampler: Sampler,
    /// Where it crosses the picture's height: 0 the upper edge, 1 the lower.
    pub height: f32,
}

/// Rays from the camera that are traced together, column by column.
#[derive(Clone, Debug, Default)]
pub struct Bundle {
    /// The rays.
    pub(crate) rays: Vec<Ray>,
    /// Where the samples of each come from.
    pub(crate) samplers: Vec<Sampler>,
    /// Where each crosses the picture's height; asked for under a gradient alone.
    pub(crate) heights: Vec<f32>,
}

impl Bundle {
    /// Room for `len` rays.
    pub fn with_capacity(len: usize) -> Self {
        Self {
            rays: Vec::with_capacity(len),
            samplers: Vec::with_capacity(len),
            heights: Vec::with_capacity(len),
        }
    }

    /// Adds a ray behind the others.
    #[inline]
    pub fn push(&mut self, CameraRay { ray, sampler, height }: CameraRay) {
        self.rays.push(ray);
        self.samplers.push(sampler);
        self.heights.push(height);
    }

    /// Forgets the rays and keeps the room.
    pub fn clear(&mut self) {
        self.rays.clear();
        self.samplers.clear();
        self.heights.clear();
    }
}

impl From<CameraRay> for Bundle {
    fn from(ray: CameraRay) -> Self {
        let mut bundle = Self::default();
        bundle.push(ray);
        bundle
    }
}

/// What a ray brought home.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Radiance {
    /// The terms, linear and unclamped.
    pub terms: Terms,
    /// Whether the ray met a surface.
    pub met: bool,
}

/// How many rays were traced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// From the camera.
    pub primary: u64,
    /// Towards lights.
    pub shadow: u64,
    /// Mirror and glass.
    pub secondary: u64,
}

impl RayCounts {
    /// All rays.
    pub fn total(&self) -> u64 {
        self.primary + self.shadow + self.secondary
    }

    /// Adds the counts of another.
    pub fn add(&mut self, other: &Self) {
        self.primary += other.primary;
        self.shadow += other.shadow;
        self.secondary += other.secondary;
    }
}

/// A ray that goes on from a surface.
struct Onward {
    /// The bundle's ray it came from.
    parent: usize,
    weight: Rgb,
    fresnel: Option<f32>,
    ray: Ray,
    sampler: Sampler,
}

impl Integrator<'_> {
    /// Traces rays from the camera, and all that follow from them; what each brings, in order.
    pub fn trace<W: Witness>(
        &self,
        bundle: &Bundle,
        counts: &mut RayCounts,
        witness: &mut W,
    ) -> Vec<Radiance> {
        counts.primary += bundle.rays.len() as u64;
        let height = |i: usize| bundle.heights[i];
        self.follow(&bundle.rays, &bundle.samplers, &height, self.depth, counts, witness)
    }

    /// The road itself. `height` tells where in the background's height a ray ends that meets
    /// nothing; `bounces` are left.
    fn follow<W: Witness>(
        &self,
        rays: &[Ray],
        samplers: &[Sampler],
        height: &dyn Fn(usize) -> f32,
        bounces: u32,
        counts: &mut RayCounts,
        witness: &mut W,
    ) -> Vec<Radiance> {
        let mut out = vec![Radiance::default(); rays.len()];
        let mut hits = vec![Hit::NONE; rays.len()];
        self.scene.bvh().intersect_bundle(rays, &mut hits);

        let mut of = Vec::with_capacity(rays.len());
        for (i, hit) in hits.iter().enumerate() {
            if hit.is_some() {
                of.push(i as u32);
            } else {
                let background = seen(self.background, || height(i));
                out[i].terms.background = background;
                witness.missed(&rays[i], background);
            }
        }
        let mut met = Met::new(self.scene, rays, hits, of);
        for k in 0..met.len() {
            let (i, color) = (met.rays[k] as usize, met.color(k));
            let material = &self.scene.materials()[met.material(k)];
            let ambient = material.ambient(color, self.scene.ambient());
            (out[i].met, out[i].terms.ambient) = (true, ambient);
            if W::LISTENS {
                witness.met(&rays[i], &met.at(k), ambient);
            }
        }
        for light in 0..self.scene.lights().len() {
            self.light(light, rays, &mut met, samplers, &mut out, counts, witness);
        }
        for k in 0..met.len() {
            let terms = &mut out[met.rays[k] as usize].terms;
            (terms.diffuse, terms.specular) = met.light(k);
        }
        for branch in [Branch::Reflection, Branch::Transmission] {
            self.branch(branch, &met, samplers, bounces, &mut out, counts, witness);
        }
        out
    }

    #[inline]
    fn material(&self, at: &SurfaceInteraction) -> &Material {
        &self.scene.materials()[at.material as usize]
    }

    /// Adds what one light gives to every surface met.
    #[expect(clippy::too_many_arguments, reason = "the state of the road, handed on as it is")]
    fn light<W: Witness>(
        &self,
        number: usize,
        rays: &[Ray],
        met: &mut Met,
        samplers: &[Sampler],
        out: &mut [Radiance],
        counts: &mut RayCounts,
        witness: &mut W,
    ) {
        let (mut sent, shadow_rays) = self.send(number, met, samplers);
        let mut blocked = vec![false; shadow_rays.len()];
        self.scene.bvh().occluded_bundle(&shadow_rays, &mut blocked);
        counts.shadow += shadow_rays.len() as u64;
        lights::take_away(&mut sent, &blocked);
        if self.scene.has_ambient_per_light() {
            for k in 0..met.len() {
                let ambient = self.ambient_of_light(number, &sent, met, k);
                out[met.rays[k] as usize].terms.ambient += ambient;
            }
        }
        if W::LISTENS {
            self.tell(number, rays, &sent, &shadow_rays, met, witness);
        }
        self.shade(number, rays, &sent, met);
    }

    /// Adds what the mirror rays, or the refracted ones, bring to the surfaces met.
    #[expect(clippy::too_many_arguments, reason = "the state of the road, handed on as it is")]
    fn branch<W: Witness>(
        &self,
        branch: Branch,
        met: &Met,
        samplers: &[Sampler],
        bounces: u32,
        out: &mut [Radiance],
        counts: &mut RayCounts,
        witness: &mut W,
    ) {
        let mut onward = Vec::new();
        if !self.scene.has_bounces() {
            return;
        }
        for k in 0..met.len() {
            let material = &self.scene.materials()[met.material(k)];
            if !material.bounces() {
                continue;
            }
            let (i, at) = (met.rays[k] as usize, &met.at(k));
            let (dir, weight, fresnel) = match branch {
                Branch::Reflection => mirrored(material, at),
                Branch::Transmission => match refracted(material, at) {
                    Some(refracted) => refracted,
                    None => continue,
                },
            };
            if weight.is_black() {
                continue;
            }
            if bounces == 0 {
                witness.cut(branch, weight, fresnel);
                continue;
            }
            onward.push(Onward {
                parent: i,
                weight,
                fresnel,
                ray: at.spawn(dir, f32::INFINITY),
                sampler: samplers[i].branch(branch as u32),
            });
        }
        if onward.is_empty() {
            return;
        }
        for Onward { weight, fresnel, ray, .. } in &onward {
            witness.entered(branch, *weight, *fresnel, ray);
        }
        counts.secondary += onward.len() as u64;
        let rays: Vec<Ray> = onward.iter().map(|o| o.ray).collect();
        let samplers: Vec<Sampler> = onward.iter().map(|o| o.sampler).collect();
        let up = self.scene.camera().up();
        let height = |i: usize| 0.5 - 0.5 * rays[i].dir.dot(up);
        let brought = self.follow(&rays, &samplers, &height, bounces - 1, counts, witness);
        for (Onward { parent, weight, .. }, Radiance { terms, .. }) in onward.iter().zip(&brought) {
            let light = terms.total();
            witness.left(branch, light);
            let terms = &mut out[*parent].terms;
            match branch {
                Branch::Reflection => terms.reflection = *weight * light,
                Branch::Transmission => terms.transmission = *weight * light,
            }
        }
    }
}

/// The background at a height: 0 its top, 1 its bottom. Transparent is black.
fn seen(background: Background, height: impl Fn() -> f32) -> Rgb {
    match background {
        Background::Color(color) => color,
        Background::Gradient { top, bottom } => {
            let height = height();
            (1.0 - height) * top + height * bottom
        }
        Background::Transparent => Rgb::BLACK,
    }
}
