//! Results of several gyros on one stand as text: a line for each, and what they have in common.

use super::calibration::{NOT_STATED, assumed, doubts, not_stated, passport, without_reading};
use super::style::Outcome;
use super::tolerance::headline;
use crate::calibration::NotStated;
use crate::interface::calibrated::Done;
use crate::passport::Check;
use crate::report::page::language::Language;
use crate::report::{columns, recorded, style};
use crate::text::printable;
use crate::uncertainty::MonteCarlo;
use crate::wording::plain;
use std::fmt::Write;

/// Words for the outcomes, in the order in which they are counted; the last two are of gyros without a result.
const WORDS: [&str; 7] = ["PASS", "UNDECIDED", "FAIL", "CALIBRATED", "INVALID", "REFUSED", "NOT WRITTEN"];

/// Returns the result for one of several gyros in one line: the decision for the type of this name, or the fit if there is
/// none.
pub(crate) fn line(file: &str, done: &Done, trials: Option<&MonteCarlo>, gyro_type: Option<&str>) -> String {
    let Done { calibration, document, readings, .. } = done;
    let file = printable(file);
    let ((outcome, word), mut reasons) = headline(document, gyro_type);
    if let Some(hint) = &calibration.hint {
        reasons += &format!("; {}", hint.causes());
    } else if gyro_type.is_none() && document.is_valid() {
        let fit = calibration.adopted().map(|answer| columns::probability(answer.chi_square.probability));
        reasons = fit.map_or_else(String::new, |p| format!("probability of a larger chi-square {p}"));
    }
    let mut out = format!("{}  {file}  {reasons}", style::of_input(outcome, &word));
    // That the readings do not fit is said already.
    for words in doubts(done, trials).skip(calibration.hint.iter().len()) {
        let _ = write!(out, "; {}", plain(&words));
    }
    let digits = calibration.digits.iter().flat_map(|digits| recorded::words(digits, Language::English));
    for words in without_reading(readings).into_iter().chain(digits) {
        let _ = write!(out, "; {}", plain(&words));
    }
    out.push('\n');
    out
}

/// Outcomes of several gyros, and what the lines do not say because all or many have it in common.
#[derive(Default)]
pub(crate) struct Gyros {
    outcomes: Vec<(Outcome, String)>,
    passport: Option<String>,
    results: usize,
    /// Inputs without a stated uncertainty, and the number of results that do not include it.
    missing: Vec<(NotStated, usize)>,
}

impl Gyros {
    /// Adds the result of a gyro with a passport on which these `checks` were made.
    pub(crate) fn add(&mut self, done: &Done, gyro_type: Option<&str>, checks: &[Check]) {
        self.outcomes.push(headline(&done.document, gyro_type).0);
        self.passport.get_or_insert_with(|| passport(&done.document, checks));
        self.results += 1;
        for what in &done.missing {
            match self.missing.iter_mut().find(|(known, _)| known == what) {
                Some((_, number)) => *number += 1,
                None => self.missing.push((*what, 1)),
            }
        }
    }

    /// Adds a gyro without a result; `word` is one of [`WORDS`].
    pub(crate) fn add_failed(&mut self, word: &str) {
        self.outcomes.push((Outcome::Failed, word.to_owned()));
    }

    /// Returns the counts of the outcomes with the mark of the worst; nothing for a single gyro.
    pub(crate) fn summary(&self) -> String {
        if self.outcomes.len() < 2 {
            return String::new();
        }
        let count = |word: &str| self.outcomes.iter().filter(|(_, found)| found == word).count();
        let counts = columns::counts(WORDS.map(|word| (count(word), word.to_lowercase())));
        let has = |outcome: &Outcome| self.outcomes.iter().any(|(found, _)| found == outcome);
        let worst = [Outcome::Failed, Outcome::Undecided, Outcome::NotAsked].into_iter().find(has);
        style::marked(worst.unwrap_or(Outcome::Passed), &format!("{} gyros: {counts}", self.outcomes.len())) + "\n"
    }

    /// Returns the counts, the passport, what was assumed or not tested, and the inputs without a stated uncertainty.
    pub(crate) fn text(&self, meter_assumed: bool, gyro_type: Option<&str>) -> String {
        let mut out = self.summary();
        let Some(passport) = &self.passport else { return out };
        columns::paragraph(&mut out, "", passport);
        for words in assumed(meter_assumed, gyro_type) {
            columns::paragraph(&mut out, "", words);
        }
        let (of_all, of_some): (Vec<_>, Vec<_>) = self.missing.iter().partition(|(_, number)| *number == self.results);
        let [of_all, of_some] = [of_all, of_some].map(|of| of.into_iter().map(|(what, _)| what).collect::<Vec<_>>());
        not_stated(&mut out, NOT_STATED, &of_all);
        not_stated(&mut out, "Not included for some of the gyros either", &of_some);
        out
    }
}
