//! Files: read whole and not too large, written whole or not at all.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// What a file operation could not do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// It cannot be opened or read.
    #[error("{}: cannot be read: {}", path.display(), reason(error))]
    Read {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// It is a folder.
    #[error("{}: is a folder, expected a file", path.display())]
    Folder {
        /// Which.
        path: PathBuf,
    },
    /// It is larger than any such file can be.
    #[error("{}: more than {limit} bytes: is this the right file?", path.display())]
    TooLarge {
        /// Which file.
        path: PathBuf,
        /// The limit in bytes.
        limit: usize,
    },
    /// It exists, and is not replaced.
    #[error("{}: exists and was left as it is{}", path.display(), if *replaceable { "; --force replaces it" } else { "" })]
    Exists {
        /// Which file.
        path: PathBuf,
        /// Whether it may be replaced when the user says so.
        replaceable: bool,
    },
    /// It cannot be written.
    #[error("{}: cannot be written: {}; nothing was left behind", path.display(), reason(error))]
    Write {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
}

/// What the system says, in words for those who do not know its error numbers.
pub fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "no such file or folder".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        io::ErrorKind::NotADirectory => "what should be a folder on the way to it is a file".to_owned(),
        io::ErrorKind::StorageFull => "no space left".to_owned(),
        _ => error.to_string(),
    }
}

/// Reads a file of at most `limit` bytes; no more than that is ever held.
///
/// # Errors
/// [`FileError::Read`], [`FileError::Folder`], [`FileError::TooLarge`].
pub fn read(path: &Path, limit: usize) -> Result<Vec<u8>, FileError> {
    let bytes = read_first(path, limit + 1)?;
    if bytes.len() > limit {
        return Err(FileError::TooLarge { path: path.to_owned(), limit });
    }
    Ok(bytes)
}

/// The first `limit` bytes of a file, or all of it when it is shorter.
///
/// # Errors
/// [`FileError::Read`], [`FileError::Folder`].
pub fn read_first(path: &Path, limit: usize) -> Result<Vec<u8>, FileError> {
    let failed = |error| FileError::Read { path: path.to_owned(), error };
    let file = File::open(path).map_err(failed)?;
    if file.metadata().map_err(failed)?.is_dir() {
        return Err(FileError::Folder { path: path.to_owned() });
    }
    let mut bytes = Vec::new();
    file.take(limit as u64).read_to_end(&mut bytes).map_err(failed)?;
    Ok(bytes)
}

/// Who may read a new file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// Everybody whom the user's umask lets.
    Shared,
    /// The user alone (mode 0600): private keys.
    Private,
}

/// Writes a new file: to a temporary name beside it, synced, renamed without replacing, the folder synced.
///
/// Missing folders are made.
///
/// # Errors
/// [`FileError::Exists`] when something of that name is there, [`FileError::Write`].
pub fn write_new(path: &Path, bytes: &[u8], access: Access) -> Result<(), FileError> {
    write(path, bytes, access, |temporary| temporary.persist_noclobber(path), false)
}

/// The same, replacing what is there when `force` says so.
///
/// # Errors
/// As [`write_new`].
pub fn write_replaceable(path: &Path, bytes: &[u8], force: bool) -> Result<(), FileError> {
    if force {
        write(path, bytes, Access::Shared, |temporary| temporary.persist(path), true)
    } else {
        write(path, bytes, Access::Shared, |temporary| temporary.persist_noclobber(path), true)
    }
}

fn write(
    path: &Path,
    bytes: &[u8],
    access: Access,
    persist: impl FnOnce(tempfile::NamedTempFile) -> Result<File, tempfile::PersistError>,
    replaceable: bool,
) -> Result<(), FileError> {
    let failed = |error| FileError::Write { path: path.to_owned(), error };
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(folder).map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => failed(io::ErrorKind::NotADirectory.into()),
        _ => failed(error),
    })?;
    let mut temporary = builder(access).tempfile_in(folder).map_err(failed)?;
    temporary.write_all(bytes).and_then(|()| temporary.as_file().sync_all()).map_err(failed)?;
    persist(temporary).map_err(|refused| match refused.error.kind() {
        io::ErrorKind::AlreadyExists => FileError::Exists { path: path.to_owned(), replaceable },
        _ => failed(refused.error),
    })?;
    sync_folder(folder).map_err(failed)
}

/// A temporary file's name says whose it is, so that a leftover can be recognised.
fn builder(access: Access) -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".dtg-passport-").suffix(".tmp");
    #[cfg(unix)]
    if access == Access::Shared {
        use std::os::unix::fs::PermissionsExt;
        // The umask takes away from this; without it the file would be the user's alone.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    #[cfg(not(unix))]
    let _ = access;
    builder
}

#[cfg(unix)]
fn sync_folder(folder: &Path) -> io::Result<()> {
    File::open(folder)?.sync_all()
}

#[cfg(not(unix))]
fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}
