//! Monte Carlo of a calibration: trials until the stated digits are stable, coverage intervals, and whether first order
//! is valid here.
//!
//! Source: [JCGM 101](crate::bibliography::Bibliography::Jcgm101), 7.9 (adaptive procedure), 7.7 (coverage intervals),
//! 8 (validation of first order). A seed gives the same bytes on any number of threads. Memory does not grow with the
//! number of trials.

use super::budget::{Budget, COVERAGE, ParameterBudget};
use super::engine::{BLOCK, Engine, PAIRS, PARAMETERS, pair};
use crate::calibration::{Method, Model, Options, Parameter};
use crate::parallel;
use crate::statistics::student::student_factor;
use crate::text::number::exponent_as_printed;
use dtg_passport_trials::accumulator::{Accumulator, BlockSummary, Scale};
use dtg_passport_trials::bins::{BINS, quantile, shortest};
use dtg_passport_trials::wide_random::WideRandom;
use nalgebra::DMatrix;
use serde::{Serialize, Serializer};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Number of significant digits of a standard uncertainty that must be correct (JCGM 101, 7.9.2).
const DIGITS: i32 = 2;

/// Share of that tolerance within which the Monte Carlo itself must be stable to validate first order (JCGM 101, 8.2).
const SHARE_OF_TOLERANCE: f64 = 0.2;

/// Probability that a difference is beyond the tolerance only by the errors of the Monte Carlo, in any of the 16 ends of
/// intervals, below which first order is not valid.
const BY_CHANCE: f64 = 0.001;

/// Number of blocks in the first wave; the digits are tested after each wave. Fewer do not show how far they are stable.
const FIRST_BLOCKS: u64 = 10;
const MOST_BLOCKS_IN_A_WAVE: u64 = 512;

/// Number of trials after which an adaptive run stops.
pub(crate) const MOST_TRIALS: u64 = 200_000_000;

/// Returns the reason why trials cannot have the model of a calibration, or `None` if it is the paper's without a drift.
pub(crate) fn refused_model(options: &Options) -> Option<&'static str> {
    let same = options.model == Model::Paper && !options.drift;
    (!same).then_some("the Monte Carlo method supports only the paper's model with one constant drift")
}

/// Settings of a Monte Carlo run.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct Trials<'a> {
    /// Number of trials, rounded up to whole blocks of `BLOCK`; `None` runs until the digits are stable.
    pub trials: Option<u64>,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Number of threads; 0 and 1 have the same effect.
    pub threads: usize,
    /// Flag that cancels the run: once it is `true`, no further block is started.
    pub cancel: Option<&'a AtomicBool>,
    /// Function called after every wave with the number of trials done, and with the total as far as it is known.
    pub progress: Option<&'a (dyn Fn(u64, u64) + Sync)>,
}

impl Trials<'_> {
    /// Creates a run that lasts until the digits are stable, on all CPUs that the process may use.
    pub fn adaptive(seed: u64) -> Self {
        let threads = parallel::processors();
        Self { trials: None, seed, threads, cancel: None, progress: None }
    }

    fn is_cancelled(&self) -> bool {
        self.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed))
    }
}

/// Result of a Monte Carlo run; as JSON the key `monte_carlo` of `calibrate`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MonteCarlo {
    /// Method of the calibration.
    pub method: Method,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Number of trials made.
    pub trials: u64,
    /// Number of trials without finite parameters, which are excluded.
    pub failed: u64,
    /// `true` if every stated digit is stable (JCGM 101, 7.9.4).
    pub stable: bool,
    /// Distributions of the parameters, in the order of [`Parameter::EIGHT`].
    pub parameters: Vec<Distribution>,
    /// Covariance of the parameters, 8×8.
    #[serde(serialize_with = "by_rows")]
    pub covariance: DMatrix<f64>,
}

