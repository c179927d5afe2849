//! The only judge of a scene, wherever it came from: text, a file, or code.
//!
//! What a value may be by itself is in its row of `keys`; here stands what several must be together.
//! Readers ask the same judges of single things while they know the place of each key.

mod bulk;
mod clip;
mod coplanar;
mod detail;
pub(crate) mod fault;
mod groups;
mod known;
mod lamps;
pub(crate) mod material;
pub(crate) mod settings;
pub(crate) mod shape;
mod suspicion;
pub(crate) mod texture;
mod value;

use glam::DAffine3;

use self::fault::{Fault, Faults};
pub(crate) use self::groups::MOST_OBJECTS;
pub use self::known::SoundArrays;
use crate::bounds::Bounds;
use crate::diagnostic::{Diagnostic, Place, Severity, Span};
use crate::furniture::Furniture;
use crate::limits::LARGEST;
use crate::maps;
use crate::scene::{Object, Scene};
use crate::shape::Shape;

/// Most diagnostics that are told; the rest are counted, and said to be.
const MOST: usize = 1000;

impl Scene {
    /// Everything that is wrong with the scene, and everything that can hardly be meant.
    ///
    /// A scene without an error here is one that can be drawn and written; one with an error may
    /// hold indices, numbers and groups that nothing else looks at twice. Errors are: numbers that
    /// are NaN, infinite or out of their range, indices and array lengths that do not fit, empty
    /// meshes and clouds, directions without a direction, placements that cannot be undone, groups
    /// that hold later groups or themselves, and things more than 1e18 units away. Each names the
    /// thing, its field and the value, with the place where it was written if it was.
    ///
    /// ```
    /// use phong_scene::{Object, Scene, Shape};
    /// # use glam::DVec3;
    /// let ball = Shape::Sphere { center: DVec3::ZERO, radius: -1.0 };
    /// let scene = Scene { objects: vec![Object::from(ball)], ..Scene::default() };
    /// let said = scene.check();
    /// assert_eq!(
    ///     said[0].to_string(),
    ///     "error: objects[0] `sphere`: `radius` must be a number above 0; this is -1",
    /// );
    /// ```
    #[must_use]
    pub fn check(&self) -> Vec<Diagnostic> {
        let earlier = SoundArrays::default();
        let mut judge = Judge::new(self, &earlier);
        judge.look();
        clip::names(self, &mut |error| judge.say(error));
        lamps::meshes(self, &mut |error| judge.say(error));
        judge.geometry();
        judge.exact_extents();
        if !judge.has_errors() {
            let bounds = std::mem::take(&mut judge.bounds);
            clip::open(self, &bounds, &mut |warning| judge.say(warning));
            suspicion::check(self, &bounds, &mut |warning| judge.say(warning));
            maps::check(self, &mut |diagnostic| judge.say(diagnostic));
            coplanar::check(self, &mut |warning| judge.say(warning));
            detail::check(self, &mut |warning| judge.say(warning));
        }
        judge.finish()
    }

    /// What is wrong with the objects and groups alone: [`Scene::check`] without camera, lights,
    /// materials and picture, and without what can hardly be meant.
    #[must_use]
    pub fn check_objects(&self) -> Vec<Diagnostic> {
        self.check_objects_again(&mut SoundArrays::default())
    }

    /// The same of a scene that may share arrays with one that was checked before: of those which
    /// were sound then, as `known` has it, nothing is read again. Afterwards it has those of this scene.
    #[must_use]
    pub fn check_objects_again(&self, known: &mut SoundArrays) -> Vec<Diagnostic> {
        let mut judge = Judge::new(self, known);
        judge.geometry();
        if !judge.has_errors() {
            judge.extents(false);
            if judge.has_errors() {
                // What is known of arrays is only where they lie at most.
                judge.said.clear();
                judge.exact_extents();
            }
        }
        let sound = std::mem::take(&mut judge.sound);
        let said = judge.finish();
        *known = sound;
        said
    }
}

/// Where an object stands in its scene.
#[derive(Clone, Copy)]
enum At {
    /// In [`Scene::objects`].
    Top(usize),
    /// In a group.
    Group(usize, usize),
}

/// A scene, and what has been said of it.
struct Judge<'s> {
    scene: &'s Scene,
    said: Vec<Diagnostic>,
    /// Warnings and errors beyond those.
    untold: [usize; 2],
    /// The boxes of the scene's objects.
    bounds: Vec<Bounds>,
    /// Arrays in which an earlier check found nothing wrong, and those of this scene.
    earlier: &'s SoundArrays,
    sound: SoundArrays,
}

impl<'s> Judge<'s> {
    fn new(scene: &'s Scene, earlier: &'s SoundArrays) -> Self {
        let (said, untold, bounds) = (Vec::new(), [0; 2], Vec::new());
        Self { scene, said, untold, bounds, earlier, sound: SoundArrays::default() }
    }

