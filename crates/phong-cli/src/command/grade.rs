//! `phong grade`: somebody else's rendering held against ours.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use phong::image::{Picture, Transfer};
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_lab::grade::{self, Candidate, Grade, GradeError, Grader, MISTAKES};
use phong_scene::{Scene, srgb_encode};
use serde_json::{Value, json};

use super::compare::{self, Drawing};
use crate::args::InputArgs;
use crate::failure::Failure;
use crate::{input, memory, report};

const EXAMPLES: &str = "\
Examples:
  phong grade scene.toml mine.png
  phong grade scene.toml */picture.png --json

The scene is drawn at the size of each picture. One sample a pixel, through its centre, is expected,
but pixels at edges are left out, so smoothed edges do no harm; of a JPEG what its compression may
have changed is allowed for. A cause is named if it explains the picture; causes that explain it
equally well are told as tied, and where none does, none is named. Exit code 0: every picture
passes; 1: one does not; 2: one cannot be graded, which takes no verdict from the others.";

/// Bytes that a pixel takes while it is graded, at least: what its ray met and one light.
const PIXEL: u64 = 300;

/// Hold somebody else's rendering against ours, term by term: names the term that is wrong
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES, after_long_help = causes())]
pub(crate) struct Args {
    #[command(flatten)]
    pub(crate) input: InputArgs,

    /// Pictures of the scene (.png .ppm .jpg .pfm .exr), drawn by another program
    #[arg(required = true, value_name = "IMAGE")]
    pub(crate) images: Vec<PathBuf>,

    /// Draw how the picture differs from ours, in colours with their scale, beside both (.png); or
    /// write the differences as numbers (.pfm .exr). For one picture
    #[arg(short = 'o', long, value_name = "FILE")]
    pub(crate) diff: Option<PathBuf>,

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
    if args.diff.is_some() && args.images.len() > 1 {
        return Err(Failure::usage("--diff is for one picture, and there are more"));
    }
    let inputs = [Some(args.input.input.as_str()), args.images[0].to_str()];
    let mut drawing = args.diff.as_deref().map(|path| Drawing::beside(path, inputs)).transpose()?;
    let mut scene = input::open(&args.input, false)?.scene;
    let written_size = scene.image.size;
    let mut grader = None;
    let mut answers = Vec::new();
    let (mut all_pass, mut all_graded) = (true, true);
    // One picture at a time; what is wrong with one takes no verdict from the others.
    for path in &args.images {
        let graded = match one(&mut scene, &mut grader, path, drawing.as_mut()) {
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
            let mut answer = serde_json::Map::new();
            answer.insert("image".to_owned(), path.to_string_lossy().into());
            if let Value::Object(told) = grade::json(&graded, scene.image.size) {
                answer.extend(told);
            }
            answers.push(answer.into());
        } else {
            let sizes = [written_size, scene.image.size];
            report::data(as_text(path, &graded, sizes).as_bytes())?;
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
    if let Some(drawing) = drawing.filter(|_| all_graded) {
        drawing.finish()?;
    }
    match (all_graded, all_pass) {
        (false, _) => Err(Failure::Told),
        (true, false) => Err(Failure::No),
        (true, true) => Ok(()),
    }
}

fn one(
    scene: &mut Scene,
    grader: &mut Option<Grader>,
    path: &Path,
    drawing: Option<&mut Drawing>,
) -> Result<Grade, Failure> {
    let picture = compare::read(path)?;
    let pixels = u64::from(picture.size[0]) * u64::from(picture.size[1]);
    memory::want(pixels.saturating_mul(PIXEL))?;
    scene.image.size = picture.size;
    let trouble = |error: GradeError| Failure::usage(format!("{}: {error}", path.display()));
    // What pictures of one size have in common is found out once.
    let ready = match grader.take().filter(|ready| ready.size() == picture.size) {
        Some(ready) => ready,
        None => Grader::new(scene).map_err(trouble)?,
    };
    let graded = grader.insert(ready).grade(&picture).map_err(trouble)?;
    if let Some(drawing) = drawing {
        // A is ours, B is theirs.
        drawing.draw_beside(&ours(scene, &picture)?, &picture)?;
    }
    Ok(graded)
}

/// Our picture of the scene with one sample a pixel, as bytes or as floats as theirs is.
fn ours(scene: &Scene, theirs: &Picture) -> Result<Picture, Failure> {
    let trouble = |error: String| Failure::System(error);
    let options = RenderOptions::of(&scene.image).map_err(|error| trouble(error.to_string()))?;
    let view = View::of(scene).map_err(|error| trouble(error.to_string()))?;
    let film = render(&view, &options.one_sample(), &|_| {}, &Cancel::new()).film;
    let mut picture = Picture::of_film(&film);
    if theirs.transfer == Transfer::Srgb {
        for value in picture.planes.iter_mut().flat_map(|plane| &mut plane.values) {
            *value = srgb_encode(f64::from(*value).clamp(0.0, 1.0)) as f32;
        }
        picture.transfer = Transfer::Srgb;
    }
    Ok(picture)
}

fn as_text(path: &Path, graded: &Grade, [written, size]: [[u32; 2]; 2]) -> String {
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
    if written != size {
        line(format!(
            "drawn at its size, {} × {}; the scene's own is {} × {}",
            size[0], size[1], written[0], written[1]
        ));
    }
    let hidden = format!("this scene cannot reveal: {}", graded.unrevealed.join(", "));
    if graded.pass {
        line(hidden);
        return text;
    }
    match &graded.cause {
        Some(cause) => line(format!("cause: {cause} (confidence {:.2})", graded.confidence)),
        None => line(
            "no known mistake explains it: is it a picture of this scene, seen from its camera?"
                .to_owned(),
        ),
    }
    if let (Some(cause), false) = (&graded.cause, graded.tied.is_empty()) {
        let needs = graded.told_apart_by.as_deref().unwrap_or_default();
        line(format!(
            "these pictures cannot be told apart in this scene: {cause}, {}; a scene that could: \
             one with {needs}",
            graded.tied.join(", ")
        ));
    }
    if !graded.objects.is_empty() {
        line(format!("only these objects differ: {}", graded.objects.join(", ")));
    }
    let mut told = |title: &str, explains: bool| {
        let ones: Vec<&Candidate> =
            graded.candidates.iter().filter(|one| one.explains == explains).collect();
        if !ones.is_empty() && !title.is_empty() {
            line(title.to_owned());
        }
        for one in ones {
            line(format!("- {}: {}", one.cause, one.says));
            line(format!("    {}", one.evidence));
        }
    };
    told("", true);
    told("also tried, and not enough:", false);
    line(hidden);
    text
}
