//! Chi-square test of a fit: its value from all inputs, and its distribution if uncertainties rest on estimates.

use super::causes::Cause;
use super::data::Data;
use super::estimates::{Basis, Estimates};
use super::inputs::Setup;
use super::least_squares::{Fit, multiply_rows};
use super::propagation;
use super::sensitivity::Sensitivity;
use crate::statistics::scaled_f::{self, Part, ScaledF};
use nalgebra::{DMatrix, DVector, DVectorView, Matrix2};

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
}

/// Returns chi-square of readings at a fit.
///
/// It is r' C⁻ r, where r are the residuals of a method, C is their covariance from all inputs, and C⁻ is any
/// generalised inverse. The part that the parameters absorb cancels. Chi-square is therefore the same for every method
/// that fits exact readings exactly. It is computed from z = Q₂'W e, whose covariance 1 + B B' has full rank (B is Q₂'W
/// times the common part of all positions).
pub(crate) fn chi_square(setup: &Setup, fit: &Fit, data: &Data) -> ChiSquare {
    let degrees_of_freedom = fit.model.rows - fit.model.columns;
    if degrees_of_freedom == 0 {
        // With as many readings as unknowns, the residuals are only rounding.
        return ChiSquare { value: 0.0, degrees_of_freedom, probability: 1.0, of_uncertainties: f64::INFINITY };
    }
    let (value, Estimated { parts, visits }) = quadratic_form(setup, fit, data);
    let with =
        |factor: f64| visits.iter().flat_map(|(_, terms)| terms).fold(value, |sum, term| sum - term.taken(factor));
    let of_visits = visits.as_ref().map(|(estimate, _)| *estimate);
    let probability = scaled_f::larger(degrees_of_freedom, &parts, of_visits, with);
    let of_uncertainties = ScaledF::new(degrees_of_freedom, &parts).denominator;
    ChiSquare { value, degrees_of_freedom, probability, of_uncertainties }
}

/// Parts of the covariance of the residuals that rest on estimates with few degrees of freedom.
#[derive(Debug, Default)]
pub(crate) struct Estimated {
    pub(crate) parts: Vec<Part>,
    /// Index of the estimate of the scatter of visits, and how chi-square changes with it.
    pub(crate) visits: Option<(usize, Vec<Term>)>,
}

/// Term of the change of chi-square if the variance of visits is multiplied by a factor.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Term {
    /// Share of this variance in the variance of a combination of the residuals.
    share: f64,
    /// Square of the derivative of that combination.
    square: f64,
}

impl Term {
    /// Returns what `factor` takes from chi-square.
    pub(crate) fn taken(&self, factor: f64) -> f64 {
        let more = factor - 1.0;
        self.square * more / (1.0 + self.share * more)
    }
}

/// Returns the value of chi-square, and the parts of the covariance that rest on estimates.
pub(crate) fn quadratic_form(setup: &Setup, fit: &Fit, data: &Data) -> (f64, Estimated) {
    let shared = Sensitivity::new(setup, &fit.unknowns).shared(&fit.currents_ma, &data.repeats);
    let count = shared.ncols();
    // The misclosures follow the common part as one more column, so that a single rotation transforms both.
    let mut rotated = shared.resize(fit.model.rows, count + 1, 0.0);
    let top = 2 * fit.whitening.len();
    rotated.view_mut((top, count), (fit.model.rows - top, 1)).copy_from(&fit.of_differences(&data.offsets));
    for (place, (current, whiten)) in data.currents_ma.iter().zip(&fit.whitening).enumerate() {
        let misclosure = fit.misclosure(place, current);
        rotated[(2 * place, count)] = misclosure.x;
        rotated[(2 * place + 1, count)] = misclosure.y;
        multiply_rows(&mut rotated, place, whiten);
    }
    let whitened = rotated.clone();
    fit.model.rotate(&mut rotated);
    let rest = rotated.rows_range(fit.model.columns..);
    // Woodbury: z' (1 + B B')⁻¹ z = z'z − (B'z)' (1 + B'B)⁻¹ (B'z).
    let z = rest.column(count);
    let projected = DVector::from_fn(count, |i, _| rest.column(i).dot(&z));
    let inner =
        DMatrix::from_fn(count, count, |i, j| rest.column(i).dot(&rest.column(j)) + if i == j { 1.0 } else { 0.0 });
    let cholesky = inner.cholesky();
    let taken = cholesky.as_ref().map_or(0.0, |cholesky| projected.dot(&cholesky.solve(&projected)));
    let lower = cholesky.map(|cholesky| cholesky.unpack());
    let shared = whitened.columns(0, count).into_owned();
    (z.norm_squared() - taken, estimated(setup, fit, data, &shared, lower, whitened.column(count)))
}

