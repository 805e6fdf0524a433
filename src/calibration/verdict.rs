//! Comparison of a result with the specification of the gyro type, and with an earlier result.
//!
//! Decisions are made by the rule of the gyro type: simple acceptance, or guarded acceptance with a guard band of a part of
//! the expanded uncertainty ([JCGM 106](crate::bibliography::Bibliography::Jcgm106), 8.2 and 8.3; ILAC-G8), with the
//! specific risk (7.3). The coverage factor is 2, or that of Student's t for the same probability, if the uncertainty rests
//! on few degrees of freedom ([JCGM 100](crate::bibliography::Bibliography::Gum), G.3).

use super::parameter::Parameter;
use crate::gyro::{DecisionRule, GyroParameters, GyroType, Rule};
use crate::statistics::student::{effective_degrees_of_freedom, student_beyond, student_factor};
use crate::wording::Words;
use crate::wording::number::Number;
use crate::wording::texts::comparison;
use serde::Serialize;

/// Coverage factor of expanded uncertainties with unlimited degrees of freedom.
pub(crate) const COVERAGE_FACTOR: f64 = 2.0;

/// Probability that a normal variable is farther from its mean than [`COVERAGE_FACTOR`] standard deviations.
pub(crate) const BEYOND: f64 = 0.045_500_263_896_358_42;

/// The parameters that refer to a value of g.
pub(crate) const PER_G: [Parameter; 2] = [Parameter::OmegaG, Parameter::OmegaK];

/// Decision on conformity with a tolerance, from the best to the worst.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Decision {
    /// Conformity: within tolerance.
    Pass,
    /// No decision is possible with this uncertainty.
    Undecided,
    /// Nonconformity: not within tolerance.
    Fail,
}

/// Comparison of a result with a specification or an earlier result.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// Overall decision: fail if a parameter fails, pass if all eight pass, otherwise undecided.
    pub overall: Decision,
    /// Rule of the decisions.
    pub rule: DecisionRule,
    /// Value of g to which the drifts of the type refer and at which drifts are compared, m/s².
    pub gravity_m_per_s2: f64,
    /// Decisions, one for each parameter; the general model has no ω_g and ω_k.
    pub parameters: Vec<ParameterVerdict>,
    /// `true` if no statement of conformity is made, because the parameters are not valid or rest on a passport that was
    /// not verified. Decisions and risks then have no meaning.
    #[serde(skip)]
    pub(crate) withheld: bool,
}

/// Comparison of one parameter with its tolerance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ParameterVerdict {
    /// Parameter compared with its tolerance.
    pub parameter: Parameter,
    /// Value found, in the unit of the parameter; drifts at the type's g.
    pub value: f64,
    /// Nominal or earlier value, in the unit of the parameter; drifts at the type's g.
    pub reference_value: f64,
    /// Standard uncertainty of the difference of the two values, in the unit of the parameter.
    pub standard_uncertainty: f64,
    /// Unit of the deviation, the tolerance and the expanded uncertainties; percent of the nominal value for scale
    /// factors whose tolerance is in percent.
    pub unit: &'static str,
    /// Deviation: value found minus nominal or earlier value.
    pub deviation: f64,
    /// Part of the deviation that comes from converting g-sensitive drifts from the local g to the type's g; absent for other
    /// parameters.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub conversion_of_g: Option<f64>,
    /// Tolerance: largest permitted deviation, in either direction.
    pub tolerance: f64,
    /// Expanded uncertainty of the deviation.
    pub expanded_uncertainty: f64,
    /// Coverage factor of the expanded uncertainties: 2, or more with few degrees of freedom.
    pub coverage_factor: f64,
    /// Part of the expanded uncertainty from the local g, with which drifts were converted to the type's g; absent if
    /// there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub expanded_uncertainty_from_gravity: Option<f64>,
    /// Decision by simple acceptance: whether the deviation is within the tolerance.
    pub simple: Decision,
    /// Decision by guarded acceptance: whether the deviation is inside or outside by more than the guard band, which is that
    /// of the type's rule, and the expanded uncertainty if that is simple acceptance.
    pub guarded: Decision,
    /// Decision by the type's rule, one of the two.
    pub decision: Decision,
    /// Specific risk: probability that the decision is wrong; absent if it is undecided.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub specific_risk: Option<f64>,
}

