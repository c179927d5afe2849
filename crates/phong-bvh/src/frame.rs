//! From the world into the space of one part, and back.
//!
//! Rays start in f64 in the world, and kernels work in f32. So a ray is taken to the part's own axes in
//! f64, about the part's own origin, and where it starts far from the part it is first moved along, to
//! just before it. Only then are its numbers rounded to f32, which next to the part are fine enough.
//! What is done is a function of ray and part alone; one ray and eight take the same steps.

use fearless_simd::{Simd, f32x8, f64x4, prelude::*};
use glam::{DAffine3, DMat3, DVec3};

use crate::{
    Aabb, Ray, Rays8,
    eights::halves,
    lanes::{Lanes, add, dot, splat3, sub},
    local::{self, Loaded, load3},
};

/// Distance from the middle of a part, in its sizes, from which on rays are moved along first.
const FAR: f64 = 1024.0;
/// What rounding to f32 changes at most, relative: half of ε, and a little for rounding the bound.
pub(crate) const ROUNDING: f64 = 0.500_001 * f32::EPSILON as f64;
/// More than a few roundings in f64 change.
const DUST: f64 = 8.0 * f64::EPSILON;

/// Where a part stands.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    /// The origin of the part's own space in the world.
    origin: DVec3,
    /// None: its axes are the world's.
    axes: Option<Axes>,
    /// The middle of its box, in its own space.
    middle: DVec3,
    /// The largest side of that box; +∞: no ray is moved along.
    size: f64,
}

/// Axes of a part that are not the world's.
#[derive(Clone, Debug)]
struct Axes {
    to_world: DMat3,
    to_local: DMat3,
    /// How much a rounding along each axis of the world may make along each, to the part and back.
    dust: DMat3,
}

/// A ray, or several, in a part's space, before rounding.
pub(crate) struct Entered<F> {
    pub(crate) origin: [F; 3],
    pub(crate) dir: [F; 3],
    pub(crate) way: Way<F>,
}

/// How distances along a ray in a part's space belong to those in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way<F> {
    /// Length in the part's space of what is 1 long in the world.
    pub(crate) scale: F,
    /// How far the start was moved along the ray, in the part's space.
    pub(crate) skip: F,
}

impl Frame {
    /// The world itself about `center`; `bounds` of what rays are moved along to, if to anything.
    pub(crate) fn about(center: DVec3, bounds: Option<Aabb>) -> Self {
        let (middle, size) = extent(bounds);
        Self { origin: center, axes: None, middle, size }
    }

    /// A placed object, whose numbers are about `center` in its own space; none if the placement has
    /// no inverse.
    pub(crate) fn placed(to_world: &DAffine3, center: DVec3, bounds: Option<Aabb>) -> Option<Self> {
        let origin = to_world.transform_point3(center);
        let matrix = to_world.matrix3;
        let to_local = matrix.inverse();
        let finite = origin.is_finite() && matrix.is_finite() && to_local.is_finite();
        if !finite || to_local.determinant() == 0.0 {
            return None;
        }
        let axes = (matrix != DMat3::IDENTITY).then(|| {
            let abs = |m: DMat3| DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
            let dust = DUST * (abs(matrix) * abs(to_local) + DMat3::IDENTITY);
            Axes { to_world: matrix, to_local, dust }
        });
        let (middle, size) = extent(bounds);
        Some(Self { origin, axes, middle, size })
    }

    /// A ray of the world, or several, in this space. Directions are unit to rounding.
    #[inline(always)]
    pub(crate) fn enter<F: Lanes<Scalar = f64>>(&self, origin: [F; 3], dir: [F; 3]) -> Entered<F> {
        let one = dir[0].splat(1.0);
        let zero = dir[0].splat(0.0);
        // The difference first: it is exact where it matters, far from the world's origin.
        let origin = sub(origin, splat3(zero, self.origin.to_array()));
        let (origin, dir, scale) = match &self.axes {
            None => (origin, dir, one),
            Some(axes) => {
                let [x, y, z] = times(&axes.to_local, dir);
                let scale = (x * x + y * y + z * z).sqrt();
                let inverse = one / scale;
                let dir = [x * inverse, y * inverse, z * inverse];
                (times(&axes.to_local, origin), dir, scale)
            }
        };
        let off = sub(origin, splat3(zero, self.middle.to_array()));
        let far = Lanes::max(Lanes::max(off[0].abs(), off[1].abs()), off[2].abs());
        // To two sizes before the point closest to the middle.
        let ahead = zero - dot(off, dir) / dot(dir, dir) - zero.splat(2.0 * self.size);
        let skip = F::select(far.gt(zero.splat(FAR * self.size)), ahead.at_least(0.0), zero);
        let origin =
            [origin[0] + skip * dir[0], origin[1] + skip * dir[1], origin[2] + skip * dir[2]];
        Entered { origin, dir, way: Way { scale, skip } }
    }

