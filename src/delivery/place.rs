//! Names of the members of a delivery.

use crate::folder::place::numbered;
use crate::register::FILE_NAME;
use crate::text::Identifier;
use std::ffi::OsStr;

/// Folder of passports in an archive, as in a workspace.
pub(super) const PASSPORTS: &str = "passports";

/// Page that says what to do first.
pub(super) const PAGE: &str = "START-HERE.html";

/// Public keys, for people: a reader takes them from the signatures.
pub(super) const KEYS: &str = "signing_keys.pub";

/// What a member of an archive is by its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Member {
    /// Register of a stand, `<model>/<serial>`.
    Register(String),
    /// Passport of a stand, with its name.
    Passport(String, String),
    /// Folder, or file for people, of which nothing is taken.
    Other,
}

/// Returns what has this name, or `None` if nothing in a delivery has it.
pub(super) fn place_of(name: &str) -> Option<Member> {
    if [PAGE, KEYS].contains(&name) {
        return Some(Member::Other);
    }
    let names: Vec<&str> = name.strip_suffix('/').unwrap_or(name).split('/').collect();
    let (first, inner) = names.split_first()?;
    let is_good = *first == PASSPORTS && inner.iter().all(|name| Identifier::new(name).is_ok());
    match *inner {
        _ if !is_good => None,
        [] | [_] | [_, _] if name.ends_with('/') => Some(Member::Other),
        [model, serial, FILE_NAME] if !name.ends_with('/') => Some(Member::Register(format!("{model}/{serial}"))),
        [model, serial, file] if !name.ends_with('/') && numbered(OsStr::new(file)).is_some() => {
            Some(Member::Passport(format!("{model}/{serial}"), file.to_owned()))
        }
        _ => None,
    }
}

/// Returns the name of a file of a stand in an archive.
pub(super) fn name_of(stand: &str, file: &str) -> String {
    format!("{PASSPORTS}/{stand}/{file}")
}
