//! What `render` is to do, resolved: the command line over the file over the defaults.

use std::path::{Path, PathBuf};

use phong::aov::Aov;
use phong::film::{Film, LayerKind, Window};
use phong::finish::{Finishing, finish};
use phong::image::{self, Bits, Content, Encoding, Format, WriteError};
use phong::part::{self, Settings};
use phong::render::{Passes, RenderOptions};
use phong::terms::TermSet;
use phong_lab::furniture;
use phong_scene::{Camera, Diagnostic, Image};

use crate::args::{self, EncodingArgs, ImageArgs, OutputFormat, RenderArgs, Stereo, ViewArgs};
use crate::failure::Failure;
use crate::input::{self, Input};
use crate::output::Output;

/// All files that a film becomes, made ready but not yet written.
#[derive(Debug)]
pub(crate) enum Outputs {
    /// A part file.
    Part(Box<Output>),
    /// Each file with what it holds, the picture's first.
    Picture(Format, Vec<(Content, Output)>),
    /// The picture as SVG, with its furniture as outlines.
    Figure(Box<Output>),
}

impl Outputs {
    /// Makes ready the files of a picture with these layers.
    pub(crate) fn picture(
        path: &Path,
        format: Option<OutputFormat>,
        kinds: &[LayerKind],
    ) -> Result<Self, Failure> {
        let stdout = path == Path::new("-");
        let is_svg = |end: &std::ffi::OsStr| end.eq_ignore_ascii_case("svg");
        if format == Some(OutputFormat::Svg)
            || format.is_none() && path.extension().is_some_and(is_svg)
        {
            if Content::of(kinds, Format::Png).len() > 1 {
                return Err(Failure::usage("an SVG holds the picture, and no layers of it")
                    .with_help("write them into an .exr, or beside a .png"));
            }
            return Ok(Self::Figure(Box::new(Output::create(path)?)));
        }
        let format = format.and_then(OutputFormat::of_picture);
        let format = match format.or_else(|| Format::of_path(path)) {
            Some(format) => format,
            None if stdout => Format::Png,
            None => {
                let what = format!("the name {} does not say what to write", path.display());
                return Err(Failure::usage(what)
                    .with_help("end it in .png, .pfm, .exr or .svg, or give --output-format"));
            }
        };
        let contents = Content::of(kinds, format);
        if stdout && contents.len() > 1 {
            return Err(Failure::usage("several files do not fit into standard output")
                .with_help("--output-format exr holds all layers in one"));
        }
        let create = |content: Content| Ok((content, Output::create(&content.path(path))?));
        let files = contents.into_iter().map(create).collect::<Result<_, Failure>>()?;
        Ok(Self::Picture(format, files))
    }

    /// Gives up the files of layers that the film will not have, and makes ready those that were not
    /// known of before, beside the picture's file `path`.
    pub(crate) fn keep(&mut self, path: &Path, kinds: &[LayerKind]) -> Result<(), Failure> {
        if let Self::Picture(format, files) = self {
            let contents = Content::of(kinds, *format);
            files.retain(|(content, _)| contents.contains(content));
            for content in contents {
                if files.iter().all(|(known, _)| *known != content) {
                    files.push((content, Output::create(&content.path(path))?));
                }
            }
        }
        Ok(())
    }

