//! The plan as JSON, and what templates take from it.

use super::sensitivity::{CommonError, Effect, parameters};
use super::{Evaluation, MOST_READINGS, Plan};
use crate::calibration::NotStated;
use crate::coefficients::PositionIndex;
use crate::stand::MOST_POSITIONS;
use crate::text::node::from_json;
use crate::text::{Kind, Unreadable};
use serde::ser::SerializeMap;
use serde::{Deserialize, Serialize, Serializer};
use serde_json::json;

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
        let plan: Self = from_json(name, bytes, EXPECTED, ADVICE)?;
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

/// The keys are described by the schema `plan`.
impl Serialize for Plan {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let angles = |place: &usize| [self.readings[*place].theta_deg, self.readings[*place].phi_deg];
        let worse = self.worse().into_iter().map(|(parameter, ratio)| json!({"parameter": parameter, "ratio": ratio}));
        let mut keys = serializer.serialize_map(None)?;
        keys.serialize_entry("criterion", self.criterion.key())?;
        keys.serialize_entry("value", &self.evaluation.value)?;
        keys.serialize_entry("frame_axis_azimuth_deg", &self.frame_axis_azimuth_deg)?;
        keys.serialize_entry("readings", &self.readings)?;
        keys.serialize_entry("order", &self.order.places.iter().map(angles).collect::<Vec<_>>())?;
        keys.serialize_entry("standard_uncertainty", &parameters(&self.evaluation.standard_uncertainty))?;
        if let Some(paper) = &self.paper {
            keys.serialize_entry("paper", paper)?;
        }
        keys.serialize_entry("worse", &worse.collect::<Vec<_>>())?;
        keys.serialize_entry("has_matrices", &self.has_matrices)?;
        keys.serialize_entry("has_general_model", &self.has_general_model)?;
        keys.serialize_entry("common_errors", &common_errors(&self.evaluation, self.paper.as_ref()))?;
        keys.serialize_entry("drift_over_tolerance_per_deg_per_h", &self.order.largest_over_tolerance)?;
        keys.serialize_entry("gravity_over_tolerance", &self.gravity_over_tolerance)?;
        keys.serialize_entry("turn_on_over_tolerance", &self.turn_on_over_tolerance)?;
        keys.serialize_entry("beyond_range", &self.beyond_range)?;
        keys.serialize_entry("exhaustive", &self.exhaustive)?;
        keys.serialize_entry("not_stated", &self.not_stated().collect::<Vec<_>>())?;
        keys.end()
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
