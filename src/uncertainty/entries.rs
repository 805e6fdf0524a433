//! Covariance of the numbers of a passport: the uncertainty of stand and site in its vectors and matrices.
//!
//! First order ([JCGM 102](crate::bibliography::Bibliography::Jcgm102), 6.2.1), with exact derivatives of eq. (5) and
//! (11)-(15) of [the paper](crate::bibliography::Bibliography::Tang17). The seat of the gyro, the repeatability of
//! positions and the currents are not part of a passport and do not affect its numbers.

use crate::calibration::causes::of_stand_and_site;
use crate::calibration::estimates::Estimates;
use crate::calibration::sensitivity::VectorChange;
use crate::calibration::{Input, Setup};
use crate::coefficients::{Matrices, MatrixRows, PositionIndex, pair_differences};
use crate::text::record::Record;
use nalgebra::{DMatrix, Matrix2};

/// Number of a passport, identified by its keys.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Entry {
    /// Element of `vectors`: position, key, and place in the list if the key has one.
    Vector(PositionIndex, &'static str, Option<usize>),
    /// Element of `matrices`: key, row, column, from 0.
    Matrix(&'static str, usize, usize),
}

impl std::fmt::Display for Entry {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::Vector(index, key, Some(place)) => write!(f, "vectors {index} {key}[{place}]"),
            Self::Vector(index, key, None) => write!(f, "vectors {index} {key}"),
            Self::Matrix(key, row, column) => write!(f, "matrices.{key}[{row}][{column}]"),
        }
    }
}

/// Joint uncertainty of the numbers of a passport.
#[derive(Debug, Clone, PartialEq)]
pub struct EntryUncertainty {
    /// Numbers of the passport: those of `vectors`, five per position; then those of `matrices`, if the stand has them.
    pub entries: Vec<Entry>,
    /// Uncertain inputs.
    pub inputs: Vec<Input>,
    /// Change of each entry (rows) for one standard uncertainty of each input (columns), in the unit of the entry.
    pub spread: DMatrix<f64>,
}

impl EntryUncertainty {
    /// Computes the uncertainty of the entries from the stand and the site of `setup`.
    pub fn new(setup: &Setup) -> Self {
        let inputs = of_stand_and_site(setup, &Estimates::of_stand(setup));
        let positions = &setup.coefficients().positions;
        let mut entries = Vec::new();
        for at in positions {
            let of = |key, place| Entry::Vector(at.index, key, place);
            entries.extend([0, 1].map(|place| of("specific_force_g", Some(place))));
            entries.push(of("specific_force_z_g", None));
            entries.extend([0, 1].map(|place| of("omega_deg_per_h", Some(place))));
        }
        if setup.coefficients().matrices.is_some() {
            for &key in MatrixRows::KEYS {
                entries.extend([(0, 0), (0, 1), (1, 0), (1, 1)].map(|(row, column)| Entry::Matrix(key, row, column)));
            }
        }
        let mut spread = DMatrix::zeros(entries.len(), inputs.len());
        for (column, input) in inputs.iter().enumerate() {
            let change = |place| setup.changed(place, input.cause).times(input.standard_uncertainty);
            let changes: Vec<VectorChange> = (0..positions.len()).map(change).collect();
            let mut values: Vec<f64> = changes.iter().flat_map(entries_of).collect();
            if let (Some(matrices), Some(eight)) = (&setup.coefficients().matrices, setup.coefficients().eight()) {
                values.extend(of_matrices(matrices, &eight.map(|place| changes[place])));
            }
            spread.column_mut(column).copy_from_slice(&values);
        }
        Self { entries, inputs, spread }
    }

    /// Returns the covariance of the entries, entries × entries, in their order.
    pub fn covariance(&self) -> DMatrix<f64> {
        crate::calibration::propagation::covariance(&self.spread)
    }
}

/// Returns the changes in the order of the entries of a position.
fn entries_of(change: &VectorChange) -> [f64; 5] {
    let VectorChange { earth_rate_deg_per_h: earth, vertical } = change;
    [vertical.x, vertical.y, vertical.z, earth.x, earth.y]
}

/// Returns the changes of the matrices, in the order of [`MatrixRows`], row by row, for those of the eight positions.
fn of_matrices(m: &Matrices, changes: &[VectorChange; 8]) -> Vec<f64> {
    let (n1, n2) = pair_differences(|position| changes[position].vertical.xy());
    let (omega1, omega2) = pair_differences(|position| changes[position].earth_rate_deg_per_h.xy());
    // Δ = n_2⁻¹ n_1, B = ω_31 − ω_32 Δ, C = ω_32 n_2⁻¹ (paper, eq. (13), (15)).
    let delta = m.n2_inverse * (n1 - n2 * m.delta);
    let b = omega1 - omega2 * m.delta - m.omega2_deg_per_h * delta;
    let c = (omega2 - m.c_deg_per_h_per_g * n2) * m.n2_inverse;
    let n2_inverse = -m.n2_inverse * n2 * m.n2_inverse;
    let rows = |matrix: Matrix2<f64>| [matrix.m11, matrix.m12, matrix.m21, matrix.m22];
    [delta, b, c, n1, n2, n2_inverse, omega1, omega2].into_iter().flat_map(rows).collect()
}
