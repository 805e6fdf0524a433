//! What a folder holds: passports, lists of withdrawn ones, links.

use crate::files::walk::{Entry, Walk};
use crate::files::{self, FileError};
use crate::passport::Trust;
use crate::register::Alarm;
use crate::revocation::{RevocationList, Series};
use crate::text::LARGEST_DOCUMENT_BYTES;
use jiff::Timestamp;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// What a folder holds that a register reads.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Found {
    /// Files named as passports are, `<site id>-<revision>.yaml`, sorted.
    pub passports: Vec<PathBuf>,
    /// Files named `revocation-<sequence>.yaml`, sorted.
    pub revocation_lists: Vec<PathBuf>,
    /// Links: they may lead out of the folder, and were not followed.
    pub links: Vec<PathBuf>,
}

/// Finds the passports and revocation lists under `root`, at any depth; links are not followed.
///
/// # Errors
/// [`FileError::Read`] for a folder that cannot be read.
pub fn find(root: &Path) -> Result<Found, FileError> {
    let mut found = Found::default();
    for entry in Walk::deep(root, is_numbered) {
        match entry? {
            Entry::Link(path) => found.links.push(path),
            Entry::File(path) if is_revocation_list(&path) => found.revocation_lists.push(path),
            Entry::File(path) => found.passports.push(path),
        }
    }
    Ok(found)
}

/// Takes the revocation lists of a folder into account: of them and the one that is trusted already the newest counts.
/// Gives what a person should look at.
///
/// # Errors
/// A list that cannot be read.
pub fn withdraw(lists: &[PathBuf], trust: &mut Trust, time: Timestamp) -> Result<Vec<Alarm>, FileError> {
    let mut good: Vec<RevocationList> = trust.withdrawn.take().into_iter().collect();
    let mut alarms = Vec::new();
    for path in lists {
        let name = path.display().to_string();
        let bytes = files::read(path, LARGEST_DOCUMENT_BYTES)?;
        match RevocationList::verify(&name, &bytes, &trust.signers, &trust.revoked, time) {
            Ok(list) => good.push(list),
            Err(error) => alarms.push(Alarm::revocation(error.to_string(), &name)),
        }
    }
    let series = Series::of(good);
    alarms.extend(series.alarms.into_iter().map(|words| Alarm::revocation(words, "")));
    trust.withdrawn = series.newest;
    Ok(alarms)
}

/// Whether a file is named as passports and revocation lists are, `<name>-<number>.yaml`.
pub fn is_numbered(name: &OsStr) -> bool {
    numbered(name).is_some()
}

/// Whether it is named as a revocation list is, `revocation-<sequence>.yaml`.
pub fn is_revocation_list(path: &Path) -> bool {
    path.file_name().and_then(numbered) == Some("revocation")
}

/// What stands before the number in `<name>-<number>.yaml`.
fn numbered(name: &OsStr) -> Option<&str> {
    let (name, number) = name.to_str()?.strip_suffix(".yaml")?.rsplit_once('-')?;
    (!number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())).then_some(name)
}
