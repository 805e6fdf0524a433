//! Chi-square and normal probabilities, and terms of the binomial and the Poisson distribution for parameters of any size.
//!
//! Source of the terms: [Loader](crate::bibliography::Bibliography::Loader00). Differences of logarithms of the gamma function
//! lose all digits if the parameters are large. These functions use only the small remainder of Stirling's formula and the
//! deviance.

use std::f64::consts::{PI, SQRT_2};

/// Returns the probability that chi-square with `degrees_of_freedom` is larger than `value`.
///
/// The result is 1 without degrees of freedom or for a value of 0 or less, 0 for infinity, and NaN if `value` is NaN.
///
/// Above the mean, Q(k/2, x/2) for whole k is a finite sum of positive terms: Q(a + 1, t) = Q(a, t) + tᵃ e⁻ᵗ/Γ(a + 1),
/// from Q(1, t) = e⁻ᵗ or Q(1/2, t) = erfc √t. No digits are lost, however far out in the tail. Below the mean, where
/// the probability is never small, it is 1 minus the series DLMF 8.11.4.
pub(crate) fn chi_square_larger(value: f64, degrees_of_freedom: usize) -> f64 {
    if value.is_nan() || value == f64::INFINITY {
        return if value.is_nan() { f64::NAN } else { 0.0 };
    }
    if degrees_of_freedom == 0 || value <= 0.0 {
        return 1.0;
    }
    let (t, a) = (value / 2.0, degrees_of_freedom as f64 / 2.0);
    if t < a { 1.0 - gamma_below(a, t) } else { gamma_above(a, t) }
}

/// Returns P(a, t) for t < a, where the terms of the series decrease.
fn gamma_below(a: f64, t: f64) -> f64 {
    let (mut term, mut sum, mut next) = (poisson_term(a, t), 0.0, a);
    while term > f64::EPSILON * sum {
        sum += term;
        next += 1.0;
        term *= t / next;
    }
    sum
}

/// Returns Q(a, t) for t ≥ a and a whole 2 a, from the largest term down.
fn gamma_above(a: f64, t: f64) -> f64 {
    let (mut next, mut sum) = (a - 1.0, 0.0);
    let mut term = if next >= 0.0 { poisson_term(next, t) } else { 0.0 };
    while next >= 0.0 {
        sum += term;
        if term <= f64::EPSILON * sum {
            return sum;
        }
        term *= next / t;
        next -= 1.0;
    }
    if a.fract() == 0.0 { sum } else { sum + libm::erfc(t.sqrt()) }
}

/// Returns xᵃ yᵇ Γ(a + b + 1)/(Γ(a + 1) Γ(b + 1)) for x + y = 1, all positive.
pub(crate) fn binomial_term(x: f64, y: f64, a: f64, b: f64) -> f64 {
    let n = a + b;
    let excess = a * y - b * x;
    let logarithm = stirling_error(n)
        - stirling_error(a)
        - stirling_error(b)
        - deviance(a, n * x, excess)
        - deviance(b, n * y, -excess);
    // √(n/(2π a b)), without the product a b, which may overflow.
    libm::exp(logarithm) * ((1.0 / a + 1.0 / b) / (2.0 * PI)).sqrt()
}

/// Returns tᵃ e⁻ᵗ/Γ(a + 1) for a ≥ 0 and positive t.
fn poisson_term(a: f64, t: f64) -> f64 {
    if a == 0.0 {
        return libm::exp(-t);
    }
    libm::exp(-stirling_error(a) - deviance(a, t, a - t)) / (2.0 * PI * a).sqrt()
}

/// Returns x ln(x/m) + m − x, given `difference` = x − m as exactly as possible.
pub(crate) fn deviance(x: f64, m: f64, difference: f64) -> f64 {
    let v = difference / (x + m);
    if v.abs() >= 0.1 {
        return x * libm::log(x / m) - difference;
    }
    // ln(x/m) = 2 artanh v; after its first term, difference · v remains.
    let (mut sum, mut power) = (difference * v, 2.0 * x * v);
    for j in 1..100 {
        power *= v * v;
        let next = sum + power / f64::from(2 * j + 1);
        if next == sum {
            break;
        }
        sum = next;
    }
    sum
}

