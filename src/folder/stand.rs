//! Folder of one stand, listed and examined once: its names, its register, and what a command adds to it.
//!
//! A command decides on this snapshot. It then writes its passports, and last one new register that lists them all. If it is
//! killed in between, the passports are there but not listed, and so do not count; the same command again lists them.

use super::place::{self, file_name, numbered};
use super::refused::FolderRefused;
use super::registers::{self, Found};
use super::{Authority, Existing, Folder, Issued, Next, Sealed};
use crate::document::sha256_hex;
use crate::files::{self, Access, Durability, FileError, or_here};
use crate::passport::checks::for_the_issuer;
use crate::passport::issue::{Draft as Passport, Issue, PreparedStand};
use crate::passport::reissue::Successor;
use crate::passport::{Content, Question, verify};
use crate::register::draft::Draft;
use crate::register::{Doubt, Entry, FILE_NAME, NoRegister, RegisterRefused, State, VerifiedRegister};
use crate::site::Site;
use crate::text::{LARGEST_DOCUMENT_BYTES, first_few, name_of, shown};
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Name of the file that is locked while a register is replaced.
const LOCK_NAME: &str = ".register.lock";

/// Time to wait for another run that replaces the register.
const LONGEST_WAIT: Duration = Duration::from_secs(30);
const WAIT: Duration = Duration::from_millis(20);

/// Number of folders of a passport: `<model>/<serial>` and the root.
const FOLDERS: usize = 3;

/// Number of times that an order is tried; each retry means that another run has just written a passport.
const ATTEMPTS: usize = 8;

pub(crate) struct StandFolder<'a> {
    authority: &'a Authority<'a>,
    folder: &'a Folder,
    /// Stand, `<model>/<serial>`.
    pub stand: String,
    pub path: PathBuf,
    pub register: Option<VerifiedRegister>,
    /// Sites by their lower-case names, each with its spelling and its last revision.
    sites: Mutex<BTreeMap<String, (String, u32)>>,
    /// Entries to add to the register, by their ids.
    listings: Mutex<BTreeMap<String, Listing>>,
}

/// Entry to add to a register, and the passport that it supersedes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Listing {
    entry: Entry,
    superseded: Option<(String, State)>,
}

impl<'a> StandFolder<'a> {
    /// Lists the folder of a stand and verifies its register. `planned` tells which of the passports there this command
    /// writes itself; others need a register. If passports are to be signed, what killed runs left there is removed.
    ///
    /// # Errors
    /// Returns [`FolderRefused`] if a link or another spelling is in the way, if the register is not accepted or is not
    /// the last one, or if there are passports without a register.
    pub(crate) fn open(
        folder: &'a Folder,
        stand: &str,
        authority: &'a Authority<'a>,
        planned: impl Fn(&str) -> bool,
    ) -> Result<Self, FolderRefused> {
        let (this, names) = Self::listed(folder, stand, authority)?;
        if authority.signer.is_some() {
            [folder.root(), &this.path].into_iter().for_each(files::leftovers::remove);
        }
        if let Some(key) = authority.register_signer.and_then(|signer| signer.public_key()) {
            // Otherwise the passports would be written, and then not be listed.
            let name = name_of(&this.path.join(FILE_NAME));
            let checked = VerifiedRegister::check_key(&name, &key, authority.issuer, authority.trust, authority.now());
            checked.map_err(NoRegister::from)?;
        }
        if names.iter().any(|name| name == FILE_NAME) {
            return Ok(Self { register: Some(this.read_register()?), ..this });
        }
        this.check_memory()?;
        match names.iter().find(|name| !planned(name) && this.good(name).is_some()) {
            Some(name) => Err(FolderRefused::NoRegister { folder: this.path.clone(), passport: this.path.join(name) }),
            None => Ok(this),
        }
    }

