//! Placeholders of the templates: values that only the user knows, and that no document of theirs may contain.

#[cfg(feature = "yaml")]
use super::{Node, Path, Problems};

/// Word that a template contains instead of a value.
const PLACEHOLDER: &str = "CHANGE";

/// Advice on a value that is still a placeholder.
pub(super) const ADVICE: &str = "replace the word from the template";

/// Returns `true` if `text` is a placeholder: the word alone, or the word, a colon and what is to be written.
pub(super) fn is_placeholder(text: &str) -> bool {
    let rest = text.trim().strip_prefix(PLACEHOLDER);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(':'))
}

/// Reports every placeholder in a hand-written document. A value with an error already, such as no number, gets the advice.
#[cfg(feature = "yaml")]
pub(crate) fn check(node: &Node, problems: &mut Problems) {
    node.each_text(&Path::Root, &mut |at, text| {
        if is_placeholder(text) && !problems.advise(at, ADVICE) {
            problems.at(at, format!("{text:?}"), "your value", ADVICE);
        }
    });
}
