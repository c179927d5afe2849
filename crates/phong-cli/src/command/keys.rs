//! `phong keys`: what a scene text may say.

use phong_scene::{batch_reference_markdown, batch_schema_json, reference_markdown, schema_json};

use crate::failure::Failure;
use crate::report;

const EXAMPLES: &str = "\
Examples:
  phong keys | less                           every table, key, range and default
  phong keys --schema > scene.schema.json     then, as a scene's first line:
                                              #:schema ./scene.schema.json
  phong keys --batch                          the same of batch files";

/// Every key of a scene text, with its range and default, as Markdown
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// As a JSON schema, by which editors complete and check while you type
    #[arg(long)]
    schema: bool,

    /// Of a batch file, which `phong batch` reads
    #[arg(long)]
    batch: bool,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let text = match (args.batch, args.schema) {
        (false, false) => reference_markdown(),
        (false, true) => schema_json(),
        (true, false) => batch_reference_markdown(),
        (true, true) => batch_schema_json(),
    };
    report::data(text.as_bytes())
}
