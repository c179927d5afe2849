//! What the lecture says of vectors and numbers.

use glam::Vec3;
use phong::math::{Dir3, reflect};
use phong::reflectance::{Distribution, Incident, Phong, Reflectance, Switches};
use phong::terms::Terms;
use phong_lab::eval::{Directions, Lobe, Query, Value};
use phong_scene::Rgb;

fn dir(x: f32, y: f32, z: f32) -> Dir3 {
    Dir3::new(Vec3::new(x, y, z)).unwrap()
}

/// The unit vector `degrees` from z towards x.
fn tilted(degrees: f64) -> Dir3 {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    dir(sin as f32, 0.0, cos as f32)
}

fn degrees_between(a: Dir3, b: Dir3) -> f64 {
    let [a, b] = [a, b].map(|d| d.to_vec().as_dvec3());
    libm::atan2(a.cross(b).length(), a.dot(b)).to_degrees()
}

fn number(query: &Query) -> f64 {
    match query.value().unwrap() {
        Value::Number(number) => f64::from(number),
        other => panic!("{other:?} is no number"),
    }
}

/// The lobe at light 0, `theta` degrees from the normal in the x–z plane, seen from `e`.
fn lobe(lobe: Lobe, alpha: f32, theta: f64, e: Dir3) -> f64 {
    let at = Directions { n: Dir3::Z, l: tilted(-theta), e };
    number(&Query::Specular { lobe, at, alpha })
}

/// How far, in degrees, the eye turns from the mirror direction until the lobe is half its peak:
/// away from the normal in the plane of incidence, or out of it, for light at `theta` degrees.
fn half_width(which: Lobe, alpha: f32, theta: f64, across: bool) -> f64 {
    let r = tilted(theta).to_vec().as_dvec3();
    let turned = |degrees: f64| {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        // In the plane: along the tangent of growing θ; across it: along y.
        let aside = if across { glam::DVec3::Y } else { glam::DVec3::new(r.z, 0.0, -r.x) };
        Dir3::new((cos * r + sin * aside).as_vec3()).unwrap()
    };
    let (mut near, mut far) = (0.0, 90.0);
    for _ in 0..40 {
        let middle = 0.5 * (near + far);
        if lobe(which, alpha, theta, turned(middle)) > 0.5 { near = middle } else { far = middle }
    }
    near
}

#[track_caller]
fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found}, not {expected} ± {tolerance}");
}

/// "Light energy falling on a surface is proportional to the cosine of the angle of incidence."
#[test]
fn the_diffuse_term_is_the_cosine_of_the_angle_of_incidence() {
    for theta in [0.0, 15.0, 30.0, 45.0, 60.0, 89.0] {
        let found = number(&Query::Lambert { n: Dir3::Z, l: tilted(theta) });
        assert_near(found, libm::cos(theta.to_radians()), 1e-7);
    }
}

/// "Side oriented away from light: black", for which the equation needs a clamp it does not show.
#[test]
fn the_side_oriented_away_from_the_light_is_black() {
    for theta in [90.0, 91.0, 120.0, 180.0] {
        assert_near(number(&Query::Lambert { n: Dir3::Z, l: tilted(theta) }), 0.0, 1e-7);
    }
}

/// "`R_m = 2(L_m·N)N − L_m`", "light vector reflected about normal".
#[test]
fn r_is_unit_and_in_the_plane_of_l_and_n_and_as_far_from_n_as_l() {
    for (n, l) in [
        (Dir3::Z, tilted(40.0)),
        (dir(0.2, -0.5, 1.0), dir(1.0, 0.3, 0.8)),
        (dir(-1.0, 2.0, 0.1), dir(0.2, 0.9, -0.3)),
    ] {
        let r = n.mirror(l);
        assert_near(f64::from(r.dot(r)), 1.0, 5e-7);
        assert_near(degrees_between(r, n), degrees_between(l, n), 5e-5);
        assert_near(f64::from(r.to_vec().dot(n.to_vec().cross(l.to_vec()))), 0.0, 3e-7);
        assert_near(degrees_between(n.mirror(r), l), 0.0, 5e-5);
    }
}

/// "`r = ℓ − 2(ℓ·n)n`" on one slide, "`R = 2(L·N)N − L`" on another: opposite, with ℓ to the light
/// in both. The first is right for the direction in which light *travels*.
#[test]
fn the_two_slides_disagree_by_a_sign_and_each_has_its_name_here() {
    let (n, l) = (dir(0.2, -0.5, 1.0), dir(1.0, 0.3, 0.8));
    let first_slide = reflect(l, n); // ℓ − 2(ℓ·n)n, taken at its word
    assert_eq!(first_slide, -n.mirror(l));
    assert_eq!(reflect(-l, n), n.mirror(l));
}

