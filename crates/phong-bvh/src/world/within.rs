//! Every primitive that a ray hits, not the closest alone.

use super::{Instance, World};
use crate::{
    Hit, Primitives, Ray, Tree,
    frame::Frame,
    level::Token,
    local::{self, Ray as LocalRay},
    reference::Prepared,
};

/// Adds the hits of a ray on all parts, in no order.
pub(super) fn every(world: &World, ray: &Ray, found: &mut Vec<Hit>) {
    let World { loose, instances, upper, token, .. } = world;
    loose.each_plane_hit(ray, |part, t| found.push(Hit { t, part, prim: 0, u: 0.0, v: 0.0 }));
    of_tree(loose.tree(), loose.frame(), *token, ray, |batch, hit| {
        found.push(of_part(loose.part(batch), hit));
    });
    let mut of_instance = |Instance { tree, frame, part }: &Instance| {
        of_tree(tree, frame, *token, ray, |_, hit| found.push(of_part(*part, hit)));
    };
    match upper {
        None => instances.iter().for_each(of_instance),
        Some(upper) => upper.each(*token, ray, |instance| of_instance(&instances[instance])),
    }
}

fn of_part(part: u32, local::Hit { t, prim, u, v }: local::Hit) -> Hit {
    Hit { t, part, prim, u, v }
}

/// Gives `add` the batch of every primitive hit, and the hit, with its distance in the world.
fn of_tree(
    tree: &Tree,
    frame: &Frame,
    token: Token,
    ray: &Ray,
    mut add: impl FnMut(usize, local::Hit),
) {
    let (near, way) = frame.ray(ray);
    let near: &LocalRay = &near;
    let prepared = Prepared::new(near);
    tree.rays(token).every(near, |number| {
        let batch = tree.first().partition_point(|&first| first <= number) - 1;
        let primitives: &Primitives = &tree.batches()[batch];
        if let Some(hit) = prepared.intersect(primitives, number - tree.first()[batch]) {
            add(batch, local::Hit { t: way.back(hit.t, ray), ..hit });
        }
    });
}
