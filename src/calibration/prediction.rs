//! What a calibration on a stand will be worth, before there is a reading: the uncertainties for exact currents of a
//! nominal gyro.

use super::inputs::{MeterUncertainty, Setup};
use super::least_squares;
use super::procedure::{Options, calibrate};
use super::readings::Readings;
use super::result::{Method, MethodResult};
use crate::attitude::Deviation;
use crate::coefficients::{EarthRate, Position, StandGeometry};
use crate::gyro::GyroParameters;

/// The result of a method on exact currents of `gyro`: its covariance is what a laboratory will find, to first order.
///
/// `None` where the method gives nothing there.
pub fn predicted(setup: &Setup, gyro: &GyroParameters, method: Method) -> Option<MethodResult> {
    let positions = &setup.coefficients().positions;
    let each: Option<Vec<_>> = positions.iter().map(|at| Some((at.index, gyro.currents_ma(at)?))).collect();
    let readings = Readings::new(setup.coefficients(), &each?).ok()?;
    let options = Options { methods: vec![method], ..Options::default() };
    calibrate(setup, &readings, &options).ok()?.results.pop()
}

/// Ratios of standard uncertainties, this stand's to a perfect one's with the same positions at the same site.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NoiseGrowth {
    /// The worst of K_x, K_xy, K_yx, K_y.
    pub k: f64,
    /// The worse of ω_0x, ω_0y.
    pub omega0: f64,
    /// ω_g.
    pub omega_g: f64,
    /// ω_k.
    pub omega_k: f64,
}

impl NoiseGrowth {
    /// The worst of all.
    pub(crate) fn worst(&self) -> f64 {
        self.k.max(self.omega0).max(self.omega_g).max(self.omega_k)
    }
}

/// How much noisier a calibration by least squares is on a stand than on the same stand without deviations, for the own
/// errors of a meter's readings alone.
///
/// `None` where least squares gives nothing on one of the two.
pub(crate) fn noise_growth(
    positions: &[Position],
    earth: EarthRate,
    gyro: &GyroParameters,
    meter: MeterUncertainty,
) -> Option<NoiseGrowth> {
    let none = Deviation { alpha_rad: 0.0, beta_rad: 0.0, gamma_rad: 0.0 };
    let perfect: Vec<Position> = positions.iter().map(|at| Position { deviation: none, ..*at }).collect();
    let u = |positions: &[Position]| {
        let coefficients = StandGeometry::new(positions).ok()?.at(earth);
        least_squares::expected_uncertainties(&coefficients, gyro, &meter)
    };
    let (real, perfect) = (u(positions)?, u(&perfect)?);
    let [kx, kxy, kyx, ky, omega0x, omega0y, omega_g, omega_k] =
        std::array::from_fn(|place| real[place] / perfect[place]);
    Some(NoiseGrowth { k: kx.max(kxy).max(kyx).max(ky), omega0: f64::max(omega0x, omega0y), omega_g, omega_k })
}
