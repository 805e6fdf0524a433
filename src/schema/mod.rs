//! JSON Schemas of the file formats, and the lists of their keys.
//!
//! The program contains the schemas as `generate` made them. So users need not compile what makes them.

#[cfg(feature = "generate")]
pub(crate) mod generate;
mod reference;

pub(crate) use reference::lists;

use serde_json::{Map, Value};

/// Names of the formats.
pub(crate) const FORMATS: [&str; 7] = ["stand", "site", "gyro", "laboratory", "dcc", "passport", "register-file"];

/// Returns the JSON Schema of each format, by its name.
///
/// # Errors
///
/// Returns an error if the schemas are not JSON, which a test excludes.
pub(crate) fn schemas() -> serde_json::Result<Map<String, Value>> {
    serde_json::from_str(include_str!("schemas.json"))
}
