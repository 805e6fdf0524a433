//! Folders that need one look, however many of their files are worked on.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Folders that are looked at once, by whichever thread comes first.
#[derive(Debug, Default)]
pub(crate) struct Visited(Mutex<HashSet<PathBuf>>);

impl Visited {
    /// Looks at a folder that was not looked at yet, while others wait; a look that comes to nothing is not the last one.
    pub(crate) fn visit<E>(&self, folder: &Path, look: impl FnOnce() -> Result<bool, E>) -> Result<(), E> {
        let mut visited = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !visited.contains(folder) && look()? {
            visited.insert(folder.to_owned());
        }
        Ok(())
    }
}
