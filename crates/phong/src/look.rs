//! What a geometry looks like: camera, lights, materials, background and ambient light.
//!
//! All of it is cheap to make and to change, and nothing of it is needed to build trees.

use phong_scene::{
    AmbientOcclusion, Background, Camera, Clip, Diagnostic, Fog, Image, Light, Material, Rgb,
    Scene, Sky, Texture,
};

/// What a geometry looks like, as it was written. Each part can be replaced.
///
/// A [`View`](crate::view::View) makes it ready for rays.
#[derive(Clone, Debug)]
pub struct Look {
    /// Where the picture is taken from.
    pub camera: Camera,
    /// The lights, in the order of their numbers.
    pub lights: Vec<Light>,
    /// The materials; a surface names its own by its place here.
    pub materials: Vec<Material>,
    /// The textures; a material names one by its place here.
    pub textures: Vec<Texture>,
    /// The ambient light; `C_a` is this times the material's ambient colour. Linear.
    pub ambient: Rgb,
    /// What takes ambient light away; `None`: nothing does.
    pub ambient_occlusion: Option<AmbientOcclusion>,
    /// What is far away fades into a colour; `None`: it does not.
    pub fog: Option<Fog>,
    /// What the ambient light comes from; `None`: from everywhere alike.
    pub sky: Option<Sky>,
    /// What is cut away of the objects.
    pub clips: Vec<Clip>,
    /// What rays see that hit nothing.
    pub background: Background,
}

impl Look {
    /// That of a scene.
    pub fn new(scene: &Scene) -> Self {
        Self {
            camera: scene.camera.clone(),
            lights: scene.lights.clone(),
            materials: scene.materials.clone(),
            textures: scene.ranged_textures(),
            ambient: scene.ambient,
            ambient_occlusion: scene.ambient_occlusion,
            fog: scene.fog,
            sky: scene.sky.clone(),
            clips: scene.clips.clone(),
            background: scene.image.background,
        }
    }
    /// What is wrong with it, by the rules of [`Scene::check`].
    #[must_use]
    pub fn check(&self) -> Vec<Diagnostic> {
        let Self {
            camera,
            lights,
            materials,
            textures,
            ambient,
            ambient_occlusion,
            fog,
            sky,
            clips,
            background,
        } = self.clone();
        let image = Image { background, ..Image::default() };
        // What they cut is looked up where there are objects, as is what shines.
        let clips = clips.into_iter().map(|clip| Clip { objects: Vec::new(), ..clip }).collect();
        let scene = Scene {
            image,
            camera,
            ambient,
            ambient_occlusion,
            fog,
            sky,
            clips,
            lights,
            materials,
            textures,
            ..Scene::default()
        };
        scene.check().into_iter().filter(Diagnostic::is_error).collect()
    }
}
