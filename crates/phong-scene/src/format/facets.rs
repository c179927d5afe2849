//! Metallic and rough surfaces, as glTF and other formats have them, as microfacets.

use crate::color::Rgb;
use crate::material::{ConstantMaterial, Distribution, Fresnel, Material, Model, Shadowing};
use crate::texels::{TexelValues, Texels, TexelsError};
use crate::texture::TextureRef;

/// The least width of a highlight: one of nothing would not be seen in the light of a point.
const LEAST_ALPHA: f64 = 1e-3;

/// The weight of ambient light; and how much more metals have, in place of what they would mirror.
const AMBIENT: [f32; 2] = [0.1, 0.3];

/// Reflectance at normal incidence of what is no metal, where the file does not say it.
pub(super) const F0: Rgb = Rgb::grey(0.04);

/// The α of facets of that roughness.
pub(super) fn width(roughness: f64) -> f64 {
    (roughness * roughness).max(LEAST_ALPHA)
}

/// The roughness of facets about as wide as `(N·H)^n`, by α² = 2/(n + 2).
pub(super) fn of_exponent(n: f32) -> f32 {
    (2.0 / (n + 2.0)).sqrt().sqrt()
}

/// Reflectance at normal incidence of a dielectric of that index of refraction.
pub(super) fn reflectance(index: f64) -> Rgb {
    let r = (index - 1.0) / (index + 1.0);
    Rgb::grey((r * r) as f32)
}

/// The weight of ambient light of what is metal to this share.
pub(super) fn ambient(metal: f32) -> f32 {
    AMBIENT[0] + AMBIENT[1] * metal
}

/// What a surface scatters that is metal to this share, and what it mirrors at normal incidence.
pub(super) fn parted(base: Rgb, metal: f64, dielectric: Rgb) -> [Rgb; 2] {
    let (metal, other) = (metal as f32, (1.0 - metal) as f32);
    [base * other, dielectric * other + base * metal]
}

/// Microfacets over a diffuse base, which metals have none of.
pub(super) fn microfacets(
    base: Rgb,
    [metal, roughness]: [f64; 2],
    dielectric: Rgb,
) -> ConstantMaterial {
    let [color, f0] = parted(base, metal, dielectric);
    ConstantMaterial {
        model: Model::Microfacet {
            distribution: Distribution::Ggx,
            roughness: width(roughness) as f32,
            shadowing: Shadowing::Correlated,
            fresnel: Fresnel::Schlick { f0: f0.map(|c| c.clamp(0.0, 1.0)) },
        },
        color,
        ambient_color: Some(base),
        specular_color: Some(Rgb::WHITE),
        k_a: ambient(metal as f32),
        k_d: 1.0,
        k_s: 1.0,
        ..ConstantMaterial::default()
    }
}

/// Images in place of what a surface scatters and of what it mirrors, which then has that colour at every angle.
pub(super) fn imaged(material: &mut Material, scattered: TextureRef, mirrored: Option<TextureRef>) {
    material.color = scattered.into();
    if let Some(mirrored) = mirrored {
        material.specular_color = Some(mirrored.into());
        if let Model::Microfacet { fresnel, .. } = &mut material.model {
            *fresnel = Fresnel::None;
        }
    }
}

/// How much a surface mirrors of an image of its base colour.
pub(super) fn mirrored(metal: f64, dielectric: Rgb) -> f32 {
    let metal = metal as f32;
    metal + (1.0 - metal) * dielectric.max_channel()
}

/// A number for each pixel of an image, as 16-bit numbers.
pub(super) fn numbers(
    texels: &Texels,
    value: impl Fn([f32; 4]) -> f64,
) -> Result<Texels, TexelsError> {
    let [width, height] = texels.size();
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let short = |at| (value(texels.get(at, false)).clamp(0.0, 1.0) * 65535.0 + 0.5) as u16;
    Texels::new([width, height], 1, TexelValues::Shorts(pixels.map(short).collect()))
}

/// The colours of an image, each made anew by what another image has there, as floats.
pub(super) fn mixed(
    base: &Texels,
    other: &Texels,
    value: impl Fn([f32; 4], [f32; 4]) -> Rgb,
) -> Result<Texels, TexelsError> {
    let [width, height] = base.size();
    let [w, h] = other.size();
    let there =
        |i: u32, count: u32, of: u32| (u64::from(i) * u64::from(of) / u64::from(count)) as u32;
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let color = |[x, y]: [u32; 2]| {
        let beside = other.get([there(x, width, w), there(y, height, h)], false);
        value(base.get([x, y], true), beside).to_array()
    };
    Texels::new([width, height], 3, TexelValues::Floats(pixels.flat_map(color).collect()))
}
