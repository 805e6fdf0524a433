//! The paper's Fig. 4: the number of steps of the iterative method, depending on the limit of the deviations.

use super::accuracy::PAPER_LATITUDE_DEG;
use super::draw::{self, Deviations};
use crate::calibration::iterative::{Plan, StopRule};
use crate::coefficients::{EarthRate, StandGeometry};
use crate::gyro::{GyroParameters, GyroType};
use crate::statistics::random::{Run, Stream};
use crate::statistics::summary::{binomial_standard_error, percentile};
use serde::Serialize;

/// Options of the convergence simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct ConvergenceOptions {
    /// Limits of the deviations, degrees; all limits use the same random numbers.
    pub limits_deg: Vec<f64>,
    /// Distributions of the angles, with a series of rows for each.
    pub deviations: Vec<Deviations>,
    /// Stop rule of the iteration.
    pub stop_rule: StopRule,
    /// Earth rate at the site.
    pub earth: EarthRate,
    /// Parameters of the gyro.
    pub gyro: GyroParameters,
}

impl Default for ConvergenceOptions {
    /// Returns the options for the paper's gyro, place and stop rule, up to ±30°, uniform and at the corners.
    fn default() -> Self {
        Self {
            limits_deg: vec![0.1, 1.0, 3.0, 5.0, 7.5, 10.0, 12.5, 15.0, 17.5, 20.0, 25.0, 30.0],
            deviations: vec![Deviations::Uniform, Deviations::Corners],
            stop_rule: StopRule::default(),
            earth: EarthRate::at_astronomic_latitude(PAPER_LATITUDE_DEG),
            gyro: GyroType::gvk_6().nominal.to_model(),
        }
    }
}

/// Result of the convergence simulation: the paper's Fig. 4 as numbers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Convergence {
    /// Largest number of stands drawn for a row; the last row has fewer if cancelled.
    pub trials: u64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Rows, one for each distribution and each limit.
    pub rows: Vec<ConvergenceRow>,
}

/// Number of steps at one limit of the deviations.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConvergenceRow {
    /// Limit of the deviations, degrees.
    pub limit_deg: f64,
    /// Distribution of the angles: "uniform" within ± the limit, or "corners", with every angle at + or − the limit.
    pub deviations: &'static str,
    /// Mean number of steps of the stands that converged; absent if none did.
    pub mean: Option<f64>,
    /// 95th percentile of the number of steps of the stands that converged.
    pub percentile_95: Option<usize>,
    /// Largest number of steps of the stands that converged.
    pub most: Option<usize>,
    /// Share of stands that had not converged after 200 steps, percent.
    pub not_converged_percent: f64,
    /// Standard error of that share (binomial), percent.
    pub not_converged_u_percent: f64,
    /// Number of stands drawn.
    pub stands: u64,
}

/// Simulates the number of steps over stands drawn at random.
///
/// `run.progress` counts all rows together: up to the trials of the run times the number of rows.
pub fn convergence(options: &ConvergenceOptions, run: &Run) -> Convergence {
    let mut rows = Vec::new();
    let mut before = 0;
    for &deviations in &options.deviations {
        for &limit_deg in &options.limits_deg {
            let progress = |done: u64| {
                if let Some(progress) = run.progress {
                    progress(before + done);
                }
            };
            let part = Run { progress: Some(&progress), ..*run };
            let blocks = part.blocks(|stream, trials| steps(options, deviations, limit_deg, stream, trials));
            if let Some(row) = row(deviations, limit_deg, &blocks) {
                rows.push(row);
            }
            before += run.trials;
        }
    }
    Convergence { trials: run.trials, seed: run.seed, rows }
}

/// Returns the numbers of steps of the stands that converged in one block, and the number of stands drawn.
fn steps(
    options: &ConvergenceOptions,
    deviations: Deviations,
    limit_deg: f64,
    stream: &mut Stream,
    trials: u64,
) -> (Vec<u16>, u64) {
    let mut converged = Vec::new();
    for _ in 0..trials {
        let stand = draw::stand(stream, deviations, limit_deg);
        let plan = StandGeometry::new(&stand).ok().and_then(|geometry| {
            let at = geometry.at(options.earth);
            let currents = at.positions.iter().map(|position| options.gyro.currents_ma(position));
            Plan::new(&at, &currents.collect::<Option<Vec<_>>>()?).ok()
        });
        if let Some(steps) = plan.and_then(|plan| plan.steps(&options.stop_rule)) {
            converged.extend(u16::try_from(steps));
        }
    }
    (converged, trials)
}

/// Returns the row of one limit, or `None` if the run was cancelled before the first block.
fn row(deviations: Deviations, limit_deg: f64, blocks: &[(Vec<u16>, u64)]) -> Option<ConvergenceRow> {
    let mut converged: Vec<u16> = blocks.iter().flat_map(|(steps, _)| steps).copied().collect();
    converged.sort_unstable();
    let stands: u64 = blocks.iter().map(|(_, trials)| trials).sum();
    let missing = stands - converged.len() as u64;
    let sum: u64 = converged.iter().map(|steps| u64::from(*steps)).sum();
    (stands > 0).then(|| ConvergenceRow {
        limit_deg,
        deviations: deviations.key(),
        mean: (!converged.is_empty()).then(|| sum as f64 / converged.len() as f64),
        percentile_95: percentile(&converged, 0.95).map(usize::from),
        most: converged.last().copied().map(usize::from),
        not_converged_percent: 100.0 * missing as f64 / stands as f64,
        not_converged_u_percent: 100.0 * binomial_standard_error(missing, stands),
        stands,
    })
}
