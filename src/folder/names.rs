//! Names that differ only in case, which some systems do not distinguish.

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
    /// Names in each folder, by their lower-case form.
    known: Mutex<HashMap<PathBuf, HashMap<String, String>>>,
    of: Of,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Of {
    /// Models and serial numbers.
    Folders,
    /// Sites: the part of a passport's file name before the revision.
    Passports,
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
            if self.of == Of::Passports && known.len() >= MOST_FOLDERS_OF_PASSPORTS {
                known.clear();
            }
            known.insert(folder.to_owned(), self.list(folder)?);
        }
        let there =
            known.get_mut(folder).map(|names| names.entry(name.to_ascii_lowercase()).or_insert(name.to_owned()));
        Ok(there.filter(|there| *there != name).map(|there| folder.join(there)))
    }

    fn list(&self, folder: &Path) -> Result<HashMap<String, String>, FileError> {
        let failed = |error| FileError::Read(folder.to_owned(), error);
        let entries = match fs::read_dir(folder) {
            // A file in place of the folder is reported when the passport itself is looked up.
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
                return Ok(HashMap::new());
            }
            entries => entries.map_err(failed)?,
        };
        let mut names = HashMap::new();
        for entry in entries {
            let entry = entry.map_err(failed)?;
            let is_folder = entry.file_type().map_err(failed)?.is_dir();
            if is_folder == (self.of == Of::Folders)
                && let Some(name) = self.name(Path::new(&entry.file_name()))
            {
                names.insert(name.to_ascii_lowercase(), name.to_owned());
            }
        }
        Ok(names)
    }

    fn name<'p>(&self, path: &'p Path) -> Option<&'p str> {
        let name = path.file_name()?;
        match self.of {
            Of::Folders => name.to_str(),
            Of::Passports => numbered(name),
        }
    }
}