/// The mistake shows at odd exponents: that is why the slide's 3 and 9 matter more than 2, 4, …, 32.
#[test]
fn the_wrong_sign_is_hidden_by_even_exponents_and_exposed_by_3_and_9() {
    let (l, e) = (tilted(-30.0), tilted(40.0));
    let cos = f64::from(Dir3::Z.mirror(l).dot(e));
    let wrong = f64::from(reflect(l, Dir3::Z).dot(e));
    for i in [2, 4, 8, 16, 32] {
        assert_eq!(libm::pow(wrong, f64::from(i)), libm::pow(cos, f64::from(i)));
    }
    for i in [3, 9] {
        assert_eq!(libm::pow(wrong, f64::from(i)), -libm::pow(cos, f64::from(i)));
    }
    // Clamped, as it is here, the wrong sign has no highlight at all, whatever the exponent.
    assert_eq!(phong::math::lobe(wrong as f32, 2.0), 0.0);
}

/// "Use cos(φ) = r·e."
#[test]
fn the_highlight_depends_on_the_angle_between_r_and_e() {
    for (theta, phi) in [(0.0, 10.0), (30.0, 20.0), (50.0, 35.0)] {
        let found = lobe(Lobe::Phong, 9.0, theta, tilted(theta - phi));
        assert_near(found, libm::pow(libm::cos(phi.to_radians()), 9.0), 2e-6);
    }
}

/// "Intensity of light will fall off more or less rapidly from the ideal (mirror) reflection vector."
#[test]
fn the_highlight_falls_off_from_the_mirror_direction_the_faster_the_higher_the_exponent() {
    let at = |alpha, away| lobe(Lobe::Phong, alpha, 30.0, tilted(30.0 - away));
    for alpha in [3.0, 9.0, 200.0] {
        assert_near(at(alpha, 0.0), 1.0, 3e-7 * f64::from(alpha));
        for away in 0..40 {
            assert!(at(alpha, f64::from(away)) > at(alpha, f64::from(away + 1)), "{alpha} {away}");
        }
    }
    assert!(at(3.0, 20.0) > at(9.0, 20.0) && at(9.0, 20.0) > at(200.0, 20.0));
}

/// "cos(x)^i for i ∈ {1, 2, 4, 8, 16, 32}".
#[test]
fn the_shininess_figure_has_these_half_widths() {
    let half_widths = [60.0, 45.0, 32.7651, 23.5081, 16.7437, 11.8825];
    for (i, x) in [1.0, 2.0, 4.0, 8.0, 16.0, 32.0_f32].into_iter().zip(half_widths) {
        assert_near(number(&Query::CosPower { x_deg: x as f32, i }), 0.5, 3e-6);
        assert_near(half_width(Lobe::Phong, i, 0.0, false), x, 1e-4);
        assert_near(number(&Query::CosPower { x_deg: 0.0, i }), 1.0, 0.0);
        assert_near(number(&Query::CosPower { x_deg: 120.0, i }), 0.0, 0.0);
    }
}

/// "Specular coefficient in (0.25, 0.5, 0.75), shininess in (3, 9, 200)."
#[test]
fn the_specular_coefficient_scales_the_lobe_and_shininess_shapes_it() {
    let l = Incident { l: tilted(-30.0), c_d: Rgb::WHITE, c_s: Rgb::WHITE, color: Rgb::WHITE };
    for alpha in [3.0, 9.0, 200.0] {
        for k_s in [0.25, 0.5, 0.75] {
            let model = Reflectance::Phong(Phong::new(0.0, k_s, alpha, Switches::default()));
            for away in [0.0, 5.0, 25.0] {
                let e = tilted(30.0 - away);
                let found = model.shade_light(Dir3::Z, Dir3::X, e, l).specular;
                let expected = f64::from(k_s) * lobe(Lobe::Phong, alpha, 30.0, e);
                assert_near(f64::from(found.g), expected, 1e-7);
            }
        }
    }
}

