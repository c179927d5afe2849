//! A lobe as a scene's material, and a scene's material in another model.

use std::fmt;
use std::str::FromStr;

use phong::light::LightSample;
use phong::material::Material;
use phong::math::Dir3;
use phong_scene::{
    self as scene, ConstantMaterial, Distribution, Fresnel, Rgb, Shadowing, WardForm,
};

use super::lobe::Base;
use super::{FitError, Formula, Lobe, Model, fit, formula};

/// Another model for a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// Diffuse only, no highlight.
    Lambert,
    /// Rough and diffuse, no highlight; σ in degrees.
    OrenNayar {
        /// Standard deviation of the facets' slope angle, degrees, in [0, 90].
        sigma: f64,
    },
    /// A highlight of this model. `None`: the number that the formula gives, or where there is no
    /// formula, the fit.
    Highlight {
        /// The model.
        model: Model,
        /// Its exponent or roughness, if it is not to be looked for.
        number: Option<f64>,
    },
}

/// What became of a material's highlight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remodelled {
    /// What it was.
    pub from: Lobe,
    /// What it is.
    pub to: Lobe,
    /// By which formula; `None`: the number was given, or fitted.
    pub formula: Option<Formula>,
    /// `k_s` before and after: that the highlight is as bright face on.
    pub k_s: [f32; 2],
}

impl Target {
    /// σ of Oren–Nayar where none is given, degrees: the scene's default.
    const SIGMA: f64 = 20.0;

    /// All names, for messages.
    pub fn names() -> String {
        format!("lambert, oren-nayar, {}", Model::names())
    }
}

impl FromStr for Target {
    type Err = FitError;

    /// `lambert`, `oren-nayar`, `oren-nayar:30`, `ggx` or `ggx:0.2`.
    fn from_str(text: &str) -> Result<Self, FitError> {
        let (name, number) = match text.split_once(':') {
            Some((name, number)) => {
                let text = number.trim();
                let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
                (name, Some(number.ok_or_else(|| FitError::NotANumber { text: text.to_owned() })?))
            }
            None => (text, None),
        };
        match (name, number) {
            ("lambert", None) => Ok(Self::Lambert),
            ("oren-nayar", _) => {
                let sigma = number.unwrap_or(Self::SIGMA);
                let told = || FitError::Sigma { sigma };
                (0.0..=90.0).contains(&sigma).then_some(Self::OrenNayar { sigma }).ok_or_else(told)
            }
            _ => {
                let model: Model = name.parse()?;
                if let Some(number) = number {
                    Lobe::new(model, number)?;
                }
                Ok(Self::Highlight { model, number })
            }
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Lambert => f.write_str("lambert"),
            Self::OrenNayar { sigma } => write!(f, "oren-nayar:{sigma}"),
            Self::Highlight { model, number: None } => write!(f, "{model}"),
            Self::Highlight { model, number: Some(number) } => write!(f, "{model}:{number}"),
        }
    }
}

/// The parameters that make a highlight, by their keys in the scene text.
const HIGHLIGHT: [&str; 6] =
    ["k_s", "specular_color", "shininess", "roughness", "roughness_x", "roughness_y"];

/// Draws a material in another model: colours and weights stay, and so does the brightness of the
/// highlight face on. `None`: it had no highlight to carry over.
///
/// A material without a highlight gets none, and one whose highlight textures vary is left as it
/// is. Facets keep their Fresnel reflectance as facets; in any other model its colour face on
/// becomes the specular colour.
pub fn remodel(material: &mut scene::Material, target: Target) -> Option<Remodelled> {
    let (model, number) = match target {
        Target::Lambert => {
            material.model = scene::Model::Lambert;
            material.k_s = 0.0.into();
            return None;
        }
        Target::OrenNayar { sigma } => {
            let sigma = sigma.to_radians() as f32;
            material.model = scene::Model::OrenNayar { sigma: sigma.into(), full: false };
            material.k_s = 0.0.into();
            return None;
        }
        Target::Highlight { model, number } => (model, number),
    };
    if material.textured().iter().any(|(key, _)| HIGHLIGHT.contains(key)) {
        return None;
    }
    // What textures vary is not the highlight's, and goes back as it was.
    let mut constant = material.at(|_| Rgb::WHITE);
    let told = carry_over(&mut constant, model, number)?;
    let scene::Material { color, ambient_color, emission_color, k_a, k_d, k_e, .. } = *material;
    let scene::Material { reflection, transmission, .. } = *material;
    *material = scene::Material {
        color,
        ambient_color,
        emission_color,
        k_a,
        k_d,
        k_e,
        reflection,
        transmission,
        ..constant.into()
    };
    Some(told)
}

