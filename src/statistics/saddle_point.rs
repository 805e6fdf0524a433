//! Terms of the binomial and the Poisson distribution for parameters of any size.
//!
//! Source: [Loader](crate::bibliography::Bibliography::Loader00). Differences of logarithms of the gamma function lose
//! all digits if the parameters are large. These functions use only the small remainder of Stirling's formula and the
//! deviance.

use std::f64::consts::PI;

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
pub(crate) fn poisson_term(a: f64, t: f64) -> f64 {
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
