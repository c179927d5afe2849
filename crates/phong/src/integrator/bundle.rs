//! Rays that are traced together, and the radiance they return.

use phong_bvh::{Ray, Rays8};
use phong_scene::Rgb;

use crate::math::lanes::set;
use crate::sampling::{Sampler, Samplers8};
use crate::terms::{TermSet, Terms8};
use crate::witness::Branch;

/// A ray from the camera.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CameraRay {
    /// The ray.
    pub(crate) ray: Ray,
    /// Where its samples come from.
    pub(crate) sampler: Sampler,
    /// Where it crosses the picture's height: 0 the upper edge, 1 the lower.
    pub(crate) height: f32,
}

/// Rays from the camera that are traced together, eight side by side.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bundle {
    /// The rays.
    pub(crate) rays: Vec<Rays8>,
    /// Where the samples of each come from, eight for eight rays; asked for under soft lights alone.
    pub(crate) samplers: Vec<Samplers8>,
    /// Where each crosses the picture's height; asked for under a gradient alone.
    pub(crate) heights: Vec<[f32; 8]>,
}

impl Bundle {
    /// Forgets the rays and keeps the room.
    pub(crate) fn clear(&mut self) {
        self.rays.clear();
        self.samplers.clear();
        self.heights.clear();
    }
}

impl From<CameraRay> for Bundle {
    fn from(CameraRay { ray, sampler, height }: CameraRay) -> Self {
        Self {
            rays: Rays8::of(&[ray]),
            samplers: vec![Samplers8::splat(sampler)],
            heights: vec![[height; 8]],
        }
    }
}

/// The radiance of eight rays; black in lanes without a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Radiance8 {
    /// The terms, linear and unclamped.
    pub(crate) terms: Terms8,
    /// Those that any of the rays may have brought; the others are black.
    pub(crate) brought: TermSet,
    /// The rays that met a surface, a bit each, the lowest for the first.
    pub(crate) met: u32,
    /// The rays of those that see a transparent background through glass, a bit each.
    pub(crate) clear: u32,
    /// How much of it each of these sees: the sum over its refracted paths of the product of their
    /// weights, each the mean of its channels. Unspecified for the others.
    pub(crate) seen_through: [f32; 8],
}

impl Radiance8 {
    /// Nothing.
    pub(crate) const NONE: Self = Self {
        terms: Terms8::NONE,
        brought: TermSet::NONE,
        met: 0,
        clear: 0,
        seen_through: [0.0; 8],
    };

    /// How much of a transparent background a ray sees.
    fn sees_through(&self, lane: usize) -> f32 {
        let has = |mask: u32| mask >> lane & 1 != 0;
        match (has(self.met), has(self.clear)) {
            (false, _) => 1.0,
            (true, false) => 0.0,
            (true, true) => self.seen_through[lane],
        }
    }

    /// Takes the light of a ray that went on from `lane` this way, already weighted, as that way's term.
    pub(super) fn take(&mut self, branch: Branch, lane: usize, light: Rgb) {
        let term = branch.term();
        match branch {
            Branch::Through => self.terms.add(term, lane, light),
            Branch::Reflection | Branch::Transmission => {
                set(&mut self.terms[term], lane, light.to_array());
            }
        }
        self.brought = self.brought.with(term);
    }

    /// What a refracted ray adds to how much of a transparent background `lane` sees: that ray is
    /// `from` of another eight, and counts `weight`.
    pub(super) fn see_through(&mut self, lane: usize, weight: Rgb, (from, of): (&Self, usize)) {
        let share = from.sees_through(of) * (weight.r + weight.g + weight.b) / 3.0;
        if share > 0.0 {
            // Glass of which a part is not there lets through two rays.
            let before = if self.clear >> lane & 1 == 0 { 0.0 } else { self.seen_through[lane] };
            self.clear |= 1 << lane;
            self.seen_through[lane] = (before + share).min(1.0);
        }
    }

    /// How much of a pixel each ray covers.
    #[inline]
    pub(crate) fn covers(&self, lane: usize) -> f32 {
        if self.met >> lane & 1 == 0 { 0.0 } else { 1.0 - self.sees_through(lane) }
    }

    /// Nothing again, from rays of which these met a surface.
    #[inline(always)]
    pub(super) fn begin(&mut self, met: u32) {
        for term in self.brought.iter() {
            self.terms[term] = [[0.0; 8]; 3];
        }
        (self.brought, self.met, self.clear) = (TermSet::NONE, met, 0);
    }
}

/// How many rays were traced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// From the camera.
    pub primary: u64,
    /// Towards lights, and those that look around for what takes ambient light away.
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

/// How many rays there are.
pub(super) fn count(rays: &[Rays8]) -> u64 {
    // Most eights are full, and not every processor counts bits.
    let count = |rays: &Rays8| if rays.there == 0xff { 8 } else { rays.there.count_ones() };
    rays.iter().map(|rays| u64::from(count(rays))).sum()
}
