//! The scene: what was written, resolved.
//!
//! ```toml
//! version = 1
//!
//! [image]
//! size = [960, 540]
//! background = { top = "#4a7fc0", bottom = "#dfe9f4" }
//!
//! [camera]
//! eye = [0, 2, 8]
//! look_at = [0, 1, 0]
//!
//! [ambient]
//! color = 1.0
//!
//! [[include]]
//! file = "lights.toml"            # relative to the file that says so
//!
//! [groups.snowman]
//! [[groups.snowman.sphere]]
//! center = [0, 1, 0]
//! radius = 1
//! [[groups.snowman.sphere]]
//! center = [0, 2.4, 0]
//! radius = 0.7
//!
//! [[instance]]
//! group = "snowman"
//! translate = [3, 0, 0]
//! ```
//!
//! The file as a whole:
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `version` | 1 | 1, with a warning | Version of this format; 1 is the only one so far. |
//! | `image` | a table | every key's default | The picture. |
//! | `camera` | a table | required | Where the picture is taken from. |
//! | `ambient` | a table | every key's default | The ambient light. |
//! | `ambient_occlusion` | a table | none | What takes ambient light away: a factor of the ambient term. |
//! | `sky` | a table | none | A sky that the ambient light comes from. |
//! | `fog` | a table | none | What is far away fades into a colour. |
//! | `outline` | a table | none | Lines around things, drawn when the picture is done. |
//! | `furniture` | a table | every key's default | What title, scale bar, axes, legend and labels have in common. |
//! | `title` | a table | none | A title, drawn onto the picture when it is done. |
//! | `scale_bar` | a table | none | A bar that shows a length. |
//! | `axes` | a table | none | Three arrows that show which ways x, y and z point. |
//! | `legend` | a table | none | What the colours of a map stand for. |
//! | `label` | a list of tables | none | Words at points of the scene. |
//! | `tone` | a table | light as it is | How light becomes what a PNG shows. |
//! | `clip` | a list of tables | none | What is cut away. |
//! | `light` | a list of tables | none | The lights. |
//! | `materials` | tables by name | none | The materials, by name. |
//! | `textures` | tables by name | none | The textures, by name. |
//! | `groups` | tables by name | none | Shapes to be placed together, by name. |
//! | `sphere` | a list of tables | none | All points at `radius` from `center`; scaled unevenly, an ellipsoid. |
//! | `plane` | a list of tables | none | An infinite plane. |
//! | `triangle` | a list of tables | none | One triangle, counter-clockwise seen from outside. |
//! | `disc` | a list of tables | none | A flat disc. |
//! | `box` | a list of tables | none | A box with faces along the axes. |
//! | `cylinder` | a list of tables | none | A cylinder around the line from `from` to `to`. |
//! | `cone` | a list of tables | none | A cone or frustum around the line from `from` to `to`. |
//! | `torus` | a list of tables | none | A ring with a round section. |
//! | `mesh` | a list of tables | none | The triangles of a file. |
//! | `points` | a list of tables | none | A sphere at every point of a file. |
//! | `cylinders` | a list of tables | none | A cylinder along every segment of a file. |
//! | `molecule` | a list of tables | none | The atoms or particles of a file, and the bonds between them. |
//! | `instance` | a list of tables | none | A group, placed. |
//! | `include` | a list of tables | none | Other files, at this place. |
//!
//! `[image]`:
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `size` | `[width, height]`, whole numbers from 1 to 1048576 | `[960, 540]` | Width and height in pixels. |
//! | `samples` | a whole number from 1 to 1000000 | `16` | Samples a pixel; 1 is the pixel's centre. |
//! | `background` | a colour, "transparent", or `{ top = .., bottom = .. }` | `0` | What rays see that hit nothing; a table `{ top, bottom }` runs along the picture's height. |
//! | `filter` | `box`, `tent`, `gaussian` or `mitchell` | `"box"` | How samples are weighted into a pixel. |
//! | `seed` | a whole number, 0 or above | `0` | Seed of the sampling pattern. |
//! | `depth` | a whole number from 0 to 100 | `8` | Mirror and glass bounces; beyond it a ray brings black. |
//! | `min_weight` | a number from 0 to 1 | `0.0001` | Mirror and glass rays whose light would count less than this in every channel are not followed; 0: all are. |
//! | `terminator` | `true` or `false` | `true` | Whether shadow rays from meshes with smooth normals start above the face, so that faces do not show where light ends. |
//! | `dpi` | a number above 0 | 96, which no file says | Pixels an inch: how wide lines are whose width is in points; PNG files say it. |
//! | `cel` | a whole number from 2 to 64 | none | The picture's luminance in so many steps from black to white, even to the eye, when it is done. |
//!
//! `background = { .. }`:
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `top` | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | required | Colour at the upper edge. |
//! | `bottom` | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | required | Colour at the lower edge. |
//!
//! `[ambient]`:
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `color` | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | `1` | `C_a` is this times the material's ambient colour. |
//!
//! `[[include]]`:
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `file` | the path of a file, in quotes | required | The scene file. |

