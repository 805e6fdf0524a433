//! Expected uncertainty of a calibration on a stand, before any reading: computed for the exact currents of a nominal
//! gyro.

use super::{
    Calibration, MeterUncertainty, Method, MethodResult, Options, Parameter, Reading, Readings, Setup, Visit,
    calibrate, least_squares, procedure::without_causes,
};
use crate::coefficients::{Coefficients, PositionIndex};
use crate::gyro::GyroParameters;
use nalgebra::Vector2;
use serde::Serialize;

/// Returns the result of `method` for the exact currents of `gyro`, or `None` if the method gives no result.
///
/// Its covariance is the one that a laboratory can expect, to first order.
pub(crate) fn predicted(setup: &Setup, gyro: &GyroParameters, method: Method) -> Option<MethodResult> {
    let readings = Readings::new(setup.coefficients(), &exact_currents_ma(setup, gyro)?).ok()?;
    let options = Options { methods: vec![method], ..Options::default() };
    calibrate(setup, &readings, &options).ok()?.results.pop()
}

/// Returns the exact currents (J_x, J_y) of `gyro` in every position, mA, or `None` if its K has no inverse.
pub(crate) fn exact_currents_ma(setup: &Setup, gyro: &GyroParameters) -> Option<Vec<(PositionIndex, Vector2<f64>)>> {
    setup.coefficients().positions.iter().map(|at| Some((at.index, gyro.currents_ma(at)?))).collect()
}

/// Returns the parameter whose standard uncertainty suffers most from the positions that `readings` left out, with its
/// ratio to that with all positions, each visited once; `others` is a further standard uncertainty of each parameter, which
/// no position reduces.
///
/// Returns `None` if none was left out, or the rest does not determine the parameters.
pub(crate) fn cost_of_missing(
    setup: &Setup,
    readings: &Readings,
    gyro: &GyroParameters,
    others: impl Fn(Parameter) -> f64,
) -> Option<(Parameter, f64)> {
    let rest = setup.of_readings(readings);
    if readings.left_out.is_empty() {
        return None;
    }
    let [all, rest] = [setup, &rest].map(|setup| predicted(setup, gyro, Method::LeastSquares));
    let (all, rest) = (all?, rest?);
    let ratio = |parameter: Parameter| {
        let [rest, all] = [&rest, &all].map(|result| result.standard_uncertainty(parameter));
        Some((parameter, libm::hypot(rest?, others(parameter)) / libm::hypot(all?, others(parameter))))
    };
    Parameter::EIGHT.into_iter().filter_map(ratio).max_by(|(_, one), (_, other)| one.total_cmp(other))
}

/// Returns what a noise of the drift from visit to visit, °/h, adds to the standard uncertainty of each parameter, in the
/// order of [`Parameter::EIGHT`], if every position with readings is visited once; `None` if no result can be predicted.
pub(crate) fn u_of_single_visits(
    setup: &Setup,
    readings: &Readings,
    gyro: &GyroParameters,
    deg_per_h: f64,
) -> Option<[f64; 8]> {
    let setup = setup.of_readings(readings);
    let with = |noise| {
        predicted(&setup.clone().into_owned().with(|u| u.visit_deg_per_h = Some(noise)), gyro, Method::LeastSquares)
    };
    let (with, without) = (with(deg_per_h)?, with(0.0)?);
    let of = |result: &MethodResult, parameter| result.standard_uncertainty(parameter).unwrap_or(f64::NAN);
    Some(Parameter::EIGHT.map(|parameter| {
        let (with, without) = (of(&with, parameter), of(&without, parameter));
        (with * with - without * without).max(0.0).sqrt()
    }))
}

/// Single further visit that would reduce the uncertainty of a parameter most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FurtherVisit {
    pub index: PositionIndex,
    /// Ratio of the standard uncertainty of the parameter with that visit to the one without it.
    pub ratio: f64,
}

