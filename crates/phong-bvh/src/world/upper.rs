//! The tree over many instances: each ray looks for the boxes it enters, and then in the trees there.

use std::cell::RefCell;

use glam::{DAffine3, DVec3};

use super::{Best, Instance};
use crate::{
    Canonical, Primitives, Ray, Solid, Tree,
    build::{BuildError, BuildOptions, Nodes},
    frame::Frame,
    level::Token,
    traverse::{BoxStack, Boxes, Meter, NO_BOXES},
};

/// A tree over the boxes of instances, in the world about its centre.
#[derive(Debug)]
pub(super) struct Upper {
    nodes: Nodes,
    /// The instance in each box.
    instances: Vec<u32>,
    frame: Frame,
}

thread_local! {
    static STACK: RefCell<BoxStack> = const { RefCell::new(NO_BOXES) };
}

impl Upper {
    pub(super) fn build(
        instances: &[Instance],
        center: DVec3,
        options: BuildOptions,
    ) -> Result<Self, BuildError> {
        let mut numbers = Vec::with_capacity(instances.len());
        let mut boxes = Vec::with_capacity(instances.len());
        for (instance, number) in instances.iter().zip(0..) {
            let Some(bounds) = instance.bounds() else { continue };
            let [low, high] = instance.frame.bounds(bounds, center);
            let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
            let to_world = DAffine3::from_translation(middle) * DAffine3::from_scale(half);
            boxes.push(Primitives::Solid(Solid { shape: Canonical::Box, to_world }));
            numbers.push(number);
        }
        let nodes = Tree::of(boxes, options)?.into_nodes();
        Ok(Self { nodes, instances: numbers, frame: Frame::about(center, None) })
    }

    pub(super) fn nodes(&self) -> u64 {
        self.nodes.nodes
    }

    pub(super) fn bytes(&self) -> u64 {
        self.nodes.bytes()
    }

    /// Offers the closest hit in all instances.
    pub(super) fn closest(
        &self,
        token: Token,
        instances: &[Instance],
        ray: &Ray,
        best: &mut Best,
        meter: &mut impl Meter,
    ) {
        let farthest = best.0.t;
        self.visit(token, ray, farthest, |instance| {
            meter.node();
            instances[instance].closest(token, ray, best, meter);
            best.0.t
        });
    }

    /// Whether anything is hit in any instance.
    pub(super) fn any(&self, token: Token, instances: &[Instance], ray: &Ray) -> bool {
        let mut hit = false;
        self.visit(token, ray, ray.t_max, |instance| {
            hit = instances[instance].any(token, ray);
            if hit { -1.0 } else { ray.t_max }
        });
        hit
    }

    /// Gives `visit` the number of every instance whose box the ray enters.
    pub(super) fn each(&self, token: Token, ray: &Ray, mut visit: impl FnMut(usize)) {
        self.visit(token, ray, ray.t_max, |instance| {
            visit(instance);
            ray.t_max
        });
    }

    fn visit(&self, token: Token, ray: &Ray, farthest: f32, mut visit: impl FnMut(usize) -> f32) {
        let (local, _) = self.frame.ray(ray);
        STACK.with_borrow_mut(|stack| {
            let (nodes, ray) = (&self.nodes, &local);
            let visit = |number: u32| visit(self.instances[number as usize] as usize);
            token.run(Boxes { nodes, ray, stack, farthest, visit });
        });
    }
}
