//! `OUT.part`, kept while a picture is rendered, so that a later run goes on from it.

use std::fs::{self, File};
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use phong::film::Film;
use phong::part::{self, Part, PartError, Settings};
use phong::render::{Cancel, Event, Passes, RenderOptions, Rendering};
use phong_scene::trouble;

use crate::failure::Failure;
use crate::output::Output;
use crate::report;

/// The shortest time between two checkpoints; writing them takes a twentieth of the time at most.
const PAUSE: Duration = Duration::from_secs(1);

/// Where the checkpoint of a picture is that is to be written to `output`.
pub(crate) fn path(output: &Path) -> PathBuf {
    let mut path = output.as_os_str().to_owned();
    path.push(".part");
    path.into()
}

/// The checkpoint of one picture.
#[derive(Debug)]
pub(crate) struct Checkpoint {
    path: PathBuf,
    settings: Settings,
    /// The memory that what it holds may take, bytes.
    limit: u64,
    quiet: bool,
    /// What went wrong with the last attempt to write it.
    trouble: Mutex<Option<String>>,
}

impl Checkpoint {
    /// The checkpoint of a picture that is to be written to `output`; `quiet` says nothing of
    /// trouble with it.
    pub(crate) fn beside(
        output: &Path,
        settings: Settings,
        options: &RenderOptions,
        quiet: bool,
    ) -> Self {
        // It may be of a run in passes, whatever this one is.
        let limit = options.clone().with_passes(Passes::CoarseToFine).film_bytes();
        Self { path: path(output), settings, limit, quiet, trouble: Mutex::default() }
    }

    /// What an earlier run has done of this very picture; `None` if there is no checkpoint.
    pub(crate) fn film(&self) -> Result<Option<Film>, Failure> {
        let failed = |error: &io::Error| Failure::reading(&self.path, error);
        // Opening a pipe would wait for whoever writes to it.
        if fs::metadata(&self.path).is_ok_and(|kind| !kind.is_file()) {
            return Err(self.unusable("it is no file"));
        }
        let file = match File::open(&self.path) {
            Ok(file) => file,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) if error.kind() == io::ErrorKind::InvalidFilename => {
                let why = format!("cannot keep {}: its name is too long", self.path.display());
                return Err(Failure::usage(why).with_help("give OUT a shorter name"));
            }
            Err(error) => return Err(failed(&error)),
        };
        let read = Part::read(&mut BufReader::with_capacity(1 << 18, file), self.limit);
        let part = read.map_err(|error| match error {
            PartError::Io(error) => failed(&error),
            error => self.unusable(&error.to_string()),
        })?;
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

    /// The checkpoint cannot be gone on from.
    pub(crate) fn unusable(&self, why: &str) -> Failure {
        Failure::usage(format!("cannot go on from {}: {why}", self.path.display()))
            .with_help("remove it to begin anew")
    }

