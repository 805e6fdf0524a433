//! Variance components of the readings: the own scatter of positions, and the part common to all positions of a run.
//!
//! Small changes of the angles of a position are rotations of the case. The reading of run r in position p differs from
//! the mean of that position by
//!
//! δ_pr = s_r + Ã_p b_r + e_pr,
//!
//! with three elements each along x, y, z of the case. s_r is a rotation of the platform common to the whole run (it
//! acts from the left of E·A), b_r one of the base (from the right), and e_pr the own scatter of the visit. Least
//! squares over the positions of a run gives its s and b. The residuals are scatter; the variation of s and b beyond
//! the share that scatter has in them is common. Sums of squares are set equal to their expectations
//! ([Searle, Casella and McCulloch](crate::bibliography::Bibliography::Searle92), chapter 5). The estimates are
//! unbiased, and equal to the analysis of variance if all axes scatter alike.

use super::NotCertified;
use crate::attitude::Deviation;
use crate::calibration::inputs::Turn;
use crate::coefficients::Position;
use crate::statistics::least_squares::{Factorised, condition};
use crate::statistics::student::chi_square_point;
use crate::units::radians_from_arcseconds;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use serde::Serialize;

/// Limit of the condition: directions of the base weaker than 1/30 of the strongest cannot be distinguished from a
/// rotation of the platform.
const CONDITION_LIMIT: f64 = 30.0;

/// Variance below which the residuals are only rounding errors of the computation, arcsec².
const LEAST_SCATTER_ARCSEC2: f64 = 1e-12;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Variance {
    /// Variance, in the squared unit of the quantity.
    pub value: f64,
    pub degrees_of_freedom: f64,
}

/// Estimated rotation common to all positions of one run, relative to the mean of all runs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct RunTurn {
    /// Number of the run.
    pub run: u32,
    /// Rotation of the platform about x, y, z of the case, arcsec.
    pub platform_arcsec: [f64; 3],
    /// Rotation of the base about east, north, up, arcsec; what cannot be distinguished from the platform is in
    /// `platform_arcsec`.
    pub base_arcsec: [f64; 3],
}

/// Variance component common to all positions of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Common {
    /// Variance from run to run, per axis, arcsec²; 0 if scatter alone explains the readings.
    pub between_runs_arcsec2: f64,
    /// Degrees of freedom of that variance (Satterthwaite); those of the runs if it is 0.
    pub degrees_of_freedom: f64,
    /// Upper limit of the variance at 95 %, arcsec².
    pub upper_limit_arcsec2: f64,
}

/// Variance components of a series of runs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Components {
    /// Variance of one visit about x, y, z of the case, arcsec².
    pub own_arcsec2: [Variance; 3],
    /// Variance of one visit, pooled over the axes, arcsec²; its root is the repeatability in a certificate.
    pub pooled_arcsec2: Variance,
    /// Mean squares of the residuals of each axis, arcsec². They separate the axes less well than
    /// [`Components::own_arcsec2`], but scatter less themselves.
    axis_squares_arcsec2: [f64; 3],
    /// Rotation of the platform common to a run.
    pub platform: Common,
    /// Rotation of the base common to a run; `None` if no axis of it can be distinguished from the platform.
    pub base: Option<Common>,
    /// Number of axes of the base that can be distinguished from the platform: 3 for the paper's eight positions.
    pub base_axes: usize,
    /// Rotations of the single runs.
    pub run_turns: Vec<RunTurn>,
    /// Rotations of the runs in the axes of the model, arcsec.
    pub(crate) effects: Vec<DVector<f64>>,
    /// Residuals of the readings, `[run][3 position + axis]`, arcsec along x, y, z of the case.
    pub(crate) residuals: Vec<DVector<f64>>,
    /// Share of the scatter of each row in the residual of each row of one run: rows × rows, `[3 position + axis]`.
    pub(crate) keeps: DMatrix<f64>,
    /// Model of a run, at the means of the readings.
    pub(crate) model: RunModel,
}

/// Length, in readings, below which a combination of rotations cannot be distinguished from those of the whole run.
const LEAST_LENGTH: f64 = 0.5;

