//! From sixteen currents to the parameters of a gyro. It takes coefficients, never a passport.
//!
//! * [`readings`]: the currents, from CSV.
//! * [`analytic`]: the paper's closed solution, eq. (13)-(16) and (8).
//! * [`iterative`]: the paper's successive approximation, eq. (17)-(19).
//! * [`least_squares`]: all readings of any positions, weighted.
//! * [`noise`]: how much noisier it is on a stand than on a perfect one.
//! * [`procedure`]: all of them side by side, with uncertainties, residuals and chi-square.
//! * [`scatter`]: whether repeated readings agree.
//! * [`diagnosis`]: what may be wrong where readings do not fit.
//! * [`verdict`]: against a type's specification and against an earlier calibration.
//! * [`document`]: a result for machines.
//! * [`inputs`]: what is known of stand, site, seat and meter, and how well; [`stated`]: as the files state it.

pub mod analytic;
pub mod diagnosis;
pub mod document;
pub mod inputs;
pub mod iterative;
pub mod least_squares;
pub mod noise;
pub mod parameter;
pub mod procedure;
mod propagation;
pub mod readings;
pub mod scatter;
mod sensitivity;
pub mod stated;
mod unknowns;
pub mod verdict;

pub use inputs::{InputUncertainty, MeterUncertainty, Setup};
pub use procedure::{Calibration, Method, MethodResult, Options, calibrate};
pub use readings::Readings;
