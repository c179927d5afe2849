//! `OUT.part`, kept while a picture is rendered, so that a later run goes on from it.

use std::fs::{self, File};
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use phong::film::Film;
use phong::part::{self, Part, Settings};
use phong_scene::trouble;

use crate::failure::Failure;
use crate::output::Output;

/// The shortest time between two checkpoints; writing them takes a twentieth of the time at most.
const PAUSE: Duration = Duration::from_secs(1);

/// The checkpoint of one picture.
#[derive(Debug)]
pub(crate) struct Checkpoint {
    path: PathBuf,
    settings: Settings,
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    due: Instant,
    /// What went wrong with writing it; it is not tried again.
    trouble: Option<String>,
}

impl Checkpoint {
    /// The checkpoint of a picture that is to be written to `output`.
    pub(crate) fn beside(output: &Path, settings: Settings) -> Self {
        let mut path = output.as_os_str().to_owned();
        path.push(".part");
        let state = State { due: Instant::now() + PAUSE, trouble: None };
        Self { path: path.into(), settings, state: Mutex::new(state) }
    }

    /// What an earlier run has done of this very picture; `None` if there is no checkpoint.
    pub(crate) fn film(&self) -> Result<Option<Film>, Failure> {
        let file = match File::open(&self.path) {
            Ok(file) => file,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(self.unusable(&trouble(&error))),
        };
        let part = Part::read(&mut BufReader::new(file), self.settings.film_bytes())
            .map_err(|error| self.unusable(&error.to_string()))?;
        match self.settings.difference(&part.settings) {
            Some((what, here, there)) => {
                Err(self
                    .unusable(&format!("it is of another picture: {what} is {there}, not {here}")))
            }
            None if part.settings.share != self.settings.share => {
                Err(self.unusable("it is of another share"))
            }
            None => Ok(Some(part.film)),
        }
    }

    fn unusable(&self, why: &str) -> Failure {
        Failure::usage(format!("cannot go on from {}: {why}", self.path.display()))
            .with_help("remove it to begin anew")
    }

    /// Writes the checkpoint if it is time.
    pub(crate) fn keep(&self, film: impl FnOnce() -> Film) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let begun = Instant::now();
        if begun < state.due || state.trouble.is_some() {
            return;
        }
        let written = Output::create(&self.path).and_then(|mut output| {
            output.write(|mut out| part::write(film().film_tiles(), &self.settings, &mut out))?;
            Output::commit(vec![output])
        });
        state.trouble = written.err().map(|failure| failure.summary());
        state.due = Instant::now() + PAUSE.max(20 * begun.elapsed());
    }

    /// The picture is done: the checkpoint goes. What went wrong with it, if anything did.
    pub(crate) fn remove(self) -> Option<String> {
        let trouble = self.state.into_inner().unwrap_or_else(PoisonError::into_inner).trouble;
        match fs::remove_file(&self.path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                let why = phong_scene::trouble(&error);
                trouble.or_else(|| Some(format!("cannot remove {}: {why}", self.path.display())))
            }
            _ => trouble,
        }
    }
}
