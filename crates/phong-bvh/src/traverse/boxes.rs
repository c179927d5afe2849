//! A ray through a tree whose leaves are boxes: the caller intersects what they hold.

use fearless_simd::{Simd, f32x8, prelude::*};

use super::{
    slabs::Slabs,
    waiting::{key_of_child, push},
};
use crate::{
    build::Nodes,
    level::Kernel,
    local::Ray,
    node8::{NODE, Ref, Row, rows},
};

/// Boxes and nodes to visit: entry distance in the upper half, [`Ref`] in the lower.
pub(crate) type Stack = [u64; super::STACK];

/// Visits the boxes that a ray enters, mostly the nearest first. `visit` is given the number of a box, and
/// says how far the ray still has to look; below 0: no farther.
pub(crate) struct Boxes<'a, F> {
    pub(crate) nodes: &'a Nodes,
    pub(crate) ray: &'a Ray,
    pub(crate) stack: &'a mut Stack,
    pub(crate) farthest: f32,
    pub(crate) visit: F,
}

impl<F: FnMut(u32) -> f32> Kernel for Boxes<'_, F> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { nodes, ray, stack, mut farthest, mut visit } = self;
        let Some(root) = nodes.root else { return };
        let all = nodes.rows.as_slice();
        let slabs = Slabs::new(simd, ray);
        stack[0] = u64::from(root.0);
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let key = stack[depth];
            if f32::from_bits((key >> 32) as u32) > farthest {
                continue;
            }
            let at = Ref(key as u32);
            if at.kind().is_some() {
                farthest = visit(all[at.row()].bits(0));
                continue;
            }
            let node: &[Row; NODE] = rows(all, at.row());
            let (mask, enter) = slabs.meet(simd, node, f32x8::splat(simd, farthest));
            let (mut mask, enter) = (mask.to_bitmask() as u32, enter.to_array());
            let bottom = depth;
            while mask != 0 {
                let lane = mask.trailing_zeros() as usize & 7;
                mask &= mask - 1;
                let key = key_of_child(node, at.row(), lane, &enter);
                push(stack, bottom, &mut depth, key);
            }
        }
    }
}
