//! Where rays start that leave a surface: one, or eight.

use fearless_simd::{Simd, f32x8, f64x4, mask64x4, prelude::*, u32x8};
use glam::{DVec3, Vec3};

use super::Surfaces8;
use crate::{
    eights::{halves, whole},
    local::load3,
};

/// Where to start a ray that leaves the surface at `p` towards `dir`: beyond the error of `p`, on
/// the side of `ng` that `dir` points to.
///
/// The true point is within the box `p ± p_error`; moved along ±`ng` by `|ng| · p_error`, the box
/// lies wholly on that side of the tangent plane. Where the error is no less than what rounding to f32
/// costs, as it is for things near the world's origin, each coordinate is then rounded away from `p`, to a
/// number in f32, which stays as it is where the ray enters a part's space.
/// (Pharr, Jakob, Humphreys, *Physically Based Rendering*, 4th ed., section 6.8.6.)
///
/// ```
/// use glam::{DVec3, Vec3};
/// use phong_bvh::offset_origin;
///
/// let (p, error) = (DVec3::new(3.0, 4.0, 5.0), Vec3::splat(1e-6));
/// let up = offset_origin(p, error, Vec3::Z, Vec3::new(0.6, 0.0, 0.8));
/// assert!(up.z > 5.000_001 && up.truncate() == p.truncate());
/// assert!(offset_origin(p, error, Vec3::Z, Vec3::NEG_Z).z < 4.999_999);
/// ```
#[inline]
pub fn offset_origin(p: DVec3, p_error: Vec3, ng: Vec3, dir: Vec3) -> DVec3 {
    let side = if dir.dot(ng) < 0.0 { -ng } else { ng };
    let offset = ng.abs().dot(p_error) * side;
    let away = |axis: usize| {
        let (offset, moved) = (offset[axis], p[axis] + f64::from(offset[axis]));
        let is_coarse = p_error[axis] < (p[axis] as f32).abs() * HALF;
        match moved as f32 {
            _ if is_coarse => moved,
            near if offset > 0.0 => near.next_up().into(),
            near if offset < 0.0 => near.next_down().into(),
            near => near.into(),
        }
    };
    DVec3::new(away(0), away(1), away(2))
}

/// What rounding to f32 costs at most, relative.
const HALF: f32 = f32::EPSILON / 2.0;

/// [`offset_origin`] for eight rays: the same bits.
#[inline(always)]
pub fn offset_origins<S: Simd>(
    simd: S,
    surface: &Surfaces8,
    dir: [f32x8<S>; 3],
    to: &mut [[f64; 8]; 3],
) {
    let ng = load3(simd, &surface.ng);
    let zero = f32x8::splat(simd, 0.0);
    let below = (dir[0] * ng[0] + dir[1] * ng[1] + dir[2] * ng[2]).simd_lt(zero);
    let side =
        [below.select(-ng[0], ng[0]), below.select(-ng[1], ng[1]), below.select(-ng[2], ng[2])];
    let [x, y, z] = offset_sides(simd, surface, side);
    *to = [whole(x[0], x[1]), whole(y[0], y[1]), whole(z[0], z[1])];
}

/// [`offset_origin`] for eight rays that leave on the side of `side`, which is the surface's `ng` or its
/// opposite: the same bits, in two halves.
#[inline(always)]
pub fn offset_sides<S: Simd>(
    simd: S,
    surface: &Surfaces8,
    side: [f32x8<S>; 3],
) -> [[f64x4<S>; 2]; 3] {
    let error = load3(simd, &surface.p_error);
    let keep = side[0].abs() * error[0] + side[1].abs() * error[1] + side[2].abs() * error[2];
    let offset = [keep * side[0], keep * side[1], keep * side[2]];
    let [x, y, z] = &surface.p;
    if surface.coarse {
        return [
            away_coarse(simd, x, error[0], offset[0]),
            away_coarse(simd, y, error[1], offset[1]),
            away_coarse(simd, z, error[2], offset[2]),
        ];
    }
    [away(simd, x, offset[0])[0], away(simd, y, offset[1])[0], away(simd, z, offset[2])[0]]
}

