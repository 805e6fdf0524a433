//! Signed passports: content, text form, issue, re-issue and verification.
//!
//! * `content`: records, their reader, which accepts only the canonical form, and the numbers computed from stand and site.
//! * `accuracy`: expected calibration uncertainty for a stated gyro type and meter.
//! * `annotations`: comments between the records.
//! * [`issue`]: issue of a signed passport from a stand and a site.
//! * `recomputed`: recomputation of every number from the signed inputs.
//! * `checks`: names and results of the checks.
//! * `place`: comparison of a place with the site.
//! * `verification`: the six steps, and "may I use this passport, on this stand, here, now?".
//! * [`reissue`]: re-issue of a passport as its successor.
//! * `difference`: differences of two passports, number by number.
//! * `export`: stand and site of a passport as files again.

pub(crate) mod accuracy;
pub(crate) mod annotations;
pub(crate) mod checks;
pub(crate) mod content;
pub(crate) mod difference;
#[cfg(feature = "factory")]
pub(crate) mod export;
#[cfg(feature = "factory")]
pub mod issue;
pub(crate) mod place;
pub(crate) mod recomputed;
#[cfg(feature = "factory")]
pub mod reissue;
pub(crate) mod verification;

pub use crate::coefficients::MatrixRows;
pub(crate) use crate::coefficients::Rows;
use crate::document::Form;
pub use crate::document::{Malformed, RegisterUsed};
use crate::text::Limits;
pub use accuracy::{Accuracy, Stated};
pub use checks::{Check, CheckName, Code};
pub use content::{
    Content, Dated, PassportHeader, PositionCurrents, PositionVectors, Predecessor, SelfCheck, content_from_anyone,
};
pub use verification::{Question, Refused, Trust, Verification, VerifiedPassport, accept, verify};

/// Namespace of the signatures of passports.
pub const NAMESPACE: &str = "dtg-passport";

/// Form of passports as signed documents.
pub(crate) const FORM: Form = Form {
    namespace: NAMESPACE,
    format: content::PASSPORT_FORMAT,
    limits: Limits::DOCUMENT,
    expected: "a passport, which `issue` makes and signs",
};
