//! Conversion of hand-written YAML to a tree with `serde_yaml`, with the line and column of every error, and files that
//! are read back once written.

use super::kind::mistaken;
use super::node::{Builder, REPEATED, hand_written_text, location_of, odd_character};
use super::record::File;
use super::{Document, Field, Kind, Limits, Location, Node, Path, Problems, Unreadable, advice, canonical};
use serde::de::DeserializeSeed;
use std::cell::Cell;

/// Reads one YAML document.
///
/// `name` is the file name used in messages. A byte order mark and CR LF line endings are accepted. Refused are documents
/// larger than [`super::LARGEST_DOCUMENT_BYTES`], bytes that are not UTF-8, other CR, and anything that `serde_yaml`
/// cannot read (with line and column).
pub(crate) fn tree(name: &str, bytes: &[u8]) -> Result<(Node, String), Unreadable> {
    let text = hand_written_text(name, bytes)?;
    if text.lines().all(|line| line.trim_start().is_empty() || line.trim_start().starts_with('#')) {
        return Err(Unreadable::whole(name, None, "only spaces and comments", "a YAML document", ""));
    }
    // The YAML reader refuses most of them too, but reports a position that no editor shows.
    if let Some((index, found, cause)) = odd_character(&text) {
        let at = location_of(&text.as_bytes()[..index]);
        return Err(Unreadable::whole(name, Some(at), found, "text with ordinary spaces", cause));
    }
    refuse_deep(name, &text)?;
    // Every value and every byte of a string takes space in the text unless an alias repeats it, so no document without
    // aliases needs this much.
    let budget = Cell::new(4 * text.len() + 64);
    match Builder(&budget).deserialize(serde_yaml::Deserializer::from_str(&text)) {
        Ok(node) => Ok((node, text)),
        Err(error) => Err(unreadable_yaml(name, &text, &error)),
    }
}

/// Words of the parser's error for several documents in one text.
const SEVERAL: &str = "more than one document";

fn unreadable_yaml(name: &str, text: &str, error: &serde_yaml::Error) -> Unreadable {
    let location = error.location().map(|at| Location { line: at.line(), column: at.column() });
    let mut words = error.to_string();
    if let Some(at) = words.find(" at line ") {
        words.truncate(at);
    }
    if let Some(found) = location.and_then(|at| tab(text, at)) {
        return Unreadable::whole(name, location, found, "spaces", "replace the tab with spaces");
    }
    // The parser takes such a line for the beginning of another document.
    let is_marked = text.lines().any(|line| line.starts_with("---"));
    if let Some(line) = less_indented(text).filter(|_| words.contains(SEVERAL) && !is_marked) {
        let (at, found) = (Location { line, column: 1 }, "a line that is indented less than the first one");
        let advice = "begin every key of the file in column 1";
        return Unreadable::whole(name, Some(at), found, "a plain YAML mapping", advice);
    }
    // The parser could read these constructs, but they are refused; the message describes what is in the file.
    let (found, advice) = match words.as_str() {
        deep if deep.ends_with("recursion limit exceeded") => {
            ("values nested too deeply", "check that this is the right file")
        }
        aliases if aliases.ends_with(REPEATED) || aliases.ends_with("repetition limit exceeded") => {
            ("aliases (`*name`) that repeat too much content", "write out the content")
        }
        tag if tag.contains("invalid type: enum") => ("a tag (`!name`)", "delete it"),
        several if several.contains(SEVERAL) => ("several documents (`---`)", "keep one document"),
        _ => {
            if let Some((at, opened)) = unclosed(text, location.map_or(usize::MAX, |at| at.line)) {
                let found = format!("a {opened} that is not closed in its line, in invalid YAML ({words})");
                return Unreadable::whole(name, Some(at), found, "a YAML mapping", format!("close the {opened}"));
            }
            let advice = "check the quotes, brackets and indentation of this line and the one before";
            return Unreadable::whole(name, location, format!("invalid YAML ({words})"), "a YAML mapping", advice);
        }
    };
    Unreadable::whole(name, location, found, "a plain YAML mapping", advice)
}

/// Returns the number of the first line that is indented less than the first line with content.
fn less_indented(text: &str) -> Option<usize> {
    let indent = |line: &str| line.len() - line.trim_start_matches(' ').len();
    let mut lines =
        (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'));
    let (_, first) = lines.next()?;
    lines.find(|(_, line)| indent(line) < indent(first)).map(|(number, _)| number)
}

/// Returns the place and the kind of the first quote that is not closed in its line, or else of the last bracket that is
/// still open at the end of line `last`. The parser reports only where it no longer understands the text, often many lines
/// below.
fn unclosed(text: &str, last: usize) -> Option<(Location, &'static str)> {
    let mut brackets = Vec::new();
    for (line, words) in (1..=last).zip(text.lines()) {
        let mut chars = (1..).zip(words.chars()).peekable();
        // A quote or a bracket begins a value only there; elsewhere it is one of its characters.
        let (mut begins, mut before) = (true, ' ');
        while let Some((column, c)) = chars.next() {
            let at = Location { line, column };
            match c {
                '#' if before == ' ' => break,
                '"' | '\'' if begins => loop {
                    match chars.next() {
                        None => return Some((at, "quote")),
                        Some((_, '\\')) if c == '"' => drop(chars.next()),
                        // In a text in single quotes, two are one.
                        Some((_, end)) if end == c && chars.next_if(|(_, next)| c == '\'' && *next == c).is_none() => {
                            break;
                        }
                        Some(_) => {}
                    }
                },
                '[' | '{' if begins => brackets.push((at, "bracket")),
                ']' | '}' => drop(brackets.pop()),
                _ => {}
            }
            begins = match c {
                ' ' => begins || ":-".contains(before),
                ',' => !brackets.is_empty(),
                _ => "[{".contains(c),
            };
            before = c;
        }
    }
    brackets.pop()
}

/// Describes a tab that indents the line at `at` or is the character there, or returns `None` if there is none.
fn tab(text: &str, at: Location) -> Option<&'static str> {
    let line = text.lines().nth(at.line.checked_sub(1)?)?;
    if line.trim_start_matches(' ').starts_with('\t') {
        return Some("a tab before the first word");
    }
    (line.chars().nth(at.column.checked_sub(1)?)? == '\t').then_some("a tab before a value")
}

