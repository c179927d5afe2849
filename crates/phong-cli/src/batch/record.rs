//! What is known about one task: a file of lines, one an event, that is also its lock.
//!
//! The lock is the system's, and ends with the process that holds it, however that ends: nobody is
//! kept out by the dead. Between machines it works where the folder's file system has locks: NFS,
//! Lustre mounted with `flock`, GPFS. Where it has none that is said, and two of the same task may
//! both do its work, which costs time and nothing else, since files are written whole.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use phong_scene::trouble;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::report;

/// How long a lock may be held by somebody who only looks.
const MOMENT: Duration = Duration::from_millis(20);

/// The record of one task.
#[derive(Debug)]
pub(crate) struct Record {
    path: PathBuf,
}

/// The record of a task that is worked on by this process.
#[derive(Debug)]
pub(crate) struct Held {
    file: File,
    path: PathBuf,
}

/// What a record says of a task that is not done.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum State {
    /// Nobody has begun it.
    Missing,
    /// It is being worked on.
    Running(Begun),
    /// It was stopped, and goes on from where it was.
    Interrupted(Begun),
    /// Its process ended without a word: killed, or its machine went down.
    Killed(Begun),
    /// It failed with this exit code, and what was said.
    Failed { begun: Begun, code: u8, error: String },
}

/// Who began to work on a task, and when.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Begun {
    pub(crate) host: String,
    pub(crate) process: u64,
    /// The job of a cluster's scheduler; empty: it was in none.
    pub(crate) job: String,
    /// Seconds since 1970.
    pub(crate) time: u64,
    /// How often it was begun so far.
    pub(crate) starts: usize,
}

impl Record {
    pub(crate) fn new(path: PathBuf) -> Self {
        Self { path }
    }

    /// Takes the task, and waits for whoever works on it.
    pub(crate) fn take(&self, number: usize) -> Result<Held, Failure> {
        let failed = |error: &io::Error| {
            Failure::System(format!("cannot write {}: {}", self.path.display(), trouble(error)))
        };
        let open = OpenOptions::new().read(true).append(true).create(true).open(&self.path);
        let mut file = open.map_err(|error| failed(&error))?;
        let mut locked = file.try_lock();
        for _ in 0..5 {
            if matches!(locked, Err(TryLockError::WouldBlock)) {
                std::thread::sleep(MOMENT);
                locked = file.try_lock();
            }
        }
        match locked {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let begun = begun(&read(&mut file));
                report::say(&format!("task {number} is being done {begun}; waiting for it"));
                file.lock().map_err(|error| failed(&error))?;
            }
            Err(TryLockError::Error(error)) => report::say(&format!(
                "warning: {} has no locks ({}): two of the same task may both do its work",
                self.path.parent().unwrap_or(Path::new(".")).display(),
                trouble(&error)
            )),
        }
        Ok(Held { file, path: self.path.clone() })
    }

    /// What is known about the task, if it is not done.
    pub(crate) fn state(&self) -> State {
        let Ok(mut file) = File::open(&self.path) else { return State::Missing };
        let is_locked = matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock));
        let lines = read(&mut file);
        let begun = begun(&lines);
        let Some(last) = lines.last() else { return State::Missing };
        if is_locked {
            return State::Running(begun);
        }
        match last["event"].as_str() {
            Some("failed") => State::Failed {
                begun,
                code: last["code"].as_u64().and_then(|code| code.try_into().ok()).unwrap_or(3),
                error: last["error"].as_str().unwrap_or_default().to_owned(),
            },
            Some("interrupted") => State::Interrupted(begun),
            // What was made is gone.
            Some("done") => State::Missing,
            _ => State::Killed(begun),
        }
    }

    /// How often the task was begun.
    pub(crate) fn starts(&self) -> usize {
        File::open(&self.path).map_or(0, |mut file| begun(&read(&mut file)).starts)
    }
}

impl Held {
    /// The work begins.
    pub(crate) fn start(&mut self, task: usize, goes_on: bool) -> Result<(), Failure> {
        self.add(&json!({
            "event": "start",
            "task": task,
            "goes_on": goes_on,
            "host": host(),
            "process": std::process::id(),
            "job": job(),
            "time": now(),
        }))
    }

    /// It is done.
    pub(crate) fn done(&mut self, seconds: f64) -> Result<(), Failure> {
        self.add(&json!({ "event": "done", "seconds": seconds, "time": now() }))
    }

    /// It ended in another way.
    pub(crate) fn ended(&mut self, failure: &Failure, error: &str) -> Result<(), Failure> {
        let event = match failure {
            Failure::Interrupted(_) => "interrupted",
            _ => "failed",
        };
        let code = failure.code();
        self.add(&json!({ "event": event, "code": code, "error": error, "time": now() }))
    }

    fn add(&mut self, line: &Value) -> Result<(), Failure> {
        // A line that a killed process has left half-written must not take ours with it.
        let ends = self.ends_a_line().unwrap_or(true);
        let text = format!("{}{line}\n", if ends { "" } else { "\n" });
        self.file.write_all(text.as_bytes()).map_err(|error| {
            Failure::System(format!("cannot write {}: {}", self.path.display(), trouble(&error)))
        })
    }

