//! The leaves of a tree whose boxes a ray enters before its end, in no order.

use fearless_simd::{Simd, f32x8, prelude::*};

use super::{BoxStack, World, slabs::Slabs};
use crate::{
    lanes,
    level::Kernel,
    local::Ray,
    node8::{Kind, NODE, REFS, Ref, Row, rows},
    primitives::{capsule, sphere, triangle},
};

/// Gives `visit` the number of every primitive in those leaves.
pub(super) struct Every<'a, F> {
    pub(super) world: &'a World<'a>,
    pub(super) root: Ref,
    pub(super) ray: &'a Ray,
    pub(super) stack: &'a mut BoxStack,
    pub(super) visit: F,
}

impl<F: FnMut(u32)> Kernel for Every<'_, F> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { world, root, ray, stack, mut visit } = self;
        let slabs = Slabs::new(simd, ray);
        let end = f32x8::splat(simd, ray.t_max);
        stack[0] = u64::from(root.0);
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let at = Ref(stack[depth] as u32);
            if let Some(kind) = at.kind() {
                numbers(world, kind, at, &mut visit);
                continue;
            }
            let node: &[Row; NODE] = rows(world.rows, at.row());
            let (mask, _) = slabs.meet(simd, node, end);
            for lane in lanes(mask.to_bitmask() as u32) {
                stack[depth] = u64::from(Ref(node[REFS].bits(lane)).from(at.row()).0);
                depth += 1;
            }
        }
    }
}

/// The numbers of the primitives in a leaf.
fn numbers(world: &World<'_>, kind: Kind, leaf: Ref, visit: &mut impl FnMut(u32)) {
    let own = match kind {
        Kind::Triangles => triangle::BLOCK,
        Kind::Spheres => sphere::BLOCK,
        Kind::Cylinders => capsule::BLOCK,
        Kind::Solid => return visit(world.rows[leaf.row()].bits(0)),
        Kind::Indexed => {
            let [locals, geometries]: &[Row; 2] = rows(world.rows, leaf.row());
            for lane in (0..8).filter(|&lane| locals.bits(lane) != u32::MAX) {
                visit(world.first[geometries.bits(lane) as usize] + locals.bits(lane));
            }
            return;
        }
    };
    let numbers = world.rows[leaf.row() + own - 1];
    // An unused lane has no number.
    (0..8).map(|lane| numbers.bits(lane)).filter(|&number| number != u32::MAX).for_each(visit);
}
