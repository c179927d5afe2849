//! How much light the models give back, by quadrature over the hemisphere.
//!
//! Midpoint sums in f64 over the renderer's own f32 values.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use phong::math::Dir3;
use phong::reflectance::{Distribution, Fresnel, OrenNayarForm, Shadowing, WardForm};
use phong::reflectance::{blinn_phong, phong as phong_model};
use phong_lab::eval::{Directions, Lobe, Query};

use crate::directions::{number, polar};

/// `∫ f(θ) dω` of something that does not depend on azimuth; θ in degrees.
fn around_the_normal(steps: u32, f: impl Fn(f64) -> f64) -> f64 {
    let step = FRAC_PI_2 / f64::from(steps);
    (0..steps)
        .map(|i| {
            let theta = (f64::from(i) + 0.5) * step;
            f(theta.to_degrees()) * libm::sin(theta) * TAU * step
        })
        .sum()
}

/// `∫ f(ω) dω` over the hemisphere; `steps` in θ, four times as many in azimuth.
fn over_the_hemisphere(steps: u32, f: impl Fn(Dir3) -> f64) -> f64 {
    let turns = 4 * steps;
    around_the_normal(steps, |theta| {
        let turn = |j| f(polar(theta, 360.0 * (f64::from(j) + 0.5) / f64::from(turns)));
        (0..turns).map(turn).sum::<f64>() / f64::from(turns)
    })
}

/// The share of light from `theta` degrees that a BRDF gives back: `∫ f (N·E) dω`.
fn albedo(theta: f64, steps: u32, brdf: impl Fn(Directions) -> Query) -> f64 {
    let l = polar(theta, 0.0);
    over_the_hemisphere(steps, |e| {
        f64::from(e.dot(Dir3::Z)) * number(&brdf(Directions { n: Dir3::Z, l, e }))
    })
}

#[track_caller]
fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found}, not {expected}");
}

fn face_on(theta: f64) -> Directions {
    Directions { n: Dir3::Z, l: Dir3::Z, e: polar(theta, 0.0) }
}

/// How near the energy of a lobe is found: at exponent 1000 a cosine's rounding counts a thousandfold.
const LOBE: f64 = 4e-5;

#[test]
fn raising_the_exponent_takes_energy_out_of_the_lobe() {
    // The lobe integrates to 2π/(α+1), while its peak stays 1.
    for alpha in [0.0, 1.0, 3.0, 9.0, 32.0, 200.0, 1000.0] {
        let lobe =
            |theta| number(&Query::Specular { lobe: Lobe::Phong, at: face_on(theta), alpha });
        let exact = TAU / (f64::from(alpha) + 1.0);
        assert_near(around_the_normal(4000, lobe) / exact, 1.0, LOBE);
    }
}

#[test]
fn normalized_lobes_have_the_same_energy_at_every_exponent() {
    for n in [1.0, 3.0, 10.0, 32.0, 200.0, 1000.0] {
        for times_cosine in [false, true] {
            let energy = |lobe, factor: f32| {
                let cosine =
                    |theta: f64| if times_cosine { libm::cos(theta.to_radians()) } else { 1.0 };
                let value = |theta| {
                    cosine(theta) * number(&Query::Specular { lobe, at: face_on(theta), alpha: n })
                };
                f64::from(factor) / PI * around_the_normal(4000, value)
            };
            let phong = energy(Lobe::Phong, phong_model::normalization(n, times_cosine));
            assert_near(phong, 1.0, LOBE);
            let blinn = energy(Lobe::Blinn, blinn_phong::normalization(n, times_cosine));
            assert_near(blinn, 1.0, LOBE);
        }
    }
}

#[test]
fn the_short_blinn_factor_is_too_bright_by_some_percent() {
    for (n, percent) in [(1.0, 2.4), (9.0, 7.5), (200.0, 1.0)] {
        let ratio = blinn_phong::short_normalization(n) / blinn_phong::normalization(n, true);
        assert_near(100.0 * (f64::from(ratio) - 1.0), percent, 0.06);
    }
}

#[test]
fn modified_phong_gives_back_at_most_all_light_and_little_at_grazing_angles() {
    for (theta, share) in [(0.0, 1.00), (30.0, 0.87), (60.0, 0.50), (75.0, 0.26), (85.0, 0.12)] {
        let found =
            albedo(theta, 200, |at| Query::ModifiedPhongBrdf { at, k_d: 0.0, k_s: 1.0, n: 32.0 });
        assert_near(found, share, 0.005);
    }
}

