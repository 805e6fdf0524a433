//! Student's t and Fisher's F, through the regularised incomplete beta function.
//!
//! Degrees of freedom are any positive numbers, as Welch and Satterthwaite's formula gives them; infinite ones are the
//! normal and the chi-square distribution.

use super::distributions::{chi_square_larger, falling_root, normal_below};

/// The regularised incomplete beta function I_x(a, b) for positive a and b, 0 ≤ x ≤ 1; NaN outside.
///
/// By the continued fraction DLMF 8.17.22 (<https://dlmf.nist.gov/8.17.E22>), evaluated by Lentz's method on the side of
/// the mean where it converges fast. Relative error below 1e-12 for a and b up to 1e4.
pub fn incomplete_beta(x: f64, a: f64, b: f64) -> f64 {
    let inside = (0.0..=1.0).contains(&x) && a > 0.0 && b > 0.0;
    if !inside {
        return f64::NAN;
    }
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - lower_beta(1.0 - x, b, a);
    }
    lower_beta(x, a, b)
}

/// I_x(a, b) for x below (a + 1)/(a + b + 2).
fn lower_beta(x: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    let logarithm = a * libm::log(x) + b * libm::log1p(-x) + libm::lgamma(a + b) - libm::lgamma(a) - libm::lgamma(b);
    libm::exp(logarithm) / (a * fraction(x, a, b))
}

/// 1 + d₁/(1 + d₂/(1 + …)): DLMF 8.17.22 with its coefficients d.
fn fraction(x: f64, a: f64, b: f64) -> f64 {
    const TINY: f64 = 1e-300;
    const MOST_TERMS: u32 = 10_000;
    let away_from_zero = |value: f64| if value.abs() < TINY { TINY } else { value };
    let (mut value, mut numerator, mut denominator) = (1.0, 1.0, 0.0);
    for term in 1..=MOST_TERMS {
        let m = f64::from(term / 2);
        let d = if term % 2 == 0 {
            m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m))
        } else {
            -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))
        };
        denominator = 1.0 / away_from_zero(1.0 + d * denominator);
        numerator = away_from_zero(1.0 + d / numerator);
        let change = numerator * denominator;
        value *= change;
        if (change - 1.0).abs() < 1e-15 {
            break;
        }
    }
    value
}

/// The probability that |t| of Student's distribution is larger than |`value`|.
pub fn student_beyond(value: f64, degrees_of_freedom: f64) -> f64 {
    if degrees_of_freedom == f64::INFINITY {
        return 2.0 * normal_below(-value.abs());
    }
    let square = value * value;
    if square == f64::INFINITY {
        return 0.0;
    }
    incomplete_beta(degrees_of_freedom / (degrees_of_freedom + square), degrees_of_freedom / 2.0, 0.5)
}

/// The t ≥ 0 that |t| of Student's distribution exceeds with `probability`: the coverage factor for 1 − `probability`.
///
/// NaN for a probability that is not between 0 and 1 or degrees of freedom that are not positive.
pub fn student_factor(probability: f64, degrees_of_freedom: f64) -> f64 {
    if !(probability > 0.0 && probability < 1.0 && degrees_of_freedom > 0.0) {
        return f64::NAN;
    }
    falling_root(|t| student_beyond(t, degrees_of_freedom), probability)
}

/// The probability that F with the given degrees of freedom (numerator, denominator) is larger than `value`.
pub fn f_larger(value: f64, numerator: usize, denominator: f64) -> f64 {
    let n = numerator as f64;
    if denominator == f64::INFINITY {
        return chi_square_larger(value * n, numerator);
    }
    if value.is_nan() || value == f64::INFINITY {
        return if value.is_nan() { f64::NAN } else { 0.0 };
    }
    if numerator == 0 || value <= 0.0 {
        return 1.0;
    }
    incomplete_beta(denominator / (denominator + n * value), denominator / 2.0, n / 2.0)
}

/// The value that chi-square with `degrees_of_freedom` exceeds with `probability`; NaN unless that is between 0 and 1.
pub fn chi_square_point(probability: f64, degrees_of_freedom: usize) -> f64 {
    if !(probability > 0.0 && probability < 1.0) {
        return f64::NAN;
    }
    falling_root(|value| chi_square_larger(value, degrees_of_freedom), probability)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: GUM (JCGM 100:2008), table G.2, columns 95 % and 99 %.
    #[test]
    fn coverage_factors_of_the_guide() {
        let table = [
            (1.0, 12.71, 63.66),
            (2.0, 4.30, 9.92),
            (4.0, 2.78, 4.60),
            (10.0, 2.23, 3.17),
            (16.0, 2.12, 2.92),
            (50.0, 2.01, 2.68),
            (f64::INFINITY, 1.960, 2.576),
        ];
        for (degrees_of_freedom, at_95, at_99) in table {
            for (probability, expected) in [(0.05, at_95), (0.01, at_99)] {
                let found = student_factor(probability, degrees_of_freedom);
                assert!((found - expected).abs() <= 0.005 + 1e-9, "{degrees_of_freedom}: {found}");
            }
        }
    }

    /// Expected: t with 1 and 2 degrees of freedom and F with 2 in the numerator have closed forms:
    /// 1 − (2/π) atan t, 1 − t/√(2 + t²), (1 + 2 F/ν)^(−ν/2).
    #[test]
    fn closed_forms() {
        for t in [0.01, 0.5, 1.0, 3.0, 30.0, 1e4] {
            let one = 2.0 / std::f64::consts::PI * libm::atan(1.0 / t);
            assert!((student_beyond(t, 1.0) / one - 1.0).abs() < 1e-12, "{t}");
            let root = (2.0 + t * t).sqrt();
            let two = 2.0 / (root * (root + t));
            assert!((student_beyond(-t, 2.0) / two - 1.0).abs() < 1e-12, "{t}");
            for nu in [0.7, 5.0, 83.5] {
                let expected = libm::pow(1.0 + 2.0 * t / nu, -nu / 2.0);
                assert!((f_larger(t, 2, nu) / expected - 1.0).abs() < 1e-11, "{t} {nu}");
            }
        }
        assert_eq!(student_beyond(0.0, 3.0), 1.0);
        assert_eq!((f_larger(0.0, 3, 4.0), f_larger(f64::INFINITY, 3, 4.0)), (1.0, 0.0));
        assert!(incomplete_beta(1.5, 1.0, 1.0).is_nan() && student_factor(0.0, 3.0).is_nan());
    }

    /// Expected: upper 5 % points of F in any table (3 and 10: 3.71; 6 and 20: 2.60; 18 and 36: 1.90).
    #[test]
    fn points_of_f() {
        for (numerator, denominator, point) in
            [(3, 10.0, 3.71), (6, 20.0, 2.60), (18, 36.0, 1.90), (3, f64::INFINITY, 2.605)]
        {
            let found = f_larger(point, numerator, denominator);
            assert!((found - 0.05).abs() < 0.001, "{numerator} {denominator}: {found}");
        }
    }
}
