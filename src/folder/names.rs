//! Names that differ only in case, which some systems do not distinguish.

use super::place;
use crate::files::FileError;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Names of folders, or of files. Each folder is listed once.
#[derive(Debug)]
pub(super) struct Names {
    /// Names in each folder by their lower-case form.
    known: Mutex<HashMap<PathBuf, HashMap<String, String>>>,
    /// `true` for names of folders, `false` for those of files.
    of_folders: bool,
}

/// Number of folders whose files are remembered before the list is cleared. Files of one stand follow each other.
const MOST_FOLDERS_OF_FILES: usize = 256;

impl Names {
    pub(super) fn folders() -> Self {
        Self { known: Mutex::default(), of_folders: true }
    }

    pub(super) fn files() -> Self {
        Self { known: Mutex::default(), of_folders: false }
    }

    /// Adds a name to those of its folder; returns the path of an existing one that differs only in case, or `None`.
    pub(super) fn add(&self, path: &Path) -> Result<Option<PathBuf>, FileError> {
        let folder = crate::files::folder_of(path);
        let Some(name) = path.file_name().and_then(|name| name.to_str()) else { return Ok(None) };
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if !known.contains_key(folder) {
            if !self.of_folders && known.len() >= MOST_FOLDERS_OF_FILES {
                known.clear();
            }
            known.insert(folder.to_owned(), self.list(folder)?);
        }
        let names = known.get_mut(folder);
        let there = names.map(|names| names.entry(name.to_ascii_lowercase()).or_insert_with(|| name.to_owned()));
        Ok(there.filter(|there| *there != name).map(|there| folder.join(there)))
    }

    fn list(&self, folder: &Path) -> Result<HashMap<String, String>, FileError> {
        let mut names = HashMap::new();
        for entry in place::entries(folder)? {
            let file_type = entry.file_type().map_err(|error| FileError::Read(folder.to_owned(), error))?;
            let is_folder = file_type.is_dir();
            if is_folder == self.of_folders
                && let Ok(name) = entry.file_name().into_string()
            {
                names.entry(name.to_ascii_lowercase()).or_insert(name);
            }
        }
        Ok(names)
    }
}
