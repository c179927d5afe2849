//! Materials as glTF has them: metallic and rough.

use serde_json::{Map, Value, json};

use crate::color::Rgb;
use crate::format::export::Account;
use crate::format::export::flat::warning;
use crate::format::facets::of_exponent;
use crate::material::{ConstantMaterial, Distribution, Fresnel, Material, Model};
use crate::wording::Word;

/// The material, and the extensions that it needs. Its own numbers are in `extras`.
pub(super) fn surface(material: &Material, account: &mut Account) -> (Value, Vec<&'static str>) {
    for (key, _) in material.textured() {
        let message =
            format!("material `{}`: the texture of `{key}`, for which 0.5 stands", material.name);
        account.drop(warning(message, &material.place));
    }
    let m = &material.at(|_| Rgb::grey(0.5));
    let (roughness, how) = roughness(m);
    if let Some(how) = how {
        account.map(format!("material `{}`: {how}, roughness {roughness}", m.name));
    }
    let mut used = Vec::new();
    let mut extensions = Map::new();
    let metal = is_metal(m);
    let Rgb { r, g, b } = base_color(m);
    let opacity = 1.0 - mean(m.transmission).clamp(0.0, 1.0);
    let straight = m.ior == 1.0;
    let alpha = if straight { opacity } else { 1.0 };
    let mut value = json!({
        "name": m.name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [r.min(1.0), g.min(1.0), b.min(1.0), alpha],
            "metallicFactor": if metal { 1.0 } else { 0.0 },
            "roughnessFactor": roughness,
        },
        "doubleSided": true,
        "extras": { "phong": extras(m, material.model.word()) },
    });
    if alpha < 1.0 {
        value["alphaMode"] = json!("BLEND");
    }
    if opacity < 1.0 && !straight {
        used.extend(["KHR_materials_transmission", "KHR_materials_ior"]);
        extensions.insert(
            "KHR_materials_transmission".into(),
            json!({ "transmissionFactor": 1.0 - opacity }),
        );
        extensions.insert("KHR_materials_ior".into(), json!({ "ior": m.ior.max(1.0) }));
    }
    let glow = m.emission_color.unwrap_or(m.color) * m.k_e;
    let most = glow.max_channel();
    if most > 0.0 {
        let Rgb { r, g, b } = glow / most.max(1.0);
        value["emissiveFactor"] = json!([r, g, b]);
        if most > 1.0 {
            used.push("KHR_materials_emissive_strength");
            extensions.insert(
                "KHR_materials_emissive_strength".into(),
                json!({ "emissiveStrength": most }),
            );
        }
    }
    if !extensions.is_empty() {
        value["extensions"] = Value::Object(extensions);
    }
    (value, used)
}

fn mean(Rgb { r, g, b }: Rgb) -> f32 {
    (r + g + b) / 3.0
}

/// Whether nothing is scattered, and the highlight has a colour.
fn is_metal(m: &ConstantMaterial) -> bool {
    (m.k_d == 0.0 || m.color.is_black()) && m.k_s > 0.0
}

/// What a metal mirrors, and what others scatter.
pub(super) fn base_color(m: &ConstantMaterial) -> Rgb {
    match m.model {
        Model::Microfacet { fresnel: Fresnel::Schlick { f0 }, .. } if is_metal(m) => f0,
        _ if is_metal(m) => m.specular_color.unwrap_or(m.color) * m.k_s,
        _ => m.color * m.k_d,
    }
}

/// The roughness of which α is the square, and by which formula.
fn roughness(m: &ConstantMaterial) -> (f32, Option<&'static str>) {
    match m.model {
        _ if m.k_s == 0.0 => (1.0, None),
        Model::Phong => {
            (of_exponent(4.0 * m.shininess), Some("(R·E)^n becomes GGX with α² = 2/(4n + 2)"))
        }
        Model::BlinnPhong | Model::BlinnFast => {
            (of_exponent(m.shininess), Some("(N·H)^n becomes GGX with α² = 2/(n + 2)"))
        }
        Model::Microfacet { distribution: Distribution::Blinn, roughness, .. } => {
            (of_exponent(roughness), Some("Blinn's facets become GGX with α² = 2/(n + 2)"))
        }
        Model::Microfacet { roughness, distribution, .. } => {
            let how = (distribution != Distribution::Ggx).then_some("Beckmann's m becomes GGX's α");
            (roughness.sqrt().min(1.0), how)
        }
        Model::Ward { roughness_x, roughness_y, .. } => (
            (roughness_x * roughness_y).sqrt().sqrt().min(1.0),
            Some("Ward's lobe becomes GGX with α² = α_x α_y"),
        ),
        Model::Lambert | Model::OrenNayar { .. } => (1.0, None),
    }
}

/// The material's own numbers.
fn extras(m: &ConstantMaterial, model: &str) -> Value {
    let rgb = |Rgb { r, g, b }: Rgb| json!([r, g, b]);
    json!({
        "model": model,
        "color": rgb(m.color),
        "k_a": m.k_a,
        "k_d": m.k_d,
        "k_s": m.k_s,
        "shininess": m.shininess,
        "reflection": rgb(m.reflection),
        "transmission": rgb(m.transmission),
        "ior": m.ior,
    })
}
