//! Looks by name: one word makes a good figure of a model, whatever it is.
//!
//! A look sets what a scene looks like and nothing of what is in it: lights, ambient light and what takes
//! it away, fog, lines, the background, and the factors of materials. Lights and fog go by the camera, so
//! a look is put on when that is chosen. Colours stay, but where a look is of one colour.

use glam::DVec3;

use crate::ambient_occlusion::{AmbientOcclusion, OcclusionDistance};
use crate::camera::Camera;
use crate::color::Rgb;
use crate::diagnostic::Diagnostic;
use crate::fog::{Fog, FogDistance, FogKind};
use crate::format::ExportOptions;
use crate::light::{Light, LightKind};
use crate::material::{Material, Model, VertexColors};
use crate::outline::Outline;
use crate::scene::{Background, Scene};
use crate::texture::Param;
use crate::wording::words;

/// A look by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NamedLook {
    /// The lecture's equation with its default factors, under the two lights of a bare model.
    Lecture,
    /// Soft light on white, depth by occlusion, a faint mist and thin lines: for print.
    Publication,
    /// Everything of one matt clay, modelled by soft light alone.
    Clay,
    /// Colours without light, parted by lines.
    Flat,
    /// Black lines on white, and nothing else.
    Ink,
    /// Full light, sharp shadows and occlusion before black, as Tachyon's pictures of molecules have.
    Tachyon,
    /// Two lights, broad highlights, no shadows, and depth that fades to black, as VMD's window has.
    Vmd,
    /// A light beside the eye, small highlights, and depth that fades to white, as `PyMOL`'s figures have.
    Pymol,
    /// A grey part with every edge drawn, as in a manual.
    Technical,
}

words!(NamedLook {
    "lecture" = Lecture,
    "publication" = Publication,
    "clay" = Clay,
    "flat" = Flat,
    "ink" = Ink,
    "tachyon" = Tachyon,
    "vmd" = Vmd,
    "pymol" = Pymol,
    "technical" = Technical,
});

impl NamedLook {
    /// Every look.
    pub const ALL: [Self; 9] = [
        Self::Lecture,
        Self::Publication,
        Self::Clay,
        Self::Flat,
        Self::Ink,
        Self::Tachyon,
        Self::Vmd,
        Self::Pymol,
        Self::Technical,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        crate::wording::Word::word(&self)
    }

    /// The look of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        <Self as crate::wording::Word>::of_word(name)
    }
}

/// What a look is made of, but for its lights.
struct Recipe {
    background: Background,
    ambient: f32,
    /// `k_a`, `k_d`, `k_s` and the exponent of every material.
    factors: [f32; 4],
    model: Model,
    /// The one colour of everything; `None`: each its own.
    color: Option<Rgb>,
    /// Rays of the ambient occlusion; 0: none.
    occlusion: u32,
    /// How much of what is farthest fades, and to which colour; `None`: nothing does.
    fog: Option<(f64, Rgb)>,
    /// Where fading begins, as a share of the model's depth.
    fog_start: f64,
    outline: Option<Outline>,
}

