//! Where shadow rays start, and where they end.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};
use phong_bvh::{Rays8, Surfaces8, lanes, offset_origins};

use crate::light::Reach;
use crate::math::lanes::{add, dot, load3, normalize, scale, select3, splat3, store3};
use crate::view::{Fixture, Shading8};

/// The share of its way by which a ray ends short of a light: a few roundings of its direction and of the
/// distance of what it meets.
const SHORT: f32 = 8.0 * f32::EPSILON;

/// Aims rays from eight surfaces at a light. `front` are the geometric normals on the side that is lit.
///
/// A ray starts beyond the error of its point, on a smooth mesh above the face, and ends short of the light
/// by the error of the point, of the light's position and of what it may meet there. At a light that
/// lies in a surface it is aimed at a point a hair off that, on its own side, so that no rounding takes
/// it across however it grazes.
#[inline(always)]
pub(super) fn aim<S: Simd>(
    simd: S,
    (surface, shading): (&Surfaces8, &Shading8),
    front: [f32x8<S>; 3],
    reach: &Reach<[f32x8<S>; 3], f32x8<S>>,
    fixture: &Fixture,
    to: &mut Rays8,
) {
    let &Reach { l, distance, .. } = reach;
    let zero = f32x8::splat(simd, 0.0);
    let smooth = mask32x8::from_bitmask(simd, shading.smooth.into());
    // A distant light is in the same direction from everywhere.
    let mut aimed = distance.simd_lt(f32x8::splat(simd, f32::INFINITY));
    if fixture.surfaces.is_empty() {
        aimed &= smooth;
    }
    let (mut dir, mut length) = (l, distance);
    if aimed.any_true() {
        let mut toward = scale(distance, l);
        for mounting in &fixture.surfaces {
            let normal = splat3(zero, mounting.normal.to_array());
            let keep = distance * SHORT + mounting.keep;
            let keep = dot(l, normal).simd_gt(zero).select(-keep, keep);
            toward = add(toward, scale(keep, normal));
        }
        let lift = load3(simd, &shading.lift);
        let lifted = [toward[0] - lift[0], toward[1] - lift[1], toward[2] - lift[2]];
        toward = select3(smooth, lifted, toward);
        let way = normalize(toward);
        dir = select3(aimed, way, l);
        length = aimed.select(dot(toward, way), distance);
    }
    let [x, y, z] = load3(simd, &surface.p_error);
    let end = length * (1.0 - SHORT) - (x + y + z + fixture.error);
    to.dir = store3(dir);
    to.t_max = end.simd_gt(zero).select(end, zero).into();
    // Of a smooth surface what looks below the face has to meet it.
    let side = if shading.smooth == 0 { l } else { select3(smooth, front, l) };
    offset_origins(simd, surface, side, &mut to.origin);
    for lane in lanes(shading.smooth) {
        for axis in 0..3 {
            to.origin[axis][lane] += f64::from(shading.lift[axis][lane]);
        }
    }
}
