//! OpenSSH's lists of patterns (ssh_config(5), PATTERNS): separated by commas, with `*` for any characters, `?` for one
//! character and a leading `!` for negation.

/// Longest pattern that OpenSSH matches, in bytes; a list with a longer pattern matches nothing.
pub(super) const LONGEST_PATTERN: usize = 1022;

/// Returns `true` if at least one pattern of `list` matches `text` and no negated pattern does.
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

/// Returns `true` if the pattern matches; the worst-case time is proportional to the product of the lengths.
fn matches(text: &[u8], pattern: &[u8]) -> bool {
    let (mut at, mut in_pattern) = (0, 0);
    let mut last_star = None;
    while at < text.len() {
        match pattern.get(in_pattern) {
            Some(b'*') => {
                last_star = Some((at, in_pattern));
                in_pattern += 1;
            }
            Some(&byte) if byte == b'?' || byte == text[at] => {
                at += 1;
                in_pattern += 1;
            }
            _ => match last_star {
                // Let the star match one more byte, and try the rest of the pattern again after it.
                Some((start, star)) => {
                    last_star = Some((start + 1, star));
                    at = start + 1;
                    in_pattern = star + 1;
                }
                None => return false,
            },
        }
    }
    pattern[in_pattern..].iter().all(|&byte| byte == b'*')
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
}
