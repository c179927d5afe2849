//! `phong batch`: many pictures, as tasks that may be done anywhere, killed and done again.

mod local;
mod task;
mod tell;

use rayon::iter::{IntoParallelIterator, ParallelIterator};

use crate::args::{BoundArgs, path, whole};
use crate::batch::{Contents, Known, Program, Script, State, Tasks, Work, script, write_index};
use crate::failure::Failure;
use crate::{input, report};

const EXAMPLES: &str = "\
Examples:
  phong batch sweep.toml                     what there is to do
  phong batch sweep.toml --run --jobs 4      do what is not done, on this machine
  phong batch sweep.toml --status            what is done, what failed, and why
  phong batch sweep.toml --script slurm > sweep.sh && bash sweep.sh
  phong batch sweep.toml --task 17           one task, as those scripts do it

A batch file says which pictures there are; `phong keys --batch` tells all its keys:
  version = 1
  inputs = [\"balls.toml\"]
  options = \"--size 640x360\"
  [parameters]
  \"materials.red.shininess\" = [1, 10, 100]
  \"camera.eye\" = { from = [0, 2, 8], to = [4, 2, 8], steps = 5 }

Pictures are called by their content: what is drawn already is not drawn again, and what changes gets
another name. A task that is killed goes on from where it was. --status ends with 0 if all is done.";

/// Many pictures: inputs x parameters, on one machine or many
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// The batch file
    #[arg(value_name = "FILE", value_parser = path())]
    file: String,

    /// Do what is not done, on this machine
    #[arg(long, conflicts_with_all = ["task", "status", "script"])]
    run: bool,

    /// Tasks to do at a time [default: 1]
    #[arg(long, value_name = "N", requires = "run", value_parser = whole(1_usize, 4096))]
    jobs: Option<usize>,

    /// Do the task of this number, counted from 0
    #[arg(long, value_name = "I", conflicts_with_all = ["status", "script"])]
    task: Option<usize>,

    /// What is done, what is being done and where, what failed and why
    #[arg(long, conflicts_with = "script")]
    status: bool,

    /// Write a script that has the tasks done, to standard output
    #[arg(long, value_name = "KIND")]
    script: Option<Script>,

    /// Threads of each task [default: what the batch file says, else all cores]
    #[arg(long, value_name = "N", value_parser = whole(1_u32, 4096))]
    pub(super) threads: Option<u32>,

    /// One JSON object on standard output
    #[arg(long, conflicts_with_all = ["run", "task", "script"])]
    json: bool,
}

/// A batch whose pictures have the names of their content.
#[derive(Debug)]
pub(crate) struct Plan {
    pub(crate) tasks: Tasks,
    /// The name of each picture's content.
    pub(crate) digests: Vec<String>,
}

/// What is known of a task.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Progress {
    Done,
    Not(State),
}

impl Plan {
    /// Reads everything that the batch is of, so that what is wrong is known before any work.
    fn new(tasks: Tasks) -> Result<Self, Failure> {
        let mut contents = Contents::of(&tasks);
        let mut digests = Vec::with_capacity(tasks.pictures.len());
        let mut small = Vec::new();
        for picture in &tasks.pictures {
            let (digest, known) = contents.digest(&tasks, picture)?;
            digests.push(digest);
            small.push(Known::bytes(&known) <= MOST_CHECKED);
        }
        let mut wrong = check_values(&tasks, &small);
        if let Some(failure) = wrong.pop() {
            return Err(failure);
        }
        if tasks.records().is_dir() {
            contents.save()?;
        }
        Ok(Self { tasks, digests })
    }

    /// What is known of the task of this number.
    pub(crate) fn progress(&self, number: usize) -> Progress {
        let task = self.tasks.task(number);
        let digest = &self.digests[task.picture.number];
        let part = |share| self.tasks.share_file(digest, share).is_file();
        let is_done = self.tasks.picture_file(digest).is_file()
            || matches!(task.work, Work::Share(share) if part(share));
        if is_done {
            return Progress::Done;
        }
        Progress::Not(self.tasks.record(digest, task.work).state())
    }
}

/// Bytes of an input whose values are tried one by one before anything is drawn. Of larger ones only
/// the first picture is read.
const MOST_CHECKED: u64 = 1 << 20;

/// The most values that are tried.
const MOST_TRIED: usize = 4096;

/// Reads a picture for each value of each parameter, with the first values of the others.
fn check_values(tasks: &Tasks, small: &[bool]) -> Vec<Failure> {
    let first = &tasks.pictures[0].changes;
    let differs = |number: &usize| {
        let picture = &tasks.pictures[*number];
        let others = picture.changes.iter().zip(first).filter(|(a, b)| a != b).count();
        small[*number] && (tasks.zip || others == 1 && picture.frame == 0)
    };
    let tried: Vec<usize> = (0..tasks.pictures.len()).filter(differs).take(MOST_TRIED).collect();
    let read = |number: usize| -> Result<(), Failure> {
        let picture = &tasks.pictures[number];
        let (reading, _) = input::read(&tasks.render_args(picture)?.input)?;
        match reading.scene {
            Some(_) => Ok(()),
            None => Err(tasks.at_fault(picture, reading.diagnostics)),
        }
    };
    let failed: Vec<Option<Failure>> =
        tried.into_par_iter().map(|number| read(number).err()).collect();
    failed.into_iter().flatten().take(1).collect()
}

pub(crate) fn run(args: &Args, bounds: &BoundArgs) -> Result<(), Failure> {
    if args.file == "-" {
        return Err(Failure::usage("a batch is read again by every task: standard input is not")
            .with_help("write it to a file"));
    }
    let tasks = Tasks::open(&args.file)?;
    if let Some(number) = args.task {
        return task::run(&tasks, number, args.threads);
    }
    let plan = Plan::new(tasks)?;
    let program = Program::this();
    match args.script {
        Some(kind) => {
            plan.tasks.make_folders()?;
            write_index(&plan.tasks, &plan.digests)?;
            report::data(script(&plan.tasks, kind, &program).as_bytes())
        }
        None if args.run => local::run(&plan, args, bounds, &program),
        None if args.status => tell::status(&plan, args.json),
        None => tell::plan(&plan, args.json),
    }
}
