//! File access: files are read completely up to a limit, and written completely or not at all.
//!
//! * [`leftovers`]: temporary files that killed runs left behind.
//! * `platform`: operations that differ between Unix and Windows.
//! * [`together`]: several files, all or none.
//! * [`walk`]: the files under a folder.

pub(crate) mod leftovers;
mod platform;
pub(crate) mod together;
pub(crate) mod walk;

pub(crate) use platform::{is_closed_pipe, sync_folder, wait_for_turn};

use crate::text::{LARGEST_DOCUMENT_BYTES, Printable, large_file, misspelt, name_of, shown};
use std::collections::BTreeSet;
use std::fs::{self, File, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use tempfile::{NamedTempFile, PersistError};

/// Failure of a file operation.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// File that cannot be opened or read.
    #[error("{}: cannot be read: {}", shown(.0), Printable(reason_at(.0, .1)))]
    Read(PathBuf, io::Error),
    /// Folder found instead of a file.
    #[error("{}: found a folder, expected a file", shown(.0))]
    Folder(PathBuf),
    /// Pipe, device or socket, which its reader might wait for indefinitely.
    #[error("{}: found a pipe, a device or a socket, expected a file; save its output to a file first", shown(.0))]
    Special(PathBuf),
    /// File that exceeds this limit, in bytes.
    #[error("{}: more than {} bytes; {}", shown(.0), .1, large_file(&name_of(.0)))]
    TooLarge(PathBuf, usize),
    /// Existing file that is not replaced, or a link, wherever it leads.
    #[error("{}: {}", shown(path), why_not_replaced(path, *replaceable))]
    Exists {
        /// Path of the file.
        path: PathBuf,
        /// `true` if the file may be replaced when the user requests it.
        replaceable: bool,
    },
    /// Path that two options name for different files to be written.
    #[error("{}: is specified for two of the files to be written; give each its own name", shown(.0))]
    Twice(PathBuf),
    /// File that cannot be written.
    #[error("{}: cannot be written: {}; no file was left", shown(.0), Printable(reason_at(.0, .1)))]
    Write(PathBuf, io::Error),
}

impl FileError {
    /// Returns the message with what to do: the nearest existing path if there is no such file.
    pub(crate) fn with_nearest(&self) -> String {
        if let Self::Folder(_) = self {
            return format!("{self}; specify a file in it");
        }
        let nearest = if self.is_missing() { nearest(self.path()) } else { None };
        nearest.map_or_else(|| self.to_string(), |near| format!("{self}; {}", misspelt::question(shown(&near))))
    }

    pub(crate) fn is_missing(&self) -> bool {
        matches!(self, Self::Read(_, error) if error.kind() == io::ErrorKind::NotFound)
    }

    /// Returns `true` if neither the path nor a similar one exists.
    pub(crate) fn is_unlike_any(&self) -> bool {
        self.is_missing() && nearest(self.path()).is_none()
    }

    pub(crate) fn path(&self) -> &Path {
        match self {
            Self::Read(path, _)
            | Self::Folder(path)
            | Self::Special(path)
            | Self::TooLarge(path, _)
            | Self::Exists { path, .. }
            | Self::Twice(path)
            | Self::Write(path, _) => path,
        }
    }
}

/// Returns why an existing file is not replaced.
fn why_not_replaced(path: &Path, replaceable: bool) -> &'static str {
    match replaceable {
        _ if path.is_symlink() => "is a link, not overwritten; remove it, or specify a file that is not a link",
        true => "already exists, not overwritten; to replace it, use --force",
        false => "already exists, not overwritten",
    }
}

/// Number of names in a folder among which the nearest is looked for.
const MOST_NAMES: usize = 10_000;

/// Returns the existing path nearest to one that does not exist: one that differs in a few letters of one name, or
/// `None` if there is none.
fn nearest(path: &Path) -> Option<PathBuf> {
    let mut there = PathBuf::new();
    let mut parts = path.components();
    for part in parts.by_ref() {
        if there.join(part).symlink_metadata().is_ok() {
            there.push(part);
            continue;
        }
        let name = part.as_os_str().to_str()?;
        let entries = fs::read_dir(or_here(&there)).ok()?.take(MOST_NAMES);
        let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        // Of a name of one or two letters every other one is near.
        let length = name.chars().count();
        let most = if length < 3 { 0 } else { length / 6 + 1 };
        // Of equally near ones it is the last, such as the latest revision.
        let mut names: Vec<String> = names.collect();
        names.sort_unstable_by(|one, other| other.cmp(one));
        let nearest = misspelt::name(names, name, most)?;
        let found = there.join(nearest).join(parts.as_path());
        // Without a remainder, `join` would add a separator to the name of a file.
        let found: PathBuf = found.components().collect();
        return found.exists().then_some(found);
    }
    None
}

