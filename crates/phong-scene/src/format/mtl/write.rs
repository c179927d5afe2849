//! A material as MTL statements, and what they fail to say.

use std::fmt::Write as _;

use super::draft::Draft;
use super::maps::Maps;
use crate::color::Rgb;
use crate::diagnostic::Span;
use crate::format::text::Findings;
use crate::material::{
    AmbientRule, ConstantMaterial, Distribution, Fresnel, Material, Model, Shadowing, Tint,
};

/// A difference between a material and what its statements mean.
#[derive(Debug, PartialEq)]
pub(crate) enum Difference {
    /// It is there in another form; how.
    Mapped(String),
    /// It is not there.
    Lost(String),
}

/// Writes a material under `name`, and says in what the statements differ from it: they are read
/// as any reader of this module reads them, so nothing can be lost without being noticed.
pub(crate) fn write(material: &Material, name: &str, text: &mut String) -> Vec<Difference> {
    let mut differences = Vec::new();
    for (key, _) in material.textured() {
        let what = format!("the texture of `{key}`, for which 0.5 stands");
        differences.push(Difference::Lost(what));
    }
    let material = &material.at(|_| Rgb::grey(0.5));
    let draft = draft(material, name, &mut differences);
    // Writing to a string does not fail.
    let _ = writeln!(text, "newmtl {name}");
    for (keyword, color) in [
        ("Ka", draft.ambient),
        ("Kd", draft.diffuse),
        ("Ks", draft.specular),
        ("Ke", draft.emission),
        ("Tf", draft.filter),
    ] {
        if let Some(Rgb { r, g, b }) = color {
            let _ = writeln!(text, "{keyword} {r} {g} {b}");
        }
    }
    for (keyword, number) in [("Ns", draft.exponent), ("Ni", draft.index), ("d", draft.dissolve)] {
        if let Some(number) = number {
            let _ = writeln!(text, "{keyword} {number}");
        }
    }
    if let Some((illum, _)) = &draft.illum {
        let _ = writeln!(text, "illum {illum}");
    }
    let back = draft.finish(&Maps::default(), &mut Findings::default());
    let back = back.at(|_| Rgb::grey(0.5));
    compare(material, &back, &mut differences);
    differences
}

/// The statements that come nearest to a material.
fn draft(m: &ConstantMaterial, name: &str, differences: &mut Vec<Difference>) -> Draft {
    let mut draft = Draft::new(name.to_owned(), Span::default());
    let sees_through = !m.transmission.is_black();
    let refracts = sees_through && (m.fresnel || m.ior != 1.0);
    // What goes straight on is (1 − d) Tf, and all else is weighted by d.
    // The mirror is not weighted by it, as a file that says both shows.
    let both = m.k_s == m.k_d && m.specular_color.is_some_and(|k_s| near(k_s, m.reflection));
    let d = match (sees_through && !refracts, both && m.k_d > 0.0 && m.k_d < 1.0) {
        (true, _) => dissolve(m),
        (false, true) => m.k_d,
        _ => 1.0,
    };
    let highlight = m.specular_color.unwrap_or(m.color) * (m.k_s / d);
    let exponent = exponent(m, differences).filter(|_| !highlight.is_black());
    let k_s = if exponent.is_some() { highlight } else { Rgb::BLACK };

    draft.diffuse = Some(m.color * (m.k_d / d));
    if m.ambient_color.is_some() || (m.k_a - 0.1 * d).abs() > 1e-7 * d || m.k_d != d {
        draft.ambient = Some(m.ambient_color.unwrap_or(m.color) * (m.k_a / d));
    }
    draft.specular = exponent.map(|_| k_s);
    draft.emission = (m.k_e > 0.0).then(|| m.emission_color.unwrap_or(m.color) * (m.k_e / d));
    draft.exponent = exponent;
    if d != 1.0 {
        draft.dissolve = Some(d);
        let filter = m.transmission / (1.0 - d);
        draft.filter = Some(filter).filter(|&filter| sees_through && filter != Rgb::WHITE);
    }
    let mirrors = !m.reflection.is_black() && near(m.reflection, k_s);
    let illum = match (refracts, mirrors) {
        (true, _) if m.fresnel => 7,
        (true, _) => 6,
        (_, true) if m.fresnel => 5,
        (_, true) => 3,
        _ if exponent.is_some() => 2,
        _ => 1,
    };
    if refracts {
        let let_by = |t: f32, k: f32| if k < 1.0 { t / (1.0 - k) } else { 0.0 };
        let (t, k) = (m.transmission, k_s);
        let filter = Rgb::new(let_by(t.r, k.r), let_by(t.g, k.g), let_by(t.b, k.b));
        draft.filter = Some(filter).filter(|&filter| filter != Rgb::WHITE);
    }
    if refracts || illum == 5 {
        draft.index = Some(m.ior);
    }
    draft.illum = Some((illum, Span::default()));
    draft
}

