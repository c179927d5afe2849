//! Eight rays of the world against each plane and, where a whole tree is a single leaf of spheres, as in
//! many small scenes, against each of its spheres.
//!
//! Rays are taken to the space of the tree as they are loaded, which saves the room and the time that a
//! second bundle takes.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*, u32x8};

use crate::{
    Hits8, Plane, Rays8,
    frame::Frame,
    lanes,
    level::Kernel,
    local::{Loaded, load3},
    node8::Row,
    primitives::sphere::{BLOCK, Closest8},
    traverse::{highest, lowest},
};

/// What there is a handful of: planes, each with its part, and perhaps spheres.
#[derive(Clone, Copy)]
pub(super) struct Few<'a> {
    /// Where all of it stands: about a point, with the world's axes.
    pub(super) frame: &'a Frame,
    pub(super) planes: &'a [(Plane, u32)],
    pub(super) spheres: Option<Spheres<'a>>,
}

/// A tree that is a single leaf of spheres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spheres<'a> {
    pub(super) block: &'a [Row; BLOCK],
    /// Part and number of each sphere.
    pub(super) names: [[u32; 2]; 8],
}

impl Few<'_> {
    /// The spheres that any of the rays may hit, one bit each. Sets `all` to false, and says none from then
    /// on, if some rays may be too far away to be taken to them as they are. `starts` are set to where the
    /// rays start about the frame's origin.
    #[inline(always)]
    fn near<S: Simd>(&self, simd: S, rays: &[Rays8], starts: &mut [Start8], all: &mut bool) -> u32 {
        if self.planes.is_empty() && self.spheres.is_none() {
            return 0;
        }
        for (rays, starts) in rays.iter().zip(&mut *starts).filter(|(rays, _)| rays.there != 0) {
            let [x, y, z] = self.frame.load_origins(simd, rays);
            starts.0 = [x.into(), y.into(), z.into()];
        }
        let Some(Spheres { block, .. }) = self.spheres else { return 0 };
        if !*all {
            return 0;
        }
        let near = near(simd, self.frame, rays, starts, block);
        *all = near.is_some();
        near.unwrap_or(0)
    }
}

/// The closest hits of rays. Returns false, with the planes done and the spheres not, if some rays may start
/// too far from the spheres to be taken to them as they are.
pub(super) struct Closest<'a> {
    pub(super) few: Few<'a>,
    /// Whether these are the first things asked, so that nothing has been hit and `hits` are unspecified.
    pub(super) first: bool,
    pub(super) rays: &'a [Rays8],
    pub(super) hits: &'a mut [Hits8],
}

impl Kernel for Closest<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> bool {
        let Self { few: few @ Few { planes, spheres, .. }, first, rays, hits } = self;
        let (mut all, mut starts) = (true, NO_STARTS);
        for (rays, hits) in rays.chunks(TOGETHER).zip(hits.chunks_mut(TOGETHER)) {
            let near = few.near(simd, rays, &mut starts, &mut all);
            if near == 0 && planes.is_empty() {
                if first {
                    hits.fill(Hits8::NONE);
                }
                continue;
            }
            for (i, (rays, hits)) in rays.iter().zip(hits).enumerate() {
                if first {
                    hits.met = 0;
                }
                let there = mask32x8::from_bitmask(simd, rays.there.into());
                let rays = &loaded(simd, &starts[i], rays);
                let mut best = Best::load(simd, hits, rays.t_max);
                for (plane, part) in planes {
                    if let Some((met, t)) = plane.intersect8(simd, rays) {
                        best.offer(simd, there & met, t, [*part, 0]);
                    }
                }
                if let Some(Spheres { block, names }) = spheres
                    && near != 0
                {
                    let closest = Closest8::of_rays(simd, rays);
                    for lane in lanes(near) {
                        if let Some((met, t)) = closest.intersect_one(simd, block, lane) {
                            best.offer(simd, there & met, t, names[lane]);
                        }
                    }
                }
                best.store(simd, first, hits);
            }
        }
        all
    }
}

/// The best hits of eight rays so far; where there is none, the distance is the ray's end.
struct Best<S: Simd> {
    t: f32x8<S>,
    part: u32x8<S>,
    prim: u32x8<S>,
    /// Those that were found here.
    new: mask32x8<S>,
}

impl<S: Simd> Best<S> {
    #[inline(always)]
    fn load(simd: S, hits: &Hits8, t_max: f32x8<S>) -> Self {
        let new = mask32x8::splat(simd, false);
        if hits.met == 0 {
            let none = u32x8::splat(simd, u32::MAX);
            return Self { t: t_max, part: none, prim: none, new };
        }
        let met = mask32x8::from_bitmask(simd, hits.met.into());
        Self {
            t: met.select(f32x8::load_array_ref(simd, &hits.t), t_max),
            part: u32x8::load_array_ref(simd, &hits.part),
            prim: u32x8::load_array_ref(simd, &hits.prim),
            new,
        }
    }

    /// Takes hits that are nearer, or as near and of a lower part, or primitive of the same.
    #[inline(always)]
    fn offer(&mut self, simd: S, met: mask32x8<S>, t: f32x8<S>, [part, prim]: [u32; 2]) {
        let (part, prim) = (u32x8::splat(simd, part), u32x8::splat(simd, prim));
        let lower = part.simd_lt(self.part) | (part.simd_eq(self.part) & prim.simd_lt(self.prim));
        let better = met & (t.simd_lt(self.t) | (t.simd_eq(self.t) & lower));
        self.t = better.select(t, self.t);
        self.part = better.select(part, self.part);
        self.prim = better.select(prim, self.prim);
        self.new |= better;
    }

