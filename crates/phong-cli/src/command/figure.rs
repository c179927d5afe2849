//! `phong figure`: the lecture's figures.

use std::fmt::Write as _;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use clap::builder::PossibleValuesParser;
use phong_lab::figures::{self, CATALOGUE, Entry, Finish, Parameter, Setting};
use phong_scene::{Rgb, trouble};

use crate::args;
use crate::failure::Failure;
use crate::output::Output;
use crate::report;

const EXAMPLES: &str = "\
Examples:
  phong figure                       lists the figures
  phong figure reflection            figures/reflection.svg and figures/reflection.png
  phong figure blinn --theta 60 --alpha 40 --color tomato --dark
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

    /// The angle of incidence, degrees from 5 to 80
    #[arg(long, value_name = "DEGREES", value_parser = between(5.0, 80.0), allow_hyphen_values = true)]
    theta: Option<f64>,

    /// The shininess, from 1 to 1000
    #[arg(long, value_name = "N", value_parser = between(1.0, 1000.0), allow_hyphen_values = true)]
    alpha: Option<f64>,

    /// The colour of the balls: "#rrggbb", a CSS name (both sRGB), or r,g,b (linear)
    #[arg(long, value_name = "COLOR", value_parser = args::color, allow_hyphen_values = true)]
    color: Option<Rgb>,

    /// On dark paper
    #[arg(long)]
    dark: bool,
}

/// A number from `least` to `most`.
fn between(least: f64, most: f64) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| {
        let number = text.trim().parse().ok().filter(|v: &f64| (least..=most).contains(v));
        number.ok_or_else(|| format!("write a number from {least} to {most}"))
    }
}

fn names() -> PossibleValuesParser {
    PossibleValuesParser::new(CATALOGUE.iter().map(|entry| entry.name).chain([ALL]))
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let Some(name) = &args.name else { return list() };
    refuse_unused(args, name)?;
    let setting = Setting {
        theta: args.theta,
        alpha: args.alpha,
        color: args.color,
        dark: args.dark,
        ..Finish::Slide.into()
    };
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
        let figure = entry.draw(setting);
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

/// Refuses what the figure has no use for; of all figures, those that have one take it.
fn refuse_unused(args: &Args, name: &str) -> Result<(), Failure> {
    if args.color.is_some_and(Rgb::is_black) {
        return Err(Failure::usage("--color: of a black ball nothing can be measured"));
    }
    let given = [
        ("--theta", args.theta.is_some(), Parameter::Theta),
        ("--alpha", args.alpha.is_some(), Parameter::Alpha),
        ("--color", args.color.is_some(), Parameter::Color),
    ];
    for (option, _, parameter) in given.into_iter().filter(|(_, given, _)| *given) {
        let takes = |entry: &&Entry| entry.takes.contains(&parameter);
        if name != ALL && !CATALOGUE.iter().filter(takes).any(|entry| entry.name == name) {
            let with: Vec<&str> = CATALOGUE.iter().filter(takes).map(|entry| entry.name).collect();
            return Err(Failure::usage(format!("the figure {name} has no {option}"))
                .with_help(format!("these have: {}", with.join(", "))));
        }
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
