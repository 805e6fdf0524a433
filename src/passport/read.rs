//! Step 5 of verification: the signed text, and nothing else, becomes content.

use super::NAMESPACE;
use super::content::Content;
use super::document::SignedText;
use crate::text::node::Node;
use crate::text::problem::{Location, Problem, Unreadable};
use crate::text::{Field, Problems, rule};

/// Parses a payload and requires that its content, written again, gives the same lines, comments and blank lines
/// aside.
///
/// Call it only on text whose signature holds.
///
/// # Errors
/// Every mistake of the content, or the first line that differs.
pub fn content(name: &str, payload: &str) -> Result<Content, Unreadable> {
    let (node, text) = Node::from_yaml(name, payload.as_bytes())?;
    let mut problems = Problems::new();
    let content = Content::from_node(&node, &mut problems);
    let Some(content) = content.filter(|_| problems.is_empty()) else {
        return Err(problems.refuse(name, &text));
    };
    let canonical = content.write().map(|node| rule::write(&node, &rule::no_comments)).unwrap_or_default();
    match rule::differs(payload, &canonical) {
        None => Ok(content),
        Some((line, found, expected)) => {
            let advice = "the text is not as this format is written";
            let location = Some(Location { line, column: 1 });
            let problem = Problem { location, field: String::new(), found, expected, advice: advice.to_owned() };
            Err(Unreadable::of(name, vec![problem]))
        }
    }
}

/// The content of a passport file of which nothing is verified but its form: anybody may have written it.
///
/// # Errors
/// The file has not the form of a passport, or its content breaks a rule.
pub fn unverified(name: &str, bytes: &[u8]) -> Result<Content, Unreadable> {
    let text = SignedText::split(name, bytes, NAMESPACE).map_err(|malformed| malformed.fault)?;
    content(name, text.unverified_payload())
}
