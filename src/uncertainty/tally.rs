//! What millions of trials leave behind: sums, products and histograms of a fixed size, whatever the number of trials.
//!
//! Values are counted in [`BINS`] bins over ±[`REACH`] standard deviations of a pilot run. A quantile is interpolated in
//! its bin: it is off by less than a bin, 0.0049 standard deviations, and by w² |f′|/(8 f) where the density f is smooth
//! over a bin of width w: for a normal distribution 6e-6 standard deviations at 2.5 % and 97.5 %. Means, variances and
//! covariances do not come from bins.

#![allow(clippy::needless_range_loop, reason = "a loop over trials that indexes several columns is what becomes wide")]

use super::engine::Solutions;
use crate::statistics::lanes::{Column, WIDTH};

/// Bins of a histogram.
pub const BINS: usize = 4096;

/// How far a histogram reaches either way, in standard deviations of the pilot run.
pub const REACH: f64 = 10.0;

/// Parameters counted.
const PARAMETERS: usize = 8;

/// Pairs of parameters, each with itself too.
const PAIRS: usize = PARAMETERS * (PARAMETERS + 1) / 2;

/// The scale of every parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Middle of the histogram.
    pub centre: [f64; PARAMETERS],
    /// One standard deviation.
    pub unit: [f64; PARAMETERS],
}

impl Scale {
    /// From a pilot sample of every parameter: median, and a quarter of the width of the middle 95 % (3.92 standard
    /// deviations of a normal distribution).
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

/// Means, standard deviations and quantiles of one block, in units of the scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlockSummary {
    /// Good trials.
    pub count: u64,
    /// Trials that gave no finite parameters.
    pub failed: u64,
    /// Sums of the values.
    pub sums: [f64; PARAMETERS],
    /// Sums of products, by rows of the lower triangle.
    pub products: [f64; PAIRS],
    /// Quantiles at 2.5 % and 97.5 %.
    pub quantiles: [[f64; 2]; PARAMETERS],
}

/// Counts of every parameter's bins.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Histograms {
    counts: Vec<u64>,
}

impl Default for Histograms {
    fn default() -> Self {
        Self { counts: vec![0; PARAMETERS * BINS] }
    }
}

impl Histograms {
    /// Adds what another one counted. The order does not matter.
    pub fn merge(&mut self, other: &Self) {
        for (count, more) in self.counts.iter_mut().zip(&other.counts) {
            *count += more;
        }
    }

    /// The bins of a parameter.
    pub fn of(&self, place: usize) -> Bins<'_, u64> {
        Bins(&self.counts[place * BINS..(place + 1) * BINS])
    }
}

/// Bins of one parameter.
#[derive(Debug, Clone, Copy)]
pub struct Bins<'a, T>(&'a [T]);

/// The value at a place counted in bins from the lower end.
fn value_at(bins: f64) -> f64 {
    bins * (2.0 * REACH / BINS as f64) - REACH
}

impl<T: Copy + Into<u64>> Bins<'_, T> {
    fn total(&self) -> u64 {
        self.0.iter().map(|count| (*count).into()).sum()
    }

    /// The value that `share` of the sample does not exceed, in units of the scale about its centre; 0 of nothing.
    pub fn quantile(&self, share: f64) -> f64 {
        let due = share * self.total() as f64;
        self.at_count(due)
    }

    fn at_count(&self, due: f64) -> f64 {
        let mut below = 0.0;
        for (bin, count) in self.0.iter().enumerate() {
            let count = (*count).into() as f64;
            if count > 0.0 && below + count >= due {
                return value_at(bin as f64 + (due - below) / count);
            }
            below += count;
        }
        0.0
    }

    /// The shortest interval that holds `share` of the sample (JCGM 101, 5.3.4 and 7.7.3), in units of the scale.
    pub fn shortest(&self, share: f64) -> [f64; 2] {
        let total = self.total() as f64;
        let (mut best, mut width) = ([self.quantile(0.0), self.quantile(1.0)], f64::INFINITY);
        let mut below = 0.0;
        // The upper end moves up with the lower one.
        let (mut upper, mut below_upper) = (0, 0.0);
        for (bin, count) in self.0.iter().enumerate() {
            let due = below + share * total;
            if due > total {
                break;
            }
            while upper < self.0.len() && below_upper + (self.0[upper].into() as f64) < due {
                below_upper += self.0[upper].into() as f64;
                upper += 1;
            }
            let in_bin = self.0.get(upper).map_or(1.0, |count| (*count).into() as f64);
            let high = value_at(upper as f64 + (due - below_upper) / in_bin.max(1.0));
            let low = value_at(bin as f64);
            if high - low < width {
                (best, width) = ([low, high], high - low);
            }
            below += (*count).into() as f64;
        }
        best
    }
}

