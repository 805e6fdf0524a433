//! The model against independent 60-digit reference values.

use crate::inside::reference::{numbers, reference_case, reference_cases};
use dtg_passport::coefficients::{EarthRate, Matrices};
use nalgebra::Matrix2;
use serde_json::Value;

/// What the reference leaves of a zero in 60-digit arithmetic.
const REFERENCE_ZERO: f64 = 1e-30;

/// Largest difference to the reference, of the reference's largest element.
const LIMIT: f64 = 1e-13;

fn rows(matrix: &Matrix2<f64>) -> Vec<f64> {
    matrix.transpose().iter().copied().collect()
}

/// The largest error of `found`, relative to the largest element of `expected` (absolute where all of it is zero).
fn error(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let largest = expected.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let worst = found.iter().zip(expected).fold(0.0, |a: f64, (x, y)| a.max((x - y).abs()));
    if largest < REFERENCE_ZERO { worst } else { worst / largest }
}

/// Errors of one case, by name.
fn errors(case: &Value) -> Vec<(&'static str, f64)> {
    let (setup, ..) = reference_case(case);
    let found = setup.coefficients();
    let earth = EarthRate::at_astronomic_latitude(case["latitude_deg"].as_f64().unwrap());
    let Matrices { delta, b_deg_per_h, c_deg_per_h_per_g, n1, n2, n2_inverse, omega1_deg_per_h, omega2_deg_per_h } =
        found.matrices.expect("all eight positions are there");
    let n = found.positions.iter().flat_map(|at| <[f64; 2]>::from(at.specific_force_g)).collect();
    let omega = found.positions.iter().flat_map(|at| <[f64; 2]>::from(at.earth_rate_deg_per_h)).collect();
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
    let cases = reference_cases();
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
