//! Uncertainty of a calibration and its sources.
//!
//! * `budget`: first-order contributions of every input, effective degrees of freedom, covariance.
//! * `dominant`: the dominant contribution of a budget, and what would halve an uncertainty; `document`: a budget as JSON.
//! * `engine`: what the trials of a Monte Carlo draw and compute.
//! * `monte_carlo`: distributions by Monte Carlo, and whether first order is valid.

pub(crate) mod budget;
mod document;
pub(crate) mod dominant;
#[cfg(feature = "monte-carlo")]
pub(crate) mod engine;
#[cfg(feature = "monte-carlo")]
pub(crate) mod monte_carlo;

pub use budget::{Budget, Contribution, ParameterBudget};
#[cfg(feature = "monte-carlo")]
pub use engine::Engine;
#[cfg(feature = "monte-carlo")]
pub use monte_carlo::{Distribution, MonteCarlo, Trials, monte_carlo};
