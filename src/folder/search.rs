//! What a folder holds that a register reads, and the register of it.

use crate::files::walk::{Entry, Walk};
use crate::files::{self, FileError};
use crate::parallel;
use crate::passport::{Question, Trust};
use crate::register::{Alarm, Register, examine};
use crate::revocation::{RevocationList, Series, claims_to_be_a_list};
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of};
use jiff::Timestamp;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// What a folder holds that a register reads.
#[derive(Debug, Default)]
pub struct Found {
    /// Files named as passports are, `<site id>-<revision>.yaml`, sorted.
    pub passports: Vec<PathBuf>,
    /// Files named `revocation-<sequence>.yaml`, sorted.
    pub revocation_lists: Vec<PathBuf>,
    /// Links to folders, or named so: they may lead out of the folder, and were not followed.
    pub links: Vec<PathBuf>,
    /// Pipes, devices and sockets named so: to open one may wait for ever.
    pub special: Vec<PathBuf>,
    /// Folders below that cannot be read, and why.
    pub unreadable: Vec<FileError>,
}

/// Finds the passports and revocation lists under `root`, at any depth; links are not followed.
///
/// # Errors
/// [`FileError::Read`] when `root` cannot be read; of a folder below it is told in what is found.
pub fn find(root: &Path) -> Result<Found, FileError> {
    let mut found = Found::default();
    for entry in Walk::deep(root, is_numbered) {
        match entry {
            Ok(Entry::Link(path)) => found.links.push(path),
            Ok(Entry::Special(path)) => found.special.push(path),
            Ok(Entry::File(path)) if is_revocation_list(&path) => found.revocation_lists.push(path),
            Ok(Entry::File(path)) => found.passports.push(path),
            Err(error) if error.path() == root => return Err(error),
            Err(error) => found.unreadable.push(error),
        }
    }
    Ok(found)
}

/// What the files named as revocation lists are say, when taken into account.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Withdrawn {
    /// What a person should look at.
    pub alarms: Vec<Alarm>,
    /// Files that are no lists: a site may be called so.
    pub no_lists: Vec<PathBuf>,
}

/// Takes the revocation lists of a folder into account: of them and the one that is trusted already the newest counts.
pub fn withdraw(lists: &[PathBuf], trust: &mut Trust, time: Timestamp) -> Withdrawn {
    let mut good: Vec<RevocationList> = trust.withdrawn.take().into_iter().collect();
    let mut withdrawn = Withdrawn::default();
    for path in lists {
        let name = name_of(path);
        match files::read(path, LARGEST_DOCUMENT_BYTES) {
            Ok(bytes) if !claims_to_be_a_list(&bytes) => withdrawn.no_lists.push(path.clone()),
            Ok(bytes) => match RevocationList::verify(&name, &bytes, &trust.signers, &trust.revoked, time) {
                Ok(list) => {
                    if path.file_name().is_none_or(|name| *name != *list.file_name()) {
                        withdrawn.alarms.push(Alarm::misnamed_list(&list, &name));
                    }
                    good.push(list);
                }
                Err(error) => withdrawn.alarms.push(Alarm::refused_list(&error, &name)),
            },
            Err(error) => withdrawn.alarms.push(unreadable(&error)),
        }
    }
    let series = Series::of(good);
    withdrawn.alarms.extend(series.alarms.into_iter().map(Alarm::series));
    trust.withdrawn = series.newest;
    withdrawn
}

/// The register of a folder: its revocation lists first, then every passport. The trust that comes back knows what those
/// lists withdraw. So many threads do the work.
///
/// # Errors
/// [`FileError::Read`] when `root` cannot be read; one file or folder below it hides none of the others.
pub fn register(
    root: &Path,
    mut trust: Trust,
    question: &Question,
    within_days: Option<u32>,
    threads: usize,
) -> Result<(Register, Trust), FileError> {
    let found = find(root)?;
    let name = |path: &Path| name_of(path);
    let mut alarms: Vec<Alarm> = found.unreadable.iter().map(unreadable).collect();
    alarms.extend(found.links.iter().map(|path| Alarm::link(&name(path))));
    alarms.extend(found.special.iter().map(|path| Alarm::special(&name(path))));
    let withdrawn = withdraw(&found.revocation_lists, &mut trust, question.time);
    alarms.extend(withdrawn.alarms);
    let passports: Vec<PathBuf> = found.passports.into_iter().chain(withdrawn.no_lists).collect();
    let read = parallel::map_with(&passports, threads, Vec::new, |bytes, path| {
        files::read_into(bytes, path, LARGEST_DOCUMENT_BYTES)?;
        Ok(examine(&name(path), bytes, &trust, question.time, within_days))
    });
    let mut examined = Vec::with_capacity(passports.len());
    for file in read {
        match file {
            Ok(file) => examined.push(file),
            Err(error) => alarms.push(unreadable(&error)),
        }
    }
    Ok((Register::of(examined, alarms), trust))
}

fn unreadable(error: &FileError) -> Alarm {
    match error {
        FileError::TooLarge { path, .. } => Alarm::too_large(&name_of(path)),
        FileError::Read { path, error } => {
            Alarm::unreadable(&format!("cannot be read: {}", files::reason(error)), &name_of(path))
        }
        other => Alarm::unreadable(&other.to_string(), ""),
    }
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
