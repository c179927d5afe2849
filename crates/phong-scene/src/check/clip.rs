//! What clips name and what they leave.

use std::collections::BTreeSet;

use super::at;
use crate::bounds::Bounds;
use crate::clip::{Cap, Clip, ClipKind, CutObjects, Keep};
use crate::diagnostic::Diagnostic;
use crate::scene::{Object, Scene};
use crate::shape::Shape;
use crate::wording::{closest, list, quoted};

/// Most names that a message lists.
const MOST_LISTED: usize = 12;

/// Says what is wrong with what clips name, and that there are too many of them.
pub(super) fn names(scene: &Scene, say: &mut dyn FnMut(Diagnostic)) {
    if let Some(beyond) = scene.clips.get(Clip::MOST) {
        let message = format!("a scene holds at most {} clips", Clip::MOST);
        say(Diagnostic::error(message, at(&beyond.place)));
    }
    let names = || scene.objects.iter().map(|object| object.name.as_str());
    let asked = scene.clips.iter().any(|clip| !clip.objects.is_empty());
    let all: BTreeSet<&str> = names().filter(|_| asked).collect();
    for clip in &scene.clips {
        if let Cap::Of(material) = clip.cap
            && material.0 as usize >= scene.materials.len()
        {
            let message = format!(
                "clip: `cap` is material {}, but the scene holds {} materials",
                material.0,
                scene.materials.len()
            );
            say(Diagnostic::error(message, at(&clip.place)));
        }
        for name in &clip.objects {
            let top = name.split(" / ").next().unwrap_or_default();
            if all.contains(top) || all.contains(name.as_str()) {
                continue;
            }
            let message = format!("clip: there is no object {}", quoted(name));
            let help = match closest(name, names()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("there are {}", list(names().take(MOST_LISTED), "and")),
            };
            say(Diagnostic::error(message, at(&clip.place)).with_help(help));
        }
    }
}

/// Says which meshes a clip with a cap cuts through that enclose nothing. `bounds` are the boxes of the
/// objects.
pub(super) fn open(scene: &Scene, bounds: &[Bounds], say: &mut dyn FnMut(Diagnostic)) {
    let capped = scene.clips.iter().filter(|clip| clip.cap != Cap::Open);
    let capped: Vec<_> = capped.map(|clip| (&clip.kind, clip.cut_objects())).collect();
    for (object, bounds) in scene.objects.iter().zip(bounds) {
        let is_cut = |(kind, cut): &(&ClipKind, CutObjects<'_>)| {
            cut.has(&object.name) && passes_through(kind, bounds)
        };
        // Whether a mesh is open takes a sort of its edges.
        if capped.iter().any(is_cut) && is_open(object) {
            let message = format!("{} is open: where it is cut one looks into it", object.name);
            let help = "a cap needs a mesh of which every edge is shared by two faces; `cap = false` \
                        says that none is wanted";
            say(Diagnostic::warning(message, at(&object.place)).with_help(help));
        }
    }
}

fn is_open(object: &Object) -> bool {
    matches!(&object.shape, Shape::Mesh(mesh) if !mesh.is_closed())
}

/// Whether a box may lie on both sides of a cut.
fn passes_through(kind: &ClipKind, bounds: &Bounds) -> bool {
    match *kind {
        ClipKind::Plane { point, normal } => {
            let sides = bounds.corners().map(|corner| (corner - point).dot(normal) > 0.0);
            sides.contains(&true) && sides.contains(&false)
        }
        ClipKind::Box { min, max, keep } => {
            let apart = bounds.max.cmple(min).any() || bounds.min.cmpge(max).any();
            let within = bounds.min.cmpge(min).all() && bounds.max.cmple(max).all();
            !(apart || within && keep == Keep::Inside)
        }
    }
}
