//! Trials of a Monte Carlo, side by side and without branches.
//!
//! A chunk is [`WIDTH`] trials. Each of its steps is a loop over the chunk that the compiler vectorises:
//!
//! 1. [`draw`]: standard deviates of the inputs, one column each.
//! 2. [`kernel`]: attitudes, specific force, Earth rate and currents of every position.
//! 3. [`closed`]: the paper's coefficients and its analytic solution; or [`refit`]: weighted least squares.
//!
//! [`wide_random`] has the random numbers, and [`bins`] the quantiles and coverage intervals of a sample of any size.
//!
//! The program chooses the width of the instructions at run time, as the CPU allows. The arithmetic is the same
//! everywhere, product by product: nothing is fused or reordered, so a seed always gives the same bytes.
//!
//! It is a crate of its own so that it is always compiled for speed, which takes a moment. The rest of the project takes
//! minutes, and is compiled so only for packages. Therefore no function that does the work is generic: the crate that
//! names its types would compile it.

#![allow(clippy::needless_range_loop, reason = "a loop over trials that indexes several columns is what becomes wide")]

pub mod accumulator;
pub mod bins;
pub mod closed;
pub mod draw;
pub mod elementary;
pub mod kernel;
pub mod refit;
pub mod student;
pub mod wide_random;

use accumulator::Accumulator;
use draw::Draw;
use kernel::{At, Kernel};
use refit::Refit;
use wide_random::{Column, WIDTH, WideRandom};

/// Number of chunks in a block: 16,384 trials. JCGM 101, 7.9.4 requires at least 10,000.
const CHUNKS_PER_BLOCK: u64 = 512;

/// Number of trials in a block.
pub const BLOCK: u64 = CHUNKS_PER_BLOCK * WIDTH as u64;

/// Method that computes the parameters in every trial.
#[derive(Debug, Clone)]
pub enum Solver {
    /// Analytic method, with the places of the eight positions.
    Closed([usize; 8]),
    /// Weighted least squares.
    Refit(Refit),
}

/// Everything that a trial needs, prepared for one calibration.
#[derive(Debug, Clone)]
pub struct Computation {
    /// Inputs that are drawn.
    pub draw: Draw,
    /// Model of all positions.
    pub kernel: Kernel,
    /// Method.
    pub solver: Solver,
}

/// Number of parameters of a gyro.
pub const PARAMETERS: usize = 8;

/// Parameters of every trial of a chunk: K_x, K_xy, K_yx, K_y, ω_0x, ω_0y, ω_g, ω_k.
pub type Solutions = [Column; PARAMETERS];

/// Number of pairs of parameters, including each with itself: the elements of the lower triangle of 8×8, row by row.
pub const PAIRS: usize = PARAMETERS * (PARAMETERS + 1) / 2;

/// Returns the place of (row, column ≤ row) in the lower triangle.
pub const fn pair(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

/// Columns that a chunk works on, reused from chunk to chunk.
#[derive(Debug, Clone)]
pub struct Workspace {
    deviates: Vec<Column>,
    positions: Vec<At>,
    solutions: Solutions,
}

impl Computation {
    /// Returns columns for the trials of one thread.
    pub fn workspace(&self) -> Workspace {
        Workspace {
            deviates: vec![[0.0; WIDTH]; self.draw.columns()],
            positions: vec![At::default(); self.kernel.places.len()],
            solutions: [[0.0; WIDTH]; PARAMETERS],
        }
    }

    /// Runs a block of trials, and adds them to `tally`.
    pub fn block(&self, lanes: &mut WideRandom, work: &mut Workspace, tally: &mut Accumulator) {
        pulp::Arch::new().dispatch(Block { of: self, lanes, work, each: |solutions: &Solutions| tally.add(solutions) });
    }

    /// Runs a block of trials, and returns every value of each parameter; `narrow` uses no wide instructions.
    pub fn samples(&self, lanes: &mut WideRandom, narrow: bool) -> [Vec<f64>; PARAMETERS] {
        let (mut samples, mut work): ([Vec<f64>; PARAMETERS], _) = (Default::default(), self.workspace());
        let each = |solutions: &Solutions| {
            for (sample, column) in samples.iter_mut().zip(solutions) {
                sample.extend_from_slice(column);
            }
        };
        let block = Block { of: self, lanes, work: &mut work, each };
        if narrow {
            pulp::WithSimd::with_simd(block, pulp::Scalar)
        } else {
            pulp::Arch::new().dispatch(block)
        }
        samples
    }

    /// Returns the parameters for given standard deviates, one row per trial (at most [`WIDTH`]), in the order of the
    /// inputs that are drawn.
    pub fn solutions_for(&self, trials: &[Vec<f64>]) -> Vec<[f64; PARAMETERS]> {
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
    of: &'a Computation,
    lanes: &'a mut WideRandom,
    work: &'a mut Workspace,
    each: F,
}

impl<F: FnMut(&Solutions)> pulp::WithSimd for Block<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(mut self, _: S) {
        for _ in 0..CHUNKS_PER_BLOCK {
            self.of.draw.draw(self.lanes, &mut self.work.deviates);
            self.of.solve(self.work);
            (self.each)(&self.work.solutions);
        }
    }
}
