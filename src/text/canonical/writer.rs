//! Writer of the canonical form, whose output is either a text or compared with one.

use super::after_comments;
use crate::text::field::Sink;
use crate::text::{Field, number, rule};

/// Source of the comment lines above a key, given as a path such as `earth.gravity_m_per_s2`; without the `# `.
pub(super) type Comments<'a> = &'a dyn Fn(&str) -> Vec<String>;

/// Writes a mapping: nested mappings as blocks, each item of a list of mappings on its own line, a matrix on one line.
pub(crate) fn write(document: &impl Field, comments: Comments) -> String {
    let mut text = String::with_capacity(USUAL_BYTES);
    write_some(&mut text, document, comments, &|_| true);
    text
}

/// Writes a mapping without comments, the form in which texts are compared.
pub(crate) fn write_bare(document: &impl Field) -> String {
    Writer::new(String::with_capacity(USUAL_BYTES)).written(document)
}

/// Appends the `wanted` top-level keys of a mapping, with all keys nested in them, to a text.
pub(crate) fn write_some(text: &mut String, document: &impl Field, comments: Comments, wanted: &dyn Fn(&str) -> bool) {
    let writer = Writer { wanted, comments: Some(comments), ..Writer::new(std::mem::take(text)) };
    *text = writer.written(document);
}

/// Returns `true` if `text`, without its comments and empty lines, is what [`write()`] makes of the document.
pub(super) fn is_written(document: &impl Field, text: &str) -> bool {
    let compared = Writer::new(Compared(Some(text.as_bytes()))).written(document);
    compared.0.is_some_and(|rest| after_comments(rest).is_empty())
}

/// Initial capacity of a text, in bytes; a passport has about 9,000.
const USUAL_BYTES: usize = 12_000;

/// Destination of the parts of a text, one after the other.
trait Output {
    fn push(&mut self, part: &str);

    /// Announces that the next part begins a line.
    fn begin_line(&mut self) {}
}

impl Output for String {
    fn push(&mut self, part: &str) {
        self.push_str(part);
    }
}

/// Remaining text to compare the parts with; `None` after the first difference.
struct Compared<'t>(Option<&'t [u8]>);

impl Output for Compared<'_> {
    #[inline]
    fn push(&mut self, part: &str) {
        self.0 = self.0.and_then(|rest| rest.strip_prefix(part.as_bytes()));
    }

    fn begin_line(&mut self) {
        self.0 = self.0.map(after_comments);
    }
}

struct Writer<'a, O> {
    text: O,
    /// Keys from the top to the current one, joined by points.
    path: String,
    /// Length of the part of `path` that leads to the current mapping, bytes.
    outer: usize,
    /// Number of blocks around the current key.
    depth: usize,
    /// Number of brackets around the current value; 0 if it follows its key, which began a line.
    inline: usize,
    /// Whether no key has been written yet in the current brackets.
    first: bool,
    /// Source of the comments; if `None`, the path is not needed.
    comments: Option<Comments<'a>>,
    /// Filter of the top-level keys to write.
    wanted: &'a dyn Fn(&str) -> bool,
}

impl<'a, O: Output> Writer<'a, O> {
    fn new(text: O) -> Self {
        let path = String::new();
        Self { text, path, outer: 0, depth: 0, inline: 0, first: true, comments: None, wanted: &|_| true }
    }

    fn written(mut self, document: &impl Field) -> O {
        document.emit(&mut self);
        self.text
    }

    fn indent(&mut self) {
        (1..self.depth).for_each(|_| self.text.push("  "));
    }

    /// Writes a value on the line of its key.
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
    fn boolean(&mut self, value: bool) {
        self.on_the_line(|writer| writer.text.push(if value { "true" } else { "false" }));
    }

    fn integer(&mut self, value: i64) {
        self.on_the_line(|writer| writer.text.push(&value.to_string()));
    }

    fn number(&mut self, value: f64) {
        if !value.is_finite() {
            // No text may contain it: the readers refuse it, and so does the reader that checks what was written.
            debug_assert!(false, "only finite numbers are written");
            return self.text.push(" null");
        }
        self.on_the_line(|writer| number::write(value, |part| writer.text.push(part)));
    }

    fn text(&mut self, value: &str) {
        self.on_the_line(|writer| rule::write_quoted(value, |part| writer.text.push(part)));
    }

    fn list<T: Field>(&mut self, items: &[T]) {
        if self.inline == 0 && items.first().is_some_and(Field::is_mapping) {
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
            for (index, item) in items.iter().enumerate() {
                if index > 0 {
                    writer.text.push(", ");
                }
                writer.bracketed(|writer| item.emit(writer));
            }
            writer.text.push("]");
        });
    }

    fn one_line(&mut self, value: impl FnOnce(&mut Self)) {
        self.on_the_line(value);
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
        self.text.begin_line();
        if let Some(comments) = self.comments {
            self.path.truncate(self.outer);
            self.path.push_str(if self.outer > 0 { "." } else { "" });
            self.path.push_str(key);
            for line in comments(&self.path) {
                self.indent();
                ["# ", &line, "\n"].into_iter().for_each(|part| self.text.push(part));
            }
        }
        self.indent();
        self.text.push(key);
        self.text.push(":");
        true
    }
}
