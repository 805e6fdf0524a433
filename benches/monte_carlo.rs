//! Monte Carlo against NumPy and against its own random numbers, all in one run: `cargo bench --bench monte_carlo`.
//!
//! The paper's gyro on a stand with general angles; 24 normal angles (5″) and 16 uniform currents (±0.015 %) drawn; the
//! passport's coefficients and a method in every trial. NumPy runs on one core, from `target/test-tools` where the tests
//! have installed it, otherwise as `python3`. Rounds alternate, so that all share the machine's mood; medians count.

use dtg_passport::attitude;
use dtg_passport::calibration::{InputUncertainty, MeterUncertainty, Method, Readings, Setup};
use dtg_passport::coefficients::{EarthRate, Position};
use dtg_passport::gyro::GyroType;
use dtg_passport::simulation::accuracy::PAPER_LATITUDE_DEG;
use dtg_passport::simulation::draw::{self, Deviations};
use dtg_passport::statistics::lanes::Lanes;
use dtg_passport::statistics::random::Stream;
use dtg_passport::uncertainty::engine::{BLOCK, Engine, ReadingShape};
use dtg_passport::uncertainty::monte_carlo::Trials;
use dtg_passport::uncertainty::{Budget, MonteCarlo, monte_carlo};
use dtg_passport::units::radians_from_arcseconds;
use nalgebra::Vector3;
use serde_json::{Value, json};
use std::hint::black_box;
use std::io::Write;
use std::process::{Command, Stdio};
use std::time::Instant;

const ROUNDS: usize = 7;
const U_ANGLE_ARCSEC: f64 = 5.0;
const READING_LIMIT: f64 = 0.015e-2;

struct Case {
    positions: Vec<Position>,
    earth: EarthRate,
    setup: Setup,
    readings: Readings,
}

fn case() -> Option<Case> {
    let positions = draw::stand(&mut Stream::new(1), Deviations::Uniform, 5.0);
    let reading = READING_LIMIT / 3.0_f64.sqrt();
    let meter = MeterUncertainty { reading, floor_ma: 1e-12, gain: 0.0, offset_ma: 0.0 };
    let uncertainty = InputUncertainty {
        angles_rad: vec![[radians_from_arcseconds(U_ANGLE_ARCSEC); 3]; 8],
        ..InputUncertainty::of_meter(meter)
    };
    let earth = EarthRate::at_astronomic_latitude(PAPER_LATITUDE_DEG);
    let setup = Setup::new(&positions, earth, uncertainty).ok()?;
    let gyro = GyroType::gvk_6().nominal.to_model();
    let each = setup.coefficients().positions.iter().map(|at| Some((at.index, gyro.currents_ma(at)?)));
    let readings = Readings::new(setup.coefficients(), &each.collect::<Option<Vec<_>>>()?).ok()?;
    Some(Case { positions, earth, setup, readings })
}

/// Blocks on `threads` threads: nanoseconds per trial of wall-clock time.
fn blocks(threads: u64, each: u64, work: impl Fn(&mut Lanes, u64) + Sync) -> f64 {
    let start = Instant::now();
    std::thread::scope(|scope| {
        for thread in 0..threads {
            let work = &work;
            scope.spawn(move || {
                let mut lanes = Lanes::new(thread);
                work(&mut lanes, each);
            });
        }
    });
    start.elapsed().as_secs_f64() * 1e9 / (threads * each * BLOCK) as f64
}

fn trials_alone(engine: &Engine, threads: u64, each: u64) -> f64 {
    blocks(threads, each, |lanes, count| {
        let mut work = engine.workspace();
        // The sums that NumPy takes too.
        let (mut sums, mut squares) = ([0.0; 8], [0.0; 8]);
        for _ in 0..count {
            engine.block(lanes, &mut work, |solutions| {
                for ((sum, square), column) in sums.iter_mut().zip(&mut squares).zip(solutions) {
                    *sum += column.iter().sum::<f64>();
                    *square += column.iter().map(|x| x * x).sum::<f64>();
                }
            });
        }
        black_box((sums, squares));
    })
}

fn drawing_alone(engine: &Engine, threads: u64, each: u64) -> f64 {
    blocks(threads, each, |lanes, count| {
        let mut work = engine.workspace();
        for _ in 0..count {
            black_box(engine.draw_alone(lanes, &mut work));
        }
    })
}

