use super::*;

fn lobe(text: &str) -> Lobe {
    text.parse().unwrap()
}

fn fitted(from: &str, to: Model) -> Fit {
    fit(lobe(from), to).unwrap()
}

#[track_caller]
fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found}, not {expected} ± {tolerance}");
}

#[test]
fn blinns_exponent_is_about_four_times_phongs() {
    for p in [8.0, 32.0, 200.0] {
        let fit = fitted(&format!("phong:{p}"), Model::BlinnPhong);
        assert_near(fit.to.number, 4.0 * p + 1.3, 0.05);
        assert_near(fit.formula.unwrap().value, 4.0 * p + 0.7, 0.05);
        assert!(!fit.at_the_end);
    }
}

#[test]
fn the_match_holds_in_the_plane_of_incidence_and_fails_across_it() {
    let fit = fitted("phong:32", Model::BlinnPhong);
    assert!(fit.residual.in_plane < 0.005, "{:?}", fit.residual);
    assert_near(fit.residual.across, 0.45, 0.01);
    for at in &fit.angles {
        // What matches across is the exponent times cos² θ; a little more where the lobe is wide.
        let cos = libm::cos(at.theta.to_radians());
        let [in_plane, across] = at.best_alone.map(|n| n / fit.to.number);
        assert_near(in_plane, 1.0, 0.005);
        assert_near(across, cos * cos, 0.01);
    }
    let across = |i: usize| fit.angles[i].half_width_to[1].unwrap();
    for (i, width) in [11.9, 10.3, 5.95, 3.1].into_iter().enumerate() {
        assert_near(across(i), width, 0.05);
        assert_near(fit.angles[i].half_width_from[1].unwrap(), 11.88, 0.01);
    }
}

#[test]
fn the_formula_makes_the_half_widths_equal() {
    for p in [1.0, 5.0, 32.0, 1000.0] {
        let phong = lobe(&format!("phong:{p}"));
        let formula = fit(phong, Model::BlinnPhong).unwrap().formula.unwrap();
        let blinn = Lobe::new(Model::BlinnPhong, formula.value).unwrap();
        let [a, b] = [phong, blinn].map(|l| l.half_width(0.0, Slice::InPlane).unwrap());
        // Cosines in f32: at 1000 the half angle is known to a few in ten thousand.
        assert_near(b / a, 1.0, 2e-4);
        // And backwards it gives the exponent it came from.
        let back = fit(blinn, Model::Phong).unwrap().formula.unwrap();
        assert_near(back.value / p, 1.0, 1e-9);
    }
    assert_eq!(fitted("blinn-phong:1.5", Model::Phong).formula, None);
}

#[test]
fn a_lobe_is_most_like_itself() {
    for text in [
        "phong:32",
        "blinn-phong:5",
        "mtl:200",
        "ggx:0.3",
        "gltf:0.5",
        "beckmann:0.1",
        "cook-torrance:0.4",
        "ward:0.2",
        "x3d:0.2",
        "ospray:10",
        "pov-specular:0.05",
    ] {
        let lobe = lobe(text);
        let fit = fit(lobe, lobe.model).unwrap();
        assert_near(fit.to.number / lobe.number, 1.0, 1e-4);
        assert_near(fit.formula.unwrap().value / lobe.number, 1.0, 1e-12);
        assert!(fit.residual.in_plane < 1e-3 && fit.residual.across < 1e-3, "{text}: {fit:?}");
    }
}

#[test]
fn a_unit_of_another_program_is_the_same_lobe() {
    for (text, to, number) in [
        ("x3d:0.2", Model::BlinnPhong, 25.6),
        ("ospray:10", Model::BlinnPhong, 40.0),
        ("pov-specular:0.05", Model::BlinnPhong, 20.0),
        ("mtl:256", Model::X3d, 2.0),
        ("gltf:0.5", Model::Ggx, 0.25),
    ] {
        let fit = fitted(text, to);
        assert_near(fit.formula.unwrap().value, number, 1e-9);
        assert_near(fit.to.number / number, 1.0, 1e-4);
    }
}

