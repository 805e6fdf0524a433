//! The model against independent 60-digit reference values, and against what geometry demands.

use dtg_passport::attitude::{self, Deviation};
use dtg_passport::calibration::analytic;
use dtg_passport::coefficients::{
    Coefficients, EIGHT_POSITIONS, EarthRate, Matrices, Position, StandGeometry, pair_differences,
};
use dtg_passport::gyro::GyroParameters;
use dtg_passport::units::radians_from_arcseconds;
use nalgebra::{Matrix2, Matrix3, Vector2};
use proptest::prelude::*;
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

prop_compose! {
    fn deviation_up_to(limit_rad: f64)(
        alpha_rad in -limit_rad..limit_rad,
        beta_rad in -limit_rad..limit_rad,
        gamma_rad in -limit_rad..limit_rad,
    ) -> Deviation {
        Deviation { alpha_rad, beta_rad, gamma_rad }
    }
}

prop_compose! {
    fn stand_up_to(limit_rad: f64)(deviations in prop::array::uniform8(deviation_up_to(limit_rad))) -> Vec<Position> {
        EIGHT_POSITIONS
            .iter()
            .zip(deviations)
            .map(|((index, theta_deg, phi_deg), deviation)| Position {
                index: *index, theta_deg: *theta_deg, phi_deg: *phi_deg, deviation,
            })
            .collect()
    }
}

/// Some sixteen roundings of 1.1e-16 each.
const ROUNDING: f64 = 2e-15;

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn real_orientation_is_a_rotation(
        angles in deviation_up_to(0.8), theta in -360.0..360.0, phi in -360.0..360.0,
    ) {
        let matrix = attitude::actual(theta, phi, &angles);
        prop_assert!((matrix * matrix.transpose() - Matrix3::identity()).abs().max() < ROUNDING);
        prop_assert!((matrix.determinant() - 1.0).abs() < ROUNDING);
    }

    /// |n|² + Ã₃₃² = 1 (gravity is 1 g in any axes), and ω_3 with its third component has the length Ω.
    #[test]
    fn vectors_have_the_lengths_that_geometry_demands(stand in stand_up_to(0.8), latitude in -89.9..89.9) {
        let earth = EarthRate::at_astronomic_latitude(latitude);
        let rotation = 15.041_066_876_065_45;
        for (position, at) in stand.iter().zip(StandGeometry::new(&stand).unwrap().at(earth).positions) {
            let squared = at.specific_force_g.norm_squared() + at.specific_force_z_g.powi(2);
            prop_assert!((squared - 1.0).abs() < ROUNDING);
            let attitude = attitude::actual(position.theta_deg, position.phi_deg, &position.deviation);
            let along_z = attitude.m32 * earth.horizontal_deg_per_h + attitude.m33 * earth.vertical_deg_per_h;
            let length = (at.earth_rate_deg_per_h.norm_squared() + along_z * along_z).sqrt();
            prop_assert!((length / rotation - 1.0).abs() < ROUNDING);
        }
    }

    /// Expected: Δ = 0, B = 2 ω_Γ [[0, 1], [1, 0]], C = ω_B·1, n_2 = 2 [[0, 1], [1, 0]] (paper, fig. 3, by hand).
    #[test]
    fn zero_deviations_give_the_closed_form(latitude in -89.9..89.9) {
        let none = Deviation { alpha_rad: 0.0, beta_rad: 0.0, gamma_rad: 0.0 };
        let stand: Vec<Position> = EIGHT_POSITIONS
            .iter()
            .map(|(index, theta_deg, phi_deg)| Position {
                index: *index, theta_deg: *theta_deg, phi_deg: *phi_deg, deviation: none,
            })
            .collect();
        let earth = EarthRate::at_astronomic_latitude(latitude);
        let found = StandGeometry::new(&stand).unwrap().at(earth).matrices.unwrap();
        let exchange = Matrix2::new(0.0, 1.0, 1.0, 0.0);
        prop_assert_eq!(found.delta, Matrix2::zeros());
        prop_assert_eq!(found.n1, Matrix2::zeros());
        prop_assert_eq!(found.n2, exchange * 2.0);
        prop_assert_eq!(found.n2_inverse, exchange * 0.5);
        prop_assert_eq!(found.b_deg_per_h, exchange * (2.0 * earth.horizontal_deg_per_h));
        prop_assert_eq!(found.c_deg_per_h_per_g, Matrix2::identity() * earth.vertical_deg_per_h);
    }

    /// The definitions of B and C (paper, under eq. (13) and (15)) against the form used, free of the site.
    #[test]
    fn b_and_c_are_the_papers(stand in stand_up_to(0.2), latitude in -89.0..89.0) {
        let m = StandGeometry::new(&stand).unwrap().at(EarthRate::at_astronomic_latitude(latitude)).matrices.unwrap();
        let b = m.omega1_deg_per_h - m.omega2_deg_per_h * m.n2_inverse * m.n1;
        let c = m.omega2_deg_per_h * m.n2_inverse;
        prop_assert!((b - m.b_deg_per_h).abs().max() < 1e-13);
        prop_assert!((c - m.c_deg_per_h_per_g).abs().max() < 1e-13);
        prop_assert!((m.n2_inverse * m.n2 - Matrix2::identity()).abs().max() < ROUNDING);
    }

    /// A gyro drawn at random, its exact currents, and (13)-(16), (8): the same gyro.
    #[test]
    fn exact_currents_give_the_gyro_back(
        stand in stand_up_to(0.2), latitude in -80.0..80.0,
        k in prop::array::uniform2(50.0..150.0), k_cross in prop::array::uniform2(-20.0..20.0),
        omega0 in prop::array::uniform2(-40.0..40.0), g_drifts in prop::array::uniform2(-30.0..30.0),
    ) {
        let gyro = GyroParameters {
            k_deg_per_h_per_ma: Matrix2::new(k[0], k_cross[0], k_cross[1], k[1]),
            omega0_deg_per_h: omega0.into(),
            omega_g_deg_per_h_per_g: g_drifts[0],
            omega_k_deg_per_h_per_g: g_drifts[1],
        };
        let at = StandGeometry::new(&stand).unwrap().at(EarthRate::at_astronomic_latitude(latitude));
        let currents: Vec<_> = at.positions.iter().map(|position| gyro.currents_ma(position).unwrap()).collect();
        // Rounding of the currents is magnified by how badly they determine K: up to the condition below nothing is lost.
        let found = analytic::solve(&at, &currents);
        let condition = condition_of_the_solution(&at, &currents);
        prop_assume!(condition < 1e4);
        let found = found.unwrap();
        let limit = 1e-12 * condition;
        prop_assert!((found.parameters.k_deg_per_h_per_ma - gyro.k_deg_per_h_per_ma).abs().max() < 100.0 * limit);
        prop_assert!((found.parameters.omega0_deg_per_h - gyro.omega0_deg_per_h).abs().max() < 100.0 * limit);
        prop_assert!((found.omega_n_deg_per_h_per_g - gyro.omega_n_deg_per_h_per_g()).abs().max() < 100.0 * limit);
    }
}

/// Condition number of J_1 − J_2 Δ, whose inverse gives K (paper, eq. (13)).
fn condition_of_the_solution(at: &Coefficients, currents: &[Vector2<f64>]) -> f64 {
    let (j1, j2) = pair_differences(|position| currents[position]);
    let values = (j1 - j2 * at.matrices.unwrap().delta).singular_values();
    values.max() / values.min()
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
