//! `[materials.NAME]`.

use super::notes::Notes;
use super::table::Values;
use super::texture::TextureNames;
use crate::check::material as judge;
use crate::color::Rgb;
use crate::material::{Dialect, Distribution, Fresnel, Material, Model, Shadowing};
use crate::texture::Param;

/// A material; what is wrong with it has been said.
pub(super) fn material(
    v: &Values,
    name: &str,
    textures: &mut TextureNames,
    notes: &mut Notes,
) -> Option<Material> {
    let (name, place) = (name.to_owned(), notes.place(v.spot));
    let mut material = Material { name, place, ..Material::default() };
    v.fill_textured(&mut material, |by, name, spot| textures.take(by, name, spot))?;
    model(v, &mut material, notes)?;
    let Material { dialect, .. } = material;
    if !dialect.allows(&material.model) {
        say_contradiction(v, dialect, notes);
        return None;
    }
    if !v.takes("k_s") {
        material.k_s = Param::Constant(0.0);
    }
    if !v.has("fresnel") {
        material.fresnel = !material.transmission.is_black();
    }
    if material.fresnel && !material.transmission.is_black() && material.reflection.is_black() {
        let message = "Fresnel's factor takes from what is let through what `reflection` \
                       would mirror, but that is 0: the light is lost";
        let help = "write `reflection = 1`, as for glass, or `fresnel = false` to keep \
                    `transmission` as it is written";
        notes.warning(v.spot_of("transmission"), message).help = Some(help.to_owned());
    }
    if !notes.judge(|key| v.spot_of(key), |faults| judge::material(&material, None, faults)) {
        return None;
    }
    if material.dialect == Dialect::ThreeJs && material.model == Model::BlinnPhong {
        three_js(v, material, notes)
    } else {
        Some(material)
    }
}

/// three.js's highlight, `F ¼ (α/2 + 1)/π (N·H)^α`, is that of facets; so is then the material.
fn three_js(v: &Values, material: Material, notes: &mut Notes) -> Option<Material> {
    for switch in ["times_cosine", "normalize", "tint", "viewer"] {
        if v.has(switch) {
            let message = format!("the dialect three-js leaves no choice of `{switch}`");
            notes.error(v.spot_of(switch), message).help =
                Some("its highlight is (α + 2)/8 F (N·H)^α (N·L); leave the key out".to_owned());
            return None;
        }
    }
    let specular = material.specular_color.unwrap_or(material.color);
    let (Some(k_s), Some(specular)) = (material.k_s.constant(), specular.constant()) else {
        let key = if material.k_s.constant().is_none() { "k_s" } else { "specular_color" };
        let message = "the dialect three-js takes one highlight for the whole surface";
        notes.error(v.spot_of(key), message).help =
            Some("leave the texture out, or the dialect".to_owned());
        return None;
    };
    let f0 = k_s * specular;
    let model = Model::Microfacet {
        distribution: Distribution::Blinn,
        roughness: material.shininess,
        shadowing: Shadowing::Implicit,
        fresnel: Fresnel::Schlick { f0: f0.into() },
    };
    let (k_s, white) = (Param::Constant(1.0), Param::Constant(Rgb::WHITE));
    Some(Material { model, k_s, specular_color: Some(white), ..material })
}

/// What stands in several keys of a model.
fn model(v: &Values, material: &mut Material, notes: &mut Notes) -> Option<()> {
    match &mut material.model {
        Model::Microfacet { distribution, roughness, fresnel, .. } => {
            // The exponent goes with Blinn's distribution, the roughness with the others.
            if let Some(word) = v.word("distribution") {
                let (takes, other) = match distribution {
                    Distribution::Blinn => ("shininess", "roughness"),
                    Distribution::Beckmann | Distribution::Ggx => ("roughness", "shininess"),
                };
                if v.has(other) {
                    let message = format!("`{other}` means nothing to this distribution");
                    let help = format!("`distribution = \"{word}\"` takes `{takes}`");
                    notes.error(v.spot_of(other), message).help = Some(help);
                }
            }
            if *distribution == Distribution::Blinn {
                *roughness = material.shininess;
            }
            *fresnel = self::fresnel(v, *fresnel, notes)?;
        }
        Model::Ward { roughness_x, roughness_y, .. } if !v.has("roughness_y") => {
            *roughness_y = *roughness_x;
        }
        _ => {}
    }
    Some(())
}

/// `f0`, or `eta` alone, or `eta` with `k`, where `written` has what was written of them.
fn fresnel(v: &Values, written: Fresnel, notes: &mut Notes) -> Option<Fresnel> {
    if v.has("f0") && (v.has("eta") || v.has("k")) {
        let help = "`f0` alone (Schlick), `eta` alone (dielectric), or `eta` with `k` (metal)";
        notes.error(v.spot_of("f0"), "`f0` and `eta` both say what facets reflect").help =
            Some(help.to_owned());
        return None;
    }
    if !v.has("eta") {
        if v.has("k") {
            notes.error(v.spot_of("k"), "`k` goes with `eta`, which is not here");
            return None;
        }
        // Schlick's formula is then 1 at every angle.
        let mirrors = Fresnel::Schlick { f0: Rgb::WHITE.into() };
        return Some(if written == mirrors { Fresnel::None } else { written });
    }
    let Fresnel::Conductor { eta, .. } = written else { return None };
    match eta {
        _ if v.has("k") => Some(written),
        Param::Textured(by) => Some(Fresnel::Dielectric { eta: by.into() }),
        Param::Constant(Rgb { r, g, b }) if [g, b] == [r; 2] => {
            Some(Fresnel::Dielectric { eta: r.into() })
        }
        Param::Constant(_) => {
            let help = "write one number, or give `k` as well for a metal";
            notes.error(v.spot_of("eta"), "a dielectric has one `eta` for all channels").help =
                Some(help.to_owned());
            None
        }
    }
}

/// Says that the model's lobe is none of the dialect's.
fn say_contradiction(v: &Values, dialect: Dialect, notes: &mut Notes) {
    let (name, word) = (dialect.name(), v.word("model").unwrap_or_default());
    let lobes = [
        (Model::Phong, "phong"),
        (Model::BlinnPhong, "blinn-phong"),
        (Model::BlinnFast, "blinn-fast"),
    ];
    let fits: Vec<String> = lobes
        .iter()
        .filter(|(model, _)| dialect.allows(model))
        .map(|(_, word)| format!("`model = \"{word}\"`"))
        .collect();
    let fits = fits.join(" or ");
    let message = format!("the dialect `{name}` contradicts the model, {word}");
    notes.error(v.spot_of("dialect"), message).help =
        Some(format!("the model fixes the lobe; {name}'s is that of {fits}"));
}
