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

use super::components::{Components, RunModel, RunTurn};
use super::suspects::{AXES, OUTLIER, Outlier, STRAGGLER};
use super::{AngleReadings, Header, turns_of};
use crate::statistics::outlier::bonferroni_student;
use nalgebra::Vector3;
use std::ops::Range;

/// Smallest number of runs that shows which one is wrong.
const FEWEST_RUNS: usize = 3;

/// Names of the axes of the base.
const COMPASS: [&str; 3] = ["east", "north", "up"];

/// Run whose common rotation differs from that of the other runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BumpedRun {
    /// Number of the run.
    pub run: u32,
    /// Axis of the most improbable rotation: 0, 1, 2 for x, y, z of the platform, 3, 4, 5 for east, north, up of the base.
    pub axis: usize,
    /// Rotation about the three axes of platform or base relative to the mean of the other runs, other bumped runs omitted,
    /// arcsec.
    pub turns_arcsec: [f64; 3],
    /// Number of runs, by which the rotation is divided in their mean.
    pub runs: usize,
    /// Probability that any run of the series differs this much about any axis by chance.
    pub probability: f64,
}

impl BumpedRun {
    /// Returns `true` for a rotation of the base, `false` for one of the platform.
    pub(crate) fn is_of_the_base(&self) -> bool {
        self.axis >= 3
    }

    /// Returns the part that is rotated.
    pub(crate) fn part(&self) -> &'static str {
        if self.is_of_the_base() { "base" } else { "platform" }
    }

    /// Returns the name of the axis, without platform or base.
    pub(crate) fn axis_name(&self) -> &'static str {
        [AXES, COMPASS].as_flattened()[self.axis]
    }

    /// Returns the rotation about the axis, arcsec.
    pub(crate) fn turn_arcsec(&self) -> f64 {
        self.turns_arcsec[self.axis % 3]
    }

    /// Returns the rotation that the run adds to the mean of all runs, about the three axes, arcsec.
    pub(crate) fn in_the_mean_arcsec(&self) -> [f64; 3] {
        self.turns_arcsec.map(|turn| turn / self.runs as f64)
    }

    /// Returns the angle of that rotation, the largest effect on a certified angle, arcsec.
    pub(crate) fn largest_effect_arcsec(&self) -> f64 {
        Vector3::from(self.in_the_mean_arcsec()).norm()
    }

    /// Returns the names of the three axes with platform or base.
    pub(crate) fn axes(&self) -> String {
        let names = if self.is_of_the_base() { COMPASS } else { AXES };
        format!("{} of the {}", names.join(", "), self.part())
    }
}

/// Variances between the rotations of those runs that are no outliers, per axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RunVariance {
    /// Number of these runs.
    pub runs: usize,
    /// Variance of the platform, arcsec².
    pub platform_arcsec2: f64,
    /// Variance of the base, arcsec²; 0 if its rotations cannot be distinguished from those of the platform.
    pub base_arcsec2: f64,
}

/// Rotation of one run: the number of the run, and the rotations about the six axes.
type Turn = (u32, [f64; 6]);

/// Returns the bumped runs, the least probable first. The `outliers`, single readings that are suspect already, do not
/// count against their run.
pub(crate) fn bumped(
    header: &Header,
    readings: &AngleReadings,
    components: &Components,
    outliers: &[Outlier],
) -> Vec<BumpedRun> {
    let mut left = without(header, readings, components, outliers);
    let runs = left.len();
    let mut found: Vec<BumpedRun> = Vec::new();
    while left.len() >= FEWEST_RUNS {
        let Some(worst) = worst(&left, components.base_axes).filter(|worst| worst.probability < STRAGGLER) else {
            break;
        };
        left.retain(|(run, _)| *run != worst.run);
        found.push(BumpedRun { runs, ..worst });
    }
    found
}

