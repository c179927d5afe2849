//! What a batch file asks for, resolved: every picture of it, and the tasks that make them.

mod contents;
mod index;
mod inputs;
mod names;
mod record;
mod script;

use std::path::{Path, PathBuf};

use clap::Parser;
use phong::image::Format;
use phong_scene::{Batch, Change, Diagnostic, Label, ParameterValues, Written, path_of};

pub(crate) use contents::{Contents, Known};
pub(crate) use index::{link, parameters, write_index};
pub(crate) use record::{Held, Record, State};
pub(crate) use script::{Program, Script, script};

use crate::args::{RenderArgs, ShareOf};
use crate::failure::Failure;
use crate::input;
use names::Pattern;

/// The most pictures of a batch.
const MOST: usize = 1_000_000;

/// The folder of what pictures are, by their content, in the folder that is written to.
const CONTENT: &str = "by-content";

/// The folder of what is known about tasks, in the folder that is written to.
const RECORDS: &str = ".batch";

/// Every task of a batch.
#[derive(Debug)]
pub(crate) struct Tasks {
    /// The batch file.
    pub(crate) file: PathBuf,
    /// The folder that pictures are written to.
    pub(crate) output: PathBuf,
    pub(crate) format: Format,
    pub(crate) pictures: Vec<Picture>,
    /// How many inputs there are.
    pub(crate) inputs: usize,
    /// The parameters, each with how many values it has.
    pub(crate) parameters: Vec<(Written, usize)>,
    /// Whether inputs and parameters go in step.
    pub(crate) zip: bool,
    pub(crate) shares: u32,
    pub(crate) threads: Option<u32>,
    /// Options of `sbatch`.
    pub(crate) slurm: Vec<(String, String)>,
    /// Options of `phong render`.
    pub(crate) options: Vec<String>,
}

/// One picture of a batch.
#[derive(Clone, Debug)]
pub(crate) struct Picture {
    /// Its number, from 0.
    pub(crate) number: usize,
    /// The scene or model.
    pub(crate) input: String,
    /// The input's number, from 0.
    pub(crate) frame: usize,
    /// The value of each parameter.
    pub(crate) changes: Vec<Change>,
    /// What its file is called.
    pub(crate) name: String,
}

/// What there is to do in one go.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Task<'t> {
    /// Its number, from 0.
    pub(crate) number: usize,
    pub(crate) picture: &'t Picture,
    pub(crate) work: Work,
}

/// What a task makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Work {
    /// A picture.
    Whole,
    /// A share of one.
    Share(ShareOf),
    /// A picture of its shares.
    Merge,
}

/// The options of a batch's pictures, as words.
#[derive(Debug, Parser)]
#[command(no_binary_name = true, disable_help_flag = true, disable_version_flag = true)]
struct Options {
    #[command(flatten)]
    render: RenderArgs,
}

impl Tasks {
    /// Reads a batch file, and looks for its inputs.
    pub(crate) fn open(path: &str) -> Result<Self, Failure> {
        let batch = input::read_batch(path)?;
        let file = path_of(path);
        let folder = file.parent().map(Path::to_owned).unwrap_or_default();
        let mut errors = Vec::new();
        let inputs: Vec<String> = batch
            .inputs
            .iter()
            .filter_map(|input| keep(inputs::files(input, &folder), &mut errors))
            .flatten()
            .collect();
        let values = values(&batch, &folder, &mut errors);
        let output = match &batch.output {
            Some(output) => folder.join(path_of(&output.text)),
            None => file.with_extension(""),
        };
        if output == file {
            let help = "give the batch file an ending, or say where with `output`";
            return Err(Failure::usage("the pictures need another folder").with_help(help));
        }
        let options = batch.options.as_ref().map_or(Ok(Vec::new()), options);
        let options = keep(options, &mut errors).unwrap_or_default();
        let paths: Vec<&str> = batch.parameters.iter().map(|p| p.path.text.as_str()).collect();
        let pattern = keep(Pattern::new(batch.name.as_ref(), &paths), &mut errors);
        let (Some(mut pattern), true) = (pattern, errors.is_empty()) else {
            return Err(Failure::Input(errors));
        };
        let choices = choices(&batch, inputs.len(), &values)?;
        let mut pictures: Vec<Picture> = choices
            .into_iter()
            .enumerate()
            .map(|(number, choice)| Picture {
                number,
                input: inputs[choice[0]].clone(),
                frame: choice[0],
                changes: values.iter().zip(&choice[1..]).map(|(v, &i)| v[i].clone()).collect(),
                name: String::new(),
            })
            .collect();
        pattern.vary(&values.iter().map(Vec::len).collect::<Vec<_>>());
        pattern.name(&mut pictures, inputs.len())?;
        let parameters = batch.parameters.iter().zip(&values);
        let parameters = parameters.map(|(p, v)| (p.path.clone(), v.len()));
        Ok(Self {
            output,
            format: pattern.format(),
            pictures,
            inputs: inputs.len(),
            parameters: parameters.collect(),
            zip: batch.zip,
            shares: batch.shares,
            threads: batch.threads,
            slurm: batch.slurm.into_iter().map(|(name, value)| (name.text, value)).collect(),
            options,
            file,
        })
    }

