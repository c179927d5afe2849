//! `phong grade`: somebody else's rendering held against ours.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use phong_lab::grade::{Grade, GradeError, MISTAKES, grade};
use phong_scene::Scene;
use serde_json::{Value, json};

use super::compare;
use crate::args::InputArgs;
use crate::failure::Failure;
use crate::{input, memory, report};

const EXAMPLES: &str = "\
Examples:
  phong grade scene.toml mine.png
  phong grade scene.toml */picture.png --json

Give the scene the size of the pictures; one sample a pixel, through its centre, is expected, but
pixels at edges are left out, so smoothed edges do no harm. Exit code 0: every picture passes; 1:
one does not; 2: one cannot be graded, which takes no verdict from the others.";

/// Bytes that a pixel takes while it is graded, at least (measured: 300).
const PIXEL: u64 = 200;

/// Hold somebody else's rendering against ours, term by term: names the term that is wrong
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES, after_long_help = causes())]
pub(crate) struct Args {
    #[command(flatten)]
    pub(crate) input: InputArgs,

    /// Pictures of the scene (.png .pfm .exr), drawn by another program
    #[arg(required = true, value_name = "IMAGE")]
    pub(crate) images: Vec<PathBuf>,

    /// One JSON object on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

/// The examples, and the list of causes.
fn causes() -> String {
    let mut text = format!("{EXAMPLES}\n\nCauses:\n");
    for mistake in MISTAKES {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {:<24} {}", mistake.cause, mistake.says);
    }
    text
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let scene = input::open(&args.input, false)?.scene;
    let mut answers = Vec::new();
    let (mut all_pass, mut all_graded) = (true, true);
    // One picture at a time; what is wrong with one takes no verdict from the others.
    for path in &args.images {
        let graded = match one(&scene, path) {
            Ok(graded) => graded,
            Err(failure) => {
                all_graded = false;
                let error = failure.summary();
                report::failure(&failure);
                answers.push(json!({ "image": path.to_string_lossy(), "error": error }));
                continue;
            }
        };
        all_pass &= graded.pass;
        if args.json {
            answers.push(as_json(path, &graded));
        } else {
            report::data(as_text(path, &graded).as_bytes())?;
        }
    }
    if args.json {
        match <[Value; 1]>::try_from(answers) {
            Ok([answer]) => report::json(&answer)?,
            Err(answers) => {
                let pass = all_pass && all_graded;
                report::json(&json!({ "pass": pass, "images": answers }))?;
            }
        }
    }
    match (all_graded, all_pass) {
        (false, _) => Err(Failure::Told),
        (true, false) => Err(Failure::No),
        (true, true) => Ok(()),
    }
}

fn one(scene: &Scene, path: &Path) -> Result<Grade, Failure> {
    let picture = compare::read(path)?;
    let pixels = u64::from(picture.size[0]) * u64::from(picture.size[1]);
    memory::want(pixels.saturating_mul(PIXEL))?;
    grade(scene, &picture).map_err(|error| {
        let failure = Failure::usage(format!("{}: {error}", path.display()));
        match error {
            GradeError::Size { .. } => {
                failure.with_help("grade takes pictures of the scene's own size")
            }
            GradeError::NoColor | GradeError::View(_) | GradeError::Options(_) => failure,
        }
    })
}

fn as_json(path: &Path, graded: &Grade) -> Value {
    let candidates: Vec<Value> = graded
        .candidates
        .iter()
        .map(|one| {
            json!({
                "cause": one.cause,
                "says": one.says,
                "evidence": one.evidence,
                "rms": one.residual.rms,
            })
        })
        .collect();
    let terms: serde_json::Map<String, Value> =
        graded.terms.iter().map(|(name, factor)| ((*name).clone(), json!(factor))).collect();
    json!({
        "image": path.to_string_lossy(),
        "verdict": if graded.pass { "pass" } else { "fail" },
        "cause": graded.cause,
        "confidence": graded.confidence,
        "candidates": candidates,
        "terms": terms,
        "rms": graded.residual.rms,
        "worst": { "difference": graded.residual.worst, "at": graded.residual.worst_at },
        "share_noticed": graded.residual.over,
        "pixels_compared": graded.residual.pixels,
    })
}

fn as_text(path: &Path, graded: &Grade) -> String {
    let residual = graded.residual;
    let [x, y] = residual.worst_at;
    let mut text = format!(
        "{}: {}\n  differs by {:.2}/255 rms, {:.1}/255 at worst in pixel ({x}, {y}); {:.2} % of {} pixels notably\n",
        path.display(),
        if graded.pass { "pass" } else { "fail" },
        255.0 * residual.rms,
        255.0 * residual.worst,
        100.0 * residual.over,
        residual.pixels,
    );
    let mut line = |line: String| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {line}");
    };
    let terms: Vec<String> = graded
        .terms
        .iter()
        .filter_map(|(name, factor)| factor.map(|factor| format!("{name} × {factor:.2}")))
        .collect();
    line(format!("terms, ours = 1: {}", terms.join(", ")));
    if graded.pass {
        return text;
    }
    match &graded.cause {
        Some(cause) => line(format!("cause: {cause} (confidence {:.2})", graded.confidence)),
        None => line(
            "no known mistake explains it: is it a picture of this scene, seen from its camera?"
                .to_owned(),
        ),
    }
    for one in &graded.candidates {
        line(format!("- {}: {}", one.cause, one.says));
        line(format!("    {}", one.evidence));
    }
    text
}
