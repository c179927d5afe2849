//! A fit to look at: both lobes as curves, and the same scene in both models.

use std::fmt::Write;
use std::io::Cursor;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use phong::film::{Film, LayerKind};
use phong::finish::{Finishing, finish};
use phong::geometry::{Geometry, GeometryOptions};
use phong::image::{Content, Encoding, Format, write};
use phong::look::Look;
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_scene::{
    Camera, CameraKind, ConstantMaterial, Image, Light, LightKind, MaterialId, Object, Place, Rgb,
    Scene, Shape,
};
use rayon::prelude::*;

use super::lobe::LitLobe;
use super::surface::written;
use super::{Fit, Lobe, Slice};
use crate::markup::data_url;

/// Pixels of each of the two pictures.
const PICTURE: [u32; 2] = [430, 270];
/// Incidence of the curves, degrees; the middle and the worst.
const ANGLES: [f64; 3] = [0.0, 30.0, 60.0];
/// From one row of plots to the next.
const ROW: f64 = 182.0;
/// Inside of a plot.
const PLOT: [f64; 2] = [390.0, 120.0];
/// A's ink, and B's.
const INKS: [&str; 2] = ["#1f5fa8", "#d2691e"];

/// A drawing of a fit: two pictures of a ball on a floor, one in each model, and the lobes over
/// eyes in the plane of incidence and across it, each 1 at its peak.
pub fn svg(fit: &Fit) -> String {
    let mut out = String::new();
    // Writing to a String does not fail.
    let _ = draw(&mut out, fit);
    out
}

fn draw(out: &mut String, fit: &Fit) -> std::fmt::Result {
    let names = [fit.from, fit.to].map(|lobe| lobe.to_string());
    let height = 398 + ROW as usize * ANGLES.len();
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 940 {height}\" width=\"940\" \
         height=\"{height}\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"13\">\n\
         <title>{} and {}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>",
        names[0], names[1]
    )?;
    // One ball on one floor for both lobes.
    let stage = ball_on_floor(fit.from);
    let geometry = Geometry::new(&stage, GeometryOptions::of(&stage)).ok().map(Arc::new);
    let pictures: Vec<Option<String>> =
        [fit.from, fit.to].par_iter().map(|lobe| picture(geometry.as_ref()?, *lobe)).collect();
    for (i, (name, picture)) in names.iter().zip(pictures).enumerate() {
        let x = 25 + 460 * i;
        writeln!(
            out,
            "<text x=\"{x}\" y=\"34\" font-size=\"18\" fill=\"{}\">{name}</text>",
            INKS[i]
        )?;
        if let Some(png) = picture {
            writeln!(
                out,
                "<image x=\"{x}\" y=\"46\" width=\"{}\" height=\"{}\" \
                 href=\"{png}\"/>",
                PICTURE[0], PICTURE[1]
            )?;
        }
    }
    for (i, slice) in [Slice::InPlane, Slice::Across].into_iter().enumerate() {
        let x = 50.0 + 460.0 * i as f64;
        let what = match slice {
            Slice::InPlane => "eyes in the plane of incidence",
            Slice::Across => "eyes across it",
        };
        writeln!(out, "<text x=\"{x}\" y=\"350\" font-size=\"15\">{what}</text>")?;
        for (row, theta) in ANGLES.into_iter().enumerate() {
            plot(out, fit, slice, theta, [x, 368.0 + ROW * row as f64])?;
        }
    }
    writeln!(
        out,
        "<text x=\"50\" y=\"{}\" fill=\"#555\">No single number is right for all angles.</text>\n</svg>",
        height - 14
    )
}

/// One pair of curves, its upper left corner at `[x0, y0]`.
fn plot(
    out: &mut String,
    fit: &Fit,
    slice: Slice,
    theta: f64,
    [x0, y0]: [f64; 2],
) -> std::fmt::Result {
    const STEPS: u32 = 240;
    let [width, height] = PLOT;
    let wide = [fit.from, fit.to].map(|lobe| lobe.half_width(0.0, slice).unwrap_or(90.0));
    let reach = 4.0 * wide[0].max(wide[1]);
    let scale = [1.0, 2.0, 4.0, 10.0, 20.0, 40.0, 60.0];
    let reach = scale.into_iter().find(|scale| *scale >= reach).unwrap_or(90.0);
    writeln!(
        out,
        "<g transform=\"translate({x0} {y0})\"><path d=\"M0 0V{height}H{width}\" fill=\"none\" \
         stroke=\"#444\"/><path d=\"M{0} 0V{height}M0 {1}H{width}\" stroke=\"#ddd\"/>\
         <text x=\"6\" y=\"12\">light at {theta}°</text>",
        width / 2.0,
        height / 2.0
    )?;
    for (share, anchor) in [(0.0, "start"), (0.5, "middle"), (1.0, "end")] {
        writeln!(
            out,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"{anchor}\" fill=\"#555\">{}°</text>",
            share * width,
            height + 16.0,
            (reach * (2.0 * share - 1.0)).to_string().replace('-', "−")
        )?;
    }
    for (value, y) in [("1", 0.0), ("½", 0.5), ("0", 1.0)] {
        writeln!(
            out,
            "<text x=\"-6\" y=\"{}\" text-anchor=\"end\" fill=\"#555\">{value}</text>",
            y * height + 4.0
        )?;
    }
    writeln!(
        out,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">the eye’s angle from the mirror \
         direction</text><text transform=\"translate(-28 {}) rotate(-90)\" \
         text-anchor=\"middle\">highlight, of its peak</text>",
        width / 2.0,
        height + 33.0,
        height / 2.0
    )?;
    for (lobe, ink, dash) in [(fit.from, INKS[0], ""), (fit.to, INKS[1], "6 4")] {
        let shone = LitLobe::new(lobe, theta);
        let at = |i: u32| {
            let phi = reach * (2.0 * f64::from(i) / f64::from(STEPS) - 1.0);
            shone.at(slice, phi)
        };
        let peak = (0..=STEPS).map(at).fold(f64::MIN_POSITIVE, f64::max);
        write!(
            out,
            "<path fill=\"none\" stroke=\"{ink}\" stroke-width=\"2\" stroke-dasharray=\"{dash}\" d=\""
        )?;
        for i in 0..=STEPS {
            let x = width * f64::from(i) / f64::from(STEPS);
            let y = height * (1.0 - at(i) / peak);
            write!(out, "{}{x:.1} {y:.2}", if i == 0 { 'M' } else { 'L' })?;
        }
        writeln!(out, "\"/>")?;
    }
    writeln!(out, "</g>")
}