impl ParameterVerdict {
    /// Returns the expanded uncertainty in the unit of the parameter.
    pub(crate) fn expanded_uncertainty_of_value(&self) -> f64 {
        self.coverage_factor * self.standard_uncertainty
    }

    /// Returns the part of the standard uncertainty that comes from the local g, in the unit of the parameter.
    pub(crate) fn u_from_gravity(&self) -> Option<f64> {
        self.expanded_uncertainty_from_gravity.map(|expanded| expanded / self.coverage_factor)
    }

    /// Returns the share of the variance that comes from the local g.
    pub(crate) fn share_of_gravity(&self) -> f64 {
        let part = self.expanded_uncertainty_from_gravity.unwrap_or(0.0) / self.expanded_uncertainty;
        part * part
    }

    /// Returns the ratio of the new uncertainty to this one if the part that does not come from the local g is multiplied by
    /// `ratio`.
    pub(crate) fn ratio_with_gravity(&self, ratio: f64) -> f64 {
        let share = self.share_of_gravity();
        libm::sqrt(ratio * ratio * (1.0 - share) + share)
    }

    /// Returns `true` if more than half of the variance comes from the local g.
    pub(crate) fn is_mostly_from_gravity(&self) -> bool {
        self.share_of_gravity() > 0.5
    }
}

/// Values and standard uncertainties of the eight parameters at one local g; ω_g and ω_k are NaN in the general model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// Parameters, drifts per local g.
    pub parameters: GyroParameters,
    /// Standard uncertainties, in the order of [`Parameter::EIGHT`].
    pub standard_uncertainty: [f64; 8],
    /// Effective degrees of freedom of the standard uncertainties; infinite where nothing is known of them.
    pub degrees_of_freedom: [f64; 8],
    /// Local g, m/s².
    pub gravity_m_per_s2: f64,
    /// Standard uncertainty of the local g, m/s².
    pub gravity_u_m_per_s2: f64,
}

/// Difference of two results, in units of their standard uncertainties, below which both are from the same readings.
const SAME_READINGS: f64 = 1e-6;

