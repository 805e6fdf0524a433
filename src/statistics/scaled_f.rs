//! Distribution of z′ Ĉ⁻¹ z where parts of the covariance Ĉ are themselves estimates.
//!
//! [`larger`] treats one of the estimates exactly: it averages over the distribution of this estimate, which may have very
//! few degrees of freedom.
//!
//! Source: [Kenward and Roger](crate::bibliography::Bibliography::KenwardRoger97), section 4. The first two moments, to
//! first order in the variances of the estimates, are those of a scaled F. With one estimate of all of Ĉ the
//! distribution is F itself; without estimates it is chi-square.

use super::student::f_larger;

/// Part of the covariance that is scaled by one estimate with few degrees of freedom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Part {
    /// Degrees of freedom of the estimate.
    pub(crate) degrees_of_freedom: f64,
    /// Trace of S = C^(−½) P C^(−½), P being the part and C the whole.
    pub(crate) trace: f64,
    /// Trace of S S.
    pub(crate) square: f64,
}

/// Share of the covariance below which a part changes no digit of a probability. A part that the parameters absorb is
/// nothing but rounding, and so would be the degrees of freedom from its moments.
const ROUNDING: f64 = 1e-6;

/// Scaled F distribution: `scale` · z′ Ĉ⁻¹ z / `numerator` has F with `numerator` and `denominator` degrees of freedom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ScaledF {
    numerator: usize,
    scale: f64,
    /// Degrees of freedom of the denominator; infinite if nothing was estimated.
    pub(crate) denominator: f64,
}

impl ScaledF {
    /// Creates the distribution of a quadratic form in `numerator` dimensions.
    pub(crate) fn new(numerator: usize, parts: &[Part]) -> Self {
        let known = Self { numerator, scale: 1.0, denominator: f64::INFINITY };
        let least = ROUNDING * numerator as f64;
        let parts = || parts.iter().filter(|part| part.degrees_of_freedom.is_finite() && part.trace > least);
        let sum = |of: fn(&Part) -> f64| parts().map(|part| 2.0 / part.degrees_of_freedom * of(part)).sum::<f64>();
        let (a1, a2) = (sum(|part| part.trace * part.trace), sum(|part| part.square));
        if numerator == 0 || a2 <= 0.0 {
            return known;
        }
        let p = numerator as f64;
        let b = (a1 + 6.0 * a2) / (2.0 * p);
        let g = ((p + 1.0) * a1 - (p + 4.0) * a2) / ((p + 2.0) * a2);
        let [c1, c2, c3] = [g, p - g, p - g + 2.0].map(|c| c / (3.0 * p + 2.0 * (1.0 - g)));
        // 1/E, and ρ = V/(2 E²) as a fraction; both vanish if the estimate has 2 degrees of freedom.
        let apart = |value: f64| if value.abs() < 1e-6 { 1e-6 } else { value };
        let inverse_mean = apart(1.0 - a2 / p);
        let below = apart(1.0 - c2 * b) * apart(1.0 - c2 * b) * (1.0 - c3 * b);
        let above = (1.0 + c1 * b) * inverse_mean * inverse_mean;
        let denominator = 4.0 + (p + 2.0) * below / (above - below);
        let scale = denominator * inverse_mean / (denominator - 2.0);
        let fewest = parts().map(|part| part.degrees_of_freedom).fold(f64::INFINITY, f64::min);
        if scale > 0.0 && scale.is_finite() && denominator >= fewest {
            Self { numerator, scale, denominator }
        } else {
            // No scaled F has these moments: use the degrees of freedom of the poorest estimate.
            Self { denominator: fewest, ..known }
        }
    }

    /// Returns the probability that the quadratic form is larger than `value`.
    pub(crate) fn larger(&self, value: f64) -> f64 {
        f_larger(self.scale * value / self.numerator as f64, self.numerator, self.denominator)
    }
}

/// Weight, relative to the sum, below which [`larger`] leaves out the rest of a distribution.
const NEGLIGIBLE: f64 = 1e-17;

