//! Tests that take more than some seconds or ask other programs: `tests/quick` leaves them out.

#[cfg(feature = "cli")]
mod alone;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod causes;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod coarse_readings;
#[cfg(feature = "monte-carlo")]
mod decisions;
#[cfg(feature = "monte-carlo")]
mod diagnosis;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod findings;
#[cfg(feature = "cli")]
mod fuzz;
#[cfg(feature = "cli")]
mod hostile_input;
#[cfg(feature = "cli")]
mod hostile_memory;
#[cfg(feature = "factory")]
mod noise;
#[cfg(feature = "report")]
mod repeats;
#[cfg(feature = "monte-carlo")]
mod runs;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod same_stand;
#[cfg(feature = "report")]
mod simulation;
#[cfg(feature = "monte-carlo")]
mod stated_uncertainty;
#[cfg(feature = "factory")]
mod suites;
#[cfg(feature = "factory")]
mod tampering;
#[cfg(all(feature = "factory", feature = "report"))]
mod uncertainty;
#[cfg(feature = "factory")]
mod yaml_readers;

#[cfg(feature = "monte-carlo")]
use dtg_passport::calibration::{MeterUncertainty, Method, Options};
#[cfg(feature = "monte-carlo")]
use dtg_passport::coefficients::EarthRate;
#[cfg(feature = "monte-carlo")]
use dtg_passport::gyro::GyroParameters;
#[cfg(feature = "monte-carlo")]
use dtg_passport::statistics::random::{Run, Stream};
#[cfg(feature = "monte-carlo")]
use nalgebra::{Matrix3, SMatrix, Vector2, Vector3};

/// Returns the number of trials of each kind: as many as the variable `DTG_TRIALS` says, or the usual number.
#[cfg(feature = "monte-carlo")]
fn trials(usual: u64) -> u64 {
    std::env::var("DTG_TRIALS").ok().and_then(|trials| trials.parse().ok()).unwrap_or(usual)
}

/// Returns the share of the trials that are of each kind, in percent.
#[cfg(feature = "monte-carlo")]
fn shares<const N: usize>(trials: u64, seed: u64, trial: impl Fn(&mut Stream) -> [bool; N] + Sync) -> [f64; N] {
    let sum = |one: [u64; N], other: [u64; N]| std::array::from_fn(|kind| one[kind] + other[kind]);
    let blocks = Run::new(trials, seed)
        .blocks(|stream, trials| (0..trials).fold([0; N], |count, _| sum(count, trial(stream).map(u64::from))));
    blocks.into_iter().fold([0; N], sum).map(|count| 100.0 * count as f64 / trials as f64)
}

#[cfg(feature = "monte-carlo")]
fn least_squares_only() -> Options {
    Options { methods: vec![Method::LeastSquares], ..Options::default() }
}

/// Draws an error of the meter's specification for each of these currents, mA.
#[cfg(feature = "monte-carlo")]
fn errors_of(meter: MeterUncertainty, currents_ma: &[Vector2<f64>], stream: &mut Stream) -> Vec<Vector2<f64>> {
    currents_ma.iter().map(|at| at.map(|j| meter.own_variance_ma2(j).sqrt() * stream.normal())).collect()
}

/// Returns the equations of a position for K_x, K_xy, K_yx, K_y, ω_0x, ω_0y, ω_g, ω_k, from its current and its specific force.
#[cfg(feature = "monte-carlo")]
fn equations(j: Vector2<f64>, n: Vector2<f64>) -> SMatrix<f64, 2, 8> {
    SMatrix::from_row_slice(&[j.x, j.y, 0.0, 0.0, 1.0, 0.0, n.x, -n.y, 0.0, 0.0, j.x, j.y, 0.0, 1.0, n.y, n.x])
}

/// Returns the current of a gyro with this attitude, from the axes of the base: K J = ω_3 − ω_0 − ω_n n.
#[cfg(feature = "monte-carlo")]
fn current(gyro: &GyroParameters, attitude: &Matrix3<f64>, latitude_deg: f64) -> Vector2<f64> {
    let earth = EarthRate::at_astronomic_latitude(latitude_deg);
    let rate = attitude * Vector3::new(0.0, earth.horizontal_deg_per_h, earth.vertical_deg_per_h);
    let drift = gyro.omega0_deg_per_h + gyro.omega_n_deg_per_h_per_g() * attitude.column(2).xy();
    gyro.k_deg_per_h_per_ma.try_inverse().expect("K has an inverse") * (rate.xy() - drift)
}
