//! Materials.

use super::fault::Faults;
use crate::color::Rgb;
use crate::limits::{LARGEST, Range};
use crate::material::{Distribution, Fresnel, Material, Model};
use crate::texture::{Param, Texture, TextureRef, Textured};
use crate::wording::quoted;

/// Judges a material. What it takes from textures is held against the values of `textures`, the
/// scene's; `None`: they are not known yet, and that is left out.
pub(crate) fn material(material: &Material, textures: Option<&[Texture]>, faults: &mut Faults) {
    let m = material;
    let mut judge = Parameters { textures, faults };
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
            judge.color(field, color);
        }
    }
    for (field, number) in
        [("k_a", m.k_a), ("k_d", m.k_d), ("k_s", m.k_s), ("k_e", m.k_e), ("shininess", m.shininess)]
    {
        judge.number(field, number, &Range::NOT_NEGATIVE);
    }
    judge.faults.number("ior", m.ior.into(), &Material::IOR);
    if m.priority > Material::MOST_PRIORITY {
        let most = Material::MOST_PRIORITY;
        judge
            .faults
            .say("priority", format!("`priority` is from 0 to {most}; this is {}", m.priority));
    }
    if !m.dialect.allows(&m.model) {
        let message = format!("the dialect `{}` contradicts the model", m.dialect.name());
        judge.faults.say("dialect", message);
    }
    match m.model {
        Model::Lambert | Model::Phong | Model::BlinnPhong | Model::BlinnFast => {}
        Model::Microfacet { distribution, roughness, fresnel, .. } => {
            if distribution != Distribution::Blinn {
                judge.number("roughness", roughness, &Model::ROUGHNESS);
            } else if roughness.constant().is_some_and(|exponent| exponent <= 0.0) {
                judge.faults.say("shininess", "`shininess` must be above 0 for facets");
            } else {
                judge.number("shininess", roughness, &Range::POSITIVE);
            }
            facets(fresnel, judge.faults);
        }
        Model::OrenNayar { sigma, .. } => {
            // What 90 degrees are rounded to may be a little more.
            let degrees = (f64::from(sigma).to_degrees() * 1e5).round() * 1e-5;
            judge.faults.number("sigma", degrees, &Model::SIGMA);
        }
        Model::Ward { roughness_x, roughness_y, .. } => {
            judge.number("roughness_x", roughness_x, &Model::ROUGHNESS);
            judge.number("roughness_y", roughness_y, &Model::ROUGHNESS);
        }
    }
}

/// Judges what textures may vary.
struct Parameters<'j> {
    textures: Option<&'j [Texture]>,
    faults: &'j mut Faults,
}

impl Parameters<'_> {
    fn number(&mut self, field: &'static str, number: Param<f32>, range: &Range) {
        match number {
            Param::Constant(number) => {
                self.faults.number(field, number.into(), range);
            }
            Param::Textured(by) => self.values(field, &by, |value| {
                let value = f32::of(value, &by);
                let held = range.holds(value.into());
                (!held).then(|| format!("a number {}; it becomes {value}", range.words()))
            }),
        }
    }

    fn color(&mut self, field: &'static str, color: Param<Rgb>) {
        match color {
            Param::Constant(color) => {
                self.faults.color(field, color, LARGEST);
            }
            Param::Textured(by) => self.values(field, &by, |value| {
                let value = Rgb::of(value, &by).max_channel();
                let held = f64::from(value) <= LARGEST;
                (!held).then(|| format!("at most {LARGEST:e}; it becomes {value:e}"))
            }),
        }
    }

    /// Says the first thing that `wrong` finds with the values of the texture.
    fn values(
        &mut self,
        field: &'static str,
        by: &TextureRef,
        wrong: impl Fn(Rgb) -> Option<String>,
    ) {
        let scaled = self.faults.finite(field, by.scale.into());
        if !scaled || !self.faults.finite(field, by.offset.into()) {
            return;
        }
        let Some(textures) = self.textures else { return };
        let Some(texture) = textures.get(by.texture.0 as usize) else {
            let (number, count) = (by.texture.0, textures.len());
            let message = format!("`{field}` names texture {number}, and there are {count}");
            self.faults.say(field, message);
            return;
        };
        if let Some(wrong) = texture.values().into_iter().find_map(wrong) {
            let name = quoted(&texture.name);
            self.faults
                .say(field, format!("with the texture {name}, `{field}` must be {wrong}"))
                .help = Some(
                "`scale` and `offset` beside `texture` bring its values into range".to_owned(),
            );
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
