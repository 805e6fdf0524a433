//! Chi-square test of a fit: its value from all inputs, and its distribution if uncertainties rest on estimates.

use super::causes::{Cause, table};
use super::estimates::{Basis, Estimates};
use super::least_squares::multiply_rows;
use super::propagation::{self, Propagation, Rest, covariance};
use crate::statistics::distributions::chi_square_larger;
use crate::statistics::scaled_f::{self, Part, ScaledF};
use nalgebra::{DMatrix, DVector, Matrix2};

/// Probability of chi-square below which a fit is examined.
pub(crate) const ALARM: f64 = 0.005;

/// Degrees of freedom of uncertainties below which they are stated beside the probability.
pub(crate) const FEW_DEGREES: f64 = 1000.0;

/// Chi-square test of a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChiSquare {
    /// Value of chi-square; 0 without degrees of freedom.
    pub value: f64,
    /// Number of readings minus number of parameters; if it is 0, a fit cannot be judged.
    pub degrees_of_freedom: usize,
    /// Probability of a larger value if the readings agree with all stated uncertainties.
    ///
    /// It is computed from a scaled F distribution if uncertainties rest on estimates with few degrees of freedom, and from
    /// its mean over the noise of visits if that is estimated.
    pub probability: f64,
    /// Denominator degrees of freedom of that F distribution; infinite if every uncertainty is known.
    pub of_uncertainties: f64,
}

impl ChiSquare {
    /// Returns `false` if there are as many unknowns as readings; then any readings fit.
    pub(crate) fn judges(&self) -> bool {
        self.degrees_of_freedom > 0
    }

    /// Returns `true` if estimated uncertainties, though with many degrees of freedom, make the probability another than that
    /// of chi-square by more than a hundredth.
    pub(crate) fn is_changed_by_estimates(&self) -> bool {
        let known = chi_square_larger(self.value, self.degrees_of_freedom);
        self.of_uncertainties >= FEW_DEGREES && (known - self.probability).abs() > 0.01 * known
    }
}

/// Returns chi-square of readings at the fit of `propagation`.
///
/// It is r' C⁻ r, where r are the residuals of a method, C is their covariance from all inputs, and C⁻ is any
/// generalised inverse. The part that the parameters absorb cancels. Chi-square is therefore the same for every method
/// that fits exact readings exactly. It is computed from z = Q₂'W e, whose covariance 1 + B B' has full rank (B is Q₂'W
/// times the common part of all positions).
pub(crate) fn chi_square(propagation: &Propagation) -> ChiSquare {
    let model = &propagation.fit.model;
    let degrees_of_freedom = model.rows - model.columns;
    if degrees_of_freedom == 0 {
        // With as many readings as unknowns, the residuals are only rounding.
        return ChiSquare { value: 0.0, degrees_of_freedom, probability: 1.0, of_uncertainties: f64::INFINITY };
    }
    let (value, Estimated { parts, visits }) = quadratic_form(propagation);
    let with = |factor: f64| match &visits {
        Some((_, terms)) => terms.iter().map(|term| term.with(factor)).sum(),
        None => value,
    };
    let of_visits = visits.as_ref().map(|(estimate, _)| *estimate);
    let probability = scaled_f::larger(degrees_of_freedom, &parts, of_visits, with);
    let of_uncertainties = ScaledF::new(degrees_of_freedom, &parts).denominator;
    ChiSquare { value, degrees_of_freedom, probability, of_uncertainties }
}

/// Parts of the covariance of the residuals that rest on estimates with few degrees of freedom.
#[derive(Debug, Default)]
pub(crate) struct Estimated {
    pub(crate) parts: Vec<Part>,
    /// Index of the estimate of the scatter of visits, and the terms of chi-square, which change with it.
    pub(crate) visits: Option<(usize, Vec<Term>)>,
}

/// Square of a combination of the residuals with unit variance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Term {
    square: f64,
    /// Share of the variance of visits in its variance.
    share: f64,
}

impl Term {
    /// Returns the term if the variance of visits is multiplied by `factor`.
    pub(crate) fn with(&self, factor: f64) -> f64 {
        self.square / (1.0 + self.share * (factor - 1.0))
    }

    /// Returns −2 ln of the likelihood if a further part has this variance, less that of the logarithm's constants.
    pub(crate) fn score(&self, variance: f64) -> f64 {
        self.with(1.0 + variance) + libm::log(1.0 + self.share * variance)
    }
}

