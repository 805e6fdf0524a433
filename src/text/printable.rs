//! Text of others among the program's own words: names, labels, paths and reasons are shown, and do nothing.
//!
//! A file's name, or a label in a signature that nobody has verified, could hold a line that looks like a verdict, a
//! terminal's commands, or characters that turn or hide what stands beside them. So whatever is not the program's own
//! passes through [`Printable`] into a message, and every message and result through [`outgoing`] or [`json`] on its way
//! out, where only line feeds and emphasis are left of what a terminal obeys.

use super::rule;
use serde::Serialize;
use std::fmt::{self, Display, Formatter, Write};
use std::path::{self, Path};

/// What the program draws or writes beyond the characters of a signed text: superscripts, subscripts, bars, and what
/// stands for bytes that are no text.
fn drawn(c: char) -> bool {
    matches!(c, '\u{2070}'..='\u{209C}' | '\u{2500}'..='\u{259F}' | '\u{FFFD}')
}

/// Whether a character is shown as it is: it can be seen, stands alone, and turns nothing round.
fn visible(c: char) -> bool {
    rule::allowed_in_string(c) || drawn(c)
}

/// Displays a value on one line, every character that cannot be seen as Rust would write it (`\n`, `\u{202e}`).
///
/// What is printable already stays as it is: to escape it twice does no harm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Printable<T>(pub T);

impl<T: Display> Display for Printable<T> {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        write!(Escaping(f, visible), "{}", self.0)
    }
}

/// The text as [`Printable`] displays it.
pub(crate) fn printable(text: impl Display) -> String {
    Printable(text).to_string()
}

/// A path for a message.
pub(crate) fn shown(path: &Path) -> Printable<path::Display<'_>> {
    Printable(path.display())
}

/// A path as the name of a document: a value, which is escaped where it goes out.
pub(crate) fn name_of(path: &Path) -> String {
    path.display().to_string()
}

/// Writes on, what is not `kept` escaped.
struct Escaping<'a, W>(&'a mut W, fn(char) -> bool);

impl<W: Write> Write for Escaping<'_, W> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let Self(out, kept) = self;
        let mut rest = text;
        while let Some((at, c)) = rest.char_indices().find(|(_, c)| !kept(*c)) {
            write!(out, "{}{}", &rest[..at], c.escape_default())?;
            rest = &rest[at + c.len_utf8()..];
        }
        out.write_str(rest)
    }
}

/// A page, in which besides line feeds the blanks of typesetting are kept: U+00A0, U+2002, U+202F.
pub(crate) fn page(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    // A string takes all that is written.
    let _ = Escaping(&mut shown, |c| visible(c) || "\n\u{A0}\u{2002}\u{202F}".contains(c)).write_str(text);
    shown
}

/// A result or a message on its way out, of which line feeds are kept, and `codes`, the emphasis of a terminal.
pub(crate) fn outgoing(text: &str, codes: &[&str]) -> String {
    let mut shown = String::with_capacity(text.len());
    let mut rest = text;
    loop {
        let (before, after) = rest.split_once('\u{1B}').map_or((rest, None), |(before, after)| (before, Some(after)));
        let _ = Escaping(&mut shown, |c| visible(c) || c == '\n').write_str(before);
        let Some(after) = after else { break };
        shown.push_str(if codes.iter().any(|code| after.starts_with(code)) { "\u{1B}" } else { "\\u{1b}" });
        rest = after;
    }
    shown
}

/// A value as JSON, its strings to the character, those that cannot be seen as `\uXXXX`.
///
/// # Errors
/// When the value cannot be written as JSON.
pub(crate) fn json(value: &impl Serialize) -> Result<String, serde_json::Error> {
    // Outside of strings JSON is ASCII.
    let text = serde_json::to_string_pretty(value)?;
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        if visible(c) || c == '\n' {
            escaped.push(c);
        } else {
            for unit in c.encode_utf16(&mut [0; 2]) {
                let _ = write!(escaped, "\\u{unit:04x}");
            }
        }
    }
    Ok(escaped)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_would_obey_is_escaped() {
        assert_eq!(printable("паспорт é 'a' \"b\" \\"), "паспорт é 'a' \"b\" \\");
        let hostile = "a\nb\r\t\u{1b}[31m\u{9b}\u{202e}\u{200b}\u{2028}\u{3164}\u{301}";
        let shown = "a\\nb\\r\\t\\u{1b}[31m\\u{9b}\\u{202e}\\u{200b}\\u{2028}\\u{3164}\\u{301}";
        assert_eq!(printable(hostile), shown);
        assert_eq!(printable(shown), shown);
    }

    #[test]
    fn only_line_feeds_and_emphasis_go_out() {
        let codes = ["[1m", "[0m"];
        assert_eq!(outgoing("\u{1b}[1mA\u{1b}[0m\nb", &codes), "\u{1b}[1mA\u{1b}[0m\nb");
        assert_eq!(outgoing("a\u{1b}[31m\u{1b}\u{1b}[1m\r\u{1b}", &codes), "a\\u{1b}[31m\\u{1b}\u{1b}[1m\\r\\u{1b}");
    }

    #[test]
    fn json_gives_the_value_back() {
        let hostile = "a\n\"\\\u{1b}\u{7f}\u{85}\u{202e}\u{e0041}é漢א";
        let json = json(&[hostile]).unwrap();
        assert!(json.chars().all(|c| c == '\n' || visible(c)), "{json}");
        assert_eq!(serde_json::from_str::<Vec<String>>(&json).unwrap(), [hostile]);
    }
}
