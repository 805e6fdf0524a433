//! The fit of all runs without some of the readings, found without fitting again.
//!
//! A reading with a parameter of its own (a mean-shift outlier) no longer bears on anything else. With P the matrix that makes
//! residuals of readings, e the residuals and D the readings taken out, their shifts are P_DD⁻¹ e_D: how far each is from what
//! all other readings say (Cook and Weisberg, Residuals and Influence in Regression, 1982, section 2.2). Means of positions
//! over R runs and the turns that each run shares make P = (1 − 1/R) of the same run, −1/R of another, times
//! [`Components::keeps`].

use super::components::{Components, Variance};
use nalgebra::{DMatrix, DVector};

/// One angle that was read: its run (by place) and its row, 3 position + axis.
pub(crate) type Angle = (usize, usize);

/// Below this share of its own variance in its residual, a reading is determined by itself alone.
const LEAST_KEPT: f64 = 1e-6;

/// The fit without the angles in [`Deletion::angles`].
#[derive(Debug, Clone)]
pub(crate) struct Deletion {
    /// What was taken out.
    pub(crate) angles: Vec<Angle>,
    /// How far each is from what all other readings say, arcsec.
    pub(crate) shifts_arcsec: DVector<f64>,
    /// Mean squares of the residuals that are left, by axis, arcsec².
    pub(crate) squares_arcsec2: [Variance; 3],
    /// Covariance of the shifts for readings of variance 1.
    spread: DMatrix<f64>,
}

impl Deletion {
    /// Returns the fit without `angles`, or `None` if the others do not determine them.
    pub(crate) fn of(components: &Components, angles: Vec<Angle>) -> Option<Self> {
        let keeps = &components.keeps;
        let runs = components.residuals.len() as f64;
        let of_runs = |one: Angle, other: Angle| f64::from(u8::from(one.0 == other.0)) - 1.0 / runs;
        let count = angles.len();
        let between =
            DMatrix::from_fn(count, count, |a, b| of_runs(angles[a], angles[b]) * keeps[(angles[a].1, angles[b].1)]);
        let residual = DVector::from_iterator(count, angles.iter().map(|(run, row)| components.residuals[*run][*row]));
        let spread = between
            .cholesky()
            .filter(|root| root.l_dirty().diagonal().iter().all(|pivot| pivot * pivot > LEAST_KEPT))?
            .inverse();
        let shifts_arcsec = &spread * residual;
        let squares_arcsec2 = [0, 1, 2].map(|axis| {
            let of_axis = |a: usize, b: usize| {
                let rows = (axis..keeps.nrows()).step_by(3);
                rows.map(|row| keeps[(row, angles[a].1)] * keeps[(row, angles[b].1)]).sum::<f64>()
            };
            let shared = DMatrix::from_fn(count, count, |a, b| of_runs(angles[a], angles[b]) * of_axis(a, b));
            let along = DVector::from_fn(count, |a, _| {
                let rows = (axis..keeps.nrows()).step_by(3);
                rows.map(|row| keeps[(row, angles[a].1)] * components.residuals[angles[a].0][row]).sum::<f64>()
            });
            let all = &components.axis_squares_arcsec2[axis];
            let kept = components.kept(axis);
            let sum =
                all.value * kept - 2.0 * shifts_arcsec.dot(&along) + shifts_arcsec.dot(&(&shared * &shifts_arcsec));
            let left = kept - (&spread * shared).trace();
            // Correlated residuals have fewer degrees of freedom than they keep, by the same share as before.
            Variance { value: sum.max(0.0) / left, degrees_of_freedom: all.degrees_of_freedom * left / kept }
        });
        Some(Self { angles, shifts_arcsec, squares_arcsec2, spread })
    }

    /// Returns the fit without one more angle: the one without which the readings are most likely, each axis with a scatter of
    /// its own.
    pub(crate) fn next(&self, components: &Components) -> Option<Self> {
        let rows = components.keeps.nrows();
        let others = (0..components.residuals.len()).flat_map(|run| (0..rows).map(move |row| (run, row)));
        let without = others.filter(|angle| !self.angles.contains(angle)).filter_map(|angle| {
            let mut angles = self.angles.clone();
            angles.push(angle);
            Self::of(components, angles)
        });
        // −2 ln of the likelihood, but for a constant; degrees of freedom make sums of squares of mean squares.
        let unlikelihood = |deletion: &Self| -> f64 {
            let axes = components.axis_squares_arcsec2.iter().zip(&deletion.squares_arcsec2);
            axes.map(|(all, left)| {
                let sum = left.value * left.degrees_of_freedom;
                all.degrees_of_freedom * libm::log(sum.max(f64::MIN_POSITIVE))
            })
            .sum()
        };
        let scored = without.map(|deletion| (unlikelihood(&deletion), deletion));
        scored.min_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, deletion)| deletion)
    }

    /// Returns the shift of the n-th angle over its standard deviation, and the degrees of freedom of that (Student's t).
    pub(crate) fn student(&self, n: usize) -> (f64, f64) {
        let scatter = &self.squares_arcsec2[self.angles[n].1 % 3];
        (self.shifts_arcsec[n] / (scatter.value * self.spread[(n, n)]).sqrt(), scatter.degrees_of_freedom)
    }
}
