//! What a calibration gives.

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

/// A method of calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Method {
    /// The paper's closed solution.
    Analytic,
    /// The paper's successive approximation.
    Iterative,
    /// Weighted least squares on all readings.
    LeastSquares,
}

impl Method {
    /// All of them, in the order of results: the last one is the answer.
    pub const ALL: [Self; 3] = [Self::Analytic, Self::Iterative, Self::LeastSquares];

    /// Its name in options and results.
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
    /// Results in the order of the methods asked for; refused methods are missing.
    pub results: Vec<MethodResult>,
    /// Methods that gave nothing, and why.
    pub refused: Vec<(Method, MethodRefusal)>,
    /// Whether the visits of a position agree; absent where every position was visited once.
    pub scatter: Option<Scatter>,
    /// How the rows of a visit scatter; absent where every visit has one.
    pub row_scatter: Option<RowScatter>,
    /// Whether the fit settled. If not, the readings are far from any gyro's on this stand.
    pub settled: bool,
    /// What may be wrong, when the readings do not fit.
    pub hint: Option<Hint>,
}

impl Calibration {
    /// The answer: least squares where asked for, else the last method; `None` when no method gave anything.
    pub fn answer(&self) -> Option<&MethodResult> {
        self.results.iter().find(|result| result.method == Method::LeastSquares).or(self.results.last())
    }

    /// Why no parameters are to be given, in words: the fit did not settle, so they would mean nothing.
    pub(crate) fn meaningless(&self) -> Option<String> {
        let why = "no parameters are given, because the readings differ too much from those of any gyro on this stand";
        let hint = self.hint.as_ref().map_or_else(String::new, |hint| format!("; {hint}"));
        (!self.settled).then(|| format!("{why}{hint}"))
    }
}

/// Why one method gave nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MethodRefusal {
    /// The closed solution.
    #[error(transparent)]
    Analytic(#[from] NoAnalyticSolution),
    /// Successive approximation.
    #[error(transparent)]
    Iterative(#[from] NoIterativeSolution),
    /// Least squares.
    #[error(transparent)]
    LeastSquares(#[from] NoLeastSquares),
}

/// What one method gives.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodResult {
    /// Which method.
    pub method: Method,
    /// K, ω_0, ω_g, ω_k.
    pub parameters: GyroParameters,
    /// ω_n, 2×2: four free numbers of the paper's methods, [[ω_g, −ω_k], [ω_k, ω_g]] of least squares.
    pub omega_n_deg_per_h_per_g: Matrix2<f64>,
    /// The anisoelastic coefficient, when fitted.
    pub anisoelasticity_deg_per_h_per_g2: Option<f64>,
    /// How successive approximation went.
    pub iteration: Option<Iteration>,
    /// Covariance of the parameters in the order of `Parameter::NINE`, 8×8 or 9×9, from all inputs.
    pub covariance: DMatrix<f64>,
    /// Standard uncertainties of the elements of ω_n, 2×2.
    pub omega_n_uncertainty_deg_per_h_per_g: Matrix2<f64>,
    /// How far each parameter is from that of least squares, in the order of [`Parameter::EIGHT`] and in units of the
    /// difference's own standard uncertainty (both methods see the same errors); absent for least squares itself.
    pub from_least_squares: Option<[f64; 8]>,
    /// Whether the readings fit.
    pub chi_square: ChiSquare,
    /// What is left of each equation, in the order of the coefficients.
    pub residuals: Vec<Residual>,
}

impl MethodResult {
    /// Standard uncertainty of a parameter; `None` when it was not fitted.
    pub fn standard_uncertainty(&self, parameter: Parameter) -> Option<f64> {
        self.covariance.get((parameter.place(), parameter.place())).map(|variance| variance.sqrt())
    }

    /// Value of a parameter; `None` when it was not fitted.
    pub fn value(&self, parameter: Parameter) -> Option<f64> {
        match parameter {
            Parameter::Anisoelasticity => self.anisoelasticity_deg_per_h_per_g2,
            other => self.parameters.to_vector().get(other.place()).copied(),
        }
    }
}

/// How successive approximation went.
#[derive(Debug, Clone, PartialEq)]
pub struct Iteration {
    /// When it was to stop.
    pub stop_rule: StopRule,
    /// Steps taken, the first approximation counted as 1.
    pub steps: u32,
    /// What each step after the first approximation moved.
    pub changes: Vec<StepChange>,
    /// Steps predicted before the first one.
    pub predicted_steps: Option<u32>,
    /// ρ(T), known before the first step.
    pub spectral_radius: f64,
    /// What K still lacks, exactly.
    pub remainder_k_deg_per_h_per_ma: Matrix2<f64>,
    /// What ω_n still lacks, exactly.
    pub remainder_omega_n_deg_per_h_per_g: Matrix2<f64>,
}

/// Chi-square of a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChiSquare {
    /// Chi-square; 0 where there are no degrees of freedom.
    pub value: f64,
    /// Number of readings less number of parameters; with 0 a fit cannot be judged.
    pub degrees_of_freedom: usize,
    /// Probability of a larger value when nothing is wrong.
    ///
    /// Where uncertainties rest on estimates with few degrees of freedom, this is that of a scaled F.
    pub probability: f64,
    /// Degrees of freedom of the denominator of that F; infinite where every uncertainty is known.
    pub of_uncertainties: f64,
}

impl ChiSquare {
    pub(crate) fn new(misfit: Misfit) -> Self {
        let Misfit { value, degrees_of_freedom, distribution } = misfit;
        let probability = if degrees_of_freedom == 0 { 1.0 } else { distribution.larger(value) };
        Self { value, degrees_of_freedom, probability, of_uncertainties: distribution.denominator }
    }

    /// Returns `false` if there are as many unknowns as readings, which any readings fit.
    pub(crate) fn judges(&self) -> bool {
        self.degrees_of_freedom > 0
    }
}

/// What is left of the two equations of a position: ω_3 − K J − ω_0 − ω_n n.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// Which position.
    pub index: PositionIndex,
    /// Along x and y.
    pub residual_deg_per_h: Vector2<f64>,
    /// Its standard uncertainty: what is left when nothing is wrong.
    pub standard_uncertainty_deg_per_h: Vector2<f64>,
    /// In units of its standard uncertainty; 0 where it cannot differ from 0.
    pub normalised: Vector2<f64>,
}
