//! A scene as an STL file: triangles alone.

use std::collections::BTreeSet;

use glam::DVec3;

use crate::diagnostic::Diagnostic;
use crate::format::export::flat::{
    is_triangles, listed, say_fields, say_unfolded, triangles_alone, warning,
};
use crate::format::export::merge::merge;
use crate::format::export::{Account, File, Writing};
use crate::scene::Scene;
use crate::shape::Shape;

/// The scene's triangles as a binary STL file.
pub(crate) fn write_stl(
    scene: Scene,
    options: &Writing,
    name: &str,
    account: &mut Account,
) -> Result<Vec<File>, Box<Diagnostic>> {
    triangles_alone(&scene, options, account)?;
    say_unfolded(&scene, account);
    say_fields(&scene, account);
    let held: Vec<_> = scene.all_objects().filter(|object| is_triangles(&object.shape)).collect();
    let used: BTreeSet<u32> = held.iter().flat_map(|object| object.material_numbers()).collect();
    let own = |m: &u32| !(options.bare && *m == 0);
    let own: Vec<_> =
        used.iter().filter(|m| own(m)).filter_map(|m| scene.materials.get(*m as usize)).collect();
    if let [first, ..] = own[..] {
        let names = listed(own.iter().map(|m| m.name.as_str()), own.len());
        let message = format!("STL holds no materials: {names}");
        account.drop(warning(message, &first.place));
    }
    if let Some(colored) = held.iter().find(|object| object.shape.has_colors()) {
        let message = format!("STL holds no colours, like those of {}", colored.name);
        account.drop(warning(message, &colored.place));
    }
    // A bare model's normals are those that a reader of STL makes, unless its file had others.
    if held.iter().any(|object| matches!(&object.shape, Shape::Mesh(m) if !m.normals.is_empty())) {
        account.map("corners lose their own normals: a facet has its geometric one".to_owned());
    }
    let mesh = merge(scene, false, true).mesh;
    if mesh.origin != DVec3::ZERO {
        account.map("positions far from the origin are rounded to single precision".to_owned());
    }
    account.carry("triangle", mesh.indices.len());
    Ok(vec![File::new(name, move |to| mesh.write_stl(to))])
}
