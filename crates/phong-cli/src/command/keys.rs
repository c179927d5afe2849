//! `phong keys`: what a scene text may say.

use phong_scene::{reference_markdown, schema_json};

use crate::failure::Failure;
use crate::report;

const EXAMPLES: &str = "\
Examples:
  phong keys | less                           every table, key, range and default
  phong keys --schema > scene.schema.json     then, as a scene's first line:
                                              #:schema ./scene.schema.json";

/// Every key of a scene text, with its range and default, as Markdown
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// As a JSON schema, by which editors complete and check while you type
    #[arg(long)]
    schema: bool,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let text = if args.schema { schema_json() } else { reference_markdown() };
    report::data(text.as_bytes())
}
