//! The plan as JSON.

use super::sensitivity::Effect;
use super::{Evaluation, Plan};
use crate::calibration::NotStated;
use crate::gyro::{GyroParameters, Parameters};
use serde::Serialize;

/// JSON form of a plan, with the keys in the order of writing.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct PlanDocument {
    /// Criterion: a, d or worst.
    criterion: String,
    /// Σ (u/T)² (a), ln det of the covariance in units of T (d), or the largest u/T (worst), T the tolerances.
    value: f64,
    /// Azimuth of the frame's axis, degrees clockwise from north.
    frame_axis_azimuth_deg: f64,
    /// Positions and their numbers of visits.
    readings: Vec<ReadingDocument>,
    /// Nominal angles [θ, φ] of the visits, in the best order, degrees.
    order: Vec<[f64; 2]>,
    /// Standard uncertainties of the parameters.
    standard_uncertainty: Parameters,
    /// The paper's eight positions, the frame's axis east; absent if they cannot be compared.
    #[serde(skip_serializing_if = "Option::is_none")]
    paper: Option<PaperDocument>,
    /// Parameters that are more uncertain than with the paper's eight, by key, with the ratio.
    worse: Vec<WorseDocument>,
    /// Whether the plan has the paper's eight positions, and so matrices and the closed methods.
    has_matrices: bool,
    /// Whether the plan determines the general model.
    has_general_model: bool,
    /// Errors that all positions share.
    common_errors: Vec<EffectDocument>,
    /// Largest change of a parameter in units of its tolerance, for an ω_0 that rises by 1 °/h over the run in this order.
    drift_over_tolerance_per_deg_per_h: f64,
    /// Whether every choice was compared.
    exhaustive: bool,
    /// Inputs without a stated uncertainty; they count as 0.
    not_stated: Vec<String>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct ReadingDocument {
    theta_deg: f64,
    phi_deg: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    i: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    j: Option<u32>,
    visits: u32,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct PaperDocument {
    value: f64,
    standard_uncertainty: Parameters,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct WorseDocument {
    parameter: &'static str,
    ratio: f64,
}

/// Effect of an error that all positions share.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct EffectDocument {
    error: &'static str,
    size: f64,
    unit: &'static str,
    #[serde(flatten)]
    plan: EffectOnDesign,
    #[serde(skip_serializing_if = "Option::is_none")]
    paper: Option<EffectOnDesign>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct EffectOnDesign {
    change: Parameters,
    largest_over_tolerance: f64,
    largest_residual_deg_per_h: f64,
    /// Root of the chi-square that the residuals add.
    residuals_over_noise: f64,
}

impl From<&Plan> for PlanDocument {
    fn from(plan: &Plan) -> Self {
        let angles = |place: &usize| [plan.readings[*place].theta_deg, plan.readings[*place].phi_deg];
        let readings = plan.readings.iter().map(|at| ReadingDocument {
            theta_deg: at.theta_deg,
            phi_deg: at.phi_deg,
            i: at.index.map(|index| index.i),
            j: at.index.map(|index| index.j),
            visits: at.visits,
        });
        Self {
            criterion: plan.criterion.to_string(),
            value: plan.evaluation.value,
            frame_axis_azimuth_deg: plan.frame_axis_azimuth_deg,
            readings: readings.collect(),
            order: plan.order.places.iter().map(angles).collect(),
            standard_uncertainty: parameters(&plan.evaluation.standard_uncertainty),
            paper: plan.paper.as_ref().map(|paper| PaperDocument {
                value: paper.value,
                standard_uncertainty: parameters(&paper.standard_uncertainty),
            }),
            worse: plan
                .worse()
                .into_iter()
                .map(|(parameter, ratio)| WorseDocument { parameter: parameter.key(), ratio })
                .collect(),
            has_matrices: plan.has_matrices,
            has_general_model: plan.has_general_model,
            common_errors: common_errors(&plan.evaluation, plan.paper.as_ref()),
            drift_over_tolerance_per_deg_per_h: plan.order.largest_over_tolerance,
            exhaustive: plan.exhaustive,
            not_stated: plan.not_stated().map(str::to_owned).collect(),
        }
    }
}

impl Plan {
    /// Returns the inputs of single readings that no file states, in words.
    pub(crate) fn not_stated(&self) -> impl Iterator<Item = &'static str> {
        let noise = self.noise_not_stated.then_some("noise of the gyro (noise.visit_deg_per_h)");
        noise.into_iter().chain(self.of_positions_not_stated.iter().copied().map(NotStated::words))
    }
}

fn common_errors(plan: &Evaluation, paper: Option<&Evaluation>) -> Vec<EffectDocument> {
    let of_paper = |place: usize| paper.and_then(|paper| paper.effects.get(place)).map(EffectOnDesign::from);
    let each = plan.effects.iter().enumerate().map(|(place, effect)| {
        let (size, unit) = effect.error.size();
        EffectDocument { error: effect.error.name(), size, unit, plan: effect.into(), paper: of_paper(place) }
    });
    each.collect()
}

impl From<&Effect> for EffectOnDesign {
    fn from(effect: &Effect) -> Self {
        Self {
            change: parameters(&effect.change),
            largest_over_tolerance: effect.largest_over_tolerance,
            largest_residual_deg_per_h: effect.largest_residual_deg_per_h,
            residuals_over_noise: effect.residuals_over_noise,
        }
    }
}

fn parameters(values: &[f64; 8]) -> Parameters {
    let GyroParameters { k_deg_per_h_per_ma: k, omega0_deg_per_h, omega_g_deg_per_h_per_g, omega_k_deg_per_h_per_g } =
        GyroParameters::from_vector(values);
    Parameters {
        k_deg_per_h_per_ma: [[k.m11, k.m12], [k.m21, k.m22]],
        omega0_deg_per_h: omega0_deg_per_h.into(),
        omega_g_deg_per_h_per_g,
        omega_k_deg_per_h_per_g,
    }
}
