//! Materials: metallic and rough ones as microfacets.

use std::sync::Arc;

use super::buffer::Buffers;
use super::images::{Images, Made, Named};
use super::json::{At, Result};
use crate::color::Rgb;
use crate::diagnostic::Place;
use crate::format::facets::{
    F0, ambient, imaged, microfacets, mirrored, mixed, numbers, parted, reflectance, width,
};
use crate::format::text::{Findings, whole};
use crate::material::{Fresnel, Material, Model, OpacityMode, VertexColors};
use crate::texture::{Channel, TextureRef};

/// What a material takes whose colour is an image that cannot be read.
const GREY: f64 = 0.8;

/// Microfacets over a diffuse base, which metals have none of.
fn surface(base: [f64; 3], metallic: f64, roughness: f64, dielectric: Rgb) -> Material {
    let base = Rgb::from(base.map(|c| c as f32));
    microfacets(base, [metallic, roughness], dielectric).into()
}

/// Makes colours of vertices multiply the base colour of a material that is everywhere as metallic as `even`
/// says; `None`: as an image says, where they multiply what is scattered alone.
///
/// The weights then hold how metallic it is, so that what is scattered, mirrored and ambient has one colour.
fn follow_vertices(material: &mut Material, even: Option<f64>, f0: Rgb) {
    material.vertex_colors = VertexColors::Multiply;
    let (Some(metal), Some(base)) = (even, material.ambient_color) else { return };
    (material.color, material.ambient_color) = (base, None);
    if metal > 0.0 {
        let scattered = |k_d: f32| (k_d * (1.0 - metal) as f32).into();
        material.k_d = material.k_d.constant().map_or(material.k_d, scattered);
        material.k_s = mirrored(metal, f0).into();
        material.specular_color = None;
        if let Model::Microfacet { fresnel, .. } = &mut material.model {
            *fresnel = Fresnel::None;
        }
    }
}

