//! The visit, or the row of a visit, that agrees least with the others, if chance does not explain how little.
//!
//! Each is compared with what all others predict of it, in both components together. In units of the scatter of the
//! others this is Fisher's F with 2 degrees of freedom and those of the others; for one component it is Student's t of
//! [Stefansky's test](crate::bibliography::Bibliography::Stefansky72). The probability is Bonferroni's bound for as many
//! comparisons as there are visits or rows.

use super::chi_square::{ChiSquare, chi_square};
use super::data::{Data, Observation};
use super::offsets::{Differences, VisitRow, VisitRows};
use super::propagation::Propagation;
use super::readings::Exclusion;
use super::scatter::{IMPROBABLE, VisitErrors};
use super::{NoiseSource, Options, Readings, RowScatter, Setup};
use crate::coefficients::PositionIndex;
use crate::statistics::distributions::chi_square_larger;
use crate::statistics::student::f_larger;
use nalgebra::{Matrix2, Vector2};
use serde::{Deserialize, Serialize};

/// Determinant of the part of its covariance that the residual of a visit keeps, below which nothing is kept but rounding.
const ALONE: f64 = 1e-9;

/// Probability of a larger scatter from which one is as stated.
const AS_STATED: f64 = 0.05;

/// Relative difference of two sums of squares that are equal but for rounding.
const EQUAL: f64 = 1e-6;

/// Visit, or row of a visit, that differs from the others by more than chance explains.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "struct SuspectDocument")]
pub struct Suspect {
    /// Frame index.
    pub i: u32,
    /// Platform index.
    pub j: u32,
    /// Turn-on of the gyro.
    pub cycle: u32,
    /// Number of the visit within its cycle and position.
    pub visit: u32,
    /// Number of the row within the visit; absent if the visit as a whole is meant.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub row: Option<usize>,
    /// `true` if another suspect may be wrong instead: the readings do not tell which.
    pub one_of_several: bool,
    /// Difference of the currents (J_x, J_y) from what the others predict, mA.
    pub difference_ma: [f64; 2],
    /// Probability that any visit, or any row, differs as much by chance.
    pub probability: f64,
}

impl Suspect {
    pub(crate) fn index(&self) -> PositionIndex {
        PositionIndex { i: self.i, j: self.j }
    }

    /// Returns the readings without the visit or row.
    pub(crate) fn left_out(&self, readings: &Readings) -> Option<Readings> {
        let Self { i, j, cycle, visit, row, .. } = *self;
        let mut rest = readings.clone();
        match row {
            Some(row) => rest.leave_out_row(self.index(), (cycle, visit), row.checked_sub(1)?)?,
            None => rest.exclude(Exclusion { i, j, visit, cycle: Some(cycle), why: String::new() }).ok()?,
        }
        Some(rest)
    }
}

/// Returns those of several visits or rows, of which one is wrong, that may be the wrong one: if the readings fit the stand
/// far better without another of them, one is not.
///
/// The fits without each of them are compared by Fisher's F, in units of the residuals of the best fit; by chi-square if the
/// noise of the gyro is stated and that fit agrees with it. If there is nothing else to compare them with, this also tells
/// whether any of them is wrong.
fn by_fit(setup: &Setup, readings: &Readings, options: &Options, several: Vec<Suspect>) -> Vec<Suspect> {
    let without = |one: &Suspect| {
        let rest = one.left_out(readings)?;
        let Observation { data, fit, .. } = Observation::new(setup, &rest, options.model, options.drift).ok()?;
        Some(chi_square(&Propagation::new(setup, &data, &fit))).filter(ChiSquare::judges)
    };
    let fits: Vec<ChiSquare> = several.iter().map_while(without).collect();
    let best = fits.iter().min_by(|one, other| one.value.total_cmp(&other.value));
    let probabilities: Vec<f64> = best.filter(|_| fits.len() == several.len()).map_or_else(Vec::new, |best| {
        let is_known = setup.uncertainty().visit_deg_per_h.is_some() && best.probability >= AS_STATED;
        let of_residuals = if is_known { f64::INFINITY } else { best.degrees_of_freedom as f64 };
        let freedom = of_residuals.min(best.of_uncertainties);
        let variance = (best.value / best.degrees_of_freedom as f64).max(1.0);
        fits.iter().map(|fit| by_chance(several.len(), fit.value - best.value, variance, freedom)).collect()
    });
    let refuted = probabilities.iter().copied().filter(|probability| *probability < IMPROBABLE).reduce(f64::max);
    let Some(refuted) = refuted else {
        return several.into_iter().filter(|one| one.probability < IMPROBABLE).collect();
    };
    let rest = several.into_iter().zip(probabilities).filter(|(_, probability)| *probability >= IMPROBABLE);
    let mut rest: Vec<Suspect> =
        rest.map(|(one, _)| Suspect { probability: one.probability.min(refuted), ..one }).collect();
    let one_of_several = rest.len() > 1;
    rest.iter_mut().for_each(|one| one.one_of_several = one_of_several);
    rest
}

