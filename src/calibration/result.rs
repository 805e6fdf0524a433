//! Results of a calibration.

use super::analytic::NoAnalyticSolution;
use super::diagnosis::Hint;
use super::iterative::{NoIterativeSolution, StepChange, StopRule};
use super::least_squares::NoLeastSquares;
use super::parameter::Parameter;
use super::propagation::Misfit;
use super::scatter::{RowScatter, Scatter};
use crate::coefficients::PositionIndex;
use crate::gyro::GyroParameters;
use nalgebra::{DMatrix, Matrix2, Vector2};

/// Method of calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Method {
    /// The paper's analytic method.
    Analytic,
    /// The paper's iterative method.
    Iterative,
    /// Weighted least squares on all readings.
    LeastSquares,
}

impl Method {
    /// All methods, in the order of results; the last one gives the adopted result.
    pub const ALL: [Self; 3] = [Self::Analytic, Self::Iterative, Self::LeastSquares];

    /// Returns the name of the method in options and results.
    pub fn key(self) -> &'static str {
        match self {
            Self::Analytic => "analytic",
            Self::Iterative => "iterative",
            Self::LeastSquares => "least-squares",
        }
    }
}

/// The result of a calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// Results in the order of the requested methods; refused methods are missing.
    pub results: Vec<MethodResult>,
    /// Methods without a result, each with the reason.
    pub refused: Vec<(Method, MethodRefusal)>,
    /// Agreement of the visits of each position; `None` if every position was visited once.
    pub scatter: Option<Scatter>,
    /// Scatter of the rows of each visit; `None` if every visit has one row.
    pub row_scatter: Option<RowScatter>,
    /// `true` if the fit converged. Otherwise the readings are far from those of any gyro on this stand.
    pub settled: bool,
    /// Possible causes if the readings do not fit; otherwise `None`.
    pub hint: Option<Hint>,
}

impl Calibration {
    /// Returns the adopted result: least squares if requested, otherwise the last method; `None` if no method gave a
    /// result.
    pub fn answer(&self) -> Option<&MethodResult> {
        self.results.iter().find(|result| result.method == Method::LeastSquares).or(self.results.last())
    }

    /// Returns the reason why no parameters are given, or `None` if the fit converged. Without convergence the
    /// parameters have no meaning.
    pub(crate) fn meaningless(&self) -> Option<String> {
        let why = "no parameters are given, because the readings differ too much from those of any gyro on this stand";
        let hint = self.hint.as_ref().map_or_else(String::new, |hint| format!("; {hint}"));
        (!self.settled).then(|| format!("{why}{hint}"))
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
}

/// Result of one method.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodResult {
    /// Method that gave this result.
    pub method: Method,
    /// Parameters K, ω_0, ω_g, ω_k.
    pub parameters: GyroParameters,
    /// ω_n, °/(h·g), 2×2: four independent numbers for the paper's methods, [[ω_g, −ω_k], [ω_k, ω_g]] for least
    /// squares.
    pub omega_n_deg_per_h_per_g: Matrix2<f64>,
    /// Anisoelastic coefficient, °/(h·g²); `None` if it was not fitted.
    pub anisoelasticity_deg_per_h_per_g2: Option<f64>,
    /// Course of the iteration; `None` for other methods.
    pub iteration: Option<Iteration>,
    /// Covariance of the parameters from all inputs, 8×8 or 9×9, in the order of `Parameter::NINE`.
    pub covariance: DMatrix<f64>,
    /// Standard uncertainties of the elements of ω_n, °/(h·g), 2×2.
    pub omega_n_uncertainty_deg_per_h_per_g: Matrix2<f64>,
    /// Difference of each parameter from least squares, in units of its own standard uncertainty (both methods are
    /// subject to the same errors), in the order of [`Parameter::EIGHT`]; `None` for least squares itself.
    pub from_least_squares: Option<[f64; 8]>,
    /// Chi-square test of the fit.
    pub chi_square: ChiSquare,
    /// Residuals of each position, in the order of the coefficients.
    pub residuals: Vec<Residual>,
}

impl MethodResult {
    /// Returns the standard uncertainty of a parameter in its unit, or `None` if it was not fitted.
    pub fn standard_uncertainty(&self, parameter: Parameter) -> Option<f64> {
        self.covariance.get((parameter.place(), parameter.place())).map(|variance| variance.sqrt())
    }

    /// Returns the value of a parameter in its unit, or `None` if it was not fitted.
    pub fn value(&self, parameter: Parameter) -> Option<f64> {
        match parameter {
            Parameter::Anisoelasticity => self.anisoelasticity_deg_per_h_per_g2,
            other => self.parameters.to_vector().get(other.place()).copied(),
        }
    }
}

/// Course of the iterative method.
#[derive(Debug, Clone, PartialEq)]
pub struct Iteration {
    /// Stop rule of the iteration.
    pub stop_rule: StopRule,
    /// Number of steps; the first approximation counts as 1.
    pub steps: u32,
    /// Changes of the parameters in each step after the first approximation.
    pub changes: Vec<StepChange>,
    /// Number of steps predicted before the first one; `None` if there is no prediction.
    pub predicted_steps: Option<u32>,
    /// Spectral radius ρ(T), known before the first step.
    pub spectral_radius: f64,
    /// Exact difference of the analytic solution from K at the last step, °/(h·mA), 2×2.
    pub remainder_k_deg_per_h_per_ma: Matrix2<f64>,
    /// Exact difference of the analytic solution from ω_n at the last step, °/(h·g), 2×2.
    pub remainder_omega_n_deg_per_h_per_g: Matrix2<f64>,
}

/// Chi-square test of a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChiSquare {
    /// Value of chi-square; 0 without degrees of freedom.
    pub value: f64,
    /// Number of readings minus number of parameters; if it is 0, a fit cannot be judged.
    pub degrees_of_freedom: usize,
    /// Probability of a larger value if the readings agree with all stated uncertainties.
    ///
    /// It is computed from a scaled F distribution if uncertainties rest on estimates with few degrees of freedom.
    pub probability: f64,
    /// Denominator degrees of freedom of that F distribution; infinite if every uncertainty is known.
    pub of_uncertainties: f64,
}

impl ChiSquare {
    pub(crate) fn new(misfit: Misfit) -> Self {
        let Misfit { value, degrees_of_freedom, distribution } = misfit;
        let probability = if degrees_of_freedom == 0 { 1.0 } else { distribution.larger(value) };
        Self { value, degrees_of_freedom, probability, of_uncertainties: distribution.denominator }
    }

    /// Returns `false` if there are as many unknowns as readings; then any readings fit.
    pub(crate) fn judges(&self) -> bool {
        self.degrees_of_freedom > 0
    }
}

/// Residuals of the two equations of a position: ω_3 − K J − ω_0 − ω_n n.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// Index (i, j) of the position.
    pub index: PositionIndex,
    /// Residuals along x and y, °/h.
    pub residual_deg_per_h: Vector2<f64>,
    /// Standard uncertainties of the residuals, °/h, if only the stated uncertainties act.
    pub standard_uncertainty_deg_per_h: Vector2<f64>,
    /// Residuals divided by their standard uncertainties; 0 if a residual cannot differ from 0.
    pub normalised: Vector2<f64>,
}
