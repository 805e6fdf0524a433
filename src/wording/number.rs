//! Numbers formatted for people: rounded once from the full binary64, with the decimal mark of the language.
//!
//! [JCGM 100](crate::bibliography::Bibliography::Gum), 7.2.6: an uncertainty has two significant digits, and its value
//! ends at the same decimal place. A narrow non-breaking space separates groups of three digits (SI Brochure, 5.4.4).

use super::texts::units;
use super::{Language, Text};
use crate::text::number;

/// Largest angle that is printed in arcseconds alone.
pub(crate) const LARGEST_IN_ARCSEC: f64 = 600.0;

/// Hemispheres of a latitude and of a longitude: of positive numbers, and of negative ones.
pub(crate) const LATITUDES: [Text; 2] = [units::NORTH_LATITUDE, units::SOUTH_LATITUDE];
pub(crate) const LONGITUDES: [Text; 2] = [units::EAST_LONGITUDE, units::WEST_LONGITUDE];

/// Narrow non-breaking space, between groups of digits.
pub(crate) const THIN_BLANK: char = '\u{202F}';

/// Returns the sign before a power of ten: a cross in English (SI Brochure, 5.4.5), a point in Russian.
pub(crate) fn times(language: Language) -> char {
    match language {
        Language::English => '\u{00D7}',
        Language::Russian => '\u{00B7}',
    }
}

/// Least probability that is printed as a number.
pub(crate) const LEAST_PROBABILITY: f64 = 1e-6;

/// A number of a document, and its printed digits.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Number {
    pub(crate) value: f64,
    /// Sign, degrees and minutes before the digits, if the number is printed as an angle; empty otherwise.
    before: String,
    /// Printed digits, with a decimal point and an ASCII minus.
    digits: String,
}

impl Number {
    fn new(value: f64, digits: String) -> Self {
        Self { value, before: String::new(), digits }
    }

    /// Creates the number of an angle in arcseconds with the standard uncertainty `u`: as [`Number::measured`], above 600″
    /// with degrees and minutes. The mark of the seconds is not part of it.
    pub(crate) fn angle(arcsec: f64, u: f64) -> Self {
        let seconds = Self::measured(arcsec, u);
        let (sign, unsigned) = match seconds.digits.strip_prefix('-') {
            Some(unsigned) => ("\u{2212}", unsigned),
            None => ("", seconds.digits.as_str()),
        };
        let (whole, decimals) = unsigned.find('.').map_or((unsigned, ""), |at| unsigned.split_at(at));
        let large = |whole: &u64| arcsec.abs() > LARGEST_IN_ARCSEC && *whole as f64 >= LARGEST_IN_ARCSEC;
        let Some(whole) = whole.parse::<u64>().ok().filter(large) else { return seconds };
        let (degrees, minutes) = (whole / 3600, whole / 60 % 60);
        let before =
            if degrees > 0 { format!("{sign}{degrees}°{minutes:02}′") } else { format!("{sign}{minutes}′") };
        Self { value: arcsec, before, digits: format!("{:02}{decimals}", whole % 60) }
    }

    /// Creates a number with `decimals` decimals.
    pub(crate) fn fixed(value: f64, decimals: usize) -> Self {
        Self::new(value, without_minus_zero(format!("{value:.decimals$}")))
    }

    /// Returns the number with its sign also where it is positive, as of a change.
    pub(crate) fn signed(self) -> Self {
        let before = if self.value > 0.0 && !self.is_printed_as_zero() { "+" } else { "" };
        Self { before: before.to_owned(), ..self }
    }

    /// Creates a number with `digits` significant digits.
    pub(crate) fn significant(value: f64, digits: i32) -> Self {
        Self::to_place(value, number::exponent_as_printed(value, digits) - digits + 1)
    }

