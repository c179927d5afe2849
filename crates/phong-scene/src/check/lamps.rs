//! Lights that are meshes of the scene.

use super::at;
use crate::diagnostic::Diagnostic;
use crate::light::{Light, LightKind};
use crate::scene::Scene;
use crate::shape::Shape;
use crate::wording::{closest, quoted};

/// Says of which lights there is no mesh that could shine. Where there are no objects at all, as in the look of a
/// scene alone, they are looked for when it is put together.
pub(super) fn meshes(scene: &Scene, say: &mut dyn FnMut(Diagnostic)) {
    if scene.objects.is_empty() && scene.groups.is_empty() {
        return;
    }
    for light in &scene.lights {
        if !matches!(light.kind, LightKind::Mesh { .. }) {
            continue;
        }
        let (name, most) = (quoted(&light.object), Light::MOST_TRIANGLES);
        let object = scene.objects.iter().find(|object| object.name == light.object);
        let (wrong, help) = match object.map(|object| &object.shape) {
            Some(Shape::Mesh(mesh)) => match mesh.indices.len() {
                0 => (format!("{name} has no triangles"), None),
                n if n > most => (
                    format!("{name} has {n} triangles, and a mesh that shines at most {most}"),
                    Some("give a coarser mesh that stands for it".to_owned()),
                ),
                _ => continue,
            },
            Some(_) => (format!("{name} is no mesh"), None),
            None => {
                let is_mesh = |shape: &Shape| matches!(shape, Shape::Mesh(_));
                let meshes = scene.objects.iter().filter(|object| is_mesh(&object.shape));
                let near = closest(&light.object, meshes.map(|object| object.name.as_str()));
                let help = match near {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => "it is the name of a `[[mesh]]` that is in no group".to_owned(),
                };
                (format!("there is no object {name}"), Some(help))
            }
        };
        let mut error =
            Diagnostic::error(format!("{}: `object`: {wrong}", light.name), at(&light.place));
        error.help = help;
        say(error);
    }
}
