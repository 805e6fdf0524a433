//! Where the uncertainty of a calibration comes from, and how large it is.
//!
//! * [`budget`]: first order: contributions of every named input, effective degrees of freedom, covariance.
//! * [`remedy`]: what would halve an uncertainty, in one computed sentence.
//! * [`document`]: the same for machines.
//! * [`entries`]: covariance of the numbers of a passport.
//! * [`picture`]: the contributions as bars (SVG).

pub mod budget;
pub mod document;
pub mod entries;
pub mod picture;
pub mod remedy;

pub use budget::Budget;
