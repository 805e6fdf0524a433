//! Changes of registers alone: signed again, made for the first time, joined, taken over; and passports withdrawn.

use super::place;
use super::refused::FolderRefused;
use super::registers;
use super::stand::StandFolder;
use super::{Authority, Folder};
use crate::document::sha256_hex;
use crate::files::leftovers::is_lasting;
use crate::files::walk::Walk;
use crate::files::{self, FileError};
use crate::passport::Content;
use crate::register::draft::Draft;
use crate::register::{Doubt, Entry, FILE_NAME, RegisterRefused, State, VerifiedRegister};
use crate::text::{Kind, LARGEST_DOCUMENT_BYTES, first_few, misspelt, name_of, shown};
use jiff::civil::Date;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Renewal of the registers under a folder.
#[derive(Debug, Clone, Default)]
pub(crate) struct Renewal {
    /// Last day of freshness of the new registers (inclusive), or none; as before if `None`.
    pub fresh_until: Option<Option<Date>>,
    /// SHA-256 of passports that are not listed, and of registers whose key is no longer trusted, to take over.
    pub adopt: Vec<String>,
    /// Another register of the same stand, to be joined.
    pub with: Option<PathBuf>,
    /// Passports in lists of an earlier version that are withdrawn, each with its reason.
    pub withdrawn: Vec<(String, String)>,
    /// Passports in lists of an earlier version that are not withdrawn.
    pub not_withdrawn: Vec<String>,
    /// Folder of a workspace, which may have such lists.
    pub workspace: Option<PathBuf>,
}

/// New register of a stand, or the one that would be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Renewed {
    pub stand: String,
    pub sequence: u64,
    pub entries: Vec<Entry>,
    /// Conclusions for a person to read: entries that are new, or whose state is concluded; and what cannot be listed.
    pub conclusions: Vec<String>,
}

/// Reason why a renewal stops before anything is written.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NotRenewed {
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Folder(#[from] FolderRefused),
    /// Order that the folder does not permit, in words.
    #[error("{0}")]
    Rule(String),
    #[error("{}: found no passport and no register in this folder; check the path", shown(.0))]
    Empty(PathBuf),
}

impl NotRenewed {
    /// Returns `true` if a file or a folder cannot be used, `false` if a document was refused.
    pub(crate) fn is_unusable(&self) -> bool {
        match self {
            Self::File(_) | Self::Empty(_) => true,
            Self::Folder(refused) => refused.is_unusable(),
            _ => false,
        }
    }
}

impl Renewal {
    /// Signs every register under `root` again, and makes first ones where there are passports without any. Nothing is
    /// written without a signer of registers.
    ///
    /// # Errors
    /// Returns [`NotRenewed`]; registers of stands before the one that is refused were written.
    pub(crate) fn run(&self, root: &Path, authority: &Authority) -> Result<Vec<Renewed>, NotRenewed> {
        self.check_old_lists(root)?;
        let stands = place::stands(root)?;
        if stands.is_empty() {
            return Err(NotRenewed::Empty(root.to_owned()));
        }
        let mut adopted = BTreeSet::new();
        let mut prepared = Vec::new();
        let folders: Vec<Folder> = stands.iter().map(|(above, _)| Folder::new(above)).collect();
        for ((_, stand), folder) in stands.iter().zip(&folders) {
            prepared.push(self.prepare(folder, stand, authority, &mut adopted)?);
        }
        if let Some(sha256) = self.adopt.iter().find(|sha256| !adopted.contains(*sha256)) {
            return Err(NotRenewed::Rule(format!(
                "--adopt {sha256}: found no unlisted passport and no outdated register with this SHA-256 that a trusted key \
                 signed"
            )));
        }
        for (id, _) in &self.withdrawn {
            if !prepared.iter().flatten().any(|(_, draft, _)| draft.entry(id).is_some()) {
                return Err(not_listed(id, ""));
            }
        }
        let mut renewed = Vec::new();
        for (folder, draft, conclusions) in prepared.into_iter().flatten() {
            let (stand, sequence) = (folder.stand.clone(), draft.sequence());
            let entries = draft.entries().to_vec();
            folder.write(true, |new| Ok(new.take_from(draft)?))?;
            renewed.push(Renewed { stand, sequence, entries, conclusions });
        }
        Ok(renewed)
    }