    fn has_errors(&self) -> bool {
        self.said.iter().any(Diagnostic::is_error)
    }

    fn say(&mut self, diagnostic: Diagnostic) {
        if self.said.len() < MOST {
            self.said.push(diagnostic);
        } else {
            self.untold[usize::from(diagnostic.is_error())] += 1;
        }
    }

    /// Says what a judge of single things finds; `name` is asked for only then.
    fn judge(&mut self, place: &Place, name: impl Fn() -> String, judge: impl FnOnce(&mut Faults)) {
        let mut faults = Faults::default();
        judge(&mut faults);
        for Fault { message, help, .. } in faults.all {
            let mut error = Diagnostic::error(format!("{}: {message}", name()), at(place));
            error.help = help;
            self.say(error);
        }
    }

    /// The picture, the camera, the lights and the materials.
    fn look(&mut self) {
        let scene = self.scene;
        let nowhere = Place::default();
        self.judge(&nowhere, || "image".into(), |f| settings::image(&scene.image, f));
        self.judge(&nowhere, || "camera".into(), |f| settings::camera(&scene.camera, f));
        self.judge(&nowhere, || "ambient".into(), |f| settings::ambient(scene.ambient, f));
        if let Some(occlusion) = &scene.ambient_occlusion {
            let name = || "ambient_occlusion".into();
            self.judge(&nowhere, name, |f| settings::occlusion(occlusion, f));
        }
        if let Some(sky) = &scene.sky {
            self.judge(&nowhere, || "sky".into(), |f| settings::sky(sky, f));
        }
        if let Some(fog) = &scene.fog {
            self.judge(&nowhere, || "fog".into(), |f| settings::fog(fog, f));
        }
        if let Some(outline) = &scene.outline {
            self.judge(&nowhere, || "outline".into(), |f| settings::outline(outline, f));
        }
        self.furniture();
        if let Some(tone) = &scene.tone {
            self.judge(&nowhere, || "tone".into(), |f| settings::tone(tone, f));
        }
        for (i, clip) in scene.clips.iter().enumerate() {
            let name = || named("clips", i, "clip", &clip.place);
            self.judge(&clip.place, name, |f| settings::clip(clip, f));
        }
        for (i, light) in scene.lights.iter().enumerate() {
            let name = || named("lights", i, &light.name, &light.place);
            self.judge(&light.place, name, |f| settings::light(light, f));
        }
        for (i, material) in scene.materials.iter().enumerate() {
            let name = || named("materials", i, &material.name, &material.place);
            let textures = Some(&*scene.textures);
            self.judge(&material.place, name, |f| material::material(material, textures, f));
        }
        for (i, texture) in scene.textures.iter().enumerate() {
            let name = || named("textures", i, &texture.name, &texture.place);
            self.judge(&texture.place, name, |f| texture::texture(texture, f));
        }
    }

    /// What a figure needs beside its picture.
    fn furniture(&mut self) {
        let Furniture { style, title, scale_bar, axes, legend, labels } = &self.scene.furniture;
        let nowhere = Place::default();
        self.judge(&nowhere, || "furniture".into(), |f| settings::furniture_style(style, f));
        if let Some(title) = title {
            self.judge(&nowhere, || "title".into(), |f| settings::title(title, f));
        }
        if let Some(bar) = scale_bar {
            self.judge(&nowhere, || "scale_bar".into(), |f| settings::scale_bar(bar, f));
        }
        if let Some(axes) = axes {
            self.judge(&nowhere, || "axes".into(), |f| settings::axes(axes, f));
        }
        if let Some(legend) = legend {
            self.judge(&nowhere, || "legend".into(), |f| settings::legend(legend, f));
            let textures = &self.scene.textures;
            self.judge(
                &nowhere,
                || "legend".into(),
                |f| settings::legend_texture(legend, textures, f),
            );
        }
        for (i, label) in labels.iter().enumerate() {
            let name = || named("furniture.labels", i, "label", &label.place);
            self.judge(&label.place, name, |f| settings::label(label, f));
        }
        let (count, most) = (labels.len(), Furniture::MOST_LABELS);
        if count > most {
            let message = format!("a scene has at most {most} labels, and there are {count}");
            self.say(Diagnostic::error(message, None));
        }
    }

    /// The objects and groups.
    fn geometry(&mut self) {
        let scene = self.scene;
        for (i, object) in scene.objects.iter().enumerate() {
            self.object(At::Top(i), object);
        }
        for (number, group) in scene.groups.iter().enumerate() {
            for (i, object) in group.objects.iter().enumerate() {
                self.object(At::Group(number, i), object);
            }
        }
        self.groups();
    }

