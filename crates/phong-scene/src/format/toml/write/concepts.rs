//! What each concept says to each key of its table: the reader's files, read backwards.
//!
//! `None` is a key that is not written: its default is meant, or it does not apply.

use glam::{DAffine3, DMat3, DVec3};

use super::text::{degrees, short};
use crate::camera::{Camera, CameraKind};
use crate::color::Rgb;
use crate::format::toml::value::{TexturedValue, Value};
use crate::light::{Light, LightKind};
use crate::material::{
    AmbientRule, Dialect, Distribution, Fresnel, Material, Model, Shadowing, Tint, Viewer, WardForm,
};
use crate::scene::{Background, FilterKind, Image};
use crate::shape::Shape;
use crate::texture::{Channel, Param, Texture, TextureKind, TextureRef, TextureSpace, Textured};

pub(super) fn image(image: &Image, key: &str) -> Option<Value> {
    Some(match key {
        "size" => Value::Size(image.size),
        "samples" => Value::Integer(image.samples.into()),
        "background" => match image.background {
            Background::Color(color) => Value::Color(color),
            other => Value::Background(other),
        },
        "filter" => Value::Word(match image.filter {
            FilterKind::Box => "box",
            FilterKind::Tent => "tent",
            FilterKind::Gaussian => "gaussian",
            FilterKind::Mitchell => "mitchell",
        }),
        "seed" => Value::Integer(image.seed),
        "depth" => Value::Integer(image.depth.into()),
        "min_weight" => Value::Number(short(image.min_weight)),
        "terminator" => Value::Flag(image.terminator),
        _ => return None,
    })
}

pub(super) fn camera_kind(camera: &Camera) -> &'static str {
    match camera.kind {
        CameraKind::Perspective { .. } => "perspective",
        CameraKind::Orthographic { .. } => "orthographic",
        CameraKind::Fisheye { .. } => "fisheye",
        CameraKind::Panorama => "panorama",
    }
}

pub(super) fn camera(camera: &Camera, key: &str) -> Option<Value> {
    Some(match (key, camera.kind) {
        ("kind", _) => Value::Word(camera_kind(camera)),
        ("eye", _) => Value::Vector(camera.eye),
        ("look_at", _) => Value::Vector(camera.look_at),
        ("up", _) => Value::Vector(camera.up),
        ("fov", CameraKind::Perspective { fov } | CameraKind::Fisheye { fov }) => {
            Value::Number(fov)
        }
        ("height", CameraKind::Orthographic { height }) => Value::Number(height),
        ("aperture", _) => Value::Number(camera.aperture),
        ("focus", _) => Value::Number(camera.focus?),
        _ => return None,
    })
}

pub(super) fn light_kind(light: &Light) -> &'static str {
    match light.kind {
        LightKind::Point { .. } => "point",
        LightKind::Distant { .. } => "distant",
        LightKind::Spot { .. } => "spot",
    }
}

/// `number` counts the scene's lights from 1.
pub(super) fn light(light: &Light, number: usize, key: &str) -> Option<Value> {
    use LightKind::{Distant, Point, Spot};
    Some(match (key, light.kind) {
        ("kind", _) => Value::Word(light_kind(light)),
        ("name", _) => return name(&light.name, &format!("light {number}")),
        ("position", Point { position, .. } | Spot { position, .. }) => Value::Vector(position),
        ("direction", Distant { direction, .. }) => Value::Vector(direction),
        ("target", Spot { target, .. }) => Value::Vector(target),
        ("cone", Spot { cone, .. }) => Value::Number(cone),
        ("edge", Spot { cone, edge, .. }) if edge != cone => Value::Number(edge),
        ("color", _) => Value::Color(light.color),
        ("specular_color", _) if light.specular_color != light.color => {
            Value::Color(light.specular_color)
        }
        ("attenuation", Point { attenuation, .. } | Spot { attenuation, .. }) => {
            Value::Vector(attenuation.into())
        }
        ("shadows", _) => Value::Flag(light.shadows),
        ("radius", Point { radius, .. } | Spot { radius, .. }) => Value::Number(radius),
        ("angle", Distant { angle, .. }) => Value::Number(angle),
        _ => return None,
    })
}

pub(super) fn material_model(material: &Material) -> &'static str {
    match material.model {
        Model::Phong => "phong",
        Model::Lambert => "lambert",
        Model::BlinnPhong => "blinn-phong",
        Model::BlinnFast => "blinn-fast",
        // Read as facets, and written as what it was.
        Model::Microfacet { .. } if material.dialect == Dialect::ThreeJs => "blinn-phong",
        Model::Microfacet { distribution: Distribution::Ggx, .. } => "ggx",
        Model::Microfacet { .. } => "cook-torrance",
        Model::OrenNayar { .. } => "oren-nayar",
        Model::Ward { .. } => "ward",
    }
}

