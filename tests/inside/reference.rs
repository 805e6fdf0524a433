//! What several tests need: the reference cases, stands drawn at random, the paper's gyro.

// Each feature alone uses its own part.
#![cfg_attr(not(feature = "cli"), allow(dead_code))]

use dtg_passport::attitude::Deviation;
use dtg_passport::calibration::{InputUncertainty, MeterUncertainty, Readings, Setup};
use dtg_passport::coefficients::{EIGHT_POSITIONS, EarthRate, Position};
use dtg_passport::gyro::{GyroParameters, GyroType};
use dtg_passport::laboratory::Laboratory;
#[cfg(feature = "monte-carlo")]
use dtg_passport::statistics::random::Stream;
use dtg_passport::units::radians_from_arcseconds;
use nalgebra::Vector2;
use serde_json::Value;

/// The latitude of the paper's laboratory.
pub const LATITUDE_DEG: f64 = 55.7658;

/// The twelve cases of 60-digit arithmetic.
pub fn reference_cases() -> Vec<Value> {
    let reference: Value = serde_json::from_str(include_str!("../vectors/model.json")).expect("model.json is JSON");
    reference["cases"].as_array().expect("cases").clone()
}

/// Every number in `value`, in order.
pub fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(items) => items.iter().flat_map(numbers).collect(),
        number => vec![number.as_f64().expect("a number")],
    }
}

/// The paper's eight positions with α, β, γ (radians) for each.
pub fn eight(angles_rad: impl IntoIterator<Item = [f64; 3]>) -> Vec<Position> {
    EIGHT_POSITIONS
        .iter()
        .zip(angles_rad)
        .map(|((index, theta_deg, phi_deg), [alpha_rad, beta_rad, gamma_rad])| Position {
            index: *index,
            theta_deg: *theta_deg,
            phi_deg: *phi_deg,
            deviation: Deviation { alpha_rad, beta_rad, gamma_rad },
        })
        .collect()
}

/// A stand with every angle uniform within ±`limit_deg`.
#[cfg(feature = "monte-carlo")]
pub fn drawn_stand(stream: &mut Stream, limit_deg: f64) -> Vec<Position> {
    let limit = dtg_passport::units::radians_from_degrees(limit_deg);
    let angles: Vec<[f64; 3]> = (0..8).map(|_| [(); 3].map(|()| stream.within(limit))).collect();
    eight(angles)
}

/// A meter of the paper's accuracy.
pub fn paper_meter() -> MeterUncertainty {
    MeterUncertainty::from(&Laboratory::paper().meter)
}

/// `positions` at a latitude, the paper's meter the only uncertainty.
pub fn setup(positions: &[Position], latitude_deg: f64) -> Setup {
    with_uncertainty(positions, latitude_deg, InputUncertainty::of_meter(paper_meter()))
}

/// `positions` at a latitude.
pub fn with_uncertainty(positions: &[Position], latitude_deg: f64, uncertainty: InputUncertainty) -> Setup {
    Setup::new(positions, EarthRate::at_astronomic_latitude(latitude_deg), uncertainty).expect("n_2 has an inverse")
}

/// The paper's gyro.
pub fn gvk_6() -> GyroParameters {
    GyroType::gvk_6().nominal.to_model()
}

/// The currents of a gyro on a stand, exact.
pub fn currents(setup: &Setup, gyro: &GyroParameters) -> Vec<Vector2<f64>> {
    setup.coefficients().positions.iter().map(|at| gyro.currents_ma(at).expect("K has an inverse")).collect()
}

/// One reading for each position.
pub fn readings(setup: &Setup, currents_ma: &[Vector2<f64>]) -> Readings {
    let each = setup.coefficients().positions.iter().zip(currents_ma);
    let each: Vec<_> = each.map(|(at, current)| (at.index, *current)).collect();
    Readings::new(setup.coefficients(), &each).expect("a reading for each position")
}

/// A reference case: its stand, its gyro's currents, its gyro's parameters in the order K_x, K_xy, K_yx, K_y, ω_0x,
/// ω_0y, ω_g, ω_k.
pub fn reference_case(case: &Value) -> (Setup, Vec<Vector2<f64>>, Vec<f64>) {
    let angles = numbers(&case["deviations_arcsec"]);
    let angles = angles.chunks_exact(3).map(|a| [a[0], a[1], a[2]].map(radians_from_arcseconds));
    let setup = setup(&eight(angles), case["latitude_deg"].as_f64().expect("a latitude"));
    let gyro = &case["gyro"];
    let currents = numbers(&gyro["currents_ma"]).chunks_exact(2).map(|pair| Vector2::new(pair[0], pair[1])).collect();
    let mut parameters = numbers(&gyro["k_deg_per_h_per_ma"]);
    for key in ["omega0_deg_per_h", "omega_g_deg_per_h_per_g", "omega_k_deg_per_h_per_g"] {
        parameters.extend(numbers(&gyro[key]));
    }
    (setup, currents, parameters)
}
