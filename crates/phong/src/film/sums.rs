//! Pixels' samples, summed in f64, eight pixels side by side.

use fearless_simd::{Simd, f32x8, f64x4, mask32x8, prelude::*};
use phong_bvh::{Kernel, World};
use phong_scene::Background;

use super::Window;
use crate::filter::LEAST_WEIGHT;
use crate::integrator::Radiance8;
use crate::math::lanes::{load3, scale, store3};
use crate::terms::{PerTerm, Term, TermSet, Terms8};

/// The sums of eight pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub(crate) struct Sums8 {
    /// Of each term red, green and blue.
    terms: PerTerm<[[f64; 8]; 3]>,
    /// The terms that anything was added to; the others are 0.
    brought: TermSet,
    alpha: [f64; 8],
    weight: [f64; 8],
}

impl Sums8 {
    /// No samples.
    pub(crate) const NONE: Self = Self {
        terms: PerTerm::splat([[0.0; 8]; 3]),
        brought: TermSet::NONE,
        alpha: [0.0; 8],
        weight: [0.0; 8],
    };

    /// How many numbers there are in it.
    pub(crate) const NUMBERS: usize = (3 * Term::ALL.len() + 2) * 8;

    /// All its numbers, as they stand in a file.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = f64> {
        let Self { terms, brought: _, alpha, weight } = self;
        let terms = Term::ALL.iter().flat_map(|term| &terms[*term]);
        terms.chain([alpha, weight]).flatten().copied()
    }

    /// The sums of [`NUMBERS`](Self::NUMBERS) numbers.
    pub(crate) fn of_numbers(numbers: &[f64]) -> Self {
        let mut eights = numbers.as_chunks().0.iter().copied();
        let mut next = || eights.next().unwrap_or_default();
        let mut sums = Self { brought: TermSet::ALL, ..Self::NONE };
        for term in Term::ALL {
            sums.terms[term] = std::array::from_fn(|_| next());
        }
        (sums.alpha, sums.weight) = (next(), next());
        sums
    }

    /// Adds samples to sums: of each eight pixels as many, one after the other. One that brought nothing, outside a
    /// fisheye's image circle, still has its weight.
    pub(crate) fn add(bvh: &World, sums: &mut [Self], samples: &[Radiance8], weights: &[[f32; 8]]) {
        bvh.run(Add { sums, samples, weights });
    }

    /// What eight pixels of so many samples are: the terms, each resolved to f32, and the coverage.
    pub(crate) fn resolve(
        &self,
        bvh: &World,
        samples: u32,
        background: Background,
    ) -> (Terms8, [f32; 8]) {
        bvh.run(Resolve { sums: self, samples, background })
    }
}

/// The rows of eight pixels, or fewer, that a tile is worked on in: as many sums as it has.
pub(crate) fn eights_of(tile: Window) -> usize {
    tile.width().div_ceil(8) as usize * tile.height() as usize
}

/// The sums of a tile's pixels between two passes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TileSums {
    samples: u32,
    eights: Vec<Sums8>,
}

impl TileSums {
    /// The sums of so many samples of each pixel, eight pixels for eight.
    pub(crate) fn new(samples: u32, eights: Vec<Sums8>) -> Self {
        Self { samples, eights }
    }

    /// Samples that each pixel has, ≥ 1.
    pub(crate) fn samples(&self) -> u32 {
        self.samples
    }

    /// The sums, eight pixels for eight.
    pub(crate) fn eights(&self) -> &[Sums8] {
        &self.eights
    }

    /// Bytes that it takes.
    pub(crate) fn bytes(&self) -> u64 {
        size_of_val(&self.eights[..]) as u64
    }
}

struct Add<'a> {
    sums: &'a mut [Sums8],
    samples: &'a [Radiance8],
    weights: &'a [[f32; 8]],
}

impl Kernel for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { sums, samples, weights } = self;
        let one = f32x8::splat(simd, 1.0);
        // As many of each.
        let len = samples.len().div_ceil(sums.len().max(1)).max(1);
        let samples = samples.chunks(len).zip(weights.chunks(len));
        for (sums, (samples, weights)) in sums.iter_mut().zip(samples) {
            for (sample, weight) in samples.iter().zip(weights) {
                add(simd, sums, sample, weight, one);
            }
        }
    }
}

