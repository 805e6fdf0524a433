//! Parts of a comparison: a test, the result for a position, the rotation common to all, and why there is none.

use super::kind::OUTLIER;
use crate::coefficients::PositionIndex;
use crate::statistics::student::{detectable, f_larger};
use serde::Serialize;

/// Reason why readings were not compared with a certificate.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NotCompared {
    /// Certificate of another stand.
    #[error("the certificate is for {certificate}, but the readings are from {readings}")]
    OtherStand {
        /// Model and serial number in the certificate.
        certificate: String,
        /// Model and serial number in the header.
        readings: String,
    },
    /// Positions that are missing from the certificate or from the readings.
    #[error("certificate and readings differ in their positions or nominal angles: {0}")]
    OtherPositions(PositionIndex),
    /// Missing repeatability: the certificate states none, and a single run does not show it.
    #[error("the certificate states no repeatability, and one run does not show it; measure two runs or more")]
    NoRepeatability,
    /// Too few positions to distinguish a common rotation from changes of single positions.
    #[error("too few positions to distinguish a common rotation from changes of single positions")]
    TooFewPositions,
}

/// Result of a test with F, which is chi-square over its degrees of freedom if the uncertainties are known exactly.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Test {
    /// Chi-square: the sum of squared differences in units of their standard uncertainties.
    pub chi_square: f64,
    /// Degrees of freedom of chi-square.
    pub degrees_of_freedom: usize,
    /// Probability of a larger value for an unchanged stand, by the F distribution, because the uncertainties have
    /// finite degrees of freedom themselves.
    pub probability: f64,
    /// Degrees of freedom of the uncertainties.
    #[serde(skip)]
    pub(crate) of_u: f64,
}

impl Test {
    pub(super) fn new(chi_square: f64, degrees_of_freedom: usize, of_u: f64) -> Self {
        let probability = f_larger(chi_square / degrees_of_freedom as f64, degrees_of_freedom, of_u);
        Self { chi_square, degrees_of_freedom, probability, of_u }
    }

    /// Returns the statistic to which the probability belongs.
    pub(crate) fn f(&self) -> f64 {
        self.chi_square / self.degrees_of_freedom as f64
    }
}

/// Result of a comparison for one position.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ComparedPosition {
    /// Index (i, j) of the position.
    #[serde(flatten)]
    pub index: PositionIndex,
    /// Rotation since the certificate about x, y, z of the case, relative to the other positions, arcsec.
    pub turn_arcsec: [f64; 3],
    /// Standard uncertainties of `turn_arcsec`, arcsec.
    pub u_arcsec: [f64; 3],
    /// Test of all three components at once, relative to the rotation common to the other positions.
    pub test: Test,
    /// `true` if the position repeats.
    pub repeats: bool,
}

/// Rotation common to all positions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CommonTurn {
    /// Rotation of the platform about x, y, z of the case, arcsec.
    pub platform_arcsec: [f64; 3],
    /// Rotation of the base about east, north, up, arcsec; what cannot be distinguished from the platform is in
    /// `platform_arcsec`.
    pub base_arcsec: [f64; 3],
    /// Test of the common rotation against the variation between runs; `None` if that is unknown.
    pub test: Option<Test>,
    /// Largest standard uncertainty of `platform_arcsec` in that test, arcsec; 0 without it.
    #[serde(skip)]
    pub(crate) u_platform_arcsec: f64,
}

impl CommonTurn {
    /// Returns the smallest rotation of the platform about an axis of the case that the test finds with a probability of 95 %.
    pub(crate) fn detectable_arcsec(&self) -> Option<f64> {
        let test = self.test?;
        Some(self.u_platform_arcsec * detectable(OUTLIER, test.degrees_of_freedom, test.of_u)?)
    }
}
