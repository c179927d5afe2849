//! The pictures of two eyes as one: `phong render --stereo side-by-side` and `anaglyph`.

use std::path::PathBuf;
use std::sync::Arc;

use phong::film::{LayerKind, Window};
use phong::look::Look;
use phong::part::Settings;
use phong::render::{Event, Outcome, RenderOptions};
use phong::view::View;
use phong_lab::furniture;
use phong_lab::measure::memory::peak;
use phong_lab::stereo::Pairing;
use phong_lab::tell::diagnostic;
use serde_json::json;

use super::render::{Clock, draw};
use crate::args::{RenderArgs, Stereo};
use crate::compile::compile;
use crate::failure::Failure;
use crate::input::Input;
use crate::plan::{Outputs, Plan, not_finite};
use crate::progress::Meter;
use crate::{interrupt, memory, report};

impl Stereo {
    /// How two pictures become one; `None`: it is one eye's.
    pub(crate) fn pairing(self) -> Option<Pairing> {
        match self {
            Self::Left | Self::Right => None,
            Self::SideBySide => Some(Pairing::SideBySide),
            Self::Anaglyph => Some(Pairing::Anaglyph),
        }
    }
}

/// Refuses what a picture of both eyes cannot have.
pub(super) fn check(args: &RenderArgs) -> Result<(), Failure> {
    let work = &args.work;
    let layers = args.terms || !args.aov.is_empty() || args.lights;
    let unwanted = [
        (work.tile.is_some(), "--tile"),
        (work.resume, "--resume"),
        (args.film.is_asked_for(), "--turntable, --frames and --path"),
        (layers, "--terms, --aov and --lights"),
    ];
    match unwanted.into_iter().find(|(is, _)| *is) {
        Some((_, option)) => {
            Err(Failure::usage(format!("a picture of both eyes does not take {option}"))
                .with_help("--stereo left and --stereo right do, each for a picture of its own"))
        }
        None => Ok(()),
    }
}

/// Draws the pictures of both eyes and writes them as one.
pub(super) fn run(
    args: &RenderArgs,
    plan: &Plan,
    pairing: Pairing,
    mut outputs: Outputs,
    mut input: Input,
    options: &RenderOptions,
    mut meter: Meter,
    mut clock: Clock,
) -> Result<Vec<PathBuf>, Failure> {
    let quiet = args.work.quiet;
    if let Outputs::Figure(_) = outputs {
        return Err(Failure::usage("an SVG holds the picture of one eye")
            .with_help("write a .png, or --stereo left and right"));
    }
    let cameras = plan.eyes(&input.scene.camera)?;
    meter.stage("building");
    let bytes = options.film_bytes();
    let view = compile(&input.scene, &args.input, bytes.saturating_mul(4))?;
    memory::set_aside(bytes.saturating_mul(2))?;
    clock.lap("build");
    meter.samples();
    let listen = |event: Event<'_>| {
        if let Event::Progress(progress) = event {
            meter.update(progress, 0);
        }
    };
    let mut films = Vec::new();
    let mut all = [0_u64; 3];
    for camera in cameras {
        input.scene.camera = camera;
        let settings = Settings::of(&input.scene, options, plan.encoding);
        let view = View::new(Arc::clone(view.geometry()), Look::new(&input.scene))
            .map_err(|error| Failure::usage(error.to_string()))?;
        let Outcome { film, complete, rays } = interrupt::heeding(|cancel| {
            draw(&view, options, &settings, None, false, &listen, cancel)
        })?;
        if !complete {
            meter.finish();
            return Err(interrupt::failure());
        }
        let counts = [rays.primary, rays.shadow, rays.secondary];
        all.iter_mut().zip(counts).for_each(|(all, more)| *all += more);
        if let (Some(unsound), true) = (not_finite(&film), films.is_empty()) {
            if !quiet {
                report::diagnostics(std::slice::from_ref(&unsound));
            }
            input.warnings.push(unsound);
        }
        films.push((film, settings));
    }
    meter.finish();
    clock.lap("trace");
    let [left, right] = [&films[0], &films[1]];
    let settings = &left.1;
    let (film, patches) = {
        let [left, right] = [left, right].map(|(film, settings)| furniture::finish(film, settings));
        pairing.pair(&left, &right)
    };
    let mut finishing = settings.finishing();
    (finishing.lines, finishing.shown, finishing.patches) = (None, None, patches);
    let exposure = outputs.write_finished(&film, settings, &finishing)?;
    outputs.commit()?;
    clock.lap("write");
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
            "exposure": exposure,
            "threads": rayon::current_num_threads(),
            "seconds": clock.json(),
            "rays": { "primary": all[0], "shadow": all[1], "secondary": all[2] },
            "peak_bytes": peak(),
            "warnings": input.warnings.iter().map(diagnostic).collect::<Vec<_>>(),
        }))?;
    } else if report::is_watched() && !quiet {
        let [width, height] = pairing.size([options.shown().width(), options.shown().height()]);
        let seconds = clock.seconds("trace");
        report::say(&format!(
            "{}: {width} × {height}, both eyes, in {seconds:.2} s",
            plan.output.display(),
        ));
    }
    Ok(input.files().to_vec())
}