/// Returns the parts of the covariance of the residuals that rest on estimates with few degrees of freedom. `shared` is
/// the whitened common part of all positions, `lower` is L with L L' = 1 + B'B, and `y` are the whitened misclosures.
///
/// χ² is y' M y of the whitened misclosures y, with M = 1 − V V'. V consists of Q₁ and Q₂ B L'⁻¹ side by side; Q₁ = W X
/// R⁻¹ is the part that the parameters absorb. A part D of the covariance of y enters through tr D M and tr D M D M. Own
/// parts of positions are blocks of D, so D M costs little more than M itself.
fn estimated(
    setup: &Setup,
    fit: &Fit,
    data: &Data,
    shared: &DMatrix<f64>,
    lower: Option<DMatrix<f64>>,
    y: DVectorView<f64>,
) -> Estimated {
    let estimates = Estimates::new(setup, &data.repeats);
    if estimates.degrees_of_freedom.is_empty() {
        return Estimated::default();
    }
    let v = absorbed(fit, data, shared, lower);
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
    let own = own_parts(setup, fit, data, &estimates);
    let common = common_parts(setup, fit, data, &estimates);
    let mut parts = Vec::with_capacity(own.len());
    for (estimate, (own, common)) in own.iter().zip(&common).enumerate() {
        let mut product = m.clone();
        for (place, block) in own.iter().enumerate() {
            multiply_rows(&mut product, place, block);
        }
        // Differences of visits, the last rows, have unit covariance.
        if estimates.visits != Basis::Estimate(estimate) {
            product.rows_range_mut(2 * fit.whitening.len()..).fill(0.0);
        }
        if common.ncols() > 0 {
            product += propagation::product(common, &common.tr_mul(&m));
        }
        let square = (0..rows).map(|row| product.row(row).tr_dot(&product.column(row))).sum();
        let degrees_of_freedom = estimates.degrees_of_freedom[estimate];
        parts.push(Part { degrees_of_freedom, trace: product.trace(), square });
    }
    let visits = estimates.of_visits().map(|estimate| (estimate, terms(m, &own[estimate], y)));
    Estimated { parts, visits }
}

/// Returns how chi-square changes with the variance of visits, whose whitened part is D = G G', `own` for the positions and
/// 1 for the differences.
///
/// If this variance is multiplied by 1 + a, the covariance of y gains a D. By Woodbury, χ² = y' M y then loses
/// a g' (1 + a G'M G)⁻¹ g, where g = G'M y. The eigenvectors of G'M G make a sum of this.
fn terms(mut m: DMatrix<f64>, own: &[Matrix2<f64>], y: DVectorView<f64>) -> Vec<Term> {
    let mut g = &m * y;
    let roots: Vec<Matrix2<f64>> = own.iter().map(|block| root(*block)).collect();
    for _ in 0..2 {
        for (place, root) in roots.iter().enumerate() {
            multiply_rows(&mut m, place, root);
        }
        m.transpose_mut();
    }
    for (place, root) in roots.iter().enumerate() {
        let rows = root * g.fixed_rows::<2>(2 * place);
        g.fixed_rows_mut::<2>(2 * place).copy_from(&rows);
    }
    let eigen = m.symmetric_eigen();
    let squares = eigen.eigenvectors.tr_mul(&g);
    let each = eigen.eigenvalues.iter().zip(squares.iter());
    each.map(|(share, g)| Term { share: share.max(0.0), square: g * g }).collect()
}

