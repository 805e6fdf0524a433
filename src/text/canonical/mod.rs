//! Canonical form of signed texts, and its reader.
//!
//! Writer and scanner are inverse. The result of the scanner is accepted only if the writer produces the same text from
//! it; [`read()`] ensures this.

pub(crate) mod scanner;
mod writer;

pub(crate) use scanner::Scanner;
pub(crate) use writer::{write, write_bare, write_some};

use super::{Field, Limits, Location, Problem, rule};

/// Reads a text in canonical form, ignoring comments and empty lines.
///
/// The reader never goes back in the text, and its recursion is only as deep as the type.
///
/// # Errors
/// Returns the first place that is not in canonical form, and what was found there, up to the end of its line.
pub(crate) fn read<T: Field>(text: &str, limits: Limits) -> Result<T, Problem> {
    let document = scanner::scan(text, limits, T::scan)?;
    match rule::differs(text, &write_bare(&document)) {
        None => Ok(document),
        Some((line, found, expected)) => {
            let at = Location { line, column: 1 };
            Err(Problem::new(Some(at), "", found, expected, rule::NOT_CANONICAL))
        }
    }
}

/// Returns the text after any empty lines and comments.
fn after_comments(mut text: &[u8]) -> &[u8] {
    while let Some(start) = text.iter().position(|byte| *byte != b' ') {
        let end = match text[start] {
            b'\n' => start,
            b'#' => match memchr::memchr(b'\n', text) {
                // Comments with other characters are not skipped, because another reader may not take them for
                // comments.
                Some(end) if super::characters::is_printable_ascii(&text[..end]) => end,
                _ => return text,
            },
            _ => return text,
        };
        text = &text[end + 1..];
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::record;

    record! {
        /// Lists, and a mapping that may be absent.
        pub struct Document {
            /// Lists of whole numbers.
            pub lists: Option<Vec<Vec<u32>>>,
            /// Mapping.
            pub inner: Option<Inner>,
        }
    }

    record! {
        /// Mapping with one key.
        pub struct Inner {
            /// Whole number.
            pub value: u32,
        }
    }

    #[test]
    fn empty_lines_and_comments_in_ascii_are_skipped() {
        for (text, rest) in [
            ("\n \n# c\n  # d\n\na: 1\n", "a: 1\n"),
            ("# c\n  a: 1\n", "  a: 1\n"),
            ("# \u{416}\na: 1\n", "# \u{416}\na: 1\n"),
            ("# c", "# c"),
            ("  ", "  "),
        ] {
            assert_eq!(after_comments(text.as_bytes()), rest.as_bytes(), "{text:?}");
        }
    }

    #[test]
    fn a_comment_is_asked_for_by_the_path_of_its_key() {
        let document = Document { lists: Some(vec![vec![1, 23], vec![]]), inner: Some(Inner { value: 4 }) };
        let bare = "lists: [[1, 23], []]\ninner:\n  value: 4\n";
        let text = "# lists\nlists: [[1, 23], []]\n# inner\ninner:\n  # inner.value\n  value: 4\n";
        assert_eq!(write(&document, &|path| vec![path.to_owned()]), text);
        assert_eq!(write_bare(&document), bare);
        let read = |text| read(text, Limits::DOCUMENT);
        assert_eq!((read(text), read(bare)), (Ok(document.clone()), Ok(document)));
        let empty = Document { lists: None, inner: None };
        assert_eq!((write_bare(&empty), read("")), (String::new(), Ok(empty)));
    }

    #[test]
    fn a_text_may_have_as_many_bytes_and_brackets_as_stated() {
        let lists = |text: &str| {
            read::<Document>(text, Limits::DOCUMENT).ok().and_then(|read| read.lists).map(|lists| lists.len())
        };
        let brackets = |inner: usize| format!("lists: [{}]\n", vec!["[]"; inner].join(", "));
        assert_eq!((lists(&brackets(24_999)), lists(&brackets(25_000))), (Some(24_999), None));
        let bytes = |bytes: usize| format!("lists: [[1], [2]]\n#{}\n", "x".repeat(bytes - 20));
        assert_eq!((lists(&bytes(1_048_576)), lists(&bytes(1_048_577))), (Some(2), None));
    }
}
