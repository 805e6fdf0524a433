//! Passports in a folder: where each stands, what is there already, new ones written whole and never over another.
//!
//! * `search`: what is there.

mod claim;
mod names;
pub(crate) mod search;
mod superseding;
mod visited;

pub use crate::files::{Durability, FileError};
pub use search::register;
pub(crate) use superseding::Superseding;
pub(crate) use visited::Visited;

use crate::document::sha256_hex;
use crate::document::{SignedText, Signer};
use crate::files::{self, Access};
use crate::passport::content::Content;
use crate::passport::issue::{Draft, Issue, IssueRefused, PreparedStand, Remarks};
use crate::passport::reissue::{Successor, changes};
use crate::passport::verification::{Question, Trust, verify};
use crate::passport::{NAMESPACE, read};
use crate::register::Asked;
use crate::site::Site;
use crate::stand::{Identity, Stand};
use crate::text::scalar::Identifier;
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of, shown};
use jiff::Timestamp;
use jiff::civil::Date;
use names::{Names, Of};
use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};

/// A folder of passports: `<model>/<serial>/<site id>-<revision>.yaml`.
#[derive(Debug)]
pub struct Folder {
    root: PathBuf,
    durability: Durability,
    /// Folders below that are no links.
    no_links: Visited,
    /// Names of models and serial numbers, and of sites.
    folders: Names,
    sites: Names,
}

/// Who signs, and by whose trust a new passport must hold before it is written.
#[derive(Clone, Copy)]
pub struct Seal<'a> {
    /// The signer.
    pub signer: &'a (dyn Signer + Sync),
    /// The trust of those who will verify; `None` to leave that to them.
    pub trust: Option<&'a Trust>,
}

/// What became of an order.
#[derive(Debug, Clone, PartialEq)]
pub struct Issued {
    /// The passport's id.
    pub id: String,
    /// Its file.
    pub path: PathBuf,
    /// SHA-256 of the file.
    pub sha256: String,
    /// Whether it is new; otherwise an equal one was there, and was left.
    pub new: bool,
    /// What the factory should know about it.
    pub remarks: Remarks,
}

/// What an order comes to.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Next {
    /// An equal passport is there.
    There(Issued),
    /// A new one, which is yet to be signed and written.
    New(Unwritten),
}

/// A passport that was computed and checked, and is not there yet.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Unwritten {
    path: PathBuf,
    draft: Box<Draft>,
}

impl Unwritten {
    /// Its id.
    pub(crate) fn id(&self) -> &str {
        &self.draft.content().passport.id
    }

    /// Its file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// What the factory should know about it.
    pub(crate) fn remarks(&self) -> Remarks {
        self.draft.remarks()
    }
}

/// How often an order is looked at again because another run was faster. Each time that one wrote a passport.
const ATTEMPTS: usize = 8;

