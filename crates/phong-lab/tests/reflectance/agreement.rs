//! Every formula against the oracle, over random directions.
//!
//! f32 holds a direction to 6e-8 and a cosine to about 1e-7. So an answer may be as far off as
//! directions 2e-7 away from those given would bring it, by the oracle, and a little for the
//! arithmetic beyond them; each test says how little.

use phong::math::Dir3;
use phong::reflectance::{Distribution, Fresnel, OrenNayarForm, Shadowing, WardForm};
use phong_lab::eval::{Directions, Lobe, Query, Value};
use phong_scene::Rgb;

use crate::directions::{Dice, number};
use crate::oracle::{self, Facets, Nle};

/// Directions tried on each formula.
const TRIALS: usize = 5000;

#[track_caller]
fn assert_close(found: f64, expected: f64, tolerance: f64, what: &dyn std::fmt::Debug) {
    let off = (found - expected).abs();
    assert!(
        off <= tolerance,
        "{found} for {expected}: off by {off:e}, {:e} of it, {:.2} times what may be; {what:?}",
        off / expected.abs(),
        off / tolerance
    );
}

/// Holds a formula to `oracle` at `at`; `relative` is what its arithmetic may lose.
#[track_caller]
fn assert_agrees(query: &Query, at: Directions, relative: f64, oracle: impl Fn(Nle) -> f64) {
    let given = Nle::from(at);
    let expected = oracle(given);
    let sway: f64 = given.swayed(2e-7).map(|near| (oracle(near) - expected).abs()).sum();
    assert_close(number(query), expected, sway + relative * expected.abs() + 1e-30, query);
}

fn exponent(dice: &mut Dice) -> f32 {
    match dice.below(4) {
        0 => 0.0,
        1 => dice.between(0.0, 10.0),
        _ => dice.between(10.0, 1000.0),
    }
}

/// A distribution, ours and the oracle's, and the relative error of a cosine that it magnifies.
fn facets(dice: &mut Dice) -> (Distribution, Facets, f64) {
    match dice.below(3) {
        0 => {
            let n = dice.between(0.0, 800.0);
            (Distribution::Blinn { n }, Facets::Blinn(f64::from(n)), f64::from(n))
        }
        1 => {
            let m = dice.between(0.05, 1.0);
            (Distribution::Beckmann { m }, Facets::Beckmann(f64::from(m)), 4.0)
        }
        _ => {
            let alpha = dice.between(0.05, 1.0);
            (Distribution::Ggx { alpha }, Facets::Ggx(f64::from(alpha)), 4.0)
        }
    }
}

const SHADOWINGS: [Shadowing; 3] =
    [Shadowing::Separable, Shadowing::Correlated, Shadowing::VCavity];

#[test]
fn the_mirrored_vector() {
    let mut dice = Dice::new(1);
    for _ in 0..TRIALS {
        let at = dice.directions();
        let Ok(Value::Direction(r)) = (Query::Reflect { n: at.n, l: at.l }).value() else {
            panic!("no direction")
        };
        let expected = oracle::mirrored(oracle::wide(at.n), oracle::wide(at.l));
        for (found, expected) in r.to_array().into_iter().zip(expected) {
            assert_close(f64::from(found), expected, 8e-7, &at);
        }
    }
}

#[test]
fn the_lobes_of_phong_and_blinn() {
    let mut dice = Dice::new(2);
    for _ in 0..TRIALS {
        let (at, alpha) = (dice.directions(), exponent(&mut dice));
        let wide = f64::from(alpha);
        let relative = 4e-7 * (1.0 + wide);
        let specular = |lobe| Query::Specular { lobe, at, alpha };
        assert_agrees(&specular(Lobe::Phong), at, relative, |at| oracle::phong_lobe(at, wide));
        assert_agrees(&specular(Lobe::Blinn), at, relative, |at| oracle::blinn_lobe(at, wide));
    }
}

