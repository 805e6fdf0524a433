//! Reasons why a passport is not written to a folder.

use crate::files::FileError;
use crate::passport::issue::IssueRefused;
use crate::register::{Doubt, Entry, NoRegister, RegisterRefused};
use crate::text::shown;
use std::path::{Path, PathBuf};

/// Reason why no new passport was written to a folder.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FolderRefused {
    /// What is at this path, or missing there, and what to do, in words.
    #[error("{}: {}", shown(.0), .1)]
    There(PathBuf, String),
    /// Existing passport of a signer who is not trusted: fingerprint and reason.
    #[error(
        "{}: already exists, signed by {fingerprint}, which --trust does not accept ({why}); nothing was written; find out \
         who put it there, and move it to another folder",
        shown(path)
    )]
    Foreign {
        /// Path of the passport.
        path: PathBuf,
        /// Fingerprint of the signing key.
        fingerprint: String,
        /// Check that failed, in words.
        why: String,
    },
    /// Successor that would say the same as its predecessor.
    #[error(
        "nothing would change, because stand, site, issuer and expiry date are those of this passport; give the corrected \
         file with --site or --stand, or use --same-content to sign the same content again"
    )]
    NothingChanges,
    /// Passports without a register.
    #[error(
        "{}: has passports, such as {}, but no register; make it with `register DIR --renew`, or restore it from the \
         backup",
        shown(folder),
        shown(passport)
    )]
    NoRegister {
        /// Folder of the stand.
        folder: PathBuf,
        /// First passport in it.
        passport: PathBuf,
    },
    /// Register that is not accepted.
    #[error("{0}")]
    Register(#[from] RegisterRefused),
    /// Register that does not count beside the last one of the workspace, or that contradicts the one read before.
    #[error("{}: {}", shown(.0), .1)]
    Doubt(PathBuf, Doubt),
    /// Register that cannot be issued.
    #[error(transparent)]
    NoNewRegister(#[from] NoRegister),
    /// Register that another run has kept locked.
    #[error("{}: another run has kept the register locked for 30 s; wait for it, and run the command again", shown(.0))]
    Locked(PathBuf),
    /// Order without a signing key.
    #[error("no key was given to sign with")]
    NoSigner,
    /// Link in the path of the passport.
    #[error("{}: is a link; specify its target with --out, because links may lead out of the folder", shown(.0))]
    Link(PathBuf),
    /// New passport that fails verification with the given trust: the check that failed and its detail.
    #[error(
        "the new passport failed verification ({0}: {1}); nothing was written; check --key, --identity and --trust"
    )]
    NotVerifiable(&'static str, String),
    /// Passport that cannot be issued.
    #[error(transparent)]
    Issue(#[from] IssueRefused),
    /// Failure of the file system.
    #[error(transparent)]
    File(#[from] FileError),
}

impl FolderRefused {
    /// Returns `true` if the file system or the signer failed, `false` if a document was refused.
    pub(crate) fn is_unusable(&self) -> bool {
        match self {
            Self::File(FileError::Exists { .. }) => false,
            Self::File(_)
            | Self::Locked(_)
            | Self::NoSigner
            | Self::Issue(IssueRefused::Signing(_) | IssueRefused::Identity(_))
            | Self::NoNewRegister(NoRegister::Signing(_) | NoRegister::Identity(_)) => true,
            _ => false,
        }
    }

    pub(super) fn there(path: PathBuf, words: impl Into<String>) -> Self {
        Self::There(path, words.into())
    }

    /// Returns the refusal of an existing file that is not a passport, and why it cannot be compared as one.
    pub(super) fn not_comparable(path: PathBuf, why: &str) -> Self {
        Self::There(
            path,
            format!("already exists and cannot be compared as a passport ({why}); move it to another folder"),
        )
    }

    /// Returns the refusal of a path next to which another name, `there`, differs only in case.
    pub(super) fn other_case(path: PathBuf, there: &Path) -> Self {
        let there = shown(there);
        let words = format!(
            "found {there}, which differs only in case; use the same spelling, or rename one, because Windows and macOS do \
             not distinguish them"
        );
        Self::There(path, words)
    }

    /// Returns the refusal of a revision that is missing before an existing one.
    pub(super) fn gap(path: PathBuf, later: PathBuf) -> Self {
        let later = shown(&later);
        let words = format!(
            "is missing, but there is a later revision, {later}, which supersedes it; to issue a new one, use `reissue {later}`"
        );
        Self::There(path, words)
    }

    /// Returns the refusal of a passport whose entry is not current.
    pub(super) fn ended(path: PathBuf, entry: &Entry) -> Self {
        let advice = if entry.by.is_some() { "; re-issue that passport" } else { "" };
        Self::There(path, format!("listed in the register as {}{advice}", entry.ended()))
    }
}
