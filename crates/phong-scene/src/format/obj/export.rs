//! A scene as an OBJ file with its MTL file: triangles, without lights, camera and shapes.

use std::collections::BTreeSet;

use crate::diagnostic::Diagnostic;
use crate::format::export::flat::{
    say_fields, say_unfolded, split_scene, triangles_alone, warning,
};
use crate::format::export::merge::{Merged, merge};
use crate::format::export::{Account, File, Writing, free_name};
use crate::format::mtl::{Difference, write_material};
use crate::material::Material;
use crate::scene::Scene;

/// The scene as an OBJ file, with its materials in an MTL file beside it.
pub(crate) fn write_obj(
    scene: Scene,
    options: &Writing,
    name: &str,
    account: &mut Account,
) -> Result<Vec<File>, Box<Diagnostic>> {
    triangles_alone(&scene, options, account)?;
    let colors = scene.all_objects().any(|object| object.shape.has_colors());
    let mut materials = scene.materials.clone();
    say_unfolded(&scene, account);
    say_fields(&scene, account);
    let scene = if colors { split_scene(scene) } else { scene };
    let mut merged = merge(scene, colors, options.bare);
    account.carry("triangle", merged.mesh.indices.len());
    account.carry("object", merged.objects.len());

    let used: BTreeSet<u32> = merged.mesh.face_materials.iter().copied().collect();
    let mut names = BTreeSet::new();
    let mut text = String::new();
    for number in used {
        let Some(material) = materials.get_mut(number as usize) else { continue };
        let was = material.name.clone();
        material.name = free_name(&plain(&was, "material"), &mut names);
        if material.name != was {
            account.map(format!("the material `{was}` is called `{}`", material.name));
        }
        account.carry("material", 1);
        if !text.is_empty() {
            text.push('\n');
        }
        for difference in write_material(material, &material.name, &mut text) {
            match difference {
                Difference::Mapped(how) => account.map(format!("material `{was}`: {how}")),
                Difference::Lost(what) => account.drop(warning(
                    format!("material `{was}`: MTL does not hold {what}"),
                    &material.place,
                )),
            }
        }
    }
    if colors {
        work_in(&mut merged, &materials, account);
    }
    let stem = name.strip_suffix(".obj").unwrap_or(name);
    let library = (!text.is_empty()).then(|| format!("{}.mtl", plain(stem, "materials")));
    for (_, name) in &mut merged.objects {
        *name = plain(name, "object");
    }
    let Merged { mesh, objects } = merged;
    let first = library.as_ref().map_or_else(String::new, |name| format!("mtllib {name}\n"));
    let obj = File::new(name, move |to| {
        to.write_all(first.as_bytes())?;
        mesh.write_obj_objects(&materials, &objects, to)
    });
    let mtl = library.map(|name| File::text(name, text));
    Ok(std::iter::once(obj).chain(mtl).collect())
}

/// Vertex colours replace the whole of `Kd`: the weight that theirs are to have is worked in.
fn work_in(merged: &mut Merged, materials: &[Material], account: &mut Account) {
    let mesh = &mut merged.mesh;
    let mut weights = vec![1.0; mesh.positions.len()];
    for (triangle, material) in mesh.indices.iter().zip(&mesh.face_materials) {
        let weight =
            materials.get(*material as usize).map_or(1.0, |m| m.k_d.constant().unwrap_or(0.5));
        for &i in triangle {
            weights[i as usize] = weight;
        }
    }
    if weights.iter().any(|&weight| weight != 1.0) {
        account.map("vertex colours replace `Kd`, so they are written times `k_d`".to_owned());
        for (color, weight) in mesh.colors.iter_mut().zip(weights) {
            *color *= weight;
        }
    }
}

/// A name as OBJ and MTL can hold it: on one line, without what ends or continues one.
fn plain(name: &str, unnamed: &str) -> String {
    let plain = name.replace(|c: char| c.is_control() || c == '#' || c == '\\', "_");
    let plain = plain.trim();
    if plain.is_empty() { unnamed.to_owned() } else { plain.to_owned() }
}