pub(super) fn texture_kind(texture: &Texture) -> &'static str {
    match texture.kind {
        TextureKind::Checker { .. } => "checker",
        TextureKind::Gradient { .. } => "gradient",
    }
}

pub(super) fn texture(texture: &Texture, key: &str) -> Option<Value> {
    use TextureKind::{Checker, Gradient};
    Some(match (key, &texture.kind) {
        ("kind", _) => Value::Word(texture_kind(texture)),
        ("colors", Checker { colors, .. }) => Value::Colors(*colors),
        ("scale", Checker { scale, .. }) => Value::Number(*scale),
        ("axis", Gradient { axis, .. }) => Value::Vector(*axis),
        ("from", Gradient { from, .. }) => Value::Number(*from),
        ("to", Gradient { to, .. }) => Value::Number(*to),
        ("stops", Gradient { stops, .. }) => Value::Stops(stops.clone()),
        ("space", _) => Value::Word(match texture.space {
            TextureSpace::Object => "object",
            TextureSpace::World => "world",
            TextureSpace::Uv => "uv",
        }),
        // A checker's `scale` counts squares, so any other one is in the matrix.
        (_, Checker { .. }) if !is_shift(&texture.transform) => match key {
            "matrix" => Value::Matrix(texture.transform),
            _ => return None,
        },
        _ => return placed(&texture.transform, key),
    })
}

fn is_shift(transform: &DAffine3) -> bool {
    transform.matrix3 == DMat3::IDENTITY
}

/// A parameter, with the names of the scene's textures.
fn parameter<T: Textured>(
    parameter: Param<T>,
    textures: &[String],
    constant: impl Fn(T) -> Value,
) -> Value {
    match parameter {
        Param::Constant(value) => constant(value),
        Param::Textured(TextureRef { texture, scale, offset, channel }) => {
            Value::Textured(TexturedValue {
                texture: textures.get(texture.0 as usize).cloned().unwrap_or_default(),
                scale: short(scale),
                offset: short(offset),
                channel: channel.map(Channel::name),
            })
        }
    }
}

/// `textures` are the names of the scene's textures.
pub(super) fn material(material: &Material, textures: &[String], key: &str) -> Option<Value> {
    let m = material;
    let number = |x: Param<f32>| parameter(x, textures, |x| Value::Number(short(x)));
    let color = |c: Param<Rgb>| parameter(c, textures, Value::Color);
    let preset = m.dialect.switches();
    Some(match key {
        "model" => Value::Word(material_model(m)),
        "color" => color(m.color),
        "ambient_color" => color(m.ambient_color?),
        "specular_color" => match three_js_f0(m) {
            Some(f0) => Value::Color(f0),
            None => m.specular_color.map_or(Value::Word("object"), color),
        },
        "k_a" => number(m.k_a),
        "k_d" => number(m.k_d),
        "k_s" => number(m.k_s),
        "k_e" => number(m.k_e),
        "emission_color" => color(m.emission_color?),
        "reflection" => color(m.reflection),
        "transmission" => color(m.transmission),
        "ior" => Value::Number(short(m.ior)),
        "priority" => Value::Integer(m.priority.into()),
        "fresnel" if m.fresnel == m.transmission.is_black() => Value::Flag(m.fresnel),
        "dialect" => Value::Word(m.dialect.name()),
        "times_cosine" if m.times_cosine != preset.times_cosine => Value::Flag(m.times_cosine),
        "normalize" if m.normalize != preset.normalize => Value::Flag(m.normalize),
        "tint" if m.tint != preset.tint => Value::Word(match m.tint {
            Tint::Light => "light",
            Tint::Object => "object",
            Tint::Metallic => "metallic",
        }),
        "ambient_rule" if m.ambient_rule != preset.ambient_rule => {
            Value::Word(match m.ambient_rule {
                AmbientRule::Once => "once",
                AmbientRule::PerLight => "per-light",
                AmbientRule::Both => "both",
            })
        }
        "viewer" if m.viewer != preset.viewer => Value::Word(match m.viewer {
            Viewer::Local => "local",
            Viewer::Distant => "distant",
        }),
        _ => return model(m, textures, key),
    })
}

/// What `specular_color` becomes in three.js's dialect, `k_s` being 1.
fn three_js_f0(material: &Material) -> Option<Rgb> {
    match material.model {
        Model::Microfacet { fresnel: Fresnel::Schlick { f0 }, .. }
            if material.dialect == Dialect::ThreeJs =>
        {
            Some(f0)
        }
        _ => None,
    }
}