    /// One ray in this space.
    #[inline]
    pub(crate) fn ray(&self, ray: &Ray) -> (local::Ray, Way<f64>) {
        if self.axes.is_none() {
            // As below, where nothing turns the ray and nothing moves it along.
            let origin = ray.origin - self.origin;
            if (origin - self.middle).abs().max_element() <= FAR * self.size {
                let &Ray { t_min, dir, t_max, .. } = ray;
                let origin = origin.as_vec3();
                let local = local::Ray { origin, t_min: t_min.max(0.0), dir, t_max };
                return (local, Way { scale: 1.0, skip: 0.0 });
            }
        }
        let Entered { origin, dir, way } =
            self.enter(ray.origin.to_array(), ray.dir.as_dvec3().to_array());
        let narrow = |v: [f64; 3]| DVec3::from_array(v).as_vec3();
        let t_min = (f64::from(ray.t_min) * way.scale - way.skip).at_least(0.0) as f32;
        let t_max = (f64::from(ray.t_max) * way.scale - way.skip) as f32;
        (local::Ray { origin: narrow(origin), t_min, dir: narrow(dir), t_max }, way)
    }

    /// Whether this space is the world itself.
    #[inline(always)]
    pub(crate) fn is_of_world(&self) -> bool {
        self.axes.is_none() && self.origin == DVec3::ZERO
    }

    /// The origin of this space in the world.
    pub(crate) fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Whether its origin is that of another one.
    pub(crate) fn starts_at(&self, other: &Self) -> bool {
        self.origin == other.origin
    }

    /// Whether its axes are the world's.
    pub(crate) fn is_upright(&self) -> bool {
        self.axes.is_none()
    }

    /// Eight rays in this space.
    #[inline(always)]
    pub(crate) fn rays<S: Simd>(
        &self,
        simd: S,
        rays: &Rays8,
        to: &mut local::Rays8,
    ) -> [Way<f64x4<S>>; 2] {
        let Rays8 { origin: [ox, oy, oz], dir, t_min, t_max, there } = rays;
        let (dx, dy, dz) = (wide(simd, &dir[0]), wide(simd, &dir[1]), wide(simd, &dir[2]));
        let [ox, oy, oz] = [halves(simd, ox), halves(simd, oy), halves(simd, oz)];
        let low = self.enter([ox[0], oy[0], oz[0]], [dx.0, dy.0, dz.0]);
        let high = self.enter([ox[1], oy[1], oz[1]], [dx.1, dy.1, dz.1]);
        let (least, most) = (wide(simd, t_min), wide(simd, t_max));
        let t_min = (least.0 * low.way.scale - low.way.skip)
            .at_least(0.0)
            .narrow((least.1 * high.way.scale - high.way.skip).at_least(0.0));
        let t_max =
            (most.0 * low.way.scale - low.way.skip).narrow(most.1 * high.way.scale - high.way.skip);
        *to = local::Rays8 {
            origin: narrow3(low.origin, high.origin),
            dir: if self.axes.is_some() { narrow3(low.dir, high.dir) } else { *dir },
            t_min: t_min.into(),
            t_max: t_max.into(),
            there: *there,
        };
        [low.way, high.way]
    }

    /// Whether no ray that starts within these bounds, in this space, is moved along. Of rays just short of
    /// that distance it may say no.
    pub(crate) fn is_near(&self, bounds: [[f32; 2]; 3]) -> bool {
        // The bounds are of rounded numbers.
        let slack = 1e-6 * self.middle.abs().max_element() + 1e-3 * FAR * self.size;
        (0..3).all(|axis| {
            let off = bounds[axis].map(|v| (f64::from(v) - self.middle[axis]).abs());
            off[0].max(off[1]) + slack < FAR * self.size
        })
    }

