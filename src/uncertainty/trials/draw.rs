//! Standard deviates of the inputs of every trial.
//!
//! Source: JCGM 101, 6.4. The distribution is normal if only a standard uncertainty is known (6.4.7), uniform between
//! limits (6.4.2), and scaled t if the uncertainty was estimated with few degrees of freedom (6.4.9).

use crate::student;
use crate::wide_random::{Column, WIDTH, WideRandom};

/// Place of a column of standard deviates; column 0 is all zeros.
pub type Slot = usize;

/// Distribution of one input.
#[derive(Debug, Clone)]
pub struct Input {
    /// `true` for the uniform distribution with the limits ±√3 u (JCGM 101, 6.4.2).
    pub uniform: bool,
    /// Indices of the estimates on which the variance rests, with their shares; empty if the variance is known.
    pub estimates: Vec<(usize, f64)>,
}

/// Inputs that are drawn, in the order of their columns.
#[derive(Debug, Clone)]
pub struct Draw {
    /// Distribution of each input.
    pub inputs: Vec<Input>,
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
        const ROOT_OF_THREE: f64 = 1.732_050_807_568_877_2;
        let mut waiting: Option<usize> = None;
        for (place, input) in self.inputs.iter().enumerate() {
            let slot = place + 1;
            match (input.uniform, waiting) {
                (true, _) => {
                    lanes.uniform(&mut deviates[slot]);
                    deviates[slot].iter_mut().for_each(|value| *value *= ROOT_OF_THREE);
                }
                (false, None) => waiting = Some(slot),
                (false, Some(first)) => {
                    let (before, after) = deviates.split_at_mut(slot);
                    lanes.normals(&mut before[first], &mut after[0]);
                    waiting = None;
                }
            }
        }
        if let Some(last) = waiting {
            let mut spare = [0.0; WIDTH];
            lanes.normals(&mut deviates[last], &mut spare);
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
        for (deviates, input) in drawn[1..].iter_mut().zip(&self.inputs) {
            if input.estimates.is_empty() {
                continue;
            }
            let mut variance = [0.0; WIDTH];
            for &(place, share) in &input.estimates {
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
