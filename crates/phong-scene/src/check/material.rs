//! Materials.

use super::fault::Faults;
use super::value::values;
use crate::color::Rgb;
use crate::limits::LARGEST;
use crate::material::{Distribution, Fresnel, Material, Model};
use crate::texture::Texture;

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
    facets(fresnel, faults);
}

fn facets(fresnel: Fresnel, faults: &mut Faults) {
    let index = |eta: Rgb, faults: &mut Faults| {
        if faults.color("eta", eta, LARGEST) && eta.to_array().contains(&0.0) {
            faults.say("eta", "`eta` must be above 0");
        }
    };
    match fresnel {
        Fresnel::None => {}
        Fresnel::Schlick { f0 } => {
            faults.color("f0", f0, 1.0);
        }
        Fresnel::Dielectric { eta } => index(Rgb::grey(eta), faults),
        Fresnel::Conductor { eta, k } => {
            index(eta, faults);
            faults.color("k", k, LARGEST);
        }
    }
}
