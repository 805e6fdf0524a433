//! Least squares, distributions, random streams: statistics without a gyro in it.
//!
//! * [`least_squares`]: a weighted linear model through QR, its rank and condition through the SVD.
//! * [`distributions`]: chi-square and normal probabilities; [`beta`]: Student's t and Fisher's F; `saddle_point`: what
//!   both need of large parameters.
//! * `scaled_f`: of a chi-square whose covariance was partly estimated.
//! * [`outlier`]: Bartlett's test for a group that scatters more, Grubbs' for a value that is out.
//! * [`propagation`]: the law of propagation of uncertainty for any model with its gradient.
//! * [`random`]: streams of random numbers that do not depend on the number of threads or on the platform.
//! * [`wide_random`]: random numbers many at a time; [`elementary`]: what they need of sine, cosine and logarithm.
//! * [`bins`]: quantiles and coverage intervals of a sample of any size.
//! * [`summary`]: largest, mean, deviation, percentile, and what a share of a sample is worth.

pub(crate) mod beta;
#[cfg(feature = "monte-carlo")]
pub(crate) mod bins;
pub(crate) mod distributions;
pub(crate) mod elementary;
pub(crate) mod least_squares;
pub(crate) mod outlier;
pub(crate) mod propagation;
#[cfg(feature = "monte-carlo")]
pub(crate) mod random;
pub(crate) mod saddle_point;
pub(crate) mod scaled_f;
pub(crate) mod summary;
#[cfg(feature = "monte-carlo")]
pub(crate) mod wide_random;