    /// Lists the folder of a stand; its register is not read.
    ///
    /// # Errors
    /// Returns [`FolderRefused`] if the folder cannot be read, or if a link or another spelling is in the way.
    pub(crate) fn listed(
        folder: &'a Folder,
        stand: &str,
        authority: &'a Authority<'a>,
    ) -> Result<(Self, Vec<String>), FolderRefused> {
        let path = folder.root.join(stand);
        folder.check_folder(&path)?;
        let mut names = place::names(&path)?;
        names.sort_unstable();
        let mut sites: BTreeMap<String, (String, u32)> = BTreeMap::new();
        for (site, revision) in names.iter().filter_map(|name| numbered(OsStr::new(name))) {
            let last = &mut sites.entry(site.to_ascii_lowercase()).or_insert((site.to_owned(), 0)).1;
            *last = (*last).max(revision);
        }
        let this = Self {
            authority,
            folder,
            stand: stand.to_owned(),
            register: None,
            sites: Mutex::new(sites),
            listings: Mutex::default(),
            path,
        };
        Ok((this, names))
    }

    /// Sets the register on which the next one builds.
    pub(crate) fn with_register(self, register: Option<VerifiedRegister>) -> Self {
        Self { register, ..self }
    }

    /// Checks that the workspace does not remember a register, since there is none.
    pub(crate) fn check_memory(&self) -> Result<(), FolderRefused> {
        match self.authority.memory.filter(|memory| !memory.is_empty_for(&self.stand)) {
            Some(_) => Err(RegisterRefused::Missing(shown(&self.path.join(FILE_NAME)).to_string()).into()),
            None => Ok(()),
        }
    }

    /// Reads the register, and checks that it is the last one as far as the workspace remembers.
    pub(crate) fn read_register(&self) -> Result<VerifiedRegister, FolderRefused> {
        let (path, Authority { trust, memory, .. }) = (self.path.join(FILE_NAME), *self.authority);
        let bytes = registers::bytes(&path)?;
        let Found { register, doubt, .. } = Found::of(&path, &bytes, trust, self.authority.now(), memory)?;
        if register.header().stand != self.stand {
            let words =
                format!("is the register of {}; restore that of this stand from the backup", register.header().stand);
            return Err(FolderRefused::There(path, words));
        }
        if let Some(doubt) = doubt {
            return Err(FolderRefused::Doubt(path, doubt));
        }
        if let Some(memory) = memory {
            memory.keep(&self.stand, &bytes)?;
        }
        Ok(register)
    }

    /// Returns content and SHA-256 of a file if it is a passport of this stand that is authentic by the trust of the
    /// authority.
    pub(crate) fn good(&self, name: &str) -> Option<(Content, String)> {
        let path = self.path.join(name);
        numbered(OsStr::new(name))?;
        let bytes = files::read(&path, LARGEST_DOCUMENT_BYTES).ok().filter(|_| !path.is_symlink())?;
        let content = self.authentic(&path, &bytes).ok().filter(|content| content.stand.id() == self.stand)?;
        Some((content, sha256_hex(&bytes)))
    }

    /// Returns the content of a passport if it is authentic by the trust of the authority, whatever its dates.
    fn authentic(&self, path: &Path, bytes: &[u8]) -> Result<Content, FolderRefused> {
        let verification = verify(&name_of(path), bytes, self.authority.trust, &Question::at(self.authority.now()));
        match (verification.authentic(), verification.content_from_anyone(), verification.key_from_anyone()) {
            (Some((content, _)), ..) => Ok(content.clone()),
            (None, Some(_), Some(key)) => {
                let why = for_the_issuer(verification.why()).to_owned();
                Err(FolderRefused::Foreign { path: path.to_owned(), fingerprint: key.fingerprint(), why })
            }
            _ => Err(FolderRefused::not_comparable(path.to_owned(), verification.why())),
        }
    }

    /// Returns the entries of the register; none without one.
    pub(crate) fn entries(&self) -> &[Entry] {
        self.register.as_ref().map_or(&[], VerifiedRegister::entries)
    }

    pub(crate) fn path_of(&self, site: &str, revision: u32) -> PathBuf {
        self.path.join(file_name(site, revision))
    }

    /// Returns the sites that listed passports state, for remarks only: at most `most`.
    pub(crate) fn sites(&self, most: usize) -> Vec<Site> {
        self.entries().iter().take(most).filter_map(|entry| Some(self.listed_content(entry)?.site)).collect()
    }

    /// Returns the content of the passport of an entry, if its file is the listed one.
    pub(crate) fn listed_content(&self, entry: &Entry) -> Option<Content> {
        place::listed_content(&self.path_of_entry(entry), &entry.sha256)
    }

