//! Examples of JCGM 100:2008 (GUM), annex H: H.1, H.2, H.3.
//!
//! Inputs and results were compared with the guide as quoted in the examples and tests of MSL's GTC 1.5.1. GTC computes
//! without rounding the results that the guide states with fewer digits or rounds on the way.

use super::Case;
use crate::calibration::propagation::{covariance, product, standard_deviations};
use crate::statistics::least_squares::Factorised;
use crate::statistics::student::effective_degrees_of_freedom;
use nalgebra::DMatrix;

const BY_GTC: &str = "GTC 1.5.1 (Measurement Standards Laboratory of New Zealand) with the same inputs";

pub(crate) fn cases() -> Vec<Case> {
    [end_gauge(), impedance(), thermometer()].concat()
}

/// Creates cases of an example for numbers printed with `decimals` decimals; the tolerance is half a unit of the last one.
fn printed(example: &'static str) -> impl Fn(&'static str, &str, f64, i32, f64) -> Case {
    move |source, quantity, expected, decimals, found| {
        Case::new(example, source, quantity, [expected, 0.5 * 10_f64.powi(-decimals), found])
    }
}

/// Returns the standard uncertainties of results and their correlation coefficients, from their errors for one standard
/// uncertainty of each cause (results × causes).
fn uncertainty(spread: &DMatrix<f64>) -> (Vec<f64>, DMatrix<f64>) {
    let u = standard_deviations(spread);
    let correlation = covariance(spread).map_with_location(|one, other, element| element / (u[one] * u[other]));
    (u, correlation)
}

/// Returns the cases of H.1, nm: the length of an end gauge at 20 °C, l = l_S + d − l_S (δα θ + α_S δθ).
fn end_gauge() -> Vec<Case> {
    const EXAMPLE: &str = "GUM H.1 end gauge";
    /// Estimates: l_S, d in nm; α_S, δα in 1/°C; θ, δθ in °C (JCGM 100:2008, H.1.3).
    const ESTIMATES: [f64; 6] = [50_000_623.0, 215.0, 11.5e-6, 0.0, -0.1, 0.0];
    // u and ν of d: the mean of five readings, 13 nm/sqrt 5 from 25 comparisons; random and systematic effects of the
    // comparator.
    let of_difference: [(f64, f64); 3] = [(5.8, 24.0), (3.9, 5.0), (6.7, 8.0)];
    let u_d = of_difference.iter().map(|(u, _)| u * u).sum::<f64>().sqrt();
    let nu_d = effective_degrees_of_freedom(&of_difference);
    let root_of_three = 3_f64.sqrt();
    // θ has an arc sine distribution about its mean; those of α_S and δα are rectangular.
    let inputs: [(f64, f64); 6] = [
        (25.0, 18.0),
        (u_d, nu_d),
        (2e-6 / root_of_three, f64::INFINITY),
        (1e-6 / root_of_three, 50.0),
        (0.41, f64::INFINITY),
        (0.05 / root_of_three, 2.0),
    ];
    let [l, d, alpha, d_alpha, theta, d_theta] = ESTIMATES;
    let gradient = [1.0 - (d_alpha * theta + alpha * d_theta), 1.0, -l * d_theta, -l * theta, -l * d_alpha, -l * alpha];
    let length = l + d - l * (d_alpha * theta + alpha * d_theta);
    let contributions: Vec<(f64, f64)> = inputs.iter().zip(gradient).map(|((u, nu), c)| (u * c, *nu)).collect();
    let u = standard_deviations(&DMatrix::from_fn(1, 6, |_, input| contributions[input].0))[0];
    let case = printed(EXAMPLE);
    // H.1.6 uses the contributions and ν(d) with the digits printed there, but u(l) itself with all digits.
    const PRINTED: [(f64, f64); 4] = [(25.0, 18.0), (9.7, 25.6), (2.9, 50.0), (16.6, 2.0)];
    let as_printed = u * u * u * u / PRINTED.iter().map(|(u, nu)| u * u * u * u / nu).sum::<f64>();
    let unrounded = effective_degrees_of_freedom(&contributions);
    vec![
        case("JCGM 100:2008, H.1.5", "length, nm", 50_000_838.0, 0, length),
        case("JCGM 100:2008, H.1.3.2", "u(difference), nm", 9.7, 1, u_d),
        case("JCGM 100:2008, H.1.6", "ν_eff, terms as printed", 16.7, 1, as_printed),
        case(BY_GTC, "u(length), nm; GUM: 32", 31.66388, 5, u),
        case(BY_GTC, "ν_eff, unrounded", 16.75186, 5, unrounded),
    ]
}

