//! Outlines as SVG.

use std::fmt::Write;

use super::{DASH, Ink, Path, Point, Step, Stroke};

/// An outline as an element.
pub(crate) fn shape(path: &Path, fill: Option<Ink>, stroke: Option<Stroke>) -> String {
    let mut out = String::from("<path d=\"");
    for step in &path.0 {
        let (letter, points): (char, &[Point]) = match step {
            Step::Move(p) => ('M', &[*p]),
            Step::Line(p) => ('L', &[*p]),
            Step::Quad(c, p) => ('Q', &[*c, *p]),
            Step::Cubic(c, d, p) => ('C', &[*c, *d, *p]),
            Step::Close => ('Z', &[]),
        };
        out.push(letter);
        let numbers: Vec<String> = points.iter().flat_map(|p| [number(p.x), number(p.y)]).collect();
        out += &numbers.join(" ");
    }
    out += "\"";
    out += &paint("fill", fill);
    if let Some(Stroke { ink, width, dashed }) = stroke {
        out += &paint("stroke", Some(ink));
        let _ = write!(out, " stroke-width=\"{}\"", number(width));
        if dashed {
            let _ = write!(out, " stroke-dasharray=\"{}\"", DASH.map(number).join(" "));
        }
    }
    out + "/>\n"
}

/// An attribute's ink, and its opacity.
pub(crate) fn paint(attribute: &str, ink: Option<Ink>) -> String {
    let Some(Ink { srgb: [r, g, b], opacity }) = ink else {
        return format!(" {attribute}=\"none\"");
    };
    let mut out = format!(" {attribute}=\"#{r:02x}{g:02x}{b:02x}\"");
    if opacity < 1.0 {
        let _ = write!(out, " {attribute}-opacity=\"{}\"", number(opacity));
    }
    out
}

/// Hundredths, without trailing zeros.
pub(crate) fn number(value: f64) -> String {
    let rounded = format!("{value:.2}");
    let trimmed = rounded.trim_end_matches('0').trim_end_matches('.');
    if trimmed == "-0" { "0".to_owned() } else { trimmed.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!([1.0, -0.001, 0.5, 12.345_6].map(number), ["1", "0", "0.5", "12.35"]);
    }
}
