//! `phong merge`: shares of a picture put together.

use std::io::BufReader;
use std::path::PathBuf;

use phong::part::{Join, PartError, ReadError};

use crate::args::{EncodingArgs, ToneArgs};
use crate::failure::Failure;
use crate::input::open_file;
use crate::memory;
use crate::output::keep_inputs_safe;
use crate::plan::{Outputs, not_finite};
use crate::report;

const EXAMPLES: &str = "\
Examples:
  phong render scene.toml --tile 0/2 -o a.part
  phong render scene.toml --tile 1/2 -o b.part
  phong merge a.part b.part -o scene.png      # the very bytes of an undivided render";

/// Shares of a picture, as `render --tile` writes them, put together
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Every share of the picture, in any order
    #[arg(value_name = "PART", required = true)]
    pub(crate) parts: Vec<PathBuf>,

    /// The file to write (.png .pfm .exr .svg); - is standard output
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,

    #[command(flatten)]
    pub(crate) encoding: EncodingArgs,

    #[command(flatten)]
    pub(crate) tone: ToneArgs,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    // The tiles of one part beside what is put together already.
    let limit = memory::limit() / 2;
    let mut join = Join::default();
    for path in &args.parts {
        let at_fault = |why: String| Failure::usage(format!("{}: {why}", path.display()));
        let file = open_file(path)?;
        let mut file = BufReader::with_capacity(1 << 18, file);
        let joined = join.read(&path.display().to_string(), &mut file, limit);
        joined.map_err(|error| match error {
            ReadError::Part(PartError::Io(error)) => Failure::reading(path, &error),
            ReadError::Part(error) => at_fault(error.to_string()),
            ReadError::Join(error) => Failure::usage(error.to_string()),
        })?;
    }
    let (film, mut settings) = join.finish().map_err(|error| Failure::usage(error.to_string()))?;
    memory::set_aside(settings.film_bytes())?;
    if let Some(unsound) = not_finite(&film) {
        report::diagnostics(&[unsound]);
    }
    let EncodingArgs { linear, bits, output_format } = &args.encoding;
    let encoding = &mut settings.encoding;
    encoding.linear |= linear;
    encoding.bits = bits.map_or(encoding.bits, Into::into);
    args.tone.over(&mut settings.tone);
    let mut outputs = Outputs::picture(&args.output, *output_format, &settings.shown_layers())?;
    keep_inputs_safe(outputs.iter(), &args.parts)?;
    outputs.write(&film, &settings)?;
    outputs.commit()?;
    std::mem::forget(film);
    Ok(())
}
