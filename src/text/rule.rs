//! Text rule of signed documents: their allowed content and its canonical form.
//!
//! Every YAML 1.1 and 1.2 reader finds the same content in such a text, to the last bit of every number. The
//! writer ([`write_quoted`], [`number`](super::number)) corresponds to the check of the rule ([`check`], [`differs`]).

pub(crate) use super::characters::allowed_in_string;
pub(crate) use super::problem::UPDATE;

use super::characters::is_printable_ascii;
use super::node::{location_of, plain_text};
use super::problem::Unreadable;
use super::without_secrets;

/// Returns `true` if `c` is allowed outside strings and comments: in keys, numbers, `true`, `false` and brackets.
fn allowed_outside(c: char) -> bool {
    c.is_ascii_lowercase() || c.is_ascii_digit() || " _:,{}[]+-.".contains(c)
}

/// Writes a string in double quotes, with the only two escapes of the rule, in parts.
pub(super) fn write_quoted(text: &str, mut push: impl FnMut(&str)) {
    push("\"");
    let mut rest = text;
    while let Some(at) = memchr::memchr2(b'"', b'\\', rest.as_bytes()) {
        let (plain, others) = rest.split_at(at);
        let (escaped, after) = others.split_at(1);
        [plain, "\\", escaped].into_iter().for_each(&mut push);
        rest = after;
    }
    push(rest);
    push("\"");
}

/// Advice for text that is not as the writer writes it.
pub(super) const NOT_CANONICAL: &str = "this is not the canonical form; get the file from the issuer again";

/// Returns `true` if the format `found` is `known` with a later number.
pub(crate) fn is_later_format(found: &str, known: &str) -> bool {
    let number = |format: &str| {
        format.rsplit_once('/').and_then(|(kind, number)| Some((kind.to_owned(), number.parse::<u32>().ok()?)))
    };
    number(found).zip(number(known)).is_some_and(|(found, known)| found.0 == known.0 && found.1 > known.1)
}

/// Checks the bytes against the rule before anything is parsed, and returns the text.
pub(crate) fn check<'a>(name: &str, bytes: &'a [u8], largest_bytes: usize) -> Result<&'a str, Unreadable> {
    let text = plain_text(name, bytes, largest_bytes)?;
    if !text.ends_with('\n') {
        let (at, advice) = (location_of(bytes), "the file may be truncated; get it from the issuer again");
        return Err(Unreadable::whole(name, Some(at), "no line feed at the end", "a line feed", advice));
    }
    if obeys_at_first_sight(text) {
        return Ok(text);
    }
    let mut line_start = 0;
    for line_end in memchr::memchr_iter(b'\n', bytes) {
        if let Some((offset, found, expected)) = first_fault(&text[line_start..line_end]) {
            let at = location_of(&bytes[..line_start + offset]);
            return Err(Unreadable::whole(name, Some(at), found, expected, NOT_CANONICAL));
        }
        line_start = line_end + 1;
    }
    Ok(text)
}

/// Returns `true` if a fast check of many bytes at once shows that a text obeys the rule. It returns `false` for other
/// texts, and also for those with an escape in a string or a line that might be a document marker.
fn obeys_at_first_sight(text: &str) -> bool {
    let marks = |line: &[u8]| line.first().is_some_and(|first| b"-.".contains(first));
    let bytes = text.as_bytes();
    if marks(bytes) || memchr::memchr_iter(b'\n', bytes).any(|end| marks(&bytes[end + 1..])) {
        return false;
    }
    let mut rest = text;
    let mut at_line_start = true;
    while let Some(at) = memchr::memchr2(b'"', b'#', rest.as_bytes()) {
        let (outside, inside) = (&rest[..at], &rest[at + 1..]);
        if !may_stand_outside(outside.as_bytes()) {
            return false;
        }
        let comment = rest[at..].starts_with('#');
        if comment {
            let line = outside.rfind('\n').map(|end| &outside[end + 1..]).or(at_line_start.then_some(outside));
            let alone = line.is_some_and(|before| before.bytes().all(|byte| byte == b' '));
            let end = memchr::memchr(b'\n', inside.as_bytes());
            let Some(end) = end.filter(|&end| alone && is_printable_ascii(&inside.as_bytes()[..end])) else {
                return false;
            };
            rest = &inside[end + 1..];
        } else {
            let Some(end) = memchr::memchr3(b'"', b'\\', b'\n', inside.as_bytes()) else { return false };
            let (string, after) = inside.split_at(end);
            if !(is_printable_ascii(string.as_bytes()) || string.chars().all(allowed_in_string)) {
                return false;
            }
            let Some(after) = after.strip_prefix('"') else { return false };
            rest = after;
        }
        at_line_start = comment;
    }
    may_stand_outside(rest.as_bytes())
}

