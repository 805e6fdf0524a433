//! Several files that belong together: all of them are written, or none.

use super::{Access, Durability, FileError, folder_of, make_folder, sync_folder, temporary};
use std::path::{Path, PathBuf};
use std::{fs, io};
use tempfile::{NamedTempFile, PersistError};

/// Writes several new files, and then `last`, which may replace another: all of them or none.
///
/// All are first written and synced under temporary names, so that only their renaming, which needs no space, remains.
/// If one cannot be renamed, those renamed before are removed. A kill between two renames can leave some of the new
/// files, each of them whole.
///
/// # Errors
/// Returns [`FileError::Exists`] if a name of a new file is already used, or [`FileError::Write`].
pub(crate) fn write_together(new: &[(PathBuf, Vec<u8>)], last: &(PathBuf, Vec<u8>)) -> Result<(), FileError> {
    let failed = |path: &Path| {
        let path = path.to_owned();
        move |error| FileError::Write { path, error }
    };
    let stage = |(path, bytes): &(PathBuf, Vec<u8>)| {
        make_folders(folder_of(path)).map_err(failed(path))?;
        temporary(folder_of(path), bytes, Access::Shared, Durability::Named).map_err(failed(path))
    };
    let staged = new.iter().map(stage).collect::<Result<Vec<_>, _>>()?;
    let staged_last = stage(last)?;
    let mut written = Vec::new();
    let published = publish(new, staged, &mut written)
        .and_then(|()| staged_last.persist(&last.0).map_err(|error| failed(&last.0)(error.error)));
    if let Err(error) = published {
        // Nobody has seen these files, which were written a moment ago.
        for path in &written {
            let _ = fs::remove_file(path);
        }
        return Err(error);
    }
    for (path, _) in new.iter().chain([last]) {
        sync_folder(folder_of(path)).map_err(failed(path))?;
    }
    Ok(())
}

/// Gives temporary files the names of `new`, none of which may be used, and adds each to `written`.
fn publish<'a>(
    new: &'a [(PathBuf, Vec<u8>)],
    staged: Vec<NamedTempFile>,
    written: &mut Vec<&'a Path>,
) -> Result<(), FileError> {
    for ((path, _), temporary) in new.iter().zip(staged) {
        temporary.persist_noclobber(path).map_err(|PersistError { error, .. }| match error.kind() {
            io::ErrorKind::AlreadyExists => FileError::Exists { path: path.clone(), replaceable: false },
            _ => FileError::Write { path: path.clone(), error },
        })?;
        written.push(path);
    }
    Ok(())
}

fn make_folders(folder: &Path) -> io::Result<()> {
    if folder.is_dir() { Ok(()) } else { make_folder(folder, Durability::Named) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_are_written_or_none() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let file = |name: &str, text: &str| (at(name), text.as_bytes().to_vec());
        fs::write(at("last"), "old").unwrap();
        fs::write(at("b"), "there").unwrap();
        let refused = write_together(&[file("a", "1"), file("b", "2")], &file("last", "new"));
        assert!(matches!(refused, Err(FileError::Exists { path, .. }) if path == at("b")));
        let read = |name: &str| fs::read_to_string(at(name)).ok();
        assert_eq!((read("a"), read("b"), read("last")), (None, Some("there".into()), Some("old".into())));
        // A folder in place of the last file: the new ones are removed again.
        fs::create_dir(at("folder")).unwrap();
        assert!(write_together(&[file("a", "1")], &file("folder", "new")).is_err());
        assert_eq!(read("a"), None);
        write_together(&[file("deep/er/a", "1"), file("c", "2")], &file("last", "new")).unwrap();
        assert_eq!(
            (read("deep/er/a"), read("c"), read("last")),
            (Some("1".into()), Some("2".into()), Some("new".into()))
        );
        let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left.len(), 5, "no temporary file is left: {left:?}");
    }
}
