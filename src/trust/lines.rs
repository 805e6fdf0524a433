//! Lines of textual trust files, and the checks that apply to all of these files.

use super::LARGEST_TRUST_FILE_BYTES;
use crate::text::node::{odd, utf8, without_byte_order_mark};
use crate::text::problem::{MOST_COUNTED, counted};
use crate::text::{Advice, Location, Problem, RefusalCause, Unreadable};

/// A line that is neither empty nor a comment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line<'a> {
    /// Line number, from 1.
    pub(super) number: usize,
    /// Text without the line ending.
    pub(super) text: &'a str,
}

impl Line<'_> {
    /// Creates the report of an error in this line, `at` bytes from its beginning.
    pub(super) fn problem(
        &self,
        at: usize,
        field: &str,
        found: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<Advice>,
    ) -> Problem {
        let column = 1 + self.text.get(..at).unwrap_or(self.text).chars().count();
        Problem::new(Some(Location { line: self.number, column }), field, found, expected, advice)
    }

    /// Returns the problem of the first control character in this line except tab, or `None` if there is none.
    pub(super) fn control_character(&self) -> Option<Problem> {
        let is_control =
            |(at, c)| odd(c).filter(|(_, cause)| *cause == RefusalCause::ControlCharacter).map(|odd| (at, odd));
        let (at, (found, cause)) = self.text.char_indices().find_map(is_control)?;
        Some(self.problem(at, "", found, "text", cause))
    }
}

/// Reads each line of a trust file that is neither empty nor a comment; line endings are LF or CRLF, and a byte order mark
/// is left out, as in other hand-written files.
///
/// # Errors
/// Returns [`Unreadable`] if the file is larger than [`LARGEST_TRUST_FILE_BYTES`], is not UTF-8, or contains a private
/// key, or with the errors in the lines. Of many of one kind, which mostly have one cause, only the first is shown, with
/// the number of others.
pub(super) fn read<T>(
    name: &str,
    bytes: &[u8],
    read: impl Fn(&Line) -> Result<T, Vec<Problem>>,
) -> Result<Vec<T>, Unreadable> {
    check_size(name, bytes)?;
    let text = utf8(name, without_byte_order_mark(bytes), None)?;
    if text.contains("PRIVATE KEY-----") {
        // The lines of a private key must not appear in messages, because messages end up in logs.
        let advice = "use the line of the .pub file, and keep the private key secret";
        return Err(Unreadable::whole(name, None, "a private key", "public keys", advice));
    }
    let (mut kept, mut problems) = (Vec::new(), Vec::new());
    for (number, text) in (1..).zip(text.split('\n')) {
        let text = text.strip_suffix('\r').unwrap_or(text);
        if text.trim().is_empty() || text.trim_start().starts_with('#') {
            continue;
        }
        match read(&Line { number, text }) {
            Ok(line) => kept.push(line),
            Err(mut found) => problems.append(&mut found),
        }
        if problems.len() >= MOST_COUNTED {
            break;
        }
    }
    let kind = |problem: &Problem| Some((problem.field.clone(), problem.expected.clone(), problem.advice.clone()));
    if problems.is_empty() { Ok(kept) } else { Err(Unreadable::of(name, counted(problems, kind))) }
}

/// Refuses a trust file that is larger than [`LARGEST_TRUST_FILE_BYTES`].
pub(super) fn check_size(name: &str, bytes: &[u8]) -> Result<(), Unreadable> {
    if bytes.len() <= LARGEST_TRUST_FILE_BYTES {
        return Ok(());
    }
    let (found, expected) = (format!("{} bytes", bytes.len()), format!("at most {LARGEST_TRUST_FILE_BYTES}"));
    Err(Unreadable::whole(name, None, found, expected, "check that this is the right file"))
}

#[cfg(all(test, feature = "factory"))]
mod tests {
    use super::*;

    #[test]
    fn a_byte_order_mark_shifts_no_line() {
        let text = "\u{FEFF}\n# one\n \t\r\n  a b\r\n\nc";
        let kept = read("f", text.as_bytes(), |line| Ok((line.number, line.text.to_owned()))).unwrap();
        assert_eq!(kept, [(4, "  a b".to_owned()), (6, "c".to_owned())]);
    }

    #[test]
    fn other_encodings_are_named_with_their_place() {
        let refusal = |bytes: &[u8]| read("f", bytes, |_| Ok(())).unwrap_err().to_string();
        assert!(refusal(b"\xFF\xFEa\0").contains("found UTF-16"));
        assert!(refusal(b"a\0\n\0").contains("found UTF-16"));
        assert!(refusal("# жж\nж".as_bytes().split_last().unwrap().1).starts_with("f:2:1: found byte 0xD0"));
        assert!(refusal(&vec![b' '; LARGEST_TRUST_FILE_BYTES + 1]).contains("16777217 bytes"));
    }

    #[test]
    fn a_private_key_does_not_come_back_in_the_message() {
        let key = crate::trust::SigningKey::generate().unwrap().to_openssh("c", None).unwrap();
        let refusal = read("f", key.as_bytes(), |_| Ok(())).unwrap_err().to_string();
        assert!(refusal.starts_with("f: found a private key, expected public keys"), "{refusal}");
        assert!(key.lines().all(|line| !refusal.contains(line)), "{refusal}");
    }

    #[test]
    fn control_characters_are_placed() {
        let line = Line { number: 3, text: "жb\u{0}c" };
        let problem = line.control_character().unwrap();
        assert_eq!(problem.location, Some(Location { line: 3, column: 3 }));
        assert!(problem.found.contains("U+0000"));
    }
}
