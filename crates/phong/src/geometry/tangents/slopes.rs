//! The directions in which texture coordinates grow: on triangles, and about their corners.

use fearless_simd::{Simd, f32x8, prelude::*};
use phong_bvh::{Kernel, Lanes};

use super::Corners;
use super::groups::Hand;
use crate::math::acos;
use crate::math::lanes::{Lanes3, dot, get, load3, scale, select3, set, store3, sub};

/// The directions in which u and v grow on eight triangles; 0 where there is none.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub(super) struct Slopes8 {
    s: Lanes3,
    t: Lanes3,
}

/// Those of triangle after triangle, and their hands.
pub(super) struct Slopes<'a> {
    pub(super) mesh: &'a Corners<'a>,
    pub(super) faces: &'a [u32],
    pub(super) hands: &'a mut Vec<Hand>,
}

impl Kernel for Slopes<'_> {
    type Output = Vec<Slopes8>;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Self::Output {
        let Self { mesh, faces, hands } = self;
        let mut all = Vec::with_capacity(faces.len().div_ceil(8));
        for faces in faces.chunks(8) {
            let mut positions = [[[0.0; 8]; 3]; 3];
            let mut uvs = [[[0.0; 8]; 2]; 3];
            for (lane, &face) in faces.iter().enumerate() {
                for (to, from) in positions.iter_mut().zip(mesh.positions_of(face as usize)) {
                    set(to, lane, from);
                }
                for (to, from) in uvs.iter_mut().zip(mesh.uvs_of(face as usize)) {
                    (to[0][lane], to[1][lane]) = (from.x, from.y);
                }
            }
            let [a, b, c] = &positions;
            let positions = [load3(simd, a), load3(simd, b), load3(simd, c)];
            let [a, b, c] = &uvs;
            let uvs = [load2(simd, a), load2(simd, b), load2(simd, c)];
            let ([s, t], is_any, is_right) = of_triangle(positions, uvs);
            all.push(Slopes8 { s: store3(s), t: store3(t) });
            let (is_any, is_right) = (is_any.to_bitmask() as u32, is_right.to_bitmask() as u32);
            let hand = |lane: usize| Hand {
                is_any: is_any >> lane & 1 != 0,
                is_right: is_right >> lane & 1 != 0,
            };
            hands.extend((0..faces.len()).map(hand));
        }
        all
    }
}

#[inline(always)]
fn load2<S: Simd>(simd: S, [u, v]: &[[f32; 8]; 2]) -> [f32x8<S>; 2] {
    [f32x8::load_array_ref(simd, u), f32x8::load_array_ref(simd, v)]
}

/// The directions in which u and v grow on a triangle, whether they are of no use, and whether they are right-handed.
#[inline(always)]
fn of_triangle<F: Lanes<Scalar = f32>>(
    [a, b, c]: [[F; 3]; 3],
    uvs: [[F; 2]; 3],
) -> ([[F; 3]; 2], F::Mask, F::Mask) {
    let (ab, ac) = (sub(b, a), sub(c, a));
    let [own, [u, v], [s, t]] = uvs;
    let (b, c) = ([u - own[0], v - own[1]], [s - own[0], t - own[1]]);
    let area = b[0] * c[1] - b[1] * c[0];
    let zero = area.splat(0.0);
    let is_right = area.gt(zero);
    let sign = F::select(is_right, area.splat(1.0), area.splat(-1.0));
    let area = area.abs();
    let s = sub(scale(c[1], ab), scale(b[1], ac));
    let minus = -c[0];
    let (along, across) = (scale(minus, ab), scale(b[0], ac));
    let t = [along[0] + across[0], along[1] + across[1], along[2] + across[2]];
    let has_area = is_some(area);
    let of_use = has_area & is_some(dot(s, s).sqrt() / area) & is_some(dot(t, t).sqrt() / area);
    let s = select3(has_area, scale(sign, unit(s)), [zero; 3]);
    let t = select3(has_area, scale(sign, unit(t)), [zero; 3]);
    ([s, t], !of_use, is_right)
}

/// What a triangle adds about a corner where the normal is `n`: the directions in which u and v grow across it, and
/// the angle there. `p` are the corner itself, the next one, and the one before.
#[inline(always)]
pub(super) fn about<F: Lanes<Scalar = f32>>(
    n: [F; 3],
    [p, next, before]: [[F; 3]; 3],
    [s, t]: [[F; 3]; 2],
) -> ([[F; 3]; 2], F) {
    let cos = dot(across(n, sub(next, p)), across(n, sub(before, p)));
    ([across(n, s), across(n, t)], cos.map(acos))
}

/// The unit vector along what of `v` is at right angles to `n`.
#[inline(always)]
fn across<F: Lanes<Scalar = f32>>(n: [F; 3], v: [F; 3]) -> [F; 3] {
    unit(sub(v, scale(dot(n, v), n)))
}

/// The unit vector along `v`, or what is shorter than any of them as it is.
#[inline(always)]
pub(super) fn unit<F: Lanes<Scalar = f32>>(v: [F; 3]) -> [F; 3] {
    let has_length = is_some(v[0]) | is_some(v[1]) | is_some(v[2]);
    let one = v[0].splat(1.0);
    select3(has_length, scale(one / dot(v, v).sqrt(), v), v)
}

#[inline(always)]
fn is_some<F: Lanes<Scalar = f32>>(x: F) -> F::Mask {
    x.abs().gt(x.splat(f32::MIN_POSITIVE))
}

impl Slopes8 {
    pub(super) fn of(all: &[Self], face: usize) -> [[f32; 3]; 2] {
        let Self { s, t } = &all[face / 8];
        [get(s, face % 8), get(t, face % 8)]
    }

    #[inline(always)]
    pub(super) fn load<S: Simd>(&self, simd: S) -> [[f32x8<S>; 3]; 2] {
        [load3(simd, &self.s), load3(simd, &self.t)]
    }
}
