//! Eight rays against each plane and, where the whole tree is a single leaf of spheres, as in many small
//! scenes, against each of its spheres.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*, u32x8};

use super::columns::{highest, lowest};
use crate::{
    Plane, Primitives, lanes,
    level::Kernel,
    local::{Hits8, Rays8},
    node8::Row,
    primitives::sphere::{BLOCK, Closest8},
};

/// The geometry that has no bounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Planes<'a> {
    pub(crate) geometry: &'a [Primitives],
    /// Which of the geometries are planes.
    pub(crate) which: &'a [usize],
    /// First primitive number of each geometry.
    pub(crate) first: &'a [u32],
}

impl<'a> Planes<'a> {
    #[inline(always)]
    fn each(self) -> impl Iterator<Item = (&'a Plane, u32)> {
        self.which.iter().filter_map(move |&index| match &self.geometry[index] {
            Primitives::Plane(plane) => Some((plane, self.first[index])),
            _ => None,
        })
    }
}

/// The closest hit of each ray outside the tree and in `block`; where there is none, its end and
/// the number of none.
pub(crate) struct ClosestOfFew<'a> {
    pub(crate) planes: Planes<'a>,
    pub(crate) block: Option<&'a [Row; BLOCK]>,
    pub(crate) rays: &'a [Rays8],
    pub(crate) hits: &'a mut [Hits8],
}

impl Kernel for ClosestOfFew<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { planes, block, rays, hits } = self;
        for (rays, hits) in rays.chunks(TOGETHER).zip(hits.chunks_mut(TOGETHER)) {
            let near = block.map(|block| (block, near(simd, rays, block)));
            for (rays, hits) in rays.iter().zip(hits) {
                let end = f32x8::load_array_ref(simd, &rays.t_max);
                let mut best = (end, u32x8::splat(simd, u32::MAX));
                let there = mask32x8::from_bitmask(simd, rays.there.into());
                for (plane, number) in planes.each() {
                    if let Some((met, t)) = plane.intersect8(simd, rays) {
                        offer(simd, &mut best, there & met, t, number);
                    }
                }
                if let Some((block, near)) = near
                    && near != 0
                {
                    let closest = Closest8::of_rays(simd, rays);
                    for lane in lanes(near) {
                        if let Some((met, t)) = closest.intersect_one(simd, block, lane) {
                            let number = block[BLOCK - 1].bits(lane);
                            offer(simd, &mut best, there & met, t, number);
                        }
                    }
                }
                let (t, prim) = best;
                let met = prim.simd_lt(u32x8::splat(simd, u32::MAX)).to_bitmask() as u32;
                *hits = Hits8 { t: t.into(), prim: prim.into(), met, ..Hits8::NONE };
            }
        }
    }
}

/// Takes hits that are nearer, or as near and of a lower number.
#[inline(always)]
fn offer<S: Simd>(
    simd: S,
    best: &mut (f32x8<S>, u32x8<S>),
    met: mask32x8<S>,
    t: f32x8<S>,
    number: u32,
) {
    let number = u32x8::splat(simd, number);
    let lower = t.simd_eq(best.0) & number.simd_lt(best.1);
    let better = met & (t.simd_lt(best.0) | lower);
    *best = (better.select(t, best.0), better.select(number, best.1));
}

/// Whether each ray hits anything outside the tree or in `block`, a bit each.
pub(crate) struct AnyOfFew<'a> {
    pub(crate) planes: Planes<'a>,
    pub(crate) block: Option<&'a [Row; BLOCK]>,
    pub(crate) rays: &'a [Rays8],
    pub(crate) blocked: &'a mut [u32],
}

impl Kernel for AnyOfFew<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { planes, block, rays, blocked } = self;
        for (rays, blocked) in rays.chunks(TOGETHER).zip(blocked.chunks_mut(TOGETHER)) {
            let near = block.map(|block| (block, near(simd, rays, block)));
            for (rays, blocked) in rays.iter().zip(blocked) {
                *blocked = 0;
                if rays.there == 0 {
                    continue;
                }
                for (plane, _) in planes.each() {
                    if let Some((met, _)) = plane.intersect8(simd, rays) {
                        *blocked |= met.to_bitmask() as u32;
                    }
                }
                if let Some((block, near)) = near
                    && near != 0
                {
                    let closest = Closest8::of_rays(simd, rays);
                    for lane in lanes(near) {
                        if let Some((met, _)) = closest.intersect_one(simd, block, lane) {
                            *blocked |= met.to_bitmask() as u32;
                        }
                    }
                }
                *blocked &= rays.there;
            }
        }
    }
}

