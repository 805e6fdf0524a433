//! Checks of a verification: names, result codes and details.

use crate::text::printable;
use crate::text::words;
use crate::trust::allowed_signers::ASK_FOR_THE_KEY;
use serde::ser::{Serialize, SerializeStruct, Serializer};
use std::fmt::Display;

words! {
    /// Name of a check; the variants are in the order of the report.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    #[non_exhaustive]
    pub enum CheckName: pub as_str {
        /// Text rule, split into text and signature, and form of the signature.
        Grammar = "grammar",
        /// Signature over the text.
        Signature = "signature",
        /// Canonical form of the content, and all of its rules.
        Schema = "schema",
        /// Key of the issuer, trusted for passports at the time of issue.
        Signer = "signer",
        /// Revocation of the key.
        Revocation = "revocation",
        /// Recomputation of every number from the signed inputs.
        Recomputed = "recomputed",
        /// Time of verification, compared with the time of issue and the expiry date.
        InForce = "in_force",
        /// Issuer, compared with the required one.
        Issuer = "issuer",
        /// Serial number of the stand, compared with the required one.
        Stand = "stand",
        /// Distance from the site, compared with the validity radius.
        Place = "place",
        /// State of the passport in the register of its stand.
        Register = "register",
    }
}

words! {
    /// Result code of a check, for programs.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[non_exhaustive]
    pub enum Code: pub as_str {
        /// The check passed.
        Ok = "ok",
        /// Not run, because it depends on an earlier check that failed.
        NotRun = "not_run",
        /// Not requested: the question has nothing to compare with.
        NotAsked = "not_asked",
        /// The file could not be opened or read.
        Unreadable = "unreadable",
        /// The text rule, the split or the armor is broken.
        Malformed = "malformed",
        /// The text is signed with a key of a type that cannot sign passports.
        UnsupportedKey = "unsupported_key",
        /// The text is not the one that was signed.
        Altered = "altered",
        /// The signature was made for another kind of document.
        WrongNamespace = "wrong_namespace",
        /// The content breaks a rule or is not in canonical form.
        BadContent = "bad_content",
        /// The format has a later number, or the content a key that this version does not know.
        NewerFormat = "newer_format",
        /// No trusted signer has this key.
        UnknownKey = "unknown_key",
        /// The key belongs to another signer.
        WrongPrincipal = "wrong_principal",
        /// The passport was issued before the validity of the key began.
        KeyNotYetValid = "key_not_yet_valid",
        /// The passport was issued after the validity of the key had ended.
        KeyExpired = "key_expired",
        /// The key is revoked.
        KeyRevoked = "key_revoked",
        /// A number does not follow from the signed inputs.
        WrongNumber = "wrong_number",
        /// The time of issue is later than the time of verification.
        NotYetValid = "not_yet_valid",
        /// The expiry date has passed.
        Expired = "expired",
        /// The passport is from another issuer.
        WrongIssuer = "wrong_issuer",
        /// The passport is for another stand.
        WrongStand = "wrong_stand",
        /// The passport is for another place.
        WrongPlace = "wrong_place",
        /// The issuer has withdrawn the passport.
        Withdrawn = "withdrawn",
        /// A passport for the same site supersedes this one.
        Superseded = "superseded",
        /// The stand has left the site.
        Moved = "moved",
        /// The register does not list the file.
        NotListed = "not_listed",
        /// The register is no longer fresh.
        RegisterStale = "register_stale",
        /// A later register is known.
        RegisterOlder = "register_older",
        /// Two registers of the stand contradict each other.
        RegisterContradicted = "register_contradicted",
        /// No register of the stand that counts was given.
        RegisterUnknown = "register_unknown",
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

/// Request at the end of the detail of a passport that was withdrawn.
pub(crate) const ASK_THE_ISSUER: &str = "ask the issuer for a new passport";

/// Request at the end of the detail of a passport that has expired.
pub(super) const REQUEST_FROM_THE_ISSUER: &str = "request a new passport from the issuer";

/// Returns the detail of a check for the issuer: without the request to ask the issuer.
pub(crate) fn for_the_issuer(detail: &str) -> &str {
    let requests = [ASK_THE_ISSUER, REQUEST_FROM_THE_ISSUER, ASK_FOR_THE_KEY];
    let without = |request| detail.strip_suffix(request)?.strip_suffix("; ");
    requests.into_iter().find_map(without).unwrap_or(detail)
}

impl CheckName {
    /// Returns the option that asks for the check, or `None` for one that is part of every verification.
    pub(crate) fn option(self) -> Option<&'static str> {
        Some(match self {
            Self::Revocation => "--revoked",
            Self::Issuer => "--issuer",
            Self::Stand => "--serial",
            Self::Place => "--at",
            Self::Register => "--register",
            _ => return None,
        })
    }
}

impl Check {
    /// Creates the result of a check, with `detail` as a single printable line.
    pub(crate) fn new(name: CheckName, code: Code, detail: impl Display) -> Self {
        Self { name, code, detail: printable(detail) }
    }

    /// Creates the check `name`, which was not run: not asked, or else because of `why`.
    pub(super) fn not_run(name: CheckName, asked: bool, why: &str) -> Self {
        match name.option().filter(|_| !asked) {
            Some(option) => Self::new(name, Code::NotAsked, format!("not asked ({option})")),
            None => Self::new(name, Code::NotRun, format!("not run: {why}")),
        }
    }

    /// Returns `false` if the check was not requested.
    pub(crate) fn was_asked(&self) -> bool {
        self.code != Code::NotAsked
    }

    /// Returns whether the check passed, or `None` if it was not run or not requested.
    pub fn passed(&self) -> Option<bool> {
        match self.code {
            Code::Ok => Some(true),
            Code::NotRun | Code::NotAsked => None,
            _ => Some(false),
        }
    }
}

/// Serialises the check as `verify` prints it: `{name, passed, code, detail}`.
impl Serialize for Check {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut line = serializer.serialize_struct("Check", 4)?;
        line.serialize_field("name", self.name.as_str())?;
        line.serialize_field("passed", &self.passed())?;
        line.serialize_field("code", self.code.as_str())?;
        line.serialize_field("detail", &self.detail)?;
        line.end()
    }
}