/// `d`: what an MTL file's material was read from if it was, else what is not let through.
fn dissolve(m: &ConstantMaterial) -> f32 {
    if m.k_d > 0.0 && m.k_d < 1.0 {
        return m.k_d;
    }
    (1.0 - m.transmission.max_channel()).clamp(0.01, 0.99)
}

/// `Ns` of a highlight that is about as wide; `None`: there is none. With α² = 2/(n + 2), and a
/// fourth of the exponent where the mirrored direction is compared instead of the halfway one.
fn exponent(m: &ConstantMaterial, differences: &mut Vec<Difference>) -> Option<f32> {
    let of_roughness = |a2: f32| (2.0 / a2 - 2.0).max(0.0);
    let (exponent, how) = match m.model {
        Model::BlinnPhong | Model::BlinnFast => return Some(m.shininess),
        Model::Phong => (4.0 * m.shininess, "(R·E)^n becomes (N·H)^4n"),
        Model::Microfacet { distribution: Distribution::Blinn, roughness: n, .. } => {
            (n, "facets with Blinn's distribution become (N·H)^n")
        }
        Model::Microfacet { roughness, .. } => {
            (of_roughness(roughness * roughness), "facets become (N·H)^n with n = 2/α² − 2")
        }
        Model::Ward { roughness_x, roughness_y, .. } => (
            of_roughness(roughness_x * roughness_y),
            "Ward's lobe becomes (N·H)^n with n = 2/(α_x α_y) − 2, the same all round",
        ),
        // What is lost of it is told, as all that reads back otherwise.
        _ => return None,
    };
    if m.k_s > 0.0 {
        differences.push(Difference::Mapped(format!("{how} = {exponent}")));
    }
    Some(exponent)
}

/// Says in what `back`, which was read from the statements, differs from `m`.
fn compare(m: &ConstantMaterial, back: &ConstantMaterial, differences: &mut Vec<Difference>) {
    let mut lost = |what: &str| differences.push(Difference::Lost(what.to_owned()));
    let no_highlight = m.k_s == 0.0 || m.specular_color.is_some_and(Rgb::is_black);
    if !no_highlight && (m.model == Model::BlinnFast) {
        lost("the fast lobe (its exponent is kept)");
    }
    if matches!(m.model, Model::OrenNayar { .. }) {
        lost("Oren and Nayar's roughness");
    }
    if let Model::Microfacet { fresnel, shadowing, .. } = m.model {
        if fresnel != Fresnel::None {
            lost("the Fresnel reflectance of facets");
        }
        if shadowing != Shadowing::Implicit {
            lost("the shadowing of facets");
        }
    }
    if !no_highlight {
        let specular = |m: &ConstantMaterial| m.k_s * m.specular_color.unwrap_or(m.color);
        if !near(specular(m), specular(back)) {
            lost("the weight of the highlight");
        }
        if m.times_cosine || m.normalize {
            lost("a highlight times N·L, or normalised");
        }
        if m.tint != Tint::Light {
            lost("the tint of the highlight");
        }
        if m.viewer != ConstantMaterial::default().viewer {
            lost("a viewer infinitely far away");
        }
    }
    if m.ambient_rule != AmbientRule::Once && m.k_a > 0.0 {
        lost("ambient light per light");
    }
    let ambient = |m: &ConstantMaterial| m.k_a * m.ambient_color.unwrap_or(m.color);
    if !near(ambient(m), ambient(back)) {
        lost("the ambient colour");
    }
    if !near(m.k_d * m.color, back.k_d * back.color) {
        lost("the diffuse colour");
    }
    let emission = |m: &ConstantMaterial| m.k_e * m.emission_color.unwrap_or(m.color);
    if !near(emission(m), emission(back)) {
        lost("the light of its own");
    }
    if !near(m.reflection, back.reflection) {
        if back.reflection.is_black() {
            lost("the mirror, whose weight is not that of the highlight");
        } else {
            lost("the weight of the mirror, which becomes that of the highlight");
        }
    }
    if !near(m.transmission, back.transmission) {
        lost("the weight of refraction");
    }
    let sees = !m.transmission.is_black() || m.fresnel && !m.reflection.is_black();
    if sees && (m.ior != back.ior || m.fresnel != back.fresnel) {
        lost("the index of refraction, or whether Fresnel's factor counts");
    }
    if m.priority > 0 {
        lost("the priority among surfaces in one place");
    }
}

fn near(a: Rgb, b: Rgb) -> bool {
    let close = |a: f32, b: f32| (a - b).abs() <= 1e-5 * (1e-3 + a.abs().max(b.abs()));
    close(a.r, b.r) && close(a.g, b.g) && close(a.b, b.b)
}
