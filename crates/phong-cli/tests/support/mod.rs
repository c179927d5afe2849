//! A folder to run `phong` in, and what came of it.
#![allow(clippy::unwrap_used, dead_code, reason = "tests; none of them needs all of it")]

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

/// A scene that takes a moment: one ball over a floor, and a mirror.
pub(crate) const BALLS: &str = r#"
version = 1
[image]
size = [40, 30]
samples = 4
[camera]
eye = [0, 1, 5]
look_at = [0, 0.7, 0]
[[light]]
kind = "point"
position = [3, 4, 5]
[materials.mirror]
reflection = 0.5
[[sphere]]
center = [0, 1, 0]
radius = 1
material = "mirror"
[[plane]]
point = [0, 0, 0]
normal = [0, 1, 0]
"#;

/// A folder with files.
pub(crate) struct Given {
    folder: TempDir,
}

/// What `phong` did.
pub(crate) struct Then {
    pub(crate) code: Option<i32>,
    pub(crate) out: Vec<u8>,
    pub(crate) err: String,
}

pub(crate) fn given(files: &[(&str, &str)]) -> Given {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    Given { folder }
}

impl Given {
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// `phong` with these words, in this folder, ready to run.
    pub(crate) fn command(&self, words: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_phong"));
        command.current_dir(self.folder.path()).args(words.split_whitespace());
        command
    }

    pub(crate) fn when(&self, words: &str) -> Then {
        Then::of(self.command(words).stdin(Stdio::null()).output().unwrap())
    }

    /// Runs `phong` and wants it to succeed.
    pub(crate) fn done(&self, words: &str) -> Then {
        let then = self.when(words);
        assert_eq!(then.code, Some(0), "{words}: {}", then.err);
        then
    }

    pub(crate) fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// The names of all files there are, hidden ones included.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).unwrap();
        let name = |entry: fs::DirEntry| entry.file_name().into_string().unwrap();
        let mut names: Vec<_> = entries.map(|entry| name(entry.unwrap())).collect();
        names.sort();
        names
    }
}

impl Then {
    pub(crate) fn of(output: Output) -> Self {
        let err = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!err.contains("panicked"), "{err}");
        Self { code: output.status.code(), out: output.stdout, err }
    }

    /// The input or the command line is at fault, and these words say so.
    pub(crate) fn is_refused(&self, words: &[&str]) {
        assert_eq!(self.code, Some(2), "{}", self.err);
        for word in words {
            assert!(self.err.contains(word), "`{word}` is not in:\n{}", self.err);
        }
    }

    pub(crate) fn json(&self) -> serde_json::Value {
        serde_json::from_slice(&self.out).unwrap()
    }
}
