//! Where the uncertainty of a calibration comes from, and how large it is.
//!
//! * [`budget`]: first order: contributions of every named input, effective degrees of freedom, covariance.
//! * [`remedy`]: what matters in a budget, and what would halve an uncertainty.
//! * [`document`]: the same for machines.
//! * [`engine`]: trials of a Monte Carlo, many side by side.
//! * [`entries`]: covariance of the numbers of a passport.
//! * [`mod@monte_carlo`]: the same without first order, and whether first order is valid; [`tally`]: what trials leave behind.
//! * [`picture`]: the contributions as bars (SVG).

pub mod budget;
pub mod document;
pub mod engine;
pub mod entries;
pub mod monte_carlo;
pub mod picture;
pub mod remedy;
pub mod tally;

pub use budget::Budget;
pub use monte_carlo::{MonteCarlo, monte_carlo};
