//! The plan as JSON, and what templates take from it.

use super::sensitivity::{CommonError, Effect};
use super::{Evaluation, MOST_READINGS, Plan, Visited};
use crate::calibration::NotStated;
use crate::coefficients::PositionIndex;
use crate::gyro::{GyroParameters, Parameters};
use crate::stand::MOST_POSITIONS;
use crate::text::Unreadable;
use crate::text::kind::Kind;
use serde::{Deserialize, Serialize, Serializer};

/// JSON form of a plan, with the keys in the order of writing.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct PlanDocument<'a> {
    /// Criterion: a, d or worst.
    criterion: &'static str,
    /// Σ (u/T)² (a), ln det of the covariance in units of T (d), or the largest u/T (worst), T the tolerances.
    value: f64,
    /// Azimuth of the frame's axis, degrees clockwise from north.
    frame_axis_azimuth_deg: f64,
    /// Positions and their numbers of visits.
    readings: &'a [Visited],
    /// Nominal angles [θ, φ] of the visits, in the best order, degrees.
    order: Vec<[f64; 2]>,
    /// Standard uncertainties of the parameters.
    standard_uncertainty: Parameters,
    /// The paper's eight positions, the frame's axis east; absent if they cannot be compared.
    #[serde(skip_serializing_if = "Option::is_none")]
    paper: Option<&'a Evaluation>,
    /// Parameters that are more uncertain than with the paper's eight, by key, with the ratio.
    worse: Vec<WorseDocument>,
    /// Whether the plan has the paper's eight positions, and so matrices and the closed methods.
    has_matrices: bool,
    /// Whether the plan determines the general model.
    has_general_model: bool,
    /// Errors that all positions share.
    common_errors: Vec<EffectDocument<'a>>,
    /// Largest change of a parameter in units of its tolerance, for an ω_0 that rises or falls by 1 °/h on each axis over
    /// the run in this order.
    drift_over_tolerance_per_deg_per_h: f64,
    /// Number of positions left out, because the meter cannot read their currents.
    beyond_range: usize,
    /// Whether every choice was compared.
    exhaustive: bool,
    /// Inputs without a stated uncertainty; they count as 0.
    not_stated: Vec<String>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct WorseDocument {
    parameter: &'static str,
    ratio: f64,
}

/// Effect of an error that all positions share.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct EffectDocument<'a> {
    error: &'static str,
    size: f64,
    unit: &'static str,
    #[serde(flatten)]
    plan: &'a Effect,
    #[serde(skip_serializing_if = "Option::is_none")]
    paper: Option<&'a Effect>,
}

/// Positions and order of a plan, as its JSON states them; other keys are ignored.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(crate) struct Planned {
    /// Azimuth of the frame's axis, degrees clockwise from north.
    pub frame_axis_azimuth_deg: f64,
    /// Positions, each once.
    pub readings: Vec<PlannedPosition>,
    /// Nominal angles [θ, φ] of the visits, in their order, degrees.
    pub order: Vec<[f64; 2]>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(crate) struct PlannedPosition {
    /// Nominal angle θ of the frame, degrees.
    pub theta_deg: f64,
    /// Nominal angle φ of the platform, degrees.
    pub phi_deg: f64,
    i: Option<u32>,
    j: Option<u32>,
}

impl PlannedPosition {
    /// Returns the index on the stand that was planned for, or `None` if the plan is for none.
    pub(crate) fn index(&self) -> Option<PositionIndex> {
        self.i.zip(self.j).map(|(i, j)| PositionIndex { i, j })
    }

    fn angles(&self) -> [f64; 2] {
        [self.theta_deg, self.phi_deg]
    }
}

