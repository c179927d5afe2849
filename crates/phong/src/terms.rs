//! The terms that a pixel is the sum of: the one list of them, and what is kept for each.
//!
//! A new term is a line in the list below. What sums, stores, names or tells terms goes through
//! [`Term::ALL`] or indexes by [`Term`], and so knows it.

use std::ops::{Add, AddAssign, Index, IndexMut};

use fearless_simd::{Simd, f32x8};
use phong_scene::{Rgb, Scene};

use crate::math::lanes::{Lanes3, add, get, load3};

/// Makes [`Term`] and [`Terms`] of one list: a variant and a field for each line.
macro_rules! terms {
    ($($(#[$doc:meta])* $variant:ident $field:ident;)+) => {
        /// A term of the sum. The order is the one in which they are added.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Term {
            $($(#[$doc])* $variant,)+
        }

        impl Term {
            /// Every term, in the order of the sum.
            pub const ALL: [Self; [$(stringify!($field)),+].len()] = [$(Self::$variant),+];

            /// The name used in files and explanations.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => stringify!($field),)+
                }
            }
        }

        /// What a pixel is made of, kept apart to the film. Linear, unclamped.
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct Terms {
            $($(#[$doc])* pub $field: Rgb,)+
        }

        impl Index<Term> for Terms {
            type Output = Rgb;

            #[inline]
            fn index(&self, term: Term) -> &Rgb {
                match term {
                    $(Term::$variant => &self.$field,)+
                }
            }
        }

        impl IndexMut<Term> for Terms {
            #[inline]
            fn index_mut(&mut self, term: Term) -> &mut Rgb {
                match term {
                    $(Term::$variant => &mut self.$field,)+
                }
            }
        }
    };
}

terms! {
    /// What rays see that hit nothing.
    Background background;
    /// `k_a C_a`.
    Ambient ambient;
    /// `Σ V_m k_d (L_m·N) C_{m,d}`.
    Diffuse diffuse;
    /// `Σ V_m k_s (R_m·E)^α C_{m,s}`.
    Specular specular;
    /// `k_e C_e`: the surface's own light.
    Emission emission;
    /// All that the mirror ray brings, weighted.
    Reflection reflection;
    /// All that the refracted ray brings, weighted.
    Transmission transmission;
    /// What fog adds, by whose share the others are less.
    Fog fog;
}

impl Term {
    /// The term of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|term| term.name() == name)
    }
}

impl Terms {
    /// Terms of which each is what `value` says.
    pub fn from_fn(mut value: impl FnMut(Term) -> Rgb) -> Self {
        let mut terms = Self::default();
        for term in Term::ALL {
            terms[term] = value(term);
        }
        terms
    }

    /// Every term with its value, in the order of the sum.
    pub fn iter(&self) -> impl Iterator<Item = (Term, Rgb)> {
        Term::ALL.into_iter().map(|term| (term, self[term]))
    }

    /// What is left of them behind fog of which `clear` lets through, and the fog's own light.
    #[must_use]
    pub(crate) fn behind(self, clear: f32, fog: Rgb) -> Self {
        Self { fog, ..Self::from_fn(|term| self[term] * clear) }
    }

    /// The picture: the sum of the terms, in f32, in their order.
    pub fn total(&self) -> Rgb {
        let [first, others @ ..] = Term::ALL;
        others.into_iter().fold(self[first], |sum, term| sum + self[term])
    }
}

impl Add for Terms {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::from_fn(|term| self[term] + other[term])
    }
}

impl AddAssign for Terms {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

/// Some of the terms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TermSet(u32);

impl TermSet {
    /// None of them.
    pub const NONE: Self = Self(0);

    /// All of them.
    pub const ALL: Self = Self::of(&Term::ALL);

    /// These.
    pub const fn of(terms: &[Term]) -> Self {
        let (mut set, mut left) = (Self::NONE, terms);
        while let [term, others @ ..] = left {
            set = set.with(*term);
            left = others;
        }
        set
    }

    /// Those that a picture of the scene can have: the others are black all over it.
    pub fn of_scene(scene: &Scene) -> Self {
        let can_be_seen = |term: &Term| match term {
            Term::Emission => {
                let is_seen = |l: &phong_scene::Light| l.visible && l.kind.has_surface();
                scene.materials.iter().any(phong_scene::Material::glows)
                    || scene.lights.iter().any(is_seen)
            }
            Term::Fog => scene.fog.is_some(),
            _ => true,
        };
        Term::ALL.into_iter().filter(can_be_seen).fold(Self::NONE, Self::with)
    }

    /// These, and that one.
    #[must_use]
    pub const fn with(self, term: Term) -> Self {
        Self(self.0 | 1 << term as u32)
    }

    /// Those in either set.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether a term is one of them.
    #[inline]
    pub const fn has(self, term: Term) -> bool {
        self.0 >> term as u32 & 1 != 0
    }

    /// They, in the order of the sum.
    #[inline]
    pub fn iter(self) -> impl Iterator<Item = Term> {
        let mut left = self.0;
        std::iter::from_fn(move || {
            // Where none is left this is the number of no term.
            let term = *Term::ALL.get(left.trailing_zeros() as usize)?;
            left &= left - 1;
            Some(term)
        })
    }
}

/// A value for each term.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub(crate) struct PerTerm<T>([T; Term::ALL.len()]);

impl<T: Copy> PerTerm<T> {
    /// The same value for each.
    pub(crate) const fn splat(value: T) -> Self {
        Self([value; Term::ALL.len()])
    }
}

impl<T> Index<Term> for PerTerm<T> {
    type Output = T;

    #[inline(always)]
    fn index(&self, term: Term) -> &T {
        &self.0[term as usize]
    }
}

impl<T> IndexMut<Term> for PerTerm<T> {
    #[inline(always)]
    fn index_mut(&mut self, term: Term) -> &mut T {
        &mut self.0[term as usize]
    }
}

/// The terms of eight pixels or rays side by side: of each term red, green and blue, of each eight.
pub(crate) type Terms8 = PerTerm<Lanes3>;

impl Terms8 {
    /// Nothing.
    pub(crate) const NONE: Self = Self::splat([[0.0; 8]; 3]);

    /// The terms in one lane, below 8.
    pub(crate) fn get(&self, lane: usize) -> Terms {
        Terms::from_fn(|term| Rgb::from(get(&self[term], lane)))
    }

    /// [`Terms::total`] of each.
    #[inline(always)]
    pub(crate) fn total<S: Simd>(&self, simd: S) -> [f32x8<S>; 3] {
        let [first, others @ ..] = Term::ALL;
        let of = |term: Term| load3(simd, &self[term]);
        others.into_iter().fold(of(first), |sum, term| add(sum, of(term)))
    }

    /// Adds to one term in one lane.
    #[inline]
    pub(crate) fn add(&mut self, term: Term, lane: usize, more: Rgb) {
        for (sum, more) in self[term].iter_mut().zip(more.to_array()) {
            sum[lane] += more;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_leads_back_to_its_term() {
        for term in Term::ALL {
            assert_eq!(Term::from_name(term.name()), Some(term));
        }
        assert_eq!(Term::from_name("difuse"), None);
    }

    #[test]
    fn the_sum_of_one_has_the_bits_of_eight_in_the_order_of_the_list() {
        let mut eight = Terms8::NONE;
        for term in Term::ALL {
            for lane in 0..8 {
                let x = (term as usize * 37 + lane * 61) as f32;
                eight.add(term, lane, Rgb::new(0.1 * x, 1e-7 * x, 1e7 - x));
            }
        }
        let simd = fearless_simd::Fallback::new();
        let total = crate::math::lanes::store3(eight.total(simd));
        for lane in 0..8 {
            let terms = eight.get(lane);
            assert_eq!(get(&total, lane), terms.total().to_array());
            let mut sum = terms.background;
            for term in &Term::ALL[1..] {
                sum += terms[*term];
            }
            assert_eq!(terms.total(), sum);
        }
    }

    #[test]
    fn a_set_has_what_was_put_into_it_in_the_order_of_the_list() {
        let set = TermSet::of(&[Term::Reflection, Term::Ambient]);
        assert_eq!(set.iter().collect::<Vec<_>>(), [Term::Ambient, Term::Reflection]);
        assert!(!set.has(Term::Diffuse) && set.with(Term::Diffuse).has(Term::Diffuse));
        assert!(Term::ALL.into_iter().all(|term| TermSet::ALL.has(term)));
        assert_eq!(set.or(TermSet::NONE), set);
    }
}
