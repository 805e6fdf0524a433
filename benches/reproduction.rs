//! All figures of docs/development/reproduction.md at full size: `cargo bench --bench reproduction`.
//!
//! The command line also gives the tables of accuracy and Fig. 4 (`dtg-passport simulate accuracy` and
//! `dtg-passport simulate convergence`). The other figures have no command of their own.

use dtg_passport::calibration::Method;
use dtg_passport::calibration::iterative::{self, StopRule};
use dtg_passport::coefficients::{EarthRate, Position, StandGeometry};
use dtg_passport::gyro::GyroType;
use dtg_passport::simulation::draw::{self, CurrentError, Deviations};
use dtg_passport::simulation::{AccuracyOptions, PAPER_LATITUDE_DEG, Stands, accuracy};
use dtg_passport::simulation::{LIMITS_DEG, Run, convergence};
use std::time::Instant;

fn main() {
    paper_table();
    independent_within_tolerance();
    independent();
    exact();
    fig_4();
    step_is_no_bound();
}

fn paper_table() {
    println!("The paper's table in the paper's reading: gyro within tolerance, common gain error, 10,000 draws");
    for limit_deg in [0.5, 15.0, 45.0] {
        let mut options = AccuracyOptions::default();
        options.stands = Stands::Drawn { limit_deg };
        options.within_tolerance = true;
        options.current_error = CurrentError::Common;
        options.methods = vec![Method::Analytic];
        let mut range = [(f64::INFINITY, 0.0_f64); 8];
        for seed in 1..=30 {
            let found = accuracy(&options, &Run::new(10_000, seed));
            for (range, row) in range.iter_mut().zip(&found.rows) {
                *range = (range.0.min(row.worst), range.1.max(row.worst));
            }
        }
        for (row, range) in accuracy(&options, &Run::new(10_000, 1)).rows.iter().zip(range) {
            let bound = row.paper_bound.unwrap_or(f64::NAN);
            println!(
                "  {limit_deg:>4} deg {:<9} {:.5} {:<8} 30 seeds {:.5} to {:.5}; paper {bound}",
                row.parameter.key(),
                row.worst,
                row.unit,
                range.0,
                range.1
            );
        }
    }
}

fn independent_within_tolerance() {
    println!("The table with independent errors instead, 15 deg, 10,000 draws");
    let mut options = AccuracyOptions::default();
    options.within_tolerance = true;
    options.methods = vec![Method::Analytic];
    for row in accuracy(&options, &Run::new(10_000, 1)).rows {
        println!("  {:<9} {:.4} {}", row.parameter.key(), row.worst, row.unit);
    }
}

/// Prints the relative error of each parameter without errors in the currents: the effect of rounding alone.
fn exact() {
    println!("Exact currents: largest relative error of any parameter, 100,000 stands");
    for limit_deg in [0.5, 5.0, 15.0, 30.0, 45.0] {
        let mut options = AccuracyOptions::default();
        options.stands = Stands::Drawn { limit_deg };
        options.current_percent = 0.0;
        options.methods = vec![Method::Analytic, Method::LeastSquares];
        let found = accuracy(&options, &Run::new(100_000, 1));
        let largest = |method: Method| {
            let rows = found.rows.iter().filter(|row| row.method == method.key());
            // Percent for scale factors; the drifts are 20 deg/h and 10 deg/(h·g).
            let relative = rows.map(|row| match row.unit {
                "%" => row.worst / 100.0,
                "deg/h" => row.worst / 20.0,
                _ => row.worst / 10.0,
            });
            relative.fold(0.0, f64::max)
        };
        println!(
            "  {limit_deg:>4} deg: analytic {:.1e}, least squares {:.1e}",
            largest(Method::Analytic),
            largest(Method::LeastSquares)
        );
    }
}

/// Prints how often the remaining error after the last step exceeds step * rho / (1 - rho), its bound if T were normal.
fn step_is_no_bound() {
    println!("What is missing against step * rho/(1 - rho), 100,000 stands");
    for limit_deg in [5.0, 10.0, 15.0] {
        let blocks = Run::new(100_000, 1).blocks(|stream, trials| {
            let (mut beyond, mut largest) = (0_u64, 0.0_f64);
            for _ in 0..trials {
                let Some(ratio) = missing_over_bound(&draw::stand(stream, Deviations::Uniform, limit_deg)) else {
                    continue;
                };
                beyond += u64::from(ratio > 1.0);
                largest = largest.max(ratio);
            }
            (beyond, largest)
        });
        let beyond: u64 = blocks.iter().map(|block| block.0).sum();
        let largest = blocks.iter().map(|block| block.1).fold(0.0, f64::max);
        println!("  {limit_deg} deg: exceeded in {:.2} %, up to {largest:.1} times", beyond as f64 / 1000.0);
    }
}

fn missing_over_bound(stand: &[Position]) -> Option<f64> {
    let at = StandGeometry::new(stand).ok()?.at(EarthRate::at_astronomic_latitude(PAPER_LATITUDE_DEG));
    let gyro = GyroType::gvk_6().nominal.to_model();
    let currents: Vec<_> = at.positions.iter().map(|at| gyro.currents_ma(at)).collect::<Option<_>>()?;
    let found = iterative::solve(&at, &currents, &StopRule::default()).ok()?;
    let rho = found.spectral_radius;
    Some(found.remainder_k_deg_per_h_per_ma.norm() / (found.last_change_k_deg_per_h_per_ma.norm() * rho / (1.0 - rho)))
}

fn independent() {
    println!("Independent errors, nominal gyro, 100,000 stands");
    for limit_deg in [0.5, 5.0, 15.0, 30.0, 45.0] {
        let mut options = AccuracyOptions::default();
        options.stands = Stands::Drawn { limit_deg };
        options.methods = vec![Method::Analytic, Method::Iterative, Method::LeastSquares];
        let start = Instant::now();
        let found = accuracy(&options, &Run::new(100_000, 1));
        println!("  {limit_deg} deg, {:.1} s", start.elapsed().as_secs_f64());
        for row in &found.rows {
            println!(
                "  {:<14} {:<9} worst {:.5} sd {:.6} mean/sd {:+.4} {}; not solved {}",
                row.method,
                row.parameter.key(),
                row.worst,
                row.standard_deviation,
                row.mean / row.standard_deviation,
                row.unit,
                row.not_solved
            );
        }
    }
}

fn fig_4() {
    let start = Instant::now();
    let found = convergence(&LIMITS_DEG, &Run::new(100_000, 1));
    println!("Fig. 4, 100,000 stands a row, {:.1} s", start.elapsed().as_secs_f64());
    for row in found.rows {
        println!(
            "  {:<8} {:>5} deg: mean {:.3} p95 {:?} most {:?} not converged {:.4} +- {:.4} %",
            row.deviations,
            row.limit_deg,
            row.mean.unwrap_or(f64::NAN),
            row.percentile_95,
            row.most,
            row.not_converged_percent,
            row.not_converged_u_percent
        );
    }
}