    /// Creates a whole number from 10 upwards, and one with two significant digits below.
    pub(crate) fn whole_or_two_digits(value: f64) -> Self {
        if value < 10.0 { Self::significant(value, 2) } else { Self::fixed(value, 0) }
    }

    /// Creates a number with `digits` significant digits, and a power of ten if it would otherwise have many zeros.
    pub(crate) fn scientific(value: f64, digits: i32) -> Self {
        let plain = value == 0.0 || (1e-3..1e5).contains(&value.abs());
        if plain {
            return if value == 0.0 { Self::exact(value) } else { Self::significant(value, digits) };
        }
        let decimals = usize::try_from(digits - 1).unwrap_or(0);
        Self::new(value, format!("{value:.decimals$e}"))
    }

    /// Creates the number of a probability, with two digits, or that of [`LEAST_PROBABILITY`] if it is less.
    pub(crate) fn probability(p: f64) -> Self {
        match p {
            p if p < LEAST_PROBABILITY => Self::scientific(LEAST_PROBABILITY, 1),
            p if p < 0.1 => Self::scientific(p, 2),
            p => Self::fixed(p, 2),
        }
    }

    /// Creates a sum of squares in units of its variance; a large one has no decimals.
    pub(crate) fn chi_square(value: f64) -> Self {
        match value {
            small if small < 99.995 => Self::fixed(value, 2),
            large if large < 99_999.5 => Self::fixed(value, 0),
            _ => Self::scientific(value, 2),
        }
    }

    /// Creates a number with the shortest decimal that gives the value back.
    pub(crate) fn exact(value: f64) -> Self {
        let magnitude = value.abs();
        let plain = magnitude == 0.0 || (1e-6..1e16).contains(&magnitude);
        let digits = if plain { format!("{value}") } else { format!("{value:e}") };
        Self::new(value, without_minus_zero(digits))
    }

    /// Creates a number with the shortest decimal, but at most `decimals` decimals, and no zeros at their end.
    pub(crate) fn at_most(value: f64, decimals: usize) -> Self {
        let rounded = format!("{value:.decimals$}").parse().unwrap_or(value);
        Self { value, ..Self::exact(rounded) }
    }

    /// Creates the number of a standard uncertainty: two significant digits, or a plain 0.
    pub(crate) fn uncertainty(u: f64) -> Self {
        Self::to_place(u, Self::place_of(u))
    }

    /// Creates the number of a value with the standard uncertainty `u`. It ends at the place of the second digit of
    /// `u`, or is exact if `u` is 0.
    pub(crate) fn measured(value: f64, u: f64) -> Self {
        if u > 0.0 { Self::to_place(value, Self::place_of(u)) } else { Self::exact(value) }
    }

    /// Returns the place (power of ten) of the second significant digit of `u`, after rounding: 0.0996 becomes 0.10.
    pub(crate) fn place_of(u: f64) -> i32 {
        if u > 0.0 && u.is_finite() { number::exponent_as_printed(u, 2) - 1 } else { 0 }
    }

    /// Creates a number rounded to a multiple of 10 to the power `place`.
    pub(crate) fn to_place(value: f64, place: i32) -> Self {
        if place <= 0 {
            return Self::fixed(value, place.unsigned_abs() as usize);
        }
        // Rounded once: the quotient is as exact as the value.
        let multiple = format!("{:.0}", value / libm::pow(10.0, f64::from(place)));
        let zeros = if multiple.trim_start_matches('-') == "0" { 0 } else { place as usize };
        Self::new(value, without_minus_zero(multiple + &"0".repeat(zeros)))
    }

    /// Returns a coordinate without its sign, and its hemisphere.
    pub(crate) fn in_hemisphere(self, [positive, negative]: [Text; 2]) -> (Self, Text) {
        match self.digits.strip_prefix('-').map(str::to_owned) {
            Some(digits) => (Self { digits, ..self }, negative),
            None => (self, positive),
        }
    }