/// Why a folder got no new passport.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FolderRefused {
    /// A passport with other content has the name.
    #[error(
        "{}: already exists with other content ({changed}); to issue the changes, use `reissue {}`",
        shown(path),
        shown(path)
    )]
    OtherContent {
        /// The file that is there.
        path: PathBuf,
        /// What differs from it, in words.
        changed: String,
    },
    /// The old passport has another successor already.
    #[error(
        "{}: is already a successor of this passport for this site, with other content; re-issue that successor",
        shown(path)
    )]
    OtherSuccessor {
        /// The successor that is there.
        path: PathBuf,
    },
    /// The old passport is superseded already, by a passport for another site or in another folder.
    #[error(
        "{}: already supersedes this passport; re-issue that successor, because a second one would be a fork",
        shown(path)
    )]
    Fork {
        /// The successor that is there.
        path: PathBuf,
    },
    /// The next revision is there, made from another passport.
    #[error(
        "{}: is already the next revision for this site, re-issued from another passport; re-issue that revision",
        shown(path)
    )]
    LaterRevision {
        /// The revision that is there.
        path: PathBuf,
    },
    /// What has the name is no passport.
    #[error(
        "{}: already exists and cannot be compared as a passport ({reason}); move it to another folder",
        shown(path)
    )]
    NotComparable {
        /// The file that is there.
        path: PathBuf,
        /// Why it cannot be compared.
        reason: String,
    },
    /// A link stands in its way.
    #[error("{}: is a link; specify its target with --out, because links may lead out of the folder", shown(path))]
    Link {
        /// The link.
        path: PathBuf,
    },
    /// A name that differs only in case is there already.
    #[error(
        "{}: found {}, which differs only in case; use the same spelling, or rename one, because Windows and macOS do \
         not distinguish them",
        shown(path),
        shown(there)
    )]
    OtherCase {
        /// The folder or the file that would stand beside it.
        path: PathBuf,
        /// What is there.
        there: PathBuf,
    },
    /// By the trust given, nobody could verify it.
    #[error("the new passport failed verification ({check}: {detail}); nothing was written")]
    NotVerifiable {
        /// The check that failed.
        check: &'static str,
        /// In its words.
        detail: String,
    },
    /// No such passport can be issued.
    #[error(transparent)]
    Issue(#[from] IssueRefused),
    /// The file system refused.
    #[error(transparent)]
    File(#[from] FileError),
}

impl FolderRefused {
    /// Whether the file system or the signer refused, which is no verdict on a document.
    pub(crate) fn is_unusable(&self) -> bool {
        match self {
            Self::File(FileError::Exists { .. }) => false,
            Self::File(_) | Self::Issue(IssueRefused::Signing(_) | IssueRefused::Identity(_)) => true,
            _ => false,
        }
    }
}

impl Folder {
    /// The folder `root`, which need not exist yet. What is written to it is safe from a loss of power at once.
    pub fn new(root: impl Into<PathBuf>) -> Self {
        let (folders, sites) = (Names::new(Of::Folders), Names::new(Of::Passports));
        Self { root: root.into(), durability: Durability::Named, no_links: Visited::default(), folders, sites }
    }

    /// The same folder; what is written to it is as safe from a loss of power as `durability` says.
    pub fn with_durability(self, durability: Durability) -> Self {
        Self { durability, ..self }
    }

    /// The folder itself.
    pub fn root(&self) -> &Path {
        or_here(&self.root)
    }

    /// Returns the root that the path of a passport of `stand` shows, or `None` unless the two folders above the file are
    /// `<model>/<serial>`.
    pub(crate) fn root_of<'a>(path: &'a Path, stand: &Identity) -> Option<&'a Path> {
        let serial = path.parent()?;
        let model = serial.parent()?;
        let shows = serial.file_name()? == stand.serial.as_str() && model.file_name()? == stand.model.as_str();
        model.parent().filter(|_| shows)
    }

    /// Where the passport of a stand for a site stands.
    pub fn path_of(&self, stand: &Identity, site: &Identifier, revision: u32) -> PathBuf {
        let folder = self.root.join(stand.model.as_str()).join(stand.serial.as_str());
        folder.join(format!("{site}-{revision}.yaml"))
    }

    /// Where the passport with this id stands; `None` when that is no id.
    pub(crate) fn path_of_id(&self, id: &str) -> Option<PathBuf> {
        let parts: Vec<&str> = id.split('/').collect();
        let [model, serial, site, revision] = parts.as_slice() else { return None };
        let names = [model, serial, site].map(|name| Identifier::new(name).ok());
        let [Some(model), Some(serial), Some(site)] = names else { return None };
        let revision: u32 = revision.parse().ok()?;
        Some(self.root.join(model.as_str()).join(serial.as_str()).join(format!("{site}-{revision}.yaml")))
    }

    /// Returns in words what speaks against one more passport from the certificate of `stand`, by the passports of the stand
    /// that are there and count by `trust`: that the certificate was replaced, or that another one is in force.
    pub(crate) fn against_certificate(&self, stand: &Stand, trust: &Trust, time: Timestamp) -> Vec<String> {
        let folder = self.root.join(stand.stand.model.as_str()).join(stand.stand.serial.as_str());
        let number = &stand.certificate.number;
        if !superseding::has_other_certificate(&folder, number) {
            return Vec::new();
        }
        match search::register(&folder, trust.clone(), &Asked::at(time), 1) {
            Ok((register, _)) => register.against_certificate(&stand.stand.id(), number),
            Err(_) => Vec::new(),
        }
    }

    /// Issues revision 1 of a stand for a site.
    ///
    /// An equal passport (its time, program and signature aside) is left as it is; another one of that name is never
    /// replaced.
    ///
    /// # Errors
    /// See [`FolderRefused`].
    pub fn issue(
        &self,
        stand: &PreparedStand,
        site: &Site,
        order: &Issue,
        seal: Seal,
    ) -> Result<Issued, FolderRefused> {
        self.settle(|| self.next_first(stand, site, order), seal)
    }

    /// What [`Self::issue`] would do; nothing is signed or written.
    ///
    /// # Errors
    /// See [`FolderRefused`].
    pub(crate) fn next_first(&self, stand: &PreparedStand, site: &Site, order: &Issue) -> Result<Next, FolderRefused> {
        let draft = Box::new(stand.draft(site, order)?);
        let stand = stand.stand();
        let path = self.path_of(&stand.stand, &site.id, order.revision);
        match self.existing(&path)? {
            Some(there) if same(&there.content, draft.content()) => Ok(Next::There(there.left(&draft))),
            Some(there) => {
                let changed = there.differences(stand, site, draft.content());
                Err(FolderRefused::OtherContent { path: there.path, changed })
            }
            None => Ok(Next::New(Unwritten { path, draft })),
        }
    }

    /// Issues the successor of a passport.
    ///
    /// # Errors
    /// See [`FolderRefused`].
    pub fn reissue(&self, successor: &Successor, seal: Seal) -> Result<Issued, FolderRefused> {
        self.settle(|| self.next_successor(successor), seal)
    }

    /// What [`Self::reissue`] would do; nothing is signed or written.
    ///
    /// # Errors
    /// See [`FolderRefused`].
    pub(crate) fn next_successor(&self, successor: &Successor) -> Result<Next, FolderRefused> {
        let mut revision = successor.first_revision();
        loop {
            let draft = Box::new(successor.draft(revision)?);
            let path = self.path_of(&successor.stand().stand, &successor.site().id, revision);
            let Some(there) = self.existing(&path)? else {
                return match successor.rival() {
                    Some(rival) => Err(FolderRefused::Fork { path: rival.to_owned() }),
                    None => Ok(Next::New(Unwritten { path, draft })),
                };
            };
            let of_the_same = there.predecessor_sha256() == Some(successor.old_sha256());
            if same(&there.content, draft.content()) {
                return Ok(Next::There(there.left(&draft)));
            }
            if of_the_same {
                return Err(FolderRefused::OtherSuccessor { path: there.path });
            }
            // At the old site only one revision can be the next; at another the one after it is free.
            if successor.same_site() {
                return Err(FolderRefused::LaterRevision { path: there.path });
            }
            revision = revision.saturating_add(1);
        }
    }

    /// Signs and writes what comes next. When another run writes a file of that name first, what comes next is asked
    /// again.
    fn settle(&self, next: impl Fn() -> Result<Next, FolderRefused>, seal: Seal) -> Result<Issued, FolderRefused> {
        for _ in 1..ATTEMPTS {
            match self.settle_once(&next, seal) {
                Err(FolderRefused::File(FileError::Exists { .. })) => {}
                settled => return settled,
            }
        }
        self.settle_once(&next, seal)
    }

    fn settle_once(&self, next: impl Fn() -> Result<Next, FolderRefused>, seal: Seal) -> Result<Issued, FolderRefused> {
        match next()? {
            Next::There(issued) => Ok(issued),
            Next::New(new) => self.write(new, seal),
        }
    }

    fn write(&self, new: Unwritten, seal: Seal) -> Result<Issued, FolderRefused> {
        let Unwritten { path, draft } = new;
        let text = draft.sign(seal.signer)?;
        if let Some(trust) = seal.trust {
            check_verifiable(&path, &text, &draft, trust)?;
        }
        files::write_new_as(&path, text.as_bytes(), Access::Shared, self.durability)?;
        let id = draft.content().passport.id.clone();
        Ok(Issued { id, path, sha256: sha256_hex(text.as_bytes()), new: true, remarks: draft.remarks() })
    }

    /// Whether the way from the root to `folder` has no link, asked once for all its passports.
    fn check_for_links(&self, folder: &Path) -> Result<(), FolderRefused> {
        self.no_links.visit(folder, || {
            let mut way = folder.ancestors().take_while(|folder| *folder != self.root);
            match way.find(|folder| folder.is_symlink()) {
                Some(link) => Err(FolderRefused::Link { path: link.to_owned() }),
                None => Ok(folder.is_dir()),
            }
        })
    }

    /// Whether model, serial number and site have no neighbours that a system without case would take for them.
    fn check_case(&self, path: &Path) -> Result<(), FolderRefused> {
        let stand = files::folder_of(path);
        for (names, path) in [(&self.folders, files::folder_of(stand)), (&self.folders, stand), (&self.sites, path)] {
            if let Some(there) = names.add(path)? {
                return Err(FolderRefused::OtherCase { path: path.to_owned(), there });
            }
        }
        Ok(())
    }

    /// The passport that is there already.
    fn existing(&self, path: &Path) -> Result<Option<Existing>, FolderRefused> {
        self.check_for_links(files::folder_of(path))?;
        self.check_case(path)?;
        let found = match path.symlink_metadata() {
            Ok(found) => found,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(FileError::Read { path: path.to_owned(), error }.into()),
        };
        if found.is_symlink() {
            return Err(FolderRefused::Link { path: path.to_owned() });
        }
        // A pipe of that name would keep its reader waiting for ever.
        if !found.is_file() && !found.is_dir() {
            let reason = "a pipe, a device or a socket".to_owned();
            return Err(FolderRefused::NotComparable { path: path.to_owned(), reason });
        }
        match files::read(path, LARGEST_DOCUMENT_BYTES) {
            Err(FileError::Read { error, .. }) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error.into()),
            Ok(bytes) => Existing::of(path, &bytes).map(Some),
        }
    }
}

