//! A scene under construction, with what is compiled of it: nothing here knows Python.

use std::collections::BTreeMap;
use std::sync::Arc;

use phong::geometry::{Geometry, GeometryError, GeometryOptions};
use phong::look::Look;
use phong::view::{View, ViewError};
use phong_lab::furniture;
use phong_scene::{
    Background, Diagnostic, Framing, Image, Material, MaterialId, Object, Place, Scene, Texture,
    TextureId,
};

/// What of a scene is chosen for the picture, since nobody has said it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Automatic {
    /// The lights.
    pub(crate) lights: bool,
    /// Background, lights, and the colour of what has none: a bare model from a file.
    pub(crate) bare: bool,
}

/// What of a scene something was said of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Subject {
    /// The file or the text that it was read from.
    Text,
    Camera,
    Lights,
    Ambient,
    Settings,
    Image,
    /// The material of a number.
    Material(u32),
    /// The object of a number.
    Part(u64),
}

/// A scene under construction.
#[derive(Clone, Debug)]
pub(crate) struct State {
    /// The scene; pictures that are being rendered hold it too, and changes leave theirs alone.
    pub(crate) scene: Arc<Scene>,
    /// From where it is looked at; `None`: from its own camera.
    pub(crate) framing: Option<Framing>,
    pub(crate) automatic: Automatic,
    /// What was said of what it was made of.
    said: BTreeMap<Subject, Vec<Diagnostic>>,
    /// The number of each object, which stays the same when others go. Ascending.
    pub(crate) parts: Vec<u64>,
    /// The number of the next object.
    next: u64,
    /// Counts changes, so that what was compiled meanwhile is known to be late.
    version: u64,
    compiled: Compiled,
}

/// What is ready for rays.
#[derive(Clone, Debug, Default)]
struct Compiled {
    geometry: Option<Arc<Geometry>>,
    /// Whether objects have changed since it was built.
    stale: bool,
    /// What the last picture was made of, and what beside the scene it was made for.
    last: Option<(Asked, Ready)>,
}

/// The size and the background of a picture that was asked for.
type Asked = ([u32; 2], Background);

/// What is needed to look at a scene, away from it.
#[derive(Debug)]
pub(crate) struct Snapshot {
    pub(crate) scene: Arc<Scene>,
    framing: Option<Framing>,
    automatic: Automatic,
    version: u64,
    compiled: Compiled,
}

/// A scene made ready for one picture.
#[derive(Clone, Debug)]
pub(crate) struct Ready {
    /// The scene as it is looked at: with the picture's own settings, framed.
    pub(crate) scene: Arc<Scene>,
    pub(crate) view: Arc<View>,
    /// What is to be said of it.
    pub(crate) warnings: Vec<Diagnostic>,
    /// What beside the scene it was made for.
    asked: Asked,
    version: u64,
}

impl State {
    /// A scene in which everything is said.
    pub(crate) fn new(scene: Scene, framing: Option<Framing>, automatic: Automatic) -> Self {
        let count = scene.objects.len() as u64;
        Self {
            scene: Arc::new(scene),
            framing,
            automatic,
            said: BTreeMap::new(),
            parts: (0..count).collect(),
            next: count,
            version: 0,
            compiled: Compiled::default(),
        }
    }

    /// The same with these numbers for its objects, as they were before.
    pub(crate) fn numbered(mut self, parts: Vec<u64>) -> Self {
        self.next = parts.last().map_or(0, |last| last + 1);
        self.parts = parts;
        self
    }

    /// The scene, to change what it looks like.
    pub(crate) fn look(&mut self) -> &mut Scene {
        self.version += 1;
        self.compiled.last = None;
        Arc::make_mut(&mut self.scene)
    }

    /// The scene, to change its objects.
    pub(crate) fn objects(&mut self) -> &mut Scene {
        self.compiled.stale = true;
        self.look()
    }

