//! What other programs mean by "Phong", by their own formulas, in f64.

use std::f64::consts::PI;

use phong::math::Dir3;
use phong::reflectance::{
    BlinnPhong, Distribution, Falloff, Fresnel, Incident, Microfacet, Phong, Reflectance,
    Shadowing, Switches,
};
use phong_scene::Rgb;

use crate::directions::Dice;
use crate::oracle::{self, Nle};

const ALONE: Switches = Switches { times_cosine: false, normalize: false };
const NORMALIZED: Switches = Switches { times_cosine: false, normalize: true };
const BRDF: Switches = Switches { times_cosine: true, normalize: true };

/// Holds the specular term of `model` of an exponent to `formula` of it, under white light, at
/// random directions and exponents.
#[track_caller]
fn assert_dialect(model: impl Fn(f32) -> Reflectance, formula: impl Fn(Nle, f64) -> f64) {
    let mut dice = Dice::new(77);
    for _ in 0..500 {
        let (at, n) = (dice.directions(), dice.between(1.0, 200.0));
        let light = Incident { l: at.l, c_d: Rgb::BLACK, c_s: Rgb::WHITE, color: Rgb::BLACK };
        let terms = model(n).shade_light(at.n, Dir3::X, at.e, light);
        let (found, wide) = (f64::from(terms.specular.g), f64::from(n));
        let given = Nle::from(at);
        let expected = formula(given, wide);
        let sway: f64 = given.swayed(3e-7).map(|near| (formula(near, wide) - expected).abs()).sum();
        let tolerance = sway + 5e-7 * (3.0 + wide) * expected.abs() + 1e-30;
        assert!((found - expected).abs() <= tolerance, "{found}, not {expected}: {at:?}, n = {n}");
    }
}

fn phong(k_s: f32, switches: Switches) -> impl Fn(f32) -> Reflectance {
    move |n| Reflectance::Phong(Phong::new(0.0, k_s, n, switches))
}

fn blinn(k_s: f32, switches: Switches) -> impl Fn(f32) -> Reflectance {
    move |n| Reflectance::BlinnPhong(BlinnPhong::new(0.0, k_s, n, switches))
}

fn n_dot_l(at: Nle) -> f64 {
    oracle::dot(at.n, at.l)
}

#[test]
fn pov_rays_phong_and_specular_without_albedo() {
    assert_dialect(phong(0.4, ALONE), |at, n| f64::from(0.4_f32) * oracle::phong_lobe(at, n));
    assert_dialect(blinn(0.4, ALONE), |at, n| f64::from(0.4_f32) * oracle::blinn_lobe(at, n));
}

#[test]
fn pov_rays_phong_and_specular_with_albedo() {
    assert_dialect(phong(1.0, NORMALIZED), |at, n| 0.5 * (n + 1.0) * oracle::phong_lobe(at, n));
    assert_dialect(blinn(1.0, NORMALIZED), |at, n| {
        (n + 2.0) / (8.0 * (1.0 - libm::exp2(-(n + 2.0) / 2.0))) * oracle::blinn_lobe(at, n)
    });
}

#[test]
fn ospray_s_scivis_renderer_but_for_its_pi() {
    // f cos L = ks (n + 2)/(4π (2 − 2^(−n/2))) (N·H)^n: a light of 1 here is one of π there.
    assert_dialect(blinn(0.5, NORMALIZED), |at, n| {
        let f = 0.5 * (n + 2.0) / (4.0 * PI * (2.0 - libm::exp2(-n / 2.0)));
        PI * f * oracle::blinn_lobe(at, n)
    });
}

#[test]
fn modified_phong_and_the_blinn_phong_brdf() {
    assert_dialect(phong(0.5, BRDF), |at, n| {
        PI * n_dot_l(at) * oracle::modified_phong(at, 0.0, 0.5, n)
    });
    assert_dialect(blinn(0.5, BRDF), |at, n| {
        PI * n_dot_l(at) * oracle::blinn_phong_brdf(at, 0.0, 0.5, n, true)
    });
}

#[test]
fn three_js_s_mesh_phong_material_as_facets_that_hide_nothing() {
    // F(V·H) ¼ (n/2 + 1)/π (N·H)^n, times N·L, and a π as in OSPRay's.
    let f0 = 0.1_f32;
    let model = |n| {
        Reflectance::Microfacet(Microfacet {
            k_d: 0.0,
            k_s: 1.0,
            distribution: Distribution::Blinn { n },
            shadowing: Shadowing::Implicit,
            fresnel: Fresnel::Schlick { f0: Rgb::grey(f0) },
        })
    };
    assert_dialect(model, |at, n| {
        let v_dot_h = (0.5 * (1.0 + oracle::dot(at.l, at.e))).sqrt();
        let fresnel = oracle::schlick(v_dot_h, f64::from(f0));
        let f = fresnel * 0.25 * (n / 2.0 + 1.0) / PI * oracle::blinn_lobe(at, n);
        PI * f * n_dot_l(at)
    });
}

#[test]
fn tachyon_s_fast_lobe() {
    let model = |n| {
        let power = BlinnPhong::new(0.0, 0.5, n, ALONE);
        Reflectance::BlinnPhong(power.with_falloff(Falloff::Rational))
    };
    assert_dialect(model, |at, n| {
        let x = oracle::blinn_lobe(at, 1.0);
        0.5 * x / (n - n * x + x)
    });
}