/// Gives a material the highlight of another model.
fn carry_over(
    material: &mut ConstantMaterial,
    model: Model,
    number: Option<f64>,
) -> Option<Remodelled> {
    let from = highlight(material)?;
    let formula = match number {
        Some(_) => None,
        None => formula::formula(from, model),
    };
    let wanted = number.or(formula.map(|formula| formula.value));
    let number = match wanted {
        Some(number) => number.clamp(model.range()[0], model.range()[1]),
        None => fit(from, model).ok()?.to.number,
    };
    let to = Lobe { model, number };
    let facets = match material.model {
        scene::Model::Microfacet { fresnel, .. } => Some(fresnel),
        _ => None,
    };
    let before = (material.k_s, peak(material));
    (material.model, material.shininess) = written(to);
    (material.times_cosine, material.normalize) = (false, false);
    material.dialect = scene::Dialect::Lecture;
    match (&mut material.model, facets) {
        (scene::Model::Microfacet { fresnel, .. }, Some(kept)) => *fresnel = kept,
        _ if material.specular_color.is_some() && !before.1.is_black() => {
            material.specular_color = Some((1.0 / before.1.max_channel()) * before.1);
        }
        _ => {}
    }
    material.k_s = 1.0;
    let after = peak(material).max_channel();
    material.k_s = if after > 0.0 { before.1.max_channel() / after } else { 0.0 };
    Some(Remodelled { from, to, formula, k_s: [before.0, material.k_s] })
}

/// The lobe of a material; `None` where it has no highlight.
fn highlight(material: &ConstantMaterial) -> Option<Lobe> {
    if material.k_s == 0.0 {
        return None;
    }
    let (model, number) = match material.model {
        scene::Model::Phong => (Model::Phong, material.shininess),
        scene::Model::BlinnPhong | scene::Model::BlinnFast => {
            (Model::BlinnPhong, material.shininess)
        }
        scene::Model::Microfacet { distribution, roughness, shadowing, .. } => {
            let model = match (distribution, shadowing) {
                (Distribution::Blinn, _) => Model::BlinnPhong,
                (Distribution::Beckmann, Shadowing::VCavity) => Model::CookTorrance,
                (Distribution::Beckmann, _) => Model::Beckmann,
                (Distribution::Ggx, _) => Model::Ggx,
            };
            (model, roughness)
        }
        scene::Model::Ward { roughness_x, roughness_y, .. } => {
            (Model::Ward, (roughness_x * roughness_y).sqrt())
        }
        _ => return None,
    };
    let [least, most] = model.range();
    Some(Lobe { model, number: f64::from(number).clamp(least, most) })
}

/// The highlight of a white object, face on, under white light.
fn peak(material: &ConstantMaterial) -> Rgb {
    let light =
        LightSample { l: Dir3::Z, distance: 1.0, color: Rgb::WHITE, specular_color: Rgb::WHITE };
    let material = Material::new(material, Dir3::Z);
    material.shade_light(Dir3::Z, Dir3::X, Dir3::Z, Rgb::WHITE, &light).specular
}

