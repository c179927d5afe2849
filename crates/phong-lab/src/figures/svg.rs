//! A drawing as SVG.
//!
//! Text stays text: it can be selected, searched and edited. The fonts ride along as data, so it
//! looks the same in every browser; a program that ignores them falls back to a common face.

use std::fmt::Write;

use super::drawing::Drawing;
use super::mark::{Anchor, Bitmap, Mark, Path, Point, Script, Text};
use super::raster;
use super::text;
use crate::draw::{number, paint, shape};
use crate::markup::{data_url, escaped};

/// Names of the faces, with common ones behind them.
const SANS: &str = "'Noto Sans','DejaVu Sans',sans-serif";
const SERIF: &str = "'Noto Serif','DejaVu Serif',serif";

/// A whole SVG file: title and description for those who cannot see it, fonts, marks.
pub(super) fn document(drawing: &Drawing, title: &str, description: &str) -> String {
    let style = format!("<style>{}</style>\n", font_faces());
    element(drawing, title, description, &style)
}

/// The `svg` element alone, for a page that declares [`font_faces`] once.
pub(super) fn inline(drawing: &Drawing, title: &str, description: &str) -> String {
    element(drawing, title, description, "")
}

/// The embedded fonts as CSS.
pub(super) fn font_faces() -> String {
    let faces = [
        ("Noto Sans", "normal", 400, text::SANS),
        ("Noto Sans", "normal", 700, text::BOLD),
        ("Noto Serif", "italic", 400, text::ITALIC),
    ];
    let mut css = String::new();
    for (family, style, weight, file) in faces {
        let data = data_url("font/ttf", file);
        let _ = writeln!(
            css,
            "@font-face{{font-family:'{family}';font-style:{style};font-weight:{weight};\
             src:url({data})}}"
        );
    }
    css
}

fn element(drawing: &Drawing, title: &str, description: &str, head: &str) -> String {
    let Point { x: width, y: height } = drawing.size;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" \
         role=\"img\" font-family=\"{SANS}\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n\
         <title>{}</title>\n<desc>{}</desc>\n{head}",
        escaped(title),
        escaped(description),
        w = number(width),
        h = number(height),
    );
    let corners = [Point::ZERO, Point::new(width, 0.0), drawing.size, Point::new(0.0, height)];
    out += &shape(&Path::polygon(corners), Some(drawing.paper), None);
    for mark in &drawing.marks {
        out += &match mark {
            Mark::Shape { path, fill, stroke } => shape(path, *fill, *stroke),
            Mark::Text(text) => words(text),
            Mark::Image { at, size, bitmap } => image(*at, *size, bitmap),
        };
    }
    out + "</svg>\n"
}

fn words(text: &Text) -> String {
    let Text { at, anchor, size, ink, bold, upright, runs } = text;
    let mut out = if *upright {
        format!("<text transform=\"translate({} {}) rotate(-90)\"", number(at.x), number(at.y))
    } else {
        format!("<text x=\"{}\" y=\"{}\"", number(at.x), number(at.y))
    };
    match anchor {
        Anchor::Start => {}
        Anchor::Middle => out += " text-anchor=\"middle\"",
        Anchor::End => out += " text-anchor=\"end\"",
    }
    let _ = write!(out, " font-size=\"{}\"{}", number(*size), paint("fill", Some(*ink)));
    if *bold {
        out += " font-weight=\"700\"";
    }
    out += " style=\"white-space:pre\">";
    let mut sunk = 0.0;
    for run in runs {
        let drop = run.script.drop() * size;
        let words = escaped(&run.words);
        if !run.italic && run.script == Script::Line && drop == sunk {
            out += &words;
            continue;
        }
        out += "<tspan";
        if drop != sunk {
            let _ = write!(out, " dy=\"{}\"", number(drop - sunk));
        }
        if run.script != Script::Line {
            let _ = write!(out, " font-size=\"{}\"", number(size * run.script.scale()));
        }
        if run.italic {
            let _ = write!(out, " font-family=\"{SERIF}\" font-style=\"italic\"");
        }
        let _ = write!(out, ">{words}</tspan>");
        sunk = drop;
    }
    out + "</text>\n"
}

fn image(at: Point, size: Point, bitmap: &Bitmap) -> String {
    format!(
        "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" href=\"{}\"/>\n",
        number(at.x),
        number(at.y),
        number(size.x),
        number(size.y),
        data_url("image/png", &raster::encode(bitmap))
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_escaped_and_scripts_come_back_to_the_line() {
        let mut drawing = Drawing::slide();
        drawing.text(Point::ZERO, Anchor::Start, 10.0, crate::figures::style::TEXT, "a_i < b");
        let svg = inline(&drawing, "a < b", "");
        assert!(svg.contains("<title>a &lt; b</title>"));
        assert!(
            svg.contains("a<tspan dy=\"1.8\" font-size=\"7\">i</tspan><tspan dy=\"-1.8\"> &lt; b")
        );
    }
}
