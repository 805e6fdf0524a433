//! First-order propagation of uncertainty for any model that gives its gradient.
//!
//! Source: [GUM](crate::bibliography::Bibliography::Gum), eq. (13) with several results (H.9), (17), (G.2b).

use nalgebra::{DMatrix, DVector};

/// Linearisation of a model at one point: its results and their derivatives by the inputs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Linearised {
    /// Results of the model.
    pub values: DVector<f64>,
    /// Derivatives, results × inputs.
    pub gradient: DMatrix<f64>,
}

/// Results with their covariance.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Propagated {
    /// Results of the model.
    pub values: DVector<f64>,
    /// Covariance of the results, results × results.
    pub covariance: DMatrix<f64>,
}

impl Propagated {
    /// Returns the standard uncertainty of a result.
    pub(crate) fn standard_uncertainty(&self, result: usize) -> f64 {
        let variance = self.covariance[(result, result)];
        // Rounding may make a variance of zero slightly negative; NaN stays NaN.
        if variance < 0.0 { 0.0 } else { variance.sqrt() }
    }

    /// Returns the correlation coefficient of two results, or NaN if one of them is exact.
    pub(crate) fn correlation(&self, one: usize, other: usize) -> f64 {
        self.covariance[(one, other)] / (self.standard_uncertainty(one) * self.standard_uncertainty(other))
    }
}

impl Linearised {
    /// Returns the results with their covariance C_y = G C_x G' from the `covariance` C_x of the inputs.
    pub(crate) fn propagated(self, covariance: &DMatrix<f64>) -> Propagated {
        let covariance = &self.gradient * covariance * self.gradient.transpose();
        Propagated { values: self.values, covariance }
    }
}

/// Returns the means of simultaneous readings (rows: readings, columns: quantities) and the covariance of the means.
///
/// With fewer than two readings the covariance is unknown and its elements are NaN.
pub(crate) fn of_means(readings: &DMatrix<f64>) -> Propagated {
    let number = readings.nrows() as f64;
    let values = readings.row_sum().transpose() / number;
    let differences =
        DMatrix::from_fn(readings.nrows(), readings.ncols(), |row, column| readings[(row, column)] - values[column]);
    let freedom = if readings.nrows() < 2 { f64::NAN } else { number - 1.0 };
    let covariance = differences.transpose() * &differences / (number * freedom);
    Propagated { values, covariance }
}

/// Returns the effective degrees of freedom of a sum of independent contributions, each (standard uncertainty, degrees
/// of freedom), by Welch and Satterthwaite's formula; infinite if all of them are known exactly.
pub(crate) fn effective_degrees_of_freedom(contributions: &[(f64, f64)]) -> f64 {
    let variance: f64 = contributions.iter().map(|(u, _)| u * u).sum();
    let doubt: f64 = contributions.iter().map(|(u, nu)| u * u * u * u / nu).sum();
    if doubt > 0.0 { variance * variance / doubt } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: y = (x₁ x₂, x₁ + x₂) at (2, 3), u = (0.1, 0.2), r = 0.5: u²(y₁) = 0.09 + 0.16 + 0.12.
    #[test]
    fn a_product_and_a_sum() {
        let model = Linearised {
            values: DVector::from_vec(vec![2.0 * 3.0, 2.0 + 3.0]),
            gradient: DMatrix::from_row_slice(2, 2, &[3.0, 2.0, 1.0, 1.0]),
        };
        let covariance = DMatrix::from_row_slice(2, 2, &[0.01, 0.01, 0.01, 0.04]);
        let found = model.propagated(&covariance);
        assert!((found.standard_uncertainty(0) - 0.37_f64.sqrt()).abs() < 1e-15);
        assert!((found.standard_uncertainty(1) - 0.07_f64.sqrt()).abs() < 1e-15);
        // G C G' off the diagonal: 3 (0.01 + 0.01) + 2 (0.01 + 0.04).
        assert!((found.correlation(0, 1) - 0.16 / (0.37_f64 * 0.07).sqrt()).abs() < 1e-14);
    }

    /// By hand: means 2 and 4 of (1, 3, 2) and (2, 6, 4), twice the first: correlation 1.
    #[test]
    fn means_of_readings() {
        let found = of_means(&DMatrix::from_row_slice(3, 2, &[1.0, 2.0, 3.0, 6.0, 2.0, 4.0]));
        assert_eq!((found.values[0], found.values[1]), (2.0, 4.0));
        assert!((found.standard_uncertainty(0) - (1.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert!((found.correlation(0, 1) - 1.0).abs() < 1e-15);
        assert!(of_means(&DMatrix::from_element(1, 1, 1.0)).standard_uncertainty(0).is_nan());
    }

    /// Equal contributions with equal degrees of freedom add them up; one that is exact adds none of its own.
    #[test]
    fn degrees_of_freedom_add() {
        assert!((effective_degrees_of_freedom(&[(1.0, 4.0), (1.0, 4.0)]) - 8.0).abs() < 1e-15);
        assert!((effective_degrees_of_freedom(&[(1.0, 4.0), (1.0, f64::INFINITY)]) - 16.0).abs() < 1e-15);
        assert_eq!(effective_degrees_of_freedom(&[(1.0, f64::INFINITY)]), f64::INFINITY);
    }
}
