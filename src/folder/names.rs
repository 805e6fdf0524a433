//! Names in the folders of passports: those that differ only in case, which some systems do not distinguish, and the last
//! revisions.

use super::search::numbered;
use crate::files::FileError;
use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Names in folders of stands or of sites. Each folder is listed once.
#[derive(Debug)]
pub(super) struct Names {
    /// Names in each folder.
    known: Mutex<HashMap<PathBuf, Listed>>,
    of: Of,
}

/// Names by their lower-case form, with the last revision that was there.
type Listed = HashMap<String, (String, u32)>;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Of {
    /// Models and serial numbers.
    Folders,
    /// Sites: the part of a passport's file name before the revision.
    Passports,
    /// Files of other kinds.
    Files,
}

/// Number of folders of passports that are remembered before the list is cleared. Passports of one stand follow each
/// other.
const MOST_FOLDERS_OF_PASSPORTS: usize = 256;

impl Names {
    pub(super) fn new(of: Of) -> Self {
        Self { known: Mutex::default(), of }
    }

    /// Adds a name to those of its folder; returns the path of an existing one that differs only in case, or `None`.
    pub(super) fn add(&self, path: &Path) -> Result<Option<PathBuf>, FileError> {
        let folder = crate::files::folder_of(path);
        let Some(name) = self.name(path) else { return Ok(None) };
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if !known.contains_key(folder) {
            if self.of != Of::Folders && known.len() >= MOST_FOLDERS_OF_PASSPORTS {
                known.clear();
            }
            known.insert(folder.to_owned(), self.list(folder)?);
        }
        let there =
            known.get_mut(folder).map(|names| names.entry(name.to_ascii_lowercase()).or_insert((name.to_owned(), 0)));
        Ok(there.filter(|(there, _)| *there != name).map(|(there, _)| folder.join(there)))
    }

    /// Returns the last revision in the folder of a passport that was added, if it is later than `revision`.
    pub(super) fn later(&self, path: &Path, revision: u32) -> Option<u32> {
        let (folder, name) = (crate::files::folder_of(path), self.name(path)?);
        let known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let (_, last) = known.get(folder)?.get(&name.to_ascii_lowercase())?;
        Some(*last).filter(|last| *last > revision)
    }

    fn list(&self, folder: &Path) -> Result<Listed, FileError> {
        let failed = |error| FileError::Read(folder.to_owned(), error);
        let entries = match fs::read_dir(folder) {
            // A file in place of the folder is reported when the passport itself is looked up.
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
                return Ok(Listed::new());
            }
            entries => entries.map_err(failed)?,
        };
        let mut names = Listed::new();
        for entry in entries {
            let file = entry.map_err(failed)?.file_name();
            if let Some(name) = self.name(Path::new(&file)) {
                let last = &mut names.entry(name.to_ascii_lowercase()).or_insert((name.to_owned(), 0)).1;
                *last = (*last).max(numbered(&file).map_or(0, |(_, revision)| revision));
            }
        }
        Ok(names)
    }

    fn name<'p>(&self, path: &'p Path) -> Option<&'p str> {
        let name = path.file_name()?;
        match self.of {
            Of::Folders | Of::Files => name.to_str(),
            Of::Passports => numbered(name).map(|(site, _)| site),
        }
    }
}
