//! What can hardly be meant although every part of the scene is valid: all of it warnings.

use std::collections::BTreeSet;

use glam::DVec3;

use super::at;
use crate::bounds::Bounds;
use crate::camera::CameraKind;
use crate::color::Rgb;
use crate::diagnostic::{Diagnostic, Label};
use crate::light::Light;
use crate::material::Material;
use crate::scene::{Object, Scene};
use crate::shape::{GroupId, Shape};
use crate::texture::{Channel, TextureRef, TextureSpace, TextureUse, Textured};
use crate::wording::{list, quoted};

/// Most pairs of a light and an object that are looked at: a check must not outlast the render.
const MOST_PAIRS: usize = 10_000_000;

/// Most names that a message lists.
const MOST_NAMED: usize = 5;

/// A scene that is smaller than this in all is drawn wrong: the square of its lengths is 0 as an f32.
const SMALLEST: f64 = 1e-17;

/// Says everything suspicious about a scene, each with its place but without an excerpt.
/// `bounds` are the boxes of the objects.
pub(super) fn check(scene: &Scene, bounds: &[Bounds], say: &mut dyn FnMut(Diagnostic)) {
    unseen(scene, bounds, say);
    minute(scene, bounds, say);
    without_coordinates(scene, say);
    scene.materials.iter().for_each(|material| nowhere_above_0(scene, material, say));
    if scene.objects.is_empty() {
        let help = "add a shape, such as `[[sphere]]`";
        say(Diagnostic::warning("the scene has no objects", None).with_help(help));
    }
    if scene.lights.is_empty() {
        let help = "without a `[[light]]` only the ambient term is seen";
        say(Diagnostic::warning("the scene has no lights", None).with_help(help));
    }
    if scene.objects.len().saturating_mul(scene.lights.len()) <= MOST_PAIRS {
        scene.objects.iter().for_each(|object| shut_in(scene, object, say));
    }
}

/// Says which meshes have no texture coordinates although a material of theirs asks for some.
fn without_coordinates(scene: &Scene, say: &mut dyn FnMut(Diagnostic)) {
    let asks = |material: &Material| {
        let uses = material.textured().into_iter();
        uses.filter_map(|(_, by)| scene.textures.get(by.texture.0 as usize))
            .find(|texture| texture.space == TextureSpace::Uv)
            .map(|texture| texture.name.as_str())
    };
    let asked: Vec<Option<&str>> = scene.materials.iter().map(asks).collect();
    if asked.iter().all(Option::is_none) {
        return;
    }
    for object in scene.all_objects() {
        let Shape::Mesh(mesh) = &object.shape else { continue };
        if !mesh.uvs.is_empty() {
            continue;
        }
        let numbers: BTreeSet<u32> = object.material_numbers().collect();
        let asked = |number: &u32| asked.get(*number as usize).copied().flatten();
        let Some(texture) = numbers.iter().find_map(asked) else { continue };
        let texture = quoted(texture);
        let message = format!(
            "{} has no texture coordinates, which the texture {texture} needs",
            object.name
        );
        let help =
            "each of its triangles shows the texture for itself; `space = \"object\"` needs none";
        say(Diagnostic::warning(message, at(&object.place)).with_help(help));
    }
}

/// Says if all there is is so small that numbers do not tell its parts apart.
fn minute(scene: &Scene, bounds: &[Bounds], say: &mut dyn FnMut(Diagnostic)) {
    let sizes =
        bounds.iter().filter(|bounds| !bounds.is_empty()).map(|bounds| bounds.size().length());
    let largest = sizes.reduce(f64::max).filter(|&largest| largest < SMALLEST);
    if let (Some(largest), Some(first)) = (largest, scene.objects.first()) {
        let message = format!(
            "nothing is larger than {largest:.1e} units: below {SMALLEST:e} pictures are wrong"
        );
        let help = "give all lengths in a smaller unit";
        say(Diagnostic::warning(message, at(&first.place)).with_help(help));
    }
}

