//! Budgets and Monte Carlo for machines: the keys `budget` and `monte_carlo` of `calibrate --format json`.

use super::budget::{Budget, COVERAGE};
use super::monte_carlo::MonteCarlo;
use crate::calibration::document::CalibrationDocument;
use serde::Serialize;

/// The result of a calibration, and what was asked for besides.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct WholeDocument<'a> {
    /// The calibration.
    #[serde(flatten)]
    pub(crate) calibration: &'a CalibrationDocument,
    /// Its budget.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) budget: Option<BudgetDocument>,
    /// Its Monte Carlo.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) monte_carlo: Option<MonteCarloDocument>,
}

/// A budget.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BudgetDocument {
    /// Of which method.
    pub(crate) method: &'static str,
    /// One computed sentence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) sentence: Option<String>,
    /// For each parameter.
    pub(crate) parameters: Vec<ParameterDocument>,
    /// Covariance of the parameters, in their order.
    pub(crate) covariance: Vec<Vec<f64>>,
    /// Every input by itself.
    pub(crate) inputs: Vec<InputDocument>,
}

/// One parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct ParameterDocument {
    /// Its key.
    pub(crate) parameter: &'static str,
    /// Its unit.
    pub(crate) unit: &'static str,
    /// Its value.
    pub(crate) value: f64,
    /// k = 1.
    pub(crate) standard_uncertainty: f64,
    /// Absent when infinite.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) effective_degrees_of_freedom: Option<f64>,
    /// Probability of the expanded uncertainty.
    pub(crate) coverage_probability: f64,
    /// Expanded over standard uncertainty.
    pub(crate) coverage_factor: f64,
    /// Half the width of the interval.
    pub(crate) expanded_uncertainty: f64,
    /// The largest first.
    pub(crate) contributions: Vec<ContributionDocument>,
}

/// A line of a budget.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct ContributionDocument {
    /// The kind of input.
    pub(crate) input: String,
    /// How many inputs of that kind.
    pub(crate) inputs: usize,
    /// Who states it.
    pub(crate) source: &'static str,
    /// The unit of its uncertainty.
    pub(crate) input_unit: &'static str,
    /// The largest standard uncertainty of the kind.
    pub(crate) input_standard_uncertainty: f64,
    /// What it contributes, in the parameter's unit.
    pub(crate) contribution: f64,
    /// Of the parameter's variance.
    pub(crate) share: f64,
}

/// One input.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct InputDocument {
    /// Its name.
    pub(crate) input: String,
    /// Its unit.
    pub(crate) unit: &'static str,
    /// Of the mean of all readings.
    pub(crate) standard_uncertainty: f64,
    /// Absent when infinite.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) degrees_of_freedom: Option<f64>,
    /// The change of every parameter that one standard uncertainty makes, in their order.
    pub(crate) changes: Vec<f64>,
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

impl BudgetDocument {
    /// Of a budget and the sentence on it.
    pub fn new(budget: &Budget, sentence: Option<String>) -> Self {
        let covariance = budget.covariance();
        let parameters = budget.parameters.iter().map(|line| ParameterDocument {
            parameter: line.parameter.key(),
            unit: line.parameter.unit(),
            value: line.value,
            standard_uncertainty: line.standard_uncertainty,
            effective_degrees_of_freedom: finite(line.effective_degrees_of_freedom),
            coverage_probability: COVERAGE,
            coverage_factor: line.coverage_factor,
            expanded_uncertainty: line.expanded_uncertainty(),
            contributions: line.contributions.iter().map(ContributionDocument::new).collect(),
        });
        let inputs = budget.inputs.iter().enumerate().map(|(column, input)| InputDocument {
            input: input.cause.name(),
            unit: input.cause.unit(),
            standard_uncertainty: input.cause.shown(input.standard_uncertainty),
            degrees_of_freedom: finite(input.degrees_of_freedom),
            changes: budget.spread.column(column).iter().copied().collect(),
        });
        Self {
            method: budget.method.key(),
            sentence,
            parameters: parameters.collect(),
            covariance: covariance.row_iter().map(|row| row.iter().copied().collect()).collect(),
            inputs: inputs.collect(),
        }
    }
}

impl ContributionDocument {
    fn new(line: &super::budget::Contribution) -> Self {
        Self {
            input: line.cause.kind(),
            inputs: line.inputs,
            source: line.cause.source(),
            input_unit: line.cause.unit(),
            input_standard_uncertainty: line.cause.shown(line.standard_uncertainty[1]),
            contribution: line.contribution,
            share: line.share,
        }
    }
}

/// A Monte Carlo: the key `monte_carlo` of `calibrate --format json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct MonteCarloDocument {
    /// Of which method.
    pub(crate) method: &'static str,
    /// The same seed gives the same numbers.
    pub(crate) seed: u64,
    /// Trials made.
    pub(crate) trials: u64,
    /// Trials without finite parameters, left out.
    pub(crate) failed: u64,
    /// Whether every stated digit is stable.
    pub(crate) stable: bool,
    /// For each parameter.
    pub(crate) parameters: Vec<DistributionDocument>,
    /// Covariance of the parameters, in their order.
    pub(crate) covariance: Vec<Vec<f64>>,
}

/// The distribution of one parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct DistributionDocument {
    /// Its key.
    pub(crate) parameter: &'static str,
    /// Its unit.
    pub(crate) unit: &'static str,
    /// Mean of the trials.
    pub(crate) mean: f64,
    /// Their standard deviation.
    pub(crate) standard_uncertainty: f64,
    /// Probability of the intervals.
    pub(crate) coverage_probability: f64,
    /// As much below it as above.
    pub(crate) symmetric_interval: [f64; 2],
    /// The shortest.
    pub(crate) shortest_interval: [f64; 2],
    /// y - U and y + U by first order.
    pub(crate) first_order_interval: [f64; 2],
    /// How far the ends of the symmetric and the first-order interval are apart.
    pub(crate) differences: [f64; 2],
    /// What they may be apart.
    pub(crate) tolerance: f64,
    /// JCGM 101, clause 8; null where there are too few trials to tell.
    pub(crate) first_order_valid: Option<bool>,
}

impl MonteCarloDocument {
    /// Of a Monte Carlo.
    pub(crate) fn new(found: &MonteCarlo) -> Self {
        let parameters = found.parameters.iter().map(|line| DistributionDocument {
            parameter: line.parameter.key(),
            unit: line.parameter.unit(),
            mean: line.mean,
            standard_uncertainty: line.standard_uncertainty,
            coverage_probability: COVERAGE,
            symmetric_interval: line.symmetric,
            shortest_interval: line.shortest,
            first_order_interval: line.first_order.interval,
            differences: line.first_order.differences,
            tolerance: line.first_order.tolerance,
            first_order_valid: line.first_order.valid,
        });
        Self {
            method: found.method.key(),
            seed: found.seed,
            trials: found.trials,
            failed: found.failed,
            stable: found.stable,
            parameters: parameters.collect(),
            covariance: found.covariance.row_iter().map(|row| row.iter().copied().collect()).collect(),
        }
    }
}
