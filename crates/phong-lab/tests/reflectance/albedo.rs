//! Every model as a material has it: how much light it gives back, by quadrature, and whether light
//! and eye may change places. The figures are a table.
//!
//! `cargo test -p phong --test reflectance albedo -- --nocapture` prints it; with `PHONG_BLESS=1` it
//! is written anew, to albedo.md.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use std::path::Path;

use phong::math::{Dir3, Frame};
use phong::reflectance::{
    BlinnPhong, Distribution, Falloff, Fresnel, Incident, Lambert, Microfacet, OrenNayar,
    OrenNayarForm, Phong, Reflectance, Shadowing, Switches, Ward, WardForm,
};
use phong_lab::eval::Directions;
use phong_scene::Rgb;

use crate::directions::{Dice, polar};

/// Angles of the light, degrees.
const ANGLES: [f64; 3] = [0.0, 45.0, 80.0];
const TERM: Switches = Switches { times_cosine: false, normalize: false };
const BRDF: Switches = Switches { times_cosine: true, normalize: true };

/// A model of weight 1 over black, and what holds of it.
struct Row {
    name: String,
    model: Reflectance,
    /// The most that it gives back of the light it gets, whatever the angle; `None`: it is not
    /// bounded by design.
    most: Option<f64>,
    reciprocal: bool,
}

fn brdf(name: impl Into<String>, most: f64, model: Reflectance) -> Row {
    Row { name: name.into(), model, most: Some(most), reciprocal: true }
}

/// The lobe as the equation adds it: no BRDF, since it is not multiplied by N·L.
fn term(name: impl Into<String>, model: Reflectance) -> Row {
    Row { most: None, reciprocal: false, ..brdf(name, 1.0, model) }
}

fn facets(distribution: Distribution, shadowing: Shadowing, fresnel: Fresnel) -> Reflectance {
    Reflectance::Microfacet(Microfacet { k_d: 0.0, k_s: 1.0, distribution, shadowing, fresnel })
}

fn phong(alpha: f32, switches: Switches) -> Reflectance {
    Reflectance::Phong(Phong::new(0.0, 1.0, alpha, switches))
}

fn blinn(alpha: f32, switches: Switches) -> BlinnPhong {
    BlinnPhong::new(0.0, 1.0, alpha, switches)
}

fn rough(degrees: f32, form: OrenNayarForm) -> Reflectance {
    Reflectance::OrenNayar(OrenNayar { k_d: 1.0, sigma: degrees.to_radians(), form })
}

fn ward(a_x: f32, a_y: f32, form: WardForm) -> Reflectance {
    Reflectance::Ward(Ward { k_d: 0.0, k_s: 1.0, a_x, a_y, form })
}

fn rows() -> Vec<Row> {
    use Distribution::{Beckmann, Blinn, Ggx};
    use Shadowing::{Correlated, Implicit, Separable, VCavity};
    let mirror = Fresnel::None;
    let glass = Fresnel::Dielectric { eta: 1.5 };
    let gold =
        Fresnel::Conductor { eta: Rgb::new(0.143, 0.375, 1.442), k: Rgb::new(3.983, 2.386, 1.603) };
    let full = OrenNayarForm::Full { interreflection: true };
    let fast = blinn(32.0, TERM).with_falloff(Falloff::Rational);
    let mut rows = vec![brdf("Lambert", 1.0, Reflectance::Lambert(Lambert { k_d: 1.0 }))];
    rows.extend([20.0, 40.0].map(|degrees| {
        let model = rough(degrees, OrenNayarForm::Qualitative);
        brdf(format!("Oren–Nayar, qualitative, σ {degrees}°"), 1.02, model)
    }));
    rows.push(brdf("Oren–Nayar, full, σ 40°", 1.02, rough(40.0, full)));
    rows.extend([3.0, 32.0, 200.0].map(|n| term(format!("Phong's term, α {n}"), phong(n, TERM))));
    rows.push(term("Blinn's term, α 32", Reflectance::BlinnPhong(blinn(32.0, TERM))));
    rows.push(term("Blinn's term, fast, α 32", Reflectance::BlinnPhong(fast)));
    rows.extend(
        [3.0, 32.0, 200.0].map(|n| brdf(format!("modified Phong, n {n}"), 1.0, phong(n, BRDF))),
    );
    rows.push(Row {
        most: None,
        ..brdf("Blinn–Phong BRDF, n 32", 1.0, Reflectance::BlinnPhong(blinn(32.0, BRDF)))
    });
    rows.push(brdf("three.js, n 30, F 1", 1.0, facets(Blinn { n: 30.0 }, Implicit, mirror)));
    rows.extend([0.1, 0.3, 0.6].map(|m| {
        let model = facets(Beckmann { m }, VCavity, mirror);
        brdf(format!("Cook–Torrance, Beckmann {m}"), 1.0, model)
    }));
    rows.push(brdf("Cook–Torrance, Blinn n 32", 1.0, facets(Blinn { n: 32.0 }, VCavity, mirror)));
    rows.extend([("separable", Separable), ("correlated", Correlated)].map(|(name, shadowing)| {
        brdf(format!("Beckmann 0.3, {name}"), 1.0, facets(Beckmann { m: 0.3 }, shadowing, mirror))
    }));
    rows.extend(
        [0.1, 0.3, 0.6, 0.9].map(|alpha| {
            brdf(format!("GGX {alpha}"), 1.0, facets(Ggx { alpha }, Correlated, mirror))
        }),
    );
    rows.extend([("gold, green", gold), ("glass η 1.5", glass)].map(|(name, fresnel)| {
        brdf(format!("GGX 0.3, {name}"), 1.0, facets(Ggx { alpha: 0.3 }, Correlated, fresnel))
    }));
    rows.push(Row {
        most: None,
        ..brdf("Ward 0.2, as published", 1.0, ward(0.2, 0.2, WardForm::Ward))
    });
    rows.push(brdf("Ward 0.2, mended", 1.0, ward(0.2, 0.2, WardForm::Gmd)));
    rows.push(brdf("Ward 0.4 × 0.1, mended", 1.0, ward(0.4, 0.1, WardForm::Gmd)));
    rows
}

