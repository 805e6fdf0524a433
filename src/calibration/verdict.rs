//! A result against the specification of the gyro's type, and against an earlier result.
//!
//! Decisions by simple acceptance and by guarded acceptance with a guard band of one expanded uncertainty
//! ([JCGM 106](crate::bibliography::Bibliography::Jcgm106), 8.2 and 8.3; ILAC-G8), with the specific risk (7.3).

use super::parameter::Parameter;
use crate::gyro::{GyroParameters, GyroType};
use crate::statistics::distributions::normal_below;
use serde::Serialize;

/// Expanded uncertainty is this many standard uncertainties.
pub(crate) const COVERAGE_FACTOR: f64 = 2.0;

/// The parameters that are drifts per g.
const PER_G: [Parameter; 2] = [Parameter::OmegaG, Parameter::OmegaK];

/// A decision.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Decision {
    /// Within tolerance.
    Pass,
    /// Not within tolerance.
    Fail,
    /// Cannot be decided with this uncertainty.
    Undecided,
}

/// A result against a specification.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// Fail when a parameter fails by guarded acceptance, pass when all pass so, else undecided.
    pub overall: Decision,
    /// The type's g, at which drifts are compared, m/s².
    pub gravity_m_per_s2: f64,
    /// Parameter by parameter.
    pub parameters: Vec<ParameterVerdict>,
}

/// One parameter against its tolerance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ParameterVerdict {
    /// Which one.
    pub parameter: &'static str,
    /// Value found, in the parameter's own unit, drifts at the type's g.
    pub value: f64,
    /// Nominal or earlier value, likewise.
    pub reference_value: f64,
    /// Standard uncertainty of their difference, likewise.
    pub standard_uncertainty: f64,
    /// Unit of the four numbers that follow: percent of the nominal value for scale factors.
    pub unit: &'static str,
    /// Found less nominal, or found less earlier.
    pub deviation: f64,
    /// Largest deviation allowed, either way.
    pub tolerance: f64,
    /// Two standard uncertainties of the deviation.
    pub expanded_uncertainty: f64,
    /// Part of the expanded uncertainty that comes from the local g, by which drifts were brought to the type's g;
    /// absent where none does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub expanded_uncertainty_from_gravity: Option<f64>,
    /// By simple acceptance: whether the deviation is within the tolerance.
    pub simple: Decision,
    /// By guarded acceptance: whether it is within, or outside, by more than the expanded uncertainty.
    pub guarded: Decision,
    /// Probability that the simple decision is wrong.
    pub specific_risk: f64,
}

impl ParameterVerdict {
    /// Returns `true` if more than half of the variance comes from the local g.
    pub(crate) fn is_mostly_from_gravity(&self) -> bool {
        let of_gravity = self.expanded_uncertainty_from_gravity.unwrap_or(0.0);
        2.0 * of_gravity * of_gravity > self.expanded_uncertainty * self.expanded_uncertainty
    }
}

/// Values and standard uncertainties of the eight parameters at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// The parameters, drifts per local g.
    pub parameters: GyroParameters,
    /// Standard uncertainties in the order of [`Parameter::EIGHT`].
    pub standard_uncertainty: [f64; 8],
    /// The local g.
    pub gravity_m_per_s2: f64,
    /// Its standard uncertainty.
    pub gravity_u_m_per_s2: f64,
}

impl Found {
    /// With g-sensitive drifts per `gravity_m_per_s2` exactly, instead of the local g: the drift per m/s² is the gyro's
    /// own, and how well the local g is known enters here.
    #[must_use]
    pub(crate) fn at_gravity(&self, gravity_m_per_s2: f64) -> Self {
        let ratio = gravity_m_per_s2 / self.gravity_m_per_s2;
        let mut values = self.parameters.to_vector();
        let mut standard_uncertainty = self.standard_uncertainty;
        for parameter in PER_G {
            let place = parameter.place();
            standard_uncertainty[place] =
                ratio * libm::hypot(standard_uncertainty[place], self.u_from_gravity(parameter));
            values[place] *= ratio;
        }
        let parameters = GyroParameters::from_vector(&values);
        Self { parameters, standard_uncertainty, gravity_m_per_s2, gravity_u_m_per_s2: 0.0 }
    }

    /// The standard uncertainty that the local g adds to a parameter which is brought to another g; 0 where it has no part.
    fn u_from_gravity(&self, parameter: Parameter) -> f64 {
        let value = if PER_G.contains(&parameter) { self.parameters.to_vector()[parameter.place()] } else { 0.0 };
        value.abs() * self.gravity_u_m_per_s2 / self.gravity_m_per_s2
    }

    /// The same with the local g taken as exact: a change between two results under the same g does not depend on it.
    fn under_the_same_gravity(&self, other: &Self) -> Self {
        let same = self.gravity_m_per_s2 == other.gravity_m_per_s2;
        Self { gravity_u_m_per_s2: if same { 0.0 } else { self.gravity_u_m_per_s2 }, ..*self }
    }
}

/// A result against the specification of a type.
pub fn against_type(found: &Found, gyro_type: &GyroType) -> Verdict {
    let nominal = Found {
        parameters: gyro_type.nominal.to_model(),
        standard_uncertainty: [0.0; 8],
        gravity_m_per_s2: gyro_type.gravity(),
        gravity_u_m_per_s2: 0.0,
    };
    compare(found, &nominal, gyro_type)
}

/// The change since an earlier result, against the tolerance of the type: the paper's tolerance is an instability.
///
/// The two results count as independent. Where they share a stand, its part in both uncertainties is the same and does
/// not change: what is said here is then on the cautious side.
pub fn against_earlier(found: &Found, earlier: &Found, gyro_type: &GyroType) -> Verdict {
    compare(&found.under_the_same_gravity(earlier), &earlier.under_the_same_gravity(found), gyro_type)
}