/// Says which parameters `scale` and `offset` bring below 0 wherever their texture is: they are 0.
fn nowhere_above_0(scene: &Scene, material: &Material, say: &mut dyn FnMut(Diagnostic)) {
    for ((key, by), (_, TextureUse { is_color, .. })) in
        material.textured().into_iter().zip(material.texture_uses())
    {
        // Slopes have either sign.
        if matches!(key, "normal" | "bump") || by.scale >= 0.0 && by.offset >= 0.0 {
            continue;
        }
        let Some(texture) = scene.textures.get(by.texture.0 as usize) else { continue };
        let channel = by.channel.or((!is_color).then_some(Channel::Red));
        let by = TextureRef { channel, ..by };
        if texture.values(channel).into_iter().all(|value| Rgb::of(value, &by).is_black()) {
            let (of, texture) = (quoted(&material.name), quoted(&texture.name));
            let message = format!(
                "`{key}` of the material {of} is 0 everywhere: all of the texture {texture} comes below 0"
            );
            let help = "`scale` and `offset` beside `texture` bring its values into range";
            say(Diagnostic::warning(message, at(&material.place)).with_help(help));
        }
    }
}

/// Says which objects lie wholly outside the picture, or that all do.
fn unseen(scene: &Scene, bounds: &[Bounds], say: &mut dyn FnMut(Diagnostic)) {
    let Some(edges) = edges(scene) else { return };
    let outside = |bounds: &Bounds| {
        let corners = bounds.corners().map(|corner| corner - scene.camera.eye);
        edges.iter().any(|edge| corners.iter().all(|corner| corner.dot(*edge) > 0.0))
    };
    let is_unseen = |bounds: &Bounds| !bounds.is_empty() && outside(bounds);
    let unseen: Vec<&Object> = (scene.objects.iter().zip(bounds))
        .filter(|(_, bounds)| is_unseen(bounds))
        .map(|(object, _)| object)
        .collect();
    let [first, ..] = unseen[..] else { return };
    if unseen.len() == scene.objects.len() {
        let message = "the camera sees nothing: everything lies outside the picture";
        let help = "look at its `eye` and `look_at`";
        say(Diagnostic::warning(message, at(&first.place)).with_help(help));
        return;
    }
    // Elsewhere mirrors and shadows may be what shows them.
    let mirrors = |m: &Material| !m.reflection.is_black() || !m.transmission.is_black();
    if scene.materials.iter().any(mirrors) {
        return;
    }
    // Of many copies some may well lie outside, as trees of a forest do.
    let group_of = |object: &Object| match object.shape {
        Shape::Instance(group) => Some(group),
        _ => None,
    };
    let groups_seen: BTreeSet<GroupId> = (scene.objects.iter().zip(bounds))
        .filter(|(_, bounds)| !is_unseen(bounds))
        .filter_map(|(object, _)| group_of(object))
        .collect();
    let unseen: Vec<&Object> = (unseen.into_iter())
        .filter(|object| group_of(object).is_none_or(|group| !groups_seen.contains(&group)))
        .collect();
    let [first, ..] = unseen[..] else { return };
    let names = list(unseen.iter().take(MOST_NAMED).map(|object| object.name.as_str()), ",");
    let more = unseen.len().saturating_sub(MOST_NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let message = format!("wholly outside the picture: {names}{more}");
    say(Diagnostic::warning(message, at(&first.place)));
}

/// Normals of the planes through the eye that bound what it sees, pointing outwards; `None`: it
/// sees in all directions, or rays do not leave from one point.
fn edges(scene: &Scene) -> Option<[DVec3; 5]> {
    let CameraKind::Perspective { fov } = scene.camera.kind else { return None };
    let forward = (scene.camera.look_at - scene.camera.eye).try_normalize()?;
    let right = forward.cross(scene.camera.up).try_normalize()?;
    let up = right.cross(forward);
    let [width, height] = scene.image.size.map(f64::from);
    let tan_y = libm::tan(0.5 * fov.to_radians());
    let tan_x = tan_y * width / height;
    let [by_x, by_y] = (2.0 * tan_y * scene.camera.shift).to_array();
    Some([
        right - (tan_x + by_x) * forward,
        -right - (tan_x - by_x) * forward,
        up - (tan_y + by_y) * forward,
        -up - (tan_y - by_y) * forward,
        -forward,
    ])
}

/// Says if lights or the camera are within an object that keeps light in or out.
fn shut_in(scene: &Scene, object: &Object, say: &mut dyn FnMut(Diagnostic)) {
    let to_own_space = object.transform.inverse();
    let within = |p: DVec3| contains(&object.shape, to_own_space.transform_point3(p));
    let lights = || scene.lights.iter().filter_map(|light| Some((light, light.kind.position()?)));
    if within(scene.camera.eye) {
        // A closed room or a dome is lit from within; a ball that the camera fell into is not.
        let lit = lights().any(|(_, position)| within(position));
        if matches!(object.shape, Shape::Sphere { .. }) && !lit {
            let message = format!("the camera is inside {}, and no light is", object.name);
            say(Diagnostic::warning(message, at(&object.place)));
        }
        return;
    }
    for (light, position) in lights() {
        if light.shadows && within(position) {
            say(dark(light, object));
        }
    }
}

/// The warning that nothing outside `object` gets anything of the light inside it.
fn dark(light: &Light, object: &Object) -> Diagnostic {
    let message = format!("{} is inside {}, which keeps all its light", light.name, object.name);
    let label =
        at(&object.place).map(|span| Label { message: format!("{} is here", object.name), span });
    let mut warning = Diagnostic::warning(message, at(&light.place));
    warning.labels.extend(label);
    warning.with_help("move it out, or give the light `shadows = false`")
}

/// Whether `p` lies inside a shape that is closed all round, both in its own space. Meshes and
/// instances are not looked into: that takes rays, or time.
fn contains(shape: &Shape, p: DVec3) -> bool {
    match *shape {
        Shape::Sphere { center, radius } => p.distance(center) < radius,
        Shape::Box { min, max } => p.cmpgt(min).all() && p.cmplt(max).all(),
        Shape::Cylinder { from, to, radius, capped: true } => {
            let (along, across) = about(from, to - from, p);
            along > 0.0 && along < 1.0 && across < radius
        }
        Shape::Cone { from, to, radius, radius_to, capped: true } => {
            let (along, across) = about(from, to - from, p);
            along > 0.0 && along < 1.0 && across < radius + along * (radius_to - radius)
        }
        Shape::Torus { center, axis, radius, tube } => {
            let (along, across) = about(center, axis, p);
            let height = along * axis.length();
            let from_ring = across - radius;
            from_ring * from_ring + height * height < tube * tube
        }
        _ => false,
    }
}

/// Where `p` is about an axis: along it, in lengths of `axis`, and its distance from it.
fn about(from: DVec3, axis: DVec3, p: DVec3) -> (f64, f64) {
    let along = (p - from).dot(axis) / axis.length_squared();
    (along, p.distance(from + along * axis))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn assert_holds(shape: &Shape, inside: [f64; 3], outside: [f64; 3]) {
        assert!(contains(shape, inside.into()), "inside");
        assert!(!contains(shape, outside.into()), "outside");
    }

    #[test]
    fn a_sphere_holds_what_is_nearer_than_its_radius() {
        let shape = Shape::Sphere { center: DVec3::Y, radius: 1.0 };
        assert_holds(&shape, [0.0, 0.1, 0.0], [0.0, -0.1, 0.0]);
    }

    #[test]
    fn a_box_holds_what_lies_between_its_corners() {
        let shape = Shape::Box { min: DVec3::ZERO, max: DVec3::ONE };
        assert_holds(&shape, [0.5, 0.5, 0.9], [0.5, 0.5, 1.1]);
    }

    #[test]
    fn a_cylinder_ends_at_its_caps() {
        let shape =
            Shape::Cylinder { from: DVec3::ZERO, to: 4.0 * DVec3::Y, radius: 1.0, capped: true };
        assert_holds(&shape, [0.9, 3.9, 0.0], [0.9, 4.1, 0.0]);
        assert_holds(&shape, [0.9, 3.9, 0.0], [1.1, 3.9, 0.0]);
    }

    #[test]
    fn a_cone_narrows_towards_its_tip() {
        let (from, to) = (DVec3::ZERO, 4.0 * DVec3::Y);
        let shape = Shape::Cone { from, to, radius: 1.0, radius_to: 0.0, capped: true };
        assert_holds(&shape, [0.2, 3.0, 0.0], [0.3, 3.0, 0.0]);
    }

    #[test]
    fn a_torus_holds_its_tube_and_not_its_hole() {
        let (center, axis) = (DVec3::ZERO, 5.0 * DVec3::Y);
        let shape = Shape::Torus { center, axis, radius: 2.0, tube: 0.5 };
        assert_holds(&shape, [2.4, 0.0, 0.0], [0.0, 0.0, 0.0]);
        assert_holds(&shape, [2.0, 0.4, 0.0], [2.0, 0.6, 0.0]);
    }

    #[test]
    fn what_is_open_holds_nothing() {
        let (from, to) = (DVec3::ZERO, 4.0 * DVec3::Y);
        let tube = Shape::Cylinder { from, to, radius: 1.0, capped: false };
        assert!(!contains(&tube, DVec3::Y));
    }
}