/// Distribution of one parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Distribution {
    /// Parameter of the distribution.
    #[serde(flatten, serialize_with = "with_unit")]
    pub parameter: Parameter,
    /// Mean of the trials.
    pub mean: f64,
    /// Standard deviation of the trials.
    pub standard_uncertainty: f64,
    /// Coverage probability of the intervals.
    pub coverage_probability: f64,
    /// Probabilistically symmetric coverage interval.
    #[serde(rename = "symmetric_interval")]
    pub symmetric: [f64; 2],
    /// Shortest coverage interval.
    #[serde(rename = "shortest_interval")]
    pub shortest: [f64; 2],
    /// Numerical uncertainties: twice the standard deviations of the mean, of the standard uncertainty and of the two
    /// ends of the symmetric interval.
    #[serde(skip)]
    pub numerical: [f64; 4],
    /// First-order interval, y − U and y + U, with which the symmetric one is compared (JCGM 101, clause 8).
    #[serde(rename = "first_order_interval")]
    pub first_order: [f64; 2],
    /// Distances between the lower and between the upper ends of the two intervals.
    pub differences: [f64; 2],
    /// Largest valid distance: half a unit of the second significant digit of the standard uncertainty.
    pub tolerance: f64,
    /// `true` if both distances are within the tolerance; `None` if there are too few trials to decide.
    pub first_order_valid: Option<bool>,
}

/// Writes a parameter as its key and its unit.
fn with_unit<S: Serializer>(parameter: &Parameter, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map([("parameter", parameter.key()), ("unit", parameter.unit())])
}

fn by_rows<S: Serializer>(matrix: &DMatrix<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(matrix.row_iter().map(|row| row.iter().copied().collect::<Vec<f64>>()))
}

/// Runs the trials of `engine`, and compares them with the first-order `budget`.
pub fn monte_carlo(engine: &Engine, budget: &Budget, run: &Trials) -> MonteCarlo {
    // The scale of every parameter, from the first block.
    let scale = Scale::of_pilot(engine.computation.samples(&mut WideRandom::new(run.seed), false));
    let mut series = Series::new(scale, run.seed);
    let asked = run.trials.map(|trials| trials.div_ceil(BLOCK).max(1));
    let mut due = asked.unwrap_or(FIRST_BLOCKS);
    let mut stable = false;
    while series.blocks < due && !run.is_cancelled() {
        let wave = (due - series.blocks).min(MOST_BLOCKS_IN_A_WAVE);
        series.wave(engine, wave, run);
        let ratio = series.instability(budget);
        stable = ratio <= 1.0 && series.blocks >= FIRST_BLOCKS;
        if asked.is_none() && !stable {
            // Twice the standard deviation falls with the root of the trials; add a tenth, and at most quadruple the
            // blocks.
            let enough = (series.blocks as f64 * ratio * ratio * 1.1).ceil();
            let next = enough.clamp(series.blocks as f64 + 2.0, 4.0 * series.blocks as f64) as u64;
            due = next.min(MOST_TRIALS / BLOCK);
        }
        if let Some(progress) = run.progress {
            progress(series.blocks * BLOCK, due * BLOCK);
        }
    }
    series.result(budget, run.seed, stable)
}

/// Accumulated results of all blocks, of a fixed size.
struct Series {
    scale: Scale,
    lanes: WideRandom,
    blocks: u64,
    count: u64,
    failed: u64,
    sums: [f64; PARAMETERS],
    products: [f64; PAIRS],
    /// Counts of the bins of each parameter.
    histograms: Vec<[u64; BINS]>,
    /// Mean of the blocks' values and the sum of squares about it, for the mean, the standard deviation and the two
    /// quantiles of each parameter.
    of_blocks: [[(f64, f64); 4]; 8],
}

impl Series {
    fn new(scale: Scale, seed: u64) -> Self {
        Self {
            scale,
            lanes: WideRandom::new(seed),
            blocks: 0,
            count: 0,
            failed: 0,
            sums: [0.0; PARAMETERS],
            products: [0.0; PAIRS],
            histograms: vec![[0; BINS]; PARAMETERS],
            of_blocks: [[(0.0, 0.0); 4]; 8],
        }
    }

