//! Tests for unequal variances (Bartlett), a largest variance (Cochran) and an outlier (Grubbs).

use super::distributions::{chi_square_larger, deviance};
use super::student::{f_beyond, student_beyond};
use serde::Serialize;

/// Result of Bartlett's test that several variances are equal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Bartlett {
    /// Test statistic, which has approximately the chi-square distribution.
    pub statistic: f64,
    /// Degrees of freedom: the number of groups less one.
    pub degrees_of_freedom: usize,
    /// Probability of a larger statistic if all variances are equal.
    pub probability: f64,
}

/// Tests by Bartlett's method that the variances of several groups, given with their degrees of freedom, are equal.
///
/// Source: [Bartlett](crate::bibliography::Bibliography::Bartlett37); in the form of
/// [the handbook](crate::bibliography::Bibliography::NistHandbook), section 1.3.5.7.
///
/// The result is `None` with fewer than two groups, or if a variance or its degrees of freedom is not a positive
/// number: a group that does not scatter at all is not a sample of a normal distribution.
pub(crate) fn bartlett(groups: &[(f64, f64)]) -> Option<Bartlett> {
    let positive = |value: f64| value > 0.0 && value.is_finite();
    if groups.len() < 2 || !groups.iter().all(|&(variance, nu)| positive(variance) && positive(nu)) {
        return None;
    }
    let total: f64 = groups.iter().map(|(_, nu)| nu).sum();
    let pooled = groups.iter().map(|(variance, nu)| variance * nu).sum::<f64>() / total;
    // Σ ν ln(pooled/variance), as a sum of positive terms: Σ ν (variance − pooled) is 0.
    let logarithms: f64 =
        groups.iter().map(|&(variance, nu)| nu * (deviance(pooled, variance, pooled - variance) / pooled)).sum();
    let reciprocals: f64 = groups.iter().map(|(_, nu)| 1.0 / nu).sum();
    let degrees_of_freedom = groups.len() - 1;
    let statistic = logarithms / (1.0 + (reciprocals - 1.0 / total) / (3.0 * degrees_of_freedom as f64));
    Some(Bartlett { statistic, degrees_of_freedom, probability: chi_square_larger(statistic, degrees_of_freedom) })
}

/// Returns the probability, by Bonferroni's bound, that the variance of any group exceeds the others' as much as that
/// of the group `at` does. This is Cochran's test of the largest variance, for groups given as variance and degrees of
/// freedom.
///
/// Source: [ISO 5725-2](crate::bibliography::Bibliography::Iso5725), 7.3.3, whose critical values are those of this
/// bound. The result is NaN for fewer than two groups or if the others do not vary.
pub(crate) fn cochran_probability(groups: &[(f64, f64)], at: usize) -> f64 {
    let Some(&(variance, own)) = groups.get(at) else { return f64::NAN };
    let others = groups.iter().enumerate().filter(|(place, _)| *place != at).map(|(_, group)| group);
    let (sum, rest) = others.fold((0.0, 0.0), |(sum, rest), (variance, nu)| (sum + variance * nu, rest + nu));
    let beyond = f_beyond(variance * (rest / sum), own, rest);
    (groups.len() as f64 * beyond).clamp(0.0, 1.0)
}

