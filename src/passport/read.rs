//! Step 5 of verification: parsing the signed text, and nothing else, into the content of a passport.

use super::{Content, NAMESPACE};
use crate::document::{self, SignedText};
use crate::text::Unreadable;

/// Parses the payload of a passport: see [`document::parse`].
pub(crate) fn content(name: &str, payload: &str) -> Result<Content, Unreadable> {
    document::parse(name, payload, Content::check)
}

/// Parses the content of a passport file without verifying its signature: anyone may have written it.
///
/// # Errors
/// Returns an error if the file does not have the form of a passport, or if its content breaks a rule.
pub fn content_from_anyone(name: &str, bytes: &[u8]) -> Result<Content, Unreadable> {
    let text = SignedText::split(name, bytes, NAMESPACE).map_err(|malformed| malformed.fault)?;
    content(name, text.unverified_payload())
}