    fn ends_a_line(&mut self) -> io::Result<bool> {
        if self.file.metadata()?.len() == 0 {
            return Ok(true);
        }
        let mut last = [0];
        self.file.seek(SeekFrom::End(-1))?;
        self.file.read_exact(&mut last)?;
        Ok(last == *b"\n")
    }
}

/// The lines of a record that are whole.
fn read(file: &mut File) -> Vec<Value> {
    let mut bytes = Vec::new();
    let _ = file.seek(SeekFrom::Start(0)).and_then(|_| file.read_to_end(&mut bytes));
    let text = String::from_utf8_lossy(&bytes);
    text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect()
}

/// Who began last.
fn begun(lines: &[Value]) -> Begun {
    let starts = || lines.iter().filter(|line| line["event"] == "start");
    let Some(last) = starts().next_back() else { return Begun::default() };
    let text = |key: &str| last[key].as_str().unwrap_or_default().to_owned();
    Begun {
        host: text("host"),
        process: last["process"].as_u64().unwrap_or(0),
        job: text("job"),
        time: last["time"].as_u64().unwrap_or(0),
        starts: starts().count(),
    }
}

impl std::fmt::Display for Begun {
    /// `on node7 (process 123, job 45_6), begun 2 min ago`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { host, process, job, time, .. } = self;
        write!(f, "on {host} (process {process}")?;
        if !job.is_empty() {
            write!(f, ", job {job}")?;
        }
        write!(f, "), begun {} ago", duration(now().saturating_sub(*time)))
    }
}

/// Seconds for people.
fn duration(seconds: u64) -> String {
    match seconds {
        0..120 => format!("{seconds} s"),
        120..7200 => format!("{} min", seconds / 60),
        7200..172_800 => format!("{} h", seconds / 3600),
        _ => format!("{} days", seconds / 86_400),
    }
}

fn now() -> u64 {
    SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default().as_secs()
}

/// What this machine is called.
fn host() -> String {
    #[cfg(unix)]
    let name = rustix::system::uname().nodename().to_string_lossy().into_owned();
    #[cfg(not(unix))]
    let name = std::env::var("COMPUTERNAME").unwrap_or_default();
    name
}

/// The job that this process is part of, as Slurm calls it.
fn job() -> String {
    let said = |name: &str| std::env::var(name).ok();
    match (said("SLURM_ARRAY_JOB_ID"), said("SLURM_ARRAY_TASK_ID")) {
        (Some(array), Some(task)) => format!("{array}_{task}"),
        _ => said("SLURM_JOB_ID").unwrap_or_default(),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn record() -> (tempfile::TempDir, Record) {
        let folder = tempfile::tempdir().expect("a folder");
        let record = Record::new(folder.path().join("a.jsonl"));
        (folder, record)
    }

    #[test]
    fn a_record_tells_what_became_of_its_task() {
        let (_folder, record) = record();
        assert_eq!((record.state(), record.starts()), (State::Missing, 0));
        let mut held = record.take(3).expect("it is free");
        held.start(3, false).expect("written");
        assert!(matches!(record.state(), State::Running(begun) if begun.starts == 1));
        drop(held);
        assert!(matches!(record.state(), State::Killed(_)));
        let mut held = record.take(3).expect("the dead hold nothing");
        held.start(3, true).expect("written");
        held.ended(&Failure::Interrupted(15), "").expect("written");
        drop(held);
        assert!(matches!(record.state(), State::Interrupted(begun) if begun.starts == 2));
        let mut held = record.take(3).expect("it is free");
        held.start(3, true).expect("written");
        held.ended(&Failure::System("full".to_owned()), "error: full").expect("written");
        drop(held);
        let State::Failed { code, error, begun } = record.state() else { panic!("it failed") };
        assert_eq!((code, error.as_str(), begun.starts), (3, "error: full", 3));
        fs::remove_file(&record.path).expect("it is there");
        assert_eq!(record.state(), State::Missing);
    }

    #[test]
    fn a_line_that_was_cut_short_takes_no_other_with_it() {
        let (_folder, record) = record();
        fs::write(&record.path, "{\"event\": \"start\"}\n{\"event\": \"do").expect("written");
        let mut held = record.take(0).expect("it is free");
        held.start(0, true).expect("written");
        drop(held);
        assert_eq!(record.starts(), 2);
    }

    #[test]
    fn of_two_that_want_a_task_the_second_waits_until_the_first_has_ended() {
        let (_folder, record) = record();
        let mut first = record.take(0).expect("it is free");
        first.start(0, false).expect("written");
        std::thread::scope(|scope| {
            let second = scope.spawn(|| record.take(0).map(|_| SystemTime::now()));
            std::thread::sleep(Duration::from_millis(300));
            let ended = SystemTime::now();
            drop(first);
            let taken = second.join().expect("no panic").expect("taken");
            assert!(taken >= ended);
        });
    }
}
