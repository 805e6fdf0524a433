//! The paper's model and its analytic method, compared with reference values of 60-digit arithmetic
//! (tests/vectors/model.json).

use super::Case;
use crate::attitude::Deviation;
use crate::calibration::analytic;
use crate::coefficients::{Coefficients, EIGHT_POSITIONS, EarthRate, Position, StandGeometry};
use crate::units::radians_from_arcseconds;
use nalgebra::{Matrix2, Vector2};
use serde_json::Value;

const REFERENCE: &str = include_str!("../../tests/vectors/model.json");

/// Largest error of a coefficient relative to the largest of its matrix or set; the limit with which passports are
/// verified.
const COEFFICIENT_LIMIT: f64 = 1e-12;

/// Largest relative error of a gyro parameter.
const PARAMETER_LIMIT: f64 = 1e-9;

/// Returns the largest errors over all stands of the reference: of a coefficient, and of a parameter.
pub(crate) fn cases() -> [Case; 2] {
    let reference: Value = serde_json::from_str(REFERENCE).unwrap_or(Value::Null);
    let stands = reference["cases"].as_array().map_or(&[][..], Vec::as_slice);
    let errors: Vec<[f64; 2]> = stands.iter().map(errors).collect();
    let worst = |which: usize| match errors.as_slice() {
        [] => f64::NAN,
        some => largest(some.iter().map(|pair| pair[which])),
    };
    let of = format!("of {} stands", errors.len());
    [
        case(&format!("largest error of a coefficient {of}"), COEFFICIENT_LIMIT, worst(0)),
        case(&format!("largest error of a parameter {of}"), PARAMETER_LIMIT, worst(1)),
    ]
}

/// Returns the largest error. NaN means that there is no result, so it counts as the largest.
fn largest(errors: impl Iterator<Item = f64>) -> f64 {
    errors.fold(0.0, |a, b| if b > a || b.is_nan() { b } else { a })
}

fn case(quantity: &str, tolerance: f64, found: f64) -> Case {
    const SOURCE: &str = "60-digit arithmetic of eq. (3) to (16), tests/vectors/model.json";
    Case::new("The paper's model", SOURCE, quantity, [0.0, tolerance, found])
}

/// Returns the errors of the coefficients and of the parameters of a stand; NaN if there is nothing to compare.
fn errors(reference: &Value) -> [f64; 2] {
    let found = coefficients(reference);
    let coefficient = found.as_ref().and_then(|found| coefficient_error(found, reference));
    let parameter = found.as_ref().and_then(|found| parameter_error(found, reference));
    [coefficient, parameter].map(|error| error.unwrap_or(f64::NAN))
}

/// Returns all numbers in `value`, in order. A remainder of 60-digit arithmetic counts as zero.
fn numbers(value: &Value) -> Vec<f64> {
    const ZERO: f64 = 1e-30;
    match value {
        Value::Array(items) => items.iter().flat_map(numbers).collect(),
        number => number.as_f64().map(|x| if x.abs() < ZERO { 0.0 } else { x }).into_iter().collect(),
    }
}

fn coefficients(reference: &Value) -> Option<Coefficients> {
    let deviations = numbers(&reference["deviations_arcsec"]);
    let each = EIGHT_POSITIONS.iter().zip(deviations.chunks_exact(3));
    let positions: Vec<Position> = each
        .map(|((index, theta_deg, phi_deg), angles)| {
            let deviation = Deviation::of([0, 1, 2].map(|at| radians_from_arcseconds(angles[at])));
            Position { index: *index, theta_deg: *theta_deg, phi_deg: *phi_deg, deviation }
        })
        .collect();
    let earth = EarthRate::at_astronomic_latitude(reference["latitude_deg"].as_f64()?);
    Some(StandGeometry::new(&positions).ok()?.at(earth))
}

fn rows(matrix: &Matrix2<f64>) -> Vec<f64> {
    matrix.transpose().iter().copied().collect()
}

/// Returns the largest error of a coefficient, relative to the largest element of its matrix or set.
fn coefficient_error(found: &Coefficients, reference: &Value) -> Option<f64> {
    let matrices = found.matrices.as_ref()?;
    let vectors = |of: fn(&crate::coefficients::PositionCoefficients) -> Vector2<f64>| -> Vec<f64> {
        found.positions.iter().map(of).flat_map(|vector| [vector.x, vector.y]).collect()
    };
    let pairs = [
        ("n", vectors(|at| at.specific_force_g)),
        ("omega_deg_per_h", vectors(|at| at.earth_rate_deg_per_h)),
        ("delta", rows(&matrices.delta)),
        ("b_deg_per_h", rows(&matrices.b_deg_per_h)),
        ("c_deg_per_h_per_g", rows(&matrices.c_deg_per_h_per_g)),
        ("n1", rows(&matrices.n1)),
        ("n2", rows(&matrices.n2)),
        ("n2_inverse", rows(&matrices.n2_inverse)),
        ("omega1_deg_per_h", rows(&matrices.omega1_deg_per_h)),
        ("omega2_deg_per_h", rows(&matrices.omega2_deg_per_h)),
    ];
    let errors = pairs.iter().map(|(key, found)| {
        let expected = numbers(&reference[key]);
        if expected.len() != found.len() {
            return f64::INFINITY;
        }
        let size = largest(expected.iter().map(|x| x.abs()));
        let worst = largest(found.iter().zip(&expected).map(|(x, y)| (x - y).abs()));
        if size == 0.0 { worst } else { worst / size }
    });
    Some(largest(errors))
}

/// Returns the largest relative error of the gyro parameters computed from the reference currents by eq. (13)-(16),
/// (8).
fn parameter_error(found: &Coefficients, reference: &Value) -> Option<f64> {
    let gyro = &reference["gyro"];
    let currents = numbers(&gyro["currents_ma"]);
    let currents: Vec<Vector2<f64>> = currents.chunks_exact(2).map(|pair| Vector2::new(pair[0], pair[1])).collect();
    let solved = analytic::solve(found, &currents).ok()?.parameters;
    let mut parameters = rows(&solved.k_deg_per_h_per_ma);
    parameters.extend(solved.omega0_deg_per_h.iter());
    parameters.extend([solved.omega_g_deg_per_h_per_g, solved.omega_k_deg_per_h_per_g]);
    let keys = ["k_deg_per_h_per_ma", "omega0_deg_per_h", "omega_g_deg_per_h_per_g", "omega_k_deg_per_h_per_g"];
    let expected: Vec<f64> = keys.iter().flat_map(|key| numbers(&gyro[key])).collect();
    if expected.len() != parameters.len() {
        return None;
    }
    Some(largest(parameters.iter().zip(&expected).map(|(x, y)| (x / y - 1.0).abs())))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A result that is not a number does not agree, in any place of the list.
    #[test]
    fn what_is_not_a_number_is_the_largest_error() {
        for errors in [[f64::NAN, 1.0], [1.0, f64::NAN]] {
            assert!(largest(errors.into_iter()).is_nan());
        }
        assert_eq!(largest([0.5, 2.0, 1.0].into_iter()), 2.0);
    }
}
