//! The one form in which a signed text is written, and a quick reader of that form alone.
//!
//! [`write()`] and [`scan()`] are each other's inverse. What `scan` makes of a text counts only when `write` makes the
//! same text of it again ([`is_written()`]); [`read()`] sees to that. [`crate::document::parse`] gives every other text to
//! the general reader.

mod memory;
mod scanner;
mod writer;

pub use memory::Memory;
pub use scanner::Scanner;
pub use writer::{Comments, is_written, write, write_bare, write_some};

use super::{Field, rule};
use memory::Entry;
use scanner::Scanned;

/// Reads a text in canonical form, comments and blank lines aside; `None` for any other. Of what `memory` is to remember
/// it takes what it has read before, and keeps what is new.
pub fn read<T: Field>(text: &str, memory: &mut Memory) -> Option<T> {
    let Scanned { document, known, new, .. } = scanner::scan::<T>(text, memory)?;
    let canonical = writer::is_written_but_for(&document, text, known);
    canonical.then(|| {
        memory.keep(new);
        document
    })
}

/// The same of a text whose beginning tells what all of it may be: `None` also when it is something else.
///
/// Numbers that can be computed are not read so, but written and compared.
pub fn read_predicted<B: Field, T: Field>(
    text: &str,
    memory: &mut Memory,
    predict: impl FnOnce(B) -> Option<T>,
) -> Option<T> {
    let Scanned { document: beginning, known, new, .. } = scanner::scan_beginning(text, memory)?;
    let document = predict(beginning)?;
    let canonical = writer::is_written_but_for(&document, text, known);
    canonical.then(|| {
        memory.keep(new);
        document
    })
}

/// What the quick reader makes of a text, comments and blank lines aside; `None` when it is not in canonical form, and for
/// some that are hardly different it gives something: a number written in another way may be taken, so ask
/// [`is_written()`].
///
/// It never looks back and has no depth but that of the type.
pub fn scan<T: Field>(text: &str, memory: &Memory) -> Option<T> {
    Some(scanner::scan(text, memory)?.document)
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
