//! Several files that belong together: all of them are written, or none.

use super::{Access, Durability, FileError, check_replaceable, folder_of, make_folder, sync_folder, temporary};
use std::path::{Path, PathBuf};
use std::{fs, io};
use tempfile::PersistError;

/// Writes several files as [`super::write_replaceable`] does: all of them or none.
pub(crate) fn write_replaceable_together<B: AsRef<[u8]>>(files: &[(PathBuf, B)], force: bool) -> Result<(), FileError> {
    check_replaceable(files.iter().map(|(path, _)| path), force)?;
    if force { write_together(&[], files) } else { write_together(files, &[]) }
}

/// Writes several new files, and then those of `last` in their order, which may replace others: all of them or none.
///
/// All are first written and synced under temporary names, so that only their renaming, which needs no space, remains.
/// If one cannot be renamed, the new ones renamed before are removed, unless one of `last` has replaced another already,
/// because it may reference them. A kill between two renames can leave some of the new files, each of them whole.
///
/// # Errors
/// Returns [`FileError::Exists`] if a name of a new file is already used, or [`FileError::Write`].
pub(crate) fn write_together<B: AsRef<[u8]>>(new: &[(PathBuf, B)], last: &[(PathBuf, B)]) -> Result<(), FileError> {
    let failed = |path: &Path| {
        let path = path.to_owned();
        move |error| FileError::Write(path, error)
    };
    let stage = |(path, bytes): &(PathBuf, B)| {
        let folder = folder_of(path);
        if !folder.is_dir() {
            make_folder(folder, Durability::Named).map_err(failed(path))?;
        }
        temporary(folder, bytes.as_ref(), Access::Shared, Durability::Named).map_err(failed(path))
    };
    let staged = new.iter().map(stage).collect::<Result<Vec<_>, _>>()?;
    let staged_last = last.iter().map(stage).collect::<Result<Vec<_>, _>>()?;
    let mut written = Vec::new();
    let named = new.iter().zip(staged).try_for_each(|((path, _), temporary)| {
        temporary.persist_noclobber(path).map_err(|PersistError { error, .. }| match error.kind() {
            io::ErrorKind::AlreadyExists => FileError::Exists { path: path.clone(), replaceable: false },
            _ => FileError::Write(path.clone(), error),
        })?;
        written.push(path);
        Ok(())
    });
    let mut is_replaced = false;
    let published = named.and_then(|()| {
        // The names of the new files are durable before another file references them.
        new.iter().try_for_each(|(path, _)| sync_folder(folder_of(path)).map_err(failed(path)))?;
        last.iter().zip(staged_last).try_for_each(|((path, _), temporary)| {
            temporary.persist(path).map_err(|error| failed(path)(error.error))?;
            is_replaced = true;
            Ok(())
        })
    });
    if let Err(error) = published {
        if is_replaced {
            return Err(error);
        }
        // Nobody has seen these files, which were written a moment ago.
        for path in &written {
            let _ = fs::remove_file(path);
        }
        return Err(error);
    }
    for (path, _) in last {
        sync_folder(folder_of(path)).map_err(failed(path))?;
    }
    Ok(())
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
        let refused = write_together(&[file("a", "1"), file("b", "2")], &[file("last", "new")]);
        assert!(matches!(refused, Err(FileError::Exists { path, .. }) if path == at("b")));
        let read = |name: &str| fs::read_to_string(at(name)).ok();
        assert_eq!((read("a"), read("b"), read("last")), (None, Some("there".into()), Some("old".into())));
        // If the last file cannot be replaced, because it is a folder, the new files are removed again.
        fs::create_dir(at("folder")).unwrap();
        assert!(write_together(&[file("a", "1")], &[file("folder", "new")]).is_err());
        assert_eq!(read("a"), None);
        write_together(&[file("deep/er/a", "1"), file("c", "2")], &[file("last", "new")]).unwrap();
        assert_eq!(
            (read("deep/er/a"), read("c"), read("last")),
            (Some("1".into()), Some("2".into()), Some("new".into()))
        );
        // What cannot be written leaves none of the others, nor replaces any.
        for force in [false, true] {
            let refused = write_replaceable_together(&[file("d", "1"), file("b/below", "2")], force);
            assert!(matches!(refused, Err(FileError::Write(path, _)) if path == at("b/below")));
            assert!(write_replaceable_together(&[file("d", "1"), file("folder", "2")], force).is_err());
            assert_eq!(read("d"), None);
        }
        let refused = write_replaceable_together(&[file("d", "1"), file("b", "2")], false);
        assert!(matches!(refused, Err(FileError::Exists { replaceable: true, .. })));
        write_replaceable_together(&[file("c", "3"), file("b", "4")], true).unwrap();
        assert_eq!((read("c"), read("b"), read("d")), (Some("3".into()), Some("4".into()), None));
        fs::write(at("b"), "format: \"dtg-passport/1\"\n").unwrap();
        let refused = write_replaceable_together(&[file("c", "5"), file("b", "6")], true);
        assert!(matches!(refused, Err(FileError::Exists { replaceable: false, .. })));
        assert_eq!(read("c"), Some("3".into()));
        let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left.len(), 5, "no temporary file is left: {left:?}");
    }
}