    /// Renders, and keeps what there is: from the beginning on, now and then on a thread of its
    /// own, so that no tile waits for it, and at the end if that is not the picture's.
    pub(crate) fn run(
        &self,
        rendering: &Rendering<'_>,
        listen: &(dyn Fn(Event<'_>) + Sync),
        cancel: &Cancel,
    ) {
        // What is wrong with its place is known before it is needed.
        self.write(rendering);
        thread::scope(|scope| {
            let (end, ended) = channel::<()>();
            let keep = move || {
                let mut pause = PAUSE;
                while ended.recv_timeout(pause) == Err(RecvTimeoutError::Timeout) {
                    let begun = Instant::now();
                    self.write(rendering);
                    pause = PAUSE.max(20 * begun.elapsed());
                }
            };
            if let Err(error) = thread::Builder::new().spawn_scoped(scope, keep) {
                let why = trouble(&error);
                self.warn(&format!("no thread to write the checkpoint meanwhile ({why})"));
            }
            rendering.run(listen, cancel);
            drop(end);
        });
        let progress = rendering.progress();
        if progress.tiles_done < progress.tiles {
            self.write(rendering);
        }
    }

    /// Writes it. Trouble is told when it begins, and the next time is another attempt.
    fn write(&self, rendering: &Rendering<'_>) {
        let tiles = (0..rendering.tiles()).filter_map(|tile| rendering.film_tile(tile));
        let written = Output::create(&self.path).and_then(|mut output| {
            output.write(|mut out| part::write(tiles, &self.settings, &mut out))?;
            Output::commit(vec![output])
        });
        let now = written.err().map(|failure| failure.summary());
        let mut before = self.trouble.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(why) = &now
            && *before != now
        {
            self.warn(&format!("{why}; it will be tried again"));
        }
        *before = now;
    }

    fn warn(&self, why: &str) {
        if !self.quiet {
            report::say(&format!("warning: {why}"));
        }
    }

    /// The picture is done: the checkpoint goes.
    pub(crate) fn remove(self) {
        match fs::remove_file(&self.path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                let why = trouble(&error);
                self.warn(&format!("cannot remove {}: {why}", self.path.display()));
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use phong::image::Encoding;
    use phong::view::View;
    use phong_scene::{Limits, Memory, Scene};

    use super::*;

    const BALL: &str = "version = 1\nimage = { size = [64, 48], samples = 2 }\n\
                        camera = { eye = [0, 0, 5], look_at = [0, 0, 0] }\n\
                        sphere = [{ center = [0, 0, 0], radius = 1 }]\n";

    fn view() -> View {
        let files = Memory::new().with("ball.toml", BALL.as_bytes());
        let reading = phong_scene::read("ball.toml", None, &files, &Limits::default());
        View::of(&reading.scene.unwrap()).unwrap()
    }

    #[test]
    fn what_is_done_when_a_render_is_cancelled_is_in_its_checkpoint() {
        let folder = tempfile::tempdir().unwrap();
        let (view, options) = (view(), RenderOptions::new([64, 48]).unwrap());
        let settings = Settings::of(&Scene::default(), &options, Encoding::default());
        let output = folder.path().join("a.png");
        let checkpoint = || Checkpoint::beside(&output, settings.clone(), &options, true);
        let (cancel, tiles) = (Cancel::new(), Mutex::new(0));
        let listen = |event: Event<'_>| {
            if let Event::Tile { .. } = event {
                *tiles.lock().unwrap() += 1;
                if *tiles.lock().unwrap() == 5 {
                    cancel.cancel();
                }
            }
        };
        let rendering = Rendering::new(&view, &options);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        pool.install(|| checkpoint().run(&rendering, &listen, &cancel));
        let film = checkpoint().film().unwrap().unwrap();
        assert_eq!(film.done.iter().filter(|&&done| done).count(), 5);
        let rest = Rendering::resume(&view, &options, film).unwrap();
        checkpoint().run(&rest, &|_| {}, &Cancel::new());
        let whole = Rendering::new(&view, &options);
        whole.run(&|_| {}, &Cancel::new());
        assert_eq!(rest.film(), whole.film());
    }

    #[test]
    fn a_checkpoint_that_could_not_be_written_is_written_at_the_next_attempt() {
        let folder = tempfile::tempdir().unwrap();
        let (view, options) = (view(), RenderOptions::new([64, 48]).unwrap());
        let settings = Settings::of(&Scene::default(), &options, Encoding::default());
        let output = folder.path().join("later/a.png");
        let checkpoint = Checkpoint::beside(&output, settings, &options, true);
        let rendering = Rendering::new(&view, &options);
        checkpoint.write(&rendering);
        let trouble = checkpoint.trouble.lock().unwrap().clone().unwrap();
        assert!(trouble.contains("no such folder"), "{trouble}");
        fs::create_dir(folder.path().join("later")).unwrap();
        checkpoint.write(&rendering);
        assert_eq!(*checkpoint.trouble.lock().unwrap(), None);
        assert!(checkpoint.film().unwrap().is_some());
    }
}
