//! What matters in a budget: how well the worst parameter is known, from what, and what would halve that; in one sentence too.

use super::budget::{Budget, Contribution, ParameterBudget};
use crate::calibration::causes::Cause;
use crate::calibration::parameter::Parameter;
use crate::gyro::Tolerance;
use crate::units::printed;

/// From this share of a variance on, it comes from one kind of input "nearly all".
const NEARLY_ALL: f64 = 0.9;

/// An uncertainty's share of what it is compared with: `tolerance` where given, otherwise the parameter's own size.
fn weight(line: &ParameterBudget, tolerance: Option<&Tolerance>) -> f64 {
    let size = line.value.abs();
    let allowed = tolerance.map_or(size, |tolerance| match line.parameter {
        Parameter::Kx | Parameter::Ky => tolerance.k_main_percent / 100.0 * size,
        Parameter::Kxy | Parameter::Kyx => tolerance.k_cross_percent / 100.0 * size,
        Parameter::Omega0x | Parameter::Omega0y => tolerance.omega0_deg_per_h,
        Parameter::OmegaG => tolerance.omega_g_deg_per_h_per_g,
        Parameter::OmegaK => tolerance.omega_k_deg_per_h_per_g,
        Parameter::Anisoelasticity => f64::INFINITY,
    });
    if allowed > 0.0 { line.standard_uncertainty / allowed } else { 0.0 }
}

/// What a budget comes to.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Dominant<'a> {
    /// The parameter whose uncertainty is the largest share of its tolerance; without a type's tolerance, of its own size.
    pub worst: &'a ParameterBudget,
    /// Its largest contribution.
    pub first: &'a Contribution,
    /// What smaller inputs of that kind would do.
    pub effect: Effect,
}

/// What may be expected of the largest contribution alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Effect {
    /// The parameter's uncertainty halves when that of the input is at most this, in the unit of
    /// [`Cause::unit`](crate::calibration::causes::Cause::unit); two digits, rounded down, so that what is asked for is enough.
    HalvesAt(f64),
    /// Even without the contribution this would be left, in the parameter's unit.
    Leaves(f64),
}

/// How much of a variance the largest contribution is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// From 90 % on.
    NearlyAll,
    /// From a half on.
    Most,
    /// No other is larger.
    Largest,
}

impl<'a> Dominant<'a> {
    /// Of a budget; `None` when nothing is uncertain.
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

    /// How much of the variance its largest contribution is.
    pub(crate) fn part(&self) -> Part {
        match self.first.share {
            share if share >= NEARLY_ALL => Part::NearlyAll,
            share if share >= 0.5 => Part::Most,
            _ => Part::Largest,
        }
    }

    /// All of it in one sentence without a full stop.
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

/// Percent that an uncertainty of a scale factor is of it; `None` for other parameters, and of a factor of 0.
pub(crate) fn percent(line: &ParameterBudget, u: f64) -> Option<f64> {
    let of_factor = matches!(line.parameter, Parameter::Kx | Parameter::Kxy | Parameter::Kyx | Parameter::Ky);
    (of_factor && line.value != 0.0).then(|| 100.0 * u / line.value.abs())
}

/// An uncertainty of a parameter: in percent of a scale factor, in its unit otherwise.
fn amount(line: &ParameterBudget, u: f64) -> String {
    match percent(line, u) {
        Some(percent) => format!("{} %", two_digits(percent)),
        None => format!("{} {}", two_digits(u), printed(line.parameter.unit())),
    }
}

/// How an input comes to be known to `limit`, in its unit.
fn what_to_do(cause: Cause, limit: f64) -> String {
    let to = format!("{} {}", two_digits(limit), cause.unit());
    match cause {
        Cause::Seat(axis) => format!(
            "seat the gyro with an uncertainty of {to} about {}",
            [
                "x",
                "y",
                "the spin \
            axis"
            ][axis]
        ),
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
        Cause::Gain => format!("calibrate the gain of the meter with an uncertainty of {to}"),
        Cause::Offset => format!("calibrate the offset of the meter with an uncertainty of {to}"),
    }
}

/// Two significant digits.
fn two_digits(value: f64) -> String {
    plain(format!("{value:.1e}"))
}

/// Two significant digits, towards zero.
fn rounded_down(value: f64) -> f64 {
    let decade = libm::pow(10.0, libm::log10(value).floor() - 1.0);
    (value / decade + 1e-9).floor() * decade
}

/// 1.5e-1 as 0.15, and so on, as long as that is short.
fn plain(scientific: String) -> String {
    match (scientific.parse::<f64>(), scientific.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok()))
    {
        (Ok(value), Some(exponent @ -4..=4)) => format!("{value:.*}", usize::try_from(1 - exponent).unwrap_or(0)),
        _ => scientific,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits() {
        for (value, due) in [(0.1503, "0.15"), (12.49, "12"), (0.000_123, "0.00012"), (1.0e-7, "1.0e-7")] {
            assert_eq!(two_digits(value), due);
        }
        assert_eq!(two_digits(rounded_down(14.97)), "14");
        assert_eq!(two_digits(rounded_down(0.0499)), "0.049");
        assert_eq!(two_digits(rounded_down(10.0)), "10");
    }
}
