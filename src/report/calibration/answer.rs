//! Answer of a calibration on the gyro: the first line in a terminal, and the headline of a page.

use super::result::counted;
use crate::calibration::parameter::symbols;
use crate::calibration::{CalibrationDocument, Decision, Verdict};
use crate::report::doc::{either, given, joined};
use crate::wording::texts::calibration as texts;
use crate::wording::{Outcome, Text, Words};

/// Answer of a calibration. A page has the statement as a headline, and the reasons below it.
pub(crate) struct Answer {
    /// Outcome, and its word in a terminal.
    pub outcome: Outcome,
    pub word: Text,
    /// Why the parameters are not those of the gyro, and what to do.
    pub invalid: Option<[Text; 2]>,
    /// Decision on the values and their change; `None` without a statement of conformity.
    pub decision: Option<Decision>,
    /// Statement of conformity, or that there is none.
    pub statement: Words,
    /// `true` if a type was specified, but nothing is stated on it.
    pub withheld: bool,
    /// How many parameters pass by their values and by their change, which do not, or why nothing was assessed.
    pub reasons: Vec<Words>,
}

impl Answer {
    pub(crate) fn of(document: &CalibrationDocument, gyro_type: Option<&str>) -> Self {
        let invalid = match &document.mistake {
            _ if !document.consistent => Some([texts::DOES_NOT_FIT, texts::DOES_NOT_FIT_WORDS]),
            mistake => mistake.as_ref().map(|_| [texts::MISTAKE, texts::MISTAKE_WORDS]),
        };
        let judged = gyro_type.zip(document.verdict.as_ref());
        let withheld = judged.is_some_and(|(_, verdict)| verdict.withheld);
        let (decision, statement, reasons) = match judged {
            None => (None, texts::NO_TYPE.into(), vec![texts::NO_TYPE_WORDS.into()]),
            Some((name, _)) if withheld => (None, texts::no_statement(given(name)), Vec::new()),
            Some((name, verdict)) => decided(name, verdict, document.change.as_ref()),
        };
        let (outcome, word) = match (invalid, decision) {
            (Some(_), _) => (Outcome::Failed, texts::INVALID),
            (None, None) => (Outcome::NotAsked, texts::IS_CALIBRATED),
            (None, Some(Decision::Pass)) => (Outcome::Passed, texts::PASSES),
            (None, Some(Decision::Fail)) => (Outcome::Failed, texts::FAILS),
            (None, Some(Decision::Undecided)) => (Outcome::Undecided, texts::IS_UNDECIDED),
        };
        Self { outcome, word, invalid, decision, statement, withheld, reasons }
    }

    /// Returns what a terminal says after the word: the reasons, or why nothing is stated.
    pub(crate) fn in_a_line(&self) -> Words {
        let why = self.invalid.map(|[why, _]| why).or(self.withheld.then_some(texts::NOT_VERIFIED));
        let stated = self.withheld.then(|| self.statement.clone());
        let without = why.map(|why| [why.into()].into_iter().chain(stated).collect());
        joined(without.unwrap_or_else(|| self.reasons.clone()), ". ")
    }
}

/// The decision on values and change, the statement on it, and how many parameters pass. A change that cannot be assessed is
/// not decided.
fn decided(name: &str, verdict: &Verdict, change: Option<&Verdict>) -> (Option<Decision>, Words, Vec<Words>) {
    let statement = match (verdict.overall, change.map(|change| change.overall)) {
        (Decision::Fail, _) => texts::conforms_not,
        (_, Some(Decision::Fail)) => texts::changed_too_much,
        (Decision::Undecided, _) => texts::undecided,
        (Decision::Pass, Some(Decision::Undecided)) => texts::change_undecided,
        (Decision::Pass, _) => texts::conforms,
    };
    let of_change = change.map(|change| match change.withheld {
        true => texts::CHANGE_NOT_ASSESSED.into(),
        false => counted(change, |row| row.decision, texts::change_passed),
    });
    let not_found = verdict.not_found();
    let not_found = (!not_found.is_empty()).then(|| texts::not_in_the_model(symbols(not_found)));
    let of_values = joined([counted(verdict, |row| row.decision, texts::passed)].into_iter().chain(not_found), "; ");
    let of_values = either(of_values.clone(), texts::of_type_name(given(name), of_values));
    let reasons = [of_values].into_iter().chain(of_change).map(|words| vec![words, either(".", "")].into());
    (Some(verdict.with_change(change)), statement(given(name)), reasons.collect())
}
