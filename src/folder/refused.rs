//! Reasons why a passport is not written to a folder.

use crate::files::FileError;
use crate::passport::issue::IssueRefused;
use crate::register::{Contradiction, Entry, NoRegister, RegisterRefused, State};
use crate::stand::remarks::NumberInUse;
use crate::text::shown;
use std::path::PathBuf;

/// Reason why no new passport was written to a folder.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FolderRefused {
    /// Existing passport of this name with other content, and the differences in words.
    #[error(
        "{}: already exists with different content ({}); if the changes are intended, issue them with `reissue {}` \
         and the changed --stand, --site, --valid-until or --identity",
        shown(.0),
        .1,
        shown(.0)
    )]
    OtherContent(PathBuf, String),
    /// Last revision for this site, which has the content of the one to be issued.
    #[error("{}: has this content already; it is the last revision for this site, and nothing is left to issue", shown(.0))]
    Done(PathBuf),
    /// Existing passport of this name that states another expected uncertainty.
    #[error(
        "{}: already exists with other values of --accuracy, --gyro or --laboratory; repeat the options with which it was \
         issued, or withdraw it with `revoke` and issue the new one to another folder with --out",
        shown(.0)
    )]
    OtherAccuracy(PathBuf),
    /// Existing successor of the predecessor for this site, with different content.
    #[error(
        "{}: is already a successor of this passport for this site, with different content; re-issue the passport that is current",
        shown(.0)
    )]
    OtherSuccessor(PathBuf),
    /// Passport that is listed as superseded, moved or withdrawn, and how, in words.
    #[error("{}: listed in the register as {}", shown(.0), .1)]
    Ended(PathBuf, String),
    /// Existing passport with the wanted content, while the register lists another file under its identifier.
    #[error(
        "{}: the register lists another file with this identifier; restore that file from the backup",
        shown(.0)
    )]
    OtherFile(PathBuf),
    /// Passport that is listed in the register, but whose file is missing.
    #[error("{}: missing, but listed in the register; restore the file from the backup, or withdraw it with `revoke`", shown(.0))]
    Lost(PathBuf),
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
    /// Register that cannot be issued.
    #[error(transparent)]
    NoNewRegister(#[from] NoRegister),
    /// Register whose key has expired or was revoked, its SHA-256, and why it is not accepted.
    #[error(
        "{why}; if this is the last register, take it over with --adopt {sha256}; otherwise restore the last one from the \
         backup"
    )]
    Outdated {
        /// SHA-256 of the register.
        sha256: String,
        /// Reason why it is not accepted.
        why: String,
    },
    /// Register of another stand.
    #[error("{}: is the register of {stand}; restore that of this stand from the backup", shown(path))]
    OtherStand {
        /// Path of the register.
        path: PathBuf,
        /// Stand that it states.
        stand: String,
    },
    /// Register that is older than the last one of the workspace.
    #[error("{}: older than register {last}, the last one of this workspace; restore it from the backup", shown(path))]
    OlderRegister {
        /// Path of the register.
        path: PathBuf,
        /// Sequence number of the last one.
        last: u64,
    },
    /// Register that contradicts the last one of the workspace.
    #[error("{}: {}", shown(.0), .1)]
    Contradicted(PathBuf, Contradiction),
    /// Register whose number is too high to be accepted without a person, in words.
    #[error("{}: {}", shown(.0), .1)]
    Unconfirmed(PathBuf, String),
    /// Register that another run has kept locked.
    #[error("{}: another run has kept the register locked for 30 s; wait for it, and run the command again", shown(.0))]
    Locked(PathBuf),
    /// Order without a signing key.
    #[error("no key was given to sign with")]
    NoSigner,
    /// Existing next revision that was re-issued from another passport.
    #[error(
        "{}: is already the next revision for this site, re-issued from another passport; re-issue that revision",
        shown(.0)
    )]
    LaterRevision(PathBuf),
    /// Missing revision before an existing one.
    #[error(
        "{}: is missing, but there is a later revision, {}, which supersedes it; to issue a new one, use `reissue {}`",
        shown(path),
        shown(later),
        shown(later)
    )]
    Gap {
        /// Path of the missing file.
        path: PathBuf,
        /// Path of the last revision.
        later: PathBuf,
    },
    /// Existing file of this name that is not a passport, and why it cannot be compared as one.
    #[error(
        "{}: already exists and cannot be compared as a passport ({}); move it to another folder",
        shown(.0),
        .1
    )]
    NotComparable(PathBuf, String),
    /// Link in the path of the passport.
    #[error("{}: is a link; specify its target with --out, because links may lead out of the folder", shown(.0))]
    Link(PathBuf),
    /// Existing name that differs only in case.
    #[error(
        "{}: found {}, which differs only in case; use the same spelling, or rename one, because Windows and macOS do \
         not distinguish them",
        shown(path),
        shown(there)
    )]
    OtherCase {
        /// Path of the folder or file that would be created.
        path: PathBuf,
        /// Path of the existing folder or file.
        there: PathBuf,
    },
    /// Existing passport that states other angles under the number of the certificate.
    #[error("{}: {}", shown(.0), .1)]
    NumberInUse(PathBuf, NumberInUse),
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

    /// Returns the refusal of a passport whose entry is not current.
    pub(crate) fn ended(path: PathBuf, entry: &Entry) -> Self {
        let since = entry.since.map_or_else(String::new, |since| format!(" since {since}"));
        let words = match (entry.state, &entry.by, &entry.reason) {
            (State::Withdrawn, _, Some(reason)) => format!("withdrawn{since}: {reason}"),
            (state, Some(by), _) => format!("{}{since} by {by}; re-issue that passport", state.key()),
            (state, ..) => format!("{}{since}", state.key()),
        };
        Self::Ended(path, words)
    }
}
