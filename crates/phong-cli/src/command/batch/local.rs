//! A batch's tasks done on this machine, each in a process of its own: one that is killed or runs out
//! of memory takes no other with it.

use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::Duration;

use super::{Args, Plan, Progress};
use crate::args::BoundArgs;
use crate::batch::{Program, State, write_index};
use crate::failure::Failure;
use crate::{interrupt, report};

/// How often the processes are looked at.
const INTERVAL: Duration = Duration::from_millis(10);

/// Does what is not done.
pub(crate) fn run(
    plan: &Plan,
    args: &Args,
    bounds: &BoundArgs,
    program: &Program,
) -> Result<(), Failure> {
    let tasks = &plan.tasks;
    tasks.make_folders()?;
    write_index(tasks, &plan.digests)?;
    let jobs = args.jobs.unwrap_or(1);
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let threads = args.threads.or(tasks.threads).map_or(cores.div_ceil(jobs), |n| n as usize);
    let command = |number: usize| {
        let mut command = Command::new(&program.0[0]);
        command.args(&program.0[1..]).args(["batch", &args.file]);
        command.args(["--task", &number.to_string(), "--threads", &threads.to_string()]);
        if let Some(bytes) = bounds.max_memory {
            command.args(["--max-memory", &bytes.to_string()]);
        }
        if let Some(folder) = &bounds.jail {
            command.arg("--jail").arg(folder);
        }
        command.stdin(Stdio::null()).stdout(Stdio::null());
        command
    };
    let mut failed = 0;
    for round in [0..tasks.first_round(), tasks.first_round()..tasks.len()] {
        // What somebody else works on comes last: it may be done by then.
        let open =
            |number: &usize| plan.progress(*number) != Progress::Done || is_unnamed(plan, *number);
        let (elsewhere, here): (Vec<_>, Vec<_>) = round
            .filter(open)
            .partition(|&number| matches!(plan.progress(number), Progress::Not(State::Running(_))));
        let numbers: Vec<usize> = here.into_iter().chain(elsewhere).collect();
        failed += interrupt::heeding(|cancel| -> Result<usize, Failure> {
            let mut queue = numbers.iter().copied();
            let mut running: Vec<(usize, Child)> = Vec::new();
            let (mut done, mut failed) = (0, 0);
            loop {
                if cancel.is_cancelled() {
                    end(running);
                    return Err(interrupt::failure());
                }
                while running.len() < jobs
                    && let Some(number) = queue.next()
                {
                    let child = command(number).spawn().map_err(|error| {
                        let why = phong_scene::trouble(&error);
                        Failure::System(format!("cannot start {}: {why}", program.0[0]))
                    });
                    match child {
                        Ok(child) => running.push((number, child)),
                        Err(failure) => {
                            end(running);
                            return Err(failure);
                        }
                    }
                }
                if running.is_empty() {
                    return Ok(failed);
                }
                thread::sleep(INTERVAL);
                running.retain_mut(|(number, child)| {
                    let Ok(None) = child.try_wait() else {
                        done += 1;
                        let succeeded = child.wait().is_ok_and(|status| status.success());
                        failed += usize::from(!succeeded);
                        tell(plan, *number, succeeded, done, numbers.len());
                        return false;
                    };
                    true
                });
            }
        })?;
        if failed > 0 {
            let file = &args.file;
            let what = if failed == 1 { "task has" } else { "tasks have" };
            let help = format!("`phong batch {file} --status` says why");
            return Err(Failure::System(format!("{failed} {what} failed; {help}")));
        }
    }
    Ok(())
}

/// Whether a picture that is there has not the name yet that this batch gives it.
fn is_unnamed(plan: &Plan, number: usize) -> bool {
    let task = plan.tasks.task(number);
    let is_picture = number >= plan.tasks.first_round() || plan.tasks.shares == 1;
    let name = plan.tasks.output.join(&task.picture.name);
    let file = plan.tasks.picture_file(&plan.digests[task.picture.number]);
    let same = std::fs::canonicalize(name).ok() == std::fs::canonicalize(file).ok();
    is_picture && !same
}

/// A line about a task that has ended.
fn tell(plan: &Plan, number: usize, succeeded: bool, done: usize, of: usize) {
    if report::is_watched() {
        let name = &plan.tasks.task(number).picture.name;
        let what = if succeeded { "done" } else { "FAILED" };
        report::say(&format!("{done} of {of}: task {number} ({name}) {what}"));
    }
}

/// Ends processes in order, so that each keeps what it has done, and waits for them.
fn end(running: Vec<(usize, Child)>) {
    for (_, child) in &running {
        #[cfg(unix)]
        if let Some(process) = rustix::process::Pid::from_raw(child.id() as i32) {
            let _ = rustix::process::kill_process(process, rustix::process::Signal::TERM);
        }
        #[cfg(not(unix))]
        let _ = child;
    }
    for (_, mut child) in running {
        #[cfg(not(unix))]
        let _ = child.kill();
        let _ = child.wait();
    }
}
