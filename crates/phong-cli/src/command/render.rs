//! `phong render`: a picture of a scene.

use std::path::PathBuf;
use std::time::Instant;

use phong::film::{Film, Window};
use phong::part::{Settings, fingerprint};
use phong::render::{self, Rendered};
use serde_json::json;

use super::check;
use crate::args::{self, Crop, EncodingArgs, InputArgs, PictureSize, ShareOf, ViewArgs};
use crate::checkpoint::Checkpoint;
use crate::compile::compile;
use crate::failure::Failure;
use crate::input;
use crate::interrupt;
use crate::memory;
use crate::output::keep_inputs_safe;
use crate::plan::Plan;
use crate::progress::{Meter, rate, short};
use crate::report;

const EXAMPLES: &str = "\
Examples:
  phong render scene.toml
  phong render scene.toml -o large.png --size 1920x1080 --samples 64
  phong render dragon.ply --view front --color \"#c8402f\"
  phong render scene.toml -o all.exr --terms --aov depth,normal
  phong render scene.toml -o a.part --tile 0/2     # and 1/2 elsewhere, then: phong merge
  phong render scene.toml -o - | display           # to another program
  cat scene.toml | phong render - --format toml -o scene.png";

/// A picture of a scene or a bare model
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    pub(crate) input: InputArgs,

    /// The file to write (.png .pfm .exr); - is standard output
    /// [default: INPUT's stem + .png, in the current folder]
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) image: ImageArgs,

    #[command(flatten)]
    pub(crate) view: ViewArgs,

    #[command(flatten)]
    pub(crate) encoding: EncodingArgs,

    /// Also every term by itself: layers of an EXR, else files STEM.TERM.ext beside OUT
    #[arg(long, help_heading = "File")]
    pub(crate) terms: bool,

    /// Also depth, normal, position, albedo, uv, object, material, shadow or cost
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', value_parser = args::aov)]
    #[arg(help_heading = "File")]
    pub(crate) aov: Vec<phong::aov::Aov>,

    #[command(flatten)]
    pub(crate) work: WorkArgs,
}

/// What the picture is; the scene's own settings hold where nothing is said.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Picture")]
pub(crate) struct ImageArgs {
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", value_parser = args::size, allow_hyphen_values = true)]
    pub(crate) size: Option<PictureSize>,

    /// Samples a pixel
    #[arg(long, value_name = "N", value_parser = args::whole(1_u32, 1 << 20), allow_hyphen_values = true)]
    pub(crate) samples: Option<u32>,

    /// Seed of the sampling pattern
    #[arg(long, value_name = "N", value_parser = args::whole(0, u64::MAX), allow_hyphen_values = true)]
    pub(crate) seed: Option<u64>,

    /// Mirror and glass bounces; beyond it a ray brings black
    #[arg(long, value_name = "N", value_parser = args::whole(0_u32, 1 << 10), allow_hyphen_values = true)]
    pub(crate) depth: Option<u32>,

    /// Every light reaches everything
    #[arg(long)]
    pub(crate) no_shadows: bool,

    /// What rays see that hit nothing: a colour as for --color, or transparent
    #[arg(long, value_name = "COLOR", value_parser = args::background, allow_hyphen_values = true)]
    pub(crate) background: Option<phong_scene::Background>,

    /// Only these pixels; X1 and Y1 lie outside, and the file has the size of the crop
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = args::crop, allow_hyphen_values = true)]
    pub(crate) crop: Option<Crop>,
}

/// How the work is done.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Work")]
pub(crate) struct WorkArgs {
    /// Threads to use [default: all cores]
    #[arg(long, value_name = "N", value_parser = args::whole(1_u32, 4096), allow_hyphen_values = true)]
    pub(crate) threads: Option<u32>,

    /// Only share I (from 0) of N; OUT becomes a part, which `phong merge` takes
    #[arg(long, value_name = "I/N", value_parser = args::share, allow_hyphen_values = true)]
    pub(crate) tile: Option<ShareOf>,

    /// Keep a checkpoint OUT.part while rendering, and go on from it if there is one
    #[arg(long)]
    pub(crate) resume: bool,

    /// One JSON object about the work, on standard output
    #[arg(long)]
    pub(crate) json: bool,

