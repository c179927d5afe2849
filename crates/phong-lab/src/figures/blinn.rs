//! Phong's lobe against Blinn's: the same exponent, a higher one, in and across the plane of
//! incidence.

use glam::DVec3;
use phong::film::LayerKind;
use phong::math::{Dir3, wide};
use phong::reflectance::{BlinnPhong, Incident, Phong, Reflectance, Switches};
use phong_scene::{ConstantMaterial, Model, Rgb, Scene};

use super::drawing::Drawing;
use super::mark::{Anchor, Ink, Point, Stroke};
use super::plot::{Plot, fixed, ticks};
use super::shininess::half_width;
use super::stage::{self, ball, distant, plastic};
use super::symbols::{across, light, within};
use super::{Number, Plate, Setting, style};

const TITLE: &str = "Phong and Blinn–Phong";
const EQUATION: &str = "(*r*·*e*)^{*α*}   and   (*n*·*h*)^{*α′*}";

/// The direction to the light of the pictures.
const TO_LIGHT: DVec3 = DVec3::new(1.0, 0.55, 0.1);
/// Phong's exponent in the picture.
const ALPHA: f64 = 20.0;
/// The angle of incidence of the plots, degrees.
const THETA: f64 = 45.0;
/// Exponents for which the factor 4 is tried.
const EXPONENTS: [f64; 3] = [5.0, 20.0, 200.0];

pub(super) fn draw(setting: Setting) -> Plate {
    let (alpha, theta) = (setting.alpha_or(ALPHA), setting.theta_or(THETA));
    let phong = width(Lobe::Phong, alpha, 0.0, within);
    let same = width(Lobe::Blinn, alpha, 0.0, within);
    let mut numbers = vec![
        Number::new(format!("half width, Phong, α = {alpha}"), phong, "°"),
        Number::new(format!("half width, Blinn–Phong, α = {alpha}"), same, "°"),
        Number::new("their ratio, in the plane", same / phong, ""),
        Number::new(format!("the matching exponent for α = {alpha}"), matching(alpha), ""),
    ];
    for alpha in EXPONENTS {
        let ratio = |exponent| {
            width(Lobe::Blinn, exponent, 0.0, within) / width(Lobe::Phong, alpha, 0.0, within)
        };
        numbers.push(Number::new(format!("ratio with 4α, α = {alpha}"), ratio(4.0 * alpha), ""));
        let name = format!("ratio with the matching exponent, α = {alpha}");
        numbers.push(Number::new(name, ratio(matching(alpha)), ""));
    }
    let second = if alpha == 200.0 { 20.0 } else { 200.0 };
    for alpha in [alpha, second] {
        let ratio = width(Lobe::Blinn, matching(alpha), theta, across)
            / width(Lobe::Phong, alpha, theta, across);
        let name = format!("ratio across the plane, θ = {theta}°, matching exponent, α = {alpha}");
        numbers.push(Number::new(name, ratio, ""));
    }
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "With the same exponent Blinn’s highlight is twice as wide in the plane of \
                  incidence; a matching exponent makes them equal there, but across the plane \
                  Blinn’s narrows with cos θ, so that no exponent makes the two models equal.",
        numbers,
        drawing: drawing(setting),
    }
}

/// The exponent with which Blinn's lobe is half as high as its peak where Phong's is, in the plane
/// of incidence: `−2 ln 2 / ln((1 + 2^(−1/α))/2)`, which is `4α + ln 2 + O(1/α)`.
fn matching(alpha: f64) -> f64 {
    -2.0 * wide::ln(2.0) / wide::ln(0.5 * (1.0 + wide::pow(2.0, -1.0 / alpha)))
}

#[derive(Clone, Copy, Debug)]
enum Lobe {
    Phong,
    Blinn,
}

/// The specular term alone, by the function that shades every hit.
fn specular(lobe: Lobe, exponent: f64, theta: f64, e: Dir3) -> f64 {
    let (k_d, k_s, alpha) = (0.0, 1.0, exponent as f32);
    let model = match lobe {
        Lobe::Phong => Reflectance::Phong(Phong::new(k_d, k_s, alpha, Switches::default())),
        Lobe::Blinn => {
            Reflectance::BlinnPhong(BlinnPhong::new(k_d, k_s, alpha, Switches::default()))
        }
    };
    let incident =
        Incident { l: light(theta), c_d: Rgb::WHITE, c_s: Rgb::WHITE, color: Rgb::WHITE };
    f64::from(model.shade_light(Dir3::Y, Dir3::X, e, incident).specular.r)
}

/// The half width of a lobe along a path of eyes, degrees of φ.
fn width(lobe: Lobe, exponent: f64, theta: f64, eye: fn(f64, f64) -> Dir3) -> f64 {
    half_width(|phi| specular(lobe, exponent, theta, eye(theta, phi)))
}

