//! The result of a calibration as JSON that is read on paper.

use crate::calibration::document::CalibrationDocument;
use serde::Serialize;
use serde_json::Serializer;
use serde_json::ser::Formatter;
use std::io::{self, Write};

/// Returns the result as JSON, a key on each line.
pub(super) fn lines(document: &CalibrationDocument) -> String {
    // Every number of a result is finite, and its keys are strings. So this JSON can always be written.
    let mut json = Vec::new();
    let mut writer = Serializer::with_formatter(&mut json, Lines { open: Vec::new(), in_list: false });
    match document.serialize(&mut writer) {
        // A space before an object that begins a line; a string contains no line feed.
        Ok(()) => String::from_utf8(json).unwrap_or_default().replace(", \n", ",\n") + "\n",
        Err(_) => String::new(),
    }
}

/// A JSON formatter that writes each key of the document and of each result on its own line, and so each object of a list.
/// Other objects, matrices and lists of numbers stay on one line.
struct Lines {
    /// Objects that are open, the innermost last: `true` if each of its keys begins a line.
    open: Vec<bool>,
    /// `true` if the value that begins is one of a list.
    in_list: bool,
}

impl Lines {
    fn new_line(&self, writer: &mut (impl Write + ?Sized)) -> io::Result<()> {
        write!(writer, "\n{}", "  ".repeat(self.open.len()))
    }
}

impl Formatter for Lines {
    fn begin_object<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        let depth = self.open.len();
        self.open.push(depth == 0 || depth == 1 && self.in_list);
        if self.in_list && depth > 1 {
            self.new_line(writer)?;
        }
        self.in_list = false;
        writer.write_all(b"{")
    }

    fn end_object<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        if self.open.pop() == Some(true) {
            self.new_line(writer)?;
        }
        writer.write_all(b"}")
    }

    fn begin_object_key<W: Write + ?Sized>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        if !first {
            writer.write_all(b",")?;
        }
        match self.open.last() {
            Some(true) => self.new_line(writer),
            _ if first => Ok(()),
            _ => writer.write_all(b" "),
        }
    }

    fn begin_object_value<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        self.in_list = false;
        writer.write_all(b": ")
    }

    fn begin_array_value<W: Write + ?Sized>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        self.in_list = true;
        writer.write_all(if first { b"" } else { b", " })
    }
}
