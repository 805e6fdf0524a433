//! Criteria by which plans are compared: one number from the information of all visits, smaller is better.
//!
//! All quantities are in units of the tolerances, so that parameters of different kinds can be added.

use crate::text::{word_of_a_key, words};
use nalgebra::SMatrix;

pub(crate) type Matrix8 = SMatrix<f64, 8, 8>;

/// Smallest pivot, as a share of its diagonal element, with which a matrix counts as regular.
const SMALLEST_PIVOT: f64 = 1e-11;

/// Places of ω_0x and ω_0y among the eight parameters.
const OMEGA0: [usize; 2] = [4, 5];

words! {
    /// Criterion by which plans are compared.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
    pub(crate) enum Criterion: pub(crate) key {
        /// Sum of (u/tolerance)².
        A = "a",
        /// Determinant of the covariance.
        D = "d",
        /// Largest u/tolerance.
        Worst = "worst",
    }
}

word_of_a_key!(Criterion, key, "");

impl Criterion {
    /// Returns the value for the information matrix `information` in units of the tolerances; `turn_on` is the variance
    /// that the scatter of turn-ons adds to ω_0x and ω_0y. Returns infinity if a parameter is not determined.
    pub(crate) fn value(self, information: &Matrix8, turn_on: f64) -> f64 {
        let Some(lower) = cholesky(information) else { return f64::INFINITY };
        match self {
            Self::A => variances(&lower, turn_on).iter().sum(),
            Self::Worst => variances(&lower, turn_on).into_iter().fold(0.0, f64::max).sqrt(),
            Self::D => {
                // det(M⁻¹ + v (e_4 e_4' + e_5 e_5')) = det M⁻¹ · det(1 + v M₂), with M₂ the block of ω_0.
                let [x, y] = OMEGA0;
                let block = |row: usize, column: usize| turn_on * information[(row, column)];
                let added = (1.0 + block(x, x)) * (1.0 + block(y, y)) - block(y, x) * block(y, x);
                libm::log(added) - 2.0 * (0..8).map(|place| libm::log(lower[(place, place)])).sum::<f64>()
            }
        }
    }

    /// Returns the ratio of two values as a ratio of uncertainties: √(a/a'), exp((d − d')/16), or the ratio itself.
    pub(crate) fn ratio(self, value: f64, other: f64) -> f64 {
        match self {
            Self::A => (value / other).sqrt(),
            Self::D => libm::exp((value - other) / 16.0),
            Self::Worst => value / other,
        }
    }
}

/// Returns the variances of the eight parameters, in units of the tolerances, from the Cholesky factor.
fn variances(lower: &Matrix8, turn_on: f64) -> [f64; 8] {
    let inverse = inverse_of_lower(lower);
    let mut variances = std::array::from_fn(|place| inverse.column(place).iter().map(|value| value * value).sum());
    OMEGA0.into_iter().for_each(|place| variances[place] += turn_on);
    variances
}

/// Returns L with L L' = M, or `None` if M is not positive definite. Only the lower triangle of M counts.
pub(crate) fn cholesky(matrix: &Matrix8) -> Option<Matrix8> {
    let mut lower = Matrix8::zeros();
    for column in 0..8 {
        for row in column..8 {
            let product: f64 = (0..column).map(|inner| lower[(row, inner)] * lower[(column, inner)]).sum();
            let left = matrix[(row, column)] - product;
            if row > column {
                lower[(row, column)] = left / lower[(column, column)];
            } else if left > SMALLEST_PIVOT * matrix[(column, column)] {
                lower[(column, column)] = left.sqrt();
            } else {
                return None;
            }
        }
    }
    Some(lower)
}

pub(crate) fn inverse_of_lower(lower: &Matrix8) -> Matrix8 {
    let mut inverse = Matrix8::zeros();
    for column in 0..8 {
        inverse[(column, column)] = 1.0 / lower[(column, column)];
        for row in column + 1..8 {
            let product: f64 = (column..row).map(|inner| lower[(row, inner)] * inverse[(inner, column)]).sum();
            inverse[(row, column)] = -product / lower[(row, row)];
        }
    }
    inverse
}