/// The three lobes that are compared, with their colours and names.
fn lobes(alpha: f64) -> [(Lobe, f64, Ink, String); 3] {
    let matched = matching(alpha);
    [
        (Lobe::Phong, alpha, style::MIRROR, format!("Phong, *α* = {alpha}")),
        (Lobe::Blinn, alpha, style::HALF, format!("Blinn–Phong, *α′* = {alpha}")),
        (Lobe::Blinn, matched, style::NORMAL, format!("Blinn–Phong, *α′* = {}", fixed(matched, 2))),
    ]
}

fn scene(lobe: Lobe, exponent: f64, setting: Setting) -> Scene {
    let model = match lobe {
        Lobe::Phong => Model::Phong,
        Lobe::Blinn => Model::BlinnPhong,
    };
    let material =
        ConstantMaterial { model, shininess: exponent as f32, k_s: 0.7, ..plastic(setting) };
    ball(material, vec![distant(TO_LIGHT, 1.0)], DVec3::Z)
}

fn drawing(setting: Setting) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    let (alpha, theta) = (setting.alpha_or(ALPHA), setting.theta_or(THETA));
    let size = 176.0;
    for (column, (lobe, exponent, ink, words)) in lobes(alpha).into_iter().enumerate() {
        let at = Point::new(86.0 + 306.0 * column as f64, 76.0);
        let film = stage::shown(&scene(lobe, exponent, setting), Point::splat(size), setting);
        drawing.image(at, Point::splat(size), stage::bitmap(&film, &[LayerKind::Picture]));
        stage::light_from(&mut drawing, TO_LIGHT, DVec3::Z, at, size);
        let under = at + Point::new(0.5 * size, size + 22.0);
        drawing.text(under, Anchor::Middle, style::NOTE, ink, &words);
    }
    let plots =
        [("in the plane of incidence", within as fn(f64, f64) -> Dir3), ("across it", across)];
    for (column, (words, eye)) in plots.into_iter().enumerate() {
        let left = 96.0 + 444.0 * column as f64;
        let corners = [Point::new(left, 330.0), Point::new(left + 360.0, 480.0)];
        let plot = Plot { corners, x: [-60.0, 60.0], y: [0.0, 1.0] };
        let x_ticks = ticks(&[-60.0, -30.0, 0.0, 30.0, 60.0], "°");
        plot.axes(&mut drawing, &x_ticks, &ticks(&[0.0, 0.5, 1.0], ""));
        plot.names(&mut drawing, "*φ*", "share of the peak", 40.0);
        let above = Point::new(left + 180.0, 318.0);
        drawing.heading(above, &format!("{words}, *θ* = {theta}°"));
        for (lobe, exponent, ink, _) in lobes(alpha) {
            let share = |phi: f64| specular(lobe, exponent, theta, eye(theta, phi));
            // Phong's curve is a broad band, to be seen where another lies on it.
            let stroke = match lobe {
                Lobe::Phong => Stroke::new(ink.fade(0.35), 3.2 * style::CURVE),
                Lobe::Blinn => Stroke::new(ink, style::CURVE),
            };
            plot.curve(&mut drawing, [-60.0, 60.0], 240, share, stroke);
        }
    }
    drawing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_exponent_makes_blinn_twice_as_wide_and_four_times_it_nearly_equal() {
        let [phong, blinn, ratio, matched, by_4, exact, by_4_20, exact_20, by_4_200, exact_200, ..] =
            draw(Setting::DRAFT).values::<12>();
        assert!((phong - wide::acos(wide::pow(2.0, -0.05)).to_degrees()).abs() < 2e-5, "{phong}");
        assert!((ratio - 2.0).abs() < 3e-6 && (blinn - 2.0 * phong).abs() < 4e-5, "{ratio}");
        assert!((matched - (80.0 + wide::ln(2.0))).abs() < 0.01, "{matched}");
        assert!((by_4 - 1.018).abs() < 5e-4, "{by_4}");
        assert!((by_4_20 - 1.0044).abs() < 2e-4, "{by_4_20}");
        assert!((by_4_200 - 1.0004).abs() < 1e-4, "{by_4_200}");
        for ratio in [exact, exact_20, exact_200] {
            assert!((ratio - 1.0).abs() < 5e-5, "{ratio}"); // f32 angles of 4.7° at α = 200
        }
    }

    #[test]
    fn across_the_plane_the_matched_lobe_narrows_towards_the_cosine() {
        let values = draw(Setting::DRAFT).values::<12>();
        let [at_20, at_200] = [values[10], values[11]];
        let cosine = wide::cos(THETA.to_radians());
        assert!(cosine < at_200 && at_200 < at_20 && at_20 < cosine + 0.01, "{at_20} {at_200}");
        let tends = [30.0, 60.0, 75.0].map(|theta: f64| {
            let alpha = 20_000.0;
            let ratio = width(Lobe::Blinn, matching(alpha), theta, across)
                / width(Lobe::Phong, alpha, theta, across);
            (ratio - wide::cos(theta.to_radians())).abs()
        });
        // Lobes of half a degree, with cosines in f32.
        assert!(tends.iter().all(|off| *off < 4e-3), "{tends:?}");
    }
}
