//! The folder that scenes are read from, and saved in.

use std::io;
use std::path::{Path, PathBuf};

use phong::scene::{Blob, Format, Jail, Memory, Source, path_of, path_text};
#[cfg(feature = "server")]
use phong::{
    image::{Draft, SaveError, place},
    scene::trouble,
};

#[cfg(feature = "server")]
use crate::engine::Keep;
use crate::engine::{EXAMPLE, EXAMPLE_NAME};

/// The most names that are told of a folder.
const MOST_NAMES: usize = 200;

/// A folder, nothing outside of which is read, with the studio's own scene where no file is named.
#[derive(Clone, Debug)]
pub struct Shelf {
    folder: PathBuf,
    jail: Jail,
    /// What to open first.
    open: String,
    own: Option<Memory>,
}

impl Shelf {
    /// A folder, and the file in it to open first; `None`: a scene of the studio's own.
    ///
    /// # Errors
    /// What the system says of the folder.
    pub fn new(folder: &Path, open: Option<String>) -> io::Result<Self> {
        let jail = Jail::new(folder)?;
        let folder = folder.canonicalize()?;
        let own = match open {
            Some(_) => None,
            None => Some(Memory::new().with(EXAMPLE_NAME, EXAMPLE.as_bytes())),
        };
        let open = open.unwrap_or_else(|| EXAMPLE_NAME.to_owned());
        Ok(Self { folder, jail, open, own })
    }

    /// What to open first.
    #[must_use]
    pub fn first(&self) -> &str {
        &self.open
    }

    /// Scenes and models in the folder, in alphabetical order.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let Ok(files) = self.folder.read_dir() else { return Vec::new() };
        let readable = |name: &String| {
            Format::of_path(name).is_some_and(|format| Format::readable().contains(&format))
        };
        let names = files.filter_map(|file| Some(path_text(&file.ok()?.file_name())));
        let mut names: Vec<String> = names.filter(readable).take(MOST_NAMES).collect();
        if self.own.is_some() && !names.iter().any(|name| name == EXAMPLE_NAME) {
            names.push(EXAMPLE_NAME.to_owned());
        }
        names.sort();
        names
    }
}

impl Source for Shelf {
    fn open(&self, path: &str) -> io::Result<Box<dyn Blob>> {
        let file = self.folder.join(path_of(path));
        let found = self.jail.open(&path_text(file.as_os_str()));
        match (&self.own, found) {
            (Some(own), Err(_)) if path == EXAMPLE_NAME => own.open(path),
            (_, found) => found,
        }
    }
}

#[cfg(feature = "server")]
impl Keep for Shelf {
    fn keep(&self, path: &str, text: &str) -> Result<(), String> {
        let cannot = |why: &str| format!("cannot write {path}: {why}");
        let system = |error: io::Error| cannot(&trouble(&error));
        let named = self.folder.join(path_of(path));
        let file = match self.jail.resolve(&named) {
            Ok(file) if file.is_file() => file,
            Ok(_) => return Err(cannot("it is no file")),
            // What is not there may be made, but not where a link leads.
            Err(error) if error.kind() == io::ErrorKind::NotFound && !named.is_symlink() => {
                let name = named.file_name().ok_or_else(|| cannot("it names no file"))?;
                let folder = named.parent().unwrap_or(&self.folder);
                let folder = self.jail.resolve(folder).map_err(system)?;
                folder.join(name)
            }
            Err(error) => return Err(system(error)),
        };
        let said = |error: SaveError| match error {
            SaveError::Place { why, .. } => cannot(&why),
            SaveError::Io { source, .. } => system(source),
            error => error.to_string(),
        };
        let mut draft = Draft::create(&file).map_err(said)?;
        draft.write(|out| out.write_all(text.as_bytes())).map_err(said)?;
        place(vec![draft]).map_err(said)
    }
}
