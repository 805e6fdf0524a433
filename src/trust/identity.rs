//! Identities: the names of signers in lists of allowed signers.

use super::pattern::LONGEST_PATTERN;
use super::public_key::AnyKey;
use crate::text::{Printable, rule};

/// Identity that a list of allowed signers would not read as one principal, or that a signed text cannot contain.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "the identity \"{}\" is empty or too long, begins with a key type, or contains a space, a quote, one of , * ? ! # or \
     a character that no signed text may contain: choose another one, such as factory@example.org, because \
     allowed_signers would not read this as one name",
    Printable(.0)
)]
pub struct BadIdentity(String);

/// Checks an identity to which a key or a document is to be assigned. Both uses have one rule, because a document is
/// valid only if allowed signers assign the key to its issuer.
///
/// # Errors
/// Returns [`BadIdentity`] if a list of allowed signers would not read it as exactly one principal.
pub(crate) fn check_identity(identity: &str) -> Result<(), BadIdentity> {
    let plain = |c: char| rule::allowed_in_string(c) && !c.is_whitespace() && !"\"',*?!#".contains(c);
    let good = !identity.is_empty()
        && identity.len() <= LONGEST_PATTERN
        && !AnyKey::is_type(identity)
        && identity.chars().all(plain);
    if good { Ok(()) } else { Err(BadIdentity(identity.to_owned())) }
}

#[cfg(all(test, feature = "factory"))]
mod tests {
    use super::*;
    use crate::trust::{AllowedSigners, SigningKey};

    /// Expected: what is accepted is, in a line of allowed signers, the one principal that it is; ssh-keygen(1), ALLOWED
    /// SIGNERS, gives the meaning of the characters refused.
    #[test]
    fn what_is_accepted_is_read_as_one_principal() {
        let key = SigningKey::generate().unwrap();
        let at = "2026-11-09T09:00:00Z".parse().unwrap();
        for good in ["factory@example.org", "Завод-1", "a.b_c", &"a".repeat(LONGEST_PATTERN)] {
            check_identity(good).unwrap();
            let line = format!("{good} {}", key.public_key().to_openssh());
            let signers = AllowedSigners::parse("signers", line.as_bytes()).unwrap();
            assert_eq!(signers.authorise(&key.public_key(), good, "any", at), Ok(()), "{good}");
        }
        let long = "a".repeat(LONGEST_PATTERN + 1);
        let bad = [
            "",
            "a b",
            "a\u{a0}b",
            "a\tb",
            "a,b",
            "a*",
            "!a",
            "#a",
            "a\"b",
            "ssh-factory",
            "a\u{202e}b",
            "a\nb",
            &long,
        ];
        for bad in bad {
            assert!(check_identity(bad).is_err(), "{bad:?}");
        }
    }
}
