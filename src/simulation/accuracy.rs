//! The paper's table: errors of computed parameters relative to the nominal ones
//! ([the paper](crate::bibliography::Bibliography::Tang17), "Results of modelling the analytic method").
//!
//! Two interpretations of the table are useful (docs/development/reproduction.md, "The table"). With a gyro drawn within its
//! tolerance and one gain error common to all currents, the simulation gives the paper's figures at any deviations. A
//! nominal gyro with an independent error in every current is the usual case in a laboratory.

use super::draw::{self, CurrentError, Deviations};
use crate::calibration::iterative::{self, StopRule};
use crate::calibration::{MeterUncertainty, Method, Model, Parameter, analytic, least_squares};
use crate::coefficients::{Coefficients, EarthRate, Position, StandGeometry};
use crate::gyro::{GyroParameters, GyroType};
use crate::laboratory::Laboratory;
use crate::statistics::random::{Run, Stream};
use crate::statistics::summary::Summary;
use nalgebra::Vector2;
use serde::Serialize;

/// Latitude of the paper's laboratory, degrees.
#[doc(hidden)]
pub const PAPER_LATITUDE_DEG: f64 = 55.7658;

/// Stands of a simulation.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Stands {
    /// Stands drawn for every trial, with every angle uniform within ±`limit_deg`.
    Drawn {
        /// Limit of the deviations, degrees.
        limit_deg: f64,
    },
    /// Positions of one stand for all trials.
    Given(Vec<Position>),
}

/// Options of the accuracy simulation.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct AccuracyOptions {
    /// Stands of the simulation.
    pub stands: Stands,
    /// Earth rate at the site.
    pub earth: EarthRate,
    /// Nominal parameters and tolerance of the gyro.
    pub gyro: GyroType,
    /// `true` to draw the gyro of every trial within the tolerance; computed parameters are compared with nominal ones.
    pub within_tolerance: bool,
    /// Limit of the relative error of the currents, percent.
    pub current_percent: f64,
    /// Correlation of the errors of the readings.
    pub current_error: CurrentError,
    /// Methods to compare.
    pub methods: Vec<Method>,
}

impl Default for AccuracyOptions {
    /// Returns the options for the paper's nominal gyro in its laboratory: stands within ±15°, independent errors of
    /// ±0.015 %.
    fn default() -> Self {
        Self {
            stands: Stands::Drawn { limit_deg: 15.0 },
            earth: EarthRate::at_astronomic_latitude(PAPER_LATITUDE_DEG),
            gyro: GyroType::gvk_6(),
            within_tolerance: false,
            current_percent: 0.015,
            current_error: CurrentError::Independent,
            methods: vec![Method::Analytic, Method::LeastSquares],
        }
    }
}

/// Result of the accuracy simulation: the paper's table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AccuracyTable {
    /// Number of trials made; fewer than requested if cancelled.
    pub trials: u64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Limit of the deviations, degrees, if stands were drawn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit_deg: Option<f64>,
    /// Astronomic latitude of the site, degrees.
    pub latitude_deg: f64,
    /// Rows of the table, one for each method and parameter.
    pub rows: Vec<AccuracyRow>,
}

/// Errors of one parameter computed by one method.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AccuracyRow {
    /// Key of the method.
    pub method: &'static str,
    /// Parameter whose errors the row shows.
    pub parameter: Parameter,
    /// Unit of the errors: percent of the nominal value for K.
    pub unit: &'static str,
    /// Largest magnitude of the error; NaN, as the standard deviation and the mean, if no trial gave a result.
    pub worst: f64,
    /// Standard deviation of the error about its mean.
    pub standard_deviation: f64,
    /// Mean error.
    pub mean: f64,
    /// Number of trials without a solution.
    pub not_solved: u64,
    /// Error bound in the paper's table, for the paper's gyro only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub paper_bound: Option<f64>,
}

/// Returns the error bound of a parameter in the paper's table, in percent for K.
fn bound_of_the_paper(parameter: Parameter) -> f64 {
    match parameter {
        Parameter::Kx | Parameter::Ky => 0.0645,
        Parameter::Kxy | Parameter::Kyx => 0.514,
        _ => 0.01,
    }
}

/// Simulates the errors of the computed parameters over stands, gyros and currents drawn at random.
pub fn accuracy(options: &AccuracyOptions, run: &Run) -> AccuracyTable {
    let simulation = Simulation::new(options);
    let blocks = run.blocks(|stream, trials| simulation.block(stream, trials));
    let trials = blocks.iter().map(|block| block.trials).sum();
    let mut rows = Vec::new();
    for (place, method) in options.methods.iter().enumerate() {
        for parameter in Parameter::AS_IN_THE_PAPER {
            let summary =
                blocks.iter().fold(Summary::default(), |sum, block| sum.with(&block.errors[place][parameter.place()]));
            rows.push(simulation.row(*method, parameter, &summary, trials));
        }
    }
    let limit_deg = match options.stands {
        Stands::Drawn { limit_deg } => Some(limit_deg),
        Stands::Given(_) => None,
    };
    let latitude_deg = options.earth.astronomic_latitude_deg();
    AccuracyTable { trials, seed: run.seed, limit_deg, latitude_deg, rows }
}