/// Returns the reason of a system error, in words for users who do not know its error numbers.
pub(crate) fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "no such file or folder".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        io::ErrorKind::NotADirectory => "a parent in this path is a file, not a folder".to_owned(),
        io::ErrorKind::StorageFull => "no space left on the disk".to_owned(),
        _ => error.to_string(),
    }
}

/// Returns the reason of a system error at `path`. Windows does not tell a path below a file from one that is absent.
fn reason_at(path: &Path, error: &io::Error) -> String {
    let above = || path.ancestors().skip(1).find(|above| above.is_file());
    match error.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => {
            above().map_or_else(|| reason(error), |file| format!("{} is a file, not a folder", shown(file)))
        }
        _ => reason(error),
    }
}

/// Reads a file of at most `limit` bytes; memory for a larger file is never used.
pub(crate) fn read(path: &Path, limit: usize) -> Result<Vec<u8>, FileError> {
    let mut bytes = Vec::new();
    read_into(&mut bytes, path, limit)?;
    Ok(bytes)
}

/// Reads a file as [`read`] does, but replaces the content of `bytes`, so that its memory can be reused for many files.
pub(crate) fn read_into(bytes: &mut Vec<u8>, path: &Path, limit: usize) -> Result<(), FileError> {
    read_first_into(bytes, path, limit + 1)?;
    if bytes.len() > limit {
        return Err(FileError::TooLarge(path.to_owned(), limit));
    }
    Ok(())
}

/// Reads the first `limit` bytes of a file, or all of it if it is shorter.
pub(crate) fn read_first(path: &Path, limit: usize) -> Result<Vec<u8>, FileError> {
    let mut bytes = Vec::new();
    read_first_into(&mut bytes, path, limit)?;
    Ok(bytes)
}

fn read_first_into(bytes: &mut Vec<u8>, path: &Path, limit: usize) -> Result<(), FileError> {
    let failed = |error| FileError::Read(path.to_owned(), error);
    let folder = || FileError::Folder(path.to_owned());
    let file = match platform::open(path) {
        // Windows does not open folders.
        Err(_) if path.is_dir() => return Err(folder()),
        opened => opened.map_err(failed)?,
    };
    let found = file.metadata().map_err(failed)?;
    if found.is_dir() {
        return Err(folder());
    }
    if !found.is_file() {
        return Err(FileError::Special(path.to_owned()));
    }
    // With one spare byte in the buffer, the end of the file is found without growing it.
    let length = usize::try_from(found.len()).unwrap_or(limit).min(limit);
    bytes.clear();
    bytes.reserve_exact(length.saturating_add(1));
    file.take(limit as u64).read_to_end(bytes).map_err(failed)?;
    Ok(())
}

/// Permission to read a new file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Access {
    /// Access for all users allowed by the umask.
    Shared,
    /// Access for the user only (mode 0600), for private keys.
    Private,
}

/// Durability of a new file after a power failure. Killing the program loses nothing in any variant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub(crate) enum Durability {
    /// Durable file and name.
    Named,
    /// Durable file; its name is durable after `sync_folder` has returned, which serves many files at once.
    NameLater,
    /// No durability until the system writes the file in its own time.
    None,
}

/// Number of attempts to write a file again after its temporary file was removed; even a second removal is unlikely.
const ATTEMPTS: usize = 4;

/// Writes a new file: to a temporary name in its folder, synced, renamed without replacing, and the folder synced, as far
/// as `durability` demands it. Missing folders are created.
pub(crate) fn write_new(path: &Path, bytes: &[u8], access: Access, durability: Durability) -> Result<(), FileError> {
    let persist = |temporary: NamedTempFile| temporary.persist_noclobber(path);
    write(path, bytes, access, durability, persist)
}

/// Replaces a file as a whole, or creates it: its old or its new content is there at every moment. A link is replaced, not
/// followed.
pub(crate) fn replace(path: &Path, bytes: &[u8], durability: Durability) -> Result<(), FileError> {
    let persist = |temporary: NamedTempFile| temporary.persist(path);
    write(path, bytes, Access::Shared, durability, persist)
}

/// Checks that no file is in the way of [`write_replaceable`], so that none of several is written if one cannot be.
///
/// # Errors
/// Returns [`FileError::Folder`]; [`FileError::Exists`] without `force`, for a link, or for a file that is never replaced.
pub(crate) fn check_replaceable<P: AsRef<Path>>(
    paths: impl IntoIterator<Item = P>,
    force: bool,
) -> Result<(), FileError> {
    for path in paths {
        let path = path.as_ref().to_owned();
        if path.is_dir() {
            return Err(FileError::Folder(path));
        }
        if let Ok(there) = path.symlink_metadata() {
            let replaceable = there.is_file() && !(force && is_irreplaceable(&path));
            if !(force && replaceable) {
                return Err(FileError::Exists { path, replaceable });
            }
        }
    }
    Ok(())
}

