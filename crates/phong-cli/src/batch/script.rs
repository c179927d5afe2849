//! Scripts that have a batch's tasks done: by Slurm, by GNU parallel, by make.

use std::env;
use std::fmt::Write as _;
use std::path::{Path, absolute};

use clap::ValueEnum;

use super::Tasks;

/// Who does the tasks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Script {
    /// A job array of Slurm
    Slurm,
    /// GNU parallel
    #[value(alias = "parallel")]
    GnuParallel,
    /// A makefile
    Make,
}

/// The longest array that Slurm takes where nobody has set another limit, less one.
const LONGEST_ARRAY: usize = 1000;

/// How this very program is started: its words.
#[derive(Clone, Debug)]
pub(crate) struct Program(pub(crate) Vec<String>);

impl Program {
    /// This program, or the Python module that it is part of.
    pub(crate) fn this() -> Self {
        let path = env::current_exe().unwrap_or_else(|_| "phong".into());
        let is_python = path
            .file_name()
            .is_some_and(|name| name.to_string_lossy().to_lowercase().starts_with("python"));
        let mut words = vec![path.to_string_lossy().into_owned()];
        if is_python {
            words.extend(["-m".to_owned(), "phong".to_owned()]);
        }
        Self(words)
    }
}

/// The script that has the tasks done.
pub(crate) fn script(tasks: &Tasks, kind: Script, program: &Program) -> String {
    let words: Vec<String> = program.0.iter().map(|word| quoted(word)).collect();
    let file = quoted(&full(&tasks.file));
    let mut text = match kind {
        Script::Make => String::new(),
        Script::Slurm | Script::GnuParallel => "#!/bin/bash\n".to_owned(),
    };
    let what = match tasks.shares {
        1 => format!("{} pictures", tasks.pictures.len()),
        shares => format!("{} pictures of {shares} shares each", tasks.pictures.len()),
    };
    // The name of a file may hold a line break.
    let name = full(&tasks.file).replace(char::is_control, " ");
    let _ = writeln!(text, "# {what}, as {name} says. A task that is done is not done again.");
    match kind {
        Script::Slurm => slurm(tasks, &words.join(" "), &file, &mut text),
        Script::GnuParallel => parallel(tasks, &words.join(" "), &file, &mut text),
        Script::Make => make(tasks, &words.join(" "), &file, &mut text),
    }
    text
}

fn slurm(tasks: &Tasks, program: &str, file: &str, text: &mut String) {
    let (first, all) = (tasks.first_round(), tasks.len());
    let (length, merges) = (first.min(LONGEST_ARRAY), (all - first).min(LONGEST_ARRAY));
    let said = |name: &str| tasks.slurm.iter().any(|(option, _)| option == name);
    let job = tasks.file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let log = full(&tasks.records().join("slurm-%A_%a.txt"));
    let threads = tasks.threads.unwrap_or(1).to_string();
    let ours = [
        ("job-name", job.as_str()),
        ("output", &log),
        ("open-mode", "append"),
        ("cpus-per-task", &threads),
        // A minute before its time is up a task is told, and keeps what it has done.
        ("signal", "TERM@60"),
        ("requeue", ""),
    ];
    text.push_str("# Hand it in with `bash`: then it does that itself. Again after a time limit: tasks go on.\n");
    let theirs = tasks.slurm.iter().map(|(name, value)| (name.as_str(), value.as_str()));
    let ours = ours.into_iter().filter(|(name, _)| !said(name));
    for (name, value) in ours.chain(theirs) {
        let _ = match value {
            "" => writeln!(text, "#SBATCH --{name}"),
            value => writeln!(text, "#SBATCH --{name}={}", option(value)),
        };
    }
    let _ = writeln!(text, "#SBATCH --array=0-{}\nset -u", length - 1);
    let _ = writeln!(text, "\nif [ -z \"${{SLURM_JOB_ID:-}}\" ]; then");
    if all == first {
        text.push_str("    exec sbatch \"$@\" \"$0\"\n");
    } else {
        let _ = writeln!(text, "    shares=$(sbatch --parsable \"$@\" \"$0\") || exit");
        let _ = writeln!(
            text,
            "    exec sbatch --dependency=\"afterok:${{shares%%;*}}\" --kill-on-invalid-dep=yes \\"
        );
        let _ =
            writeln!(text, "        --array=0-{} \"$@\" \"$0\" {first} {all} {merges}", merges - 1);
    }
    let _ = writeln!(text, "fi\n");
    let _ =
        writeln!(text, "# The first task, the one behind the last, and how many jobs share them.");
    let _ = writeln!(text, "first=${{1:-0}} end=${{2:-{first}}} jobs=${{3:-{length}}}");
    let _ = writeln!(text, "threads=${{SLURM_CPUS_PER_TASK:-1}}\ncode=0");
    let _ =
        writeln!(text, "for ((task = first + SLURM_ARRAY_TASK_ID; task < end; task += jobs)); do");
    let _ = writeln!(text, "    srun --ntasks=1 --cpus-per-task=\"$threads\" \\");
    let _ = writeln!(
        text,
        "        {program} batch {file} --task \"$task\" --threads \"$threads\" || code=$?"
    );
    let _ = writeln!(text, "    [ \"$code\" -lt 128 ] || break # told to end, or killed\ndone");
    let _ = writeln!(text, "exit \"$code\"");
}

