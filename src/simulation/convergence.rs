//! The paper's Fig. 4: the number of steps of the iterative method, depending on the limit of the deviations.

use super::accuracy::PAPER_LATITUDE_DEG;
use super::draw::{self, Deviations};
use crate::calibration::iterative::{Plan, StopRule};
use crate::coefficients::{EarthRate, Position, StandGeometry};
use crate::gyro::GyroType;
use crate::statistics::random::Run;
use crate::statistics::summary::{binomial_standard_error, percentile};
use serde::Serialize;

/// Limits of the deviations in the paper's Fig. 4 and beyond, degrees.
#[doc(hidden)]
pub const LIMITS_DEG: [f64; 12] = [0.1, 1.0, 3.0, 5.0, 7.5, 10.0, 12.5, 15.0, 17.5, 20.0, 25.0, 30.0];

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
    /// Standard uncertainty of that mean, from the scatter of the steps; absent if fewer than two converged.
    pub mean_u: Option<f64>,
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

/// Simulates the number of steps with the paper's gyro, place and stop rule over stands drawn at random: for each
/// distribution of the angles and each of the limits, degrees, which all use the same random numbers.
///
/// `run.progress` counts all rows together: up to the trials of the run times the number of rows.
pub fn convergence(limits_deg: &[f64], run: &Run) -> Convergence {
    let (earth, gyro) = (EarthRate::at_astronomic_latitude(PAPER_LATITUDE_DEG), GyroType::gvk_6().nominal.to_model());
    let steps = |stand: &[Position]| {
        let at = StandGeometry::new(stand).ok()?.at(earth);
        let currents_ma: Option<Vec<_>> = at.positions.iter().map(|position| gyro.currents_ma(position)).collect();
        u16::try_from(Plan::new(&at, &currents_ma?).ok()?.steps(&StopRule::default())?).ok()
    };
    let mut rows = Vec::new();
    let mut before = 0;
    for deviations in Deviations::ALL {
        for &limit_deg in limits_deg {
            let progress = |done: u64| {
                if let Some(progress) = run.progress {
                    progress(before + done);
                }
            };
            let part = Run { progress: Some(&progress), ..*run };
            let blocks = part.blocks(|stream, trials| {
                let converged = (0..trials).filter_map(|_| steps(&draw::stand(stream, deviations, limit_deg)));
                (converged.collect(), trials)
            });
            if let Some(row) = row(deviations, limit_deg, &blocks) {
                rows.push(row);
            }
            before += run.trials;
        }
    }
    Convergence { trials: run.trials, seed: run.seed, rows }
}

/// Returns the row of one limit from the numbers of steps of the stands that converged in each block, and the number of
/// stands drawn; `None` if the run was cancelled before the first block.
fn row(deviations: Deviations, limit_deg: f64, blocks: &[(Vec<u16>, u64)]) -> Option<ConvergenceRow> {
    let mut converged: Vec<u16> = blocks.iter().flat_map(|(steps, _)| steps).copied().collect();
    converged.sort_unstable();
    let stands: u64 = blocks.iter().map(|(_, trials)| trials).sum();
    let missing = stands - converged.len() as u64;
    let number = converged.len() as f64;
    let mean = converged.iter().map(|steps| f64::from(*steps)).sum::<f64>() / number;
    let squares: f64 = converged.iter().map(|steps| (f64::from(*steps) - mean) * (f64::from(*steps) - mean)).sum();
    (stands > 0).then(|| ConvergenceRow {
        limit_deg,
        deviations: deviations.key(),
        mean: (!converged.is_empty()).then_some(mean),
        mean_u: (converged.len() > 1).then(|| (squares / (number - 1.0) / number).sqrt()),
        percentile_95: percentile(&converged, 0.95).map(usize::from),
        most: converged.last().copied().map(usize::from),
        not_converged_percent: 100.0 * missing as f64 / stands as f64,
        not_converged_u_percent: 100.0 * binomial_standard_error(missing, stands),
        stands,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected by hand: 2, 4 and 6 steps have the mean 4 and the standard deviation 2; one stand in four did not converge.
    #[test]
    fn a_mean_has_the_uncertainty_of_its_scatter() {
        let found = row(Deviations::ALL[0], 1.0, &[(vec![4, 2], 3), (vec![6], 1)]).unwrap();
        assert_eq!((found.mean, found.stands, found.not_converged_percent), (Some(4.0), 4, 25.0));
        assert!((found.mean_u.unwrap() - 2.0 / 3.0_f64.sqrt()).abs() < 1e-15, "{found:?}");
        let one = row(Deviations::ALL[0], 1.0, &[(vec![5], 1)]).unwrap();
        assert_eq!((one.mean, one.mean_u), (Some(5.0), None));
    }
}
