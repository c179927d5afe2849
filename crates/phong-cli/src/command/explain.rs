//! `phong explain`: why is this pixel this colour.

use std::io::{self, Cursor};
use std::path::{Path, PathBuf};

use phong::explain::{Explanation, explain, exposed_by};
use phong::film::{LayerKind, Window};
use phong::finish::{Finishing, finish};
use phong::image::{self, Content, Encoding, Format};
use phong::render::{Cancel, Event, RenderOptions, render};
use phong::view::View;
use phong_lab::furniture;
use phong_lab::tell::html::{MAX_PIXELS, page};
use phong_lab::tell::{self, Telling};
use phong_scene::Scene;

use crate::args::{self, ImageArgs, InputArgs, ToneArgs, ViewArgs};
use crate::compile::compile;
use crate::failure::Failure;
use crate::output::{Output, keep_inputs_safe};
use crate::progress::Meter;
use crate::{input, interrupt, memory, plan, report};

const EXAMPLES: &str = "\
Examples:
  phong explain scene.toml 480 270                 the equation with the pixel's numbers put in
  phong explain scene.toml 480 270 --samples 1     the ray through the pixel's centre alone
  phong explain scene.toml 480 270 --digits 4      rounded, to check with a pocket calculator
  phong explain scene.toml 480 270 --json | jq .linear
  phong explain scene.toml 480 270 --svg vectors.svg
  phong explain scene.toml --html page.html        every pixel, on one offline page to click in

X runs to the right and Y down from 0, 0 at the upper left.";

/// Why is this pixel this colour: every vector, term, shadow test and ray, with numbers
#[derive(Debug, clap::Args)]
#[command(
    after_help = EXAMPLES,
    override_usage = "phong explain [OPTIONS] <INPUT> <X> <Y>\n       \
                      phong explain [OPTIONS] <INPUT> --html <FILE>"
)]
pub(crate) struct Args {
    #[command(flatten)]
    pub(crate) input: InputArgs,

    /// Column of the pixel, from 0 at the left
    #[arg(required_unless_present = "html", requires = "y", value_parser = place())]
    #[arg(allow_negative_numbers = true)]
    pub(crate) x: Option<u32>,

    /// Row of the pixel, from 0 at the top
    #[arg(required_unless_present = "html", value_parser = place())]
    #[arg(allow_negative_numbers = true)]
    pub(crate) y: Option<u32>,

    /// One JSON object on standard output
    #[arg(long, conflicts_with = "latex")]
    pub(crate) json: bool,

    /// A LaTeX document on standard output
    #[arg(long)]
    pub(crate) latex: bool,

    /// Draw the vectors at the point, in the plane of incidence and in space
    #[arg(long, value_name = "FILE", requires = "x")]
    pub(crate) svg: Option<PathBuf>,

    /// Write one offline page that explains every pixel; one sample a pixel and a small size
    /// unless --samples and --size say otherwise
    #[arg(long, value_name = "FILE")]
    pub(crate) html: Option<PathBuf>,

    /// Which sample to tell in full, from 1 [default: the first; text tells all of up to 2]
    #[arg(long, value_name = "N", value_parser = args::whole(1, u32::MAX), allow_hyphen_values = true)]
    pub(crate) sample: Option<u32>,

    /// Significant digits of every number in text and LaTeX [default: all; LaTeX: 5]
    #[arg(long, value_name = "N", value_parser = args::whole(1_u32, 17), allow_hyphen_values = true)]
    #[arg(conflicts_with = "json")]
    pub(crate) digits: Option<u32>,

    /// Tell mirror and glass rays too that bring less than half a level
    #[arg(long)]
    pub(crate) full: bool,

    #[command(flatten)]
    pub(crate) image: ImageArgs,

    #[command(flatten)]
    pub(crate) view: ViewArgs,

