//! Groups and instances, unfolded.

use glam::DAffine3;
use phong_scene::{Group, Object, Shape};

/// Every object that is not an instance, in the order of the text, instances at their place.
pub(super) fn flatten(objects: &[Object], groups: &[Group]) -> Vec<Object> {
    let mut leaves = Vec::with_capacity(objects.len());
    for object in objects {
        match object.shape {
            Shape::Instance(group) => {
                place(
                    &groups[group.0 as usize],
                    &object.name,
                    object.transform,
                    groups,
                    &mut leaves,
                );
            }
            _ => leaves.push(object.clone()),
        }
    }
    leaves
}

/// The scene's reader has made sure that no group holds itself.
fn place(
    group: &Group,
    name: &str,
    transform: DAffine3,
    groups: &[Group],
    leaves: &mut Vec<Object>,
) {
    for object in &group.objects {
        let transform = transform * object.transform;
        let name = format!("{name} / {}", object.name);
        if let Shape::Instance(inner) = object.shape {
            place(&groups[inner.0 as usize], &name, transform, groups, leaves);
        } else {
            leaves.push(Object { name, transform, ..object.clone() });
        }
    }
}
