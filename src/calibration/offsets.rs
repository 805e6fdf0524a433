//! Drift that changes during a run: the bias of each turn-on of the gyro (cycle), and a linear drift in time.
//!
//! In visit v the gyro drifts by ω_0 + Σ a_v x, where a_v are known numbers (one for each turn-on but the last, so that
//! the turn-ons have mean zero, and the time since the mean time) and x is unknown, two components each. The mean of the
//! visits to a position contains the mean of their a_v. Differences between its visits contain nothing but x and the
//! errors of visits, because everything else is the same. What they say of x is condensed into at most as many rows as x
//! has components, and the rest is the scatter of visits.

use super::readings::{PositionReadings, Readings, Visit};
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

/// Seconds in an hour.
const SECONDS_PER_HOUR: f64 = 3600.0;

/// Eigenvalue, relative to the largest, below which differences of visits do not determine a combination of x.
const UNDETERMINED: f64 = 1e-12;

/// Mean of a_v below which visits to a position are balanced.
const BALANCED: f64 = 1e-12;

/// Numbers a_v of all visits, and what differences between visits say of x.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Offsets {
    /// Turn-ons in ascending order; empty if there is only one.
    pub(crate) cycles: Vec<u32>,
    /// `true` if a linear drift is fitted.
    pub(crate) drift: bool,
    /// Mean time of all readings, s.
    mean_time_s: f64,
    /// For each position: mean of a_v over its visits.
    pub(crate) means: Vec<Vec<f64>>,
    /// Rows for x from the differences of visits, with unit covariance, and their right-hand side.
    pub(crate) rows: DMatrix<f64>,
    pub(crate) right: DVector<f64>,
}

/// Evaluation of the differences between the visits to each position.
pub(crate) struct Differences {
    /// Rows for x, with unit covariance, and their right-hand side.
    rows: DMatrix<f64>,
    right: DVector<f64>,
    /// Sum of squares that no x explains, in units of the covariance of visits.
    pub(crate) chi_square: f64,
    pub(crate) degrees_of_freedom: usize,
}

impl Offsets {
    /// Creates the offsets of readings; differences of visits are added by [`Self::with`].
    pub(crate) fn new(readings: &Readings, drift: bool) -> Self {
        let cycles = readings.cycles();
        let cycles = if cycles.len() > 1 { cycles } else { Vec::new() };
        let mean_time_s = readings.mean_time_s().unwrap_or(0.0);
        let mut offsets = Self { cycles, drift, mean_time_s, ..Self::default() };
        if offsets.terms() > 0 {
            offsets.rows = DMatrix::zeros(0, offsets.columns());
            offsets.means = readings.positions().iter().map(|at| offsets.mean(at)).collect();
        }
        offsets
    }

    /// Returns the number of elements of a_v; x has two components for each.
    pub(crate) fn terms(&self) -> usize {
        self.cycles.len().saturating_sub(1) + usize::from(self.drift)
    }

    /// Returns the number of columns of x.
    pub(crate) fn columns(&self) -> usize {
        2 * self.terms()
    }

    /// Returns `true` if x changes the mean of no position, so that the means are those of one constant ω_0.
    pub(crate) fn are_balanced(&self) -> bool {
        self.means.iter().flatten().all(|mean| mean.abs() < BALANCED)
    }

    /// Returns a_v.
    fn of_visit(&self, visit: &Visit) -> Vec<f64> {
        let mut terms = vec![0.0; self.terms()];
        if let Some((last, others)) = self.cycles.split_last() {
            for (term, cycle) in terms.iter_mut().zip(others) {
                *term = if visit.cycle == *last { -1.0 } else { f64::from(u8::from(visit.cycle == *cycle)) };
            }
        }
        if self.drift
            && let Some(term) = terms.last_mut()
        {
            *term = (visit.time_s.unwrap_or(self.mean_time_s) - self.mean_time_s) / SECONDS_PER_HOUR;
        }
        terms
    }

    fn mean(&self, at: &PositionReadings) -> Vec<f64> {
        let mut mean = vec![0.0; self.terms()];
        for visit in &at.visits {
            for (mean, term) in mean.iter_mut().zip(self.of_visit(visit)) {
                *mean += term * at.visit_share();
            }
        }
        mean
    }

    /// Returns Σ a x for the mean of the visits to a position, °/h.
    pub(crate) fn of_mean(&self, place: usize, x: &[f64]) -> Vector2<f64> {
        let terms = self.means.get(place).into_iter().flatten().zip(x.chunks_exact(2));
        terms.fold(Vector2::zeros(), |sum, (a, x)| sum + Vector2::new(x[0], x[1]) * *a)
    }

