//! What is written of an explanation are its numbers, and its products multiply out.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use std::path::Path;

use phong::explain::explain;
use phong::render::RenderOptions;
use phong::terms::TermSet;
use phong::view::View;
use phong_lab::tell::{self, Telling};
use phong_scene::{AmbientRule, Folder, Limits, Material};

fn compiled(file: &str) -> (View, RenderOptions) {
    changed(file, |_| {})
}

/// The scene with every material changed.
fn changed(file: &str, change: fn(&mut Material)) -> (View, RenderOptions) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(file);
    let reading = phong_scene::read(path.to_str().unwrap(), None, &Folder, &Limits::default());
    let mut scene = reading.scene.unwrap_or_else(|| panic!("{file}: {:?}", reading.diagnostics));
    scene.materials.iter_mut().for_each(change);
    let options = RenderOptions::of(&scene.image).unwrap().with_size([20, 12]).unwrap();
    let options = options.with_samples(3).unwrap().with_terms(TermSet::ALL);
    (View::of(&scene).unwrap(), options)
}

#[test]
fn numbers_in_json_are_the_very_bits() {
    let (scene, options) = compiled("two-balls.toml");
    let told = explain(&scene, &options, [9, 6]).unwrap();
    let json: serde_json::Value = serde_json::from_str(&tell::json(&told).to_string()).unwrap();
    for (value, number) in told.linear.to_array().iter().zip(json["linear"].as_array().unwrap()) {
        assert_eq!(number.as_f64().unwrap() as f32, *value);
    }
    assert_eq!(json["samples"].as_array().unwrap().len(), 3);
    assert_eq!(json["pixel"], serde_json::json!([9, 6]));
}

#[test]
fn an_explanation_in_words_puts_the_numbers_into_the_equation() {
    let (scene, options) = compiled("two-balls.toml");
    let told = explain(&scene, &options.with_samples(1).unwrap(), [9, 6]).unwrap();
    let text = tell::text(&told, &all());
    for wanted in ["pixel (9, 6) of 20 × 12", "N·L = ", "diffuse  = k_d (N·L) C_d\n", "bytes"] {
        assert!(text.contains(wanted), "{wanted:?} is not in\n{text}");
    }
}

/// Everything that is told of every sample.
fn all() -> Telling {
    Telling { full: true, ..Telling::default() }
}

/// Whether the factors of a line `… = a × b × (c, d, e)` multiply out to the colour `(f, g, h)`
/// behind or under it.
fn multiplies_out(factors: &str, sign: &str, value: &str, tolerance: f64) -> Result<(), String> {
    let triple = |text: &str| -> [f64; 3] {
        let inside = text.trim().trim_start_matches('(').trim_end_matches(')');
        let numbers: Vec<f64> = inside.split(", ").map(number).collect();
        match numbers[..] {
            [r, g, b] => [r, g, b],
            [grey] => [grey; 3],
            _ => panic!("{text}"),
        }
    };
    let mut product = [1.0; 3];
    for factor in factors.split(sign) {
        for (p, f) in product.iter_mut().zip(triple(factor)) {
            *p *= f;
        }
    }
    let told = triple(value);
    let close = |(a, b): (&f64, &f64)| (a - b).abs() <= tolerance * b.abs() + 1e-30;
    if product.iter().zip(&told).all(close) {
        Ok(())
    } else {
        Err(format!("{factors} is {product:?}, not {told:?}"))
    }
}

/// A number in either notation: `1.5e-9`, or `1.5 \cdot 10^{-9}` with its sign marked.
fn number(text: &str) -> f64 {
    let text = text.replace('@', "e").replace(['{', '}'], "");
    text.trim().parse().unwrap_or_else(|_| panic!("{text} is no number"))
}

#[test]
fn what_is_written_as_a_product_multiplies_out_whatever_the_model_and_dialect() {
    let mut seen = std::collections::BTreeSet::new();
    let switched = |m: &mut Material| {
        (m.times_cosine, m.normalize) = (true, m.k_s.constant().unwrap() < 0.4);
        m.ambient_rule = AmbientRule::Both;
    };
    for (file, change) in [
        ("two-balls.toml", (|_| {}) as fn(&mut Material)),
        ("two-balls.toml", switched),
        ("dialects.toml", |_| {}),
        ("models.toml", |_| {}),
        ("metals.toml", |_| {}),
    ] {
        let (scene, options) = changed(file, change);
        let options = options.with_samples(1).unwrap();
        for [x, y] in (0..12).flat_map(|y| (0..20).map(move |x| [x, y])) {
            let told = explain(&scene, &options, [x, y]).unwrap();
            let (text, latex) = (tell::text(&told, &all()), tell::latex(&told, &all()));
            let lines: Vec<&str> = text.lines().collect();
            for three in lines.windows(3) {
                let [head, above, below] = three else { continue };
                // The last line of an equation, and that above it.
                let steps = [above, below].map(|line| line.trim().strip_prefix("= "));
                let [Some(factors), Some(value)] = steps else { continue };
                if !factors.contains(" × ") || factors.contains('^') || value.contains(" × ") {
                    continue;
                }
                multiplies_out(factors, " × ", value, 2e-6)
                    .unwrap_or_else(|wrong| panic!("{file} {x} {y}: {head}\n{wrong}"));
                let letters = head.trim();
                seen.extend(letters.split_once('=').map(|(name, _)| name.trim().to_owned()));
                for word in ["normalisation", "× N·L", "π f", "× light"] {
                    seen.extend(text.contains(word).then(|| word.to_owned()));
                }
            }
            // A term's factors stand on one line, what they come to on the next.
            let latex = latex.replace("\\\\\n&= ", " = ");
            for line in latex.lines().filter(|line| line.contains("C_") && line.contains(" &= ")) {
                let line = line.replace(" \\cdot 10^", "@").replace("\\\\", "");
                let (_, sides) = line.split_once(" &= ").unwrap();
                let (factors, value) = sides.rsplit_once(" = ").unwrap();
                // Five digits a factor.
                multiplies_out(factors, " \\cdot ", value, 4e-4)
                    .unwrap_or_else(|wrong| panic!("{file} {x} {y}: {line}\n{wrong}"));
            }
        }
    }
    for kind in ["ambient", "diffuse", "normalisation", "× N·L", "π f", "× light"] {
        assert!(seen.contains(kind), "{kind} is not among {seen:?}");
    }
}
