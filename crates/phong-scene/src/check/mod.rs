//! The only judge of a scene, wherever it came from: text, a file, or code.
//!
//! What a value may be by itself is in its row of `keys`; here stands what several must be together.
//! Readers ask the same judges of single things while they know the place of each key.

mod bulk;
mod coplanar;
mod detail;
pub(crate) mod fault;
mod groups;
pub(crate) mod material;
pub(crate) mod settings;
pub(crate) mod shape;
mod suspicion;
pub(crate) mod texture;
mod value;

use self::fault::{Fault, Faults};
pub(crate) use self::groups::MOST_OBJECTS;
use crate::bounds::Bounds;
use crate::diagnostic::{Diagnostic, Place, Severity, Span};
use crate::limits::LARGEST;
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
        let mut judge = Judge::new(self);
        judge.look();
        judge.geometry();
        if !judge.said.iter().any(Diagnostic::is_error) {
            let bounds = std::mem::take(&mut judge.bounds);
            suspicion::check(self, &bounds, &mut |warning| judge.say(warning));
            coplanar::check(self, &mut |warning| judge.say(warning));
            detail::check(self, &mut |warning| judge.say(warning));
        }
        judge.finish()
    }

    /// What is wrong with the objects and groups alone: [`Scene::check`] without camera, lights,
    /// materials and picture, and without what can hardly be meant.
    #[must_use]
    pub fn check_objects(&self) -> Vec<Diagnostic> {
        let mut judge = Judge::new(self);
        judge.geometry();
        judge.finish()
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
}

impl<'s> Judge<'s> {
    fn new(scene: &'s Scene) -> Self {
        Self { scene, said: Vec::new(), untold: [0; 2], bounds: Vec::new() }
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

    /// The objects and groups, and how far they reach.
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
        if !self.said.iter().any(Diagnostic::is_error) {
            self.extents();
        }
    }

    fn object(&mut self, stands: At, object: &Object) {
        let materials = self.scene.materials.len();
        self.judge(
            &object.place,
            || name_of(stands, object),
            |faults| {
                shape::shape(&object.shape, faults);
                shape::transform(&object.transform, faults);
                let mut own = !matches!(object.shape, Shape::Instance(_));
                match &object.shape {
                    Shape::Mesh(mesh) => {
                        bulk::mesh(mesh, materials, faults);
                        own = mesh.face_materials.is_empty();
                    }
                    Shape::Points(points) => bulk::points(points, faults),
                    Shape::Cylinders(cylinders) => bulk::cylinders(cylinders, faults),
                    _ => {}
                }
                if own && object.material.0 as usize >= materials {
                    let number = object.material.0;
                    let message = format!(
                        "`material` is {number}, but the scene holds {materials} materials"
                    );
                    faults.say("material", message);
                }
            },
        );
    }

    fn object_error(&mut self, stands: At, object: &Object, message: &str) {
        let message = format!("{}: {message}", name_of(stands, object));
        self.say(Diagnostic::error(message, at(&object.place)));
    }

    /// Says which objects are farther away, or larger, than numbers can hold.
    fn extents(&mut self) {
        let scene = self.scene;
        let mut groups = Vec::with_capacity(scene.groups.len());
        let mut all = Bounds::EMPTY;
        for (number, group) in scene.groups.iter().enumerate() {
            let mut whole = Bounds::EMPTY;
            for (i, object) in group.objects.iter().enumerate() {
                whole = whole.union(self.extent(At::Group(number, i), object, &groups));
            }
            groups.push(whole);
        }
        for (i, object) in scene.objects.iter().enumerate() {
            let bounds = self.extent(At::Top(i), object, &groups);
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

    fn extent(&mut self, stands: At, object: &Object, groups: &[Bounds]) -> Bounds {
        let bounds = object.bounds(groups);
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