    /// Puts those found here in their place. They have no barycentric weights.
    #[inline(always)]
    fn store(self, simd: S, first: bool, hits: &mut Hits8) {
        let new = self.new.to_bitmask() as u32;
        if first {
            let none = f32x8::splat(simd, f32::INFINITY);
            self.new.select(self.t, none).store_array(&mut hits.t);
            self.part.store_array(&mut hits.part);
            self.prim.store_array(&mut hits.prim);
            (hits.u, hits.v, hits.met) = ([0.0; 8], [0.0; 8], new);
            return;
        }
        if new == 0 {
            return;
        }
        if hits.met & !new == 0 {
            (hits.u, hits.v) = ([0.0; 8], [0.0; 8]);
        } else {
            for lane in lanes(new) {
                (hits.u[lane], hits.v[lane]) = (0.0, 0.0);
            }
        }
        // Elsewhere `t` is how far the ray reaches.
        let old = f32x8::load_array_ref(simd, &hits.t);
        self.new.select(self.t, old).store_array(&mut hits.t);
        self.part.store_array(&mut hits.part);
        self.prim.store_array(&mut hits.prim);
        hits.met |= new;
    }
}

/// Whether each ray hits anything, a bit each; of those already `blocked` nothing is asked. Returns as
/// [`Closest`] does.
pub(super) struct Any<'a> {
    pub(super) few: Few<'a>,
    pub(super) rays: &'a [Rays8],
    pub(super) blocked: &'a mut [u32],
}

impl Kernel for Any<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> bool {
        let Self { few: few @ Few { planes, spheres, .. }, rays, blocked } = self;
        let (mut all, mut starts) = (true, NO_STARTS);
        for (rays, blocked) in rays.chunks(TOGETHER).zip(blocked.chunks_mut(TOGETHER)) {
            let near = few.near(simd, rays, &mut starts, &mut all);
            if near == 0 && planes.is_empty() {
                continue;
            }
            for (i, (rays, blocked)) in rays.iter().zip(blocked).enumerate() {
                let there = rays.there;
                if there & !*blocked == 0 {
                    continue;
                }
                let rays = &loaded(simd, &starts[i], rays);
                for (plane, _) in planes {
                    if let Some((met, _)) = plane.intersect8(simd, rays) {
                        *blocked |= met.to_bitmask() as u32;
                    }
                }
                if let Some(Spheres { block, .. }) = spheres
                    && near != 0
                {
                    let closest = Closest8::of_rays(simd, rays);
                    for lane in lanes(near) {
                        if let Some((met, _)) = closest.intersect_one(simd, block, lane) {
                            *blocked |= met.to_bitmask() as u32;
                        }
                    }
                }
                *blocked &= there;
            }
        }
        all
    }
}

/// So many eights are tested together first for whether any of them can hit a sphere.
const TOGETHER: usize = 16;

/// Where eight rays start, about the frame's origin.
///
/// It asks for the alignment of a vector: so the compiler aligns all that a kernel keeps on the stack, and no vector
/// that it puts there lies across two lines of the cache or two pages.
#[derive(Clone, Copy)]
#[repr(align(32))]
struct Start8([[f32; 8]; 3]);

/// Room for where the rays start.
const NO_STARTS: [Start8; TOGETHER] = [Start8([[0.0; 8]; 3]); TOGETHER];

/// Eight rays that start there.
#[inline(always)]
fn loaded<S: Simd>(simd: S, start: &Start8, rays: &Rays8) -> Loaded<S> {
    Loaded {
        origin: load3(simd, &start.0),
        dir: load3(simd, &rays.dir),
        t_min: f32x8::load_array_ref(simd, &rays.t_min),
        t_max: f32x8::load_array_ref(simd, &rays.t_max),
    }
}

/// The spheres of a block that any of the rays may hit, one bit each; `None` if some rays may be too far
/// away to enter the block as they are.
///
/// How far a sphere's middle is off the line of a ray is the length of `c × d`, `c` leading from the
/// ray's origin to the middle and `d` unit. From the bounds of all origins and directions follow
/// bounds of each coordinate of that, and so a distance that no ray comes nearer than.
#[inline(always)]
fn near<S: Simd>(
    simd: S,
    frame: &Frame,
    rays: &[Rays8],
    starts: &[Start8],
    block: &[Row; BLOCK],
) -> Option<u32> {
    let used = block[BLOCK - 1].0.iter().filter(|n| n.to_bits() != u32::MAX).count();
    let used = (1 << used) - 1;
    let Some([ox, oy, oz, dx, dy, dz]) = bounds(simd, rays, starts) else { return Some(0) };
    if !frame.is_near([ox, oy, oz]) {
        return None;
    }
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
    Some(used & !(off.simd_gt(reach * reach).to_bitmask() as u32))
}

/// The bounds of origins and directions; `None` without rays.
#[inline(always)]
fn bounds<S: Simd>(simd: S, rays: &[Rays8], starts: &[Start8]) -> Option<[[f32; 2]; 6]> {
    let most = f32x8::splat(simd, f32::INFINITY);
    let (mut low, mut high) = ([most; 6], [-most; 6]);
    let mut any = 0;
    for (rays, starts) in rays.iter().zip(starts) {
        if rays.there == 0 {
            continue;
        }
        any |= rays.there;
        let ([ox, oy, oz], [dx, dy, dz]) = (load3(simd, &starts.0), load3(simd, &rays.dir));
        let columns = [ox, oy, oz, dx, dy, dz];
        // In this order a NaN, which no ray should hold, changes nothing.
        if rays.there == 0xff {
            for (i, column) in columns.into_iter().enumerate() {
                (low[i], high[i]) = (column.min(low[i]), column.max(high[i]));
            }
            continue;
        }
        let there = mask32x8::from_bitmask(simd, rays.there.into());
        for (i, column) in columns.into_iter().enumerate() {
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