    /// Runs `blocks` blocks on the threads of `run`, and adds them in their order; after a cancellation no further block
    /// is started.
    fn wave(&mut self, engine: &Engine, blocks: u64, run: &Trials) {
        let own_lanes = (0..blocks).map(|_| {
            let lanes = self.lanes.clone();
            self.lanes.jump();
            lanes
        });
        let own_lanes: Vec<WideRandom> = own_lanes.collect();
        let histograms = Mutex::new(&mut self.histograms);
        let of_thread = || (Accumulator::new(self.scale), engine.computation.workspace());
        let summaries = parallel::map_with(&own_lanes, run.threads, of_thread, |(tally, work), lanes| {
            if run.is_cancelled() {
                return None;
            }
            engine.computation.block(&mut lanes.clone(), work, tally);
            Some(tally.end_of_block(&mut histograms.lock().unwrap_or_else(PoisonError::into_inner)))
        });
        summaries.iter().flatten().for_each(|summary| self.add(summary));
    }

    fn add(&mut self, summary: &BlockSummary) {
        self.blocks += 1;
        self.count += summary.count;
        self.failed += summary.failed;
        let good = summary.count.max(2) as f64;
        for place in 0..8 {
            self.sums[place] += summary.sums[place];
            let mean = summary.sums[place] / good;
            let variance = (summary.products[pair(place, place)] - good * mean * mean) / (good - 1.0);
            let [low, high] = summary.quantiles[place];
            let values = [mean, variance.max(0.0).sqrt(), low, high];
            for ((mean, squares), value) in self.of_blocks[place].iter_mut().zip(values) {
                // Welford's update.
                let before = value - *mean;
                *mean += before / self.blocks as f64;
                *squares += before * (value - *mean);
            }
        }
        for (sum, product) in self.products.iter_mut().zip(&summary.products) {
            *sum += product;
        }
    }

    /// Returns twice the standard deviations of the means over blocks of the four values of a parameter, in its unit.
    fn numerical(&self, place: usize) -> [f64; 4] {
        let blocks = self.blocks as f64;
        if self.blocks < 2 {
            return [f64::INFINITY; 4];
        }
        self.of_blocks[place]
            .map(|(_, squares)| 2.0 * (squares / (blocks * (blocks - 1.0))).sqrt() * self.scale.unit[place])
    }

    /// Returns the largest of these uncertainties relative to its limit; at most 1 if every digit is stable.
    fn instability(&self, budget: &Budget) -> f64 {
        let of = |(place, line): (usize, &ParameterBudget)| {
            let u = self.standard_deviation(place);
            let limit = SHARE_OF_TOLERANCE * tolerance(if u > 0.0 { u } else { line.standard_uncertainty });
            self.numerical(place).into_iter().fold(0.0, |worst: f64, value| worst.max(value / limit))
        };
        budget.parameters.iter().take(8).enumerate().map(of).fold(0.0, f64::max)
    }

    fn standard_deviation(&self, place: usize) -> f64 {
        self.covariance(place, place).max(0.0).sqrt()
    }

    fn covariance(&self, one: usize, other: usize) -> f64 {
        let (row, column) = (one.max(other), one.min(other));
        let count = self.count.max(2) as f64;
        let product = self.products[pair(row, column)];
        let about_mean = product - self.sums[row] * self.sums[column] / count;
        about_mean / (count - 1.0) * self.scale.unit[row] * self.scale.unit[column]
    }

