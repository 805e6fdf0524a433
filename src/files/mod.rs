//! Files: read whole and not too large, written whole or not at all.
//!
//! * [`leftovers`]: temporary files that a killed run left behind.
//! * [`walk`]: the files under a folder.

pub(crate) mod leftovers;
pub(crate) mod walk;

use crate::text::{LARGEST_DOCUMENT_BYTES, Printable, shown};
use std::fs::{self, File, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use tempfile::{NamedTempFile, PersistError};

/// What a file operation could not do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// It cannot be opened or read.
    #[error("{}: cannot be read: {}", shown(path), Printable(reason(error)))]
    Read {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// It is a folder.
    #[error("{}: is a folder, expected a file", shown(path))]
    Folder {
        /// Which.
        path: PathBuf,
    },
    /// It is a pipe, a device or a socket: its reader might wait for ever.
    #[error("{}: found a pipe, a device or a socket, expected a file; save its output to a file first", shown(path))]
    Special {
        /// Which.
        path: PathBuf,
    },
    /// It is larger than any such file can be.
    #[error("{}: more than {limit} bytes; check that this is the right file", shown(path))]
    TooLarge {
        /// Which file.
        path: PathBuf,
        /// The limit in bytes.
        limit: usize,
    },
    /// It exists, and is not replaced.
    #[error("{}: already exists, not overwritten{}", shown(path), if *replaceable { "; to replace it, use --force" } else { "" })]
    Exists {
        /// Which file.
        path: PathBuf,
        /// Whether it may be replaced when the user says so.
        replaceable: bool,
    },
    /// It cannot be written.
    #[error("{}: cannot be written: {}; no file was left", shown(path), Printable(reason(error)))]
    Write {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
}

impl FileError {
    /// Which file.
    pub(crate) fn path(&self) -> &Path {
        match self {
            Self::Read { path, .. }
            | Self::Folder { path }
            | Self::Special { path }
            | Self::TooLarge { path, .. }
            | Self::Exists { path, .. }
            | Self::Write { path, .. } => path,
        }
    }
}

/// What the system says, in words for those who do not know its error numbers.
pub(crate) fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "no such file or folder".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        io::ErrorKind::NotADirectory => "a parent in this path is a file, not a folder".to_owned(),
        io::ErrorKind::StorageFull => "no space left on the disk".to_owned(),
        _ => error.to_string(),
    }
}

/// Reads a file of at most `limit` bytes; no more than that is ever held.
///
/// # Errors
/// [`FileError::Read`], [`FileError::Folder`], [`FileError::Special`], [`FileError::TooLarge`].
pub(crate) fn read(path: &Path, limit: usize) -> Result<Vec<u8>, FileError> {
    let mut bytes = Vec::new();
    read_into(&mut bytes, path, limit)?;
    Ok(bytes)
}

/// The same into `bytes`, in place of what they were: the memory of one file serves the next.
///
/// # Errors
/// As [`read`].
pub(crate) fn read_into(bytes: &mut Vec<u8>, path: &Path, limit: usize) -> Result<(), FileError> {
    read_first_into(bytes, path, limit + 1)?;
    if bytes.len() > limit {
        return Err(FileError::TooLarge { path: path.to_owned(), limit });
    }
    Ok(())
}

/// The first `limit` bytes of a file, or all of it when it is shorter.
///
/// # Errors
/// [`FileError::Read`], [`FileError::Folder`], [`FileError::Special`].
pub(crate) fn read_first(path: &Path, limit: usize) -> Result<Vec<u8>, FileError> {
    let mut bytes = Vec::new();
    read_first_into(&mut bytes, path, limit)?;
    Ok(bytes)
}

fn read_first_into(bytes: &mut Vec<u8>, path: &Path, limit: usize) -> Result<(), FileError> {
    let failed = |error| FileError::Read { path: path.to_owned(), error };
    let file = open(path).map_err(failed)?;
    let found = file.metadata().map_err(failed)?;
    if found.is_dir() {
        return Err(FileError::Folder { path: path.to_owned() });
    }
    if !found.is_file() {
        return Err(FileError::Special { path: path.to_owned() });
    }
    // With one byte more than there are, the end is seen without another look.
    let length = usize::try_from(found.len()).unwrap_or(limit).min(limit);
    bytes.clear();
    bytes.reserve_exact(length.saturating_add(1));
    file.take(limit as u64).read_to_end(bytes).map_err(failed)?;
    Ok(())
}

