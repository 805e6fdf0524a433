//! The decision on a gyro in a line: its word and its reasons.

use super::counted;
use crate::calibration::parameter::symbols;
use crate::calibration::{CalibrationDocument, Decision};
use crate::report::doc::joined;
use crate::report::style::Outcome;
use crate::wording::texts::calibration as texts;
use crate::wording::{Text, Words};

/// Returns the outcome of a calibration with its word, and the reasons: which parameters pass, fail and are undecided by
/// their values and by their change, or why no statement is made.
pub(in crate::report) fn headline(document: &CalibrationDocument, gyro_type: Option<&str>) -> ((Outcome, Text), Words) {
    let judged = gyro_type.zip(document.verdict.as_ref());
    let (outcome, word, words): (Outcome, Text, Words) = match judged {
        _ if !document.consistent => (Outcome::Failed, texts::INVALID, texts::DOES_NOT_FIT.into()),
        _ if document.mistake.is_some() => (Outcome::Failed, texts::INVALID, texts::MISTAKE.into()),
        None => (Outcome::NotAsked, texts::IS_CALIBRATED, texts::NO_TYPE_WORDS.into()),
        Some((_, verdict)) if verdict.withheld => (Outcome::NotAsked, texts::IS_CALIBRATED, texts::NOT_VERIFIED.into()),
        Some((name, verdict)) => {
            // Nothing is decided on a change that is not assessed.
            let worst = verdict.with_change(document.change.as_ref());
            let of_change: Option<Words> = document.change.as_ref().map(|change| match change.withheld {
                true => texts::CHANGE_NOT_ASSESSED.into(),
                false => counted(change, |row| row.decision, texts::change_passed),
            });
            let of_values = counted(verdict, |row| row.decision, texts::passed);
            let not_found = verdict.not_found();
            let not_found = (!not_found.is_empty()).then(|| texts::not_in_the_model(symbols(not_found)));
            let of_values = joined([of_values].into_iter().chain(not_found), "; ");
            let name = Words::Given(name.to_owned());
            let words = [texts::of_type_name(name, of_values)].into_iter().chain(of_change);
            (worst.into(), word(worst), joined(words, ". "))
        }
    };
    let withheld = judged.filter(|(_, verdict)| verdict.withheld);
    let withheld = withheld.map(|(name, _)| texts::no_statement(Words::Given(name.to_owned())));
    ((outcome, word), joined([words].into_iter().chain(withheld), ". "))
}

fn word(decision: Decision) -> Text {
    match decision {
        Decision::Pass => texts::PASSES,
        Decision::Fail => texts::FAILS,
        Decision::Undecided => texts::IS_UNDECIDED,
    }
}
