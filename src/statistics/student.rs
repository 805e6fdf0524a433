//! Student's t with the effective degrees of freedom of a sum, and Fisher's F, computed through the regularised incomplete
//! beta function.
//!
//! Degrees of freedom are any positive numbers, as Welch and Satterthwaite's formula gives them. Infinite ones give the
//! normal and the chi-square distribution.

use super::distributions::{binomial_term, chi_square_larger, falling_root, normal_below};

/// Returns the regularised incomplete beta function I_x(a, b), given both x and y = 1 − x so that neither loses digits;
/// a and b positive, 0 ≤ x ≤ 1.
///
/// The continued fraction of [Didonato and Morris](crate::bibliography::Bibliography::DidonatoMorris92), (9), is used
/// on the side of the mean where it converges fast. The other side is 1 minus that, and never a small probability.
fn incomplete_beta(x: f64, y: f64, a: f64, b: f64) -> f64 {
    if (b + 1.0) * x > (a + 1.0) * y { 1.0 - lower_beta(y, x, b, a) } else { lower_beta(x, y, a, b) }
}

/// Returns I_x(a, b) for x below (a + 1)/(a + b + 2).
fn lower_beta(x: f64, y: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    // xᵃ yᵇ/B(a, b)
    let power = binomial_term(x, y, a, b) / (1.0 / a + 1.0 / b);
    power / fraction(x, y, a, b)
}

/// Returns β₀ + α₁/(β₁ + α₂/(β₂ + …)) by Lentz's method.
///
/// This is the even part of DLMF 8.17.22. With a → ∞ its terms become those of the incomplete gamma function, so their
/// number does not grow with a.
fn fraction(x: f64, y: f64, a: f64, b: f64) -> f64 {
    const TINY: f64 = 1e-300;
    const MOST_TERMS: u32 = 100_000;
    let away_from_zero = |value: f64| if value.abs() < TINY { TINY } else { value };
    let beta = |m: f64| {
        let (below, above) = (a + 2.0 * m - 1.0, a + 2.0 * m + 1.0);
        let rest = a * y - b * x + 1.0 + m * (1.0 + y);
        let first = if m > 0.0 { m + m * ((b - m) * x / below) } else { 0.0 };
        first + (a + m) / above * rest
    };
    let mut value = away_from_zero(beta(0.0));
    let (mut numerator, mut denominator) = (value, 0.0);
    for m in (1..=MOST_TERMS).map(f64::from) {
        let below = a + 2.0 * m - 1.0;
        // In this order no product overflows, however large a or b.
        let alpha = m * ((a + m - 1.0) / below) * ((a + b + m - 1.0) * x / below) * ((b - m) * x);
        let beta = beta(m);
        denominator = 1.0 / away_from_zero(beta + alpha * denominator);
        numerator = away_from_zero(beta + alpha / numerator);
        let change = numerator * denominator;
        value *= change;
        if (change - 1.0).abs() < f64::EPSILON {
            break;
        }
    }
    value
}

/// Returns the probability that |t| of Student's distribution is larger than |`value`|.
pub(crate) fn student_beyond(value: f64, degrees_of_freedom: f64) -> f64 {
    if degrees_of_freedom == f64::INFINITY {
        return 2.0 * normal_below(-value.abs());
    }
    f_beyond(value * value, 1.0, degrees_of_freedom)
}

/// Returns the probability that F with `numerator` and `denominator` degrees of freedom, both finite, is larger than
/// `value`; NaN where one of the three is NaN or a number of degrees of freedom is not positive.
pub(crate) fn f_beyond(value: f64, numerator: f64, denominator: f64) -> f64 {
    if value.is_nan() || !(numerator > 0.0 && denominator > 0.0) {
        return f64::NAN;
    }
    // x = ν/(ν + n F) and 1 − x, each computed without a difference.
    let ratio = numerator * value / denominator;
    if ratio <= 0.0 {
        return 1.0;
    }
    let (x, y) = (1.0 / (1.0 + ratio), if ratio > 1.0 { 1.0 / (1.0 + 1.0 / ratio) } else { ratio / (1.0 + ratio) });
    incomplete_beta(x, y, denominator / 2.0, numerator / 2.0)
}

