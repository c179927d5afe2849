//! The pictures of two eyes as one: `phong render --stereo side-by-side` and `anaglyph`.

use std::sync::Arc;

use phong::look::Look;
use phong::part::Settings;
use phong::render::{Event, Outcome, RenderOptions, render};
use phong::view::View;
use phong_lab::furniture;
use phong_lab::stereo::Pairing;

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

/// What both eyes are to see, and how it becomes one picture.
pub(super) struct Eyes<'a> {
    pub(super) args: &'a RenderArgs,
    pub(super) plan: &'a Plan,
    pub(super) options: &'a RenderOptions,
    pub(super) pairing: Pairing,
}

/// What was drawn of both eyes.
pub(super) struct Both {
    pub(super) input: Input,
    /// Primary, shadow and secondary rays.
    pub(super) rays: [u64; 3],
    pub(super) exposure: Option<f64>,
}

impl Eyes<'_> {
    /// Draws the pictures of both eyes and writes them as one.
    pub(super) fn draw(
        self,
        mut outputs: Outputs,
        mut input: Input,
        mut meter: Meter,
        mut lap: impl FnMut(&'static str),
    ) -> Result<Both, Failure> {
        let Self { args, plan, options, pairing } = self;
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
        lap("build");
        meter.samples();
        let listen = |event: Event<'_>| {
            if let Event::Progress(progress) = event {
                meter.update(progress, 0);
            }
        };
        let (mut films, mut sound) = (Vec::new(), true);
        let mut all = [0_u64; 3];
        for camera in cameras {
            input.scene.camera = camera;
            let settings = Settings::of(&input.scene, options, plan.encoding);
            let view = View::new(Arc::clone(view.geometry()), Look::new(&input.scene))
                .map_err(|error| Failure::usage(error.to_string()))?;
            let Outcome { film, complete, rays } = interrupt::heeding(|cancel| {
                Ok::<_, Failure>(render(&view, options, &listen, cancel))
            })?;
            if !complete {
                meter.finish();
                return Err(interrupt::failure());
            }
            let counts = [rays.primary, rays.shadow, rays.secondary];
            all.iter_mut().zip(counts).for_each(|(all, more)| *all += more);
            // The same surfaces are seen by both; one of the two may meet what is wrong with them.
            if let (Some(unsound), true) = (not_finite(&film), sound) {
                sound = false;
                if !quiet {
                    report::diagnostics(std::slice::from_ref(&unsound));
                }
                input.warnings.push(unsound);
            }
            films.push((film, settings));
        }
        meter.finish();
        lap("trace");
        let [left, right] = [&films[0], &films[1]];
        let settings = &left.1;
        let (film, patches) = {
            let [left, right] =
                [left, right].map(|(film, settings)| furniture::finish(film, settings));
            pairing.pair(&left, &right)
        };
        let mut finishing = settings.finishing();
        (finishing.lines, finishing.shown, finishing.patches) = (None, None, patches);
        let exposure = outputs.write_finished(&film, settings, &finishing)?;
        outputs.commit()?;
        lap("write");
        Ok(Both { input, rays: all, exposure })
    }
}
