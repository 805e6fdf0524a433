//! Sentences about the digits of the readings, for the terminal and for pages.

use super::doc::Words;
use super::page::Number;
use crate::calibration::recorded::{Digits, rounding_of};
use crate::wording::texts::calibration as texts;

/// Returns what must be stated about the digits of the readings.
pub(crate) fn said(digits: &Digits) -> Vec<Words> {
    let rounding = digits.last_digit_ma.map(|digit| {
        let [digit, u] = [Number::significant(digit, 1), Number::scientific(rounding_of(digit), 2)];
        texts::last_digit(digit, u)
    });
    let rows = digits.identical_rows.then(|| texts::IDENTICAL_ROWS.into());
    let visits = digits.identical_visits.then(|| texts::IDENTICAL_VISITS.into());
    rounding.into_iter().chain(rows).chain(visits).collect()
}
