//! Uncertainty budget: the first-order contribution of every input to every parameter.
//!
//! Sources: [JCGM 100](crate::bibliography::Bibliography::Gum), 5.1.2 (u² = Σ (c_i u_i)²), G.4.1 (Welch-Satterthwaite)
//! and G.3.3 (coverage factor); [JCGM 102](crate::bibliography::Bibliography::Jcgm102), 6.2.1 (covariance of several
//! results).

use crate::calibration::causes;
use crate::calibration::data::Observation;
use crate::calibration::estimates::Estimates;
use crate::calibration::procedure::{observe, response};
use crate::calibration::propagation::{covariance, product};
use crate::calibration::{
    Basis, Calibration, Cause, Input, Method, MethodRefusal, Model, Options, Parameter, Readings, Setup,
};
use crate::statistics::student::student_factor;
use nalgebra::DMatrix;
use std::collections::BTreeMap;

/// Coverage probability of expanded uncertainties.
pub(crate) const COVERAGE: f64 = 0.95;

/// Share of the variance below which a contribution is only rounding, because the input does not act on the parameter.
const ROUNDING: f64 = 1e-18;

/// Uncertainty budget of one method.
#[derive(Debug, Clone, PartialEq)]
pub struct Budget {
    /// Method of the calibration.
    pub method: Method,
    /// Uncertain inputs.
    pub inputs: Vec<Input>,
    /// Change of each parameter (rows, in the order of `parameters`) for one standard uncertainty of each input
    /// (columns), in the unit of the parameter.
    pub spread: DMatrix<f64>,
    /// Budgets of the parameters, in the order of the rows.
    pub parameters: Vec<ParameterBudget>,
}

/// Uncertainty budget of one parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterBudget {
    /// Parameter of the budget.
    pub parameter: Parameter,
    /// Value of the parameter by this method; for the iterative method, the limit of the iteration.
    pub value: f64,
    /// Standard uncertainty of the parameter (k = 1), in its unit.
    pub standard_uncertainty: f64,
    /// Effective degrees of freedom by Welch and Satterthwaite; infinite if the uncertainty of every input is known
    /// exactly.
    pub effective_degrees_of_freedom: f64,
    /// Coverage factor for the coverage probability `COVERAGE`, from Student's t with those degrees of freedom.
    pub coverage_factor: f64,
    /// Lines of the budget, the largest first.
    pub contributions: Vec<Contribution>,
}

impl ParameterBudget {
    /// Returns the expanded uncertainty: half the width of the interval that covers the parameter with probability
    /// `COVERAGE`.
    pub(crate) fn expanded_uncertainty(&self) -> f64 {
        self.coverage_factor * self.standard_uncertainty
    }
}

/// Line of a budget: all inputs of one kind, which are independent of each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Contribution {
    /// First of these inputs; all have the same kind, source and unit.
    pub cause: Cause,
    /// Number of these inputs.
    pub inputs: usize,
    /// Smallest and largest of their standard uncertainties: rad, a share of the reading, or mA.
    pub standard_uncertainty: [f64; 2],
    /// Contribution of these inputs to the standard uncertainty of the parameter, in its unit; 0 if it is only rounding.
    pub contribution: f64,
    /// Share of these inputs in the variance of the parameter.
    pub share: f64,
}

impl Contribution {
    /// Returns `true` if the standard uncertainties of the inputs differ by more than one percent.
    pub(crate) fn has_several_sizes(&self) -> bool {
        let [smallest, largest] = self.standard_uncertainty;
        smallest < 0.99 * largest
    }
}

impl Budget {
    /// Computes the budget of `method` for a calibration of `readings` at `setup` with the model of `options`.
    ///
    /// The sum of squares of the contributions is the variance that
    /// [`calibrate`](crate::calibration::calibrate) states.
    ///
    /// # Errors
    /// Returns [`MethodRefusal`] if the method has no solution for these readings.
    pub fn new(setup: &Setup, readings: &Readings, method: Method, options: &Options) -> Result<Self, MethodRefusal> {
        Self::at(&setup.of_readings(readings), &observe(setup, readings, method, options)?, method)
    }

    /// Computes the budget of the adopted result of a calibration, or of least squares if there is none.
    ///
    /// # Errors
    /// Returns [`MethodRefusal`] as [`Self::new`] does.
    pub(crate) fn of(
        calibration: &Calibration,
        setup: &Setup,
        readings: &Readings,
        options: &Options,
    ) -> Result<Self, MethodRefusal> {
        let method = calibration.adopted().map_or(Method::LeastSquares, |answer| answer.method);
        let observation = &calibration.observation;
        if observation.fit.of != method.model(options) {
            return Self::new(setup, readings, method, options);
        }
        Self::at(&setup.of_readings(readings), observation, method)
    }