impl Planned {
    /// Reads the JSON of a plan; `name` is the file name in messages.
    pub(crate) fn from_json(name: &str, bytes: &[u8]) -> Result<Self, Unreadable> {
        const EXPECTED: &str = "the JSON of a plan";
        const ADVICE: &str = "create it with `plan --format json`";
        let refused = |found: String| Unreadable::whole(name, None, found, EXPECTED, ADVICE).in_text(bytes);
        if let Some(kind) = Kind::of(bytes) {
            return Err(refused(kind.words().to_owned()));
        }
        let plan: Self =
            serde_json::from_slice(bytes).map_err(|error| Unreadable::json(name, bytes, &error, EXPECTED, ADVICE))?;
        match plan.contradiction() {
            Some(found) => Err(refused(found)),
            None => Ok(plan),
        }
    }

    /// Returns the rule that the plan breaks, in words.
    fn contradiction(&self) -> Option<String> {
        let count = self.readings.len();
        let finite = self.readings.iter().flat_map(PlannedPosition::angles).all(f64::is_finite);
        let twice = |at: &PlannedPosition| {
            let alike = |other: &&PlannedPosition| {
                other.angles() == at.angles() || (at.index().is_some() && other.index() == at.index())
            };
            self.readings.iter().filter(alike).count() > 1
        };
        let unknown = |angles: &&[f64; 2]| !self.readings.iter().any(|at| at.angles() == **angles);
        if count == 0 || count > MOST_POSITIONS || self.order.len() > MOST_READINGS as usize {
            return Some(format!("a plan of {count} positions and {} visits", self.order.len()));
        }
        if !finite || !(0.0..360.0).contains(&self.frame_axis_azimuth_deg) {
            return Some("a plan with impossible angles".to_owned());
        }
        if let Some(at) = self.readings.iter().find(|at| twice(at)) {
            return Some(format!("a plan that lists position ({}°, {}°) twice", at.theta_deg, at.phi_deg));
        }
        if let Some([theta_deg, phi_deg]) = self.order.iter().find(unknown) {
            return Some(format!("a plan whose order visits ({theta_deg}°, {phi_deg}°), which is not in its readings"));
        }
        let missing = self.readings.iter().find(|at| !self.order.contains(&at.angles()));
        missing.map(|at| format!("a plan whose order never visits ({}°, {}°)", at.theta_deg, at.phi_deg))
    }
}

impl<'a> From<&'a Plan> for PlanDocument<'a> {
    fn from(plan: &'a Plan) -> Self {
        let angles = |place: &usize| [plan.readings[*place].theta_deg, plan.readings[*place].phi_deg];
        Self {
            criterion: plan.criterion.key(),
            value: plan.evaluation.value,
            frame_axis_azimuth_deg: plan.frame_axis_azimuth_deg,
            readings: &plan.readings,
            order: plan.order.places.iter().map(angles).collect(),
            standard_uncertainty: parameters(&plan.evaluation.standard_uncertainty),
            paper: plan.paper.as_ref(),
            worse: plan
                .worse()
                .into_iter()
                .map(|(parameter, ratio)| WorseDocument { parameter: parameter.key(), ratio })
                .collect(),
            has_matrices: plan.has_matrices,
            has_general_model: plan.has_general_model,
            common_errors: common_errors(&plan.evaluation, plan.paper.as_ref()),
            drift_over_tolerance_per_deg_per_h: plan.order.largest_over_tolerance,
            beyond_range: plan.beyond_range,
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

fn common_errors<'a>(plan: &'a Evaluation, paper: Option<&'a Evaluation>) -> Vec<EffectDocument<'a>> {
    let of_paper = |place: usize| paper.and_then(|paper| paper.effects.get(place));
    let each = plan.effects.iter().enumerate().map(|(place, effect)| {
        let CommonError { name, size, cause } = effect.error;
        EffectDocument { error: name, size, unit: cause.unit(), plan: effect, paper: of_paper(place) }
    });
    each.collect()
}

fn parameters(values: &[f64; 8]) -> Parameters {
    Parameters::of(&GyroParameters::from_vector(values))
}

/// Writes numbers in the order of [`Parameter::EIGHT`](crate::calibration::Parameter::EIGHT) under the keys of a gyro type.
pub(super) fn by_parameter<S: Serializer>(values: &[f64; 8], serializer: S) -> Result<S::Ok, S::Error> {
    parameters(values).serialize(serializer)
}
