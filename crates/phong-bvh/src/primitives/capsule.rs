//! The capsule: all points at `radius` from a segment, and so a cylinder with a half sphere at each
//! end. Bonds and tubes are made of many.
//!
//! Let `m` be the segment's middle, and `h` lead from it to the second end. As for the
//! [sphere](super::sphere), the ray starts anew at its point closest to `m`, at `b`, and `f` leads
//! from there to `m`. What is left of direction and `f` across the axis is
//! `e = d − (d·h / h·h) h` and `g = f − (f·h / h·h) h`. Seen along the axis, the endless cylinder is a
//! circle, and the line is nearest to its middle at `c = g·e / e·e`, by `q = g − c e`. So the line is
//! inside for `c ± √((r² − q·q) / e·e)`: again the closest-point form, with no difference of
//! large squares.
//!
//! Where one of these two is between the ends, `|t (d·h) − f·h| ≤ h·h`, the line crosses the
//! cylinder's side there. Where it is beyond an end, the line can cross on that side only the sphere
//! around that end. A capsule is convex, so this is true of both crossings, each on its own; and a line that
//! does not go in does not come out.
//!
//! A line along the axis makes `e` zero but for rounding. Then the crossings with the endless
//! cylinder are far beyond the ends, and the sphere decides. Where the segment has no length, h = 0,
//! the side is the sphere.
//!
//! **Most lines miss widely**, which [`super::segment`] knows sooner than this does. So a ray asks that
//! of eight cylinders first. What is left takes the same steps in one lane and in eight, in f32, so they agree bit
//! for bit. Errors are as if the ray had been moved by a few roundings of the middle's distance and of the
//! segment's length.
//!
//! **Blocks.** Eight capsules share a block with what has two radii, flat ends or none
//! ([`tapered`](super::tapered)). These lie within a capsule, so the same first question is asked of them; what is
//! left is met in f64.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};

use super::{
    segment::{self, misses},
    sphere::{Closest, Closest8},
};
use crate::{Caps, Cylinder, node8::Row};

/// Divisors are no less.
const TINY: f32 = 1e-37;
/// `e·e` is no less. Rounding alone makes it 10⁻¹⁴ for a ray along the axis.
const ALONG: f32 = 1e-20;

/// Half of the way from the first end to the second.
#[inline(always)]
pub(crate) fn half(cylinder: &Cylinder) -> [f32; 3] {
    (0.5 * (cylinder.to - cylinder.from)).to_array()
}

/// Whether it is a capsule: the rest is [`tapered`](super::tapered).
#[inline(always)]
pub(crate) fn is_capsule(cylinder: &Cylinder, caps: Caps) -> bool {
    caps == Caps::Round && cylinder.radius == cylinder.radius_to
}

/// Where a cylinder is hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct At {
    /// Distance along the ray.
    pub(crate) t: f32,
    /// Whether that is in the half of the second end.
    pub(crate) second_half: bool,
}

/// Where a ray meets a capsule, or none.
pub(crate) fn intersect(ray: &Closest, capsule: &Cylinder) -> Option<At> {
    let [x, y, z, hx, hy, hz, reach, radius, _] = lane(capsule, Caps::Round);
    let [ox, oy, oz] = ray.origin;
    let c = [x - ox + hx, y - oy + hy, z - oz + hz];
    if misses(ray.dir, ray.scale, c, [hx, hy, hz], reach) {
        return None;
    }
    let [dx, dy, dz] = ray.dir;
    let [cx, cy, cz] = c;
    let b = (cx * dx + cy * dy + cz * dz) * ray.scale;
    let [fx, fy, fz] = [cx - b * dx, cy - b * dy, cz - b * dz];
    let hh = hx * hx + hy * hy + hz * hz;
    let per_hh = 1.0 / hh.max(TINY);
    let dh = dx * hx + dy * hy + dz * hz;
    let fh = fx * hx + fy * hy + fz * hz;
    let (d_along, f_along) = (dh * per_hh, fh * per_hh);
    let [ex, ey, ez] = [dx - d_along * hx, dy - d_along * hy, dz - d_along * hz];
    let [gx, gy, gz] = [fx - f_along * hx, fy - f_along * hy, fz - f_along * hz];
    let per_ee = 1.0 / (ex * ex + ey * ey + ez * ez).max(ALONG);
    let c = (gx * ex + gy * ey + gz * ez) * per_ee;
    let [qx, qy, qz] = [gx - c * ex, gy - c * ey, gz - c * ez];
    let square = radius * radius;
    let inside = square - (qx * qx + qy * qy + qz * qz);
    if inside < 0.0 {
        return None;
    }
    let reach = (inside * per_ee).sqrt();
    let crossing = |side: f32| {
        let t = c + side * reach;
        let along = t * dh - fh;
        let second_half = along > 0.0;
        if along.abs() <= hh {
            return Some(At { t: b + t, second_half });
        }
        let end = if along > 0.0 { 1.0 } else { -1.0 };
        let [vx, vy, vz] = [fx + end * hx, fy + end * hy, fz + end * hz];
        let k = (vx * dx + vy * dy + vz * dz) * ray.scale;
        let [wx, wy, wz] = [vx - k * dx, vy - k * dy, vz - k * dz];
        let inside = square - (wx * wx + wy * wy + wz * wz);
        let t = b + (k + side * (inside * ray.scale).sqrt());
        (inside >= 0.0).then_some(At { t, second_half })
    };
    let enter = crossing(-1.0)?;
    let at = if enter.t > ray.t_min { enter } else { crossing(1.0)? };
    (at.t > ray.t_min && at.t < ray.t_max).then_some(at)
}

