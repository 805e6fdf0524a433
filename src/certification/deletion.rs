//! Fit of all runs without some of the readings, found without repeating the fit.
//!
//! A reading with its own parameter (a mean-shift outlier) no longer affects the rest of the fit. Let P be the matrix
//! that gives the residuals from the readings, e the residuals, and D the deleted readings. Their shifts are
//! P_DD⁻¹ e_D: the distance of each from the prediction of all other readings (Cook and Weisberg, Residuals and
//! Influence in Regression, 1982, section 2.2). The means of positions over R runs and the rotations common to each run
//! give P = (1 − 1/R) within one run, −1/R between two runs, times [`Components::keeps`].

use super::components::{Components, Variance};
use nalgebra::{DMatrix, DVector};

/// Single angle of a reading: the place of its run and its row, 3 position + axis.
pub(crate) type Angle = (usize, usize);

/// Share of its own variance in its residual below which a reading is determined by itself alone.
const LEAST_KEPT: f64 = 1e-6;

/// Weight of a prediction relative to that of a reading below which the other readings do not determine the deleted ones.
///
/// Readings that determine the rotations of their run give predictions of 1/5 at least (three runs, one of which keeps three
/// of eight positions). Where only the deviations of the stand, a few arcminutes, tell platform and base apart, it is 1/1000 or
/// less, and the means are worse than without the whole run.
const LEAST_WEIGHT: f64 = 0.1;

/// Fit without the angles in [`Deletion::angles`].
#[derive(Debug, Clone)]
pub(crate) struct Deletion {
    pub(crate) angles: Vec<Angle>,
    /// Difference of each deleted angle from the prediction of all other readings, arcsec.
    pub(crate) shifts_arcsec: DVector<f64>,
    /// Mean squares of the remaining residuals, by axis, arcsec².
    pub(crate) squares_arcsec2: [Variance; 3],
    /// Covariance of the shifts for readings with variance 1.
    pub(crate) spread: DMatrix<f64>,
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
            let rows = || (axis..keeps.nrows()).step_by(3);
            let of_axis = |a: usize, b: usize| {
                rows().map(|row| keeps[(row, angles[a].1)] * keeps[(row, angles[b].1)]).sum::<f64>()
            };
            let shared = DMatrix::from_fn(count, count, |a, b| of_runs(angles[a], angles[b]) * of_axis(a, b));
            let along = DVector::from_fn(count, |a, _| {
                rows().map(|row| keeps[(row, angles[a].1)] * components.residuals[angles[a].0][row]).sum::<f64>()
            });
            let all = &components.axis_squares_arcsec2[axis];
            let kept = components.kept(axis);
            let sum =
                all.value * kept - 2.0 * shifts_arcsec.dot(&along) + shifts_arcsec.dot(&(&shared * &shifts_arcsec));
            let left = kept - (&spread * shared).trace();
            // Correlated residuals have fewer degrees of freedom than `kept`; assume the same ratio as before the
            // deletion.
            Variance { value: sum.max(0.0) / left, degrees_of_freedom: all.degrees_of_freedom * left / kept }
        });
        Some(Self { angles, shifts_arcsec, squares_arcsec2, spread })
    }

    /// Returns `true` if no prediction of a deleted angle has less than [`LEAST_WEIGHT`] of a reading.
    ///
    /// The variance of a shift is that of a reading plus that of its prediction.
    pub(crate) fn is_determined(&self) -> bool {
        self.spread.diagonal().iter().all(|shift| (shift - 1.0) * LEAST_WEIGHT <= 1.0)
    }

    /// Returns the fit without one more angle: the one whose deletion makes the remaining readings most likely, with a
    /// separate variance for each axis. `None` if no further angle can be deleted.
    pub(crate) fn next(&self, components: &Components) -> Option<Self> {
        let rows = components.keeps.nrows();
        let others = (0..components.residuals.len()).flat_map(|run| (0..rows).map(move |row| (run, row)));
        let without = others.filter(|angle| !self.angles.contains(angle)).filter_map(|angle| {
            let mut angles = self.angles.clone();
            angles.push(angle);
            Self::of(components, angles)
        });
        let scored = without.map(|deletion| (deletion.unlikelihood(components), deletion));
        scored.min_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, deletion)| deletion)
    }

    /// Returns −2 ln of the likelihood of the remaining readings, up to a constant.
    pub(crate) fn unlikelihood(&self, components: &Components) -> f64 {
        let sum = |axis: usize| {
            let (all, left) = (&components.axis_squares_arcsec2[axis], &self.squares_arcsec2[axis]);
            // The degrees of freedom are effective ones, in the same ratio before and after the deletion.
            left.value * left.degrees_of_freedom * components.kept(axis) / all.degrees_of_freedom
        };
        components.unlikelihood([0, 1, 2].map(sum))
    }

    /// Returns Student's t of the n-th angle (its shift over its standard deviation), and the degrees of freedom of t.
    pub(crate) fn student(&self, n: usize) -> (f64, f64) {
        let scatter = &self.squares_arcsec2[self.angles[n].1 % 3];
        (self.shifts_arcsec[n] / (scatter.value * self.spread[(n, n)]).sqrt(), scatter.degrees_of_freedom)
    }
}