/// Returns the probability, by Bonferroni's bound, that any of `values` residuals of a linear model is as far out as
/// `t`.
///
/// `t` is the deviation from the prediction of all other values, over its standard deviation from their residuals
/// alone, which has `degrees_of_freedom`.
///
/// For a single sample of n values and n − 2 degrees of freedom this is
/// [Grubbs'](crate::bibliography::Bibliography::Grubbs69) two-sided test with G = (n − 1) t / √(n (n − 2 + t²)). For
/// residuals of several means it is Stefansky's test
/// ([maximum normed residual](crate::bibliography::Bibliography::Stefansky72)). The bound is the exact probability
/// where no two residuals can be this far out together, as at the usual critical values, and never too small elsewhere.
/// The result is NaN without degrees of freedom.
pub(crate) fn bonferroni_student(t: f64, values: usize, degrees_of_freedom: f64) -> f64 {
    (values as f64 * student_beyond(t, degrees_of_freedom)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::student::student_factor;

    /// Expected: gear diameters, ten batches of ten: NIST/SEMATECH e-Handbook, 1.3.5.7 with the data of 1.3.5.8.1
    /// (GEAR.DAT): T = 20.78587 with 9 degrees of freedom, critical value at 5 % 16.919.
    #[test]
    #[rustfmt::skip]
    fn bartlett_of_the_handbook() {
        let batches_thousandths = [
            [1006, 996, 998, 1000, 992, 993, 1002, 999, 994, 1000], [998, 1006, 1000, 1002, 997, 998, 996, 1000, 1006, 988],
            [991, 987, 997, 999, 995, 994, 1000, 999, 996, 996], [1005, 1002, 994, 1000, 995, 994, 998, 996, 1002, 996],
            [998, 998, 982, 990, 1002, 984, 996, 993, 980, 996], [1009, 1013, 1009, 997, 988, 1002, 995, 998, 981, 996],
            [990, 1004, 996, 1001, 998, 1000, 1018, 1010, 996, 1002], [998, 1000, 1006, 1000, 1002, 996, 998, 996, 1002, 1006],
            [1002, 998, 996, 995, 996, 1004, 1004, 998, 999, 991], [991, 995, 984, 994, 997, 997, 991, 998, 1004, 997],
        ];
        let groups = batches_thousandths.map(|batch: [i32; 10]| {
            let mean = f64::from(batch.iter().sum::<i32>()) / 10.0;
            (batch.iter().map(|&x| (f64::from(x) - mean) * (f64::from(x) - mean)).sum::<f64>() / 9.0, 9.0)
        });
        let found = bartlett(&groups).unwrap();
        assert!((found.statistic - 20.785_87).abs() < 1e-5, "{}", found.statistic);
        assert_eq!(found.degrees_of_freedom, 9);
        assert!((chi_square_larger(16.919, 9) - 0.05).abs() < 1e-5);
    }

    /// Expected by hand: variances 1 and 4 with 10 degrees of freedom each.
    #[test]
    fn bartlett_by_hand() {
        // pooled 2.5: 10 ln 2.5 + 10 ln 0.625 = 4.462871; C = 1 + (0.2 - 0.05)/3 = 1.05; the ratio 4.250354.
        let found = bartlett(&[(1.0, 10.0), (4.0, 10.0)]).unwrap();
        assert!((found.statistic - 4.250_353).abs() < 1e-5, "{}", found.statistic);
        assert!((found.probability - 0.0392).abs() < 2e-4, "{}", found.probability);
        assert_eq!(bartlett(&[(1.0, 10.0)]), None);
        assert_eq!(bartlett(&[(1.0, 10.0), (0.0, 10.0)]), None);
    }

    /// Expected: Grubbs' two-sided critical values, 5 % and 1 % (F. E. Grubbs and G. Beck, Technometrics 14, 1972,
    /// table 1, columns 2.5 % and 0.5 %; also ISO 5725-2:1994, table 5).
    #[test]
    fn grubbs_table() {
        let table = [
            (3, 1.155, 1.155),
            (4, 1.481, 1.496),
            (5, 1.715, 1.764),
            (6, 1.887, 1.973),
            (8, 2.126, 2.274),
            (10, 2.290, 2.482),
            (15, 2.549, 2.806),
            (20, 2.709, 3.001),
        ];
        for (n, at_5, at_1) in table {
            for (probability, expected) in [(0.05, at_5), (0.01, at_1)] {
                let values = f64::from(n);
                let t = student_factor(probability / values, values - 2.0);
                let found = (values - 1.0) * t / (values * (values - 2.0 + t * t)).sqrt();
                assert!((found - expected).abs() < 1e-3, "{n}: {found}, not {expected}");
                assert!((bonferroni_student(t, n as usize, values - 2.0) - probability).abs() < 1e-9);
            }
        }
        assert!(bonferroni_student(1.0, 2, 0.0).is_nan());
        assert_eq!(bonferroni_student(0.0, 5, 4.0), 1.0);
    }

    /// Expected: ISO 5725-2:1994, table 4: critical values of Cochran's C, eight groups of n values, 5 % and 1 %; the last with the
    /// four digits of C. Eisenhart, M. Hastay and W. Wallis, Techniques of Statistical Analysis, 1947, for 0.3595 is a tie.
    #[test]
    fn cochran_table() {
        let table = [(2, 0.680, 0.794), (3, 0.516, 0.615), (4, 0.438, 0.521), (5, 0.391, 0.463), (6, 0.3595, 0.4226)];
        for (n, at_5, at_1) in table {
            for (expected, c) in [(0.05, at_5), (0.01, at_1)] {
                let of = |c: f64| {
                    let groups: Vec<_> =
                        (0..8).map(|at| (if at == 3 { c } else { (1.0 - c) / 7.0 }, f64::from(n - 1))).collect();
                    cochran_probability(&groups, 3)
                };
                // The table has three digits.
                assert!(of(c - 0.0005) > expected && of(c + 0.0005) < expected, "{n}: {} at {c}", of(c));
            }
        }
        assert!(cochran_probability(&[(1.0, 5.0)], 0).is_nan());
        assert_eq!(cochran_probability(&[(1.0, 5.0), (1.0, 5.0)], 0), 1.0);
    }
}
