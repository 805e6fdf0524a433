//! The checks of a verification: their names and verdicts, in words and for programs.

use crate::text::printable;
use std::fmt::Display;

/// The checks, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum CheckName {
    /// The text rule, the split, the form of the signature.
    Grammar,
    /// The signature over the text.
    Signature,
    /// The content in its one form, and every rule of it.
    Schema,
    /// The key is the issuer's, for passports, at the time of issue.
    Signer,
    /// Neither key nor passport is revoked.
    Revocation,
    /// Every number follows from the signed inputs.
    Recomputed,
    /// Issued, and not expired.
    InForce,
    /// The issuer is the one asked for.
    Issuer,
    /// The stand is the one asked for.
    Stand,
    /// The place is within the radius of validity.
    Place,
    /// No successor supersedes it in the folder asked about.
    Register,
}

impl CheckName {
    /// As `verify --format json` names it.
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

/// The verdict of a check, for programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Code {
    /// Passed.
    Ok,
    /// An earlier check failed, and this one needs it.
    NotRun,
    /// The file could not be opened or read.
    Unreadable,
    /// The text rule, the split or the armor is broken.
    Malformed,
    /// The text is not the one that was signed.
    Altered,
    /// Signed as another kind of document.
    WrongNamespace,
    /// The content breaks a rule, or is not in its one form.
    BadContent,
    /// The key is nobody's that is trusted.
    UnknownKey,
    /// The key is somebody else's.
    WrongPrincipal,
    /// The key's time had not begun when the passport was issued.
    KeyNotYetValid,
    /// The key's time had ended when the passport was issued.
    KeyExpired,
    /// The key was revoked.
    KeyRevoked,
    /// The passport was withdrawn.
    PassportRevoked,
    /// A number does not follow from the signed inputs.
    WrongNumber,
    /// Issued later than the time asked about.
    NotYetValid,
    /// Past its last day.
    Expired,
    /// From another issuer.
    WrongIssuer,
    /// Of another stand.
    WrongStand,
    /// For another place.
    WrongPlace,
    /// A successor counts in its place.
    Superseded,
    /// Something in the register that may supersede or withdraw it cannot be read.
    RegisterUnknown,
}

impl Code {
    /// As `verify --format json` writes it.
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

/// One check.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Check {
    /// Which.
    pub name: CheckName,
    /// Its verdict.
    pub code: Code,
    /// One line that a laboratory engineer understands, or one for each mistake in the content.
    pub detail: String,
}

impl Check {
    /// The verdict of a check in one line; whatever is in `detail`, it stays one.
    pub(crate) fn new(name: CheckName, code: Code, detail: impl Display) -> Self {
        Self { name, code, detail: printable(detail) }
    }

    /// Whether it passed; `None` when it was not run.
    pub fn passed(&self) -> Option<bool> {
        match self.code {
            Code::Ok => Some(true),
            Code::NotRun => None,
            _ => Some(false),
        }
    }
}