    /// Writes the columns of x into the rows of all positions and adds the rows from differences, from column `first` on.
    pub(crate) fn write(&self, design: &mut DMatrix<f64>, first: usize) {
        for (place, means) in self.means.iter().enumerate() {
            for (term, a) in means.iter().enumerate() {
                design[(2 * place, first + 2 * term)] = *a;
                design[(2 * place + 1, first + 2 * term + 1)] = *a;
            }
        }
        let top = 2 * self.means.len();
        design.view_mut((top, first), self.rows.shape()).copy_from(&self.rows);
    }

    /// Returns the biases of the turn-ons, °/h, in the order of [`Self::cycles`], as a linear map of x: one row of
    /// coefficients for each turn-on, the same for both axes.
    pub(crate) fn turn_ons(&self) -> DMatrix<f64> {
        let count = self.cycles.len();
        DMatrix::from_fn(count, count.saturating_sub(1), |row, column| match row {
            _ if row + 1 == count => -1.0,
            _ => f64::from(u8::from(row == column)),
        })
    }

    /// Takes over what differences between visits say of x; returns `false` if they said the same before.
    pub(crate) fn with(&mut self, differences: &Differences) -> bool {
        let changed = (&self.rows, &self.right) != (&differences.rows, &differences.right);
        (self.rows, self.right) = (differences.rows.clone(), differences.right.clone());
        changed
    }

    /// Evaluates the differences between visits; `k` is K, and `covariance` returns the covariance of the errors of a
    /// visit (°/h)², 2×2, by the indices of position and visit.
    ///
    /// Returns `None` if no position has two visits, or a covariance has no inverse.
    pub(crate) fn differences(
        &self,
        readings: &Readings,
        k: &Matrix2<f64>,
        covariance: impl Fn(usize, usize) -> Matrix2<f64>,
    ) -> Option<Differences> {
        let columns = self.columns();
        let (mut normal, mut right) = (DMatrix::zeros(columns, columns), DVector::zeros(columns));
        let (mut squares, mut differences) = (0.0, 0);
        for (place, at) in readings.positions().iter().enumerate().filter(|(_, at)| at.visits.len() > 1) {
            differences += 2 * (at.visits.len() - 1);
            // Mean of the visits with their weights, for the misclosure (last column) and each column of x.
            let mut weight = Matrix2::zeros();
            let mut sum = DMatrix::zeros(2, columns + 1);
            let mut each = Vec::with_capacity(at.visits.len());
            for (number, visit) in at.visits.iter().enumerate() {
                let own = covariance(place, number).try_inverse()?;
                let mut row = DMatrix::zeros(2, columns + 1);
                for (term, a) in self.of_visit(visit).into_iter().enumerate() {
                    row[(0, 2 * term)] = a;
                    row[(1, 2 * term + 1)] = a;
                }
                row.column_mut(columns).copy_from(&(k * (at.mean_ma - visit.mean_ma)));
                weight += own;
                sum += own * &row;
                each.push((own, row));
            }
            let mean = weight.try_inverse()? * sum;
            for (own, row) in &each {
                let row = row - &mean;
                let weighted = own * &row;
                let all = row.transpose() * weighted;
                normal += all.view((0, 0), (columns, columns));
                right += all.view((0, columns), (columns, 1));
                squares += all[(columns, columns)];
            }
        }
        (differences > 0).then(|| condensed(normal, &right, squares, differences))
    }
}

/// Condenses normal equations into rows of unit covariance; combinations that they do not determine have none.
fn condensed(normal: DMatrix<f64>, right: &DVector<f64>, squares: f64, differences: usize) -> Differences {
    let columns = normal.nrows();
    if columns == 0 {
        let (rows, right) = (DMatrix::zeros(0, 0), DVector::zeros(0));
        return Differences { rows, right, chi_square: squares, degrees_of_freedom: differences };
    }
    let eigen = normal.symmetric_eigen();
    let largest = eigen.eigenvalues.max();
    let known: Vec<usize> =
        (0..columns).filter(|place| eigen.eigenvalues[*place] > UNDETERMINED * largest.max(0.0)).collect();
    let root = |row: usize| eigen.eigenvalues[known[row]].sqrt();
    let rows =
        DMatrix::from_fn(known.len(), columns, |row, column| root(row) * eigen.eigenvectors[(column, known[row])]);
    let right = DVector::from_fn(known.len(), |row, _| eigen.eigenvectors.column(known[row]).dot(right) / root(row));
    let chi_square = (squares - right.norm_squared()).max(0.0);
    Differences { rows, right, chi_square, degrees_of_freedom: differences - known.len() }
}
