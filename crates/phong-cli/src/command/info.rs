//! `phong info`: what an input holds.

use std::fmt::Write as _;
use std::time::Instant;

use phong_lab::measure::{Holdings, memory};
use serde_json::json;

use crate::args::QuestionArgs;
use crate::compile::compile;
use crate::failure::Failure;
use crate::{input, report};

const EXAMPLES: &str = "\
Examples:
  phong info dragon.ply
  phong info scene.toml --json";

/// What is in it: counts, bounds, materials, memory, build time
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    question: QuestionArgs,
}

pub(crate) fn run(Args { question: args }: &Args) -> Result<(), Failure> {
    let input = input::open(&args.input, false)?;
    let format = input::format(&args.input).map(|format| format.to_string());
    let bounds = input.scene.bounds();
    let bounds = (!bounds.is_empty()).then(|| {
        [bounds.min, bounds.max].map(|corner| corner.to_array().map(phong_lab::compare::shortest))
    });
    let lights = input.scene.lights.len();
    let names: Vec<String> = input.scene.materials.iter().map(|m| m.name.clone()).collect();
    let started = Instant::now();
    let scene = compile(&input.scene, &args.input, 0)?;
    let build_seconds = started.elapsed().as_secs_f64();
    let held = Holdings::of(scene.geometry());
    let bytes = held.bytes + input.scene.image_bytes();
    std::mem::forget(scene);
    if args.json {
        return report::json(&json!({
            "format": format,
            "triangles": held.triangles,
            "spheres": held.spheres,
            "cylinders": held.cylinders,
            "primitives": held.primitives(),
            "lights": lights,
            "materials": names.len(),
            "material_names": names,
            "bounds": bounds,
            "nodes": held.nodes,
            "bytes": bytes,
            "build_seconds": build_seconds,
            "peak_bytes": memory::peak(),
        }));
    }
    let mut text = format!("format      {}\n", format.unwrap_or_default());
    let mut line = |name: &str, value: String| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{name:<12}{value}");
    };
    line("triangles", held.triangles.to_string());
    line("spheres", held.spheres.to_string());
    line("cylinders", held.cylinders.to_string());
    line("other", held.other.to_string());
    line("lights", lights.to_string());
    line("materials", format!("{}: {}", names.len(), shortened(&names)));
    line("bounds", bounds.map_or("none".to_owned(), |[min, max]| format!("{min:?} to {max:?}")));
    line("memory", report::readable(bytes));
    line("build", format!("{build_seconds:.3} s"));
    report::data(text.as_bytes())
}

fn shortened(names: &[String]) -> String {
    let mut text = names.iter().take(8).map(String::as_str).collect::<Vec<_>>().join(", ");
    if names.len() > 8 {
        text.push_str(", …");
    }
    text
}
