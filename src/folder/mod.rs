//! Folder of passports: the place of each passport, existing passports, and new ones, which are written completely and
//! never replace another file.
//!
//! * `search`: the files in a folder, their register, and the history of one stand.
//! * `archive`: stand files that a new certificate supersedes.
//! * `refused`: reasons why a passport is not written.

pub(crate) mod archive;
mod claim;
mod names;
pub(crate) mod refused;
pub(crate) mod search;
mod superseding;

pub use crate::files::{Durability, FileError};
pub use refused::FolderRefused;
pub use search::register;
pub(crate) use superseding::Superseding;

use crate::document::{SignedText, Signer, sha256_hex};
use crate::files::walk::{Visited, Walk};
use crate::files::{self, Access, or_here};
use crate::passport::checks::for_the_issuer;
use crate::passport::issue::{Draft, Issue, PreparedStand, Remarks};
use crate::passport::reissue::{NO_CHANGES, Successor, changes};
use crate::passport::{Content, NAMESPACE, Question, Trust, content, content_from_anyone, verify};
use crate::register::{Asked, Line, State};
use crate::site::Site;
use crate::stand::{Identity, Stand};
use crate::text::{Identifier, LARGEST_DOCUMENT_BYTES, name_of};
use jiff::Timestamp;
use jiff::civil::Date;
use names::{Names, Of};
use std::cmp::Reverse;
use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};

/// Folder of passports: `<model>/<serial>/<site id>-<revision>.yaml`.
#[derive(Debug)]
pub struct Folder {
    root: PathBuf,
    durability: Durability,
    /// Folders of stands that were checked.
    checked: Visited,
    /// Names of models and serial numbers; `sites` has the names of sites, `files` those of files of other kinds.
    folders: Names,
    sites: Names,
    files: Names,
}

/// Signer, with the trust by which a new passport must pass verification before it is written.
#[derive(Clone, Copy)]
pub struct Seal<'a> {
    /// Signer of the passport.
    pub signer: &'a (dyn Signer + Sync),
    /// Trust of the future verifiers; `None` to skip the verification.
    pub trust: Option<&'a Trust>,
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
    /// Equal passport that already exists.
    There(Issued),
    /// New passport, computed and checked, which is yet to be signed and written.
    New { path: PathBuf, draft: Box<Draft> },
}

