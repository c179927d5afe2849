//! `phong render`: a picture of a scene.

use std::path::PathBuf;
use std::time::Instant;

use phong::film::{LayerKind, Window};
use phong::part::Settings;
use phong::render::{Cancel, Event, Outcome, RenderOptions, Rendering};
use phong::view::View;
use phong_lab::measure::memory::peak;
use phong_lab::tell::diagnostic;
use serde_json::json;

use super::stereo;
use crate::args::{RenderArgs, Stereo};
use crate::checkpoint::Checkpoint;
use crate::compile::compile;
use crate::failure::Failure;
use crate::input;
use crate::interrupt;
use crate::memory;
use crate::output::keep_inputs_safe;
use crate::plan::{Plan, not_finite};
use crate::progress::{Meter, rate, short};
use crate::report;

/// Draws the picture; tells the files that the scene was read from.
pub(crate) fn run(args: &RenderArgs) -> Result<Vec<PathBuf>, Failure> {
    let mut clock = Clock::start();
    if args.film.fps.is_some() {
        return Err(Failure::usage("--fps is for films")
            .with_help("give --turntable N, --frames A:B:S or --path FILE"));
    }
    let plan = Plan::new(args)?;
    let pairing = plan.stereo.and_then(Stereo::pairing);
    if pairing.is_some() {
        stereo::check(args)?;
    }
    if args.toml {
        return print_look(args, &plan);
    }
    let quiet = args.work.quiet;
    // What cannot be written is known before anything is read, let alone rendered.
    let mut outputs = plan.outputs(args)?;
    keep_inputs_safe(outputs.iter(), [&args.input.input])?;

    let mut meter = Meter::new(quiet, "reading");
    let mut input = input::open(&args.input, quiet)?;
    let options = plan.settle(args, &mut input)?;
    plan.look_through(&mut input.scene.camera)?;
    outputs.keep(&plan.output, &options.shown_layers())?;
    keep_inputs_safe(outputs.iter(), input.files())?;
    clock.lap("read");
    if let Some(pairing) = pairing {
        let lap = |stage| clock.lap(stage);
        let eyes = stereo::Eyes { args, plan: &plan, options: &options, pairing };
        let both = eyes.draw(outputs, input, meter, lap)?;
        if args.work.json {
            let Window { x0, y0, x1, y1 } = options.shown();
            let layer =
                |kind: LayerKind| json!({ "name": kind.name(), "averaged": kind.is_averaged() });
            let layers = [LayerKind::Picture, LayerKind::Alpha].map(layer);
            report::json(&json!({
                "output": plan.output.to_string_lossy(),
                "size": pairing.size([x1 - x0, y1 - y0]),
                "layers": layers,
                "samples": options.samples(),
                "exposure": both.exposure,
                "threads": rayon::current_num_threads(),
                "seconds": clock.json(),
                "rays": { "primary": both.rays[0], "shadow": both.rays[1], "secondary": both.rays[2] },
                "peak_bytes": peak(),
                "warnings": both.input.warnings.iter().map(diagnostic).collect::<Vec<_>>(),
            }))?;
        } else if report::is_watched() && !quiet {
            let [width, height] = pairing.size([options.shown().width(), options.shown().height()]);
            let seconds = clock.seconds("trace");
            report::say(&format!(
                "{}: {width} × {height}, both eyes, in {seconds:.2} s",
                plan.output.display(),
            ));
        }
        return Ok(both.input.files().to_vec());
    }

    meter.stage("building");
    let settings = Settings::of(&input.scene, &options, plan.encoding);
    let scene = compile(&input.scene, &args.input, options.film_bytes())?;
    memory::set_aside(settings.film_bytes())?;
    clock.lap("build");

    let beside = || Checkpoint::beside(&plan.output, settings.clone(), &options, quiet);
    let checkpoint = args.work.resume.then(beside);
    meter.samples();
    let listen = |event: Event<'_>| {
        if let Event::Progress(progress) = event {
            meter.update(progress, 0);
        }
    };
    let (kept, replace) = (checkpoint.as_ref(), args.work.replace);
    let Outcome { film, complete, rays } = interrupt::heeding(|cancel| {
        draw(&scene, &options, &settings, kept, replace, &listen, cancel)
    })?;
    meter.finish();
    if !complete {
        return Err(interrupt::failure());
    }
    clock.lap("trace");

    let unsound = not_finite(&film);
    if let (Some(unsound), false) = (&unsound, quiet) {
        report::diagnostics(std::slice::from_ref(unsound));
    }
    input.warnings.extend(unsound);
    let exposure = outputs.write(&film, &settings)?;
    outputs.commit()?;
    if let Some(checkpoint) = checkpoint {
        checkpoint.remove();
    }
    clock.lap("write");

    if !args.work.watch {
        // Memory goes back to the system with the process, all at once.
        std::mem::forget((scene, film));
    }
    if args.work.json {
        let Window { x0, y0, x1, y1 } = options.shown();
        let layer =
            |kind: LayerKind| json!({ "name": kind.name(), "averaged": kind.is_averaged() });
        report::json(&json!({
            "output": plan.output.to_string_lossy(),
            "size": [x1 - x0, y1 - y0],
            "layers": options.shown_layers().into_iter().map(layer).collect::<Vec<_>>(),
            "samples": options.samples(),
            "threads": rayon::current_num_threads(),
            "seconds": clock.json(),
            "rays": {
                "primary": rays.primary,
                "shadow": rays.shadow,
                "secondary": rays.secondary,
            },
            "peak_bytes": peak(),
            "exposure": exposure,
            "warnings": input.warnings.iter().map(diagnostic).collect::<Vec<_>>(),
        }))?;
    } else if report::is_watched() && !quiet {
        let [width, height] = [options.shown().width(), options.shown().height()];
        let seconds = clock.seconds("trace");
        report::say(&format!(
            "{}: {width} × {height}, {} samples a pixel, {} rays in {seconds:.2} s ({})",
            plan.output.display(),
            options.samples(),
            short(rays.total() as f64),
            rate(rays.total(), seconds),
        ));
    }
    Ok(input.files().to_vec())
}

