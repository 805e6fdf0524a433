//! From sixteen currents to the parameters of a gyro. It takes coefficients, never a passport.
//!
//! * [`analytic`]: the paper's closed solution, eq. (13)-(16) and (8).

pub mod analytic;
