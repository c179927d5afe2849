//! `phong compare`: how different two images are, or two scenes, or one scene in two models.

mod scenes;
mod text;

use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use phong::film::{Film, LayerKind, Window};
use phong::finish::{Finishing, finish};
use phong::image::{self, Content, Encoding, Format, Picture, ReadError};
use phong::render::RenderOptions;
use phong_lab::compare::{self, Comparison};
use phong_lab::fit::{FitError, Target};
use phong_scene::read_stream;

use super::fit::trouble;
use crate::args::ImageArgs;
use crate::failure::Failure;
use crate::input::{open_file, unreadable};
use crate::memory;
use crate::output::Output;
use crate::report;

const EXAMPLES: &str = "\
Examples:
  phong compare a.png b.png
  phong compare a.png b.png --tolerance 0.004 -o difference.png
  phong compare a.exr b.exr --json
  phong compare a.toml b.toml -o a-and-b.png           both scenes, and which term differs
  phong compare scene.toml --model blinn-phong         as written, and in another model
  phong compare scene.toml --model phong:32 --model blinn-phong:32

PNGs are compared as encoded values in [0, 1], EXR, PFM and scenes as linear ones. ΔE is CIEDE2000
of the colours as a display shows them: 1 is about the least that is seen side by side.
A model without a number takes the one that the formula of `phong fit` gives; highlights keep their
brightness face on.
Exit code 0: no value differs by more than the tolerance; 1: one does; 2: no comparison is possible.";

/// Two images, scenes, or models of one scene: how different
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// An image (.png .pfm .exr), a scene, or a bare model
    pub(crate) a: String,

    /// The other; left out where --model says what differs
    pub(crate) b: Option<String>,

    /// Draw the differences in colours with their scale, beside both pictures of scenes (.png); or
    /// write them as numbers (.pfm .exr)
    #[arg(short = 'o', long, value_name = "FILE", visible_alias = "output")]
    pub(crate) diff: Option<PathBuf>,

    /// The largest difference that still counts as the same
    #[arg(long, value_name = "T", default_value_t = 0.0, allow_hyphen_values = true)]
    pub(crate) tolerance: f64,

    /// Draw scene A in this model, with its number if it is not to be looked for, beside A as it is
    /// written; given twice: in the one, beside the other
    #[arg(long, value_name = "NAME[:NUMBER]")]
    pub(crate) model: Vec<String>,

    /// One JSON object on standard output
    #[arg(long)]
    pub(crate) json: bool,

    /// Make warnings of scenes errors
    #[arg(long)]
    pub(crate) strict: bool,

    #[command(flatten)]
    pub(crate) image: ImageArgs,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if args.tolerance.is_nan() || args.tolerance < 0.0 {
        return Err(Failure::usage("--tolerance is a number from 0 on"));
    }
    let models = targets(&args.model)?;
    let inputs = [Some(args.a.as_str()), args.b.as_deref()];
    let mut output = args.diff.as_deref().map(|path| Drawing::beside(path, inputs)).transpose()?;
    let kinds = (is_scene(&args.a), args.b.as_deref().map(is_scene));
    let (told, pictures, scenes) = match (kinds, &args.b) {
        ((false, Some(false)), Some(b)) => {
            only_for_scenes(args)?;
            let pictures = [read(Path::new(&args.a))?, read(Path::new(b))?];
            (hold(&args.a, b, &pictures)?, pictures, None)
        }
        ((true, Some(true)), Some(b)) if models.is_empty() => {
            let (pictures, both) = scenes::render([&args.a, b], [None; 2], args)?;
            (hold(&args.a, b, &pictures)?, pictures, Some(both))
        }
        ((true, None), _) if !models.is_empty() => {
            let models = match models[..] {
                [one] => [None, Some(one)],
                _ => [models.first().copied(), models.get(1).copied()],
            };
            let (pictures, both) = scenes::render([&args.a; 2], models, args)?;
            (hold(&args.a, &args.a, &pictures)?, pictures, Some(both))
        }
        (kinds, _) => return Err(unfit(args, kinds)),
    };
    if let Some(output) = &mut output {
        output.draw(&told, &pictures, scenes.is_some())?;
    }
    let same = !compare::exceeds(told.max, args.tolerance);
    if args.json {
        let mut answer = compare::json(&told, args.tolerance);
        if let Some(scenes) = &scenes {
            scenes.add_to(&mut answer, args);
        }
        report::json(&answer)?;
    } else {
        let mut text = text::numbers(&told, args.tolerance);
        if let Some(scenes) = &scenes {
            text.push_str(&text::scenes(scenes, &told, args));
        }
        report::data(text.as_bytes())?;
    }
    if let Some(output) = output {
        output.finish()?;
    }
    if same { Ok(()) } else { Err(Failure::No) }
}

/// Whether a name is that of a scene or a bare model. What is neither that nor an image is tried as
/// an image, by its content.
fn is_scene(name: &str) -> bool {
    Format::of_path(Path::new(name)).is_none() && phong_scene::Format::of_path(name).is_some()
}

/// What is wrong with a pair that cannot be compared.
fn unfit(args: &Args, kinds: (bool, Option<bool>)) -> Failure {
    let Args { a, b, .. } = args;
    let b = b.as_deref().unwrap_or_default();
    match kinds {
        (true, Some(true)) => Failure::usage("--model is for one scene, and here are two")
            .with_help(format!("leave out {b}, or --model")),
        (true, None) => Failure::usage(format!("there is nothing to compare {a} with"))
            .with_help("give another scene, or --model NAME"),
        (false, None) if args.model.is_empty() => {
            Failure::usage(format!("there is nothing to compare {a} with"))
                .with_help("give another image")
        }
        (false, None) => Failure::usage(format!("--model is for scenes, and {a} is an image")),
        (first, _) => {
            let (scene, image) = if first { (a.as_str(), b) } else { (b, a.as_str()) };
            Failure::usage(format!("{scene} is a scene and {image} an image")).with_help(format!(
                "`phong grade {scene} {image}` holds one against the other, or render the scene first"
            ))
        }
    }
}

