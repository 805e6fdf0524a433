//! A run during which the stand moved: its positions from one reading on are rotated together relative to those before it.
//!
//! A bump in the middle of a run leaves residuals in all of its positions, and the test of single readings would name good
//! ones. So a rotation of the platform, or of the base, is fitted to the positions after each reading of each run, in the order
//! of the rows, and compared with the residuals (F test).

use super::components::{Combinations, Components, by_axis};
use super::remark::together;
use super::rotated_runs::{CommonAxis, FEWEST_RUNS};
use super::suspects::OUTLIER;
use super::{AngleReadings, Header};
use crate::calibration::inputs::Turn;
use crate::coefficients::PositionIndex;
use crate::statistics::student::{effective_degrees_of_freedom, f_beyond};
use crate::wording::Words;
use crate::wording::number::Probability;
use crate::wording::texts::remarks as texts;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Fewest positions before the change, and after it: one alone is a suspect reading.
const FEWEST_POSITIONS: usize = 2;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SplitRun {
    /// Number of the run.
    pub run: u32,
    /// Last position before the change, and first one after it.
    pub between: [PositionIndex; 2],
    /// First axis of the part that is rotated, platform or base.
    pub axis: CommonAxis,
    /// Rotation of the positions after the change about the three axes of that part, arcsec.
    pub turns_arcsec: [f64; 3],
    /// Probability that any run seems to change this much by chance.
    pub probability: f64,
    /// −2 ln of the likelihood of the readings with this change, up to a constant.
    pub(crate) unlikelihood: f64,
}

impl SplitRun {
    /// Returns the remark on the run, or with `of_check` the finding of a check.
    pub(super) fn words(&self, of_check: bool) -> Words {
        let (run, [before, after], [x, y, z]) = (self.run, self.between, together(self.turns_arcsec));
        let axes = self.axis.names();
        match of_check {
            true => texts::check_split(run, after, x, y, z, axes, before),
            false => texts::split_run(run, after, x, y, z, axes, before, Probability(self.probability)),
        }
    }
}

/// Returns the run during which the stand most probably moved, if chance explains that in less than 1 %; `relative` are the
/// variances of the positions relative to their mean.
pub(super) fn find(
    header: &Header,
    readings: &AngleReadings,
    components: &Components,
    relative: &[f64],
) -> Option<SplitRun> {
    let runs = components.residuals.len();
    if runs < FEWEST_RUNS {
        return None;
    }
    let turns = &components.model.turns;
    let parts = [DMatrix::identity(3, 3), components.model.base_axes.clone()];
    let sums_arcsec2 = by_axis(components.residuals.iter().flatten().map(|left| left * left));
    let mut found = Vec::new();
    for run in 0..runs {
        let mut order: Vec<usize> =
            (0..turns.len()).filter(|place| !readings.missing.contains(&(*place, run))).collect();
        order.sort_by_key(|place| readings.line(*place, run));
        for first in FEWEST_POSITIONS..=order.len().saturating_sub(FEWEST_POSITIONS) {
            for (part, axes) in parts.iter().enumerate().filter(|(_, axes)| axes.ncols() > 0) {
                let attitude = |turn: &Turn| if part == 0 { Matrix3::identity() } else { turn.attitude };
                let mut rotation = DMatrix::zeros(3 * turns.len(), axes.ncols());
                for &place in &order[first..] {
                    rotation.view_mut((3 * place, 0), (3, axes.ncols())).copy_from(&(attitude(&turns[place]) * axes));
                }
                let Some(fit) = Fit::of(&rotation, components, sums_arcsec2, relative, run) else { continue };
                let turn: Vector3<f64> = Vector3::from_column_slice((axes * &fit.turn).as_slice());
                found.push(SplitRun {
                    run: readings.runs[run],
                    between: [order[first - 1], order[first]].map(|place| header.positions[place].index()),
                    axis: CommonAxis(3 * part),
                    turns_arcsec: turn.into(),
                    probability: fit.probability,
                    unlikelihood: fit.unlikelihood,
                });
            }
        }
    }
    let values = found.len() as f64;
    let best = found.into_iter().min_by(|a, b| a.unlikelihood.total_cmp(&b.unlikelihood))?;
    let probability = (values * best.probability).min(1.0);
    (probability < OUTLIER).then_some(SplitRun { probability, ..best })
}

/// Least-squares fit of a rotation of some positions of one run.
struct Fit {
    turn: DVector<f64>,
    /// Probability that this rotation is as large by chance.
    probability: f64,
    unlikelihood: f64,
}

impl Fit {
    /// Fits a `rotation` to the residuals of a run; without it, the squared residuals about x, y, z have the sums `rest`.
    fn of(
        rotation: &DMatrix<f64>,
        components: &Components,
        mut rest: [f64; 3],
        relative: &[f64],
        run: usize,
    ) -> Option<Self> {
        let runs = components.residuals.len() as f64;
        let Combinations { shared, lengths, shares } = components.combinations(rotation)?;
        let residual = &components.residuals[run];
        let effect = shared.tr_mul(residual);
        // The mean over the runs takes 1/R of a rotation.
        let of_all = runs / (runs - 1.0);
        let turn = shares.tr_mul(&effect.component_div(&lengths)) * of_all;
        let fitted = &shared * &effect;
        for row in 0..fitted.len() {
            rest[row % 3] -= of_all * fitted[row] * (2.0 * residual[row] - fitted[row]);
        }
        let shares = by_axis(shared.row_iter().map(|row| row.norm_squared()));
        let freedom = [0, 1, 2].map(|axis| components.kept(axis) - shares[axis]);
        let scatter = [0, 1, 2].map(|axis| rest[axis].max(0.0) / freedom[axis]);
        let weighted = DMatrix::from_fn(shared.nrows(), shared.ncols(), |row, at| {
            shared[(row, at)] * scatter[row % 3] * relative[row / 3]
        });
        let covariance = shared.tr_mul(&weighted);
        let by_chance = covariance.trace();
        // Satterthwaite: the combinations vary differently if the axes scatter differently.
        let own = by_chance * by_chance / covariance.norm_squared();
        let contributions = [0, 1, 2].map(|axis| ((shares[axis] * scatter[axis]).sqrt(), freedom[axis]));
        let ratio = of_all * effect.norm_squared() / by_chance;
        Some(Self {
            turn,
            probability: f_beyond(ratio, own, effective_degrees_of_freedom(&contributions)),
            unlikelihood: components.unlikelihood(rest),
        })
    }
}
