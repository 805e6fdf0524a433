//! Sentences about a calibration, for its JSON, the terminal and the page.

use super::recorded::{Digits, rounding_of};
use super::{Agreement, Calibration, DriftNoise, NoiseSource, Readings, Scatter};
use crate::wording::number::Number;
use crate::wording::texts::{calibration as texts, units};
use crate::wording::words::{Statement, joined, listed, probability};
use crate::wording::{Language, Text, Words, plain};

/// Returns the sentence on parameters that are not valid: readings that do not fit, or those of another gyro.
pub(crate) fn invalid(calibration: &Calibration) -> Option<Words> {
    match (calibration.consistent, calibration.mistake()) {
        (false, _) => Some(joined([texts::DOES_NOT_FIT, texts::DOES_NOT_FIT_WORDS], ". ")),
        (true, Some(_)) => Some(texts::MISTAKE_WORDS.into()),
        (true, None) => None,
    }
}

/// Returns what a program should show with the parameters, a sentence each: what makes them unusable, what the readings
/// cannot tell, and a scatter that is not the stated one.
pub(crate) fn remarks(calibration: &Calibration, readings: &Readings) -> Vec<String> {
    let said = |words: &Words| plain(&words.plain(Language::English));
    let words = calibration.causes.iter().map(|cause| cause.words.clone());
    let mut remarks: Vec<String> = match invalid(calibration) {
        Some(invalid) => vec![[said(&invalid)].into_iter().chain(words).collect::<Vec<_>>().join(" ")],
        None => words.collect(),
    };
    let tested = calibration.adopted().is_some_and(|answer| answer.chi_square.judges());
    remarks.extend((!tested).then(|| texts::NOT_JUDGED.of(Language::English).to_owned()));
    let scatter = scatter(calibration).into_iter().filter(|(weight, _)| *weight != Usual);
    remarks.extend(scatter.filter_map(|(_, statement)| statement.sentence(Language::English, &said)));
    remarks.extend(without_reading(readings).map(|words| words.plain(Language::English) + "."));
    remarks
}

/// Returns the positions without a reading, without a full stop.
pub(crate) fn without_reading(readings: &Readings) -> Option<Words> {
    let positions = listed(readings.left_out.iter());
    (!readings.left_out.is_empty()).then(|| texts::without_reading(positions))
}

/// Weight of what is said: programs show remarks with the parameters.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Weight {
    Usual,
    Remark,
}
use Weight::{Remark, Usual};

/// Statements about the scatter of the readings, each with its weight.
pub(crate) fn scatter(calibration: &Calibration) -> Vec<(Weight, Statement)> {
    let mut doc = vec![(Remark, Statement::of(calibration.digits.iter().flat_map(of_digits)))];
    if let Some(rows) = &calibration.row_scatter {
        let s = Words::Quantity(Number::scientific(rows.standard_deviation_ma, 2), units::MILLIAMPERES);
        doc.extend(match &rows.against_stated() {
            Some(stated) => agreement(stated, texts::ROW_SCATTER, texts::ROWS_LESS_THAN_STATED),
            None => {
                let freedom = (texts::FREEDOM, rows.degrees_of_freedom.into(), false);
                vec![(Usual, Statement::Fields(vec![(texts::ROW_DEVIATION, s, false), freedom]))]
            }
        });
    }
    if let Some(visits) = &calibration.scatter {
        // Of several turn-ons the visits are those that were meant to be.
        let has_turn_ons = calibration.adopted().is_some_and(|answer| answer.document.cycles.len() > 1);
        let less = if has_turn_ons { texts::NOISE_LESS_THAN_STATED } else { texts::LESS_THAN_STATED };
        doc.extend(agreement(visits, texts::SCATTER, less));
        let is_more = visits.agreement() == Agreement::More && calibration.visit_noise.source == NoiseSource::Estimated;
        doc.push((Remark, Statement::of(is_more.then_some(texts::NOISE_ADDED))));
    }
    doc.extend(
        calibration
            .turn_on_scatter
            .iter()
            .flat_map(|turn_ons| agreement(turn_ons, texts::TURN_ON_SCATTER, texts::NOISE_LESS_THAN_STATED)),
    );
    let noises = [(texts::VISIT_NOISE, &calibration.visit_noise), (texts::TURN_ON_NOISE, &calibration.turn_on_noise)];
    let is_estimated = noises.iter().any(|(_, noise)| noise.source == NoiseSource::Estimated);
    doc.push((if is_estimated { Remark } else { Usual }, noise(noises)));
    doc.push((
        Remark,
        Statement::of(calibration.drift_or_noise.then(|| {
            let advice = Words::All(vec![" ".into(), texts::drift_or_noise_advice("noise.visit_deg_per_h")]);
            Words::All(vec![texts::DRIFT_OR_NOISE.into(), Words::Either(Box::new("".into()), Box::new(advice))])
        })),
    ));
    doc
}

/// The noise of the gyro that the uncertainties contain.
fn noise(each: [(Text, &DriftNoise); 2]) -> Statement {
    let stated = each.into_iter().filter(|(_, noise)| noise.source != NoiseSource::NotStated);
    Statement::Fields(
        stated
            .map(|(name, noise)| {
                let deg_per_h = Words::Quantity(Number::scientific(noise.deg_per_h, 2), units::DEG_PER_H);
                let source = match noise.source {
                    NoiseSource::Estimated => texts::noise_estimated(Number::fixed(noise.degrees_of_freedom, 0)),
                    _ => texts::NOISE_STATED.into(),
                };
                (name, vec![deg_per_h, " (".into(), source, ")".into()].into(), false)
            })
            .collect(),
    )
}

/// The comparison of an observed scatter with the stated uncertainty; `less` says what to check if it is smaller.
fn agreement(found: &Scatter, what: Text, less: Text) -> Vec<(Weight, Statement)> {
    let weight = if found.agreement() == Agreement::AsStated { Usual } else { Remark };
    // A factor of 1 changes nothing.
    let factor = (found.variance_factor > 1.0).then(|| Number::significant(found.variance_factor, 2).into());
    let mut each = vec![
        (what, Number::chi_square(found.chi_square).into(), false),
        (texts::FREEDOM, found.degrees_of_freedom.into(), false),
        (texts::PROBABILITY, probability(found.probability), false),
    ];
    each.extend(factor.map(|factor| (texts::ENLARGED, factor, false)));
    let less = (found.agreement() == Agreement::Less).then_some(less);
    vec![(weight, Statement::Fields(each)), (weight, Statement::of(less))]
}

/// The sentences on the digits of the readings.
pub(crate) fn of_digits(digits: &Digits) -> Vec<Words> {
    let rounding = digits.last_digit_ma.map(|digit| {
        let [digit, u] = [Number::significant(digit, 1), Number::scientific(rounding_of(digit), 2)];
        texts::last_digit(digit, u)
    });
    let rows = digits.identical_rows.then(|| texts::IDENTICAL_ROWS.into());
    let visits = digits.identical_visits.then(|| texts::IDENTICAL_VISITS.into());
    rounding.into_iter().chain(rows).chain(visits).collect()
}
