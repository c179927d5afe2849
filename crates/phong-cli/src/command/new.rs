//! `phong new`: a first scene.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use phong_scene::trouble;

use crate::failure::Failure;
use crate::report;

const EXAMPLES: &str = "\
Examples:
  phong new                      scene.toml: a red ball on a floor, under a lamp
  phong new ball                 ball.toml
  phong render ball.toml         its picture, ball.png";

/// What is written: also the first scene of the README and of the book.
const SCENE: &str = include_str!("new.toml");

/// A first scene to change and to draw; never written over a file that is there
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// The file to write; `.toml` is added where it is missing
    #[arg(default_value = "scene")]
    name: PathBuf,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let path = file_of(&args.name)?;
    create(&path).map_err(|error| refused(&path, &error))?;
    report::say(&format!("{}: a first scene; `phong render {0}` draws it", path.display()));
    Ok(())
}

/// The file that a name stands for.
fn file_of(name: &Path) -> Result<PathBuf, Failure> {
    let Some(file) = name.file_name() else {
        return Err(Failure::usage(format!("{} names no file", name.display()))
            .with_help("give a name, like `phong new ball`"));
    };
    if name.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
        return Ok(name.to_owned());
    }
    let mut file = file.to_owned();
    file.push(".toml");
    Ok(name.with_file_name(file))
}

/// Writes the scene, whole or not at all, under a name that nothing has.
fn create(path: &Path) -> io::Result<()> {
    let mut file = File::options().write(true).create_new(true).open(path)?;
    let written = file.write_all(SCENE.as_bytes()).and_then(|()| file.sync_all());
    if written.is_err() {
        // The file is this process's own: it was not there before.
        let _ = std::fs::remove_file(path);
    }
    written
}

fn refused(path: &Path, error: &io::Error) -> Failure {
    match error.kind() {
        io::ErrorKind::AlreadyExists => Failure::usage(format!("{} exists", path.display()))
            .with_help("give another name; nothing is written over"),
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => {
            Failure::usage(format!("there is no folder for {}", path.display()))
                .with_help("make the folder first")
        }
        io::ErrorKind::PermissionDenied => {
            Failure::usage(format!("{}: {}", path.display(), trouble(error)))
                .with_help("give a name in a folder where you may write")
        }
        _ => Failure::System(format!("cannot write {}: {}", path.display(), trouble(error))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_scene_has_twelve_lines_and_nothing_to_complain_about() {
        assert_eq!(SCENE.lines().count(), 12);
        let files = phong_scene::Memory::new().with("new.toml", SCENE.as_bytes());
        let reading = phong_scene::read("new.toml", None, &files, &phong_scene::Limits::default());
        assert_eq!(reading.diagnostics, []);
        assert!(reading.scene.is_some());
    }

    #[test]
    fn the_readme_and_the_book_show_the_scene_that_is_written() {
        let pages = [
            include_str!("../../../../README.md"),
            include_str!("../../../../book/src/equation.md"),
        ];
        for page in pages {
            assert!(page.contains(&format!("```toml\n{SCENE}```\n")));
        }
    }

    #[test]
    fn a_name_gets_its_ending_once() {
        let file = |name: &str| file_of(Path::new(name)).map(|path| path.display().to_string());
        assert_eq!(file("a").ok().as_deref(), Some("a.toml"));
        assert_eq!(file("b/a.TOML").ok().as_deref(), Some("b/a.TOML"));
        assert_eq!(file("v1.2").ok().as_deref(), Some("v1.2.toml"));
        assert!(file("..").is_err());
    }
}