impl Scene {
    /// Puts a look on: replaces lights, ambient light, ambient occlusion, fog, outline and background,
    /// and the model and factors of all materials; what is mirrored, seen through or glows stays so.
    pub fn put_on(&mut self, look: NamedLook) {
        let grey = |level: u8| Rgb::from_srgb8([level; 3]);
        let plain = Recipe {
            background: Background::Color(Rgb::WHITE),
            ambient: 1.0,
            factors: [0.5, 0.55, 0.0, 32.0],
            model: Model::Phong,
            color: None,
            occlusion: 0,
            fog: None,
            // The corners of the box are empty: what is there is nearer its middle.
            fog_start: 0.25,
            outline: None,
        };
        let lines =
            |width, crease, color| Some(Outline { width, color, crease, ..Outline::default() });
        let shadowless = |lights: &mut Vec<Light>| {
            for light in lights {
                light.shadows = false;
            }
        };
        let mut lights = Vec::new();
        let camera = self.camera.clone();
        let light = |name, from, color, angle| from_the_eye(&camera, name, from, color, angle);
        let recipe = match look {
            NamedLook::Lecture => {
                self.light();
                lights = std::mem::take(&mut self.lights);
                let background = Background::Gradient { top: grey(0xf2), bottom: grey(0xc4) };
                Recipe { background, ambient: 1.0, factors: [0.1, 0.7, 0.3, 32.0], ..plain }
            }
            NamedLook::Publication => {
                lights.push(light("key light", [-0.6, 0.9, 1.0], 0.62, 12.0));
                lights.push(light("fill light", [0.9, 0.1, 0.8], 0.14, 0.0));
                shadowless(&mut lights);
                lights[0].shadows = true;
                Recipe {
                    factors: [0.5, 0.75, 0.18, 40.0],
                    occlusion: 12,
                    fog: Some((0.3, Rgb::WHITE)),
                    outline: lines(0.6, 180.0, grey(0x30)),
                    ..plain
                }
            }
            NamedLook::Clay => {
                lights.push(light("sky light", [-0.5, 1.2, 0.7], 0.5, 40.0));
                let background = Background::Gradient { top: grey(0xe9), bottom: grey(0xcf) };
                Recipe {
                    background,
                    factors: [0.62, 0.55, 0.0, 32.0],
                    color: Some(Rgb::from_srgb8([0xd8, 0xc3, 0xae])),
                    occlusion: 24,
                    ..plain
                }
            }
            NamedLook::Flat => Recipe {
                factors: [1.0, 0.0, 0.0, 32.0],
                outline: lines(1.0, 50.0, grey(0x20)),
                ..plain
            },
            NamedLook::Ink => Recipe {
                factors: [1.0, 0.0, 0.0, 32.0],
                color: Some(Rgb::WHITE),
                outline: lines(1.0, 35.0, Rgb::BLACK),
                ..plain
            },
            NamedLook::Tachyon => {
                lights.push(light("light 1", [-0.2, 0.3, 1.0], 0.7, 0.0));
                lights.push(light("light 2", [1.0, 1.2, 0.6], 0.45, 0.0));
                Recipe {
                    background: Background::Color(Rgb::BLACK),
                    factors: [0.3, 0.75, 0.2, 40.0],
                    occlusion: 12,
                    ..plain
                }
            }
            NamedLook::Vmd => {
                lights.push(light("light 1", [-0.1, 0.1, 1.0], 0.8, 0.0));
                lights.push(light("light 2", [1.0, 2.0, 0.5], 0.45, 0.0));
                shadowless(&mut lights);
                Recipe {
                    background: Background::Color(Rgb::BLACK),
                    factors: [0.06, 0.7, 0.5, 40.0],
                    model: Model::BlinnPhong,
                    fog: Some((0.7, Rgb::BLACK)),
                    ..plain
                }
            }
            NamedLook::Pymol => {
                lights.push(light("eye light", [0.0, 0.0, 1.0], 0.42, 0.0));
                lights.push(light("key light", [-0.4, 0.5, 1.0], 0.5, 0.0));
                shadowless(&mut lights);
                lights[1].shadows = true;
                Recipe {
                    factors: [0.2, 0.8, 0.3, 55.0],
                    fog: Some((0.6, Rgb::WHITE)),
                    // PyMOL's `fog_start`: the front of a molecule does not fade.
                    fog_start: 0.45,
                    ..plain
                }
            }
            NamedLook::Technical => {
                lights.push(light("key light", [-0.7, 0.9, 0.8], 0.5, 0.0));
                lights.push(light("fill light", [0.8, -0.2, 0.6], 0.12, 0.0));
                shadowless(&mut lights);
                Recipe {
                    factors: [0.55, 0.6, 0.0, 32.0],
                    color: Some(Rgb::from_srgb8([0xd4, 0xdb, 0xe2])),
                    occlusion: 8,
                    outline: lines(0.9, 25.0, grey(0x18)),
                    ..plain
                }
            }
        };
        self.lights = lights;
        self.apply(&recipe);
    }

    /// All of the scene but its objects as scene text: what it looks like.
    ///
    /// # Errors
    /// A number that the text cannot hold.
    pub fn look_text(&self) -> Result<String, Box<Diagnostic>> {
        let mut bare = Self { objects: Vec::new(), groups: Vec::new(), ..self.clone() };
        // A clip of objects that are not there would cut everything.
        bare.clips.retain(|clip| clip.objects.is_empty());
        let options = ExportOptions { images: false, ..ExportOptions::default() };
        let text = bare.export(&options, "scene.toml")?.text();
        text.map_err(|error| Box::new(Diagnostic::error(error.to_string(), None)))
    }

    fn apply(&mut self, recipe: &Recipe) {
        self.image.background = recipe.background;
        self.ambient = Rgb::grey(recipe.ambient);
        self.sky = None;
        self.ambient_occlusion = (recipe.occlusion > 0).then_some(AmbientOcclusion {
            samples: recipe.occlusion,
            distance: OcclusionDistance::Auto,
        });
        self.outline = recipe.outline;
        self.fog =
            recipe.fog.and_then(|(strength, color)| self.fade(strength, color, recipe.fog_start));
        for material in &mut self.materials {
            dress(material, recipe);
        }
    }

