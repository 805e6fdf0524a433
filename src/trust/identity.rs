//! Identities: the names of signers in lists of allowed signers.

use super::pattern::LONGEST_PATTERN;
use super::public_key::AnyKey;
use crate::text::{Printable, rule};

/// Identity that a list of allowed signers would not read as one principal, or that a signed text cannot contain.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "the identity \"{}\" {}; choose a name such as factory@example.org, which allowed_signers reads as one name",
    Printable(.0),
    broken_rule(.0).unwrap_or_default()
)]
pub struct BadIdentity(String);

/// Checks an identity to which a key or a document is to be assigned. Both uses have one rule, because a document is
/// valid only if allowed signers assign the key to its issuer.
///
/// # Errors
/// Returns [`BadIdentity`] if a list of allowed signers would not read it as exactly one principal.
pub(crate) fn check_identity(identity: &str) -> Result<(), BadIdentity> {
    broken_rule(identity).map_or(Ok(()), |_| Err(BadIdentity(identity.to_owned())))
}

/// Returns the rule that an identity breaks, after its name, or `None` if it is good.
fn broken_rule(identity: &str) -> Option<String> {
    if identity.is_empty() {
        return Some("is empty".to_owned());
    }
    if identity.len() > LONGEST_PATTERN {
        return Some(format!("is longer than {LONGEST_PATTERN} bytes"));
    }
    if AnyKey::is_type(identity) {
        return Some("begins as the type of a key does".to_owned());
    }
    let bad = |c: &char| !rule::allowed_in_string(*c) || c.is_whitespace() || "\"',*?!#".contains(*c);
    identity.chars().find(bad).map(|c| match c {
        ' ' => "contains a space".to_owned(),
        '"' | '\'' => "contains a quote".to_owned(),
        ',' | '*' | '?' | '!' | '#' => format!("contains `{c}`, which has a special meaning in a list of names"),
        _ => format!("contains {}, which no identity may contain", c.escape_unicode()),
    })
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