/// Orthonormal combinations of what a rotation of the whole run leaves of rotations of some of its positions.
#[derive(Debug, Clone)]
pub(crate) struct Combinations {
    /// Combinations: rows × combinations.
    pub(crate) shared: DMatrix<f64>,
    /// Length of each combination, in readings.
    pub(crate) lengths: DVector<f64>,
    /// Shares of the rotations: combinations × rotations.
    pub(crate) shares: DMatrix<f64>,
}

impl Combinations {
    /// Returns the combinations of what a layer keeps of `rotations`, rows × rotations.
    pub(crate) fn of(rotations: &DMatrix<f64>) -> Option<Self> {
        let svd = rotations.clone().svd(true, true);
        let kept: Vec<usize> =
            (0..svd.singular_values.len()).filter(|&at| svd.singular_values[at] > LEAST_LENGTH).collect();
        Some(Self {
            shared: svd.u?.select_columns(&kept),
            lengths: svd.singular_values.select_rows(&kept),
            shares: svd.v_t?.select_rows(&kept),
        })
    }
}

/// Variances of the rotations of the runs about one axis of platform or base, arcsec².
pub(crate) struct Variation {
    /// About this axis.
    pub own_arcsec2: f64,
    /// About the other two of its part.
    pub others_arcsec2: f64,
    /// Pooled from all three.
    pub between_arcsec2: f64,
    /// Variance about this axis, scatter of visits included, relative to what the others let expect.
    pub ratio: f64,
}

/// Linear model of the rotations of platform and base in one run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RunModel {
    pub(crate) turns: Vec<Turn>,
    pub(crate) design: DMatrix<f64>,
    /// Axes of the base for the columns from 3 on: 3 × their number.
    pub(crate) base_axes: DMatrix<f64>,
    /// Least-squares solution matrix: columns × rows.
    pub(crate) solve: DMatrix<f64>,
}

impl RunModel {
    /// Creates the model of positions rotated by `turns`, or returns `None` if they do not even determine a rotation of
    /// the platform.
    pub(crate) fn new(turns: Vec<Turn>) -> Option<Self> {
        let full = design(&turns, &DMatrix::identity(3, 3));
        let undetermined = condition(&full, CONDITION_LIMIT)?.undetermined;
        // Rotations that both can make are assigned to the platform: in the certified positions both act alike.
        let mut base_axes = DMatrix::identity(3, 3);
        if !undetermined.is_empty() {
            let lost = DMatrix::from_fn(3, undetermined.len(), |row, column| undetermined[column][3 + row]);
            let kept = DMatrix::identity(3, 3) - &lost * lost.clone().pseudo_inverse(1e-9).ok()?;
            let eigen = kept.symmetric_eigen();
            let columns: Vec<_> = (0..3).filter(|&at| eigen.eigenvalues[at] > 0.5).collect();
            base_axes = eigen.eigenvectors.select_columns(&columns);
        }
        let design = design(&turns, &base_axes);
        let factorised = Factorised::new(design.clone())?;
        let (rows, columns) = design.shape();
        let mut rotated = DMatrix::identity(rows, rows);
        factorised.rotate(&mut rotated);
        let solve = &factorised.r_inverse * rotated.rows(0, columns);
        Some(Self { turns, design, base_axes, solve })
    }

    /// Returns the rotations about x, y, z of the platform, and about east, north, up of the base, of a solution.
    pub(crate) fn rotations(&self, solution: &DVector<f64>) -> [[f64; 3]; 2] {
        let base = &self.base_axes * solution.rows(3, solution.len() - 3);
        [[solution[0], solution[1], solution[2]], [base[0], base[1], base[2]]]
    }

    /// Returns the share of each row in the residual of each row, or `None` if the rotations leave no degrees of freedom.
    pub(crate) fn keeps(&self) -> Option<DMatrix<f64>> {
        let (rows, columns) = self.design.shape();
        (rows > columns).then(|| DMatrix::identity(rows, rows) - &self.design * &self.solve)
    }
}

