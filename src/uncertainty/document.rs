//! JSON of budgets and Monte Carlo: the keys `budget` and `monte_carlo` of `calibrate --format json`.

use super::budget::{Budget, COVERAGE};
use super::monte_carlo::MonteCarlo;
use crate::calibration::document::{CalibrationDocument, finite};
use serde::Serialize;

/// Calibration result with the requested budget and Monte Carlo.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct WholeDocument<'a> {
    /// Result of the calibration.
    #[serde(flatten)]
    pub(crate) calibration: &'a CalibrationDocument,
    /// Uncertainty budget, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) budget: Option<BudgetDocument>,
    /// Monte Carlo result, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) monte_carlo: Option<MonteCarloDocument>,
}

/// Uncertainty budget: the key `budget` of `calibrate --format json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct BudgetDocument {
    /// Key of the method.
    pub(crate) method: &'static str,
    /// Sentence on the dominant contribution.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) sentence: Option<String>,
    /// Budgets of the parameters.
    pub(crate) parameters: Vec<ParameterDocument>,
    /// Covariance of the parameters, in their order.
    pub(crate) covariance: Vec<Vec<f64>>,
    /// Single inputs.
    pub(crate) inputs: Vec<InputDocument>,
}

/// Uncertainty budget of one parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct ParameterDocument {
    /// Key of the parameter.
    pub(crate) parameter: &'static str,
    /// Unit of the parameter.
    pub(crate) unit: &'static str,
    /// Value of the parameter.
    pub(crate) value: f64,
    /// Standard uncertainty (k = 1).
    pub(crate) standard_uncertainty: f64,
    /// Effective degrees of freedom; absent if infinite.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) effective_degrees_of_freedom: Option<f64>,
    /// Coverage probability of the expanded uncertainty.
    pub(crate) coverage_probability: f64,
    /// Coverage factor: expanded over standard uncertainty.
    pub(crate) coverage_factor: f64,
    /// Expanded uncertainty: half the width of the coverage interval.
    pub(crate) expanded_uncertainty: f64,
    /// Lines of the budget, the largest first.
    pub(crate) contributions: Vec<ContributionDocument>,
}

/// Line of a budget.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct ContributionDocument {
    /// Kind of the inputs.
    pub(crate) input: String,
    /// Number of inputs of that kind.
    pub(crate) inputs: usize,
    /// Source that states the uncertainty.
    pub(crate) source: &'static str,
    /// Unit of the input uncertainty.
    pub(crate) input_unit: &'static str,
    /// Largest standard uncertainty of the kind.
    pub(crate) input_standard_uncertainty: f64,
    /// Contribution to the standard uncertainty of the parameter, in its unit.
    pub(crate) contribution: f64,
    /// Share in the variance of the parameter.
    pub(crate) share: f64,
}

/// Single input.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct InputDocument {
    /// Name of the input.
    pub(crate) input: String,
    /// Unit of the input.
    pub(crate) unit: &'static str,
    /// Standard uncertainty of the input, for the mean of all readings.
    pub(crate) standard_uncertainty: f64,
    /// Degrees of freedom of that uncertainty; absent if infinite.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) degrees_of_freedom: Option<f64>,
    /// Change of every parameter for one standard uncertainty of the input, in the order of the parameters.
    pub(crate) changes: Vec<f64>,
}

impl BudgetDocument {
    /// Creates the document of a budget and the sentence on it.
    pub(crate) fn new(budget: &Budget, sentence: Option<String>) -> Self {
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

/// Monte Carlo result: the key `monte_carlo` of `calibrate --format json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct MonteCarloDocument {
    /// Key of the method.
    pub(crate) method: &'static str,
    /// Seed, which determines the numbers.
    pub(crate) seed: u64,
    /// Number of trials made.
    pub(crate) trials: u64,
    /// Number of trials without finite parameters, which are excluded.
    pub(crate) failed: u64,
    /// `true` if every stated digit is stable.
    pub(crate) stable: bool,
    /// Distributions of the parameters.
    pub(crate) parameters: Vec<DistributionDocument>,
    /// Covariance of the parameters, in their order.
    pub(crate) covariance: Vec<Vec<f64>>,
}

/// Distribution of one parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct DistributionDocument {
    /// Key of the parameter.
    pub(crate) parameter: &'static str,
    /// Unit of the parameter.
    pub(crate) unit: &'static str,
    /// Mean of the trials.
    pub(crate) mean: f64,
    /// Standard deviation of the trials.
    pub(crate) standard_uncertainty: f64,
    /// Coverage probability of the intervals.
    pub(crate) coverage_probability: f64,
    /// Probabilistically symmetric coverage interval.
    pub(crate) symmetric_interval: [f64; 2],
    /// Shortest coverage interval.
    pub(crate) shortest_interval: [f64; 2],
    /// First-order interval, y - U and y + U.
    pub(crate) first_order_interval: [f64; 2],
    /// Distances between the lower and between the upper ends of the symmetric and the first-order interval.
    pub(crate) differences: [f64; 2],
    /// Largest distance for which first order is valid.
    pub(crate) tolerance: f64,
    /// `true` if first order is valid by JCGM 101, clause 8; null if there are too few trials to decide.
    pub(crate) first_order_valid: Option<bool>,
}

impl MonteCarloDocument {
    /// Creates the document of a Monte Carlo result.
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