#[test]
fn facets_cast_a_shadow_of_exactly_their_ground() {
    for distribution in [
        Distribution::Blinn { n: 0.0 },
        Distribution::Blinn { n: 100.0 },
        Distribution::Beckmann { m: 0.1 },
        Distribution::Beckmann { m: 0.6 },
        Distribution::Ggx { alpha: 0.1 },
        Distribution::Ggx { alpha: 0.6 },
    ] {
        let shadow = around_the_normal(20_000, |theta| {
            let cos = libm::cos(theta.to_radians());
            cos * number(&Query::Density { distribution, n_dot_h: cos as f32 })
        });
        assert_near(shadow, 1.0, 2e-4);
    }
}

#[test]
fn the_facets_that_an_eye_sees_fill_exactly_what_it_sees() {
    // ∫ D(h) (E·h)₊ dh = (N·E)(1 + Λ(E)): what is not hidden has the area N·E.
    for distribution in [
        Distribution::Beckmann { m: 0.3 },
        Distribution::Beckmann { m: 0.8 },
        Distribution::Ggx { alpha: 0.3 },
        Distribution::Ggx { alpha: 0.8 },
    ] {
        for theta in [10.0, 45.0, 70.0, 85.0] {
            let e = polar(theta, 0.0);
            let facing = over_the_hemisphere(300, |h| {
                let n_dot_h = h.dot(Dir3::Z);
                f64::from(e.cos(h)) * number(&Query::Density { distribution, n_dot_h })
            });
            let cos = e.dot(Dir3::Z);
            let lambda = number(&Query::Lambda { distribution, cos });
            assert_near(facing / (f64::from(cos) * (1.0 + lambda)), 1.0, 1e-3);
        }
    }
}

#[test]
fn microfacets_never_give_back_more_light_than_they_get() {
    for distribution in [
        Distribution::Beckmann { m: 0.3 },
        Distribution::Beckmann { m: 0.8 },
        Distribution::Ggx { alpha: 0.3 },
        Distribution::Ggx { alpha: 0.8 },
    ] {
        for shadowing in [Shadowing::Separable, Shadowing::Correlated, Shadowing::VCavity] {
            for theta in [0.0, 40.0, 80.0] {
                let fresnel = Fresnel::None;
                let share = albedo(theta, 100, |at| Query::MicrofacetBrdf {
                    at,
                    distribution,
                    shadowing,
                    fresnel,
                });
                assert!(share <= 1.001, "{distribution:?} {shadowing:?} at {theta}: {share}");
                assert!(share > 0.4, "{distribution:?} {shadowing:?} at {theta}: {share}");
            }
        }
    }
}

#[test]
fn smooth_facets_give_back_nearly_all() {
    let distribution = Distribution::Ggx { alpha: 0.1 };
    let share = albedo(30.0, 300, |at| Query::MicrofacetBrdf {
        at,
        distribution,
        shadowing: Shadowing::Correlated,
        fresnel: Fresnel::None,
    });
    assert!((0.98..=1.0).contains(&share), "{share}");
}

#[test]
fn wards_mended_form_gives_back_at_most_all_light_where_the_published_one_does_not() {
    let share = |form, theta| {
        albedo(theta, 300, |at| Query::WardBrdf {
            at,
            k_s: 1.0,
            x: Dir3::X,
            a_x: 0.2,
            a_y: 0.2,
            form,
        })
    };
    for theta in [0.0, 30.0, 60.0, 80.0, 88.0] {
        let mended = share(WardForm::Gmd, theta);
        assert!(mended <= 1.001, "at {theta}: {mended}");
    }
    assert!(share(WardForm::Gmd, 0.0) > 0.95);
    // Towards the horizon the published form grows without bound, but loses light before.
    assert!(share(WardForm::Ward, 60.0) < 1.0);
}

#[test]
fn rough_diffuse_surfaces_give_back_less_than_lambert_but_for_two_percent() {
    for sigma in [0.0, 0.2, 0.5] {
        for form in [
            OrenNayarForm::Qualitative,
            OrenNayarForm::Full { interreflection: false },
            OrenNayarForm::Full { interreflection: true },
        ] {
            for theta in [0.0, 45.0, 80.0] {
                let share =
                    albedo(theta, 60, |at| Query::OrenNayarBrdf { at, rho: 1.0, sigma, form });
                assert!(share <= 1.02, "σ {sigma}, {form:?} at {theta}: {share}");
            }
        }
    }
}

#[test]
fn read_as_a_brdf_the_classical_term_is_not_reciprocal() {
    // k_s (R·E)^α added bare is a BRDF of (R·E)^α/(N·L): it changes when light and eye do.
    let brdf = |l: Dir3, e: Dir3| {
        let at = Directions { n: Dir3::Z, l, e };
        number(&Query::Specular { lobe: Lobe::Phong, at, alpha: 5.0 }) / f64::from(l.dot(Dir3::Z))
    };
    let (a, b) = (polar(20.0, 0.0), polar(60.0, 150.0));
    assert!((brdf(a, b) / brdf(b, a) - 1.0).abs() > 0.4);
}