    /// Eight rays where the axes are the world's, none of them moved along, into registers.
    #[inline(always)]
    fn load<S: Simd>(&self, simd: S, rays: &Rays8) -> Loaded<S> {
        Loaded {
            origin: self.load_origins(simd, rays),
            dir: load3(simd, &rays.dir),
            t_min: f32x8::load_array_ref(simd, &rays.t_min),
            t_max: f32x8::load_array_ref(simd, &rays.t_max),
        }
    }

    /// Where eight rays start, under the same conditions.
    #[inline(always)]
    pub(crate) fn load_origins<S: Simd>(&self, simd: S, rays: &Rays8) -> [f32x8<S>; 3] {
        let zero: f64x4<S> = SimdBase::splat(simd, 0.0);
        let [x, y, z] = &rays.origin;
        let [from_x, from_y, from_z] = splat3(zero, self.origin.to_array());
        let [x, y, z] = [halves(simd, x), halves(simd, y), halves(simd, z)];
        [
            (x[0] - from_x).narrow(x[1] - from_x),
            (y[0] - from_y).narrow(y[1] - from_y),
            (z[0] - from_z).narrow(z[1] - from_z),
        ]
    }

    /// [`Frame::rays`] into registers, where the axes are the world's and no ray is moved along; else none.
    #[inline(always)]
    pub(crate) fn load_near<S: Simd>(&self, simd: S, rays: &Rays8) -> Option<Loaded<S>> {
        if self.axes.is_some() {
            return None;
        }
        let loaded = self.load(simd, rays);
        if self.size == f64::INFINITY {
            return Some(loaded);
        }
        // Rounded as they are, they may say no of rays that `Frame::rays` would leave where they are.
        let middle = splat3(loaded.t_min, self.middle.as_vec3().to_array());
        let off = sub(loaded.origin, middle);
        let [x, y, z] = [Lanes::abs(off[0]), Lanes::abs(off[1]), Lanes::abs(off[2])];
        let far = Lanes::max(Lanes::max(x, y), z);
        let limit: f32x8<S> = SimdBase::splat(simd, (0.99 * FAR * self.size) as f32);
        (!far.simd_ge(limit).any_true()).then_some(loaded)
    }

    /// A point of this space, rounded to f32, in the world; with the bound of its error, and its unit
    /// normal.
    ///
    /// A ray that starts there is rounded where it enters this space again. Where the world is this space,
    /// it is not: what it starts from is made of numbers in f32.
    #[inline(always)]
    pub(crate) fn leave<F: Lanes<Scalar = f64>>(
        &self,
        [p, p_error, ng]: [[F; 3]; 3],
    ) -> [[F; 3]; 3] {
        if self.is_of_world() {
            return [p, p_error, ng];
        }
        let origin = splat3(p[0], self.origin.to_array());
        let error = [
            p_error[0] + p[0].abs() * ROUNDING,
            p_error[1] + p[1].abs() * ROUNDING,
            p_error[2] + p[2].abs() * ROUNDING,
        ];
        let Some(axes) = &self.axes else {
            let p = add(p, origin);
            let size = add(abs(p), abs(origin));
            let dust = [size[0] * DUST, size[1] * DUST, size[2] * DUST];
            return [p, add(error, dust), ng];
        };
        let p = add(times(&axes.to_world, p), origin);
        let dust = times(&axes.dust, add(abs(p), abs(origin)));
        let error = add(times_sizes(&axes.to_world, error), dust);
        // Normals are gradients, so they go by the transposed inverse, which also keeps them
        // outwards under a mirror image.
        let ng = unit(times(&axes.to_local.transpose(), ng));
        [p, error, ng]
    }

    /// A direction of this space in the world, of any length.
    pub(crate) fn direction(&self, v: DVec3) -> DVec3 {
        self.axes.as_ref().map_or(v, |axes| axes.to_world * v)
    }

    /// A gradient of this space in the world, of any length.
    pub(crate) fn normal(&self, v: DVec3) -> DVec3 {
        self.axes.as_ref().map_or(v, |axes| axes.to_local.transpose() * v)
    }

