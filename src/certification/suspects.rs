//! Positions that scatter more than the others, outliers, and runs that agree too well: reported, never excluded.

use super::components::{Components, Variance};
use super::deletion::Deletion;
use super::split_run::{self, SplitRun};
use super::worse_groups::{self, WorseGroup};
use super::{AngleReadings, Header};
use crate::coefficients::PositionIndex;
use crate::statistics::outlier::{Bartlett, bartlett, bonferroni_student, cochran_probability};
use serde::Serialize;

/// Largest difference from the other runs, in steps of the readings, that rounding explains: one step, if both are within
/// half a step of it.
pub(super) const STEPS_OF_ROUNDING: f64 = 1.5;

/// Probability below which a value is reported: a straggler in
/// [ISO 5725-2](crate::bibliography::Bibliography::Iso5725).
pub(crate) const STRAGGLER: f64 = 0.05;

/// Probability below which a value is called an outlier.
pub(crate) const OUTLIER: f64 = 0.01;

/// Names of the axes of the case about which scatter is computed.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

/// Largest number of outliers that are searched for; with more, the readings do not show which are wrong.
pub(crate) const MOST_OUTLIERS: usize = 4;

/// Share of the usual squared difference of two runs below which a pair agrees too well.
const TOO_WELL: f64 = 1e-3;

/// Number of runs above which pairs are not compared: there are too many pairs, and one copy has little effect.
const MOST_PAIRED: usize = 100;

/// Position that scatters more than the others.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct WorsePosition {
    #[serde(flatten)]
    pub index: PositionIndex,
    /// Place of the position in the header.
    #[serde(skip)]
    pub(crate) place: usize,
    /// Standard deviation of the position over that of all positions.
    pub ratio: f64,
    /// Probability that any of the positions scatters this much more than the others by chance.
    pub probability: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Outlier {
    pub index: PositionIndex,
    /// Place of the position in the header.
    pub(crate) place: usize,
    /// Number of the run.
    pub run: u32,
    /// Line in the file of readings; `None` if they do not come from a file.
    pub line: Option<usize>,
    /// Axis of the case: 0, 1, 2 for x, y, z (α, β, γ of a small deviation).
    pub axis: usize,
    /// Difference from the other runs, other outliers excluded, arcsec.
    pub residual_arcsec: f64,
    /// Probability that any reading of the series differs this much by chance.
    pub probability: f64,
}

/// Results of the tests for outliers.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Suspects {
    /// Test whether all positions scatter alike; `None` if it cannot be made, for instance because a reading is
    /// suspect.
    pub positions: Option<Bartlett>,
    /// Test whether x, y and z scatter alike; `None` for the same reasons.
    pub axes: Option<Bartlett>,
    /// Positions that scatter more than the others, the worst first.
    pub worse: Vec<WorsePosition>,
    /// Positions with the same θ that scatter more than the others.
    pub group: Option<WorseGroup>,
    /// Run during which the stand moved; single readings and positions are then not examined.
    pub split: Option<SplitRun>,
    /// Outliers, the least probable first.
    pub outliers: Vec<Outlier>,
    /// Numbers of the runs of each pair that agrees far better than the others.
    pub twins: Vec<(u32, u32)>,
}

impl Suspects {
    /// Returns what is suspect; a run during which the stand moved is looked for if `may_split`.
    pub(crate) fn of(header: &Header, readings: &AngleReadings, components: &Components, may_split: bool) -> Self {
        let alike = vec![1.0; header.positions.len()];
        let found = Self::relative_to(header, readings, components, &alike);
        let is_coarse = readings.is_coarse(components.pooled_arcsec2.value.sqrt());
        // One position that scatters more is not taken for a group.
        let group = worse_groups::find(header, components, &found.outliers);
        let group = group.filter(|group| !is_coarse && found.worse.iter().all(|at| group.probability < at.probability));
        let relative = group.as_ref().map_or(alike, WorseGroup::relative);
        let split = split_run::find(header, readings, components, &relative).filter(|_| may_split);
        if let Some(split) = split.filter(|split| !found.explains(split, readings, components)) {
            return Self { split: Some(split), twins: found.twins, ..Self::default() };
        }
        if group.is_none() {
            return found;
        }
        let found = Self::relative_to(header, readings, components, &of_readings(&relative));
        // A reading that is suspect all the same may be of any position, and all state the pooled scatter.
        if found.outliers.is_empty() { Self { worse: Vec::new(), group, ..found } } else { found }
    }

