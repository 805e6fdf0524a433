//! Rotations, lengths and closed forms of the model, on stands and at latitudes drawn at random.

use crate::inside::reference::*;
use dtg_passport::attitude;
use dtg_passport::calibration::analytic;
use dtg_passport::coefficients::{Coefficients, EarthRate, Position, StandGeometry, pair_differences};
use dtg_passport::gyro::GyroParameters;
use dtg_passport::statistics::random::Stream;
use dtg_passport::units::degrees_from_radians;
use nalgebra::{Matrix2, Matrix3, Vector2};

/// Some sixteen roundings of 1.1e-16 each.
const ROUNDING: f64 = 2e-15;

/// Stands with deviations up to a limit, each at a latitude; the number of a draw is its seed.
fn drawn(limit_rad: f64, latitude_deg: f64) -> impl Iterator<Item = (u64, Stream, Vec<Position>, EarthRate)> {
    (0..256).map(move |number| {
        let mut stream = Stream::new(number);
        let stand = drawn_stand(&mut stream, degrees_from_radians(limit_rad));
        let earth = EarthRate::at_astronomic_latitude(stream.within(latitude_deg));
        (number, stream, stand, earth)
    })
}

#[test]
fn real_orientation_is_a_rotation() {
    for (number, mut stream, stand, _) in drawn(0.8, 90.0) {
        let matrix = attitude::actual(stream.within(360.0), stream.within(360.0), &stand[0].deviation);
        assert!((matrix * matrix.transpose() - Matrix3::identity()).abs().max() < ROUNDING, "{number}");
        assert!((matrix.determinant() - 1.0).abs() < ROUNDING, "{number}");
    }
}

/// |n|² + Ã₃₃² = 1 (gravity is 1 g in any axes), and ω_3 with its third component has the length Ω.
#[test]
fn vectors_have_the_lengths_that_geometry_demands() {
    for (number, _, stand, earth) in drawn(0.8, 89.9) {
        let rotation = 15.041_066_876_065_45;
        for (position, at) in stand.iter().zip(StandGeometry::new(&stand).unwrap().at(earth).positions) {
            let squared = at.specific_force_g.norm_squared() + at.specific_force_z_g.powi(2);
            assert!((squared - 1.0).abs() < ROUNDING, "{number}");
            let attitude = attitude::actual(position.theta_deg, position.phi_deg, &position.deviation);
            let along_z = attitude.m32 * earth.horizontal_deg_per_h + attitude.m33 * earth.vertical_deg_per_h;
            let length = (at.earth_rate_deg_per_h.norm_squared() + along_z * along_z).sqrt();
            assert!((length / rotation - 1.0).abs() < ROUNDING, "{number}");
        }
    }
}

/// Expected: Δ = 0, B = 2 ω_Γ [[0, 1], [1, 0]], C = ω_B·1, n_2 = 2 [[0, 1], [1, 0]] (paper, fig. 3, by hand).
#[test]
fn zero_deviations_give_the_closed_form() {
    let exchange = Matrix2::new(0.0, 1.0, 1.0, 0.0);
    for (number, _, stand, earth) in drawn(0.0, 89.9) {
        let found = StandGeometry::new(&stand).unwrap().at(earth).matrices.unwrap();
        assert_eq!(found.delta, Matrix2::zeros(), "{number}");
        assert_eq!(found.n1, Matrix2::zeros(), "{number}");
        assert_eq!(found.n2, exchange * 2.0, "{number}");
        assert_eq!(found.n2_inverse, exchange * 0.5, "{number}");
        assert_eq!(found.b_deg_per_h, exchange * (2.0 * earth.horizontal_deg_per_h), "{number}");
        assert_eq!(found.c_deg_per_h_per_g, Matrix2::identity() * earth.vertical_deg_per_h, "{number}");
    }
}

/// A gyro drawn at random, its exact currents, and (13)-(16), (8): the same gyro.
#[test]
fn exact_currents_give_the_gyro_back() {
    let mut well_determined = 0;
    for (number, mut stream, stand, earth) in drawn(0.2, 80.0) {
        let mut within = |limit| stream.within(limit);
        let gyro = GyroParameters {
            k_deg_per_h_per_ma: Matrix2::new(100.0 + within(50.0), within(20.0), within(20.0), 100.0 + within(50.0)),
            omega0_deg_per_h: Vector2::new(within(40.0), within(40.0)),
            omega_g_deg_per_h_per_g: within(30.0),
            omega_k_deg_per_h_per_g: within(30.0),
        };
        let at = StandGeometry::new(&stand).unwrap().at(earth);
        let currents: Vec<_> = at.positions.iter().map(|position| gyro.currents_ma(position).unwrap()).collect();
        // Rounding of the currents is magnified by how badly they determine K: up to the condition below nothing is lost.
        let condition = condition_of_the_solution(&at, &currents);
        if condition >= 1e4 {
            continue;
        }
        well_determined += 1;
        let found = analytic::solve(&at, &currents).unwrap();
        let limit = 1e-10 * condition;
        let off = (found.parameters.k_deg_per_h_per_ma - gyro.k_deg_per_h_per_ma).abs().max();
        assert!(off < limit, "{number}: {off:e}");
        let off = (found.parameters.omega0_deg_per_h - gyro.omega0_deg_per_h).abs().max();
        assert!(off < limit, "{number}: {off:e}");
        let off = (found.omega_n_deg_per_h_per_g - gyro.omega_n_deg_per_h_per_g()).abs().max();
        assert!(off < limit, "{number}: {off:e}");
    }
    assert!(well_determined > 200, "{well_determined}");
}

/// Condition number of J_1 − J_2 Δ, whose inverse gives K (paper, eq. (13)).
fn condition_of_the_solution(at: &Coefficients, currents: &[Vector2<f64>]) -> f64 {
    let (j1, j2) = pair_differences(|position| currents[position]);
    let values = (j1 - j2 * at.matrices.unwrap().delta).singular_values();
    values.max() / values.min()
}
