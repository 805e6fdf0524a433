//! Runs whose rotation common to all positions differs from that of the other runs: reported, never excluded.
//!
//! A bump of the stand, or a set-up that went wrong in one run, rotates all its readings together. The residuals do not
//! show it, and the variance between runs that it inflates hides it. So the rotations of the runs are tested themselves,
//! about each axis of the platform and of the base, by two of Grubbs' tests, both of which must find the run:
//!
//! * the rotations about that axis alone, because level, azimuth and instruments vary by different amounts;
//! * the rotations about all axes of the platform, or of the base, with their pooled variance, because a few runs agree
//!   about one of six axes by chance.
//!
//! The variance is that of the other runs about all these axes: a run that is rotated about an oblique axis would else hide
//! behind its own rotation about the axes that are not tested.
//!
//! With four runs or more, the same two tests also look for a stand that shifted between two runs or that drifts: a step and a
//! straight line are fitted to the rotations in the order of the runs, as the single run is, and compared with what the fit
//! leaves. Bonferroni's bound counts them with the runs, and only the least probable is named, so a cause has one name. A
//! move after the first or before the last run is that run's.

use super::AngleReadings;
use super::components::{Components, RunTurn};
use super::suspects::{AXES, OUTLIER, Outlier, STEPS_OF_ROUNDING, STRAGGLER};
use crate::statistics::outlier::bonferroni_student;
use crate::wording::Text;
use crate::wording::texts::compass;
use crate::wording::texts::remarks as texts;
use nalgebra::Vector3;
use std::ops::Range;

/// Smallest number of runs that shows which one is wrong.
pub(crate) const FEWEST_RUNS: usize = 3;

/// Smallest number of runs that shows a shift: two before it and two after it, because one is a bumped run.
pub(crate) const FEWEST_RUNS_OF_A_MOVE: usize = 4;

/// Axis of a rotation common to all positions: 0, 1, 2 for x, y, z of the platform, 3, 4, 5 for east, north, up of the base.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct CommonAxis(pub usize);

impl CommonAxis {
    /// Returns `true` for a rotation of the base, `false` for one of the platform.
    pub(crate) fn is_of_the_base(self) -> bool {
        self.0 >= 3
    }

    pub(crate) fn part(self) -> &'static str {
        if self.is_of_the_base() { "base" } else { "platform" }
    }

    /// Returns the name of the axis, without platform or base.
    pub(crate) fn name(self) -> &'static str {
        self.word().en
    }

    /// Returns the names of the three axes of the part, with its name.
    pub(crate) fn names(self) -> Text {
        if self.is_of_the_base() { texts::AXES_OF_BASE } else { texts::AXES_OF_PLATFORM }
    }

    /// Returns the name of the axis in each language, without platform or base.
    pub(crate) fn word(self) -> Text {
        let [x, y, z] = AXES.map(|name| Text { en: name, ru: name });
        [x, y, z, compass::EAST, compass::NORTH, compass::UP][self.0]
    }
}

/// Runs whose common rotation differs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pattern {
    /// Run, by its number, that differs from all others.
    One(u32),
    /// Stand that shifted between two runs: the numbers of the last run before and the first after it.
    Move(u32, u32),
    /// Stand that rotates from run to run by the same amount.
    Drift,
}

/// Runs whose common rotation differs from that of the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RotatedRuns {
    pub pattern: Pattern,
    /// Axis of the most improbable rotation.
    pub axis: CommonAxis,
    /// Rotation about the three axes of platform or base relative to the mean of the other runs, other bumped runs omitted,
    /// arcsec; of a drift from one run to the next.
    pub turns_arcsec: [f64; 3],
    /// Number of runs, by which the rotation of one is divided in their mean.
    pub runs: usize,
    /// Probability that any runs of the series differ this much about any axis by chance.
    pub probability: f64,
}

impl RotatedRuns {
    /// Returns the number of the run that differs, or `None` for a shift or a drift.
    pub(crate) fn run(&self) -> Option<u32> {
        if let Pattern::One(run) = self.pattern { Some(run) } else { None }
    }

    pub(crate) fn turn_arcsec(&self) -> f64 {
        self.turns_arcsec[self.axis.0 % 3]
    }

    /// Returns the rotation that a single run adds to the mean of all runs, about the three axes, arcsec.
    pub(crate) fn in_the_mean_arcsec(&self) -> [f64; 3] {
        self.turns_arcsec.map(|turn| turn / self.runs as f64)
    }

    /// Returns the angle of that rotation, the largest effect on a certified angle, arcsec.
    pub(crate) fn largest_effect_arcsec(&self) -> f64 {
        Vector3::from(self.in_the_mean_arcsec()).norm()
    }
}

/// Variances between the rotations of the runs without those that are outliers, a shift and a drift, per axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RunVariance {
    /// Degrees of freedom per axis: the number of these runs less one, and one fewer for a shift or a drift.
    pub changes: usize,
    /// Variance of the platform, arcsec².
    pub platform_arcsec2: f64,
    /// Variance of the base, arcsec²; 0 if its rotations cannot be distinguished from those of the platform.
    pub base_arcsec2: f64,
}

