//! Files that the worker has fetched, and those that it has not.

use std::io;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use phong::scene::{Blob, Memory, Source};

/// Files that the worker has fetched.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shelf(Arc<Mutex<Files>>);

#[derive(Debug, Default)]
struct Files {
    there: Memory,
    lacking: Vec<String>,
}

impl Shelf {
    /// Puts a file there.
    pub(crate) fn put(&self, path: String, bytes: Vec<u8>) {
        let mut files = self.files();
        files.there = std::mem::take(&mut files.there).with(path, bytes);
    }

    /// Files that were asked for and not there, since this was last asked.
    pub(crate) fn lacking(&self) -> Vec<String> {
        std::mem::take(&mut self.files().lacking)
    }

    fn files(&self) -> MutexGuard<'_, Files> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Source for Shelf {
    fn open(&self, path: &str) -> io::Result<Box<dyn Blob>> {
        let mut files = self.files();
        let found = files.there.open(path);
        if found.is_err() {
            files.lacking.push(path.to_owned());
        }
        found
    }
}
