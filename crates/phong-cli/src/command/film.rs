//! `phong render --turntable N`, `--frames A:B:S` and `--path FILE`: the pictures of a film, one after another.

use std::path::Path;
use std::sync::Arc;

use glam::DVec3;
use phong::film::{Film, Window};
use phong::image::{
    Animation, AnimationFormat, AnimationOptions, Content, Format, WriteError, picture_of,
};
use phong::look::Look;
use phong::part::Settings;
use phong::render::{Event, Outcome, Progress, RenderOptions};
use phong::view::View;
use phong_lab::furniture;
use phong_lab::measure::memory::peak;
use phong_lab::tell::diagnostic;
use phong_scene::{Background, Camera, CameraPath, FrameRange, Scene};
use serde_json::json;

use super::render::{Clock, draw};
use crate::args::{OutputFormat, RenderArgs};
use crate::checkpoint::Checkpoint;
use crate::compile::{compile_again, compile_for};
use crate::failure::Failure;
use crate::film::{Names, Target};
use crate::input::{self, FramesOf, Input};
use crate::output::{Output, keep_inputs_safe};
use crate::plan::{Outputs, Plan, not_finite};
use crate::progress::{Meter, short};
use crate::{interrupt, memory, report};

/// Warnings that are kept for the answer as JSON, at most.
const MOST_WARNINGS: usize = 1000;

/// Draws every picture of the film.
pub(crate) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let clock = Clock::start();
    match (args.film.frames, args.film.turntable) {
        (Some(range), _) => {
            input::with_frames(&args.input, range, |frames| frames_of(args, range, frames, clock))
        }
        (None, None) if args.film.path.is_some() => along_a_path(args, clock),
        (None, turntable) => once_around(args, turntable.unwrap_or(1), clock),
    }
}

/// Turns once around what is seen.
fn once_around(args: &RenderArgs, pictures: u32, clock: Clock) -> Result<(), Failure> {
    let target = Target::new(args, pictures)?;
    let plan = ready(args, &target, 0)?;
    let meter = Meter::new(args.work.quiet, "reading");
    let mut input = input::open(&args.input, args.work.quiet)?;
    let options = plan.settle(args, &mut input)?;
    let axis = input::turn_around(&mut input, &args.view, pictures);
    let motion = Motion::Turn { first: input.scene.camera.clone(), axis, pictures };
    let film =
        Filming { args, plan, options, input, motion, view: None, meter, rays: [0; 3], there: 0 };
    film.run(&target, clock)
}

/// Goes the way that a file says.
fn along_a_path(args: &RenderArgs, clock: Clock) -> Result<(), Failure> {
    let file = args.film.path.as_deref().unwrap_or_default();
    let quiet = args.work.quiet;
    let path = input::read_camera_path(file, args.input.strict, quiet)?;
    let target = Target::new(args, path.pictures)?;
    let plan = ready(args, &target, 0)?;
    keep_inputs_safe([&Output::create(&target.file(0))?], [file])?;
    let meter = Meter::new(quiet, "reading");
    let mut input = input::open(&args.input, quiet)?;
    let options = plan.settle(args, &mut input)?;
    let first = input.scene.camera.clone();
    if let Some(error) = path.unfit(&first) {
        return Err(Failure::Input(vec![error]));
    }
    let motion = Motion::Path { first, path };
    let film =
        Filming { args, plan, options, input, motion, view: None, meter, rays: [0; 3], there: 0 };
    film.run(&target, clock)
}

/// Draws the frames of a trajectory, each seen as the first one is.
fn frames_of(
    args: &RenderArgs,
    range: FrameRange,
    frames: &FramesOf<'_>,
    clock: Clock,
) -> Result<(), Failure> {
    let quiet = args.work.quiet;
    let meter = Meter::new(quiet, "reading");
    let mut input = frames.open(range.start, true, quiet)?;
    let numbers = frames.numbers()?;
    let pictures = u32::try_from(numbers.len()).unwrap_or(u32::MAX);
    let target = Target::new(args, pictures)?;
    let plan = ready(args, &target, range.start)?;
    let options = plan.settle(args, &mut input)?;
    let first = Box::new(input.scene.clone());
    let motion = Motion::Frames { frames, first, at: range.start, numbers };
    let film =
        Filming { args, plan, options, input, motion, view: None, meter, rays: [0; 3], there: 0 };
    film.run(&target, clock)
}

/// What the command line decides; what cannot be written is known before anything is drawn.
fn ready(args: &RenderArgs, target: &Target, number: u64) -> Result<Plan, Failure> {
    let plan = Plan::new(args)?;
    let first = target.file(number);
    keep_inputs_safe([&Output::create(&first)?], [&args.input.input])?;
    Ok(plan)
}

