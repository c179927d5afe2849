//! The rays of a group against the triangles of a leaf.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};

use super::{
    World,
    columns::{Column, Columns, PACKETS, Packets, ZERO, least, own_or_first},
    leaves::Triangles,
    query::Query,
};
use crate::{
    local::Rays8,
    node8::{Ref, Row, rows},
    primitives::triangle::{BLOCK, Shear, ShearBounds, Shears},
};

/// Up to so many rays are tested one by one, each against eight triangles at once.
const FEW: u32 = 8;

/// What the triangle test needs besides [`Columns`]: slopes of directions that are longest along the same
/// axis.
#[derive(Debug)]
pub(super) struct Sheared {
    slope: [Column; 2],
    all: ShearBounds,
}

impl Sheared {
    /// No rays.
    pub(super) const EMPTY: Self = Self {
        slope: [ZERO; 2],
        all: ShearBounds { axes: [0; 3], origin: [[0.0; 2]; 3], slope: [[0.0; 2]; 2] },
    };

    /// Takes the rays of a group. Returns false where their directions are not longest along the same axis.
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
        let first = &group.rays[packet];
        let axes = Shear::new(&first.get(lane)).axes;
        let [x, y, z] = axes;
        let zero = f32x8::splat(simd, 0.0);
        let most = f32x8::splat(simd, f32::INFINITY);
        // As in `Columns`: minima, and maxima with their signs changed.
        let mut slopes = [most, most, most, most, zero, zero, zero, zero];
        for (packet, rays) in group.rays.iter().enumerate().take(PACKETS) {
            let own = mask32x8::from_bitmask(simd, group.lanes[packet].into());
            let dx = own_or_first(simd, own, &rays.dir[x], first.dir[x][lane]);
            let dy = own_or_first(simd, own, &rays.dir[y], first.dir[y][lane]);
            let dz = own_or_first(simd, own, &rays.dir[z], first.dir[z][lane]);
            // In the order of the axes, not of this ray's: ties go to the first.
            let ax = own_or_first(simd, own, &rays.dir[0], first.dir[0][lane]).abs();
            let ay = own_or_first(simd, own, &rays.dir[1], first.dir[1][lane]).abs();
            let az = own_or_first(simd, own, &rays.dir[2], first.dir[2][lane]).abs();
            let is_x = ax.simd_ge(ay) & ax.simd_ge(az);
            let is_y = !is_x & ay.simd_ge(az);
            let agree = match z {
                0 => is_x,
                1 => is_y,
                _ => !(is_x | is_y),
            };
            if !agree.all_true() {
                return false;
            }
            let (sx, sy) = (dx / dz, dy / dz);
            sx.store_array(&mut self.slope[0][packet]);
            sy.store_array(&mut self.slope[1][packet]);
            slopes[0] = slopes[0].min(sx);
            slopes[1] = slopes[1].min(-sx);
            slopes[2] = slopes[2].min(sy);
            slopes[3] = slopes[3].min(-sy);
        }
        let [x_low, x_high, y_low, y_high, ..] = least(slopes);
        let start = columns.bounds.start;
        self.all = ShearBounds {
            axes,
            origin: axes.map(|axis| [start.lo[axis], start.hi[axis]]),
            slope: [[x_low, -x_high], [y_low, -y_high]],
        };
        true
    }

    /// The rays `met` against the triangles of a leaf.
    pub(super) fn leaf<S: Simd, E: Query>(
        &self,
        simd: S,
        world: &World<'_>,
        group: &Packets<'_>,
        met: (Ref, u64),
        columns: &mut Columns,
        query: &mut E,
    ) {
        simd.vectorize(
            #[inline(always)]
            || self.leaf_at(simd, world, group, met, columns, query),
        );
    }

    #[inline(always)]
    fn leaf_at<S: Simd, E: Query>(
        &self,
        simd: S,
        world: &World<'_>,
        group: &Packets<'_>,
        (leaf, mut met): (Ref, u64),
        columns: &mut Columns,
        query: &mut E,
    ) {
        let block: &[Row; BLOCK] = rows(world.rows, leaf.row());
        // For few rays, finding the triangles that all of them miss costs more than it saves.
        let count = met.count_ones();
        let few = count <= FEW;
        let mut lanes = if few { u32::MAX } else { self.all.filter(simd, block) };
        if few || count < lanes.count_ones() * packets(met) {
            while met != 0 {
                let i = met.trailing_zeros() as usize;
                met &= met - 1;
                let (packet, lane) = (i / 8, i % 8);
                let rays = &group.rays[packet];
                let triangles = Triangles::of(simd, self.one(rays, packet, lane));
                let at = (group.first_eight + packet, lane);
                columns.t_max[packet][lane] =
                    query.leaf(simd, world, &triangles, (&rays.get(lane), at), leaf);
            }
            return;
        }
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize & 7;
            lanes &= lanes - 1;
            let prim = block[BLOCK - 1].bits(lane);
            if prim == u32::MAX {
                break;
            }
            let corner = |first: usize| {
                let at = |axis: usize| f32x8::splat(simd, block[first + (axis & 3)].0[lane]);
                [at(self.all.axes[0]), at(self.all.axes[1]), at(self.all.axes[2])]
            };
            let corners = [corner(0), corner(3), corner(6)];
            let mut left = met;
            while left != 0 {
                let packet = left.trailing_zeros() as usize / 8;
                let among = (left >> (8 * packet)) as u32 & 0xff;
                left &= !(0xff << (8 * packet));
                let shears = self.eight(simd, &group.rays[packet], packet);
                let (mask, at) = shears.intersect(simd, corners, among);
                if mask != 0 {
                    let eight = group.first_eight + packet;
                    query.hits(simd, eight, mask, prim, at, &mut columns.t_max[packet]);
                }
            }
        }
    }

    /// One ray.
    #[inline(always)]
    fn one(&self, rays: &Rays8, packet: usize, lane: usize) -> Shear {
        let at = |lanes: &[f32; 8]| lanes[lane % 8];
        let [x, y, z] = self.all.axes;
        Shear {
            axes: self.all.axes,
            origin: [at(&rays.origin[x]), at(&rays.origin[y]), at(&rays.origin[z])],
            slope: [at(&self.slope[0][packet % 8]), at(&self.slope[1][packet % 8])],
            along: at(&rays.dir[z]),
            t_min: at(&rays.t_min),
            t_max: at(&rays.t_max),
        }
    }

    /// Eight rays.
    #[inline(always)]
    fn eight<S: Simd>(&self, simd: S, rays: &Rays8, packet: usize) -> Shears<S> {
        let at = |lanes: &[f32; 8]| f32x8::load_array_ref(simd, lanes);
        let [x, y, z] = self.all.axes;
        Shears {
            origin: [at(&rays.origin[x]), at(&rays.origin[y]), at(&rays.origin[z])],
            slope: [at(&self.slope[0][packet % 8]), at(&self.slope[1][packet % 8])],
            along: at(&rays.dir[z]),
            t_min: at(&rays.t_min),
            t_max: at(&rays.t_max),
        }
    }
}

/// The number of eights that have a ray among `rays`.
#[inline(always)]
pub(super) fn packets(mut rays: u64) -> u32 {
    rays |= rays >> 4;
    rays |= rays >> 2;
    rays |= rays >> 1;
    (rays & 0x0101_0101_0101_0101).count_ones()
}