#[test]
fn roughness_by_formula_is_walters() {
    // α² = 2/(n + 2), with n = 4α for Phong's lobe; glTF's is its root.
    let formula = |from, to| fitted(from, to).formula.unwrap().value;
    assert_near(formula("blinn-phong:198", Model::Ggx), 0.1, 1e-12);
    assert_near(formula("phong:12", Model::Beckmann), 0.2, 1e-12);
    assert_near(formula("mtl:198", Model::Gltf), 0.1_f64.sqrt(), 1e-12);
    assert_near(formula("ggx:0.1", Model::BlinnPhong), 198.0, 1e-9);
    assert_near(formula("beckmann:0.2", Model::Phong), 12.0, 1e-9);
    assert_near(formula("beckmann:0.3", Model::Ward), 0.3, 1e-12);
    assert_eq!(fitted("ggx:1.2", Model::Phong).formula, None);
}

#[test]
fn beckmanns_facets_are_like_blinns_of_walters_exponent() {
    // Smooth facets: D is Gaussian in both; only G and the cosines differ.
    let fit = fitted("blinn-phong:1998", Model::Beckmann);
    assert_near(fit.to.number / fit.formula.unwrap().value, 1.0, 0.01);
    assert!(fit.angles[0].residual.in_plane < 0.01, "{:?}", fit.angles[0]);
}

#[test]
fn what_programs_make_of_an_exponent_differs_wildly() {
    let used = |from: &str| -> Vec<f64> {
        fitted(from, Model::Gltf).in_use.iter().map(|in_use| in_use.roughness).collect()
    };
    // Theory, several, Blender, obj2gltf, FBX.
    for (from, row) in [
        ("mtl:10", [0.639, 0.408, 0.900, 0.990, 0.668]),
        ("mtl:200", [0.315, 0.100, 0.553, 0.800, 0.236]),
        ("phong:96", [0.268, 0.143, 0.690, 0.904, 0.342]),
    ] {
        for (found, expected) in used(from).into_iter().zip(row) {
            assert_near(found, expected, 6e-4);
        }
    }
    assert!(fitted("ggx:0.5", Model::Gltf).in_use.is_empty());
    assert!(fitted("mtl:10", Model::Phong).in_use.is_empty());
}

#[test]
fn holding_two_lobes_together_changes_neither() {
    let (a, b) = (lobe("phong:32"), lobe("blinn-phong:32"));
    let held = hold(a, b).unwrap();
    assert_eq!((held.from, held.to), (a, b));
    let twice =
        held.angles[0].half_width_to[0].unwrap() / held.angles[0].half_width_from[0].unwrap();
    assert_near(twice, 2.0, 1e-4);
    assert!(held.residual.in_plane > 0.4);
}

#[test]
fn a_fit_that_runs_into_the_end_of_the_range_says_so() {
    assert!(fitted("phong:1e6", Model::Ggx).at_the_end);
    assert!(!fitted("phong:1e4", Model::Ggx).at_the_end);
}

#[test]
fn the_same_question_has_the_same_answer() {
    let ask = || fitted("beckmann:0.3", Model::Ggx);
    assert_eq!(ask(), ask());
}

#[test]
fn what_is_no_lobe_is_told_with_a_way_out() {
    let told = |text: &str| text.parse::<Lobe>().unwrap_err().to_string();
    assert!(told("fong:3").starts_with("no model `fong`; there are phong, blinn-phong, mtl,"));
    assert_eq!(told("ggx"), "`ggx` needs its roughness: `ggx:0.2`");
    assert_eq!(told("phong:"), "`` is not a number");
    assert_eq!(told("phong:3x"), "`3x` is not a number");
    for text in ["phong:0", "phong:-1", "phong:1e9", "phong:nan", "phong:inf"] {
        assert!(
            told(text).ends_with("of `phong` is not between 0.01 and 1000000"),
            "{}",
            told(text)
        );
    }
}

#[test]
fn a_lobe_prints_as_it_is_read() {
    for (number, text) in
        [(32.0, "phong:32"), (129.28, "phong:129.3"), (4800.4, "phong:4800"), (0.05, "phong:0.05")]
    {
        assert_eq!(Lobe::new(Model::Phong, number).unwrap().to_string(), text);
    }
    assert_eq!(lobe("blinn:7").to_string(), "blinn-phong:7");
}
