//! The capsule: all points at `radius` from a segment, and so a cylinder with a half sphere at each
//! end. Bonds and tubes are made of many.
//!
//! In the [frame of the ray](super::ray_frame) a segment has its middle at `(p, b)` and half of it is `(q, k)`: first
//! what is seen of it across the ray, then what is along the ray. The line is nearest to the axis at
//! `b − (p·q / q·q) k`, by `|p × q| / |q|`, and sees the cylinder's chord longer by `√(q·q + k²) / |q|` than it is
//! across the axis. So it is inside the endless cylinder for
//! `b − (p·q / q·q) k ± √((r² − (p × q)² / q·q) (q·q + k²) / q·q)`: the closest-point form of the
//! [sphere](super::sphere), with no difference of large squares, and of what the first question was answered with.
//!
//! Where one of these two is between the ends, `|(t − b) k − p·q| < q·q + k²`, the line crosses the
//! cylinder's side there. Where it is beyond an end, the line can cross on that side only the sphere
//! around that end, which is seen at `p ± q`.
//!
//! A line along the axis makes `q` zero but for rounding. Then the crossings with the endless
//! cylinder are far beyond the ends, and the sphere decides. Where the segment has no length the
//! ends are the sphere.
//!
//! **Most lines miss widely.** So of eight cylinders it is asked first which the line comes near to at all. One lane
//! and eight take the same steps in f32, so they agree bit for bit. Errors are as if the ray had been moved by a few
//! roundings of the middle's distance and of the segment's length.
//!
//! **Other ends.** Discs leave the part of the chord between the planes of both ends, `|(t − b) k − p·q| ≤ q·q + k²`.
//! Where there is nothing, of the crossings with the side those count that are between the ends.
//!
//! **Blocks.** What has two radii ([`tapered`](super::tapered)) shares blocks with the others. It lies within a
//! capsule, so the same first question is asked of it; what is left is met in f64.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};

use super::ray_frame::{self, Crossing, RayFrame, Seen};
use crate::{Caps, Cylinder, node8::Row};

/// Half of the way from the first end to the second.
#[inline(always)]
pub(crate) fn half(cylinder: &Cylinder) -> [f32; 3] {
    (0.5 * (cylinder.to - cylinder.from)).to_array()
}

/// Whether it is a capsule.
#[inline(always)]
pub(crate) fn is_capsule(cylinder: &Cylinder, caps: Caps) -> bool {
    caps == Caps::Round && is_straight(cylinder)
}

/// Whether it has one radius: the rest is [`tapered`](super::tapered).
#[inline(always)]
pub(crate) fn is_straight(cylinder: &Cylinder) -> bool {
    cylinder.radius == cylinder.radius_to
}

/// Where a cylinder is hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct At {
    /// Distance along the ray.
    pub(crate) t: f32,
    /// Whether that is in the half of the second end.
    pub(crate) second_half: bool,
}

/// Where a ray meets a cylinder of one radius, or none.
pub(crate) fn intersect(ray: &RayFrame<f32>, cylinder: &Cylinder, caps: Caps) -> Option<At> {
    let numbers = lane(cylinder, Caps::Round);
    let [x, y, z] = ray.axes();
    let from = [numbers[x], numbers[y], numbers[z]];
    let seen = Seen::new(ray, from, [numbers[3 + x], numbers[3 + y], numbers[3 + z]]);
    if seen.misses(ray, numbers[6]) {
        return None;
    }
    let chord = seen.chord(ray, numbers[7]);
    let [enter, leave] =
        if caps == Caps::Round { chord.round() } else { chord.cut(caps == Caps::Flat) };
    let Crossing { t, second_half } = if enter.t > ray.t_min { enter } else { leave };
    (t > ray.t_min && t < ray.t_max).then_some(At { t, second_half })
}

/// Eight cylinders: x, y, z of the first end, the same of [`half`], how far [`Seen8::may_meet`] has to look, the two
/// radii, then their numbers. The sign of the first radius is negative where the ends are flat, that of the
/// second where the cylinder is open, so that both are the same number in capsules alone.
pub(crate) const BLOCK: usize = 10;

