//! Reproduction of the paper's table and its Fig. 4.
//!
//! * [`accuracy`]: errors of computed parameters, over stands and currents drawn at random.
//! * [`convergence`]: the number of steps of the iterative method.
//! * [`draw`]: stands, gyros and current errors drawn at random.

pub(crate) mod accuracy;
pub(crate) mod convergence;
#[doc(hidden)]
pub mod draw;

pub use crate::statistics::random::Run;
// For the benchmarks.
#[doc(hidden)]
pub use crate::statistics::random::Stream;
pub use accuracy::{AccuracyOptions, AccuracyRow, AccuracyTable, PAPER_LATITUDE_DEG, Stands, accuracy};
pub use convergence::{Convergence, ConvergenceRow, LIMITS_DEG, convergence};
pub use draw::CurrentError;
