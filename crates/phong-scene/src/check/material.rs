//! Materials.

use super::fault::Faults;
use super::value::values;
use crate::color::Rgb;
use crate::material::{Distribution, Fresnel, Material, Model};
use crate::texture::{Param, Texture, TextureRef, Textured};

/// Judges a material. What it takes from textures is held against the values of `textures`, the
/// scene's; `None`: they are not known yet, and that is left out.
pub(crate) fn material(material: &Material, textures: Option<&[Texture]>, faults: &mut Faults) {
    values(material, textures, faults);
    if !material.dialect.allows(&material.model) {
        let message = format!("the dialect `{}` contradicts the model", material.dialect.name());
        faults.say("dialect", message);
    }
    let Model::Microfacet { distribution, roughness, fresnel, .. } = material.model else { return };
    if distribution == Distribution::Blinn && roughness.constant() == Some(0.0) {
        faults.say("shininess", "`shininess` must be above 0 for facets");
    }
    if can_be_zero(fresnel, textures.unwrap_or_default()) {
        faults.say("eta", "`eta` must be above 0");
    }
}

/// Whether an index of refraction is 0 in any channel, or is where one of the textures says so.
fn can_be_zero(fresnel: Fresnel, textures: &[Texture]) -> bool {
    let values = |by: TextureRef| {
        let texture = textures.get(by.texture.0 as usize);
        texture.map(|texture| texture.values(by.channel)).unwrap_or_default()
    };
    match fresnel {
        Fresnel::None | Fresnel::Schlick { .. } => false,
        Fresnel::Dielectric { eta: Param::Constant(eta) } => eta == 0.0,
        Fresnel::Dielectric { eta: Param::Textured(by) } => {
            values(by).into_iter().any(|value| f32::of(value, &by) == 0.0)
        }
        Fresnel::Conductor { eta: Param::Constant(eta), .. } => eta.to_array().contains(&0.0),
        Fresnel::Conductor { eta: Param::Textured(by), .. } => {
            values(by).into_iter().any(|value| Rgb::of(value, &by).to_array().contains(&0.0))
        }
    }
}
