//! A file that is replaced: what its successor takes from it, and how it is kept until then.

use std::fs::{self, File, Metadata};
use std::io;
use std::path::{Path, PathBuf};

use super::{folder_of, temporary};

/// A file that will be replaced.
#[derive(Debug)]
pub(super) struct Former(Metadata);

impl Former {
    pub(super) fn new(meta: Metadata) -> Self {
        Self(meta)
    }

    /// Gives its successor its mode, and its owner where the system allows it.
    pub(super) fn hand_on(&self, file: &File) -> io::Result<()> {
        #[cfg(unix)]
        {
            use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
            let (own, was) = (file.metadata()?, &self.0);
            // Only who may give files away can do this; a group can be given by its members.
            let same = (own.uid(), own.gid()) == (was.uid(), was.gid());
            let given = same || fchown(file, Some(was.uid()), Some(was.gid())).is_ok();
            let grouped = given || fchown(file, None, Some(was.gid())).is_ok();
            // To run as its owner or group is not for a file that others own.
            let mode = self.mode() & if given { 0o7777 } else { 0o777 };
            let mode = if grouped { mode } else { mode & !0o070 };
            // A file system without modes refuses this; the file is then what all its files are.
            let _ = file.set_permissions(fs::Permissions::from_mode(mode));
        }
        #[cfg(not(unix))]
        let _ = (file, &self.0);
        Ok(())
    }

    /// Whether whoever owns `own`, a file in the same folder, may replace it: not in a folder where
    /// all may write and each only removes what is theirs.
    pub(super) fn may_be_replaced(&self, folder: &Path, own: &File) -> bool {
        #[cfg(unix)]
        {
            use std::os::unix::fs::MetadataExt;
            let (Ok(folder), Ok(own)) = (fs::metadata(folder), own.metadata()) else { return true };
            let user = own.uid();
            folder.mode() & 0o1000 == 0 || user == 0 || [folder.uid(), self.0.uid()].contains(&user)
        }
        #[cfg(not(unix))]
        {
            let _ = (folder, own);
            true
        }
    }

    #[cfg(unix)]
    pub(super) fn mode(&self) -> u32 {
        use std::os::unix::fs::MetadataExt;
        self.0.mode()
    }
}

/// Keeps the file that will be replaced at `path` under a temporary name as well; `None` if there
/// is none. It is a second name of the very file where the file system knows such, else a copy.
pub(super) fn keep(path: &Path) -> io::Result<Option<PathBuf>> {
    let meta = match fs::metadata(path) {
        Ok(meta) => meta,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error),
    };
    if !meta.is_file() {
        return Ok(None);
    }
    let former = Former::new(meta);
    let builder = temporary(".old", Some(&former));
    let linked = builder.make_in(folder_of(path), |name| fs::hard_link(path, name));
    let kept = if let Ok(linked) = linked {
        linked.into_temp_path()
    } else {
        let mut copy = builder.tempfile_in(folder_of(path))?;
        io::copy(&mut File::open(path)?, copy.as_file_mut())?;
        former.hand_on(copy.as_file())?;
        copy.as_file().sync_all()?;
        copy.into_temp_path()
    };
    Ok(Some(kept.keep()?))
}

/// Whether two names are of one file; false if there is none of either name.
pub(super) fn is_same_file(a: &Path, b: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let number = |path: &Path| fs::metadata(path).ok().map(|meta| (meta.dev(), meta.ino()));
        number(a).is_some_and(|a| number(b) == Some(a))
    }
    #[cfg(not(unix))]
    {
        let real = |path: &Path| fs::canonicalize(path).ok();
        real(a).is_some_and(|a| real(b) == Some(a))
    }
}