fn parallel(tasks: &Tasks, program: &str, file: &str, text: &mut String) {
    let (first, all) = (tasks.first_round(), tasks.len());
    let threads = tasks.threads.unwrap_or(1);
    text.push_str("# Options for parallel may follow its name, such as --jobs 4 or --sshloginfile nodes.\nset -eu\n");
    let _ = writeln!(text, "threads={threads} cores=$(nproc)");
    let _ = writeln!(text, "jobs=$((cores > threads ? cores / threads : 1))");
    let _ = writeln!(
        text,
        "tasks() {{ # tasks FIRST LAST [OPTION...]\n    local first=$1 last=$2\n    shift 2"
    );
    let _ = writeln!(
        text,
        "    seq \"$first\" \"$last\" | parallel --quote --jobs \"$jobs\" \"$@\" \\"
    );
    let _ = writeln!(text, "        {program} batch {file} --task {{}} --threads \"$threads\"\n}}");
    let _ = writeln!(text, "tasks 0 {} \"$@\"", first - 1);
    if all > first {
        let _ = writeln!(text, "tasks {first} {} \"$@\"", all - 1);
    }
}

fn make(tasks: &Tasks, program: &str, file: &str, text: &mut String) {
    let recipe = |text: &str| text.replace('$', "$$");
    let threads = tasks.threads.unwrap_or(1);
    text.push_str("# make --jobs=4 --keep-going -f THIS\n");
    let last = if tasks.len() == tasks.first_round() { 0 } else { tasks.first_round() };
    text.push_str("all:");
    (last..tasks.len()).for_each(|task| {
        let _ = write!(text, " task-{task}");
    });
    let _ = writeln!(text, "\n.PHONY: all FORCE\nFORCE:");
    let _ = writeln!(text, "task-%: FORCE");
    let _ = writeln!(
        text,
        "\t@{} batch {} --task $* --threads {threads}",
        recipe(program),
        recipe(file)
    );
    if last > 0 {
        for picture in &tasks.pictures {
            let _ = write!(text, "task-{}:", last + picture.number);
            tasks.shares_of(picture).for_each(|share| {
                let _ = write!(text, " task-{share}");
            });
            text.push('\n');
        }
    }
}

/// A path from the root on, so that a job finds it wherever it begins.
fn full(path: &Path) -> String {
    absolute(path).unwrap_or_else(|_| path.to_owned()).to_string_lossy().into_owned()
}

/// A word for the shell.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._-+=:@%".contains(c);
    match word {
        "" => "''".to_owned(),
        word if word.chars().all(plain) => word.to_owned(),
        word => format!("'{}'", word.replace('\'', r"'\''")),
    }
}

/// A value in an `#SBATCH` line, which has quotation marks of its own.
fn option(value: &str) -> String {
    let value = value.replace(char::is_control, " ");
    if value.contains([' ', '#']) { format!("\"{}\"", value.replace('"', "")) } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_for_the_shell_are_one_word() {
        assert_eq!(quoted("/usr/bin/phong"), "/usr/bin/phong");
        assert_eq!(quoted("/it's $HOME"), r"'/it'\''s $HOME'");
        assert_eq!(quoted(""), "''");
        assert_eq!(option("a b"), "\"a b\"");
    }
}