/// Reads one material, with the set of texture coordinates that its images lie in. What of it is not drawn is told.
///
/// One whose vertices are `colored` is no metal unless it says so: most that do not are coloured scans, of which
/// nothing but what is mirrored would be seen.
pub(super) fn read(
    (at, colored): (&At<'_>, bool),
    drawn: &mut Images<'_>,
    from: (&Buffers, &Arc<str>),
    findings: &mut Findings,
) -> Result<(Material, u64)> {
    let (_, file) = from;
    let name = at.name("material");
    let unit = |value: f64| value.clamp(0.0, 1.0);
    let mut images = Vec::new();
    let mut image = |of: &At<'_>, key: &str| images.extend(of.get(key).map(|_| key.to_owned()));
    let mut base = [1.0, 1.0, 1.0, 1.0];
    let (mut metallic, mut roughness) = (1.0, 1.0);
    let mut maps = Maps::default();
    let mut says_metal = false;
    // Whether the colour is an image that cannot be read.
    let mut lost = false;
    if let Some(pbr) = at.get("pbrMetallicRoughness") {
        base = pbr.numbers_or("baseColorFactor", base)?;
        says_metal |= pbr.get("metallicFactor").is_some();
        metallic = pbr.number_or("metallicFactor", 1.0)?;
        roughness = pbr.number_or("roughnessFactor", 1.0)?;
        maps.base = drawn.named(&pbr, "baseColorTexture", from, findings);
        maps.facets = drawn.named(&pbr, "metallicRoughnessTexture", from, findings);
        lost = maps.base.is_none() && pbr.get("baseColorTexture").is_some();
    }
    maps.normal = drawn.named(at, "normalTexture", from, findings);
    maps.occlusion = drawn.named(at, "occlusionTexture", from, findings);
    maps.emissive = drawn.named(at, "emissiveTexture", from, findings);
    let mut f0 = F0;
    if let Some(ior) = at.extension("KHR_materials_ior") {
        let n = ior.number_or("ior", 1.5)?;
        // 0 stands for infinite: everything is reflected.
        f0 = if n <= 0.0 { Rgb::WHITE } else { reflectance(n) };
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
        maps.base = drawn.named(&glossy, "diffuseTexture", from, findings);
        maps.facets = None;
        lost = maps.base.is_none() && glossy.get("diffuseTexture").is_some();
        image(&glossy, "specularGlossinessTexture");
    }
    let is_unlit = at.extension("KHR_materials_unlit").is_some();
    if is_unlit || colored && !says_metal && maps.base.is_none() && maps.facets.is_none() {
        metallic = 0.0;
    }
    let [r, g, b, alpha] = base.map(|c| if c < 0.0 { 0.0 } else { c });
    let white = lost && [r, g, b] == [1.0; 3];
    let [r, g, b] = if white { [GREY; 3] } else { [r, g, b] };
    let mut material = surface([r, g, b], unit(metallic), unit(roughness), f0);
    let mut shown = 1.0;
    let mode = at.get("alphaMode").map_or(Ok("OPAQUE"), |mode| mode.text())?;
    // Where an image says it, each place has an opacity of its own.
    if mode == "BLEND" && maps.base.is_none() {
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
    material.k_d = shown.into();
    material.k_a = (shown * ambient(unit(metallic) as f32)).into();
    // Light goes straight on: surfaces are thin unless an extension that is not read says otherwise.
    material.transmission = through.into();
    material.ior = 1.0.into();
    material.fresnel = false;
    if !glow.is_black() {
        (material.k_e, material.emission_color) = (1.0.into(), Some(glow.into()));
    }
    if is_unlit {
        // The base colour as it is, whatever the light.
        material.color = Rgb::from([r, g, b].map(|c| c as f32)).into();
        material.ambient_color = None;
        material.model = Model::Lambert;
        (material.k_a, material.k_d, material.k_s) = (0.0.into(), 0.0.into(), 0.0.into());
        (material.k_e, material.emission_color) = (shown.into(), None);
    }
    material.name.clone_from(&name);
    material.place = Place { file: Arc::clone(file), ..Place::default() };
    let factors = ([r, g, b, alpha], [unit(metallic), unit(roughness)], f0);
    let set = drawn.set(file, findings);
    let even = maps.put(at, mode, (&mut material, factors), (drawn, findings))?;
    if colored {
        if even.is_none() {
            findings.warning(
                "colours of vertices",
                || whole(file),
                || {
                    format!(
                        "{}: an image says how metallic it is: colours of vertices tint what is scattered alone (material `{name}`)",
                        at.pointer
                    )
                },
            );
        }
        follow_vertices(&mut material, even, f0);
    }
    if !images.is_empty() {
        let names = images.iter().map(String::as_str);
        let names = crate::wording::list(names, ",");
        findings.warning(
            "materials with images",
            || whole(file),
            || format!("{}: images that are not drawn: {names} (material `{name}`)", at.pointer),
        );
    }
    Ok((material, set))
}

/// The images that a material names and that could be read.
#[derive(Debug, Default)]
struct Maps {
    base: Option<Named>,
    /// Green the roughness, blue how metallic it is.
    facets: Option<Named>,
    normal: Option<Named>,
    occlusion: Option<Named>,
    emissive: Option<Named>,
}

impl Maps {
    /// Puts them in place of the material's own values. How metallic it is everywhere; `None`: as an image says.
    fn put(
        self,
        at: &At<'_>,
        mode: &str,
        (material, (base, [metallic, roughness], f0)): (&mut Material, ([f64; 4], [f64; 2], Rgb)),
        (images, findings): (&mut Images<'_>, &mut Findings),
    ) -> Result<Option<f64>> {
        let [r, g, b, alpha] = base.map(|c| c as f32);
        let base_color = Rgb::new(r, g, b);
        let (name, place) = (material.name.clone(), material.place.clone());
        let is_unlit = matches!(material.model, Model::Lambert);
        // How metallic it is everywhere, if it is everywhere the same.
        let mut even = Some(metallic);
        if let Some(facets) = self.facets.as_ref().filter(|_| !is_unlit) {
            let mut tell = |message: String| {
                findings.warning(
                    "materials with images",
                    || whole(&place.file),
                    || format!("{}: {message} (material `{name}`)", at.pointer),
                );
            };
            let (of, size) = (vec![facets.image], facets.texels.size());
            let of = Made { what: "roughness", images: of, factors: vec![roughness.to_bits()] };
            let alpha = |[_, green, ..]: [f32; 4]| width(f64::from(green) * roughness);
            match images.made(of, (size, 2), || numbers(&facets.texels, alpha)) {
                Ok(texels) => {
                    let named = (name.as_str(), "roughness");
                    let by = images.texture(&facets.with(texels), Rgb::WHITE, named, &place);
                    if let Model::Microfacet { roughness, .. } = &mut material.model {
                        *roughness = by.into();
                    }
                }
                Err(why) => tell(format!("the image of roughness is left out: {why}")),
            }
            let [least, most] = facets.texels.bounds(false).map(|bound| f64::from(bound[2]));
            let mean = if least == most || metallic == 0.0 {
                metallic * most
            } else {
                metallic * f64::from(images.mean(facets)[2])
            };
            even = (least == most || metallic == 0.0).then_some(mean);
            if let Some(k_a) = material.k_a.constant() {
                // What is ambient has one weight everywhere: that of the mean.
                material.k_a = (k_a * ambient(mean as f32) / ambient(metallic as f32)).into();
            }
            // An image of one pixel lies everywhere alike.
            let lies = |base: &Named| base.texels.size() == [1, 1] || base.lies_as(facets);
            if even.is_none() && self.base.as_ref().is_some_and(|base| !lies(base)) {
                tell(
                    "its images of colour and of metal lie differently, so that it is \
                      everywhere as metallic as the mean"
                        .to_owned(),
                );
                even = Some(mean);
            }
            if even.is_none() {
                // The share of metal varies: it is put into the colours of both terms.
                let base = self.base.as_ref().filter(|base| base.texels.size() != [1, 1]);
                let flat = match &self.base {
                    Some(base) if base.texels.size() == [1, 1] => base.texels.get([0, 0], true),
                    _ => [1.0; 4],
                };
                let flat = base.is_none().then_some(flat);
                let larger = base.unwrap_or(facets);
                let metal = |other: [f32; 4]| other[2] * metallic as f32;
                let of = |c: [f32; 4]| {
                    let [r, g, b, _] = flat.unwrap_or(c);
                    Rgb::new(r, g, b) * base_color
                };
                let mut made = |what, of: &dyn Fn([f32; 4], [f32; 4]) -> Rgb| {
                    let numbers = self.base.iter().chain([facets]).map(|named| named.image);
                    let colors = base_color.to_array().into_iter().chain(f0.to_array());
                    let factors = colors.map(f64::from).chain([metallic]).map(f64::to_bits);
                    let (numbers, factors) = (numbers.collect(), factors.collect());
                    let from = Made { what, images: numbers, factors };
                    let make = || mixed(&larger.texels, &facets.texels, of);
                    images.made(from, (larger.texels.size(), 12), make)
                };
                let parts = |c, other| parted(of(c), metal(other).into(), f0);
                let diffuse = made("diffuse", &|c, other| parts(c, other)[0]);
                let specular = made("specular", &|c, other| parts(c, other)[1]);
                match diffuse.and_then(|diffuse| Ok((diffuse, specular?))) {
                    Ok((diffuse, specular)) => {
                        let mut texture = |texels, key| {
                            let named = (name.as_str(), key);
                            images.texture(&larger.with(texels), Rgb::WHITE, named, &place)
                        };
                        let diffuse = texture(diffuse, "diffuse");
                        imaged(material, diffuse, Some(texture(specular, "specular")));
                    }
                    Err(why) => {
                        tell(format!("it is everywhere as metallic as the mean: {why}"));
                        even = Some(mean);
                    }
                }
            }
        }
        let mut texture =
            |named: &Named, tint: Rgb, key: &str| images.texture(named, tint, (&name, key), &place);
        if let Some(normal) = &self.normal {
            let by = texture(normal, Rgb::WHITE, "normal");
            let scale = at.need("normalTexture")?.number_or("scale", 1.0)? as f32;
            material.normal = Some(TextureRef { scale, ..by });
        }
        if let Some(metal) = even.filter(|_| self.facets.is_some() && !is_unlit) {
            let [diffuse, f0] = parted(base_color, metal, f0);
            material.color = diffuse.into();
            if let Model::Microfacet { fresnel, .. } = &mut material.model {
                *fresnel = Fresnel::Schlick { f0: f0.map(|c| c.clamp(0.0, 1.0)).into() };
            }
        }
        if let Some(base) = &self.base {
            let by = texture(base, base_color, "base color");
            material.ambient_color = (!is_unlit).then(|| by.into());
            if let Some(metal) = even {
                let diffuse = base_color * (1.0 - metal) as f32;
                let diffuse = texture(base, diffuse, "color");
                let is_metal = metal > 0.0 && !is_unlit;
                imaged(material, diffuse, is_metal.then(|| texture(base, base_color, "metal")));
                if is_metal {
                    material.k_s = mirrored(metal, f0).into();
                }
            }
            let opacity = TextureRef { scale: alpha.min(1.0), channel: Some(Channel::Alpha), ..by };
            if mode == "BLEND" || mode == "MASK" {
                material.opacity = opacity.into();
            }
        }
        if mode == "MASK" {
            material.opacity_mode = OpacityMode::Mask;
            material.cutoff = at.number_or("alphaCutoff", 0.5)?.clamp(0.0, 1.0) as f32;
            if self.base.is_none() {
                material.opacity = alpha.clamp(0.0, 1.0).into();
            }
        }
        if let (Some(occlusion), Some(k_a)) = (&self.occlusion, material.k_a.constant()) {
            let strength = at.need("occlusionTexture")?.number_or("strength", 1.0)?;
            let strength = strength.clamp(0.0, 1.0) as f32;
            let by = texture(occlusion, Rgb::WHITE, "occlusion");
            let (scale, offset) = (k_a * strength, k_a * (1.0 - strength));
            material.k_a = TextureRef { scale, offset, ..by }.into();
        }
        let glow = material.emission_color.and_then(crate::texture::Param::constant);
        if let (Some(emissive), Some(glow)) = (&self.emissive, glow) {
            material.emission_color = Some(texture(emissive, glow, "emission").into());
        }
        Ok(even)
    }
}