/// Maximum nesting of brackets in a document; a position's matrix in a list needs four.
const DEEPEST: usize = 64;

/// Maximum number of values: a base number, and one more for each given number of bytes. A stand of 4,000 positions has
/// one value for every six bytes; a file with more values than the limit is not a document of this project.
const MOST_VALUES: (usize, usize) = (25_000, 5);

/// Refuses brackets nested deeper than [`DEEPEST`] outside strings and comments, too many brackets
/// in total, and more than [`MOST_VALUES`] values.
///
/// The parser examines every open bracket at every token, so a million of them would occupy it for minutes. It keeps
/// about a hundred bytes for each value, and twice that while it grows, so a text of commas would need two hundred
/// times its size. This check assumes that a string ends with its line, as in signed texts, and that any quote begins a
/// string. A quote inside a plain word does not begin one, and so hides the brackets after it. The total numbers
/// therefore include the content of strings.
fn refuse_deep(name: &str, text: &str) -> Result<(), Unreadable> {
    let refuse = |line: usize, column: usize, found: String| {
        let at = Some(Location { line: line + 1, column: column + 1 });
        Err(Unreadable::whole(name, at, found, "a file of dtg-passport", "check that this is the right file"))
    };
    let most_values = MOST_VALUES.0 + text.len() / MOST_VALUES.1;
    let (mut depth, mut opened, mut values) = (0_usize, 0_usize, 0_usize);
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with('#')) {
        let (mut in_string, mut escaped) = (false, false);
        // A comma with no colon since the last comma can end two values, because a key in braces may have no value.
        let mut paired = false;
        values += 1;
        for (column, c) in line.chars().enumerate() {
            opened += usize::from("[{".contains(c));
            values += match c {
                ':' | '?' => 1,
                '-' | '[' | '{' => 2,
                ',' => 2 - usize::from(paired),
                _ => 0,
            };
            paired = c == ':' || (paired && c != ',');
            match c {
                _ if escaped => escaped = false,
                '\\' => escaped = in_string,
                '"' => in_string = !in_string,
                '[' | '{' if !in_string => depth += 1,
                ']' | '}' if !in_string => depth = depth.saturating_sub(1),
                _ => {}
            }
            if depth > DEEPEST {
                return refuse(index, column, format!("more than {DEEPEST} nested brackets"));
            }
            if opened > Limits::DOCUMENT.brackets {
                return refuse(index, column, format!("more than {} brackets", Limits::DOCUMENT.brackets));
            }
            if values > most_values {
                return refuse(index, column, format!("more than {most_values} values in {} bytes", text.len()));
            }
        }
    }
    Ok(())
}

/// Reads a document of the record type `T`: first the tree, then its `format`, then the fields, and finally the rules
/// of its content (`check`). Every error of the stage that fails is reported.
pub(crate) fn read_document<T: Document>(
    name: &str,
    bytes: &[u8],
    check: impl FnOnce(&T, &mut Problems),
) -> Result<T, Unreadable> {
    parse(name, bytes, check).map_err(|unreadable| {
        let expected = Kind::of_format(T::FORMAT).map_or(T::FORMAT, |kind| kind.words());
        // The message about another format shows its line.
        let other = mistaken(name, bytes, expected, Kind::is_yaml);
        other.unwrap_or_else(|| unreadable.in_text(bytes))
    })
}

fn parse<T: Document>(name: &str, bytes: &[u8], check: impl FnOnce(&T, &mut Problems)) -> Result<T, Unreadable> {
    let (node, text) = tree(name, bytes)?;
    let mut problems = Problems::default();
    let value = File::<T>::read(&node, &Path::Root, &mut problems).map(|File(value)| value);
    if let Some(value) = &value {
        check(value, &mut problems);
    }
    advice::check_placeholders(&node, &mut problems);
    value.filter(|_| problems.is_empty()).ok_or_else(|| problems.refuse(name, &text))
}

/// Writes the file of a document with `comments` above its keys, and reads it back with `read` as a check; `name` is its
/// name in messages.
pub(crate) fn write_document<T: Document + PartialEq>(
    name: &str,
    document: &T,
    comments: &dyn Fn(&str) -> Vec<String>,
    read: fn(&str, &[u8]) -> Result<T, Unreadable>,
) -> Result<String, Unreadable> {
    let text = canonical::write(&File(document.clone()), comments);
    if read(name, text.as_bytes())? == *document {
        return Ok(text);
    }
    Err(Unreadable::whole(name, None, "other content than was written", "the same", "report this"))
}