    /// Every file.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Output> {
        let (part, files) = match self {
            Self::Part(output) | Self::Figure(output) => (Some(&**output), None),
            Self::Picture(_, files) => (None, Some(files)),
        };
        part.into_iter().chain(files.into_iter().flatten().map(|(_, output)| output))
    }

    /// Writes everything, under no name yet; tells the stops of exposure of a PNG.
    pub(crate) fn write(
        &mut self,
        film: &Film,
        settings: &Settings,
    ) -> Result<Option<f64>, Failure> {
        match self {
            Self::Part(output) => {
                output.write(|mut out| part::write(film.film_tiles(), settings, &mut out))?;
                Ok(None)
            }
            Self::Picture(format, files) => {
                let finishing = furniture::finishing(film, settings);
                write_files(*format, files, film, settings, &finishing)
            }
            Self::Figure(output) => {
                output.write(|out| {
                    let text = furniture::svg(film, settings, &settings.encoding)?;
                    out.write_all(text.as_bytes())?;
                    Ok::<_, WriteError>(())
                })?;
                Ok(None)
            }
        }
    }

    /// Writes a picture that is finished in another way than its settings say; tells the stops of exposure as
    /// [`write`](Self::write) does.
    pub(crate) fn write_finished(
        &mut self,
        film: &Film,
        settings: &Settings,
        finishing: &Finishing,
    ) -> Result<Option<f64>, Failure> {
        match self {
            Self::Picture(format, files) => write_files(*format, files, film, settings, finishing),
            Self::Part(_) | Self::Figure(_) => self.write(film, settings),
        }
    }

    /// The same, where the files are to say which picture they are.
    pub(crate) fn write_marked(
        &mut self,
        film: &Film,
        settings: &Settings,
    ) -> Result<Option<f64>, Failure> {
        match self {
            Self::Part(_) | Self::Figure(_) => self.write(film, settings),
            Self::Picture(format, files) => {
                let marked = furniture::finishing(film, settings).of_picture(settings.checksum());
                write_files(*format, files, film, settings, &marked)
            }
        }
    }

    /// Gives every file its name: all or none.
    pub(crate) fn commit(self) -> Result<(), Failure> {
        Output::commit(match self {
            Self::Part(output) | Self::Figure(output) => vec![*output],
            Self::Picture(_, files) => files.into_iter().map(|(_, output)| output).collect(),
        })
    }
}

/// Writes the files of a picture, under no name yet.
fn write_files(
    format: Format,
    files: &mut [(Content, Output)],
    film: &Film,
    settings: &Settings,
    finishing: &Finishing,
) -> Result<Option<f64>, Failure> {
    let (picture, encoding) = (finish(film, finishing), &settings.encoding);
    for (content, output) in files {
        output.write(|mut out| image::write(&picture, *content, format, encoding, &mut out))?;
    }
    Ok((format == Format::Png).then(|| picture.tone().stops()))
}

/// What there is to say of pixels that are no finite colour; `None`: there are none.
pub(crate) fn not_finite(film: &Film) -> Option<Diagnostic> {
    let count = film.not_finite();
    let pixels = if count == 1 { "1 pixel is" } else { &format!("{count} pixels are") };
    let message = format!("{pixels} infinite or NaN: products of numbers beyond what an f32 holds");
    let help = "look for a light, a colour or a factor that is far too large";
    (count > 0).then(|| Diagnostic::warning(message, None).with_help(help))
}

/// What `render` is to do, as far as it is known before the input is read.
#[derive(Debug)]
pub(crate) struct Plan {
    pub(crate) output: PathBuf,
    pub(crate) terms: bool,
    pub(crate) aovs: Vec<Aov>,
    pub(crate) lights: bool,
    pub(crate) encoding: Encoding,
    pub(crate) share: Option<(u32, u32)>,
    pub(crate) stereo: Option<Stereo>,
    /// How far apart the two eyes are, in scene units; `None`: a thirtieth of the camera's focus.
    pub(crate) eye_distance: Option<f64>,
}

impl Plan {
    /// What the command line alone decides, or what is wrong with it.
    pub(crate) fn new(args: &RenderArgs) -> Result<Self, Failure> {
        let share = args.work.tile.map(|share| (share.index, share.count));
        let stem = input::stem(&args.input.input);
        let output = args.output.clone().unwrap_or_else(|| {
            share.map_or_else(
                || format!("{stem}.png").into(),
                |(index, count)| format!("{stem}.{index}-of-{count}.part").into(),
            )
        });
        let stdout = output == Path::new("-");
        if stdout && args.work.json {
            return Err(Failure::usage("--json and -o - both want standard output"));
        }
        if stdout && args.work.resume {
            return Err(Failure::usage("--resume needs a file to keep its checkpoint beside"));
        }
        let (terms, aovs, lights) = (args.terms, args.aov.clone(), args.lights);
        let (stereo, eye_distance) = (args.stereo, args.eye_distance);
        let encoding = encoding(&args.encoding);
        Ok(Self { output, terms, aovs, lights, encoding, share, stereo, eye_distance })
    }