/// Opens a file without waiting: a pipe that nobody writes to would keep its reader for ever. The opened file
/// itself tells afterwards what it is, so that nothing can be exchanged in between.
#[cfg(unix)]
fn open(path: &Path) -> io::Result<File> {
    use rustix::fs::OFlags;
    use std::os::unix::fs::OpenOptionsExt;
    let flags = OFlags::NONBLOCK | OFlags::NOCTTY;
    File::options().read(true).custom_flags(flags.bits().cast_signed()).open(path)
}

/// Opens a file.
#[cfg(not(unix))]
fn open(path: &Path) -> io::Result<File> {
    File::open(path)
}

/// Who may read a new file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Access {
    /// Everybody whom the user's umask lets.
    Shared,
    /// The user alone (mode 0600): private keys.
    Private,
}

/// What of a new file is safe from a loss of power once it has been written. To kill the program loses nothing of any.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Durability {
    /// The file, under its name.
    Named,
    /// The file; its name once `sync_folder` has come back, which then does for many files.
    NameLater,
    /// Nothing, until the system has written it in its own time.
    None,
}

/// How often a file is written anew whose temporary name somebody took away. A second time is bad luck already.
const ATTEMPTS: usize = 4;

/// Writes a new file: to a temporary name beside it, synced, renamed without replacing, the folder synced.
///
/// Missing folders are made.
///
/// # Errors
/// [`FileError::Exists`] when something of that name is there, [`FileError::Write`].
pub(crate) fn write_new(path: &Path, bytes: &[u8], access: Access) -> Result<(), FileError> {
    write_new_as(path, bytes, access, Durability::Named)
}

/// The same, as safe from a loss of power as `durability` says.
///
/// # Errors
/// As [`write_new`].
pub(crate) fn write_new_as(path: &Path, bytes: &[u8], access: Access, durability: Durability) -> Result<(), FileError> {
    let persist = |temporary: NamedTempFile| temporary.persist_noclobber(path);
    write(path, bytes, access, durability, persist, false)
}

/// The same, replacing a file that is there when `force` says so. Passports, lists of withdrawn ones and private keys stay;
/// so does all that is no file: a new file renamed to the name of a device would take its place.
///
/// # Errors
/// As [`write_new`].
pub(crate) fn write_replaceable(path: &Path, bytes: &[u8], force: bool) -> Result<(), FileError> {
    if path.metadata().is_ok_and(|there| !there.is_file()) || (force && is_irreplaceable(path)) {
        return Err(FileError::Exists { path: path.to_owned(), replaceable: false });
    }
    let persist = |temporary: NamedTempFile| match force {
        true => temporary.persist(path),
        false => temporary.persist_noclobber(path),
    };
    write(path, bytes, Access::Shared, Durability::Named, persist, true)
}

/// Whether a file is a passport, a list of withdrawn ones or a private key, by its content.
fn is_irreplaceable(path: &Path) -> bool {
    const DOCUMENTS: [&[u8]; 2] = [b"format: \"dtg-passport/", b"format: \"dtg-revocation/"];
    let bytes = read_first(path, LARGEST_DOCUMENT_BYTES).unwrap_or_default();
    let mut lines = bytes.split(|&byte| byte == b'\n');
    let key = lines.clone().next().is_some_and(|line| line.trim_ascii_end().ends_with(b"PRIVATE KEY-----"));
    key || lines.any(|line| DOCUMENTS.iter().any(|format| line.starts_with(format)))
}

