//! Canonical form of numbers.

/// Returns a binary64 value in canonical form: see [`write`].
pub(crate) fn decimal(value: f64) -> String {
    let mut text = String::new();
    write(value, &mut text);
    text
}

/// Returns a value as text with two significant digits, and as 1.5e-5 if it is not near 1.
pub(crate) fn two_digits(value: f64) -> String {
    let scientific = format!("{value:.1e}");
    match (scientific.parse::<f64>(), exponent_of(&scientific)) {
        (Ok(value), exponent @ -4..=5) => format!("{value:.*}", usize::try_from(1 - exponent).unwrap_or(0)),
        _ => scientific,
    }
}

/// Returns the number of decimals, at most 12, that show the standard uncertainty `u` with two significant digits (GUM,
/// 7.2.6).
pub(crate) fn decimals(u: f64) -> usize {
    if !(u.is_finite() && u > 0.0) {
        return 6;
    }
    usize::try_from(1 - exponent_as_printed(u, 2)).unwrap_or(0).min(12)
}

/// Returns the power of ten of the first digit of a value as printed with `digits` significant digits: that of 0.0996 is
/// −2 with three digits, and −1 with two, because it rounds to 0.10.
pub(crate) fn exponent_as_printed(value: f64, digits: i32) -> i32 {
    let decimals = usize::try_from(digits - 1).unwrap_or(0);
    exponent_of(&format!("{value:.decimals$e}"))
}

pub(crate) fn exponent_of(scientific: &str) -> i32 {
    scientific.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0)
}

/// Writes a binary64 value so that every YAML reader reads it back bit for bit.
///
/// The text is the shortest decimal that gives the value back, always with a decimal point. Below 1e-4 and from 1e16 it
/// has an exponent with a sign and at least two digits (`1.0e-06`, because PyYAML and Psych read `1e-6` as a string).
///
/// # Panics
/// Only in debug builds, if the value is not finite. Documents cannot contain such a value, because it is refused
/// earlier.
pub(super) fn write(value: f64, out: &mut String) {
    debug_assert!(value.is_finite(), "only finite numbers are written");
    let magnitude = value.abs();
    if magnitude == 0.0 {
        return out.push_str("0.0");
    }
    let plain = (1e-4..1e16).contains(&magnitude);
    let mut buffer = zmij::Buffer::new();
    let shortest = buffer.format_finite(value);
    if may_be_midway(value, shortest) {
        return write_parts(&if plain { format!("{value}") } else { format!("{value:e}") }, out);
    }
    match shortest.strip_prefix('-').unwrap_or(shortest).strip_prefix("0.0000") {
        // Magnitude below 1e-4 and not below 1e-5.
        Some(digits) => {
            let (first, others) = digits.split_at(1);
            let sign = if value < 0.0 { "-" } else { "" };
            out.extend([sign, first, ".", if others.is_empty() { "0" } else { others }, "e-05"]);
        }
        _ if plain => out.push_str(shortest),
        _ => write_parts(shortest, out),
    }
}

/// Writes a number in canonical form from the digits of another form.
fn write_parts(digits: &str, out: &mut String) {
    let (mantissa, exponent) = digits.split_once('e').map_or((digits, None), |(m, e)| (m, Some(e)));
    out.extend([mantissa, if mantissa.contains('.') { "" } else { ".0" }]);
    if let Some(exponent) = exponent {
        let unsigned = exponent.trim_start_matches(['-', '+']);
        let sign = if exponent.starts_with('-') { "e-" } else { "e+" };
        out.extend([sign, if unsigned.len() < 2 { "0" } else { "" }, unsigned]);
    }
}

