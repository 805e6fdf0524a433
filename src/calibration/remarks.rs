//! Sentences about a calibration, for its JSON, the terminal and the page.
//!
//! * `mistake`: the sentence on a mistake that explains the result.

mod mistake;

pub(crate) use mistake::words as of_mistake;

use super::diagnosis::INCONSISTENT;
use super::recorded::{Digits, rounding_of};
use super::result::DriftTest;
use super::{Agreement, Calibration, DriftNoise, NoiseSource, Readings, Scatter, Suspect};
use crate::wording::number::{Number, Probability};
use crate::wording::texts::{calibration as texts, units};
use crate::wording::words::{Statement, listed, probability, told};
use crate::wording::{Language, Text, Words, capital, plain};

/// Returns what makes the parameters unusable: readings that do not fit, or those of another gyro.
fn unusable(calibration: &Calibration) -> impl Iterator<Item = String> {
    let inconsistent = calibration.hint.iter().map(|hint| format!("{INCONSISTENT}. {}.", capital(&hint.causes())));
    let correlated = calibration.hint.as_ref().and_then(|_| in_english(&correlated(calibration)));
    let mistake = calibration.mistake.as_ref().map(|mistake| plain(&of_mistake(mistake).plain(Language::English)));
    inconsistent.chain(correlated).chain(mistake)
}

fn in_english(statement: &Statement) -> Option<String> {
    statement.sentence(Language::English, &|words| plain(&words.plain(Language::English)))
}

/// Returns what a program should show with the parameters, a sentence each: what makes them unusable, what the readings
/// cannot tell, and a scatter that is not the stated one.
pub(crate) fn remarks(calibration: &Calibration, readings: &Readings) -> Vec<String> {
    let mut remarks: Vec<String> = unusable(calibration).collect();
    let tested = calibration.adopted().is_some_and(|answer| answer.chi_square.judges());
    remarks.extend((!tested).then(|| texts::NOT_JUDGED.of(Language::English).to_owned()));
    // The result of readings that do not fit begins with their correlation.
    let correlated = calibration.hint.is_none().then(|| correlated(calibration));
    remarks.extend(correlated.as_ref().and_then(in_english));
    let scatter = scatter(calibration).into_iter().filter(|(weight, _)| *weight != Usual);
    remarks.extend(scatter.filter_map(|(_, statement)| in_english(&statement)));
    remarks.extend(without_reading(readings).map(|words| words.plain(Language::English) + "."));
    remarks
}

/// Returns the positions without a reading, without a full stop.
pub(crate) fn without_reading(readings: &Readings) -> Option<Words> {
    let positions = listed(readings.left_out.iter());
    (!readings.left_out.is_empty()).then(|| texts::without_reading(positions))
}

/// Weight of what is said: programs show remarks and warnings with the parameters.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Weight {
    Usual,
    Remark,
    Warning,
}
use Weight::{Remark, Usual, Warning};

/// Statements about the scatter of the readings, each with its weight.
pub(crate) fn scatter(calibration: &Calibration) -> Vec<(Weight, Statement)> {
    let mut doc = vec![(Remark, Statement::of(calibration.digits.iter().flat_map(of_digits)))];
    if let Some(rows) = &calibration.row_scatter {
        let s = Words::Quantity(Number::scientific(rows.standard_deviation_ma, 2), units::MILLIAMPERES);
        doc.extend(match &rows.against_stated {
            Some(stated) => agreement(stated, texts::ROW_SCATTER, texts::ROWS_LESS_THAN_STATED),
            None => {
                let freedom = (texts::FREEDOM, rows.degrees_of_freedom.into(), false);
                vec![(Usual, Statement::Fields(vec![(texts::ROW_DEVIATION, s, false), freedom]))]
            }
        });
    }
    if let Some(visits) = &calibration.scatter {
        // Of several turn-ons the visits are those that were meant to be.
        let has_turn_ons = calibration.adopted().is_some_and(|answer| answer.cycles.len() > 1);
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
    doc.extend(calibration.suspects.iter().map(|suspect| (Warning, Statement::of(with_advice(suspect)))));
    let noises = [(texts::VISIT_NOISE, &calibration.visit_noise), (texts::TURN_ON_NOISE, &calibration.turn_on_noise)];
    let is_estimated = noises.iter().any(|(_, noise)| noise.source == NoiseSource::Estimated);
    doc.push((if is_estimated { Remark } else { Usual }, noise(noises)));
    for (test, in_order) in [(calibration.drift_test, false), (calibration.drift_in_order, true)] {
        doc.push((
            Warning,
            Statement::of(test.filter(|test| test.is_significant()).map(|test| drift(in_order, &test))),
        ));
    }
    doc.push((
        Remark,
        Statement::of(calibration.drift_or_noise.then(|| {
            let advice = Words::All(vec![" ".into(), texts::drift_or_noise_advice("noise.visit_deg_per_h")]);
            Words::All(vec![texts::DRIFT_OR_NOISE.into(), Words::Either(Box::new("".into()), Box::new(advice))])
        })),
    ));
    doc
}

/// The sentence on readings of a visit that are correlated; it may be why they do not fit.
pub(crate) fn correlated(calibration: &Calibration) -> Statement {
    Statement::of(calibration.row_correlation.map(|r| texts::rows_correlated(Number::fixed(r, 2))))
}

fn drift(in_order: bool, test: &DriftTest) -> Words {
    let [x, y] =
        [test.drift_deg_per_h_per_h.x, test.drift_deg_per_h_per_h.y].map(|drift| told(Number::scientific(drift, 2)));
    let p = Probability(test.probability);
    if in_order { texts::drifts_in_order(x, y, p, "--drift") } else { texts::drifts(x, y, p, "--drift") }
}

/// The sentences on a reading that differs from the others, and at a terminal how to leave it out.
fn with_advice(suspect: &Suspect) -> Vec<Words> {
    let Suspect { i, j, cycle, visit, .. } = *suspect;
    let how = format!(
        "Look for the cause; if there is one, leave the visit out with --exclude {i},{j},{visit},{cycle} and --why."
    );
    let advice = Words::Either(Box::new("".into()), Box::new(how.into()));
    suspicion(suspect).into_iter().chain([advice]).collect()
}

/// The sentences on a reading that differs from the others.
pub(crate) fn suspicion(suspect: &Suspect) -> Vec<Words> {
    let difference_ua = suspect.difference_ma.map(|difference| 1000.0 * difference);
    let place = Number::place_of(difference_ua[0].abs().max(difference_ua[1].abs()));
    let [jx, jy] = difference_ua.map(|difference| Number::to_place(difference, place));
    let Suspect { cycle, visit, .. } = *suspect;
    let index = suspect.index();
    let what = match suspect.row {
        Some(row) => texts::suspect_row(row, visit, index, cycle, jx, jy),
        None => texts::suspect_visit(visit, index, cycle, jx, jy),
    };
    let several = suspect.one_of_several.then(|| texts::ONE_OF_SEVERAL.into());
    [what].into_iter().chain(several).collect()
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