/// So many eights are tested together first for whether any of them can hit a sphere.
const TOGETHER: usize = 16;

/// The spheres of a block that any of the rays may hit, one bit each.
///
/// How far a sphere's middle is off the line of a ray is the length of `c × d`, `c` leading from the
/// ray's origin to the middle and `d` unit. From the bounds of all origins and directions follow
/// bounds of each coordinate of that, and so a distance that no ray comes nearer than.
#[inline(always)]
fn near<S: Simd>(simd: S, rays: &[Rays8], block: &[Row; BLOCK]) -> u32 {
    let used = block[BLOCK - 1].0.iter().filter(|n| n.to_bits() != u32::MAX).count();
    let used = (1 << used) - 1;
    let Some([ox, oy, oz, dx, dy, dz]) = bounds(simd, rays) else { return 0 };
    let center = |axis: usize, [low, high]: [f32; 2]| {
        let c = f32x8::load_array_ref(simd, &block[axis].0);
        [c - high, c - low]
    };
    let (x, y, z) = (center(0, ox), center(1, oy), center(2, oz));
    let (yz, zy) = (product(y, dz), product(z, dy));
    let (zx, xz) = (product(z, dx), product(x, dz));
    let (xy, yx) = (product(x, dy), product(y, dx));
    let (across_x, across_y, across_z) = (apart(yz, zy), apart(zx, xz), apart(xy, yx));
    let off = across_x * across_x + across_y * across_y + across_z * across_z;
    // What rounding can do here and in the kernel is far less than that.
    let far = x[0].abs().max(x[1].abs()) + y[0].abs().max(y[1].abs()) + z[0].abs().max(z[1].abs());
    let reach = f32x8::load_array_ref(simd, &block[3].0) * 1.001 + far * 1e-5;
    used & !(off.simd_gt(reach * reach).to_bitmask() as u32)
}

/// The bounds of origins and directions; `None` without rays.
#[inline(always)]
fn bounds<S: Simd>(simd: S, rays: &[Rays8]) -> Option<[[f32; 2]; 6]> {
    let most = f32x8::splat(simd, f32::INFINITY);
    let (mut low, mut high) = ([most; 6], [-most; 6]);
    let mut any = 0;
    for Rays8 { origin: [ox, oy, oz], dir: [dx, dy, dz], there, .. } in rays {
        any |= there;
        let there = mask32x8::from_bitmask(simd, (*there).into());
        for (i, column) in [ox, oy, oz, dx, dy, dz].into_iter().enumerate() {
            let column = f32x8::load_array_ref(simd, column);
            // In this order a NaN, which no ray should hold, changes nothing.
            low[i] = there.select(column, most).min(low[i]);
            high[i] = there.select(column, -most).max(high[i]);
        }
    }
    let bounds = [
        [lowest(low[0]), highest(high[0])],
        [lowest(low[1]), highest(high[1])],
        [lowest(low[2]), highest(high[2])],
        [lowest(low[3]), highest(high[3])],
        [lowest(low[4]), highest(high[4])],
        [lowest(low[5]), highest(high[5])],
    ];
    (any != 0).then_some(bounds)
}

/// The bounds of a product.
#[inline(always)]
fn product<S: Simd>([a, b]: [f32x8<S>; 2], [low, high]: [f32; 2]) -> [f32x8<S>; 2] {
    let (al, ah, bl, bh) = (a * low, a * high, b * low, b * high);
    [al.min(ah).min(bl.min(bh)), al.max(ah).max(bl.max(bh))]
}

/// The least distance between two numbers.
#[inline(always)]
fn apart<S: Simd>(a: [f32x8<S>; 2], b: [f32x8<S>; 2]) -> f32x8<S> {
    let zero = f32x8::splat(a[0].token(), 0.0);
    (a[0] - b[1]).max(b[0] - a[1]).max(zero)
}
