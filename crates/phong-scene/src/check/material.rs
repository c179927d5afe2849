//! Materials.

use super::fault::Faults;
use crate::color::Rgb;
use crate::limits::{LARGEST, Range};
use crate::material::{Distribution, Fresnel, Material, Model};

/// Judges a material.
pub(crate) fn material(material: &Material, faults: &mut Faults) {
    let m = material;
    let colors = [
        ("color", Some(m.color)),
        ("ambient_color", m.ambient_color),
        ("emission_color", m.emission_color),
        ("specular_color", m.specular_color),
        ("reflection", Some(m.reflection)),
        ("transmission", Some(m.transmission)),
    ];
    for (field, color) in colors {
        if let Some(color) = color {
            faults.color(field, color, LARGEST);
        }
    }
    for (field, number) in
        [("k_a", m.k_a), ("k_d", m.k_d), ("k_s", m.k_s), ("k_e", m.k_e), ("shininess", m.shininess)]
    {
        faults.number(field, number.into(), &Range::NOT_NEGATIVE);
    }
    faults.number("ior", m.ior.into(), &Material::IOR);
    if !m.dialect.allows(&m.model) {
        let message = format!("the dialect `{}` contradicts the model", m.dialect.name());
        faults.say("dialect", message);
    }
    match m.model {
        Model::Lambert | Model::Phong | Model::BlinnPhong | Model::BlinnFast => {}
        Model::Microfacet { distribution, roughness, fresnel, .. } => {
            if distribution == Distribution::Blinn {
                if roughness <= 0.0 {
                    faults.say("shininess", "`shininess` must be above 0 for facets");
                } else {
                    faults.number("shininess", roughness.into(), &Range::POSITIVE);
                }
            } else {
                faults.number("roughness", roughness.into(), &Model::ROUGHNESS);
            }
            facets(fresnel, faults);
        }
        Model::OrenNayar { sigma, .. } => {
            // What 90 degrees are rounded to may be a little more.
            let degrees = (f64::from(sigma).to_degrees() * 1e5).round() * 1e-5;
            faults.number("sigma", degrees, &Model::SIGMA);
        }
        Model::Ward { roughness_x, roughness_y, .. } => {
            faults.number("roughness_x", roughness_x.into(), &Model::ROUGHNESS);
            faults.number("roughness_y", roughness_y.into(), &Model::ROUGHNESS);
        }
    }
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