    /// Returns `true` if all printed digits are zeros.
    pub(crate) fn is_printed_as_zero(&self) -> bool {
        self.digits.chars().all(|c| matches!(c, '0' | '.'))
    }

    /// Returns the digits with the marks of `language`.
    pub(crate) fn text(&self, language: Language) -> String {
        format!("{}{}", self.before, localised(&self.digits, language))
    }

    /// Returns the number of printed decimals.
    pub(crate) fn decimals(&self) -> usize {
        let decimals = self.digits.split_once('.').map_or("", |(_, decimals)| decimals);
        decimals.chars().take_while(char::is_ascii_digit).count()
    }
}

/// A probability as the value of a text, with its relation: `p = 0.012`, `p < 10⁻⁶`.
pub(crate) struct Probability(pub f64);

fn without_minus_zero(digits: String) -> String {
    match digits.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| "0.".contains(c)) => rest.to_owned(),
        _ => digits,
    }
}

/// Converts a decimal number with point and ASCII minus to the notation of `language`.
pub(crate) fn localised(ascii: &str, language: Language) -> String {
    let (sign, unsigned) = match ascii.strip_prefix('-') {
        Some(rest) => ("\u{2212}", rest),
        None => ("", ascii),
    };
    let (mantissa, exponent) = unsigned.split_once('e').map_or((unsigned, None), |(m, e)| (m, Some(e)));
    if let ("1", Some(exponent)) = (mantissa, exponent) {
        return format!("{sign}10{}", superscripts(exponent));
    }
    let (whole, decimals) = mantissa.split_once('.').map_or((mantissa, None), |(w, d)| (w, Some(d)));
    let mut out = sign.to_owned();
    grouped(&mut out, whole, whole.len() % 3);
    if let Some(decimals) = decimals {
        out.push(match language {
            Language::English => '.',
            Language::Russian => ',',
        });
        grouped(&mut out, decimals, 0);
    }
    if let Some(exponent) = exponent {
        out += &format!("{THIN_BLANK}{}{THIN_BLANK}10{}", times(language), superscripts(exponent));
    }
    out
}

/// Appends the digits in groups of three after the first `head` digits; four digits or fewer are not grouped.
fn grouped(out: &mut String, digits: &str, head: usize) {
    for (index, digit) in digits.chars().enumerate() {
        if digits.len() > 4 && index > 0 && index % 3 == head {
            out.push(THIN_BLANK);
        }
        out.push(digit);
    }
}

