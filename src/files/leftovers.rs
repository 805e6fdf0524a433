//! Temporary files that a killed run left behind, and how they are told from those of a run that lives.
//!
//! A run locks its temporary file as long as it has that name, and the system drops the lock when the run ends, however
//! it ends. So a temporary file that nobody has locked belongs to nobody. Where a shared folder knows no locks, or they
//! do not reach from machine to machine, a living run may lose a temporary file to another one: it finds that out when
//! it renames the file, and writes it again.

use std::ffi::OsStr;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::Path;

/// How the name of every temporary file begins.
pub(super) const PREFIX: &str = ".dtg-passport-";

/// And how it ends.
pub(super) const SUFFIX: &str = ".tmp";

/// Removes from a folder the temporary files that belong to no living run; gives how many.
///
/// What cannot be looked at or removed stays: it is in nobody's way.
pub(crate) fn remove(folder: &Path) -> usize {
    let Ok(entries) = fs::read_dir(folder) else { return 0 };
    let ours = entries.flatten().filter(|entry| {
        // A link or a folder of that name is not ours.
        !is_lasting(&entry.file_name()) && entry.file_type().is_ok_and(|kind| kind.is_file())
    });
    ours.filter(|entry| remove_unless_in_use(&entry.path()).is_ok()).count()
}

/// Returns `true` if a file is not named as the temporary files of a run are.
pub(crate) fn is_lasting(name: &OsStr) -> bool {
    let name = name.to_string_lossy();
    !(name.starts_with(PREFIX) && name.ends_with(SUFFIX))
}

fn remove_unless_in_use(path: &Path) -> io::Result<()> {
    // Over NFS only a file that is open for writing can be locked.
    let file = File::options().read(true).write(true).open(path)?;
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => Err(io::ErrorKind::ResourceBusy.into()),
        // The lock is kept until the name is gone: whoever made the file just now sees that he has lost it.
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
        assert_eq!(remove(folder.path()), 1);
        assert!(!folder.path().join(".dtg-passport-left.tmp").exists());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 4);
        drop(in_use);
        assert_eq!(remove(folder.path()), 1);
        assert_eq!(remove(&folder.path().join("no such folder")), 0);
    }
}
