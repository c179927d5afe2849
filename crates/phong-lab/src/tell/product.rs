//! Terms as products: the factors that words, LaTeX and pages write, each with its number.

use phong::explain::{Lit, Surface};
use phong::math::lobe;
use phong::reflectance::blinn_phong::{self, rational_lobe};
use phong::reflectance::phong as phong_model;
use phong::terms::Term;
use phong_scene::{AmbientRule, ConstantMaterial, Model, Rgb};

/// A term: its factors in the order they are written, and what they come to, as it is in the sum.
pub(super) struct Product {
    pub(super) factors: Vec<Factor>,
    pub(super) value: Rgb,
}

/// One factor of a term.
pub(super) struct Factor {
    /// In letters, for a terminal.
    pub(super) words: String,
    /// In letters, for LaTeX.
    pub(super) latex: &'static str,
    pub(super) number: Number,
    /// What it was raised from, if it is a power.
    pub(super) power: Option<Power>,
}

/// What a factor is in numbers.
#[derive(Clone, Copy)]
pub(super) enum Number {
    One(f32),
    Color(Rgb),
}

/// A cosine, which may be below 0 and then counts as 0, raised to an exponent.
#[derive(Clone, Copy)]
pub(super) struct Power {
    pub(super) cosine: f32,
    pub(super) exponent: f32,
}

fn one(words: &str, latex: &'static str, number: f32) -> Factor {
    Factor { words: words.to_owned(), latex, number: Number::One(number), power: None }
}

fn color(words: &str, latex: &'static str, color: Rgb) -> Factor {
    Factor { words: words.to_owned(), latex, number: Number::Color(color), power: None }
}

/// A grey is one number.
fn grey_or_color(words: &str, latex: &'static str, of: Rgb) -> Factor {
    if of.r == of.g && of.g == of.b { one(words, latex, of.r) } else { color(words, latex, of) }
}

/// The terms that belong to the surface as it is, and to no light: of the ambient term nothing
/// where it is added light by light.
pub(super) fn own_terms(s: &Surface) -> Vec<(Term, Product)> {
    let m = &s.material;
    let mut terms = Vec::new();
    if m.ambient_rule != AmbientRule::PerLight {
        let mut factors = vec![one("k_a", "k_a", m.k_a), color("C_a", "C_a", s.c_a)];
        factors.extend(cover(s));
        match s.openness.and_then(|open| open.sky) {
            Some(sky) => factors.push(color("× sky", r"\text{sky}", sky)),
            None => factors.extend(openness(s)),
        }
        terms.push((Term::Ambient, Product { factors, value: s.ambient }));
    }
    if m.k_e > 0.0 {
        let mut factors = vec![one("k_e", "k_e", m.k_e), color("C_e", "C_e", s.c_e())];
        factors.extend(cover(s));
        terms.push((Term::Emission, Product { factors, value: s.terms.emission }));
    }
    terms
}

/// The share of the surface that is there, where it is see-through.
fn cover(s: &Surface) -> Option<Factor> {
    (s.cover < 1.0).then(|| one("× opacity", r"\text{opacity}", s.cover))
}

/// The share of the ambient light that finds its way here, in scenes that ask.
fn openness(s: &Surface) -> Option<Factor> {
    s.openness.map(|open| one("× openness", r"\text{openness}", open.share))
}

/// What one light adds to the ambient term; `None` where lights add nothing to it.
pub(super) fn ambient_of_light(s: &Surface, lit: &Lit) -> Option<Product> {
    let m = &s.material;
    let surface = match m.ambient_rule {
        AmbientRule::Once => return None,
        AmbientRule::PerLight => color("C_a", "C_a", s.c_a),
        AmbientRule::Both => color("colour", r"\text{colour}", m.ambient_color.unwrap_or(s.color)),
    };
    let light = color("× light", r"\text{light}", lit.color);
    let mut factors = vec![one("k_a", "k_a", m.k_a), surface, light];
    factors.extend(cover(s));
    factors.extend(openness(s));
    Some(Product { factors, value: lit.ambient })
}

/// The diffuse term of a light that adds to it.
pub(super) fn diffuse(s: &Surface, lit: &Lit) -> Product {
    let k_d = s.material.k_d;
    let mut factors = vec![one("k_d", "k_d", k_d)];
    if !s.material.model.is_lambertian() {
        factors.push(brdf(lit.white.diffuse, k_d * lit.n_dot_l));
    }
    factors.push(one("(N·L)", r"(N \cdot L)", lit.n_dot_l));
    factors.push(color("C_d", "C_d", lit.c_d));
    factors.extend(cover(s));
    Product { factors, value: lit.diffuse }
}

/// The specular term of a light that adds to it; `None` for models that have no highlight.
pub(super) fn specular(s: &Surface, lit: &Lit) -> Option<Product> {
    let m = &s.material;
    if !m.model.is_glossy() {
        return None;
    }
    let c_s = color("C_s", "C_s", lit.c_s);
    let mut factors = vec![one("k_s", "k_s", m.k_s)];
    if m.model.is_power() {
        factors.push(highlight(m, lit));
        factors.push(c_s);
        factors
            .extend(normalization(m).map(|n| one("× normalisation", r"\text{normalisation}", n)));
        if m.times_cosine {
            factors.push(one("× N·L", r"(N \cdot L)", lit.n_dot_l));
        }
    } else {
        factors.push(brdf(lit.white.specular, m.k_s * lit.n_dot_l));
        factors.push(one("(N·L)", r"(N \cdot L)", lit.n_dot_l));
        factors.push(c_s);
    }
    factors.extend(cover(s));
    Some(Product { factors, value: lit.specular })
}

/// π f, the model's answer to white light, of which `known` is written as factors of their own.
fn brdf(answer: Rgb, known: f32) -> Factor {
    let f = if known > 0.0 { (1.0 / known) * answer } else { Rgb::BLACK };
    grey_or_color("π f", r"\pi f", f)
}

/// The lobe of Phong's and Blinn's models.
fn highlight(m: &ConstantMaterial, lit: &Lit) -> Factor {
    let exponent = m.shininess;
    let power = |name: &str, latex, cosine: f32| Factor {
        words: format!("({name})^{exponent}"),
        latex,
        number: Number::One(lobe(cosine.max(0.0), exponent)),
        power: Some(Power { cosine, exponent }),
    };
    match m.model {
        Model::Phong => power("R·E", r"(R \cdot E)^\alpha", lit.r_dot_e),
        Model::BlinnFast => one(
            "x/(α − αx + x)",
            r"\frac{N \cdot H}{\alpha - (\alpha - 1)(N \cdot H)}",
            rational_lobe(lit.n_dot_h, exponent),
        ),
        _ => power("N·H", r"(N \cdot H)^\alpha", lit.n_dot_h),
    }
}

/// The value of the lobe's power, `(R·E)^α` or `(N·H)^α`; `None` for models without one, and of a
/// light that adds nothing.
pub(super) fn power(s: &Surface, lit: &Lit) -> Option<f32> {
    match highlight(&s.material, lit).number {
        Number::One(value) if s.material.model.is_power() && lit.visible => Some(value),
        _ => None,
    }
}

/// What a normalised lobe is multiplied by; `None` where it is not normalised.
pub(super) fn normalization(m: &ConstantMaterial) -> Option<f32> {
    m.normalize.then(|| match m.model {
        Model::Phong => phong_model::normalization(m.shininess, m.times_cosine),
        _ => blinn_phong::normalization(m.shininess, m.times_cosine),
    })
}