    /// Returns the next register of a stand, not yet signed, or `None` if there is nothing to list.
    fn prepare<'a>(
        &self,
        folder: &'a Folder,
        stand: &str,
        authority: &'a Authority<'a>,
        adopted: &mut BTreeSet<String>,
    ) -> Result<Option<(StandFolder<'a>, Draft, Vec<String>)>, NotRenewed> {
        let (this, names) = StandFolder::listed(folder, stand, authority)?;
        let mut conclusions = Vec::new();
        let register = match names.iter().any(|name| name == FILE_NAME) {
            true => Some(self.current(&this, authority, adopted, &mut conclusions)?),
            false => {
                this.check_memory()?;
                None
            }
        };
        let is_first = register.is_none();
        let mut draft = Draft::after(register.as_ref(), stand, authority.issuer, authority.now());
        if let Some(other) = &self.with {
            let other = registers::read(other, authority.trust, authority.now()).map_err(FolderRefused::from)?;
            if other.header().stand == stand {
                draft.join(&other).map_err(FolderRefused::from)?;
                conclusions.push(format!(
                    "joined with register {} (SHA-256 {})",
                    other.header().sequence,
                    other.sha256()
                ));
            }
        }
        let listed: BTreeSet<&str> = draft.entries().iter().map(|entry| entry.sha256.as_str()).collect();
        let mut unlisted: Vec<(Content, String)> = names.iter().filter_map(|name| this.good(name)).collect();
        unlisted.retain(|(_, sha256)| !listed.contains(sha256.as_str()));
        let wanted = |sha256: &String| is_first || self.adopt.contains(sha256);
        for (content, sha256) in unlisted.iter().filter(|(_, sha256)| !wanted(sha256)) {
            conclusions.push(format!("not listed: {}; to take it over, add --adopt {sha256}", content.passport.id));
        }
        unlisted.retain(|(_, sha256)| wanted(sha256));
        adopted.extend(unlisted.iter().map(|(_, sha256)| sha256.clone()));
        // Predecessors before their successors, and the revisions of a site in ascending order.
        unlisted.sort_by_key(|(content, _)| (content.passport.issued_at, content.passport.revision));
        for (content, sha256) in &unlisted {
            let id = &content.passport.id;
            draft.add(Draft::entry_of(content, sha256)).map_err(FolderRefused::from)?;
            let from = content.passport.reissued_from.as_ref().filter(|_| content.passport.supersedes == Some(true));
            let moved = from.filter(|from| draft.entry(&from.id).is_some_and(|entry| entry.sha256 == from.sha256));
            if let Some(from) = moved {
                draft.supersede(&from.id, id, State::Moved).map_err(FolderRefused::from)?;
            }
        }
        for (id, reason) in &self.withdrawn {
            if draft.entry(id).is_some() {
                draft.withdraw(id, reason).map_err(FolderRefused::from)?;
            }
        }
        if let Some(last) = self.fresh_until {
            draft.fresh_until(last);
        }
        let words = |entry: &Entry| {
            let by = entry.by.as_deref().or(entry.reason.as_deref());
            format!("{}: {}{}", entry.id, entry.state.key(), by.map_or_else(String::new, |by| format!(" ({by})")))
        };
        if is_first || self.with.is_some() || !unlisted.is_empty() {
            conclusions.extend(draft.entries().iter().map(words));
        }
        if draft.entries().is_empty() {
            return Ok(None);
        }
        Ok(Some((this.with_register(register), draft, conclusions)))
    }

    /// Returns the register that is there. One whose key has expired or was revoked is taken over if that was asked for.
    fn current(
        &self,
        folder: &StandFolder,
        authority: &Authority,
        adopted: &mut BTreeSet<String>,
        conclusions: &mut Vec<String>,
    ) -> Result<VerifiedRegister, NotRenewed> {
        let path = folder.path.join(FILE_NAME);
        let refused = match folder.read_register() {
            Ok(register) => return Ok(register),
            Err(FolderRefused::Doubt(_, Doubt::Contradicted(_))) if self.with.is_some() => {
                let read = registers::read(&path, authority.trust, authority.now());
                return Ok(read.map_err(FolderRefused::from)?);
            }
            Err(refused) => refused,
        };
        let outdated = matches!(
            refused,
            FolderRefused::Register(RegisterRefused::KeyRevoked(_) | RegisterRefused::NotAuthorised(_))
        );
        let bytes = registers::bytes(&path).map_err(FolderRefused::from)?;
        let sha256 = sha256_hex(&bytes);
        match VerifiedRegister::take_over(&name_of(&path), &bytes, authority.trust) {
            Ok(register) if outdated && self.adopt.contains(&sha256) => {
                adopted.insert(sha256);
                let remembered = authority.memory.map(|memory| memory.path_of(&folder.stand));
                let remembered = remembered.and_then(|path| {
                    crate::register::Register::from_anyone(&name_of(&path), &registers::bytes(&path).ok()?).ok()
                });
                conclusions.push(format!("taken over: {refused}"));
                for entry in register.entries() {
                    let last =
                        remembered.as_ref().and_then(|last| last.passports.iter().find(|old| old.id == entry.id));
                    let last = last.map_or("not remembered", |last| last.state.key());
                    conclusions.push(format!("{}: {}, before: {last}", entry.id, entry.state.key()));
                }
                Ok(register)
            }
            Ok(_) if outdated => Err(NotRenewed::Rule(format!(
                "{refused}; if this is the last register, take it over with --adopt {sha256}; otherwise restore the last one \
                 from the backup"
            ))),
            _ => Err(refused.into()),
        }
    }

    /// Checks that every passport in lists of an earlier version is decided on. Nothing else in these lists is believed.
    fn check_old_lists(&self, root: &Path) -> Result<(), NotRenewed> {
        let beside = files::resolved(root).ok().and_then(|root| Some(root.parent()?.join("revocations")));
        let places = [Some(root.to_owned()), beside, self.workspace.clone()];
        let (mut files, mut undecided) = (Vec::new(), BTreeSet::new());
        let mut seen = BTreeSet::new();
        let mut bytes = Vec::new();
        for path in places.into_iter().flatten().flat_map(|place| Walk::deep(&place, is_lasting).files()) {
            if !seen.insert(path.canonicalize().unwrap_or_else(|_| path.clone())) {
                continue;
            }
            let read = files::read_into(&mut bytes, &path, LARGEST_DOCUMENT_BYTES);
            if read.is_err() || Kind::of(&bytes) != Some(Kind::RevocationList) {
                continue;
            }
            let ids: Vec<String> = ids_in_old_list(&String::from_utf8_lossy(&bytes));
            let is_decided = |id: &String| {
                self.not_withdrawn.contains(id) || self.withdrawn.iter().any(|(withdrawn, _)| withdrawn == id)
            };
            if !ids.iter().all(is_decided) {
                files.push(name_of(&path));
                undecided.extend(ids.into_iter().filter(|id| !is_decided(id)));
            }
        }
        match files.is_empty() {
            true => Ok(()),
            false => Err(NotRenewed::Rule(format!(
                "{}: withdraws {}, in a format of an earlier version; for each passport, add --withdrawn ID --reason TEXT or \
                 --not-withdrawn ID",
                files.join(", "),
                undecided.into_iter().collect::<Vec<_>>().join(", ")
            ))),
        }
    }
}