/// Counts the trials of one thread.
#[derive(Debug, Clone)]
pub struct Tally {
    scale: Scale,
    /// Bins of the block, then of all blocks.
    block: Vec<u32>,
    all: Histograms,
    sums: [Column; PARAMETERS],
    products: [Column; PAIRS],
    count: u64,
    failed: u64,
}

impl Tally {
    /// Nothing counted yet.
    pub fn new(scale: Scale) -> Self {
        Self {
            scale,
            block: vec![0; PARAMETERS * BINS],
            all: Histograms::default(),
            sums: [[0.0; WIDTH]; PARAMETERS],
            products: [[0.0; WIDTH]; PAIRS],
            count: 0,
            failed: 0,
        }
    }

    /// A chunk of trials.
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
        if !together.iter().sum::<f64>().is_finite() {
            self.leave_out_failures(&mut scaled, &together);
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
    }

    /// Trials without finite parameters count as the centre, and are told.
    #[cold]
    #[inline(never)]
    fn leave_out_failures(&mut self, scaled: &mut Solutions, together: &Column) {
        for trial in (0..WIDTH).filter(|trial| !together[*trial].is_finite()) {
            self.failed += 1;
            for column in scaled.iter_mut() {
                column[trial] = 0.0;
            }
        }
    }

    #[inline(always)]
    fn count_bins(&mut self, scaled: &Solutions) {
        const PER_UNIT: f64 = BINS as f64 / (2.0 * REACH);
        // 2^52: the mantissa's lowest bits are then the whole number nearest to what was added.
        const WHOLE: f64 = 4_503_599_627_370_496.0;
        for (place, column) in scaled.iter().enumerate() {
            let mut bins = [0_u64; WIDTH];
            for trial in 0..WIDTH {
                let bin = (column[trial] + REACH) * PER_UNIT - 0.5;
                let bin = if bin > 0.0 { bin } else { 0.0 };
                let bin = if bin < (BINS - 1) as f64 { bin } else { (BINS - 1) as f64 };
                bins[trial] = (bin + WHOLE).to_bits() & (BINS as u64 - 1);
            }
            let counts = &mut self.block[place * BINS..(place + 1) * BINS];
            for bin in bins {
                counts[bin as usize] += 1;
            }
        }
    }

    /// What the block says, and on to the next.
    pub fn end_of_block(&mut self) -> BlockSummary {
        let mut quantiles = [[0.0; 2]; PARAMETERS];
        for (place, quantiles) in quantiles.iter_mut().enumerate() {
            let counts = &self.block[place * BINS..(place + 1) * BINS];
            let (low, high) = (0.025 * self.count as f64, 0.975 * self.count as f64);
            *quantiles = [Bins(counts).at_count(low), Bins(counts).at_count(high)];
        }
        for (all, count) in self.all.counts.iter_mut().zip(&mut self.block) {
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

    /// The histograms of all blocks.
    pub fn histograms(&self) -> &Histograms {
        &self.all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: quantiles of the normal distribution by `normal_quantile`, of a sample that is its own quantiles; the
    /// shortest interval of a symmetric density is the symmetric one.
    #[test]
    fn quantiles_of_a_normal_sample() {
        use crate::statistics::distributions::normal_quantile;
        let scale = Scale { centre: [5.0; PARAMETERS], unit: [2.0; PARAMETERS] };
        let mut tally = Tally::new(scale);
        let chunks = 4000;
        for chunk in 0..chunks {
            let column = std::array::from_fn(|trial| {
                let share = ((chunk * WIDTH + trial) as f64 + 0.5) / (chunks * WIDTH) as f64;
                5.0 + 2.0 * normal_quantile(share)
            });
            tally.add(&[column; PARAMETERS]);
        }
        let summary = tally.end_of_block();
        assert_eq!((summary.count, summary.failed), ((chunks * WIDTH) as u64, 0));
        for place in 0..PARAMETERS {
            let bins = tally.histograms().of(place);
            for share in [0.025, 0.3, 0.5, 0.975] {
                assert!((bins.quantile(share) - normal_quantile(share)).abs() < 2e-4, "{share}");
            }
            let [low, high] = bins.shortest(0.95);
            assert!((high - low - 2.0 * 1.959_964).abs() < 1e-3 && (low + 1.96).abs() < 0.05, "{low} {high}");
            assert!((summary.quantiles[place][1] - 1.959_964).abs() < 2e-4);
            assert!(summary.sums[place].abs() < 1e-6);
        }
        assert!((summary.products[0] / summary.count as f64 - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_trial_that_fails_is_told() {
        let mut tally = Tally::new(Scale { centre: [0.0; PARAMETERS], unit: [1.0; PARAMETERS] });
        let mut column = [0.5; WIDTH];
        column[3] = f64::NAN;
        column[4] = f64::INFINITY;
        tally.add(&[column; PARAMETERS]);
        let summary = tally.end_of_block();
        assert_eq!((summary.count, summary.failed), (WIDTH as u64, 2));
        assert!((summary.sums[0] - 15.0).abs() < 1e-12);
    }
}