impl Found {
    /// Returns `true` if both results agree so closely that they are from the same readings.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        let (here, there) = (self.parameters.to_vector(), other.parameters.to_vector());
        // The drifts per g depend on the local g.
        let same =
            |place: usize| (here[place] - there[place]).abs() <= SAME_READINGS * self.standard_uncertainty[place];
        Parameter::EIGHT.iter().filter(|parameter| !PER_G.contains(parameter)).all(|parameter| same(parameter.place()))
    }

    /// Returns the result with g-sensitive drifts per exactly `gravity_m_per_s2` instead of the local g. The drift per
    /// m/s² belongs to the gyro, so the uncertainty of the local g enters here.
    #[must_use]
    pub(crate) fn at_gravity(&self, gravity_m_per_s2: f64) -> Self {
        let ratio = gravity_m_per_s2 / self.gravity_m_per_s2;
        let mut values = self.parameters.to_vector();
        let (mut standard_uncertainty, mut degrees_of_freedom) = (self.standard_uncertainty, self.degrees_of_freedom);
        for parameter in PER_G {
            let place = parameter.place();
            let (own, from_gravity) = (standard_uncertainty[place], self.u_from_gravity(parameter));
            standard_uncertainty[place] = ratio * libm::hypot(own, from_gravity);
            let both = [(own, degrees_of_freedom[place]), (from_gravity, f64::INFINITY)];
            degrees_of_freedom[place] = effective_degrees_of_freedom(&both);
            values[place] *= ratio;
        }
        let parameters = GyroParameters::from_vector(&values);
        Self { parameters, standard_uncertainty, degrees_of_freedom, gravity_m_per_s2, gravity_u_m_per_s2: 0.0 }
    }

    /// Returns the expanded uncertainty of a parameter: k = 2, or Student's t for few degrees of freedom.
    pub(crate) fn expanded_uncertainty(&self, parameter: Parameter) -> f64 {
        self.coverage_factor(parameter) * self.standard_uncertainty[parameter.place()]
    }

    /// Returns the coverage factor of the expanded uncertainty of a parameter.
    pub(crate) fn coverage_factor(&self, parameter: Parameter) -> f64 {
        coverage_factor(self.degrees_of_freedom[parameter.place()])
    }

    /// Returns the standard uncertainty that the local g adds to a parameter on conversion to another g; 0 if it has no
    /// effect.
    pub(crate) fn u_from_gravity(&self, parameter: Parameter) -> f64 {
        let value = if PER_G.contains(&parameter) { self.parameters.to_vector()[parameter.place()] } else { 0.0 };
        value.abs() * self.gravity_u_m_per_s2 / self.gravity_m_per_s2
    }

    /// Adds a part to the standard uncertainty of a parameter: an independent standard uncertainty with its degrees of freedom.
    pub(crate) fn add(&mut self, parameter: Parameter, part: (f64, f64)) {
        let place = parameter.place();
        let both = [(self.standard_uncertainty[place], self.degrees_of_freedom[place]), part];
        self.standard_uncertainty[place] = libm::hypot(both[0].0, part.0);
        self.degrees_of_freedom[place] = effective_degrees_of_freedom(&both);
    }

    /// Returns the result with an exact local g if `other` has the same local g, because the change then does not
    /// depend on it.
    fn under_the_same_gravity(&self, other: &Self) -> Self {
        let same = self.gravity_m_per_s2 == other.gravity_m_per_s2;
        Self { gravity_u_m_per_s2: if same { 0.0 } else { self.gravity_u_m_per_s2 }, ..*self }
    }
}

/// Compares a result with the specification of a gyro type.
pub(crate) fn against_type(found: &Found, gyro_type: &GyroType) -> Verdict {
    let nominal = Found {
        parameters: gyro_type.nominal.to_model(),
        standard_uncertainty: [0.0; 8],
        degrees_of_freedom: [f64::INFINITY; 8],
        gravity_m_per_s2: gyro_type.gravity(),
        gravity_u_m_per_s2: 0.0,
    };
    compare(found, &nominal, gyro_type)
}

/// Compares the change since an earlier result with the tolerance of the type; the paper's tolerance is an instability.
///
/// The two results are treated as independent. If they were found on one stand, its contribution to both errors is the
/// same and cancels in the change. The stated uncertainty is then too large.
pub(crate) fn against_earlier(found: &Found, earlier: &Found, gyro_type: &GyroType) -> Verdict {
    compare(&found.under_the_same_gravity(earlier), &earlier.under_the_same_gravity(found), gyro_type)
}

