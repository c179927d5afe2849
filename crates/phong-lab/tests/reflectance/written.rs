//! Every dialect as it is written in a scene, held to its program's own formula, in f64.

use std::f64::consts::FRAC_PI_2;

use phong::light::LightSample;
use phong::material::Material;
use phong::math::Dir3;
use phong_scene::{Dialect, Limits, Memory, Rgb};

use crate::directions::Dice;
use crate::oracle::{self, Nle, V};

const K_A: f64 = 0.25;
const K_S: f64 = 0.5;
const OBJECT: V = [0.75, 0.5, 0.25];
const HIGHLIGHT: V = [0.5, 0.25, 1.0];
const AMBIENT: V = [0.5, 1.0, 0.75];
const LIGHT: V = [1.0, 0.5, 0.25];
const LIGHT_S: V = [0.25, 1.0, 0.5];
/// To a viewer infinitely far along the camera's axis.
const AXIS: V = [0.0, 0.0, 1.0];

/// One material as written, and its program's highlight of directions and exponent.
struct Row {
    dialect: &'static str,
    model: &'static str,
    switch: &'static str,
    highlight: fn(Nle, f64) -> V,
    ambient: fn() -> V,
}

const ROWS: [Row; 23] = [
    row("lecture", "phong", "", phong, once),
    row("lecture", "blinn-phong", "", blinn, once),
    // Ks Σ (N·H)^Ns I and Ka Ia
    row("mtl", "blinn-phong", "", blinn, once),
    row("pov-ray", "phong", "", phong, once),
    row("pov-ray", "blinn-phong", "", blinn, once),
    row("pov-ray", "phong", "normalize = true", pov_albedo, once),
    row("pov-ray", "phong", "tint = 'metallic'", pov_metallic, once),
    row("tachyon", "blinn-phong", "", blinn, once),
    row("tachyon", "phong", "", phong, once),
    row("tachyon", "blinn-fast", "", fast, once),
    // The object's colour, and not the light's.
    row("tachyon-metal", "blinn-phong", "", |at, n| metal(oracle::blinn_lobe(at, n)), once),
    row("tachyon-metal", "phong", "", |at, n| metal(oracle::phong_lobe(at, n)), once),
    row("vtk", "phong", "", phong, once),
    // h = L + (0, 0, 1), unless the viewer is local; ambient of the scene and of every light
    row("opengl", "blinn-phong", "", |at, n| blinn(Nle { e: AXIS, ..at }, n), both),
    row("opengl", "blinn-phong", "viewer = 'local'", blinn, both),
    row("direct3d9", "blinn-phong", "", blinn, both),
    row("ospray", "blinn-phong", "", ospray, once),
    row("three-js", "blinn-phong", "", three_js, once),
    row("pymol", "blinn-phong", "", |at, n| blinn(Nle { e: AXIS, ..at }, n), once),
    row("x3d", "blinn-phong", "", blinn, per_light),
    row("rtc", "phong", "", phong, per_light),
    row("collada", "phong", "", phong, once),
    row("collada", "blinn-phong", "", blinn, once),
];

const fn row(
    dialect: &'static str,
    model: &'static str,
    switch: &'static str,
    highlight: fn(Nle, f64) -> V,
    ambient: fn() -> V,
) -> Row {
    Row { dialect, model, switch, highlight, ambient }
}

