//! The one form in which a signed text is written, and a quick reader of that form alone.
//!
//! [`write()`] and [`scan()`] are each other's inverse. What `scan` makes of a text counts only when `write` makes the
//! same text of it again ([`is_written()`]): [`crate::document::parse`] sees to that, and gives every other text to the
//! general reader.

use super::node::{MOST_BRACKETS, Node};
use super::rule;
use super::sink::Sink;
use super::{Field, LARGEST_DOCUMENT_BYTES};

/// The comment lines above a key, given as a path like `earth.gravity_m_per_s2`; without the `# `.
pub type Comments<'a> = &'a dyn Fn(&str) -> Vec<String>;

/// No comments at all: the form that texts are compared in.
pub fn no_comments(_: &str) -> Vec<String> {
    Vec::new()
}

/// Writes a mapping: nested mappings as blocks, each item of a list of mappings on its own line, a matrix on one line.
pub fn write(document: &impl Field, comments: Comments) -> String {
    let mut text = String::with_capacity(USUAL_BYTES);
    write_some(&mut text, document, comments, &|_| true);
    text
}

/// Writes those keys of a mapping that are `wanted` to the end of a text, nested ones aside, which go with theirs.
pub fn write_some(text: &mut String, document: &impl Field, comments: Comments, wanted: &dyn Fn(&str) -> bool) {
    let writer = Writer { wanted, ..Writer::new(std::mem::take(text), comments) };
    *text = writer.written(document);
}

/// Whether `text`, its comments and blank lines aside, is what [`write()`] makes of the document.
pub fn is_written(document: &impl Field, text: &str) -> bool {
    let compared = Writer::new(Compared { rest: Some(text.as_bytes()) }, &no_comments).written(document);
    compared.rest.is_some_and(|rest| after_comments(rest).is_empty())
}

/// A passport has some 9,000 bytes.
const USUAL_BYTES: usize = 12_000;

/// Where the parts of a text go, one after the other.
trait Output {
    fn push(&mut self, part: &str);

    /// The next part begins a line.
    fn begin_line(&mut self) {}
}

impl Output for String {
    fn push(&mut self, part: &str) {
        self.push_str(part);
    }
}

/// A text that the parts are compared with; `None` from the first on that differs.
struct Compared<'t> {
    rest: Option<&'t [u8]>,
}

impl Output for Compared<'_> {
    #[inline]
    fn push(&mut self, part: &str) {
        self.rest = self.rest.and_then(|rest| rest.strip_prefix(part.as_bytes()));
    }

    fn begin_line(&mut self) {
        self.rest = self.rest.map(after_comments);
    }
}

/// What follows the lines that are blank or a comment.
fn after_comments(mut text: &[u8]) -> &[u8] {
    while let Some(start) = text.iter().position(|byte| *byte != b' ') {
        let end = match text[start] {
            b'\n' => start,
            b'#' => match memchr::memchr(b'\n', text) {
                // What else could stand in a comment the general reader decides.
                Some(end) if rule::is_printable_ascii(&text[..end]) => end,
                _ => return text,
            },
            _ => return text,
        };
        text = &text[end + 1..];
    }
    text
}

struct Writer<'a, O> {
    text: O,
    /// The keys from the top to the current one, joined by points.
    path: String,
    /// How much of the path leads to the current mapping.
    outer: usize,
    /// Blocks around the current key.
    depth: usize,
    /// Brackets around the current value; 0: it stands behind its key, which began a line.
    inline: usize,
    /// Whether no key has been written yet in the current brackets.
    first: bool,
    comments: Comments<'a>,
    /// Which keys are written, those at the top.
    wanted: &'a dyn Fn(&str) -> bool,
}

impl<'a, O: Output> Writer<'a, O> {
    fn new(text: O, comments: Comments<'a>) -> Self {
        Self { text, path: String::new(), outer: 0, depth: 0, inline: 0, first: true, comments, wanted: &|_| true }
    }

    fn written(mut self, document: &impl Field) -> O {
        if document.is_mapping() {
            document.emit(&mut self);
        }
        self.text
    }

    fn indent(&mut self) {
        (1..self.depth).for_each(|_| self.text.push("  "));
    }

    /// A value on the line of its key.
    fn on_the_line(&mut self, write: impl FnOnce(&mut Self)) {
        if self.inline > 0 {
            return write(self);
        }
        self.text.push(" ");
        self.bracketed(write);
        self.text.push("\n");
    }

    fn bracketed(&mut self, write: impl FnOnce(&mut Self)) {
        self.inline += 1;
        write(self);
        self.inline -= 1;
    }
}