/// Compares two results at the type's g.
fn compare(found: &Found, reference: &Found, gyro_type: &GyroType) -> Verdict {
    let gravity_m_per_s2 = gyro_type.gravity();
    let sides = [found, reference];
    let at_type = sides.map(|side| side.at_gravity(gravity_m_per_s2));
    // The general model has no ω_g and ω_k, and the paper's tolerances say nothing of its matrix.
    let is_found =
        |parameter: &Parameter| at_type.iter().all(|side| !side.parameters.to_vector()[parameter.place()].is_nan());
    let parameters = Parameter::EIGHT.into_iter().filter(is_found).map(|parameter| {
        let of = |side: &Found| side.parameters.to_vector()[parameter.place()];
        let values = [of(&at_type[0]), of(&at_type[1])];
        let conversion = (values[0] - of(found)) - (values[1] - of(reference));
        let parts = at_type
            .map(|side| (side.standard_uncertainty[parameter.place()], side.degrees_of_freedom[parameter.place()]));
        let u = libm::hypot(parts[0].0, parts[1].0);
        let u = (u, effective_degrees_of_freedom(&parts));
        let from_gravity = sides.map(|side| side.u_from_gravity(parameter) * gravity_m_per_s2 / side.gravity_m_per_s2);
        let from_gravity = libm::hypot(from_gravity[0], from_gravity[1]);
        judge(parameter, values, u, [from_gravity, conversion], gyro_type)
    });
    Verdict::of(gyro_type.decision_rule(), gravity_m_per_s2, parameters.collect())
}