/// A lobe as the model of a scene, and the exponent that goes with it.
pub(super) fn written(lobe: Lobe) -> (scene::Model<f32, Rgb>, f32) {
    let facets = |distribution, shadowing, roughness: f64| scene::Model::Microfacet {
        distribution,
        roughness: roughness as f32,
        shadowing,
        fresnel: Fresnel::None,
    };
    match lobe.model.base(lobe.number) {
        Base::Phong(n) => (scene::Model::Phong, n as f32),
        Base::Blinn(n) => (scene::Model::BlinnPhong, n as f32),
        Base::CookTorrance(m) => (facets(Distribution::Beckmann, Shadowing::VCavity, m), 0.0),
        Base::Beckmann(m) => (facets(Distribution::Beckmann, Shadowing::Correlated, m), 0.0),
        Base::Ggx(a) => (facets(Distribution::Ggx, Shadowing::Correlated, a), 0.0),
        Base::Ward(a) => {
            let (a, form) = (a as f32, WardForm::Gmd);
            (scene::Model::Ward { roughness_x: a, roughness_y: a, form }, 0.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn into(material: &ConstantMaterial, target: &str) -> (ConstantMaterial, Option<Remodelled>) {
        let mut material: scene::Material = material.clone().into();
        let told = remodel(&mut material, target.parse().unwrap());
        (material.at(|_| Rgb::BLACK), told)
    }

    #[test]
    fn textures_stay_and_a_highlight_that_they_vary_is_left_as_it_is() {
        let by = scene::TextureRef::new(scene::TextureId(0));
        let tiles = scene::Material { color: by.into(), ..scene::Material::default() };
        let mut changed = tiles.clone();
        assert!(remodel(&mut changed, "ggx".parse().unwrap()).is_some());
        assert_eq!(changed.color, tiles.color);
        let worn = scene::Material { k_s: by.into(), ..scene::Material::default() };
        let mut same = worn.clone();
        assert_eq!(remodel(&mut same, "ggx".parse().unwrap()), None);
        assert_eq!(same, worn);
    }

    #[test]
    fn the_highlight_is_as_bright_face_on_in_every_model() {
        let written = ConstantMaterial {
            specular_color: Some(Rgb::new(1.0, 0.5, 0.25)),
            ..ConstantMaterial::default()
        };
        for model in Model::ALL {
            let (changed, told) = into(&written, model.name());
            assert_eq!(told.unwrap().to.model, model);
            let (before, after) = (peak(&written), peak(&changed));
            for (a, b) in before.to_array().into_iter().zip(after.to_array()) {
                assert!((a - b).abs() < 1e-5, "{model}: {before:?} {after:?}");
            }
            assert_eq!((changed.color, changed.k_d), (written.color, written.k_d));
        }
    }

    #[test]
    fn a_number_is_by_formula_unless_it_is_given() {
        let (matched, told) = into(&ConstantMaterial::default(), "blinn-phong");
        assert!((matched.shininess - 128.69).abs() < 0.01, "{}", matched.shininess);
        assert!(told.unwrap().formula.is_some());
        let (given, told) = into(&ConstantMaterial::default(), "blinn-phong:32");
        assert_eq!((given.shininess, told.unwrap().formula), (32.0, None));
    }

    #[test]
    fn a_metal_keeps_its_fresnel_as_facets_and_its_colour_otherwise() {
        let fresnel = Fresnel::Schlick { f0: Rgb::new(1.0, 0.8, 0.3) };
        let model = scene::Model::Microfacet {
            distribution: Distribution::Ggx,
            roughness: 0.3,
            shadowing: Shadowing::Correlated,
            fresnel,
        };
        let gold = ConstantMaterial { model, k_s: 1.0, ..ConstantMaterial::default() };
        let (facets, _) = into(&gold, "beckmann");
        assert!(
            matches!(facets.model, scene::Model::Microfacet { fresnel: f, .. } if f == fresnel)
        );
        let (phong, _) = into(&gold, "phong");
        assert_eq!(phong.specular_color, Some(Rgb::new(1.0, 0.8, 0.3)));
    }

    #[test]
    fn what_has_no_highlight_gets_none_and_matt_models_take_it() {
        let matt = ConstantMaterial {
            model: scene::Model::Lambert,
            k_s: 0.0,
            ..ConstantMaterial::default()
        };
        assert_eq!(into(&matt, "ggx"), (matt.clone(), None));
        for target in ["lambert", "oren-nayar:30"] {
            let (changed, told) = into(&ConstantMaterial::default(), target);
            assert_eq!((changed.k_s, told), (0.0, None));
        }
    }

    #[test]
    fn what_is_no_target_is_refused() {
        for wrong in ["fong", "lambert:1", "oren-nayar:91", "ggx:x", "ggx:nan", "ggx:-1", ""] {
            assert!(wrong.parse::<Target>().is_err(), "{wrong}");
        }
        assert_eq!("ggx:0.2".parse::<Target>().unwrap().to_string(), "ggx:0.2");
    }
}
