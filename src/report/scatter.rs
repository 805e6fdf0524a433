//! Sentences on the scatter of the readings: rows of a visit, visits, turn-ons, and the noise and drift of the gyro.

use super::columns;
use super::page::Number;
use super::page::language::{Language, Text, values};
use super::page::texts::calibration as texts;
use crate::calibration::result::DriftTest;
use crate::calibration::{Agreement, Calibration, NoiseSource, Scatter, Suspect};
use crate::text::number;
use crate::wording::number::Probability;
use crate::wording::{Value, plain};

/// Weight of a sentence. Programs show remarks and warnings with the parameters.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Weight {
    Usual,
    Remark,
    Warning,
}

/// Returns what the scatter of the readings tells.
pub(super) fn scatter(calibration: &Calibration) -> Vec<(Weight, String)> {
    let mut said = Vec::new();
    let mut say = |words: String, weight: Weight| said.push((weight, words));
    let of = |found: &Scatter| if found.agreement() == Agreement::AsStated { Weight::Usual } else { Weight::Remark };
    if let Some(rows) = &calibration.row_scatter {
        match &rows.against_stated {
            Some(stated) => {
                let words =
                    agreement("Readings of a visit", stated, false, "check whether they are copies of one reading");
                say(words, of(stated));
            }
            None => {
                let words = format!(
                    "Readings of a visit have a standard deviation of {} µA ({}), which was used as the noise of \
                     the meter, because noise_ma is not stated.",
                    columns::two_digits(rows.standard_deviation_ma * 1000.0),
                    columns::freedom(rows.degrees_of_freedom)
                );
                say(words, Weight::Usual);
            }
        }
    }
    // The result of readings that do not fit begins with it.
    if let Some(words) = correlated(calibration).filter(|_| calibration.hint.is_none()) {
        say(words, Weight::Warning);
    }
    const CHECK: &str = "check the noise that the gyro type states";
    let of_visits = match calibration.adopted().map_or(1, |answer| answer.cycles.len()) {
        0 | 1 => {
            "if these readings were taken without leaving the position, give them the same number in the column visit"
        }
        _ => CHECK,
    };
    let each = [
        ("Visits to a position", &calibration.scatter, &calibration.visit_noise, of_visits),
        ("Turn-ons", &calibration.turn_on_scatter, &calibration.turn_on_noise, CHECK),
    ];
    for (what, found, noise, less) in each {
        if let Some(found) = found {
            say(agreement(what, found, noise.is_estimated(), less), of(found));
        }
    }
    for suspect in &calibration.suspects {
        say(suspicion(suspect), Weight::Warning);
    }
    let each = [("visit to visit", &calibration.visit_noise), ("turn-on to turn-on", &calibration.turn_on_noise)];
    for (between, noise) in each.into_iter().filter(|(_, noise)| noise.source == NoiseSource::Estimated) {
        let words = format!(
            "Noise of the gyro from {between}, estimated: {} °/h ({}).",
            columns::two_digits(noise.deg_per_h),
            columns::freedom(noise.degrees_of_freedom)
        );
        say(words, Weight::Remark);
    }
    if calibration.drift_or_noise {
        let untested = texts::DRIFT_OR_NOISE.of(Language::English);
        let advice = "Visit more positions again, or state noise.visit_deg_per_h in the gyro type.";
        say(format!("{untested} {advice}"), Weight::Remark);
    }
    if let Some(test) = calibration.drift_test.filter(|test| test.is_significant()) {
        say(plain(&drift(texts::DRIFTS, &test, Language::English)), Weight::Warning);
    }
    if let Some(test) = calibration.drift_in_order.filter(|test| test.is_significant()) {
        say(plain(&drift(texts::DRIFTS_IN_ORDER, &test, Language::English)), Weight::Warning);
    }
    said
}

/// Returns the sentence on readings of a visit that are correlated; it may be why they do not fit.
pub(super) fn correlated(calibration: &Calibration) -> Option<String> {
    let r = Number::fixed(calibration.row_correlation?, 2);
    Some(texts::ROWS_CORRELATED.filled(Language::English, values! { r }))
}

/// Returns the sentence on a reading that differs from the others.
fn suspicion(suspect: &Suspect) -> String {
    let Suspect { i, j, cycle, visit, .. } = *suspect;
    let of_visit = format!("visit {visit} to position ({i}, {j}) in turn-on {cycle}");
    let what = match suspect.row {
        None => format!("{of_visit} differs from the other visits"),
        Some(row) => format!("row {row} of {of_visit} differs from the other rows of the visit"),
    };
    let either = if suspect.one_of_several {
        format!(" {}", texts::ONE_OF_SEVERAL.of(Language::English))
    } else {
        String::new()
    };
    let difference_ua = suspect.difference_ma.map(|difference| 1000.0 * difference);
    let decimals = number::decimals(difference_ua[0].abs().max(difference_ua[1].abs()));
    let [jx, jy] = difference_ua.map(|difference| number::signed(difference, decimals));
    format!(
        "{what} by ({jx}, {jy}) µA ({}).{either} Look for the cause; if there is one, leave the visit out with \
         --exclude {i},{j},{visit},{cycle} and --why.",
        Probability(suspect.probability).said(Language::English)
    )
}

/// Returns the sentence on a drift that the residuals show.
pub(super) fn drift(text: Text, test: &DriftTest, language: Language) -> String {
    let [x, y] = [test.drift_deg_per_h_per_h.x, test.drift_deg_per_h_per_h.y].map(|drift| Number::scientific(drift, 2));
    let p = Probability(test.probability);
    text.filled(language, values! { x, y, p, option: "--drift" })
}

/// Returns why chi-square is much smaller than expected, if it is.
pub(in crate::report) fn too_small(calibration: &Calibration) -> Option<Text> {
    let drifts = [calibration.drift_test, calibration.drift_in_order];
    let turn_ons = calibration.adopted().map_or(1, |answer| answer.cycles.len());
    let is_multiplied = calibration.scatter.is_some_and(|scatter| scatter.variance_factor > 1.0);
    let is_enlarged = is_multiplied || calibration.visit_noise.is_estimated();
    let why = match is_enlarged {
        true if drifts.iter().flatten().any(DriftTest::is_significant) => texts::TOO_SMALL_BY_TREND,
        true if turn_ons < 2 || is_multiplied => texts::TOO_SMALL_OR_TURN_ONS,
        _ => texts::TOO_SMALL,
    };
    calibration.fits_too_well().then_some(why)
}

/// Returns a sentence that compares an observed scatter with the stated uncertainty. If `has_noise`, the noise of the gyro
/// is estimated from it; `less` is the advice if the scatter is smaller.
fn agreement(what: &str, found: &Scatter, has_noise: bool, less: &str) -> String {
    let verdict = match found.agreement() {
        Agreement::More if found.variance_factor > 1.0 => {
            format!("more than stated, so the variance was multiplied by {:.1}", found.variance_factor)
        }
        Agreement::More => "more than stand and meter explain; the rest is taken as noise of the gyro".to_owned(),
        Agreement::AsStated if has_noise => {
            "not clearly more than stand and meter explain; the rest is taken as noise of the gyro".to_owned()
        }
        Agreement::AsStated => "as stated".to_owned(),
        Agreement::Less => format!("less than stated; {less}"),
    };
    format!(
        "{what} scatter with a chi-square of {} ({}; probability of a larger value: {}): {verdict}.",
        columns::chi_square(found.chi_square),
        columns::freedom(found.degrees_of_freedom),
        columns::probability(found.probability)
    )
}