    fn object(&mut self, stands: At, object: &Object) {
        let materials = self.scene.materials.len();
        let known = self.sound.take_over(&object.shape, self.earlier, materials);
        let mut sound = false;
        self.judge(
            &object.place,
            || name_of(stands, object),
            |faults| {
                shape::shape(&object.shape, faults);
                shape::transform(&object.transform, faults);
                let mut arrays = Faults::default();
                match &object.shape {
                    _ if known => {}
                    Shape::Mesh(mesh) => bulk::mesh(mesh, materials, &mut arrays),
                    Shape::Points(points) => bulk::points(points, &mut arrays),
                    Shape::Cylinders(cylinders) => bulk::cylinders(cylinders, &mut arrays),
                    _ => {}
                }
                sound = arrays.all.is_empty();
                faults.all.append(&mut arrays.all);
                let own = match &object.shape {
                    Shape::Instance(_) => false,
                    Shape::Mesh(mesh) => mesh.face_materials.is_empty(),
                    _ => true,
                };
                if own && object.material.0 as usize >= materials {
                    let number = object.material.0;
                    let message = format!(
                        "`material` is {number}, but the scene holds {materials} materials"
                    );
                    faults.say("material", message);
                }
            },
        );
        if sound && !known {
            self.sound.add(&object.shape);
        }
    }

    fn object_error(&mut self, stands: At, object: &Object, message: &str) {
        let message = format!("{}: {message}", name_of(stands, object));
        self.say(Diagnostic::error(message, at(&object.place)));
    }

    /// How far the objects reach, if nothing else is wrong with them.
    fn exact_extents(&mut self) {
        if !self.has_errors() {
            self.extents(true);
        }
    }

    /// Says which objects are farther away, or larger, than numbers can hold; if not `exact`, arrays
    /// whose box is known are not read.
    fn extents(&mut self, exact: bool) {
        let scene = self.scene;
        let mut groups = Vec::with_capacity(scene.groups.len());
        let mut all = Bounds::EMPTY;
        for (number, group) in scene.groups.iter().enumerate() {
            let mut whole = Bounds::EMPTY;
            for (i, object) in group.objects.iter().enumerate() {
                whole = whole.union(self.extent(At::Group(number, i), object, &groups, exact));
            }
            groups.push(whole);
        }
        for (i, object) in scene.objects.iter().enumerate() {
            let bounds = self.extent(At::Top(i), object, &groups, exact);
            self.bounds.push(bounds);
            all = all.union(bounds);
        }
        let size = all.size().max_element();
        if size > LARGEST {
            let message =
                format!("the scene is {size:e} units across, more than the {LARGEST:e} it may be");
            self.say(Diagnostic::error(message, None));
        }
    }

    fn extent(&mut self, stands: At, object: &Object, groups: &[Bounds], exact: bool) -> Bounds {
        let to_world = object.transform;
        let placed = |own: Bounds| {
            if to_world == DAffine3::IDENTITY {
                return Some(own);
            }
            let corners = own.corners().map(|p| to_world.transform_point3(p));
            (!exact).then(|| corners.into_iter().fold(Bounds::EMPTY, Bounds::with))
        };
        let known = self.sound.bounds(&object.shape).and_then(placed);
        let bounds = known.unwrap_or_else(|| object.bounds(groups));
        let farthest = bounds.min.abs().max(bounds.max.abs()).max_element();
        if !bounds.is_empty() && (farthest.is_nan() || farthest > LARGEST) {
            let message = format!(
                "it reaches {farthest:e} units from the origin; scenes go up to {LARGEST:e}"
            );
            self.object_error(stands, object, &message);
            return Bounds::EMPTY;
        }
        bounds
    }

    fn finish(mut self) -> Vec<Diagnostic> {
        let [warnings, errors] = self.untold;
        for (severity, count) in [(Severity::Error, errors), (Severity::Warning, warnings)] {
            if count > 0 {
                let message = format!("and {count} more, beyond the first {MOST}, which are told");
                let diagnostic = Diagnostic { severity, message, ..Diagnostic::default() };
                self.said.push(diagnostic);
            }
        }
        self.said
    }
}

/// What to call an object.
fn name_of(stands: At, object: &Object) -> String {
    match stands {
        At::Top(i) => named("objects", i, &object.name, &object.place),
        At::Group(group, i) => {
            named(&format!("groups[{group}].objects"), i, &object.name, &object.place)
        }
    }
}

/// What to call one of a list: its name, and its number where the text does not show it.
fn named(list: &str, number: usize, name: &str, place: &Place) -> String {
    match name {
        _ if !place.file.is_empty() && !name.is_empty() => name.to_owned(),
        "" => format!("{list}[{number}]"),
        name => format!("{list}[{number}] `{name}`"),
    }
}

/// The place as that of a diagnostic; `None`: it was made in memory.
fn at(place: &Place) -> Option<Span> {
    (!place.file.is_empty()).then(|| Span { place: place.clone(), ..Span::default() })
}
