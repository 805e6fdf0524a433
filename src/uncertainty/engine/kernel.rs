//! Constants and inputs of every position, for the trials.

use super::plan::{BASE_AT_SITE, Plan};
use crate::calibration::{Cause, Setup};
use dtg_passport_trials::elementary::SMALL_RAD;
use dtg_passport_trials::kernel::{Kernel, Place, Scaled};
use nalgebra::Vector2;

/// Largest normal deviate that is drawn.
const LARGEST_NORMAL: f64 = 8.5;

/// Returns the model of all positions.
pub(super) fn kernel(setup: &Setup, means_ma: &[Vector2<f64>], plan: &Plan) -> Kernel {
    let earth = setup.earth_rate_east_north_up();
    let each = setup.coefficients().positions.iter().zip(&setup.turns).zip(means_ma);
    let places: Vec<Place> = each
        .map(|((at, turn), means_ma)| {
            let certified = turn.certified;
            let angles_rad = [certified.alpha_rad, certified.beta_rad, certified.gamma_rad];
            Place {
                sin_cos: angles_rad.map(libm::sincos),
                certified_rad: angles_rad,
                vertical: turn.nominal.column(2).into_owned().into(),
                earth: (turn.nominal * earth).into(),
                nominal: turn.nominal.transpose().into(),
                angles: [0, 1, 2].map(|angle| plan.slot(Cause::Angle(at.index, angle))),
                returns: [0, 1, 2].map(|axis| plan.slot(Cause::Return(at.index, axis))),
                means_ma: (*means_ma).into(),
                currents: [0, 1].map(|axis| plan.slot(Cause::Reading(at.index, axis))),
                noise: [0, 1].map(|axis| plan.slot(Cause::Noise(at.index, axis))),
                visits: [0, 1].map(|axis| plan.slot(Cause::Visits(at.index, axis))),
            }
        })
        .collect();
    let case = [0, 1, 2].map(|axis| [Cause::Seat(axis), Cause::Platform(axis)].map(|cause| plan.slot(cause)));
    let base = [0, 1, 2].map(|axis| [BASE_AT_SITE[axis], Cause::Base(axis)].map(|cause| plan.slot(cause)));
    let latitude = plan.slot(Cause::Latitude);
    let drawn = |inputs: &[Scaled]| inputs.iter().any(|(slot, _)| *slot > 0);
    let case_turns = drawn(case.as_flattened()) || places.iter().any(|place| drawn(&place.returns));
    let base_turns = drawn(base.as_flattened()) || drawn(&[latitude]);
    // The vector of a rotation is at most the sum of its parts, each at most √3 times its largest component.
    let largest = places
        .iter()
        .flat_map(|place| place.angles.iter().chain(&place.returns))
        .chain(case.as_flattened())
        .chain(base.as_flattened());
    let largest = largest.chain([&latitude]).fold(0.0, |largest: f64, (_, u)| largest.max(*u));
    let may_be_large = plan.draw.has_long_tails() || 4.0 * LARGEST_NORMAL * largest > SMALL_RAD;
    let (gain, offset) = (plan.slot(Cause::Gain), plan.slot(Cause::Offset));
    let turn_on = [0, 1].map(|axis| plan.slot(Cause::TurnOn(axis)));
    let scale = [0, 1].map(|axis| [0, 1].map(|column| plan.slot(Cause::Scale(2 * axis + column))));
    let drifts = drawn(&turn_on) || drawn(scale.as_flattened()) || places.iter().any(|place| drawn(&place.visits));
    Kernel {
        places,
        case,
        base,
        latitude,
        gain,
        offset,
        turn_on,
        scale,
        drifts,
        earth: earth.into(),
        case_turns,
        base_turns,
        may_be_large,
    }
}
