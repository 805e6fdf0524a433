//! A budget as JSON.

use super::budget::{Budget, COVERAGE, Contribution};
use super::dominant::Dominant;
use crate::calibration::document::finite;
use crate::gyro::Tolerance;
use crate::wording::texts::calibration as texts;
use crate::wording::words::joined;
use crate::wording::{Language, plain};
use serde_json::{Value, json};

impl Budget {
    /// Returns the budget as JSON, `{method, sentence, parameters, covariance, inputs}`: the key `budget` of `calibrate`. The
    /// parameters have their `contributions`; `changes` of an input are those of the parameters, for one standard uncertainty.
    /// The sentence is on the uncertainty that is largest relative to its `tolerance`, or to its value.
    pub(crate) fn to_json(&self, tolerance: Option<&Tolerance>) -> Value {
        let worst = if tolerance.is_some() { texts::budget_worst } else { texts::budget_worst_of_size };
        let sentence = Dominant::of(self, tolerance)
            .map(|remedy| plain(&joined(remedy.said(worst), " ").plain(Language::English)));
        let contribution = |part: &Contribution| {
            json!({
                "input": part.cause.kind(), "inputs": part.inputs, "source": part.cause.source(),
                "input_unit": part.cause.unit(),
                "input_standard_uncertainty": part.cause.shown(part.standard_uncertainty[1]),
                "contribution": part.contribution, "share": part.share,
            })
        };
        let parameters = self.parameters.iter().map(|line| {
            stated(json!({
                "parameter": line.parameter.key(), "unit": line.parameter.unit(), "value": line.value,
                "standard_uncertainty": line.standard_uncertainty,
                "effective_degrees_of_freedom": finite(line.effective_degrees_of_freedom),
                "coverage_probability": COVERAGE, "coverage_factor": line.coverage_factor,
                "expanded_uncertainty": line.expanded_uncertainty(),
                "contributions": line.contributions.iter().map(contribution).collect::<Vec<_>>(),
            }))
        });
        let inputs = self.inputs.iter().zip(self.spread.column_iter()).map(|(input, changes)| {
            stated(json!({
                "input": input.cause.name(), "unit": input.cause.unit(),
                "standard_uncertainty": input.cause.shown(input.standard_uncertainty),
                "degrees_of_freedom": finite(input.degrees_of_freedom), "changes": changes.as_slice(),
            }))
        });
        let covariance = self.covariance();
        stated(json!({
            "method": self.method.key(),
            "sentence": sentence,
            "parameters": parameters.collect::<Vec<_>>(),
            "covariance": covariance.row_iter().map(|row| row.iter().copied().collect()).collect::<Vec<Vec<f64>>>(),
            "inputs": inputs.collect::<Vec<_>>(),
        }))
    }
}

/// Returns an object without the keys that have no value: infinite degrees of freedom, no sentence.
fn stated(mut object: Value) -> Value {
    if let Value::Object(keys) = &mut object {
        keys.retain(|_, value| !value.is_null());
    }
    object
}
