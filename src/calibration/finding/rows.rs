//! Causes that act within visits: a row that differs from the others, rows that are correlated, and a meter that is noisier
//! than stated.

use super::visits::by_fit;
use super::{Finding, Kind, LEVEL, Scope, jointly};
use crate::calibration::data::Observation;
use crate::calibration::{Options, Readings, Setup, Visit};
use crate::statistics::distributions::normal_below;
use crate::statistics::student::f_larger;
use nalgebra::{DMatrix, Vector2};

/// Relative difference of two sums of squares that are equal but for rounding.
const EQUAL: f64 = 1e-6;

/// Returns what was found in the rows of visits.
pub(super) fn causes(setup: &Setup, readings: &Readings, of: &Observation, options: &Options) -> Vec<Finding> {
    let mut found = by_fit(setup, readings, options, suspects(setup, readings, of));
    found.extend(correlation(readings).filter(|(_, probability)| *probability < LEVEL).map(
        |(correlation, probability)| {
            Finding::new(Kind::RowsCorrelated, Scope::default(), Some((correlation, "1")), probability)
        },
    ));
    let noise = of.seen.rows.and_then(|rows| Some((rows.standard_deviation_ma, jointly(rows.probability?))));
    found.extend(noise.filter(|(_, probability)| *probability < LEVEL).map(|(noise_ma, probability)| {
        Finding::new(Kind::Meter, Scope::default(), Some((noise_ma, "mA")), probability)
    }));
    found
}

/// Returns the row that agrees least with the other rows of its visit, or both of two; with a probability of 1 if there are no
/// other rows to compare them with.
fn suspects(setup: &Setup, readings: &Readings, of: &Observation) -> Vec<Finding> {
    let Some(rows) = of.seen.rows else { return Vec::new() };
    let Some(rest) = rows.degrees_of_freedom.checked_sub(2) else { return Vec::new() };
    let meter = &setup.uncertainty().meter;
    let least_ma = readings.recorded.rounding_ma(meter).max(meter.noise_ma);
    let visits = readings.positions().iter().flat_map(|at| at.visits.iter().map(move |visit| (at.index, visit)));
    let several = visits.filter(|(_, visit)| visit.each_ma.len() > 1);
    let count: usize = several.clone().map(|(_, visit)| visit.each_ma.len()).sum();
    let each = several.flat_map(|(index, visit)| {
        let rows = visit.each_ma.len() as f64;
        visit.each_ma.iter().enumerate().map(move |(row, current_ma)| {
            let residual = current_ma - visit.mean_ma;
            let difference_ma = residual * (rows / (rows - 1.0));
            (residual.dot(&difference_ma), difference_ma, index, visit, row)
        })
    });
    let mut each: Vec<_> = each.collect();
    let largest = each.iter().map(|(squares, ..)| *squares).fold(f64::NAN, f64::max);
    let all = rows.standard_deviation_ma.powi(2) * rows.degrees_of_freedom as f64;
    let variance = ((all - largest).max(0.0) / rest as f64).max(least_ma * least_ma);
    let probability = match rest {
        0 => 1.0,
        _ => jointly(count as f64 * f_larger(largest / 2.0 / variance, 2, rest as f64)),
    };
    each.retain(|(squares, ..)| (probability < LEVEL || rest == 0) && squares * (1.0 + EQUAL) > largest);
    let k = of.fit.unknowns.parameters.k_deg_per_h_per_ma;
    let found = each.into_iter().map(|(_, difference_ma, index, Visit { cycle, number, .. }, row)| {
        let (cycle, visit, row) = (Some(*cycle), Some(*number), Some(row + 1));
        let scope = Scope { cycle, visit, row, ..Scope::of(index) };
        let found = Finding::new(Kind::Row, scope, Some(((k * difference_ma).norm(), "deg/h")), probability);
        Finding { pair: (difference_ma * 1000.0).into(), ..found }
    });
    found.collect()
}

/// Returns the correlation of successive rows of a visit, pooled over all visits, and the probability that independent rows
/// have a larger one; `None` if no visit has three rows.
///
/// With the rows z of a visit less their mean, the correlation is Σ z'A z / Σ z'z. Its distribution is that of Durbin and
/// Watson: it exceeds r where Σ λ u² of independent normal u is positive, with the eigenvalues λ of A less r. Lugannani and
/// Rice's approximation gives the probability.
pub(crate) fn correlation(readings: &Readings) -> Option<(f64, f64)> {
    let (mut products, mut squares) = (0.0, 0.0);
    let mut eigenvalues = Vec::new();
    for visit in readings.visits().filter(|visit| visit.each_ma.len() > 2) {
        let left: Vec<Vector2<f64>> = visit.each_ma.iter().map(|row| row - visit.mean_ma).collect();
        products += left.iter().zip(&left[1..]).map(|(one, next)| one.dot(next)).sum::<f64>();
        squares += left.iter().map(Vector2::norm_squared).sum::<f64>();
        eigenvalues.extend(of_independent(left.len()).into_iter().flat_map(|value| [value, value]));
    }
    let found = products / squares;
    let less = eigenvalues.iter().map(|value| value - found);
    (squares > 0.0).then(|| (found, jointly(positive(&less.collect::<Vec<_>>()))))
}

/// Returns the eigenvalues of the products of successive ones of `count` rows less their mean, without that of the mean.
fn of_independent(count: usize) -> Vec<f64> {
    let centred = DMatrix::from_fn(count, count, |row, column| f64::from(u8::from(row == column)) - 1.0 / count as f64);
    let next = DMatrix::from_fn(count, count, |row, column| if row.abs_diff(column) == 1 { 0.5 } else { 0.0 });
    // The mean has the eigenvalue 0 of the centred matrix; a large one takes its place and is left out.
    let mean = DMatrix::from_element(count, count, 10.0 / count as f64);
    let mut values: Vec<f64> = (&centred * next * &centred + mean).symmetric_eigenvalues().data.into();
    values.retain(|value| *value < 5.0);
    values
}

/// Returns the probability that Σ λ u² of independent standard normal u is positive (Lugannani and Rice).
fn positive(each: &[f64]) -> f64 {
    let [least, most] = each.iter().fold([0.0_f64, 0.0_f64], |[least, most], one| [least.min(*one), most.max(*one)]);
    if least >= 0.0 || most <= 0.0 {
        return if most > 0.0 { 1.0 } else { 0.0 };
    }
    let slope = |s: f64| each.iter().map(|one| one / (1.0 - 2.0 * s * one)).sum::<f64>();
    // The slope rises from −∞ to ∞ between the poles.
    let (mut low, mut high) = (0.5 / least, 0.5 / most);
    for _ in 0..100 {
        let middle = (low + high) / 2.0;
        if slope(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let s = (low + high) / 2.0;
    let value = each.iter().map(|one| -0.5 * libm::log(1.0 - 2.0 * s * one)).sum::<f64>();
    let curvature = each.iter().map(|one| 2.0 * (one / (1.0 - 2.0 * s * one)).powi(2)).sum::<f64>();
    let w = (-2.0 * value).max(0.0).sqrt().copysign(s);
    let u = s * curvature.sqrt();
    if w.abs() < 1e-4 {
        return 0.5;
    }
    let density = libm::exp(-w * w / 2.0) / std::f64::consts::TAU.sqrt();
    (normal_below(-w) + density * (1.0 / u - 1.0 / w)).clamp(0.0, 1.0)
}