/// Returns the t ≥ 0 that |t| of Student's distribution exceeds with `probability`: the coverage factor for
/// 1 − `probability`.
///
/// The result is NaN for a probability that is not between 0 and 1 or degrees of freedom that are not positive.
pub(crate) fn student_factor(probability: f64, degrees_of_freedom: f64) -> f64 {
    if !(probability > 0.0 && probability < 1.0 && degrees_of_freedom > 0.0) {
        return f64::NAN;
    }
    falling_root(|t| student_beyond(t, degrees_of_freedom), probability)
}

/// Returns the probability that F with the given degrees of freedom (numerator, denominator) is larger than `value`.
pub(crate) fn f_larger(value: f64, numerator: usize, denominator: f64) -> f64 {
    let n = numerator as f64;
    if denominator == f64::INFINITY {
        return chi_square_larger(value * n, numerator);
    }
    if numerator == 0 && !value.is_nan() {
        return 1.0;
    }
    f_beyond(value, n, denominator)
}

/// Returns the probability that F with `numerator` and `denominator` degrees of freedom is larger than `value` if the
/// numerator has the `non_centrality` λ: the mean of central probabilities with Poisson's weights of mean λ/2.
fn non_central_f_larger(value: f64, numerator: usize, denominator: f64, non_centrality: f64) -> f64 {
    /// Standard deviations of the distribution of Poisson beyond which its weights do not count.
    const REACH: f64 = 9.0;
    let mean = non_centrality / 2.0;
    let reach = REACH * (mean.sqrt() + 1.0);
    let terms = (mean - reach).max(0.0) as usize..=(mean + reach) as usize;
    let weight =
        |j: f64| if j > 0.0 { libm::exp(j * libm::log(mean) - mean - libm::lgamma(j + 1.0)) } else { libm::exp(-mean) };
    terms
        .map(|j| {
            let n = numerator + 2 * j;
            weight(j as f64) * f_larger(value * numerator as f64 / n as f64, n, denominator)
        })
        .sum()
}

/// Returns √λ that the test of F with the given degrees of freedom finds with a probability of 95 %, where it takes an F for
/// a change that is larger by chance with the probability `level` only: for one degree of freedom of the numerator, the
/// change in units of its standard uncertainty. Returns `None` if that is more than 100, as for one degree
/// of freedom of the denominator or fewer.
pub(crate) fn detectable(level: f64, numerator: usize, denominator: f64) -> Option<f64> {
    const MISSED: f64 = 0.05;
    // The number of terms grows with λ, which has no bound for few degrees of freedom.
    const LARGEST: f64 = 100.0;
    let critical = falling_root(|value| f_larger(value, numerator, denominator), level);
    let missed = |root: f64| 1.0 - non_central_f_larger(critical, numerator, denominator, root * root);
    (missed(LARGEST) <= MISSED).then(|| falling_root(missed, MISSED))
}

/// Returns the value that chi-square with `degrees_of_freedom` exceeds with `probability`, or NaN if `probability` is
/// not between 0 and 1.
pub(crate) fn chi_square_point(probability: f64, degrees_of_freedom: usize) -> f64 {
    if !(probability > 0.0 && probability < 1.0) {
        return f64::NAN;
    }
    falling_root(|value| chi_square_larger(value, degrees_of_freedom), probability)
}

