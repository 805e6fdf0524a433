//! A result for machines: the JSON of `calibrate`, which is also what a later calibration compares itself with.

use super::iterative::{LARGEST_NUMBER_OF_STEPS, StepChange};
use super::mistake::Mistake;
use super::parameter::Parameter;
use super::result::{Calibration, MethodResult};
use super::scatter::RowScatter;
use super::stated::NotStated;
use super::verdict::{Found, Verdict};
use crate::gyro::GyroParameters;
use crate::text::Unreadable;
use crate::text::problem::Location;
use nalgebra::{Matrix2, Vector2};
use serde::de::IgnoredAny;
use serde::{Deserialize, Deserializer, Serialize};

/// The result of a calibration, in the order in which it is written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CalibrationDocument {
    /// The passport used.
    pub(crate) passport_id: String,
    /// Whether it was verified.
    pub(crate) passport_verified: bool,
    /// The g that drifts are stated for.
    pub(crate) gravity_m_per_s2: f64,
    /// Its standard uncertainty; absent where it is not stated.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub(crate) gravity_u_m_per_s2: Option<f64>,
    /// One for each method.
    pub(crate) results: Vec<ResultDocument>,
    /// What certificate, site and laboratory do not state: the uncertainties are without it.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub(crate) not_stated: Vec<String>,
    /// Whether the visits of a position agree, when there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) scatter: Option<ScatterDocument>,
    /// How the rows of a visit scatter, when there are several.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub(crate) row_scatter: Option<RowScatterDocument>,
    /// What may be wrong, in words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) hint: Option<String>,
    /// The mistake that explains the result, when readings fit and the parameters are not the gyro's.
    #[serde(skip_serializing_if = "Option::is_none", default, deserialize_with = "left_aside")]
    pub(crate) mistake: Option<Mistake>,
    /// Against the gyro's type.
    #[serde(skip_serializing_if = "Option::is_none", default, deserialize_with = "left_aside")]
    pub(crate) verdict: Option<Verdict>,
    /// Against an earlier result.
    #[serde(skip_serializing_if = "Option::is_none", default, deserialize_with = "left_aside")]
    pub(crate) change: Option<Verdict>,
    /// Keys of a result that come from elsewhere: read, and left aside.
    #[serde(skip_serializing, default, deserialize_with = "left_aside_whole")]
    budget: (),
    #[serde(skip_serializing, default, deserialize_with = "left_aside_whole")]
    monte_carlo: (),
}

/// What one method gives.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ResultDocument {
    /// Which method.
    pub(crate) method: String,
    /// K: [[K_x, K_xy], [K_yx, K_y]].
    pub(crate) k_deg_per_h_per_ma: [[f64; 2]; 2],
    /// ω_0: [x, y].
    pub(crate) omega0_deg_per_h: [f64; 2],
    /// ω_n: four free numbers of the paper's methods.
    pub(crate) omega_n_deg_per_h_per_g: [[f64; 2]; 2],
    /// ω_g, per local g.
    pub(crate) omega_g_deg_per_h_per_g: f64,
    /// ω_k, per local g.
    pub(crate) omega_k_deg_per_h_per_g: f64,
    /// When fitted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) anisoelasticity_deg_per_h_per_g2: Option<f64>,
    /// Of successive approximation: steps taken.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) iterations: Option<u32>,
    /// Steps predicted before the first one; absent when that is more than are allowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) iterations_predicted: Option<u32>,
    /// Δ₁ and Δ₂, at which it was to stop.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) stop_rule: Option<StopRuleDocument>,
    /// What each step after the first approximation moved.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) changes: Option<Vec<ChangeDocument>>,
    /// ρ(T).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) spectral_radius: Option<f64>,
    /// What K still lacks, exactly.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) remainder_k_deg_per_h_per_ma: Option<[[f64; 2]; 2]>,
    /// What ω_n still lacks, exactly.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) remainder_omega_n_deg_per_h_per_g: Option<[[f64; 2]; 2]>,
    /// Standard uncertainties, with the keys of the values.
    pub(crate) standard_uncertainty: UncertaintyDocument,
    /// Differences to least squares in units of their standard uncertainty: K_x, K_xy, K_yx, K_y, ω_0x, ω_0y, ω_g, ω_k.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) from_least_squares: Option<[f64; 8]>,
    /// Whether the readings fit.
    pub(crate) chi_square: ChiSquareDocument,
    /// What is left of each equation; absent where nothing can be left.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub(crate) residuals_deg_per_h: Vec<ResidualDocument>,
}

