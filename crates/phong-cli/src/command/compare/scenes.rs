//! Two scenes, or one in two models, drawn alike and held against each other term by term.

use std::sync::Arc;

use phong::image::Picture;
use phong::look::Look;
use phong::render::{Cancel, RenderOptions, render as trace};
use phong::terms::TermSet;
use phong::view::View;
use phong_lab::compare::{TermDifference, terms as between};
use phong_lab::fit::{Remodelled, Target, remodel};
use phong_scene::Scene;
use serde_json::{Value, json};

use super::Args;
use crate::args::{ImageArgs, InputArgs, ViewArgs};
use crate::compile::compile;
use crate::failure::Failure;
use crate::input::{self, Input};
use crate::plan;
use phong_lab::compare::shortest;

/// What is to be said about two scenes besides their pictures.
pub(super) struct Scenes {
    /// The difference of each term.
    pub(super) terms: Vec<TermDifference>,
    /// What each side is.
    pub(super) sides: [Side; 2],
    /// Size of the whole picture, samples, and where its compared part begins.
    pub(super) size: [u32; 2],
    pub(super) samples: u32,
    pub(super) corner: [u32; 2],
}

/// One side.
pub(super) struct Side {
    pub(super) name: String,
    /// What it was drawn in; `None`: as it is written.
    pub(super) model: Option<Target>,
    /// What became of the highlights, by material.
    pub(super) changed: Vec<(String, Remodelled)>,
}

/// Draws both sides with the same size, samples and seed.
pub(super) fn render(
    names: [&String; 2],
    models: [Option<Target>; 2],
    args: &Args,
) -> Result<([Picture; 2], Scenes), Failure> {
    let inputs = names.map(|name| InputArgs {
        input: name.clone(),
        format: None,
        strict: args.strict,
        lenient: false,
        set: Vec::new(),
    });
    // What is wrong with the second is told before the first is drawn.
    let once = names[0] == names[1];
    let a = input::open(&inputs[0], false)?;
    let b = input::open(&inputs[1], once)?;
    let (of_a, of_b) = (&a.scene.image, &b.scene.image);
    if args.image.size.is_none() && of_a.size != of_b.size {
        let [(aw, ah), (bw, bh)] = [of_a, of_b].map(|image| (image.size[0], image.size[1]));
        return Err(Failure::usage(format!(
            "{} is drawn at {aw}x{ah} and {} at {bw}x{bh}",
            names[0], names[1]
        ))
        .with_help(format!("draw both at one size, as with --size {aw}x{ah}")));
    }
    let samples = of_a.samples.max(of_b.samples);
    let alike = ImageArgs {
        samples: args.image.samples.or(Some(samples)),
        seed: args.image.seed.or(Some(of_a.seed)),
        ..args.image
    };
    let terms = TermSet::of_scene(&a.scene).or(TermSet::of_scene(&b.scene));
    let mut sides = names.map(|name| Side { name: name.clone(), model: None, changed: Vec::new() });
    let mut films = Vec::with_capacity(2);
    let mut told = ([0, 0], 1, [0, 0]);
    let mut earlier = None;
    for (k, mut input) in [a, b].into_iter().enumerate() {
        let options = plan::settle(&alike, &ViewArgs::default(), &mut input)?.with_terms(terms);
        if let Some(target) = models[k] {
            sides[k].model = Some(target);
            sides[k].changed = remodelled(&mut input, target);
        }
        let corner = [options.window().x0, options.window().y0];
        told = (options.size(), options.samples(), corner);
        let view = ready(&input.scene, &inputs[k], &options, earlier.filter(|_| once))?;
        films.push(trace(&view, &options, &|_| {}, &Cancel::new()).film);
        earlier = Some(view);
    }
    let terms = between(&films[0], &films[1]).map_err(|e| Failure::System(e.to_string()))?;
    let pictures = [Picture::of_film(&films[0]), Picture::of_film(&films[1])];
    let (size, samples, corner) = told;
    Ok((pictures, Scenes { terms, sides, size, samples, corner }))
}

fn remodelled(input: &mut Input, target: Target) -> Vec<(String, Remodelled)> {
    let materials = input.scene.materials.iter_mut();
    materials.filter_map(|m| Some((m.name.clone(), remodel(m, target)?))).collect()
}

/// Makes a scene ready to be drawn; one of which `earlier` shows another look is not built again.
fn ready(
    scene: &Scene,
    args: &InputArgs,
    options: &RenderOptions,
    earlier: Option<View>,
) -> Result<View, Failure> {
    if let Some(earlier) = earlier {
        let view = View::new(Arc::clone(earlier.geometry()), Look::new(scene));
        return view.map_err(|error| Failure::System(error.to_string()));
    }
    let pixels = options.window().pixels();
    // Two films with their terms, the pictures made of them, and their differences.
    let beside = pixels * 4 * (2 * 25 + 2 * 4 + 8);
    compile(scene, args, beside)
}

impl Scenes {
    /// The commands that explain a pixel of the compared part, on each side that is as written.
    pub(super) fn explaining(&self, at: [u32; 2], args: &Args) -> Vec<String> {
        let [x, y] = [at[0] + self.corner[0], at[1] + self.corner[1]];
        let [width, height] = self.size;
        let sized = args.image.size.map_or(String::new(), |_| format!(" --size {width}x{height}"));
        let shadows = if args.image.no_shadows { " --no-shadows" } else { "" };
        let options = format!("{sized} --samples {}{shadows}", self.samples);
        let written = self.sides.iter().filter(|side| side.model.is_none());
        written.map(|side| format!("phong explain {} {x} {y}{options}", side.name)).collect()
    }

    /// The answer's part about scenes.
    pub(super) fn add_to(&self, answer: &mut Value, args: &Args) {
        let terms: serde_json::Map<String, Value> = self
            .terms
            .iter()
            .map(|t| {
                let told = json!({
                    "mean_a": shortest(t.mean_a),
                    "mean_b": shortest(t.mean_b),
                    "mean": shortest(t.mean),
                    "max": shortest(t.max),
                    "worst": t.worst,
                    "share": t.share,
                });
                (t.term.name().to_owned(), told)
            })
            .collect();
        let sides = self.sides.iter().map(|side| {
            let changed: Vec<Value> = side
                .changed
                .iter()
                .map(|(name, told)| {
                    json!({
                        "material": name,
                        "from": told.from.to_string(),
                        "to": told.to.to_string(),
                        "formula": told.formula.map(|formula| formula.text),
                        "k_s": told.k_s,
                    })
                })
                .collect();
            json!({
                "scene": side.name,
                "model": side.model.map(|model| model.to_string()),
                "materials": changed,
            })
        });
        let worst = answer["worst"].as_array().map(|at| [&at[0], &at[1]].map(number));
        if let Value::Object(answer) = answer {
            answer.insert("size".to_owned(), json!(self.size));
            answer.insert("samples".to_owned(), json!(self.samples));
            answer.insert("sides".to_owned(), sides.collect());
            answer.insert("terms".to_owned(), Value::Object(terms));
            let explain = self.explaining(worst.unwrap_or_default(), args);
            answer.insert("explain".to_owned(), json!(explain));
        }
    }
}

fn number(value: &Value) -> u32 {
    value.as_u64().and_then(|n| u32::try_from(n).ok()).unwrap_or(0)
}
