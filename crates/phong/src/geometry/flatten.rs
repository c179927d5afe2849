//! Groups and instances, unfolded.

use glam::DAffine3;
use phong_scene::{Group, GroupId, Object, Scene, Shape};

/// An object that is not an instance, where it is placed.
#[derive(Debug)]
pub(super) struct Placed<'a> {
    /// The object as it was written; its own transform is part of `to_world`.
    pub(super) object: &'a Object,
    /// The name, behind those of the instances on the way to it.
    pub(super) name: String,
    pub(super) to_world: DAffine3,
}

/// Every object that is not an instance, in the order of the text, instances at their place.
///
/// The scene has been checked: a group holds instances of earlier groups only.
pub(super) fn flatten(scene: &Scene) -> Vec<Placed<'_>> {
    let mut placed = Vec::with_capacity(count(scene) as usize);
    place(&scene.objects, &scene.groups, None, &mut placed);
    placed
}

/// How many objects there are with instances unfolded.
pub(super) fn count(scene: &Scene) -> u64 {
    let mut counts = Vec::with_capacity(scene.groups.len());
    let sum = |objects: &[Object], counts: &[u64]| {
        objects.iter().fold(0_u64, |sum, object| {
            sum.saturating_add(match object.shape {
                Shape::Instance(GroupId(group)) => counts.get(group as usize).copied().unwrap_or(0),
                _ => 1,
            })
        })
    };
    for group in &scene.groups {
        let count = sum(&group.objects, &counts);
        counts.push(count);
    }
    sum(&scene.objects, &counts)
}

fn place<'a>(
    objects: &'a [Object],
    groups: &'a [Group],
    instance: Option<(&str, DAffine3)>,
    placed: &mut Vec<Placed<'a>>,
) {
    for object in objects {
        // What stands alone keeps its transform to the bit, signs of zeros included.
        let (name, to_world) = match instance {
            Some((name, to_world)) => {
                (format!("{name} / {}", object.name), to_world * object.transform)
            }
            None => (object.name.clone(), object.transform),
        };
        match object.shape {
            Shape::Instance(GroupId(group)) => {
                if let Some(group) = groups.get(group as usize) {
                    place(&group.objects, groups, Some((&name, to_world)), placed);
                }
            }
            _ => placed.push(Placed { object, name, to_world }),
        }
    }
}