/// Returns the change of each parameter since an earlier result, in units of the standard uncertainty of the change, in
/// the order of [`Parameter::EIGHT`]; drifts are converted to the same g.
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
    /// Returns the parameter whose uncertainty takes most of its tolerance.
    pub(crate) fn least_certain(&self) -> Option<&ParameterVerdict> {
        let share = |line: &&ParameterVerdict| line.expanded_uncertainty / line.tolerance;
        let with_tolerance = self.parameters.iter().filter(|line| line.tolerance > 0.0);
        with_tolerance.max_by(|one, other| share(one).total_cmp(&share(other)))
    }

    /// Returns the parts of the deviations that come from converting g, and those of the expanded uncertainties that come from
    /// the local g where that is most of them; nothing if no statement is made.
    pub(crate) fn parts_from_gravity(&self) -> [Vec<(&ParameterVerdict, f64)>; 2] {
        let of = |part: fn(&ParameterVerdict) -> Option<f64>| {
            let rows = self.parameters.iter().filter(|_| !self.withheld);
            rows.filter_map(|row| Some((row, part(row).filter(|part| *part != 0.0)?))).collect()
        };
        let mostly =
            |row: &ParameterVerdict| row.expanded_uncertainty_from_gravity.filter(|_| row.is_mostly_from_gravity());
        [of(|row| row.conversion_of_g), of(mostly)]
    }

    /// Returns the parameters with a tolerance that were not found, because the general model does not have them.
    pub(crate) fn not_found(&self) -> Vec<Parameter> {
        let found = |parameter: &Parameter| self.parameters.iter().any(|row| row.parameter == *parameter);
        Parameter::AS_IN_THE_PAPER.into_iter().filter(|parameter| !found(parameter)).collect()
    }

    /// Returns the parameters that no gyro could pass, because the guard band alone exceeds the tolerance.
    pub(crate) fn too_uncertain(&self) -> Vec<Parameter> {
        let is_too_uncertain = |row: &&ParameterVerdict| self.guard_band(row) > row.tolerance;
        self.parameters.iter().filter(is_too_uncertain).map(|row| row.parameter).collect()
    }

    /// Returns the guard band of a parameter, in the unit of the deviation; 0 by simple acceptance.
    pub(crate) fn guard_band(&self, row: &ParameterVerdict) -> f64 {
        self.rule.guard_band() * row.expanded_uncertainty
    }

    /// Returns the parameters that fail and would pass with the other sign: the type may count them in the other direction.
    pub(crate) fn opposite(&self) -> Vec<Parameter> {
        let is_opposite = |row: &&ParameterVerdict| {
            let (difference, sum) = (row.value - row.reference_value, row.value + row.reference_value);
            row.decision == Decision::Fail && (row.deviation * sum / difference).abs() <= row.tolerance
        };
        self.parameters.iter().filter(is_opposite).map(|row| row.parameter).collect()
    }

    /// Returns the sentence on a [common factor](Self::common_factor).
    pub(crate) fn common_factor_in_words(&self) -> Option<Words> {
        self.common_factor().map(|factor| comparison::common_factor(Number::significant(factor, 3)))
    }

    /// Returns the ratio of the scale factors to those of the type, if all four fail and would be within tolerance and
    /// uncertainty but for this factor, and no drift fails.
    pub(crate) fn common_factor(&self) -> Option<f64> {
        let (k, drifts): (Vec<_>, Vec<_>) = self.parameters.iter().partition(|row| row.parameter.place() < 4);
        let sum = |of: fn(&ParameterVerdict) -> f64| k.iter().map(|row| of(row) * row.reference_value).sum::<f64>();
        let factor = sum(|row| row.value) / sum(|row| row.reference_value);
        let is_explained = |row: &&ParameterVerdict| {
            let (difference, rest) = (row.value - row.reference_value, row.value / factor - row.reference_value);
            let largest = row.tolerance + row.expanded_uncertainty / factor;
            row.decision == Decision::Fail && (row.deviation * rest / difference).abs() <= largest
        };
        let is_common = factor > 0.0 && k.iter().all(is_explained);
        (is_common && drifts.iter().all(|row| row.decision != Decision::Fail)).then_some(factor)
    }

    /// Returns the worse of the decisions of this verdict and on a change since an earlier result.
    pub(crate) fn with_change(&self, change: Option<&Self>) -> Decision {
        change.map_or(self.overall, |change| self.overall.max(change.overall))
    }

    /// Returns the parameters that are not decided, whatever U is, because the decision depends on a suspect reading.
    pub(crate) fn dependent(&self) -> Vec<Parameter> {
        let is_dependent =
            |row: &&ParameterVerdict| row.decision != decide(row.deviation, self.guard_band(row), row.tolerance);
        self.parameters.iter().filter(is_dependent).map(|row| row.parameter).collect()
    }

    /// Returns the decision on a parameter, or `None` if the result does not have it.
    pub(crate) fn parameter(&self, parameter: Parameter) -> Option<&ParameterVerdict> {
        self.parameters.iter().find(|row| row.parameter == parameter)
    }

    /// Returns the decision on a parameter, or `None` if no statement is made.
    pub(crate) fn decision(&self, row: &ParameterVerdict) -> Option<Decision> {
        (!self.withheld).then_some(row.decision)
    }

    /// Returns the comparison without the decisions that differ from those of `other`, a comparison of the same gyro, or
    /// without any if that is not possible.
    pub(crate) fn agreed(mut self, other: Option<Self>) -> Self {
        for row in &mut self.parameters {
            let other = other.as_ref().and_then(|other| other.parameter(row.parameter));
            let common = |decision: fn(&ParameterVerdict) -> Decision| match other {
                Some(other) if decision(other) == decision(row) => decision(row),
                _ => Decision::Undecided,
            };
            (row.simple, row.guarded, row.decision) =
                (common(|row| row.simple), common(|row| row.guarded), common(|row| row.decision));
            row.specific_risk = row.specific_risk.filter(|_| row.decision != Decision::Undecided);
        }
        Self { withheld: self.withheld, ..Self::of(self.rule, self.gravity_m_per_s2, self.parameters) }
    }

    /// Returns the comparison with nothing decided, for parameters that are not valid.
    pub(crate) fn undecided(self) -> Self {
        Self { withheld: true, ..self.agreed(None) }
    }

    fn of(rule: DecisionRule, gravity_m_per_s2: f64, parameters: Vec<ParameterVerdict>) -> Self {
        let number = |decision| parameters.iter().filter(|parameter| parameter.decision == decision).count();
        let overall = if number(Decision::Fail) > 0 {
            Decision::Fail
        } else if number(Decision::Pass) == Parameter::EIGHT.len() {
            // A parameter that was not found has not passed.
            Decision::Pass
        } else {
            Decision::Undecided
        };
        Self { overall, rule, gravity_m_per_s2, parameters, withheld: false }
    }
}

