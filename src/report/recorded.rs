//! Sentences about the digits of the readings, for the terminal and for pages.

use super::page::Number;
use super::page::language::{Language, values};
use super::page::texts::calibration as texts;
use crate::calibration::recorded::{Digits, rounding_of};

/// Returns what must be stated about the digits of the readings, a paragraph each.
pub(crate) fn words(digits: &Digits, language: Language) -> Vec<String> {
    let rounding = digits.last_digit_ma.map(|digit| {
        let [digit, u] = [Number::significant(digit, 1), Number::scientific(rounding_of(digit), 2)];
        texts::LAST_DIGIT.filled(language, values! { digit, u })
    });
    let rows = digits.identical_rows.then(|| texts::IDENTICAL_ROWS.words(language));
    let visits = digits.identical_visits.then(|| texts::IDENTICAL_VISITS.words(language));
    rounding.into_iter().chain(rows).chain(visits).collect()
}
