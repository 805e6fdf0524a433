//! Noise of the gyro's own drift: from visit to visit, and from one turn-on to the next; stated by its type, or estimated
//! from repeated visits and cycles.

use super::offsets::{Condensed, Differences};
use crate::text::words;
use nalgebra::Matrix2;

/// Steps of the search for the noise of a visit.
const MOST_STEPS: usize = 100;

/// Largest relative distance of the sum of squares from its expectation at the noise found.
const FOUND: f64 = 1e-9;

words! {
    /// Source of a noise of the gyro.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[non_exhaustive]
    pub enum NoiseSource: pub(crate) key {
        /// Stated by the gyro type.
        Stated = "stated",
        /// Estimated from the readings.
        Estimated = "estimated",
        /// Neither stated nor shown by repeated readings; the result does not include it.
        NotStated = "not_stated",
    }
}

/// Noise of the drift, each axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriftNoise {
    /// Standard deviation, °/h; 0 if it is not known.
    pub deg_per_h: f64,
    /// Source of the standard deviation.
    pub source: NoiseSource,
    /// Degrees of freedom of an estimate; infinite if stated.
    pub degrees_of_freedom: f64,
}

impl DriftNoise {
    /// Returns `true` if the gyro has a noise that is estimated from its readings.
    pub(crate) fn is_estimated(&self) -> bool {
        self.source == NoiseSource::Estimated && self.deg_per_h > 0.0
    }

    pub(crate) fn stated(deg_per_h: Option<f64>) -> Self {
        let source = if deg_per_h.is_some() { NoiseSource::Stated } else { NoiseSource::NotStated };
        Self { deg_per_h: deg_per_h.unwrap_or(0.0), source, degrees_of_freedom: f64::INFINITY }
    }

    pub(crate) fn estimated(deg_per_h: f64, degrees_of_freedom: usize) -> Self {
        Self { deg_per_h, source: NoiseSource::Estimated, degrees_of_freedom: degrees_of_freedom as f64 }
    }
}

/// Returns the noise of the drift from visit to visit, °/h, with which the differences between visits have their expected
/// sum of squares, or 0 if they have less without any ([Paule and
/// Mandel](crate::bibliography::Bibliography::PauleMandel82)); and their degrees of freedom.
///
/// `known` returns the covariance of the other errors of a visit, by the indices of position and visit. The result is
/// `None` if the differences have no degrees of freedom.
pub(crate) fn of_visits(
    differences: &Differences,
    k: &Matrix2<f64>,
    known: impl Fn(usize, usize) -> Matrix2<f64>,
) -> Option<(f64, usize)> {
    let alone = differences.condensed(k, |_, _| Matrix2::identity())?;
    let degrees_of_freedom = alone.degrees_of_freedom;
    if degrees_of_freedom == 0 {
        return None;
    }
    // The inverse of the sum of squares is nearly linear in the variance; it is exactly so if all visits are alike.
    let excess = |found: Condensed| 1.0 - degrees_of_freedom as f64 / found.chi_square;
    let with = |variance: f64| {
        differences
            .condensed(k, |place, visit| known(place, visit) + Matrix2::from_diagonal_element(variance))
            .map(excess)
    };
    // With this variance alone the sum is as expected; other errors can only make the variance smaller.
    let (mut low, mut high) = (0.0, alone.chi_square / degrees_of_freedom as f64);
    let none = with(0.0);
    if high == 0.0 || none.is_some_and(|excess| excess <= 0.0) {
        return Some((0.0, degrees_of_freedom));
    }
    let mut above = none.unwrap_or(1.0);
    let mut below = with(high).unwrap_or(0.0);
    // Regula falsi, with the other end halved when the same end moves twice (Illinois).
    let mut last = 0_i8;
    for _ in 0..MOST_STEPS {
        if below.abs() < FOUND {
            return Some((high.sqrt(), degrees_of_freedom));
        }
        let middle = low + above / (above - below) * (high - low);
        let found = with(middle).unwrap_or(1.0);
        if found.abs() < FOUND {
            return Some((middle.sqrt(), degrees_of_freedom));
        }
        if found > 0.0 {
            (low, above) = (middle, found);
            below = if last > 0 { below / 2.0 } else { below };
            last = 1;
        } else {
            (high, below) = (middle, found);
            above = if last < 0 { above / 2.0 } else { above };
            last = -1;
        }
    }
    Some((high.sqrt(), degrees_of_freedom))
}