/// Returns the identifiers in a list of withdrawn passports of an earlier version (`dtg-revocation/1`).
fn ids_in_old_list(text: &str) -> Vec<String> {
    let entries = text.lines().filter_map(|line| line.trim_start().strip_prefix("- {id: \""));
    entries.filter_map(|rest| Some(rest.split_once('"')?.0.to_owned())).collect()
}

/// Withdrawal of listed passports, whatever is in their files.
#[derive(Debug, Clone)]
pub(crate) struct Withdrawal<'a> {
    /// Identifiers, or patterns of them.
    pub ids: &'a [String],
    pub reason: &'a str,
}

/// Passports of a stand that were withdrawn, or would be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Withdrawn {
    pub register: PathBuf,
    pub sequence: u64,
    pub ids: Vec<String>,
    /// Differences between the listed passports and the files at their paths, in words.
    pub alarms: Vec<String>,
}

impl Withdrawal<'_> {
    /// Withdraws the passports in the registers under `root`; each identifier and each pattern must be found. Nothing is
    /// written without a signer of registers.
    ///
    /// # Errors
    /// Returns [`NotRenewed`] before anything is written if a passport is not listed, or a register is not accepted.
    pub(crate) fn run(&self, root: &Path, authority: &Authority) -> Result<Vec<Withdrawn>, NotRenewed> {
        let folder = Folder::new(root);
        let mut stands = BTreeSet::new();
        for id in self.ids {
            let parts: Vec<&str> = id.split('/').collect();
            match parts.as_slice() {
                [model, serial, _, _] if !is_pattern(model) && !is_pattern(serial) => {
                    stands.insert(format!("{model}/{serial}"));
                }
                _ => stands.extend(place::stands(root)?.into_iter().map(|(_, stand)| stand)),
            }
        }
        stands.retain(|stand| folder.root().join(stand).join(FILE_NAME).symlink_metadata().is_ok());
        let mut missing: BTreeSet<&String> = self.ids.iter().collect();
        let (mut prepared, mut listed) = (Vec::new(), Vec::new());
        for stand in &stands {
            let this = StandFolder::open(&folder, stand, authority, |_| true)?;
            let mut draft = Draft::after(this.register.as_ref(), stand, authority.issuer, authority.now());
            listed.extend(draft.entries().iter().map(|entry| entry.id.clone()));
            let mut ids = Vec::new();
            for wanted in self.ids {
                let pattern = glob::Pattern::new(wanted).ok().filter(|_| is_pattern(wanted));
                let whole = glob::MatchOptions { require_literal_separator: true, ..glob::MatchOptions::new() };
                let fits = |entry: &&Entry| match &pattern {
                    Some(pattern) => pattern.matches_with(&entry.id, whole),
                    None => entry.id == *wanted,
                };
                // A run that was killed is completed by the same command.
                let is_done = |entry: &&Entry| {
                    entry.state == State::Withdrawn
                        && (pattern.is_some() || entry.reason.as_deref() == Some(self.reason))
                };
                let (done, found): (Vec<&Entry>, Vec<&Entry>) = draft.entries().iter().filter(fits).partition(is_done);
                if !(done.is_empty() && found.is_empty()) {
                    missing.remove(wanted);
                }
                let found: Vec<String> = found.into_iter().map(|entry| entry.id.clone()).collect();
                ids.extend(found.into_iter().filter(|id| !ids.contains(id)).collect::<Vec<_>>());
            }
            ids.iter().try_for_each(|id| draft.withdraw(id, self.reason)).map_err(FolderRefused::from)?;
            if !ids.is_empty() {
                prepared.push((this, draft.sequence(), ids));
            }
        }
        if let Some(id) = missing.into_iter().next() {
            return Err(not_listed(id, &nearest(&listed, id)));
        }
        let mut withdrawn = Vec::new();
        for (this, sequence, ids) in prepared {
            let alarms = ids.iter().filter_map(|id| difference(&this, id)).collect();
            this.write(false, |draft| Ok(ids.iter().try_for_each(|id| draft.withdraw(id, self.reason))?))?;
            withdrawn.push(Withdrawn { register: this.path.join(FILE_NAME), sequence, ids, alarms });
        }
        Ok(withdrawn)
    }
}