/// Replaces the content of a file, or makes it. Its permissions stay as they were; through a link, the file that it leads
/// to is replaced.
///
/// # Errors
/// [`FileError::Write`], also for what is no regular file; the old content is then as it was.
pub(crate) fn rewrite(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let permissions = match fs::metadata(&target) {
        Ok(found) if !found.is_file() => {
            let error = io::Error::other("not a regular file");
            return Err(FileError::Write { path: path.to_owned(), error });
        }
        found => found.ok().map(|found| found.permissions()),
    };
    let persist = |temporary: NamedTempFile| {
        let kept = permissions.clone().map_or(Ok(()), |kept| temporary.as_file().set_permissions(kept));
        match kept {
            Ok(()) => temporary.persist(&target),
            Err(error) => Err(PersistError { error, file: temporary }),
        }
    };
    write(&target, bytes, Access::Shared, Durability::Named, persist, true)
}

/// Waits until no other run has its turn in a folder; the turn ends when what is returned is dropped. `None` where the
/// file system knows no locks of folders.
pub(crate) fn wait_for_turn(folder: &Path) -> Option<File> {
    File::open(folder).ok().filter(|folder| folder.lock().is_ok())
}

fn write(
    path: &Path,
    bytes: &[u8],
    access: Access,
    durability: Durability,
    persist: impl Fn(NamedTempFile) -> Result<File, PersistError>,
    replaceable: bool,
) -> Result<(), FileError> {
    let failed = |error| FileError::Write { path: path.to_owned(), error };
    let folder = folder_of(path);
    for attempt in 0.. {
        let written = temporary(folder, bytes, access, durability).and_then(|file| Ok(persist(file)?));
        match written {
            Ok(_) => break,
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                return Err(FileError::Exists { path: path.to_owned(), replaceable });
            }
            // Of many files only the first finds its folder missing.
            Err(error) if attempt == 0 && error.kind() == io::ErrorKind::NotFound => {
                make_folder(folder, durability).map_err(failed)?;
            }
            Err(error) if taken_away(&error) && attempt < ATTEMPTS && folder.is_dir() => {}
            Err(error) => return Err(failed(error)),
        }
    }
    match durability {
        Durability::Named => sync_folder(folder).map_err(failed),
        Durability::NameLater | Durability::None => Ok(()),
    }
}

/// The folder that a file is in.
pub(crate) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Makes a folder and those above it that are missing, each safe under its name.
fn make_folder(folder: &Path, durability: Durability) -> io::Result<()> {
    let made = match fs::create_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            make_folder(folder_of(folder), durability)?;
            fs::create_dir(folder)
        }
        made => made,
    };
    match made {
        Ok(()) if durability == Durability::None => Ok(()),
        Ok(()) => sync_folder(folder_of(folder)),
        Err(_) if folder.is_dir() => Ok(()),
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Err(io::ErrorKind::NotADirectory.into()),
        Err(error) => Err(error),
    }
}

/// A file under a temporary name, complete, and synced unless that is not wanted.
///
/// While it has that name it is locked: by this another run knows it from one that a killed run left behind.
fn temporary(folder: &Path, bytes: &[u8], access: Access, durability: Durability) -> io::Result<NamedTempFile> {
    let mut temporary = builder(access).tempfile_in(folder)?;
    match temporary.as_file().try_lock() {
        // Another run has just taken it for a leftover.
        Err(TryLockError::WouldBlock) => return Err(io::ErrorKind::NotFound.into()),
        // A file system without locks: see `leftovers`.
        Ok(()) | Err(TryLockError::Error(_)) => {}
    }
    temporary.write_all(bytes)?;
    if durability != Durability::None {
        temporary.as_file().sync_all()?;
    }
    Ok(temporary)
}

/// Whether the temporary file is gone: between its making and its lock, or on a file system whose locks do not reach
/// over machines, another run may take it for a leftover.
fn taken_away(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::StaleNetworkFileHandle)
}

/// A temporary file's name says whose it is, so that a leftover can be recognised.
fn builder(access: Access) -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(leftovers::PREFIX).suffix(leftovers::SUFFIX);
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

/// Makes the names in a folder safe from a loss of power.
///
/// # Errors
/// What the system says.
#[cfg(unix)]
pub(crate) fn sync_folder(folder: &Path) -> io::Result<()> {
    File::open(folder)?.sync_all()
}

/// Elsewhere the system sees to that.
///
/// # Errors
/// None.
#[cfg(not(unix))]
pub fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}