/// Returns `true` if a value may lie exactly between two decimals with as many places. zmij then takes the even one and
/// the standard library the larger one, which this program has always written.
///
/// An odd/2^f = (2k + 1)/(2·10^d) needs f = d + 1. Shortest decimals with d places are no coarser than the value's own
/// steps, 2^-52 of it, so f is at most 25. A value of at most 15 digits, such as one below 1e10 with f ≤ 5, is its own
/// shortest decimal.
fn may_be_midway(value: f64, shortest: &str) -> bool {
    const MOST_BINARY_PLACES: i64 = 25;
    let bits = value.to_bits();
    let exponent = (bits >> 52 & 0x7FF) as i64;
    let mantissa = bits & ((1 << 52) - 1) | 1 << 52;
    let binary_places = 1075 - exponent - i64::from(mantissa.trailing_zeros());
    let of_15_digits = binary_places <= 5 && value.abs() < 1e10;
    binary_places <= MOST_BINARY_PLACES && !of_15_digits && {
        let (mantissa, exponent) = shortest.split_once('e').unwrap_or((shortest, "0"));
        let places = mantissa.split_once('.').map_or(0, |(_, places)| places.len() as i64);
        binary_places == places - exponent.parse().unwrap_or(0) + 1
    }
}

#[cfg(all(test, feature = "monte-carlo"))]
mod tests {
    use super::*;

    /// Expected texts from `contract`: a point always, an exponent with sign and two digits, `0.0` for both zeros.
    #[test]
    fn numbers_have_one_form() {
        let cases = [
            (0.0, "0.0"),
            (-0.0, "0.0"),
            (1.0, "1.0"),
            (-20.0, "-20.0"),
            (0.1, "0.1"),
            (1e-4, "0.0001"),
            (9.999e-5, "9.999e-05"),
            (1e-6, "1.0e-06"),
            (-2.5e-300, "-2.5e-300"),
            (5e-324, "5.0e-324"),
            (1e15, "1000000000000000.0"),
            (1e16, "1.0e+16"),
            (1.7976931348623157e308, "1.7976931348623157e+308"),
            (15.04106687606545, "15.04106687606545"),
        ];
        for (value, text) in cases {
            assert_eq!(decimal(value), text);
        }
    }

    /// Expected: what the standard library finds, in the form of the rule, for values of every size.
    #[test]
    fn numbers_are_those_of_the_standard_library() {
        let due = |value: f64| {
            if (1e-4..1e16).contains(&value.abs()) {
                let decimal = format!("{value}");
                return if decimal.contains('.') { decimal } else { decimal + ".0" };
            }
            let scientific = format!("{value:e}");
            let (mantissa, exponent) = scientific.split_once('e').unwrap();
            let point = if mantissa.contains('.') { "" } else { ".0" };
            let exponent: i32 = exponent.parse().unwrap();
            format!("{mantissa}{point}e{}{:02}", if exponent < 0 { '-' } else { '+' }, exponent.abs())
        };
        let mut stream = crate::statistics::random::Stream::new(5);
        let mut bits = || (stream.unit() * (1_u64 << 53) as f64) as u64 * 2048 + stream.below(2048) as u64;
        for _ in 0..200_000 {
            let value = f64::from_bits(bits());
            if value.is_finite() && value != 0.0 {
                assert_eq!(decimal(value), due(value), "{:x}", value.to_bits());
            }
        }
        // These values lie midway between two decimals of sixteen digits.
        for value in [-8_895_655_562_136_013.0 / 4.0, 1_073_741_825.0 / 2048.0, 1_125_899_906_842_624.125] {
            assert_eq!(decimal(value), due(value));
        }
        // A power of two has no other bit: 2^-25 lies midway between two decimals of seventeen digits.
        for places in 0..60 {
            let value = libm::pow(2.0, f64::from(-places));
            assert_eq!(decimal(value), due(value));
        }
        for bits in 20..52 {
            for odd in 0..500 {
                let value =
                    f64::from(2 * odd + 1) * libm::pow(2.0, f64::from(bits - 52)) + libm::pow(2.0, f64::from(bits));
                assert_eq!(decimal(value), due(value));
            }
        }
        for exponent in -20..20 {
            for digits in 1..2000 {
                let value = f64::from(digits) * libm::pow(10.0, f64::from(exponent));
                assert_eq!(decimal(-value), due(-value));
            }
        }
    }
}