    /// Returns the path of the passport of an entry.
    pub(crate) fn path_of_entry(&self, entry: &Entry) -> PathBuf {
        let (site, revision) = entry.site_and_revision();
        self.path_of(site, revision)
    }

    /// Returns the last revision for a site, in the names of the files or in the register, if it is later than
    /// `revision`.
    fn later(&self, site: &str, revision: u32) -> Option<u32> {
        let sites = self.sites.lock().unwrap_or_else(PoisonError::into_inner);
        let in_names = sites.get(&site.to_ascii_lowercase()).map(|(_, last)| *last);
        let listed = self
            .entries()
            .iter()
            .map(Entry::site_and_revision)
            .filter(|(other, _)| *other == site)
            .map(|(_, revision)| revision);
        listed.chain(in_names).max().filter(|last| *last > revision)
    }

    /// Returns the existing passport for a site, or `None` if there is no file.
    fn existing(&self, site: &str, revision: u32) -> Result<Option<Existing>, FolderRefused> {
        let path = self.path_of(site, revision);
        let sites = self.sites.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((there, _)) = sites.get(&site.to_ascii_lowercase()).filter(|(there, _)| there != site) {
            return Err(FolderRefused::other_case(path, &self.path.join(there)));
        }
        drop(sites);
        let found = match path.symlink_metadata() {
            Ok(found) => found,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(FileError::Read(path, error).into()),
        };
        if found.is_symlink() {
            return Err(FolderRefused::Link(path));
        }
        // Opening a pipe of that name could block indefinitely.
        if !found.is_file() && !found.is_dir() {
            return Err(FolderRefused::not_comparable(path, "a pipe, a device or a socket"));
        }
        match files::read(&path, LARGEST_DOCUMENT_BYTES) {
            Err(error) if error.is_missing() => Ok(None),
            Err(error) => Err(error.into()),
            Ok(bytes) => {
                let content = self.authentic(&path, &bytes)?;
                Ok(Some(Existing { sha256: sha256_hex(&bytes), content, path }))
            }
        }
    }

    /// Returns the next step for an equal passport that already exists: nothing, if it is current in the register; its
    /// entry, if it is not listed.
    fn there(
        &self,
        there: Existing,
        draft: &Passport,
        superseded: Option<(String, State)>,
    ) -> Result<Next, FolderRefused> {
        let entry = self.register.as_ref().and_then(|register| register.entry(&there.content.passport.id));
        let listing = match entry {
            Some(entry) if entry.sha256 != there.sha256 => {
                let words = "the register lists another file with this identifier; restore that file from the backup";
                return Err(FolderRefused::there(there.path, words));
            }
            Some(entry) if entry.state == State::Current => None,
            Some(entry) => return Err(FolderRefused::ended(there.path, entry)),
            None => Some(Box::new(Listing { entry: Draft::entry_of(&there.content, &there.sha256), superseded })),
        };
        Ok(Next::There { issued: there.left(draft), listing })
    }

    /// Returns an error if the register lists a passport whose file is missing.
    fn check_absent(&self, path: PathBuf, id: &str) -> Result<PathBuf, FolderRefused> {
        match self.register.as_ref().and_then(|register| register.entry(id)) {
            Some(_) => {
                let words = "missing, but listed in the register; restore the file from the backup, or withdraw it with \
                             `revoke`";
                Err(FolderRefused::there(path, words))
            }
            None => Ok(path),
        }
    }

    /// Returns the next step for revision 1 of a stand at a site; nothing is signed or written.
    pub(crate) fn next_first(&self, stand: &PreparedStand, site: &Site, order: &Issue) -> Result<Next, FolderRefused> {
        let draft = Box::new(stand.draft(site, order)?);
        let (name, revision) = (site.id.as_str(), order.revision);
        let later = self.later(name, revision);
        match self.existing(name, revision)? {
            Some(there) if there.is_same(draft.content()) => self.there(there, &draft, None),
            Some(there) => {
                let latest = later.map(|last| self.existing(name, last)).transpose()?.flatten();
                Err(latest.unwrap_or(there).refuse(stand.stand(), site, draft.content()))
            }
            None => {
                let path = self.path_of(name, revision);
                if let Some(last) = later {
                    return Err(FolderRefused::gap(path, self.path_of(name, last)));
                }
                let path = self.check_absent(path, &draft.content().passport.id)?;
                Ok(Next::New { path, draft, superseded: None })
            }
        }
    }

