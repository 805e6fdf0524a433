//! Results of a calibration.

use super::chi_square::ALARM;
use super::data::Observation;
use super::document::ResultDocument;
use super::finding::{Finding, Kind};
use super::iterative::NoIterativeSolution;
use super::recorded::Digits;
use super::unknowns::Unknowns;
use super::{
    ChiSquare, DriftNoise, Model, NoAnalyticSolution, NoLeastSquares, NoiseSource, NotStated, Parameter, RowScatter,
    Scatter,
};
use crate::gyro::GyroParameters;
use crate::statistics::student::f_larger;
use crate::text::{word_of_a_key, words};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

words! {
    /// Method of calibration, in the order of results; the last one gives the adopted result.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
    #[serde(rename_all = "kebab-case")]
    #[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
    #[non_exhaustive]
    pub enum Method: pub key {
        /// The paper's analytic method.
        Analytic = "analytic",
        /// The paper's iterative method.
        Iterative = "iterative",
        /// Weighted least squares on all readings.
        LeastSquares = "least-squares",
    }
}

word_of_a_key!(Method, key, "");

/// The result of a calibration.
#[derive(Debug, Clone)]
pub struct Calibration {
    /// Results in the order of the requested methods; refused methods are missing.
    pub results: Vec<MethodResult>,
    /// Methods without a result, each with the reason.
    pub refused: Vec<(Method, MethodRefusal)>,
    /// Limits of the readings that their digits show; `None` if there are none.
    pub(crate) digits: Option<Digits>,
    /// Agreement of the visits of each position; `None` if every position was visited once.
    pub scatter: Option<Scatter>,
    /// Scatter of the rows of each visit; `None` if every visit has one row.
    pub row_scatter: Option<RowScatter>,
    /// Comparison of the turn-ons with what the gyro type states; `None` if there is one, or nothing is stated.
    pub turn_on_scatter: Option<Scatter>,
    /// Noise of the gyro's drift from visit to visit, each axis.
    pub visit_noise: DriftNoise,
    /// Noise of ω_0 from one turn-on of the gyro to the next, each axis.
    pub turn_on_noise: DriftNoise,
    /// `true` if there are times, but the repeated visits cannot tell a drift from the noise of the gyro.
    pub(crate) drift_or_noise: bool,
    /// `true` if the fit converged. Otherwise the readings are far from those of any gyro on this stand.
    pub settled: bool,
    /// `true` if the readings fit the stand.
    pub consistent: bool,
    /// Causes that explain the readings or the parameters, the most likely first. Without a gyro type only a unit of the currents
    /// that is wrong by a factor of a thousand or more is recognised of those that leave no residuals.
    pub causes: Vec<Finding>,
    /// Fit of all readings, from which budgets start.
    pub(crate) observation: Observation,
}

/// Reason why a result is not that of the gyro.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NotValid {
    /// No method gave a result; [`Calibration::refused`] has the reasons.
    #[error("no method gave a result")]
    NoResult,
    /// The readings do not fit the stand (`consistent` is false); the causes in words.
    #[error("{INCONSISTENT}. {0}")]
    Inconsistent(String),
    /// The readings fit, but a cause (`mistake`) explains parameters that are far from the gyro's; in words.
    #[error("the parameters are far from the gyro's; `mistake` states what would explain it: {0}")]
    Mistaken(String),
}

/// Consequence of readings that do not fit the stand, as a sentence without a full stop.
pub(crate) const INCONSISTENT: &str = "the readings are not consistent with this stand; the parameters are not valid: \
                                       find the cause and repeat the calibration";

impl NotValid {
    /// Returns the `result` if the readings fit and no cause explains it; `causes` are their sentences.
    pub(super) fn checked<T>(
        result: Option<T>,
        consistent: bool,
        mistaken: bool,
        causes: impl FnOnce() -> String,
    ) -> Result<T, Self> {
        match (consistent, mistaken) {
            (false, _) => Err(Self::Inconsistent(causes())),
            (true, true) => Err(Self::Mistaken(causes())),
            (true, false) => result.ok_or(Self::NoResult),
        }
    }
}