/// "Use vector halfway between e and ℓ. If n = h, we get the brightest possible reflection."
#[test]
fn h_is_halfway_and_where_it_is_the_normal_blinns_highlight_peaks() {
    let (l, e) = (dir(1.0, 0.3, 0.8), dir(-0.4, 0.5, 1.0));
    let h = l.halfway(e).unwrap();
    assert_near(degrees_between(l, h), degrees_between(h, e), 2e-5);
    let at =
        |n| number(&Query::Specular { lobe: Lobe::Blinn, at: Directions { n, l, e }, alpha: 50.0 });
    assert_near(at(h), 1.0, 1e-5);
    for aside in [Vec3::X, Vec3::Y, Vec3::Z] {
        assert!(at(Dir3::new(h.to_vec() + 0.1 * aside).unwrap()) < 0.99);
    }
}

/// "This angle β is about half the angle φ found before": half exactly in the plane of incidence.
#[test]
fn in_the_plane_of_incidence_beta_is_half_of_phi() {
    for (theta, eye) in [(30.0, 10.0), (60.0, 20.0), (45.0, -30.0)] {
        let (l, e) = (tilted(-theta), tilted(eye));
        let phi = degrees_between(Dir3::Z.mirror(l), e);
        let beta = degrees_between(l.halfway(e).unwrap(), Dir3::Z);
        assert_near(beta, phi / 2.0, 2e-5);
    }
}

/// The "about": elsewhere β is more than half of φ; across the plane, φ/(2 cos θ) for small angles.
#[test]
fn out_of_the_plane_beta_is_more_than_half_of_phi() {
    for theta in [15.0, 45.0, 60.0, 75.0] {
        let (l, r) = (tilted(-theta), tilted(theta));
        for aside in [0.02_f32, 0.2, 0.6] {
            let e = Dir3::new(r.to_vec() + aside * Vec3::Y).unwrap();
            let (phi, h) = (degrees_between(r, e), l.halfway(e).unwrap());
            let beta = degrees_between(h, Dir3::Z);
            assert!(beta > phi / 2.0 * 1.01, "θ {theta}: β {beta}, φ {phi}");
            if aside < 0.1 {
                assert_near(beta / (phi / (2.0 * libm::cos(f64::to_radians(theta)))), 1.0, 2e-3);
            }
        }
    }
}

/// "We can adjust the shininess to handle that": at the same exponent Blinn's highlight is twice as
/// wide, at four times the exponent nearly the same.
#[test]
fn four_times_the_exponent_gives_blinn_the_width_of_phong() {
    for alpha in [5.0, 20.0, 200.0_f32] {
        let phong = half_width(Lobe::Phong, alpha, 0.0, false);
        assert_near(half_width(Lobe::Blinn, alpha, 0.0, false) / phong, 2.0, 2e-4);
    }
    for (alpha, ratio) in [(5.0_f32, 1.018), (200.0, 1.0004)] {
        let phong = half_width(Lobe::Phong, alpha, 0.0, false);
        assert_near(half_width(Lobe::Blinn, 4.0 * alpha, 0.0, false) / phong, ratio, 5e-4);
    }
    // The exact match at normal incidence is 4α + ln 2 + O(1/α).
    for (alpha, exact) in [(1.0_f32, 4.82), (2.0, 8.75), (8.0, 32.7), (32.0, 128.7), (200.0, 800.7)]
    {
        let p = f64::from(alpha);
        let n = -2.0 * libm::log(2.0) / libm::log(0.5 * (1.0 + libm::exp2(-1.0 / p)));
        assert_near(n, exact, 0.05);
        let phong = half_width(Lobe::Phong, alpha, 0.0, false);
        assert_near(half_width(Lobe::Blinn, n as f32, 0.0, false) / phong, 1.0, 1e-4);
    }
}

/// But only in the plane of incidence: across it Blinn's highlight narrows, by cos θ in the limit,
/// which is why it looks right on floors.
#[test]
fn no_single_exponent_fits_across_the_plane_of_incidence() {
    let matched = 128.7;
    for (theta, across) in [(0.0, 11.9), (30.0, 10.3), (60.0, 6.0), (75.0, 3.1)] {
        assert_near(half_width(Lobe::Phong, 32.0, theta, true), 11.9, 0.05);
        assert_near(half_width(Lobe::Blinn, matched, theta, false), 11.9, 0.05);
        assert_near(half_width(Lobe::Blinn, matched, theta, true), across, 0.05);
    }
}