    /// Adds an object; its number.
    pub(crate) fn add(&mut self, object: Object) -> u64 {
        self.objects().objects.push(object);
        let number = self.next;
        self.parts.push(number);
        self.next += 1;
        number
    }

    /// Where the object of a number stands in the scene.
    pub(crate) fn place(&self, number: u64) -> Option<usize> {
        self.parts.binary_search(&number).ok()
    }

    /// Takes an object away.
    pub(crate) fn remove(&mut self, place: usize) {
        self.objects().objects.remove(place);
        let number = self.parts.remove(place);
        self.say(Subject::Part(number), Vec::new());
    }

    /// Keeps what is to be said of something, in place of what was said of it before.
    pub(crate) fn say(&mut self, of: Subject, said: Vec<Diagnostic>) {
        if said.is_empty() {
            self.said.remove(&of);
        } else {
            self.said.insert(of, said);
        }
    }

    /// All that is to be said of what it was made of.
    pub(crate) fn warnings(&self) -> Vec<Diagnostic> {
        self.said.values().flatten().cloned().collect()
    }

    /// The material of a name.
    pub(crate) fn material_named(&self, name: &str) -> Option<MaterialId> {
        let number = self.scene.materials.iter().position(|material| material.name == name);
        number.map(|number| MaterialId(number as u32))
    }

    /// The default material: that of the scene, if it has one.
    pub(crate) fn default_material(&mut self) -> MaterialId {
        self.material(&Material::default(), &[])
    }

    /// The number of a material, which is put in unless an equal one is there. Its textures are
    /// numbered as in `textures`.
    pub(crate) fn material(&mut self, material: &Material, textures: &[Texture]) -> MaterialId {
        let material = self.with_textures(material, textures);
        let same =
            |other: &Material| Material { place: Place::default(), ..other.clone() } == material;
        if let Some(number) = self.scene.materials.iter().position(same) {
            return MaterialId(number as u32);
        }
        let mut material = material;
        material.name = self.free_material_name(&material.name);
        let materials = &mut self.look().materials;
        materials.push(material);
        MaterialId(materials.len() as u32 - 1)
    }

    /// The same material, its textures among the scene's.
    pub(crate) fn with_textures(&mut self, material: &Material, textures: &[Texture]) -> Material {
        let used = material.textured();
        let mut numbers = BTreeMap::new();
        for (_, by) in used {
            let Some(texture) = textures.get(by.texture.0 as usize) else { continue };
            let texture = Texture { place: Place::default(), ..texture.clone() };
            let same =
                |other: &Texture| Texture { place: Place::default(), ..other.clone() } == texture;
            let known = self.scene.textures.iter().position(same);
            let number = known.unwrap_or_else(|| {
                let textures = &mut self.look().textures;
                textures.push(texture);
                textures.len() - 1
            });
            numbers.insert(by.texture, TextureId(number as u32));
        }
        let new = |old| numbers.get(&old).copied().unwrap_or(old);
        Material { place: Place::default(), ..material.renumber_textures(new) }
    }

    /// A name that no material has yet.
    fn free_material_name(&self, wanted: &str) -> String {
        let base = if wanted.is_empty() { "material" } else { wanted };
        let numbered = (2..).map(|number| format!("{base} {number}"));
        let mut names = std::iter::once(base.to_owned()).chain(numbered);
        names.find(|name| self.material_named(name).is_none()).unwrap_or_default()
    }

    /// The name of the next object of a kind.
    pub(crate) fn free_object_name(&self, kind: &str) -> String {
        let count = self.scene.objects.iter().filter(|object| object.shape.kind() == kind).count();
        let names = (count + 1..).map(|number| format!("{kind} {number}"));
        let taken = |name: &String| self.scene.objects.iter().any(|object| object.name == *name);
        names.into_iter().find(|name| !taken(name)).unwrap_or_default()
    }