/// Returns the value of chi-square, and the parts of the covariance that rest on estimates.
pub(crate) fn quadratic_form(propagation: &Propagation) -> (f64, Estimated) {
    let z = residuals(propagation);
    let rest = propagation.rest();
    let common = &rest.common;
    // Woodbury: z' (1 + B B')⁻¹ z = z'z − (B'z)' (1 + B'B)⁻¹ (B'z).
    let projected = common.tr_mul(&z);
    let cholesky = plus_one(common.tr_mul(common)).cholesky();
    let taken = cholesky.as_ref().map_or(0.0, |cholesky| projected.dot(&cholesky.solve(&projected)));
    let lower = cholesky.map(|cholesky| cholesky.unpack());
    (z.norm_squared() - taken, estimated(propagation, &rest, lower, &z))
}

/// Returns the terms of chi-square by the variance of a further part of each position, whose whitened covariance is `own`.
pub(crate) fn terms_of(propagation: &Propagation, own: &[Matrix2<f64>]) -> Option<Vec<Term>> {
    terms(&propagation.rest(), own, &residuals(propagation))
}

/// Returns z, the combinations of the whitened misclosures that do not depend on the parameters.
fn residuals(propagation: &Propagation) -> DVector<f64> {
    let Propagation { data, fit, .. } = propagation;
    let mut rotated = DMatrix::zeros(fit.model.rows, 1);
    let top = 2 * fit.whitening.len();
    rotated.rows_range_mut(top..).copy_from(&fit.of_differences(&data.offsets));
    for (place, (current, whiten)) in data.currents_ma.iter().zip(&fit.whitening).enumerate() {
        let misclosure = whiten * fit.misclosure(place, current);
        rotated.fixed_view_mut::<2, 1>(2 * place, 0).copy_from(&misclosure);
    }
    fit.model.rotate(&mut rotated);
    rotated.column(0).rows_range(fit.model.columns..).into_owned()
}

fn plus_one(mut matrix: DMatrix<f64>) -> DMatrix<f64> {
    (0..matrix.nrows()).for_each(|place| matrix[(place, place)] += 1.0);
    matrix
}

/// Returns the parts of the covariance of the residuals that rest on estimates with few degrees of freedom. `lower` is L
/// with L L' = 1 + B'B.
///
/// χ² is y' M y of the whitened misclosures y, with M = 1 − V V'. V consists of Q₁, the part that the parameters absorb,
/// and Q₂ B L'⁻¹ side by side. A part D of the covariance of y enters through tr D M and tr D M D M. Own parts of positions
/// are blocks of D, so D M costs little more than M itself.
fn estimated(propagation: &Propagation, rest: &Rest, lower: Option<DMatrix<f64>>, z: &DVector<f64>) -> Estimated {
    let positions = propagation.fit.whitening.len();
    let estimates = Estimates::new(propagation.setup, &propagation.data.repeats);
    if estimates.degrees_of_freedom.is_empty() {
        return Estimated::default();
    }
    let v = absorbed(propagation, rest, lower);
    let rows = v.ncols();
    let one = |row, column| if row == column { 1.0 } else { 0.0 };
    let mut m = DMatrix::zeros(rows, rows);
    for column in 0..rows {
        for row in 0..=column {
            let left = one(row, column) - v.column(row).dot(&v.column(column));
            m[(row, column)] = left;
            m[(column, row)] = left;
        }
    }
    let of_estimates = parts_of_estimates(propagation, &estimates);
    let mut parts = Vec::with_capacity(of_estimates.len());
    for (estimate, (own, common)) in of_estimates.iter().enumerate() {
        let mut product = m.clone();
        for (place, block) in own.iter().enumerate() {
            multiply_rows(&mut product, place, block);
        }
        // Differences of visits, the last rows, have unit covariance.
        if estimates.visits != Basis::Estimate(estimate) {
            product.rows_range_mut(2 * positions..).fill(0.0);
        }
        if common.ncols() > 0 {
            product += propagation::product(common, &common.tr_mul(&m));
        }
        let square = (0..rows).map(|row| product.row(row).tr_dot(&product.column(row))).sum();
        let degrees_of_freedom = estimates.degrees_of_freedom[estimate];
        parts.push(Part { degrees_of_freedom, trace: product.trace(), square });
    }
    let of_visits = |estimate: usize| Some((estimate, terms(rest, &of_estimates[estimate].0, z)?));
    Estimated { parts, visits: estimates.of_visits().and_then(of_visits) }
}