    /// Fog that begins after this share of the model's depth, and has its strength at the far end; `None`: there
    /// is no end.
    fn fade(&self, strength: f64, color: Rgb, start: f64) -> Option<Fog> {
        let bounds = self.bounds();
        let Camera { eye, look_at, .. } = self.camera;
        let forward = (look_at - eye).try_normalize()?;
        if bounds.is_empty() || !bounds.size().is_finite() {
            return None;
        }
        let along = bounds.corners().map(|corner| (corner - eye).dot(forward));
        let [near, far] = [f64::min, f64::max].map(|least| along.into_iter().reduce(least));
        let (near, far) = (near?.max(0.0), far?);
        let start = near + start * (far - near);
        (far > start).then_some(Fog {
            kind: FogKind::Linear { start, end: far },
            color: Some(color),
            distance: FogDistance::Planar,
            strength,
        })
    }
}

/// A light that stands to the right of, above and behind the eye by the three numbers of `from`.
fn from_the_eye(
    camera: &Camera,
    name: &str,
    [right_by, up_by, behind]: [f64; 3],
    color: f32,
    angle: f64,
) -> Light {
    let forward = (camera.look_at - camera.eye).normalize_or(DVec3::NEG_Z);
    let right = forward.cross(camera.up).normalize_or(DVec3::X);
    let up = right.cross(forward);
    let direction = behind * forward - right_by * right - up_by * up;
    Light {
        name: name.to_owned(),
        kind: LightKind::Distant { direction, angle },
        color: Rgb::grey(color),
        specular_color: Rgb::grey(color),
        ..Light::default()
    }
}

/// Gives a material the look's factors.
fn dress(material: &mut Material, recipe: &Recipe) {
    let plain = Material::default();
    let [k_a, k_d, k_s, shininess] = recipe.factors;
    material.model = recipe.model;
    material.k_a = Param::Constant(k_a);
    material.k_d = Param::Constant(k_d);
    material.k_s = Param::Constant(k_s);
    material.shininess = Param::Constant(shininess);
    material.ambient_color = None;
    material.specular_color = plain.specular_color;
    material.dialect = plain.dialect;
    material.times_cosine = plain.times_cosine;
    material.normalize = plain.normalize;
    material.tint = plain.tint;
    material.ambient_rule = plain.ambient_rule;
    material.viewer = plain.viewer;
    if let Some(color) = recipe.color {
        material.color = Param::Constant(color);
        material.vertex_colors = VertexColors::Ignore;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Points;
    use crate::scene::Object;
    use crate::shape::Shape;

    fn ball() -> Scene {
        let ball = Shape::Sphere { center: DVec3::ZERO, radius: 1.0 };
        let mut scene = Scene { objects: vec![Object::from(ball)], ..Scene::default() };
        scene.camera.eye = DVec3::new(0.0, 0.0, 5.0);
        scene.camera.look_at = DVec3::ZERO;
        scene
    }

    #[test]
    fn every_look_leaves_a_sound_scene_and_has_a_name_of_its_own() {
        for look in NamedLook::ALL {
            let mut scene = ball();
            scene.put_on(look);
            let said = scene.check();
            assert!(!said.iter().any(Diagnostic::is_error), "{look:?}: {said:?}");
            assert_eq!(NamedLook::from_name(look.name()), Some(look));
        }
        assert_eq!(NamedLook::from_name("cartoon"), None);
    }

    #[test]
    fn a_look_put_on_twice_is_as_put_on_once() {
        for look in NamedLook::ALL {
            let (mut once, mut twice) = (ball(), ball());
            once.put_on(look);
            twice.put_on(NamedLook::Ink);
            twice.put_on(look);
            assert_eq!((&once.lights, once.fog), (&twice.lights, twice.fog));
            assert_eq!(
                (once.outline, once.ambient_occlusion),
                (twice.outline, twice.ambient_occlusion)
            );
        }
    }

    #[test]
    fn a_look_of_one_colour_keeps_the_colours_of_points_and_draws_its_own() {
        let points = || Points {
            spheres: vec![[0.0, 0.0, 0.0, 1.0]].into(),
            colors: vec![Rgb::BLACK].into(),
            ..Points::default()
        };
        let mut scene = ball();
        scene.objects.push(points().into());
        scene.put_on(NamedLook::Clay);
        let Shape::Points(kept) = &scene.objects[1].shape else { panic!("points") };
        assert_eq!(kept.colors[..], points().colors[..]);
        assert!(scene.materials.iter().all(|m| m.vertex_colors == VertexColors::Ignore));
    }

    #[test]
    fn fog_begins_at_the_model_and_ends_with_it() {
        let mut scene = ball();
        scene.put_on(NamedLook::Vmd);
        let kind = scene.fog.map(|fog| fog.kind);
        assert_eq!(kind, Some(FogKind::Linear { start: 4.5, end: 6.0 }));
    }
}