/// π f (N·L), or the bare term: what white light from `l` adds, in green.
fn added(model: &Reflectance, n: Dir3, l: Dir3, e: Dir3) -> f64 {
    let light = Incident { l, c_d: Rgb::WHITE, c_s: Rgb::WHITE, color: Rgb::WHITE };
    // Some direction of the world, as a shape would give it.
    let grain = Dir3::X;
    let terms = model.shade_light(n, grain, e, light);
    f64::from(terms.diffuse.g) + f64::from(terms.specular.g)
}

/// The share of light from `theta` degrees that is given back: `∫ f (N·E) dω`.
///
/// In polar coordinates around the mirror direction, where the steps are finest.
fn albedo(model: &Reflectance, theta: f64) -> f64 {
    const STEPS: u32 = 400;
    const TURNS: u32 = 400;
    let l = polar(theta, 0.0);
    let frame = Frame::around(Dir3::Z.mirror(l));
    let [x, y, z] = [frame.x, frame.y, frame.z].map(Dir3::to_vec);
    let mut sum = 0.0;
    for i in 0..STEPS {
        // ψ = π u³: most steps where a narrow lobe has its peak.
        let u = (f64::from(i) + 0.5) / f64::from(STEPS);
        let (sin, cos) = libm::sincos(PI * u * u * u);
        let weight = sin * 3.0 * PI * u * u / f64::from(STEPS) * TAU / f64::from(TURNS);
        for j in 0..TURNS {
            let (sin_p, cos_p) = libm::sincos(TAU * (f64::from(j) + 0.5) / f64::from(TURNS));
            let e = (sin * cos_p) as f32 * x + (sin * sin_p) as f32 * y + cos as f32 * z;
            let e = Dir3::new(e).unwrap();
            let n_dot_e = f64::from(e.dot(Dir3::Z));
            if n_dot_e > 0.0 {
                sum += weight * n_dot_e * added(model, Dir3::Z, l, e);
            }
        }
    }
    sum / (PI * f64::from(l.dot(Dir3::Z)))
}

#[test]
fn no_model_that_is_bounded_gives_back_more_light_than_it_gets_and_the_albedo_table_says_so() {
    let mut table = "| model, of weight 1 | light at 0° | 45° | 80° | reciprocal |\n\
                     |---|---|---|---|---|\n"
        .to_owned();
    for Row { name, model, most, reciprocal } in rows() {
        let shares = ANGLES.map(|theta| albedo(&model, theta));
        if let Some(most) = most {
            // The sums themselves are good to 2e-3, at the horizon's edge.
            assert!(shares.iter().all(|share| *share <= most + 2e-3), "{name}: {shares:?}");
        }
        let [face_on, slanted, grazing] = shares;
        let reciprocal = if reciprocal { "yes" } else { "no" };
        writeln!(table, "| {name} | {face_on:.2} | {slanted:.2} | {grazing:.2} | {reciprocal} |")
            .unwrap();
    }
    println!("{table}");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reflectance/albedo.md");
    if std::env::var_os("PHONG_BLESS").is_some_and(|v| v == "1") {
        std::fs::write(&path, &table).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap();
    assert_eq!(written, table, "albedo.md is not what is measured now; see this file's head");
}

#[test]
fn the_quadrature_is_exact_where_the_answer_is_known() {
    // ∫ (N·E) dω = π; and Phong's term face on, (1/π) ∫ cos^(α+1) dω = 2/(α + 2).
    let lambert = Reflectance::Lambert(Lambert { k_d: 1.0 });
    for theta in ANGLES {
        assert!((albedo(&lambert, theta) - 1.0).abs() < 2e-3);
    }
    for alpha in [3.0, 32.0, 200.0] {
        let found = albedo(&phong(alpha, TERM), 0.0);
        let exact = 2.0 / (f64::from(alpha) + 2.0);
        assert!((found / exact - 1.0).abs() < 1e-3, "{alpha}: {found}, not {exact}");
        assert!((albedo(&phong(alpha, BRDF), 0.0) - 1.0).abs() < 1e-3);
    }
}

#[test]
fn light_and_eye_may_change_places_in_every_brdf_and_in_no_bare_term() {
    for Row { name, model, reciprocal, .. } in rows() {
        let (mut dice, mut apart) = (Dice::new(11), 0);
        for _ in 0..500 {
            let Directions { n, l, e } = dice.directions();
            let there = added(&model, n, l, e) / f64::from(l.dot(n));
            let back = added(&model, n, e, l) / f64::from(e.dot(n));
            if (there - back).abs() > 3e-4 * back.abs() + 1e-6 {
                apart += 1;
                assert!(!reciprocal, "{name}: {there} and {back} at {n:?} {l:?} {e:?}");
            }
        }
        assert!(reciprocal || apart > 10, "{name} seems reciprocal: {apart} of 500 differ");
    }
}
