//! Stands, gyros and current errors at random.

use crate::attitude::Deviation;
use crate::coefficients::{EIGHT_POSITIONS, Position};
use crate::gyro::{GyroParameters, GyroType};
use crate::statistics::random::Stream;
use crate::units::radians_from_degrees;
use nalgebra::{Matrix2, Vector2};

/// How every angle of a stand is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Deviations {
    /// Uniform within ±D.
    Uniform,
    /// +D or −D.
    Corners,
}

/// The paper's eight positions, α, β and γ of each drawn with the limit D = `limit_deg`.
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

/// A gyro whose parameters are uniform within the tolerance of its type.
pub fn gyro(stream: &mut Stream, gyro_type: &GyroType) -> GyroParameters {
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

/// Which readings share an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum CurrentError {
    /// One for every reading: what a laboratory meets.
    Independent,
    /// One for all readings of x and one for those of y.
    Channel,
    /// One for all readings: what the paper's table holds for.
    Common,
}

impl CurrentError {
    /// Adds to the currents relative errors uniform within ±`percent`.
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