/// A film that is being drawn.
struct Filming<'a> {
    args: &'a RenderArgs,
    plan: Plan,
    options: RenderOptions,
    /// The scene of the last picture.
    input: Input,
    motion: Motion<'a>,
    /// The scene of the last picture that was drawn, made ready.
    view: Option<View>,
    meter: Meter,
    /// Rays so far: primary, shadow, secondary.
    rays: [u64; 3],
    /// Pictures that were there.
    there: u32,
}

/// What changes from picture to picture.
enum Motion<'a> {
    /// The camera goes once around, from its first place about an axis.
    Turn { first: Camera, axis: DVec3, pictures: u32 },
    /// The camera goes a way; where it says nothing, it is as it is first.
    Path { first: Camera, path: CameraPath },
    /// The frames of a trajectory, by their numbers; the first one's scene, and which frame was read
    /// last.
    Frames { frames: &'a FramesOf<'a>, first: Box<Scene>, at: u64, numbers: Vec<u64> },
}

impl Motion<'_> {
    fn pictures(&self) -> u32 {
        match self {
            Self::Turn { pictures, .. } => *pictures,
            Self::Path { path, .. } => path.pictures,
            Self::Frames { numbers, .. } => u32::try_from(numbers.len()).unwrap_or(u32::MAX),
        }
    }

    /// The number that a picture's file has.
    fn number(&self, picture: u32) -> u64 {
        match self {
            Self::Turn { .. } | Self::Path { .. } => picture.into(),
            Self::Frames { numbers, .. } => numbers[picture as usize],
        }
    }
}