impl Calibration {
    /// Returns the adopted result if it is valid: least squares if requested, otherwise the last method. A result that is not
    /// that of the gyro is never returned.
    ///
    /// # Errors
    /// Returns [`NotValid`] if no method gave a result, if the readings do not fit the stand, or if an error explains the
    /// parameters.
    pub fn valid(&self) -> Result<&MethodResult, NotValid> {
        let causes = || self.meaningless().unwrap_or_else(|| self.causes_in_words());
        NotValid::checked(self.adopted(), self.fits(), self.mistake().is_some(), causes)
    }

    /// Returns `true` if the readings fit the stand and the fit converged.
    pub(crate) fn fits(&self) -> bool {
        self.settled && self.consistent
    }

    /// Returns the adopted result even if it is not valid; `None` if no method gave a result.
    pub(crate) fn adopted(&self) -> Option<&MethodResult> {
        self.results.iter().find(|result| result.method == Method::LeastSquares).or(self.results.last())
    }

    /// Returns the cause that makes the result invalid, if there is one: the first that is not chance.
    pub fn mistake(&self) -> Option<&Finding> {
        let first = self.causes.iter().find(|cause| cause.kind != Kind::Chance);
        first.filter(|cause| !self.consistent || cause.invalidates())
    }

    /// Returns `true` if the parameters are not valid.
    pub(crate) fn is_invalid(&self) -> bool {
        !self.consistent || self.mistake().is_some()
    }

    /// Adds the sentences, and a cause of another kind, such as one that the gyro type shows.
    pub(crate) fn with_words(&mut self, further: impl IntoIterator<Item = Finding>) {
        let all = further.into_iter().chain(std::mem::take(&mut self.causes));
        self.causes = all.map(Finding::in_words).collect();
    }

    /// Returns the visits and rows that are probably wrong.
    pub(crate) fn suspects(&self) -> impl Iterator<Item = &Finding> {
        self.causes.iter().filter(|cause| cause.is_reading())
    }

    /// Returns the noises of the gyro that are neither stated nor shown by the readings.
    pub(crate) fn noise_not_stated(&self) -> impl Iterator<Item = NotStated> {
        let each = [(self.visit_noise, NotStated::Visits), (self.turn_on_noise, NotStated::TurnOns)];
        each.into_iter().filter(|(noise, _)| noise.source == NoiseSource::NotStated).map(|(_, what)| what)
    }

    /// Returns the sentences of all causes in English.
    fn causes_in_words(&self) -> String {
        self.causes.iter().map(|cause| cause.words.as_str()).collect::<Vec<_>>().join(" ")
    }

    /// Returns the standard uncertainty of ω_0 from the scatter of the turn-ons, °/h, if it is most of that of ω_0x or ω_0y.
    pub(crate) fn mostly_from_turn_ons(&self) -> Option<f64> {
        let answer = self.adopted()?;
        let u = self.turn_on_noise.deg_per_h / (answer.document.cycles.len().max(1) as f64).sqrt();
        let most = |parameter| answer.standard_uncertainty(parameter).is_some_and(|whole| 2.0 * u * u > whole * whole);
        (most(Parameter::Omega0x) || most(Parameter::Omega0y)).then_some(u)
    }

    /// Returns the reason why no parameters are given, or `None` if the fit converged. Without convergence the
    /// parameters have no meaning.
    pub(crate) fn meaningless(&self) -> Option<String> {
        let why = "no parameters are given, because the readings differ too much from those of any gyro on this stand";
        (!self.settled).then(|| format!("{why}. {}", self.causes_in_words()).trim_end_matches(['.', ' ']).to_owned())
    }
}

/// Reason why a method gave no result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MethodRefusal {
    /// Refusal of the analytic method.
    #[error(transparent)]
    Analytic(#[from] NoAnalyticSolution),
    /// Refusal of the iterative method.
    #[error(transparent)]
    Iterative(#[from] NoIterativeSolution),
    /// Refusal of weighted least squares.
    #[error(transparent)]
    LeastSquares(#[from] NoLeastSquares),
    /// Method of the paper that was asked for another model than the paper's.
    #[error(
        "the method supports only the paper's model with one constant drift; the general model, a drift in time, and turn-ons \
         that did not all visit the same positions need least squares"
    )]
    NotThisModel,
}