/// The folders from a passport to its root: `<model>/<serial>` and the root itself.
const FOLDERS_OF_A_PASSPORT: usize = 3;

/// Makes the names of passports safe that were written with [`Durability::NameLater`]: theirs, and those of the folders
/// from the root to them.
///
/// # Errors
/// The first folder that cannot be made safe, with what the system says.
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
        files::sync_folder(folder).map_err(|error| FileError::Write { path: folder.to_owned(), error })?;
    }
    Ok(())
}

/// The current folder for the empty path, which is its name in the parents of a relative path.
fn or_here(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

/// A passport that nobody could verify is worse than none.
fn check_verifiable(path: &Path, text: &str, draft: &Draft, trust: &Trust) -> Result<(), FolderRefused> {
    let question = Question::at(draft.content().passport.issued_at);
    let verification = verify(&name_of(path), text.as_bytes(), trust, &question);
    match verification.checks().iter().find(|check| check.passed() != Some(true)) {
        None => Ok(()),
        Some(failed) => {
            Err(FolderRefused::NotVerifiable { check: failed.name.as_str(), detail: failed.detail.clone() })
        }
    }
}

/// A passport that is there already.
struct Existing {
    path: PathBuf,
    sha256: String,
    content: Content,
}

impl Existing {
    fn of(path: &Path, bytes: &[u8]) -> Result<Self, FolderRefused> {
        let name = name_of(path);
        let incomparable = |reason: String| FolderRefused::NotComparable { path: path.to_owned(), reason };
        let text = SignedText::split(&name, bytes, NAMESPACE)
            .map_err(|malformed| incomparable(malformed.fault.to_string()))?;
        let payload = text.signed_payload().map_err(|error| incomparable(error.to_string()))?;
        let content = read::content(&name, payload).map_err(|error| incomparable(error.to_string()))?;
        Ok(Self { path: path.to_owned(), sha256: sha256_hex(bytes), content })
    }

    fn left(self, draft: &Draft) -> Issued {
        let id = self.content.passport.id.clone();
        Issued { id, path: self.path, sha256: self.sha256, new: false, remarks: draft.remarks() }
    }

    /// What differs from it, in words; its revision was issued, `new` would be too.
    fn differences(&self, stand: &Stand, site: &Site, new: &Content) -> String {
        let there = &self.content.passport;
        let mut words = changes(&self.content, stand, site, &new.passport.issuer);
        if let Some(predecessor) = &there.reissued_from {
            words = format!("re-issued from {}; {words}", predecessor.id);
        }
        if there.valid_until != new.passport.valid_until {
            let day = |day: Option<Date>| day.map_or_else(|| "none".to_owned(), |day| day.to_string());
            words = format!("valid until {} -> {}; {words}", day(there.valid_until), day(new.passport.valid_until));
        }
        words
    }

    fn predecessor_sha256(&self) -> Option<&str> {
        self.content.passport.reissued_from.as_ref().map(|predecessor| predecessor.sha256.as_str())
    }
}

/// Whether two passports say the same, the time of issue and the program that wrote them aside.
fn same(there: &Content, new: &Content) -> bool {
    let mut there = there.clone();
    there.passport.issued_at = new.passport.issued_at;
    there.passport.issued_with.clone_from(&new.passport.issued_with);
    there == *new
}
