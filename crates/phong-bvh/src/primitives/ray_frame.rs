//! A segment as a ray sees it: projected onto the plane across the ray, where capsules are discs that were drawn
//! along a segment, and the ray is the origin.
//!
//! Two axes across the ray and the ray itself make a frame, in which lengths are counted in the ray's `t`. There let
//! `p` be where the middle of the segment is seen, and `q` lead from there to its second end. The line of the segment
//! passes the origin by `|p × q| / |q|`, where `s = −p·q / q·q` times `q` leads from `p`. Beyond an end, `|s| > 1`,
//! the origin is farther from the end than from the line by `(|p·q| − q·q) / |q|` along it. So it is
//! `√((p × q)² + max(0, |p·q| − q·q)²) / |q|` away from the segment, and that needs no division.
//!
//! Rounding moves `p` and `q` as if the ray had been moved by a few roundings of the way from its origin to the
//! segment and of the segment's length. Where the ray goes along the segment, `q` is nothing but rounding, and it is
//! still the same `q` in both terms: their sum is then right whatever it is.

use fearless_simd::{Simd, SimdBase, f32x8};

use crate::{
    lanes::{Lanes, dot},
    local::Ray,
    primitives::splat3,
};

/// No square that matters is less.
const TINY: f32 = 1e-37;
/// The share of coordinates and lengths that rounding is sure to stay below.
const ROUNDED: f32 = 2e-6;

/// A ray, or the same ray in every lane, and two axes across it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayFrame<F> {
    /// The axes of space in the order in which coordinates are taken here: that along which the ray goes least is
    /// the first one.
    axes: [usize; 3],
    origin: [F; 3],
    /// The first axis across, of length 1 / |d|.
    right: [F; 3],
    /// The second one; it has nothing along the first axis of space.
    up: [F; 2],
    /// 1 / |d|.
    unit: F,
    /// How much farther than it must a test looks, for what rounding does to the ray.
    slack: F,
    /// d / d·d.
    along: [F; 3],
    pub(super) t_min: F,
    pub(super) t_max: F,
}

/// The axis of space that a ray goes along least, the first of equal ones; then those that follow it.
#[inline(always)]
pub(crate) fn axes([x, y, z]: [f32; 3]) -> [usize; 3] {
    let size = [x.abs(), y.abs(), z.abs()];
    let first = usize::from(size[1] < size[0]);
    let first = if size[2] < size[first] { 2 } else { first };
    [first, (first + 1) % 3, (first + 2) % 3]
}

impl RayFrame<f32> {
    /// Prepares a ray.
    #[inline(always)]
    pub(crate) fn new(ray: &Ray) -> Self {
        let Ray { origin, dir, t_min, t_max } = *ray;
        let (origin, dir) = (origin.to_array(), dir.to_array());
        Across::new(axes(dir), origin, dir).frame(origin, t_min, t_max)
    }

    /// The same in eight lanes.
    #[inline(always)]
    pub(crate) fn eight<S: Simd>(&self, simd: S) -> RayFrame<f32x8<S>> {
        let [up_y, up_z] = self.up;
        RayFrame {
            axes: self.axes,
            origin: splat3(simd, self.origin),
            right: splat3(simd, self.right),
            up: [SimdBase::splat(simd, up_y), SimdBase::splat(simd, up_z)],
            unit: SimdBase::splat(simd, self.unit),
            slack: SimdBase::splat(simd, self.slack),
            along: splat3(simd, self.along),
            t_min: SimdBase::splat(simd, self.t_min),
            t_max: SimdBase::splat(simd, self.t_max),
        }
    }
}

/// What a [`RayFrame`] has beyond its ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Across<F> {
    axes: [usize; 3],
    right: [F; 3],
    up: [F; 2],
    unit: F,
    slack: F,
    along: [F; 3],
}

/// How many numbers an [`Across`] has.
pub(crate) const ACROSS: usize = 10;

impl<F: Lanes<Scalar = f32>> Across<F> {
    /// Of a ray, or of several for which [`axes`] are the same.
    #[inline(always)]
    pub(crate) fn new(axes: [usize; 3], origin: [F; 3], dir: [F; 3]) -> Self {
        let [x, y, z] = [dir[axes[0]], dir[axes[1]], dir[axes[2]]];
        let across = y * y + z * z;
        let square = across + x * x;
        let one = square.splat(1.0);
        let per_square = one / square;
        let unit = per_square.sqrt();
        let per = one / (across * square).sqrt();
        let per_right = per * unit;
        let far = origin[0].abs() + origin[1].abs() + origin[2].abs();
        Self {
            axes,
            right: [-across * per_right, x * y * per_right, x * z * per_right],
            up: [z * per, -y * per],
            along: [x * per_square, y * per_square, z * per_square],
            unit,
            slack: far * unit * ROUNDED,
        }
    }
}

