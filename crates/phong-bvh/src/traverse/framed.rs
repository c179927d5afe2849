//! The rays of a group against the cylinders of a leaf.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};

use super::{
    World,
    columns::{Column, Columns, PACKETS, Packets, ZERO, own_or_first3},
    frustum::Frustum,
    leaves::Cylinders,
    query::Query,
    sheared::packets,
};
use crate::{
    local::{Loaded, Rays8},
    node8::{NODE, Ref, Row, rows},
    primitives::{
        capsule::{self, BLOCK, OneHits},
        ray_frame::{self, ACROSS, Across, RayFrame},
    },
};

/// Up to so many rays are tested one by one, each against eight cylinders at once.
const FEW: u32 = 4;

/// A leaf that some rays of a group enter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entered<'a> {
    pub(super) leaf: Ref,
    /// The rays, a bit each; at least one.
    pub(super) met: u64,
    /// All rays of the group.
    pub(super) frustum: &'a Frustum,
    /// The greatest distance at which any of them still looks for a hit.
    pub(super) farthest: f32,
}

/// What the cylinder test needs besides [`Columns`]: rays that go least along the same axis, and what is across them.
#[derive(Debug)]
pub(super) struct Framed {
    axes: [usize; 3],
    across: [Column; ACROSS],
    /// No ray starts farther from the origin, its coordinates added up.
    far: f32,
}

impl Framed {
    /// No rays.
    pub(super) const EMPTY: Self = Self { axes: [0, 1, 2], across: [ZERO; ACROSS], far: 0.0 };

    /// Takes the rays of a group. Returns false where they do not all go least along the same axis.
    pub(super) fn fill<S: Simd>(
        &mut self,
        simd: S,
        columns: &Columns,
        group: &Packets<'_>,
    ) -> bool {
        simd.vectorize(
            #[inline(always)]
            || self.fill_at(simd, columns, group),
        )
    }

    #[inline(always)]
    fn fill_at<S: Simd>(&mut self, simd: S, columns: &Columns, group: &Packets<'_>) -> bool {
        let (packet, lane) = group.first();
        let first = group.rays[packet].get(lane);
        self.axes = ray_frame::axes(first.dir.to_array());
        let far = columns.bounds.start;
        self.far = far.lo.abs().max(far.hi.abs()).element_sum();
        for (packet, rays) in group.rays.iter().enumerate().take(PACKETS) {
            let own = mask32x8::from_bitmask(simd, group.lanes[packet].into());
            let origin = own_or_first3(simd, own, &rays.origin, first.origin.to_array());
            let dir = own_or_first3(simd, own, &rays.dir, first.dir.to_array());
            // The question of `axes` for eight rays.
            let [x, y, z] = [dir[0].abs(), dir[1].abs(), dir[2].abs()];
            let is_y = y.simd_lt(x);
            let is_z = z.simd_lt(x.min(y));
            let agree = match self.axes[0] {
                0 => !is_y & !is_z,
                1 => is_y & !is_z,
                _ => is_z,
            };
            if !agree.all_true() {
                return false;
            }
            let numbers = Across::new(self.axes, origin, dir).numbers();
            for (column, numbers) in self.across.iter_mut().zip(numbers) {
                numbers.store_array(&mut column[packet]);
            }
        }
        true
    }

    /// The rays that enter a leaf against its cylinders.
    pub(super) fn leaf<S: Simd, E: Query>(
        &self,
        simd: S,
        world: &World<'_>,
        group: &Packets<'_>,
        entered: Entered<'_>,
        columns: &mut Columns,
        query: &mut E,
    ) {
        simd.vectorize(
            #[inline(always)]
            || self.leaf_at(simd, world, group, entered, columns, query),
        );
    }

    #[inline(always)]
    fn leaf_at<S: Simd, E: Query>(
        &self,
        simd: S,
        world: &World<'_>,
        group: &Packets<'_>,
        Entered { leaf, met, frustum, farthest }: Entered<'_>,
        columns: &mut Columns,
        query: &mut E,
    ) {
        let block: &[Row; BLOCK] = rows(world.rows, leaf.row());
        let count = met.count_ones();
        // For few rays, finding the cylinders that all of them miss costs more than it saves.
        let mut lanes = 0;
        if count > FEW {
            let mut node = [Row::ZERO; NODE];
            node[..6].copy_from_slice(&capsule::boxes(simd, block, self.far));
            lanes = frustum.meet(simd, &node, farthest).0;
        }
        // Rays that are tested one by one after all.
        let mut singly = 0;
        if count <= FEW || count < lanes.count_ones() * packets(met) {
            singly = met;
            lanes = 0;
        }
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize & 7;
            lanes &= lanes - 1;
            let prim = block[BLOCK - 1].bits(lane);
            if prim == u32::MAX {
                break;
            }
            let mut left = met;
            while left != 0 {
                let packet = left.trailing_zeros() as usize / 8;
                let among = (left >> (8 * packet)) as u32 & 0xff;
                left &= !(0xff << (8 * packet));
                let rays = self.eight(simd, &group.rays[packet], packet);
                let Some(hits) = OneHits::of(simd, &rays, block, lane, among) else { continue };
                singly |= u64::from(hits.tapered) << (8 * packet);
                if hits.hit != 0 {
                    let [t, half] = hits.at;
                    let at = [t, half, f32x8::splat(simd, 0.0)];
                    let eight = group.first_eight + packet;
                    query.hits(simd, eight, hits.hit, prim, at, &mut columns.t_max[packet]);
                }
            }
        }
        while singly != 0 {
            let i = singly.trailing_zeros() as usize;
            singly &= singly - 1;
            let (packet, lane) = (i / 8, i % 8);
            let rays = &group.rays[packet];
            let cylinders = Cylinders::of(simd, &self.one(rays, packet, lane));
            let at = (group.first_eight + packet, lane);
            columns.t_max[packet][lane] =
                query.leaf(simd, world, &cylinders, (&rays.get(lane), at), leaf);
        }
    }

    /// One ray.
    #[inline(always)]
    fn one(&self, rays: &Rays8, packet: usize, lane: usize) -> RayFrame<f32> {
        let (packet, lane) = (packet % 8, lane % 8);
        let mut numbers = [0.0; ACROSS];
        for (number, column) in numbers.iter_mut().zip(&self.across) {
            *number = column[packet][lane];
        }
        let [x, y, z] = &rays.origin;
        let origin = [x[lane], y[lane], z[lane]];
        Across::of(self.axes, numbers).frame(origin, rays.t_min[lane], rays.t_max[lane])
    }

    /// Eight rays.
    #[inline(always)]
    fn eight<S: Simd>(&self, simd: S, rays: &Rays8, packet: usize) -> RayFrame<f32x8<S>> {
        let packet = packet % 8;
        let mut numbers = [f32x8::splat(simd, 0.0); ACROSS];
        for (number, column) in numbers.iter_mut().zip(&self.across) {
            *number = f32x8::load_array_ref(simd, &column[packet]);
        }
        let Loaded { origin, t_min, t_max, .. } = rays.load(simd);
        Across::of(self.axes, numbers).frame(origin, t_min, t_max)
    }
}