/// Rotation of one run: the number of the run, and the rotations about the six axes.
type Turn = (u32, [f64; 6]);

/// Returns the bumped runs, the least probable first, and after them a shift or a drift of the others. The `outliers`, single
/// readings that are suspect already, do not count against their run.
pub(crate) fn bumped(readings: &AngleReadings, components: &Components, outliers: &[Outlier]) -> Vec<RotatedRuns> {
    let mut left = without(components, outliers);
    let runs = left.len();
    let mut found: Vec<RotatedRuns> = Vec::new();
    while left.len() >= FEWEST_RUNS {
        // Runs of coarse readings may agree exactly, and a rotation within the rounding would then seem improbable.
        let span = f64::from(left[left.len() - 1].0 - left[0].0);
        let steps = |at: &RotatedRuns| if at.pattern == Pattern::Drift { span } else { 1.0 } * at.turn_arcsec().abs();
        let is_found = |worst: &RotatedRuns| {
            worst.probability < STRAGGLER && steps(worst) > STEPS_OF_ROUNDING * readings.step_arcsec
        };
        let Some(worst) = least_probable(all(&left, components.base_axes)).filter(is_found) else { break };
        found.push(RotatedRuns { runs, ..worst });
        let Some(bumped) = worst.run() else { break };
        left.retain(|(run, _)| *run != bumped);
    }
    found
}

/// Returns the variances between the runs of `components`. An outlier among the `rotated` runs would inflate the variance
/// by which its own effect on the mean is tested; it is omitted, and with it whatever else is named.
pub(crate) fn variance(components: &Components, rotated: &[RotatedRuns]) -> RunVariance {
    if rotated.iter().all(|at| at.probability >= OUTLIER) {
        return RunVariance {
            changes: components.run_turns.len() - 1,
            platform_arcsec2: components.platform.between_runs_arcsec2,
            base_arcsec2: components.base.map_or(0.0, |base| base.between_runs_arcsec2),
        };
    }
    let (squares, changes) = left_squares(turns(components), rotated);
    let between =
        |axes: Range<usize>, count: usize| squares[axes].iter().sum::<f64>() / (count.max(1) * changes) as f64;
    RunVariance { changes, platform_arcsec2: between(0..3, 3), base_arcsec2: between(3..6, components.base_axes) }
}

/// Returns the sums of squares about each axis without what is named in `rotated`, and their degrees of freedom.
pub(super) fn left_squares(mut turns: Vec<Turn>, rotated: &[RotatedRuns]) -> ([f64; 6], usize) {
    turns.retain(|(run, _)| rotated.iter().all(|at| at.run() != Some(*run)));
    let mut fits = fits(&turns);
    fits.retain(|fit| fit.pattern.is_in_order() && rotated.iter().any(|at| at.pattern == fit.pattern));
    let rest = |axis| squares(&turns, axis) - fits.iter().map(|fit| fit.squares(axis)).sum::<f64>();
    (std::array::from_fn(|axis| rest(axis).max(0.0)), turns.len() - 1 - fits.len())
}

pub(super) fn turns(components: &Components) -> Vec<Turn> {
    let six = |turn: &RunTurn| {
        let ([x, y, z], [east, north, up]) = (turn.platform_arcsec, turn.base_arcsec);
        (turn.run, [x, y, z, east, north, up])
    };
    components.run_turns.iter().map(six).collect()
}

/// Returns the rotations of the runs as they are with the `outliers` brought to where the other readings put them.
pub(super) fn without(components: &Components, outliers: &[Outlier]) -> Vec<Turn> {
    let mut turns = turns(components);
    if turns.len() <= 2 {
        return turns;
    }
    let model = &components.model;
    let runs = turns.len() as f64;
    for out in outliers {
        let effect = model.solve.column(3 * out.place + out.axis) * out.residual_arcsec;
        let effect = model.rotations(&effect);
        for (run, turn) in &mut turns {
            // The shift of one reading also moves the mean of the runs.
            let share = f64::from(u8::from(*run == out.run)) - 1.0 / runs;
            turn.iter_mut().zip(effect.as_flattened()).for_each(|(turn, effect)| *turn -= share * effect);
        }
    }
    turns
}

/// Returns the sum of the squared differences of the rotations about an axis from their mean.
fn squares(turns: &[Turn], axis: usize) -> f64 {
    let mean = mean(turns, axis);
    turns.iter().map(|(_, turn)| (turn[axis] - mean) * (turn[axis] - mean)).sum()
}

fn mean(turns: &[Turn], axis: usize) -> f64 {
    turns.iter().map(|(_, turn)| turn[axis]).sum::<f64>() / turns.len() as f64
}

