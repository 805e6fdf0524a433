//! General statistics, independent of gyros: least squares, distributions, random streams.
//!
//! * [`least_squares`]: weighted linear models through QR, with rank and condition through the SVD.
//! * [`distributions`]: chi-square and normal probabilities; [`student`]: Student's t and Fisher's F, effective degrees of
//!   freedom.
//! * `scaled_f`: the distribution of a chi-square whose covariance was partly estimated.
//! * `coincidences`: readings that are copies of earlier ones.
//! * [`random`]: streams of random numbers that do not depend on the number of threads or on the platform.
//! * [`straight_line`]: a straight line through points of known uncertainty; Holm's correction for many tests.
//! * [`summary`]: largest value, mean, standard deviation, percentiles, and the standard error of a share.

pub(crate) mod coincidences;
pub(crate) mod distributions;
pub(crate) mod least_squares;
#[cfg(feature = "monte-carlo")]
pub(crate) mod random;
pub(crate) mod scaled_f;
pub(crate) mod straight_line;
pub(crate) mod student;
pub(crate) mod summary;
