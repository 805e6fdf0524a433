//! Canonical form of signed texts, and its reader.
//!
//! Writer and scanner are inverse. The result of the scanner is accepted only if the writer produces the same text from
//! it; [`read()`] ensures this.

mod scanner;
mod writer;

pub(crate) use scanner::Scanner;
#[cfg(any(test, fuzzing))]
pub(crate) use writer::write_bare;
pub(crate) use writer::{write, write_some};

use super::excerpt::Location;
use super::{Field, rule};

/// First place at which a text is not in canonical form.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct NotCanonical {
    /// Location of that place.
    pub location: Location,
    /// Description of the text found there, up to the end of its line.
    pub found: String,
    /// Description of the text expected there.
    pub expected: String,
}

/// Reads a text in canonical form, ignoring comments and empty lines.
///
/// The reader never goes back in the text, and its recursion is only as deep as the type.
///
/// # Errors
/// Returns the first place that is not in canonical form.
pub(crate) fn read<T: Field>(text: &str) -> Result<T, NotCanonical> {
    let document = scanner::scan::<T>(text)?;
    if writer::is_written(&document, text) {
        return Ok(document);
    }
    let (line, found, expected) = rule::differs(text, &writer::write_bare(&document)).unwrap_or_default();
    Err(NotCanonical { location: Location { line, column: 1 }, found, expected })
}

/// Returns the text after any empty lines and comments.
fn after_comments(mut text: &[u8]) -> &[u8] {
    while let Some(start) = text.iter().position(|byte| *byte != b' ') {
        let end = match text[start] {
            b'\n' => start,
            b'#' => match memchr::memchr(b'\n', text) {
                // Comments with other characters are not skipped, because another reader may not take them for
                // comments.
                Some(end) if rule::is_printable_ascii(&text[..end]) => end,
                _ => return text,
            },
            _ => return text,
        };
        text = &text[end + 1..];
    }
    text
}
