//! Where the uncertainty of a calibration comes from, and how large it is.
//!
//! * `budget`: first order: contributions of every named input, effective degrees of freedom, covariance.
//! * `dominant`: what matters in a budget, and what would halve an uncertainty.
//! * `document`: the same for machines.
//! * `engine`: trials of a Monte Carlo, many side by side.
//! * `entries`: covariance of the numbers of a passport.
//! * `monte_carlo`: the same without first order, and whether first order is valid; `accumulator`: what trials leave behind.

#[cfg(feature = "monte-carlo")]
pub(crate) mod accumulator;
pub(crate) mod budget;
#[cfg(feature = "monte-carlo")]
pub(crate) mod document;
pub(crate) mod dominant;
#[cfg(feature = "monte-carlo")]
pub(crate) mod engine;
#[cfg(feature = "monte-carlo")]
pub(crate) mod entries;
#[cfg(feature = "monte-carlo")]
pub(crate) mod monte_carlo;

pub use budget::{Budget, Contribution, ParameterBudget};
#[cfg(feature = "monte-carlo")]
pub use document::BudgetDocument;
#[cfg(feature = "monte-carlo")]
pub use engine::{Engine, ReadingShape};
#[cfg(feature = "monte-carlo")]
pub use entries::{Entry, EntryUncertainty};
#[cfg(feature = "monte-carlo")]
pub use monte_carlo::{Distribution, FirstOrder, MonteCarlo, Trials, monte_carlo};
