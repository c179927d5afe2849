//! Where shadow rays start, and where they end.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};
use phong_bvh::{Kernel, Rays8, Surfaces8, offset_sides, whole};

use super::interactions::Interactions;
use crate::light::Reach;
use crate::math::lanes::{add, dot, load3, normalize, scale, select3, splat3, store3};
use crate::view::{Fixture, Shading8};

/// The share of its way by which a ray ends short of a light: a few roundings of its direction and of the
/// distance of what it meets.
const SHORT: f32 = 8.0 * f32::EPSILON;

/// Puts shadow rays to where they start, whatever light they are aimed at: beyond the error of their point on
/// the side that is lit, and on a smooth mesh above the face.
pub(super) struct Starts<'a> {
    pub(super) interactions: &'a Interactions,
    pub(super) to: &'a mut [Rays8],
}

impl Kernel for Starts<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { interactions: Interactions { hits, surfaces, shading, .. }, to } = self;
        let len = to.len();
        let (hits, surfaces, shading) = (&hits[..len], &surfaces[..len], &shading[..len]);
        for (i, to) in to.iter_mut().enumerate() {
            if hits[i].met == 0 {
                continue;
            }
            let shading = &shading[i];
            let mut starts = offset_sides(simd, &surfaces[i], load3(simd, &shading.front));
            if shading.smooth != 0 {
                let smooth = mask32x8::from_bitmask(simd, shading.smooth.into());
                // Adding −0 changes nothing.
                let none = f32x8::splat(simd, -0.0);
                for (start, lift) in starts.iter_mut().zip(&shading.lift) {
                    let by = smooth.select(f32x8::load_array_ref(simd, lift), none).widen();
                    *start = [start[0] + by.0, start[1] + by.1];
                }
            }
            let [x, y, z] = starts;
            to.origin = [whole(x[0], x[1]), whole(y[0], y[1]), whole(z[0], z[1])];
        }
    }
}

/// Aims rays from eight surfaces at a light, from where they [start](Starts).
///
/// A ray ends short of the light by the error of the point, of the light's position and of what it may meet there. At a light that
/// lies in a surface it is aimed at a point a hair off that, on its own side, so that no rounding takes
/// it across however it grazes.
#[inline(always)]
pub(super) fn aim<S: Simd>(
    simd: S,
    (surface, shading): (&Surfaces8, &Shading8),
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
}
