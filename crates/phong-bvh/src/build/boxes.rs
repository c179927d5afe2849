//! The primitives as the builder sees them: a box, and whose it is.

use fearless_simd::{Simd, f32x8, prelude::*};
use glam::Vec3;
use rayon::prelude::*;

use crate::{
    Aabb, Primitives,
    primitives::{tapered, triangle},
    simd::Rows,
};

/// A primitive's box as `[−lo, index within its geometry, hi, index of the geometry]`.
///
/// With the lower corner negated, the union of two boxes is one maximum of eight lanes. The two
/// index lanes take part in all arithmetic, and nothing reads what it makes of them. They hold
/// integers as bits, [raised](FIRST) so that these are no subnormal numbers: on those, arithmetic is
/// slower, and building took a quarter longer. A row of zeros is no box.
pub(super) use crate::node8::Row as Boxed;

/// The union of nothing, in the same form.
pub(super) const EMPTY: [f32; 8] = [f32::NEG_INFINITY; 8];

/// The bits of index 0: a power of two so small that no difference of indices is subnormal.
const FIRST: u32 = 0x2000_0000;

/// Indices are below this: their bits are then finite numbers.
pub(super) const MOST: usize = 1 << 30;

impl Boxed {
    /// The box of primitive `local` of a geometry; grown by what its test may round.
    pub(super) fn boxed(bounds: Aabb, local: usize, geometry: usize) -> Self {
        let Aabb { lo, hi } = bounds.padded();
        let [local, geometry] = [local, geometry].map(|index| f32::from_bits(index as u32 + FIRST));
        Self([-lo.x, -lo.y, -lo.z, local, hi.x, hi.y, hi.z, geometry])
    }

    /// Index within its geometry.
    pub(super) fn local(&self) -> usize {
        (self.0[3].to_bits() - FIRST) as usize
    }

    /// Index of its geometry.
    pub(super) fn geometry(&self) -> usize {
        (self.0[7].to_bits() - FIRST) as usize
    }

    /// The eight lanes.
    #[inline(always)]
    pub(super) fn lanes<S: Simd>(&self, simd: S) -> f32x8<S> {
        f32x8::load_array_ref(simd, &self.0)
    }
}

/// Half the surface of a box given as `[−lo, _, hi, _]`; 0 for the empty one.
#[inline(always)]
pub(super) fn half_area(b: &[f32; 8]) -> f32 {
    let [x, y, z] = [(b[0] + b[4]).max(0.0), (b[1] + b[5]).max(0.0), (b[2] + b[6]).max(0.0)];
    x * y + y * z + z * x
}

/// A box of every primitive that has bounds and can be hit, and how many those are: not planes, not
/// degenerate triangles.
pub(super) fn of(geometry: &[Primitives]) -> (Rows, usize) {
    const CHUNK: usize = 1 << 14;
    let bounded = |g: &Primitives| if matches!(g, Primitives::Plane(_)) { 0 } else { g.len() };
    let most = geometry.iter().map(bounded).sum();
    let mut boxes = Rows::zeroed(most);
    let mut rest = boxes.as_mut_slice();
    let mut used = 0;
    for (index, geometry) in geometry.iter().enumerate() {
        let (mine, others) = rest.split_at_mut(bounded(geometry));
        rest = others;
        used += if mine.len() < CHUNK {
            fill(mine, 0, geometry, index)
        } else {
            let chunks = mine.par_chunks_mut(CHUNK).enumerate();
            chunks.map(|(chunk, mine)| fill(mine, chunk * CHUNK, geometry, index)).sum()
        };
    }
    if used < most {
        let boxes = boxes.as_mut_slice();
        let mut end = 0;
        for at in 0..most {
            if boxes[at] != Boxed::ZERO {
                boxes[end] = boxes[at];
                end += 1;
            }
        }
    }
    (boxes, used)
}

/// The boxes of the primitives of one geometry from number `first` on; how many there are.
fn fill(boxes: &mut [Boxed], first: usize, geometry: &Primitives, index: usize) -> usize {
    let mut used = boxes.len();
    match geometry {
        Primitives::Triangles { positions, indices } => {
            for (local, slot) in (first..).zip(boxes) {
                let corners @ [a, b, c] = indices[local].map(|i| positions[i as usize]);
                if triangle::is_degenerate(corners) {
                    used -= 1;
                } else {
                    let bounds = Aabb { lo: a.min(b).min(c), hi: a.max(b).max(c) };
                    *slot = Boxed::boxed(bounds, local, index);
                }
            }
        }
        Primitives::Spheres(spheres) => {
            for (local, slot) in (first..).zip(boxes) {
                let sphere = spheres.get(local);
                let radius = Vec3::splat(sphere.radius);
                let bounds = Aabb { lo: sphere.center - radius, hi: sphere.center + radius };
                *slot = Boxed::boxed(bounds, local, index);
            }
        }
        Primitives::Cylinders { cylinders, caps } => {
            for (local, slot) in (first..).zip(boxes) {
                let bounds = tapered::bounds(&cylinders[local], *caps);
                *slot = Boxed::boxed(bounds, local, index);
            }
        }
        Primitives::Solid(solid) => {
            let [lo, hi] = solid.bounds();
            boxes[0] = Boxed::boxed(Aabb { lo, hi }, 0, index);
        }
        Primitives::Plane(_) => {}
    }
    used
}