    /// All that is needed to look at it, away from it.
    pub(crate) fn snapshot(&self) -> Snapshot {
        Snapshot {
            scene: Arc::clone(&self.scene),
            framing: self.framing.clone(),
            automatic: self.automatic,
            version: self.version,
            compiled: self.compiled.clone(),
        }
    }

    /// Keeps what was compiled of it, unless it has changed since.
    pub(crate) fn keep(&mut self, ready: &Ready) {
        if self.version == ready.version {
            let geometry = Some(Arc::clone(ready.view.geometry()));
            let last = Some((ready.asked, ready.clone()));
            self.compiled = Compiled { geometry, stale: false, last };
        }
    }

    /// The scene as a picture of this size shows it.
    pub(crate) fn scene_for(&self, size: [u32; 2]) -> Scene {
        let (scene, _) = self.snapshot().framed(Image { size, ..self.scene.image.clone() });
        scene
    }

    /// The scene as a picture of its own size shows it.
    pub(crate) fn framed(&self) -> Scene {
        let (scene, _) = self.snapshot().framed(self.scene.image.clone());
        scene
    }
}

impl Snapshot {
    /// The scene with a picture's settings, as it is looked at; and what is to be said of that.
    fn framed(&self, image: Image) -> (Scene, Vec<Diagnostic>) {
        let mut scene = Scene::clone(&self.scene);
        scene.image = image;
        let Some(framing) = &self.framing else {
            if self.automatic.lights {
                scene.light();
            }
            scene.fit_guessed();
            return (scene, Vec::new());
        };
        let image = scene.image.clone();
        if self.automatic.bare {
            let said = scene.frame(framing);
            // What the picture itself says wins.
            if image.background != self.scene.image.background {
                scene.image.background = image.background;
            }
            return (scene, said);
        }
        let mut framed = scene.clone();
        let said = framed.frame(framing);
        scene.camera = framed.camera;
        if self.automatic.lights {
            scene.lights = framed.lights;
        }
        scene.fit_guessed();
        (scene, said)
    }

    /// Makes it ready for a picture of these settings, in the current rayon pool. It may take so
    /// many bytes; `None`: as many as there are.
    ///
    /// # Errors
    /// [`ViewError`].
    pub(crate) fn prepare(self, image: Image, max_bytes: Option<u64>) -> Result<Ready, ViewError> {
        let asked = (image.size, image.background);
        let Compiled { geometry, stale, last } = &self.compiled;
        // Points and lines whose radius was guessed are as thick as the picture needs them.
        let guessed = self.scene.all_objects().any(|object| object.shape.guessed().is_some());
        let is_sized = guessed || self.framing.is_some();
        if let Some((known, ready)) = last
            && (!is_sized || known.0 == asked.0)
            && known.1 == asked.1
        {
            return Ok(ready.clone());
        }
        let (scene, mut warnings) = self.framed(image);
        let version = self.version;
        let fresh = *stale || guessed || geometry.is_none();
        let geometry = match geometry {
            Some(geometry) if !fresh => Arc::clone(geometry),
            Some(geometry) => Arc::new(geometry.update(&scene)?),
            None => {
                let options = GeometryOptions { max_bytes, ..GeometryOptions::of(&scene) };
                Arc::new(Geometry::new(&scene, options)?)
            }
        };
        let view = Arc::new(View::new(geometry, Look::new(&scene))?);
        if fresh {
            // What can hardly be meant is looked for where there is something new.
            let found = check(&scene)?;
            warnings.extend(found);
        }
        Ok(Ready { scene: Arc::new(scene), view, warnings, asked, version })
    }
}

/// What is said where a scene holds nothing to be seen.
fn check(scene: &Scene) -> Result<Vec<Diagnostic>, GeometryError> {
    let mut said = scene.check();
    if said.iter().any(Diagnostic::is_error) {
        return Err(GeometryError::Scene(said));
    }
    said.extend(furniture::warnings(scene));
    Ok(said)
}
