//! What there is to do, and what has become of it, for people and for programs.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::{Plan, Progress};
use crate::batch::{State, Task, Work, parameters};
use crate::failure::Failure;
use crate::report;

/// `phong batch FILE`: what there is to do.
pub(crate) fn plan(plan: &Plan, wants_json: bool) -> Result<(), Failure> {
    let all = progress(plan);
    if wants_json {
        return report::json(&json(plan, &all));
    }
    let tasks = &plan.tasks;
    let mut text = format!("{}\n", product(plan));
    let _ = writeln!(text, "to {}, by `--run` or what `--script` writes\n", tasks.output.display());
    let mut head = vec!["task".to_owned(), "state".to_owned(), "picture".to_owned()];
    head.extend(tasks.parameters.iter().map(|(path, _)| path.text.clone()));
    let mut rows = vec![head];
    for (task, progress) in tasks.iter().zip(&all) {
        let mut row = vec![task.number.to_string(), word(progress).to_owned(), what(task)];
        row.extend(task.picture.changes.iter().map(|change| change.value().to_owned()));
        rows.push(row);
    }
    text += &table(&rows);
    report::data(text.as_bytes())
}

/// `phong batch FILE --status`: how far it is. The answer is "no" until all is done.
pub(crate) fn status(plan: &Plan, wants_json: bool) -> Result<(), Failure> {
    let all = progress(plan);
    let open = all.iter().filter(|progress| **progress != Progress::Done).count();
    let answer = if open == 0 { Ok(()) } else { Err(Failure::No) };
    if wants_json {
        report::json(&json(plan, &all))?;
        return answer;
    }
    let words = ["done", "running", "failed", "interrupted", "killed", "missing"];
    let count = |wanted: &&str| all.iter().filter(|progress| word(progress) == *wanted).count();
    let counts: Vec<String> = words
        .iter()
        .map(|word| (count(word), word))
        .filter(|(count, _)| *count > 0)
        .map(|(count, word)| format!("{count} {word}"))
        .collect();
    let mut text = format!("{}\n{}\n", product(plan), counts.join(", "));
    for (task, progress) in plan.tasks.iter().zip(&all) {
        let Progress::Not(state) = progress else { continue };
        let said = match state {
            State::Missing => continue,
            State::Running(begun) | State::Interrupted(begun) | State::Killed(begun) => {
                begun.to_string()
            }
            State::Failed { begun, code, error } => {
                let why = error.lines().next().unwrap_or_default();
                format!("with {code} {begun}: {why}")
            }
        };
        let _ = writeln!(text, "task {} ({}) {} {said}", task.number, what(task), word(progress));
    }
    report::data(text.as_bytes())?;
    answer
}

fn progress(plan: &Plan) -> Vec<Progress> {
    (0..plan.tasks.len()).map(|number| plan.progress(number)).collect()
}

/// `12 pictures: 2 inputs × 3 materials.red.shininess × 2 camera.eye, of 4 shares each: 60 tasks`.
fn product(plan: &Plan) -> String {
    let tasks = &plan.tasks;
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let mut factors = vec![count(tasks.inputs, "input")];
    factors.extend(tasks.parameters.iter().map(|(path, values)| format!("{values} {}", path.text)));
    let sign = if tasks.zip { " in step with " } else { " × " };
    let pictures = count(tasks.pictures.len(), "picture");
    let tasks_ = count(tasks.len(), "task");
    match tasks.shares {
        1 => format!("{pictures}: {}", factors.join(sign)),
        shares => format!("{pictures}: {}; of {shares} shares each, {tasks_}", factors.join(sign)),
    }
}

fn word(progress: &Progress) -> &'static str {
    match progress {
        Progress::Done => "done",
        Progress::Not(State::Missing) => "missing",
        Progress::Not(State::Running(_)) => "running",
        Progress::Not(State::Interrupted(_)) => "interrupted",
        Progress::Not(State::Killed(_)) => "killed",
        Progress::Not(State::Failed { .. }) => "failed",
    }
}

/// What a task makes.
fn what(task: Task<'_>) -> String {
    let name = &task.picture.name;
    match task.work {
        Work::Whole => name.clone(),
        Work::Share(share) => format!("{name}, share {}/{}", share.index, share.count),
        Work::Merge => format!("{name}, of its shares"),
    }
}

/// Rows whose columns stand under one another; the last is not filled up.
fn table(rows: &[Vec<String>]) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let widest = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let widths: Vec<usize> = (0..columns).map(|column| widest(column).unwrap_or(0)).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:width$}"));
        format!("{}\n", cells.collect::<Vec<_>>().join("  ").trim_end())
    };
    rows.iter().map(line).collect()
}

fn json(plan: &Plan, all: &[Progress]) -> Value {
    let tasks = &plan.tasks;
    let task = |(task, progress): (Task<'_>, &Progress)| {
        let digest = &plan.digests[task.picture.number];
        let file = match task.work {
            Work::Share(share) => tasks.share_file(digest, share),
            Work::Whole | Work::Merge => tasks.picture_file(digest),
        };
        let mut told = json!({
            "task": task.number,
            "state": word(progress),
            "picture": task.picture.name,
            "input": task.picture.input,
            "parameters": parameters(task.picture),
            "file": file.to_string_lossy(),
            "starts": tasks.record(digest, task.work).starts(),
        });
        if let Work::Share(share) = task.work {
            told["share"] = json!([share.index, share.count]);
        }
        if let Progress::Not(
            State::Running(begun)
            | State::Interrupted(begun)
            | State::Killed(begun)
            | State::Failed { begun, .. },
        ) = progress
        {
            told["host"] = json!(begun.host);
            told["process"] = json!(begun.process);
            told["job"] = json!(begun.job);
            told["since"] = json!(begun.time);
        }
        if let Progress::Not(State::Failed { code, error, .. }) = progress {
            told["code"] = json!(code);
            told["error"] = json!(error);
        }
        told
    };
    let count = |wanted: &str| all.iter().filter(|progress| word(progress) == wanted).count();
    json!({
        "output": tasks.output.to_string_lossy(),
        "pictures": tasks.pictures.len(),
        "shares": tasks.shares,
        "done": count("done"),
        "running": count("running"),
        "failed": count("failed"),
        "interrupted": count("interrupted"),
        "killed": count("killed"),
        "missing": count("missing"),
        "tasks": tasks.iter().zip(all).map(task).collect::<Vec<_>>(),
    })
}