/// Checks that no two of the `paths` to be written are the same, because the last one would replace the others.
pub(crate) fn check_distinct<'a>(paths: impl IntoIterator<Item = &'a PathBuf>) -> Result<(), FileError> {
    let mut seen = BTreeSet::new();
    for path in paths {
        let whole = std::path::absolute(path).unwrap_or_else(|_| path.clone());
        if !seen.insert(whole) {
            return Err(FileError::Twice(path.clone()));
        }
    }
    Ok(())
}

/// Writes a file as [`write_new`] does, and replaces an existing file if `force` is set.
///
/// Passports, registers and private keys are never replaced. Nor is anything but a regular file,
/// because renaming a new file to the name of a device or of a link would remove it.
pub(crate) fn write_replaceable(path: &Path, bytes: &[u8], force: bool) -> Result<(), FileError> {
    check_replaceable([path], force)?;
    if force {
        return replace(path, bytes, Durability::Named);
    }
    write_new(path, bytes, Access::Shared, Durability::Named).map_err(|error| match error {
        FileError::Exists { path, .. } => FileError::Exists { path, replaceable: true },
        error => error,
    })
}

/// Returns `true` if a file is a passport, a register or a private key, by its content.
fn is_irreplaceable(path: &Path) -> bool {
    const DOCUMENTS: [&[u8]; 2] = [b"format: \"dtg-passport/", b"format: \"dtg-register/"];
    let bytes = read_first(path, LARGEST_DOCUMENT_BYTES).unwrap_or_default();
    let mut lines = bytes.split(|&byte| byte == b'\n');
    let key = lines.clone().next().is_some_and(|line| line.trim_ascii_end().ends_with(b"PRIVATE KEY-----"));
    key || lines.any(|line| DOCUMENTS.iter().any(|format| line.starts_with(format)))
}

/// Returns a path without links and relative parts, as people write it: on Windows without the prefix `\\?\`.
pub(crate) fn resolved(path: &Path) -> io::Result<PathBuf> {
    let path = path.canonicalize()?;
    let plain = path.to_str().and_then(|path| path.strip_prefix(r"\\?\").filter(|rest| !rest.starts_with("UNC")));
    Ok(plain.map_or_else(|| path.clone(), PathBuf::from))
}

/// Replaces the content of a file, or creates it. Its permissions are kept; for a link, the target is replaced.
///
/// # Errors
/// Returns [`FileError::Write`], also if the path is not a regular file; the content is then unchanged.
pub(crate) fn rewrite(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let permissions = match fs::metadata(&target) {
        Ok(found) if !found.is_file() => {
            return Err(FileError::Write(path.to_owned(), io::Error::other("not a regular file")));
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
    write(&target, bytes, Access::Shared, Durability::Named, persist)
}

fn write(
    path: &Path,
    bytes: &[u8],
    access: Access,
    durability: Durability,
    persist: impl Fn(NamedTempFile) -> Result<File, PersistError>,
) -> Result<(), FileError> {
    let failed = |error| FileError::Write(path.to_owned(), error);
    let folder = folder_of(path);
    for attempt in 0.. {
        let written = temporary(folder, bytes, access, durability).and_then(|file| Ok(persist(file)?));
        match written {
            Ok(_) => break,
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                return Err(FileError::Exists { path: path.to_owned(), replaceable: false });
            }
            // Only the first of many files finds its folder missing.
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

pub(crate) fn folder_of(path: &Path) -> &Path {
    path.parent().map_or(Path::new("."), or_here)
}

/// Returns the current folder for an empty path, which is how the parent of a relative path may end.
pub(crate) fn or_here(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

/// Creates a folder and its missing parents, and syncs the name of each.
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

/// Creates a complete file under a temporary name, synced unless `durability` is [`Durability::None`].
///
/// The file is locked while it has that name, so that other runs can distinguish it from a leftover of a killed run.
fn temporary(folder: &Path, bytes: &[u8], access: Access, durability: Durability) -> io::Result<NamedTempFile> {
    let mut temporary = builder(access).tempfile_in(folder)?;
    match temporary.as_file().try_lock() {
        // Another run has just taken this file for a leftover.
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

/// Returns `true` if the error means that the temporary file is gone. Another run may take it for a leftover between
/// creation and lock, or on a file system whose locks do not work between machines.
fn taken_away(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::StaleNetworkFileHandle)
}

/// Returns a builder of temporary files whose names identify this program, so that leftovers can be recognised.
fn builder(access: Access) -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(leftovers::PREFIX).suffix(leftovers::SUFFIX);
    if access == Access::Shared {
        platform::readable_by_all(&mut builder);
    }
    builder
}