/// Returns the probability by chance of a quadratic form in `numerator` dimensions that is larger than the one found.
///
/// `parts` are all estimates, and `averaged` is the index of the one over whose distribution the probability is averaged.
/// `value(w)` is the quadratic form if this estimate is multiplied by w.
///
/// The true variance is w times its estimate, where ν/w has chi-square with ν degrees of freedom. The moments of
/// [`ScaledF`] judge how uncertain the covariance is by the share of the estimate, and so least of all where the estimate
/// is too small by chance. With one estimate of all of Ĉ the mean is F as well. The other estimates enter by their
/// moments.
pub(crate) fn larger(numerator: usize, parts: &[Part], averaged: Option<usize>, value: impl Fn(f64) -> f64) -> f64 {
    let Some(averaged) = averaged.filter(|&estimate| parts[estimate].degrees_of_freedom.is_normal()) else {
        return ScaledF::new(numerator, parts).larger(value(1.0));
    };
    let mut others = parts.to_vec();
    let half = others.remove(averaged).degrees_of_freedom / 2.0;
    let of_others = ScaledF::new(numerator, &others);
    // With w = e^(−s) the density is analytic and falls off exponentially, so that equal steps are enough.
    // The step is limited by the width of the density, and for few degrees of freedom by its growth off the real axis.
    let step = f64::min(0.35, 0.6 / half.sqrt());
    let (mut sum, mut weights) = (0.0, 0.0);
    for direction in [-step, step] {
        let mut number = if direction > 0.0 { 1.0 } else { 0.0 };
        loop {
            let s = number * direction;
            let weight = libm::exp(half * (s - libm::expm1(s)));
            sum += weight * of_others.larger(value(libm::exp(-s)));
            weights += weight;
            number += 1.0;
            // No probability is larger than 1, so the rest is at most of the order of this weight. A sum of probabilities too
            // small for a number is 0, and the weights become 0 too.
            if weight.is_nan() || weight <= NEGLIGIBLE * sum {
                break;
            }
        }
    }
    sum / weights
}

#[cfg(all(test, feature = "monte-carlo"))]
mod tests {
    use super::*;
    use crate::statistics::distributions::chi_square_larger;
    use crate::statistics::random::Stream;

    /// Expected: with one estimate of all the covariance z′ Ĉ⁻¹ z/p is F with p and ν by definition; with none, chi-square.
    #[test]
    fn one_estimate_is_f_itself() {
        for (p, nu) in [(1, 1.0), (1, 6.0), (2, 3.0), (8, 1.5), (8, 18.0), (24, 2.0), (8, 1e9)] {
            let size = p as f64;
            let found = ScaledF::new(p, &[Part { degrees_of_freedom: nu, trace: size, square: size }]);
            for value in [0.3, 1.0, 4.0] {
                let due = f_larger(value, p, nu);
                assert!((found.larger(value * size) / due - 1.0).abs() < 1e-4, "{p} {nu}: {found:?}");
            }
        }
        let rounding = Part { degrees_of_freedom: 4.0, trace: 2e-14, square: 2e-28 };
        for parts in [&[][..], &[rounding]] {
            assert_eq!(ScaledF::new(8, parts).larger(9.0), chi_square_larger(9.0, 8));
        }
    }

    /// Expected: F, if the estimate is of all the covariance.
    #[test]
    fn the_mean_over_an_estimate_of_all_is_f() {
        for (p, nu) in [(1, 1.0), (2, 2.0), (2, 4.0), (8, 2.0), (8, 14.0), (24, 300.0), (8, 1e5)] {
            let part = Part { degrees_of_freedom: nu, trace: f64::from(p), square: f64::from(p) };
            let p = p as usize;
            for value in [0.3, 1.0, 4.0, 40.0] {
                let (found, due) = (larger(p, &[part], Some(0), |w| value * p as f64 / w), f_larger(value, p, nu));
                assert!((found - due).abs() < 1e-8 * due + 1e-30, "{p} {nu} {value}: {found} {due}");
            }
        }
    }

    /// Twenty rounds of eight positions that do not fit at all; half of the variance is the estimated noise of the visits.
    /// Whatever that noise is, chi-square exceeds 6000 with 300 degrees of freedom, whose probability is below 1e-1000.
    #[test]
    fn a_probability_too_small_for_a_number_is_0() {
        let part = Part { degrees_of_freedom: 280.0, trace: 150.0, square: 75.0 };
        for value in [1e4, 1e6, 1e12] {
            let found = larger(300, &[part], Some(0), |w| value / (0.5 + 0.5 * w.min(2.0)));
            assert!((0.0..1e-300).contains(&found), "{value}: {found}");
        }
    }

