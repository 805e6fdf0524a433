//! The signed passport: what it says, how it is written and read, issued, re-issued and verified.
//!
//! * `content`: the records, and the numbers that follow from stand and site.
//! * `accuracy`: what the stand is good for, for a stated gyro and meter.
//! * `annotations`: the comments that stand between them.
//! * `read`: signed text to content, canonical form required.
//! * [`issue`]: a stand and a site to a signed passport.
//! * `recomputed`: every number again from the signed inputs.
//! * `checks`: names and verdicts of the checks.
//! * `place`: whether a place is near enough to the site.
//! * `verification`: the six steps, and "may I use this passport, on this stand, here, now?".
//! * [`reissue`]: a new passport from an old one.

pub(crate) mod accuracy;
pub(crate) mod annotations;
pub(crate) mod checks;
pub(crate) mod content;
#[cfg(feature = "factory")]
pub mod issue;
pub(crate) mod place;
pub(crate) mod read;
pub(crate) mod recomputed;
#[cfg(feature = "factory")]
pub mod reissue;
pub(crate) mod verification;

pub use crate::document::Malformed;
pub use accuracy::{Accuracy, NoAccuracy, Stated, StatedGyro, StatedLaboratory};
pub use checks::{Check, CheckName, Code};
pub use content::{
    Content, Dated, Header, MatrixRows, PositionCurrents, PositionVectors, Predecessor, Rows, SelfCheck,
};
pub use read::content_from_anyone;
pub use verification::{Question, Trust, Verification, VerifiedPassport, verify};

/// The namespace that passports are signed for.
pub const NAMESPACE: &str = "dtg-passport";