fn root(covariance: Matrix2<f64>) -> Matrix2<f64> {
    let eigen = covariance.symmetric_eigen();
    let roots = Matrix2::from_diagonal(&eigen.eigenvalues.map(|value| value.max(0.0).sqrt()));
    eigen.eigenvectors * roots * eigen.eigenvectors.transpose()
}

/// Returns V' of [`estimated`].
fn absorbed(fit: &Fit, data: &Data, shared: &DMatrix<f64>, lower: Option<DMatrix<f64>>) -> DMatrix<f64> {
    let mut taken = fit.design(&data.offsets);
    for (place, whiten) in fit.whitening.iter().enumerate() {
        multiply_rows(&mut taken, place, whiten);
    }
    taken = propagation::product(&taken, &fit.model.r_inverse);
    let mut inner = shared - propagation::product(&taken, &taken.tr_mul(shared));
    if let Some(inverse) = lower.and_then(|lower| lower.try_inverse()) {
        inner = propagation::product(&inner, &inverse.transpose());
    }
    let columns = taken.ncols();
    let mut v = taken.resize_horizontally(columns + inner.ncols(), 0.0);
    v.columns_mut(columns, inner.ncols()).copy_from(&inner);
    v.transpose()
}

/// Returns the whitened own part of each position that rests on each estimate, 2×2.
fn own_parts(setup: &Setup, fit: &Fit, data: &Data, estimates: &Estimates) -> Vec<Vec<Matrix2<f64>>> {
    let (repeats, positions) = (&data.repeats, fit.whitening.len());
    let sensitivity = Sensitivity::new(setup, &fit.unknowns);
    let k = sensitivity.k_deg_per_h_per_ma();
    let noise = k * k.transpose();
    let mut parts = vec![vec![Matrix2::zeros(); positions]; estimates.degrees_of_freedom.len()];
    for (place, whiten) in fit.whitening.iter().enumerate() {
        let mut add = |basis: Basis, covariance: &dyn Fn() -> Matrix2<f64>| {
            for (estimate, share) in basis.shares() {
                parts[estimate][place] += whiten * covariance() * whiten.transpose() * share;
            }
        };
        for (basis, change) in estimates.angles[place].into_iter().zip(sensitivity.to_certified_angles(place)) {
            add(basis, &|| change * change.transpose());
        }
        add(estimates.returns, &|| sensitivity.of_return(place) * repeats.return_share(place));
        add(estimates.noise, &|| noise * repeats.noise_variance_ma2(place));
        add(estimates.visits, &|| Matrix2::from_diagonal_element(repeats.drift_variance(place)));
    }
    parts
}

/// Returns the whitened errors for one standard uncertainty of each input common to all positions that rests on each
/// estimate (rows × inputs).
fn common_parts(setup: &Setup, fit: &Fit, data: &Data, estimates: &Estimates) -> Vec<DMatrix<f64>> {
    let u = setup.uncertainty();
    let sensitivity = Sensitivity::new(setup, &fit.unknowns);
    let turn_on = data.repeats.turn_on_of_mean_deg_per_h();
    let inputs: [(Basis, f64, Vec<Cause>); 3] = [
        (estimates.platform, u.common_platform_rad, [0, 1, 2].map(Cause::Platform).into()),
        (estimates.base, u.common_base_rad, [0, 1, 2].map(Cause::Base).into()),
        (estimates.turn_ons, turn_on, [0, 1].map(Cause::TurnOn).into()),
    ];
    let of_estimate = |estimate| match inputs.iter().find(|(basis, ..)| *basis == Basis::Estimate(estimate)) {
        None => DMatrix::zeros(fit.model.rows, 0),
        Some((_, u, causes)) => {
            let mut columns = DMatrix::zeros(fit.model.rows, causes.len());
            for (place, (whiten, current_ma)) in fit.whitening.iter().zip(&fit.currents_ma).enumerate() {
                for (column, cause) in causes.iter().enumerate() {
                    let change = whiten * sensitivity.to(place, current_ma, *cause) * *u;
                    columns.fixed_view_mut::<2, 1>(2 * place, column).copy_from(&change);
                }
            }
            columns
        }
    };
    (0..estimates.degrees_of_freedom.len()).map(of_estimate).collect()
}
