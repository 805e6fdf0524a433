//! Safe display of text from other sources: names, labels, paths and reasons.
//!
//! A file name, or a label in an unverified signature, could contain a line that looks like a result, terminal
//! commands, or characters that reverse or hide the text next to them. Therefore [`Printable`] escapes all foreign text
//! in a message. In addition, every message and result is written through [`outgoing`] or [`json`], which keep only
//! line feeds and emphasis of all that a terminal interprets.

use super::characters::allowed_in_string;
use serde::Serialize;
use std::fmt::{self, Display, Formatter, Write};
use std::path::{self, Path};

/// Returns `true` for the characters that the program writes beyond those of signed texts: superscripts, subscripts,
/// bars, marks of results, and the replacement character for invalid bytes.
fn drawn(c: char) -> bool {
    matches!(c, '\u{2070}'..='\u{209C}' | '\u{2500}'..='\u{25FF}' | '\u{2715}' | '\u{FFFD}')
}

/// Returns `true` if a character is shown unescaped: it is visible, stands alone, and reverses no text.
fn visible(c: char) -> bool {
    allowed_in_string(c) || drawn(c)
}

/// Wrapper that displays a value on one line and escapes every invisible character as Rust does (`\n`, `\u{202e}`).
///
/// Escaping an escaped text again does not change it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Printable<T>(pub T);

impl<T: Display> Display for Printable<T> {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        write!(Escaping(f, visible), "{}", self.0)
    }
}

pub(crate) fn printable(text: impl Display) -> String {
    Printable(text).to_string()
}

/// Returns a path for a message.
pub(crate) fn shown(path: &Path) -> Printable<path::Display<'_>> {
    Printable(path.display())
}

/// Returns a path as the name of a document. The name is not escaped; messages escape it.
pub(crate) fn name_of(path: &Path) -> String {
    path.display().to_string()
}

/// Number of characters in 32 bytes as base64 without padding, the shortest form of a key.
const LEAST_OF_A_KEY: usize = 43;

/// Number of characters that remain of what may be a secret.
const REMAINING: usize = 8;

/// Returns text of a file for a message, because messages end up in logs: of each word that may be a secret (a key of age,
/// or 32 bytes or more as base64 or hexadecimal), only the first 8 characters remain.
pub(crate) fn without_secrets(text: &str) -> String {
    let is_in_word = |c: char| c.is_ascii_alphanumeric() || "+/=_-:".contains(c);
    let (mut shown, mut rest) = (String::with_capacity(text.len()), text);
    while let Some(start) = rest.find(is_in_word) {
        let end = rest[start..].find(|c| !is_in_word(c)).map_or(rest.len(), |length| start + length);
        match may_be_secret(&rest[start..end]) {
            true => shown.extend([&rest[..start + REMAINING], "…"]),
            false => shown.push_str(&rest[..end]),
        }
        rest = &rest[end..];
    }
    shown + rest
}

/// Returns `true` if a word may contain a secret. Fingerprints, numbers, and long words in lower case are not taken for one.
fn may_be_secret(word: &str) -> bool {
    let has = |run: &str, is: fn(&u8) -> bool| run.as_bytes().iter().any(is);
    let runs = |is_part: fn(char) -> bool| word.split(move |c| !is_part(c)).filter(|run| run.len() >= LEAST_OF_A_KEY);
    let mut base64 = runs(|c| c.is_ascii_alphanumeric() || "+/".contains(c));
    let mut for_urls = runs(|c| c.is_ascii_alphanumeric() || "-_".contains(c));
    let mut hexadecimal = runs(|c| c.is_ascii_hexdigit() || c == ':');
    !word.starts_with("SHA256:")
        && (word.to_ascii_uppercase().contains("AGE-SECRET-KEY")
            || base64.any(|run| has(run, u8::is_ascii_uppercase))
            || for_urls.any(|run| {
                [u8::is_ascii_uppercase, u8::is_ascii_lowercase, u8::is_ascii_digit].iter().all(|is| has(run, *is))
            })
            || hexadecimal.any(|run| has(run, u8::is_ascii_alphabetic) && run.replace(':', "").len() >= 64))
}

/// Writer that escapes every character that the function rejects.
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

/// Escapes a page. Besides line feeds, it keeps the typographic spaces U+00A0, U+2002 and U+202F.
pub(crate) fn page(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    // Writing into a string cannot fail.
    let _ = Escaping(&mut shown, |c| visible(c) || "\n\u{A0}\u{2002}\u{202F}".contains(c)).write_str(text);
    shown
}

/// Escapes a result or a message before output, except line feeds and `codes`, the emphasis of a terminal.
pub(crate) fn outgoing(text: &str, codes: &[&str]) -> String {
    let mut shown = String::with_capacity(text.len());
    for (index, part) in text.split('\u{1B}').enumerate() {
        if index > 0 {
            shown.push_str(if codes.iter().any(|code| part.starts_with(code)) { "\u{1B}" } else { "\\u{1b}" });
        }
        let _ = Escaping(&mut shown, |c| visible(c) || c == '\n').write_str(part);
    }
    shown
}

/// Returns a value as indented JSON, in which invisible characters are escaped as `\uXXXX`.
pub(crate) fn json(value: &impl Serialize) -> Result<String, serde_json::Error> {
    Ok(json_escaped(&serde_json::to_string_pretty(value)?))
}

/// Returns a value as JSON on a single line, escaped as [`json`] does.
pub(crate) fn json_line(value: &impl Serialize) -> Result<String, serde_json::Error> {
    Ok(json_escaped(&serde_json::to_string(value)?))
}

/// Escapes the invisible characters of a JSON text, all of which are in its strings: outside strings, JSON is ASCII.
fn json_escaped(text: &str) -> String {
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
    escaped
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
    fn what_the_program_draws_itself_is_shown() {
        assert_eq!(printable("u² 10⁻⁶ x₁ ─█● ✕ \u{fffd}"), "u² 10⁻⁶ x₁ ─█● ✕ \u{fffd}");
        let typographic = "1\u{a0}м\n\u{2002}1\u{202f}000 ✕";
        assert_eq!(page(&format!("{typographic}\u{1b}\u{202e}\t")), format!("{typographic}\\u{{1b}}\\u{{202e}}\\t"));
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
        // Expected: RFC 8259, section 7.
        assert_eq!(json_line(&["a", "\u{202e}", "\u{e0041}"]).unwrap(), r#"["a","\u202e","\udb40\udc41"]"#);
    }
}