impl<F: Copy> Across<F> {
    /// Its numbers side by side, to be kept.
    #[inline(always)]
    pub(crate) fn numbers(&self) -> [F; ACROSS] {
        let ([a, b, c], [d, e], [f, g, h]) = (self.right, self.up, self.along);
        [a, b, c, d, e, f, g, h, self.unit, self.slack]
    }

    /// From the numbers that were kept.
    #[inline(always)]
    pub(crate) fn of(axes: [usize; 3], [a, b, c, d, e, f, g, h, unit, slack]: [F; ACROSS]) -> Self {
        Self { axes, right: [a, b, c], up: [d, e], along: [f, g, h], unit, slack }
    }

    /// Together with its ray.
    #[inline(always)]
    pub(crate) fn frame(&self, origin: [F; 3], t_min: F, t_max: F) -> RayFrame<F> {
        let Self { axes, right, up, unit, slack, along } = *self;
        let [x, y, z] = axes;
        let origin = [origin[x], origin[y], origin[z]];
        RayFrame { axes, origin, right, up, unit, slack, along, t_min, t_max }
    }
}

impl<F> RayFrame<F> {
    /// The axes of space in the order in which coordinates are taken, each below 3.
    #[inline(always)]
    pub(super) fn axes(&self) -> [usize; 3] {
        let [x, y, z] = self.axes;
        [x & 3, y & 3, z & 3]
    }
}

/// What [`Seen::misses`] takes for a radius: more by what it rounds because of the segment from `from` to
/// `from + 2 h`.
pub(super) fn reach(radius: f32, from: [f32; 3], h: [f32; 3]) -> f32 {
    let size = |[x, y, z]: [f32; 3]| x.abs() + y.abs() + z.abs();
    radius * 1.000_01 + (size(from) + size(h)) * ROUNDED
}

/// How much farther than [`reach`] a box around a segment reaches, so that it holds all that rays may meet which
/// start within `far` of the origin, their coordinates added up: twice what rounding does to them.
pub(super) fn slack(far: f32) -> f32 {
    2.0 * ROUNDED * far
}

/// A segment as a ray sees it, or eight of them. With `r²` over the square of the ray's length, all is in the
/// ray's `t`.
#[derive(Clone, Copy)]
pub(super) struct Seen<F> {
    /// From the ray's origin to the first end.
    c: [F; 3],
    /// Half of the way to the second end.
    h: [F; 3],
    /// The middle across the ray, and from there to the second end.
    p: [F; 2],
    q: [F; 2],
    cross: F,
    pq: F,
    qq: F,
}

impl<F: Lanes<Scalar = f32>> Seen<F> {
    /// Looks at a segment from `from` to `from + 2 h`, coordinates in the order of [`RayFrame::axes`].
    #[inline(always)]
    pub(super) fn new(ray: &RayFrame<F>, from: [F; 3], h: [F; 3]) -> Self {
        let c = [from[0] - ray.origin[0], from[1] - ray.origin[1], from[2] - ray.origin[2]];
        let q = [dot(ray.right, h), ray.up[0] * h[1] + ray.up[1] * h[2]];
        let p = [dot(ray.right, c) + q[0], ray.up[0] * c[1] + ray.up[1] * c[2] + q[1]];
        Self {
            c,
            h,
            p,
            q,
            cross: p[0] * q[1] - p[1] * q[0],
            pq: p[0] * q[0] + p[1] * q[1],
            qq: q[0] * q[0] + q[1] * q[1],
        }
    }

    /// Whether the line surely comes nowhere as near to the segment as a radius whose [`reach`] is given.
    #[inline(always)]
    pub(super) fn misses(&self, ray: &RayFrame<F>, reach: F) -> F::Mask {
        let reach = reach * ray.unit + ray.slack;
        let beyond = (self.pq.abs() - self.qq).above_zero();
        // Of what is NaN nothing is sure, and of the smallest numbers neither.
        (self.cross * self.cross + beyond * beyond).gt(reach * reach * self.qq + TINY)
    }