/// Returns ln Γ(n + 1) − (n + ½) ln n + n − ½ ln 2π for positive n.
fn stirling_error(n: f64) -> f64 {
    if n < 16.0 {
        return libm::lgamma(n + 1.0) - (n + 0.5) * libm::log(n) + n - 0.5 * libm::log(2.0 * PI);
    }
    // DLMF 5.11.1; the omitted terms are below 2e-17.
    let r = 1.0 / (n * n);
    let series = 1.0 / 12.0
        - r * (1.0 / 360.0 - r * (1.0 / 1260.0 - r * (1.0 / 1680.0 - r * (1.0 / 1188.0 - r * (691.0 / 360_360.0)))));
    series / n
}

/// Returns the probability that a standard normal variable is below `x`.
pub(crate) fn normal_below(x: f64) -> f64 {
    0.5 * libm::erfc(-x / SQRT_2)
}

/// Returns the `x` below which a standard normal variable is with the given probability: infinite at 0 and 1, NaN
/// outside.
#[cfg(test)]
pub(crate) fn normal_quantile(probability: f64) -> f64 {
    if probability > 0.5 {
        return -normal_quantile(1.0 - probability);
    }
    if probability.is_nan() || probability < 0.0 {
        return f64::NAN;
    }
    if probability == 0.0 {
        return f64::NEG_INFINITY;
    }
    -falling_root(|x| normal_below(-x), probability)
}

/// Returns the x ≥ 0 where `falling`, which never increases, has fallen to `level`.
///
/// It takes secants between the ends of an interval that is also halved. The number of steps is therefore at most twice
/// that of bisection, and usually a dozen.
pub(crate) fn falling_root(falling: impl Fn(f64) -> f64, level: f64) -> f64 {
    /// Rounding error of a probability, relative to the level.
    const ROUNDING: f64 = 4.0 * f64::EPSILON;
    let above = |x: f64| falling(x) - level;
    let (mut low, mut at_low) = (0.0, above(0.0));
    let (mut high, mut at_high) = (1.0, above(1.0));
    while at_high > 0.0 && high < f64::MAX / 2.0 {
        (low, at_low) = (high, at_high);
        high *= 2.0;
        at_high = above(high);
    }
    loop {
        let secant = low + (high - low) * (at_low / (at_low - at_high));
        for next in [secant, 0.5 * (low + high)] {
            if next > low && next < high {
                let at_next = above(next);
                if at_next.abs() <= ROUNDING * level {
                    return next;
                }
                if at_next > 0.0 {
                    (low, at_low) = (next, at_next);
                } else {
                    (high, at_high) = (next, at_next);
                }
            }
        }
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return high;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: by definition; `beta` compares every digit of the rest.
    #[test]
    fn chi_square_at_its_ends() {
        assert_eq!(chi_square_larger(0.0, 8), 1.0);
        assert_eq!(chi_square_larger(1e300, 8), 0.0);
        assert_eq!(chi_square_larger(f64::INFINITY, 8), 0.0);
        assert!(chi_square_larger(f64::NAN, 8).is_nan());
    }

    /// Expected: the usual quantiles, from tables.
    #[test]
    fn normal_points() {
        for (probability, x) in [(0.5, 0.0), (0.975, 1.959_963_984_540_054), (0.841_344_746_068_543, 1.0)] {
            assert!((normal_quantile(probability) - x).abs() < 1e-9, "{probability}");
            assert!((normal_below(x) - probability).abs() < 1e-12, "{x}");
        }
        assert!((normal_below(-10.0) / 7.619_853_024_160_527e-24 - 1.0).abs() < 1e-12);
        assert_eq!(normal_quantile(0.0), f64::NEG_INFINITY);
        assert!(normal_quantile(1.5).is_nan());
    }
}