/// The keys of particular models.
fn model(material: &Material, textures: &[String], key: &str) -> Option<Value> {
    let number = |x: Param<f32>| parameter(x, textures, |x| Value::Number(short(x)));
    Some(match (key, material.model) {
        (
            "shininess",
            Model::Microfacet { distribution: Distribution::Blinn, roughness: exponent, .. },
        ) => number(exponent),
        ("shininess", Model::Phong | Model::BlinnPhong | Model::BlinnFast) => {
            number(material.shininess)
        }
        ("distribution", Model::Microfacet { distribution, .. }) => {
            Value::Word(match distribution {
                Distribution::Beckmann => "beckmann",
                Distribution::Blinn => "blinn",
                Distribution::Ggx => "ggx",
            })
        }
        ("roughness", Model::Microfacet { distribution, roughness, .. })
            if distribution != Distribution::Blinn =>
        {
            number(roughness)
        }
        ("shadowing", Model::Microfacet { shadowing, .. }) => Value::Word(match shadowing {
            Shadowing::Separable => "separable",
            Shadowing::Correlated => "correlated",
            Shadowing::VCavity => "v-cavity",
            Shadowing::Implicit => "implicit",
        }),
        ("f0", Model::Microfacet { fresnel, .. }) => match fresnel {
            Fresnel::None => Value::Color(Rgb::WHITE),
            Fresnel::Schlick { f0 } if f0 != Rgb::grey(0.04) => Value::Color(f0),
            _ => return None,
        },
        ("eta", Model::Microfacet { fresnel, .. }) => match fresnel {
            Fresnel::Conductor { eta, .. } => Value::Color(eta),
            Fresnel::Dielectric { eta } => Value::Color(Rgb::grey(eta)),
            _ => return None,
        },
        ("k", Model::Microfacet { fresnel: Fresnel::Conductor { k, .. }, .. }) => Value::Color(k),
        ("sigma", Model::OrenNayar { sigma, .. }) => Value::Number(degrees(sigma)),
        ("form", Model::OrenNayar { full, .. }) => {
            Value::Word(if full { "full" } else { "qualitative" })
        }
        ("roughness_x", Model::Ward { roughness_x, .. }) => number(roughness_x),
        ("roughness_y", Model::Ward { roughness_x, roughness_y, .. })
            if roughness_y != roughness_x =>
        {
            number(roughness_y)
        }
        ("form", Model::Ward { form, .. }) => Value::Word(match form {
            WardForm::Ward => "ward",
            WardForm::Gmd => "gmd",
        }),
        _ => return None,
    })
}

/// The shape's own keys; those of meshes, points, cylinders and instances name files and groups.
pub(super) fn shape(shape: &Shape, key: &str) -> Option<Value> {
    use Shape::{Box, Cone, Cylinder, Disc, Plane, Sphere, Torus, Triangle};
    Some(match (key, shape) {
        ("center", Sphere { center, .. } | Disc { center, .. } | Torus { center, .. }) => {
            Value::Vector(*center)
        }
        (
            "radius",
            Sphere { radius, .. }
            | Disc { radius, .. }
            | Cylinder { radius, .. }
            | Cone { radius, .. }
            | Torus { radius, .. },
        ) => Value::Number(*radius),
        ("point", Plane { point, .. }) => Value::Vector(*point),
        ("normal", Plane { normal, .. } | Disc { normal, .. }) => Value::Vector(*normal),
        ("points", Triangle { points, .. }) => Value::Vectors(*points),
        ("normals", Triangle { normals, .. }) => Value::Vectors((*normals)?),
        ("uv", Triangle { uv, .. }) => Value::Uvs((*uv)?),
        ("min", Box { min, .. }) => Value::Vector(*min),
        ("max", Box { max, .. }) => Value::Vector(*max),
        ("from", Cylinder { from, .. } | Cone { from, .. }) => Value::Vector(*from),
        ("to", Cylinder { to, .. } | Cone { to, .. }) => Value::Vector(*to),
        ("radius_to", Cone { radius_to, .. }) => Value::Number(*radius_to),
        ("capped", Cylinder { capped, .. } | Cone { capped, .. }) => Value::Flag(*capped),
        ("axis", Torus { axis, .. }) => Value::Vector(*axis),
        ("tube", Torus { tube, .. }) => Value::Number(*tube),
        ("caps", Shape::Cylinders(cylinders)) => Value::Word(cylinders.caps.word()),
        ("smooth", Shape::Mesh(mesh)) if mesh.normals.is_empty() => Value::Flag(false),
        _ => return None,
    })
}

/// Where a shape is placed: a scale and a shift where they give these very numbers, else the
/// matrix, since no rotation need come back to them.
pub(super) fn placed(transform: &DAffine3, key: &str) -> Option<Value> {
    let m = transform.matrix3;
    let scale = DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z);
    let plain = m == DMat3::from_diagonal(scale);
    match key {
        "scale" if plain && scale != DVec3::ONE => Some(Value::Vector(scale)),
        "translate" if plain => Some(Value::Vector(transform.translation)),
        "matrix" if !plain => Some(Value::Matrix(*transform)),
        _ => None,
    }
}

/// A name, where it is not the one that the reader would give.
pub(super) fn name(name: &str, default: &str) -> Option<Value> {
    (name != default && !name.is_empty()).then(|| Value::Text(name.to_owned()))
}
