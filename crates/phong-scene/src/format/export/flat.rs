//! OBJ and PLY: triangles, or spheres, without lights, camera and shapes.

use std::collections::{BTreeMap, BTreeSet};

use super::merge::{Merged, Size, merge, spheres};
use super::{Account, Content, ExportOptions, File, split_all};
use crate::color::Rgb;
use crate::diagnostic::{Diagnostic, Place, Span};
use crate::format::Format;
use crate::format::mtl::{Difference, write_material};
use crate::light::Light;
use crate::material::Material;
use crate::scene::{Image, Object, Scene};
use crate::shape::Shape;

/// Most names that a message lists.
const NAMED: usize = 5;

/// The scene as an OBJ file, with its materials in an MTL file beside it.
pub(super) fn write_obj(
    scene: Scene,
    options: &ExportOptions,
    name: &str,
    account: &mut Account,
) -> Result<Vec<File>, Box<Diagnostic>> {
    let size = Size::of(&scene);
    size.check(options.max_bytes)?;
    leave_out(&scene, options, is_triangles, account);
    if size.triangles == 0 {
        return Err(nothing("OBJ holds triangles"));
    }
    let colors = each_object(&scene).any(|object| has_colors(&object.shape));
    let mut materials = scene.materials.clone();
    say_unfolded(&scene, account);
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
    let content = Content::Obj { mesh, materials, objects, library: library.clone() };
    let obj = File { name: name.to_owned(), content };
    let mtl = library.map(|name| File { name, content: Content::Text(text) });
    Ok(std::iter::once(obj).chain(mtl).collect())
}

/// The scene as a PLY file: its triangles, or, if there are none, its spheres.
pub(super) fn write_ply(
    scene: Scene,
    options: &ExportOptions,
    name: &str,
    account: &mut Account,
) -> Result<Vec<File>, Box<Diagnostic>> {
    let size = Size::of(&scene);
    size.check(options.max_bytes)?;
    let solid = size.triangles > 0;
    let holds = |shape: &Shape| if solid { is_triangles(shape) } else { is_spheres(shape) };
    leave_out(&scene, options, holds, account);
    if !solid && size.spheres == 0 {
        return Err(nothing("PLY holds triangles or spheres"));
    }
    say_unfolded(&scene, account);
    let own_color = |m: &u32| {
        let automatic = options.bare && *m == 0;
        !automatic && scene.materials.get(*m as usize).is_some_and(|m| !is_default(m))
    };
    let held: Vec<_> = each_object(&scene).filter(|object| holds(&object.shape)).collect();
    let materials: BTreeSet<u32> = held.iter().flat_map(|object| used_by(object)).collect();
    let own: Vec<_> = materials.iter().filter(|m| own_color(m)).collect();
    let colors = !own.is_empty() || held.iter().any(|object| has_colors(&object.shape));
    if !own.is_empty() {
        let names = own.iter().filter_map(|m| scene.materials.get(**m as usize));
        let names = listed(names.map(|m| m.name.as_str()), own.len());
        account.map(format!("vertices get the `color` of their material: {names}"));
        let place = scene.materials.get(*own[0] as usize).map(|m| m.place.clone());
        let message = format!("PLY holds no materials, but for their colour: {names}");
        account.drop(warning(message, &place.unwrap_or_default()));
    }
    let content = if solid {
        let merged = merge(if colors { split_scene(scene) } else { scene }, colors, true);
        account.carry("triangle", merged.mesh.indices.len());
        Content::Ply(merged.mesh, options.ply)
    } else {
        let mut uneven = BTreeMap::new();
        let points = spheres(&scene, colors, &mut uneven);
        if !uneven.is_empty() {
            let count: usize = uneven.values().sum();
            let names = listed(uneven.keys().map(String::as_str), uneven.len());
            let message = format!("PLY holds no ellipsoids; {count} are left out: {names}");
            account.drop(Diagnostic::warning(message, None));
        }
        if points.spheres.is_empty() {
            return Err(nothing("PLY holds triangles or spheres"));
        }
        account.carry("sphere", points.spheres.len());
        Content::Points(points, options.ply)
    };
    Ok(vec![File { name: name.to_owned(), content }])
}

/// Says what of the scene has no place in a model file.
fn leave_out(
    scene: &Scene,
    options: &ExportOptions,
    holds: impl Fn(&Shape) -> bool,
    account: &mut Account,
) {
    let format = options.format;
    if !options.bare {
        account.drop(Diagnostic::warning(format!("{format} holds no camera"), None));
        if scene.image != Image::default() {
            let message = format!("{format} holds no settings of a picture (`[image]`)");
            account.drop(Diagnostic::warning(message, None));
        }
        if scene.ambient != Rgb::WHITE {
            let message = format!("{format} holds no ambient light");
            account.drop(Diagnostic::warning(message, None));
        }
        if let [Light { place, .. }, ..] = &scene.lights[..] {
            let (count, names) = (scene.lights.len(), scene.lights.iter().map(|l| l.name.as_str()));
            let names = listed(names, count);
            let message = format!(
                "{format} holds no lights, so {} left out: {names}",
                counted("light", count)
            );
            account.drop(warning(message, place));
        }
    }
    let mut kinds: BTreeMap<&str, Vec<&Object>> = BTreeMap::new();
    for object in each_object(scene) {
        if !matches!(object.shape, Shape::Instance(_)) && !holds(&object.shape) {
            kinds.entry(object.shape.kind()).or_default().push(object);
        }
    }
    for (kind, objects) in kinds {
        let names = listed(objects.iter().map(|o| o.name.as_str()), objects.len());
        let why = match format {
            Format::Ply => "PLY holds triangles or else spheres",
            _ => "OBJ holds triangles",
        };
        let message = format!("{why}, so {} left out: {names}", counted(kind, objects.len()));
        account.drop(warning(message, &objects[0].place));
    }
}

