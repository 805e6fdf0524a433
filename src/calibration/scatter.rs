//! Whether repeated readings of a position agree as well as meter and stand promise.

use super::inputs::Setup;
use super::least_squares::{Fit, whitening_of};
use super::readings::Readings;
use super::sensitivity::Sensitivity;
use crate::statistics::distributions::chi_square_larger;

/// Scatter less probable than this counts as more than was stated.
pub const IMPROBABLE: f64 = 0.001;

/// The scatter of repeated readings about the mean of their position, against what was stated of one reading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scatter {
    /// Sum of squares in units of the stated variance.
    pub chi_square: f64,
    /// Two for each reading beyond a position's first.
    pub degrees_of_freedom: usize,
    /// Probability of more when the statement holds.
    pub probability: f64,
    /// By how much the variance of one reading was enlarged for this calibration: 1 when it was not.
    pub variance_factor: f64,
}

impl Scatter {
    /// `None` where no position has more than one reading.
    pub(crate) fn of(setup: &Setup, readings: &Readings, fit: &Fit) -> Option<Self> {
        let sensitivity = Sensitivity::new(setup, &fit.unknowns);
        let k = fit.unknowns.parameters.k_deg_per_h_per_ma;
        let (mut chi_square, mut degrees_of_freedom) = (0.0, 0);
        for (place, position) in readings.positions().iter().enumerate() {
            if position.each_ma.len() < 2 {
                continue;
            }
            let whiten = whitening_of(&sensitivity.of_one_reading(place, &fit.currents_ma[place]))?;
            for reading in &position.each_ma {
                chi_square += (whiten * k * (reading - position.mean_ma)).norm_squared();
            }
            degrees_of_freedom += 2 * (position.each_ma.len() - 1);
        }
        if degrees_of_freedom == 0 {
            return None;
        }
        let probability = chi_square_larger(chi_square, degrees_of_freedom);
        let enlarged = probability < IMPROBABLE;
        let variance_factor = if enlarged { chi_square / degrees_of_freedom as f64 } else { 1.0 };
        Some(Self { chi_square, degrees_of_freedom, probability, variance_factor })
    }
}
