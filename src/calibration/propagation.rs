//! First-order propagation: from the uncertainties of all inputs to the covariance of misclosures, parameters and
//! residuals.
//!
//! The covariance of the misclosures is F F'. Each column of F contains the errors that one independent cause makes
//! with one standard uncertainty: first the own part of each position (two columns per position), then the common part.
//! A method is a linear map L from misclosures to parameters. The covariance of the parameters is (L F)(L F)', and that
//! of the residuals is (F − X L F)(F − X L F)'.

use super::analytic::AnalyticMap;
use super::data::Data;
use super::inputs::Setup;
use super::least_squares::{Fit, multiply_rows};
use super::sensitivity::Sensitivity;
use nalgebra::{DMatrix, DMatrixView, Matrix2, Vector2};

/// Causes of error at a fit, and their propagation by the fit.
#[derive(Debug, Clone)]
pub(crate) struct Propagation<'a> {
    pub(crate) setup: &'a Setup,
    pub(crate) data: &'a Data,
    pub(crate) fit: &'a Fit,
    /// X: unwhitened design matrix (rows, two per position × parameters).
    pub(crate) design: DMatrix<f64>,
    /// F: errors of the misclosures (rows × causes), °/h.
    pub(crate) causes: DMatrix<f64>,
    /// Q'W F (rows × causes): the upper rows belong to the parameters, the lower rows to the residuals.
    rotated: DMatrix<f64>,
}

/// Equations of the residuals: the combinations of the whitened misclosures that do not depend on the parameters.
pub(crate) struct Rest {
    /// Q₂', which takes these combinations from the whitened misclosures (degrees of freedom × rows).
    pub(crate) q2: DMatrix<f64>,
    /// B, Q₂'W times the common part of all positions (degrees of freedom × common causes).
    pub(crate) common: DMatrix<f64>,
}

impl<'a> Propagation<'a> {
    /// Propagates the uncertainties of `setup` and of `data` at their `fit`.
    pub(crate) fn new(setup: &'a Setup, data: &'a Data, fit: &'a Fit) -> Self {
        let rows = fit.model.rows;
        let shared = Sensitivity::new(setup, &fit.unknowns).shared(&fit.currents_ma, &data.repeats);
        // Differences of visits, the last rows, contain nothing that is common to all positions.
        let mut shared = shared.resize_vertically(rows, 0.0);
        let mut causes = DMatrix::zeros(rows, rows + shared.ncols());
        causes.columns_mut(rows, shared.ncols()).copy_from(&shared);
        // W C W' = 1, so the own part of F is W⁻¹, and becomes the identity when whitened.
        causes.view_mut((0, 0), (rows, rows)).fill_diagonal(1.0);
        let mut rotated = DMatrix::identity(rows, rows + shared.ncols());
        for (place, whiten) in fit.whitening.iter().enumerate() {
            let own = Matrix2::new(1.0 / whiten.m11, 0.0, -whiten.m21 / (whiten.m11 * whiten.m22), 1.0 / whiten.m22);
            causes.fixed_view_mut::<2, 2>(2 * place, 2 * place).copy_from(&own);
            multiply_rows(&mut shared, place, whiten);
        }
        rotated.columns_mut(rows, shared.ncols()).copy_from(&shared);
        fit.model.rotate(&mut rotated);
        Self { setup, data, fit, design: fit.design(&data.offsets), causes, rotated }
    }

