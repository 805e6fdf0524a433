//! Linear model y = X p + e whose errors e have unit covariance (whitened), solved through X = Q R.
//!
//! The normal equations, which square the condition, are never formed. The first rows of Q'y determine p; the others
//! are the part of y that no p can explain. Rank and condition come from the singular values of X.

use nalgebra::{DMatrix, DVector, Dyn, Matrix2, QR, SVD};

/// Factorisation X = Q R.
#[derive(Debug, Clone)]
pub(crate) struct Factorised {
    qr: QR<f64, Dyn, Dyn>,
    /// R⁻¹, columns × columns: R⁻¹ times the first rows of a rotated right-hand side gives its parameters.
    pub(crate) r_inverse: DMatrix<f64>,
    /// Frobenius norm of X, which is that of R.
    norm: f64,
    pub(crate) rows: usize,
    pub(crate) columns: usize,
}

impl Factorised {
    /// Factorises X, rows × columns. Returns `None` if there are fewer rows than columns, or R has no inverse in binary64.
    /// Near-singularity is a separate test: see [`condition`].
    pub(crate) fn new(design: DMatrix<f64>) -> Option<Self> {
        let (rows, columns) = design.shape();
        if rows < columns || columns == 0 || !is_finite(&design) {
            return None;
        }
        let norm = design.norm();
        let qr = QR::new(design);
        let r_inverse = inverse_of_upper(qr.clone().unpack_r());
        if !is_finite(&r_inverse) {
            return None;
        }
        Some(Self { qr, r_inverse, norm, rows, columns })
    }

    /// Replaces M (rows × any) by Q'M: its first `columns` rows determine the parameters, the others are residuals.
    pub(crate) fn rotate(&self, matrix: &mut DMatrix<f64>) {
        self.qr.q_tr_mul(matrix);
    }

    /// Returns the parameters for a right-hand side that is already rotated, and the length of Q₁'y: the distance of
    /// the parameters from zero in units of their own covariance.
    pub(crate) fn solve_rotated(&self, rotated: &DMatrix<f64>) -> (DVector<f64>, f64) {
        let mut solution = DVector::zeros(self.columns);
        let mut squared = 0.0;
        for (column, value) in rotated.column(0).iter().take(self.columns).enumerate() {
            solution.axpy(*value, &self.r_inverse.column(column), 1.0);
            squared += value * value;
        }
        (solution, squared.sqrt())
    }

    /// Returns an upper bound of the condition number of X, from the Frobenius norms of R and R⁻¹.
    pub(crate) fn condition_bound(&self) -> f64 {
        self.norm * self.r_inverse.norm()
    }
}

fn is_finite(matrix: &DMatrix<f64>) -> bool {
    matrix.as_slice().iter().all(|x| x.is_finite())
}

/// Returns the inverse of an upper triangular matrix. An element is not finite if a diagonal element is 0.
fn inverse_of_upper(mut matrix: DMatrix<f64>) -> DMatrix<f64> {
    let size = matrix.nrows();
    // The inverse of the first columns does not depend on the others, so the last column can be replaced first.
    for column in (0..size).rev() {
        let (before, own) = matrix.as_mut_slice().split_at_mut(size * column);
        let diagonal = 1.0 / own[column];
        own[..column].iter_mut().for_each(|value| *value *= -diagonal);
        own[column] = diagonal;
        for row in (0..column).rev() {
            let known = &before[size * row..][..=row];
            let solved = own[row] / known[row];
            own[row] = solved;
            own.iter_mut().zip(&known[..row]).for_each(|(value, r)| *value -= solved * r);
        }
    }
    matrix
}

/// Condition of a model, with the parameters that it mixes if it is bad.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Condition {
    /// Largest over smallest singular value; infinite if X is rank-deficient.
    pub number: f64,
    /// Singular vectors (each with as many elements as X has columns) whose singular value is below the largest by more
    /// than the limit: directions that the model does not determine.
    pub undetermined: Vec<DVector<f64>>,
}

