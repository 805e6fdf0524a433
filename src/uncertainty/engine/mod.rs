//! Engine of the Monte Carlo: what is drawn, and the model of one calibration. The crate `dtg-passport-trials` runs it;
//! no value in a passport is computed there.

mod kernel;
pub(crate) mod plan;

use crate::calibration::procedure::{Linearised, linearise};
use crate::calibration::{Method, MethodRefusal, NoAnalyticSolution, Options, Readings, Setup};
pub(crate) use dtg_passport_trials::{BLOCK, PAIRS, PARAMETERS, pair};
use dtg_passport_trials::{Computation, Solver, refit::Refit};
use nalgebra::Matrix2;
use plan::Plan;

/// Distribution of the own error of a current.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ReadingShape {
    /// Normal distribution with the stated standard uncertainty.
    Normal,
    /// Uniform distribution with the stated standard uncertainty u and the limits ±√3 u (JCGM 101, 6.4.2).
    Uniform,
}

/// Monte Carlo engine, prepared for one calibration.
#[derive(Debug, Clone)]
pub struct Engine {
    pub(crate) computation: Computation,
    /// Inputs in the order of the columns.
    #[cfg(test)]
    pub(crate) inputs: Vec<crate::calibration::Input>,
}

impl Engine {
    /// Creates the engine for `method` and a calibration of `readings` at `setup`.
    ///
    /// # Errors
    /// Returns [`MethodRefusal`] if the method has no solution for these readings.
    pub fn new(setup: &Setup, readings: &Readings, method: Method, shape: ReadingShape) -> Result<Self, MethodRefusal> {
        let Linearised { fit, data, .. } = linearise(setup, readings, method, &Options::default())?;
        if !data.offsets.are_balanced() {
            return Err(MethodRefusal::NotThisModel);
        }
        let setup = &*setup.of_readings(readings);
        let means_ma = readings.means_ma();
        let solver = match method {
            Method::LeastSquares => {
                let weights = fit.whitening.iter().map(|whiten| {
                    let p: Matrix2<f64> = whiten.transpose() * whiten;
                    [p.m11, p.m12, p.m22]
                });
                Solver::Refit(Refit { start: fit.unknowns.parameters.to_vector(), weights: weights.collect() })
            }
            Method::Analytic | Method::Iterative => {
                let eight = setup.coefficients().eight();
                Solver::Closed(eight.ok_or(NoAnalyticSolution::EightPositionsMissing)?)
            }
        };
        let plan = Plan::new(setup, &means_ma, &data.repeats, shape);
        let kernel = kernel::kernel(setup, &means_ma, &plan);
        Ok(Self {
            computation: Computation { draw: plan.draw, kernel, solver },
            #[cfg(test)]
            inputs: plan.inputs,
        })
    }
}