impl<O: Output> Sink for Writer<'_, O> {
    fn null(&mut self) {
        self.on_the_line(|writer| writer.text.push("null"));
    }

    fn boolean(&mut self, value: bool) {
        self.on_the_line(|writer| writer.text.push(if value { "true" } else { "false" }));
    }

    fn integer(&mut self, value: i64) {
        const DIGITS: [&str; 10] = ["0", "1", "2", "3", "4", "5", "6", "7", "8", "9"];
        // Indices of positions mostly.
        let digit = usize::try_from(value).ok().and_then(|value| DIGITS.get(value));
        self.on_the_line(|writer| match digit {
            Some(digit) => writer.text.push(digit),
            None => writer.text.push(&value.to_string()),
        });
    }

    fn number(&mut self, value: f64) {
        self.on_the_line(|writer| rule::write_number(value, |part| writer.text.push(part)));
    }

    fn text(&mut self, value: &str) {
        self.on_the_line(|writer| rule::write_quoted(value, |part| writer.text.push(part)));
    }

    fn list<T: Field>(&mut self, items: &[T]) {
        let mut items = items.iter().filter(|item| !item.is_absent()).peekable();
        if self.inline == 0 && items.peek().is_some_and(|first| first.is_mapping()) {
            self.text.push("\n");
            for item in items {
                self.text.begin_line();
                self.indent();
                self.text.push("  - ");
                self.bracketed(|writer| item.emit(writer));
                self.text.push("\n");
            }
            return;
        }
        self.on_the_line(|writer| {
            writer.text.push("[");
            for (index, item) in items.enumerate() {
                if index > 0 {
                    writer.text.push(", ");
                }
                writer.bracketed(|writer| item.emit(writer));
            }
            writer.text.push("]");
        });
    }

    fn mapping(&mut self, empty: bool, entries: impl FnOnce(&mut Self)) {
        if self.inline > 0 || (empty && self.depth > 0) {
            return self.on_the_line(|writer| {
                writer.text.push("{");
                let outer = std::mem::replace(&mut writer.first, true);
                writer.bracketed(entries);
                writer.first = outer;
                writer.text.push("}");
            });
        }
        if self.depth > 0 {
            self.text.push("\n");
        }
        let outer = std::mem::replace(&mut self.outer, self.path.len());
        self.depth += 1;
        entries(self);
        self.depth -= 1;
        self.outer = outer;
    }

    fn key(&mut self, key: &str) -> bool {
        if self.inline > 0 {
            if !std::mem::take(&mut self.first) {
                self.text.push(", ");
            }
            self.text.push(key);
            self.text.push(": ");
            return true;
        }
        if self.depth == 1 && !(self.wanted)(key) {
            return false;
        }
        self.path.truncate(self.outer);
        self.path.push_str(if self.outer > 0 { "." } else { "" });
        self.path.push_str(key);
        self.text.begin_line();
        for line in (self.comments)(&self.path) {
            self.indent();
            ["# ", &line, "\n"].into_iter().for_each(|part| self.text.push(part));
        }
        self.indent();
        self.text.push(key);
        self.text.push(":");
        true
    }
}

/// Reads a text in canonical form, comments and blank lines aside; `None` for any other, and for some that are hardly
/// different: a number written in another way may be taken, so ask [`is_written()`].
///
/// It never looks back and has no depth but that of the type.
pub fn scan<T: Field>(text: &str) -> Option<T> {
    // The general reader refuses these; so many brackets need as many bytes.
    let brackets = |text: &str| text.bytes().filter(|byte| b"[{".contains(byte)).count();
    if text.len() > LARGEST_DOCUMENT_BYTES || (text.len() > MOST_BRACKETS && brackets(text) > MOST_BRACKETS) {
        return None;
    }
    let mut scanner = Scanner { rest: text, depth: 0, inline: false, first: true };
    let document = T::scan(&mut scanner)?;
    scanner.skip_comments();
    scanner.rest.is_empty().then_some(document)
}

/// A place in a text in canonical form.
#[derive(Debug, Clone)]
pub struct Scanner<'t> {
    rest: &'t str,
    /// Blocks around the current key.
    depth: usize,
    /// Whether brackets are open, or a line is being read to its end.
    inline: bool,
    /// Whether no key has been read yet in the current brackets.
    first: bool,
}

impl<'t> Scanner<'t> {
    fn take(&mut self, text: &str) -> Option<()> {
        self.rest = self.rest.strip_prefix(text)?;
        Some(())
    }

    fn skip_comments(&mut self) {
        // They are ASCII.
        self.rest = &self.rest[self.rest.len() - after_comments(self.rest.as_bytes()).len()..];
    }