/// Returns Bonferroni's bound for the probability that one of `count` sums of two squares is as large by chance, given the
/// variance and its degrees of freedom.
fn by_chance(count: usize, squares: f64, variance: f64, degrees_of_freedom: f64) -> f64 {
    (count as f64 * f_larger(squares / 2.0 / variance, 2, degrees_of_freedom)).min(1.0)
}

/// Residual of a visit or row: the place where it is, and what its removal takes from the sum of squares.
struct Deletion {
    place: usize,
    visit: usize,
    row: Option<usize>,
    squares: f64,
    difference_ma: Vector2<f64>,
}

/// Returns the row and the visit that chance does not explain, as far as there are any.
pub(crate) fn all(setup: &Setup, readings: &Readings, observation: &Observation, options: &Options) -> Vec<Suspect> {
    let Observation { data: Data { repeats, .. }, fit, seen, differences } = observation;
    let meter = &setup.uncertainty().meter;
    let least_ma = readings.recorded.rounding_ma(meter).max(meter.noise_ma);
    let row = seen.rows.and_then(|scatter| of_rows(readings, &scatter, least_ma));
    let visit = differences.as_ref().and_then(|differences| {
        let errors = VisitErrors::new(setup, readings, fit, repeats.noise_ma);
        let of_visit = |place, visit| errors.with_noise(place, visit, repeats.visit.deg_per_h);
        // An estimated noise contains what is suspect; what is stated explains this much of the scatter in any case.
        let stated = if repeats.visit.source == NoiseSource::Estimated { 0.0 } else { repeats.visit.deg_per_h };
        let explained = |place, visit| errors.with_noise(place, visit, stated).trace() / of_visit(place, visit).trace();
        let k = &fit.unknowns.parameters.k_deg_per_h_per_ma;
        of_visits(readings, differences, k, of_visit, explained)
    });
    let each = [row, visit].into_iter().flatten();
    each.flat_map(|several| by_fit(setup, readings, options, several)).collect()
}

/// Returns the visit that agrees least with the others; several, if each of them agrees as little.
///
/// `k` is K, °/(h·mA), and `covariance` returns the covariance of the errors of a visit, (°/h)², by the indices of
/// position and visit. Its scale is that of the scatter, but not less than the share that `explained` returns. The result
/// is `None` if no visit is suspect, or without enough repeated visits.
pub(crate) fn of_visits(
    readings: &Readings,
    differences: &Differences,
    k: &Matrix2<f64>,
    covariance: impl Fn(usize, usize) -> Matrix2<f64>,
    explained: impl Fn(usize, usize) -> f64,
) -> Option<Vec<Suspect>> {
    let k_inverse = k.try_inverse()?;
    let VisitRows { design, rates, each } = differences.rows(k, covariance)?;
    // B = L⁻¹ A' for the normal equations A'A = L L': B'B projects onto what x explains.
    let lower = (design.tr_mul(&design)).cholesky()?.unpack();
    let of_x = lower.solve_lower_triangular(&design.transpose())?;
    let residuals = &rates - of_x.tr_mul(&(&of_x * &rates));
    let deletions = each.iter().enumerate().filter_map(|(at, row)| {
        let VisitRow { place, visit, whitening, of_mean } = *row;
        let own = of_x.fixed_columns::<2>(2 * at);
        let kept = Matrix2::identity() - whitening * of_mean * whitening.transpose() - own.tr_mul(&own);
        // Of a visit that alone determines an unknown nothing is kept.
        let inverse = kept.try_inverse().filter(|_| kept.determinant() > ALONE)?;
        let residual = residuals.fixed_rows::<2>(2 * at).into_owned();
        let predicted = inverse * residual;
        let difference_ma = -(k_inverse * (whitening.try_inverse()? * predicted));
        Some(Deletion { place, visit, row: None, squares: residual.dot(&predicted), difference_ma })
    });
    let freedom = differences.degrees_of_freedom();
    let least = each.iter().map(|row| explained(row.place, row.visit)).fold(1.0, f64::min);
    let spread =
        Spread { squares: residuals.norm_squared(), degrees_of_freedom: freedom, least, is_stated: least >= 1.0 };
    largest(readings, deletions, each.len(), spread)
}

