//! From sixteen currents to the parameters of a gyro. It takes coefficients, never a passport.
//!
//! * [`analytic`]: the paper's closed solution, eq. (13)-(16) and (8).
//! * [`noise`]: how much noisier it is on a stand than on a perfect one.

pub mod analytic;
pub mod noise;