    /// The keys of a mapping, which [`Scanner::entry`] reads one after the other.
    pub fn mapping<T>(&mut self, entries: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        if self.inline || (self.depth > 0 && self.rest.starts_with(" {")) {
            return self.on_the_line(|scanner| {
                scanner.take("{")?;
                let outer = std::mem::replace(&mut scanner.first, true);
                let mapping = entries(scanner)?;
                scanner.first = outer;
                scanner.take("}")?;
                Some(mapping)
            });
        }
        if self.depth > 0 {
            self.take("\n")?;
        }
        self.depth += 1;
        let mapping = entries(self)?;
        self.depth -= 1;
        Some(mapping)
    }

    /// The value of `key` when that is the next key, otherwise its value when absent.
    pub fn entry<T: Field>(&mut self, key: &str) -> Option<T> {
        if self.at_key(key).is_some() { T::scan(self) } else { T::absent() }
    }

    /// Passes over `key` when that is the next one.
    fn at_key(&mut self, key: &str) -> Option<()> {
        let rest = if self.inline {
            let rest = if self.first { self.rest } else { self.rest.strip_prefix(", ")? };
            let rest = rest.strip_prefix(key)?.strip_prefix(": ")?;
            self.first = false;
            rest
        } else {
            self.skip_comments();
            self.indented(0)?.strip_prefix(key)?.strip_prefix(':')?
        };
        self.rest = rest;
        Some(())
    }

    /// The line without the indent of the current block and `more` blanks.
    fn indented(&self, more: usize) -> Option<&'t str> {
        let indent = 2 * (self.depth - 1) + more;
        let (blanks, rest) = self.rest.split_at_checked(indent)?;
        blanks.bytes().all(|byte| byte == b' ').then_some(rest)
    }

    /// A value on the line of its key, with the line's end.
    fn on_the_line<T>(&mut self, read: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        if self.inline {
            return read(self);
        }
        self.take(" ")?;
        let value = self.bracketed(read)?;
        self.take("\n")?;
        Some(value)
    }

    fn bracketed<T>(&mut self, read: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        let outer = std::mem::replace(&mut self.inline, true);
        let value = read(self)?;
        self.inline = outer;
        Some(value)
    }

    /// The items of a list.
    pub fn list<T: Field>(&mut self) -> Option<Vec<T>> {
        let mut items = Vec::new();
        if !self.inline && self.rest.starts_with('\n') {
            self.take("\n")?;
            loop {
                self.skip_comments();
                let Some(item) = self.indented(2).and_then(|rest| rest.strip_prefix("- ")) else { return Some(items) };
                self.rest = item;
                items.push(self.bracketed(T::scan)?);
                self.take("\n")?;
            }
        }
        self.on_the_line(|scanner| {
            scanner.take("[")?;
            if scanner.take("]").is_some() {
                return Some(items);
            }
            loop {
                items.push(T::scan(scanner)?);
                if scanner.take("]").is_some() {
                    return Some(items);
                }
                scanner.take(", ")?;
            }
        })
    }

    /// A value that is neither list nor mapping.
    pub fn scalar(&mut self) -> Option<Node> {
        self.on_the_line(|scanner| match scanner.rest.strip_prefix('"') {
            Some(text) => scanner.quoted(text),
            None => match scanner.word()? {
                "true" => Some(Node::Bool(true)),
                "false" => Some(Node::Bool(false)),
                whole => whole.parse().ok().map(Node::Integer),
            },
        })
    }

    /// A number with a point.
    pub fn number(&mut self) -> Option<f64> {
        self.on_the_line(|scanner| scanner.word()?.parse().ok())
    }

    fn word(&mut self) -> Option<&'t str> {
        let end = self.rest.bytes().position(|byte| matches!(byte, b',' | b']' | b'}' | b'\n'))?;
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        Some(word)
    }

    /// The string that begins `text`, its opening quote aside.
    fn quoted(&mut self, text: &'t str) -> Option<Node> {
        let mut string = String::new();
        let mut rest = text;
        loop {
            let end = memchr::memchr3(b'"', b'\\', b'\n', rest.as_bytes())?;
            string.push_str(&rest[..end]);
            let (found, after) = rest[end..].split_at(1);
            match found {
                "\"" => {
                    self.rest = after;
                    return Some(Node::Text(string));
                }
                "\\" if after.starts_with(['"', '\\']) => {
                    let (escaped, after) = after.split_at(1);
                    string.push_str(escaped);
                    rest = after;
                }
                _ => return None,
            }
        }
    }
}