/// The paper's Δ₁ and Δ₂.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StopRuleDocument {
    /// Δ₁.
    pub(crate) delta1_percent: f64,
    /// Δ₂.
    pub(crate) delta2_deg_per_h: f64,
}

/// What one step of successive approximation moved.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ChangeDocument {
    /// Which step; the first approximation is step 1.
    pub(crate) step: u32,
    /// K_x or K_y, whichever moved more.
    pub(crate) main_scale_factors_percent: f64,
    /// ω_g or ω_k, whichever moved more.
    pub(crate) g_drifts_deg_per_h_per_g: f64,
}

/// Standard uncertainties of one method's values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct UncertaintyDocument {
    /// Of K's elements.
    pub(crate) k_deg_per_h_per_ma: [[f64; 2]; 2],
    /// Of ω_0: [x, y].
    pub(crate) omega0_deg_per_h: [f64; 2],
    /// Of ω_n's elements.
    pub(crate) omega_n_deg_per_h_per_g: [[f64; 2]; 2],
    /// Of ω_g.
    pub(crate) omega_g_deg_per_h_per_g: f64,
    /// Of ω_k.
    pub(crate) omega_k_deg_per_h_per_g: f64,
    /// Of the anisoelastic coefficient, when fitted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) anisoelasticity_deg_per_h_per_g2: Option<f64>,
}

/// Chi-square.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ChiSquareDocument {
    /// Its value.
    pub(crate) value: f64,
    /// Readings less parameters.
    pub(crate) degrees_of_freedom: usize,
    /// Probability of a larger value when nothing is wrong; absent without degrees of freedom.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) probability: Option<f64>,
    /// Degrees of freedom of the uncertainties that it is made with; absent when infinite.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub(crate) uncertainty_degrees_of_freedom: Option<f64>,
}

/// Scatter of the visits of a position.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ScatterDocument {
    /// Sum of squares in units of the stated variance.
    pub(crate) chi_square: f64,
    /// Two for each visit beyond a position's first.
    pub(crate) degrees_of_freedom: usize,
    /// Probability of more when what is stated holds; close to 1 when there is less than stated.
    pub(crate) probability: f64,
    /// By how much the variance of a visit was enlarged.
    pub(crate) variance_factor: f64,
}

/// Scatter of the rows of a visit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RowScatterDocument {
    /// Standard deviation of one reading.
    pub(crate) standard_deviation_ma: f64,
    /// Two for each row beyond a visit's first.
    pub(crate) degrees_of_freedom: usize,
    /// Sum of squares in units of the stated variance; absent where no noise is stated.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub(crate) chi_square: Option<f64>,
    /// Probability of more when what is stated holds; close to 1 when there is less than stated.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub(crate) probability: Option<f64>,
    /// By how much the variance of a reading was enlarged.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub(crate) variance_factor: Option<f64>,
}

/// The residuals of one position.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ResidualDocument {
    /// Frame index.
    pub(crate) i: u32,
    /// Platform index.
    pub(crate) j: u32,
    /// Along x.
    pub(crate) x: f64,
    /// Along y.
    pub(crate) y: f64,
    /// Standard uncertainty of x; results of earlier versions have none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) u_x: Option<f64>,
    /// Of y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) u_y: Option<f64>,
}

/// The judgement of an earlier result is not read again: it is judged anew.
fn left_aside<'de, T, D: Deserializer<'de>>(deserializer: D) -> Result<Option<T>, D::Error> {
    IgnoredAny::deserialize(deserializer).map(|_| None)
}

fn left_aside_whole<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(), D::Error> {
    IgnoredAny::deserialize(deserializer).map(|_| ())
}