/// The whole procedure with its histograms, covariances and stability: nanoseconds per trial, and what it found.
fn whole(engine: &Engine, budget: &Budget, threads: usize, trials: u64) -> (f64, MonteCarlo) {
    let start = Instant::now();
    let found = monte_carlo(engine, budget, &Trials { trials: Some(trials), threads, ..Trials::adaptive(1) });
    (start.elapsed().as_secs_f64() * 1e9 / found.trials as f64, found)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Trials per second of NumPy, and its standard deviations.
fn numpy(case: &Case, budget: &Budget) -> Option<Value> {
    let rate = Vector3::new(0.0, case.earth.horizontal_deg_per_h, case.earth.vertical_deg_per_h);
    let nominal: Vec<_> = case.positions.iter().map(|at| attitude::nominal(at.theta_deg, at.phi_deg)).collect();
    let rows = |vectors: Vec<Vector3<f64>>| -> Vec<[f64; 3]> { vectors.into_iter().map(Into::into).collect() };
    let currents = case.readings.means_ma();
    // Weights of the meter alone, which is all that NumPy's fit needs to do the same work.
    let k = GyroType::gvk_6().nominal.to_model().k_deg_per_h_per_ma;
    let weights = currents.iter().map(|current| {
        let variance = current.map(|j| (j * READING_LIMIT).powi(2) / 3.0 + 1e-18);
        let p = (k * nalgebra::Matrix2::from_diagonal(&variance) * k.transpose()).try_inverse()?;
        Some([p.m11, p.m12, p.m22])
    });
    let input = json!({
        "angles_rad": case.positions.iter().map(|at| {
            [at.deviation.alpha_rad, at.deviation.beta_rad, at.deviation.gamma_rad]
        }).collect::<Vec<_>>(),
        "u_angle_rad": radians_from_arcseconds(U_ANGLE_ARCSEC),
        "vertical": rows(nominal.iter().map(|a| a.column(2).into_owned()).collect()),
        "earth": rows(nominal.iter().map(|a| a * rate).collect()),
        "currents_ma": currents.iter().map(|j| [j.x, j.y]).collect::<Vec<_>>(),
        "reading_limit": READING_LIMIT,
        "weights": weights.collect::<Option<Vec<_>>>()?,
        "seconds": 0.25,
    });
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let installed = folder.join("target/test-tools/venv/bin/python");
    let python = if installed.is_file() { installed } else { "python3".into() };
    let script = folder.join("benches/monte_carlo_numpy.py");
    let mut child = Command::new(python).arg(script).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().ok()?;
    child.stdin.take()?.write_all(input.to_string().as_bytes()).ok()?;
    let output = child.wait_with_output().ok()?;
    let found: Value = serde_json::from_slice(&output.stdout).ok()?;
    for (line, other) in budget.parameters.iter().zip(found["analytic"]["standard_deviations"].as_array()?) {
        let ratio = other.as_f64()? / line.standard_uncertainty;
        assert!((ratio - 1.0).abs() < 0.05, "NumPy does other work: {} {ratio}", line.parameter.key());
    }
    Some(found)
}

/// Largest resident memory of a process of this program that makes so many trials, in MB (Linux).
fn resident_mb() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? / 1024.0)
}

fn main() {
    let Some(case) = case() else { return };
    let engine = |method| Engine::new(&case.setup, &case.readings, method, ReadingShape::Uniform);
    let budget = |method| Budget::new(&case.setup, &case.readings, method, false);
    let (Ok(closed), Ok(refit)) = (engine(Method::Analytic), engine(Method::LeastSquares)) else { return };
    let (Ok(of_closed), Ok(of_refit)) = (budget(Method::Analytic), budget(Method::LeastSquares)) else { return };
    if let Some(trials) = std::env::args().skip_while(|word| word != "--memory").nth(1) {
        let trials = trials.parse().unwrap_or(100_000);
        let (ns, found) = whole(&closed, &of_closed, 2, trials);
        println!(
            "{} trials: {:.1} s, {:.1} MB",
            found.trials,
            ns * found.trials as f64 / 1e9,
            resident_mb().unwrap_or(0.0)
        );
        return;
    }
    let mut times: [Vec<f64>; 8] = Default::default();
    let mut peers: [Vec<f64>; 2] = Default::default();
    for _ in 0..ROUNDS {
        let measured = [
            trials_alone(&closed, 2, 60),
            drawing_alone(&closed, 2, 60),
            trials_alone(&closed, 1, 60),
            trials_alone(&refit, 2, 20),
            trials_alone(&refit, 1, 20),
            whole(&closed, &of_closed, 2, 4_000_000).0,
            whole(&closed, &of_closed, 1, 2_000_000).0,
            whole(&refit, &of_refit, 2, 1_000_000).0,
        ];
        times.iter_mut().zip(measured).for_each(|(all, time)| all.push(time));
        if let Some(found) = numpy(&case, &of_closed) {
            for (all, name) in peers.iter_mut().zip(["analytic", "least_squares"]) {
                all.push(1e9 / found[name]["trials_per_s"].as_f64().unwrap_or(f64::NAN));
            }
        }
    }
    let [two, drawing, one, refit_two, refit_one, whole_two, whole_one, whole_refit] = times.clone().map(median);
    // Ratios of neighbours in time, then their medians: what disturbs one mostly disturbs the other.
    let ratio = |above: &[f64], below: &[f64]| median(above.iter().zip(below).map(|(a, b)| a / b).collect());
    let [numpy, numpy_refit] = peers.clone().map(median);
    println!("medians of {ROUNDS} rounds, ns per trial (wall clock)");
    println!(
        "closed solution, 2 threads {two:.1}, 1 thread {one:.1}; its random numbers alone, 2 threads {drawing:.1}"
    );
    println!("least-squares refit, 2 threads {refit_two:.1}, 1 thread {refit_one:.1}");
    println!(
        "with histograms and covariance: closed, 2 threads {whole_two:.1}, 1 thread {whole_one:.1}; refit {whole_refit:.1}"
    );
    println!("NumPy, 1 core: closed {numpy:.1}, refit {numpy_refit:.1}");
    println!(
        "closed: NumPy / 2 threads = {:.1} (asked for: 10); with histograms {:.1}",
        ratio(&peers[0], &times[0]),
        ratio(&peers[0], &times[5])
    );
    println!("closed: 2 threads / drawing alone = {:.2} (at most 2.0)", ratio(&times[0], &times[1]));
    println!("refit: NumPy / 2 threads = {:.1} (asked for: 10)", ratio(&peers[1], &times[3]));
    println!(
        "closed: 1 thread / 2 threads = {:.2} (asked for: 1.8); with histograms {:.2}",
        ratio(&times[2], &times[0]),
        ratio(&times[6], &times[5])
    );
}