    /// How many tasks there are: one a picture, or one a share and one more a picture.
    pub(crate) fn len(&self) -> usize {
        match self.shares {
            1 => self.pictures.len(),
            shares => self.pictures.len() * (shares as usize + 1),
        }
    }

    /// How many of them, the first, need no other.
    pub(crate) fn first_round(&self) -> usize {
        self.pictures.len() * self.shares as usize
    }

    /// The task of this number.
    pub(crate) fn task(&self, number: usize) -> Task<'_> {
        let first = self.first_round();
        let shares = self.shares as usize;
        let (picture, work) = if shares == 1 {
            (number, Work::Whole)
        } else if number < first {
            let index = (number % shares) as u32;
            (number / shares, Work::Share(ShareOf { index, count: self.shares }))
        } else {
            (number - first, Work::Merge)
        };
        Task { number, picture: &self.pictures[picture], work }
    }

    /// Every task.
    pub(crate) fn iter(&self) -> impl Iterator<Item = Task<'_>> {
        (0..self.len()).map(|number| self.task(number))
    }

    /// The shares that a picture is put together of.
    pub(crate) fn shares_of(&self, picture: &Picture) -> impl Iterator<Item = usize> {
        let shares = self.shares as usize;
        picture.number * shares..(picture.number + 1) * shares
    }

    /// How `phong render` is told to draw a picture; what is written and how is to be said still.
    pub(crate) fn render_args(&self, picture: &Picture) -> Result<RenderArgs, Failure> {
        let mut args = parse(&self.options).map_err(|error| Failure::usage(error.to_string()))?;
        args.input.input.clone_from(&picture.input);
        args.input.set.extend(picture.changes.iter().cloned());
        Ok(args)
    }

    /// What is wrong with a picture, and the parameters that it comes of.
    pub(crate) fn at_fault(&self, picture: &Picture, mut all: Vec<Diagnostic>) -> Failure {
        for diagnostic in &mut all {
            for ((path, _), change) in self.parameters.iter().zip(&picture.changes) {
                let message = format!("{} = {}", path.text, change.value());
                diagnostic.labels.push(Label { message, span: path.span.clone() });
            }
        }
        Failure::Input(all)
    }

    /// The file of a picture of this content.
    pub(crate) fn picture_file(&self, digest: &str) -> PathBuf {
        self.output.join(CONTENT).join(format!("{digest}.{}", self.format.extension()))
    }

    /// The file of a share of a picture of this content.
    pub(crate) fn share_file(&self, digest: &str, share: ShareOf) -> PathBuf {
        let name = format!("{digest}.{}-of-{}.part", share.index, share.count);
        self.output.join(CONTENT).join(name)
    }

    /// What is known about the task on a picture of this content.
    pub(crate) fn record(&self, digest: &str, work: Work) -> Record {
        let name = match work {
            Work::Whole | Work::Merge => format!("{digest}.jsonl"),
            Work::Share(ShareOf { index, count }) => {
                format!("{digest}.{index}-of-{count}.jsonl")
            }
        };
        Record::new(self.records().join(name))
    }

    /// The folder of what is known about tasks.
    pub(crate) fn records(&self) -> PathBuf {
        self.output.join(RECORDS)
    }

    /// Makes the folders that tasks write to.
    pub(crate) fn make_folders(&self) -> Result<(), Failure> {
        for folder in [self.output.join(CONTENT), self.records()] {
            std::fs::create_dir_all(&folder).map_err(|error| {
                let why = phong_scene::trouble(&error);
                Failure::usage(format!("cannot make the folder {}: {why}", folder.display()))
                    .with_help("give another one as `output`")
            })?;
        }
        Ok(())
    }
}

/// The value of a result; its error goes to the others.
fn keep<T>(result: Result<T, Box<Diagnostic>>, errors: &mut Vec<Diagnostic>) -> Option<T> {
    result.map_err(|error| errors.push(*error)).ok()
}

