//! The terms a pixel is the sum of.

use std::ops::{Add, AddAssign};

use fearless_simd::{Simd, f32x8};
use phong_scene::Rgb;

use crate::math::Dir3;
use crate::math::lanes::{Lanes3, add, get, load3};

/// Light that arrives at a point from one light, already tinted by the material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incident {
    /// To the light.
    pub l: Dir3,
    /// `C_{m,d}`: the light's colour, attenuated, times the material's diffuse colour. No cosine.
    pub c_d: Rgb,
    /// `C_{m,s}`: the light's specular colour, attenuated, times the material's specular colour.
    pub c_s: Rgb,
    /// The material's diffuse colour alone: what tints light once more that meets two facets.
    pub color: Rgb,
}

/// What a pixel is made of, kept apart to the film. Linear, unclamped.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Terms {
    /// What rays see that hit nothing.
    pub background: Rgb,
    /// `k_a C_a`.
    pub ambient: Rgb,
    /// `Σ V_m k_d (L_m·N) C_{m,d}`.
    pub diffuse: Rgb,
    /// `Σ V_m k_s (R_m·E)^α C_{m,s}`.
    pub specular: Rgb,
    /// All that the mirror ray brings, weighted.
    pub reflection: Rgb,
    /// All that the refracted ray brings, weighted.
    pub transmission: Rgb,
}

impl Terms {
    /// The names of the terms, in the order they are summed.
    pub const NAMES: [&str; 6] =
        ["background", "ambient", "diffuse", "specular", "reflection", "transmission"];

    /// The terms in the order of [`Terms::NAMES`].
    pub const fn to_array(self) -> [Rgb; 6] {
        let Self { background, ambient, diffuse, specular, reflection, transmission } = self;
        [background, ambient, diffuse, specular, reflection, transmission]
    }

    /// Terms from the order of [`Terms::NAMES`].
    pub const fn from_array(
        [background, ambient, diffuse, specular, reflection, transmission]: [Rgb; 6],
    ) -> Self {
        Self { background, ambient, diffuse, specular, reflection, transmission }
    }

    /// The picture: the sum of the terms, in f32, in this very order.
    pub fn total(self) -> Rgb {
        let Self { background, ambient, diffuse, specular, reflection, transmission } = self;
        background + ambient + diffuse + specular + reflection + transmission
    }
}

impl Add for Terms {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self {
            background: self.background + o.background,
            ambient: self.ambient + o.ambient,
            diffuse: self.diffuse + o.diffuse,
            specular: self.specular + o.specular,
            reflection: self.reflection + o.reflection,
            transmission: self.transmission + o.transmission,
        }
    }
}

impl AddAssign for Terms {
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

/// The terms of eight pixels or rays side by side: of each term red, green and blue, of each eight.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub struct Terms8(pub [[[f32; 8]; 3]; 6]);

impl Terms8 {
    /// Nothing.
    pub const NONE: Self = Self([[[0.0; 8]; 3]; 6]);

    /// Places of the terms, in the order of [`Terms::NAMES`].
    pub(crate) const BACKGROUND: usize = 0;
    pub(crate) const AMBIENT: usize = 1;
    pub(crate) const DIFFUSE: usize = 2;
    pub(crate) const SPECULAR: usize = 3;
    pub(crate) const REFLECTION: usize = 4;
    pub(crate) const TRANSMISSION: usize = 5;

    /// The terms in one lane, below 8.
    pub fn get(&self, lane: usize) -> Terms {
        let term = |i: usize| Rgb::from(get(&self.0[i], lane));
        Terms::from_array([term(0), term(1), term(2), term(3), term(4), term(5)])
    }

    /// [`Terms::total`] of each.
    #[inline(always)]
    pub(crate) fn total<S: Simd>(&self, simd: S) -> [f32x8<S>; 3] {
        let term = |i: usize| load3(simd, &self.0[i]);
        let sum = add(add(add(term(0), term(1)), term(2)), term(3));
        add(add(sum, term(4)), term(5))
    }

    /// Adds to one term in one lane.
    #[inline]
    pub(crate) fn add(&mut self, term: usize, lane: usize, more: Rgb) {
        let term: &mut Lanes3 = &mut self.0[term];
        for (sum, more) in term.iter_mut().zip(more.to_array()) {
            sum[lane] += more;
        }
    }
}
