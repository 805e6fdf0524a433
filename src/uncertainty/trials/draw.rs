//! Standard deviates of the inputs of every trial.
//!
//! Source: JCGM 101, 6.4. The distribution is normal if only a standard uncertainty is known (6.4.7), and scaled t if the
//! uncertainty was estimated with few degrees of freedom (6.4.9).

use crate::student;
use crate::wide_random::{Column, WIDTH, WideRandom};

/// Place of a column of standard deviates; column 0 is all zeros.
pub type Slot = usize;

/// Inputs that are drawn, in the order of their columns.
#[derive(Debug, Clone)]
pub struct Draw {
    /// For each input: indices of the estimates on which the variance rests, with their shares; empty if it is known.
    pub inputs: Vec<Vec<(usize, f64)>>,
    /// Degrees of freedom of the estimates that some inputs depend on.
    pub estimates: Vec<f64>,
}

impl Draw {
    /// Returns the number of columns of standard deviates, including the column of zeros and one for each estimate.
    pub fn columns(&self) -> usize {
        self.inputs.len() + 1 + self.estimates.len()
    }

    /// Returns `true` if some deviates have no practical bound, because t has long tails.
    pub fn has_long_tails(&self) -> bool {
        !self.estimates.is_empty()
    }

    /// Draws new standard deviates: with variance 1, or by Student's t.
    #[inline(always)]
    pub fn draw(&self, lanes: &mut WideRandom, deviates: &mut [Column]) {
        let mut spare = [0.0; WIDTH];
        for pair in deviates[1..=self.inputs.len()].chunks_mut(2) {
            match pair {
                [one, other] => lanes.normals(one, other),
                [last] => lanes.normals(last, &mut spare),
                _ => {}
            }
        }
        if self.has_long_tails() {
            self.scale(lanes, deviates);
        }
    }

    /// Scales inputs that depend on estimates to Student's t, with one χ² per trial for all inputs of one estimate.
    #[inline(always)]
    fn scale(&self, lanes: &mut WideRandom, deviates: &mut [Column]) {
        let (drawn, factors) = deviates.split_at_mut(self.inputs.len() + 1);
        for (factor, degrees_of_freedom) in factors.iter_mut().zip(&self.estimates) {
            student::variance(lanes, factor, *degrees_of_freedom);
        }
        for (deviates, estimates) in drawn[1..].iter_mut().zip(&self.inputs) {
            if estimates.is_empty() {
                continue;
            }
            let mut variance = [0.0; WIDTH];
            for &(place, share) in estimates {
                for trial in 0..WIDTH {
                    variance[trial] += share * factors[place][trial];
                }
            }
            for trial in 0..WIDTH {
                deviates[trial] *= variance[trial].sqrt();
            }
        }
    }
}
