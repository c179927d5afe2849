//! Materials: metallic and rough ones as microfacets.

use std::sync::Arc;

use super::json::{At, Result};
use crate::color::Rgb;
use crate::diagnostic::Place;
use crate::format::text::{Findings, whole};
use crate::material::{ConstantMaterial, Distribution, Fresnel, Material, Model, Shadowing};

/// The least width of a highlight: one of nothing would not be seen in the light of a point.
const LEAST_ALPHA: f64 = 1e-3;

/// The weight of ambient light; and how much more metals have, in place of what they would mirror.
const AMBIENT: [f32; 2] = [0.1, 0.3];

/// Reflectance at normal incidence of what is no metal, where the file does not say it.
const F0: f64 = 0.04;

/// What a material does to primitives, besides being theirs.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub(super) material: Material,
    /// What colours of vertices are multiplied by: they replace the material's.
    pub(super) color: Rgb,
}

/// The material that a primitive has which names none.
pub(super) fn plain() -> Surface {
    surface([1.0; 3], 1.0, 1.0, Rgb::grey(F0 as f32))
}

/// Microfacets over a diffuse base, which metals have none of.
fn surface(base: [f64; 3], metallic: f64, roughness: f64, dielectric: Rgb) -> Surface {
    let rgb = |channel: fn(f64) -> f64| Rgb::from(base.map(|c| channel(c) as f32));
    let base_color = rgb(|c| c);
    let (metal, other) = (metallic as f32, (1.0 - metallic) as f32);
    let color = base_color * other;
    let f0 = dielectric * other + base_color * metal;
    let material = ConstantMaterial {
        model: Model::Microfacet {
            distribution: Distribution::Ggx,
            roughness: (roughness * roughness).max(LEAST_ALPHA) as f32,
            shadowing: Shadowing::Correlated,
            fresnel: Fresnel::Schlick { f0: f0.map(|c| c.clamp(0.0, 1.0)) },
        },
        color,
        ambient_color: Some(base_color),
        specular_color: Some(Rgb::WHITE),
        k_a: AMBIENT[0] + AMBIENT[1] * metal,
        k_d: 1.0,
        k_s: 1.0,
        ..ConstantMaterial::default()
    };
    Surface { material: material.into(), color }
}

/// Reads one material. What of it is not drawn is told.
pub(super) fn read(at: &At<'_>, file: &Arc<str>, findings: &mut Findings) -> Result<Surface> {
    let name = at.name("material");
    let unit = |value: f64| value.clamp(0.0, 1.0);
    let mut images = Vec::new();
    let mut image = |of: &At<'_>, key: &str| images.extend(of.get(key).map(|_| key.to_owned()));
    let mut base = [1.0, 1.0, 1.0, 1.0];
    let (mut metallic, mut roughness) = (1.0, 1.0);
    if let Some(pbr) = at.get("pbrMetallicRoughness") {
        base = pbr.numbers_or("baseColorFactor", base)?;
        metallic = pbr.number_or("metallicFactor", 1.0)?;
        roughness = pbr.number_or("roughnessFactor", 1.0)?;
        image(&pbr, "baseColorTexture");
        image(&pbr, "metallicRoughnessTexture");
    }
    for key in ["normalTexture", "occlusionTexture", "emissiveTexture"] {
        image(at, key);
    }
    let mut f0 = Rgb::grey(F0 as f32);
    if let Some(ior) = at.extension("KHR_materials_ior") {
        let n = ior.number_or("ior", 1.5)?;
        // 0 stands for infinite: everything is reflected.
        let r = if n <= 0.0 { 1.0 } else { (n - 1.0) / (n + 1.0) };
        f0 = Rgb::grey((r * r) as f32);
    }
    if let Some(specular) = at.extension("KHR_materials_specular") {
        let weight = unit(specular.number_or("specularFactor", 1.0)?) as f32;
        let tint: [f64; 3] = specular.numbers_or("specularColorFactor", [1.0; 3])?;
        let [r, g, b] = tint.map(|c| c as f32);
        f0 = (f0 * Rgb::new(r, g, b)).map(|c| c.clamp(0.0, 1.0)) * weight;
        image(&specular, "specularTexture");
        image(&specular, "specularColorTexture");
    }
    if let Some(glossy) = at.extension("KHR_materials_pbrSpecularGlossiness") {
        base = glossy.numbers_or("diffuseFactor", [1.0; 4])?;
        let specular: [f64; 3] = glossy.numbers_or("specularFactor", [1.0; 3])?;
        f0 = Rgb::from(specular.map(|c| c as f32));
        metallic = 0.0;
        roughness = 1.0 - unit(glossy.number_or("glossinessFactor", 1.0)?);
        image(&glossy, "diffuseTexture");
        image(&glossy, "specularGlossinessTexture");
    }
    let [r, g, b, alpha] = base.map(|c| if c < 0.0 { 0.0 } else { c });
    let mut surface = surface([r, g, b], unit(metallic), unit(roughness), f0);
    let mut shown = 1.0;
    if at.get("alphaMode").map_or(Ok("OPAQUE"), |mode| mode.text())? == "BLEND" {
        shown = unit(alpha) as f32;
    }
    let mut through = Rgb::grey(1.0 - shown);
    if let Some(glass) = at.extension("KHR_materials_transmission") {
        let weight = unit(glass.number_or("transmissionFactor", 0.0)?) as f32;
        through += Rgb::from([r, g, b].map(|c| c as f32)) * (weight * shown);
        shown *= 1.0 - weight;
        image(&glass, "transmissionTexture");
    }
    let mut strength = 1.0;
    if let Some(emission) = at.extension("KHR_materials_emissive_strength") {
        strength = emission.number_or("emissiveStrength", 1.0)?;
    }
    let emissive: [f64; 3] = at.numbers_or("emissiveFactor", [0.0; 3])?;
    let glow = Rgb::from(emissive.map(|c| (c * strength).max(0.0) as f32));
    let material = &mut surface.material;
    material.k_d = shown.into();
    material.k_a = (shown * (AMBIENT[0] + AMBIENT[1] * unit(metallic) as f32)).into();
    // Light goes straight on: surfaces are thin unless an extension that is not read says otherwise.
    material.transmission = through.into();
    material.ior = 1.0;
    material.fresnel = false;
    if !glow.is_black() {
        (material.k_e, material.emission_color) = (1.0.into(), Some(glow.into()));
    }
    if at.extension("KHR_materials_unlit").is_some() {
        // The base colour as it is, whatever the light; vertices' own colours take its place.
        let color = Rgb::from([r, g, b].map(|c| c as f32));
        surface.color = color;
        material.color = color.into();
        material.model = Model::Lambert;
        (material.k_a, material.k_d, material.k_s) = (0.0.into(), 0.0.into(), 0.0.into());
        (material.k_e, material.emission_color) = (shown.into(), None);
    }
    material.name.clone_from(&name);
    material.place = Place { file: Arc::clone(file), ..Place::default() };
    if !images.is_empty() {
        let names = images.iter().map(String::as_str);
        let names = crate::wording::list(names, ",");
        findings.warning(
            "materials with images",
            || whole(file),
            || format!("{}: images are not drawn yet: {names} (material `{name}`)", at.pointer),
        );
    }
    Ok(surface)
}
