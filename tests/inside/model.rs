//! The model against independent 60-digit reference values.

use dtg_passport::attitude::Deviation;
use dtg_passport::calibration::analytic;
use dtg_passport::coefficients::{Coefficients, EIGHT_POSITIONS, EarthRate, Matrices, Position, StandGeometry};
use dtg_passport::units::radians_from_arcseconds;
use nalgebra::{Matrix2, Vector2};
use serde_json::Value;

/// What the reference leaves of a zero in 60-digit arithmetic.
const REFERENCE_ZERO: f64 = 1e-30;

/// Largest difference to the reference, of the reference's largest element.
const LIMIT: f64 = 1e-13;

fn reference() -> Value {
    serde_json::from_str(include_str!("../vectors/model.json")).expect("tests/vectors/model.json is JSON")
}

/// Every number in `value`, in order.
fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(items) => items.iter().flat_map(numbers).collect(),
        number => vec![number.as_f64().filter(|x| x.abs() >= REFERENCE_ZERO).unwrap_or(0.0)],
    }
}

fn coefficients(case: &Value) -> Coefficients {
    let deviations = numbers(&case["deviations_arcsec"]);
    let positions: Vec<Position> = EIGHT_POSITIONS
        .iter()
        .zip(deviations.chunks_exact(3))
        .map(|((index, theta_deg, phi_deg), angles)| Position {
            index: *index,
            theta_deg: *theta_deg,
            phi_deg: *phi_deg,
            deviation: Deviation {
                alpha_rad: radians_from_arcseconds(angles[0]),
                beta_rad: radians_from_arcseconds(angles[1]),
                gamma_rad: radians_from_arcseconds(angles[2]),
            },
        })
        .collect();
    let earth = EarthRate::at_astronomic_latitude(case["latitude_deg"].as_f64().unwrap());
    StandGeometry::new(&positions).expect("n_2 has an inverse").at(earth)
}

fn rows(matrix: &Matrix2<f64>) -> Vec<f64> {
    matrix.transpose().iter().copied().collect()
}

/// The largest error of `found`, relative to the largest element of `expected` (absolute where all of it is zero).
fn error(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let largest = expected.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let worst = found.iter().zip(expected).fold(0.0, |a: f64, (x, y)| a.max((x - y).abs()));
    if largest == 0.0 { worst } else { worst / largest }
}

/// Errors of one case, by name.
fn errors(case: &Value) -> Vec<(&'static str, f64)> {
    let found = coefficients(case);
    let earth = EarthRate::at_astronomic_latitude(case["latitude_deg"].as_f64().unwrap());
    let Matrices { delta, b_deg_per_h, c_deg_per_h_per_g, n1, n2, n2_inverse, omega1_deg_per_h, omega2_deg_per_h } =
        found.matrices.expect("all eight positions are there");
    let n: Vec<f64> =
        found.positions.iter().flat_map(|at| at.specific_force_g.iter().copied().collect::<Vec<_>>()).collect();
    let omega: Vec<f64> =
        found.positions.iter().flat_map(|at| at.earth_rate_deg_per_h.iter().copied().collect::<Vec<_>>()).collect();
    [
        ("horizontal_deg_per_h", vec![earth.horizontal_deg_per_h]),
        ("vertical_deg_per_h", vec![earth.vertical_deg_per_h]),
        ("n", n),
        ("omega_deg_per_h", omega),
        ("delta", rows(&delta)),
        ("b_deg_per_h", rows(&b_deg_per_h)),
        ("c_deg_per_h_per_g", rows(&c_deg_per_h_per_g)),
        ("n1", rows(&n1)),
        ("n2", rows(&n2)),
        ("n2_inverse", rows(&n2_inverse)),
        ("omega1_deg_per_h", rows(&omega1_deg_per_h)),
        ("omega2_deg_per_h", rows(&omega2_deg_per_h)),
    ]
    .into_iter()
    .map(|(name, found)| (name, error(&found, &numbers(&case[name]))))
    .collect()
}

/// Prints the figure of docs/development/figures.md: `cargo test --lib -- --nocapture largest_error`.
#[test]
fn largest_error_against_the_reference() {
    let reference = reference();
    let cases = reference["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 12);
    let mut worst = (0.0, String::new());
    for (number, case) in cases.iter().enumerate() {
        for (name, error) in errors(case) {
            assert!(error <= LIMIT, "case {number}, {name}: {error:e}");
            if error > worst.0 {
                worst = (error, format!("{name} of case {number}"));
            }
        }
    }
    println!("largest error against the reference: {:.1e} of the largest element ({})", worst.0, worst.1);
}

/// Expected: the gyro of the reference vectors; 1e-10 of each parameter's own size.
#[test]
fn reference_currents_give_the_reference_gyro() {
    let mut worst: f64 = 0.0;
    for case in reference()["cases"].as_array().unwrap() {
        let at = coefficients(case);
        let gyro = &case["gyro"];
        let currents: Vec<Vector2<f64>> =
            numbers(&gyro["currents_ma"]).chunks_exact(2).map(|pair| Vector2::new(pair[0], pair[1])).collect();
        let found = analytic::solve(&at, &currents).unwrap().parameters;
        let mut parameters = rows(&found.k_deg_per_h_per_ma);
        parameters.extend(found.omega0_deg_per_h.iter());
        parameters.extend([found.omega_g_deg_per_h_per_g, found.omega_k_deg_per_h_per_g]);
        let mut expected = numbers(&gyro["k_deg_per_h_per_ma"]);
        expected.extend(numbers(&gyro["omega0_deg_per_h"]));
        expected.extend(numbers(&gyro["omega_g_deg_per_h_per_g"]));
        expected.extend(numbers(&gyro["omega_k_deg_per_h_per_g"]));
        for (found, expected) in parameters.iter().zip(&expected) {
            worst = worst.max((found / expected - 1.0).abs());
        }
    }
    println!("largest relative error of a parameter found by the analytic method: {worst:.1e}");
    assert!(worst < 1e-10, "{worst:e}");
}
