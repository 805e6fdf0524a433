//! Walk through the files under a folder, in the order of their names. Links are not followed, because they may lead
//! out of the folder.

use super::FileError;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};

/// Entry found under a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Entry {
    /// File with a wanted name.
    File(PathBuf),
    /// Link with a wanted name, or to a folder; it was not followed.
    Link(PathBuf),
    /// Pipe, device or socket with a wanted name; reading it might never end.
    Special(PathBuf),
}

pub(crate) const LINK: &str = "not read: links are not followed, because they may lead out of the folder";

pub(crate) const SPECIAL: &str = "not read: it is a pipe, a device or a socket";

/// Walk through a folder. It keeps only the wanted names in the folders from the root to the current one, so its memory
/// does not depend on the number of other files.
pub(crate) struct Walk {
    wanted: fn(&OsStr) -> bool,
    deep: bool,
    next: Option<PathBuf>,
    levels: Vec<Level>,
}

struct Level {
    folder: PathBuf,
    entries: std::vec::IntoIter<Listed>,
}

/// Name in a folder, and what its path is found as; `None` for a folder, which is entered.
type Listed = (OsString, Option<fn(PathBuf) -> Entry>);

impl Walk {
    /// Creates a walk through the files with wanted names under `root`, at any depth.
    pub(crate) fn deep(root: &Path, wanted: fn(&OsStr) -> bool) -> Self {
        Self { wanted, deep: true, next: Some(root.to_owned()), levels: Vec::new() }
    }

    /// Creates a walk through the files with wanted names in `root` itself.
    pub(crate) fn flat(root: &Path, wanted: fn(&OsStr) -> bool) -> Self {
        Self { deep: false, ..Self::deep(root, wanted) }
    }

    /// Returns the files; other entries, and folders that cannot be read, are omitted.
    pub(crate) fn files(self) -> impl Iterator<Item = PathBuf> {
        self.filter_map(|entry| match entry {
            Ok(Entry::File(path)) => Some(path),
            _ => None,
        })
    }

    fn enter(&mut self, folder: PathBuf) -> Result<(), FileError> {
        let failed = |error| FileError::Read(folder.clone(), error);
        let mut entries: Vec<Listed> = Vec::new();
        for entry in fs::read_dir(&folder).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let (name, kind) = (entry.file_name(), entry.file_type().map_err(failed)?);
            let wanted = (self.wanted)(&name);
            if kind.is_symlink() {
                let to_folder = || self.deep && fs::metadata(entry.path()).is_ok_and(|target| target.is_dir());
                entries.extend((wanted || to_folder()).then_some((name, Some(Entry::Link as _))));
            } else if kind.is_dir() {
                entries.extend(self.deep.then_some((name, None)));
            } else {
                let of: fn(_) -> _ = if kind.is_file() { Entry::File } else { Entry::Special };
                entries.extend(wanted.then_some((name, Some(of))));
            }
        }
        entries.sort_by(|a, b| a.0.cmp(&b.0));
        self.levels.push(Level { folder, entries: entries.into_iter() });
        Ok(())
    }
}

impl Iterator for Walk {
    type Item = Result<Entry, FileError>;

    /// Returns the next entry. A folder that cannot be read gives one error, and the walk continues after it.
    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(folder) = self.next.take()
                && let Err(error) = self.enter(folder)
            {
                return Some(Err(error));
            }
            let level = self.levels.last_mut()?;
            let Some((name, found)) = level.entries.next() else {
                self.levels.pop();
                continue;
            };
            let path = level.folder.join(name);
            match found {
                Some(found) => return Some(Ok(found(path))),
                None => self.next = Some(path),
            }
        }
    }
}
