//! Passports in a folder: where each stands, what is there already, new ones written whole and never over another.

use crate::document::sha256_hex;
use crate::document::{SignedText, Signer};
use crate::files::{self, Access, FileError};
use crate::passport::content::Content;
use crate::passport::issue::{self, Draft, Issue, IssueRefused, Remarks};
use crate::passport::reissue::{Successor, changes};
use crate::passport::verification::{Question, Trust, verify};
use crate::passport::{NAMESPACE, read};
use crate::site::Site;
use crate::stand::{Identity, Stand};
use crate::text::LARGEST_DOCUMENT_BYTES;
use crate::text::scalar::Identifier;
use jiff::civil::Date;
use std::io;
use std::path::{Path, PathBuf};

/// A folder of passports: `<model>/<serial>/<site id>-<revision>.yaml`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Folder {
    root: PathBuf,
}

/// Who signs, and by whose trust a new passport must hold before it is written.
#[derive(Clone, Copy)]
pub struct Seal<'a> {
    /// The signer.
    pub signer: &'a dyn Signer,
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

/// Why a folder got no new passport.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FolderRefused {
    /// A passport with other content has the name.
    #[error(
        "{}: exists with other content ({changed}); what has changed is re-issued: `reissue {}`",
        path.display(),
        path.display()
    )]
    OtherContent {
        /// The file that is there.
        path: PathBuf,
        /// What differs from it, in words.
        changed: String,
    },
    /// The old passport has another successor already.
    #[error(
        "{}: is already a successor of the same passport for this site, with other content; re-issue that one",
        path.display()
    )]
    OtherSuccessor {
        /// The successor that is there.
        path: PathBuf,
    },
    /// The next revision is there, made from another passport.
    #[error("{}: is already the next revision for this site, made from another passport; re-issue that one", path.display())]
    LaterRevision {
        /// The revision that is there.
        path: PathBuf,
    },
    /// What has the name is no passport.
    #[error("{}: exists and is no passport that can be compared ({reason}); move it away", path.display())]
    NotComparable {
        /// The file that is there.
        path: PathBuf,
        /// Why it cannot be compared.
        reason: String,
    },
    /// By the trust given, nobody could verify it.
    #[error("the new passport would not verify ({check}: {detail}); nothing was written")]
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

impl Folder {
    /// The folder `root`, which need not exist yet.
    pub fn new(root: impl Into<PathBuf>) -> Self {
        Self { root: root.into() }
    }

    /// Where the passport of a stand for a site stands.
    pub fn path_of(&self, stand: &Identity, site: &Identifier, revision: u32) -> PathBuf {
        let folder = self.root.join(stand.model.as_str()).join(stand.serial.as_str());
        folder.join(format!("{site}-{revision}.yaml"))
    }

    /// Where the passport with this id stands; `None` when that is no id.
    pub fn path_of_id(&self, id: &str) -> Option<PathBuf> {
        let parts: Vec<&str> = id.split('/').collect();
        let [model, serial, site, revision] = parts.as_slice() else { return None };
        let names = [model, serial, site].map(|name| Identifier::new(name).ok());
        let [Some(model), Some(serial), Some(site)] = names else { return None };
        let revision: u32 = revision.parse().ok()?;
        Some(self.root.join(model.as_str()).join(serial.as_str()).join(format!("{site}-{revision}.yaml")))
    }

    /// Issues revision 1 of a stand for a site.
    ///
    /// An equal passport (its time, program and signature aside) is left as it is; another one of that name is never
    /// replaced.
    ///
    /// # Errors
    /// See [`FolderRefused`].
    pub fn issue(&self, stand: &Stand, site: &Site, order: &Issue, seal: Seal) -> Result<Issued, FolderRefused> {
        let draft = issue::draft(stand, site, order)?;
        let path = self.path_of(&stand.stand, &site.id, order.revision);
        match existing(&path)? {
            Some(there) if same(&there.content, draft.content()) => Ok(there.left(&draft)),
            Some(there) => {
                let changed = there.differences(stand, site, draft.content());
                Err(FolderRefused::OtherContent { path: there.path, changed })
            }
            None => write(path, &draft, seal),
        }
    }

