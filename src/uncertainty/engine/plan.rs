//! Which inputs are drawn in every trial, and from which distribution.
//!
//! Source: [JCGM 101](crate::bibliography::Bibliography::Jcgm101), 6.4: normal where a standard uncertainty is all that
//! is known (6.4.7), uniform between limits (6.4.2), scaled t where it was estimated with few degrees of freedom (6.4.9).

use super::{ReadingShape, student};
use crate::calibration::Setup;
use crate::calibration::causes::Repeats;
use crate::statistics::lanes::{Column, Lanes, WIDTH};
use nalgebra::Vector2;

/// A column of standard deviates by its place; place 0 is all zeros.
pub(crate) type Slot = usize;

/// What an input of the engine is. Normal inputs that turn the same thing about the same axis are one, their variances
/// added up: so there are fewer than in a budget.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drawn {
    /// A certified angle of the position of that place: 0, 1, 2 are α, β, γ.
    Angle(usize, usize),
    /// The return to the position of that place, about axis 0, 1, 2 of the case.
    Return(usize, usize),
    /// The own error of a current of the position of that place, 0 or 1.
    Current(usize, usize),
    /// Platform and seat, about axis 0, 1, 2 of the case.
    Case(usize),
    /// Base, level, azimuth and mark, about axis 0, 1, 2 of the base.
    Base(usize),
    /// Latitude and deflection.
    Latitude,
    /// The meter's gain.
    Gain,
    /// The meter's offset.
    Offset,
}

/// An input that is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawnInput {
    /// Which.
    pub what: Drawn,
    /// rad, mA, or a share.
    pub standard_uncertainty: f64,
    /// Of that uncertainty.
    pub degrees_of_freedom: f64,
    shape: ReadingShape,
}

/// All inputs that are drawn, in the order of their columns.
#[derive(Debug, Clone)]
pub struct Plan {
    inputs: Vec<DrawnInput>,
    /// Columns that are divided by the root of the same chi-square over its degrees of freedom.
    estimated: Vec<(f64, Vec<Slot>)>,
}

impl Plan {
    pub(crate) fn new(setup: &Setup, means_ma: &[Vector2<f64>], repeats: &Repeats, shape: ReadingShape) -> Self {
        let u = setup.uncertainty();
        let mut inputs = Vec::new();
        let mut add = |what, standard_uncertainty: f64, degrees_of_freedom, shape| {
            if standard_uncertainty > 0.0 {
                inputs.push(DrawnInput { what, standard_uncertainty, degrees_of_freedom, shape });
            }
        };
        let (normal, infinite) = (ReadingShape::Normal, f64::INFINITY);
        for place in 0..means_ma.len() {
            let known = u.angles_degrees_of_freedom.get(place).copied().unwrap_or(infinite);
            for (angle, u_rad) in u.angles_rad.get(place).copied().unwrap_or_default().into_iter().enumerate() {
                add(Drawn::Angle(place, angle), u_rad, known, normal);
            }
        }
        let of_mean: Vec<f64> =
            repeats.counts.iter().map(|count| (repeats.variance_factor / (*count).max(1) as f64).sqrt()).collect();
        for (place, share) in of_mean.iter().enumerate() {
            let known = u.repeatability_degrees_of_freedom.min(repeats.degrees_of_freedom);
            for axis in 0..3 {
                add(Drawn::Return(place, axis), u.repeatability_rad * share, known, normal);
            }
        }
        let hypot = |parts: [f64; 3]| libm::hypot(libm::hypot(parts[0], parts[1]), parts[2]);
        for axis in 0..3 {
            let case = libm::hypot(u.common_platform_rad, u.seating_rad[axis]);
            add(Drawn::Case(axis), case, infinite, normal);
            let base = match axis {
                2 => hypot([u.common_base_rad, u.azimuth_rad, u.mark_rad]),
                _ => libm::hypot(u.common_base_rad, u.level_rad),
            };
            add(Drawn::Base(axis), base, infinite, normal);
        }
        add(Drawn::Latitude, libm::hypot(u.latitude_rad, u.deflection_rad), infinite, normal);
        add(Drawn::Gain, u.meter.gain, infinite, normal);
        add(Drawn::Offset, u.meter.offset_ma, infinite, normal);
        for (place, (current_ma, share)) in means_ma.iter().zip(&of_mean).enumerate() {
            for axis in 0..2 {
                let own = u.meter.own_variance_ma2(current_ma[axis]).sqrt() * share;
                add(Drawn::Current(place, axis), own, repeats.degrees_of_freedom, shape);
            }
        }
        let estimated = estimated(&inputs);
        Self { inputs, estimated }
    }

    /// The inputs, in the order of their columns.
    pub fn inputs(&self) -> &[DrawnInput] {
        &self.inputs
    }

    /// Columns of standard deviates, the column of zeros among them.
    pub(crate) fn columns(&self) -> usize {
        self.inputs.len() + 1
    }

    /// Where the deviates of an input are, and its standard uncertainty; zeros for one that is not drawn.
    pub(crate) fn slot(&self, what: Drawn) -> (Slot, f64) {
        let found = self.inputs.iter().position(|input| input.what == what);
        found.map_or((0, 0.0), |place| (place + 1, self.inputs[place].standard_uncertainty))
    }

    /// Whether an input's deviates have no bound that matters: t has long tails.
    pub(crate) fn has_long_tails(&self) -> bool {
        !self.estimated.is_empty()
    }

    /// New standard deviates: variance 1, or of Student's t.
    #[inline(always)]
    pub(crate) fn draw(&self, lanes: &mut Lanes, deviates: &mut [Column]) {
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
        for (degrees_of_freedom, slots) in &self.estimated {
            student::scale(lanes, deviates, *degrees_of_freedom, slots);
        }
    }
}

/// Which columns rest on the same estimate of a standard uncertainty: all returns on one, all readings whose variance was
/// enlarged on one, every certified angle on its own.
fn estimated(inputs: &[DrawnInput]) -> Vec<(f64, Vec<Slot>)> {
    let mut groups: Vec<(f64, Vec<Slot>)> = Vec::new();
    let mut shared: [Option<usize>; 2] = [None; 2];
    for (place, input) in inputs.iter().enumerate().filter(|(_, input)| input.degrees_of_freedom.is_finite()) {
        let common = match input.what {
            Drawn::Return(..) => Some(0),
            Drawn::Current(..) => Some(1),
            _ => None,
        };
        match common.and_then(|kind| shared[kind]) {
            Some(group) => groups[group].1.push(place + 1),
            None => {
                if let Some(kind) = common {
                    shared[kind] = Some(groups.len());
                }
                groups.push((input.degrees_of_freedom, vec![place + 1]));
            }
        }
    }
    groups
}
