//! Summaries of a sample: largest value, mean, standard deviation, percentiles, standard error of a share.

/// Largest magnitude, mean and standard deviation of a sample, accumulated value by value.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Summary {
    pub(crate) count: u64,
    sum: f64,
    sum_of_squares: f64,
    /// Largest magnitude, or 0 for an empty sample.
    pub(crate) worst: f64,
}

impl Summary {
    pub(crate) fn add(&mut self, value: f64) {
        self.count += 1;
        self.sum += value;
        self.sum_of_squares += value * value;
        self.worst = self.worst.max(value.abs());
    }

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

/// Returns the smallest value that at least `share` of a sample in ascending order does not exceed, or `None` if the sample
/// is empty.
pub(crate) fn percentile<T: Copy>(ascending: &[T], share: f64) -> Option<T> {
    let due = (share * ascending.len() as f64).ceil() as usize;
    ascending.get(due.saturating_sub(1)).copied()
}

/// Returns the standard error of a share `part` / `whole` of independent trials (binomial), or 0 for an empty sample.
pub(crate) fn binomial_standard_error(part: u64, whole: u64) -> f64 {
    if whole == 0 {
        return 0.0;
    }
    let share = part as f64 / whole as f64;
    (share * (1.0 - share) / whole as f64).sqrt()
}

/// Returns the upper limit, at 95 % and one-sided, of a share of which `whole` independent trials showed no case: the
/// share p with (1 − p)ⁿ = 0.05.
pub(crate) fn upper_limit_without_a_case(whole: u64) -> f64 {
    -libm::expm1(libm::log(0.05) / whole as f64)
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

    /// Expected by hand: 19 of 20 values are 3, the last is 8.
    #[test]
    fn percentiles_of_twenty() {
        let mut sample = vec![3; 19];
        assert_eq!(percentile(&sample, 0.95), Some(3));
        sample.push(8);
        assert_eq!(
            [0.0, 0.95, 0.96, 1.0].map(|share| percentile(&sample, share)),
            [Some(3), Some(3), Some(8), Some(8)]
        );
        assert_eq!(percentile::<u16>(&[], 0.5), None);
        assert!((binomial_standard_error(50, 100) - 0.05).abs() < 1e-15);
    }

    /// Expected by hand: no case in two trials has the probability (1 − p)², which is 0.05 if p = 1 − √0.05.
    #[test]
    fn no_case_does_not_mean_never() {
        for (whole, limit) in [(1, 0.95), (2, 1.0 - 0.05_f64.sqrt())] {
            assert!((upper_limit_without_a_case(whole) - limit).abs() < 1e-15, "{whole}");
        }
    }
}