/// The scene with every mesh of one material: a vertex has one colour, and it may be theirs.
fn split_scene(mut scene: Scene) -> Scene {
    // That it is so is not to be seen in the file.
    let account = &mut Account::default();
    scene.objects = split_all(scene.objects, account);
    for group in &mut scene.groups {
        group.objects = split_all(std::mem::take(&mut group.objects), account);
    }
    scene
}

/// Says that instances are there as copies.
fn say_unfolded(scene: &Scene, account: &mut Account) {
    let is_instance = |object: &&Object| matches!(object.shape, Shape::Instance(_));
    let count = each_object(scene).filter(is_instance).count();
    if count > 0 {
        account.map(format!("{count} instances are unfolded into what they place"));
    }
}

/// Vertex colours replace the whole of `Kd`: the weight that theirs are to have is worked in.
fn work_in(merged: &mut Merged, materials: &[Material], account: &mut Account) {
    let mesh = &mut merged.mesh;
    let mut weights = vec![1.0; mesh.positions.len()];
    for (triangle, material) in mesh.indices.iter().zip(&mesh.face_materials) {
        let weight = materials.get(*material as usize).map_or(1.0, |m| m.k_d);
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

/// Every object that is written somewhere in the scene, once.
fn each_object(scene: &Scene) -> impl Iterator<Item = &Object> {
    scene.objects.iter().chain(scene.groups.iter().flat_map(|group| &group.objects))
}

fn is_triangles(shape: &Shape) -> bool {
    matches!(shape, Shape::Mesh(_) | Shape::Triangle { .. })
}

fn is_spheres(shape: &Shape) -> bool {
    matches!(shape, Shape::Sphere { .. } | Shape::Points(_))
}

fn has_colors(shape: &Shape) -> bool {
    match shape {
        Shape::Mesh(mesh) => !mesh.colors.is_empty(),
        Shape::Points(points) => !points.colors.is_empty(),
        _ => false,
    }
}

/// The materials of an object.
fn used_by(object: &Object) -> BTreeSet<u32> {
    match &object.shape {
        Shape::Mesh(mesh) if !mesh.face_materials.is_empty() => {
            mesh.face_materials.iter().copied().collect()
        }
        _ => BTreeSet::from([object.material.0]),
    }
}

/// Whether a material is the one that the reader makes for shapes that name none.
fn is_default(material: &Material) -> bool {
    *material == Material { place: material.place.clone(), ..Material::default() }
}

fn warning(message: String, place: &Place) -> Diagnostic {
    Diagnostic::warning(message, Span { place: place.clone(), ..Span::default() })
}

fn nothing(holds: &str) -> Box<Diagnostic> {
    let help = "a .toml holds everything";
    let message = format!("{holds}, and the scene has none: nothing would be in the file");
    Box::new(Diagnostic::error(message, None).with_help(help))
}

/// The first few of so many names.
fn listed<'n>(names: impl Iterator<Item = &'n str>, count: usize) -> String {
    let named = crate::wording::list(names.take(NAMED), ",");
    if count > NAMED { format!("{named} and {} more", count - NAMED) } else { named }
}

/// `1 box is`, `2 boxes are`.
fn counted(kind: &str, count: usize) -> String {
    match (kind, count) {
        ("points", 1) => "1 cloud of points is".to_owned(),
        ("points", _) => format!("{count} clouds of points are"),
        (kind, 1) => format!("1 {kind} is"),
        ("box", _) => format!("{count} boxes are"),
        ("torus", _) => format!("{count} tori are"),
        (kind, _) => format!("{count} {kind}s are"),
    }
}

/// A name as OBJ and MTL can hold it: on one line, without what ends or continues one.
fn plain(name: &str, unnamed: &str) -> String {
    let plain = name.replace(|c: char| c.is_control() || c == '#' || c == '\\', "_");
    let plain = plain.trim();
    if plain.is_empty() { unnamed.to_owned() } else { plain.to_owned() }
}

/// The name, or with a number behind it the first that is not taken; it is then.
pub(crate) fn free_name(name: &str, taken: &mut BTreeSet<String>) -> String {
    let numbered = (2..).map(|n| format!("{name} {n}"));
    let free = std::iter::once(name.to_owned()).chain(numbered).find(|n| !taken.contains(n));
    let free = free.unwrap_or_default();
    taken.insert(free.clone());
    free
}