use glam::DAffine3;

use crate::ambient_occlusion::AmbientOcclusion;
use crate::camera::Camera;
use crate::clip::Clip;
use crate::color::Rgb;
use crate::diagnostic::{Diagnostic, Place, SceneError};
use crate::fog::Fog;
use crate::furniture::Furniture;
use crate::light::Light;
use crate::limits::Range;
use crate::material::{Material, MaterialId};
use crate::outline::Outline;
use crate::shape::Shape;
use crate::sky::{Sky, SkyKind};
use crate::texels::Texels;
use crate::texture::Texture;
use crate::tone::Tone;
use crate::wording::words;

/// A whole scene, resolved: what the renderer takes.
///
/// Readers return checked ones.
///
/// ```
/// use phong_scene::{Light, Mesh, Object, Scene};
/// # use glam::Vec3;
/// let positions = [Vec3::ZERO, Vec3::X, Vec3::Y].into();
/// let mesh = Mesh { positions, indices: [[0, 1, 2]].into(), ..Mesh::default() };
/// let scene = Scene {
///     lights: vec![Light::default()],
///     objects: vec![Object::from(mesh)],
///     ..Scene::default()
/// };
/// ```
#[derive(Clone, Debug)]
pub struct Scene {
    /// The picture's own settings.
    pub image: Image,
    /// Where it is taken from.
    pub camera: Camera,
    /// The ambient light; `C_a` is this times the material's ambient colour. Linear.
    pub ambient: Rgb,
    /// What takes ambient light away; `None`: nothing does.
    pub ambient_occlusion: Option<AmbientOcclusion>,
    /// What is far away fades into a colour; `None`: it does not.
    pub fog: Option<Fog>,
    /// Lines around things, drawn when the picture is done; `None`: there are none.
    pub outline: Option<Outline>,
    /// Title, scale bar, axes, legend and labels, drawn when the picture is done; by default nothing.
    pub furniture: Furniture,
    /// How light becomes what a PNG shows; `None`: as it is.
    pub tone: Option<Tone>,
    /// What the ambient light comes from, and what rays see that hit nothing unless the background is
    /// transparent. `None`: ambient light comes from everywhere alike.
    pub sky: Option<Sky>,
    /// What is cut away of the objects, at most [`Clip::MOST`]; empty: nothing.
    pub clips: Vec<Clip>,
    /// The lights, in the order of the text.
    pub lights: Vec<Light>,
    /// The materials; [`MaterialId`] indexes them.
    pub materials: Vec<Material>,
    /// The textures; [`TextureId`](crate::TextureId) indexes them.
    pub textures: Vec<Texture>,
    /// The objects, in the order of the text, includes at their place.
    pub objects: Vec<Object>,
    /// What instances place; a group's objects are not in `objects`.
    pub groups: Vec<Group>,
}

impl Default for Scene {
    /// The default camera and picture, white ambient light, no lights and no objects, and one
    /// material, the default one, which [`MaterialId`] 0 and so every default object is of.
    fn default() -> Self {
        Self {
            image: Image::default(),
            camera: Camera::default(),
            ambient: Rgb::WHITE,
            ambient_occlusion: None,
            fog: None,
            outline: None,
            furniture: Furniture::default(),
            tone: None,
            sky: None,
            clips: Vec::new(),
            lights: Vec::new(),
            materials: vec![Material::default()],
            textures: Vec::new(),
            objects: Vec::new(),
            groups: Vec::new(),
        }
    }
}

impl Scene {
    /// The objects, and then those of the groups: what instances place is among them once.
    pub fn all_objects(&self) -> impl Iterator<Item = &Object> {
        self.objects.iter().chain(self.groups.iter().flat_map(|group| &group.objects))
    }

    /// Bytes of the images of its textures and of its sky in memory, each counted once, with the halves that are
    /// made of them when they are needed.
    pub fn image_bytes(&self) -> u64 {
        let sky = self.sky.iter().filter_map(|sky| match &sky.kind {
            SkyKind::Image { texels, .. } => Some(&**texels),
            _ => None,
        });
        Texels::bytes_of(self.textures.iter().filter_map(Texture::texels).chain(sky))
    }
}

/// What reading gave: a scene unless there was an error, and everything there is to say.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// The scene; `None` exactly if a diagnostic is an error.
    pub scene: Option<Scene>,
    /// Whether the input was a bare model: camera and lights are automatic.
    pub bare: bool,
    /// Errors and warnings, in the order of the text.
    pub diagnostics: Vec<Diagnostic>,
}

impl Reading {
    /// The scene, for who has no use for warnings: look at [`Reading::diagnostics`] first.
    ///
    /// # Errors
    /// [`SceneError`], with everything there is to say.
    pub fn into_scene(self) -> Result<Scene, SceneError> {
        self.scene.ok_or(SceneError(self.diagnostics))
    }
}

