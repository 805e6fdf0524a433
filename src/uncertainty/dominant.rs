//! Dominant contribution of a budget: the worst parameter, its main source, and what would halve its uncertainty.

use super::budget::{Budget, Contribution, ParameterBudget};
use crate::calibration::Cause;
use crate::gyro::Tolerance;
use crate::text::number::two_digits;
use crate::units::quantity;

/// Smallest share of a variance that counts as "nearly all" of it.
const NEARLY_ALL: f64 = 0.9;

/// Returns the uncertainty of a parameter relative to its `tolerance` if given, otherwise to the value of the
/// parameter.
fn weight(line: &ParameterBudget, tolerance: Option<&Tolerance>) -> f64 {
    let size = line.value.abs();
    let allowed = tolerance.map_or(size, |tolerance| tolerance.absolute(line.parameter, size));
    if allowed > 0.0 { line.standard_uncertainty / allowed } else { 0.0 }
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Dominant<'a> {
    /// Parameter with the largest uncertainty relative to its tolerance or, without a tolerance, to its own value.
    pub worst: &'a ParameterBudget,
    /// Largest contribution to its uncertainty.
    pub first: &'a Contribution,
    /// Effect of smaller inputs of that kind.
    pub effect: Effect,
}

/// Effect of a reduction of the largest contribution alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Effect {
    /// Standard uncertainty of the input at which that of the parameter halves, in the unit of
    /// [`Cause::unit`](crate::calibration::causes::Cause::unit); two digits, rounded down, so that this value is
    /// enough.
    HalvesAt(f64),
    /// Standard uncertainty that remains without the contribution, in the unit of the parameter.
    Leaves(f64),
}

/// Share of the largest contribution in a variance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// Share of 90 % or more.
    NearlyAll,
    /// Share of one half or more.
    Most,
    /// Smaller share, but the largest of all.
    Largest,
}

impl<'a> Dominant<'a> {
    /// Returns the dominant contribution of a budget, or `None` if nothing is uncertain.
    pub(crate) fn of(budget: &'a Budget, tolerance: Option<&Tolerance>) -> Option<Self> {
        let heaviest =
            |a: &&ParameterBudget, b: &&ParameterBudget| weight(a, tolerance).total_cmp(&weight(b, tolerance));
        let worst = budget.parameters.iter().max_by(heaviest)?;
        let first = worst.contributions.first().filter(|first| first.contribution > 0.0)?;
        let variance = worst.standard_uncertainty * worst.standard_uncertainty;
        let own = first.contribution * first.contribution;
        let rest = (variance - own).max(0.0);
        // (r · contribution)² + rest = variance/4.
        let allowed = variance / 4.0 - rest;
        let effect = if allowed <= 0.0 {
            Effect::Leaves(rest.sqrt())
        } else {
            let ratio = (allowed / own).sqrt();
            Effect::HalvesAt(rounded_down(first.cause.shown(first.standard_uncertainty[1]) * ratio))
        };
        Some(Self { worst, first, effect })
    }

    /// Returns the share of the largest contribution in the variance.
    pub(crate) fn part(&self) -> Part {
        match self.first.share {
            share if share >= NEARLY_ALL => Part::NearlyAll,
            share if share >= 0.5 => Part::Most,
            _ => Part::Largest,
        }
    }

    /// Returns the result as one sentence without a full stop.
    pub(crate) fn sentence(&self) -> String {
        let (worst, kind, percent) = (self.worst, self.first.cause.kind(), 100.0 * self.first.share);
        let from = match self.part() {
            Part::NearlyAll => format!("nearly all of the variance comes from one source ({kind})"),
            Part::Most => format!("{percent:.0} % of the variance comes from one source ({kind})"),
            Part::Largest => format!("the source with the largest share of the variance, {percent:.0} %, is: {kind}"),
        };
        let known = amount(worst, worst.standard_uncertainty);
        let effect = match self.effect {
            Effect::Leaves(rest) => format!("; without it u would be {}", amount(worst, rest)),
            Effect::HalvesAt(limit) => format!("; to halve u, {}", what_to_do(self.first.cause, limit)),
        };
        format!("u({}) is {known}; {from}{effect}", worst.parameter.symbol())
    }
}

/// Returns an uncertainty of a scale factor in percent of it, or `None` for other parameters and for a factor of 0.
pub(crate) fn percent(line: &ParameterBudget, u: f64) -> Option<f64> {
    (line.parameter.is_scale_factor() && line.value != 0.0).then(|| 100.0 * u / line.value.abs())
}

/// Returns an uncertainty of a parameter as text: in percent for a scale factor, otherwise in the unit of the
/// parameter.
fn amount(line: &ParameterBudget, u: f64) -> String {
    match percent(line, u) {
        Some(percent) => format!("{} %", two_digits(percent)),
        None => quantity(&two_digits(u), line.parameter.unit()),
    }
}

/// Returns the measure that reduces the uncertainty of an input to `limit`, in its unit.
fn what_to_do(cause: Cause, limit: f64) -> String {
    let to = quantity(&two_digits(limit), cause.unit());
    match cause {
        Cause::Seat(axis) => {
            format!("seat the gyro with an uncertainty of {to} about {}", ["x", "y", "the spin axis"][axis])
        }
        Cause::Angle(..) => format!("certify the angles with an uncertainty of {to}"),
        Cause::Return(..) => format!("improve the repeatability of the stand to {to}"),
        Cause::Platform(_) | Cause::Base(_) => format!("certify the {} with an uncertainty of {to}", cause.kind()),
        Cause::Level(_) => format!("level the base with an uncertainty of {to}"),
        Cause::Azimuth => format!("align the base with an uncertainty of its azimuth of {to}"),
        Cause::Mark => format!("determine the azimuth of the mark with an uncertainty of {to}"),
        Cause::Latitude | Cause::Deflection => format!("determine the {} with an uncertainty of {to}", cause.kind()),
        Cause::Reading(..) => format!("measure the currents with an uncertainty of {to}"),
        Cause::Floor(..) => format!("measure the currents with an uncertainty of {to} at zero"),
        Cause::Noise(..) => format!("reduce the noise of the mean reading to {to}"),
        Cause::Visits(..) => format!("reduce the gyro's noise in the mean of a position to {to}, by more visits"),
        Cause::TurnOn(_) => format!("reduce the scatter of the mean of the turn-ons to {to}, by more turn-ons"),
        Cause::Scale(_) => format!("reduce the scatter of K between turn-ons to {to}, by more turn-ons"),
        Cause::Differences(_) => "visit each position more often".to_owned(),
        Cause::Gain => format!("calibrate the gain of the meter with an uncertainty of {to}"),
        Cause::Offset => format!("calibrate the offset of the meter with an uncertainty of {to}"),
    }
}

/// Returns a number rounded towards zero to two significant digits.
fn rounded_down(value: f64) -> f64 {
    let decade = libm::pow(10.0, libm::log10(value).floor() - 1.0);
    (value / decade + 1e-9).floor() * decade
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits() {
        assert_eq!(two_digits(rounded_down(14.97)), "14");
        assert_eq!(two_digits(rounded_down(0.0499)), "0.049");
        assert_eq!(two_digits(rounded_down(10.0)), "10");
    }
}
