//! The text of every document: strict YAML in, one canonical form out, errors that point into the file.
//!
//! * [`rule`]: what a signed text may contain, and how a string is written: writer and reader of the rule side by side.
//! * [`number`]: how a number is written.
//! * [`canonical`]: the one form that content is written in, and its reader.
//! * [`sink`]: what a document is written into.
//! * [`node`]: a document as a tree.
//! * [`mod@record`]: from that tree to a Rust struct and back, every mistake reported, not only the first.
//! * [`scalar`]: identifiers, dates and times.
//! * [`table`]: tables of numbers (CSV).
//! * `yaml`: hand-written YAML to a tree, with the place of every value found again when an error needs it.
//! * [`problem`]: what is wrong, where, what was expected, what to do.

pub mod canonical;
pub mod node;
pub mod number;
pub mod problem;
pub mod record;
pub mod rule;
pub mod scalar;
pub mod sink;
pub mod table;
#[cfg(feature = "factory")]
pub mod yaml;

pub use node::Node;
pub use problem::{Path, Problems, Unreadable};
pub use record::Field;
pub(crate) use record::record;

/// The largest document that is read at all, in bytes.
///
/// A stand with a thousand positions takes a fifth of it; what is larger is not a document of this project.
pub const LARGEST_DOCUMENT_BYTES: usize = 1 << 20;

/// A file's name, or words that hold one, as they can be shown on one line: control characters and characters that cannot
/// be seen are escaped, for in a terminal they could hide or forge what stands around them.
pub fn printable(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\'' | '"' | '\\' => shown.push(c),
            _ => shown.extend(c.escape_debug()),
        }
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::printable;

    #[test]
    fn what_a_terminal_would_obey_is_escaped() {
        assert_eq!(printable("паспорт é 'a' \"b\" \\"), "паспорт é 'a' \"b\" \\");
        assert_eq!(
            printable("a\nb\r\u{1b}[31m\u{202e}\u{200b}\u{2028}"),
            "a\\nb\\r\\u{1b}[31m\\u{202e}\\u{200b}\\u{2028}"
        );
    }
}
