//! What each command does: one file a command, with its arguments and its `run`.
//!
//! A new command is a file here, a line in [`Command`], and a line in [`run_here`].

pub(crate) mod batch;
pub(crate) mod bench;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod convert;
pub(crate) mod eval;
pub(crate) mod explain;
pub(crate) mod figure;
pub(crate) mod film;
pub(crate) mod fit;
pub(crate) mod grade;
pub(crate) mod info;
pub(crate) mod keys;
pub(crate) mod man;
pub(crate) mod merge;
pub(crate) mod new;
pub(crate) mod render;
mod stereo;
pub(crate) mod studio;
pub(crate) mod watch;

use clap::builder::Styles;
use clap::builder::styling::AnsiColor;
use clap::{Parser, Subcommand};

use crate::args::{BoundArgs, RenderArgs};
use crate::failure::Failure;
use crate::{input, memory, threads};

const STYLES: Styles = Styles::styled()
    .header(AnsiColor::Green.on_default().bold())
    .usage(AnsiColor::Green.on_default().bold())
    .literal(AnsiColor::Cyan.on_default().bold())
    .placeholder(AnsiColor::Cyan.on_default());

const EXAMPLES: &str = "\
Examples:
  phong new                                  a first scene, scene.toml
  phong render scene.toml                    a picture of a scene, scene.png
  phong render dragon.ply --view iso         of a bare model, with camera and lights of its own
  phong check scene.toml                     every problem, with file, line and column
  phong COMMAND --help                       all about one command

Exit codes: 0 done, 1 the answer is \"no\", 2 the input or the command line is at fault,
3 something else went wrong, 130 interrupted, 143 told to end.";

/// A ray tracer for the Phong reflection model that can explain every pixel.
#[derive(Debug, Parser)]
#[command(name = "phong", version, styles = STYLES, after_help = EXAMPLES, max_term_width = 100)]
#[command(
    subcommand_required = true,
    arg_required_else_help = true,
    disable_help_subcommand = true
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,

    #[command(flatten)]
    pub(crate) bounds: BoundArgs,
}

/// Every command; its file in `command/` holds its arguments and what it does.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Render(Box<RenderArgs>),
    Explain(Box<explain::Args>),
    Figure(figure::Args),
    Eval(eval::Args),
    Fit(fit::Args),
    Compare(compare::Args),
    Grade(grade::Args),
    Check(check::Args),
    Info(info::Args),
    Convert(convert::Args),
    Bench(bench::Args),
    Batch(batch::Args),
    Merge(merge::Args),
    New(new::Args),
    Studio(studio::Args),
    Keys(keys::Args),
    Completions(completions::Args),
    Man(man::Args),
}

/// Does what was asked, within its bounds, on as many threads as were asked for.
pub(crate) fn run(Cli { command, bounds }: Cli) -> Result<(), Failure> {
    memory::keep_within(bounds.max_memory);
    if let Some(folder) = &bounds.jail {
        input::keep_within(folder)?;
    }
    let (wanted, quiet) = match &command {
        Command::Render(args) => (args.work.threads, args.work.quiet),
        Command::Batch(args) => (args.threads, false),
        _ => (None, false),
    };
    threads::on(wanted, quiet, || run_here(command, &bounds))
}

fn run_here(command: Command, bounds: &BoundArgs) -> Result<(), Failure> {
    match command {
        Command::Render(args) if args.work.watch => watch::run(&args),
        Command::Render(args) if args.film.is_asked_for() => film::run(&args),
        Command::Render(args) => render::run(&args).map(drop),
        Command::Explain(args) => explain::run(&args),
        Command::Figure(args) => figure::run(&args),
        Command::Eval(args) => eval::run(&args),
        Command::Fit(args) => fit::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Grade(args) => grade::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Batch(args) => batch::run(&args, bounds),
        Command::Bench(args) => bench::run(&args),
        Command::Merge(args) => merge::run(&args),
        Command::New(args) => new::run(&args),
        Command::Studio(args) => studio::run(&args),
        Command::Keys(args) => keys::run(&args),
        Command::Completions(args) => completions::run(&args),
        Command::Man(args) => man::run(&args),
    }
}