/// "`k_a C_a + Σ (k_d (L_m·N) C_{m,d} + k_s (R_m·E)^α C_{m,s})`".
#[test]
fn the_sum_worked_by_hand() {
    // L₁ = (0.6, 0, 0.8), L₂ = N = E = z: L·N = 0.8 and 1, R·E = 0.8 and 1.
    let lights = vec![
        Incident {
            l: dir(0.6, 0.0, 0.8),
            c_d: Rgb::new(1.0, 0.5, 0.0),
            c_s: Rgb::WHITE,
            color: Rgb::WHITE,
        },
        Incident {
            l: Dir3::Z,
            c_d: Rgb::new(0.0, 0.0, 1.0),
            c_s: Rgb::grey(0.5),
            color: Rgb::WHITE,
        },
    ];
    let sum = Query::Sum {
        lobe: Lobe::Phong,
        n: Dir3::Z,
        e: Dir3::Z,
        k_a: 0.1,
        k_d: 0.5,
        k_s: 0.25,
        alpha: 2.0,
        c_a: Rgb::new(1.0, 2.0, 3.0),
        lights,
    };
    let Ok(Value::Color(found)) = sum.value() else { panic!("no colour") };
    let highlights = 0.25 * (0.64 + 0.5);
    let expected =
        [0.1 + 0.5 * 0.8 + highlights, 0.2 + 0.5 * 0.8 * 0.5 + highlights, 0.3 + 0.5 + highlights];
    for (found, expected) in found.to_array().into_iter().zip(expected) {
        assert_near(f64::from(found), expected, 3e-7);
    }
}

/// "Ambient + Diffuse + Specular = Phong Reflection".
#[test]
fn the_total_is_the_sum_of_the_terms_in_order() {
    let terms = Terms {
        ambient: Rgb::new(0.1, 0.2, 0.3),
        diffuse: Rgb::grey(0.4),
        specular: Rgb::grey(0.25),
        ..Terms::default()
    };
    assert_eq!(terms.total().r, 0.1 + 0.4 + 0.25);
}

/// "Assume a surface is made up of tiny mirrors. The statistical distribution of these facets will
/// determine the reflection in each direction."
#[test]
fn tiny_mirrors_drawn_from_their_distribution_reflect_into_its_lobe() {
    // Facets drawn as often as they are seen from above, D(m)(N·m); each mirrors L, and counts for
    // the light it catches, (L·m)/((N·m)(N·L)): the share of light into a cone of directions tends
    // to the integral of D(h)/(4 N·L) over the cone.
    let (distribution, l) = (Distribution::Beckmann { m: 0.3 }, tilted(-40.0));
    let n_dot_l = f64::from(l.dot(Dir3::Z));
    let (mirror, cone) = (tilted(40.0), libm::cos(f64::to_radians(12.0)) as f32);
    let lobe = |e: Dir3| {
        let n_dot_h = l.halfway(e).unwrap().dot(Dir3::Z);
        number(&Query::Density { distribution, n_dot_h }) / (4.0 * n_dot_l)
    };
    let error = |facets: u32| {
        let mut caught = 0.0;
        for i in 0..facets {
            // A stratified pattern; Beckmann's slope is √(−m² ln u).
            let (u, phi) = ((f64::from(i) + 0.5) / f64::from(facets), f64::from(i) * 2.399_963_2);
            let slope = (-0.09 * libm::log(u)).sqrt();
            let m = dir((slope * libm::cos(phi)) as f32, (slope * libm::sin(phi)) as f32, 1.0);
            if m.mirror(l).dot(mirror) > cone {
                caught += f64::from(l.cos(m)) / (f64::from(m.dot(Dir3::Z)) * n_dot_l);
            }
        }
        (caught / f64::from(facets) / integral(mirror, cone, lobe) - 1.0).abs()
    };
    assert!(error(1_000) < 0.1 && error(100_000) < 0.005, "{} {}", error(1_000), error(100_000));
}

/// `∫ f dω` over the cone of cosine `cone` around `axis`.
fn integral(axis: Dir3, cone: f32, f: impl Fn(Dir3) -> f64) -> f64 {
    let frame = phong::math::Frame::around(axis);
    let (rings, turns) = (60, 120);
    let depth = 1.0 - f64::from(cone);
    let cell = depth * std::f64::consts::TAU / f64::from(rings * turns);
    let mut sum = 0.0;
    for i in 0..rings {
        for j in 0..turns {
            let z = 1.0 - depth * (f64::from(i) + 0.5) / f64::from(rings);
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(j) / f64::from(turns));
            let rho = (1.0 - z * z).sqrt();
            sum += cell * f(frame.to_world(dir((rho * cos) as f32, (rho * sin) as f32, z as f32)));
        }
    }
    sum
}