impl Filming<'_> {
    /// Draws all, and says what was done.
    fn run(mut self, target: &Target, mut clock: Clock) -> Result<(), Failure> {
        clock.lap("read");
        match target {
            Target::Files(names) => self.draw_files(names)?,
            Target::Animation { format, path, rate } => {
                self.draw_animation(*format, path, *rate)?;
            }
        }
        self.meter.finish();
        clock.lap("draw");
        self.tell(target, &clock)
    }

    /// Makes the scene that of a picture.
    fn stand(&mut self, picture: u32) -> Result<Settings, Failure> {
        let number = self.motion.number(picture);
        match &mut self.motion {
            Motion::Turn { first, axis, pictures } => {
                let Input { scene, bare, .. } = &mut self.input;
                scene.camera = first.turned(*axis, picture, *pictures);
                if *bare {
                    scene.light();
                }
            }
            Motion::Path { first, path } => {
                let Input { scene, bare, .. } = &mut self.input;
                scene.camera = path.camera(first, picture);
                if *bare {
                    scene.light();
                }
            }
            Motion::Frames { frames, first, at, .. } if *at != number => {
                let mut next = frames.open(number, false, self.args.work.quiet)?;
                next.quiet = true;
                self.plan.settle(self.args, &mut next)?;
                next.scene.follow(first, next.bare);
                let mut warnings = std::mem::take(&mut self.input.warnings);
                warnings.append(&mut next.warnings);
                warnings.truncate(MOST_WARNINGS);
                next.warnings = warnings;
                self.input = next;
                *at = number;
            }
            Motion::Frames { .. } => {}
        }
        self.plan.look_through(&mut self.input.scene.camera)?;
        Ok(Settings::of(&self.input.scene, &self.options, self.plan.encoding))
    }

    /// Draws the picture that the scene is of, with a checkpoint beside its file if there is to be one.
    fn draw(
        &mut self,
        number: u32,
        settings: &Settings,
        checkpoint: Option<&Checkpoint>,
    ) -> Result<Film, Failure> {
        let scene = &self.input.scene;
        let pictures = self.motion.pictures();
        let view = match (self.view.take(), &self.motion) {
            // What rays meet is the same: only the look is another.
            (Some(view), Motion::Turn { .. } | Motion::Path { .. }) => {
                View::new(Arc::clone(view.geometry()), Look::new(scene))
                    .map_err(|error| Failure::usage(error.to_string()))?
            }
            (Some(view), Motion::Frames { .. }) => compile_again(&view, scene, &self.args.input)?,
            (None, _) => {
                self.meter.stage("building");
                let bytes = self.options.film_bytes();
                let view = compile_for(pictures, scene, &self.args.input, bytes)?;
                memory::set_aside(settings.film_bytes())?;
                self.meter.samples();
                view
            }
        };
        let before: u64 = self.rays.iter().sum();
        let listen = |event: Event<'_>| {
            if let Event::Progress(progress) = event {
                self.meter.update(self.of_all(number, progress), before);
            }
        };
        let replace = true;
        let Outcome { film, complete, rays } = interrupt::heeding(|cancel| {
            draw(&view, &self.options, settings, checkpoint, replace, &listen, cancel)
        })?;
        self.view = Some(view);
        if !complete {
            return Err(interrupt::failure());
        }
        let counts = [rays.primary, rays.shadow, rays.secondary];
        self.rays.iter_mut().zip(counts).for_each(|(all, more)| *all += more);
        if let Some(unsound) = not_finite(&film)
            && !self.input.warnings.iter().any(|told| told.message.contains("infinite or NaN"))
        {
            if !self.args.work.quiet {
                report::diagnostics(std::slice::from_ref(&unsound));
            }
            self.input.warnings.push(unsound);
        }
        Ok(film)
    }

    /// How far all pictures are when one is so far.
    fn of_all(&self, number: u32, progress: Progress) -> Progress {
        let samples = progress.samples;
        Progress {
            samples: samples * u64::from(self.motion.pictures()),
            samples_done: samples * u64::from(number) + progress.samples_done,
            ..progress
        }
    }

    /// Draws a file a picture. With `--resume` those that are there are left as they are.
    fn draw_files(&mut self, names: &Names) -> Result<(), Failure> {
        let kinds = self.options.shown_layers();
        for number in 0..self.motion.pictures() {
            let settings = self.stand(number)?;
            let path = names.path(self.motion.number(number));
            let format = self.args.encoding.output_format;
            let resume = self.args.work.resume;
            let beside = || {
                let quiet = self.args.work.quiet;
                Checkpoint::beside(&path, settings.clone(), &self.options, quiet)
            };
            if resume && is_there(&path, format, &settings) {
                // It stays where a run was killed just before it would have gone.
                beside().remove();
                self.there += 1;
                continue;
            }
            let mut outputs = Outputs::picture(&path, format, &kinds)?;
            keep_inputs_safe(outputs.iter(), self.input.files())?;
            let checkpoint = resume.then(beside);
            let film = self.draw(number, &settings, checkpoint.as_ref())?;
            outputs.write_marked(&film, &settings)?;
            outputs.commit()?;
            if let Some(checkpoint) = checkpoint {
                checkpoint.remove();
            }
        }
        Ok(())
    }

    /// Draws all pictures into one file. Each is encoded when it is drawn, and forgotten.
    fn draw_animation(
        &mut self,
        format: AnimationFormat,
        path: &Path,
        rate: u16,
    ) -> Result<(), Failure> {
        let mut output = Output::create(path)?;
        keep_inputs_safe([&output], self.input.files())?;
        let Window { x0, y0, x1, y1 } = self.options.shown();
        let options = AnimationOptions {
            format,
            size: [x1 - x0, y1 - y0],
            pictures: self.motion.pictures(),
            rate,
            encoding: self.plan.encoding,
            alpha: self.input.scene.image.background == Background::Transparent,
        };
        let mut failed = None;
        let written = output.write(|out| {
            let mut animation = Animation::new(out, options)?;
            for number in 0..self.motion.pictures() {
                let drawn = self.stand(number);
                let drawn =
                    drawn.and_then(|settings| Ok((self.draw(number, &settings, None)?, settings)));
                match drawn {
                    Ok((film, settings)) => animation.add(&furniture::finish(&film, &settings))?,
                    Err(failure) => {
                        failed = Some(failure);
                        return Err(WriteError::Unsuitable("a picture is missing".to_owned()));
                    }
                }
            }
            animation.finish()
        });
        if let Some(failure) = failed {
            return Err(failure);
        }
        written?;
        Output::commit(vec![output])
    }

    /// Says what was done.
    fn tell(&self, target: &Target, clock: &Clock) -> Result<(), Failure> {
        let Self { args, options, there, .. } = self;
        let pictures = self.motion.pictures();
        if args.work.json {
            let Window { x0, y0, x1, y1 } = options.shown();
            let [primary, shadow, secondary] = self.rays;
            return report::json(&json!({
                "output": target.name(),
                "pictures": pictures,
                "skipped": there,
                "size": [x1 - x0, y1 - y0],
                "samples": options.samples(),
                "threads": rayon::current_num_threads(),
                "seconds": clock.json(),
                "rays": { "primary": primary, "shadow": shadow, "secondary": secondary },
                "peak_bytes": peak(),
                "warnings": self.input.warnings.iter().map(diagnostic).collect::<Vec<_>>(),
            }));
        }
        if !args.work.quiet && (*there > 0 || report::is_watched()) {
            let were = match there {
                0 => String::new(),
                there => format!(", of which {there} were there already"),
            };
            let (rays, seconds) = (self.rays.iter().sum::<u64>(), clock.seconds("draw"));
            report::say(&format!(
                "{}: {pictures} pictures{were}, {} rays in {seconds:.2} s",
                target.name(),
                short(rays as f64),
            ));
        }
        Ok(())
    }
}

/// Whether a picture's files are there, by what they say of themselves.
fn is_there(path: &Path, format: Option<OutputFormat>, settings: &Settings) -> bool {
    let format = match format {
        Some(format) => format.of_picture(),
        None => Format::of_path(path),
    };
    // A figure does not say which picture it is around.
    let Some(format) = format else { return false };
    let checksum = Some(settings.checksum());
    let is_of_it =
        |content: Content| picture_of(&content.path(path)).is_ok_and(|said| said == checksum);
    Content::of(&settings.shown_layers(), format).into_iter().all(is_of_it)
}
