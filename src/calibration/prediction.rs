//! What a calibration on a stand will be worth, before there is a reading: the uncertainties for exact currents of a
//! nominal gyro.

use super::inputs::{InputUncertainty, MeterUncertainty, Setup};
use super::parameter::Parameter;
use super::procedure::{Method, MethodResult, Options, calibrate};
use super::readings::Readings;
use crate::attitude::Deviation;
use crate::coefficients::{EarthRate, Position};
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

/// How much noisier each parameter (in the order of [`Parameter::EIGHT`]) is on a stand than on the same stand without
/// deviations, for errors of the currents alone.
///
/// `None` where the method gives nothing on one of the two.
pub fn noise_growth(
    positions: &[Position],
    earth: EarthRate,
    gyro: &GyroParameters,
    meter: MeterUncertainty,
    method: Method,
) -> Option<[f64; 8]> {
    let perfect: Vec<Position> = positions
        .iter()
        .map(|at| Position { deviation: Deviation { alpha_rad: 0.0, beta_rad: 0.0, gamma_rad: 0.0 }, ..*at })
        .collect();
    let u = |positions: &[Position]| {
        let setup = Setup::new(positions, earth, InputUncertainty::of_meter(meter)).ok()?;
        let result = predicted(&setup, gyro, method)?;
        Some(Parameter::EIGHT.map(|parameter| result.standard_uncertainty(parameter).unwrap_or(f64::NAN)))
    };
    let (real, perfect) = (u(positions)?, u(&perfect)?);
    Some(std::array::from_fn(|place| real[place] / perfect[place]))
}
