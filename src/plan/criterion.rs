//! Criteria by which plans are compared: one number from the information of all visits, smaller is better.
//!
//! All quantities are in units of the tolerances, so that parameters of different kinds can be added.

use crate::text::{word_of_a_key, words};

/// Symmetric matrix, 8×8, of which the lower triangle counts.
pub(crate) type Symmetric = [[f64; 8]; 8];

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
    pub(crate) fn value(self, information: &Symmetric, turn_on: f64) -> f64 {
        let Some(lower) = cholesky(information) else { return f64::INFINITY };
        match self {
            Self::A => variances(&lower, turn_on).iter().sum(),
            Self::Worst => variances(&lower, turn_on).into_iter().fold(0.0, f64::max).sqrt(),
            Self::D => {
                // det(M⁻¹ + v (e_4 e_4' + e_5 e_5')) = det M⁻¹ · det(1 + v M₂), with M₂ the block of ω_0.
                let [x, y] = OMEGA0;
                let block = |row: usize, column: usize| turn_on * information[row][column];
                let added = (1.0 + block(x, x)) * (1.0 + block(y, y)) - block(y, x) * block(y, x);
                libm::log(added) - 2.0 * (0..8).map(|place| libm::log(lower[place][place])).sum::<f64>()
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
fn variances(lower: &Symmetric, turn_on: f64) -> [f64; 8] {
    let inverse = inverse_of_lower(lower);
    let mut variances = [0.0; 8];
    for (row, values) in inverse.iter().enumerate() {
        for (variance, value) in variances.iter_mut().zip(values).take(row + 1) {
            *variance += value * value;
        }
    }
    OMEGA0.into_iter().for_each(|place| variances[place] += turn_on);
    variances
}

/// Returns L with L L' = M, or `None` if M is not positive definite.
pub(crate) fn cholesky(matrix: &Symmetric) -> Option<Symmetric> {
    let mut lower = [[0.0; 8]; 8];
    for column in 0..8 {
        let squares: f64 = lower[column][..column].iter().map(|value| value * value).sum();
        let pivot = matrix[column][column] - squares;
        let is_regular = pivot > SMALLEST_PIVOT * matrix[column][column];
        if !is_regular {
            return None;
        }
        let root = pivot.sqrt();
        lower[column][column] = root;
        for row in column + 1..8 {
            let of_rows = lower[row][..column].iter().zip(&lower[column][..column]);
            let product: f64 = of_rows.map(|(one, other)| one * other).sum();
            lower[row][column] = (matrix[row][column] - product) / root;
        }
    }
    Some(lower)
}

pub(crate) fn inverse_of_lower(lower: &Symmetric) -> Symmetric {
    let mut inverse = [[0.0; 8]; 8];
    for column in 0..8 {
        inverse[column][column] = 1.0 / lower[column][column];
        for row in column + 1..8 {
            let product: f64 = (column..row).map(|inner| lower[row][inner] * inverse[inner][column]).sum();
            inverse[row][column] = -product / lower[row][row];
        }
    }
    inverse
}

/// Adds `share` times `other`, lower triangle only.
pub(crate) fn add(matrix: &mut Symmetric, other: &Symmetric, share: f64) {
    for (row, (values, others)) in matrix.iter_mut().zip(other).enumerate() {
        for (value, other) in values.iter_mut().zip(others).take(row + 1) {
            *value += share * other;
        }
    }
}