/// Moves eight coordinates, and rounds them away from `p`; and the same not rounded.
#[inline(always)]
fn away<S: Simd>(simd: S, p: &[f64; 8], offset: f32x8<S>) -> [[f64x4<S>; 2]; 2] {
    let zero = f32x8::splat(simd, 0.0);
    let [low, high] = halves(simd, p);
    let by = offset.widen();
    let moved = [low + by.0, high + by.1];
    let near: f32x8<S> = moved[0].narrow(moved[1]);
    let down = offset.simd_lt(zero);
    // The next number up; down is up in a mirror.
    let up = down.select(-near, near);
    let bits: u32x8<S> = up.bitcast();
    let next: f32x8<S> = up.simd_gt(zero).select(bits + 1, bits - 1).bitcast();
    let least = f32x8::splat(simd, f32::from_bits(1));
    let next = up.simd_eq(zero).select(least, next);
    let next = down.select(-next, next);
    let near = (down | offset.simd_gt(zero)).select(next, near).widen();
    [[near.0, near.1], moved]
}

/// [`away`] where the `error` of some may be less than what rounding costs.
#[inline(always)]
fn away_coarse<S: Simd>(simd: S, p: &[f64; 8], error: f32x8<S>, offset: f32x8<S>) -> [f64x4<S>; 2] {
    let [near, moved] = away(simd, p, offset);
    let bits = is_coarse(simd, p, error);
    let (low, high): (mask64x4<S>, mask64x4<S>) =
        (SimdMask::from_bitmask(simd, bits & 15), SimdMask::from_bitmask(simd, bits >> 4));
    [low.select(moved[0], near[0]), high.select(moved[1], near[1])]
}

/// Of which of eight coordinates the error is less than what rounding them to f32 costs, a bit each.
#[inline(always)]
pub(super) fn is_coarse<S: Simd>(simd: S, p: &[f64; 8], error: f32x8<S>) -> u64 {
    let [low, high] = halves(simd, p);
    let point: f32x8<S> = low.narrow(high);
    error.simd_lt(point.abs() * HALF).to_bitmask()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_rays_leave_where_one_does() {
        let simd = fearless_simd::Fallback::new();
        let x = |i: usize, k: usize| ((i * 37 + k * 61) % 83) as f32 / 41.5 - 1.0;
        let unit = |i: usize, k: usize| {
            Vec3::new(x(i, k), x(i, k + 1), x(i, k + 2)).normalize_or(Vec3::NEG_Y)
        };
        for round in 0..60 {
            let mut surface = Surfaces8 { coarse: true, ..Surfaces8::default() };
            let (mut dirs, mut want) = ([[0.0; 8]; 3], [DVec3::ZERO; 8]);
            for lane in 0..8 {
                let i = 8 * round + lane;
                // Coordinates that are 0, far away or not of f32, and normals along an axis are the odd ones.
                let p = match lane {
                    0 => DVec3::new(0.0, -0.0, x(i, 2).into()),
                    1 => DVec3::new(1e9 + 0.1, f64::from(x(i, 1)) * 1e-3, -1e7),
                    _ => Vec3::new(x(i, 1), x(i, 2), 5.0).as_dvec3(),
                };
                let p_error = Vec3::new(1e-7 * x(i, 3).abs(), 0.0, 3e-7);
                let ng = if lane == 2 { Vec3::NEG_Y } else { unit(i, 4) };
                let dir = unit(i, 11);
                for axis in 0..3 {
                    surface.p[axis][lane] = p[axis];
                    surface.p_error[axis][lane] = p_error[axis];
                    surface.ng[axis][lane] = ng[axis];
                    dirs[axis][lane] = dir[axis];
                }
                want[lane] = offset_origin(p, p_error, ng, dir);
            }
            let dirs = dirs.map(|lanes| f32x8::load_array(simd, lanes));
            let mut found = [[0.0; 8]; 3];
            offset_origins(simd, &surface, dirs, &mut found);
            for (lane, want) in want.into_iter().enumerate() {
                let found = found.map(|all| all[lane].to_bits());
                assert_eq!(found, want.to_array().map(f64::to_bits), "lane {lane}");
            }
        }
    }
}