    /// Returns the next step for the successor of a passport; nothing is signed or written.
    pub(crate) fn next_successor(&self, successor: &Successor) -> Result<Next, FolderRefused> {
        let (old_id, old_sha256) = successor.old();
        let old = self.register.as_ref().and_then(|register| register.entry(old_id));
        let state = if successor.same_site { State::Superseded } else { State::Moved };
        let superseded = successor.supersedes().then(|| (old_id.to_owned(), state));
        let site = successor.site.id.as_str();
        let mut revision = successor.first_revision();
        loop {
            let draft = Box::new(successor.draft(revision)?);
            let later = self.later(site, revision);
            let Some(there) = self.existing(site, revision)? else {
                let path = self.path_of(site, revision);
                // A passport that is superseded already has its successor.
                if let Some(entry) = old.filter(|old| successor.supersedes() && old.by.is_some()) {
                    return Err(FolderRefused::ended(self.path_of_entry(entry), entry));
                }
                return match later {
                    Some(last) if successor.same_site => Err(FolderRefused::gap(path, self.path_of(site, last))),
                    // In one step, however high the number in the name of a file is.
                    Some(last) => {
                        revision = last;
                        continue;
                    }
                    None if successor.says_the_same && !successor.may_say_the_same => {
                        Err(FolderRefused::NothingChanges)
                    }
                    None => {
                        let path = self.check_absent(path, &draft.content().passport.id)?;
                        Ok(Next::New { path, draft, superseded })
                    }
                };
            };
            if there.is_same(draft.content()) {
                return self.there(there, &draft, superseded);
            }
            let predecessor = there.content.passport.reissued_from.as_ref();
            if predecessor.is_some_and(|predecessor| predecessor.sha256 == old_sha256) {
                let latest = later.map_or(there.path, |last| self.path_of(site, last));
                let words = "is already a successor of this passport for this site, with different content; re-issue the \
                             passport that is current";
                return Err(FolderRefused::there(latest, words));
            }
            // At the predecessor's site only one revision can be the next one; at another site, try the next free
            // revision.
            let Some(next) = revision.checked_add(1).filter(|_| !successor.same_site) else {
                let words = "is already the next revision for this site, re-issued from another passport; re-issue that revision";
                return Err(FolderRefused::there(there.path, words));
            };
            revision = next;
        }
    }

    /// Signs the next passport and verifies it, but does not write it.
    pub(crate) fn seal(&self, next: Next) -> Result<Sealed, FolderRefused> {
        match next {
            Next::There { issued, listing } => {
                listing.into_iter().for_each(|listing| self.add(*listing));
                Ok(Sealed { issued, text: None })
            }
            Next::New { path, draft, superseded } => {
                let signer = self.authority.signer.ok_or(FolderRefused::NoSigner)?;
                let (text, sha256) = super::sign(&path, &draft, signer, self.authority.trust)?;
                let content = draft.content();
                let listing = Listing { entry: Draft::entry_of(content, &sha256), superseded };
                let issued =
                    Issued { id: content.passport.id.clone(), path, sha256, new: true, remarks: draft.remarks() };
                self.note(&content.site, content.passport.revision, listing);
                Ok(Sealed { issued, text: Some(text) })
            }
        }
    }

    fn listings(&self) -> MutexGuard<'_, BTreeMap<String, Listing>> {
        self.listings.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn add(&self, listing: Listing) {
        self.listings().insert(listing.entry.id.clone(), listing);
    }

    fn note(&self, site: &Site, revision: u32, listing: Listing) {
        self.add(listing);
        let mut sites = self.sites.lock().unwrap_or_else(PoisonError::into_inner);
        let known = sites.entry(site.id.as_str().to_ascii_lowercase()).or_insert((site.id.to_string(), 0));
        known.1 = known.1.max(revision);
    }

