//! Checks of a verification: names, result codes and details.

use crate::text::printable;
use std::fmt::Display;

/// Name of a check; the variants are in the order of the report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum CheckName {
    /// Text rule, split into text and signature, and form of the signature.
    Grammar,
    /// Signature over the text.
    Signature,
    /// Canonical form of the content, and all of its rules.
    Schema,
    /// Key of the issuer, trusted for passports at the time of issue.
    Signer,
    /// Revocation of the key, and withdrawal of the passport.
    Revocation,
    /// Recomputation of every number from the signed inputs.
    Recomputed,
    /// Time of verification, compared with the time of issue and the expiry date.
    InForce,
    /// Issuer, compared with the required one.
    Issuer,
    /// Serial number of the stand, compared with the required one.
    Stand,
    /// Distance from the site, compared with the validity radius.
    Place,
    /// Absence of a superseding successor in the given register folder.
    Register,
}

impl CheckName {
    /// Returns the name that `verify --format json` uses.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Grammar => "grammar",
            Self::Signature => "signature",
            Self::Schema => "schema",
            Self::Signer => "signer",
            Self::Revocation => "revocation",
            Self::Recomputed => "recomputed",
            Self::InForce => "in_force",
            Self::Issuer => "issuer",
            Self::Stand => "stand",
            Self::Place => "place",
            Self::Register => "register",
        }
    }
}

/// Result code of a check, for programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Code {
    /// The check passed.
    Ok,
    /// Not run, because it depends on an earlier check that failed.
    NotRun,
    /// The file could not be opened or read.
    Unreadable,
    /// The text rule, the split or the armor is broken.
    Malformed,
    /// The text is not the one that was signed.
    Altered,
    /// The signature was made for another kind of document.
    WrongNamespace,
    /// The content breaks a rule or is not in canonical form.
    BadContent,
    /// No trusted signer has this key.
    UnknownKey,
    /// The key belongs to another signer.
    WrongPrincipal,
    /// The passport was issued before the validity of the key began.
    KeyNotYetValid,
    /// The passport was issued after the validity of the key had ended.
    KeyExpired,
    /// The key is revoked.
    KeyRevoked,
    /// The passport is withdrawn.
    PassportRevoked,
    /// A number does not follow from the signed inputs.
    WrongNumber,
    /// The time of issue is later than the time of verification.
    NotYetValid,
    /// The expiry date has passed.
    Expired,
    /// The passport is from another issuer.
    WrongIssuer,
    /// The passport is for another stand.
    WrongStand,
    /// The passport is for another place.
    WrongPlace,
    /// A successor supersedes the passport.
    Superseded,
    /// A file in the register that may supersede or withdraw the passport cannot be read.
    RegisterUnknown,
}

impl Code {
    /// Returns the code that `verify --format json` writes.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::NotRun => "not_run",
            Self::Unreadable => "unreadable",
            Self::Malformed => "malformed",
            Self::Altered => "altered",
            Self::WrongNamespace => "wrong_namespace",
            Self::BadContent => "bad_content",
            Self::UnknownKey => "unknown_key",
            Self::WrongPrincipal => "wrong_principal",
            Self::KeyNotYetValid => "key_not_yet_valid",
            Self::KeyExpired => "key_expired",
            Self::KeyRevoked => "key_revoked",
            Self::PassportRevoked => "passport_revoked",
            Self::WrongNumber => "wrong_number",
            Self::NotYetValid => "not_yet_valid",
            Self::Expired => "expired",
            Self::WrongIssuer => "wrong_issuer",
            Self::WrongStand => "wrong_stand",
            Self::WrongPlace => "wrong_place",
            Self::Superseded => "superseded",
            Self::RegisterUnknown => "register_unknown",
        }
    }
}

/// Result of one check of a verification.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Check {
    /// Name of the check.
    pub name: CheckName,
    /// Result code.
    pub code: Code,
    /// Explanation for a laboratory engineer: one line, or one line for each error in the content.
    pub detail: String,
}

/// Detail of the check of revocations if there is no list to check.
pub(super) const NO_LIST: &str = "no revocation list was given (--revoked)";

impl Check {
    /// Creates the result of a check, with `detail` as a single printable line.
    pub(crate) fn new(name: CheckName, code: Code, detail: impl Display) -> Self {
        Self { name, code, detail: printable(detail) }
    }

    /// Returns `false` if there was nothing to check, because the question was not asked.
    pub(crate) fn was_asked(&self) -> bool {
        self.detail != NO_LIST
    }

    /// Returns whether the check passed, or `None` if it was not run.
    pub fn passed(&self) -> Option<bool> {
        match self.code {
            Code::Ok => Some(true),
            Code::NotRun => None,
            _ => Some(false),
        }
    }
}