/// Returns the effective degrees of freedom of a sum of independent contributions, each (standard uncertainty, degrees
/// of freedom), by Welch and Satterthwaite's formula
/// ([GUM](crate::bibliography::Bibliography::Gum), eq. (G.2b)); infinite if all of them are known exactly.
pub(crate) fn effective_degrees_of_freedom(contributions: &[(f64, f64)]) -> f64 {
    let variance: f64 = contributions.iter().map(|(u, _)| u * u).sum();
    let doubt: f64 = contributions.iter().map(|(u, nu)| u * u * u * u / nu).sum();
    if doubt > 0.0 { variance * variance / doubt } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: tests/vectors/distributions.csv, which says how it was computed. Probabilities down to 1e-300 for degrees
    /// of freedom from 0.7 to 1e300.
    #[test]
    fn every_digit_at_any_degrees_of_freedom() {
        let mut worst: f64 = 0.0;
        for line in include_str!("../../tests/vectors/distributions.csv").lines() {
            let cells: Vec<&str> = line.split(',').collect();
            let ["t" | "f" | "chi" | "factor", numbers @ ..] = cells.as_slice() else { continue };
            let [value, numerator, denominator, probability] =
                <[f64; 4]>::try_from(numbers.iter().map(|cell| cell.parse().unwrap()).collect::<Vec<_>>()).unwrap();
            let (found, due) = match cells[0] {
                "t" => (student_beyond(value, denominator), probability),
                "factor" => (student_factor(probability, denominator), value),
                "f" => (f_larger(value, numerator as usize, denominator), probability),
                _ => (chi_square_larger(value, numerator as usize), probability),
            };
            // Far out a probability changes by the exponent's own rounding: ln p rounded in its last place.
            let limit = 2e-13_f64.max(4.0 * f64::EPSILON * -libm::log(due.min(1.0)));
            let off = (found / due - 1.0).abs();
            worst = worst.max(off);
            assert!(off < limit || (due < 1e-307 && found < 1e-306), "{line}: {found:e}, off by {off:e}");
        }
        assert!(worst > 0.0);
    }

    /// Expected: SciPy 1.17, `brentq(lambda l: ncf.sf(f.isf(level, n, nu), n, nu, l) - 0.95, 0, 1e4)`, with `ncx2` and `chi2`
    /// for infinite ν; for n = 1 and infinite ν by hand, z(1 − level/2) + z(0.95), the other tail being below 1e-9.
    #[test]
    fn the_change_that_is_found_with_95_percent() {
        for (level, numerator, denominator, non_centrality) in [
            (0.01 / 8.0, 3, 40.0, 35.815_769_036_844_5),
            (0.01, 6, 12.0, 54.342_648_900_308),
            (0.01, 3, 8.0, 49.856_178_937_092),
            (0.01 / 24.0, 3, 14.6, 64.783_134_991_623),
            (0.01, 1, f64::INFINITY, (2.575_829_303_548_9_f64 + 1.644_853_626_951_5).powi(2)),
            (0.01 / 8.0, 3, f64::INFINITY, 29.183_423_902_110),
        ] {
            let found = detectable(level, numerator, denominator).unwrap();
            assert!((found * found / non_centrality - 1.0).abs() < 1e-9, "{level} {numerator} {denominator}: {found}");
        }
    }

    /// Expected: SciPy 1.17, `ncf.sf(f.isf(0.01 / 8, 3, nu), 3, nu, 1e4)`: 0.0782 for one degree of freedom; with fewer it falls.
    #[test]
    fn few_degrees_of_freedom_find_nothing() {
        for denominator in [1.0, 0.5, 0.01, 1e-9] {
            assert_eq!(detectable(0.01 / 8.0, 3, denominator), None, "{denominator}");
        }
    }

    /// Expected: by definition.
    #[test]
    fn what_has_no_digits() {
        assert_eq!((student_beyond(0.0, 3.0), student_beyond(-3.0, 2.0)), (1.0, student_beyond(3.0, 2.0)));
        assert_eq!((f_larger(0.0, 3, 4.0), f_larger(f64::INFINITY, 3, 4.0)), (1.0, 0.0));
        assert!(f_larger(1.0, 1, -1.0).is_nan() && student_factor(0.0, 3.0).is_nan());
    }

    /// Equal contributions with equal degrees of freedom add them up; one that is exact adds none of its own.
    #[test]
    fn degrees_of_freedom_add() {
        assert!((effective_degrees_of_freedom(&[(1.0, 4.0), (1.0, 4.0)]) - 8.0).abs() < 1e-15);
        assert!((effective_degrees_of_freedom(&[(1.0, 4.0), (1.0, f64::INFINITY)]) - 16.0).abs() < 1e-15);
        assert_eq!(effective_degrees_of_freedom(&[(1.0, f64::INFINITY)]), f64::INFINITY);
    }

    /// Expected: the coverage factor falls with the degrees of freedom, to that of the normal distribution (1.959964).
    #[test]
    fn the_coverage_factor_falls_to_that_of_the_normal_distribution() {
        let (mut last, mut degrees_of_freedom) = (f64::INFINITY, 1.0);
        while degrees_of_freedom < 1e300 {
            let found = student_factor(0.05, degrees_of_freedom);
            assert!(found <= last * (1.0 + 4.0 * f64::EPSILON), "{degrees_of_freedom}: {found} after {last}");
            assert!(found >= 1.959_963_984_540_054 * (1.0 - 4.0 * f64::EPSILON), "{degrees_of_freedom}: {found}");
            last = found;
            degrees_of_freedom *= if degrees_of_freedom < 1e20 { 1.37 } else { 1e7 };
        }
        assert!((last - 1.959_963_984_540_054).abs() < 1e-14, "{last}");
    }
}
