//! Folder of passports: the place of each passport and of each register. Passports are written completely and never
//! replace another file; a register is replaced as a whole.
//!
//! * `stand`: the folder of one stand, examined once, and what a command adds to it.
//! * `registers`: registers as readers of passports ask them, and the memory of a workspace.
//! * `overview`: the registers of all stands, compared with the files.
//! * `renewal`: registers signed again, first registers, and withdrawals.
//! * `place`: the places of passports, and the stands that a folder has.
//! * `archive`: stand files that a new certificate supersedes.
//! * `refused`: reasons why a passport or a register is not written.

pub(crate) mod archive;
pub(crate) mod overview;
pub(crate) mod place;
pub(crate) mod refused;
pub(crate) mod registers;
pub(crate) mod renewal;
pub(crate) mod stand;

pub use crate::files::FileError;
pub use refused::FolderRefused;
pub(crate) use registers::{Memory, Registers};
pub(crate) use stand::{Listing, StandFolder};

use crate::document::Signer;
use crate::files::{self, Durability, or_here};
use crate::passport::checks::for_the_issuer;
use crate::passport::issue::{Draft, Issue, PreparedStand, Remarks};
use crate::passport::reissue::{NO_CHANGES, Successor, changes};
use crate::passport::{Content, Trust};
use crate::register::State;
use crate::site::Site;
use crate::stand::{Identity, Stand};
use crate::text::scalar::identifiers;
use crate::text::{name_of, shown};
use jiff::Timestamp;
use jiff::civil::Date;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Folder of passports: `<model>/<serial>/<site id>-<revision>.yaml`, with a register in the folder of each stand.
#[derive(Debug)]
pub struct Folder {
    root: PathBuf,
    durability: Durability,
    /// Names in folders by their lower-case forms; each folder is listed once.
    names: Mutex<HashMap<PathBuf, HashMap<String, String>>>,
}

/// Issuer of passports and registers: its keys, its trust, and its clock.
#[derive(Clone, Copy)]
pub struct Authority<'a> {
    /// Issuer: a principal of allowed_signers.
    pub issuer: &'a str,
    /// Trust by which what exists is believed, and by which what is new must pass verification before it is written.
    pub trust: &'a Trust,
    /// Signer of passports; `None` in a dry run.
    pub signer: Option<&'a (dyn Signer + Sync)>,
    /// Signer of registers; `None` to leave them to a second person. The passports then do not count yet.
    pub register_signer: Option<&'a (dyn Signer + Sync)>,
    /// Clock, by which registers are dated.
    pub clock: &'a (dyn Fn() -> Timestamp + Sync),
    /// Last accepted register of each stand, in a workspace.
    pub(crate) memory: Option<&'a Memory>,
}

impl<'a> Authority<'a> {
    /// Creates an authority that signs passports and registers with one key.
    pub fn new(
        issuer: &'a str,
        signer: &'a (dyn Signer + Sync),
        trust: &'a Trust,
        clock: &'a (dyn Fn() -> Timestamp + Sync),
    ) -> Self {
        Self { issuer, trust, signer: Some(signer), register_signer: Some(signer), clock, memory: None }
    }

    fn now(&self) -> Timestamp {
        (self.clock)()
    }
}

/// Result of an order: a passport that exists now.
#[derive(Debug, Clone, PartialEq)]
pub struct Issued {
    /// Id of the passport.
    pub id: String,
    /// Path of the passport.
    pub path: PathBuf,
    /// SHA-256 of the file.
    pub sha256: String,
    /// `true` if the passport is new; `false` if an equal one already existed and was left unchanged.
    pub new: bool,
    /// Remarks on the passport for the factory.
    pub remarks: Remarks,
}

/// Next step for an order.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Next {
    /// Equal passport that already exists, and its entry if the register does not list it.
    There { issued: Issued, listing: Option<Box<Listing>> },
    /// New passport, computed and checked, which is yet to be signed and written, and the one that it supersedes.
    New { path: PathBuf, draft: Box<Draft>, superseded: Option<(String, State)> },
}

impl Next {
    pub(crate) fn id(&self) -> &str {
        match self {
            Self::There { issued, .. } => &issued.id,
            Self::New { draft, .. } => &draft.content().passport.id,
        }
    }
}

