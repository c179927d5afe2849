//! One task: taken, done, and what became of it written down.

use std::fs;
use std::path::PathBuf;
use std::time::Instant;

use crate::args::RenderArgs;
use crate::batch::{Contents, Held, Known, Task, Tasks, Work, link};
use crate::command::{merge, render};
use crate::failure::Failure;
use crate::{checkpoint, report, threads};

/// Does the task of this number, unless it is done; waits for whoever works on it. `threads` is what
/// the command line says, and what this runs on.
pub(crate) fn run(tasks: &Tasks, number: usize, threads: Option<u32>) -> Result<(), Failure> {
    if number >= tasks.len() {
        let last = tasks.len() - 1;
        return Err(Failure::usage(format!("there is no task {number}: the last one is {last}")));
    }
    let task = tasks.task(number);
    // What is wrong is told here, but it is of this batch, and known to the plan as well.
    let (digest, known) = Contents::of(tasks).digest(tasks, task.picture)?;
    tasks.make_folders()?;
    if !is_done(tasks, task, &digest) {
        let mut held = tasks.record(&digest, task.work).take(number)?;
        // Somebody else may have done it meanwhile.
        if !is_done(tasks, task, &digest) {
            let mut work = || work(tasks, task, &digest, &known, &mut held);
            let done = match (threads, tasks.threads) {
                (None, Some(threads)) => threads::on(Some(threads), true, work),
                // Those there are already.
                _ => work(),
            };
            if let Err(failure) = done {
                held.ended(&failure, report::plain(&failure).trim_end())?;
                return Err(failure);
            }
        }
    }
    // It stays where a task was killed just before it would have gone.
    let _ = fs::remove_file(checkpoint::path(&file(tasks, task, &digest)));
    match task.work {
        Work::Share(_) => Ok(()),
        Work::Whole | Work::Merge => link(tasks, task.picture, &digest),
    }
}

fn is_done(tasks: &Tasks, task: Task<'_>, digest: &str) -> bool {
    let part = |share| tasks.share_file(digest, share).is_file();
    // A share of a picture that is there is needed no more.
    tasks.picture_file(digest).is_file() || matches!(task.work, Work::Share(share) if part(share))
}

/// What a task writes.
fn file(tasks: &Tasks, task: Task<'_>, digest: &str) -> PathBuf {
    match task.work {
        Work::Share(share) => tasks.share_file(digest, share),
        Work::Whole | Work::Merge => tasks.picture_file(digest),
    }
}

fn work(
    tasks: &Tasks,
    task: Task<'_>,
    digest: &str,
    known: &Known,
    held: &mut Held,
) -> Result<(), Failure> {
    let started = Instant::now();
    let output = file(tasks, task, digest);
    let mut args = tasks.render_args(task.picture)?;
    if task.work == Work::Merge {
        held.start(task.number, false)?;
        merge_shares(tasks, task, digest, &args)?;
    } else {
        held.start(task.number, checkpoint::path(&output).is_file())?;
        args.output = Some(output.clone());
        args.work.resume = true;
        args.work.replace = true;
        args.work.quiet = true;
        args.work.tile = match task.work {
            Work::Share(share) => Some(share),
            Work::Whole | Work::Merge => None,
        };
        render::run(&args)?;
    }
    if !known.holds() {
        // Its name says another content.
        let _ = fs::remove_file(&output);
        let message = format!("{} changed while it was drawn", task.picture.input);
        return Err(Failure::System(format!("{message}; do the task again")));
    }
    held.done(started.elapsed().as_secs_f64())
}

/// Puts a picture together of its shares, which are needed no more then.
fn merge_shares(
    tasks: &Tasks,
    task: Task<'_>,
    digest: &str,
    args: &RenderArgs,
) -> Result<(), Failure> {
    let mut parts = Vec::new();
    let mut lacking = Vec::new();
    for number in tasks.shares_of(task.picture) {
        let Work::Share(share) = tasks.task(number).work else { continue };
        let part = tasks.share_file(digest, share);
        if !part.is_file() {
            lacking.push(number.to_string());
        }
        parts.push(part);
    }
    if !lacking.is_empty() {
        let (numbers, of) = (lacking.join(", "), task.picture.number);
        return Err(Failure::System(format!(
            "shares of picture {of} are lacking: tasks {numbers}"
        )));
    }
    let output = tasks.picture_file(digest);
    let (encoding, tone) = (args.encoding.clone(), args.tone.clone());
    merge::run(&merge::Args { parts: parts.clone(), output, encoding, tone })?;
    for part in parts {
        // One that cannot be removed takes room and does no harm; nor does its checkpoint, which a killed
        // task may have left.
        let _ = fs::remove_file(checkpoint::path(&part));
        let _ = fs::remove_file(part);
    }
    Ok(())
}