fn design(turns: &[Turn], base_axes: &DMatrix<f64>) -> DMatrix<f64> {
    let mut design = DMatrix::zeros(3 * turns.len(), 3 + base_axes.ncols());
    for (place, turn) in turns.iter().enumerate() {
        design.fixed_view_mut::<3, 3>(3 * place, 0).copy_from(&Matrix3::identity());
        let base = turn.attitude * base_axes;
        design.view_mut((3 * place, 3), (3, base_axes.ncols())).copy_from(&base);
    }
    design
}

/// Returns the rotation of the case, along its axes and in the unit of the angles, for small changes of (α, β, γ).
pub(crate) fn case_turn(turn: &Turn, change: &Vector3<f64>) -> Vector3<f64> {
    turn.axes[0] * change.x + turn.axes[1] * change.y + turn.axes[2] * change.z
}

/// Returns the rotation of every position at its means (α, β, γ, arcsec).
pub(crate) fn turns_at(positions: &[Position], means_arcsec: &[Vector3<f64>]) -> Vec<Turn> {
    let each = positions.iter().zip(means_arcsec);
    each.map(|(position, mean)| {
        let deviation = Deviation::of([mean.x, mean.y, mean.z].map(radians_from_arcseconds));
        Turn::of(&Position { deviation, ..*position }, &Matrix3::identity())
    })
    .collect()
}

/// Estimates the variance components of `differences[run]`, the rotations of all positions from their means, arcsec.
///
/// # Errors
/// Returns [`NotCertified::TooFewPositions`] if the positions do not separate the components, and
/// [`NotCertified::NoScatter`] if the residuals are zero.
pub(crate) fn estimate(
    turns: Vec<Turn>,
    runs: &[u32],
    differences: &[DVector<f64>],
) -> Result<Components, NotCertified> {
    let model = RunModel::new(turns).ok_or(NotCertified::TooFewPositions)?;
    let keeps = model.keeps().ok_or(NotCertified::TooFewPositions)?;
    let (rows, columns) = model.design.shape();
    let changes = runs.len() as f64 - 1.0;
    let effects: Vec<DVector<f64>> = differences.iter().map(|run| &model.solve * run).collect();
    let residuals: Vec<DVector<f64>> =
        differences.iter().zip(&effects).map(|(run, effect)| run - &model.design * effect).collect();
    let squares = mean_squares(&residuals);
    let axis = |row: usize| row % 3;
    let own = grouped(&squares, &keeps, 3, axis, &|_| 1.0).ok_or(NotCertified::TooFewPositions)?;
    let own_arcsec2 = [0, 1, 2].map(|a| own[a].0.over(changes));
    let axis_squares_arcsec2 = [0, 1, 2].map(|a| own[a].1);
    let pooled_arcsec2 = pooled(&axis_squares_arcsec2, &own_arcsec2);
    if own_arcsec2.iter().any(|variance| variance.value.is_nan() || variance.value < LEAST_SCATTER_ARCSEC2) {
        return Err(NotCertified::NoScatter);
    }
    let scale = |row: usize| own_arcsec2[axis(row)].value;
    let of_effect = |at: usize| {
        let seen = effects.iter().map(|effect| effect[at] * effect[at]).sum::<f64>() / changes;
        let of_scatter = (0..rows).map(|row| model.solve[(at, row)] * model.solve[(at, row)] * scale(row)).sum::<f64>();
        (seen, of_scatter)
    };
    let common = |from: usize, to: usize| common((from..to).map(of_effect).collect(), changes, &pooled_arcsec2);
    let turn = |run, effect: &DVector<f64>| {
        let [platform_arcsec, base_arcsec] = model.rotations(effect);
        RunTurn { run, platform_arcsec, base_arcsec }
    };
    Ok(Components {
        own_arcsec2,
        pooled_arcsec2,
        axis_squares_arcsec2,
        platform: common(0, 3),
        base: (columns > 3).then(|| common(3, columns)),
        base_axes: columns - 3,
        run_turns: runs.iter().zip(&effects).map(|(run, effect)| turn(*run, effect)).collect(),
        effects,
        residuals,
        keeps,
        model,
    })
}

