//! Rays side by side, eight at a time: what a renderer's bundles are made of.
//!
//! A number of eight rays lies in memory as vector code wants it, so nothing has to be put in order
//! on the way from a camera to a kernel and on to what is made of the hits.

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::{DVec3, Vec3};

use crate::{Hit, Ray};

/// Eight rays side by side, some of which may be missing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct Rays8 {
    /// [`Ray::origin`]: x of each, y of each, z of each.
    pub origin: [[f64; 8]; 3],
    /// [`Ray::dir`].
    pub dir: [[f32; 8]; 3],
    /// [`Ray::t_min`].
    pub t_min: [f32; 8],
    /// [`Ray::t_max`].
    pub t_max: [f32; 8],
    /// Which of the eight there are, a bit each, the lowest for the first; at most `0xff`. The
    /// numbers of the others are unspecified.
    pub there: u32,
}

impl Rays8 {
    /// No rays.
    pub const NONE: Self = Self {
        origin: [[0.0; 8]; 3],
        dir: [[0.0; 8]; 3],
        t_min: [0.0; 8],
        t_max: [f32::INFINITY; 8],
        there: 0,
    };

    /// The ray in one lane, below 8.
    #[inline]
    pub fn get(&self, lane: usize) -> Ray {
        Ray {
            origin: DVec3::from_array(self.origin.map(|all| all[lane])),
            t_min: self.t_min[lane],
            dir: Vec3::from_array(self.dir.map(|all| all[lane])),
            t_max: self.t_max[lane],
        }
    }

    /// Puts a ray into one lane, below 8.
    #[inline]
    pub fn set(&mut self, lane: usize, ray: &Ray) {
        for axis in 0..3 {
            self.origin[axis][lane] = ray.origin[axis];
            self.dir[axis][lane] = ray.dir[axis];
        }
        (self.t_min[lane], self.t_max[lane]) = (ray.t_min, ray.t_max);
        self.there |= 1 << lane;
    }

    /// Rays in order, as many eights as it takes.
    ///
    /// ```
    /// use phong_bvh::{Ray, Rays8};
    /// use glam::{DVec3, Vec3};
    ///
    /// let rays = [Ray::new(DVec3::ZERO, Vec3::X); 11];
    /// let eights = Rays8::of(&rays);
    /// assert_eq!((eights.len(), eights[1].there), (2, 0b111));
    /// assert_eq!(eights[1].get(2), rays[10]);
    /// ```
    pub fn of(rays: &[Ray]) -> Vec<Self> {
        let eight = |rays: &[Ray]| {
            let mut eight = Self::NONE;
            rays.iter().enumerate().for_each(|(lane, ray)| eight.set(lane, ray));
            eight
        };
        rays.chunks(8).map(eight).collect()
    }
}

/// What eight rays hit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct Hits8 {
    /// [`Hit::t`].
    pub t: [f32; 8],
    /// [`Hit::part`].
    pub part: [u32; 8],
    /// [`Hit::prim`].
    pub prim: [u32; 8],
    /// [`Hit::u`].
    pub u: [f32; 8],
    /// [`Hit::v`].
    pub v: [f32; 8],
    /// The rays that hit something, a bit each, the lowest for the first; at most `0xff`. What is told
    /// of the others is unspecified.
    pub met: u32,
}

impl Hits8 {
    /// Nothing was hit.
    pub const NONE: Self = Self {
        t: [f32::INFINITY; 8],
        part: [u32::MAX; 8],
        prim: [u32::MAX; 8],
        u: [0.0; 8],
        v: [0.0; 8],
        met: 0,
    };

    /// The hit in one lane, below 8.
    #[inline]
    pub fn get(&self, lane: usize) -> Hit {
        Hit {
            t: self.t[lane],
            part: self.part[lane],
            prim: self.prim[lane],
            u: self.u[lane],
            v: self.v[lane],
        }
    }

    /// Puts a hit, or none, into one lane, below 8.
    #[inline]
    pub fn set(&mut self, lane: usize, hit: Hit) {
        (self.t[lane], self.part[lane], self.prim[lane]) = (hit.t, hit.part, hit.prim);
        (self.u[lane], self.v[lane]) = (hit.u, hit.v);
        self.met = self.met & !(1 << lane) | u32::from(hit.is_some()) << lane;
    }
}

/// The numbers of the bits that are set, lowest first.
///
/// ```
/// assert_eq!(phong_bvh::lanes(0b1010_0001).collect::<Vec<_>>(), [0, 5, 7]);
/// ```
#[inline]
pub fn lanes(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (mask != 0).then(|| {
            let lane = mask.trailing_zeros();
            mask &= mask - 1;
            lane as usize
        })
    })
}

/// Eight numbers in memory as two halves of four.
#[inline(always)]
pub fn halves<S: Simd>(simd: S, lanes: &[f64; 8]) -> [f64x4<S>; 2] {
    let halves = lanes.as_chunks::<4>().0;
    [f64x4::load_array_ref(simd, &halves[0]), f64x4::load_array_ref(simd, &halves[1])]
}

/// Two halves of four as eight numbers in memory.
#[inline(always)]
pub fn whole<S: Simd>(low: f64x4<S>, high: f64x4<S>) -> [f64; 8] {
    let mut all = [0.0; 8];
    let halves = all.as_chunks_mut::<4>().0;
    low.store_array(&mut halves[0]);
    high.store_array(&mut halves[1]);
    all
}
