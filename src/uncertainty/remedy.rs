//! One sentence on a budget: how well the worst parameter is known, from what, and what would halve that.

use super::budget::{Budget, Contribution, ParameterBudget};
use crate::calibration::causes::Cause;
use crate::calibration::parameter::Parameter;
use crate::gyro::Tolerance;

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

/// The sentence about the parameter whose uncertainty is the largest share of its tolerance; without a type's tolerance,
/// of its own size. `None` when nothing is uncertain.
pub fn sentence(budget: &Budget, tolerance: Option<&Tolerance>) -> Option<String> {
    let heaviest = |a: &&ParameterBudget, b: &&ParameterBudget| weight(a, tolerance).total_cmp(&weight(b, tolerance));
    let worst = budget.parameters.iter().max_by(heaviest)?;
    let first = worst.contributions.first().filter(|first| first.contribution > 0.0)?;
    let known = amount(worst, worst.standard_uncertainty);
    let kind = first.cause.kind();
    let from = if first.share >= NEARLY_ALL {
        format!("nearly all of it from the {kind}")
    } else if first.share >= 0.5 {
        format!("{:.0} % of its variance from the {kind}", 100.0 * first.share)
    } else {
        format!("the largest part of its variance, {:.0} %, from the {kind}", 100.0 * first.share)
    };
    Some(format!("{} is known to {known}, {from}{}", worst.parameter.symbol(), remedy(worst, first)))
}

/// An uncertainty of a parameter: in percent of a scale factor, in its unit otherwise.
fn amount(line: &ParameterBudget, u: f64) -> String {
    match line.parameter {
        Parameter::Kx | Parameter::Kxy | Parameter::Kyx | Parameter::Ky if line.value != 0.0 => {
            format!("{} %", two_digits(100.0 * u / line.value.abs()))
        }
        other => format!("{} {}", two_digits(u), other.unit()),
    }
}

/// What halves the parameter's uncertainty through its largest contribution alone, or that this cannot.
fn remedy(line: &ParameterBudget, first: &Contribution) -> String {
    let variance = line.standard_uncertainty * line.standard_uncertainty;
    let own = first.contribution * first.contribution;
    let rest = (variance - own).max(0.0);
    // (r · contribution)² + rest = variance/4.
    let allowed = variance / 4.0 - rest;
    if allowed <= 0.0 {
        return format!("; without it, it would still be {}", amount(line, rest.sqrt()));
    }
    let ratio = (allowed / own).sqrt();
    // Rounded down, so that what is asked for is enough.
    let limit = rounded_down(first.cause.shown(first.standard_uncertainty[1]) * ratio);
    let unit = first.cause.unit();
    let what = match first.cause {
        Cause::Seat(axis) => format!("seat the gyro to {limit} {unit} about {}", ["x", "y", "the spin axis"][axis]),
        Cause::Angle(..) => format!("certify the angles to {limit} {unit}"),
        Cause::Return(..) => format!("let the stand return to its positions within {limit} {unit}"),
        Cause::Platform(_) | Cause::Base(_) => format!("certify the {} to {limit} {unit}", first.cause.kind()),
        Cause::Level(_) => format!("level the base to {limit} {unit}"),
        Cause::Azimuth => format!("turn the base north to {limit} {unit}"),
        Cause::Mark => format!("survey the azimuth of the mark to {limit} {unit}"),
        Cause::Latitude | Cause::Deflection => format!("find the {} to {limit} {unit}", first.cause.kind()),
        Cause::Reading(..) => format!("read the currents to {limit} {unit}"),
        Cause::Floor(..) => format!("read the currents to {limit} {unit} at zero"),
        Cause::Gain => format!("calibrate the meter's gain to {limit} {unit}"),
        Cause::Offset => format!("calibrate the meter's offset to {limit} {unit}"),
    };
    format!(": {what} and it halves")
}

/// Two significant digits.
fn two_digits(value: f64) -> String {
    plain(format!("{value:.1e}"))
}

/// Two significant digits, towards zero.
fn rounded_down(value: f64) -> String {
    let decade = libm::pow(10.0, libm::log10(value).floor() - 1.0);
    plain(format!("{:.1e}", (value / decade + 1e-9).floor() * decade))
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
        assert_eq!(rounded_down(14.97), "14");
        assert_eq!(rounded_down(0.0499), "0.049");
        assert_eq!(rounded_down(10.0), "10");
    }
}