    pub(crate) fn sensitivity(&self) -> Sensitivity<'a> {
        Sensitivity::new(self.setup, &self.fit.unknowns)
    }

    /// Returns Q₁' (parameters × rows), which takes from whitened misclosures what the parameters absorb.
    pub(crate) fn absorbed(&self) -> DMatrix<f64> {
        owned(&self.rotated.view((0, 0), (self.fit.model.columns, self.fit.model.rows)))
    }

    pub(crate) fn rest(&self) -> Rest {
        let (rows, columns) = (self.fit.model.rows, self.fit.model.columns);
        let [q2, common] = [self.rotated.view_range(columns.., ..rows), self.rotated.view_range(columns.., rows..)];
        Rest { q2: owned(&q2), common: owned(&common) }
    }

    /// Returns L F of least squares: the change of each parameter for one standard uncertainty of each cause
    /// (parameters × causes).
    pub(crate) fn least_squares(&self) -> DMatrix<f64> {
        self.of_parameters(&self.rotated)
    }

    /// Returns L of least squares: the change of each parameter per misclosure (parameters × misclosures).
    pub(crate) fn response_of_least_squares(&self) -> DMatrix<f64> {
        let rows = self.fit.model.rows;
        let mut rotated = DMatrix::identity(rows, rows);
        for (place, whiten) in self.fit.whitening.iter().enumerate() {
            multiply_rows(&mut rotated, place, whiten);
        }
        self.fit.model.rotate(&mut rotated);
        self.of_parameters(&rotated)
    }

    /// Returns R⁻¹ times the upper rows of a rotated matrix.
    fn of_parameters(&self, rotated: &DMatrix<f64>) -> DMatrix<f64> {
        product(&self.fit.model.r_inverse, &owned(&rotated.view_range(..self.fit.model.columns, ..)))
    }

    /// Returns L M of the analytic method for columns M of misclosures, such as [`Self::causes`]: the changes of the eight
    /// parameters (8 × columns), and of the four elements of ω_n by rows (4 × columns).
    pub(crate) fn analytic(&self, map: &AnalyticMap, misclosures: &DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
        let columns = misclosures.ncols();
        let (mut spread, mut omega_n) = (DMatrix::zeros(8, columns), DMatrix::zeros(4, columns));
        let mut each = vec![Vector2::zeros(); self.fit.whitening.len()];
        for (place, column) in misclosures.column_iter().enumerate() {
            for (place, misclosure) in each.iter_mut().enumerate() {
                *misclosure = Vector2::new(column[2 * place], column[2 * place + 1]);
            }
            let change = map.apply(&each);
            spread.column_mut(place).copy_from_slice(&change.parameters.to_vector());
            let w = change.omega_n_deg_per_h_per_g;
            omega_n.column_mut(place).copy_from_slice(&[w.m11, w.m12, w.m21, w.m22]);
        }
        (spread, omega_n)
    }

    /// Returns the standard deviations of the residuals, °/h, of a method with the given L F, in the order of the rows.
    pub(crate) fn of_residuals(&self, spread: &DMatrix<f64>) -> Vec<f64> {
        let mut residual = self.causes.clone();
        for (cause, mut column) in residual.column_iter_mut().enumerate() {
            // The paper's methods have no offsets; they are asked only where these do not change the mean of a position.
            for parameter in 0..spread.nrows() {
                column.axpy(-spread[(parameter, cause)], &self.design.column(parameter), 1.0);
            }
        }
        standard_deviations(&residual)
    }
}

/// Copies a view, faster than its own `into_owned`.
fn owned(view: &DMatrixView<f64>) -> DMatrix<f64> {
    let mut copy = DMatrix::zeros(view.nrows(), view.ncols());
    copy.copy_from(view);
    copy
}

/// Returns A B, with sums in a fixed order, so that the result does not depend on the CPU.
pub(crate) fn product(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let mut product = DMatrix::zeros(a.nrows(), b.ncols());
    for (column, right) in b.column_iter().enumerate() {
        for (inner, value) in right.iter().enumerate() {
            if *value != 0.0 {
                product.column_mut(column).axpy(*value, &a.column(inner), 1.0);
            }
        }
    }
    product
}

/// Returns the covariance S S' of a spread S (parameters × causes).
pub(crate) fn covariance(spread: &DMatrix<f64>) -> DMatrix<f64> {
    let size = spread.nrows();
    let mut covariance = DMatrix::zeros(size, size);
    // The order of summation is fixed, so that results do not depend on the CPU.
    for cause in spread.column_iter() {
        for column in 0..size {
            covariance.column_mut(column).axpy(cause[column], &cause, 1.0);
        }
    }
    covariance
}

/// Returns the square roots of the diagonal of S S', where S is `spread`.
pub(crate) fn standard_deviations(spread: &DMatrix<f64>) -> Vec<f64> {
    let mut squares = vec![0.0; spread.nrows()];
    for cause in spread.column_iter() {
        for (square, value) in squares.iter_mut().zip(cause.as_slice()) {
            *square += value * value;
        }
    }
    squares.into_iter().map(f64::sqrt).collect()
}