/// Eight cylinders: x, y, z of the first end, the same of [`half`], how far [`misses`] has to look, the two
/// radii, then their numbers. The sign of the first radius is negative where the ends are flat, that of the
/// second where the cylinder is open, so that both are the same number in capsules alone.
pub(crate) const BLOCK: usize = 10;

/// A cylinder as the first numbers of one lane of a block.
pub(crate) fn lane(cylinder: &Cylinder, caps: Caps) -> [f32; BLOCK - 1] {
    let [x, y, z] = cylinder.from.to_array();
    let h @ [hx, hy, hz] = half(cylinder);
    let reach = segment::reach(cylinder.radius.max(cylinder.radius_to), h);
    let radius = if caps == Caps::Flat { -cylinder.radius } else { cylinder.radius };
    let radius_to = if caps == Caps::Open { -cylinder.radius_to } else { cylinder.radius_to };
    [x, y, z, hx, hy, hz, reach, radius, radius_to]
}

/// The cylinders of a block that a ray may meet, a bit each.
#[inline(always)]
pub(crate) fn may_meet<S: Simd>(simd: S, ray: &Closest8<S>, block: &[Row; BLOCK]) -> u32 {
    let [ox, oy, oz] = ray.origin;
    let h @ [hx, hy, hz] = [row(simd, block, 3), row(simd, block, 4), row(simd, block, 5)];
    let cx = row(simd, block, 0) - ox + hx;
    let cy = row(simd, block, 1) - oy + hy;
    let cz = row(simd, block, 2) - oz + hz;
    let misses = misses(ray.dir, ray.scale, [cx, cy, cz], h, row(simd, block, 6));
    !misses.to_bitmask() as u32 & 0xff
}

#[inline(always)]
fn row<S: Simd>(simd: S, block: &[Row; BLOCK], row: usize) -> f32x8<S> {
    f32x8::load_array_ref(simd, &block[row].0)
}

/// Which lanes of a block a ray meets.
pub(crate) struct CapsuleHits {
    /// Capsules that are hit, a bit each.
    pub(crate) hit: u32,
    /// Those of them that are hit in the half of the second end.
    pub(crate) second_half: u32,
    /// What is no capsule and may be hit, a bit each.
    pub(crate) open: u32,
    /// Where capsules are hit.
    pub(crate) t: [f32; 8],
}

impl CapsuleHits {
    /// Where the capsule of a lane is hit, which it is.
    #[inline(always)]
    pub(crate) fn at(&self, lane: usize) -> At {
        At { t: self.t[lane & 7], second_half: self.second_half >> lane & 1 != 0 }
    }
}

