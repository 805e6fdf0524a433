//! A position that scatters more than the others, a reading that is out, runs that agree too well: named, never dropped.

use super::components::{Components, Variance};
use super::deletion::Deletion;
use super::{AngleReadings, Header};
use crate::coefficients::PositionIndex;
use crate::statistics::outlier::{Bartlett, bartlett, bonferroni_student, cochran_probability};

/// What is less probable than this is named (a straggler, by [ISO 5725-2](crate::bibliography::Bibliography::Iso5725)).
pub(crate) const STRAGGLER: f64 = 0.05;

/// What is less probable than this is called an outlier.
pub(crate) const OUTLIER: f64 = 0.01;

/// The names of the axes of the case, in whose turns scatter is measured.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

/// The largest number of readings that are looked for; of more it cannot be said which are wrong.
pub(crate) const MOST_OUTLIERS: usize = 4;

/// Two runs agree too well when the square of their difference is less than this share of that of pairs usually.
const TOO_WELL: f64 = 1e-3;

/// Of more runs no pairs are compared: there are too many, and one copy among them matters little.
const MOST_PAIRED: usize = 100;

/// A position that is worse than the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct WorsePosition {
    /// Index (i, j) of the position.
    pub index: PositionIndex,
    /// Its place in the header.
    pub(crate) place: usize,
    /// Its standard deviation over that of all positions.
    pub ratio: f64,
    /// Probability that any of so many positions scatters so much more than the others by chance.
    pub probability: f64,
}

/// A reading that is out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Outlier {
    /// Index (i, j) of the position.
    pub index: PositionIndex,
    /// Number of the run.
    pub run: u32,
    /// Line of the file of readings, when they come from one.
    pub line: Option<usize>,
    /// Axis of the case: 0, 1, 2 for x, y, z (α, β, γ of a small deviation).
    pub axis: usize,
    /// Deviation from what the other runs say, readings that are out aside, arcsec.
    pub residual_arcsec: f64,
    /// Probability that any reading of the series is so far out by chance.
    pub probability: f64,
}

/// What the tests say.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Suspects {
    /// Whether all positions scatter alike; `None` when the test cannot be made, as while a reading is suspect.
    pub positions: Option<Bartlett>,
    /// Whether x, y and z scatter alike; `None` likewise.
    pub axes: Option<Bartlett>,
    /// Positions that scatter more than the others, the worst first.
    pub worse: Vec<WorsePosition>,
    /// Readings that are out, the least probable first.
    pub outliers: Vec<Outlier>,
    /// Pairs of runs that agree far better than others do, by their numbers.
    pub twins: Vec<(u32, u32)>,
}

impl Suspects {
    pub(crate) fn of(header: &Header, readings: &AngleReadings, components: &Components) -> Self {
        let outliers = outliers(header, readings, components);
        let twins = twins(readings.runs(), components);
        // A reading that is out makes its position, its axis and its run look worse, and through what a run shares others too.
        if !outliers.is_empty() {
            let worse =
                in_several_runs(&outliers).map_or_else(Vec::new, |index| worse(header, components, Some(index)));
            return Self { positions: None, axes: None, worse, outliers, twins };
        }
        Self {
            positions: bartlett(&groups(&components.position_squares)),
            axes: bartlett(&groups(&components.axis_squares_arcsec2)),
            worse: worse(header, components, None),
            outliers,
            twins,
        }
    }

