//! Principals, the names of signers in lists of allowed signers: what may be one, and OpenSSH's patterns of them.

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

/// Longest pattern that OpenSSH matches, in bytes; a list with a longer pattern matches nothing.
pub(super) const LONGEST_PATTERN: usize = 1022;

/// Returns `true` if at least one pattern of `list` matches `text` and no negated pattern does (ssh_config(5), PATTERNS):
/// they are separated by commas, with `*` for any characters, `?` for one and a leading `!` for negation.
///
/// As in OpenSSH, `?` matches one byte, case matters, and a list of negated patterns alone matches nothing.
pub(super) fn matches_list(text: &str, list: &str) -> bool {
    let mut matched = false;
    for pattern in list.split(',') {
        match pattern.strip_prefix('!') {
            Some(excluded) if matches(text.as_bytes(), excluded.as_bytes()) => return false,
            Some(_) => {}
            None => matched = matched || matches(text.as_bytes(), pattern.as_bytes()),
        }
    }
    matched
}

/// Returns `true` if the pattern matches; the time is proportional to the product of the lengths.
fn matches(text: &[u8], pattern: &[u8]) -> bool {
    // Whether the pattern so far matches the first bytes of the text, for every number of them.
    let mut matched = vec![false; text.len() + 1];
    matched[0] = true;
    for &part in pattern {
        if part == b'*' {
            (0..text.len()).for_each(|at| matched[at + 1] |= matched[at]);
        } else {
            (0..text.len()).rev().for_each(|at| matched[at + 1] = matched[at] && (part == b'?' || part == text[at]));
            matched[0] = false;
        }
    }
    matched[text.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stars_and_question_marks() {
        for (text, pattern, expected) in [
            ("", "", true),
            ("", "*", true),
            ("", "?", false),
            ("a", "", false),
            ("a", "?", true),
            ("ab", "?", false),
            ("ab", "a*", true),
            ("ab", "*a", false),
            ("abcabd", "*abd", true),
            ("aaa", "*a*a", true),
            ("a", "*a*a", false),
            ("abc", "a**c", true),
            ("abc", "*?*?*?*", true),
            ("ab", "*?*?*?*", false),
            ("a.b", "a?b", true),
            ("A", "a", false),
            ("ж", "??", true),
            ("ж", "?", false),
        ] {
            assert_eq!(matches_list(text, pattern), expected, "{text:?} against {pattern:?}");
        }
    }

    #[test]
    fn a_list_is_separated_at_every_comma() {
        assert!(!matches_list("a,b", "a,b"));
        assert!(!matches_list("lab@factory", "!bad@*"));
        assert!(matches_list("!a", "?a"));
    }

    #[test]
    fn many_stars_do_not_take_forever() {
        let (text, pattern) = ("a".repeat(1000), "*a".repeat(500) + "b");
        assert!(!matches_list(&text, &pattern));
    }

    /// Expected: what is accepted is, in a line of allowed signers, the one principal that it is; ssh-keygen(1), ALLOWED
    /// SIGNERS, gives the meaning of the characters refused.
    #[cfg(feature = "factory")]
    #[test]
    fn what_is_accepted_is_read_as_one_principal() {
        use crate::trust::{AllowedSigners, SigningKey};

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