/// A cylinder as the first numbers of one lane of a block.
pub(crate) fn lane(cylinder: &Cylinder, caps: Caps) -> [f32; BLOCK - 1] {
    let [x, y, z] = cylinder.from.to_array();
    let h @ [hx, hy, hz] = half(cylinder);
    let reach = ray_frame::reach(cylinder.radius.max(cylinder.radius_to), [x, y, z], h);
    let radius = if caps == Caps::Flat { -cylinder.radius } else { cylinder.radius };
    let radius_to = if caps == Caps::Open { -cylinder.radius_to } else { cylinder.radius_to };
    [x, y, z, hx, hy, hz, reach, radius, radius_to]
}

/// The cylinders of a block as a ray sees them.
#[derive(Clone, Copy)]
pub(crate) struct Seen8<'a, S: Simd> {
    ray: &'a RayFrame<f32x8<S>>,
    block: &'a [Row; BLOCK],
    seen: Seen<f32x8<S>>,
}

#[inline(always)]
fn row<S: Simd>(simd: S, block: &[Row; BLOCK], row: usize) -> f32x8<S> {
    f32x8::load_array_ref(simd, &block[row].0)
}

/// Which lanes of a block a ray meets.
pub(crate) struct CylinderHits {
    /// Those of one radius that are hit, a bit each.
    pub(crate) hit: u32,
    /// Those of them that are hit in the half of the second end.
    pub(crate) second_half: u32,
    /// Those of two radii that may be hit, a bit each.
    pub(crate) tapered: u32,
    /// Where those of one radius are hit.
    pub(crate) t: [f32; 8],
}

impl CylinderHits {
    /// Where the cylinder of a lane is hit, which it is.
    #[inline(always)]
    pub(crate) fn at(&self, lane: usize) -> At {
        At { t: self.t[lane & 7], second_half: self.second_half >> lane & 1 != 0 }
    }
}

impl<'a, S: Simd> Seen8<'a, S> {
    /// Looks at a block.
    #[inline(always)]
    pub(crate) fn new(simd: S, ray: &'a RayFrame<f32x8<S>>, block: &'a [Row; BLOCK]) -> Self {
        let [x, y, z] = ray.axes();
        let from = [row(simd, block, x), row(simd, block, y), row(simd, block, z)];
        let half = [row(simd, block, 3 + x), row(simd, block, 3 + y), row(simd, block, 3 + z)];
        Self { ray, block, seen: Seen::new(ray, from, half) }
    }

    /// The cylinders that the ray may meet, a bit each.
    #[inline(always)]
    pub(crate) fn may_meet(&self, simd: S) -> u32 {
        !self.seen.misses(self.ray, row(simd, self.block, 6)).to_bitmask() as u32 & 0xff
    }

    /// The ray against those of the cylinders that it [may meet](Self::may_meet).
    ///
    /// All that may be asked for is computed at once, rather than one after the other: what the processor would
    /// have to guess costs more than what is for nothing.
    #[inline(always)]
    pub(crate) fn intersect(&self, simd: S, may: u32) -> CylinderHits {
        let Self { ray, block, seen } = self;
        let may = mask32x8::from_bitmask(simd, may.into());
        let [first, second] = [row(simd, block, 7), row(simd, block, 8)];
        let radius = first.abs();
        let straight = radius.simd_eq(second.abs());
        let round = first.simd_eq(second);
        let chord = seen.chord(ray, radius);
        let [mut enter, mut leave] = chord.round();
        if (may & straight & !round).any_true() {
            let [cut_enter, cut_leave] = chord.cut(first.simd_lt(f32x8::splat(simd, 0.0)));
            enter = Crossing::select(round, enter, cut_enter);
            leave = Crossing::select(round, leave, cut_leave);
        }
        let (hit, Crossing { t, second_half }) = met(ray, enter, leave);
        let tapered = (may & !straight).to_bitmask() as u32;
        CylinderHits {
            hit: (may & straight & hit).to_bitmask() as u32,
            second_half: second_half.to_bitmask() as u32,
            tapered,
            t: t.to_array(),
        }
    }
}