/// Returns an exponent in superscript digits.
pub(crate) fn superscripts(exponent: &str) -> String {
    let raised = |c: char| match c {
        '-' => Some('⁻'),
        c => "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(c.to_digit(10)? as usize),
    };
    exponent.chars().filter_map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wording::plain;

    fn english(number: &Number) -> String {
        number.text(Language::English).replace(THIN_BLANK, "_")
    }

    /// By hand.
    #[test]
    fn a_large_chi_square_has_no_decimals() {
        let cases = [(0.0, "0.00"), (8.371, "8.37"), (99.994, "99.99"), (99.996, "100"), (8534.75, "8535")];
        for (value, due) in cases.into_iter().chain([(100_419_738.45, "1.0×10⁸")]) {
            assert_eq!(plain(&Number::chi_square(value).text(Language::English)), due, "{value}");
        }
    }

    /// By hand after JCGM 100, 7.2.6; 0.0996 rounds to 0.10 and takes its value to hundredths.
    #[test]
    fn an_uncertainty_has_two_digits_and_its_value_the_same_place() {
        let cases = [
            (12.4, 1.2, "12.4", "1.2"),
            (-31.0, 2.0, "\u{2212}31.0", "2.0"),
            (9.815_722_055, 5e-4, "9.815_72", "0.000_50"),
            (1.2345, 0.0996, "1.23", "0.10"),
            (1.2345, 0.0994, "1.234", "0.099"),
            (4310.0, 120.0, "4310", "120"),
            (4315.0, 123.4, "4320", "120"),
            (96_543.0, 12_300.0, "97_000", "12_000"),
            (-3.0, 1200.0, "0", "1200"),
            (-51.0, 1200.0, "\u{2212}100", "1200"),
            (-0.0004, 0.12, "0.00", "0.12"),
            (7.25, 0.0, "7.25", "0"),
        ];
        for (value, u, printed, printed_u) in cases {
            assert_eq!(english(&Number::measured(value, u)), printed, "{value} with {u}");
            assert_eq!(english(&Number::uncertainty(u)), printed_u, "{u}");
        }
    }

    /// By hand: 2412.34″ is 40′12.34″, 3599.96″ rounds to a degree, and 45° has no seconds.
    #[test]
    fn a_large_angle_has_degrees_and_minutes() {
        let cases = [
            (600.0, 1.2, "600.0"),
            (-599.2, 12.0, "\u{2212}599"),
            (2412.34, 1.2, "40′12.3"),
            (-3599.96, 1.2, "\u{2212}1°00′00.0"),
            (3661.25, 0.0, "1°01′01.25"),
            (-162_000.0, 0.0, "\u{2212}45°00′00"),
            (4315.0, 123.4, "1°12′00"),
        ];
        for (arcsec, u, printed) in cases {
            assert_eq!(english(&Number::angle(arcsec, u)), printed, "{arcsec} with {u}");
        }
        assert_eq!(Number::angle(-2412.34, 1.2).text(Language::Russian), "\u{2212}40′12,3");
    }

    #[test]
    fn what_rounds_to_zero_is_printed_as_zero() {
        for (value, zero) in [(4.9e-4, true), (-4.9e-4, true), (0.0, true), (5.1e-4, false), (-1.0, false)] {
            assert_eq!(Number::to_place(value, -3).is_printed_as_zero(), zero, "{value}");
        }
    }

    #[test]
    fn a_rounded_zero_has_no_sign() {
        for (value, due) in [(-0.00004, "0.0000"), (-0.0, "0.0000"), (-0.00006, "\u{2212}0.0001"), (0.0001, "+0.0001")]
        {
            assert_eq!(english(&Number::fixed(value, 4).signed()), due);
        }
    }

    /// 0.15 is 0.1499999999999999944…: rounded from its decimal 0.15 it would be 0.2.
    #[test]
    fn rounding_is_from_the_binary_value() {
        assert_eq!(english(&Number::fixed(0.15, 1)), "0.1");
        assert_eq!(english(&Number::fixed(2.675, 2)), "2.67");
        assert_eq!(english(&Number::significant(0.000_123_456, 3)), "0.000_123");
        assert_eq!(english(&Number::scientific(4.649e-9, 2)), "4.6_×_10⁻⁹");
        assert_eq!(english(&Number::scientific(0.0464, 2)), "0.046");
    }

    /// By hand: 72 degrees of freedom that are computed as a sum of fractions.
    #[test]
    fn no_zeros_end_a_number_of_few_decimals() {
        let at_most = |value| english(&Number::at_most(value, 1));
        assert_eq!(
            [72.000_000_01, 8.94, 100.02, 0.04, 71.96, 23.0].map(at_most),
            ["72", "8.9", "100", "0", "72", "23"]
        );
    }

    #[test]
    fn marks_are_those_of_the_language() {
        let russian = |value| Number::exact(value).text(Language::Russian).replace(THIN_BLANK, "_");
        assert_eq!(russian(-15.041_066_876_065_45), "\u{2212}15,041_066_876_065_45");
        assert_eq!(russian(5_766_742.0), "5_766_742");
        assert_eq!(russian(1234.5), "1234,5");
        assert_eq!(russian(2.5e-7), "2,5_·_10⁻⁷");
        assert_eq!(russian(-0.0), "0");
    }
}