    /// The line in the endless cylinder of a radius around the segment.
    #[inline(always)]
    pub(super) fn chord(&self, ray: &RayFrame<F>, radius: F) -> Chord<F> {
        let Self { c, h, p, q, cross, pq, qq } = *self;
        let radius = radius * ray.unit;
        let square = radius * radius;
        let k = dot(ray.along, h);
        let hh = qq + k * k;
        let per_qq = qq.splat(1.0) / qq.at_least(TINY);
        let nearest = -(pq * per_qq) * k;
        let reach = ((square - cross * (cross * per_qq)) * (hh * per_qq)).sqrt();
        let [enter, leave] = [nearest - reach, nearest + reach];
        Chord { middle: dot(ray.along, c) + k, p, q, k, pq, hh, square, enter, leave }
    }
}

/// The part of a line in the endless cylinder around a segment. Every `t` is counted from where the line passes the
/// segment's middle; NaN: there is none.
#[derive(Clone, Copy)]
pub(super) struct Chord<F> {
    /// Where the line passes the segment's middle.
    middle: F,
    /// As a [`Seen`] has them.
    p: [F; 2],
    q: [F; 2],
    pq: F,
    /// How far from the middle the line passes the second end.
    k: F,
    /// The squares of half of the segment and of the radius.
    hh: F,
    square: F,
    /// Where the line goes in, and where it comes out.
    enter: F,
    leave: F,
}

/// Where a line crosses a surface.
#[derive(Clone, Copy)]
pub(super) struct Crossing<F: Lanes> {
    /// Distance along the ray; NaN: nowhere.
    pub(super) t: F,
    /// Whether that is in the half of the second end.
    pub(super) second_half: F::Mask,
}

impl<F: Lanes<Scalar = f32>> Chord<F> {
    /// Where the line crosses the capsule, going in and coming out.
    ///
    /// A capsule is convex, so each crossing with the endless cylinder tells alone whether the capsule is crossed on
    /// its side, or which end is; and a line that does not go in does not come out.
    #[inline(always)]
    pub(super) fn round(&self) -> [Crossing<F>; 2] {
        let Self { p, q, square, .. } = *self;
        let first = within(p[0] - q[0], p[1] - q[1], square);
        let second = within(p[0] + q[0], p[1] + q[1], square);
        [self.round_at(self.enter, -first, -second), self.round_at(self.leave, first, second)]
    }

    /// The same on one side, given where the endless cylinder is crossed, and where the spheres around both ends
    /// are, counted from these.
    #[inline(always)]
    fn round_at(&self, t: F, first: F, second: F) -> Crossing<F> {
        let along = t * self.k - self.pq;
        let second_half = along.gt(along.splat(0.0));
        let end = F::select(second_half, second + self.k, first - self.k);
        // Not where there is no length: there the ends are all that there is.
        let on_side = along.abs().lt(self.hh);
        Crossing { t: self.middle + F::select(on_side, t, end), second_half }
    }

    /// Where the line crosses the cylinder whose ends are discs where `flat`, else open.
    #[inline(always)]
    pub(super) fn cut(&self, flat: F::Mask) -> [Crossing<F>; 2] {
        let Self { p, q, k, pq, hh, square, enter, leave, .. } = *self;
        let none = k.splat(f32::NAN);
        // What is seen from its end has no sides by which the line could pass.
        let has_sides = (q[0] * q[0] + q[1] * q[1]).gt(k.splat(TINY));
        let within = has_sides | square.gt(p[0] * p[0] + p[1] * p[1]);
        // Between the planes of the ends; where the line is along them, everywhere or nowhere.
        let per_k = k.splat(1.0) / F::select(k.abs().gt(k.splat(TINY)), k, k.splat(TINY));
        let [first, second] = [(pq - hh) * per_k, (pq + hh) * per_k];
        let back = k.lt(k.splat(0.0));
        let [low, high] = [F::select(back, second, first), F::select(back, first, second)];
        let low = F::select(low.gt(enter), low, enter);
        let high = F::select(high.lt(leave), high, leave);
        let inside = low.lt(high) & hh.gt(hh.splat(0.0)) & within;
        let [low, high] = [F::select(inside, low, none), F::select(inside, high, none)];
        // And on the side alone.
        let [at_enter, at_leave] = [enter * k - pq, leave * k - pq];
        let enter = F::select(at_enter.abs().lt(hh), enter, none);
        let leave = F::select(at_leave.abs().lt(hh), leave, none);
        [self.cut_at(F::select(flat, low, enter)), self.cut_at(F::select(flat, high, leave))]
    }

