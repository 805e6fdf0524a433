//! From sixteen currents to the parameters of a gyro. It takes coefficients, never a passport.
//!
//! * `readings`: the currents, from CSV.
//! * `analytic`: the paper's closed solution, eq. (13)-(16) and (8).
//! * [`iterative`]: the paper's successive approximation, eq. (17)-(19).
//! * `least_squares`: all readings of any positions, weighted.
//! * `procedure`: all of them side by side; `result`: with uncertainties, residuals and chi-square.
//! * `scatter`: whether rows of a visit and visits of a position agree.
//! * `diagnosis`: what may be wrong where readings do not fit.
//! * `verdict`: against a type's specification and against an earlier calibration.
//! * `mistake`: mistakes that leave readings fitting, recognised by what the gyro should be.
//! * `document`: a result for machines.
//! * `prediction`: what a calibration on this stand will be worth, before there is a reading.
//! * `estimates`: which uncertainties rest on the same estimate.
//! * `causes`: everything that is uncertain, by name; what budgets are made of.
//! * `inputs`: what is known of stand, site, seat and meter, and how well; `stated`: as the files state it.
//!
//! The laboratory's call, once the setup is known:
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
//! # let csv = "i,j,jx_ma,jy_ma\n1,1,-0.2010,-0.1014\n1,2,-0.1014,-0.2010\n1,3,-0.1809,-0.2814\n1,4,-0.2814,-0.1809\n\
//! #            2,1,-0.0883,-0.1761\n2,2,-0.1596,-0.2997\n2,3,-0.2937,-0.2067\n2,4,-0.2224,-0.0831\n";
//!
//! let readings = Readings::from_csv("currents.csv", csv.as_bytes(), setup.coefficients(), laboratory.meter.range_ma)?;
//! let calibration = calibrate(&setup, &readings, &Options::default())?;
//! let answer = calibration.answer().ok_or("the readings do not determine the parameters")?;
//! # assert!((answer.parameters.k_deg_per_h_per_ma.m11 / 95.0 - 1.0).abs() < 0.01, "{answer:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub(crate) mod analytic;
pub(crate) mod causes;
pub(crate) mod diagnosis;
pub(crate) mod document;
pub(crate) mod estimates;
pub(crate) mod inputs;
pub mod iterative;
pub(crate) mod least_squares;
pub(crate) mod mistake;
pub(crate) mod parameter;
pub(crate) mod prediction;
pub(crate) mod procedure;
pub(crate) mod propagation;
pub(crate) mod readings;
pub(crate) mod result;
pub(crate) mod scatter;
pub(crate) mod sensitivity;
pub(crate) mod stated;
pub(crate) mod unknowns;
pub(crate) mod verdict;

pub use analytic::NoAnalyticSolution;
pub use causes::{Cause, Input};
pub use diagnosis::{Explanation, Hint};
pub use document::CalibrationDocument;
pub use estimates::Basis;
pub use inputs::{InputUncertainty, MeterUncertainty, NoSetup, Setup};
pub use least_squares::NoLeastSquares;
pub use mistake::{CurrentsMistaken, Mistake};
pub use parameter::Parameter;
pub use prediction::predicted;
pub use procedure::{Options, calibrate};
pub use readings::{NoReadings, PositionReadings, Reading, Readings, Visit};
pub use result::{Calibration, ChiSquare, Iteration, Method, MethodRefusal, MethodResult, Residual};
pub use scatter::{Agreement, RowScatter, Scatter};
pub use stated::NotStated;
pub use verdict::{Decision, Found, ParameterVerdict, Verdict, against_earlier, against_type};