    /// The cameras of the left eye and of the right, beside this one.
    pub(crate) fn eyes(&self, camera: &Camera) -> Result<[Camera; 2], Failure> {
        let apart = self.eye_distance.unwrap_or(camera.focus_distance() / 30.0);
        match [-0.5, 0.5].map(|side| camera.beside(side * apart)) {
            [Some(left), Some(right)] => Ok([left, right]),
            _ => Err(Failure::usage("--stereo is for perspective cameras")
                .with_help("to a camera with parallel rays both eyes see the same")),
        }
    }

    /// Makes the camera that of the one eye that is asked for.
    pub(crate) fn look_through(&self, camera: &mut Camera) -> Result<(), Failure> {
        if let Some(side @ (Stereo::Left | Stereo::Right)) = self.stereo {
            let [left, right] = self.eyes(camera)?;
            *camera = if side == Stereo::Left { left } else { right };
        }
        Ok(())
    }

    /// Makes ready what may be written: which terms the scene has is not known yet.
    pub(crate) fn outputs(&self, args: &RenderArgs) -> Result<Outputs, Failure> {
        if self.share.is_some() {
            return Ok(Outputs::Part(Box::new(Output::create(&self.output)?)));
        }
        let any = RenderOptions::of(&Image::default())?;
        let terms = if self.terms { TermSet::ALL } else { TermSet::NONE };
        // How many lights there are is not known yet; one layer says that there are several files.
        let lights = self.lights.then_some(1);
        let layers = any.with_terms(terms).with_aovs(&self.aovs).with_lights(lights).layers();
        Outputs::picture(&self.output, args.encoding.output_format, &layers)
    }

    /// Lays the command line's values over the scene's; the rendering that follows.
    pub(crate) fn settle(
        &self,
        args: &RenderArgs,
        input: &mut Input,
    ) -> Result<RenderOptions, Failure> {
        let options = settle(&args.image, &args.view, input)?;
        args.tone.over_scene(&mut input.scene);
        input.tell(furniture::crowded(&input.scene), args.input.strict)?;
        let terms = if self.terms { TermSet::of_scene(&input.scene) } else { TermSet::NONE };
        let passes = if args.work.passes { Passes::CoarseToFine } else { Passes::One };
        let options = options.with_terms(terms).with_aovs(&self.aovs).with_passes(passes);
        let count = u32::try_from(input.scene.lights.len()).unwrap_or(u32::MAX);
        let options = options.with_lights(self.lights.then_some(count));
        let options = options.with_finishing_of(&input.scene);
        Ok(match self.share {
            Some((index, count)) => options.with_share(index, count)?,
            None => options,
        })
    }
}

/// Lays the command line's values over the scene's.
pub(crate) fn settle(
    args: &ImageArgs,
    view: &ViewArgs,
    input: &mut Input,
) -> Result<RenderOptions, Failure> {
    let ImageArgs { size, samples, seed, depth, no_shadows, background, crop, dpi, look } = args;
    let image = &mut input.scene.image;
    image.size = size.map_or(image.size, |size| size.0);
    input::look(input, view)?;
    if let Some(look) = *look {
        input.scene.put_on(look);
    }
    let image = &mut input.scene.image;
    image.dpi = dpi.or(image.dpi);
    image.samples = samples.unwrap_or(image.samples);
    image.seed = seed.unwrap_or(image.seed);
    image.depth = depth.unwrap_or(image.depth);
    image.background = background.unwrap_or(image.background);
    let options = RenderOptions::of(image)?.with_shadows(!no_shadows);
    let Some(args::Crop { x0, y0, x1, y1 }) = *crop else { return Ok(options) };
    let [width, height] = image.size;
    options.with_window(Window { x0, y0, x1, y1 }).map_err(|_outside| {
        Failure::usage(format!(
            "--crop {x0},{y0},{x1},{y1} reaches out of the picture, which is {width}x{height}"
        ))
    })
}

/// How the command line wants a picture written.
pub(crate) fn encoding(args: &EncodingArgs) -> Encoding {
    Encoding { bits: args.bits.map_or(Bits::Eight, Bits::from), linear: args.linear }
}

impl From<args::Bits> for Bits {
    fn from(bits: args::Bits) -> Self {
        match bits {
            args::Bits::Eight => Self::Eight,
            args::Bits::Sixteen => Self::Sixteen,
        }
    }
}