/// Returns the condition of X, rows × columns; directions weaker than 1/`limit` of the strongest are undetermined.
///
/// The result is `None` if the singular values cannot be computed (values that are not finite).
pub(crate) fn condition(design: &DMatrix<f64>, limit: f64) -> Option<Condition> {
    if !is_finite(design) {
        return None;
    }
    // Rows of zeros do not change the singular values, but make the SVD return every direction of the parameters.
    let (rows, columns) = design.shape();
    let square =
        if rows < columns { design.clone().resize_vertically(columns, 0.0) } else { QR::new(design.clone()).r() };
    let svd = SVD::try_new(square, false, true, f64::EPSILON, 10_000)?;
    let largest = svd.singular_values.max();
    let smallest = svd.singular_values.min();
    let directions = svd.v_t.as_ref()?;
    let weak = svd.singular_values.iter().enumerate().filter(|(_, value)| **value * limit <= largest);
    let undetermined = weak.map(|(row, _)| directions.row(row).transpose()).collect();
    let number = if smallest > largest * f64::EPSILON { largest / smallest } else { f64::INFINITY };
    Some(Condition { number, undetermined })
}

/// Returns L⁻¹ for C = L L', or `None` if C is not positive definite.
pub(crate) fn whitening_of(covariance: &Matrix2<f64>) -> Option<Matrix2<f64>> {
    let lower = covariance.cholesky()?.unpack();
    let (a, b, c) = (lower.m11, lower.m21, lower.m22);
    let inverse = Matrix2::new(1.0 / a, 0.0, -b / (a * c), 1.0 / c);
    inverse.iter().all(|x| x.is_finite()).then_some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_columns_are_undetermined_together() {
        let design = DMatrix::from_row_slice(3, 3, &[1.0, 1.0, 0.0, 2.0, 2.0, 1.0, 3.0, 3.0, 0.0]);
        let found = condition(&design, 1e6).unwrap();
        assert!(found.number > 1e12);
        assert_eq!(found.undetermined.len(), 1);
        let direction = &found.undetermined[0];
        assert!((direction[0] + direction[1]).abs() < 1e-12 && direction[2].abs() < 1e-12);
        let wide = DMatrix::from_row_slice(1, 2, &[1.0, 0.0]);
        assert!(Factorised::new(wide.clone()).is_none());
        assert_eq!(condition(&wide, 1e6).unwrap().number, f64::INFINITY);
        assert!(condition(&DMatrix::from_element(2, 2, f64::NAN), 1e6).is_none());
        assert!(Factorised::new(DMatrix::from_element(2, 2, 0.0)).is_none());
    }

    /// A straight line through (0, 1), (1, 3), (2, 5), (3, 8), by hand: slope 2.3, intercept 0.8.
    #[test]
    fn a_straight_line() {
        let design = DMatrix::from_row_slice(4, 2, &[0.0, 1.0, 1.0, 1.0, 2.0, 1.0, 3.0, 1.0]);
        let model = Factorised::new(design.clone()).unwrap();
        let mut right = DMatrix::from_column_slice(4, 1, &[1.0, 3.0, 5.0, 8.0]);
        let y = right.clone();
        model.rotate(&mut right);
        let (line, _) = model.solve_rotated(&right);
        assert!((line[0] - 2.3).abs() < 1e-14 && (line[1] - 0.8).abs() < 1e-14);
        // The rotated rest has the length of the residuals: 0.2, -0.1, -0.4, 0.3.
        let rest: f64 = right.column(0).iter().skip(2).map(|x| x * x).sum();
        assert!((rest - 0.3).abs() < 1e-13);
        assert!(((y - design * line).norm_squared() - 0.3).abs() < 1e-13);
        // Variance of the slope: 1/Σ(x - 1.5)² = 0.2.
        let slope: f64 = model.r_inverse.row(0).iter().map(|x| x * x).sum();
        assert!((slope - 0.2).abs() < 1e-14);
    }
}