/// Returns the variances between the runs of `components`. An outlier among the `bumped` would inflate the variance by which
/// its own effect on the mean is tested, and is omitted.
pub(crate) fn variance(components: &Components, bumped: &[BumpedRun]) -> RunVariance {
    let out: Vec<u32> = bumped.iter().filter(|run| run.probability < OUTLIER).map(|run| run.run).collect();
    if out.is_empty() {
        return RunVariance {
            runs: components.run_turns.len(),
            platform_arcsec2: components.platform.between_runs_arcsec2,
            base_arcsec2: components.base.map_or(0.0, |base| base.between_runs_arcsec2),
        };
    }
    let left: Vec<Turn> = turns(components).into_iter().filter(|(run, _)| !out.contains(run)).collect();
    let between = |axes: Range<usize>, count: usize| {
        let sum = axes.map(|axis| squares(&left, axis)).sum::<f64>();
        sum / (count.max(1) * (left.len() - 1)) as f64
    };
    RunVariance {
        runs: left.len(),
        platform_arcsec2: between(0..3, 3),
        base_arcsec2: between(3..6, components.base_axes),
    }
}

fn turns(components: &Components) -> Vec<Turn> {
    let six = |turn: &RunTurn| {
        let ([x, y, z], [east, north, up]) = (turn.platform_arcsec, turn.base_arcsec);
        (turn.run, [x, y, z, east, north, up])
    };
    components.run_turns.iter().map(six).collect()
}

/// Returns the rotations of the runs as they are with the `outliers` brought to where the other readings put them.
fn without(header: &Header, readings: &AngleReadings, components: &Components, outliers: &[Outlier]) -> Vec<Turn> {
    let mut turns = turns(components);
    let Some(model) = RunModel::new(&turns_of(header, readings)).filter(|_| turns.len() > 2) else { return turns };
    let runs = turns.len() as f64;
    for out in outliers {
        let Some(place) = header.positions.iter().position(|at| at.index() == out.index) else { continue };
        let effect = model.solve.column(3 * place + out.axis) * out.residual_arcsec;
        let base = &model.base_axes * effect.rows(3, effect.len() - 3);
        for (run, turn) in &mut turns {
            // The shift of one reading also moves the mean of the runs.
            let share = f64::from(u8::from(*run == out.run)) - 1.0 / runs;
            for axis in 0..3 {
                turn[axis] -= share * effect[axis];
                turn[3 + axis] -= share * base[axis];
            }
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

/// Returns the least probable rotation of one run, or `None` if no axis varies.
fn worst(turns: &[Turn], base_axes: usize) -> Option<BumpedRun> {
    let runs = turns.len() as f64;
    let groups: Vec<_> = [(0..3, 3), (3..6, base_axes)].into_iter().filter(|(_, count)| *count > 0).collect();
    let values = groups.iter().map(|(_, count)| count * turns.len()).sum::<usize>();
    let means: [f64; 6] = std::array::from_fn(|axis| mean(turns, axis));
    let sums: [f64; 6] = std::array::from_fn(|axis| squares(turns, axis));
    let mut found: Vec<BumpedRun> = Vec::new();
    for (axes, count) in &groups {
        for (run, turn) in turns {
            let difference = |axis: usize| (turn[axis] - means[axis]) * runs / (runs - 1.0);
            // What this run adds to the sum of squares of the others, and that of the others.
            let own = |axis: usize| difference(axis) * difference(axis) * (runs - 1.0) / runs;
            let others = |axis: usize| (sums[axis] - own(axis)).max(0.0);
            let freedom = runs - 2.0;
            let of_group = axes.clone().map(others).sum::<f64>();
            for axis in axes.clone() {
                let probability = |sum: f64, values: usize, freedom: f64| {
                    bonferroni_student((own(axis) / (sum / freedom)).sqrt(), values, freedom)
                };
                let about_axis = probability(others(axis), groups.len() * turns.len(), freedom);
                let about_all = probability(of_group, values, *count as f64 * freedom);
                found.push(BumpedRun {
                    run: *run,
                    axis,
                    turns_arcsec: [0, 1, 2].map(|at| difference(axes.start + at)),
                    runs: turns.len(),
                    probability: about_axis.max(about_all),
                });
            }
        }
    }
    found.retain(|run| !run.probability.is_nan());
    // A large rotation is improbable about any axis; of equally improbable ones it is the largest.
    found.into_iter().min_by(|a, b| {
        a.probability.total_cmp(&b.probability).then(b.turn_arcsec().abs().total_cmp(&a.turn_arcsec().abs()))
    })
}