/// ω_0 of one turn-on of the gyro.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "struct CycleDocument")]
pub(crate) struct Cycle {
    /// Number of the turn-on.
    pub cycle: u32,
    /// ω_0 about x and y, °/h.
    pub omega0_deg_per_h: [f64; 2],
}

/// F test of whether the two parameters of the paper's g-sensitive drift are enough.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ModelTest {
    /// Ratio of mean squares: of what the further parameters explain to what they leave.
    pub f: f64,
    /// Number of further parameters, and degrees of freedom of the rest.
    pub degrees_of_freedom: [usize; 2],
    /// Probability of a larger ratio if the paper's parameters are enough.
    pub probability: f64,
    /// `true` if the paper's model does not fit with the uncertainties as they are, but the larger one does. With few degrees of
    /// freedom of the rest the ratio may be far from significant even so.
    #[serde(skip)]
    pub(crate) only_larger_fits: bool,
}

impl ModelTest {
    /// Compares the fits of the paper's and of a larger model; `None` if the larger model leaves no degree of freedom.
    pub(crate) fn new(paper: &ChiSquare, larger: &ChiSquare) -> Option<Self> {
        let degrees_of_freedom =
            [paper.degrees_of_freedom.checked_sub(larger.degrees_of_freedom)?, larger.degrees_of_freedom];
        let [further, rest] = degrees_of_freedom;
        if further == 0 || rest == 0 || larger.value.is_nan() || larger.value <= 0.0 {
            return None;
        }
        let f = (paper.value - larger.value).max(0.0) / further as f64 / (larger.value / rest as f64);
        let probability = f_larger(f, further, rest as f64);
        let only_larger_fits = paper.probability < ALARM && larger.probability >= ALARM;
        Some(Self { f, degrees_of_freedom, probability, only_larger_fits })
    }

    /// Returns `true` if the further parameters are needed.
    pub(crate) fn is_significant(&self) -> bool {
        self.probability < SIGNIFICANT || self.only_larger_fits
    }
}

/// Probability below which further parameters are taken to be needed.
const SIGNIFICANT: f64 = 0.01;

/// Result of one method.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodResult {
    /// Method that gave this result.
    pub method: Method,
    /// Model that was fitted.
    pub model: Model,
    /// Parameters K, ω_0, ω_g, ω_k.
    pub parameters: GyroParameters,
    /// These parameters and those beyond them.
    pub(crate) unknowns: Unknowns,
    /// Covariance of the parameters from all inputs, 8×8 in the order of [`Parameter::EIGHT`]; 9×9 with the anisoelastic
    /// coefficient last, or 12×12 with G by rows instead of ω_g and ω_k.
    pub covariance: DMatrix<f64>,
    /// Chi-square test of the fit.
    pub chi_square: ChiSquare,
    /// Everything that is stated of the result.
    pub(crate) document: ResultDocument,
}

impl MethodResult {
    /// Returns the standard uncertainty of a parameter in its unit, or `None` if it was not fitted.
    pub fn standard_uncertainty(&self, parameter: Parameter) -> Option<f64> {
        let column = self.model.column(parameter)?;
        self.covariance.get((column, column)).map(|variance| variance.sqrt())
    }

    /// Returns the covariance of [`Parameter::EIGHT`], 8×8; `None` for ω_g and ω_k in the general model.
    pub(crate) fn covariance_of_eight(&self) -> Vec<[Option<f64>; 8]> {
        let columns = Parameter::EIGHT.map(|parameter| self.model.column(parameter));
        let element = |row: Option<usize>, column: Option<usize>| Some(self.covariance[(row?, column?)]);
        columns.map(|row| columns.map(|column| element(row, column))).into()
    }

    /// Returns the value of a parameter in its unit, or `None` if it was not fitted.
    pub fn value(&self, parameter: Parameter) -> Option<f64> {
        self.model.column(parameter).map(|_| self.unknowns.value(parameter))
    }
}