    /// A box around what `bounds` of this space are in the world about `center`, with what kernels may
    /// round here.
    pub(crate) fn bounds(&self, bounds: Aabb, center: DVec3) -> [DVec3; 2] {
        let (lo, hi) = (bounds.lo.as_dvec3(), bounds.hi.as_dvec3());
        let (middle, half) = ((lo + hi) / 2.0, (hi - lo) / 2.0);
        // Rays start up to `FAR` sizes away, and a kernel may round by 2⁻²⁰ of its coordinates.
        let largest = FAR * self.size + middle.abs().max_element();
        let half = half + DVec3::splat(4.0 * largest / 1_048_576.0);
        let (middle, half) = match &self.axes {
            None => (middle, half),
            Some(axes) => {
                let m = axes.to_world;
                let abs = DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
                (m * middle, abs * half)
            }
        };
        let middle = middle + self.origin - center;
        let half = half + DUST * (middle.abs() + self.origin.abs() + center.abs());
        [middle - half, middle + half]
    }
}

impl Way<f64> {
    /// The distance in this space for one in the world.
    #[inline]
    pub(crate) fn there(self, t: f32) -> f32 {
        (f64::from(t) * self.scale - self.skip) as f32
    }

    /// The distance in the world for one in this space, strictly within the ray's interval.
    #[inline]
    pub(crate) fn back(self, t: f32, ray: &Ray) -> f32 {
        let t = ((f64::from(t) + self.skip) / self.scale) as f32;
        // In the same order as for eight.
        let (least, most) = (ray.t_min.abs().next_up(), ray.t_max.next_down());
        let t = if t > least { t } else { least };
        if t < most { t } else { most }
    }

    /// How far to look in this space for all that is in the world at `best` or nearer.
    #[inline]
    pub(crate) fn reach(self, best: f32, ray: &Ray) -> f32 {
        let most = (f64::from(ray.t_max) * self.scale - self.skip) as f32;
        if best >= ray.t_max.next_down() {
            return most;
        }
        let reach = (f64::from(best) * self.scale * SLACK - self.skip) as f32;
        if reach < most { reach } else { most }
    }
}

/// More than the roundings to and fro.
pub(crate) const SLACK: f64 = 1.0 + 1.0 / 4_194_304.0;

/// Middle and largest side.
fn extent(bounds: Option<Aabb>) -> (DVec3, f64) {
    let none = (DVec3::ZERO, f64::INFINITY);
    bounds.map_or(none, |Aabb { lo, hi }| {
        let (lo, hi) = (lo.as_dvec3(), hi.as_dvec3());
        ((lo + hi) / 2.0, (hi - lo).max_element())
    })
}

// What vector code calls more than once is a function that is always inlined: a closure becomes a call,
// without the level's instructions.

/// Eight numbers of f32 as two halves in f64.
#[inline(always)]
pub(crate) fn wide<S: Simd>(simd: S, lanes: &[f32; 8]) -> (f64x4<S>, f64x4<S>) {
    f32x8::load_array_ref(simd, lanes).widen()
}

#[inline(always)]
fn narrow3<S: Simd>(low: [f64x4<S>; 3], high: [f64x4<S>; 3]) -> [[f32; 8]; 3] {
    [low[0].narrow(high[0]).into(), low[1].narrow(high[1]).into(), low[2].narrow(high[2]).into()]
}

#[inline(always)]
fn abs<F: Lanes>(v: [F; 3]) -> [F; 3] {
    [v[0].abs(), v[1].abs(), v[2].abs()]
}

#[inline(always)]
fn times<F: Lanes<Scalar = f64>>(m: &DMat3, [x, y, z]: [F; 3]) -> [F; 3] {
    [
        x * m.x_axis.x + y * m.y_axis.x + z * m.z_axis.x,
        x * m.x_axis.y + y * m.y_axis.y + z * m.z_axis.y,
        x * m.x_axis.z + y * m.y_axis.z + z * m.z_axis.z,
    ]
}

/// [`times`] with all numbers of the matrix without their signs.
#[inline(always)]
fn times_sizes<F: Lanes<Scalar = f64>>(m: &DMat3, v: [F; 3]) -> [F; 3] {
    times(&DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs()), v)
}

/// The direction of `v`; z where it has none.
#[inline(always)]
pub(crate) fn unit<F: Lanes<Scalar = f64>>(v: [F; 3]) -> [F; 3] {
    let square = dot(v, v);
    let (zero, one, least) = (square.splat(0.0), square.splat(1.0), square.splat(1e-290));
    let (inverse, some) = (one / square.sqrt(), square.gt(least));
    [
        F::select(some, v[0] * inverse, zero),
        F::select(some, v[1] * inverse, zero),
        F::select(some, v[2] * inverse, one),
    ]
}
