//! A picture with its furniture over it as SVG: the picture as PNG, the furniture as outlines.

use std::fmt::Write as _;
use std::io::Cursor;

use phong::film::{Film, LayerKind};
use phong::finish::{Finished, finish};
use phong::image::{Content, Encoding, Format, WriteError, write};
use phong::part::Settings;
use phong::scene::Rgb;

use super::sheet::{Group, Paint, ink};
use super::{depth, groups, text::Font, unhidden};
use crate::draw::{Point, Stroke, number, shape};
use crate::markup::{data_url, escaped};

/// Colours of a bar that are written; between them an SVG mixes the levels of sRGB.
const RAMP: u32 = 64;

/// A film's finished picture as an SVG file: the picture and the lines in it as PNG, and over it its
/// furniture as outlines, sharp at any size. Without furniture it is the picture alone.
///
/// # Errors
/// [`WriteError::Unsuitable`] where the film has no picture.
pub fn svg(film: &Film, settings: &Settings, encoding: &Encoding) -> Result<String, WriteError> {
    let finishing = settings.finishing();
    let picture = finish(film, &finishing);
    let png = png(&picture, *encoding)?;
    let shown = picture.film().window;
    let [width, height] = [shown.width(), shown.height()];
    let mut out = String::from("<svg xmlns=\"http://www.w3.org/2000/svg\"");
    let (wide, high) = match finishing.dpi {
        Some(dpi) => {
            let inches = |pixels: u32| format!("{:.4}in", f64::from(pixels) / dpi);
            (inches(width), inches(height))
        }
        None => (width.to_string(), height.to_string()),
    };
    // Writing to a string does not fail.
    let _ = writeln!(
        out,
        " width=\"{wide}\" height=\"{high}\" viewBox=\"{} {} {width} {height}\" role=\"img\" \
         stroke-linecap=\"round\" stroke-linejoin=\"round\">",
        shown.x0, shown.y0
    );
    let scene = settings.furniture();
    let title = scene.as_ref().and_then(|scene| scene.furniture.title.as_ref());
    if let Some(title) = title {
        let _ = writeln!(out, "<title>{}</title>", escaped(&title.text));
    }
    let _ = writeln!(
        out,
        "<image x=\"{}\" y=\"{}\" width=\"{width}\" height=\"{height}\" href=\"{}\"/>",
        shown.x0,
        shown.y0,
        data_url("image/png", &png)
    );
    if let Some(scene) = &scene {
        let seen = unhidden(scene, settings.size, |pixel| depth(film, pixel));
        let all = groups(&Font::new(), &seen, settings.size);
        for (number, group) in all.iter().enumerate() {
            put(&mut out, group, number);
        }
    }
    Ok(out + "</svg>\n")
}

fn png(picture: &Finished<'_>, encoding: Encoding) -> Result<Vec<u8>, WriteError> {
    let mut png = Cursor::new(Vec::new());
    write(picture, Content::Layer(LayerKind::Picture), Format::Png, &encoding, &mut png)?;
    Ok(png.into_inner())
}

fn put(out: &mut String, group: &Group, number_of: usize) {
    let _ = writeln!(out, "<g role=\"img\" aria-label=\"{}\">", escaped(&group.says));
    if let Some((color, width)) = group.halo {
        for paint in &group.paints {
            match paint {
                Paint::Fill(path, _) => {
                    *out += &shape(path, None, Some(Stroke::new(color, 2.0 * width)));
                }
                Paint::Line(path, line) => {
                    let stroke = Stroke::new(color, line.width + 2.0 * width);
                    *out += &shape(path, None, Some(stroke));
                }
                Paint::Ramp { .. } => {}
            }
        }
    }
    for paint in &group.paints {
        match paint {
            Paint::Fill(path, ink) => *out += &shape(path, Some(*ink), None),
            Paint::Line(path, stroke) => *out += &shape(path, None, Some(*stroke)),
            Paint::Ramp { at, size, stops } => {
                let _ = write!(
                    out,
                    "<linearGradient id=\"map{number_of}\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">"
                );
                for step in 0..=RAMP {
                    let t = f64::from(step) / f64::from(RAMP);
                    let [r, g, b] = ink(Rgb::of_stops(stops, t as f32)).srgb;
                    let _ = write!(
                        out,
                        "<stop offset=\"{}\" stop-color=\"#{r:02x}{g:02x}{b:02x}\"/>",
                        (1e4 * t).round() / 1e4
                    );
                }
                let Point { x, y } = *at;
                let _ = writeln!(
                    out,
                    "</linearGradient>\n<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" \
                     fill=\"url(#map{number_of})\"/>",
                    number(x),
                    number(y),
                    number(size.x),
                    number(size.y)
                );
            }
        }
    }
    *out += "</g>\n";
}
