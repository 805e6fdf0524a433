//! Placeholders of the templates: values that only the user knows, and that must not be signed.

use super::{Path, Problems, Unreadable, yaml};

/// Word that a template contains instead of a value.
const PLACEHOLDER: &str = "CHANGE";

/// Returns `true` if `text` is a placeholder: the word alone, or the word, a colon and what is to be written.
fn is_placeholder(text: &str) -> bool {
    let rest = text.trim().strip_prefix(PLACEHOLDER);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(':'))
}

/// Reads a hand-written document with `read`, and refuses its placeholders; `name` is its name in messages.
///
/// # Errors
/// Returns the error of `read`, or [`Unreadable`] with every placeholder at its line, column and field.
pub(crate) fn filled_in<T>(
    name: &str,
    bytes: &[u8],
    read: impl FnOnce(&str, &[u8]) -> Result<T, Unreadable>,
) -> Result<T, Unreadable> {
    let document = read(name, bytes)?;
    // Most documents contain none, and are not read a second time.
    if memchr::memmem::find(bytes, PLACEHOLDER.as_bytes()).is_none() {
        return Ok(document);
    }
    let (node, text) = yaml::tree(name, bytes)?;
    let mut problems = Problems::default();
    node.each_text(&Path::Root, &mut |at, text| {
        if is_placeholder(text) {
            problems.at(at, format!("{text:?}"), "your value", "replace the word from the template");
        }
    });
    if problems.is_empty() { Ok(document) } else { Err(problems.refuse(name, &text).in_text(bytes)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: by hand. A comment and another word that begins like the placeholder are none.
    #[test]
    fn every_placeholder_is_found_at_its_place() {
        let text = "a: \"CHANGE\"  # CHANGE\nb: {c: [\"good\", \"CHANGE: where from\"]}\nd: \"CHANGED\"\n";
        let refused = filled_in("f.yaml", text.as_bytes(), |_, _| Ok(())).unwrap_err().to_string();
        assert!(refused.contains("f.yaml:1:4: a: found \"CHANGE\", expected your value"), "{refused}");
        assert!(refused.contains("b.c[1]: found \"CHANGE: where from\""), "{refused}");
        assert_eq!(refused.matches("f.yaml:").count(), 2, "{refused}");
        assert!(filled_in("f.yaml", b"a: 1  # CHANGE\nd: \"CHANGED\"\n", |_, _| Ok(())).is_ok());
    }
}