/// What renders are made of means nothing to images.
fn only_for_scenes(args: &Args) -> Result<(), Failure> {
    let ImageArgs { size, samples, seed, depth, no_shadows, background, crop, dpi, look } =
        &args.image;
    let given = [
        ("--model", !args.model.is_empty()),
        ("--size", size.is_some()),
        ("--samples", samples.is_some()),
        ("--seed", seed.is_some()),
        ("--depth", depth.is_some()),
        ("--no-shadows", *no_shadows),
        ("--background", background.is_some()),
        ("--crop", crop.is_some()),
        ("--look", look.is_some()),
        ("--dpi", dpi.is_some()),
    ];
    match given.iter().find(|(_, given)| *given) {
        Some((name, _)) => {
            let [a, b] = [&args.a, args.b.as_ref().unwrap_or(&args.a)];
            Err(Failure::usage(format!("{name} is for scenes, and {a} and {b} are images")))
        }
        None => Ok(()),
    }
}

fn targets(models: &[String]) -> Result<Vec<Target>, Failure> {
    if models.len() > 2 {
        return Err(Failure::usage("--model is given once or twice"));
    }
    let at_fault = |error: FitError| match (&error, trouble(&error)) {
        (FitError::UnknownModel { name }, Failure::Usage { help, .. }) => {
            let message = format!("--model: no model `{name}`; there are {}", Target::names());
            Failure::Usage { message, help }
        }
        (_, told) => told,
    };
    models.iter().map(|text| text.parse().map_err(at_fault)).collect()
}

fn hold(a: &str, b: &str, [one, two]: &[Picture; 2]) -> Result<Comparison, Failure> {
    compare::compare(one, two).map_err(|error| match error {
        compare::CompareError::Size { a: of_a, b: of_b } => Failure::usage(format!(
            "{a} is {}x{} and {b} is {}x{}: only images of one size are compared",
            of_a[0], of_a[1], of_b[0], of_b[1]
        )),
        compare::CompareError::Channels => {
            Failure::usage(format!("{a} and {b} have no channel in common"))
        }
    })
}

/// An image, read. It may take half of the memory there is: another is read beside it, or drawn.
pub(crate) fn read(path: &Path) -> Result<Picture, Failure> {
    let at_fault = |why: String| Failure::usage(format!("{}: {why}", path.display()));
    let mut file = open_file(path)?;
    let unreadable = |error: io::Error| unreadable(path, &error);
    let most = memory::limit() / 2;
    // What is no picture is not read to its end, which it may not have.
    let begin = read_stream((&mut file).take(8), most.max(8)).map_err(unreadable)?;
    if begin.is_empty() {
        return Err(at_fault("the file is empty".to_owned()));
    }
    if !Picture::is_known(&begin) {
        return Err(at_fault(ReadError::Unknown.to_string()));
    }
    let bytes = read_stream(begin.chain(file), most).map_err(unreadable)?;
    Picture::read_within(&bytes, most).map_err(|error| at_fault(error.to_string()))
}

/// Where differences are drawn.
pub(crate) struct Drawing {
    output: Output,
    format: Format,
}

impl Drawing {
    /// A file that is none of the inputs.
    pub(crate) fn beside(path: &Path, inputs: [Option<&str>; 2]) -> Result<Self, Failure> {
        let stdout = path == Path::new("-");
        let format = Format::of_path(path).or(stdout.then_some(Format::Png)).ok_or_else(|| {
            Failure::usage(format!("the name {} does not say what to write", path.display()))
                .with_help("end it in .png, .pfm or .exr")
        })?;
        if stdout {
            return Err(
                Failure::usage("the numbers go to standard output").with_help("give --diff a file")
            );
        }
        let output = Output::create(path)?;
        if inputs.into_iter().flatten().any(|input| output.is(Path::new(input))) {
            return Err(Failure::usage(format!("{} would be written over", path.display()))
                .with_help("give --diff another file"));
        }
        Ok(Self { output, format })
    }

    /// Draws how a picture differs from ours, beside both.
    pub(crate) fn draw_beside(&mut self, ours: &Picture, theirs: &Picture) -> Result<(), Failure> {
        let found =
            compare::compare(ours, theirs).map_err(|error| Failure::usage(error.to_string()))?;
        self.draw(&found, &[ours.clone(), theirs.clone()], true)
    }

    /// Puts the file in place.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        Output::commit(vec![self.output])
    }

    /// A drawing with a scale as PNG; else the differences themselves, three channels a pixel.
    fn draw(
        &mut self,
        found: &Comparison,
        [a, b]: &[Picture; 2],
        side_by_side: bool,
    ) -> Result<(), Failure> {
        let film = if self.format == Format::Png {
            compare::draw(found, a.size, side_by_side.then_some([a, b]))
        } else if found.map.is_empty() {
            return Err(Failure::usage("the images have no colours whose differences to write")
                .with_help("give --diff a .png"));
        } else {
            let kinds = [LayerKind::Picture];
            let mut film = Film::new(a.size, Window::full(a.size), RenderOptions::TILE, &kinds);
            film.layers[0].values.copy_from_slice(&found.map);
            film
        };
        let content = Content::of(&[LayerKind::Picture], self.format)[0];
        let format = self.format;
        let film = finish(&film, &Finishing::default());
        self.output
            .write(|mut out| image::write(&film, content, format, &Encoding::default(), &mut out))
    }
}