#[inline(always)]
fn add<S: Simd>(simd: S, sums: &mut Sums8, sample: &Radiance8, weight: &[f32; 8], one: f32x8<S>) {
    let covered = mask32x8::from_bitmask(simd, sample.met.into());
    let weight = f32x8::load_array_ref(simd, weight);
    // Times 1 a value stays as it is.
    let plain = weight.simd_eq(one).all_true();
    let mut covers = covered.select(weight, f32x8::splat(simd, 0.0));
    if sample.clear != 0 {
        let clear = mask32x8::from_bitmask(simd, sample.clear.into());
        let seen = f32x8::load_array_ref(simd, &sample.seen_through);
        covers = clear.select(weight * (1.0 - seen), covers);
    }
    plus(simd, &mut sums.alpha, covers.widen());
    let weight = weight.widen();
    plus(simd, &mut sums.weight, weight);
    // Of what is black everywhere nothing is added.
    sums.brought = sums.brought.or(sample.brought);
    for term in sample.brought.iter() {
        let (sums, values) = (&mut sums.terms[term], &sample.terms[term]);
        for (sum, values) in sums.iter_mut().zip(values) {
            let value = wide(simd, values);
            plus(simd, sum, if plain { value } else { times(weight, value) });
        }
    }
}

#[inline(always)]
fn wide<S: Simd>(simd: S, lanes: &[f32; 8]) -> (f64x4<S>, f64x4<S>) {
    f32x8::load_array_ref(simd, lanes).widen()
}

#[inline(always)]
fn times<S: Simd>(a: (f64x4<S>, f64x4<S>), b: (f64x4<S>, f64x4<S>)) -> (f64x4<S>, f64x4<S>) {
    (a.0 * b.0, a.1 * b.1)
}

#[inline(always)]
fn plus<S: Simd>(simd: S, sum: &mut [f64; 8], more: (f64x4<S>, f64x4<S>)) {
    let (low, high) = sum.split_at_mut(4);
    for (half, more) in [(low, more.0), (high, more.1)] {
        (f64x4::from_slice(simd, half) + more).store_slice(half);
    }
}

struct Resolve<'a> {
    sums: &'a Sums8,
    samples: u32,
    background: Background,
}

impl Kernel for Resolve<'_> {
    type Output = (Terms8, [f32; 8]);

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Self::Output {
        let Self { sums: Sums8 { terms, brought, alpha, weight }, samples, background } = self;
        // Signed weights that all but cancel would blow up what little is left.
        let least = f64x4::splat(simd, f64::from(LEAST_WEIGHT) * f64::from(samples));
        let total = |half: usize| {
            let weight = f64x4::from_slice(simd, &weight[4 * half..][..4]);
            weight.simd_gt(least).select(weight, least)
        };
        let (low, high) = (total(0), total(1));
        let resolved = |sum: &[f64; 8]| -> f32x8<S> {
            let (l, h) = (f64x4::from_slice(simd, &sum[..4]), f64x4::from_slice(simd, &sum[4..]));
            (l / low).narrow(h / high)
        };
        let mut out = Terms8::NONE;
        for term in brought.iter() {
            for (sum, channel) in terms[term].iter().zip(&mut out[term]) {
                *channel = resolved(sum).into();
            }
        }
        let share = resolved(alpha);
        let zero = f32x8::splat(simd, 0.0);
        let seen = share.max(zero).min(f32x8::splat(simd, 1.0));
        if background == Background::Transparent && !share.simd_eq(seen).all_true() {
            // Light of what covers more than the pixel, or less than nothing of it, is cut with its cover.
            let kept = share.simd_gt(zero).select(seen / share, zero);
            for term in brought.iter() {
                out[term] = store3(scale(kept, load3(simd, &out[term])));
            }
        }
        (out, <[f32; 8]>::from(seen).map(|share| coverage(share, background)))
    }
}

/// The alpha of a pixel of which surfaces cover `share`.
pub(crate) fn coverage(share: f32, background: Background) -> f32 {
    match background {
        Background::Transparent => share,
        Background::Color(_) | Background::Gradient { .. } => 1.0,
    }
}
