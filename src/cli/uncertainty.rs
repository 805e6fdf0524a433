//! Options of `calibrate` for the uncertainty budget and the Monte Carlo method.

use super::options::Threads;
use super::{Failure, inputs, long_run, output};
use crate::calibration::{Calibration, CalibrationDocument, Options as CalibrationOptions, Readings, Setup};
use crate::gyro::{GyroType, Tolerance};
use crate::interface::calibrated::{WholeDocument, distributions};
use crate::report::uncertainty as report;
use crate::uncertainty::monte_carlo::{Trials, refused_model};
use crate::uncertainty::{Budget, MonteCarlo};
use crate::wording::Language;
use clap::Args;
use indicatif::HumanDuration;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Expected duration above which the program announces how long the trials will take.
const LONG: Duration = Duration::from_secs(10);

#[derive(Args)]
pub(super) struct UncertaintyOptions {
    /// Uncertainty budget: contribution of every input to every parameter
    #[arg(long, help_heading = "Uncertainty")]
    pub budget: bool,
    /// Monte Carlo method (JCGM 101): coverage intervals, and validity of the linear approximation
    #[arg(long, help_heading = "Uncertainty")]
    monte_carlo: bool,
    /// Number of trials, rounded up to a multiple of 16384 [default: until every digit is stable, at most 200 million]
    #[arg(long, help_heading = "Uncertainty", value_name = "N", requires = "monte_carlo", value_parser = trials)]
    trials: Option<u64>,
    /// Seed of the random numbers; results do not depend on the number of threads
    #[arg(long, help_heading = "Uncertainty", value_name = "S", default_value_t = 1, requires = "monte_carlo", value_parser = inputs::whole::<u64>(0..=u64::MAX))]
    seed: u64,
    #[command(flatten)]
    threads: Threads,
}

/// Parses a number of trials, also in the form 1e9.
fn trials(text: &str) -> Result<u64, String> {
    const MOST: f64 = 1e12;
    let whole = |value: &f64| value.fract() == 0.0 && (1.0..=MOST).contains(value);
    let value = text.parse().ok().filter(whole);
    value.map(|value| value as u64).ok_or_else(|| "expected a whole number from 1 to 1e12".to_owned())
}

/// The requested budget and Monte Carlo result.
pub(super) struct Found {
    /// The budget, and the tolerances of the gyro type.
    pub budget: Option<(Budget, Option<Tolerance>)>,
    pub monte_carlo: Option<MonteCarlo>,
}

impl Found {
    /// Returns the results as text; empty if none was requested.
    pub(super) fn text(&self, gyro: Option<&GyroType>, document: &CalibrationDocument, language: Language) -> String {
        let budget = self.budget.as_ref().map(|(budget, _)| budget);
        report::text(budget, self.monte_carlo.as_ref(), (gyro, document), language)
    }

    /// Returns the result of a calibration with these, as JSON.
    pub(super) fn with<'a>(&'a self, calibration: &'a CalibrationDocument) -> WholeDocument<'a, MonteCarlo> {
        let budget = self.budget.as_ref().map(|(budget, tolerance)| budget.to_json(tolerance.as_ref()));
        WholeDocument { calibration, budget, monte_carlo: self.monte_carlo.as_ref() }
    }
}

impl UncertaintyOptions {
    /// Computes the requested budget and Monte Carlo result.
    pub(super) fn find(
        &self,
        setup: &Setup,
        readings: &Readings,
        calibration: &Calibration,
        (options, tolerance): (&CalibrationOptions, Option<&Tolerance>),
    ) -> Result<Found, Failure> {
        if !self.budget && !self.monte_carlo {
            return Ok(Found { budget: None, monte_carlo: None });
        }
        if let Some(why) = self.monte_carlo.then(|| refused_model(options)).flatten() {
            let advice = "omit --monte-carlo, or --anisoelasticity, --drift and --model general";
            return Err(Failure::unusable(format!("{why}; {advice}")));
        }
        let budget = Budget::of(calibration, setup, readings, options).map_err(Failure::refused)?;
        let trials = self.monte_carlo.then(|| self.trials(setup, readings, (&budget, options))).transpose()?;
        let budget = self.budget.then(|| (budget, tolerance.cloned()));
        Ok(Found { budget, monte_carlo: trials })
    }

    /// Runs the trials, and announces a run that takes long.
    fn trials(
        &self,
        setup: &Setup,
        readings: &Readings,
        of: (&Budget, &CalibrationOptions),
    ) -> Result<MonteCarlo, Failure> {
        let (start, told) = (Instant::now(), AtomicBool::new(false));
        long_run::trials(self.trials.unwrap_or(0), |cancel, bar| {
            let progress = |done: u64, due: u64| {
                bar.set_length(due);
                bar.set_position(done);
                let whole = start.elapsed().mul_f64(due as f64 / done.max(1) as f64);
                if whole > LONG && !told.swap(true, Ordering::Relaxed) {
                    output::say(&format!("{due} trials will take about {}", HumanDuration(whole)));
                }
            };
            let usual = Trials::adaptive(self.seed);
            let threads = self.threads.or(usual.threads);
            let (cancel, progress) = (Some(cancel), Some(&progress as &_));
            let run = Trials { trials: self.trials, cancel, progress, threads, ..usual };
            distributions(setup, readings, of, &run)
        })
    }
}
