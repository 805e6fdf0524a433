//! Readings that are given twice under two names: those of one gyro or stand are not those of another.

use crate::text::Printable;

/// Contents of the inputs read so far, each with the name of its file.
pub(crate) struct Once<T>(Vec<(T, String)>);

impl<T: PartialEq> Once<T> {
    pub(crate) fn new() -> Self {
        Self(Vec::new())
    }

    /// Keeps the content of `file`, or returns the earlier file with the same content.
    pub(crate) fn earlier(&mut self, content: T, file: &str) -> Option<&str> {
        let there = self.0.iter().position(|(known, _)| *known == content);
        if there.is_none() {
            self.0.push((content, file.to_owned()));
        }
        Some(&self.0[there?].1)
    }

    /// Keeps the content of `file`; `what` and `of` are words such as "currents" and "gyro".
    ///
    /// # Errors
    /// Returns a sentence if an earlier file has the same content.
    pub(crate) fn check(&mut self, content: T, file: &str, [what, of]: [&str; 2]) -> Result<(), String> {
        let Some(other) = self.earlier(content, file) else { return Ok(()) };
        let (file, other) = (Printable(file), Printable(other));
        Err(format!("{file}: found the {what} of {other}, expected those of another {of}"))
    }
}
