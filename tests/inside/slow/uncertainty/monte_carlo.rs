//! Monte Carlo: the fast path against the exact one, first order, threads, long tails, and the number of trials.

use super::cases::{Case, three};
use crate::inside::reference::*;
use dtg_passport::attitude::{self, Deviation};
use dtg_passport::calibration::{
    Cause, InputUncertainty, Method, Model, Options, Readings, Setup, analytic, least_squares,
};
use dtg_passport::coefficients::{Coefficients, EIGHT_POSITIONS, Matrices, PositionCoefficients, pair_differences};
use dtg_passport::statistics::random::Stream;
use dtg_passport::uncertainty::engine::{BASE_AT_SITE, BLOCK, Engine};
use dtg_passport::uncertainty::monte_carlo::{Trials, tolerance};
use dtg_passport::uncertainty::{Budget, monte_carlo};
use dtg_passport::units::{radians_from_arcseconds, radians_from_degrees};
use dtg_passport_trials::wide_random::WIDTH;
use nalgebra::{Matrix3, Vector2, Vector3};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// The rotation that turns coordinates by the vector `turn`, with libm.
fn rotation(turn: Vector3<f64>) -> Matrix3<f64> {
    let angle = turn.norm();
    if angle == 0.0 {
        return Matrix3::identity();
    }
    let axis = turn / angle;
    let (sin, cos) = libm::sincos(angle);
    // v × δ as a matrix on v.
    let cross = Matrix3::new(0.0, axis.z, -axis.y, -axis.z, 0.0, axis.x, axis.y, -axis.x, 0.0);
    Matrix3::identity() + cross * sin + cross * cross * (1.0 - cos)
}

/// Coefficients and currents of one trial, by nalgebra and libm, one thing after the other.
fn exactly(case: &Case, engine: &Engine, deviates: &[f64]) -> (Coefficients, Vec<Vector2<f64>>) {
    let inputs = &engine.inputs;
    let value = |cause: Cause| {
        let place = inputs.iter().position(|input| input.cause == cause);
        place.map_or(0.0, |place| deviates[place] * inputs[place].standard_uncertainty)
    };
    let vector = |of: &dyn Fn(usize) -> Cause| Vector3::from_fn(|axis, _| value(of(axis)));
    let base = case.base() * rotation(vector(&|axis| BASE_AT_SITE[axis]));
    let latitude = radians_from_degrees(case.latitude_deg) + value(Cause::Latitude);
    let (sin, cos) = libm::sincos(latitude);
    let earth = Vector3::new(0.0, cos, sin) * dtg_passport::earth::rotation_deg_per_h();
    let mut positions = Vec::new();
    let mut currents = Vec::new();
    for (at, mean) in case.positions.iter().zip(case.readings.means_ma()) {
        let deviation = Deviation {
            alpha_rad: at.deviation.alpha_rad + value(Cause::Angle(at.index, 0)),
            beta_rad: at.deviation.beta_rad + value(Cause::Angle(at.index, 1)),
            gamma_rad: at.deviation.gamma_rad + value(Cause::Angle(at.index, 2)),
        };
        let case_turn = vector(&Cause::Seat) + vector(&|axis| Cause::Return(at.index, axis));
        let attitude = rotation(case_turn) * attitude::actual(at.theta_deg, at.phi_deg, &deviation) * base;
        let rate = attitude * earth;
        positions.push(PositionCoefficients {
            index: at.index,
            specific_force_g: attitude.column(2).xy(),
            specific_force_z_g: attitude.m33,
            earth_rate_deg_per_h: rate.xy(),
        });
        let read = mean + Vector2::from_fn(|axis, _| value(Cause::Reading(at.index, axis)));
        currents.push(read * (1.0 + value(Cause::Gain)) + Vector2::repeat(value(Cause::Offset)));
    }
    let find = |place: usize| positions.iter().find(|at| at.index == EIGHT_POSITIONS[place].0).expect("all eight");
    let (n1, n2) = pair_differences(|place| find(place).specific_force_g);
    let (omega1, omega2) = pair_differences(|place| find(place).earth_rate_deg_per_h);
    let n2_inverse = n2.try_inverse().expect("n_2 has an inverse");
    let delta = n2_inverse * n1;
    let matrices = Matrices {
        delta,
        b_deg_per_h: omega1 - omega2 * delta,
        c_deg_per_h_per_g: omega2 * n2_inverse,
        n1,
        n2,
        n2_inverse,
        omega1_deg_per_h: omega1,
        omega2_deg_per_h: omega2,
    };
    (Coefficients { positions, matrices: Some(matrices) }, currents)
}

/// What draws the trials of a calibration, and its first order.
fn both(setup: &Setup, readings: &Readings, method: Method) -> (Engine, Budget) {
    let engine = Engine::new(setup, readings, method).unwrap();
    (engine, Budget::new(setup, readings, method, &Options::default()).unwrap())
}

