//! The paper's table and its Fig. 4, computed again.
//!
//! * [`accuracy`]: how far found parameters are from nominal ones, over stands and currents drawn at random.
//! * [`convergence`]: how many steps successive approximation takes.
//! * [`draw`]: stands and currents at random.

pub(crate) mod accuracy;
pub(crate) mod convergence;
pub mod draw;

pub use crate::statistics::random::{Run, Stream};
pub use accuracy::{Accuracy, AccuracyOptions, AccuracyRow, PAPER_LATITUDE_DEG, Stands, accuracy};
pub use convergence::{Convergence, ConvergenceOptions, ConvergenceRow, convergence};
