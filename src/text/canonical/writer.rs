//! Writer of the canonical form.

use crate::text::field::{Scalar, Sink};
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
    let mut text = String::with_capacity(USUAL_BYTES);
    document.emit(&mut Writer::new(&mut text));
    text
}

/// Appends the `wanted` top-level keys of a mapping, with all keys nested in them, to a text.
pub(crate) fn write_some(text: &mut String, document: &impl Field, comments: Comments, wanted: &dyn Fn(&str) -> bool) {
    document.emit(&mut Writer { wanted, comments: Some(comments), ..Writer::new(text) });
}

/// Initial capacity of a text, in bytes; a passport has about 9,000.
const USUAL_BYTES: usize = 12_000;

struct Writer<'a> {
    text: &'a mut String,
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

impl<'a> Writer<'a> {
    fn new(text: &'a mut String) -> Self {
        let path = String::new();
        Self { text, path, outer: 0, depth: 0, inline: 0, first: true, comments: None, wanted: &|_| true }
    }

    fn indent(&mut self) {
        (1..self.depth).for_each(|_| self.text.push_str("  "));
    }

    /// Writes a value on the line of its key.
    fn on_the_line(&mut self, write: impl FnOnce(&mut Self)) {
        if self.inline > 0 {
            return write(self);
        }
        self.text.push(' ');
        self.bracketed(write);
        self.text.push('\n');
    }

    fn bracketed(&mut self, write: impl FnOnce(&mut Self)) {
        self.inline += 1;
        write(self);
        self.inline -= 1;
    }
}

impl Sink for Writer<'_> {
    fn scalar(&mut self, value: Scalar) {
        self.on_the_line(|Self { text, .. }| match value {
            Scalar::Bool(value) => text.push_str(if value { "true" } else { "false" }),
            Scalar::Integer(value) => text.push_str(&value.to_string()),
            Scalar::Number(value) if value.is_finite() => number::write(value, text),
            Scalar::Number(_) => {
                // No text may contain it: the readers refuse it, and so does the reader that checks what was written.
                debug_assert!(false, "only finite numbers are written");
                text.push_str("null");
            }
            Scalar::Text(value) => rule::write_quoted(value, text),
        });
    }

    fn list<T: Field>(&mut self, items: &[T]) {
        if self.inline == 0 && items.first().is_some_and(Field::is_mapping) {
            self.text.push('\n');
            for item in items {
                self.indent();
                self.text.push_str("  - ");
                self.bracketed(|writer| item.emit(writer));
                self.text.push('\n');
            }
            return;
        }
        self.on_the_line(|writer| {
            writer.text.push('[');
            for (index, item) in items.iter().enumerate() {
                if index > 0 {
                    writer.text.push_str(", ");
                }
                writer.bracketed(|writer| item.emit(writer));
            }
            writer.text.push(']');
        });
    }

    fn one_line(&mut self, value: impl FnOnce(&mut Self)) {
        self.on_the_line(value);
    }

    fn mapping(&mut self, empty: bool, entries: impl FnOnce(&mut Self)) {
        if self.inline > 0 || (empty && self.depth > 0) {
            return self.on_the_line(|writer| {
                writer.text.push('{');
                let outer = std::mem::replace(&mut writer.first, true);
                writer.bracketed(entries);
                writer.first = outer;
                writer.text.push('}');
            });
        }
        if self.depth > 0 {
            self.text.push('\n');
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
                self.text.push_str(", ");
            }
            self.text.push_str(key);
            self.text.push_str(": ");
            return true;
        }
        if self.depth == 1 && !(self.wanted)(key) {
            return false;
        }
        if let Some(comments) = self.comments {
            self.path.truncate(self.outer);
            self.path.push_str(if self.outer > 0 { "." } else { "" });
            self.path.push_str(key);
            for line in comments(&self.path) {
                self.indent();
                self.text.extend(["# ", &line, "\n"]);
            }
        }
        self.indent();
        self.text.push_str(key);
        self.text.push(':');
        true
    }
}
