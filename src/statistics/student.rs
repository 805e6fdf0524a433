//! Student's t distribution: how wide an interval must be when the uncertainty itself is only estimated.

use super::distributions::{normal_below, normal_quantile};

/// The probability that Student's t with `degrees_of_freedom` (positive, not necessarily whole) is below `t`; the
/// normal probability at infinitely many. NaN where either is not usable.
///
/// P(t) = 1 − I(x; ν/2, 1/2)/2 for t ≥ 0 with x = ν/(ν + t²), I being the regularised incomplete beta function.
pub fn student_below(t: f64, degrees_of_freedom: f64) -> f64 {
    if degrees_of_freedom == f64::INFINITY {
        return normal_below(t);
    }
    if t.is_nan() || degrees_of_freedom.is_nan() || degrees_of_freedom <= 0.0 {
        return f64::NAN;
    }
    let tail = 0.5 * beta_tail(degrees_of_freedom, t);
    if t > 0.0 { 1.0 - tail } else { tail }
}

/// The `t` below which Student's t is with the given probability (between 0 and 1); by bisection, for it is called once
/// a result. NaN where an argument is not usable.
pub fn student_quantile(probability: f64, degrees_of_freedom: f64) -> f64 {
    if degrees_of_freedom == f64::INFINITY {
        return normal_quantile(probability);
    }
    if !(probability > 0.0 && probability < 1.0) || degrees_of_freedom.is_nan() || degrees_of_freedom <= 0.0 {
        return f64::NAN;
    }
    if probability > 0.5 {
        return -student_quantile(1.0 - probability, degrees_of_freedom);
    }
    let mut low = -1.0;
    while student_below(low, degrees_of_freedom) > probability && low > -1e300 {
        low *= 2.0;
    }
    let mut high = 0.0;
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return high;
        }
        if student_below(middle, degrees_of_freedom) < probability {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// I(x; ν/2, 1/2) with x = ν/(ν + t²), and 1 − x computed without cancellation.
fn beta_tail(degrees_of_freedom: f64, t: f64) -> f64 {
    let (a, b) = (0.5 * degrees_of_freedom, 0.5);
    let square = t * t;
    let (x, rest) = (degrees_of_freedom / (degrees_of_freedom + square), square / (degrees_of_freedom + square));
    if rest == 0.0 {
        return 1.0;
    }
    if x == 0.0 {
        return 0.0;
    }
    let logarithm = libm::lgamma(a + b) - libm::lgamma(a) - libm::lgamma(b) + a * libm::log(x) + b * libm::log(rest);
    let factor = libm::exp(logarithm);
    // The fraction converges fast on one side of the mean; the other side is one minus the mirror image.
    if x < (a + 1.0) / (a + b + 2.0) {
        factor * continued_fraction(x, a, b) / a
    } else {
        1.0 - factor * continued_fraction(rest, b, a) / b
    }
}

/// The continued fraction of the incomplete beta function, by Lentz's method.
fn continued_fraction(x: f64, a: f64, b: f64) -> f64 {
    const TINY: f64 = 1e-300;
    const MOST_TERMS: u32 = 10_000;
    let away_from_zero = |value: f64| if value.abs() < TINY { TINY } else { value };
    let mut c = 1.0;
    let mut d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0));
    let mut fraction = d;
    for term in 1..MOST_TERMS {
        let m = f64::from(term);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut change = 1.0;
        for coefficient in [even, odd] {
            d = 1.0 / away_from_zero(1.0 + coefficient * d);
            c = away_from_zero(1.0 + coefficient / c);
            change = d * c;
            fraction *= change;
        }
        if (change - 1.0).abs() < 1e-16 {
            break;
        }
    }
    fraction
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: JCGM 100:2008, table G.2 (two-sided 95 %, 95.45 %, 99 %), and closed forms: t with 1 degree of freedom
    /// is Cauchy's, P = 1/2 + atan(t)/π; with 2, P = 1/2 + t/(2 √(2 + t²)).
    #[test]
    fn points_of_the_guide() {
        let table = [
            (1.0, 12.71, 13.97, 63.66),
            (2.0, 4.30, 4.53, 9.92),
            (3.0, 3.18, 3.31, 5.84),
            (5.0, 2.57, 2.65, 4.03),
            (16.0, 2.12, 2.17, 2.92),
            (50.0, 2.01, 2.05, 2.68),
            (100.0, 1.984, 2.025, 2.626),
        ];
        for (degrees_of_freedom, at_95, at_9545, at_99) in table {
            for (p, due) in [(0.95, at_95), (0.9545, at_9545), (0.99, at_99)] {
                let found = student_quantile(0.5 + p / 2.0, degrees_of_freedom);
                assert!((found - due).abs() < 0.0051, "{degrees_of_freedom} {p}: {found} {due}");
            }
        }
        for t in [-50.0_f64, -3.0, -0.2, 0.0, 1e-6, 0.7, 2.5, 80.0] {
            let cauchy = 0.5 + libm::atan(t) / std::f64::consts::PI;
            assert!((student_below(t, 1.0) - cauchy).abs() < 1e-13, "{t}");
            let two = 0.5 + t / (2.0 * (2.0 + t * t).sqrt());
            assert!((student_below(t, 2.0) - two).abs() < 1e-13, "{t}");
        }
        assert!((student_quantile(0.975, 1e7) - 1.959_964).abs() < 1e-5);
        assert!(student_quantile(0.975, 0.0).is_nan() && student_quantile(1.0, 3.0).is_nan());
    }
}
