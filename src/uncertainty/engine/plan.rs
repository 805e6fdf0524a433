//! Inputs that are drawn in every trial, with their distributions.
//!
//! Source: [JCGM 101](crate::bibliography::Bibliography::Jcgm101), 6.4. The distribution is normal if only a standard
//! uncertainty is known (6.4.7), uniform between limits (6.4.2), and scaled t if the uncertainty was estimated with few
//! degrees of freedom (6.4.9).

use super::{ReadingShape, student};
use crate::calibration::Setup;
use crate::calibration::estimates::{Basis, Estimates};
use crate::calibration::repeats::Repeats;
use crate::statistics::wide_random::{Column, WIDTH, WideRandom};
use nalgebra::Vector2;

/// Place of a column of standard deviates; column 0 is all zeros.
pub(crate) type Slot = usize;

/// Kind of an input of the engine.
///
/// Normal inputs that rotate the same part about the same axis are combined into one with the sum of their variances,
/// so there are fewer inputs than in a budget.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Drawn {
    /// Certified angle of the position at a place: 0, 1, 2 are α, β, γ.
    Angle(usize, usize),
    /// Repeatability of the position at a place, about axis 0, 1, 2 of the case.
    Return(usize, usize),
    /// Specification of the meter for a current (0 or 1) of the position at a place.
    Current(usize, usize),
    /// Noise of the readings of a current (0 or 1) of the position at a place, in their mean.
    Noise(usize, usize),
    /// Gyro noise of the position at a place, in the mean of its visits, about axis 0 or 1 of the case.
    Visits(usize, usize),
    /// Mean of the turn-ons, about axis 0 or 1 of the case.
    TurnOn(usize),
    /// Platform and seat, about axis 0, 1, 2 of the case.
    Case(usize),
    /// Platform alone, if its uncertainty is an estimate with few degrees of freedom.
    Platform(usize),
    /// Base, level, azimuth and mark, about axis 0, 1, 2 of the base.
    Base(usize),
    /// Base of the stand alone, if its uncertainty is an estimate with few degrees of freedom.
    StandBase(usize),
    /// Latitude and deflection.
    Latitude,
    /// Gain of the meter.
    Gain,
    /// Offset of the meter.
    Offset,
}

/// Input that is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DrawnInput {
    /// Kind of the input.
    pub what: Drawn,
    /// Standard uncertainty: rad, mA, or a share.
    pub standard_uncertainty: f64,
    /// Degrees of freedom of that uncertainty.
    pub degrees_of_freedom: f64,
    basis: Basis,
    shape: ReadingShape,
}

/// Inputs that are drawn, in the order of their columns.
#[derive(Debug, Clone)]
pub(crate) struct Plan {
    pub(crate) inputs: Vec<DrawnInput>,
    /// Degrees of freedom of the estimates that some inputs depend on.
    estimates: Vec<f64>,
}

impl Plan {
    pub(crate) fn new(setup: &Setup, means_ma: &[Vector2<f64>], repeats: &Repeats, shape: ReadingShape) -> Self {
        let u = setup.uncertainty();
        let estimates = Estimates::new(setup, repeats);
        let mut inputs = Vec::new();
        let mut add = |what, standard_uncertainty: f64, basis, shape| {
            if standard_uncertainty > 0.0 {
                let degrees_of_freedom = estimates.degrees_of_freedom(basis);
                inputs.push(DrawnInput { what, standard_uncertainty, degrees_of_freedom, basis, shape });
            }
        };
        let normal = ReadingShape::Normal;
        for place in 0..means_ma.len() {
            for (angle, u_rad) in u.angles_rad.get(place).copied().unwrap_or_default().into_iter().enumerate() {
                add(Drawn::Angle(place, angle), u_rad, estimates.angles[place][angle], normal);
            }
        }
        for place in 0..means_ma.len() {
            let of_mean = u.repeatability_rad * repeats.return_share(place).sqrt();
            for axis in 0..3 {
                add(Drawn::Return(place, axis), of_mean, estimates.returns, normal);
            }
        }
        // A part that is known exactly is drawn together with the inputs that act in the same way.
        let known = |u: f64, basis| if basis == Basis::Known { (u, 0.0) } else { (0.0, u) };
        let (platform, platform_alone) = known(u.common_platform_rad, estimates.platform);
        let (base, base_alone) = known(u.common_base_rad, estimates.base);
        for axis in 0..3 {
            add(Drawn::Case(axis), libm::hypot(platform, u.seating_rad[axis]), Basis::Known, normal);
            add(Drawn::Platform(axis), platform_alone, estimates.platform, normal);
            let own = if axis == 2 { libm::hypot(u.azimuth_rad, u.mark_rad) } else { u.level_rad };
            add(Drawn::Base(axis), libm::hypot(base, own), Basis::Known, normal);
            add(Drawn::StandBase(axis), base_alone, estimates.base, normal);
        }
        add(Drawn::Latitude, libm::hypot(u.latitude_rad, u.deflection_rad), Basis::Known, normal);
        add(Drawn::Gain, u.meter.gain, Basis::Known, normal);
        add(Drawn::Offset, u.meter.offset_ma, Basis::Known, normal);
        for (place, current_ma) in means_ma.iter().enumerate() {
            let noise = repeats.noise_variance_ma2(place).sqrt();
            for axis in 0..2 {
                let own = u.meter.own_variance_ma2(current_ma[axis]).sqrt();
                add(Drawn::Current(place, axis), own, Basis::Known, shape);
                add(Drawn::Noise(place, axis), noise, estimates.noise, normal);
                add(Drawn::Visits(place, axis), repeats.drift_variance(place).sqrt(), estimates.visits, normal);
            }
        }
        for axis in 0..2 {
            add(Drawn::TurnOn(axis), repeats.turn_on_of_mean_deg_per_h(), estimates.turn_ons, normal);
        }
        Self { inputs, estimates: estimates.degrees_of_freedom }
    }

    /// Returns the number of columns of standard deviates, including the column of zeros and one for each estimate.
    pub(crate) fn columns(&self) -> usize {
        self.inputs.len() + 1 + self.estimates.len()
    }

    /// Returns the column of an input's deviates and its standard uncertainty; zeros if it is not drawn.
    pub(crate) fn slot(&self, what: Drawn) -> (Slot, f64) {
        let found = self.inputs.iter().position(|input| input.what == what);
        found.map_or((0, 0.0), |place| (place + 1, self.inputs[place].standard_uncertainty))
    }

    /// Returns `true` if some deviates have no practical bound, because t has long tails.
    pub(crate) fn has_long_tails(&self) -> bool {
        !self.estimates.is_empty()
    }

    /// Draws new standard deviates: with variance 1, or by Student's t.
    #[inline(always)]
    pub(crate) fn draw(&self, lanes: &mut WideRandom, deviates: &mut [Column]) {
        const ROOT_OF_THREE: f64 = 1.732_050_807_568_877_2;
        let mut waiting: Option<usize> = None;
        for (place, input) in self.inputs.iter().enumerate() {
            let slot = place + 1;
            match (input.shape, waiting) {
                (ReadingShape::Uniform, _) => {
                    lanes.uniform(&mut deviates[slot]);
                    deviates[slot].iter_mut().for_each(|value| *value *= ROOT_OF_THREE);
                }
                (ReadingShape::Normal, None) => waiting = Some(slot),
                (ReadingShape::Normal, Some(first)) => {
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
            if input.basis == Basis::Known {
                continue;
            }
            let mut variance = [0.0; WIDTH];
            for (place, share) in input.basis.shares() {
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