    /// A sentence for everything that is suspect.
    pub(crate) fn warnings(&self, runs: &[u32]) -> Vec<String> {
        let mut said = Vec::new();
        for worse in &self.worse {
            said.push(format!(
                "{}: the standard deviation of position {} is {:.1} times the pooled one (Cochran's test: probability \
                 {:.2e}); its uncertainty is computed from its own readings, that of the others without it",
                grade(worse.probability),
                worse.index,
                worse.ratio,
                worse.probability
            ));
        }
        for out in &self.outliers {
            let line = out.line.map_or_else(String::new, |line| format!(" (line {line} of the readings)"));
            said.push(format!(
                "{}: position {}, run {}{line}, differs by {:+.2} arcsec from the other runs about {} (Grubbs' test: \
                 probability {:.2e}); it was not excluded; measure it again, or omit the run",
                grade(out.probability),
                out.index,
                out.run,
                out.residual_arcsec,
                AXES[out.axis],
                out.probability
            ));
        }
        if let ([one, other], false) = (runs, self.outliers.is_empty()) {
            said.push(format!("two runs do not show whether run {one} or run {other} is wrong; measure a third run"));
        }
        if !self.outliers.is_empty() && self.worse.is_empty() {
            said.push(
                "because a reading is suspect, single positions were not compared, and all positions state the pooled \
                 standard deviation"
                    .to_owned(),
            );
        }
        for (one, other) in &self.twins {
            said.push(format!(
                "runs {one} and {other} agree more than 30 times better than other runs; check whether one is a copy \
                 of the other"
            ));
        }
        if let Some(test) = self.axes.filter(|test| test.probability < OUTLIER) {
            said.push(format!(
                "the variances about x, y and z differ (Bartlett's test: probability {:.2e}); repeatability_arcsec is \
                 their root mean square, which is too large for one axis and too small for another",
                test.probability
            ));
        }
        said
    }
}

fn grade(probability: f64) -> &'static str {
    if probability < OUTLIER { "outlier" } else { "straggler" }
}

fn groups(variances: &[Variance]) -> Vec<(f64, f64)> {
    variances.iter().map(|v| (v.value, v.degrees_of_freedom)).collect()
}

/// The position whose readings are out in two runs or more: then it is the position that does not repeat.
fn in_several_runs(outliers: &[Outlier]) -> Option<PositionIndex> {
    let several = |out: &&Outlier| outliers.iter().any(|other| other.index == out.index && other.run != out.run);
    outliers.iter().find(several).map(|out| out.index)
}

/// Positions whose variance is too large by Cochran's test, each against those that are left; of the position `only` alone
/// when there is one.
fn worse(header: &Header, components: &Components, only: Option<PositionIndex>) -> Vec<WorsePosition> {
    let mut left: Vec<(usize, (f64, f64))> = groups(&components.position_squares).into_iter().enumerate().collect();
    let mut found = Vec::new();
    while let Some(at) = (0..left.len()).max_by(|a, b| left[*a].1.0.total_cmp(&left[*b].1.0)) {
        let variances: Vec<_> = left.iter().map(|(_, group)| *group).collect();
        let probability = cochran_probability(&variances, at);
        let (place, (variance, _)) = left.remove(at);
        let index = header.positions[place].index();
        // NaN: one position is left.
        if probability.is_nan() || probability >= STRAGGLER || only.is_some_and(|only| only != index) {
            break;
        }
        found.push(WorsePosition { index, place, ratio: variance.sqrt(), probability });
    }
    found
}

/// Readings that no chance explains, each axis by its own scatter.
///
/// The most suspect is taken out, and the next, and so on; those count that were taken out up to the last that is improbable
/// ([Rosner](crate::bibliography::Bibliography::Rosner83)'s procedure, for two that are out hide one another).
fn outliers(header: &Header, readings: &AngleReadings, components: &Components) -> Vec<Outlier> {
    let runs = readings.runs();
    // Two runs are as far from one another as each from the other.
    let values = components.keeps.nrows() * if runs.len() == 2 { 1 } else { runs.len() };
    let probability = |deletion: &Deletion, n: usize| {
        let (t, degrees_of_freedom) = deletion.student(n);
        bonferroni_student(t, values, degrees_of_freedom)
    };
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

/// The readings among those taken out that are still improbable beside the others, taken out alone.
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

/// Pairs of runs that agree far better than others do, by the median of their squared differences: a reading that is out does
/// not touch it.
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