    /// No talk but errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut clock = Clock::start();
    let plan = Plan::new(args)?;
    let quiet = args.work.quiet;
    if let Some(threads) = args.work.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads as usize);
        pool.build_global().map_err(|e| Failure::System(format!("no {threads} threads: {e}")))?;
    }
    // What cannot be written is known before anything is read, let alone rendered.
    let mut outputs = plan.outputs(args)?;
    keep_inputs_safe(outputs.iter(), [&args.input.input])?;

    let mut meter = Meter::new(quiet, "reading");
    let mut input = input::open(&args.input, quiet)?;
    let options = plan.settle(args, &mut input)?;
    keep_inputs_safe(outputs.iter(), input.files())?;
    clock.lap("read");

    meter.stage("building");
    let scene_sum =
        if plan.share.is_some() || args.work.resume { fingerprint(&input.scene) } else { 0 };
    let settings = Settings::of(scene_sum, &options, plan.encoding);
    let scene = compile(input.scene, &args.input, settings.film_bytes())?;
    clock.lap("build");

    let checkpoint = args.work.resume.then(|| Checkpoint::beside(&plan.output, settings.clone()));
    let film = match &checkpoint {
        Some(checkpoint) => checkpoint.film()?,
        None => None,
    };
    meter.tiles();
    let watch = |film: &Film, progress| {
        meter.update(progress);
        if let Some(checkpoint) = &checkpoint {
            checkpoint.keep(film);
        }
    };
    let film = film.unwrap_or_else(|| settings.empty_film());
    let rendered =
        interrupt::heeding(|cancel| render::resume(&scene, &options, film, &watch, cancel));
    meter.finish();
    let Rendered { film, rays } = rendered.map_err(|_cancelled| Failure::Interrupted)?;
    clock.lap("trace");

    outputs.write(&film, &settings)?;
    outputs.commit()?;
    let trouble = checkpoint.and_then(Checkpoint::remove);
    clock.lap("write");

    // Memory goes back to the system with the process, all at once.
    std::mem::forget((scene, film));
    if let Some(trouble) = trouble.filter(|_| !quiet) {
        report::say(&format!("warning: {trouble}"));
    }
    if args.work.json {
        let Window { x0, y0, x1, y1 } = options.window;
        report::json(&json!({
            "output": plan.output.to_string_lossy(),
            "size": [x1 - x0, y1 - y0],
            "samples": options.samples,
            "threads": rayon::current_num_threads(),
            "seconds": clock.json(),
            "rays": {
                "primary": rays.primary,
                "shadow": rays.shadow,
                "secondary": rays.secondary,
            },
            "peak_bytes": memory::peak(),
            "warnings": input.warnings.iter().map(check::json).collect::<Vec<_>>(),
        }))?;
    } else if report::is_watched() && !quiet {
        let [width, height] = [options.window.width(), options.window.height()];
        let seconds = clock.seconds("trace");
        report::say(&format!(
            "{}: {width} × {height}, {} samples a pixel, {} rays in {seconds:.2} s ({})",
            plan.output.display(),
            options.samples,
            short(rays.total() as f64),
            rate(rays.total(), seconds),
        ));
    }
    Ok(())
}

/// Times of the stages, one after another.
#[derive(Debug)]
struct Clock {
    started: Instant,
    stages: Vec<(&'static str, f64)>,
}

impl Clock {
    fn start() -> Self {
        Self { started: Instant::now(), stages: Vec::new() }
    }

    /// A stage has ended.
    fn lap(&mut self, stage: &'static str) {
        let before: f64 = self.stages.iter().map(|(_, seconds)| seconds).sum();
        self.stages.push((stage, self.started.elapsed().as_secs_f64() - before));
    }

    fn seconds(&self, stage: &str) -> f64 {
        self.stages.iter().find(|(name, _)| *name == stage).map_or(0.0, |(_, seconds)| *seconds)
    }

    fn json(&self) -> serde_json::Value {
        let mut all: serde_json::Map<_, _> = self
            .stages
            .iter()
            .map(|(name, seconds)| ((*name).to_owned(), json!(seconds)))
            .collect();
        all.insert("total".to_owned(), json!(self.started.elapsed().as_secs_f64()));
        all.into()
    }
}