/// Passport that was signed and verified.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sealed {
    /// Passport, which exists once its text has been written.
    pub issued: Issued,
    /// Text to be written, or `None` if an equal passport already exists.
    pub text: Option<String>,
}

impl Folder {
    /// Creates the handle of the folder `root`, which need not exist yet. Every file is synced as soon as it is
    /// written.
    pub fn new(root: impl Into<PathBuf>) -> Self {
        Self { root: root.into(), durability: Durability::Named, names: Mutex::default() }
    }

    /// Returns the handle with another `durability` of the files written to the folder.
    pub(crate) fn with_durability(self, durability: Durability) -> Self {
        Self { durability, ..self }
    }

    /// Returns the path of the folder.
    pub fn root(&self) -> &Path {
        or_here(&self.root)
    }

    /// Returns the root in the path of a passport of `stand`.
    ///
    /// # Errors
    /// Returns a sentence unless the two folders above the file are `<model>/<serial>`.
    pub(crate) fn root_of<'a>(path: &'a Path, stand: &Identity) -> Result<&'a Path, String> {
        let root = || {
            let serial = path.parent()?;
            let model = serial.parent()?;
            let shows = serial.file_name()? == stand.serial.as_str() && model.file_name()? == stand.model.as_str();
            model.parent().filter(|_| shows)
        };
        root().ok_or_else(|| {
            format!(
                "the passport is not in a folder {}, so the folder of its successor is unknown; specify the folder of \
                 passports with --out",
                stand.id()
            )
        })
    }

    /// Returns the path of the file of a stand.
    pub(crate) fn stand_file(&self, stand: &Identity) -> PathBuf {
        self.root.join(stand.model.as_str()).join(stand.serial.as_str()).join("stand.yaml")
    }

    /// Returns the path of the passport with this id, or `None` if the text is not an id.
    pub(crate) fn path_of_id(&self, id: &str) -> Option<PathBuf> {
        let (series, revision) = id.rsplit_once('/')?;
        let [model, serial, site] = identifiers(series)?;
        Some(self.root.join(model).join(serial).join(place::file_name(site, revision.parse().ok()?)))
    }

    /// Issues revision 1 of a stand for a site, and lists it in the register of the stand.
    ///
    /// An equal passport (apart from its time, program and signature) that is authentic and current is left unchanged; a
    /// different one of that name is never replaced.
    ///
    /// # Errors
    /// Returns [`FolderRefused`] if the passport cannot be issued, written or listed; no passport is then replaced.
    pub fn issue(
        &self,
        stand: &PreparedStand,
        site: &Site,
        order: &Issue,
        authority: &Authority,
    ) -> Result<Issued, FolderRefused> {
        let name = place::file_name(site.id.as_str(), order.revision);
        let folder = StandFolder::open(self, &stand.stand().stand.id(), authority, |other| other == name)?;
        let issued = folder.settle(|| folder.next_first(stand, site, order))?;
        folder.list().map(|()| issued)
    }

    /// Issues the successor of a passport, and lists it in the register of the stand.
    ///
    /// # Errors
    /// Returns [`FolderRefused`] if the successor cannot be issued, written or listed; no passport is then replaced.
    pub fn reissue(&self, successor: &Successor, authority: &Authority) -> Result<Issued, FolderRefused> {
        let folder = StandFolder::open(self, &successor.prepared().stand().stand.id(), authority, |_| false)?;
        let issued = folder.settle(|| folder.next_successor(successor))?;
        folder.list().map(|()| issued)
    }

    /// Checks the path from the root to a folder: none of the folders is a link, and no other name next to one of them
    /// differs from it only in case.
    fn check_folder(&self, last: &Path) -> Result<(), FolderRefused> {
        let way: Vec<&Path> = last.ancestors().take_while(|folder| or_here(folder) != self.root()).collect();
        way.iter().try_for_each(|folder| check_link(folder))?;
        way.iter().rev().try_for_each(|folder| self.check_case(folder))
    }

    /// Checks the path at which a file of another kind is to be written, as that of a passport is checked.
    pub(crate) fn check_place(&self, file: &Path) -> Result<(), FolderRefused> {
        self.check_folder(files::folder_of(file))?;
        check_link(file)?;
        self.check_case(file)
    }

    /// Checks that no other name in the same folder, which some systems would not distinguish, differs from that of `path`
    /// only in case.
    fn check_case(&self, path: &Path) -> Result<(), FolderRefused> {
        let folder = files::folder_of(path);
        let Some(name) = path.file_name().and_then(|name| name.to_str()) else { return Ok(()) };
        let mut known = self.names.lock().unwrap_or_else(PoisonError::into_inner);
        if !known.contains_key(folder) {
            let names = place::names(folder)?.into_iter().map(|name| (name.to_ascii_lowercase(), name));
            known.insert(folder.to_owned(), names.collect());
        }
        let names = known.entry(folder.to_owned()).or_default();
        let there = names.entry(name.to_ascii_lowercase()).or_insert_with(|| name.to_owned());
        match *there == name {
            true => Ok(()),
            false => Err(FolderRefused::other_case(path.to_owned(), &folder.join(there))),
        }
    }
}