    /// Expected: never more than the probability itself, within three standard errors: eight numbers, a share of whose
    /// variance is one estimate with few degrees of freedom. The moments alone give far more.
    #[test]
    fn an_estimate_of_a_share() {
        const TRIALS: u32 = 20_000;
        let mut worst = 0;
        for (seed, (nu, share)) in [(2, 0.2), (2, 0.5), (2, 0.8), (4, 0.5), (14, 0.5)].into_iter().enumerate() {
            let mut stream = Stream::new(40 + seed as u64);
            let (mut improbable, mut by_moments) = (0, 0);
            for _ in 0..TRIALS {
                let estimate = (0..nu).map(|_| stream.normal().powi(2)).sum::<f64>() / f64::from(nu) * share;
                let squares = (0..8).map(|_| stream.normal().powi(2)).sum::<f64>();
                let form = |w: f64| squares / (1.0 - share + w * estimate);
                let of_all = estimate / (1.0 - share + estimate);
                let part =
                    Part { degrees_of_freedom: f64::from(nu), trace: 8.0 * of_all, square: 8.0 * of_all * of_all };
                improbable += u32::from(larger(8, &[part], Some(0), form) < 0.05);
                by_moments += u32::from(ScaledF::new(8, &[part]).larger(form(1.0)) < 0.05);
            }
            let (due, error) = (f64::from(TRIALS) * 0.05, (f64::from(TRIALS) * 0.05 * 0.95).sqrt());
            assert!(f64::from(improbable) < due + 3.0 * error, "{nu} {share}: {improbable}");
            assert!(f64::from(improbable) > 0.2 * due, "{nu} {share}: {improbable}");
            worst = worst.max(by_moments);
        }
        assert!(worst > 2 * TRIALS / 20, "{worst}");
    }

    /// Expected: by simulation, 5 % within two standard errors and half a percent: eight numbers, whose variance is
    /// partly known, partly one estimate with six degrees of freedom for each of three groups and one with three for a
    /// direction that all share.
    #[test]
    fn parts_of_several_estimates() {
        use nalgebra::{SMatrix, SVector};

        let (shares, known, nu, common, nu_common) = ([1.2, 0.9, 0.7], 0.2, 6.0, 0.3, 3.0);
        let mut stream = Stream::new(3);
        let mut chi = |nu: f64| (0..nu as usize).map(|_| stream.normal().powi(2)).sum::<f64>() / nu;
        let draws: Vec<([f64; 3], f64)> = (0..20_000).map(|_| ([chi(nu), chi(nu), chi(nu)], chi(nu_common))).collect();
        let mut stream = Stream::new(4);
        let mut improbable = [0, 0];
        for (factors, factor) in draws {
            let shared = (common / 8.0_f64).sqrt() * stream.normal();
            let own = |place: usize| f64::sqrt(known + shares[place % 3]);
            let z = SVector::<f64, 8>::from_fn(|place, _| own(place) * stream.normal() + shared);
            // Parts at the estimates, as a calibration takes them: S by its elements.
            let of_group = |group: usize| {
                let estimate = |place: usize| if place % 3 == group { shares[group] * factors[group] } else { 0.0 };
                SMatrix::<f64, 8, 8>::from_diagonal(&SVector::from_fn(|place, _| estimate(place)))
            };
            let of_all = SMatrix::from_element(common * factor / 8.0);
            let estimates = [of_group(0), of_group(1), of_group(2), of_all];
            let covariance = estimates.iter().sum::<SMatrix<f64, 8, 8>>() + SMatrix::identity() * known;
            let inverse = covariance.try_inverse().expect("a covariance");
            let parts = [0, 1, 2, 3].map(|place| {
                let s = inverse * estimates[place];
                let degrees_of_freedom = [nu, nu, nu, nu_common][place];
                Part { degrees_of_freedom, trace: s.trace(), square: (s * s).trace() }
            });
            let value = z.dot(&(inverse * z));
            improbable[0] += u32::from(ScaledF::new(8, &parts).larger(value) < 0.05);
            improbable[1] += u32::from(chi_square_larger(value, 8) < 0.05);
        }
        let percent = improbable.map(|count| f64::from(count) / 200.0);
        assert!((percent[0] - 5.0).abs() < 0.8, "{percent:?}");
        assert!(percent[1] > 7.0, "{percent:?}");
    }
}
