//! The reader of the canonical form, which knows no other.

use super::{NotCanonical, after_comments};
use crate::text::node::{MOST_BRACKETS, Node, location_of};
use crate::text::{Field, LARGEST_DOCUMENT_BYTES, rule};

/// Reads a text; a number written in another way may be taken, so ask [`super::is_written()`].
///
/// # Errors
/// The place at which the reader stopped.
pub(super) fn scan<T: Field>(text: &str) -> Result<T, NotCanonical> {
    // So many brackets need as many bytes.
    let brackets = |text: &str| text.bytes().filter(|byte| b"[{".contains(byte)).count();
    let too_large =
        text.len() > LARGEST_DOCUMENT_BYTES || (text.len() > MOST_BRACKETS && brackets(text) > MOST_BRACKETS);
    let mut scanner = Scanner { rest: text, depth: 0, inline: false, first: true };
    let document = if too_large { None } else { T::scan(&mut scanner) };
    let rest = scanner.after_comments();
    document.filter(|_| rest.is_empty()).ok_or_else(|| NotCanonical {
        location: location_of(&text.as_bytes()[..text.len() - rest.len()]),
        found: rest.lines().next().map_or_else(|| "the end of the file".to_owned(), rule::shortened),
        expected: "the next key of this format".to_owned(),
    })
}

/// A place in a text in canonical form.
#[derive(Debug)]
pub(crate) struct Scanner<'t> {
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

    fn after_comments(&self) -> &'t str {
        // They are ASCII.
        &self.rest[self.rest.len() - after_comments(self.rest.as_bytes()).len()..]
    }

    /// The keys of a mapping, which [`Scanner::entry`] reads one after the other.
    pub(crate) fn mapping<T>(&mut self, entries: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
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
    pub(crate) fn entry<T: Field>(&mut self, key: &'static str) -> Option<T> {
        if self.at_key(key).is_none() {
            return T::absent();
        }
        T::scan(self)
    }

    /// Passes over `key` when that is the next one.
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

    /// The text without the indent of the current block and `more` blanks.
    fn indented(&self, text: &'t str, more: usize) -> Option<&'t str> {
        let indent = 2 * (self.depth - 1) + more;
        let (blanks, rest) = text.split_at_checked(indent)?;
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
    pub(crate) fn list<T: Field>(&mut self) -> Option<Vec<T>> {
        let mut items = Vec::new();
        if !self.inline && self.rest.starts_with('\n') {
            self.take("\n")?;
            loop {
                // What stands above the next key is no part of the list.
                let line = self.indented(self.after_comments(), 2);
                let Some(item) = line.and_then(|line| line.strip_prefix("- ")) else { return Some(items) };
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

    /// The items of a list of so many, which are no mappings.
    pub(crate) fn array<T: Field, const N: usize>(&mut self) -> Option<[T; N]> {
        self.on_the_line(|scanner| {
            scanner.take("[")?;
            let mut item = T::scan(scanner)?;
            let mut complete = true;
            let items = std::array::from_fn(|index| {
                if index > 0 {
                    match scanner.take(", ").and_then(|()| T::scan(scanner)) {
                        Some(next) => item = next,
                        None => complete = false,
                    }
                }
                item.clone()
            });
            scanner.take("]")?;
            complete.then_some(items)
        })
    }

    /// A value that is neither list nor mapping.
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

    /// A string.
    pub(crate) fn string(&mut self) -> Option<String> {
        self.on_the_line(|scanner| scanner.quoted(scanner.rest.strip_prefix('"')?))
    }

    /// A number with a point.
    pub(crate) fn number(&mut self) -> Option<f64> {
        self.on_the_line(|scanner| scanner.word()?.parse().ok())
    }

    fn word(&mut self) -> Option<&'t str> {
        let end = self.rest.bytes().position(|byte| matches!(byte, b',' | b']' | b'}' | b'\n'))?;
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        Some(word)
    }

    /// The string that begins `text`, its opening quote aside.
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
