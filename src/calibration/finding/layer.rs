//! Equations of the visits, less what is explained, and what the columns of a cause explain of the rest.

use crate::calibration::offsets::{VisitRow, VisitRows};
use crate::statistics::distributions::chi_square_larger;
use crate::statistics::student::f_larger;
use nalgebra::{DMatrix, DVector, Vector2};

/// Length of a column, relative to its own, below which it is a combination of others.
const ALONE: f64 = 1e-4;

/// Probability of a larger scatter from which one is as stated.
pub(super) const AS_STATED: f64 = 0.05;

/// Whitened equations of the visits, less what is explained.
pub(crate) struct Layer {
    pub(crate) rows: Vec<VisitRow>,
    /// Orthonormal directions that are explained.
    taken: Vec<DVector<f64>>,
    /// Differences between visits, less their parts along these directions.
    left: DVector<f64>,
    degrees_of_freedom: usize,
    /// Least variance of a residual in any case, and whether it is the whole variance as stated.
    least: f64,
    is_stated: bool,
}

/// Columns that a cause adds to the equations of the visits.
pub(crate) struct Columns {
    /// Length of each column.
    lengths: Vec<f64>,
    /// The columns, less their parts along the directions that are explained.
    left: DMatrix<f64>,
}

/// How much the columns of a cause explain, and how probably chance explains as much.
#[derive(Clone, Copy)]
pub(crate) struct Explains {
    /// Probability that chance explains as much by one of the causes of its kind.
    pub(crate) probability: f64,
    /// Score of the fit with the columns; the least is the best.
    pub(super) score: f64,
    /// Sum of squares that they explain.
    pub(super) squares: f64,
}

impl Layer {
    /// Returns the equations `rows` with these degrees of freedom, whose residuals have `least` as variance in any case; 1 is the
    /// whole variance as stated.
    pub(crate) fn of(VisitRows { design, rates, each }: VisitRows, degrees_of_freedom: usize, least: f64) -> Self {
        let lengths = design.column_iter().map(|column| column.norm()).collect();
        let (taken, is_stated) = (Vec::new(), least >= 1.0);
        let mut layer = Self { rows: each, taken, left: rates, degrees_of_freedom, least, is_stated };
        layer.take(&Columns { lengths, left: design });
        Self { degrees_of_freedom, ..layer }
    }

    /// Returns the columns of a cause, whitened, less their mean over the visits to each position; `each` has two rows for each
    /// visit.
    pub(crate) fn columns(&self, mut each: DMatrix<f64>) -> Columns {
        for mut column in each.column_iter_mut() {
            let mut first = 0;
            for visits in self.rows.chunk_by(|one, other| one.place == other.place) {
                let here = || visits.iter().zip((first..).step_by(2));
                let mean: Vector2<f64> = here().map(|(row, at)| row.share * column.fixed_rows::<2>(at)).sum();
                for (row, at) in here() {
                    let whitened = row.whitening * (column.fixed_rows::<2>(at) - mean);
                    column.fixed_rows_mut::<2>(at).copy_from(&whitened);
                }
                first += 2 * visits.len();
            }
        }
        let lengths = each.column_iter().map(|column| column.norm()).collect();
        let mut columns = Columns { lengths, left: each };
        self.reduce(&mut columns);
        columns
    }

    /// Takes the directions that are explained from columns.
    pub(super) fn reduce(&self, columns: &mut Columns) {
        for mut column in columns.left.column_iter_mut() {
            // Twice, because the first time leaves rounding of the size of the column.
            for taken in self.taken.iter().chain(&self.taken) {
                column.axpy(-taken.dot(&column), taken, 1.0);
            }
        }
    }

    pub(super) fn take(&mut self, columns: &Columns) {
        for direction in columns.directions() {
            self.left.axpy(-direction.dot(&self.left), &direction, 1.0);
            self.taken.push(direction);
            self.degrees_of_freedom = self.degrees_of_freedom.saturating_sub(1);
        }
    }

    /// Returns what columns of one of `count` causes explain; `None` if they explain nothing that can be compared.
    pub(crate) fn tried(&self, columns: &Columns, count: usize) -> Option<Explains> {
        let directions = columns.directions();
        let rank = directions.len();
        let rest = self.degrees_of_freedom.checked_sub(rank).filter(|rest| rank > 0 && *rest > 0)?;
        let squares: f64 = directions.iter().map(|direction| direction.dot(&self.left).powi(2)).sum();
        let others = (self.left.norm_squared() - squares).max(0.0);
        let variance = (others / rest as f64).max(self.least);
        // Of a noise that is stated, and with which the others agree, the variance is known.
        let is_known = self.is_stated && chi_square_larger(others / self.least, rest) >= AS_STATED;
        let freedom = if is_known { f64::INFINITY } else { rest as f64 };
        let probability = (count as f64 * f_larger(squares / rank as f64 / variance, rank, freedom)).min(1.0);
        let all = (rest + rank) as f64;
        let score = all * libm::log(others.max(self.least * all)) + rank as f64 * libm::log(all + 1.0);
        Some(Explains { probability, score: score + 2.0 * libm::log(count as f64), squares })
    }

    /// Returns the values of columns with which they explain most.
    pub(crate) fn values(&self, columns: &Columns) -> Vec<f64> {
        let found = columns.left.clone().svd(true, true).solve(&self.left, ALONE);
        found.map_or_else(|_| vec![0.0; columns.left.ncols()], |found| found.data.into())
    }
}

impl Columns {
    /// Returns the orthonormal directions that the columns add.
    fn directions(&self) -> Vec<DVector<f64>> {
        let mut new: Vec<DVector<f64>> = Vec::with_capacity(self.lengths.len());
        for (column, length) in self.left.column_iter().zip(&self.lengths) {
            let mut left = column.into_owned();
            for direction in new.iter().chain(&new) {
                left.axpy(-direction.dot(&left), direction, 1.0);
            }
            let norm = left.norm();
            if norm > ALONE * length {
                left /= norm;
                new.push(left);
            }
        }
        new
    }

    /// Returns `true` if no column is a combination of others.
    pub(super) fn are_independent(&self) -> bool {
        self.directions().len() == self.lengths.len()
    }
}
