//! Shading normals of triangles, and the curved surface that they stand for: of one hit, or of eight.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};
use glam::{Mat3, Vec3};
use phong_bvh::Lanes;
use phong_scene::NO_INDEX;

use crate::math::lanes::{Lanes3, add, dot, load3, neg, normalize, scale, select3, sub};

/// What turns vectors of a mesh with normals into those of the world.
#[derive(Debug)]
pub(super) struct ToWorld {
    /// Normals, up to their length.
    pub(super) normals: Mat3,
    /// Edges.
    pub(super) edges: Mat3,
}

/// The smooth normals of a mesh.
#[derive(Clone, Copy)]
pub(crate) struct SmoothMesh<'a> {
    pub(super) normals: &'a [Vec3],
    /// Of each triangle; empty: those of the positions.
    pub(super) normal_indices: &'a [[u32; 3]],
    /// From the mesh to the world; `None`: they are the same.
    pub(super) to_world: Option<&'a ToWorld>,
}

/// Smooth surfaces that eight rays met.
pub(crate) struct Smooth8<S: Simd> {
    /// Which of them have a shading normal, a bit each. The numbers of the others are unspecified.
    pub(crate) there: u32,
    /// The shading normals, not yet turned to any side.
    pub(crate) n: [f32x8<S>; 3],
    /// The normals at the corners, in the mesh's own space, unit.
    at_corners: [[f32x8<S>; 3]; 3],
}

impl SmoothMesh<'_> {
    /// The shading normals at hits on `triangles`, whose corners these are; of weights `u` and `v`.
    #[inline(always)]
    pub(crate) fn normals<S: Simd>(
        &self,
        simd: S,
        triangles: &[u32; 8],
        corners: &[[u32; 3]; 8],
        weights: [f32x8<S>; 2],
    ) -> Smooth8<S> {
        let mut corners = *corners;
        let mut there = 0;
        for (lane, (corners, triangle)) in corners.iter_mut().zip(triangles).enumerate() {
            if let Some(own) = self.normal_indices.get(*triangle as usize) {
                *corners = *own;
            }
            if corners.contains(&NO_INDEX) {
                *corners = [0; 3];
            } else {
                there |= 1 << lane;
            }
        }
        let [a, b, c] = gather(self.normals, &corners);
        let at_corners = [units(load3(simd, &a)), units(load3(simd, &b)), units(load3(simd, &c))];
        let n = normal(at_corners, weights, self.to_world);
        let none: f32x8<S> = SimdBase::splat(simd, 0.0);
        let is_none = n[0].simd_eq(none) & n[1].simd_eq(none) & n[2].simd_eq(none);
        there &= !(is_none.to_bitmask() as u32);
        Smooth8 { there, n, at_corners }
    }

    /// The shading normal of a single hit, given the normals at the corners; `None` where it has no
    /// direction.
    pub(super) fn normal(&self, normals: [Vec3; 3], [u, v]: [f32; 2]) -> Option<[f32; 3]> {
        let at_corners = normals.map(|n| units(n.to_array()));
        let n = normal(at_corners, [u, v], self.to_world);
        (n != [0.0; 3]).then_some(n)
    }

    /// The way from points of triangles to the curved surface that the normals stand for, in the world:
    /// each corner's tangent plane lifts what lies below it onto itself, and the point takes the mean by
    /// its weights. 0 where the mesh is not convex. (Hanika, *Hacking the shadow terminator*, Ray Tracing
    /// Gems II, 2021.)
    ///
    /// `front` are the geometric normals on the side that is lit, and the normals are those of the other
    /// side where they are `flipped`; a corner whose normal disagrees lifts nothing.
    #[inline(always)]
    pub(crate) fn lifts<S: Simd>(
        &self,
        simd: S,
        smooth: &Smooth8<S>,
        (positions, corners): (&[Vec3], &[[u32; 3]; 8]),
        weights: [f32x8<S>; 2],
        (front, flipped): ([f32x8<S>; 3], mask32x8<S>),
    ) -> [f32x8<S>; 3] {
        let [a, b, c] = gather(positions, corners);
        let (a, b, c) = (load3(simd, &a), load3(simd, &b), load3(simd, &c));
        let (mut ab, mut ac, mut normals) = (sub(b, a), sub(c, a), smooth.at_corners);
        if let Some(ToWorld { normals: turn, edges }) = self.to_world {
            (ab, ac) = (times(edges, ab), times(edges, ac));
            let [a, b, c] = normals;
            normals = [units(times(turn, a)), units(times(turn, b)), units(times(turn, c))];
        }
        let [u, v] = weights;
        let zero: f32x8<S> = SimdBase::splat(simd, 0.0);
        let from_a = add(scale(u, ab), scale(v, ac));
        let from = [from_a, sub(from_a, ab), sub(from_a, ac)];
        let weights = [Lanes::splat(u, 1.0) - u - v, u, v];
        let mut lift = [zero; 3];
        for ((n, from), weight) in normals.into_iter().zip(from).zip(weights) {
            let n = select3(flipped, neg(n), n);
            let height = dot(from, n);
            let below = height.simd_lt(zero).select(height, zero);
            let agrees = dot(n, front).simd_gt(zero);
            lift = select3(agrees, sub(lift, scale(weight * below, n)), lift);
        }
        // Beyond the range of f32 there is nothing to lift.
        #[expect(clippy::eq_op, reason = "what is not finite is no 0 less itself")]
        let finite = (lift[0] - lift[0]).simd_eq(zero)
            & (lift[1] - lift[1]).simd_eq(zero)
            & (lift[2] - lift[2]).simd_eq(zero);
        select3(finite, lift, [zero; 3])
    }
}

/// The shading normal between the corners' unit normals, unit; 0 where it has no direction.
#[inline(always)]
fn normal<F: Lanes<Scalar = f32>>(
    [a, b, c]: [[F; 3]; 3],
    [u, v]: [F; 2],
    to_world: Option<&ToWorld>,
) -> [F; 3] {
    let n = add(add(scale(u.splat(1.0) - u - v, a), scale(u, b)), scale(v, c));
    normalize(match to_world {
        Some(to_world) => times(&to_world.normals, n),
        None => n,
    })
}

/// The unit vector along `n`, which stays as it is where it is one to 5e-6; 0 where it has no direction.
#[inline(always)]
fn units<F: Lanes<Scalar = f32>>(n: [F; 3]) -> [F; 3] {
    let off = dot(n, n) - 1.0;
    let is_unit = Lanes::abs(off).lt(off.splat(1e-5));
    if F::all(is_unit) { n } else { select3(is_unit, n, normalize(n)) }
}

#[inline(always)]
fn times<F: Lanes<Scalar = f32>>(m: &Mat3, [x, y, z]: [F; 3]) -> [F; 3] {
    [
        x * m.x_axis.x + y * m.y_axis.x + z * m.z_axis.x,
        x * m.x_axis.y + y * m.y_axis.y + z * m.z_axis.y,
        x * m.x_axis.z + y * m.y_axis.z + z * m.z_axis.z,
    ]
}

/// The values at each corner of eight triangles, number by number.
#[inline(always)]
pub(crate) fn gather(values: &[Vec3], corners: &[[u32; 3]; 8]) -> [Lanes3; 3] {
    let mut out = [[[0.0; 8]; 3]; 3];
    for (lane, corners) in corners.iter().enumerate() {
        for (out, &corner) in out.iter_mut().zip(corners) {
            let Vec3 { x, y, z } = values[corner as usize];
            (out[0][lane], out[1][lane], out[2][lane]) = (x, y, z);
        }
    }
    out
}
