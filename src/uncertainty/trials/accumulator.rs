//! Accumulated results of Monte Carlo trials: sums, products and histograms, whose size does not depend on the number
//! of trials.
//!
//! Values are counted in [bins](crate::bins) in units of the standard deviations of a pilot run. Means,
//! variances and covariances are computed from the values themselves, not from the bins.

#![allow(clippy::needless_range_loop, reason = "a loop over trials that indexes several columns is what becomes wide")]

use crate::bins::{BINS, bin, quantile};
use crate::wide_random::{Column, WIDTH};
use crate::{PAIRS, PARAMETERS, Solutions};

/// Centre and unit of the histogram of every parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Value at the middle of the histogram.
    pub centre: [f64; PARAMETERS],
    /// Standard deviation in the pilot sample.
    pub unit: [f64; PARAMETERS],
}

impl Scale {
    /// Computes the scale from a pilot sample of every parameter: the median, and the width of the middle 95 % divided
    /// by 3.92 (its width in standard deviations of a normal distribution).
    pub fn of_pilot(mut samples: [Vec<f64>; PARAMETERS]) -> Self {
        let (mut centre, mut unit) = ([0.0; PARAMETERS], [1.0; PARAMETERS]);
        for (place, sample) in samples.iter_mut().enumerate() {
            sample.retain(|value| value.is_finite());
            sample.sort_unstable_by(f64::total_cmp);
            let at = |share: f64| sample.get((share * sample.len() as f64) as usize).copied().unwrap_or(0.0);
            let width = at(0.975) - at(0.025);
            centre[place] = at(0.5);
            unit[place] = if width > 0.0 { width / 3.92 } else { 1.0 };
        }
        Self { centre, unit }
    }
}

/// Sums, products and quantiles of one block, in units of the scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlockSummary {
    /// Number of trials with finite parameters.
    pub count: u64,
    /// Number of trials without finite parameters.
    pub failed: u64,
    /// Sums of the values.
    pub sums: [f64; PARAMETERS],
    /// Sums of products, row by row of the lower triangle.
    pub products: [f64; PAIRS],
    /// Quantiles at 2.5 % and 97.5 %.
    pub quantiles: [[f64; 2]; PARAMETERS],
}

/// Accumulator for the trials of one thread.
#[derive(Debug, Clone)]
pub struct Accumulator {
    scale: Scale,
    /// Counts of the current block.
    block: Vec<u32>,
    sums: [Column; PARAMETERS],
    products: [Column; PAIRS],
    count: u64,
    failed: u64,
}

impl Accumulator {
    /// Creates an accumulator of nothing.
    pub fn new(scale: Scale) -> Self {
        Self {
            scale,
            block: vec![0; PARAMETERS * BINS],
            sums: [[0.0; WIDTH]; PARAMETERS],
            products: [[0.0; WIDTH]; PAIRS],
            count: 0,
            failed: 0,
        }
    }

    /// Adds the trials of a chunk.
    #[inline(always)]
    pub fn add(&mut self, solutions: &Solutions) {
        let mut scaled = [[0.0; WIDTH]; PARAMETERS];
        let mut together = [0.0; WIDTH];
        for place in 0..PARAMETERS {
            let (centre, factor) = (self.scale.centre[place], 1.0 / self.scale.unit[place]);
            for trial in 0..WIDTH {
                let value = (solutions[place][trial] - centre) * factor;
                scaled[place][trial] = value;
                together[trial] += value.abs();
            }
        }
        self.count += WIDTH as u64;
        let failures = !together.iter().sum::<f64>().is_finite();
        if failures {
            leave_out_failures(&mut scaled, &together);
        }
        let mut pair = 0;
        for row in 0..PARAMETERS {
            for trial in 0..WIDTH {
                self.sums[row][trial] += scaled[row][trial];
            }
            for column in 0..=row {
                for trial in 0..WIDTH {
                    self.products[pair][trial] += scaled[row][trial] * scaled[column][trial];
                }
                pair += 1;
            }
        }
        self.count_bins(&scaled);
        if failures {
            self.uncount_failures(&together);
        }
    }

    /// Removes the trials without finite parameters from the counts, and adds them to the failed ones.
    #[cold]
    #[inline(never)]
    fn uncount_failures(&mut self, together: &Column) {
        let failed = together.iter().filter(|sum| !sum.is_finite()).count();
        for counts in self.block.chunks_exact_mut(BINS) {
            counts[bin(0.0)] -= u32::try_from(failed).unwrap_or(u32::MAX);
        }
        self.count -= failed as u64;
        self.failed += failed as u64;
    }

    #[inline(always)]
    fn count_bins(&mut self, scaled: &Solutions) {
        for (place, column) in scaled.iter().enumerate() {
            let mut bins = [0; WIDTH];
            for trial in 0..WIDTH {
                bins[trial] = bin(column[trial]);
            }
            let counts = &mut self.block[place * BINS..(place + 1) * BINS];
            for bin in bins {
                counts[bin] += 1;
            }
        }
    }

    /// Returns the summary of the block, adds the counts of each parameter to those of `all` blocks, and starts the next one.
    pub fn end_of_block(&mut self, all: &mut [[u64; BINS]]) -> BlockSummary {
        let quantiles = std::array::from_fn(|place| {
            let counts = &self.block[place * BINS..(place + 1) * BINS];
            [0.025, 0.975].map(|share| quantile(counts, share))
        });
        for (all, count) in all.as_flattened_mut().iter_mut().zip(&mut self.block) {
            *all += u64::from(*count);
            *count = 0;
        }
        let sums = self.sums.map(|column| column.iter().sum());
        let products = self.products.map(|column| column.iter().sum());
        let summary = BlockSummary { count: self.count, failed: self.failed, sums, products, quantiles };
        (self.sums, self.products) = ([[0.0; WIDTH]; PARAMETERS], [[0.0; WIDTH]; PAIRS]);
        (self.count, self.failed) = (0, 0);
        summary
    }
}

/// Replaces trials without finite parameters by zeros, which add nothing to sums.
#[cold]
#[inline(never)]
fn leave_out_failures(scaled: &mut Solutions, together: &Column) {
    for trial in (0..WIDTH).filter(|trial| !together[*trial].is_finite()) {
        for column in scaled.iter_mut() {
            column[trial] = 0.0;
        }
    }
}
