//! Scanner of the canonical form, which accepts no other form.

use super::after_comments;
use crate::text::node::{Node, location_of};
use crate::text::problem::UPDATE;
use crate::text::{Limits, Problem, rule};

/// Reads a text with `read`. It may accept a number in another form, so write the result again and compare the texts.
///
/// # Errors
/// Returns the place at which the scanner stopped.
pub(super) fn scan<T>(text: &str, limits: Limits, read: impl FnOnce(&mut Scanner) -> Option<T>) -> Result<T, Problem> {
    // Count the brackets only if the text is long enough to contain too many.
    let brackets = |text: &str| text.bytes().filter(|byte| b"[{".contains(byte)).count();
    let too_large = text.len() > limits.bytes || (text.len() > limits.brackets && brackets(text) > limits.brackets);
    let mut scanner = Scanner { rest: text, depth: 0, inline: false, first: true, known: [&[]; DEEPEST + 1] };
    let document = if too_large { None } else { read(&mut scanner) };
    let rest = scanner.after_comments();
    document.filter(|_| rest.is_empty()).ok_or_else(|| {
        let at = location_of(&text.as_bytes()[..text.len() - rest.len()]);
        let found = rest.lines().next().map_or_else(|| "the end of the file".to_owned(), rule::shortened);
        let advice = if scanner.stopped_at_unknown_key(rest) { UPDATE } else { rule::NOT_CANONICAL };
        Problem::new(Some(at), "", found, "the next key of this format", advice)
    })
}

/// Deepest nesting of blocks whose keys are remembered for messages; a passport has two.
const DEEPEST: usize = 4;

#[derive(Debug)]
pub(crate) struct Scanner<'t> {
    rest: &'t str,
    /// Number of blocks around the current key.
    depth: usize,
    /// Whether the scanner is inside brackets or in the rest of a line.
    inline: bool,
    /// Whether no key has been read yet in the current brackets.
    first: bool,
    /// Keys of the mapping in the current brackets, then those of the last block at each depth.
    known: [&'static [&'static str]; DEEPEST + 1],
}

impl<'t> Scanner<'t> {
    fn take(&mut self, text: &str) -> Option<()> {
        self.rest = self.rest.strip_prefix(text)?;
        Some(())
    }

    fn after_comments(&self) -> &'t str {
        // Slicing is safe, because skipped comments are ASCII.
        &self.rest[self.rest.len() - after_comments(self.rest.as_bytes()).len()..]
    }

    /// Reads a mapping with the keys `known`; `entries` reads them one after the other with [`Scanner::entry`].
    pub(crate) fn mapping<T>(
        &mut self,
        known: &'static [&'static str],
        entries: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T> {
        if self.inline || (self.depth > 0 && self.rest.starts_with(" {")) {
            return self.on_the_line(|scanner| {
                scanner.take("{")?;
                let outer = std::mem::replace(&mut scanner.first, true);
                let outer_known = std::mem::replace(&mut scanner.known[0], known);
                let mapping = entries(scanner)?;
                (scanner.first, scanner.known[0]) = (outer, outer_known);
                scanner.take("}")?;
                Some(mapping)
            });
        }
        if self.depth > 0 {
            self.take("\n")?;
        }
        self.depth += 1;
        self.known[self.depth.min(DEEPEST)] = known;
        let mapping = entries(self)?;
        self.depth -= 1;
        Some(mapping)
    }

    /// Returns `true` if `rest`, at which the scanner stopped, begins with a key that its mapping does not have.
    fn stopped_at_unknown_key(&self, rest: &str) -> bool {
        let line = rest.trim_start_matches([',', ' ']);
        let place = if self.inline { 0 } else { (rest.len() - line.len()) / 2 + 1 };
        let known = self.known.get(place).copied().unwrap_or_default();
        let is_key = |key: &str| key.bytes().all(|byte| byte == b'_' || byte.is_ascii_alphanumeric());
        !known.is_empty() && line.split_once(':').is_some_and(|(key, _)| is_key(key) && !known.contains(&key))
    }

    /// Reads the value of `key` if that is the next key; otherwise returns the value of an absent key.
    pub(crate) fn entry<T>(
        &mut self,
        key: &'static str,
        absent: impl FnOnce() -> Option<T>,
        read: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T> {
        if self.at_key(key).is_some() { read(self) } else { absent() }
    }

    /// Skips `key` if that is the next key, otherwise returns `None`.
    fn at_key(&mut self, key: &str) -> Option<()> {
        let rest = if self.inline {
            let rest = if self.first { self.rest } else { self.rest.strip_prefix(", ")? };
            let rest = rest.strip_prefix(key)?.strip_prefix(": ")?;
            self.first = false;
            rest
        } else {
            self.indented(self.after_comments(), 0)?.strip_prefix(key)?.strip_prefix(':')?
        };
        self.rest = rest;
        Some(())
    }

    /// Returns the text without the indentation of the current block and `more` spaces; `None` if it is indented less.
    fn indented(&self, text: &'t str, more: usize) -> Option<&'t str> {
        let indent = 2 * (self.depth - 1) + more;
        let (blanks, rest) = text.split_at_checked(indent)?;
        blanks.bytes().all(|byte| byte == b' ').then_some(rest)
    }

    /// Reads a value on the line of its key, and the end of that line.
    pub(crate) fn on_the_line<T>(&mut self, read: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
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

    pub(crate) fn list<T>(&mut self, read: impl Fn(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        let mut items = Vec::new();
        if !self.inline && self.rest.starts_with('\n') {
            self.take("\n")?;
            loop {
                // Comments above the next key are not part of the list.
                let line = self.indented(self.after_comments(), 2);
                let Some(item) = line.and_then(|line| line.strip_prefix("- ")) else { return Some(items) };
                self.rest = item;
                items.push(self.bracketed(&read)?);
                self.take("\n")?;
            }
        }
        self.on_the_line(|scanner| {
            scanner.take("[")?;
            if scanner.take("]").is_some() {
                return Some(items);
            }
            loop {
                items.push(read(scanner)?);
                if scanner.take("]").is_some() {
                    return Some(items);
                }
                scanner.take(", ")?;
            }
        })
    }

    /// Reads a value that is neither list nor mapping.
    pub(crate) fn scalar(&mut self) -> Option<Node> {
        self.on_the_line(|scanner| match scanner.rest.strip_prefix('"') {
            Some(text) => scanner.quoted(text).map(Node::Text),
            None => match scanner.word()? {
                "true" => Some(Node::Bool(true)),
                "false" => Some(Node::Bool(false)),
                whole => whole.parse().ok().map(Node::Integer),
            },
        })
    }

    pub(crate) fn string(&mut self) -> Option<String> {
        self.on_the_line(|scanner| scanner.quoted(scanner.rest.strip_prefix('"')?))
    }

    /// Reads a number with a point.
    pub(crate) fn number(&mut self) -> Option<f64> {
        self.on_the_line(|scanner| scanner.word()?.parse().ok())
    }

    fn word(&mut self) -> Option<&'t str> {
        let end = self.rest.bytes().position(|byte| matches!(byte, b',' | b']' | b'}' | b'\n'))?;
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        Some(word)
    }

    /// Reads the string that begins at `text`, just after its opening quote.
    fn quoted(&mut self, text: &'t str) -> Option<String> {
        let mut string = String::new();
        let mut rest = text;
        loop {
            let end = memchr::memchr3(b'"', b'\\', b'\n', rest.as_bytes())?;
            string.push_str(&rest[..end]);
            let (found, after) = rest[end..].split_at(1);
            match found {
                "\"" => {
                    self.rest = after;
                    return Some(string);
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