    #[inline(always)]
    fn cut_at(&self, t: F) -> Crossing<F> {
        let second_half = (t * self.k).gt(self.pq);
        Crossing { t: self.middle + t, second_half }
    }
}

impl<F: Lanes> Crossing<F> {
    /// `yes` where the mask is set, else `no`.
    #[inline(always)]
    pub(super) fn select(mask: F::Mask, yes: Self, no: Self) -> Self {
        let second_half = mask & yes.second_half | !mask & no.second_half;
        Self { t: F::select(mask, yes.t, no.t), second_half }
    }
}

/// Half of the way that the line is within a sphere whose middle it sees at `x` and `y`; NaN: it misses it.
#[inline(always)]
fn within<F: Lanes>(x: F, y: F, square: F) -> F {
    (square - (x * x + y * y)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sees(origin: [f32; 3], dir: [f32; 3], h: [f32; 3], radius: f32) -> bool {
        let ray = RayFrame::new(&Ray::new(origin.into(), dir.into()));
        let from = h.map(|x| -x);
        let by_axis = |v: [f32; 3]| ray.axes().map(|axis| v[axis]);
        let seen = Seen::new(&ray, by_axis(from), by_axis(h));
        !seen.misses(&ray, reach(radius, from, h))
    }

    #[test]
    fn the_axes_across_a_ray_are_at_right_angles_whatever_its_direction_and_length() {
        for dir in
            [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.6, 0.8, 0.0], [-3.0, 4.0, 12.0], [1e-3; 3]]
        {
            let ray = RayFrame::new(&Ray::new([0.0; 3].into(), dir.into()));
            let d = ray.axes().map(|axis| f64::from(dir[axis]));
            let length = dot(d, d).sqrt();
            let right = ray.right.map(|x| f64::from(x) * length);
            let up = [0.0, f64::from(ray.up[0]) * length, f64::from(ray.up[1]) * length];
            for (a, b, expected) in [
                (right, right, 1.0),
                (up, up, 1.0),
                (right, up, 0.0),
                (right, d, 0.0),
                (up, d, 0.0),
            ] {
                let off = dot(a, b) - expected;
                assert!(off.abs() < 5e-7 * length.max(1.0), "{dir:?}: {off}");
            }
        }
    }

    #[test]
    fn a_line_is_near_the_segment_and_not_its_axis_alone() {
        let h = [0.0, 0.0, 2.0];
        for long in [1.0, 0.01, 300.0] {
            let across = [0.0, long, 0.0];
            assert!(sees([0.49, 9.0, 1.0], across, h, 0.5));
            assert!(!sees([0.51, 9.0, 1.0], across, h, 0.5), "beside");
            assert!(sees([0.0, -9.0, 2.49], across, h, 0.5));
            assert!(!sees([0.0, -9.0, 2.51], across, h, 0.5), "beyond the end");
            assert!(sees([0.3, 9.0, -2.39], across, h, 0.5));
            assert!(!sees([0.3, 9.0, -2.42], across, h, 0.5), "beyond the end and beside");
            let slanting = [long, 0.0, long];
            assert!(sees([-5.0, 0.0, -2.3], slanting, h, 0.5), "above the end");
            assert!(!sees([-4.0, 0.0, 0.75 - 2.0], slanting, h, 0.5), "by 0.75 / √2");
        }
    }

    #[test]
    fn a_line_along_the_axis_and_what_has_no_length_are_seen_as_well() {
        let h = [0.0, 0.0, 2.0];
        assert!(sees([0.3, 0.3, -9.0], [0.0, 0.0, 1.0], h, 0.5));
        assert!(!sees([3.0, 0.0, -9.0], [0.0, 0.05, 1.0], h, 0.5));
        assert!(sees([0.0, 5.0, 0.0], [1.0, 0.0, 0.0], [0.0; 3], 1.0), "its ends decide");
        assert!(sees([f32::NAN; 3], [0.0, 1.0, 0.0], h, 0.5));
        assert!(sees([1e30; 3], [0.0, 1.0, 0.0], [0.0, 0.0, 2e30], 1e20), "what overflows");
    }
}
