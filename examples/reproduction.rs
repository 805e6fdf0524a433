//! Every figure of docs/reproduction.md at full size: `cargo run --release --example reproduction`.
//!
//! The command line gives the first two parts as well (`dtg-passport simulate accuracy`, `simulate convergence`); the
//! others have no command of their own.

use dtg_passport::calibration::Method;
use dtg_passport::simulation::accuracy::{AccuracyOptions, Stands, accuracy};
use dtg_passport::simulation::convergence::{ConvergenceOptions, convergence};
use dtg_passport::simulation::draw::CurrentError;
use dtg_passport::statistics::random::Run;
use std::time::Instant;

fn main() {
    paper_table();
    independent();
    fig_4();
}

fn paper_table() {
    println!("The paper's table in the paper's reading: gyro within tolerance, common gain error, 10,000 draws");
    for limit_deg in [0.5, 15.0, 45.0] {
        let options = AccuracyOptions {
            stands: Stands::Drawn { limit_deg },
            within_tolerance: true,
            current_error: CurrentError::Common,
            methods: vec![Method::Analytic],
            ..AccuracyOptions::default()
        };
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
                row.parameter, row.worst, row.unit, range.0, range.1
            );
        }
    }
}

fn independent() {
    println!("Independent errors, nominal gyro, 100,000 stands");
    for limit_deg in [0.5, 5.0, 15.0, 30.0, 45.0] {
        let options = AccuracyOptions {
            stands: Stands::Drawn { limit_deg },
            methods: Method::ALL.to_vec(),
            ..AccuracyOptions::default()
        };
        let start = Instant::now();
        let found = accuracy(&options, &Run::new(100_000, 1));
        println!("  {limit_deg} deg, {:.1} s", start.elapsed().as_secs_f64());
        for row in &found.rows {
            println!(
                "  {:<14} {:<9} worst {:.5} sd {:.6} mean/sd {:+.4} {}; not solved {}",
                row.method,
                row.parameter,
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
    let found = convergence(&ConvergenceOptions::default(), &Run::new(100_000, 1));
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
