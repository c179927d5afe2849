//! Rays in the space of one tree, and what they hit there: all that the kernels know.
//!
//! Here everything is f32. [`Frame`](crate::frame::Frame) takes a ray of the world into that space.

use fearless_simd::{Simd, f32x8, prelude::*};
use glam::Vec3;

/// A ray: the points `origin + t · dir` for `t_min < t < t_max`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub(crate) struct Ray {
    /// Where it starts. Finite.
    pub(crate) origin: Vec3,
    /// Hits at this `t` or nearer do not count. ≥ 0.
    pub(crate) t_min: f32,
    /// Its direction, of unit length to rounding; so `t` is distance. Finite.
    pub(crate) dir: Vec3,
    /// Hits at this `t` or farther do not count. May be infinite.
    pub(crate) t_max: f32,
}

impl Ray {
    /// A ray without an end.
    #[cfg(test)]
    pub(crate) const fn new(origin: Vec3, dir: Vec3) -> Self {
        Self { origin, t_min: 0.0, dir, t_max: f32::INFINITY }
    }
}

/// The closest hit of a ray in a tree, or none.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub(crate) struct Hit {
    /// Distance along the ray.
    pub(crate) t: f32,
    /// Number of the primitive over all batches of the tree; `u32::MAX`: none. Of two hits at the same
    /// `t` the lower number is the hit.
    pub(crate) prim: u32,
    /// Barycentric weights of a triangle's second and third corner; else 0.
    pub(crate) u: f32,
    pub(crate) v: f32,
}

impl Hit {
    /// Nothing was hit.
    pub(crate) const NONE: Self = Self { t: f32::INFINITY, prim: u32::MAX, u: 0.0, v: 0.0 };

    /// Whether something was hit.
    pub(crate) const fn is_some(&self) -> bool {
        self.prim != u32::MAX
    }
}

/// Eight rays side by side, some of which may be missing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct Rays8 {
    /// [`Ray::origin`]: x of each, y of each, z of each.
    pub(crate) origin: [[f32; 8]; 3],
    /// [`Ray::dir`].
    pub(crate) dir: [[f32; 8]; 3],
    /// [`Ray::t_min`].
    pub(crate) t_min: [f32; 8],
    /// [`Ray::t_max`].
    pub(crate) t_max: [f32; 8],
    /// Which of the eight there are, a bit each, the lowest for the first; at most `0xff`. The
    /// numbers of the others are unspecified.
    pub(crate) there: u32,
}

impl Rays8 {
    /// No rays.
    pub(crate) const NONE: Self = Self {
        origin: [[0.0; 8]; 3],
        dir: [[0.0; 8]; 3],
        t_min: [0.0; 8],
        t_max: [f32::INFINITY; 8],
        there: 0,
    };

    /// The ray in one lane, below 8.
    #[inline]
    pub(crate) fn get(&self, lane: usize) -> Ray {
        let vec3 =
            |lanes: &[[f32; 8]; 3]| Vec3::new(lanes[0][lane], lanes[1][lane], lanes[2][lane]);
        Ray {
            origin: vec3(&self.origin),
            t_min: self.t_min[lane],
            dir: vec3(&self.dir),
            t_max: self.t_max[lane],
        }
    }

    /// All of them, for vector code.
    #[inline(always)]
    pub(crate) fn load<S: Simd>(&self, simd: S) -> Loaded<S> {
        Loaded {
            origin: load3(simd, &self.origin),
            dir: load3(simd, &self.dir),
            t_min: f32x8::load_array_ref(simd, &self.t_min),
            t_max: f32x8::load_array_ref(simd, &self.t_max),
        }
    }

    /// Rays in order, as many eights as it takes.
    #[cfg(test)]
    pub(crate) fn of(rays: &[Ray]) -> Vec<Self> {
        let eight = |rays: &[Ray]| {
            let mut eight = Self::NONE;
            for (lane, ray) in rays.iter().enumerate() {
                for axis in 0..3 {
                    eight.origin[axis][lane] = ray.origin[axis];
                    eight.dir[axis][lane] = ray.dir[axis];
                }
                (eight.t_min[lane], eight.t_max[lane]) = (ray.t_min, ray.t_max);
                eight.there |= 1 << lane;
            }
            eight
        };
        rays.chunks(8).map(eight).collect()
    }
}

/// Eight rays in vector registers: the numbers of [`Rays8`].
#[derive(Clone, Copy)]
pub(crate) struct Loaded<S: Simd> {
    pub(crate) origin: [f32x8<S>; 3],
    pub(crate) dir: [f32x8<S>; 3],
    pub(crate) t_min: f32x8<S>,
    pub(crate) t_max: f32x8<S>,
}

impl<S: Simd> Loaded<S> {
    /// Puts them into memory, those of `there` as rays that there are.
    #[inline(always)]
    pub(crate) fn store(self, there: u32, to: &mut Rays8) {
        for axis in 0..3 {
            self.origin[axis].store_array(&mut to.origin[axis]);
            self.dir[axis].store_array(&mut to.dir[axis]);
        }
        self.t_min.store_array(&mut to.t_min);
        self.t_max.store_array(&mut to.t_max);
        to.there = there;
    }
}

/// Three numbers of each of eight rays.
#[inline(always)]
pub(crate) fn load3<S: Simd>(simd: S, [x, y, z]: &[[f32; 8]; 3]) -> [f32x8<S>; 3] {
    [f32x8::load_array_ref(simd, x), f32x8::load_array_ref(simd, y), f32x8::load_array_ref(simd, z)]
}

/// What eight rays hit in a tree.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct Hits8 {
    /// [`Hit::t`].
    pub(crate) t: [f32; 8],
    /// [`Hit::prim`].
    pub(crate) prim: [u32; 8],
    /// [`Hit::u`].
    pub(crate) u: [f32; 8],
    /// [`Hit::v`].
    pub(crate) v: [f32; 8],
    /// The rays that hit something, a bit each, the lowest for the first; at most `0xff`. What is told
    /// of the others is unspecified.
    pub(crate) met: u32,
}

impl Hits8 {
    /// Nothing was hit.
    pub(crate) const NONE: Self =
        Self { t: [f32::INFINITY; 8], prim: [u32::MAX; 8], u: [0.0; 8], v: [0.0; 8], met: 0 };
    #[inline]
    pub(crate) fn set(&mut self, lane: usize, hit: Hit) {
        (self.t[lane], self.prim[lane]) = (hit.t, hit.prim);
        (self.u[lane], self.v[lane]) = (hit.u, hit.v);
        self.met = self.met & !(1 << lane) | u32::from(hit.is_some()) << lane;
    }
}
