//! Allowed signers: keys with their principals, namespaces and validity periods (ssh-keygen(1), ALLOWED SIGNERS).
//!
//! This reader is stricter than OpenSSH, which skips a line that it cannot read. Here such a line is an error, because
//! its author meant to trust a key or to end that trust. Only keys that cannot sign passports are skipped here too.

use super::principal::matches_list;
use super::signer_line::{self, Options, SignerLine};
use super::{KeyPoint, PublicKey, lines};
use crate::text::kind::mistaken;
use crate::text::{Kind, Printable, Unreadable};
use jiff::Timestamp;
use thiserror::Error;

/// Trusted keys, each with the principals, namespaces and validity period that it is trusted for; none by default.
#[derive(Debug, Clone, Default)]
pub struct AllowedSigners {
    lines: Vec<SignerLine>,
    /// Types of the keys that were skipped, because they cannot sign passports.
    pub(crate) skipped: Vec<String>,
}

/// Reason why a key is not trusted for an identity, a namespace and a time. If several lines contain the key, the
/// nearest miss is reported; later variants are nearer.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Error)]
#[non_exhaustive]
pub enum NotAuthorised {
    /// No line contains the key.
    #[error("the signing key is not in allowed_signers, the list of trusted keys")]
    UnknownKey,
    /// The key belongs to other signers, with these patterns of principals.
    #[error("the signing key belongs to {}, not to this issuer", Printable(.0.join(" or ")))]
    WrongPrincipal(Vec<String>),
    /// The key is trusted for other namespaces, with these patterns.
    #[error("the signing key is trusted only for {}, not for this kind of document", Printable(.0))]
    WrongNamespace(String),
    /// The key was not valid yet; it was from this instant.
    #[error("the signing key is valid from {0}; the document was issued earlier")]
    NotYetValid(Timestamp),
    /// The key was no longer valid after this instant.
    #[error("the signing key was valid until {0}; the document was issued later")]
    Expired(Timestamp),
}

impl AllowedSigners {
    /// Reads a list of allowed signers in OpenSSH's format; `name` is the file name used in messages.
    ///
    /// A line contains patterns of principals, options (`namespaces`, `valid-after`, `valid-before`) and a public key.
    /// Keys that cannot sign passports are skipped, whatever their type.
    ///
    /// # Errors
    /// Returns [`Unreadable`] with the errors of all lines, up to a limit. `cert-authority` is an error, and so is a
    /// date without `Z`, because it would depend on the verifier's local time. A list without any key is an error too.
    pub fn parse(name: &str, text: &[u8]) -> Result<Self, Unreadable> {
        let is_near = |kind| matches!(kind, Kind::AllowedSigners | Kind::PublicKey | Kind::PrivateKey);
        let advice = "add the line that `keygen` prints";
        let none = || Unreadable::whole(name, None, "no key", "a line for each trusted key", advice);
        let kept = lines::read(name, text, signer_line::read)
            .and_then(|kept| if kept.is_empty() { Err(none()) } else { Ok(kept) })
            .map_err(|refused| mistaken(name, text, Kind::AllowedSigners.words(), is_near).unwrap_or(refused))?;
        let mut signers = Self::default();
        for line in kept {
            match line {
                Ok(line) => signers.lines.push(line),
                Err(other) => signers.skipped.push(other),
            }
        }
        Ok(signers)
    }

    pub(crate) fn lines(&self) -> &[SignerLine] {
        &self.lines
    }

    /// Returns the curve point of a key in the list, decoded once; `None` for any other key.
    pub(crate) fn point(&self, key: &PublicKey) -> Option<&KeyPoint> {
        let line = self.lines.iter().find(|line| line.key == *key)?;
        line.point.get_or_init(|| KeyPoint::of(key)).as_ref()
    }

    /// Returns `true` if a line has a key of `principal`.
    #[cfg(feature = "cli")]
    pub(crate) fn knows(&self, principal: &str) -> bool {
        self.lines.iter().any(|line| matches_list(principal, &line.principals))
    }

    /// Checks that `key` is trusted for a document of `namespace` that `principal` issued at the instant `at`.
    ///
    /// Patterns are matched as by OpenSSH. The validity period includes both of its ends. Instants are compared in
    /// whole seconds.
    ///
    /// # Errors
    /// Returns [`NotAuthorised`] with the nearest miss if no line authorises the key.
    pub fn authorise(
        &self,
        key: &PublicKey,
        principal: &str,
        namespace: &str,
        at: Timestamp,
    ) -> Result<(), NotAuthorised> {
        let mut nearest = NotAuthorised::UnknownKey;
        for line in self.lines.iter().filter(|line| line.key == *key) {
            match line.authorise(principal, namespace, at) {
                Ok(()) => return Ok(()),
                Err(miss) => nearest = nearest.nearer(miss),
            }
        }
        Err(nearest)
    }
}

impl SignerLine {
    fn authorise(&self, principal: &str, namespace: &str, at: Timestamp) -> Result<(), NotAuthorised> {
        if !matches_list(principal, &self.principals) {
            return Err(NotAuthorised::WrongPrincipal(vec![self.principals.clone()]));
        }
        let Options { namespaces, valid_after, valid_before } = &self.options;
        if let Some(allowed) = namespaces.as_deref().filter(|allowed| !matches_list(namespace, allowed)) {
            return Err(NotAuthorised::WrongNamespace(allowed.to_owned()));
        }
        if let Some(from) = valid_after.filter(|from| at.as_second() < from.as_second()) {
            return Err(NotAuthorised::NotYetValid(from));
        }
        if let Some(until) = valid_before.filter(|until| at.as_second() > until.as_second()) {
            return Err(NotAuthorised::Expired(until));
        }
        Ok(())
    }
}

/// Request of a laboratory at the end of the words on an unknown key.
pub(crate) const ASK_FOR_THE_KEY: &str =
    "ask the factory for its key, and compare the fingerprint through another channel";

impl NotAuthorised {
    /// Returns the reason, whose signature it concerns, and what to do about an unknown key.
    pub(crate) fn of_document(&self, key: &PublicKey, issuer: &str, issued_at: Timestamp) -> String {
        let remedy = match self {
            Self::UnknownKey => format!("; {ASK_FOR_THE_KEY}"),
            _ => String::new(),
        };
        format!("{self} (key {}, issuer {issuer}, issued {issued_at}){remedy}", key.fingerprint())
    }

    /// Returns the nearer of two misses, or merges two of the same kind.
    fn nearer(self, other: Self) -> Self {
        match (self, other) {
            (Self::WrongPrincipal(mut allowed), Self::WrongPrincipal(more)) => {
                allowed.extend(more.into_iter().filter(|new| !allowed.contains(new)).collect::<Vec<_>>());
                Self::WrongPrincipal(allowed)
            }
            (Self::WrongNamespace(allowed), Self::WrongNamespace(more)) if allowed != more => {
                Self::WrongNamespace(format!("{allowed} or {more}"))
            }
            (Self::NotYetValid(from), Self::NotYetValid(other)) => Self::NotYetValid(from.min(other)),
            (Self::Expired(until), Self::Expired(other)) => Self::Expired(until.max(other)),
            (one, other) => one.max(other),
        }
    }
}