/// Returns the row that agrees least with the other rows of its visit, or both of two, given the scatter of all rows;
/// `least_ma` is the scatter that a reading has in any case, from its rounding or its stated noise.
fn of_rows(readings: &Readings, scatter: &RowScatter, least_ma: f64) -> Option<Vec<Suspect>> {
    let freedom = scatter.degrees_of_freedom;
    let squares = scatter.standard_deviation_ma.powi(2) * freedom as f64;
    let visits = readings
        .positions()
        .iter()
        .enumerate()
        .flat_map(|(place, at)| at.visits.iter().enumerate().map(move |(visit, found)| (place, visit, found)));
    let several = visits.filter(|(_, _, found)| found.each_ma.len() > 1);
    let deletions = several.clone().flat_map(|(place, visit, found)| {
        let count = found.each_ma.len() as f64;
        found.each_ma.iter().enumerate().map(move |(row, current_ma)| {
            let residual = current_ma - found.mean_ma;
            let difference_ma = residual * (count / (count - 1.0));
            Deletion { place, visit, row: Some(row), squares: residual.dot(&difference_ma), difference_ma }
        })
    });
    let count = several.map(|(_, _, found)| found.each_ma.len()).sum();
    let spread = Spread { squares, degrees_of_freedom: freedom, least: least_ma.powi(2), is_stated: false };
    largest(readings, deletions, count, spread)
}

/// Scatter of the residuals of all visits or rows.
struct Spread {
    /// Sum of the squares of all residuals.
    squares: f64,
    degrees_of_freedom: usize,
    /// Variance that a residual has in any case.
    least: f64,
    /// `true` if that is the whole variance as it is stated.
    is_stated: bool,
}

/// Returns the largest of `count` deletions, and each that is equal to it, if chance does not explain it. Without other
/// residuals its probability is 1, and is not known.
fn largest(
    readings: &Readings,
    deletions: impl Iterator<Item = Deletion>,
    count: usize,
    spread: Spread,
) -> Option<Vec<Suspect>> {
    let rest = spread.degrees_of_freedom.checked_sub(2)?;
    let mut deletions: Vec<Deletion> = deletions.collect();
    let squares = deletions.iter().map(|deletion| deletion.squares).fold(f64::NAN, f64::max);
    let others = (spread.squares - squares).max(0.0);
    let variance = (others / rest as f64).max(spread.least);
    let alone = rest == 0;
    // Of a noise that is stated, and with which the others agree, the variance is known.
    let is_known = spread.is_stated && chi_square_larger(others / spread.least, rest) >= AS_STATED;
    let freedom = if is_known { f64::INFINITY } else { rest as f64 };
    let probability = if alone { 1.0 } else { by_chance(count, squares, variance, freedom) };
    deletions.retain(|deletion| deletion.squares * (1.0 + EQUAL) > squares);
    let suspect = |Deletion { place, visit, row, difference_ma, .. }: &Deletion| {
        let at = &readings.positions()[*place];
        let found = &at.visits[*visit];
        Suspect {
            i: at.index.i,
            j: at.index.j,
            cycle: found.cycle,
            visit: found.number,
            row: row.map(|row| row + 1),
            one_of_several: deletions.len() > 1,
            difference_ma: (*difference_ma).into(),
            probability,
        }
    };
    (probability < IMPROBABLE || alone).then(|| deletions.iter().map(suspect).collect())
}
