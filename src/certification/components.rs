//! What scatters, and what of it all positions of a run share: variance components.
//!
//! Small differences of the angles of a position are turns of the case: the reading of run r in position p differs
//! from that position's mean by
//!
//! δ_pr = s_r + Ã_p b_r + e_pr,
//!
//! three elements each along x, y, z of the case: s_r is a turn of the platform that the whole run shares (it acts from
//! the left of E·A), b_r one of the base (from the right), e_pr the return's own scatter. Each run's s and b are found
//! by least squares over its positions; what is left is scatter, and what they vary by beyond the share that scatter has
//! in them is common. Sums of squares are set equal to their expectations
//! ([Searle, Casella and McCulloch](crate::bibliography::Bibliography::Searle92), chapter 5): unbiased, and the same as
//! the analysis of variance when all axes scatter alike.

use super::NotCertified;
use crate::calibration::inputs::Turn;
use crate::coefficients::Position;
use crate::statistics::beta::chi_square_point;
use crate::statistics::least_squares::{Factorised, condition};
use crate::units::radians_from_arcseconds;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Directions of the base weaker than 1/this of the strongest cannot be told from a turn of the platform.
const CONDITION_LIMIT: f64 = 30.0;

/// Below this variance readings do not scatter: what is left is the rounding of computations.
const LEAST_SCATTER_ARCSEC2: f64 = 1e-12;

/// A variance with its degrees of freedom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Variance {
    /// The variance, in the square of the unit of what varies.
    pub value: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: f64,
}

/// What all positions of one run share, estimated; turns in arcseconds from the mean of all runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RunTurn {
    /// The run's number.
    pub run: u32,
    /// Turn of the platform, about x, y, z of the case.
    pub platform_arcsec: [f64; 3],
    /// Turn of the base, about east, north, up; what cannot be told from the platform's is in that.
    pub base_arcsec: [f64; 3],
}

/// The part that all positions of a run share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Common {
    /// Its variance from run to run, per axis, arcsec²; 0 when scatter alone explains what is seen.
    pub between_runs_arcsec2: f64,
    /// The degrees of freedom of that (Satterthwaite); those of the runs when it is 0.
    pub degrees_of_freedom: f64,
    /// The largest variance that readings like these do not speak against at 95 %, arcsec².
    pub upper_limit_arcsec2: f64,
}

/// The variance components of a series of runs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Components {
    /// Scatter of one return, about x, y, z of the case, arcsec².
    pub own_arcsec2: [Variance; 3],
    /// The same, one for all axes: what a certificate calls repeatability.
    pub pooled_arcsec2: Variance,
    /// Mean squares of the residuals of each axis, arcsec²: what tests compare. They are less certain of which axis it
    /// is than [`Components::own_arcsec2`], but scatter less themselves.
    pub axis_squares_arcsec2: [Variance; 3],
    /// The same of each position, over those of the axes.
    pub position_squares: Vec<Variance>,
    /// Turns of the platform that a run shares.
    pub platform: Common,
    /// Turns of the base that a run shares; `None` when no axis of it can be told from the platform.
    pub base: Option<Common>,
    /// How many axes of the base can be told from the platform: 3 for the paper's eight positions.
    pub base_axes: usize,
    /// Each run's own turns.
    pub run_turns: Vec<RunTurn>,
    /// What is left of every reading, `[run][3 position + axis]`, arcsec along x, y, z of the case.
    pub(crate) residuals: Vec<DVector<f64>>,
    /// How much of each row's scatter the residual of a row of the same run contains: rows × rows, `[3 position + axis]`.
    pub(crate) keeps: DMatrix<f64>,
}

/// How platform and base of a run act on the turns of every position.
pub(crate) struct RunModel {
    pub(crate) design: DMatrix<f64>,
    /// The axes of the base that the columns from 3 on stand for: 3 × their number.
    pub(crate) base_axes: DMatrix<f64>,
    /// Least squares: columns × rows.
    pub(crate) solve: DMatrix<f64>,
}