    /// Returns what is suspect if the variances of the visits to the positions are in the ratio `scatter`.
    fn relative_to(header: &Header, readings: &AngleReadings, components: &Components, scatter: &[f64]) -> Self {
        let mut outliers = outliers(header, readings, components, scatter);
        outliers.retain(|out| out.residual_arcsec.abs() > STEPS_OF_ROUNDING * readings.step_arcsec);
        let scatter_arcsec = components.pooled_arcsec2.value.sqrt();
        // Coarse readings repeat by themselves, and a position scatters if its angles happen to be between two steps.
        let repeats = scatter_arcsec < readings.step_arcsec;
        let twins = if repeats { Vec::new() } else { twins(&readings.runs, components) };
        let none = Self { outliers, twins, ..Self::default() };
        if readings.is_coarse(scatter_arcsec) {
            return none;
        }
        // An outlier increases the scatter of its position and its axis and, through the common part, of its whole run.
        if !none.outliers.is_empty() {
            let worse =
                in_several_runs(&none.outliers).map_or_else(Vec::new, |index| worse(header, components, Some(index)));
            return Self { worse, ..none };
        }
        Self {
            positions: bartlett(&groups(&components.position_squares)),
            axes: bartlett(&groups(&components.axis_squares_arcsec2)),
            worse: worse(header, components, None),
            ..none
        }
    }

    /// Returns the difference of the most suspect angle from the other runs, arcsec, and the probability that any angle of the
    /// series differs this much by chance: what the search for outliers found if it named none.
    pub(crate) fn most_suspect_angle(&self, components: &Components) -> Option<(f64, f64)> {
        let alike = || vec![1.0; components.position_squares.len()];
        let relative = self.group.as_ref().map_or_else(alike, WorseGroup::relative);
        let first = Deletion::of(components, Vec::new())?.next(components)?;
        Some((first.shifts_arcsec[0], probability(components, &of_readings(&relative), &first, 0)))
    }

    /// Returns `true` if the outliers explain the readings better than a run during which the stand moved, or rounding does.
    fn explains(&self, split: &SplitRun, readings: &AngleReadings, components: &Components) -> bool {
        let angle =
            |out: &Outlier| Some((readings.runs.iter().position(|run| *run == out.run)?, 3 * out.place + out.axis));
        let deletion = Deletion::of(components, self.outliers.iter().filter_map(angle).collect());
        let is_rounding = split.turns_arcsec.iter().all(|turn| turn.abs() <= STEPS_OF_ROUNDING * readings.step_arcsec);
        is_rounding || deletion.is_some_and(|single| single.unlikelihood(components) <= split.unlikelihood)
    }

    /// Returns the variance of the visits to each position relative to that of all, or `None` if all scatter alike.
    pub(super) fn scatter(&self, components: &Components) -> Option<Vec<Variance>> {
        if let Some(group) = &self.group {
            return Some(group.scatter.clone());
        }
        let worse: Vec<usize> = self.worse.iter().map(|at| at.place).collect();
        components.scatter_of_positions(&worse).filter(|_| !worse.is_empty())
    }
}

/// Returns the scatter by which readings are compared, from the `relative` variances of the positions. Good readings of
/// positions that scatter more seem to be out compared with the scatter of all; those of the others contain the scatter of
/// the group, through the rotation of the run.
fn of_readings(relative: &[f64]) -> Vec<f64> {
    relative.iter().map(|scatter| scatter.max(1.0)).collect()
}

fn groups(variances: &[Variance]) -> Vec<(f64, f64)> {
    variances.iter().map(|v| (v.value, v.degrees_of_freedom)).collect()
}

/// Returns the position with outliers in two runs or more, which shows that the position itself does not repeat.
fn in_several_runs(outliers: &[Outlier]) -> Option<PositionIndex> {
    let several = |out: &&Outlier| outliers.iter().any(|other| other.index == out.index && other.run != out.run);
    outliers.iter().find(several).map(|out| out.index)
}

/// Returns the positions whose variance is too large by Cochran's test, each tested against the remaining ones; only
/// the position `only` if it is given.
fn worse(header: &Header, components: &Components, only: Option<PositionIndex>) -> Vec<WorsePosition> {
    let mut left: Vec<(usize, (f64, f64))> = groups(&components.position_squares).into_iter().enumerate().collect();
    let mut found = Vec::new();
    while let Some(at) = (0..left.len()).max_by(|a, b| left[*a].1.0.total_cmp(&left[*b].1.0)) {
        let variances: Vec<_> = left.iter().map(|(_, group)| *group).collect();
        let probability = cochran_probability(&variances, at);
        let (place, (variance, _)) = left.remove(at);
        let index = header.positions[place].index();
        // NaN: only one position remains.
        if probability.is_nan() || probability >= STRAGGLER || only.is_some_and(|only| only != index) {
            break;
        }
        found.push(WorsePosition { index, place, ratio: variance.sqrt(), probability });
    }
    found
}