/// Compares two results, brought to the type's g, in the order of the paper's table.
fn compare(found: &Found, reference: &Found, gyro_type: &GyroType) -> Verdict {
    let gravity_m_per_s2 = gyro_type.gravity();
    let sides = [found, reference];
    let at_type = sides.map(|side| side.at_gravity(gravity_m_per_s2));
    let parameters = Parameter::AS_IN_THE_PAPER.map(|parameter| {
        let values = at_type.map(|side| side.parameters.to_vector()[parameter.place()]);
        let [u, other] = at_type.map(|side| side.standard_uncertainty[parameter.place()]);
        let from_gravity = sides.map(|side| side.u_from_gravity(parameter) * gravity_m_per_s2 / side.gravity_m_per_s2);
        let from_gravity = libm::hypot(from_gravity[0], from_gravity[1]);
        judge(parameter, values, [libm::hypot(u, other), from_gravity], gyro_type)
    });
    Verdict::of(gravity_m_per_s2, parameters.into())
}

/// The change of each parameter since an earlier result, in units of the change's standard uncertainty, in the order of
/// [`Parameter::EIGHT`]; drifts brought to the same g.
pub(crate) fn change_in_uncertainties(found: &Found, earlier: &Found) -> [f64; 8] {
    let gravity = found.gravity_m_per_s2;
    let brought = |one: &Found, other: &Found| one.under_the_same_gravity(other).at_gravity(gravity);
    let (found, earlier) = (brought(found, earlier), brought(earlier, found));
    let (now, before) = (found.parameters.to_vector(), earlier.parameters.to_vector());
    std::array::from_fn(|place| {
        (now[place] - before[place])
            / libm::hypot(found.standard_uncertainty[place], earlier.standard_uncertainty[place])
    })
}

impl Verdict {
    fn of(gravity_m_per_s2: f64, parameters: Vec<ParameterVerdict>) -> Self {
        let all = |decision| parameters.iter().all(|parameter| parameter.guarded == decision);
        let overall = if parameters.iter().any(|parameter| parameter.guarded == Decision::Fail) {
            Decision::Fail
        } else if all(Decision::Pass) {
            Decision::Pass
        } else {
            Decision::Undecided
        };
        Self { overall, gravity_m_per_s2, parameters }
    }
}

/// Judges a value against a reference value; of their difference, the standard uncertainty `u` and what the local g has in
/// it; all in the parameter's own unit.
fn judge(
    parameter: Parameter,
    [value, reference_value]: [f64; 2],
    [u, from_gravity]: [f64; 2],
    gyro_type: &GyroType,
) -> ParameterVerdict {
    let tolerance = &gyro_type.tolerance;
    let limit = match parameter {
        Parameter::Kx | Parameter::Ky => tolerance.k_main_percent,
        Parameter::Kxy | Parameter::Kyx => tolerance.k_cross_percent,
        Parameter::Omega0x | Parameter::Omega0y => tolerance.omega0_deg_per_h,
        Parameter::OmegaG => tolerance.omega_g_deg_per_h_per_g,
        Parameter::OmegaK | Parameter::Anisoelasticity => tolerance.omega_k_deg_per_h_per_g,
    };
    let nominal = gyro_type.nominal.to_model().to_vector().get(parameter.place()).copied().unwrap_or(0.0);
    let is_scale_factor = parameter.place() < 4;
    // A percentage of a nominal value of 0 is 0.
    let (unit, limit, scale) = match (is_scale_factor, nominal == 0.0) {
        (true, false) => ("%", limit, 100.0 / nominal.abs()),
        (true, true) => (parameter.unit(), 0.0, 1.0),
        (false, _) => (parameter.unit(), limit, 1.0),
    };
    let deviation = (value - reference_value) * scale;
    let (simple, guarded, specific_risk) = decide(deviation, u * scale, limit);
    ParameterVerdict {
        parameter: parameter.key(),
        value,
        reference_value,
        standard_uncertainty: u,
        unit,
        deviation,
        tolerance: limit,
        expanded_uncertainty: COVERAGE_FACTOR * u * scale,
        expanded_uncertainty_from_gravity: (from_gravity > 0.0).then_some(COVERAGE_FACTOR * from_gravity),
        simple,
        guarded,
        specific_risk,
    }
}

/// Decides by simple and by guarded acceptance, with the probability that the simple decision is wrong.
fn decide(deviation: f64, u: f64, limit: f64) -> (Decision, Decision, f64) {
    let expanded_uncertainty = COVERAGE_FACTOR * u;
    let within = deviation.abs() <= limit;
    let guarded = if deviation.abs() + expanded_uncertainty <= limit {
        Decision::Pass
    } else if deviation.abs() - expanded_uncertainty > limit {
        Decision::Fail
    } else {
        Decision::Undecided
    };
    // Each tail by itself, so that a small risk keeps its digits.
    let outside = normal_below((-limit - deviation) / u) + normal_below((deviation - limit) / u);
    let inside = if deviation > 0.0 {
        normal_below((limit - deviation) / u) - normal_below((-limit - deviation) / u)
    } else {
        normal_below((limit + deviation) / u) - normal_below((deviation - limit) / u)
    };
    let specific_risk = match (u > 0.0, within) {
        (false, _) => 0.0,
        (true, true) => outside,
        (true, false) => inside,
    };
    (if within { Decision::Pass } else { Decision::Fail }, guarded, specific_risk)
}
