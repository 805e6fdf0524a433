//! Budgets and Monte Carlo for machines: the keys `budget` and `monte_carlo` of `calibrate --format json`.

use super::budget::{Budget, COVERAGE};
use super::monte_carlo::MonteCarlo;
use crate::calibration::document::CalibrationDocument;
use serde::Serialize;

/// The result of a calibration, and what was asked for besides.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WholeDocument<'a> {
    /// The calibration.
    #[serde(flatten)]
    pub calibration: &'a CalibrationDocument,
    /// Its budget.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub budget: Option<BudgetDocument>,
    /// Its Monte Carlo.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub monte_carlo: Option<MonteCarloDocument>,
}

/// A budget.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BudgetDocument {
    /// Of which method.
    pub method: &'static str,
    /// One computed sentence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sentence: Option<String>,
    /// For each parameter.
    pub parameters: Vec<ParameterDocument>,
    /// Covariance of the parameters, in their order.
    pub covariance: Vec<Vec<f64>>,
    /// Every input by itself.
    pub inputs: Vec<InputDocument>,
}

/// One parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ParameterDocument {
    /// Its key.
    pub parameter: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Its value.
    pub value: f64,
    /// k = 1.
    pub standard_uncertainty: f64,
    /// Absent when infinite.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub effective_degrees_of_freedom: Option<f64>,
    /// Probability of the expanded uncertainty.
    pub coverage_probability: f64,
    /// Expanded over standard uncertainty.
    pub coverage_factor: f64,
    /// Half the width of the interval.
    pub expanded_uncertainty: f64,
    /// The largest first.
    pub contributions: Vec<ContributionDocument>,
}

/// A line of a budget.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ContributionDocument {
    /// The kind of input.
    pub input: String,
    /// How many inputs of that kind.
    pub inputs: usize,
    /// Who states it.
    pub source: &'static str,
    /// The unit of its uncertainty.
    pub input_unit: &'static str,
    /// The largest standard uncertainty of the kind.
    pub input_standard_uncertainty: f64,
    /// What it contributes, in the parameter's unit.
    pub contribution: f64,
    /// Of the parameter's variance.
    pub share: f64,
}

/// One input.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InputDocument {
    /// Its name.
    pub input: String,
    /// Its unit.
    pub unit: &'static str,
    /// Of the mean of all readings.
    pub standard_uncertainty: f64,
    /// Absent when infinite.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub degrees_of_freedom: Option<f64>,
    /// The change of every parameter that one standard uncertainty makes, in their order.
    pub changes: Vec<f64>,
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
pub struct MonteCarloDocument {
    /// Of which method.
    pub method: &'static str,
    /// The same seed gives the same numbers.
    pub seed: u64,
    /// Trials made.
    pub trials: u64,
    /// Trials without finite parameters, left out.
    pub failed: u64,
    /// Whether every stated digit is stable.
    pub stable: bool,
    /// For each parameter.
    pub parameters: Vec<DistributionDocument>,
    /// Covariance of the parameters, in their order.
    pub covariance: Vec<Vec<f64>>,
}

/// The distribution of one parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DistributionDocument {
    /// Its key.
    pub parameter: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Mean of the trials.
    pub mean: f64,
    /// Their standard deviation.
    pub standard_uncertainty: f64,
    /// Probability of the intervals.
    pub coverage_probability: f64,
    /// As much below it as above.
    pub symmetric_interval: [f64; 2],
    /// The shortest.
    pub shortest_interval: [f64; 2],
    /// y - U and y + U by first order.
    pub first_order_interval: [f64; 2],
    /// How far the ends of the symmetric and the first-order interval are apart.
    pub differences: [f64; 2],
    /// What they may be apart.
    pub tolerance: f64,
    /// JCGM 101, clause 8; null where there are too few trials to tell.
    pub first_order_valid: Option<bool>,
}

impl MonteCarloDocument {
    /// Of a Monte Carlo.
    pub fn new(found: &MonteCarlo) -> Self {
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