/// The values of every parameter.
fn values(batch: &Batch, folder: &Path, errors: &mut Vec<Diagnostic>) -> Vec<Vec<Change>> {
    let mut values = |parameter: &phong_scene::Parameter| match &parameter.values {
        ParameterValues::Changes(changes) => Some(changes.clone()),
        ParameterValues::Files(pattern) => {
            let files = keep(inputs::files(pattern, folder), errors)?;
            // In a scene a path counts from the scene's folder, here from the batch file's.
            let absolute = |file: &String| {
                let path = std::path::absolute(path_of(file)).unwrap_or_else(|_| path_of(file));
                parameter.file(&phong_scene::path_text(path.as_os_str()))
            };
            Some(files.iter().map(absolute).collect())
        }
    };
    batch.parameters.iter().filter_map(&mut values).collect()
}

/// For each picture, which input it takes, and which value of each parameter.
fn choices(
    batch: &Batch,
    inputs: usize,
    values: &[Vec<Change>],
) -> Result<Vec<Vec<usize>>, Box<Diagnostic>> {
    let counts: Vec<usize> = [inputs].into_iter().chain(values.iter().map(Vec::len)).collect();
    if batch.zip {
        let most = counts.iter().copied().max().unwrap_or(1);
        for (i, &count) in counts.iter().enumerate() {
            if count != 1 && count != most {
                let (what, span) = match i {
                    0 => ("inputs", &batch.inputs[0].span),
                    i => ("values", &batch.parameters[i - 1].path.span),
                };
                let message = format!("there are {count} {what} here, and {most} elsewhere");
                let help = "what is combined by \"zip\" has one value or as many as all others";
                let error = Diagnostic::error(message, span.clone()).with_help(help);
                return Err(Box::new(error));
            }
        }
        let step = |i: usize| counts.iter().map(|&n| if n == 1 { 0 } else { i }).collect();
        return Ok((0..most).map(step).collect());
    }
    let all = counts.iter().try_fold(1_usize, |all, &n| all.checked_mul(n));
    let Some(all) = all.filter(|&all| all <= MOST) else {
        let message = format!("these are more than {MOST} pictures");
        let span = batch.inputs[0].span.clone();
        let help = "divide the batch, or combine by \"zip\"";
        return Err(Box::new(Diagnostic::error(message, span).with_help(help)));
    };
    // The last parameter changes from each picture to the next.
    let choice = |mut number: usize| {
        let mut choice = vec![0; counts.len()];
        for (chosen, &count) in choice.iter_mut().zip(&counts).rev() {
            *chosen = number % count;
            number /= count;
        }
        choice
    };
    Ok((0..all).map(choice).collect())
}

/// The words of `options`, if `phong render` takes them and they are about the picture.
fn options(written: &Written) -> Result<Vec<String>, Box<Diagnostic>> {
    let words: Vec<String> = written.text.split_whitespace().map(str::to_owned).collect();
    let wrong = |message: String, help: Option<String>| {
        let error = Diagnostic::error(message, written.span.clone());
        Box::new(Diagnostic { help, ..error })
    };
    let args = parse(&words).map_err(|error| {
        let told = error.render().to_string();
        let mut lines = told.lines().map(str::trim);
        let message = lines.next().unwrap_or_default().trim_start_matches("error: ").to_owned();
        wrong(message, lines.find_map(|line| line.strip_prefix("tip: ")).map(str::to_owned))
    })?;
    let work = &args.work;
    let unwanted = [
        (args.output.is_some(), "--output", "`output` and `name` say where pictures go"),
        (args.encoding.output_format.is_some(), "--output-format", "the ending of `name` says it"),
        (work.threads.is_some(), "--threads", "write `threads = N`"),
        (work.tile.is_some(), "--tile", "write `shares = N`"),
        (work.watch, "--watch", "leave it out"),
        (args.toml, "--toml", "leave it out: it draws nothing"),
        (
            args.film.is_asked_for(),
            "--turntable, --frames and --path",
            "make `camera.eye` a parameter, or draw frames with `phong render`",
        ),
        (work.json, "--json", "leave it out"),
        (work.quiet, "--quiet", "leave it out: tasks are quiet"),
        (work.resume, "--resume", "leave it out: tasks go on from where they were"),
        (work.passes, "--passes", "leave it out"),
    ];
    match unwanted.into_iter().find(|(is, ..)| *is) {
        Some((_, option, help)) => {
            Err(wrong(format!("`options` do not take {option}"), Some(help.to_owned())))
        }
        None => Ok(words),
    }
}

fn parse(words: &[String]) -> Result<RenderArgs, clap::Error> {
    // Any input will do: it is put in later.
    let words = ["scene.toml"].into_iter().chain(words.iter().map(String::as_str));
    Ok(Options::try_parse_from(words)?.render)
}