/// A ray against those of the cylinders of a block that it [may meet](may_meet).
///
/// All that may be asked for is computed at once, rather than one after the other: what the processor would
/// have to guess costs more than what is for nothing.
#[inline(always)]
pub(crate) fn intersect8<S: Simd>(
    simd: S,
    ray: &Closest8<S>,
    block: &[Row; BLOCK],
    may: u32,
) -> CapsuleHits {
    let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
    let radius = row(simd, block, 7);
    let capsule = radius.simd_eq(row(simd, block, 8));
    let may = mask32x8::from_bitmask(simd, may.into());
    let open = (may & !capsule).to_bitmask() as u32;
    let may = may & capsule;
    if !may.any_true() {
        return CapsuleHits { hit: 0, second_half: 0, open, t: [0.0; 8] };
    }
    let [ox, oy, oz] = ray.origin;
    let [dx, dy, dz] = ray.dir;
    let (hx, hy, hz) = (row(simd, block, 3), row(simd, block, 4), row(simd, block, 5));
    let cx = row(simd, block, 0) - ox + hx;
    let cy = row(simd, block, 1) - oy + hy;
    let cz = row(simd, block, 2) - oz + hz;
    let b = (cx * dx + cy * dy + cz * dz) * ray.scale;
    let fx = cx - b * dx;
    let fy = cy - b * dy;
    let fz = cz - b * dz;
    let hh = hx * hx + hy * hy + hz * hz;
    let per_hh = one / hh.max(TINY);
    let dh = dx * hx + dy * hy + dz * hz;
    let fh = fx * hx + fy * hy + fz * hz;
    let (d_along, f_along) = (dh * per_hh, fh * per_hh);
    let ex = dx - d_along * hx;
    let ey = dy - d_along * hy;
    let ez = dz - d_along * hz;
    let gx = fx - f_along * hx;
    let gy = fy - f_along * hy;
    let gz = fz - f_along * hz;
    let per_ee = one / (ex * ex + ey * ey + ez * ez).max(ALONG);
    let c = (gx * ex + gy * ey + gz * ez) * per_ee;
    let qx = gx - c * ex;
    let qy = gy - c * ey;
    let qz = gz - c * ez;
    let square = radius * radius;
    let inside = square - (qx * qx + qy * qy + qz * qz);
    let may = may & inside.simd_ge(zero);
    let reach = (inside.max(zero) * per_ee).sqrt();
    let line = Line { dir: ray.dir, scale: ray.scale, b, dh, fh, hh };
    let ends = [
        Ball::met(simd, &line, [fx - hx, fy - hy, fz - hz], square),
        Ball::met(simd, &line, [fx + hx, fy + hy, fz + hz], square),
    ];
    let (met, enter, second_half) = crossing(simd, &line, &ends, c - reach, -1.0);
    let (leaves, leave, behind) = crossing(simd, &line, &ends, c + reach, 1.0);
    let met = may & met;
    let first = met & enter.simd_gt(ray.t_min);
    // Some lines go in where the ray does not count it: it may start within.
    let inside = met & !first & leaves & leave.simd_gt(ray.t_min);
    let t = first.select(enter, leave);
    let hit = ((first | inside) & t.simd_lt(ray.t_max)).to_bitmask() as u32;
    let second_half = (first & second_half | !first & behind).to_bitmask() as u32;
    CapsuleHits { hit, second_half, open, t: t.to_array() }
}

/// The line of a ray as eight capsules see it.
struct Line<S: Simd> {
    dir: [f32x8<S>; 3],
    /// 1 / d·d.
    scale: f32x8<S>,
    /// Where it is closest to the middle.
    b: f32x8<S>,
    /// d·h, f·h and h·h.
    dh: f32x8<S>,
    fh: f32x8<S>,
    hh: f32x8<S>,
}

/// Where a line crosses the spheres around one end of eight capsules, counted from `b`.
struct Ball<S: Simd> {
    /// Whether it does.
    met: mask32x8<S>,
    /// In the middle between the two crossings.
    middle: f32x8<S>,
    /// How far from there each is.
    reach: f32x8<S>,
}

impl<S: Simd> Ball<S> {
    /// `v` leads to the end from where the line is closest to the middle.
    #[inline(always)]
    fn met(simd: S, line: &Line<S>, [vx, vy, vz]: [f32x8<S>; 3], square: f32x8<S>) -> Self {
        let &Line { dir: [dx, dy, dz], scale, .. } = line;
        let k = (vx * dx + vy * dy + vz * dz) * scale;
        let wx = vx - k * dx;
        let wy = vy - k * dy;
        let wz = vz - k * dz;
        let inside = square - (wx * wx + wy * wy + wz * wz);
        let zero = f32x8::splat(simd, 0.0);
        let reach = (inside.max(zero) * scale).sqrt();
        Self { met: inside.simd_ge(zero), middle: k, reach }
    }
}

/// The crossing on one side, given where the endless cylinder is crossed there, counted from `b`: which
/// capsules are, if their endless cylinders are, where, and which in the half of the second end.
///
/// No closure: that would be compiled without the level's instructions.
#[inline(always)]
fn crossing<S: Simd>(
    simd: S,
    line: &Line<S>,
    [first, second]: &[Ball<S>; 2],
    t: f32x8<S>,
    side: f32,
) -> (mask32x8<S>, f32x8<S>, mask32x8<S>) {
    let along = t * line.dh - line.fh;
    let on_side = along.abs().simd_le(line.hh);
    let second_half = along.simd_gt(f32x8::splat(simd, 0.0));
    let on_first = first.middle + first.reach * side;
    let on_second = second.middle + second.reach * side;
    let t = line.b + on_side.select(t, second_half.select(on_second, on_first));
    (on_side | second_half & second.met | !second_half & first.met, t, second_half)
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
        intersect(&Closest::new(&Ray::new(origin.into(), dir.into())), capsule).map(|at| at.t)
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
    fn a_thin_stick_far_away_is_met_at_its_near_side() {
        let stick = capsule([100.0, -1.0, -1.0], [100.0, 1.0, 1.0], 0.01);
        let across = Vec3::new(0.0, 1.0, -1.0).normalize_or(Vec3::Y) * 0.009;
        let t = meet(across.to_array(), [1.0, 0.0, 0.0], &stick).expect("a hit");
        assert!((t - (100.0 - (0.01f32 * 0.01 - 0.009 * 0.009).sqrt())).abs() < 2e-5, "{t}");
        assert_eq!(meet((across * 1.13).to_array(), [1.0, 0.0, 0.0], &stick), None);
    }
}