/// Which of its two crossings a ray meets, and the lanes in which it meets one.
#[inline(always)]
fn met<S: Simd>(
    ray: &RayFrame<f32x8<S>>,
    enter: Crossing<f32x8<S>>,
    leave: Crossing<f32x8<S>>,
) -> (mask32x8<S>, Crossing<f32x8<S>>) {
    let met = Crossing::select(enter.t.simd_gt(ray.t_min), enter, leave);
    (met.t.simd_gt(ray.t_min) & met.t.simd_lt(ray.t_max), met)
}

/// Boxes around the cylinders of a block, for rays that start within `far` of the origin, added up along the axes:
/// no ray meets a cylinder, by its own test, whose box it misses. Least and greatest along each axis, as a node has
/// them.
#[inline(always)]
pub(crate) fn boxes<S: Simd>(simd: S, block: &[Row; BLOCK], far: f32) -> [Row; 6] {
    let pad = row(simd, block, 6) + ray_frame::slack(far);
    let mut sides = [Row::ZERO; 6];
    for axis in 0..3 {
        let from = row(simd, block, axis);
        let half = row(simd, block, 3 + axis);
        let to = from + (half + half);
        (from.min(to) - pad).store_array(&mut sides[2 * axis].0);
        (from.max(to) + pad).store_array(&mut sides[2 * axis + 1].0);
    }
    sides
}

/// Eight rays of the same axes against the cylinder in one lane of a block.
pub(crate) struct OneHits<S: Simd> {
    /// The rays that meet it, a bit each.
    pub(crate) hit: u32,
    /// Where they do, and 1 where that is in the half of the second end, else 0.
    pub(crate) at: [f32x8<S>; 2],
    /// The rays that may meet it where it has two radii, a bit each; then nothing else is known.
    pub(crate) tapered: u32,
}

