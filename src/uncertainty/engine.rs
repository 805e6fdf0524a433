//! Engine of the Monte Carlo: what is drawn, and the model of one calibration. The crate `dtg-passport-trials` runs it;
//! no value in a passport is computed there.
//!
//! Source: [JCGM 101](crate::bibliography::Bibliography::Jcgm101), 6.4. The distribution is normal if only a standard
//! uncertainty is known (6.4.7), and scaled t if the uncertainty was estimated with few degrees of freedom (6.4.9).

use crate::calibration::data::Observation;
use crate::calibration::estimates::Estimates;
use crate::calibration::procedure::{observe, response};
use crate::calibration::repeats::Repeats;
use crate::calibration::{Basis, Cause, Input, Method, MethodRefusal, NoAnalyticSolution, Options, Readings, Setup};
use dtg_passport_trials::draw::{Draw, Slot};
use dtg_passport_trials::elementary::SMALL_RAD;
use dtg_passport_trials::kernel::{Kernel, Place, Scaled};
pub(crate) use dtg_passport_trials::{BLOCK, PAIRS, PARAMETERS, pair};
use dtg_passport_trials::{Computation, Solver, refit::Refit};
use nalgebra::{Matrix2, Vector2};

/// Largest normal deviate that is drawn.
const LARGEST_NORMAL: f64 = 8.5;

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
    pub fn new(setup: &Setup, readings: &Readings, method: Method) -> Result<Self, MethodRefusal> {
        let setup = &*setup.of_readings(readings);
        let observation = observe(setup, readings, method, &Options::default())?;
        response(setup, &observation, method)?;
        let Observation { data, fit, .. } = observation;
        if !data.offsets.are_balanced() {
            return Err(MethodRefusal::NotThisModel);
        }
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
        let plan = Plan::new(setup, &means_ma, &data.repeats);
        let kernel = kernel(setup, &means_ma, &plan);
        Ok(Self {
            computation: Computation { draw: plan.draw, kernel, solver },
            #[cfg(test)]
            inputs: plan.inputs,
        })
    }
}

/// Causes at the site that add to [`Cause::Base`] about the axes east, north and up: level, level, and azimuth with the
/// mark.
pub(crate) const BASE_AT_SITE: [Cause; 3] = [Cause::Level(0), Cause::Level(1), Cause::Azimuth];

/// Inputs that are drawn, in the order of their columns.
#[derive(Debug, Clone)]
struct Plan {
    /// Normal inputs that rotate the same part about the same axis are combined into one with the sum of their variances,
    /// so there are fewer inputs than in a budget: the seat takes the platform with it, and what the base adds at its site
    /// takes the base of the stand, unless that uncertainty is an estimate with few degrees of freedom. A reading is
    /// drawn with its floor, the latitude with the deflection.
    inputs: Vec<Input>,
    /// Distribution of each input.
    draw: Draw,
}

impl Plan {
    fn new(setup: &Setup, means_ma: &[Vector2<f64>], repeats: &Repeats) -> Self {
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
        let drawn = inputs.iter().map(|input| input.basis.shares().collect());
        Self { draw: Draw { inputs: drawn.collect(), estimates: estimates.degrees_of_freedom }, inputs }
    }

    /// Returns the column of an input's deviates and its standard uncertainty; zeros if it is not drawn.
    fn slot(&self, cause: Cause) -> (Slot, f64) {
        let found = self.inputs.iter().position(|input| input.cause == cause);
        found.map_or((0, 0.0), |place| (place + 1, self.inputs[place].standard_uncertainty))
    }
}

/// Returns the model of all positions.
fn kernel(setup: &Setup, means_ma: &[Vector2<f64>], plan: &Plan) -> Kernel {
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