/// The picture's own settings; the command line overrides them.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Width and height in pixels, each ≥ 1. Default 960 × 540.
    pub size: [u32; 2],
    /// Samples a pixel, ≥ 1. Default 16.
    pub samples: u32,
    /// What rays see that hit nothing.
    pub background: Background,
    /// How samples are weighted into a pixel. Default box.
    pub filter: FilterKind,
    /// Seed of the sampling pattern. Default 0.
    pub seed: u64,
    /// Mirror and glass bounces; beyond it a ray brings black. Default 8.
    pub depth: u32,
    /// A mirror or glass ray is not followed where the product of all weights on its way from the
    /// camera is below this in every channel: it brings black. From 0, which follows all, to 1.
    /// Default 0.0001.
    pub min_weight: f32,
    /// Whether shadow rays from meshes with smooth normals start above the face, so that faces do not
    /// show where light ends. Default true.
    pub terminator: bool,
    /// Pixels an inch, > 0: how wide lines are whose width is in points; `None`: 96, and files do not
    /// say it.
    pub dpi: Option<f64>,
    /// In how many steps from black to white the luminance of the finished picture comes, 2 to 64; `None`: it
    /// stays as it is.
    pub cel: Option<u32>,
}

impl Image {
    /// The largest width and height in pixels.
    pub const LARGEST: u32 = 1 << 20;
    /// The most samples a pixel.
    pub const MOST_SAMPLES: u32 = 1_000_000;
    /// The most bounces.
    pub const DEEPEST: u32 = 100;
    /// The most steps of luminance: more are hardly seen as steps.
    pub const MOST_STEPS: u32 = 64;
    /// The least and the largest `min_weight`.
    pub(crate) const MIN_WEIGHT: Range = Range::closed(0.0, 1.0);
}

impl Default for Image {
    fn default() -> Self {
        Self {
            size: [960, 540],
            samples: 16,
            background: Background::default(),
            filter: FilterKind::Box,
            seed: 0,
            depth: 8,
            min_weight: 1e-4,
            terminator: true,
            dpi: None,
            cel: None,
        }
    }
}

/// What rays see that hit nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// One linear colour.
    Color(Rgb),
    /// From `top` to `bottom` along the picture's height, linearly.
    Gradient {
        /// At the upper edge.
        top: Rgb,
        /// At the lower edge.
        bottom: Rgb,
    },
    /// Alpha 0; mirrors see black.
    Transparent,
}

impl Default for Background {
    /// Black.
    fn default() -> Self {
        Self::Color(Rgb::BLACK)
    }
}

words!(FilterKind {
    "box" = Box,
    "tent" = Tent,
    "gaussian" = Gaussian,
    "mitchell" = Mitchell,
});

/// The pixel filter: how a sample's place in (or around) its pixel is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FilterKind {
    /// Uniform over the pixel.
    #[default]
    Box,
    /// A triangle of radius 1 pixel.
    Tent,
    /// A Gaussian of standard deviation ½ pixel, cut at 1.5 pixels.
    Gaussian,
    /// Mitchell–Netravali, B = C = ⅓, radius 2 pixels; weights are signed.
    Mitchell,
}

/// Shapes to be placed together. A group may hold instances of earlier groups, never of itself.
#[derive(Clone, Debug, Default)]
pub struct Group {
    /// The name in the text.
    pub name: String,
    /// Its objects, in the order of the text.
    pub objects: Vec<Object>,
}

/// A shape, placed, with its material.
#[derive(Clone, Debug)]
pub struct Object {
    /// What `explain` calls it: `sphere 1`, `mesh 2` (numbered from 1 by kind).
    pub name: String,
    /// What it is, in its own space.
    pub shape: Shape,
    /// What it is made of.
    pub material: MaterialId,
    /// Own space to world; invertible and finite.
    pub transform: DAffine3,
    /// Where it was written.
    pub place: Place,
}

impl Default for Object {
    /// The default shape, called `object`, of material 0, where it is.
    fn default() -> Self {
        Self {
            name: "object".to_owned(),
            shape: Shape::default(),
            material: MaterialId::default(),
            transform: DAffine3::IDENTITY,
            place: Place::default(),
        }
    }
}

impl Object {
    /// The numbers of its materials: those of its faces, or its own; as many times as it has them.
    pub fn material_numbers(&self) -> impl Iterator<Item = u32> {
        let of_faces = match &self.shape {
            Shape::Mesh(mesh) => &mesh.face_materials[..],
            _ => &[],
        };
        let own = of_faces.is_empty().then_some(self.material.0);
        of_faces.iter().copied().chain(own)
    }
}

impl<S: Into<Shape>> From<S> for Object {
    /// This shape, called by its kind.
    fn from(shape: S) -> Self {
        let shape = shape.into();
        Self { name: shape.kind().to_owned(), shape, ..Self::default() }
    }
}
