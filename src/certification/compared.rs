//! Values of a comparison of a check run with a certificate: its tests, its positions, and what they share.

use crate::coefficients::PositionIndex;
use serde::Serialize;

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
}
