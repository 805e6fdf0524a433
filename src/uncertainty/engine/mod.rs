//! Vectorised engine of the Monte Carlo: trials side by side, without branches.
//!
//! A chunk is [`WIDTH`] trials. Each of its steps is a loop over the chunk that the compiler vectorises:
//!
//! 1. [`plan`]: which inputs are drawn, and how; standard deviates, one column each.
//! 2. [`kernel`]: attitudes, specific force, Earth rate and currents of every position.
//! 3. [`closed`]: the paper's coefficients and its analytic solution; or [`refit`]: weighted least squares.
//!
//! The program chooses the width of the instructions at run time, as the CPU allows. The arithmetic is the same
//! everywhere, product by product: nothing is fused or reordered, so a seed always gives the same bytes. No value in a
//! passport is computed here.

#![allow(clippy::needless_range_loop, reason = "a loop over trials that indexes several columns is what becomes wide")]

pub(crate) mod closed;
pub(crate) mod kernel;
pub(crate) mod plan;
pub(crate) mod refit;
mod student;

use crate::calibration::procedure::{Linearised, linearise};
use crate::calibration::{Method, MethodRefusal, NoAnalyticSolution, Options, Readings, Setup};
use crate::statistics::wide_random::{Column, WIDTH, WideRandom};
use kernel::Kernel;
use plan::Plan;
use refit::Refit;

/// Number of chunks in a block: 16,384 trials. JCGM 101, 7.9.4 requires at least 10,000.
const CHUNKS_PER_BLOCK: u64 = 512;

pub(crate) const BLOCK: u64 = CHUNKS_PER_BLOCK * WIDTH as u64;

/// Distribution of the own error of a current.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ReadingShape {
    /// Normal distribution with the stated standard uncertainty.
    Normal,
    /// Uniform distribution with the stated standard uncertainty u and the limits ±√3 u (JCGM 101, 6.4.2).
    Uniform,
}

/// Method that computes the parameters in every trial.
#[derive(Debug, Clone)]
enum Solver {
    /// Analytic method, with the places of the eight positions.
    Closed([usize; 8]),
    Refit(Box<Refit>),
}

/// Monte Carlo engine, prepared for one calibration.
#[derive(Debug, Clone)]
pub struct Engine {
    pub(crate) plan: Plan,
    kernel: Kernel,
    solver: Solver,
}

/// Number of parameters of a gyro.
pub(crate) const PARAMETERS: usize = 8;

/// Parameters of every trial of a chunk, in the order of [`crate::calibration::parameter::Parameter::EIGHT`].
pub(crate) type Solutions = [Column; PARAMETERS];

/// Number of pairs of parameters, including each with itself: the elements of the lower triangle of 8×8, row by row.
pub(crate) const PAIRS: usize = PARAMETERS * (PARAMETERS + 1) / 2;