    /// Signs and writes the next passport. If another run writes a file of that name first, the next step is determined
    /// again.
    pub(crate) fn settle(&self, next: impl Fn() -> Result<Next, FolderRefused>) -> Result<Issued, FolderRefused> {
        let settle_once = || {
            let Sealed { issued, text } = self.seal(next()?)?;
            if let Some(text) = text {
                let written = files::write_new(&issued.path, text.as_bytes(), Access::Shared, self.folder.durability);
                if let Err(error) = written {
                    self.listings().remove(&issued.id);
                    return Err(error.into());
                }
            }
            Ok(issued)
        };
        for _ in 1..ATTEMPTS {
            match settle_once() {
                Err(FolderRefused::File(FileError::Exists { .. })) => {}
                settled => return settled,
            }
        }
        settle_once()
    }

    /// Writes the register with every passport that was issued or found unlisted, once their names are durable; nothing, if
    /// there is none.
    ///
    /// # Errors
    /// Returns [`FolderRefused`] if the register cannot be written; the passports are then not listed.
    pub(crate) fn list(&self) -> Result<(), FolderRefused> {
        let listings = std::mem::take(&mut *self.listings());
        if listings.is_empty() {
            return Ok(());
        }
        self.sync_names()?;
        self.write(false, |draft| add(draft, listings))
    }

    /// Syncs the names of the passports, if that was put off when they were written, and those of the folders above.
    fn sync_names(&self) -> Result<(), FileError> {
        if self.folder.durability != Durability::NameLater {
            return Ok(());
        }
        self.path.ancestors().take(FOLDERS).map(or_here).try_for_each(|folder| {
            files::sync_folder(folder).map_err(|error| FileError::Write(folder.to_owned(), error))
        })
    }

    /// Writes the register with the passports that were sealed, together with all files: the new passports first, then the
    /// register, and last the file that replaces another one.
    pub(crate) fn list_together(
        &self,
        new: &[(PathBuf, Vec<u8>)],
        last: (PathBuf, Vec<u8>),
    ) -> Result<(), FolderRefused> {
        let listings = std::mem::take(&mut *self.listings());
        let together = |register: Option<(&Path, &[u8])>| {
            let register = register.map(|(path, text)| (path.to_owned(), text.to_owned()));
            let replaced: Vec<_> = register.into_iter().chain([last.clone()]).collect();
            Ok(files::together::write_together(new, &replaced)?)
        };
        if listings.is_empty() || self.authority.register_signer.is_none() {
            return together(None);
        }
        self.write_by(true, |draft| add(draft, listings), |path, text| together(Some((path, text))))
    }

    /// Replaces the register by one that `change` makes of it, as [`Self::write_by`] does.
    pub(crate) fn write(
        &self,
        even_if_same: bool,
        change: impl FnOnce(&mut Draft) -> Result<(), FolderRefused>,
    ) -> Result<(), FolderRefused> {
        self.write_by(even_if_same, change, |path, text| Ok(files::replace(path, text, self.folder.durability)?))
    }

    /// Replaces the register by one that `change` makes of it, under a lock that other runs respect; `write` writes it.
    /// Without a signer of registers nothing is written, and the passports do not count yet. A register with the
    /// entries of the one before is written only `even_if_same`.
    fn write_by(
        &self,
        even_if_same: bool,
        change: impl FnOnce(&mut Draft) -> Result<(), FolderRefused>,
        write: impl FnOnce(&Path, &[u8]) -> Result<(), FolderRefused>,
    ) -> Result<(), FolderRefused> {
        let Authority { issuer, trust, memory, .. } = *self.authority;
        let Some(signer) = self.authority.register_signer else { return Ok(()) };
        let path = self.path.join(FILE_NAME);
        let _locked = lock(&self.path)?;
        files::leftovers::remove(&self.path);
        let current = match registers::bytes(&path) {
            Err(RegisterRefused::Missing(_)) => None,
            Err(refused) => return Err(refused.into()),
            Ok(bytes) => match &self.register {
                Some(register) if sha256_hex(&bytes) == register.sha256() => Some(register.clone()),
                _ => Some(self.read_register()?),
            },
        };
        if let (Some(before), Some(now)) = (&self.register, &current) {
            let doubt = |why| FolderRefused::Doubt(path.clone(), Doubt::Contradicted(why));
            now.agree(before).map_err(doubt)?;
        }
        if self.register.is_some() && current.is_none() {
            return Err(RegisterRefused::Missing(shown(&path).to_string()).into());
        }
        let mut draft = Draft::after(current.as_ref(), &self.stand, issuer, self.authority.now());
        change(&mut draft)?;
        // Another run may have listed the same passports meanwhile.
        if !even_if_same && current.is_some_and(|current| current.entries() == draft.entries()) {
            return Ok(());
        }
        let (text, _) = draft.sign(&name_of(&path), signer, trust)?;
        write(&path, text.as_bytes())?;
        if let Some(memory) = memory {
            memory.keep(&self.stand, text.as_bytes())?;
        }
        Ok(())
    }