fn times(a: V, b: V) -> V {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

/// `k_s` × a lobe × the light's × the material's specular colour.
fn tinted(lobe: f64) -> V {
    times(LIGHT_S, HIGHLIGHT).map(|c| K_S * lobe * c)
}

fn metal(lobe: f64) -> V {
    OBJECT.map(|c| K_S * lobe * c)
}

fn phong(at: Nle, n: f64) -> V {
    tinted(oracle::phong_lobe(at, n))
}

fn blinn(at: Nle, n: f64) -> V {
    tinted(oracle::blinn_lobe(at, n))
}

fn fast(at: Nle, n: f64) -> V {
    let x = oracle::blinn_lobe(at, 1.0);
    tinted(x / (n - n * x + x))
}

/// `phong` × (`phong_size` + 1)/2.
fn pov_albedo(at: Nle, n: f64) -> V {
    tinted(0.5 * (n + 1.0) * oracle::phong_lobe(at, n))
}

/// Highlight colour 1 + (1 − F)(pigment − 1), F a fit to the angle of the light.
fn pov_metallic(at: Nle, n: f64) -> V {
    let x = libm::acos(oracle::dot(at.n, at.l)) / FRAC_PI_2 - 1.12;
    let f = (0.014_567_225 / (x * x) - 0.011_612_903).clamp(0.0, 1.0);
    let metal = OBJECT.map(|c| 1.0 + (1.0 - f) * (c - 1.0));
    times(metal, tinted(oracle::phong_lobe(at, n)))
}

/// ks (n + 2)/(4π(2 − 2^(−n/2))) (N·H)^n, under a light of π.
fn ospray(at: Nle, n: f64) -> V {
    tinted((n + 2.0) / (4.0 * (2.0 - libm::exp2(-n / 2.0))) * oracle::blinn_lobe(at, n))
}

/// F(V·H) ¼ (n/2 + 1)/π (N·H)^n (N·L), F from specular to 1, under a light of π.
fn three_js(at: Nle, n: f64) -> V {
    let v_dot_h = (0.5 * (1.0 + oracle::dot(at.l, at.e))).sqrt();
    let lobe = 0.25 * (n / 2.0 + 1.0) * oracle::blinn_lobe(at, n) * oracle::dot(at.n, at.l);
    let f = HIGHLIGHT.map(|c| oracle::schlick(v_dot_h, K_S * c));
    times(LIGHT_S, f).map(|c| lobe * c)
}

fn once() -> V {
    times(AMBIENT, OBJECT).map(|c| K_A * c)
}

fn per_light() -> V {
    times(times(AMBIENT, LIGHT), OBJECT).map(|c| K_A * c)
}

fn both() -> V {
    let all = [AMBIENT[0] + LIGHT[0], AMBIENT[1] + LIGHT[1], AMBIENT[2] + LIGHT[2]];
    times(all, OBJECT).map(|c| K_A * c)
}

/// The material of a scene that writes this row.
fn written(row: &Row, n: f32) -> Material {
    let Row { dialect, model, switch, .. } = row;
    let text = format!(
        "version = 1\n[camera]\neye = [0, 0, 9]\nlook_at = [0, 0, 0]\n\
         [materials.m]\nmodel = '{model}'\ndialect = '{dialect}'\n{switch}\nk_a = {K_A}\nk_d = 0\n\
         k_s = {K_S}\nshininess = {n}\ncolor = {OBJECT:?}\nspecular_color = {HIGHLIGHT:?}\n\
         [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'm'\n"
    );
    let source = Memory::new().with("scene.toml", text.into_bytes());
    let reading = phong_scene::read("scene.toml", None, &source, &Limits::default());
    let scene = reading.scene.unwrap_or_else(|| panic!("{dialect}: {:?}", reading.diagnostics));
    let material = scene.materials.iter().find(|m| m.name == "m").unwrap();
    Material::new(&material.at(|_| Rgb::BLACK), Dir3::Z)
}

#[test]
fn every_dialect_written_in_a_scene_is_its_programs_formula() {
    let rgb = |v: V| Rgb::from(v.map(|c| c as f32));
    let mut dice = Dice::new(78);
    for row in &ROWS {
        for _ in 0..200 {
            let (at, n) = (dice.directions(), dice.between(1.0, 200.0));
            let (material, wide) = (written(row, n), f64::from(n));
            let light = LightSample {
                l: at.l,
                distance: 1.0,
                color: rgb(LIGHT),
                specular_color: rgb(LIGHT_S),
            };
            let terms = material.shade_light(at.n, Dir3::X, at.e, rgb(OBJECT), &light);
            let (given, found) = (Nle::from(at), terms.specular.to_array());
            let expected = (row.highlight)(given, wide);
            for c in 0..3 {
                let sway: f64 = given
                    .swayed(3e-7)
                    .map(|near| ((row.highlight)(near, wide)[c] - expected[c]).abs())
                    .sum();
                let tolerance = sway + 1e-6 * (3.0 + wide) * expected[c].abs() + 1e-30;
                let off = (f64::from(found[c]) - expected[c]).abs();
                assert!(
                    off <= tolerance,
                    "{} {} {}: {found:?}, not {expected:?}, of {at:?}, n = {n}",
                    row.dialect,
                    row.model,
                    row.switch
                );
            }
            let ambient = material.ambient(rgb(OBJECT), rgb(AMBIENT))
                + material.ambient_of_light(rgb(OBJECT), rgb(AMBIENT), &light);
            for (found, expected) in ambient.to_array().into_iter().zip((row.ambient)()) {
                assert!((f64::from(found) - expected).abs() < 1e-7, "{}", row.dialect);
            }
        }
    }
}

#[test]
fn no_dialect_is_without_a_formula() {
    for dialect in Dialect::ALL {
        assert!(ROWS.iter().any(|row| row.dialect == dialect.name()), "{}", dialect.name());
    }
}
