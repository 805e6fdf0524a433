//! Least squares, distributions, random streams: statistics without a gyro in it.
//!
//! * [`least_squares`]: a weighted linear model through QR, its rank and condition through the SVD.
//! * [`distributions`]: chi-square and normal probabilities.
//! * [`student`]: Student's t.
//! * [`random`]: streams of random numbers that do not depend on the number of threads or on the platform.
//! * [`summary`]: largest, mean, deviation, percentile, and what a share of a sample is worth.

pub mod distributions;
pub mod least_squares;
pub mod random;
pub mod student;
pub mod summary;
