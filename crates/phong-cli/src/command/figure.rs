//! `phong figure`: the lecture's figures.

use std::fmt::Write as _;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use clap::builder::PossibleValuesParser;
use phong_lab::figures::{self, CATALOGUE, Finish};
use phong_scene::trouble;

use crate::failure::Failure;
use crate::output::Output;
use crate::report;

const EXAMPLES: &str = "\
Examples:
  phong figure                       lists the figures
  phong figure reflection            figures/reflection.svg and figures/reflection.png
  phong figure all -d slides         every figure, and slides/index.html to look at them";

/// The name that stands for every figure.
const ALL: &str = "all";

/// The lecture's figures as SVG and PNG; without a name, lists them
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Which figure, or all of them with an index.html
    #[arg(value_parser = names(), hide_possible_values = true)]
    name: Option<String>,

    /// The folder to write to, made where it is missing
    #[arg(short = 'd', long = "dir", value_name = "DIR", default_value = "figures")]
    folder: PathBuf,
}

fn names() -> PossibleValuesParser {
    PossibleValuesParser::new(CATALOGUE.iter().map(|entry| entry.name).chain([ALL]))
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let Some(name) = &args.name else { return list() };
    let folder = &args.folder;
    std::fs::create_dir_all(folder).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists | ErrorKind::NotADirectory | ErrorKind::PermissionDenied => {
            Failure::usage(format!("cannot make the folder {}", folder.display()))
                .with_help("give another one with --dir, where you may write")
        }
        _ => Failure::System(format!("cannot write {}: {}", folder.display(), trouble(&error))),
    })?;
    let mut drawn = Vec::new();
    for entry in CATALOGUE.iter().filter(|entry| name == ALL || name == entry.name) {
        let figure = entry.draw(Finish::Slide);
        let file = |extension: &str| folder.join(figure.name).with_extension(extension);
        write(&file("svg"), figure.svg().as_bytes())?;
        write(&file("png"), &figure.png())?;
        drawn.push(figure);
    }
    if name == ALL {
        write(&folder.join("index.html"), figures::page(&drawn).as_bytes())?;
    }
    Ok(())
}

fn list() -> Result<(), Failure> {
    let mut text = String::new();
    for entry in &CATALOGUE {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{:<12} {}", entry.name, entry.line);
    }
    report::data(text.as_bytes())
}

/// Writes a file whole or not at all, and says so.
fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let mut output = Output::create(path)?;
    output.write(|out| out.write_all(bytes))?;
    Output::commit(vec![output])?;
    report::say(&path.display().to_string());
    Ok(())
}