impl CalibrationDocument {
    /// Of a calibration with the passport `passport_id` under a local g with its uncertainty; `not_stated` is what
    /// [`Setup::stated`] did not find.
    ///
    /// [`Setup::stated`]: super::inputs::Setup::stated
    pub fn new(
        passport_id: &str,
        passport_verified: bool,
        (gravity_m_per_s2, gravity_u_m_per_s2): (f64, Option<f64>),
        calibration: &Calibration,
        not_stated: &[NotStated],
    ) -> Self {
        Self {
            passport_id: passport_id.to_owned(),
            passport_verified,
            gravity_m_per_s2,
            gravity_u_m_per_s2,
            results: calibration.results.iter().map(ResultDocument::new).collect(),
            not_stated: not_stated.iter().map(|what| what.words().to_owned()).collect(),
            scatter: calibration.scatter.as_ref().map(|scatter| ScatterDocument {
                chi_square: scatter.chi_square,
                degrees_of_freedom: scatter.degrees_of_freedom,
                probability: scatter.probability,
                variance_factor: scatter.variance_factor,
            }),
            row_scatter: calibration.row_scatter.as_ref().map(RowScatterDocument::new),
            hint: calibration.hint.as_ref().map(ToString::to_string),
            mistake: None,
            verdict: None,
            change: None,
            budget: (),
            monte_carlo: (),
        }
    }

    /// Reads an earlier result, file `name`.
    ///
    /// # Errors
    /// [`Unreadable`], with line and column.
    pub fn from_json(name: &str, bytes: &[u8]) -> Result<Self, Unreadable> {
        serde_json::from_slice(bytes).map_err(|error| {
            let location = (error.line() > 0).then(|| Location { line: error.line(), column: error.column().max(1) });
            let mut found = error.to_string();
            if let Some(at) = found.find(" at line ") {
                found.truncate(at);
            }
            let found = format!("unsuitable JSON ({found})");
            let advice = "create it with `calibrate --format json`";
            Unreadable::whole(name, location, found, "the JSON result of an earlier calibration", advice).in_text(bytes)
        })
    }

    /// The answer of this result: least squares where it is there, else the last method.
    pub fn answer(&self) -> Option<Found> {
        let best = self.results.iter().find(|result| result.method == "least-squares").or(self.results.last())?;
        Some(best.found(self.gravity_m_per_s2, self.gravity_u_m_per_s2))
    }
}

fn rows(matrix: &Matrix2<f64>) -> [[f64; 2]; 2] {
    [[matrix.m11, matrix.m12], [matrix.m21, matrix.m22]]
}

impl ResultDocument {
    fn new(result: &MethodResult) -> Self {
        let parameters = &result.parameters;
        let iteration = result.iteration.as_ref();
        let chi_square = &result.chi_square;
        let residuals = result.residuals.iter().filter(|_| chi_square.judges()).map(|residual| {
            let (index, value) = (residual.index, residual.residual_deg_per_h);
            let u = residual.standard_uncertainty_deg_per_h;
            ResidualDocument { i: index.i, j: index.j, x: value.x, y: value.y, u_x: Some(u.x), u_y: Some(u.y) }
        });
        Self {
            method: result.method.key().to_owned(),
            k_deg_per_h_per_ma: rows(&parameters.k_deg_per_h_per_ma),
            omega0_deg_per_h: parameters.omega0_deg_per_h.into(),
            omega_n_deg_per_h_per_g: rows(&result.omega_n_deg_per_h_per_g),
            omega_g_deg_per_h_per_g: parameters.omega_g_deg_per_h_per_g,
            omega_k_deg_per_h_per_g: parameters.omega_k_deg_per_h_per_g,
            anisoelasticity_deg_per_h_per_g2: result.anisoelasticity_deg_per_h_per_g2,
            iterations: iteration.map(|iteration| iteration.steps),
            iterations_predicted: iteration
                .and_then(|iteration| iteration.predicted_steps)
                .filter(|steps| *steps <= LARGEST_NUMBER_OF_STEPS),
            stop_rule: iteration.map(|iteration| StopRuleDocument {
                delta1_percent: iteration.stop_rule.delta1_percent,
                delta2_deg_per_h: iteration.stop_rule.delta2_deg_per_h,
            }),
            changes: iteration.map(|iteration| (2..).zip(&iteration.changes).map(ChangeDocument::new).collect()),
            spectral_radius: iteration.map(|iteration| iteration.spectral_radius),
            remainder_k_deg_per_h_per_ma: iteration.map(|it| rows(&it.remainder_k_deg_per_h_per_ma)),
            remainder_omega_n_deg_per_h_per_g: iteration.map(|it| rows(&it.remainder_omega_n_deg_per_h_per_g)),
            standard_uncertainty: UncertaintyDocument::new(result),
            from_least_squares: result.from_least_squares,
            chi_square: ChiSquareDocument {
                value: chi_square.value,
                degrees_of_freedom: chi_square.degrees_of_freedom,
                probability: chi_square.judges().then_some(chi_square.probability),
                uncertainty_degrees_of_freedom: finite(chi_square.of_uncertainties),
            },
            residuals_deg_per_h: residuals.collect(),
        }
    }

