//! Streams of random numbers: a seed gives the same numbers on any number of threads and on any platform.
//!
//! Work is divided into blocks of a fixed size. The generator of block n (xoshiro256++, period 2^256) is n jumps of
//! 2^128 numbers from the seed. Streams therefore never overlap, whichever thread computes them in whatever order.

use crate::parallel;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Stream of random numbers for one block.
#[derive(Debug, Clone)]
pub struct Stream(Xoshiro256PlusPlus);

impl Stream {
    /// Returns the first stream of a seed.
    pub fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    /// Returns a uniform number in [0, 1): the upper 53 bits of the next number.
    pub(crate) fn unit(&mut self) -> f64 {
        const PER_UNIT: f64 = (1_u64 << 53) as f64;
        (self.0.next_u64() >> 11) as f64 / PER_UNIT
    }

    /// Returns a uniform number in [-limit, limit).
    pub fn within(&mut self, limit: f64) -> f64 {
        limit * (2.0 * self.unit() - 1.0)
    }

    /// Returns -1 or 1 with equal probability.
    pub(crate) fn sign(&mut self) -> f64 {
        if self.unit() < 0.5 { -1.0 } else { 1.0 }
    }

    /// Returns a uniform whole number below `end`, or 0 if `end` is 0.
    #[cfg(any(test, feature = "fuzzing"))]
    pub(crate) fn below(&mut self, end: usize) -> usize {
        ((self.unit() * end as f64) as usize).min(end.saturating_sub(1))
    }

    /// Returns a standard normal number, by the polar form of Box and Muller (only one of the pair is used).
    #[cfg(test)]
    pub(crate) fn normal(&mut self) -> f64 {
        // 1 - u is in (0, 1], so its logarithm is finite.
        let radius = (-2.0 * libm::log(1.0 - self.unit())).sqrt();
        radius * libm::cos(std::f64::consts::TAU * self.unit())
    }
}

/// Number of trials in a block.
pub(crate) const BLOCK: u64 = 500;

/// Largest number of blocks whose streams are made at a time.
const BLOCKS_IN_A_WAVE: usize = 4096;

/// Settings of a series of trials.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    /// Total number of trials.
    pub trials: u64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Number of threads; 0 and 1 have the same effect.
    pub threads: usize,
    /// Flag that cancels the run: once it is `true`, no further block is started.
    pub cancel: Option<&'a AtomicBool>,
    /// Function called after every block with the number of trials done.
    pub progress: Option<&'a (dyn Fn(u64) + Sync)>,
}

impl std::fmt::Debug for Run<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let Self { trials, seed, threads, .. } = self;
        write!(f, "Run {{ trials: {trials}, seed: {seed}, threads: {threads} }}")
    }
}

impl Run<'_> {
    /// Creates a run of `trials` trials with the random numbers of `seed`, on all CPUs that the process may use.
    pub fn new(trials: u64, seed: u64) -> Self {
        Self { trials, seed, threads: parallel::processors(), cancel: None, progress: None }
    }

    /// Returns the results of `work` for every block of trials, in the order of the blocks.
    ///
    /// `work` is called with the stream of the block and the number of its trials. If the run is cancelled, the results
    /// of the finished blocks are returned: an unbroken series from the first.
    #[doc(hidden)]
    pub fn blocks<T: Send>(&self, work: impl Fn(&mut Stream, u64) -> T + Sync) -> Vec<T> {
        let mut stream = Stream::new(self.seed);
        let mut blocks = (0..self.trials.div_ceil(BLOCK)).map(|block| {
            let own = stream.clone();
            stream.0.jump();
            (BLOCK.min(self.trials - block * BLOCK), own)
        });
        let cancelled = || self.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed));
        let done = AtomicU64::new(0);
        let block = |(trials, stream): &(u64, Stream)| {
            if cancelled() {
                return None;
            }
            let result = work(&mut stream.clone(), *trials);
            let total = done.fetch_add(*trials, Ordering::Relaxed) + trials;
            if let Some(progress) = self.progress {
                progress(total);
            }
            Some(result)
        };
        let mut results = Vec::new();
        loop {
            // So few at a time that their streams need little memory, however many trials there are.
            let wave: Vec<(u64, Stream)> = blocks.by_ref().take(BLOCKS_IN_A_WAVE).collect();
            results.extend(parallel::map(&wave, self.threads, block).into_iter().map_while(|result| result));
            if wave.is_empty() || cancelled() {
                return results;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: moments of the uniform and the normal distribution, within five standard errors.
    #[test]
    fn moments() {
        let mut stream = Stream::new(1);
        let n = 100_000;
        let uniform: Vec<f64> = (0..n).map(|_| stream.within(3.0)).collect();
        assert!(uniform.iter().all(|x| (-3.0..3.0).contains(x)));
        let mean = uniform.iter().sum::<f64>() / f64::from(n);
        assert!(mean.abs() < 5.0 * (3.0_f64 / f64::from(n)).sqrt(), "{mean}");
        let normal: Vec<f64> = (0..n).map(|_| stream.normal()).collect();
        let variance = normal.iter().map(|x| x * x).sum::<f64>() / f64::from(n);
        assert!((variance - 1.0).abs() < 5.0 * (2.0 / f64::from(n)).sqrt(), "{variance}");
    }

    #[test]
    fn blocks_do_not_depend_on_threads() {
        let sums = |threads| {
            let run = Run { threads, ..Run::new(3 * BLOCK + 7, 42) };
            run.blocks(|stream, trials| (trials, (0..trials).map(|_| stream.unit()).sum::<f64>().to_bits()))
        };
        let one = sums(1);
        assert_eq!(one.iter().map(|(trials, _)| trials).sum::<u64>(), 3 * BLOCK + 7);
        assert_ne!(one[0], one[1]);
        for threads in [0, 2, 7] {
            assert_eq!(sums(threads), one);
        }
    }

    #[test]
    fn a_cancelled_run_keeps_what_is_done() {
        let cancel = AtomicBool::new(false);
        let progress = |done: u64| cancel.store(done >= 2 * BLOCK, Ordering::Relaxed);
        let run = Run { threads: 1, cancel: Some(&cancel), progress: Some(&progress), ..Run::new(100 * BLOCK, 1) };
        assert_eq!(run.blocks(|_, trials| trials), [BLOCK, BLOCK]);
    }
}
