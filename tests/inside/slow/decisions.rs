//! The share of sound gyros that pass by each decision rule, against what JCGM 106 predicts.

use super::stated_uncertainty::{inputs, read};
use crate::inside::reference::*;
use dtg_passport::calibration::verdict::{Decision, Found, against_type};
use dtg_passport::calibration::{Parameter, Readings, Setup, calibrate};
use dtg_passport::coefficients::EarthRate;
use dtg_passport::gyro::{DecisionRule, GyroParameters, GyroType, Rule, Tolerance};
use dtg_passport::statistics::random::Stream;
use nalgebra::{SMatrix, SVector};

const GYROS: usize = 600;

/// Draws of the prediction for all eight parameters together.
const DRAWS: usize = 200_000;

/// Standard deviation of the gyros of a type, as a share of the tolerance; those beyond the tolerance are not sound.
const SPREAD: f64 = 1.0 / 3.0;

/// Tolerances of GVK-6 in the units of the parameters, in their order: 0.05 % of 95, 0.5 % of 9.5, 0.01.
const TOLERANCE: [f64; 8] = [0.0475, 0.0475, 0.0475, 0.0475, 0.01, 0.01, 0.01, 0.01];

/// A sound gyro: deviations in units of the tolerance.
fn sound(stream: &mut Stream) -> [f64; 8] {
    std::array::from_fn(|_| {
        std::iter::repeat_with(|| SPREAD * stream.normal()).find(|deviation| deviation.abs() <= 1.0).unwrap()
    })
}

/// Φ, and the density of a sound gyro without its constant factor.
fn below(x: f64) -> f64 {
    0.5 * libm::erfc(-x / std::f64::consts::SQRT_2)
}
fn density(x: f64) -> f64 {
    libm::exp(-0.5 * (x / SPREAD) * (x / SPREAD))
}

/// The share of sound gyros whose measured value is within the acceptance limit (JCGM 106, 9.5.2), by Simpson's rule; `u`
/// and `limit` in units of the tolerance.
fn predicted(u: f64, limit: f64) -> f64 {
    let steps = 2_000;
    let integral = |of: &dyn Fn(f64) -> f64| -> f64 {
        let at = |step: i32| -1.0 + 2.0 * f64::from(step) / f64::from(steps);
        let weight = |step: i32| [2.0, 4.0][(step % 2) as usize] - f64::from(step == 0 || step == steps);
        (0..=steps).map(|step| weight(step) * of(at(step))).sum()
    };
    let accepted = |x: f64| if limit > 0.0 { below((limit - x) / u) - below((-limit - x) / u) } else { 0.0 };
    integral(&|x| density(x) * accepted(x)) / integral(&density)
}

/// Expected: JCGM 106, from the distribution of sound gyros and a normal error of the stated uncertainty: for each
/// parameter the integral over the two, for all eight together draws from their joint distribution, within 3 standard errors.
#[test]
fn sound_gyros_pass_as_jcgm_106_predicts() {
    pass_as_predicted(1.0);
}

/// Expected: as above, of a type with tolerances twice as wide, so that U is less than half of each.
#[test]
fn with_half_the_relative_uncertainty_too() {
    pass_as_predicted(2.0);
}

fn pass_as_predicted(wide: f64) {
    let tolerance = TOLERANCE.map(|tolerance| wide * tolerance);
    let (certified, u) = inputs();
    let setup = Setup::new(&certified, EarthRate::at_astronomic_latitude(LATITUDE_DEG), u.clone()).unwrap();
    let options = super::least_squares_only();
    let rules = [(Rule::Simple, None), (Rule::Guarded, Some(0.5)), (Rule::Guarded, None)];
    let limits = Tolerance {
        k_main_percent: 0.05 * wide,
        k_cross_percent: Some(0.5 * wide),
        k_cross_deg_per_h_per_ma: None,
        omega0_deg_per_h: tolerance[4],
        omega_g_deg_per_h_per_g: tolerance[6],
        omega_k_deg_per_h_per_g: tolerance[7],
    };
    let types = rules.map(|(rule, guard_band_of_u)| GyroType {
        decision: Some(DecisionRule { rule, guard_band_of_u }),
        tolerance: limits.clone(),
        ..GyroType::gvk_6()
    });
    let mut stream = Stream::new(106);
    let (mut each, mut all, mut covariance) = ([[0_u32; 8]; 3], [0_u32; 3], SMatrix::<f64, 8, 8>::zeros());
    for _ in 0..GYROS {
        let deviation = sound(&mut stream);
        let mut values = gvk_6().to_vector();
        for place in 0..8 {
            values[place] += tolerance[place] * deviation[place];
        }
        let rows = read(&mut stream, &certified, &u, &GyroParameters::from_vector(&values));
        let readings = Readings::of_rows(setup.coefficients(), &rows).unwrap();
        let result = &calibrate(&setup, &readings, &options).unwrap().results[0];
        let found = Found {
            parameters: result.parameters,
            standard_uncertainty: Parameter::EIGHT.map(|parameter| result.standard_uncertainty(parameter).unwrap()),
            degrees_of_freedom: [f64::INFINITY; 8],
            gravity_m_per_s2: 9.80665,
            gravity_u_m_per_s2: 0.0,
        };
        covariance += result.covariance.fixed_view::<8, 8>(0, 0) / GYROS as f64;
        for (rule, gyro_type) in types.iter().enumerate() {
            let verdict = against_type(&found, gyro_type);
            all[rule] += u32::from(verdict.overall == Decision::Pass);
            for row in &verdict.parameters {
                each[rule][row.parameter.place()] += u32::from(row.decision == Decision::Pass);
            }
        }
    }
    let u: [f64; 8] = std::array::from_fn(|place| covariance[(place, place)].sqrt() / tolerance[place]);
    let root = covariance.cholesky().unwrap().l();
    let mut predictions = Stream::new(107);
    let measured: Vec<[f64; 8]> = (0..DRAWS)
        .map(|_| {
            let deviation = sound(&mut predictions);
            let error = root * SVector::<f64, 8>::from_fn(|_, _| predictions.normal());
            std::array::from_fn(|place| deviation[place] + error[place] / tolerance[place])
        })
        .collect();
    let near = |passed: u32, share: f64, what: &str| {
        let (found, error) = (f64::from(passed) / GYROS as f64, libm::sqrt(share * (1.0 - share) / GYROS as f64));
        println!(
            "{what}: {passed} of {GYROS} passed, predicted {:.1} ± {:.1}",
            share * GYROS as f64,
            error * GYROS as f64
        );
        assert!((found - share).abs() <= 3.0 * error, "{what}: {found} instead of {share} ± {error}");
    };
    println!("u in units of the tolerance: {u:.3?}");
    for (rule, band) in [0.0, 0.5, 1.0].into_iter().enumerate() {
        let limit = u.map(|u| 1.0 - band * 2.0 * u);
        for parameter in Parameter::EIGHT {
            let place = parameter.place();
            near(each[rule][place], predicted(u[place], limit[place]), &format!("{} by {band} U", parameter.symbol()));
        }
        let within = |one: &&[f64; 8]| (0..8).all(|place| one[place].abs() <= limit[place]);
        let share = measured.iter().filter(within).count() as f64 / DRAWS as f64;
        near(all[rule], share, &format!("all eight by {band} U"));
    }
}
