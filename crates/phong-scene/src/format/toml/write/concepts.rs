//! What each concept says to the keys whose value is more than that of a field.
//!
//! `None` is a key that is not written: its default is meant, or it does not apply.

use glam::{DAffine3, DMat3, DVec3};

use crate::clip::{Cap, Clip};
use crate::color::Rgb;
use crate::keys::{Field, Key, Keyed, Stored, Value};
use crate::light::{Light, LightKind};
use crate::material::{Dialect, Fresnel, Material, Model};
use crate::shape::Shape;
use crate::texture::Texture;

/// `number` counts the scene's lights from 1.
pub(super) fn light(light: &Light, number: usize, key: &Key) -> Option<Value> {
    match (key.name, light.kind) {
        ("name", _) => name(&light.name, &format!("light {number}")),
        ("edge", LightKind::Spot { cone, edge, .. }) if edge == cone => None,
        ("specular_color", _) if light.specular_color == light.color => None,
        _ => key.get(light),
    }
}

/// `cap` is the name of the material of its cap, if it names one.
pub(super) fn clip(clip: &Clip, cap: Option<&str>, key: &Key) -> Option<Value> {
    match key.name {
        "cap" if clip.cap == Cap::Open => Some(Value::Flag(false)),
        "cap" => cap.map(|name| Value::Text(name.to_owned())),
        "objects" if clip.objects.is_empty() => None,
        "objects" => {
            Some(Value::Texts(clip.objects.iter().map(|name| (name.clone(), 0..0)).collect()))
        }
        _ => key.get(clip),
    }
}

pub(super) fn texture(texture: &Texture, key: &Key) -> Option<Value> {
    if !matches!(key.field, Field::None) {
        return key.get(texture);
    }
    let table = texture.table();
    let scale = table.find("scale", table.word_of(texture));
    // Where `scale` is the kind's own, any other one is in the matrix.
    if scale.is_some_and(|scale| !matches!(scale.field, Field::None)) && !is_shift(texture) {
        return (key.name == "matrix").then_some(Value::Matrix(texture.transform));
    }
    placed(&texture.transform, key.name)
}

fn is_shift(texture: &Texture) -> bool {
    texture.transform.matrix3 == DMat3::IDENTITY
}

pub(super) fn material(m: &Material, key: &Key) -> Option<Value> {
    match (key.name, m.model) {
        // Of three.js, `k_s` being 1.
        ("specular_color", Model::Microfacet { fresnel: Fresnel::Schlick { f0 }, .. })
            if m.dialect == Dialect::ThreeJs =>
        {
            f0.value()
        }
        ("fresnel", _) if m.fresnel != m.transmission.is_black() => None,
        ("times_cosine" | "normalize" | "tint" | "ambient_rule" | "viewer", _)
            if key.get(m) == key.get(&plain(m.dialect)) =>
        {
            None
        }
        ("f0", _) if key.get(m) == Rgb::grey(0.04).value() => None,
        ("roughness_y", Model::Ward { roughness_x, roughness_y, .. })
            if roughness_y == roughness_x =>
        {
            None
        }
        _ => key.get(m),
    }
}

/// A material with nothing but the switches of a dialect.
fn plain(dialect: Dialect) -> Material {
    let preset = dialect.switches();
    Material {
        times_cosine: preset.times_cosine,
        normalize: preset.normalize,
        tint: preset.tint,
        ambient_rule: preset.ambient_rule,
        viewer: preset.viewer,
        ..Material::default()
    }
}

/// The shape's own keys; those of files and groups, and where it is placed, are the object's.
pub(super) fn shape(shape: &Shape, key: &Key) -> Option<Value> {
    match (key.name, shape) {
        ("smooth", Shape::Mesh(mesh)) if mesh.normals.is_empty() => Some(Value::Flag(false)),
        _ => key.get(shape),
    }
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
