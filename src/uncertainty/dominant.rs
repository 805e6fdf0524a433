//! Dominant contribution of a budget: the worst parameter, its main source, and what would halve its uncertainty.

use super::budget::{Budget, Contribution, ParameterBudget};
use crate::calibration::Cause;
use crate::calibration::parameter::unit;
use crate::gyro::Tolerance;
use crate::wording::number::Number;
use crate::wording::texts::{calibration as texts, units};
use crate::wording::words::{symbol, told};
use crate::wording::{Text, Words};

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

    /// Returns the dominant contribution and the effect of reducing it, a sentence each; `worst` says how the parameter was
    /// chosen.
    pub(crate) fn said(&self, worst: fn(Words, Words) -> Words) -> [Words; 3] {
        let (line, first) = (self.worst, self.first);
        let share = match first.share {
            share if share >= NEARLY_ALL => texts::budget_nearly_all,
            share if share >= 0.5 => texts::budget_most,
            _ => texts::budget_largest,
        };
        let amount = |u: f64| {
            let percent = (line.parameter.is_scale_factor() && line.value != 0.0).then(|| 100.0 * u / line.value.abs());
            let (u, unit) = percent.map_or_else(|| (u, unit(line.parameter)), |percent| (percent, units::PERCENT));
            told(Words::Quantity(Number::scientific(u, 2), unit))
        };
        let effect = match self.effect {
            Effect::HalvesAt(limit) => texts::budget_halves(told(of_input(first.cause, limit))),
            Effect::Leaves(rest) => texts::budget_leaves(amount(rest)),
        };
        let share = share(told(Number::fixed(100.0 * first.share, 0)), first.cause.kind_words());
        [worst(symbol(line.parameter.symbol()), amount(line.standard_uncertainty)), share, effect]
    }
}

/// Returns the uncertainty of an input with its unit.
pub(crate) fn of_input(cause: Cause, u: f64) -> Words {
    let number = Number::scientific(u, 2);
    if cause.unit() == "1" { number.into() } else { Words::Quantity(number, unit_of(cause)) }
}

/// Returns the unit of the uncertainty of an input.
pub(crate) fn unit_of(cause: Cause) -> Text {
    match cause.unit() {
        "%" => units::PERCENT,
        "mA" => units::MILLIAMPERES,
        "deg/h" => units::DEG_PER_H,
        "deg/(h mA)" => units::DEG_PER_H_PER_MA,
        _ => units::ARCSEC,
    }
}

/// Returns a number rounded towards zero to two significant digits.
fn rounded_down(value: f64) -> f64 {
    let decade = libm::pow(10.0, libm::log10(value).floor() - 1.0);
    (value / decade + 1e-9).floor() * decade
}
