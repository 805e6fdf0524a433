//! Temporary files that killed runs left behind, and how to distinguish them from those of active runs.
//!
//! A run locks its temporary file as long as the file has that name. The system releases the lock when the run ends, in
//! whatever way. An unlocked temporary file therefore belongs to no active run. If a shared folder has no locks, or
//! they do not work between machines, an active run may lose a temporary file to another run. It notices this when it
//! renames the file, and writes it again.

use std::ffi::OsStr;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::Path;

/// Prefix of the names of temporary files.
pub(super) const PREFIX: &str = ".dtg-passport-";

/// Suffix of the names of temporary files.
pub(super) const SUFFIX: &str = ".tmp";

/// Removes the temporary files that belong to no active run from a folder.
///
/// Files that cannot be examined or removed stay; they cause no errors.
pub(crate) fn remove(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    let ours = entries.flatten().filter(|entry| {
        // A link or a folder with such a name was not created by this program.
        !is_lasting(&entry.file_name()) && entry.file_type().is_ok_and(|kind| kind.is_file())
    });
    // What cannot be removed stays.
    ours.for_each(|entry| drop(remove_unless_in_use(&entry.path())));
}

/// Returns `true` if a file is not named as the temporary files of a run are.
pub(crate) fn is_lasting(name: &OsStr) -> bool {
    let name = name.to_string_lossy();
    !(name.starts_with(PREFIX) && name.ends_with(SUFFIX))
}

fn remove_unless_in_use(path: &Path) -> io::Result<()> {
    // NFS can lock only a file that is open for writing.
    let file = File::options().read(true).write(true).open(path)?;
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => Err(io::ErrorKind::ResourceBusy.into()),
        // The lock is kept until the name is removed, so that the run that created the file notices the loss.
        Ok(()) | Err(TryLockError::Error(_)) => fs::remove_file(path),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_locked_stays_and_what_is_not_ours_too() {
        let folder = tempfile::tempdir().unwrap();
        let make = |name: &str| File::create_new(folder.path().join(name)).unwrap();
        make(".dtg-passport-left.tmp");
        make("here-1.yaml");
        make(".another-program.tmp");
        fs::create_dir(folder.path().join(".dtg-passport-folder.tmp")).unwrap();
        let in_use = make(".dtg-passport-used.tmp");
        in_use.lock().unwrap();
        remove(folder.path());
        assert!(!folder.path().join(".dtg-passport-left.tmp").exists());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 4);
        drop(in_use);
        remove(folder.path());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
        remove(&folder.path().join("no such folder"));
    }
}