impl<S: Simd> OneHits<S> {
    /// The rays `among` against it; none where they all miss it widely.
    #[inline(always)]
    pub(crate) fn of(
        simd: S,
        rays: &RayFrame<f32x8<S>>,
        block: &[Row; BLOCK],
        lane: usize,
        among: u32,
    ) -> Option<Self> {
        let number = |row: usize| block[row].0[lane & 7];
        let splat = |row: usize| f32x8::splat(simd, number(row));
        let [x, y, z] = rays.axes();
        let half = [splat(3 + x), splat(3 + y), splat(3 + z)];
        let seen = Seen::new(rays, [splat(x), splat(y), splat(z)], half);
        let may = among & !seen.misses(rays, splat(6)).to_bitmask() as u32;
        if may == 0 {
            return None;
        }
        let [first, second] = [number(7), number(8)];
        let zero = f32x8::splat(simd, 0.0);
        if first.abs() != second.abs() {
            return Some(Self { hit: 0, at: [zero; 2], tapered: may });
        }
        let chord = seen.chord(rays, f32x8::splat(simd, first.abs()));
        let [enter, leave] = if first == second {
            chord.round()
        } else {
            chord.cut(f32x8::splat(simd, first).simd_lt(zero))
        };
        let (hit, Crossing { t, second_half }) = met(rays, enter, leave);
        let half = second_half.select(f32x8::splat(simd, 1.0), zero);
        Some(Self { hit: may & hit.to_bitmask() as u32, at: [t, half], tapered: 0 })
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::local::Ray;

    fn capsule(from: [f32; 3], to: [f32; 3], radius: f32) -> Cylinder {
        Cylinder { from: from.into(), radius, to: to.into(), radius_to: radius }
    }

    fn meet(origin: [f32; 3], dir: [f32; 3], capsule: &Cylinder) -> Option<f32> {
        intersect(&RayFrame::new(&Ray::new(origin.into(), dir.into())), capsule, Caps::Round)
            .map(|at| at.t)
    }

    #[test]
    fn the_side_and_both_ends_are_met_from_outside_and_from_within() {
        let stick = capsule([-2.0, 0.0, 0.0], [2.0, 0.0, 0.0], 0.5);
        assert_eq!(meet([1.0, 5.0, 0.0], [0.0, -1.0, 0.0], &stick), Some(4.5));
        assert_eq!(meet([1.0, 0.0, 0.0], [0.0, -1.0, 0.0], &stick), Some(0.5));
        assert_eq!(meet([9.0, 0.0, 0.0], [-1.0, 0.0, 0.0], &stick), Some(6.5));
        assert_eq!(meet([0.0, 0.25, 0.0], [-1.0, 0.0, 0.0], &stick).map(|t| t > 2.4), Some(true));
        assert_eq!(meet([2.25, 5.0, 0.0], [0.0, -1.0, 0.0], &stick).map(|t| t < 4.6), Some(true));
        assert_eq!(meet([2.6, 5.0, 0.0], [0.0, -1.0, 0.0], &stick), None);
        assert_eq!(meet([9.0, 0.6, 0.0], [-1.0, 0.0, 0.0], &stick), None);
        assert_eq!(meet([3.0, 0.0, 0.0], [1.0, 0.0, 0.0], &stick), None, "behind");
    }

    #[test]
    fn without_length_it_is_a_sphere() {
        let ball = capsule([1.0, 2.0, 3.0], [1.0, 2.0, 3.0], 0.5);
        assert_eq!(meet([1.0, 9.0, 3.0], [0.0, -1.0, 0.0], &ball), Some(6.5));
        assert_eq!(meet([1.0, 2.0, 3.0], [0.0, -1.0, 0.0], &ball), Some(0.5));
    }

    #[test]
    fn flat_ends_are_met_and_open_ones_let_rays_through() {
        let stick = capsule([-2.0, 0.0, 0.0], [2.0, 0.0, 0.0], 0.5);
        let meet = |origin: [f32; 3], dir: [f32; 3], caps| {
            let ray = RayFrame::new(&Ray::new(origin.into(), dir.into()));
            intersect(&ray, &stick, caps).map(|at| (at.t, at.second_half))
        };
        let (back, down) = ([-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]);
        assert_eq!(meet([9.0, 0.25, 0.0], back, Caps::Flat), Some((7.0, true)));
        assert_eq!(meet([0.0, 0.25, 0.0], back, Caps::Flat), Some((2.0, false)), "from within");
        assert_eq!(meet([9.0, 0.25, 0.0], back, Caps::Open), None);
        for caps in [Caps::Flat, Caps::Open] {
            assert_eq!(meet([1.0, 5.0, 0.0], down, caps), Some((4.5, true)));
            assert_eq!(meet([-1.0, 0.0, 0.0], down, caps), Some((0.5, false)), "from within");
            assert_eq!(meet([2.25, 5.0, 0.0], down, caps), None, "beyond the end");
            assert_eq!(meet([9.0, 0.6, 0.0], back, caps), None, "beside");
        }
        // Down through an end: out of an open one, or into the side from within.
        let slanting = [-0.8, -0.6, 0.0];
        for (caps, expected) in [(Caps::Flat, 0.5), (Caps::Open, 0.8 / 0.6)] {
            let at = meet([2.4, 0.3, 0.0], slanting, caps);
            assert!(at.is_some_and(|(t, second)| (t - expected).abs() < 1e-6 && second), "{at:?}");
        }
        let ball = capsule([1.0; 3], [1.0; 3], 0.5);
        let ray = RayFrame::new(&Ray::new([1.0, 9.0, 1.0].into(), down.into()));
        assert_eq!(intersect(&ray, &ball, Caps::Flat), None, "without length");
        assert_eq!(intersect(&ray, &ball, Caps::Open), None, "without length");
    }

    #[test]
    fn a_thin_stick_far_away_is_met_at_its_near_side() {
        let stick = capsule([100.0, -1.0, -1.0], [100.0, 1.0, 1.0], 0.01);
        let across = Vec3::new(0.0, 1.0, -1.0).normalize_or(Vec3::Y) * 0.009;
        let t = meet(across.to_array(), [1.0, 0.0, 0.0], &stick).expect("a hit");
        assert!((t - (100.0 - (0.01f32 * 0.01 - 0.009 * 0.009).sqrt())).abs() < 2e-5, "{t}");
        assert_eq!(meet((across * 1.13).to_array(), [1.0, 0.0, 0.0], &stick), None);
    }
}
