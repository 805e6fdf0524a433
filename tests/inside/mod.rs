//! Tests of private items. They are part of the library's own test build, so they see items that users do not.
//!
//! Each test states the features that it needs; `tests/features` runs the tests that each single feature enables.

// Common parts of several tests.
#[cfg(feature = "factory")]
#[path = "../shared/fixtures.rs"]
mod fixtures;
#[cfg(feature = "report")]
#[path = "../shared/language.rs"]
mod language;
#[cfg(feature = "report")]
#[path = "../shared/picture/mod.rs"]
mod picture;
#[path = "../shared/programs.rs"]
mod programs;
mod reference;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod simulated_stands;

/// Returns any content in canonical form with a correct signature.
#[cfg(feature = "factory")]
fn written(content: &crate::passport::Content, key: &crate::trust::SigningKey) -> String {
    fixtures::signed(&crate::passport::annotations::payload(content), key)
}

#[cfg(feature = "factory")]
mod allowed_signers;
#[cfg(feature = "monte-carlo")]
mod calibration;
mod causes;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod certification;
#[cfg(feature = "monte-carlo")]
mod chi_square;
#[cfg(feature = "factory")]
mod forgeries;
mod frame_axis;
#[cfg(feature = "monte-carlo")]
mod geometry;
#[cfg(all(feature = "factory", feature = "monte-carlo", feature = "report"))]
mod hidden_drift;
mod interface;
#[cfg(feature = "factory")]
mod issue;
mod model;
#[cfg(all(feature = "factory", feature = "report"))]
mod passport_accuracy;
#[cfg(feature = "factory")]
mod passport_readers;
#[cfg(all(feature = "factory", feature = "report"))]
mod pictures;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod plan;
mod readings;
#[cfg(feature = "monte-carlo")]
mod recorded;
#[cfg(feature = "factory")]
mod register_attacks;
#[cfg(feature = "factory")]
mod reissue;
#[cfg(feature = "factory")]
mod revoked_keys;
#[cfg(feature = "monte-carlo")]
mod robustness;
mod secrets;
#[cfg(feature = "report")]
mod selftest;
#[cfg(feature = "factory")]
mod site;
mod slow;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod suspects;
#[cfg(feature = "cli")]
mod templates;
mod text_rule;
#[cfg(feature = "report")]
pub(crate) mod texts;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod transformations;
#[cfg(feature = "monte-carlo")]
mod trials;
#[cfg(all(feature = "factory", feature = "report"))]
mod type_b;
#[cfg(feature = "factory")]
mod verdict;
mod wycheproof;