    #[command(flatten)]
    pub(crate) tone: ToneArgs,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut svg = args.svg.as_deref().map(Output::create).transpose()?;
    let mut html = args.html.as_deref().map(Output::create).transpose()?;
    keep_inputs_safe(svg.iter().chain(&html), [&args.input.input])?;
    let mut input = input::open(&args.input, false)?;
    keep_inputs_safe(svg.iter().chain(&html), input.files())?;
    let options = plan::settle(&args.image, &args.view, &mut input)?;
    args.tone.over_scene(&mut input.scene);
    if let Some(sample) = args.sample.filter(|&sample| sample > options.samples()) {
        let samples = options.samples();
        return Err(Failure::usage(format!("--sample {sample}: the pixel has {samples} samples")));
    }
    // One pixel takes a whole picture where that is what exposes it.
    let pixel = args.x.zip(args.y).map(|(x, y)| [x, y]);
    let exposed = pixel.and_then(|pixel| exposed_by(&input.scene, &options, pixel));
    let bytes = exposed.map_or(0, |options| options.film_bytes());
    let scene = compile(&input.scene, &args.input, bytes)?;
    memory::set_aside(bytes)?;
    if let (Some(x), Some(y)) = (args.x, args.y) {
        let mut told = explain(&scene, &options, [x, y]).map_err(|outside| {
            let [width, height] = outside.size;
            Failure::usage(outside.to_string()).with_help(format!(
                "x is from 0 to {}, y from 0 to {}",
                width - 1,
                height - 1
            ))
        })?;
        expose(&mut told, &input.scene, &scene, &options)?;
        if let Some(output) = &mut svg {
            let drawing = tell::svg(&told, chosen(args)).ok_or_else(|| {
                Failure::usage("--svg: the ray meets nothing, so there are no vectors to draw")
            })?;
            output.write(|out| io::Write::write_all(out, drawing.as_bytes()))?;
        }
        tell(args, &told)?;
    }
    if let (Some(output), Some(path)) = (&mut html, &args.html) {
        let mut finishing = Finishing::default().with_tone(input.scene.tone.unwrap_or_default());
        finishing.cel = input.scene.image.cel;
        write_page(args, (&scene, &finishing), options, output, path)?;
    }
    Output::commit(svg.into_iter().chain(html).collect())
}

/// Finds out how the pixel becomes what is seen of it. Where all of the picture is rendered for that, a bar says how
/// far that is.
fn expose(
    told: &mut Explanation,
    scene: &Scene,
    view: &View,
    options: &RenderOptions,
) -> Result<(), Failure> {
    let mut meter = Meter::new(exposed_by(scene, options, told.pixel).is_none(), "exposing");
    meter.samples();
    let listen = |event: Event<'_>| {
        if let Event::Progress(progress) = event {
            meter.update(progress, 0);
        }
    };
    let cancelled = interrupt::heeding(|cancel| {
        furniture::expose(told, scene, view, options, &listen, cancel);
        cancel.is_cancelled()
    });
    meter.finish();
    if cancelled { Err(interrupt::failure()) } else { Ok(()) }
}

/// A column or a row.
fn place() -> impl Fn(&str) -> Result<u32, String> + Clone {
    args::whole(0, u32::MAX)
}

/// The sample to tell in full, from 0.
fn chosen(args: &Args) -> usize {
    args.sample.map_or(0, |sample| sample as usize - 1)
}

fn tell(args: &Args, told: &Explanation) -> Result<(), Failure> {
    let digits = args.digits.map(|digits| digits as usize);
    let telling = |sample| Telling { sample, full: args.full, digits };
    if args.json {
        return report::json(&tell::json(told));
    }
    if args.latex {
        return report::data(tell::latex(told, &telling(Some(chosen(args)))).as_bytes());
    }
    let all = told.samples.len() <= 2 && args.sample.is_none();
    let mut text = tell::text(told, &telling((!all).then(|| chosen(args))));
    if !all && args.sample.is_none() {
        text.push_str(
            "\n(told in full: sample 1; --sample N tells another, --samples 1 the centre)\n",
        );
    }
    report::data(text.as_bytes())
}

fn write_page(
    args: &Args,
    (scene, finishing): (&View, &Finishing),
    options: RenderOptions,
    output: &mut Output,
    path: &Path,
) -> Result<(), Failure> {
    let mut options = options.with_samples(args.image.samples.unwrap_or(1))?;
    let [width, height] = options.size();
    let pixels = f64::from(width) * f64::from(height);
    if pixels > f64::from(MAX_PIXELS) {
        if args.image.size.is_some() {
            return Err(Failure::usage(format!(
                "--html: {width} × {height} pixels are more than the {MAX_PIXELS} a page can hold"
            ))
            .with_help("give a smaller --size"));
        }
        let shrink = (f64::from(MAX_PIXELS) / 2.0 / pixels).sqrt();
        let size = [width, height].map(|n| ((f64::from(n) * shrink) as u32).max(1));
        options = options.with_size(size)?;
    }
    let size = options.size();
    let options = options.with_window(Window::full(size))?;
    let cancel = Cancel::new();
    let cancelled = |cancelled: phong::render::Cancelled| Failure::System(cancelled.to_string());
    let film = render(scene, &options, &|_| {}, &cancel).film;
    let mut png = Cursor::new(Vec::new());
    let picture = Content::Layer(LayerKind::Picture);
    let film = finish(&film, finishing);
    image::write(&film, picture, Format::Png, &Encoding::default(), &mut png)
        .map_err(|error| Failure::System(error.to_string()))?;
    let title = input::stem(&args.input.input);
    let html = page(scene, &options, &title, (png.get_ref(), &film), &|_| {}, &cancel)
        .map_err(cancelled)?;
    output.write(|out| io::Write::write_all(out, html.as_bytes()))?;
    let [width, height] = options.size();
    report::say(&format!(
        "{}: {width} × {height} pixels explained in {}",
        path.display(),
        report::readable(html.len() as u64)
    ));
    Ok(())
}
