//! Linear regression of [NIST StRD](crate::bibliography::Bibliography::NistStrd), by the project's least squares: all eleven
//! data sets. `tests/vectors/nist_strd.py` writes the data and the certified values, after it has solved each set in
//! rational numbers.

use super::Case;
use crate::calibration::propagation::covariance;
use crate::statistics::least_squares::Factorised;
use nalgebra::DMatrix;
use serde::Deserialize;

const REFERENCE: &str = include_str!("../../tests/vectors/nist_strd.json");

/// Largest relative rounding of a certified value: half a unit of its 15th digit.
const ROUNDING_OF_CERTIFIED: f64 = 5e-15;

#[derive(Deserialize)]
struct Set {
    example: &'static str,
    source: &'static str,
    /// Predictors of each row.
    x: Vec<Vec<f64>>,
    y: Vec<f64>,
    /// Predictor and its power in each column of the design.
    terms: Vec<(usize, usize)>,
    /// Certified estimates and their standard deviations, one of each for a term.
    estimates: Vec<f64>,
    deviations: Vec<f64>,
    /// Certified residual standard deviation.
    residual: f64,
}

pub(crate) fn cases() -> Vec<Case> {
    let sets: Vec<Set> = serde_json::from_str(REFERENCE).unwrap_or_default();
    sets.iter().flat_map(Set::cases).collect()
}

impl Set {
    /// Returns the cases of the set. Each tolerance is the first-order effect of the rounding errors of a stable method.
    ///
    /// Such a method gives the exact solution for a design whose columns, and a right-hand side that, differ from the given
    /// ones by γ relative to their lengths. γ is the unit roundoff times the square root of the number of elements, because
    /// rounding errors are as often positive as negative. Of a solution by the normal equations the error would be larger
    /// by the condition number.
    fn cases(&self) -> Vec<Case> {
        let (rows, columns) = (self.y.len(), self.terms.len());
        let power = |row: usize, (predictor, power): (usize, usize)| {
            std::iter::repeat_n(self.x[row][predictor], power).product::<f64>()
        };
        let design = DMatrix::from_fn(rows, columns, |row, column| power(row, self.terms[column]));
        let lengths: Vec<f64> = design.column_iter().map(|column| column.norm()).collect();
        let mut right = DMatrix::from_column_slice(rows, 1, &self.y);
        let gamma = 0.5 * f64::EPSILON * ((rows * columns) as f64).sqrt();
        let moved = gamma * (right.norm() + lengths.iter().zip(&self.estimates).map(|(a, b)| a * b.abs()).sum::<f64>());
        let Some(model) = Factorised::new(design) else { return vec![self.case("fit", 1.0, 0.0, f64::NAN)] };
        model.rotate(&mut right);
        let (estimates, _) = model.solve_rotated(&right);
        let root = ((rows - columns) as f64).sqrt();
        let residual = right.rows(columns, rows - columns).norm() / root;
        let cofactors = covariance(&model.r_inverse);
        let mut cases = Vec::new();
        for at in 0..columns {
            let spread = cofactors[(at, at)].sqrt();
            let turned = gamma * lengths.iter().enumerate().map(|(to, a)| a * cofactors[(at, to)].abs()).sum::<f64>();
            let of_estimate = spread * moved + turned * self.residual * root;
            let of_deviation = spread * moved / root + turned * self.residual;
            cases.push(self.case(&format!("B{at}"), self.estimates[at], of_estimate, estimates[at]));
            cases.push(self.case(&format!("s(B{at})"), self.deviations[at], of_deviation, residual * spread));
        }
        cases.push(self.case("residual standard deviation", self.residual, moved / root, residual));
        cases
    }

    fn case(&self, quantity: &str, expected: f64, error: f64, found: f64) -> Case {
        // Certified values have 15 digits, so no more can be compared. One that is 0 is compared with 1.
        let unit = if expected == 0.0 { 1.0 } else { expected };
        let digits = -libm::log10(((found - expected) / unit).abs());
        let digits = Some(if digits.is_nan() { 0.0 } else { digits.min(15.0) });
        let tolerance = error + expected.abs() * ROUNDING_OF_CERTIFIED;
        Case { digits, ..Case::new(self.example, self.source, quantity, [expected, tolerance, found]) }
    }
}
