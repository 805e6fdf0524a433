//! Calibration of a gyro: from the sixteen currents of the eight positions to its parameters.
//!
//! The input is the coefficients of a stand at a site, never a passport.
//!
//! * `readings`: the currents, from CSV.
//! * `analytic`: the paper's analytic method, eq. (13)-(16) and (8).
//! * [`iterative`]: the paper's iterative method, eq. (17)-(19).
//! * `least_squares`: weighted least squares on all readings of any positions.
//! * `procedure`: all methods side by side, with their options; `result`: their results with uncertainties and residuals.
//! * `data`: mean currents with their errors, and fits to them; `chi_square`: the test of a fit.
//! * `recorded`: rounding of the readings, and repeated readings without scatter.
//! * `repeats`: numbers of visits and readings, and the errors assumed for each; `scatter`: their agreement with what was
//!   stated.
//! * `noise`: the gyro's own noise; `offsets`: drift that changes during a run; `drift`: the test of a drift in time.
//! * `finding`: what explains readings that do not agree, or parameters that are not the gyro's: one list of causes.
//! * `verdict`: comparison with a type's specification and with an earlier calibration.
//! * `document`: the result as JSON; `remarks`: what is said about it.
//! * `prediction`: the expected uncertainty of a calibration on a stand, before any reading.
//! * `estimates`: the standard uncertainties that rest on a common estimate.
//! * `causes`: the uncertain inputs by name, from which budgets are made.
//! * `inputs`: stand, site, seat and meter with their uncertainties; `stated`: these as stated in the files.
//!
//! Example of a calibration with a known setup:
//!
//! ```
//! use dtg_passport::calibration::{InputUncertainty, Options, Readings, Setup, calibrate};
//! use dtg_passport::coefficients::{EIGHT_POSITIONS, EarthRate, Position};
//! use dtg_passport::attitude::Deviation;
//! use dtg_passport::laboratory::Laboratory;
//!
//! # let none = Deviation { alpha_rad: 0.0, beta_rad: 0.0, gamma_rad: 0.0 };
//! # let stand = EIGHT_POSITIONS.map(|(index, theta_deg, phi_deg)| Position { index, theta_deg, phi_deg, deviation: none });
//! let laboratory = Laboratory::paper();
//! let uncertainty = InputUncertainty::of_meter((&laboratory.meter).into());
//! let setup = Setup::new(&stand, EarthRate::at_astronomic_latitude(55.7658), uncertainty)?;
//! # let csv = "i,j,jx_ma,jy_ma\n1,1,-0.1993,-0.1007\n1,2,-0.1015,-0.1996\n1,3,-0.1828,-0.2819\n1,4,-0.2807,-0.1829\n\
//! #            2,1,-0.0884,-0.1775\n2,2,-0.1581,-0.2994\n2,3,-0.2937,-0.2051\n2,4,-0.2240,-0.0832\n";
//!
//! let readings = Readings::from_csv("currents.csv", csv.as_bytes(), setup.coefficients(), laboratory.meter.range_ma)?;
//! let calibration = calibrate(&setup, &readings, &Options::default())?;
//! let answer = calibration.valid()?;
//! # assert!((answer.parameters.k_deg_per_h_per_ma.m11 / 95.0 - 1.0).abs() < 0.01, "{answer:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub(crate) mod analytic;
pub(crate) mod causes;
pub(crate) mod chi_square;
pub(crate) mod data;
#[macro_use]
pub(crate) mod document;
pub(crate) mod drift;
pub(crate) mod estimates;
pub(crate) mod finding;
pub(crate) mod inputs;
#[doc(hidden)]
pub mod iterative;
pub(crate) mod least_squares;
pub(crate) mod noise;
pub(crate) mod offsets;
pub(crate) mod parameter;
pub(crate) mod prediction;
pub(crate) mod procedure;
pub(crate) mod propagation;
pub(crate) mod readings;
pub(crate) mod recorded;
pub(crate) mod remarks;
pub(crate) mod repeats;
pub(crate) mod result;
pub(crate) mod scatter;
pub(crate) mod sensitivity;
pub(crate) mod stated;
pub(crate) mod unknowns;
pub(crate) mod verdict;

pub use analytic::NoAnalyticSolution;
pub use causes::{Cause, Input};
pub use chi_square::ChiSquare;
pub use document::CalibrationDocument;
pub use estimates::Basis;
pub use finding::{Finding, Kind, Scope};
pub use inputs::{InputUncertainty, MeterUncertainty, NoSetup, Setup};
pub use iterative::{NoIterativeSolution, StopRule};
pub use least_squares::NoLeastSquares;
pub use noise::{DriftNoise, NoiseSource};
pub use parameter::Parameter;
pub use procedure::{Options, calibrate};
pub use readings::{NoReadings, PositionReadings, Reading, Readings, Visit};
pub use result::{Calibration, Method, MethodRefusal, MethodResult, NotValid};
pub use scatter::{Agreement, RowScatter, Scatter};
pub use stated::NotStated;
pub use unknowns::Model;
pub use verdict::{Decision, Found, ParameterVerdict, Verdict};
pub(crate) use verdict::{against_earlier, against_type};
