//! The one form in which a signed text is written, and the reader of that form.
//!
//! Writer and scanner are each other's inverse. What the scanner makes of a text counts only when the writer makes the same
//! text of it again; [`read()`] sees to that.

mod scanner;
mod writer;

pub(crate) use scanner::Scanner;
#[cfg(any(test, fuzzing))]
pub(crate) use writer::write_bare;
pub(crate) use writer::{write, write_some};

use super::problem::Location;
use super::{Field, rule};

/// The first place at which a text is not in canonical form.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct NotCanonical {
    /// The place.
    pub location: Location,
    /// The text found there, to the end of its line, in the words of a message.
    pub found: String,
    /// The text expected there, in the words of a message.
    pub expected: String,
}

/// Reads a text in canonical form, comments and blank lines aside.
///
/// It never looks back and has no depth but that of the type.
///
/// # Errors
/// The first place that is not in canonical form.
pub(crate) fn read<T: Field>(text: &str) -> Result<T, NotCanonical> {
    let document = scanner::scan::<T>(text)?;
    if writer::is_written(&document, text) {
        return Ok(document);
    }
    let (line, found, expected) = rule::differs(text, &writer::write_bare(&document)).unwrap_or_default();
    Err(NotCanonical { location: Location { line, column: 1 }, found, expected })
}

/// What follows the lines that are blank or a comment.
fn after_comments(mut text: &[u8]) -> &[u8] {
    while let Some(start) = text.iter().position(|byte| *byte != b' ') {
        let end = match text[start] {
            b'\n' => start,
            b'#' => match memchr::memchr(b'\n', text) {
                // Whatever else stands in a comment, no other reader need take for one.
                Some(end) if rule::is_printable_ascii(&text[..end]) => end,
                _ => return text,
            },
            _ => return text,
        };
        text = &text[end + 1..];
    }
    text
}