impl Components {
    /// Replaces the residuals by those without shifts of readings, such as predictions of missing ones and suspect readings, and
    /// corrects the variances: `rest` has the sums of squares about x, y, z that these leave, arcsec², and their degrees of
    /// freedom.
    pub(crate) fn without_shifts(&mut self, residuals: Vec<DVector<f64>>, rest: &[[f64; 2]]) {
        let changes = self.residuals.len() as f64 - 1.0;
        for (axis, [squares, freedom]) in rest.iter().enumerate() {
            let (own, square) = (&mut self.own_arcsec2[axis], &mut self.axis_squares_arcsec2[axis]);
            let kept = (axis..self.keeps.nrows()).step_by(3).map(|row| self.keeps[(row, row)]).sum::<f64>() * changes;
            let ratio = squares / freedom / *square;
            *square *= ratio;
            // Correlated residuals have fewer degrees of freedom; assume the same ratio as before.
            *own = Variance { value: own.value * ratio, degrees_of_freedom: own.degrees_of_freedom * freedom / kept };
        }
        self.residuals = residuals;
        self.pooled_arcsec2 = pooled(&self.axis_squares_arcsec2, &self.own_arcsec2);
    }

    /// Returns the variation of the runs about an axis (0, 1, 2 for x, y, z of the platform, 3, 4, 5 for those of the base) and
    /// about the other two of its part, from sums of `squares` about each axis, arcsec², with their degrees of freedom.
    pub(crate) fn variation(&self, squares: &[[f64; 2]], axis: usize) -> Variation {
        let first = axis / 3 * 3;
        // The scatter of visits varies the rotations too, by an amount that may differ from axis to axis.
        let of_scatter = |at: usize| {
            let shares = self.model.solve.row(at).into_owned();
            shares.iter().enumerate().map(|(row, share)| share * share * self.own_arcsec2[row % 3].value).sum::<f64>()
        };
        let seen = [0, 1, 2].map(|at| squares[first + at][0] / squares[first + at][1] - of_scatter(first + at));
        let between = seen.iter().sum::<f64>().max(0.0) / 3.0;
        let own_arcsec2 = seen[axis % 3].max(0.0);
        let others_arcsec2 = ((3.0 * between - own_arcsec2) / 2.0).max(0.0);
        // Each of the others shows the variation of all only roughly: the larger counts.
        let most = (0..3).filter(|at| *at != axis % 3).map(|at| seen[at]).fold(0.0, f64::max);
        let ratio = squares[axis][0] / squares[axis][1] / (most + of_scatter(axis));
        Variation { own_arcsec2, others_arcsec2, between_arcsec2: between, ratio }
    }

    /// Returns the variance of the visits to each position relative to that of all positions: for each of the groups `worse` by
    /// itself, for all others pooled. `None` if the residuals do not determine it.
    pub(crate) fn scatter_of_positions(&self, worse: &[Vec<usize>]) -> Option<Vec<Variance>> {
        let rows = self.keeps.nrows();
        let changes = self.residuals.len() as f64 - 1.0;
        let squares = mean_squares(&self.residuals);
        let group = |place: usize| worse.iter().position(|places| places.contains(&place)).unwrap_or(worse.len());
        let scale = |row: usize| self.own_arcsec2[row % 3].value;
        let groups = grouped(&squares, &self.keeps, worse.len() + 1, |row| group(row / 3), &scale)?;
        Some((0..rows / 3).map(|place| groups[group(place)].0.over(changes)).collect())
    }
}

/// Returns the mean squares of the residuals of every row over the runs.
fn mean_squares(residuals: &[DVector<f64>]) -> DVector<f64> {
    let changes = residuals.len() as f64 - 1.0;
    let rows = residuals.first().map_or(0, DVector::len);
    DVector::from_fn(rows, |row, _| residuals.iter().map(|run| run[row] * run[row]).sum::<f64>() / changes)
}