/// Returns the cases of H.2: resistance, reactance and impedance from five simultaneous readings of voltage, current
/// and phase.
fn impedance() -> Vec<Case> {
    const EXAMPLE: &str = "GUM H.2 impedance";
    const RESULTS: &str = "JCGM 100:2008, table H.3";
    const MEANS: &str = "JCGM 100:2008, table H.2";
    /// Readings: V in volts, I in amperes, φ in radians (table H.2).
    #[rustfmt::skip]
    const READINGS: [f64; 15] = [
        5.007, 19.663e-3, 1.0456,
        4.994, 19.639e-3, 1.0438,
        5.005, 19.640e-3, 1.0468,
        4.990, 19.685e-3, 1.0428,
        4.999, 19.678e-3, 1.0433,
    ];
    let readings = DMatrix::from_column_slice(3, 5, &READINGS);
    let means = readings.column_mean();
    // Each of the five readings is a cause: the sum of the squares is the variance of the mean.
    let of_means = DMatrix::from_fn(3, 5, |row, reading| (readings[(row, reading)] - means[row]) / 20_f64.sqrt());
    let (v, i) = (means[0], means[1]);
    let (sin, cos) = libm::sincos(means[2]);
    let z = v / i;
    #[rustfmt::skip]
    let gradient = [
        cos / i, -z * cos / i, -z * sin,
        sin / i, -z * sin / i, z * cos,
        1.0 / i, -z / i, 0.0,
    ];
    let (u_of_mean, r_of_means) = uncertainty(&of_means);
    let (u, r) = uncertainty(&product(&DMatrix::from_row_slice(3, 3, &gradient), &of_means));
    let case = printed(EXAMPLE);
    vec![
        case(MEANS, "u(V), V", 0.0032, 4, u_of_mean[0]),
        case(MEANS, "u(I), mA", 0.0095, 4, 1e3 * u_of_mean[1]),
        case(MEANS, "u(φ), rad", 0.00075, 5, u_of_mean[2]),
        case(MEANS, "r(V, I)", -0.36, 2, r_of_means[(0, 1)]),
        case(MEANS, "r(V, φ)", 0.86, 2, r_of_means[(0, 2)]),
        case(MEANS, "r(I, φ)", -0.65, 2, r_of_means[(1, 2)]),
        case(RESULTS, "R, Ω", 127.732, 3, z * cos),
        case(RESULTS, "X, Ω", 219.847, 3, z * sin),
        case(RESULTS, "Z, Ω", 254.260, 3, z),
        case(RESULTS, "u(R), Ω", 0.071, 3, u[0]),
        // The guide prints 0.295, because it rounds on the way. The readings of table H.2 give 0.2956, as GTC does.
        Case { tolerance: 0.001, ..case(RESULTS, "u(X), Ω", 0.295, 3, u[1]) },
        case(RESULTS, "u(Z), Ω", 0.236, 3, u[2]),
        case(RESULTS, "r(R, X)", -0.588, 3, r[(0, 1)]),
        case(RESULTS, "r(R, Z)", -0.485, 3, r[(0, 2)]),
        case(RESULTS, "r(X, Z)", 0.993, 3, r[(1, 2)]),
    ]
}

/// Returns the cases of H.3: the correction of a thermometer as a straight line b = y₁ + y₂ (t − 20 °C), by least
/// squares.
fn thermometer() -> Vec<Case> {
    const EXAMPLE: &str = "GUM H.3 thermometer";
    const LINE: &str = "JCGM 100:2008, H.3.3";
    const AT_30: &str = "JCGM 100:2008, H.3.4";
    /// Reading and correction, °C (table H.6).
    const READINGS: [(f64, f64); 11] = [
        (21.521, -0.171),
        (22.012, -0.169),
        (22.512, -0.166),
        (23.003, -0.159),
        (23.507, -0.164),
        (23.999, -0.165),
        (24.513, -0.156),
        (25.002, -0.157),
        (25.503, -0.159),
        (26.010, -0.161),
        (26.511, -0.160),
    ];
    let design = DMatrix::from_fn(11, 2, |row, column| if column == 0 { 1.0 } else { READINGS[row].0 - 20.0 });
    let mut right = DMatrix::from_fn(11, 1, |row, _| READINGS[row].1);
    let Some(model) = Factorised::new(design) else {
        return vec![printed(EXAMPLE)(LINE, "cannot be computed", 0.0, 0, f64::NAN)];
    };
    model.rotate(&mut right);
    let (line, _) = model.solve_rotated(&right);
    let variance = right.rows(2, 9).norm_squared() / 9.0;
    let spread = &model.r_inverse * variance.sqrt();
    let (u, r) = uncertainty(&spread);
    let u_at_30 = standard_deviations(&product(&DMatrix::from_row_slice(1, 2, &[1.0, 10.0]), &spread))[0];
    let case = printed(EXAMPLE);
    vec![
        case(LINE, "intercept, °C", -0.1712, 4, line[0]),
        case(LINE, "u(intercept), °C", 0.0029, 4, u[0]),
        case(LINE, "slope", 0.00218, 5, line[1]),
        case(LINE, "u(slope)", 0.00067, 5, u[1]),
        case(LINE, "r(intercept, slope)", -0.930, 3, r[(0, 1)]),
        case(LINE, "s of the fit, °C", 0.0035, 4, variance.sqrt()),
        case(AT_30, "correction at 30 °C, °C", -0.1494, 4, line[0] + 10.0 * line[1]),
        case(AT_30, "u(correction), °C", 0.0041, 4, u_at_30),
    ]
}