#[test]
fn modified_phong_and_blinn_phong() {
    let mut dice = Dice::new(3);
    for _ in 0..TRIALS {
        let (at, n) = (dice.directions(), exponent(&mut dice));
        let (k_d, k_s) = (dice.between(0.0, 1.0), dice.between(0.0, 1.0));
        let [d, s, wide] = [k_d, k_s, n].map(f64::from);
        let relative = 4e-7 * (3.0 + wide);
        let query = Query::ModifiedPhongBrdf { at, k_d, k_s, n };
        assert_agrees(&query, at, relative, |at| oracle::modified_phong(at, d, s, wide));
        for exact in [true, false] {
            let query = Query::BlinnPhongBrdf { at, k_d, k_s, n, exact };
            assert_agrees(&query, at, relative, |at| {
                oracle::blinn_phong_brdf(at, d, s, wide, exact)
            });
        }
    }
}

#[test]
fn fresnel() {
    let mut dice = Dice::new(4);
    for _ in 0..TRIALS {
        let [cos, f0] = [dice.between(0.001, 1.0), dice.between(0.0, 1.0)];
        let [eta, k] = [dice.between(0.05, 4.0), dice.between(0.0, 8.0)];
        let [c, f, n, i] = [cos, f0, eta, k].map(f64::from);
        let schlick = Query::Schlick { cos, f0 };
        assert_close(
            number(&schlick),
            oracle::schlick(c, f),
            1e-6 * oracle::schlick(c, f),
            &schlick,
        );
        let conductor = Query::Conductor { cos, eta, k };
        assert_close(number(&conductor), oracle::conductor(c, n, i), 1e-6, &conductor);
        // Towards the critical angle the slope is infinite.
        let dielectric = Query::Dielectric { cos, eta };
        let expected = oracle::dielectric(c, n);
        let sway =
            [c + 2e-7, c - 2e-7].map(|c| (oracle::dielectric(c.min(1.0), n) - expected).abs());
        assert_close(number(&dielectric), expected, 2e-6 + sway[0] + sway[1], &dielectric);
    }
}

#[test]
fn densities_and_lambdas() {
    let mut dice = Dice::new(5);
    for _ in 0..TRIALS {
        let (distribution, oracle, magnified) = facets(&mut dice);
        let cos = dice.between(0.02, 1.0);
        let theta = libm::acos(f64::from(cos));
        let density = Query::Density { distribution, n_dot_h: cos };
        // Beckmann's exponent, up to 100 here, magnifies rounding as Blinn's does.
        let expected = oracle.density(theta);
        let decay = libm::log(oracle.density(0.0) / expected.max(1e-40));
        let relative = 2e-7 * (magnified + decay);
        assert_close(number(&density), expected, relative * expected + 1e-30, &density);
        let lambda = Query::Lambda { distribution, cos };
        let expected = oracle.lambda(theta);
        // Ours subtracts two f32 that are nearly equal where Λ is small.
        assert_close(
            number(&lambda),
            expected,
            2e-6 * expected + 1e-7 * expected.max(0.0).sqrt() + 1e-15,
            &lambda,
        );
    }
}

#[test]
fn microfacets() {
    let mut dice = Dice::new(6);
    for trial in 0..TRIALS {
        let (at, (distribution, oracle, magnified)) = (dice.directions(), facets(&mut dice));
        let (kind, fresnel) = (trial % 3, Fresnel::None);
        let query =
            Query::MicrofacetBrdf { at, distribution, shadowing: SHADOWINGS[kind], fresnel };
        assert_agrees(&query, at, 3e-6 + 2e-7 * magnified, |at| oracle.brdf(kind, at));
    }
}

#[test]
fn the_fresnel_of_microfacets_is_that_of_the_angle_between_l_and_h() {
    let mut dice = Dice::new(7);
    for _ in 0..TRIALS {
        let at = dice.directions();
        let [eta, k] = [dice.between(0.1, 3.0), dice.between(1.0, 5.0)];
        let brdf = |fresnel| {
            let distribution = Distribution::Ggx { alpha: 0.5 };
            let shadowing = Shadowing::Correlated;
            number(&Query::MicrofacetBrdf { at, distribution, shadowing, fresnel })
        };
        let Nle { l, e, .. } = at.into();
        let cos = (0.5 * (1.0 + oracle::dot(l, e))).sqrt();
        let mirror = brdf(Fresnel::None);
        let metal = brdf(Fresnel::Conductor { eta: Rgb::grey(eta), k: Rgb::grey(k) });
        let expected = oracle::conductor(cos, f64::from(eta), f64::from(k));
        assert_close(metal / mirror, expected, 4e-6, &at);
        let schlick = brdf(Fresnel::Schlick { f0: Rgb::grey(0.1) });
        assert_close(schlick / mirror, oracle::schlick(cos, 0.1), 4e-6, &at);
    }
}