/// A ball on a floor, both of this lobe over a dark Lambert, as the address of a PNG; `None` where
/// it cannot be drawn.
fn picture(geometry: &Arc<Geometry>, lobe: Lobe) -> Option<String> {
    let scene = ball_on_floor(lobe);
    let options = RenderOptions::of(&scene.image).and_then(|of| of.with_samples(4)).ok()?;
    let view = View::new(Arc::clone(geometry), Look::new(&scene)).ok()?;
    png(&render(&view, &options, &|_| {}, &Cancel::new()).film)
}

fn png(film: &Film) -> Option<String> {
    let mut bytes = Cursor::new(Vec::new());
    let content = Content::Layer(LayerKind::Picture);
    let film = finish(film, &Finishing::default());
    write(&film, content, Format::Png, &Encoding::default(), &mut bytes).ok()?;
    Some(data_url("image/png", &bytes.into_inner()))
}

fn ball_on_floor(lobe: Lobe) -> Scene {
    let object = |name: &str, shape| Object {
        name: name.to_owned(),
        shape,
        material: MaterialId(0),
        transform: DAffine3::IDENTITY,
        place: Place::default(),
    };
    let light = |direction| Light {
        name: "light".to_owned(),
        kind: LightKind::Distant { direction, angle: 0.0 },
        ..Light::default()
    };
    Scene {
        image: Image { size: PICTURE, ..Image::default() },
        camera: Camera {
            kind: CameraKind::Perspective { fov: 30.0 },
            eye: DVec3::new(0.0, 1.6, 6.5),
            look_at: DVec3::new(0.0, 0.6, 0.0),
            up: DVec3::Y,
            aperture: 0.0,
            focus: None,
            shift: glam::DVec2::ZERO,
        },
        // One from over the shoulder, for the ball; one from beyond, low, for the floor.
        lights: vec![light(DVec3::new(0.5, -0.6, -1.0)), light(DVec3::new(0.14, -0.33, 1.0))],
        materials: vec![material(lobe).into()],
        objects: vec![
            object("ball", Shape::Sphere { center: DVec3::new(0.0, 1.0, 0.0), radius: 1.0 }),
            object("floor", Shape::Plane { point: DVec3::ZERO, normal: DVec3::Y }),
        ],
        ..Scene::default()
    }
}

/// The lobe over a dark Lambert, scaled so that its peak is the same for every lobe, face on.
fn material(lobe: Lobe) -> ConstantMaterial {
    let (model, shininess) = written(lobe);
    let peak = lobe.at(0.0, Slice::InPlane, 0.0);
    ConstantMaterial {
        model,
        shininess,
        color: Rgb::new(0.1, 0.16, 0.25),
        k_a: 0.2,
        k_d: 0.6,
        k_s: (0.7 / peak) as f32,
        ..ConstantMaterial::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::{Model, fit};

    #[test]
    fn a_drawing_has_two_pictures_and_a_pair_of_curves_for_each_angle_and_plane() {
        let drawing = svg(&fit("phong:32".parse().unwrap(), Model::Ggx).unwrap());
        assert!(drawing.starts_with("<svg ") && drawing.ends_with("</svg>\n"));
        assert_eq!(drawing.matches("<image ").count(), 2);
        assert_eq!(drawing.matches("stroke-width=\"2\"").count(), 12);
        assert!(drawing.contains(">phong:32</text>"));
        assert!(!drawing.contains("NaN") && !drawing.contains("inf"));
    }

    #[test]
    fn the_material_drawn_is_the_lobe_that_was_fitted() {
        for model in Model::ALL {
            let lobe = Lobe::new(model, model.example()).unwrap();
            let drawn =
                phong::material::Material::new(&material(lobe), phong::math::Dir3::Z).reflectance;
            let light = phong::reflectance::Incident {
                l: phong::math::Dir3::Z,
                c_d: Rgb::BLACK,
                c_s: Rgb::WHITE,
                color: Rgb::BLACK,
            };
            let z = phong::math::Dir3::Z;
            let peak = drawn.shade_light(z, phong::math::Dir3::X, z, light).specular.r;
            assert!((peak - 0.7).abs() < 1e-5, "{lobe}: {peak}");
        }
    }
}