/// Least-squares fit of a pattern to the rotations of the runs.
struct Fit {
    pattern: Pattern,
    /// Fitted rotation about each of the six axes, arcsec.
    turn: [f64; 6],
    /// Sum of the squares of the pattern less its mean.
    norm: f64,
}

impl Pattern {
    /// Returns `true` for a pattern that depends on the order of the runs.
    pub(crate) fn is_in_order(self) -> bool {
        !matches!(self, Self::One(_))
    }
}

impl Fit {
    /// Returns what the pattern adds to the sum of squares about an axis.
    fn squares(&self, axis: usize) -> f64 {
        self.turn[axis] * self.turn[axis] * self.norm
    }
}

/// Returns the fit of every pattern that the number of runs allows.
fn fits(turns: &[Turn]) -> Vec<Fit> {
    let runs = turns.len() as f64;
    let means: [f64; 6] = std::array::from_fn(|axis| mean(turns, axis));
    let differences: Vec<[f64; 6]> =
        turns.iter().map(|(_, turn)| std::array::from_fn(|axis| turn[axis] - means[axis])).collect();
    // The pattern of `count` runs is 1 for them and 0 for the others; `sum` are their differences from the mean.
    let of_runs = |pattern: Pattern, sum: [f64; 6], count: usize| {
        let norm = count as f64 * (1.0 - count as f64 / runs);
        Fit { pattern, turn: sum.map(|sum| sum / norm), norm }
    };
    let mut fits: Vec<Fit> =
        turns.iter().zip(&differences).map(|((run, _), at)| of_runs(Pattern::One(*run), *at, 1)).collect();
    if turns.len() < FEWEST_RUNS_OF_A_MOVE {
        return fits;
    }
    let mut before = [0.0; 6];
    for place in 1..turns.len() - 1 {
        before = std::array::from_fn(|axis| before[axis] + differences[place - 1][axis]);
        if place > 1 {
            let pattern = Pattern::Move(turns[place - 1].0, turns[place].0);
            fits.push(of_runs(pattern, before.map(|sum| -sum), turns.len() - place));
        }
    }
    let middle = turns.iter().map(|(run, _)| f64::from(*run)).sum::<f64>() / runs;
    let (mut sum, mut norm) = ([0.0; 6], 0.0);
    for ((run, _), difference) in turns.iter().zip(&differences) {
        let time = f64::from(*run) - middle;
        norm += time * time;
        sum = std::array::from_fn(|axis| sum[axis] + time * difference[axis]);
    }
    fits.push(Fit { pattern: Pattern::Drift, turn: sum.map(|sum| sum / norm), norm });
    fits
}

/// Returns what the search found if it named no run, or no move and no drift: the least probable of these.
pub(crate) fn most_suspect(
    components: &Components,
    outliers: &[Outlier],
    named: &[RotatedRuns],
    in_order: bool,
) -> Option<RotatedRuns> {
    let mut left = without(components, outliers);
    left.retain(|(run, _)| named.iter().all(|at| at.run() != Some(*run)));
    least_probable(all(&left, components.base_axes).into_iter().filter(|at| at.pattern.is_in_order() == in_order))
}

fn least_probable(found: impl IntoIterator<Item = RotatedRuns>) -> Option<RotatedRuns> {
    // A large rotation is improbable about any axis; of equally improbable ones it is the largest.
    found.into_iter().min_by(|a, b| {
        a.probability.total_cmp(&b.probability).then(b.turn_arcsec().abs().total_cmp(&a.turn_arcsec().abs()))
    })
}

/// Returns the rotation of every pattern about every axis that varies.
fn all(turns: &[Turn], base_axes: usize) -> Vec<RotatedRuns> {
    let groups: Vec<_> = [(0..3, 3), (3..6, base_axes)].into_iter().filter(|(_, count)| *count > 0).collect();
    let fits = fits(turns);
    let values = groups.iter().map(|(_, count)| count * fits.len()).sum::<usize>();
    let sums: [f64; 6] = std::array::from_fn(|axis| squares(turns, axis));
    let freedom = turns.len() as f64 - 2.0;
    let mut found: Vec<RotatedRuns> = Vec::new();
    for (axes, count) in &groups {
        for fit in &fits {
            let rest = |axis: usize| (sums[axis] - fit.squares(axis)).max(0.0);
            let of_group = axes.clone().map(rest).sum::<f64>();
            for axis in axes.clone() {
                let probability = |sum: f64, values: usize, freedom: f64| {
                    bonferroni_student((fit.squares(axis) / (sum / freedom)).sqrt(), values, freedom)
                };
                let about_axis = probability(rest(axis), groups.len() * fits.len(), freedom);
                let about_all = probability(of_group, values, *count as f64 * freedom);
                found.push(RotatedRuns {
                    pattern: fit.pattern,
                    axis: CommonAxis(axis),
                    turns_arcsec: [0, 1, 2].map(|at| fit.turn[axes.start + at]),
                    runs: turns.len(),
                    probability: about_axis.max(about_all),
                });
            }
        }
    }
    found.retain(|at| !at.probability.is_nan());
    found
}