fn check_link(path: &Path) -> Result<(), FolderRefused> {
    if path.is_symlink() { Err(FolderRefused::Link(path.to_owned())) } else { Ok(()) }
}

/// Signs a passport and verifies it before it is written, as every reader will: one that fails verification is useless.
/// Returns the text and its SHA-256.
fn sign(path: &Path, draft: &Draft, signer: &dyn Signer, trust: &Trust) -> Result<(String, String), FolderRefused> {
    let (text, verification) = draft.sign_and_verify(&name_of(path), signer, trust)?;
    if let Some(failed) = verification.failed() {
        let why = for_the_issuer(&failed.detail).to_owned();
        return Err(FolderRefused::NotVerifiable(failed.name.as_str(), why));
    }
    Ok((text, verification.sha256().to_owned()))
}

struct Existing {
    path: PathBuf,
    sha256: String,
    content: Content,
}

impl Existing {
    fn left(self, draft: &Draft) -> Issued {
        let id = self.content.passport.id.clone();
        Issued { id, path: self.path, sha256: self.sha256, new: false, remarks: draft.remarks() }
    }

    /// Returns the refusal of `new`, which differs from the existing passport, or from an earlier revision of it.
    fn refuse(self, stand: &Stand, site: &Site, new: &Content) -> FolderRefused {
        let there = &self.content.passport;
        let day = |day: Option<Date>| day.map_or_else(|| "none".to_owned(), |day| day.to_string());
        let valid_until = (there.valid_until != new.passport.valid_until)
            .then(|| format!("valid until {} -> {}", day(there.valid_until), day(new.passport.valid_until)));
        let accuracy = (self.content.accuracy != new.accuracy)
            .then(|| "issued with other --accuracy, --gyro or --laboratory".to_owned());
        let reissued = there.reissued_from.as_ref().map(|predecessor| format!("re-issued from {}", predecessor.id));
        let changed = changes(&self.content, stand, site, &new.passport.issuer);
        if valid_until.is_none() && changed == NO_CHANGES {
            match (accuracy.is_some(), reissued.is_some()) {
                (true, false) => {
                    let words = "already exists with other values of --accuracy, --gyro or --laboratory; repeat the options \
                                 with which it was issued, or withdraw it with `revoke` and issue the new one to another \
                                 folder with --out";
                    return FolderRefused::there(self.path, words);
                }
                (false, _) if there.revision > new.passport.revision => {
                    let words =
                        "has this content already; it is the last revision for this site, and nothing is left to issue";
                    return FolderRefused::there(self.path, words);
                }
                _ => {}
            }
        }
        let mut words: Vec<String> = [valid_until, accuracy, reissued].into_iter().flatten().collect();
        if changed != NO_CHANGES || words.is_empty() {
            words.push(changed);
        }
        let words = format!(
            "already exists with different content ({}); if the changes are intended, issue them with `reissue {}` and the \
             changed --stand, --site, --valid-until or --identity",
            words.join("; "),
            shown(&self.path)
        );
        FolderRefused::There(self.path, words)
    }

    /// Returns `true` if this passport and a new one are equal apart from the time of issue and the program that wrote
    /// them.
    fn is_same(&self, new: &Content) -> bool {
        let mut there = self.content.clone();
        there.passport.issued_at = new.passport.issued_at;
        there.passport.issued_with.clone_from(&new.passport.issued_with);
        there == *new
    }
}
