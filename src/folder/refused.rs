//! Reasons why a passport is not written to a folder.

use crate::files::FileError;
use crate::passport::issue::IssueRefused;
use crate::stand::number::NumberInUse;
use crate::text::shown;
use std::path::PathBuf;

/// End of a refusal, after which the identifier of that passport may follow.
pub(crate) const THE_ONE_IN_FORCE: &str = "the passport that is in force";

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
        "{}: is already a successor of this passport for this site, with different content; re-issue {THE_ONE_IN_FORCE}",
        shown(.0)
    )]
    OtherSuccessor(PathBuf),
    /// Existing passport that supersedes the predecessor for another site or in another folder.
    #[error(
        "{}: already supersedes this passport, and a second successor would be a fork; re-issue {THE_ONE_IN_FORCE}",
        shown(.0)
    )]
    Fork(PathBuf),
    /// Successor that would say the same as its predecessor.
    #[error(
        "nothing would change, because stand, site, issuer and expiry date are those of this passport; give the corrected \
         file with --site or --stand, or use --same-content to sign the same content again"
    )]
    NothingChanges,
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
            Self::File(_) | Self::Issue(IssueRefused::Signing(_) | IssueRefused::Identity(_)) => true,
            _ => false,
        }
    }
}