impl RunModel {
    /// Of positions that are turned as `turns` say; `None` when the positions do not even determine a platform's turn.
    pub(crate) fn new(turns: &[Turn]) -> Option<Self> {
        let full = design(turns, &DMatrix::identity(3, 3));
        let undetermined = condition(&full, CONDITION_LIMIT)?.undetermined;
        // What lies in both is left to the platform: in the certified positions the two act alike.
        let mut base_axes = DMatrix::identity(3, 3);
        if !undetermined.is_empty() {
            let lost = DMatrix::from_fn(3, undetermined.len(), |row, column| undetermined[column][3 + row]);
            let kept = DMatrix::identity(3, 3) - &lost * lost.clone().pseudo_inverse(1e-9).ok()?;
            let eigen = kept.symmetric_eigen();
            let columns: Vec<_> = (0..3).filter(|&at| eigen.eigenvalues[at] > 0.5).collect();
            base_axes = eigen.eigenvectors.select_columns(&columns);
        }
        let design = design(turns, &base_axes);
        let factorised = Factorised::new(design.clone()).ok()?;
        let (rows, columns) = design.shape();
        let mut rotated = DMatrix::identity(rows, rows);
        factorised.rotate(&mut rotated);
        let solve = factorised.r_inverse() * rotated.rows(0, columns);
        Some(Self { design, base_axes, solve })
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

/// The turn of the case, along its axes and in the angles' unit, that small changes of (α, β, γ) make.
pub(crate) fn case_turn(turn: &Turn, change: &Vector3<f64>) -> Vector3<f64> {
    turn.axes[0] * change.x + turn.axes[1] * change.y + turn.axes[2] * change.z
}

/// Means (α, β, γ in arcseconds) as the model takes them.
pub(crate) fn turns_at(positions: &[Position], means_arcsec: &[Vector3<f64>]) -> Vec<Turn> {
    let each = positions.iter().zip(means_arcsec);
    each.map(|(position, mean)| {
        let mut position = *position;
        position.deviation.alpha_rad = radians_from_arcseconds(mean.x);
        position.deviation.beta_rad = radians_from_arcseconds(mean.y);
        position.deviation.gamma_rad = radians_from_arcseconds(mean.z);
        Turn::of(&position)
    })
    .collect()
}

/// The components of readings `differences[run]`, each the turns of all positions from their means, arcsec.
pub(crate) fn estimate(turns: &[Turn], runs: &[u32], differences: &[DVector<f64>]) -> Result<Components, NotCertified> {
    let model = RunModel::new(turns).ok_or(NotCertified::TooFewPositions)?;
    let (rows, columns) = model.design.shape();
    if rows <= columns {
        return Err(NotCertified::TooFewPositions);
    }
    let keeps = DMatrix::identity(rows, rows) - &model.design * &model.solve;
    let changes = runs.len() as f64 - 1.0;
    let effects: Vec<DVector<f64>> = differences.iter().map(|run| &model.solve * run).collect();
    let residuals: Vec<DVector<f64>> =
        differences.iter().zip(&effects).map(|(run, effect)| run - &model.design * effect).collect();
    let squares = mean_squares(&residuals);
    let axis = |row: usize| row % 3;
    let own = grouped(&squares, &keeps, 3, axis, &|_| 1.0).ok_or(NotCertified::TooFewPositions)?;
    let own_arcsec2 = [0, 1, 2].map(|a| own[a].own.over(changes));
    let axis_squares_arcsec2 = [0, 1, 2].map(|a| own[a].mean_square.over(changes));
    let pooled_arcsec2 =
        pooled(&[0, 1, 2].map(|a| Variance { value: axis_squares_arcsec2[a].value, ..own_arcsec2[a] }));
    if own_arcsec2.iter().any(|variance| variance.value.is_nan() || variance.value < LEAST_SCATTER_ARCSEC2) {
        return Err(NotCertified::NoScatter);
    }
    let scale = |row: usize| own_arcsec2[axis(row)].value;
    let of_positions =
        grouped(&squares, &keeps, rows / 3, |row| row / 3, &scale).ok_or(NotCertified::TooFewPositions)?;
    let position_squares = of_positions.into_iter().map(|group| group.mean_square.over(changes)).collect();
    let of_effect = |at: usize| {
        let seen = effects.iter().map(|effect| effect[at] * effect[at]).sum::<f64>() / changes;
        let of_scatter = (0..rows).map(|row| model.solve[(at, row)] * model.solve[(at, row)] * scale(row)).sum::<f64>();
        (seen, of_scatter)
    };
    let common = |from: usize, to: usize| common((from..to).map(of_effect).collect(), changes, &pooled_arcsec2);
    Ok(Components {
        own_arcsec2,
        pooled_arcsec2,
        axis_squares_arcsec2,
        position_squares,
        platform: common(0, 3),
        base: (columns > 3).then(|| common(3, columns)),
        base_axes: columns - 3,
        run_turns: runs.iter().zip(&effects).map(|(run, effect)| run_turn(*run, effect, &model)).collect(),
        residuals,
        keeps,
    })
}

impl Components {
    /// Returns the sum of squares of the residuals of an axis over their mean square.
    pub(crate) fn kept(&self, axis: usize) -> f64 {
        let rows = (axis..self.keeps.nrows()).step_by(3);
        rows.map(|row| self.keeps[(row, row)]).sum::<f64>() * (self.residuals.len() as f64 - 1.0)
    }

    /// Returns the scatter of the returns to each position over that of all, and its degrees of freedom: of the positions
    /// `worse` each by itself, of all others together.
    pub(crate) fn scatter_of_positions(&self, worse: &[usize]) -> Option<Vec<Variance>> {
        let rows = self.keeps.nrows();
        let changes = self.residuals.len() as f64 - 1.0;
        let squares = mean_squares(&self.residuals);
        let group = |place: usize| worse.iter().position(|at| *at == place).unwrap_or(worse.len());
        let scale = |row: usize| self.own_arcsec2[row % 3].value;
        let groups = grouped(&squares, &self.keeps, worse.len() + 1, |row| group(row / 3), &scale)?;
        Some((0..rows / 3).map(|place| groups[group(place)].own.over(changes)).collect())
    }
}

/// The mean squares of the residuals of every row over the runs.
fn mean_squares(residuals: &[DVector<f64>]) -> DVector<f64> {
    let changes = residuals.len() as f64 - 1.0;
    let rows = residuals.first().map_or(0, DVector::len);
    DVector::from_fn(rows, |row, _| residuals.iter().map(|run| run[row] * run[row]).sum::<f64>() / changes)
}

fn run_turn(run: u32, effect: &DVector<f64>, model: &RunModel) -> RunTurn {
    let base = &model.base_axes * effect.rows(3, effect.len() - 3);
    RunTurn { run, platform_arcsec: [effect[0], effect[1], effect[2]], base_arcsec: [base[0], base[1], base[2]] }
}

/// A group of rows: degrees of freedom are what one run more gives.
struct Group {
    own: Variance,
    mean_square: Variance,
}

impl Variance {
    /// Returns the variance of a sum of independent parts, with degrees of freedom by Welch and Satterthwaite:
    /// [GUM](crate::bibliography::Bibliography::Gum), eq. (G.2b).
    pub(crate) fn sum(parts: impl IntoIterator<Item = Self>) -> Self {
        let (mut value, mut squares) = (0.0, 0.0);
        for part in parts {
            value += part.value;
            squares += part.value * part.value / part.degrees_of_freedom;
        }
        // No part that varies, or none whose variance is not known exactly.
        let degrees_of_freedom = if squares > 0.0 { value * value / squares } else { f64::INFINITY };
        Self { value, degrees_of_freedom }
    }

    /// With the degrees of freedom of so many runs more than one.
    fn over(self, changes: f64) -> Self {
        Self { degrees_of_freedom: self.degrees_of_freedom * changes, ..self }
    }
}

/// Variances of groups of rows, as shares of `scale`.
///
/// A residual mixes the scatter of all rows, Σ M², so the groups' mean squares are a linear system in the variances.
/// Where its solution is no variance (very few degrees of freedom), the group's own mean square stands in. The degrees of
/// freedom of a mean square of correlated residuals are (tr M)²/tr M² (Satterthwaite); those of the solution are no fewer
/// than tr M.
fn grouped(
    squares: &DVector<f64>,
    keeps: &DMatrix<f64>,
    groups: usize,
    group: impl Fn(usize) -> usize,
    scale: &dyn Fn(usize) -> f64,
) -> Option<Vec<Group>> {
    let rows = squares.len();
    let (mut mixing, mut within) = (DMatrix::zeros(groups, groups), DVector::<f64>::zeros(groups));
    let (mut sums, mut freedom) = (DVector::zeros(groups), DVector::<f64>::zeros(groups));
    for row in 0..rows {
        sums[group(row)] += squares[row] / scale(row);
        freedom[group(row)] += keeps[(row, row)];
        for other in 0..rows {
            let share = keeps[(row, other)] * keeps[(row, other)];
            mixing[(group(row), group(other))] += share * scale(other) / scale(row);
            within[group(row)] += if group(row) == group(other) { share } else { 0.0 };
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
        let effective = freedom[at] * freedom[at] / within[at];
        Group {
            own: Variance { value, degrees_of_freedom: freedom[at] },
            mean_square: Variance { value: mean_square, degrees_of_freedom: effective },
        }
    };
    Some((0..groups).map(of_group).collect())
}

/// One variance for several, weighted by their degrees of freedom; its own by Satterthwaite's formula.
fn pooled(variances: &[Variance]) -> Variance {
    let total: f64 = variances.iter().map(|v| v.degrees_of_freedom).sum();
    let sum: f64 = variances.iter().map(|v| v.degrees_of_freedom * v.value).sum();
    let squares: f64 = variances.iter().map(|v| v.degrees_of_freedom * v.value * v.value).sum();
    Variance { value: sum / total, degrees_of_freedom: sum * sum / squares }
}

/// The common part of `effects`, each (variance seen from run to run, variance that scatter alone gives it).
fn common(effects: Vec<(f64, f64)>, changes: f64, scatter: &Variance) -> Common {
    let count = effects.len() as f64;
    let seen = effects.iter().map(|effect| effect.0).sum::<f64>() / count;
    let of_scatter = effects.iter().map(|effect| effect.1).sum::<f64>() / count;
    let freedom = count * changes;
    // Satterthwaite, of a difference of mean squares: GUM (JCGM 100), G.4, with a coefficient of −1.
    let rest = seen - of_scatter;
    let spread = seen * seen / freedom + of_scatter * of_scatter / scatter.degrees_of_freedom;
    let low_chi_square = chi_square_point(0.95, freedom as usize);
    Common {
        between_runs_arcsec2: rest.max(0.0),
        degrees_of_freedom: if rest > 0.0 { rest * rest / spread } else { freedom },
        upper_limit_arcsec2: (seen * freedom / low_chi_square - of_scatter).max(0.0),
    }
}
