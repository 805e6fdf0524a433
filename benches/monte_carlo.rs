//! Monte Carlo compared with NumPy, in one run: `cargo bench --bench monte_carlo`.
//!
//! The paper's gyro on a stand with arbitrary angles; each trial draws 24 angles (5″) and 16 currents (0.015 %/√3),
//! all normal, and computes the passport's coefficients and one method. NumPy runs on one core, from `target/test-tools`
//! if the tests have installed it there, otherwise as `python3`.
//!
//! Short slices of every kind of work alternate, and the medians are printed. There are two columns. The first is the
//! wall-clock time of the slices during which the machine had almost no other load. The second is the CPU time per
//! thread of all slices, which is the relevant one on a shared machine (but excludes the time that threads wait for
//! each other). Linux only.

use dtg_passport::attitude;
use dtg_passport::calibration::{InputUncertainty, MeterUncertainty, Method, Options, Readings, Setup};
use dtg_passport::coefficients::{EarthRate, Position};
use dtg_passport::gyro::GyroType;
use dtg_passport::simulation::draw::{self, Deviations};
use dtg_passport::simulation::{PAPER_LATITUDE_DEG, Stream};
use dtg_passport::uncertainty::{Budget, Engine, Trials, monte_carlo};
use nalgebra::Vector3;
use serde_json::{Value, json};
use std::hint::black_box;
use std::io::Write;
use std::process::{Command, Stdio};
use std::time::Instant;

/// Number of rounds, each with one run of NumPy. Number of slices of every kind in a round, each about a quarter of a
/// second.
const ROUNDS: usize = 7;
const SLICES: usize = 4;

/// Largest share of the machine that other processes may use in an undisturbed slice.
const OTHERS: f64 = 0.03;

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
    let meter = MeterUncertainty { reading, floor_ma: 1e-12, noise_ma: 0.0, gain: 0.0, offset_ma: 0.0 };
    let uncertainty = InputUncertainty {
        angles_rad: vec![[(U_ANGLE_ARCSEC / 3600.0).to_radians(); 3]; 8],
        ..InputUncertainty::of_meter(meter)
    };
    let earth = EarthRate::at_astronomic_latitude(PAPER_LATITUDE_DEG);
    let setup = Setup::new(&positions, earth, uncertainty).ok()?;
    let gyro = GyroType::gvk_6().nominal.to_model();
    let each = setup.coefficients().positions.iter().map(|at| Some((at.index, gyro.currents_ma(at)?)));
    let readings = Readings::new(setup.coefficients(), &each.collect::<Option<Vec<_>>>()?).ok()?;
    Some(Case { positions, earth, setup, readings })
}

/// Time of a slice of work, nanoseconds per trial.
#[derive(Clone, Copy)]
struct Slice {
    wall: f64,
    /// CPU time divided by the number of threads.
    processor: f64,
    undisturbed: bool,
}

/// Returns the CPU time of this process and that of all processes, in seconds.
fn processor_seconds() -> (f64, f64) {
    const TICKS_PER_SECOND: f64 = 100.0;
    let numbers = |path: &str, skip: usize, places: &[usize]| -> f64 {
        let text = std::fs::read_to_string(path).unwrap_or_default();
        // The program's name, in brackets, may contain spaces.
        let text = text.lines().next().unwrap_or_default().rsplit(')').next().unwrap_or_default().to_owned();
        let fields: Vec<f64> = text.split_whitespace().skip(skip).map(|word| word.parse().unwrap_or(0.0)).collect();
        places.iter().filter_map(|&place| fields.get(place)).sum::<f64>() / TICKS_PER_SECOND
    };
    // Fields: utime and stime; user, nice, system, irq, softirq and steal of all CPUs.
    (numbers("/proc/self/stat", 0, &[11, 12]), numbers("/proc/stat", 1, &[0, 1, 2, 5, 6, 7]))
}

/// Times `work`, which returns its number of trials.
fn timed(threads: u64, work: impl FnOnce() -> u64) -> Slice {
    let processors = std::thread::available_parallelism().map_or(1, usize::from) as f64;
    let (start, (own, all)) = (Instant::now(), processor_seconds());
    let trials = work() as f64;
    let wall = start.elapsed().as_secs_f64();
    let now = processor_seconds();
    let (own, all) = (now.0 - own, now.1 - all);
    let (wall_ns, processor_ns) = (wall * 1e9 / trials, own * 1e9 / trials / threads as f64);
    Slice { wall: wall_ns, processor: processor_ns, undisturbed: all - own <= OTHERS * wall * processors }
}

/// Times the whole procedure with its histograms, covariances and test of stability.
fn trials_of(engine: &Engine, budget: &Budget, threads: usize, trials: u64) -> Slice {
    let mut run = Trials::adaptive(1);
    (run.trials, run.threads) = (Some(trials), threads);
    timed(threads as u64, || black_box(monte_carlo(engine, budget, &run)).trials)
}

fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