/// Returns the position of the passport whose further visit, in the last turn-on, would reduce the standard uncertainty
/// of `parameter` most; the visits so far are those of `readings`, and `calibration` is their result.
///
/// Returns `None` if no least-squares result can be predicted.
pub(crate) fn best_further_visit(
    setup: &Setup,
    readings: &Readings,
    (calibration, gyro): (&Calibration, &GyroParameters),
    (parameter, options): (Parameter, &Options),
) -> Option<FurtherVisit> {
    // The noises that the calibration used.
    let setup = readings.recorded.applied_to(setup).into_owned().with(|u| {
        u.visit_deg_per_h = Some(calibration.visit_noise.deg_per_h);
        u.turn_on_deg_per_h = Some(calibration.turn_on_noise.deg_per_h);
        if let Some(rows) = calibration.row_scatter.filter(|_| u.meter.noise_ma == 0.0) {
            u.meter.noise_ma = rows.standard_deviation_ma;
        }
    });
    let exact = exact_currents_ma(&setup, gyro)?;
    let current_of = |index| exact.iter().find(|(known, _)| *known == index).map(|(_, current_ma)| *current_ma);
    let mut rows = Vec::new();
    for position in readings.positions() {
        let current_ma = current_of(position.index)?;
        for Visit { cycle, number, each_ma, time_s, .. } in &position.visits {
            let row = Reading {
                cycle: *cycle,
                visit: Some(*number),
                time_s: *time_s,
                ..Reading::new(position.index, current_ma)
            };
            rows.extend(each_ma.iter().map(|_| row));
        }
    }
    let u = |rows: &[Reading]| {
        let readings = Readings::of_rows(setup.coefficients(), rows).ok()?;
        without_causes(&setup, &readings, options)?.standard_uncertainty(parameter)
    };
    let (cycle, after) = (rows.iter().map(|row| row.cycle).max(), rows.iter().filter_map(|row| row.visit).max());
    let time_s = rows.iter().filter_map(|row| row.time_s).reduce(f64::max);
    let now = u(&rows)?;
    let with = |&(index, current_ma): &(PositionIndex, Vector2<f64>)| {
        rows.push(Reading { cycle: cycle?, visit: Some(after? + 1), time_s, ..Reading::new(index, current_ma) });
        let ratio = u(&rows).map(|u| u / now);
        rows.pop();
        Some(FurtherVisit { index, ratio: ratio? })
    };
    exact.iter().filter_map(with).min_by(|one, other| one.ratio.total_cmp(&other.ratio))
}

/// Ratios of standard uncertainties on a stand to those on the ideal stand with the same positions at the same site.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct NoiseGrowth {
    /// Largest ratio of K_x, K_xy, K_yx, K_y.
    pub k: f64,
    /// Larger ratio of ω_0x, ω_0y.
    #[serde(rename = "omega_0")]
    pub omega0: f64,
    pub omega_g: f64,
    pub omega_k: f64,
}

impl NoiseGrowth {
    pub(crate) fn worst(&self) -> f64 {
        self.k.max(self.omega0).max(self.omega_g).max(self.omega_k)
    }
}

/// Returns the growth of the standard uncertainties of least squares on a stand relative to the same stand without
/// deviations, if only the own errors of the readings act.
///
/// Returns `None` if least squares gives no result on either stand.
pub(crate) fn noise_growth(
    real: &Coefficients,
    ideal: &Coefficients,
    gyro: &GyroParameters,
    meter: MeterUncertainty,
) -> Option<NoiseGrowth> {
    let u = |coefficients| least_squares::expected_uncertainties(coefficients, gyro, &meter);
    let (real, ideal) = (u(real)?, u(ideal)?);
    let [kx, kxy, kyx, ky, omega0x, omega0y, omega_g, omega_k] =
        std::array::from_fn(|place| real[place] / ideal[place]);
    Some(NoiseGrowth { k: kx.max(kxy).max(kyx).max(ky), omega0: f64::max(omega0x, omega0y), omega_g, omega_k })
}
