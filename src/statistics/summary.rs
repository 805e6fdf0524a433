//! Summaries of a sample: largest value, mean, standard deviation, percentiles, standard error of a share.

/// Largest magnitude, mean and standard deviation of a sample, accumulated value by value.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Summary {
    /// Number of values.
    pub(crate) count: u64,
    sum: f64,
    sum_of_squares: f64,
    /// Largest magnitude, or 0 for an empty sample.
    pub(crate) worst: f64,
}

impl Summary {
    /// Adds a value to the sample.
    pub(crate) fn add(&mut self, value: f64) {
        self.count += 1;
        self.sum += value;
        self.sum_of_squares += value * value;
        self.worst = self.worst.max(value.abs());
    }

    /// Returns the summary of this sample together with another one.
    #[must_use]
    pub(crate) fn with(self, other: &Self) -> Self {
        Self {
            count: self.count + other.count,
            sum: self.sum + other.sum,
            sum_of_squares: self.sum_of_squares + other.sum_of_squares,
            worst: self.worst.max(other.worst),
        }
    }

    /// Returns the mean, or 0 for an empty sample.
    pub(crate) fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }

    /// Returns the standard deviation about the mean, or 0 for fewer than two values.
    ///
    /// The values are errors about zero without a large offset, so the difference of sums loses no significant digits.
    pub(crate) fn standard_deviation(&self) -> f64 {
        if self.count < 2 {
            return 0.0;
        }
        let about_mean = self.sum_of_squares - self.sum * self.mean();
        (about_mean / (self.count - 1) as f64).max(0.0).sqrt()
    }
}

/// Counts of the whole numbers up to a limit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Histogram(Vec<u64>);

impl Histogram {
    /// Creates an empty histogram for numbers up to `largest`.
    pub(crate) fn up_to(largest: usize) -> Self {
        Self(vec![0; largest + 1])
    }

    /// Counts `value`; a value above the limit counts as the limit.
    pub(crate) fn add(&mut self, value: usize) {
        let last = self.0.len() - 1;
        if let Some(count) = self.0.get_mut(value.min(last)) {
            *count += 1;
        }
    }

    /// Adds the counts of another histogram with the same limit.
    pub(crate) fn merge(&mut self, other: &Self) {
        for (count, more) in self.0.iter_mut().zip(&other.0) {
            *count += more;
        }
    }

    /// Returns the number of values counted.
    pub(crate) fn count(&self) -> u64 {
        self.0.iter().sum()
    }

    /// Returns the mean of the values, or `None` if there are none.
    pub(crate) fn mean(&self) -> Option<f64> {
        let sum: u64 = self.0.iter().enumerate().map(|(value, count)| value as u64 * count).sum();
        (self.count() > 0).then(|| sum as f64 / self.count() as f64)
    }

    /// Returns the smallest number that at least `share` of the sample does not exceed, or `None` if the sample is
    /// empty.
    pub(crate) fn percentile(&self, share: f64) -> Option<usize> {
        let due = (share * self.count() as f64).ceil() as u64;
        let mut below = 0;
        self.0.iter().position(|count| {
            below += count;
            below > 0 && below >= due
        })
    }

    /// Returns the largest number counted, or `None` if the sample is empty.
    pub(crate) fn most(&self) -> Option<usize> {
        self.0.iter().rposition(|count| *count > 0)
    }
}

/// Returns the standard error of a share `part` / `whole` of independent trials (binomial), or 0 for an empty sample.
pub(crate) fn binomial_standard_error(part: u64, whole: u64) -> f64 {
    if whole == 0 {
        return 0.0;
    }
    let share = part as f64 / whole as f64;
    (share * (1.0 - share) / whole as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected by hand: 1, 2, 3, 6 have mean 3 and variance (4 + 1 + 0 + 9)/3.
    #[test]
    fn summary_of_four_values() {
        let mut first = Summary::default();
        let mut second = Summary::default();
        [1.0, 2.0].into_iter().for_each(|value| first.add(value));
        [3.0, 6.0].into_iter().for_each(|value| second.add(value));
        let all = first.with(&second);
        assert_eq!((all.count, all.worst, all.mean()), (4, 6.0, 3.0));
        assert!((all.standard_deviation() - (14.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!(Summary::default().standard_deviation(), 0.0);
    }

    /// Expected by hand.
    #[test]
    fn histogram_of_twenty() {
        let mut histogram = Histogram::up_to(10);
        (0..19).for_each(|_| histogram.add(3));
        assert_eq!(histogram.percentile(0.95), Some(3));
        histogram.add(8);
        assert_eq!(
            (histogram.percentile(0.95), histogram.percentile(1.0), histogram.most()),
            (Some(3), Some(8), Some(8))
        );
        assert_eq!(histogram.mean(), Some(65.0 / 20.0));
        assert_eq!(Histogram::up_to(3).percentile(0.5), None);
        assert!((binomial_standard_error(50, 100) - 0.05).abs() < 1e-15);
    }
}