/// Returns the first parameter whose nominal value is 0, so that its tolerance in percent says nothing.
pub(crate) fn without_nominal(gyro_type: &GyroType) -> Option<Parameter> {
    let nominal = gyro_type.nominal.to_model().to_vector();
    let says_nothing =
        |parameter: &Parameter| gyro_type.tolerance.is_in_percent(*parameter) && nominal[parameter.place()] == 0.0;
    Parameter::EIGHT.into_iter().find(says_nothing)
}

fn coverage_factor(degrees_of_freedom: f64) -> f64 {
    if degrees_of_freedom == f64::INFINITY { COVERAGE_FACTOR } else { student_factor(BEYOND, degrees_of_freedom) }
}

/// Compares a value with a reference value. `u` is the standard uncertainty of their difference with its degrees of
/// freedom. A part of it comes from the local g, and a part of the difference from converting g. All arguments are in the
/// unit of the parameter.
fn judge(
    parameter: Parameter,
    [value, reference_value]: [f64; 2],
    (u, degrees_of_freedom): (f64, f64),
    [from_gravity, conversion]: [f64; 2],
    gyro_type: &GyroType,
) -> ParameterVerdict {
    let limit = gyro_type.tolerance.of(parameter);
    let nominal = gyro_type.nominal.to_model().to_vector().get(parameter.place()).copied().unwrap_or(0.0);
    // With a nominal value of 0, a tolerance in percent permits no deviation.
    let (unit, limit, scale) = match (gyro_type.tolerance.is_in_percent(parameter), nominal == 0.0) {
        (true, false) => ("%", limit, 100.0 / nominal.abs()),
        (true, true) => (parameter.unit(), 0.0, 1.0),
        (false, _) => (parameter.unit(), limit, 1.0),
    };
    let deviation = (value - reference_value) * scale;
    let coverage_factor = coverage_factor(degrees_of_freedom);
    let expanded_uncertainty = coverage_factor * u * scale;
    let rule = gyro_type.decision_rule();
    let simple = decide(deviation, 0.0, limit);
    let guarded = decide(deviation, rule.guard_band_of_u.unwrap_or(1.0) * expanded_uncertainty, limit);
    let decision = if rule.rule == Rule::Simple { simple } else { guarded };
    // A decision by guarded acceptance is also that by simple acceptance.
    let specific_risk =
        (decision != Decision::Undecided).then(|| risk(deviation, (u * scale, degrees_of_freedom), limit));
    ParameterVerdict {
        parameter,
        value,
        reference_value,
        standard_uncertainty: u,
        unit,
        deviation,
        conversion_of_g: PER_G.contains(&parameter).then_some(conversion * scale),
        tolerance: limit,
        expanded_uncertainty,
        coverage_factor,
        expanded_uncertainty_from_gravity: (from_gravity > 0.0).then_some(coverage_factor * from_gravity),
        simple,
        guarded,
        decision,
        specific_risk,
    }
}

fn decide(deviation: f64, guard_band: f64, limit: f64) -> Decision {
    if deviation.abs() + guard_band <= limit {
        Decision::Pass
    } else if deviation.abs() - guard_band > limit {
        Decision::Fail
    } else {
        Decision::Undecided
    }
}

/// Returns the probability that the decision by simple acceptance is wrong.
fn risk(deviation: f64, (u, degrees_of_freedom): (f64, f64), limit: f64) -> f64 {
    if u == 0.0 {
        return 0.0;
    }
    let below = |x: f64| {
        let beyond = 0.5 * student_beyond(x, degrees_of_freedom);
        if x < 0.0 { beyond } else { 1.0 - beyond }
    };
    // Each tail is computed by itself, so that a small risk keeps its significant digits.
    if deviation.abs() <= limit {
        below((-limit - deviation) / u) + below((deviation - limit) / u)
    } else {
        below((limit - deviation.abs()) / u) - below((-limit - deviation.abs()) / u)
    }
}
