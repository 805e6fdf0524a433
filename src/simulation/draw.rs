//! Stands, gyros and current errors drawn at random.

use crate::attitude::Deviation;
use crate::coefficients::{EIGHT_POSITIONS, Position};
use crate::gyro::{GyroParameters, GyroType};
use crate::statistics::random::Stream;
use crate::text::words;
use crate::units::radians_from_degrees;
use nalgebra::{Matrix2, Vector2};

words! {
    /// Distribution of the angles of a stand.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[non_exhaustive]
    pub enum Deviations: pub(crate) key {
        /// Uniform distribution within ±D.
        Uniform = "uniform",
        /// Two values, +D and −D, with equal probability.
        Corners = "corners",
    }
}

/// Draws the paper's eight positions, with α, β and γ of each within the limit D = `limit_deg`, degrees.
pub fn stand(stream: &mut Stream, deviations: Deviations, limit_deg: f64) -> Vec<Position> {
    let limit = radians_from_degrees(limit_deg);
    let mut angle = || match deviations {
        Deviations::Uniform => stream.within(limit),
        Deviations::Corners => limit * stream.sign(),
    };
    let positions = EIGHT_POSITIONS.iter().map(|(index, theta_deg, phi_deg)| {
        let (alpha_rad, beta_rad, gamma_rad) = (angle(), angle(), angle());
        let deviation = Deviation { alpha_rad, beta_rad, gamma_rad };
        Position { index: *index, theta_deg: *theta_deg, phi_deg: *phi_deg, deviation }
    });
    positions.collect()
}

/// Draws a gyro whose parameters are uniform within the tolerance of its type.
pub(crate) fn gyro(stream: &mut Stream, gyro_type: &GyroType) -> GyroParameters {
    let nominal = gyro_type.nominal.to_model();
    let tolerance = &gyro_type.tolerance;
    let mut within_percent = |value: f64, percent: f64| value * (1.0 + stream.within(percent) / 100.0);
    let (main, cross) = (tolerance.k_main_percent, tolerance.k_cross_percent);
    let k = nominal.k_deg_per_h_per_ma;
    let k = Matrix2::new(
        within_percent(k.m11, main),
        within_percent(k.m12, cross),
        within_percent(k.m21, cross),
        within_percent(k.m22, main),
    );
    let mut near = |value: f64, limit: f64| value + stream.within(limit);
    GyroParameters {
        k_deg_per_h_per_ma: k,
        omega0_deg_per_h: nominal.omega0_deg_per_h.map(|omega0| near(omega0, tolerance.omega0_deg_per_h)),
        omega_g_deg_per_h_per_g: near(nominal.omega_g_deg_per_h_per_g, tolerance.omega_g_deg_per_h_per_g),
        omega_k_deg_per_h_per_g: near(nominal.omega_k_deg_per_h_per_g, tolerance.omega_k_deg_per_h_per_g),
    }
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