/// Returns the terms of chi-square by the variance of visits, whose whitened part is D, `own` for the positions and 1 for
/// the differences; `None` if a covariance is not finite.
///
/// With L L' = 1 + B B' the covariance of L⁻¹ z is 1. If the variance is multiplied by 1 + a, it gains a L⁻¹ Q₂'D Q₂ L'⁻¹,
/// whose eigenvectors make a sum of chi-square.
fn terms(Rest { q2, common }: &Rest, own: &[Matrix2<f64>], z: &DVector<f64>) -> Option<Vec<Term>> {
    let lower = plus_one(covariance(common)).cholesky()?.unpack();
    let q2 = lower.solve_lower_triangular(q2)?.transpose();
    let mut product = q2.clone();
    for (place, block) in own.iter().enumerate() {
        multiply_rows(&mut product, place, block);
    }
    let eigen = q2.tr_mul(&product).symmetric_eigen();
    let each = eigen.eigenvectors.tr_mul(&lower.solve_lower_triangular(z)?);
    let terms = each.iter().zip(eigen.eigenvalues.iter());
    Some(terms.map(|(each, share)| Term { square: each * each, share: share.max(0.0) }).collect())
}

/// Returns V' of [`estimated`].
fn absorbed(propagation: &Propagation, Rest { q2, common }: &Rest, lower: Option<DMatrix<f64>>) -> DMatrix<f64> {
    let by_parameters = propagation.absorbed();
    let by_common = common.tr_mul(q2);
    let by_common = lower.and_then(|lower| lower.solve_lower_triangular(&by_common)).unwrap_or(by_common);
    let columns = by_parameters.nrows();
    let mut v = by_parameters.resize_vertically(columns + by_common.nrows(), 0.0);
    v.rows_range_mut(columns..).copy_from(&by_common);
    v
}

/// Returns the whitened parts of the covariance that rest on each estimate: the own part of each position, 2×2, and the errors
/// for one standard uncertainty of each input common to all positions (rows × inputs).
fn parts_of_estimates(propagation: &Propagation, estimates: &Estimates) -> Vec<(Vec<Matrix2<f64>>, DMatrix<f64>)> {
    let Propagation { setup, data, fit, .. } = propagation;
    let (sensitivity, positions) = (propagation.sensitivity(), &setup.coefficients().positions);
    let whitened =
        |place: usize, cause, u: f64| fit.whitening[place] * sensitivity.to(place, &fit.currents_ma[place], cause) * u;
    let none = (vec![Matrix2::zeros(); positions.len()], DMatrix::zeros(fit.model.rows, 0));
    let mut parts = vec![none; estimates.degrees_of_freedom.len()];
    // The scatter of K between turn-ons is taken as known.
    let inputs = table(setup, &data.repeats, estimates).into_iter();
    let inputs = inputs.filter(|(cause, u, _)| *u > 0.0 && !matches!(cause, Cause::Scale(_)));
    for (cause, u, basis) in inputs {
        let own = cause.position().and_then(|index| positions.iter().position(|at| at.index == index));
        for (estimate, share) in basis.shares() {
            let (of_positions, common) = &mut parts[estimate];
            if let Some(place) = own {
                let change = whitened(place, cause, u);
                of_positions[place] += change * change.transpose() * share;
                continue;
            }
            let last = common.ncols();
            *common = std::mem::take(common).insert_column(last, 0.0);
            for place in 0..positions.len() {
                common.fixed_view_mut::<2, 1>(2 * place, last).copy_from(&whitened(place, cause, u));
            }
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With 8 degrees of freedom the probability of more than 8 is e⁻⁴ (1 + 4 + 4²/2 + 4³/6) = 0.43347.
    #[test]
    fn a_probability_changed_by_estimates_is_told_from_that_of_chi_square() {
        let of = |probability, of_uncertainties| {
            ChiSquare { value: 8.0, degrees_of_freedom: 8, probability, of_uncertainties }.is_changed_by_estimates()
        };
        assert!(!of(0.433_47, f64::INFINITY) && !of(0.4370, 7402.0));
        assert!(of(0.4400, 7402.0) && of(0.4270, 7402.0));
        // Few degrees of freedom are stated themselves.
        assert!(!of(0.4400, 999.0));
    }
}
