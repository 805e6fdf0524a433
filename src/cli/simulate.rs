//! Verb `simulate`: the paper's table and its Fig. 4.

use super::options::{Formatted, Picture, Threads};
use super::{Code, Failure, defaults, inputs, long_run, output};
use crate::calibration::Method;
use crate::coefficients::EarthRate;
use crate::gyro::GyroType;
use crate::report::picture::simulation as picture;
use crate::report::simulation as table;
use crate::simulation::draw::{CurrentError, Deviations};
use crate::simulation::{AccuracyOptions, LIMITS_DEG, PAPER_LATITUDE_DEG, Stands, accuracy, convergence};
use crate::stand::{CertifiedPosition, LARGEST_DEVIATION_DEG};
use crate::statistics::random::Run;
use clap::{Args, Subcommand};
use std::path::PathBuf;
use std::sync::LazyLock;

/// Simulate calibrations: the paper's table and its Fig. 4
#[derive(Args)]
pub(super) struct Options {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    Accuracy(AccuracyArguments),
    Convergence(ConvergenceArguments),
}

#[derive(Args)]
struct RunArguments {
    /// Seed of the random numbers; results do not depend on the number of threads
    #[arg(long, value_name = "S", default_value_t = 1, value_parser = inputs::whole::<u64>(0..=u64::MAX))]
    seed: u64,
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    _format: Formatted,
}

/// Reproduce the paper's table: errors of the parameters with random stands and currents
#[derive(Args)]
struct AccuracyArguments {
    /// Stand file to take the angles from [default: random stands]
    #[arg(long, value_name = "STAND", conflicts_with = "limit_deg", value_parser = defaults::stand())]
    stand: Option<PathBuf>,
    /// Site file [default: the paper's latitude, 55.7658°]
    #[arg(long, value_name = "SITE", value_parser = defaults::site())]
    site: Option<PathBuf>,
    /// Gyro type [default: the paper's GVK-6]
    #[arg(long, value_name = "FILE")]
    gyro: Option<PathBuf>,
    /// Draw each gyro randomly within its tolerance; errors are relative to the nominal values
    #[arg(long)]
    within_tolerance: bool,
    /// Half-width of the uniform distribution of the deviations, degrees
    #[arg(long, value_name = "D", default_value_t = 15.0, value_parser = inputs::number("a number", 0.0..=LARGEST_DEVIATION_DEG))]
    limit_deg: f64,
    /// Half-width of the uniform distribution of the current errors, percent
    #[arg(long, value_name = "P", default_value_t = 0.015, value_parser = inputs::number("a number", 0.0..=10.0))]
    current_percent: f64,
    /// Readings that share an error: none (independent), those of x and those of y (channel), or all (common)
    #[arg(long, value_enum, value_name = "WHICH", default_value = "independent")]
    current_error: CurrentError,
    /// Calibration methods
    #[arg(long, value_enum, value_delimiter = ',', default_value = "analytic,least-squares")]
    method: Vec<Method>,
    /// Number of random stands
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = inputs::whole::<u64>(1..=u64::MAX))]
    trials: u64,
    #[command(flatten)]
    run: RunArguments,
}

/// Reproduce the paper's Fig. 4: steps of the iterative method for each limit of the deviations
#[derive(Args)]
struct ConvergenceArguments {
    /// Limits of the deviations, degrees
    #[arg(long, value_name = "D,...", value_delimiter = ',', value_parser = inputs::number("a number", 0.0..=LARGEST_DEVIATION_DEG), default_value = PAPER_LIMITS.as_str())]
    limits_deg: Vec<f64>,
    /// Number of random stands at each limit
    #[arg(long, value_name = "N", default_value_t = 1_000, value_parser = inputs::whole::<u64>(1..=u64::MAX))]
    trials: u64,
    #[command(flatten)]
    run: RunArguments,
    #[command(flatten)]
    picture: Picture,
}

/// [`LIMITS_DEG`], as an option has them.
static PAPER_LIMITS: LazyLock<String> = LazyLock::new(|| LIMITS_DEG.map(|limit| limit.to_string()).join(","));

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    match &options.what {
        What::Accuracy(arguments) => run_accuracy(arguments),
        What::Convergence(arguments) => run_convergence(arguments),
    }
}

fn run_accuracy(arguments: &AccuracyArguments) -> Result<Code, Failure> {
    let earth = match &arguments.site {
        Some(path) => {
            let site = inputs::site(path)?;
            site.earth().rate(&site)
        }
        None => EarthRate::at_astronomic_latitude(PAPER_LATITUDE_DEG),
    };
    let stands = match &arguments.stand {
        Some(path) => Stands::Given(inputs::stand(path)?.positions.iter().map(CertifiedPosition::to_model).collect()),
        None => Stands::Drawn { limit_deg: arguments.limit_deg },
    };
    let options = AccuracyOptions {
        stands,
        earth,
        gyro: inputs::gyro(arguments.gyro.as_deref())?.unwrap_or_else(GyroType::gvk_6),
        within_tolerance: arguments.within_tolerance,
        current_percent: arguments.current_percent,
        current_error: arguments.current_error,
        methods: arguments.method.clone(),
    };
    let found = watched(&arguments.run, arguments.trials, 1, |run| accuracy(&options, run))?;
    output::write(|| &found, || table::accuracy(&found, &options))?;
    Ok(0)
}

fn run_convergence(arguments: &ConvergenceArguments) -> Result<Code, Failure> {
    let limits_deg = arguments.limits_deg.as_slice();
    let rows = (limits_deg.len() * Deviations::ALL.len()) as u64;
    let found = watched(&arguments.run, arguments.trials, rows, |run| convergence(limits_deg, run))?;
    let no_rows = || Failure::unusable("the picture could not be drawn: no rows");
    arguments.picture.save(|| picture::convergence(&found).ok_or_else(no_rows))?;
    output::write(|| &found, || table::convergence(&found))?;
    Ok(0)
}

/// Runs a simulation of `rows` times the trials.
fn watched<T>(
    arguments: &RunArguments,
    trials: u64,
    rows: u64,
    simulate: impl FnOnce(&Run) -> T,
) -> Result<T, Failure> {
    long_run::trials(trials.saturating_mul(rows), |cancel, bar| {
        let progress = |done: u64| bar.set_position(done);
        let usual = Run::new(trials, arguments.seed);
        Ok(simulate(&Run {
            cancel: Some(cancel),
            progress: Some(&progress),
            threads: arguments.threads.or(usual.threads),
            ..usual
        }))
    })
}