/// Returns the outliers among the readings, with a separate variance for each axis, and variances of the positions in the
/// ratio `scatter`.
///
/// The most suspect reading is deleted, then the next, and so on. All readings deleted up to the last improbable one
/// are outliers ([Rosner](crate::bibliography::Bibliography::Rosner83)'s procedure, because two outliers can hide each
/// other).
fn outliers(header: &Header, readings: &AngleReadings, components: &Components, scatter: &[f64]) -> Vec<Outlier> {
    let runs = &readings.runs;
    let probability = |deletion: &Deletion, n: usize| probability(components, scatter, deletion, n);
    let mut suspect = None;
    let mut deletion = Deletion::of(components, Vec::new());
    for n in 0..MOST_OUTLIERS {
        deletion = deletion.and_then(|last| last.next(components));
        let Some(next) = &deletion else { break };
        if probability(next, n) < STRAGGLER {
            suspect = Some(next.clone());
        }
    }
    let Some(suspect) = suspect.and_then(|suspect| improbable(components, suspect, &probability)) else {
        return Vec::new();
    };
    let out = |n: usize| {
        let (run, row) = suspect.angles[n];
        let (place, residual_arcsec) = (row / 3, suspect.shifts_arcsec[n]);
        let one = Outlier {
            index: header.positions[place].index(),
            place,
            run: runs[run],
            line: readings.line(place, run),
            axis: row % 3,
            residual_arcsec,
            probability: probability(&suspect, n),
        };
        let other = (runs.len() == 2).then(|| Outlier {
            run: runs[1 - run],
            line: readings.line(place, 1 - run),
            residual_arcsec: -residual_arcsec,
            ..one
        });
        std::iter::once(one).chain(other)
    };
    let mut found: Vec<Outlier> = (0..suspect.angles.len()).flat_map(out).collect();
    found.sort_by(|a, b| {
        a.probability.total_cmp(&b.probability).then(b.residual_arcsec.abs().total_cmp(&a.residual_arcsec.abs()))
    });
    found
}

/// Returns the probability that any reading of the series differs as much by chance as the n-th of a deletion.
fn probability(components: &Components, scatter: &[f64], deletion: &Deletion, n: usize) -> f64 {
    let runs = components.residuals.len();
    // With two runs, the difference of the first from the second is that of the second from the first, so it counts
    // once.
    let values = components.keeps.nrows() * if runs == 2 { 1 } else { runs };
    let (t, degrees_of_freedom) = deletion.student(n);
    bonferroni_student(t / scatter[deletion.angles[n].1 / 3].sqrt(), values, degrees_of_freedom)
}

/// Returns the deletion of only those readings that are still improbable once the others are back in the fit.
fn improbable(
    components: &Components,
    suspect: Deletion,
    probability: &impl Fn(&Deletion, usize) -> f64,
) -> Option<Deletion> {
    let out = suspect.angles.iter().enumerate().filter(|(n, _)| probability(&suspect, *n) < STRAGGLER);
    let angles: Vec<_> = out.map(|(_, angle)| *angle).collect();
    if angles.len() == suspect.angles.len() {
        return Some(suspect);
    }
    improbable(components, Deletion::of(components, angles)?, probability)
}

/// Returns the pairs of runs that agree far better than the others, by the median of their squared differences, which
/// an outlier does not affect.
fn twins(runs: &[u32], components: &Components) -> Vec<(u32, u32)> {
    let mut pairs = Vec::new();
    if runs.len() > MOST_PAIRED {
        return Vec::new();
    }
    for (one, of_one) in runs.iter().zip(&components.residuals) {
        let later = runs.iter().zip(&components.residuals).filter(|(other, _)| *other > one);
        pairs.extend(later.map(|(other, of_other)| {
            let mut squares: Vec<f64> = (of_one - of_other).iter().map(|change| change * change).collect();
            squares.sort_by(f64::total_cmp);
            (squares[squares.len() / 2], (*one, *other))
        }));
    }
    pairs.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let usual = pairs.get(pairs.len() / 2).map_or(0.0, |(square, _)| *square);
    pairs.into_iter().take_while(|(square, _)| *square < TOO_WELL * usual).map(|(_, pair)| pair).collect()
}