/// Errors of one block of trials, by method and parameter.
struct Block {
    trials: u64,
    errors: Vec<[Summary; 8]>,
}

struct Simulation<'a> {
    options: &'a AccuracyOptions,
    nominal: GyroParameters,
    /// Value of one unit of each error in the unit of the parameter: 1 % of K, 1 °/h, 1 °/(h·g).
    units: [f64; 8],
    given: Option<Coefficients>,
    meter: MeterUncertainty,
}

impl<'a> Simulation<'a> {
    fn new(options: &'a AccuracyOptions) -> Self {
        let nominal = options.gyro.nominal.to_model();
        let mut units = [1.0; 8];
        for (unit, value) in units.iter_mut().zip(nominal.to_vector()).take(4).filter(|(_, value)| *value != 0.0) {
            *unit = value.abs() / 100.0;
        }
        let given = match &options.stands {
            Stands::Given(positions) => StandGeometry::new(positions).ok().map(|geometry| geometry.at(options.earth)),
            Stands::Drawn { .. } => None,
        };
        let mut meter = MeterUncertainty::from(&Laboratory::paper().meter);
        // The standard deviation of a uniform distribution is its limit over √3.
        meter.reading = options.current_percent / 100.0 / 3.0_f64.sqrt();
        Self { options, nominal, units, given, meter }
    }

    fn block(&self, stream: &mut Stream, trials: u64) -> Block {
        let mut errors = vec![[Summary::default(); 8]; self.options.methods.len()];
        for _ in 0..trials {
            let Some((coefficients, currents_ma)) = self.draw(stream) else { continue };
            for (method, errors) in self.options.methods.iter().zip(&mut errors) {
                if let Some(found) = self.solve(*method, &coefficients, &currents_ma) {
                    let all = errors.iter_mut().zip(found.to_vector()).zip(self.nominal.to_vector()).zip(self.units);
                    for (((summary, found), nominal), unit) in all {
                        summary.add((found - nominal) / unit);
                    }
                }
            }
        }
        Block { trials, errors }
    }

    /// Draws a stand and a gyro's currents on it; returns `None` if the stand is singular or the gyro has no currents.
    fn draw(&self, stream: &mut Stream) -> Option<(Coefficients, Vec<Vector2<f64>>)> {
        let options = self.options;
        let coefficients = match (&options.stands, &self.given) {
            (Stands::Drawn { limit_deg }, _) => {
                let stand = draw::stand(stream, Deviations::Uniform, *limit_deg);
                StandGeometry::new(&stand).ok().map(|geometry| geometry.at(options.earth))
            }
            (Stands::Given(_), given) => given.clone(),
        };
        let gyro = if options.within_tolerance { draw::gyro(stream, &options.gyro) } else { self.nominal };
        let coefficients = coefficients?;
        let mut currents_ma: Vec<_> =
            coefficients.positions.iter().map(|at| gyro.currents_ma(at)).collect::<Option<_>>()?;
        options.current_error.add(stream, options.current_percent, &mut currents_ma);
        Some((coefficients, currents_ma))
    }

    fn solve(&self, method: Method, at: &Coefficients, currents_ma: &[Vector2<f64>]) -> Option<GyroParameters> {
        match method {
            Method::Analytic => analytic::solve(at, currents_ma).ok().map(|found| found.parameters),
            Method::Iterative => {
                iterative::solve(at, currents_ma, &StopRule::default()).ok().map(|found| found.parameters)
            }
            Method::LeastSquares => least_squares::solve(at, currents_ma, &self.meter, Model::Paper).ok(),
        }
    }

    fn row(&self, method: Method, parameter: Parameter, errors: &Summary, trials: u64) -> AccuracyRow {
        let of_the_paper = self.options.gyro.nominal == GyroType::gvk_6().nominal;
        let relative = parameter.place() < 4 && self.nominal.to_vector()[parameter.place()] != 0.0;
        let known = |value: f64| if errors.count > 0 { value } else { f64::NAN };
        AccuracyRow {
            method: method.key(),
            parameter,
            unit: if relative { "%" } else { parameter.unit() },
            worst: known(errors.worst),
            standard_deviation: known(errors.standard_deviation()),
            mean: known(errors.mean()),
            not_solved: trials - errors.count,
            paper_bound: of_the_paper.then(|| bound_of_the_paper(parameter)),
        }
    }
}