#[test]
fn oren_nayar() {
    let mut dice = Dice::new(8);
    for _ in 0..TRIALS {
        let at = dice.directions();
        let [rho, sigma] = [dice.between(0.0, 1.0), dice.between(0.0, 1.5)];
        let [r, s] = [rho, sigma].map(f64::from);
        let query = |form| Query::OrenNayarBrdf { at, rho, sigma, form };
        assert_agrees(&query(OrenNayarForm::Qualitative), at, 2e-6, |at| {
            oracle::oren_nayar_qualitative(at, r, s)
        });
        for interreflection in [true, false] {
            // Opposite in azimuth, terms of both signs cancel: hence more of a little.
            assert_agrees(&query(OrenNayarForm::Full { interreflection }), at, 5e-5, |at| {
                oracle::oren_nayar_full(at, r, s, interreflection)
            });
        }
    }
}

#[test]
fn ward() {
    let mut dice = Dice::new(9);
    for _ in 0..TRIALS {
        let (at, x) = (dice.directions(), dice.direction());
        let [a_x, a_y] = [(); 2].map(|()| dice.between(0.05, 1.0));
        let (tangent, wide) = (oracle::wide(x), [a_x, a_y].map(f64::from));
        if oracle::dot(oracle::wide(at.n), tangent).abs() > 0.99 {
            continue; // such a tangent says little
        }
        for (form, mended) in [(WardForm::Ward, false), (WardForm::Gmd, true)] {
            let query = Query::WardBrdf { at, k_s: 1.0, x, a_x, a_y, form };
            assert_agrees(&query, at, 2e-5, |at| oracle::ward(at, tangent, wide, mended));
        }
    }
}

#[test]
fn light_and_eye_may_change_places_in_every_brdf() {
    let mut dice = Dice::new(10);
    for _ in 0..TRIALS / 10 {
        let Directions { n, l, e } = dice.directions();
        let (x, (distribution, _, _)) = (dice.direction(), facets(&mut dice));
        for query in brdfs(distribution, x) {
            let there = number(&query(Directions { n, l, e }));
            let back = number(&query(Directions { n, l: e, e: l }));
            assert_close(there, back, 2e-4 * back + 1e-6, &query(Directions { n, l, e }));
        }
    }
}

/// Every BRDF there is, as queries.
fn brdfs(distribution: Distribution, x: Dir3) -> Vec<Box<dyn Fn(Directions) -> Query>> {
    let mut all: Vec<Box<dyn Fn(Directions) -> Query>> = vec![
        Box::new(|at| Query::ModifiedPhongBrdf { at, k_d: 0.3, k_s: 0.6, n: 20.0 }),
        Box::new(|at| Query::BlinnPhongBrdf { at, k_d: 0.3, k_s: 0.6, n: 80.0, exact: true }),
        Box::new(|at| {
            let form = OrenNayarForm::Full { interreflection: true };
            Query::OrenNayarBrdf { at, rho: 0.7, sigma: 0.4, form }
        }),
        Box::new(|at| {
            let form = OrenNayarForm::Qualitative;
            Query::OrenNayarBrdf { at, rho: 0.7, sigma: 0.4, form }
        }),
    ];
    for form in [WardForm::Ward, WardForm::Gmd] {
        all.push(Box::new(move |at| Query::WardBrdf { at, k_s: 1.0, x, a_x: 0.4, a_y: 0.2, form }));
    }
    for shadowing in SHADOWINGS {
        let fresnel = Fresnel::Schlick { f0: Rgb::grey(0.5) };
        all.push(Box::new(move |at| Query::MicrofacetBrdf {
            at,
            distribution,
            shadowing,
            fresnel,
        }));
    }
    all
}