/// Prints all of a scene but its objects, as the command line would have it drawn.
fn print_look(args: &RenderArgs, plan: &Plan) -> Result<Vec<PathBuf>, Failure> {
    let mut input = input::open(&args.input, args.work.quiet)?;
    plan.settle(args, &mut input)?;
    plan.look_through(&mut input.scene.camera)?;
    let text = input.scene.look_text().map_err(|error| Failure::Input(vec![*error]))?;
    report::data(text.as_bytes())?;
    Ok(input.files().to_vec())
}

/// Draws a picture, from where its checkpoint has left it; one that cannot be gone on from is an error,
/// or is replaced.
pub(super) fn draw(
    scene: &View,
    options: &RenderOptions,
    settings: &Settings,
    checkpoint: Option<&Checkpoint>,
    replace: bool,
    listen: &(dyn Fn(Event<'_>) + Sync),
    cancel: &Cancel,
) -> Result<Outcome, Failure> {
    let film = match checkpoint.map(Checkpoint::film) {
        Some(Err(Failure::Usage { .. })) if replace => None,
        Some(film) => film?,
        None => None,
    };
    let film = film.unwrap_or_else(|| settings.empty_film());
    let rendering = Rendering::resume(scene, options, film).map_err(|error| {
        let why = error.to_string();
        checkpoint.map_or(Failure::System(why.clone()), |kept| kept.unusable(&why))
    })?;
    match checkpoint {
        Some(checkpoint) => checkpoint.run(&rendering, listen, cancel),
        None => rendering.run(listen, cancel),
    }
    Ok(rendering.finish())
}

/// Times of the stages, one after another.
#[derive(Debug)]
pub(super) struct Clock {
    started: Instant,
    stages: Vec<(&'static str, f64)>,
}

impl Clock {
    pub(super) fn start() -> Self {
        Self { started: Instant::now(), stages: Vec::new() }
    }

    /// A stage has ended.
    pub(super) fn lap(&mut self, stage: &'static str) {
        let before: f64 = self.stages.iter().map(|(_, seconds)| seconds).sum();
        self.stages.push((stage, self.started.elapsed().as_secs_f64() - before));
    }

    pub(super) fn seconds(&self, stage: &str) -> f64 {
        self.stages.iter().find(|(name, _)| *name == stage).map_or(0.0, |(_, seconds)| *seconds)
    }

    pub(super) fn json(&self) -> serde_json::Value {
        let mut all: serde_json::Map<_, _> = self
            .stages
            .iter()
            .map(|(name, seconds)| ((*name).to_owned(), json!(seconds)))
            .collect();
        all.insert("total".to_owned(), json!(self.started.elapsed().as_secs_f64()));
        all.into()
    }
}
