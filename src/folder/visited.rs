//! Folders that are examined only once, for any number of files in them.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Folders that were examined, by whichever thread came first.
#[derive(Debug, Default)]
pub(crate) struct Visited(Mutex<HashSet<PathBuf>>);

impl Visited {
    /// Calls `look` for a folder not yet examined, while other threads wait. If it returns `false`, the next call looks
    /// again.
    pub(crate) fn visit<E>(&self, folder: &Path, look: impl FnOnce() -> Result<bool, E>) -> Result<(), E> {
        let mut visited = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !visited.contains(folder) && look()? {
            visited.insert(folder.to_owned());
        }
        Ok(())
    }
}