/// Returns the refusal of an order for a passport that no register lists.
fn not_listed(id: &str, more: &str) -> NotRenewed {
    NotRenewed::Rule(format!("{id}: no register lists this passport{more}"))
}

fn is_pattern(text: &str) -> bool {
    text.contains(['*', '?', '['])
}

/// Returns the nearest listed identifiers, as the end of a message; empty if none is near.
fn nearest(ids: &[String], id: &str) -> String {
    match (crate::text::scalar::latin(id), misspelt::name(ids, id, id.chars().count() / 3)) {
        (Some((_, odd)), _) => format!("; the {odd} only looks like a Latin letter"),
        (None, Some(nearest)) => format!("; {}", misspelt::question(nearest)),
        (None, None) if ids.is_empty() => "; specify the folder of passports with --passports".to_owned(),
        (None, None) => format!("; found {}", first_few(ids)),
    }
}

/// Returns how the file at the path of a listed passport differs from it, in words, or `None` if it does not.
fn difference(folder: &StandFolder, id: &str) -> Option<String> {
    let entry = folder.register.as_ref()?.entry(id)?;
    let path = folder.path_of_entry(entry);
    let found = match path.symlink_metadata() {
        Err(_) => "is missing".to_owned(),
        Ok(found) if found.is_symlink() => "is a link".to_owned(),
        Ok(_) => match files::read(&path, LARGEST_DOCUMENT_BYTES) {
            Ok(bytes) if sha256_hex(&bytes) == entry.sha256 => return None,
            Ok(_) => "is another file than the listed one".to_owned(),
            Err(error) => error.to_string(),
        },
    };
    Some(format!("{}: {found}; {id} was withdrawn as listed", shown(&path)))
}
