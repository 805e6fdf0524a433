//! Where the uncertainty of a calibration comes from, and how large it is.
//!
//! * `budget`: first order: contributions of every named input, effective degrees of freedom, covariance.
//! * `remedy`: what matters in a budget, and what would halve an uncertainty.
//! * `document`: the same for machines.
//! * `engine`: trials of a Monte Carlo, many side by side.
//! * `entries`: covariance of the numbers of a passport.
//! * `monte_carlo`: the same without first order, and whether first order is valid; `tally`: what trials leave behind.

pub(crate) mod budget;
#[cfg(feature = "monte-carlo")]
pub(crate) mod document;
#[cfg(feature = "monte-carlo")]
pub(crate) mod engine;
#[cfg(feature = "monte-carlo")]
pub(crate) mod entries;
#[cfg(feature = "monte-carlo")]
pub(crate) mod monte_carlo;
pub(crate) mod remedy;
#[cfg(feature = "monte-carlo")]
pub(crate) mod tally;

pub use budget::{Budget, Contribution, ParameterBudget};
#[cfg(feature = "monte-carlo")]
pub use document::BudgetDocument;
#[cfg(feature = "monte-carlo")]
pub use engine::{Engine, ReadingShape};
#[cfg(feature = "monte-carlo")]
pub use entries::{Entry, EntryUncertainty};
#[cfg(feature = "monte-carlo")]
pub use monte_carlo::{Distribution, FirstOrder, MonteCarlo, Trials, monte_carlo};