/// Standard deviates of as many trials as run side by side.
fn deviates(engine: &Engine, seed: u64, factor: f64) -> Vec<Vec<f64>> {
    let mut stream = Stream::new(seed);
    (0..WIDTH).map(|_| engine.inputs.iter().map(|_| factor * stream.normal()).collect()).collect()
}

/// Expected: the same trials by nalgebra, libm and the library's own closed solution, 1e-12 of each parameter; the last
/// round has deviations of degrees, where polynomials must give way to libm.
#[test]
fn the_fast_path_agrees_with_the_exact_one() {
    let mut worst: f64 = 0.0;
    for case in three() {
        let engine = Engine::new(&case.setup, &case.readings, Method::Analytic).unwrap();
        for (seed, factor) in [(1, 1.0), (2, 3.0), (3, 300.0)] {
            // Currents far off would make a singular gyro: only angles are made large.
            let mut trials = deviates(&engine, seed, 1.0);
            for trial in &mut trials {
                for (deviate, input) in trial.iter_mut().zip(&engine.inputs) {
                    if matches!(input.cause, Cause::Angle(..) | Cause::Seat(_)) || BASE_AT_SITE.contains(&input.cause) {
                        *deviate *= factor;
                    }
                }
            }
            let long_tails = engine.inputs.iter().any(|input| input.degrees_of_freedom.is_finite());
            if factor > 10.0 && !long_tails {
                continue; // Normal deviates never come this far, and the engine relies on it.
            }
            for (trial, found) in trials.iter().zip(engine.computation.solutions_for(&trials)) {
                let (coefficients, currents) = exactly(&case, &engine, trial);
                let due = analytic::solve(&coefficients, &currents).unwrap().parameters.to_vector();
                for (found, due) in found.iter().zip(due) {
                    worst = worst.max((found / due - 1.0).abs());
                }
            }
        }
    }
    println!("largest relative difference of the fast path: {worst:.1e}");
    assert!(worst < 1e-12, "{worst:e}");
}

/// Expected: the library's least squares, whose weights follow each trial's own solution: a hundredth of a standard
/// uncertainty.
#[test]
fn the_refit_is_that_of_least_squares() {
    let mut uncertainty = InputUncertainty::of_meter(paper_meter());
    uncertainty.angles_rad = vec![[radians_from_arcseconds(1e-9); 3]; 8];
    let case = &three()[1];
    let setup = with_uncertainty(&case.positions, case.latitude_deg, uncertainty);
    let readings = readings(&setup, &currents(&setup, &gvk_6()));
    let case = Case { setup, readings, positions: case.positions.clone(), ..*case };
    let (engine, budget) = both(&case.setup, &case.readings, Method::LeastSquares);
    let trials = deviates(&engine, 5, 1.0);
    for (trial, found) in trials.iter().zip(engine.computation.solutions_for(&trials)) {
        let (coefficients, currents) = exactly(&case, &engine, trial);
        let due = least_squares::solve(&coefficients, &currents, &paper_meter(), Model::Paper).unwrap();
        for ((found, due), line) in found.iter().zip(due.to_vector()).zip(&budget.parameters) {
            assert!((found - due).abs() < 0.01 * line.standard_uncertainty, "{}: {found} {due}", line.parameter.key());
        }
    }
}

fn fixed(trials: u64, threads: usize) -> Trials<'static> {
    Trials { trials: Some(trials), threads, ..Trials::adaptive(11) }
}

#[test]
fn the_same_seed_gives_the_same_bytes_on_any_number_of_threads() {
    let case = &three()[1];
    for method in [Method::Analytic, Method::LeastSquares] {
        let (engine, budget) = both(&case.setup, &case.readings, method);
        let one = monte_carlo(&engine, &budget, &fixed(7 * BLOCK - 5, 1));
        assert_eq!((one.trials, one.failed), (7 * BLOCK, 0));
        for threads in [0, 2, 5] {
            assert_eq!(monte_carlo(&engine, &budget, &fixed(7 * BLOCK, threads)), one);
        }
        let other = Trials { seed: 12, ..fixed(7 * BLOCK, 2) };
        assert_ne!(monte_carlo(&engine, &budget, &other).parameters, one.parameters);
    }
}

