//! `[materials.NAME]`.

use super::notes::Notes;
use super::table::Values;
use super::texture::TextureNames;
use crate::check::material as judge;
use crate::color::Rgb;
use crate::material::{
    AmbientRule, Dialect, Distribution, Fresnel, Material, Model, Shadowing, Tint, Viewer, WardForm,
};
use crate::texture::Param;

/// A material; what is wrong with it has been said.
pub(super) fn material(
    v: &Values,
    name: &str,
    textures: &mut TextureNames,
    notes: &mut Notes,
) -> Option<Material> {
    let model = match v.word("model")? {
        "lambert" => Model::Lambert,
        "blinn-phong" => Model::BlinnPhong,
        "blinn-fast" => Model::BlinnFast,
        "cook-torrance" => cook_torrance(v, textures, notes)?,
        "ggx" => Model::Microfacet {
            distribution: Distribution::Ggx,
            roughness: textures.number(v, "roughness")?,
            shadowing: shadowing(v)?,
            fresnel: fresnel(v, notes)?,
        },
        "oren-nayar" => Model::OrenNayar {
            sigma: v.number("sigma")?.to_radians() as f32,
            full: v.word("form")? == "full",
        },
        "ward" => {
            let roughness_x = textures.number(v, "roughness_x")?;
            Model::Ward {
                roughness_x,
                roughness_y: textures.number(v, "roughness_y").unwrap_or(roughness_x),
                form: if v.word("form")? == "gmd" { WardForm::Gmd } else { WardForm::Ward },
            }
        }
        _ => Model::Phong,
    };
    let dialect = dialect(v, &model, notes)?;
    let preset = dialect.switches();
    let plain = Material::default();
    let transmission = textures.color(v, "transmission")?;
    let material = Material {
        name: name.to_owned(),
        model,
        color: textures.color(v, "color")?,
        ambient_color: textures.color(v, "ambient_color"),
        // White where a model has no highlight, which the key is then an error for.
        specular_color: match v.word("specular_color") {
            Some(_) => None,
            None => Some(textures.color(v, "specular_color").unwrap_or(Rgb::WHITE.into())),
        },
        k_a: textures.number(v, "k_a")?,
        k_d: textures.number(v, "k_d")?,
        k_s: textures.number(v, "k_s").unwrap_or(Param::Constant(0.0)),
        k_e: textures.number(v, "k_e")?,
        emission_color: textures.color(v, "emission_color"),
        shininess: textures.number(v, "shininess").unwrap_or(plain.shininess),
        reflection: textures.color(v, "reflection")?,
        transmission,
        ior: v.number("ior")? as f32,
        priority: v.integer("priority")? as u32,
        fresnel: v.flag("fresnel").unwrap_or(!transmission.is_black()),
        dialect,
        times_cosine: v.flag("times_cosine").unwrap_or(preset.times_cosine),
        normalize: v.flag("normalize").unwrap_or(preset.normalize),
        tint: match v.word("tint") {
            Some("object") => Tint::Object,
            Some("metallic") => Tint::Metallic,
            Some(_) => Tint::Light,
            None => preset.tint,
        },
        ambient_rule: match v.word("ambient_rule") {
            Some("per-light") => AmbientRule::PerLight,
            Some("both") => AmbientRule::Both,
            Some(_) => AmbientRule::Once,
            None => preset.ambient_rule,
        },
        viewer: match v.word("viewer") {
            Some("distant") => Viewer::Distant,
            Some(_) => Viewer::Local,
            None => preset.viewer,
        },
        place: notes.place(v.spot),
    };
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
        fresnel: Fresnel::Schlick { f0 },
    };
    let (k_s, white) = (Param::Constant(1.0), Param::Constant(Rgb::WHITE));
    Some(Material { model, k_s, specular_color: Some(white), ..material })
}

/// Cook and Torrance's model: the exponent goes with Blinn's distribution, the roughness with
/// the others.
fn cook_torrance(v: &Values, textures: &mut TextureNames, notes: &mut Notes) -> Option<Model> {
    let (distribution, takes, other) = match v.word("distribution")? {
        "blinn" => (Distribution::Blinn, "shininess", "roughness"),
        "ggx" => (Distribution::Ggx, "roughness", "shininess"),
        _ => (Distribution::Beckmann, "roughness", "shininess"),
    };
    if v.has(other) {
        let message = format!("`{other}` means nothing to this distribution");
        let word = v.word("distribution")?;
        let help = format!("`distribution = \"{word}\"` takes `{takes}`");
        notes.error(v.spot_of(other), message).help = Some(help);
    }
    let roughness = textures.number(v, takes)?;
    Some(Model::Microfacet {
        distribution,
        roughness,
        shadowing: shadowing(v)?,
        fresnel: fresnel(v, notes)?,
    })
}

fn shadowing(v: &Values) -> Option<Shadowing> {
    Some(match v.word("shadowing")? {
        "separable" => Shadowing::Separable,
        "correlated" => Shadowing::Correlated,
        "implicit" => Shadowing::Implicit,
        _ => Shadowing::VCavity,
    })
}

/// `f0`, or `eta` alone, or `eta` with `k`.
fn fresnel(v: &Values, notes: &mut Notes) -> Option<Fresnel> {
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
        let f0 = if v.has("f0") { v.color("f0")? } else { Rgb::grey(0.04) };
        // Schlick's formula is then 1 at every angle.
        return Some(if f0 == Rgb::WHITE { Fresnel::None } else { Fresnel::Schlick { f0 } });
    }
    let eta = v.color("eta")?;
    if v.has("k") {
        return Some(Fresnel::Conductor { eta, k: v.color("k")? });
    }
    if eta != Rgb::grey(eta.r) {
        let help = "write one number, or give `k` as well for a metal";
        notes.error(v.spot_of("eta"), "a dielectric has one `eta` for all channels").help =
            Some(help.to_owned());
        return None;
    }
    Some(Fresnel::Dielectric { eta: eta.r })
}

/// The dialect, if the model's lobe is one of its.
fn dialect(v: &Values, model: &Model, notes: &mut Notes) -> Option<Dialect> {
    let dialect = Dialect::from_name(v.word("dialect")?)?;
    if dialect.allows(model) {
        return Some(dialect);
    }
    let (name, word) = (dialect.name(), v.word("model")?);
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
    None
}
