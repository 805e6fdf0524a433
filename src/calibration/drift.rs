//! Drift of ω_0 in time: whether readings can show it, and the test of whether they do.

use super::causes::inputs;
use super::chi_square::{ALARM, chi_square};
use super::data::Observation;
use super::estimates::Estimates;
use super::offsets::{Differences, Offsets};
use super::propagation::{Propagation, product};
use super::{NoLeastSquares, Options, Readings, Setup};
use crate::statistics::scaled_f::{self, Part};
use nalgebra::{Matrix2, Vector2};

/// Checks that all readings have times, and not all the same, and that the noise of the gyro is still known with a drift:
/// stated, or estimated if it is without the drift.
pub(crate) fn drift_can_be_fitted(setup: &Setup, readings: &Readings) -> Result<(), NoLeastSquares> {
    let mut times = readings.positions().iter().flat_map(|at| &at.visits).map(|visit| visit.time_s);
    let first = times.next().flatten().ok_or(NoLeastSquares::NoTimes)?;
    let mut same = true;
    for time_s in times {
        same &= time_s.ok_or(NoLeastSquares::NoTimes)? == first;
    }
    if same {
        return Err(NoLeastSquares::ConstantTime);
    }
    let of_noise = |drift| {
        let differences = Differences::new(readings, &Offsets::new(readings, (drift, false)));
        differences.map_or(0, |differences| differences.degrees_of_freedom())
    };
    let stated = setup.uncertainty().visit_deg_per_h.is_some();
    if !stated && of_noise(false) > 0 && of_noise(true) == 0 { Err(NoLeastSquares::DriftOrNoise) } else { Ok(()) }
}

/// Returns the drift in time that the readings show, °/h², the probability of a larger one if there is none, and whether they fit
/// with it; `None` if they do not determine it.
pub(crate) fn drift_test(setup: &Setup, readings: &Readings, options: &Options) -> Option<(Vector2<f64>, f64, bool)> {
    let Observation { data, fit, .. } = Observation::plain(setup, readings, options.model, (true, false)).ok()?;
    let drift = fit.drift(&data.offsets)?;
    let propagation = Propagation::new(setup, &data, &fit);
    let rest = chi_square(&propagation);
    let explains = !rest.judges() || rest.probability >= ALARM;
    let probability = probability_of_drift(&propagation, &drift)?;
    Some((drift, probability, explains))
}

/// Returns the probability of a larger drift than `drift` if there is none; `None` if its covariance has no inverse.
fn probability_of_drift(propagation: &Propagation, drift: &Vector2<f64>) -> Option<f64> {
    let Propagation { setup, data, fit, .. } = propagation;
    let (inputs, columns) = inputs(setup, data, fit);
    let response = propagation.response_of_least_squares();
    let spread = product(&response.rows(response.nrows() - 2, 2).into_owned(), &columns);
    let estimates = Estimates::new(setup, &data.repeats);
    let mut whole = Matrix2::zeros();
    let mut of_estimates = vec![Matrix2::zeros(); estimates.degrees_of_freedom.len()];
    for (input, change) in inputs.iter().zip(spread.column_iter()) {
        let change = change.fixed_rows::<2>(0);
        let square = change * change.transpose();
        whole += square;
        for (estimate, share) in input.basis.shares() {
            of_estimates[estimate] += square * share;
        }
    }
    let inverse = whole.try_inverse()?;
    let parts = of_estimates.iter().zip(&estimates.degrees_of_freedom).map(|(part, &degrees_of_freedom)| {
        let s = inverse * part;
        Part { degrees_of_freedom, trace: s.trace(), square: (s * s).trace() }
    });
    let parts: Vec<Part> = parts.collect();
    let of_visits = estimates.of_visits().map_or_else(Matrix2::zeros, |estimate| of_estimates[estimate]);
    let value = |factor: f64| {
        let inverse = (whole + of_visits * (factor - 1.0)).try_inverse();
        inverse.map_or(0.0, |inverse| drift.dot(&(inverse * drift)))
    };
    Some(scaled_f::larger(2, &parts, estimates.of_visits(), value))
}