/// Returns `true` if lines, or the rest of a line, contain only characters that [`allowed_outside`] accepts.
fn may_stand_outside(bytes: &[u8]) -> bool {
    let may =
        |byte: u8| matches!(byte, b'a'..=b'{' | b'0'..=b':' | b'+'..=b'.' | b' ' | b'[' | b']' | b'_' | b'}' | b'\n');
    // As in `is_printable_ascii`.
    bytes.iter().fold(true, |all, byte| all & may(*byte))
}

/// Returns the first character of a line that breaks the rule: byte offset, description and expected content. Returns
/// `None` if the line obeys the rule.
fn first_fault(line: &str) -> Option<(usize, String, &'static str)> {
    // A document marker has only allowed characters, but starts another document, and readers differ in which one they
    // return.
    if let Some(marker) = ["---", "..."].into_iter().find(|marker| line.starts_with(marker)) {
        return Some((0, format!("document marker `{marker}`"), "a document without markers"));
    }
    let comment = line.trim_start_matches(' ').starts_with('#');
    let mut in_string = false;
    let mut escaped = false;
    for (offset, c) in line.char_indices() {
        let (allowed, expected) = match (comment, in_string) {
            (true, _) => ((' '..='~').contains(&c), "printable ASCII in a comment"),
            (_, true) if escaped => (c == '"' || c == '\\', "\" or \\ after the backslash"),
            (_, true) => (allowed_in_string(c), "a character that is allowed in strings"),
            (_, false) => (c == '"' || allowed_outside(c), "only keys, numbers, brackets and double-quoted strings"),
        };
        if !allowed {
            return Some((offset, named(c), expected));
        }
        if !comment {
            let quote = c == '"' && !escaped;
            escaped = in_string && c == '\\' && !escaped;
            in_string ^= quote;
        }
    }
    in_string.then(|| (line.len(), "the end of the line within a string".to_owned(), "a closing double quote"))
}

fn named(c: char) -> String {
    match c {
        '\t' => "a tab".to_owned(),
        ' '..='~' => format!("character {c:?}"),
        _ => format!("character U+{:04X}", u32::from(c)),
    }
}

/// Returns the first difference of `text`, without comments and empty lines, from `canonical`: line number, found
/// content and expected content. Returns `None` if they are equal.
pub(crate) fn differs(text: &str, canonical: &str) -> Option<(usize, String, String)> {
    let mut expected = canonical.lines();
    let content = text
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.trim_matches(' ').is_empty() && !line.trim_start_matches(' ').starts_with('#'));
    for (index, found) in content {
        match expected.next() {
            Some(expected) if expected == found => {}
            other => {
                let expected = other.map_or_else(|| "the end of the file".to_owned(), shortened);
                return Some((index + 1, shortened(found), expected));
            }
        }
    }
    expected.next().map(|missing| (text.lines().count() + 1, "the end of the file".to_owned(), shortened(missing)))
}

