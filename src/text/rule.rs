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
use std::ops::Range;

/// Writes a string in double quotes, with the only two escapes of the rule.
pub(super) fn write_quoted(text: &str, out: &mut String) {
    out.push('"');
    let mut rest = text;
    while let Some(at) = memchr::memchr2(b'"', b'\\', rest.as_bytes()) {
        let (plain, others) = rest.split_at(at);
        let (escaped, after) = others.split_at(1);
        out.extend([plain, "\\", escaped]);
        rest = after;
    }
    out.extend([rest, "\""]);
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
    first_fault(text).map_or(Ok(text), |(at, found, expected)| {
        Err(Unreadable::whole(name, Some(location_of(&bytes[..at])), found, expected, NOT_CANONICAL))
    })
}

/// First character that breaks the rule: byte offset, description and expected content.
type Fault = (usize, String, &'static str);

/// Returns the first fault of a text that ends with a line feed, or `None` if it obeys the rule.
fn first_fault(text: &str) -> Option<Fault> {
    let other = check_parts(text).err();
    // A document marker has only allowed characters, but starts another document, and readers differ in which one they
    // return.
    let marked = |start: usize| {
        let marker = ["---", "..."].into_iter().find(|marker| text[start..].starts_with(marker))?;
        Some((start, format!("document marker `{marker}`"), "a document without markers"))
    };
    let line_ends = memchr::memchr_iter(b'\n', text.as_bytes());
    let marker = std::iter::once(0).chain(line_ends.map(|end| end + 1)).find_map(marked);
    marker.into_iter().chain(other).min_by_key(|(at, ..)| *at)
}

/// Checks a text part by part: what is outside strings and comments, and each of them.
fn check_parts(text: &str) -> Result<(), Fault> {
    const OUTSIDE: &str = "only keys, numbers, brackets and double-quoted strings";
    // What may be in keys, numbers, `true`, `false` and brackets, and between lines.
    let may_stand_outside =
        |byte: u8| matches!(byte, b'a'..=b'{' | b'0'..=b':' | b'+'..=b'.' | b' ' | b'[' | b']' | b'_' | b'}' | b'\n');
    let bytes = text.as_bytes();
    let mut at = 0;
    loop {
        let end = memchr::memchr2(b'"', b'#', &bytes[at..]).map_or(bytes.len(), |length| at + length);
        check_all(text, at..end, may_stand_outside, OUTSIDE)?;
        // A comment is alone on its line.
        let begins_line = || matches!(bytes[..end].iter().rfind(|byte| **byte != b' '), None | Some(b'\n'));
        at = match bytes.get(end) {
            None => return Ok(()),
            Some(b'"') => check_string(text, end + 1)?,
            Some(_) if begins_line() => {
                let line_end = memchr::memchr(b'\n', &bytes[end..]).map_or(bytes.len(), |length| end + length);
                check_all(text, end..line_end, |byte| matches!(byte, b' '..=b'~'), "printable ASCII in a comment")?;
                line_end
            }
            Some(_) => return Err((end, named('#'), OUTSIDE)),
        };
    }
}

/// Checks that each byte of a part of a text is an ASCII character that `may` be there.
fn check_all(text: &str, part: Range<usize>, may: impl Fn(u8) -> bool, expected: &'static str) -> Result<(), Fault> {
    let bytes = &text.as_bytes()[part.clone()];
    // As in `is_printable_ascii`.
    if bytes.iter().fold(true, |all, byte| all & may(*byte)) {
        return Ok(());
    }
    let at = part.start + bytes.iter().take_while(|byte| may(**byte)).count();
    Err((at, text[at..].chars().next().map_or_else(String::new, named), expected))
}

/// Checks the string that begins at `at`, just after its opening quote, and returns the place after its closing quote.
fn check_string(text: &str, mut at: usize) -> Result<usize, Fault> {
    loop {
        let rest = &text[at..];
        let end = memchr::memchr3(b'"', b'\\', b'\n', rest.as_bytes()).unwrap_or(rest.len());
        if !is_printable_ascii(&rest.as_bytes()[..end])
            && let Some((odd, c)) = rest[..end].char_indices().find(|(_, c)| !allowed_in_string(*c))
        {
            return Err((at + odd, named(c), "a character that is allowed in strings"));
        }
        at += end;
        let mut after = rest[end..].chars();
        match (after.next(), after.next()) {
            (Some('"'), _) => return Ok(at + 1),
            (Some('\\'), Some('"' | '\\')) => at += 2,
            (Some('\\'), Some(c)) if c != '\n' => {
                return Err((at + 1, named(c), "\" or \\ after the backslash"));
            }
            (first, _) => {
                let line_end = at + usize::from(first == Some('\\'));
                return Err((line_end, "the end of the line within a string".to_owned(), "a closing double quote"));
            }
        }
    }
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
    let end = || "the end of the file".to_owned();
    let mut expected = canonical.lines().peekable();
    // A carriage return is part of the line.
    for (number, found) in (1..).zip(text.split('\n')) {
        let words = found.trim_start_matches(' ');
        if expected.next_if_eq(&found).is_none() && !words.is_empty() && !words.starts_with('#') {
            return Some((number, shortened(found), expected.next().map_or_else(end, shortened)));
        }
    }
    expected.next().map(|missing| (text.lines().count() + 1, end(), shortened(missing)))
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

    /// Many bytes are tested without stopping: several faults must not cancel each other, wherever they are.
    #[test]
    fn several_faults_do_not_cancel_each_other() {
        for faults in 1..=32 {
            let text = format!("{}{}{}\n", "a".repeat(68 - faults), "A".repeat(faults), "a".repeat(68));
            assert_eq!(first_fault(&text).map(|fault| fault.0), Some(68 - faults));
        }
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
            assert_eq!(first_fault(&format!("{line}\n")).map(|fault| fault.1).as_deref(), Some(name));
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