impl Variance {
    /// Returns the variance of a sum of independent parts, with degrees of freedom by Welch and Satterthwaite:
    /// [GUM](crate::bibliography::Bibliography::Gum), eq. (G.2b).
    pub(crate) fn sum(parts: impl IntoIterator<Item = Self>) -> Self {
        let (value, doubt) = parts.into_iter().fold((0.0, 0.0), |(value, doubt), part| {
            (value + part.value, doubt + part.value * part.value / part.degrees_of_freedom)
        });
        // No part varies, or every varying part is known exactly.
        Self { value, degrees_of_freedom: if doubt > 0.0 { value * value / doubt } else { f64::INFINITY } }
    }

    /// Returns the variance with the degrees of freedom for `changes`, the number of runs less one.
    fn over(self, changes: f64) -> Self {
        Self { degrees_of_freedom: self.degrees_of_freedom * changes, ..self }
    }
}

/// Returns the variances of groups of rows relative to `scale`, with the degrees of freedom that one more run adds, and their
/// mean squares; `None` if a group has no degrees of freedom.
///
/// A residual mixes the scatter of all rows, Σ M², so the mean squares of the groups are a linear system in the
/// variances. Where its solution is not positive (with very few degrees of freedom), the mean square of the group is
/// used instead. The degrees of freedom of the solution are no fewer than tr M.
fn grouped(
    squares: &DVector<f64>,
    keeps: &DMatrix<f64>,
    groups: usize,
    group: impl Fn(usize) -> usize,
    scale: &dyn Fn(usize) -> f64,
) -> Option<Vec<(Variance, f64)>> {
    let rows = squares.len();
    let mut mixing = DMatrix::zeros(groups, groups);
    let (mut sums, mut freedom) = (DVector::zeros(groups), DVector::<f64>::zeros(groups));
    for row in 0..rows {
        sums[group(row)] += squares[row] / scale(row);
        freedom[group(row)] += keeps[(row, row)];
        for other in 0..rows {
            let share = keeps[(row, other)] * keeps[(row, other)];
            mixing[(group(row), group(other))] += share * scale(other) / scale(row);
        }
    }
    if freedom.iter().any(|&share| share < 1e-6) {
        return None;
    }
    let solved = mixing.lu().solve(&sums);
    let of_group = |at: usize| {
        let mean_square = sums[at] / freedom[at];
        let solved = solved.as_ref().map_or(0.0, |solved| solved[at]);
        let value = if solved > 0.0 { solved } else { mean_square };
        (Variance { value, degrees_of_freedom: freedom[at] }, mean_square)
    };
    Some((0..groups).map(of_group).collect())
}

/// Returns the mean of the mean squares of the axes, weighted by the degrees of freedom of their `own` variances, with
/// degrees of freedom by Satterthwaite's formula.
fn pooled(axis_squares: &[f64; 3], own: &[Variance; 3]) -> Variance {
    let variances = [0, 1, 2].map(|axis| Variance { value: axis_squares[axis], ..own[axis] });
    let total: f64 = variances.iter().map(|v| v.degrees_of_freedom).sum();
    let sum: f64 = variances.iter().map(|v| v.degrees_of_freedom * v.value).sum();
    let squares: f64 = variances.iter().map(|v| v.degrees_of_freedom * v.value * v.value).sum();
    Variance { value: sum / total, degrees_of_freedom: sum * sum / squares }
}

/// Returns the common part of `effects`, pairs of the variance observed from run to run and the share of scatter in it.
fn common(effects: Vec<(f64, f64)>, changes: f64, scatter: &Variance) -> Common {
    let count = effects.len() as f64;
    let seen = effects.iter().map(|effect| effect.0).sum::<f64>() / count;
    let of_scatter = effects.iter().map(|effect| effect.1).sum::<f64>() / count;
    let freedom = count * changes;
    // Satterthwaite for a difference of mean squares: GUM (JCGM 100), G.4, with a coefficient of −1.
    let rest = seen - of_scatter;
    let spread = seen * seen / freedom + of_scatter * of_scatter / scatter.degrees_of_freedom;
    let low_chi_square = chi_square_point(0.95, freedom as usize);
    Common {
        between_runs_arcsec2: rest.max(0.0),
        degrees_of_freedom: if rest > 0.0 { rest * rest / spread } else { freedom },
        upper_limit_arcsec2: (seen * freedom / low_chi_square - of_scatter).max(0.0),
    }
}