    fn at(setup: &Setup, observation: &Observation, method: Method) -> Result<Self, MethodRefusal> {
        let (found, response) = response(setup, observation, method)?;
        let Observation { data, fit, .. } = observation;
        let (inputs, columns) = causes::inputs(setup, data, fit);
        let spread = product(&response, &columns);
        let of = if method == Method::LeastSquares { fit.of } else { Model::Paper };
        let spread = spread.rows(0, of.columns()).into_owned();
        let estimates = Estimates::new(setup, &data.repeats).degrees_of_freedom;
        let each = of.parameters().iter().map(|parameter| (*parameter, found.value(*parameter)));
        let line = |(row, (parameter, value))| of_parameter(parameter, value, &inputs, (&spread, row), &estimates);
        let parameters = each.enumerate().map(line).collect();
        Ok(Self { method, inputs, spread, parameters })
    }

    /// Returns the effective degrees of freedom of the parameters by their keys, without unlimited ones.
    pub(crate) fn degrees_of_freedom(&self) -> BTreeMap<Parameter, f64> {
        let limited = self.parameters.iter().filter(|line| line.effective_degrees_of_freedom.is_finite());
        limited.map(|line| (line.parameter, line.effective_degrees_of_freedom)).collect()
    }

    /// Returns the covariance of the parameters, in their order; 8×8, 9×9 or 12×12.
    pub fn covariance(&self) -> DMatrix<f64> {
        covariance(&self.spread)
    }
}

fn of_parameter(
    parameter: Parameter,
    value: f64,
    inputs: &[Input],
    (spread, row): (&DMatrix<f64>, usize),
    estimates: &[f64],
) -> ParameterBudget {
    let changes: Vec<f64> = (0..inputs.len()).map(|column| spread[(row, column)]).collect();
    let variance: f64 = changes.iter().map(|change| change * change).sum();
    let mut contributions: Vec<Contribution> = Vec::new();
    for (input, change) in inputs.iter().zip(&changes) {
        let u = input.standard_uncertainty;
        match contributions.iter_mut().find(|line| line.cause.is_alike(input.cause)) {
            Some(line) => {
                line.inputs += 1;
                line.standard_uncertainty = [line.standard_uncertainty[0].min(u), line.standard_uncertainty[1].max(u)];
                // The sum of squares; its root is taken after the last input.
                line.contribution += change * change;
            }
            None => {
                let (cause, contribution) = (input.cause, change * change);
                let line = Contribution { cause, inputs: 1, standard_uncertainty: [u, u], contribution, share: 0.0 };
                contributions.push(line);
            }
        }
    }
    for line in &mut contributions {
        if line.contribution < ROUNDING * variance {
            line.contribution = 0.0;
        }
        line.share = if variance > 0.0 { line.contribution / variance } else { 0.0 };
        line.contribution = line.contribution.sqrt();
    }
    contributions.sort_by(|a, b| b.contribution.total_cmp(&a.contribution));
    let effective_degrees_of_freedom = effective_degrees_of_freedom(inputs, &changes, estimates);
    ParameterBudget {
        parameter,
        value,
        standard_uncertainty: variance.sqrt(),
        effective_degrees_of_freedom,
        coverage_factor: student_factor(1.0 - COVERAGE, effective_degrees_of_freedom),
        contributions,
    }
}

/// Degrees of freedom below which an estimate is often far too small.
const FEW: f64 = 5.0;

/// Returns the effective degrees of freedom by Welch and Satterthwaite (JCGM 100, G.4.1), not rounded. All inputs that
/// depend on one estimate form one term; an input that is a mean of estimates is divided among them.
///
/// The formula gives too many if an estimate with few degrees of freedom is most of the variance but not all of it, and
/// happens to be small. The square of its share w then counts for 3(2w − 1)(1 − w) more: with two degrees of freedom,
/// intervals with 95.45 % cover at least 93.8 instead of 92.4 %.
fn effective_degrees_of_freedom(inputs: &[Input], changes: &[f64], estimates: &[f64]) -> f64 {
    let mut terms: Vec<(f64, f64)> = estimates.iter().map(|known| (0.0, *known)).collect();
    for (input, change) in inputs.iter().zip(changes) {
        let square = change * change;
        if input.basis == Basis::Known {
            terms.push((square, f64::INFINITY));
        }
        for (place, share) in input.basis.shares() {
            terms[place].0 += share * square;
        }
    }
    let variance: f64 = terms.iter().map(|(square, _)| square).sum();
    let doubt = |(square, known): &(f64, f64)| {
        let rest = variance - square;
        let further = if *known < FEW { 3.0 * (square - rest).max(0.0) * rest } else { 0.0 };
        (square * square + further) / known
    };
    let doubt: f64 = terms.iter().map(doubt).sum();
    if doubt > 0.0 { variance * variance / doubt } else { f64::INFINITY }
}
