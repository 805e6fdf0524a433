//! What many documents have in common, letter for letter, is read once.

use super::after_comments;
use crate::text::Field;
use std::any::Any;
use std::collections::HashMap;
use std::sync::Arc;

/// So many bytes of text are kept; with the next document it begins anew.
const MOST_BYTES: usize = 1 << 20;

/// Values of keys at the top of documents, each with its text; of several values of a key that begin with the same line
/// the newest.
///
/// What an entry says depends on its own text alone, and only what was canonical is kept. So a document read with a memory
/// says what it says without.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Memory {
    keys: &'static [&'static str],
    /// By key and first line.
    entries: HashMap<&'static str, HashMap<String, Entry>>,
    bytes: usize,
}

/// A value with the text behind its key.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    key: &'static str,
    text: String,
    value: Arc<dyn Any + Send + Sync>,
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        // Equal texts have equal values.
        self.key == other.key && self.text == other.text
    }
}

impl Memory {
    /// For documents that often have the values of these keys in common.
    pub fn of(keys: &'static [&'static str]) -> Self {
        Self { keys, ..Self::default() }
    }

    /// Nothing is remembered.
    pub fn none() -> Self {
        Self::default()
    }

    pub(super) fn is_for(&self, key: &str) -> bool {
        self.keys.contains(&key)
    }

    /// The value of a key when the `text` behind it begins as the one that is remembered, and the value ends there; with what
    /// follows it.
    pub(super) fn recall<'t, T: Field>(&self, key: &str, text: &'t str) -> Option<(&Entry, T, &'t str)> {
        let entry = self.entries.get(key)?.get(first_line(text)?)?;
        let rest = text.strip_prefix(&*entry.text)?;
        // Another item of a list, or another key of a mapping, would be indented.
        let next = after_comments(rest.as_bytes()).first();
        let ends = next.is_none_or(u8::is_ascii_lowercase);
        let value = entry.value.downcast_ref::<T>().filter(|_| ends)?;
        Some((entry, value.clone(), rest))
    }

    /// Keeps entries that are canonical.
    pub(super) fn keep(&mut self, new: Vec<Entry>) {
        if self.bytes > MOST_BYTES {
            self.entries.clear();
            self.bytes = 0;
        }
        for entry in new {
            let Some(line) = first_line(&entry.text) else { continue };
            self.bytes += entry.text.len();
            self.entries.entry(entry.key).or_default().insert(line.to_owned(), entry);
        }
    }
}

/// The line of a key, or of a mapping or list the first of its own.
fn first_line(text: &str) -> Option<&str> {
    let end = memchr::memchr(b'\n', text.as_bytes().get(1..)?)?;
    text.get(..=end)
}

impl Entry {
    pub(super) fn new<T: Field>(key: &'static str, text: &str, value: &T) -> Self {
        Self { key, text: text.to_owned(), value: Arc::new(value.clone()) }
    }

    pub(super) fn key(&self) -> &'static str {
        self.key
    }

    /// From the colon of its key to its own end, the line feed included.
    pub(super) fn text(&self) -> &str {
        &self.text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::canonical::{read, write_bare};
    use crate::text::record;

    record! {
        /// An item of a list.
        pub struct Item {
            /// A number.
            pub x: f64,
        }
    }

    record! {
        /// A document.
        pub struct Document {
            /// What many have in common.
            pub common: Vec<Item>,
            /// What they have not.
            pub own: Option<u32>,
        }
    }

    fn document(own: Option<u32>) -> String {
        write_bare(&Document { common: vec![Item { x: 0.5 }, Item { x: -1.0 }], own })
    }

    /// What a memory of one document makes of another, and how many values it took from there.
    fn remembered(text: &str) -> (Option<Document>, usize) {
        let mut memory = Memory::of(&["common"]);
        read::<Document>(&document(Some(1)), &mut memory).unwrap();
        let known = super::super::scanner::scan::<Document>(text, &memory).map_or(0, |scanned| scanned.known.len());
        (read(text, &mut memory), known)
    }

    #[test]
    fn what_is_known_is_taken_and_what_differs_is_read() {
        let text = document(Some(2));
        assert_eq!(remembered(&text), (read(&text, &mut Memory::none()), 1));
        assert_eq!(remembered(&text).0.unwrap().own, Some(2));
        let commented = text.replace("own", "# a comment\n\n# another\nown");
        assert_eq!(remembered(&commented), (read(&text, &mut Memory::none()), 1));
        let other = text.replace("-1.0", "-1.5");
        assert_eq!(remembered(&other), (read(&other, &mut Memory::none()), 0));
        // Without what followed it.
        assert_eq!(remembered(&document(None)).1, 1);
    }

    #[test]
    fn what_goes_on_after_what_is_known_is_read() {
        let longer = document(Some(2)).replace("own", "  - {x: 2.0}\nown");
        assert_eq!(remembered(&longer), (read(&longer, &mut Memory::none()), 0));
        assert_eq!(remembered(&longer).0.unwrap().common.len(), 3);
        let commented = document(Some(2)).replace("own", "# a comment\n  - {x: 2.0}\nown");
        assert_eq!(remembered(&commented).0.unwrap().common.len(), 3);
        for bad in ["  own", "  - {x: 2.00}\nown", "  -\nown", "own: 3\nown", "common: []\nown"] {
            let text = document(Some(2)).replace("own", bad);
            assert_eq!(remembered(&text).0, None, "{text}");
        }
    }

    #[test]
    fn what_is_not_canonical_is_not_kept() {
        let mut memory = Memory::of(&["common"]);
        let bad = document(Some(1)).replace("0.5", "0.50");
        assert_eq!(read::<Document>(&bad, &mut memory), None);
        assert_eq!(memory, Memory::of(&["common"]));
        // Nor what stands in a text that is refused for something else.
        assert_eq!(read::<Document>(&document(Some(1)).replace("own: 1", "own: 01"), &mut memory), None);
        assert_eq!(memory, Memory::of(&["common"]));
    }
}