/// Runs NumPy. Returns its times per trial and its standard deviations, or `None` if it failed.
fn numpy(case: &Case, budget: &Budget) -> Option<Value> {
    let rate = Vector3::new(0.0, case.earth.horizontal_deg_per_h, case.earth.vertical_deg_per_h);
    let nominal: Vec<_> = case.positions.iter().map(|at| attitude::nominal(at.theta_deg, at.phi_deg)).collect();
    let rows = |vectors: Vec<Vector3<f64>>| -> Vec<[f64; 3]> { vectors.into_iter().map(Into::into).collect() };
    let currents = case.readings.means_ma();
    // Weights from the meter alone; NumPy's fit needs no more to do the same work.
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
        "u_angle_rad": (U_ANGLE_ARCSEC / 3600.0).to_radians(),
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

/// Returns the largest resident memory of this process so far, in MB (Linux).
fn resident_mb() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? / 1024.0)
}

fn main() {
    let Some(case) = case() else { return };
    let engine = |method| Engine::new(&case.setup, &case.readings, method);
    let budget = |method| Budget::new(&case.setup, &case.readings, method, &Options::default());
    let (Ok(closed), Ok(refit)) = (engine(Method::Analytic), engine(Method::LeastSquares)) else { return };
    let (Ok(of_closed), Ok(of_refit)) = (budget(Method::Analytic), budget(Method::LeastSquares)) else { return };
    if let Some(trials) = std::env::args().skip_while(|word| word != "--memory").nth(1) {
        let trials = trials.parse().ok().map(|trials: f64| trials as u64);
        let mut run = Trials::adaptive(1);
        (run.trials, run.threads) = (trials, 2);
        let (start, found) = (Instant::now(), monte_carlo(&closed, &of_closed, &run));
        let (seconds, mb) = (start.elapsed().as_secs_f64(), resident_mb().unwrap_or(f64::NAN));
        println!("{} trials: {seconds:.1} s, {mb:.1} MB", found.trials);
        return;
    }
    let mut times: [Vec<Slice>; 3] = Default::default();
    let mut peers: [Vec<Slice>; 2] = Default::default();
    for _ in 0..ROUNDS {
        for _ in 0..SLICES {
            let measured = [
                trials_of(&closed, &of_closed, 2, 5_000_000),
                trials_of(&closed, &of_closed, 1, 2_500_000),
                trials_of(&refit, &of_refit, 2, 2_000_000),
            ];
            times.iter_mut().zip(measured).for_each(|(all, slice)| all.push(slice));
        }
        let Some(found) = numpy(&case, &of_closed) else {
            println!("no NumPy: see tests/run");
            return;
        };
        for (all, name) in peers.iter_mut().zip(["analytic", "least_squares"]) {
            let ns = |key: &str| found[name][key].as_f64().unwrap_or(f64::NAN);
            let (wall, processor) = (ns("wall_ns"), ns("processor_ns"));
            // A slice on one core is undisturbed if it had that core all the time.
            let slice = Slice { wall, processor, undisturbed: processor > (1.0 - OTHERS) * wall };
            // A copy for every slice of its round.
            all.extend([slice; SLICES]);
        }
    }
    print(&times, &peers);
}

fn print(times: &[Vec<Slice>; 3], peers: &[Vec<Slice>; 2]) {
    let [two, one, refit] = times;
    let [numpy, numpy_refit] = peers;
    let alone = |all: &[Slice]| median(all.iter().filter(|slice| slice.undisturbed).map(|slice| slice.wall));
    let shown = |value: Option<f64>, decimals: usize| value.map_or("-".to_owned(), |ns| format!("{ns:.decimals$}"));
    println!("{:<52}{:>12}{:>8}{:>16}", "ns per trial, medians", "undisturbed", "slices", "processor time");
    for (name, all) in [
        ("closed solution, 2 threads", two),
        ("closed solution, 1 thread", one),
        ("least-squares refit, 2 threads", refit),
        ("NumPy, closed solution, 1 core", numpy),
        ("NumPy, least-squares refit, 1 core", numpy_refit),
    ] {
        let count = all.iter().filter(|slice| slice.undisturbed).count();
        let processor = median(all.iter().map(|slice| slice.processor));
        println!("  {name:<50}{:>12}{count:>8}{:>16}", shown(alone(all), 1), shown(processor, 1));
    }
    println!("{:<52}{:>12}{:>8}{:>16}", "ratios", "undisturbed", "", "processor time");
    for (name, above, below, asked) in [
        ("closed: NumPy / 2 threads", numpy, two, ">= 10"),
        ("refit: NumPy / 2 threads", numpy_refit, refit, ">= 10"),
        ("closed: 1 thread / 2 threads", one, two, ">= 1.8"),
    ] {
        let undisturbed = alone(above).zip(alone(below)).map(|(above, below)| above / below);
        let processor = median(above.iter().zip(below).map(|(a, b)| a.processor / b.processor));
        println!("  {name:<50}{:>12}{asked:>8}{:>16}", shown(undisturbed, 2), shown(processor, 2));
    }
}