/// Where every uncertainty is known and small, first order is right: means, uncertainties, correlations and intervals
/// agree within the scatter of Monte Carlo (five standard errors).
#[test]
fn first_order_and_monte_carlo_agree() {
    let case = &three()[0];
    // Currents with errors: the two methods then have two results.
    let mut stream = Stream::new(5);
    let noisy: Vec<Vector2<f64>> =
        case.readings.means_ma().iter().map(|current| current.map(|j| j * (1.0 + 8.7e-5 * stream.normal()))).collect();
    let readings = readings(&case.setup, &noisy);
    for method in [Method::Analytic, Method::LeastSquares] {
        let (engine, budget) = both(&case.setup, &readings, method);
        let found = monte_carlo(&engine, &budget, &fixed(1_000_000, 2));
        let (mut of_u, mut of_ends) = (0.0_f64, 0.0_f64);
        let covariance = budget.covariance();
        let n = found.trials as f64;
        for (row, (line, trials)) in budget.parameters.iter().zip(&found.parameters).enumerate() {
            let u = line.standard_uncertainty;
            assert!((trials.mean - line.value).abs() < 5.0 * u / n.sqrt() + 1e-3 * u, "{:?}", trials);
            assert!((trials.standard_uncertainty / u - 1.0).abs() < 5.0 / (2.0 * n).sqrt() + 1e-4);
            let half = 1.959_964 * u;
            // The standard error of a quantile at 2.5 %: 2.67 u/√n.
            for (end, due) in trials.symmetric.iter().zip([line.value - half, line.value + half]) {
                assert!((end - due).abs() < 5.0 * 2.67 * u / n.sqrt() + 1e-3 * u, "{:?}", trials);
            }
            let [low, high] = trials.shortest;
            assert!(((high - low) / (2.0 * half) - 1.0).abs() < 0.01);
            let beyond = trials.differences.iter().any(|d| *d > tolerance(u));
            assert!(trials.first_order_valid != Some(beyond), "{:?}", trials);
            of_u = of_u.max((trials.standard_uncertainty / u - 1.0).abs());
            of_ends = of_ends.max(trials.differences[0].max(trials.differences[1]) / u);
            for column in 0..8 {
                let scale = (covariance[(row, row)] * covariance[(column, column)]).sqrt();
                assert!((found.covariance[(row, column)] - covariance[(row, column)]).abs() < 6.0 * scale / n.sqrt());
            }
        }
        let (of_u, n) = (100.0 * of_u, found.trials);
        println!(
            "first order against {n} trials, {}: u within {of_u:.2} %, ends of intervals {of_ends:.4} u",
            method.key()
        );
    }
}

/// Expected: JCGM 101, 6.4.9: t with ν degrees of freedom has ν/(ν − 2) times the variance of its estimate.
#[test]
fn few_degrees_of_freedom_are_drawn_as_such() {
    let mut uncertainty = InputUncertainty::of_meter(paper_meter());
    uncertainty.meter.reading = 1e-9;
    uncertainty.meter.floor_ma = 1e-12;
    uncertainty.angles_rad = vec![[radians_from_arcseconds(5.0); 3]; 8];
    uncertainty.angles_degrees_of_freedom = vec![6.0; 8];
    let setup = with_uncertainty(&three()[1].positions, LATITUDE_DEG, uncertainty);
    let readings = readings(&setup, &currents(&setup, &gvk_6()));
    let (engine, budget) = both(&setup, &readings, Method::Analytic);
    let found = monte_carlo(&engine, &budget, &fixed(400_000, 2));
    for (line, trials) in budget.parameters.iter().zip(&found.parameters) {
        let ratio = trials.standard_uncertainty / line.standard_uncertainty / (6.0_f64 / 4.0).sqrt();
        assert!((ratio - 1.0).abs() < 0.01, "{}: {ratio}", line.parameter.key());
    }
}

/// The adaptive procedure ends with every digit stable, and looks at it by the same rule on any number of threads.
#[test]
fn trials_go_on_until_digits_are_stable() {
    // u(K_x) and so on chosen by the meter: the first digits decide how many trials that takes.
    let setup = setup(&three()[0].positions, LATITUDE_DEG);
    let readings = readings(&setup, &currents(&setup, &gvk_6()));
    let (engine, budget) = both(&setup, &readings, Method::Analytic);
    let found = monte_carlo(&engine, &budget, &Trials { threads: 2, ..Trials::adaptive(3) });
    println!("{} trials", found.trials);
    assert!(found.stable && found.failed == 0);
    for line in &found.parameters {
        assert!(line.numerical.iter().all(|twice| *twice <= 0.2 * tolerance(line.standard_uncertainty)));
        assert_eq!(line.first_order_valid, Some(true), "{line:?}");
    }
}

/// A thousand million trials begin at once, tell how many are done and due, from which the time that is left follows, and
/// end when told to, with what is known.
#[test]
fn many_trials_tell_how_far_they_are() {
    let case = &three()[0];
    let (engine, budget) = both(&case.setup, &case.readings, Method::Analytic);
    let (cancel, told) = (AtomicBool::new(false), Mutex::new(Vec::new()));
    let progress = |done: u64, due: u64| {
        told.lock().unwrap().push((done, due));
        cancel.store(true, Ordering::Relaxed);
    };
    let run = Trials { cancel: Some(&cancel), progress: Some(&progress), ..fixed(1_000_000_000, 2) };
    let found = monte_carlo(&engine, &budget, &run);
    let due = 1_000_000_000_u64.div_ceil(BLOCK) * BLOCK;
    assert_eq!(told.into_inner().unwrap(), [(found.trials, due)]);
    assert!(found.trials < due / 50);
    let line = &budget.parameters[0];
    assert!((found.parameters[0].standard_uncertainty / line.standard_uncertainty - 1.0).abs() < 0.01);
}