impl Next {
    pub(crate) fn id(&self) -> &str {
        match self {
            Self::There(issued) => &issued.id,
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

/// Number of times that an order is tried; each retry means that another run has just written a passport.
const ATTEMPTS: usize = 8;

/// Number of files among which the nearest id is looked for.
const MOST_FILES: usize = 10_000;

impl Folder {
    /// Creates the handle of the folder `root`, which need not exist yet. Every file is synced as soon as it is
    /// written.
    pub fn new(root: impl Into<PathBuf>) -> Self {
        let [folders, sites, files] = [Of::Folders, Of::Passports, Of::Files].map(Names::new);
        Self { root: root.into(), durability: Durability::Named, checked: Visited::default(), folders, sites, files }
    }

    /// Returns the handle with another `durability` of the files written to the folder.
    pub fn with_durability(self, durability: Durability) -> Self {
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

    fn of_stand(&self, stand: &Identity) -> PathBuf {
        self.root.join(stand.model.as_str()).join(stand.serial.as_str())
    }

    /// Returns the path of the passport of a stand for a site.
    pub fn path_of(&self, stand: &Identity, site: &Identifier, revision: u32) -> PathBuf {
        self.of_stand(stand).join(format!("{site}-{revision}.yaml"))
    }

    /// Returns the path of the file of a stand.
    pub(crate) fn stand_file(&self, stand: &Identity) -> PathBuf {
        self.of_stand(stand).join("stand.yaml")
    }

    /// Returns the path of the passport with this id, or `None` if the text is not an id.
    pub(crate) fn path_of_id(&self, id: &str) -> Option<PathBuf> {
        let parts: Vec<&str> = id.split('/').collect();
        let [model, serial, site, revision] = parts.as_slice() else { return None };
        let names = [model, serial, site].map(|name| Identifier::new(name).ok());
        let [Some(model), Some(serial), Some(site)] = names else { return None };
        let revision: u32 = revision.parse().ok()?;
        Some(self.root.join(model.as_str()).join(serial.as_str()).join(format!("{site}-{revision}.yaml")))
    }

    /// Returns the id nearest to `id` among those that the names of the files show, or `None` if none is near.
    pub(crate) fn nearest_id(&self, id: &str) -> Option<String> {
        let id_of = |path: PathBuf| {
            let name = path.strip_prefix(&self.root).ok()?.to_str()?.strip_suffix(".yaml")?.replace('\\', "/");
            let (site, revision) = name.rsplit_once('-')?;
            Some(format!("{site}/{revision}"))
        };
        let files = Walk::deep(&self.root, search::is_numbered).files();
        let ids = files.take(MOST_FILES).filter_map(id_of);
        let near = ids.map(|other| (strsim::damerau_levenshtein(&other, id), Reverse(other)));
        let most = id.chars().count() / 3;
        // Of equally near ones it is the last, such as the latest revision.
        near.filter(|(distance, _)| *distance <= most).min().map(|(_, Reverse(id))| id)
    }

    /// Returns remarks on a further passport from the certificate of `stand`: the certificate was replaced, or another
    /// one is in force. Only existing passports of the stand that are authentic by `trust` and not withdrawn are
    /// considered.
    ///
    /// # Errors
    /// Returns [`FolderRefused::NumberInUse`] if one of them states other angles under the number of the certificate.
    pub(crate) fn against_certificate(
        &self,
        stand: &PreparedStand,
        trust: &Trust,
        time: Timestamp,
    ) -> Result<Vec<String>, FolderRefused> {
        let (text, stand) = (stand.text(), stand.stand());
        let folder = self.of_stand(&stand.stand);
        if !superseding::may_contradict(&folder, text) {
            return Ok(Vec::new());
        }
        let Ok((register, _)) = search::register(&folder, trust.clone(), &Asked::at(time), 1) else {
            return Ok(Vec::new());
        };
        let number = &stand.certificate.number;
        let valid = |line: &&Line| !matches!(line.state, State::Broken | State::Revoked);
        for line in register.passports.iter().filter(valid).filter(|line| line.certificate.as_ref() == Some(number)) {
            let path = PathBuf::from(&line.file);
            let there = Existing::of(&path, &files::read(&path, LARGEST_DOCUMENT_BYTES)?)?;
            let unlike = stand.check_number(&there.content.to_stand());
            unlike.map_err(|error| FolderRefused::NumberInUse(path, error))?;
        }
        Ok(register.against_certificate(&stand.stand.id(), number))
    }

    /// Returns the sites that existing passports of a stand state, for remarks only: at most `most`, not verified.
    pub(crate) fn sites_of(&self, stand: &Identity, most: usize) -> Vec<Site> {
        let folder = self.root.join(stand.model.as_str()).join(stand.serial.as_str());
        let read = |path: PathBuf| {
            let bytes = files::read(&path, LARGEST_DOCUMENT_BYTES).ok()?;
            Some(content_from_anyone(&name_of(&path), &bytes).ok()?.site)
        };
        let found = search::passports(&folder).into_iter().flatten().flatten();
        found.take(most).filter_map(read).collect()
    }

    /// Issues revision 1 of a stand for a site.
    ///
    /// An equal passport (apart from its time, program and signature) is left unchanged; a different one of that name
    /// is never replaced.
    ///
    /// # Errors
    /// Returns [`FolderRefused`] if the passport cannot be issued or written; no file is then replaced.
    pub fn issue(
        &self,
        stand: &PreparedStand,
        site: &Site,
        order: &Issue,
        seal: Seal,
    ) -> Result<Issued, FolderRefused> {
        self.settle(|| self.next_first(stand, site, order), seal)
    }

    /// Returns the next step of [`Self::issue`]; nothing is signed or written.
    pub(crate) fn next_first(&self, stand: &PreparedStand, site: &Site, order: &Issue) -> Result<Next, FolderRefused> {
        let draft = Box::new(stand.draft(site, order)?);
        let stand = stand.stand();
        let path = self.path_of(&stand.stand, &site.id, order.revision);
        match self.existing(&path)? {
            Some(there) if same(&there.content, draft.content()) => Ok(Next::There(there.left(&draft))),
            Some(there) => {
                let latest = self.sites.later(&path, order.revision);
                let latest =
                    latest.map(|last| self.existing(&self.path_of(&stand.stand, &site.id, last))).transpose()?;
                Err(latest.flatten().unwrap_or(there).refuse(stand, site, draft.content()))
            }
            None => match self.sites.later(&path, order.revision) {
                Some(last) => Err(FolderRefused::Gap { path, later: self.path_of(&stand.stand, &site.id, last) }),
                None => Ok(Next::New { path, draft }),
            },
        }
    }

    /// Issues the successor of a passport.
    ///
    /// # Errors
    /// Returns [`FolderRefused`] if the successor cannot be issued or written; no file is then replaced.
    pub fn reissue(&self, successor: &Successor, seal: Seal) -> Result<Issued, FolderRefused> {
        self.settle(|| self.next_successor(successor), seal)
    }

    /// Returns the next step of [`Self::reissue`]; nothing is signed or written.
    pub(crate) fn next_successor(&self, successor: &Successor) -> Result<Next, FolderRefused> {
        let mut revision = successor.first_revision();
        loop {
            let draft = Box::new(successor.draft(revision)?);
            let path_of = |revision| self.path_of(&successor.stand().stand, &successor.site.id, revision);
            let path = path_of(revision);
            let Some(there) = self.existing(&path)? else {
                return match (successor.rival.as_deref(), self.sites.later(&path, revision)) {
                    (Some(rival), _) => Err(FolderRefused::Fork(rival.to_owned())),
                    (None, Some(last)) if successor.same_site => Err(FolderRefused::Gap { path, later: path_of(last) }),
                    // In one step, however high the number in the name of a file is.
                    (None, Some(last)) => {
                        revision = last;
                        continue;
                    }
                    (None, None) if successor.says_the_same && !successor.may_say_the_same => {
                        Err(FolderRefused::NothingChanges)
                    }
                    (None, None) => Ok(Next::New { path, draft }),
                };
            };
            if same(&there.content, draft.content()) {
                return Ok(Next::There(there.left(&draft)));
            }
            let predecessor = there.content.passport.reissued_from.as_ref();
            if predecessor.is_some_and(|predecessor| predecessor.sha256 == successor.old_sha256()) {
                let latest = self.sites.later(&path, revision).map_or(there.path, path_of);
                return Err(FolderRefused::OtherSuccessor(latest));
            }
            // At the predecessor's site only one revision can be the next one; at another site, try the next free
            // revision.
            let Some(next) = revision.checked_add(1).filter(|_| !successor.same_site) else {
                return Err(FolderRefused::LaterRevision(there.path));
            };
            revision = next;
        }
    }

    /// Signs the next passport and verifies it with the trust of `seal`, but does not write it, so that several can be
    /// written together with [`files::together::write_together`].
    pub(crate) fn seal(&self, next: Next, seal: Seal) -> Result<Sealed, FolderRefused> {
        match next {
            Next::There(issued) => Ok(Sealed { issued, text: None }),
            Next::New { path, draft } => {
                let text = draft.sign(seal.signer)?;
                if let Some(trust) = seal.trust {
                    check_verifiable(&path, &text, &draft, trust)?;
                }
                let (id, sha256) = (draft.content().passport.id.clone(), sha256_hex(text.as_bytes()));
                let issued = Issued { id, path, sha256, new: true, remarks: draft.remarks() };
                Ok(Sealed { issued, text: Some(text) })
            }
        }
    }

    /// Signs and writes the next passport. If another run writes a file of that name first, the next step is determined
    /// again.
    pub(crate) fn settle(
        &self,
        next: impl Fn() -> Result<Next, FolderRefused>,
        seal: Seal,
    ) -> Result<Issued, FolderRefused> {
        let settle_once = || {
            let Sealed { issued, text } = self.seal(next()?, seal)?;
            if let Some(text) = text {
                files::write_new_as(&issued.path, text.as_bytes(), Access::Shared, self.durability)?;
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

    /// Checks the path from the root to the folder of a file: none of the folders is a link, and no other name next to one
    /// of them differs from it only in case. This is done once for all files in that folder.
    fn check_folder(&self, last: &Path) -> Result<(), FolderRefused> {
        self.checked.visit(last, || {
            let way: Vec<&Path> = last.ancestors().take_while(|folder| or_here(folder) != self.root()).collect();
            way.iter().try_for_each(|folder| check_link(folder))?;
            way.iter().rev().try_for_each(|folder| check_case(&self.folders, folder))?;
            Ok(last.is_dir())
        })
    }

    /// Checks the path at which a file of another kind is to be written, as that of a passport is checked.
    pub(crate) fn check_place(&self, file: &Path) -> Result<(), FolderRefused> {
        self.check_folder(files::folder_of(file))?;
        check_link(file)?;
        check_case(&self.files, file)
    }

    /// Returns the existing passport at a path, or `None` if there is no file.
    fn existing(&self, path: &Path) -> Result<Option<Existing>, FolderRefused> {
        self.check_folder(files::folder_of(path))?;
        check_case(&self.sites, path)?;
        let found = match path.symlink_metadata() {
            Ok(found) => found,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(FileError::Read(path.to_owned(), error).into()),
        };
        check_link(path)?;
        // Opening a pipe of that name could block indefinitely.
        if !found.is_file() && !found.is_dir() {
            let reason = "a pipe, a device or a socket".to_owned();
            return Err(FolderRefused::NotComparable(path.to_owned(), reason));
        }
        match files::read(path, LARGEST_DOCUMENT_BYTES) {
            Err(error) if error.is_missing() => Ok(None),
            Err(error) => Err(error.into()),
            Ok(bytes) => Existing::of(path, &bytes).map(Some),
        }
    }
}

fn check_link(path: &Path) -> Result<(), FolderRefused> {
    if path.is_symlink() { Err(FolderRefused::Link(path.to_owned())) } else { Ok(()) }
}

/// Checks that no other name in the same folder differs from that of `path` only in case.
fn check_case(names: &Names, path: &Path) -> Result<(), FolderRefused> {
    match names.add(path)? {
        Some(there) => Err(FolderRefused::OtherCase { path: path.to_owned(), there }),
        None => Ok(()),
    }
}

/// Number of folders from a passport to its root: `<model>/<serial>` and the root itself.
const FOLDERS_OF_A_PASSPORT: usize = 3;

/// Syncs the names of passports that were written with [`Durability::NameLater`], and those of the folders from the
/// root to them.
pub(crate) fn sync_names<'a>(
    durability: Durability,
    passports: impl Iterator<Item = &'a Path>,
) -> Result<(), FileError> {
    if durability != Durability::NameLater {
        return Ok(());
    }
    let above = passports.flat_map(|file| file.ancestors().skip(1).take(FOLDERS_OF_A_PASSPORT));
    let folders: BTreeSet<&Path> = above.map(or_here).collect();
    for folder in folders {
        files::sync_folder(folder).map_err(|error| FileError::Write(folder.to_owned(), error))?;
    }
    Ok(())
}

/// Verifies a passport before it is written, because one that fails verification is useless.
fn check_verifiable(path: &Path, text: &str, draft: &Draft, trust: &Trust) -> Result<(), FolderRefused> {
    let question = Question::at(draft.content().passport.issued_at);
    let verification = verify(&name_of(path), text.as_bytes(), trust, &question);
    match verification.failed() {
        None => Ok(()),
        Some(failed) => {
            Err(FolderRefused::NotVerifiable(failed.name.as_str(), for_the_issuer(&failed.detail).to_owned()))
        }
    }
}

struct Existing {
    path: PathBuf,
    sha256: String,
    content: Content,
}

impl Existing {
    fn of(path: &Path, bytes: &[u8]) -> Result<Self, FolderRefused> {
        let name = name_of(path);
        let incomparable = |reason: String| FolderRefused::NotComparable(path.to_owned(), reason);
        let text = SignedText::split(&name, bytes, NAMESPACE)
            .map_err(|malformed| incomparable(malformed.fault.to_string()))?;
        let payload = text.signed_payload(None).map_err(|error| incomparable(error.to_string()))?;
        let content = content::read(&name, payload).map_err(|error| incomparable(error.to_string()))?;
        Ok(Self { path: path.to_owned(), sha256: sha256_hex(bytes), content })
    }

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
                (true, false) => return FolderRefused::OtherAccuracy(self.path),
                (false, _) if there.revision > new.passport.revision => return FolderRefused::Done(self.path),
                _ => {}
            }
        }
        let mut words: Vec<String> = [valid_until, accuracy, reissued].into_iter().flatten().collect();
        if changed != NO_CHANGES || words.is_empty() {
            words.push(changed);
        }
        FolderRefused::OtherContent(self.path, words.join("; "))
    }
}

/// Returns `true` if two passports are equal apart from the time of issue and the program that wrote them.
fn same(there: &Content, new: &Content) -> bool {
    let mut there = there.clone();
    there.passport.issued_at = new.passport.issued_at;
    there.passport.issued_with.clone_from(&new.passport.issued_with);
    there == *new
}
