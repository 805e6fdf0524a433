//! Results of several gyros on one stand as text: a line for each, and what they have in common.

use super::calibration::{Answer, assumed, doubts, not_included, not_stated, passport};
use super::doc::{self, Block, longest, marked, padded};
use crate::calibration::NotStated;
use crate::calibration::remarks::{of_digits, without_reading};
use crate::interface::calibrated::Done;
use crate::passport::Check;
use crate::uncertainty::MonteCarlo;
use crate::wording::texts::calibration as texts;
use crate::wording::{Language, Outcome, Text, Words};

/// Words for the outcomes, in the order in which they are counted; the last two are of gyros without a result.
const WORDS: [Text; 7] = [
    texts::PASSES,
    texts::IS_UNDECIDED,
    texts::FAILS,
    texts::IS_CALIBRATED,
    texts::INVALID,
    texts::REFUSED,
    texts::NOT_WRITTEN,
];

/// The word for the outcome of one of several inputs with its mark, as wide as the longest.
pub(crate) fn of_input(outcome: impl Into<Outcome>, word: Text) -> Words {
    marked(outcome, padded(word, |language| longest(WORDS, language)))
}

/// Returns the result for one of several gyros in one line: the decision for the type of this name, or the fit if there is
/// none.
pub(crate) fn line(
    file: &str,
    done: &Done,
    trials: Option<&MonteCarlo>,
    gyro_type: Option<&str>,
    language: Language,
) -> String {
    let Done { calibration, document, readings, .. } = done;
    let answer = Answer::of(document, gyro_type);
    let mut reasons = answer.in_a_line();
    let is_invalid = calibration.is_invalid();
    if is_invalid {
        let causes = super::calibration::causes(calibration);
        let causes = causes.iter().filter_map(|cause| doc::sentence(cause, language)).map(Words::Plain);
        let causes = doc::joined(causes, " ");
        reasons = doc::joined([reasons, causes], ". ");
    } else if gyro_type.is_none() && document.is_valid() {
        let fit = calibration.adopted().map(|answer| doc::probability(answer.chi_square.probability));
        reasons = fit.map_or_else(|| "".into(), texts::fit_probability);
    }
    // That the result is not valid is said already.
    let doubts = doubts(done, trials).into_iter().skip(usize::from(is_invalid));
    let digits = calibration.digits.iter().flat_map(of_digits);
    let all = [reasons].into_iter().chain(doubts).chain(without_reading(readings)).chain(digits);
    let words = [of_input(answer.outcome, answer.word), doc::given(file), doc::joined(all, "; ")];
    doc::typed(&[Block::Whole("", vec![vec![doc::joined(words, "  ")]])], language)
}

/// Outcomes of several gyros, and what the lines do not say because all or many have it in common.
pub(crate) struct Gyros {
    language: Language,
    outcomes: Vec<(Outcome, Text)>,
    passport: Option<Words>,
    results: usize,
    /// Inputs without a stated uncertainty, and the number of results that do not include it.
    missing: Vec<(NotStated, usize)>,
}

impl Gyros {
    pub(crate) fn new(language: Language) -> Self {
        Self { language, outcomes: Vec::new(), passport: None, results: 0, missing: Vec::new() }
    }

    /// Adds the result of a gyro with a passport on which these `checks` were made.
    pub(crate) fn add(&mut self, done: &Done, gyro_type: Option<&str>, checks: &[Check]) {
        let Answer { outcome, word, .. } = Answer::of(&done.document, gyro_type);
        self.outcomes.push((outcome, word));
        self.passport.get_or_insert_with(|| passport(&done.document, checks));
        self.results += 1;
        for what in &done.missing {
            match self.missing.iter_mut().find(|(known, _)| known == what) {
                Some((_, number)) => *number += 1,
                None => self.missing.push((*what, 1)),
            }
        }
    }

    /// Adds a gyro without a result.
    pub(crate) fn add_failed(&mut self, word: Text) {
        self.outcomes.push((Outcome::Failed, word));
    }

    /// Returns the counts of the outcomes with the mark of the worst; nothing for a single gyro.
    pub(crate) fn summary(&self) -> String {
        doc::typed(&self.counts().into_iter().collect::<Vec<_>>(), self.language)
    }

    fn counts(&self) -> Option<Block> {
        let counted = WORDS.into_iter().filter_map(|word| {
            let count = self.outcomes.iter().filter(|(_, found)| *found == word).count();
            (count > 0).then(|| format!("{count} {}", word.of(self.language).to_lowercase()))
        });
        let has = |outcome: &Outcome| self.outcomes.iter().any(|(found, _)| found == outcome);
        let worst = [Outcome::Failed, Outcome::Undecided, Outcome::NotAsked].into_iter().find(has);
        let words = marked(worst.unwrap_or(Outcome::Passed), texts::gyros(self.outcomes.len(), doc::listed(counted)));
        (self.outcomes.len() > 1).then(|| Block::Whole("", vec![vec![words]]))
    }

    /// Returns the counts, the passport, what was assumed or not tested, and the inputs without a stated uncertainty.
    pub(crate) fn text(&self, meter_assumed: bool, gyro_type: Option<&str>) -> String {
        let Some(passport) = &self.passport else { return self.summary() };
        let (of_all, of_some): (Vec<_>, Vec<_>) = self.missing.iter().partition(|(_, number)| *number == self.results);
        let of_all: Vec<NotStated> = of_all.into_iter().map(|(what, _)| what).collect();
        let of_some = (!of_some.is_empty()).then(|| {
            texts::not_stated_for_some(doc::joined(of_some.into_iter().map(|(what, _)| not_stated(what)), "; "))
        });
        let all = [passport.clone()].into_iter().chain(assumed(meter_assumed, gyro_type.is_some()).map(Words::from));
        let all = all.chain(not_included(&of_all)).chain(of_some).map(doc::line);
        doc::typed(&self.counts().into_iter().chain(all).collect::<Vec<_>>(), self.language)
    }
}
