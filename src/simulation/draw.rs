//! Stands, gyros and current errors drawn at random.

use crate::attitude::Deviation;
use crate::calibration::Parameter;
use crate::coefficients::{Position, eight_positions};
use crate::gyro::{GyroParameters, GyroType};
use crate::statistics::random::Stream;
use crate::text::words;
use crate::units::radians_from_degrees;
use nalgebra::Vector2;

words! {
    /// Distribution of the angles of a stand.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[non_exhaustive]
    #[doc(hidden)]
    pub enum Deviations: pub(crate) key {
        /// Uniform distribution within ±D.
        Uniform = "uniform",
        /// Two values, +D and −D, with equal probability.
        Corners = "corners",
    }
}

/// Draws the paper's eight positions, with α, β and γ of each within the limit D = `limit_deg`, degrees.
#[doc(hidden)]
pub fn stand(stream: &mut Stream, deviations: Deviations, limit_deg: f64) -> Vec<Position> {
    let limit = radians_from_degrees(limit_deg);
    let mut angle = || match deviations {
        Deviations::Uniform => stream.within(limit),
        Deviations::Corners => limit * stream.sign(),
    };
    eight_positions(|| Deviation::of([angle(), angle(), angle()])).into()
}

/// Draws a gyro whose parameters are uniform within the tolerance of its type.
pub(crate) fn gyro(stream: &mut Stream, gyro_type: &GyroType) -> GyroParameters {
    let nominal = gyro_type.nominal.to_model().to_vector();
    let tolerance = &gyro_type.tolerance;
    GyroParameters::from_vector(&Parameter::EIGHT.map(|parameter| {
        let (value, deviation) = (nominal[parameter.place()], stream.within(tolerance.of(parameter)));
        if tolerance.is_in_percent(parameter) { value * (1.0 + deviation / 100.0) } else { value + deviation }
    }))
}

/// Correlation of the errors of the readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum CurrentError {
    /// Separate error for every reading: the usual case in a laboratory.
    Independent,
    /// Common error for all readings of x, and another for those of y.
    Channel,
    /// Common error for all readings, as in the paper's table.
    Common,
}

impl CurrentError {
    /// Applies relative errors, uniform within ±`percent`, to the currents.
    #[doc(hidden)]
    pub fn add(self, stream: &mut Stream, percent: f64, currents_ma: &mut [Vector2<f64>]) {
        let limit = percent / 100.0;
        let mut factor = || 1.0 + stream.within(limit);
        match self {
            Self::Independent => currents_ma.iter_mut().for_each(|current| current.apply(|j| *j *= factor())),
            Self::Channel => {
                let factors = Vector2::new(factor(), factor());
                currents_ma.iter_mut().for_each(|current| current.component_mul_assign(&factors));
            }
            Self::Common => {
                let factor = factor();
                currents_ma.iter_mut().for_each(|current| *current *= factor);
            }
        }
    }
}