    fn found(&self, gravity_m_per_s2: f64, gravity_u_m_per_s2: Option<f64>) -> Found {
        let [[kx, kxy], [kyx, ky]] = self.k_deg_per_h_per_ma;
        let u = &self.standard_uncertainty;
        let [[u_kx, u_kxy], [u_kyx, u_ky]] = u.k_deg_per_h_per_ma;
        let [u_0x, u_0y] = u.omega0_deg_per_h;
        Found {
            parameters: GyroParameters {
                k_deg_per_h_per_ma: Matrix2::new(kx, kxy, kyx, ky),
                omega0_deg_per_h: Vector2::from(self.omega0_deg_per_h),
                omega_g_deg_per_h_per_g: self.omega_g_deg_per_h_per_g,
                omega_k_deg_per_h_per_g: self.omega_k_deg_per_h_per_g,
            },
            standard_uncertainty: [
                u_kx,
                u_kxy,
                u_kyx,
                u_ky,
                u_0x,
                u_0y,
                u.omega_g_deg_per_h_per_g,
                u.omega_k_deg_per_h_per_g,
            ],
            gravity_m_per_s2,
            gravity_u_m_per_s2: gravity_u_m_per_s2.unwrap_or(0.0),
        }
    }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

impl RowScatterDocument {
    fn new(rows: &RowScatter) -> Self {
        let stated = rows.against_stated;
        Self {
            standard_deviation_ma: rows.standard_deviation_ma,
            degrees_of_freedom: rows.degrees_of_freedom,
            chi_square: stated.map(|stated| stated.chi_square),
            probability: stated.map(|stated| stated.probability),
            variance_factor: stated.map(|stated| stated.variance_factor),
        }
    }
}

impl ChangeDocument {
    fn new((step, change): (u32, &StepChange)) -> Self {
        let StepChange { main_scale_factors_percent, g_drifts_deg_per_h_per_g } = *change;
        Self { step, main_scale_factors_percent, g_drifts_deg_per_h_per_g }
    }
}

impl UncertaintyDocument {
    fn new(result: &MethodResult) -> Self {
        let u = |parameter| result.standard_uncertainty(parameter).unwrap_or(0.0);
        Self {
            k_deg_per_h_per_ma: [[u(Parameter::Kx), u(Parameter::Kxy)], [u(Parameter::Kyx), u(Parameter::Ky)]],
            omega0_deg_per_h: [u(Parameter::Omega0x), u(Parameter::Omega0y)],
            omega_n_deg_per_h_per_g: rows(&result.omega_n_uncertainty_deg_per_h_per_g),
            omega_g_deg_per_h_per_g: u(Parameter::OmegaG),
            omega_k_deg_per_h_per_g: u(Parameter::OmegaK),
            anisoelasticity_deg_per_h_per_g2: result.standard_uncertainty(Parameter::Anisoelasticity),
        }
    }
}

impl MethodResult {
    /// Values and uncertainties for a verdict, under a local g and its standard uncertainty.
    pub fn found(&self, gravity_m_per_s2: f64, gravity_u_m_per_s2: f64) -> Found {
        let standard_uncertainty = Parameter::EIGHT.map(|p| self.standard_uncertainty(p).unwrap_or(0.0));
        Found { parameters: self.parameters, standard_uncertainty, gravity_m_per_s2, gravity_u_m_per_s2 }
    }
}