/// Returns a line as messages show it.
pub(super) fn shortened(line: &str) -> String {
    const LONGEST: usize = 100;
    let line = without_secrets(line);
    if line.chars().count() <= LONGEST {
        return format!("`{line}`");
    }
    format!("`{}...`", line.chars().take(LONGEST).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn good_lines_are_accepted_and_all_but_escapes_at_first_sight() {
        for line in [
            "a: \"x\"",
            "  # a comment!",
            "  - {i: 1, s: \"\\\"\\\\\", m: [[1.0e-06, -2.0]]}",
            "a: \"# no comment\"",
            "",
        ] {
            assert_eq!(first_fault(line), None, "{line}");
            assert!(obeys_at_first_sight(&format!("{line}\n")) || line.contains('\\'), "{line}");
        }
    }

    /// Tests every character of a few blocks between neighbours: outside strings, inside them and in comments, on the
    /// first, a middle and the last line. The fast check must agree with the full check.
    #[test]
    fn first_sight_sees_what_a_closer_look_sees() {
        let around =
            [("", ""), ("a: ", "1.0"), ("a: \"x", "y\""), ("  # ", "z"), ("a: \"x\\", "\"\""), ("a: \"", "\" #")];
        let mut seen = 0;
        for c in (0..0x250).filter_map(char::from_u32) {
            for (before, after) in around {
                let line = format!("{before}{c}{after}");
                for text in [format!("{line}\n"), format!("b: \"c\"\n{line}\n# d\n"), format!("b: 1\n{line}\n{line}\n")]
                {
                    let obeys = text.lines().all(|line| first_fault(line).is_none());
                    // `lines` hides a line ending with a carriage return.
                    let obeys = obeys && !text.contains('\r');
                    let first_sight = obeys_at_first_sight(&text);
                    assert!(!first_sight || obeys, "{text:?}");
                    // Escapes, and lines that begin like a document marker, need the full check.
                    let simple = !text.contains('\\') && !text.lines().any(|line| line.starts_with(['-', '.']));
                    assert!(!simple || first_sight == obeys, "{text:?}");
                    seen += usize::from(first_sight);
                }
            }
        }
        assert!(seen > 1000, "{seen}");
        // Test every position in a block.
        for length in 0..100 {
            let line = "a".repeat(length);
            assert!(obeys_at_first_sight(&format!("{line}\n  - b\n")));
            for bad in ["\n---\n", "\n...\n", "A\n", "\n\tb\n"] {
                assert!(!obeys_at_first_sight(&format!("{line}{bad}")), "{length} {bad:?}");
            }
        }
    }

    /// Many bytes are tested without stopping: several faults must not cancel each other.
    #[test]
    fn several_faults_do_not_cancel_each_other() {
        for faults in 1..=32 {
            let line = format!("{}{}", "A".repeat(faults), "a".repeat(68 - faults));
            assert!(!may_stand_outside(line.as_bytes()), "{faults}");
        }
        for begun in 1..=10 {
            let lines = format!("a: 1{}{}\n", "\n-".repeat(begun), "a".repeat(68));
            assert!(!obeys_at_first_sight(&lines), "{begun}");
        }
        assert!(may_stand_outside("a".repeat(68).as_bytes()));
    }

    /// Expected: Unicode's code points, and letters that a reader sees as they are.
    #[test]
    fn a_fault_is_named_so_that_it_can_be_found() {
        for (line, name) in [
            ("a:\t1", "a tab"),
            ("a: &x", "character '&'"),
            ("a: \u{e9}", "character U+00E9"),
            ("a: \u{7f}", "character U+007F"),
        ] {
            assert_eq!(first_fault(line).map(|fault| fault.1).as_deref(), Some(name));
        }
    }

    #[test]
    fn comments_and_blank_lines_do_not_differ_anything_else_does() {
        let canonical = "a: 1\nb:\n  c: 2.0\n";
        assert_eq!(differs("# x\na: 1\n\nb:\n  # y\n  c: 2.0\n", canonical), None);
        assert_eq!(differs("a: 1\nb:\n  c: 2.00\n", canonical).map(|found| found.0), Some(3));
        assert_eq!(differs("a: 1\n", canonical).map(|found| found.0), Some(2));
        assert_eq!(differs("a: 1\nb:\n  c: 2.0\nd: 1\n", canonical).map(|found| found.0), Some(4));
    }
}