    fn result(&self, budget: &Budget, seed: u64, stable: bool) -> MonteCarlo {
        let distribution = |(place, line): (usize, &ParameterBudget)| {
            let (centre, unit) = (self.scale.centre[place], self.scale.unit[place]);
            let value = |scaled: f64| centre + unit * scaled;
            let counts = &self.histograms[place];
            let symmetric = [0.5 - COVERAGE / 2.0, 0.5 + COVERAGE / 2.0].map(|share| value(quantile(counts, share)));
            let standard_uncertainty = self.standard_deviation(place);
            let numerical = self.numerical(place);
            let errors = [numerical[2], numerical[3]].map(|twice| twice / 2.0);
            let (half, tolerance) = (line.expanded_uncertainty(), tolerance(line.standard_uncertainty));
            let first_order = [line.value - half, line.value + half];
            let differences = [0, 1].map(|end: usize| (first_order[end] - symmetric[end]).abs());
            Distribution {
                parameter: line.parameter,
                mean: value(self.sums[place] / self.count.max(1) as f64),
                standard_uncertainty,
                coverage_probability: COVERAGE,
                symmetric,
                shortest: shortest(counts, COVERAGE).map(value),
                numerical,
                first_order,
                differences,
                tolerance,
                first_order_valid: valid(differences, tolerance, errors, self.blocks),
            }
        };
        MonteCarlo {
            method: budget.method,
            seed,
            trials: self.count + self.failed,
            failed: self.failed,
            stable,
            parameters: budget.parameters.iter().take(8).enumerate().map(distribution).collect(),
            covariance: DMatrix::from_fn(8, 8, |row, column| self.covariance(row, column)),
        }
    }
}

/// Returns `true` if both differences are within the tolerance for every Monte Carlo error with a probability of 95 %,
/// `false` if one is beyond it for all but improbable errors, otherwise `None`. The errors have Student's distribution,
/// because few blocks may agree by chance. JCGM 101, 8.2 requires a fifth of the tolerance, which decides all but close cases.
fn valid(differences: [f64; 2], tolerance: f64, errors: [f64; 2], blocks: u64) -> Option<bool> {
    let freedom = blocks.checked_sub(1).filter(|freedom| *freedom > 0)? as f64;
    let [usual, largest] = [1.0 - COVERAGE, BY_CHANCE / 16.0].map(|beyond| student_factor(beyond, freedom));
    let mut ends = differences.into_iter().zip(errors);
    if ends.clone().any(|(difference, error)| difference - largest * error > tolerance) {
        return Some(false);
    }
    ends.all(|(difference, error)| difference + usual * error <= tolerance).then_some(true)
}

/// Returns δ = ½ · 10ˡ for u = c · 10ˡ with c of two digits (JCGM 101, 7.9.2), or infinity if u is not positive.
pub(crate) fn tolerance(u: f64) -> f64 {
    if !(u.is_finite() && u > 0.0) {
        return f64::INFINITY;
    }
    0.5 * libm::pow(10.0, f64::from(exponent_as_printed(u, DIGITS) - (DIGITS - 1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_told_yet_is_not_told() {
        // Student's t with 9 degrees of freedom: 2.26 for 95 % (tables), 7.01 for 1 − 0.001/16 (its density, integrated).
        assert_eq!(valid([1.0, 2.7], 5.0, [1.0, 1.0], 10), Some(true));
        assert_eq!(valid([1.0, 2.8], 5.0, [1.0, 1.0], 10), None);
        assert_eq!(valid([1.0, 11.9], 5.0, [1.0, 1.0], 10), None);
        assert_eq!(valid([1.0, 12.1], 5.0, [1.0, 1.0], 10), Some(false));
        // Two blocks can agree by chance; one tells nothing.
        assert_eq!(valid([1.0, 11.6], 5.0, [0.1, 0.1], 2), None);
        assert_eq!(valid([1.0, 8.0], 5.0, [0.0, 0.0], 1), None);
    }

    /// Expected: the examples of JCGM 101, 7.9.2: u = 0.25 mg gives δ = 0.005 mg; u = 2 K with one digit would give 0.5.
    #[test]
    fn numerical_tolerances_of_the_guide() {
        for (u, due) in [(0.25, 0.005), (0.0996, 0.005), (1.5e-4, 5e-6), (12.0, 0.5), (99.6, 5.0)] {
            assert!((tolerance(u) / due - 1.0).abs() < 1e-12, "{u}: {}", tolerance(u));
        }
        assert_eq!(tolerance(0.0), f64::INFINITY);
    }
}