/// Returns the place of (row, column ≤ row) in the lower triangle.
pub(crate) const fn pair(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

/// Columns that a chunk works on, reused from chunk to chunk.
#[derive(Debug, Clone)]
pub(crate) struct Workspace {
    deviates: Vec<Column>,
    positions: Vec<kernel::At>,
    solutions: Solutions,
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
            Method::LeastSquares => Solver::Refit(Box::new(Refit::new(&fit))),
            Method::Analytic | Method::Iterative => {
                let eight = setup.coefficients().eight();
                Solver::Closed(eight.ok_or(NoAnalyticSolution::EightPositionsMissing)?)
            }
        };
        let plan = Plan::new(setup, &means_ma, &data.repeats, shape);
        let kernel = Kernel::new(setup, &means_ma, &plan);
        Ok(Self { plan, kernel, solver })
    }

    pub(crate) fn workspace(&self) -> Workspace {
        Workspace {
            deviates: vec![[0.0; WIDTH]; self.plan.columns()],
            positions: vec![kernel::At::default(); self.kernel.positions()],
            solutions: [[0.0; WIDTH]; 8],
        }
    }

    /// Runs a block of trials; `each` is called with the parameters of every chunk.
    pub(crate) fn block(&self, lanes: &mut WideRandom, work: &mut Workspace, each: impl FnMut(&Solutions)) {
        pulp::Arch::new().dispatch(Block { engine: self, lanes, work, each });
    }

    /// Returns the parameters for given standard deviates, one row per trial (at most [`WIDTH`]), in the order of
    /// `Plan::inputs`; for tests against the exact path.
    #[cfg(test)]
    pub(crate) fn solutions_for(&self, trials: &[Vec<f64>]) -> Vec<[f64; 8]> {
        let mut work = self.workspace();
        for (trial, deviates) in trials.iter().take(WIDTH).enumerate() {
            for (column, deviate) in work.deviates.iter_mut().skip(1).zip(deviates) {
                column[trial] = *deviate;
            }
        }
        self.solve(&mut work);
        let count = trials.len().min(WIDTH);
        (0..count).map(|trial| std::array::from_fn(|place| work.solutions[place][trial])).collect()
    }

    #[inline(always)]
    fn solve(&self, work: &mut Workspace) {
        self.kernel.run(&work.deviates, &mut work.positions);
        match &self.solver {
            Solver::Closed(eight) => closed::solve(eight, &work.positions, &mut work.solutions),
            Solver::Refit(refit) => refit.solve(&work.positions, &mut work.solutions),
        }
    }
}

/// Work that runs with the widest instructions of the CPU; every function that it calls is inlined into it.
struct Block<'a, F> {
    engine: &'a Engine,
    lanes: &'a mut WideRandom,
    work: &'a mut Workspace,
    each: F,
}

impl<F: FnMut(&Solutions)> pulp::WithSimd for Block<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(mut self, _: S) {
        for _ in 0..CHUNKS_PER_BLOCK {
            self.engine.plan.draw(self.lanes, &mut self.work.deviates);
            self.engine.solve(self.work);
            (self.each)(&self.work.solutions);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attitude::Deviation;
    use crate::calibration::{InputUncertainty, MeterUncertainty};
    use crate::coefficients::{EarthRate, eight_positions};
    use crate::gyro::GyroType;
    use crate::laboratory::Laboratory;

    /// Creates an engine for an ideal stand with uncertain inputs; the angles have `known` degrees of freedom.
    fn engine(method: Method, known: f64) -> Engine {
        let positions = eight_positions(Deviation::default);
        let uncertainty = InputUncertainty {
            angles_rad: vec![[1e-5, 2e-5, 3e-5]; 8],
            angles_degrees_of_freedom: vec![known; 8],
            repeatability_rad: 1e-5,
            level_rad: 1e-5,
            ..InputUncertainty::of_meter(MeterUncertainty::from(&Laboratory::paper().meter))
        };
        let setup = Setup::new(&positions, EarthRate::at_astronomic_latitude(50.0), uncertainty).unwrap();
        let gyro = GyroType::gvk_6().nominal.to_model();
        let each = setup.coefficients().positions.iter().map(|at| (at.index, gyro.currents_ma(at).unwrap()));
        let readings = Readings::new(setup.coefficients(), &each.collect::<Vec<_>>()).unwrap();
        Engine::new(&setup, &readings, method, ReadingShape::Normal).unwrap()
    }

    /// The widest instructions of this machine and scalar ones give the same bits.
    #[test]
    fn results_do_not_depend_on_the_width_of_instructions() {
        use pulp::WithSimd;
        for method in [Method::Analytic, Method::LeastSquares] {
            for known in [f64::INFINITY, 4.0, 4.5] {
                let engine = engine(method, known);
                let (mut wide, mut narrow) = (Vec::new(), Vec::new());
                engine.block(&mut WideRandom::new(5), &mut engine.workspace(), |found| {
                    wide.push(found[0].map(f64::to_bits))
                });
                let (mut lanes, mut work) = (WideRandom::new(5), engine.workspace());
                let each = |found: &Solutions| narrow.push(found[0].map(f64::to_bits));
                Block { engine: &engine, lanes: &mut lanes, work: &mut work, each }.with_simd(pulp::Scalar);
                assert!(wide == narrow);
            }
        }
    }
}
