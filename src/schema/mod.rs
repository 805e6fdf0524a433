//! JSON Schemas of the file formats and of results, and the lists of their keys.
//!
//! The program contains the schemas of the formats as `generate` made them. So users need not compile what makes them.
//! Those of results are written by hand; the transcripts in tests/cmd hold them against what the program prints.

#[cfg(feature = "generate")]
pub(crate) mod generate;
mod reference;

pub(crate) use reference::lists;

use serde_json::{Map, Value};

/// Names of the formats, then the verbs of the results.
#[rustfmt::skip]
pub(crate) const FORMATS: [&str; 13] = [
    "stand", "site", "gyro", "laboratory", "dcc", "passport", "register-file",
    "verify", "register", "calibrate", "certify", "plan", "history",
];

/// Returns the JSON Schema of each format and of each result, by its name.
///
/// # Errors
///
/// Returns an error if the schemas are not JSON, which a test excludes.
pub(crate) fn schemas() -> serde_json::Result<Map<String, Value>> {
    let results = serde_json::from_str::<Map<String, Value>>(include_str!("results.json"))?;
    let mut schemas: Map<String, Value> = serde_json::from_str(include_str!("schemas.json"))?;
    schemas.extend(results);
    Ok(schemas)
}
