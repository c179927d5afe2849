//! A comparison in words and columns.

use std::fmt::{self, Write};

use phong_lab::compare::{Comparison, Pixel};

use super::Args;
use super::scenes::Scenes;

/// Values of a pixel that fit into a line: colours and alpha.
const SHOWN: usize = 4;

/// How different two pictures are.
pub(super) fn numbers(told: &Comparison, tolerance: f64) -> String {
    let mut text = String::new();
    // Writing to a String does not fail.
    let _ = write_numbers(&mut text, told, tolerance);
    text
}

fn write_numbers(out: &mut String, told: &Comparison, tolerance: f64) -> fmt::Result {
    let [x, y] = told.worst;
    let name = told.channels.iter().map(|c| c.name.len()).max().unwrap_or(0).max(7);
    writeln!(out, "{:name$}  {:>10}  {:>10}  {:>10}  {:>9}", "", "max", "mean", "rms", "psnr")?;
    let mut row = |label: &str, max: f64, mean: f64, rms: f64, psnr: Option<f64>| {
        let psnr = psnr.map_or_else(|| "-".to_owned(), |psnr| format!("{psnr:.2} dB"));
        let [max, mean, rms] = [max, mean, rms].map(brief);
        writeln!(out, "{label:name$}  {max:>10}  {mean:>10}  {rms:>10}  {psnr:>9}")
    };
    row("all", told.max, told.mean, told.rms, told.psnr)?;
    for c in &told.channels {
        row(&c.name, c.max, c.mean, c.rms, c.psnr)?;
    }
    writeln!(out)?;
    if told.max == 0.0 {
        return writeln!(out, "nothing differs");
    }
    writeln!(out, "largest       {} in {} at {x}, {y}", brief(told.max), told.channel)?;
    if told.not_finite > 0 {
        let pixels = if told.not_finite == 1 { "pixel has" } else { "pixels have" };
        writeln!(
            out,
            "not finite    {} {pixels} a value that is finite in one picture only; no mean counts it",
            told.not_finite
        )?;
    }
    if let Some(d) = told.delta_e {
        let [x, y] = d.worst;
        writeln!(
            out,
            "ΔE 2000       at most {:.2}, at {x}, {y}; mean {:.3}; {:.2} % of the pixels over 1",
            d.max,
            d.mean,
            100.0 * d.over_1
        )?;
    }
    let (pixels, all) = (told.pixels_over(tolerance), told.largest.len());
    writeln!(
        out,
        "over {:<8} {pixels} of {all} pixels, {:.2} %",
        tolerance,
        100.0 * pixels as f64 / all as f64
    )?;
    writeln!(out, "over 1/255    {:.2} % of the values", 100.0 * told.over_1_255)?;
    writeln!(out)?;
    let names: Vec<&str> = told.channels.iter().take(SHOWN).map(|c| &*c.name).collect();
    let room = (names.len() * 9).max(9);
    let title = |side| format!("{side} ({})", names.join(" "));
    writeln!(
        out,
        "{:<14}{:>10}   {:<room$} {}",
        "worst pixels",
        "differ by",
        title('A'),
        title('B')
    )?;
    for Pixel { at: [x, y], difference, a, b } in &told.worst_pixels {
        let values = |values: &[f64]| {
            values
                .iter()
                .take(SHOWN)
                .map(|v| format!("{:<8}", brief(*v)))
                .collect::<Vec<_>>()
                .join(" ")
        };
        let line = format!(
            "  {:<12}{:>10}   {:<room$} {}",
            format!("{x}, {y}"),
            brief(*difference),
            values(a),
            values(b)
        );
        writeln!(out, "{}", line.trim_end())?;
    }
    Ok(())
}

/// Which term differs, what was changed, and what explains the worst pixels.
pub(super) fn scenes(scenes: &Scenes, told: &Comparison, args: &Args) -> String {
    let mut text = String::new();
    let _ = write_scenes(&mut text, scenes, told, args);
    text
}

fn write_scenes(out: &mut String, scenes: &Scenes, told: &Comparison, args: &Args) -> fmt::Result {
    writeln!(out)?;
    let [width, height] = scenes.size;
    for (letter, side) in ["A", "B"].into_iter().zip(&scenes.sides) {
        let how = match side.model {
            Some(model) => format!("in the model {model}"),
            None => "as written".to_owned(),
        };
        writeln!(out, "{letter}  {}, {how}", side.name)?;
        for (name, changed) in &side.changed {
            let by = changed.formula.map_or(String::new(), |formula| format!("; {}", formula.text));
            writeln!(
                out,
                "     {name}: {} to {}, k_s {} to {}{by}",
                changed.from,
                changed.to,
                brief(f64::from(changed.k_s[0])),
                brief(f64::from(changed.k_s[1]))
            )?;
        }
    }
    let samples = scenes.samples;
    let plural = if samples == 1 { "" } else { "s" };
    writeln!(out, "   {width}x{height}, {samples} sample{plural} a pixel, linear values")?;
    writeln!(out)?;
    writeln!(
        out,
        "{:<13} {:>10}  {:>10}  {:>10}  {:>10}  {:>7}  most at",
        "term", "mean of A", "mean of B", "mean |A−B|", "max |A−B|", "share"
    )?;
    for t in &scenes.terms {
        let [a, b, mean, max] = [t.mean_a, t.mean_b, t.mean, t.max].map(brief);
        write!(out, "{:<13} {a:>10}  {b:>10}  {mean:>10}  {max:>10}  ", t.term.name())?;
        if t.max == 0.0 {
            writeln!(out, "{:>7}  -", "-")?;
        } else {
            let share = format!("{:.1} %", 100.0 * t.share);
            writeln!(out, "{share:>7}  {}, {}", t.worst[0], t.worst[1])?;
        }
    }
    if told.worst_pixels.is_empty() {
        return Ok(());
    }
    let hints = scenes.explaining(told.worst, args);
    for (k, hint) in hints.iter().enumerate() {
        writeln!(out, "{}  {hint}", if k == 0 { "\nwhy" } else { "   " })?;
    }
    Ok(())
}

/// Six digits after the point, or as many as are read; large and small numbers by powers of ten.
fn brief(v: f64) -> String {
    match v.abs() {
        0.0 => "0".to_owned(),
        size if !size.is_finite() => v.to_string(),
        size if !(5e-5..1e5).contains(&size) => format!("{v:.2e}"),
        _ => format!("{v:.6}"),
    }
}
