//! What is said of a scene where a format holds but its triangles or spheres.

use std::collections::BTreeMap;

use super::merge::Size;
use super::{Account, Writing, split_all};
use crate::color::Rgb;
use crate::diagnostic::{Diagnostic, Place, Span};
use crate::light::Light;
use crate::scene::{Image, Object, Scene};
use crate::shape::Shape;

/// Most names that a message lists.
const NAMED: usize = 5;

/// Says what of the scene has no place in a file of triangles.
///
/// # Errors
/// If the scene is larger than `options` allow, or has no triangles.
pub(crate) fn triangles_alone(
    scene: &Scene,
    options: &Writing,
    account: &mut Account,
) -> Result<(), Box<Diagnostic>> {
    let size = Size::of(scene);
    size.check(options.max_bytes)?;
    leave_out(scene, options, "triangles", is_triangles, account);
    if size.triangles == 0 {
        return Err(nothing(&format!("{} holds triangles", options.format)));
    }
    Ok(())
}

/// Says what of the scene has no place in a model file, which holds only what is `held`.
pub(crate) fn leave_out(
    scene: &Scene,
    options: &Writing,
    held: &str,
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
        if scene.ambient_occlusion.is_some() {
            let message = format!("{format} holds no ambient occlusion");
            account.drop(Diagnostic::warning(message, None));
        }
        if scene.sky.is_some() {
            account.drop(Diagnostic::warning(format!("{format} holds no sky"), None));
        }
        if scene.fog.is_some() {
            account.drop(Diagnostic::warning(format!("{format} holds no fog"), None));
        }
        if scene.outline.is_some() {
            let message = format!("{format} holds no lines around things (`[outline]`)");
            account.drop(Diagnostic::warning(message, None));
        }
        if !scene.furniture.is_empty() {
            let message = format!("{format} holds no title, scale bar, axes, legend or labels");
            account.drop(Diagnostic::warning(message, None));
        }
        if scene.tone.is_some() {
            let message = format!("{format} holds no exposure, white balance or curve (`[tone]`)");
            account.drop(Diagnostic::warning(message, None));
        }
        if !scene.clips.is_empty() {
            let message = format!("{format} holds nothing that is cut away (`[[clip]]`)");
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
    for object in scene.all_objects() {
        if !matches!(object.shape, Shape::Instance(_)) && !holds(&object.shape) {
            kinds.entry(object.shape.kind()).or_default().push(object);
        }
    }
    for (kind, objects) in kinds {
        let names = listed(objects.iter().map(|o| o.name.as_str()), objects.len());
        let count = counted(kind, objects.len());
        let message = format!("{format} holds {held}, so {count} left out: {names}");
        account.drop(warning(message, &objects[0].place));
    }
}

/// The scene with every mesh of one material: a vertex has one colour, and it may be theirs.
pub(crate) fn split_scene(mut scene: Scene) -> Scene {
    // That it is so is not to be seen in the file.
    let account = &mut Account::default();
    scene.objects = split_all(scene.objects, account);
    for group in &mut scene.groups {
        group.objects = split_all(std::mem::take(&mut group.objects), account);
    }
    scene
}

/// Says that instances are there as copies.
pub(crate) fn say_unfolded(scene: &Scene, account: &mut Account) {
    let is_instance = |object: &&Object| matches!(object.shape, Shape::Instance(_));
    let count = scene.all_objects().filter(is_instance).count();
    if count > 0 {
        account.map(format!("{count} instances are unfolded into what they place"));
    }
}

/// Says that numbers of points, which maps show, are not written.
pub(crate) fn say_fields(scene: &Scene, account: &mut Account) {
    if let Some(lost) = fields_lost(scene) {
        account.drop(lost);
    }
}

/// What is to be said where numbers of points, which maps show, are not written; `None`: there are none.
pub(crate) fn fields_lost(scene: &Scene) -> Option<Diagnostic> {
    let first = scene.all_objects().find(|object| !object.shape.fields().is_empty())?;
    let message =
        format!("the numbers of points that maps show are not written: those of {}", first.name);
    Some(warning(message, &first.place))
}

pub(crate) fn is_triangles(shape: &Shape) -> bool {
    matches!(shape, Shape::Mesh(_) | Shape::Triangle { .. })
}

pub(crate) fn is_spheres(shape: &Shape) -> bool {
    matches!(shape, Shape::Sphere { .. } | Shape::Points(_))
}

pub(crate) fn is_cylinders(shape: &Shape) -> bool {
    matches!(shape, Shape::Cylinders(_))
}

pub(crate) fn warning(message: String, place: &Place) -> Diagnostic {
    Diagnostic::warning(message, Span { place: place.clone(), ..Span::default() })
}

pub(crate) fn nothing(holds: &str) -> Box<Diagnostic> {
    let help = "a .toml holds everything";
    let message = format!("{holds}, and the scene has none: nothing would be in the file");
    Box::new(Diagnostic::error(message, None).with_help(help))
}

/// The first few of so many names.
pub(crate) fn listed<'n>(names: impl Iterator<Item = &'n str>, count: usize) -> String {
    let named = crate::wording::list(names.take(NAMED), ",");
    if count > NAMED { format!("{named} and {} more", count - NAMED) } else { named }
}

/// `1 box is`, `2 boxes are`.
fn counted(kind: &str, count: usize) -> String {
    match (kind, count) {
        ("points", 1) => "1 cloud of points is".to_owned(),
        ("points", _) => format!("{count} clouds of points are"),
        ("cylinders", 1) => "1 bundle of cylinders is".to_owned(),
        ("cylinders", _) => format!("{count} bundles of cylinders are"),
        (kind, 1) => format!("1 {kind} is"),
        ("box", _) => format!("{count} boxes are"),
        ("torus", _) => format!("{count} tori are"),
        (kind, _) => format!("{count} {kind}s are"),
    }
}
