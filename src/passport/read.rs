//! Step 5 of verification: the signed text, and nothing else, becomes the content of a passport.

use super::NAMESPACE;
use super::content::Content;
use crate::document::{self, SignedText};
use crate::text::Unreadable;

/// Parses the payload of a passport: see [`document::parse`].
///
/// # Errors
/// Every mistake of the content, or the first line that is not in its one form.
pub fn content(name: &str, payload: &str) -> Result<Content, Unreadable> {
    document::parse(name, payload, Content::check)
}

/// The content of a passport file of which nothing is verified but its form: anybody may have written it.
///
/// # Errors
/// The file has not the form of a passport, or its content breaks a rule.
pub fn unverified(name: &str, bytes: &[u8]) -> Result<Content, Unreadable> {
    let text = SignedText::split(name, bytes, NAMESPACE).map_err(|malformed| malformed.fault)?;
    content(name, text.unverified_payload())
}
