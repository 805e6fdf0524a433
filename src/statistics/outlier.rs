//! Tests for a group that scatters more (Bartlett) and for a value that is out (Grubbs).

use super::beta::{student_beyond, student_factor};
use super::distributions::chi_square_larger;

/// The result of Bartlett's test that several variances are equal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bartlett {
    /// The statistic, which has the chi-square distribution approximately.
    pub statistic: f64,
    /// Groups less one.
    pub degrees_of_freedom: usize,
    /// The probability of a larger one when all variances are equal.
    pub probability: f64,
}

/// Bartlett's test that the variances of several groups, given with their degrees of freedom, are equal.
///
/// Source: [Bartlett](crate::bibliography::Bibliography::Bartlett37); in the form of
/// [the handbook](crate::bibliography::Bibliography::NistHandbook), section 1.3.5.7.
///
/// `None` with fewer than two groups, or when a variance or its degrees of freedom is not a positive number: a group
/// that does not scatter at all is no sample of a normal distribution.
pub fn bartlett(groups: &[(f64, f64)]) -> Option<Bartlett> {
    let positive = |value: f64| value > 0.0 && value.is_finite();
    if groups.len() < 2 || !groups.iter().all(|&(variance, nu)| positive(variance) && positive(nu)) {
        return None;
    }
    let total: f64 = groups.iter().map(|(_, nu)| nu).sum();
    let pooled = groups.iter().map(|(variance, nu)| variance * nu).sum::<f64>() / total;
    let logarithms: f64 = groups.iter().map(|(variance, nu)| nu * libm::log(pooled / variance)).sum();
    let reciprocals: f64 = groups.iter().map(|(_, nu)| 1.0 / nu).sum();
    let degrees_of_freedom = groups.len() - 1;
    let statistic = logarithms / (1.0 + (reciprocals - 1.0 / total) / (3.0 * degrees_of_freedom as f64));
    Some(Bartlett { statistic, degrees_of_freedom, probability: chi_square_larger(statistic, degrees_of_freedom) })
}

/// The probability, by Bonferroni's bound, that any of `values` residuals of a linear model with `degrees_of_freedom`
/// is as far out as `g` times its standard deviation: |residual| / (s √(1 − leverage)).
///
/// For a single sample of n values g is Grubbs' G times √(n/(n − 1)), and this is
/// [Grubbs'](crate::bibliography::Bibliography::Grubbs69) two-sided test; for residuals of several means it is Stefansky's
/// ([maximum normed residual](crate::bibliography::Bibliography::Stefansky72)). The bound is the exact probability
/// where no two residuals can be so far out together, as at the usual critical values, and never too small elsewhere.
///
/// NaN with fewer than 2 degrees of freedom: one residual alone then says nothing.
pub fn grubbs_probability(g: f64, values: usize, degrees_of_freedom: f64) -> f64 {
    if degrees_of_freedom.is_nan() || degrees_of_freedom <= 1.0 {
        return f64::NAN;
    }
    // t² = g² (ν − 1)/(ν − g²) has Student's distribution with ν − 1 degrees of freedom.
    let rest = degrees_of_freedom - g * g;
    if rest <= 0.0 {
        return 0.0;
    }
    let t = g * ((degrees_of_freedom - 1.0) / rest).sqrt();
    (values as f64 * student_beyond(t, degrees_of_freedom - 1.0)).min(1.0)
}

/// The g that [`grubbs_probability`] gives `probability`.
pub fn grubbs_critical(probability: f64, values: usize, degrees_of_freedom: f64) -> f64 {
    let t = student_factor(probability / values as f64, degrees_of_freedom - 1.0);
    t * (degrees_of_freedom / (degrees_of_freedom - 1.0 + t * t)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

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
                let g = grubbs_critical(probability, n as usize, values - 1.0);
                let found = g * ((values - 1.0) / values).sqrt();
                assert!((found - expected).abs() < 1e-3, "{n}: {found}, not {expected}");
                assert!((grubbs_probability(g, n as usize, values - 1.0) - probability).abs() < 1e-9);
            }
        }
        assert!(grubbs_probability(1.0, 2, 1.0).is_nan());
        assert_eq!(grubbs_probability(10.0, 5, 4.0), 0.0);
    }
}
