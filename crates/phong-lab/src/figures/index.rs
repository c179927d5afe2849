//! A page with all the figures, for reading without a network.

use std::fmt::Write;

use super::{Figure, Number, plot, svg, text};
use crate::markup::escaped;

const STYLE: &str = "\
body { margin: 2.5rem auto; padding: 0 1.5rem; max-width: 60rem; color: #1f242b;
  font: 1.05rem/1.55 'Noto Sans', 'DejaVu Sans', sans-serif; }
i { font-family: 'Noto Serif', 'DejaVu Serif', serif; }
section { margin: 4rem 0; }
svg { width: 100%; height: auto; border: 1px solid #e6e9ed; }
table { border-collapse: collapse; font-size: .92rem; }
th { font-weight: 400; text-align: left; padding: .15rem 2rem .15rem 0; }
td { text-align: right; font-variant-numeric: tabular-nums; }
nav, .files { color: #5c6570; }
a { color: #0066a8; }
.equation { font-size: 1.25rem; }
";

const DARK: &str = "\
body { color: #e4e8ec; background: #15181c; }
svg { border-color: #3a424c; }
nav, .files { color: #9aa5b1; }
a { color: #5cb3f0; }
";

/// A self-contained HTML page: each figure with its equation, its sentence and its numbers.
///
/// It links to `NAME.svg` and `NAME.png` beside it, and shows all there is without them.
pub fn page(figures: &[Figure]) -> String {
    let dark = if figures.iter().any(|figure| figure.dark) { DARK } else { "" };
    let mut out = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>The figures of the Phong reflection model</title>\n<style>\n{}{STYLE}{dark}</style>\n\
         </head>\n<body>\n<h1>The figures of the Phong reflection model</h1>\n\
         <p>Everything here was drawn, rendered and measured by <code>phong figure all</code>.</p>\n",
        svg::font_faces()
    );
    let link =
        |figure: &Figure| format!("<a href=\"#{}\">{}</a>", figure.name, escaped(figure.title()));
    let links: Vec<String> = figures.iter().map(link).collect();
    let _ = writeln!(out, "<nav>{}</nav>", links.join(" · "));
    for figure in figures {
        section(&mut out, figure);
    }
    out + "</body>\n</html>\n"
}

fn section(out: &mut String, figure: &Figure) {
    let Figure { name, plate, .. } = figure;
    let _ = write!(
        out,
        "<section id=\"{name}\">\n<h2>{}</h2>\n<p class=\"equation\">{}</p>\n{}<p>{}</p>\n<table>\n",
        escaped(plate.title),
        text::html(plate.equation),
        svg::inline(&plate.drawing, plate.title, plate.caption),
        escaped(plate.caption),
    );
    for Number { name, value, unit } in &plate.numbers {
        let unit = if matches!(*unit, "" | "°") { (*unit).to_owned() } else { format!(" {unit}") };
        let _ = writeln!(
            out,
            "<tr><th>{}</th><td>{}{unit}</td></tr>",
            escaped(name),
            text::html(&plot::six(*value))
        );
    }
    let _ = write!(
        out,
        "</table>\n<p class=\"files\"><a href=\"{name}.svg\">SVG</a> · \
         <a href=\"{name}.png\">PNG</a></p>\n</section>\n"
    );
}
