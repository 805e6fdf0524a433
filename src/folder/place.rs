//! Places in a folder of passports: `<model>/<serial>/<site id>-<revision>.yaml`.

use crate::document::sha256_hex;
use crate::files::walk::{Entry, Walk};
use crate::files::{self, FileError};
use crate::passport::{Content, content_from_anyone};
use crate::register::FILE_NAME;
use crate::text::scalar::identifiers;
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of};
use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Returns the name of the passport for a site.
pub(super) fn file_name(site: &str, revision: u32) -> String {
    format!("{site}-{revision}.yaml")
}

/// Returns the name and the number in `<name>-<number>.yaml`, 0 for a number that no revision has, or `None` if the name has
/// another form.
pub(crate) fn numbered(name: &OsStr) -> Option<(&str, u32)> {
    let (name, number) = name.to_str()?.strip_suffix(".yaml")?.rsplit_once('-')?;
    let is_number = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then(|| (name, number.parse().unwrap_or(0)))
}

/// Returns the path of a listed passport in a folder of passports, with slashes.
pub(super) fn path_of_id(id: &str) -> String {
    let (series, revision) = id.rsplit_once('/').unwrap_or((id, ""));
    format!("{series}-{revision}.yaml")
}

/// Returns `true` if a file is at the place `due`, a path with slashes, as far as its path shows.
pub(super) fn is_in_place(path: &Path, due: &str) -> bool {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let names: Vec<_> = whole.iter().rev().take(3).map(|name| name.to_string_lossy()).collect();
    due.split('/').rev().zip(&names).all(|(due, name)| due == name)
}

/// Returns the stand whose folder a path is, `<model>/<serial>`, by its last two names.
pub(super) fn stand_of(folder: &Path) -> Option<String> {
    let folder = folder.canonicalize().ok()?;
    let mut names = folder.iter().rev().map(|name| name.to_str());
    let (serial, model) = (names.next()??, names.next()??);
    Some(format!("{model}/{serial}"))
}

/// Returns the stands with a folder under `root` in which there is a register or a file named like a passport, each with
/// the root of its folder of passports.
///
/// # Errors
/// Returns [`FileError`] if a folder cannot be read.
pub(crate) fn stands(root: &Path) -> Result<Vec<(PathBuf, String)>, FileError> {
    let mut found = BTreeSet::new();
    for entry in Walk::deep(root, |name| name == FILE_NAME || numbered(name).is_some()) {
        let (Entry::File(path) | Entry::Link(path)) = entry? else { continue };
        let folder = files::folder_of(&path);
        if let Some(stand) = stand_of(folder)
            && identifiers::<2>(&stand).is_some()
        {
            let levels = folder.ancestors().nth(2).map(Path::to_owned);
            let above = if folder.iter().count() > 2 { levels } else { None };
            let above = above.or_else(|| files::resolved(folder).ok()?.ancestors().nth(2).map(Path::to_owned));
            found.extend(above.map(|above| (above, stand)));
        }
    }
    Ok(found.into_iter().collect())
}

/// Returns the names in a folder that are UTF-8; none if there is no such folder. A file in its place is reported when a
/// passport in it is looked up.
pub(super) fn names(folder: &Path) -> Result<Vec<String>, FileError> {
    let names = |entries: fs::ReadDir| {
        let names = entries.map(|entry| Ok(entry?.file_name().into_string().ok()));
        names.filter_map(Result::transpose).collect()
    };
    match fs::read_dir(folder) {
        Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => Ok(Vec::new()),
        entries => entries.and_then(names).map_err(|error| FileError::Read(folder.to_owned(), error)),
    }
}

/// Returns the content of the file at a path if it has this SHA-256, which a register lists.
pub(crate) fn listed_content(path: &Path, sha256: &str) -> Option<Content> {
    let bytes = files::read(path, LARGEST_DOCUMENT_BYTES).ok().filter(|bytes| sha256_hex(bytes) == sha256)?;
    content_from_anyone(&name_of(path), &bytes).ok()
}