    /// Returns remarks on a further passport from the certificate of `stand`: the certificate was replaced, or another one
    /// is current.
    ///
    /// # Errors
    /// Returns [`FolderRefused::There`] if a listed passport states other angles under its number.
    pub(crate) fn against_certificate(&self, stand: &PreparedStand) -> Result<Vec<String>, FolderRefused> {
        let Some(register) = &self.register else { return Ok(Vec::new()) };
        let (text, stand) = (stand.text(), stand.stand());
        let number = &stand.certificate.number;
        let mut bytes = Vec::new();
        let counting = || register.entries().iter().filter(|entry| entry.state != State::Withdrawn);
        for entry in counting().filter(|entry| entry.certificate == *number) {
            let path = self.path_of_entry(entry);
            let read = files::read_into(&mut bytes, &path, LARGEST_DOCUMENT_BYTES);
            if read.is_err()
                || memchr::memmem::find(&bytes, text.as_bytes()).is_some()
                || sha256_hex(&bytes) != entry.sha256
            {
                continue;
            }
            let there = self.authentic(&path, &bytes)?.to_stand();
            stand.check_number(&there).map_err(|why| FolderRefused::There(path, why))?;
        }
        let mut others: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        for entry in counting().filter(|entry| entry.state == State::Current && entry.certificate != *number) {
            others.entry(&entry.certificate).or_default().push(&entry.id);
        }
        let is_current = counting().any(|entry| entry.state == State::Current && entry.certificate == *number);
        let by = |entry: &Entry| register.entry(entry.by.as_deref()?).filter(|by| by.certificate != *number);
        let replaced = counting().filter(|entry| entry.certificate == *number && !is_current).find_map(by);
        let replaced =
            replaced.map(|by| format!("certificate {number} was replaced by {} ({})", by.certificate, by.id));
        let others = others
            .into_iter()
            .map(|(other, ids)| format!("the stand is also current under certificate {other}: {}", first_few(&ids)));
        Ok(replaced.into_iter().chain(others).collect())
    }
}

/// Adds the entries, in the order of their sites and revisions, whatever order the threads had.
fn add(draft: &mut Draft, listings: BTreeMap<String, Listing>) -> Result<(), FolderRefused> {
    let mut listings: Vec<Listing> = listings.into_values().collect();
    listings.sort_by(|a, b| a.entry.site_and_revision().cmp(&b.entry.site_and_revision()));
    for Listing { entry, superseded } in listings {
        let id = entry.id.clone();
        draft.add(entry)?;
        if let Some((old, state)) = superseded {
            draft.supersede(&old, &id, state)?;
        }
    }
    Ok(())
}

/// Locks the register in a folder, which is created if it does not exist. On a file system without locks nothing is locked;
/// a lost update is then seen in the sequence and in the SHA-256 of the register before.
fn lock(folder: &Path) -> Result<Option<File>, FolderRefused> {
    let path = folder.join(LOCK_NAME);
    if path.is_symlink() {
        return Err(FolderRefused::Link(path));
    }
    fs::create_dir_all(folder).map_err(|error| FileError::Write(folder.to_owned(), error))?;
    let file = File::options().create(true).truncate(false).read(true).write(true).open(&path);
    let file = file.map_err(|error| FileError::Write(path.clone(), error))?;
    let mut waited = Duration::ZERO;
    loop {
        match file.try_lock() {
            Ok(()) => return Ok(Some(file)),
            Err(TryLockError::Error(_)) => return Ok(None),
            Err(TryLockError::WouldBlock) if waited < LONGEST_WAIT => {
                std::thread::sleep(WAIT);
                waited += WAIT;
            }
            Err(TryLockError::WouldBlock) => return Err(FolderRefused::Locked(path)),
        }
    }
}
