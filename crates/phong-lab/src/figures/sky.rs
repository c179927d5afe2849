//! What the ambient term's constant stands for: light from everywhere, met or not, of a sky.

use glam::DVec3;
use phong::film::LayerKind;
use phong_scene::{
    AmbientOcclusion, CameraKind, ConstantMaterial, OcclusionDistance, Rgb, Scene, Shape, Sky,
    SkyKind,
};

use super::drawing::Drawing;
use super::mark::Point;
use super::plot::fixed;
use super::stage::{self, ball, object, probe};
use super::{Finish, Number, Plate, Setting};

const TITLE: &str = "From constant to sky";
const EQUATION: &str = "*k*_a *C*_a × (1, then openness, then sky)";
/// The ambient coefficient of all that is there.
const K_A: f32 = 0.8;
/// The way the camera looks from.
const EYE: DVec3 = DVec3::new(0.25, 0.4, 1.0);
/// Rays from a point whose number is told.
const RAYS: u32 = 1024;

/// What the ambient light is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Ambient {
    /// The lecture's constant.
    Constant,
    /// The constant where it finds its way.
    Occluded,
    /// A sky by day, as bright as the constant on level open ground.
    Sky,
}

const ALL: [Ambient; 3] = [Ambient::Constant, Ambient::Occluded, Ambient::Sky];

/// Places whose numbers are told: what they are called, where they are, and where they are seen from.
fn places() -> [(&'static str, DVec3, DVec3); 2] {
    [
        ("on top of the ball", DVec3::Y, DVec3::Y),
        ("on the floor by the ball", DVec3::new(0.3, -1.0, 0.9), DVec3::new(0.1, 0.6, 1.0)),
    ]
}

pub(super) fn draw(setting: Setting) -> Plate {
    let mut numbers = Vec::new();
    for ambient in ALL {
        for (words, at, eye) in places() {
            let name = match ambient {
                Ambient::Constant => "constant",
                Ambient::Occluded => "openness",
                Ambient::Sky => "sky",
            };
            numbers.push(Number::new(format!("{name} {words}"), factor(ambient, at, eye), ""));
        }
    }
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "The lecture’s constant is light that comes from everywhere alike and meets nothing; \
                  openness is the share of it that finds its way, and under a sky it matters from where.",
        drawing: drawing(&numbers, setting),
        numbers,
    }
}

/// What the ambient term is multiplied by at a point, as its luminance.
fn factor(ambient: Ambient, at: DVec3, eye: DVec3) -> f64 {
    let Rgb { r, g, b } = probe(&scene(ambient, RAYS), at, eye.normalize_or_zero()).ambient;
    let luminance = 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
    luminance / f64::from(K_A)
}

/// Two balls on a floor under ambient light alone, of so many rays from every point.
fn scene(ambient: Ambient, samples: u32) -> Scene {
    let chalk = ConstantMaterial {
        color: Rgb::WHITE,
        k_a: K_A,
        k_d: 0.0,
        k_s: 0.0,
        ..ConstantMaterial::default()
    };
    let mut scene = ball(chalk, Vec::new(), EYE.normalize_or_zero());
    scene.camera.kind = CameraKind::Orthographic { height: 3.2 };
    scene.camera.look_at = DVec3::new(0.45, -0.1, 0.0);
    let small = Shape::Sphere { center: DVec3::new(1.5, -0.45, 0.5), radius: 0.55 };
    let floor = Shape::Disc { center: -DVec3::Y, normal: DVec3::Y, radius: 5.0 };
    scene.objects.extend([object(small, 0), object(floor, 0)]);
    match ambient {
        Ambient::Constant => {}
        Ambient::Occluded => {
            let distance = OcclusionDistance::Units(2.0);
            scene.ambient_occlusion = Some(AmbientOcclusion { samples, distance });
        }
        Ambient::Sky => {
            let sun = DVec3::new(1.0, 0.7, 0.4);
            let kind = SkyKind::SunAndSky { sun, turbidity: 2.5, ground: None };
            scene.sky = Some(Sky { kind, samples, ..Sky::default() });
        }
    }
    scene
}

fn drawing(numbers: &[Number], setting: Setting) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    let size = 270.0;
    let samples = if setting.finish == Finish::Draft { 4 } else { 16 };
    let words = ["a constant", "what finds its way", "from a sky"];
    for (column, (ambient, words)) in ALL.into_iter().zip(words).enumerate() {
        let left = Point::new(36.0 + 309.0 * column as f64, 112.0);
        let film = stage::shown(&scene(ambient, samples), Point::splat(size), setting);
        drawing.image(left, Point::splat(size), stage::bitmap(&film, &[LayerKind::Picture]));
        let middle = left + Point::new(0.5 * size, size);
        drawing.heading(middle + Point::new(0.0, 36.0), words);
        let of = |place: usize| fixed(numbers[2 * column + place].value, 2);
        let note = format!("× {} on top, × {} by the ball", of(0), of(1));
        drawing.note(middle + Point::new(0.0, 62.0), &note);
    }
    drawing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_constant_is_what_a_sky_gives_that_is_even_where_nothing_is_in_the_way() {
        let chalk = || ConstantMaterial { k_a: K_A, ..ConstantMaterial::default() };
        let plain = ball(chalk(), Vec::new(), DVec3::Z);
        let mut even = plain.clone();
        even.sky = Some(Sky { samples: 16, ..Sky::default() });
        for at in [DVec3::Z, DVec3::new(0.6, 0.0, 0.8)] {
            let [constant, sky] = [&plain, &even].map(|scene| probe(scene, at, DVec3::Z).ambient);
            assert_eq!(constant, sky);
        }
    }

    #[test]
    fn on_top_all_three_give_the_same_and_by_the_ball_less_finds_its_way() {
        let [constant, flat, open, nook, day, shade] = draw(Setting::DRAFT).values();
        for whole in [constant, flat, open] {
            assert!((whole - 1.0).abs() < 1e-9, "{whole}");
        }
        assert!((day - 1.0).abs() < 0.05, "{day}");
        assert!(nook < 0.8 && shade < 0.9 * day, "{nook} {shade}");
    }
}