    /// Issues the successor of a passport.
    ///
    /// # Errors
    /// See [`FolderRefused`].
    pub fn reissue(&self, successor: &Successor, seal: Seal) -> Result<Issued, FolderRefused> {
        let mut revision = successor.first_revision();
        loop {
            let draft = successor.draft(revision)?;
            let path = self.path_of(&successor.stand().stand, &successor.site().id, revision);
            let Some(there) = existing(&path)? else { return write(path, &draft, seal) };
            let of_the_same = there.predecessor_sha256() == Some(successor.old_sha256());
            if same(&there.content, draft.content()) {
                return Ok(there.left(&draft));
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
}

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
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        if let Err(error) = search(&folder, &mut found, &mut folders) {
            let error = FileError::Read { path: folder.clone(), error };
            if folder == root {
                return Err(error);
            }
            found.unreadable.push(error);
        }
    }
    found.passports.sort();
    found.revocation_lists.sort();
    found.links.sort();
    found.special.sort();
    Ok(found)
}

fn search(folder: &Path, found: &mut Found, folders: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let kind = entry.file_type()?;
        let path = entry.path();
        match numbered(&path) {
            _ if kind.is_dir() => folders.push(path),
            name if kind.is_symlink() && (name.is_some() || path.is_dir()) => found.links.push(path),
            None => {}
            Some(_) if !kind.is_file() => found.special.push(path),
            Some("revocation") => found.revocation_lists.push(path),
            Some(_) => found.passports.push(path),
        }
    }
    Ok(())
}

/// What stands before the number in `<name>-<number>.yaml`.
fn numbered(path: &Path) -> Option<&str> {
    let (name, number) = path.file_name()?.to_str()?.strip_suffix(".yaml")?.rsplit_once('-')?;
    (!number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())).then_some(name)
}

fn write(path: PathBuf, draft: &Draft, seal: Seal) -> Result<Issued, FolderRefused> {
    let text = draft.sign(seal.signer)?;
    if let Some(trust) = seal.trust {
        check_verifiable(&path, &text, draft, trust)?;
    }
    files::write_new(&path, text.as_bytes(), Access::Shared)?;
    let id = draft.content().passport.id.clone();
    Ok(Issued { id, path, sha256: sha256_hex(text.as_bytes()), new: true, remarks: draft.remarks() })
}

/// A passport that nobody could verify is worse than none.
fn check_verifiable(path: &Path, text: &str, draft: &Draft, trust: &Trust) -> Result<(), FolderRefused> {
    let question = Question::at(draft.content().passport.issued_at);
    let verification = verify(&path.display().to_string(), text.as_bytes(), trust, &question);
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
            words = format!("last day {} -> {}; {words}", day(there.valid_until), day(new.passport.valid_until));
        }
        words
    }

    fn predecessor_sha256(&self) -> Option<&str> {
        self.content.passport.reissued_from.as_ref().map(|predecessor| predecessor.sha256.as_str())
    }
}

fn existing(path: &Path) -> Result<Option<Existing>, FolderRefused> {
    if !path.try_exists().map_err(|error| FileError::Read { path: path.to_owned(), error })? {
        return Ok(None);
    }
    let incomparable = |reason: String| FolderRefused::NotComparable { path: path.to_owned(), reason };
    // A pipe of that name would keep its reader waiting for ever.
    if std::fs::metadata(path).is_ok_and(|what| !what.is_file() && !what.is_dir()) {
        return Err(incomparable("a pipe, a device or a socket".to_owned()));
    }
    let bytes = files::read(path, LARGEST_DOCUMENT_BYTES)?;
    let name = path.display().to_string();
    let text =
        SignedText::split(&name, &bytes, NAMESPACE).map_err(|malformed| incomparable(malformed.fault.to_string()))?;
    let payload = text.signed_payload().map_err(|error| incomparable(error.to_string()))?;
    let content = read::content(&name, payload).map_err(|error| incomparable(error.to_string()))?;
    Ok(Some(Existing { path: path.to_owned(), sha256: sha256_hex(&bytes), content }))
}

/// Whether two passports say the same, the time of issue and the program that wrote them aside.
fn same(there: &Content, new: &Content) -> bool {
    let mut there = there.clone();
    there.passport.issued_at = new.passport.issued_at;
    there.passport.issued_with.clone_from(&new.passport.issued_with);
    there == *new
}
