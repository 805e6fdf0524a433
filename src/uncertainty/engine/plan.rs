//! Inputs that are drawn in every trial, with their distributions.
//!
//! Source: [JCGM 101](crate::bibliography::Bibliography::Jcgm101), 6.4. The distribution is normal if only a standard
//! uncertainty is known (6.4.7), uniform between limits (6.4.2), and scaled t if the uncertainty was estimated with few
//! degrees of freedom (6.4.9).

use super::ReadingShape;
use crate::calibration::estimates::Estimates;
use crate::calibration::repeats::Repeats;
use crate::calibration::{Basis, Cause, Input, Setup};
use dtg_passport_trials::draw::{Draw, Input as Drawn, Slot};
use nalgebra::Vector2;

/// Causes at the site that add to [`Cause::Base`] about the axes east, north and up: level, level, and azimuth with the
/// mark.
pub(crate) const BASE_AT_SITE: [Cause; 3] = [Cause::Level(0), Cause::Level(1), Cause::Azimuth];

/// Inputs that are drawn, in the order of their columns.
#[derive(Debug, Clone)]
pub(crate) struct Plan {
    /// Normal inputs that rotate the same part about the same axis are combined into one with the sum of their variances,
    /// so there are fewer inputs than in a budget: the seat takes the platform with it, and what the base adds at its site
    /// takes the base of the stand, unless that uncertainty is an estimate with few degrees of freedom. A reading is
    /// drawn with its floor, the latitude with the deflection.
    pub(crate) inputs: Vec<Input>,
    /// Distribution of each input.
    pub(crate) draw: Draw,
}

impl Plan {
    pub(crate) fn new(setup: &Setup, means_ma: &[Vector2<f64>], repeats: &Repeats, shape: ReadingShape) -> Self {
        let u = setup.uncertainty();
        let estimates = Estimates::new(setup, repeats);
        let mut inputs = Vec::new();
        let mut add = |cause, u: f64, basis| inputs.extend(estimates.input(cause, u, basis));
        let positions = &setup.coefficients().positions;
        for (place, at) in positions.iter().enumerate() {
            for (angle, u_rad) in u.angles_rad.get(place).copied().unwrap_or_default().into_iter().enumerate() {
                add(Cause::Angle(at.index, angle), u_rad, estimates.angles[place][angle]);
            }
        }
        for (place, at) in positions.iter().enumerate() {
            let of_mean = u.repeatability_rad * repeats.return_share(place).sqrt();
            for axis in 0..3 {
                add(Cause::Return(at.index, axis), of_mean, estimates.returns);
            }
        }
        // A part that is known exactly is drawn together with the inputs that act in the same way.
        let known = |u: f64, basis| if basis == Basis::Known { (u, 0.0) } else { (0.0, u) };
        let (platform, platform_alone) = known(u.common_platform_rad, estimates.platform);
        let (base, base_alone) = known(u.common_base_rad, estimates.base);
        for (axis, of_base) in BASE_AT_SITE.into_iter().enumerate() {
            add(Cause::Seat(axis), libm::hypot(platform, u.seating_rad[axis]), Basis::Known);
            add(Cause::Platform(axis), platform_alone, estimates.platform);
            let own = if axis == 2 { libm::hypot(u.azimuth_rad, u.mark_rad) } else { u.level_rad };
            add(of_base, libm::hypot(base, own), Basis::Known);
            add(Cause::Base(axis), base_alone, estimates.base);
        }
        add(Cause::Latitude, libm::hypot(u.latitude_rad, u.deflection_rad), Basis::Known);
        add(Cause::Gain, u.meter.gain, Basis::Known);
        add(Cause::Offset, u.meter.offset_ma, Basis::Known);
        for (place, (at, current_ma)) in positions.iter().zip(means_ma).enumerate() {
            let noise = repeats.noise_variance_ma2(place).sqrt();
            for axis in 0..2 {
                let own = u.meter.own_variance_ma2(current_ma[axis]).sqrt();
                add(Cause::Reading(at.index, axis), own, Basis::Known);
                add(Cause::Noise(at.index, axis), noise, estimates.noise);
                add(Cause::Visits(at.index, axis), repeats.drift_variance(place).sqrt(), estimates.visits);
            }
        }
        for axis in 0..2 {
            add(Cause::TurnOn(axis), repeats.turn_on_of_mean_deg_per_h(), estimates.turn_ons);
        }
        for (element, basis) in estimates.scale.into_iter().enumerate() {
            add(Cause::Scale(element), repeats.scale_of_mean(element), basis);
        }
        let drawn = inputs.iter().map(|input| Drawn {
            uniform: shape == ReadingShape::Uniform && matches!(input.cause, Cause::Reading(..)),
            estimates: input.basis.shares().collect(),
        });
        Self { draw: Draw { inputs: drawn.collect(), estimates: estimates.degrees_of_freedom }, inputs }
    }

    /// Returns the column of an input's deviates and its standard uncertainty; zeros if it is not drawn.
    pub(crate) fn slot(&self, cause: Cause) -> (Slot, f64) {
        let found = self.inputs.iter().position(|input| input.cause == cause);
        found.map_or((0, 0.0), |place| (place + 1, self.inputs[place].standard_uncertainty))
    }
}
