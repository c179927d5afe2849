//! A scene as a PLY file: triangles, else spheres, else cylinders, without materials, lights, camera and shapes.

use std::collections::{BTreeMap, BTreeSet};

use crate::diagnostic::Diagnostic;
use crate::format::export::flat::{
    fields_lost, is_cylinders, is_spheres, is_triangles, leave_out, listed, nothing, say_unfolded,
    split_scene, warning,
};
use crate::format::export::merge::{Size, cylinders, merge, spheres};
use crate::format::export::{Account, File, Writing};
use crate::material::Material;
use crate::mesh::Caps;
use crate::scene::{Object, Scene};
use crate::shape::Shape;

/// What makes a scene one that PLY can hold.
const HOLDS: &str = "PLY holds triangles, spheres or cylinders";

/// The scene as a PLY file: its triangles, or, if there are none, its spheres, or else its cylinders.
pub(crate) fn write_ply(
    scene: Scene,
    options: &Writing,
    name: &str,
    account: &mut Account,
) -> Result<Vec<File>, Box<Diagnostic>> {
    let size = Size::of(&scene);
    size.check(options.max_bytes)?;
    let solid = size.triangles > 0;
    let round = size.spheres > 0;
    let holds = match (solid, round) {
        (true, _) => is_triangles,
        (_, true) => is_spheres,
        _ => is_cylinders,
    };
    leave_out(&scene, options, "triangles, else spheres, else cylinders", holds, account);
    if !solid && !round && size.cylinders == 0 {
        return Err(nothing(HOLDS));
    }
    say_unfolded(&scene, account);
    let mut lost = fields_lost(&scene);
    if !solid && !round {
        say_ends(&scene, account);
    }
    let own_color = |m: &u32| {
        let automatic = options.bare && *m == 0;
        !automatic && scene.materials.get(*m as usize).is_some_and(|m| !is_default(m))
    };
    let held: Vec<_> = scene.all_objects().filter(|object| holds(&object.shape)).collect();
    let materials: BTreeSet<u32> =
        held.iter().flat_map(|object| object.material_numbers()).collect();
    let own: Vec<_> = materials.iter().filter(|m| own_color(m)).collect();
    let colors = !own.is_empty() || held.iter().any(|object| object.shape.has_colors());
    if !own.is_empty() {
        let names = own.iter().filter_map(|m| scene.materials.get(**m as usize));
        let names = listed(names.map(|m| m.name.as_str()), own.len());
        account.map(format!("vertices get the `color` of their material: {names}"));
        let place = scene.materials.get(*own[0] as usize).map(|m| m.place.clone());
        let message = format!("PLY holds no materials, but for their colour: {names}");
        account.drop(warning(message, &place.unwrap_or_default()));
    }
    let encoding = options.ply;
    let file = if solid {
        let merged = merge(if colors { split_scene(scene) } else { scene }, colors, true);
        account.carry("triangle", merged.mesh.indices.len());
        let mesh = merged.mesh;
        // A mesh that is written as it is keeps them.
        if !mesh.fields.is_empty() {
            lost = None;
        }
        File::new(name, move |to| mesh.write_ply(encoding, to))
    } else if !round {
        let mut uneven = BTreeMap::new();
        let cylinders = cylinders(&scene, colors, &mut uneven);
        say_uneven(&uneven, "cylinders that are not round", account);
        if cylinders.segments.is_empty() {
            return Err(nothing(HOLDS));
        }
        account.carry("cylinder", cylinders.segments.len());
        File::new(name, move |to| cylinders.write_ply(encoding, to))
    } else {
        let mut uneven = BTreeMap::new();
        let points = spheres(&scene, colors, &mut uneven);
        say_uneven(&uneven, "ellipsoids", account);
        if points.spheres.is_empty() {
            return Err(nothing(HOLDS));
        }
        account.carry("sphere", points.spheres.len());
        File::new(name, move |to| points.write_ply(encoding, to))
    };
    if let Some(lost) = lost {
        account.drop(lost);
    }
    Ok(vec![file])
}

/// Says whose ends PLY has no word for.
fn say_ends(scene: &Scene, account: &mut Account) {
    let flat = |object: &&Object| match &object.shape {
        Shape::Cylinders(cylinders) => cylinders.caps != Caps::Round,
        _ => false,
    };
    let objects: Vec<_> = scene.all_objects().filter(flat).collect();
    if let [first, ..] = objects[..] {
        let names = listed(objects.iter().map(|o| o.name.as_str()), objects.len());
        let message = format!("PLY does not say that ends are not round: {names}");
        account.drop(warning(message, &first.place));
    }
}

/// Says what its placement made other things of than PLY can hold.
fn say_uneven(uneven: &BTreeMap<String, usize>, what: &str, account: &mut Account) {
    if !uneven.is_empty() {
        let count: usize = uneven.values().sum();
        let names = listed(uneven.keys().map(String::as_str), uneven.len());
        let message = format!("PLY holds no {what}; {count} are left out: {names}");
        account.drop(Diagnostic::warning(message, None));
    }
}

/// Whether a material is the one that the reader makes for shapes that name none.
fn is_default(material: &Material) -> bool {
    *material == Material { place: material.place.clone(), ..Material::default() }
}
