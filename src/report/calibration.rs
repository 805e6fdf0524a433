//! Report of a calibration, composed once for a terminal and for its printed page.
//!
//! * `answer`: the first line in a terminal, and the headline of a page.
//! * `result`: parameters within their tolerances, the change since an earlier result.
//! * `fit`: agreement of the readings with the model, inputs that are not stated.
//! * `methods`: the paper's methods beside least squares.
//! * `history`: the gyro over several calibrations.

mod answer;
mod fit;
mod history;
mod methods;
mod result;

pub(crate) use answer::Answer;
pub(crate) use fit::{causes, not_stated};
pub(crate) use methods::parameters;
pub(crate) use result::{band_of_u, rule};

use super::doc::{self, Block, Words};
use crate::calibration::document::{CalibrationDocument, NoChange, ResultDocument, Subject};
use crate::calibration::parameter::{symbols, unit};
use crate::calibration::prediction::FurtherVisit;
use crate::calibration::readings::Exclusion;
use crate::calibration::stated::TemperatureOutside;
use crate::calibration::verdict::{COVERAGE_FACTOR, change_in_uncertainties};
use crate::calibration::{Calibration, NotStated, Parameter, Verdict, remarks};
use crate::gyro::GyroType;
use crate::interface::calibrated::Done;
use crate::passport::{Check, Code};
use crate::uncertainty::MonteCarlo;
use crate::wording::texts::{calibration as texts, units};
use crate::wording::{Language, Number, Text};

/// A calibration with what its report states, in a terminal and on a page.
pub(crate) struct Report<'a> {
    pub calibration: &'a Calibration,
    /// Inputs whose uncertainty no file states.
    pub missing: &'a [NotStated],
    pub document: &'a CalibrationDocument,
    pub gyro: Option<&'a GyroType>,
    /// Earlier results of the gyro, from the earliest to the latest.
    pub previous: &'a [CalibrationDocument],
    /// `true` if local g is normal gravity at 0 m, because the height of the site is unknown.
    pub without_height: bool,
    /// `true` for residuals that fit, methods that agree, and the risk of simple acceptance too.
    pub details: bool,
}

impl<'a> Report<'a> {
    pub(crate) fn of(
        done: &'a Done,
        gyro: Option<&'a GyroType>,
        previous: &'a [CalibrationDocument],
        details: bool,
    ) -> Self {
        let Done { calibration, missing, document, without_height, .. } = done;
        Self { calibration, missing, document, gyro, previous, without_height: *without_height, details }
    }

    /// Returns the sections: anchor, heading, content.
    pub(crate) fn sections(&self) -> Vec<(&'static str, Text, Vec<Block>)> {
        let mut sections = vec![
            ("result", texts::RESULT, result::section(self, false)),
            ("fit", texts::FIT, fit::section(self, false)),
            ("blind", texts::BLIND, fit::blind(self)),
        ];
        if methods::agreement(self).is_none() {
            sections.push(("methods", texts::METHODS, methods::section(self)));
        }
        sections
    }

    /// Returns what fits on a screen: a row for each parameter, the fit, and the paper's methods where they do not agree.
    fn brief(&self) -> Vec<Block> {
        [result::section(self, true), fit::section(self, true), methods::brief(self)].concat()
    }

    /// Returns the name of the gyro type and the verdict against it, or `None` if no type was specified.
    fn judged(&self) -> Option<(&str, &Verdict)> {
        self.gyro.map(|gyro| gyro.r#type.as_str()).zip(self.document.verdict.as_ref())
    }

    /// Returns what the calibration says about the gyro.
    pub(crate) fn answer(&self) -> Answer {
        Answer::of(self.document, self.gyro.map(|gyro| gyro.r#type.as_str()))
    }

    fn adopted(&self) -> Option<&ResultDocument> {
        self.document.best()
    }

    /// Returns `true` if a serial number shows that the previous result is that of this gyro.
    pub(crate) fn is_same_gyro(&self) -> bool {
        let serial = self.previous.last().and_then(CalibrationDocument::gyro_serial);
        serial.is_some() && serial == self.document.gyro_serial()
    }

    /// The visits that were excluded and the positions without a reading.
    fn left_out(&self) -> Block {
        let excluded = self.document.excluded.iter().map(|Exclusion { i, j, visit, cycle, why }| {
            let cycle = cycle.map(|cycle| format!(", {cycle}")).unwrap_or_default();
            format!("({i}, {j}), {visit}{cycle}: {why}")
        });
        let left_out = self.document.left_out.iter().map(ToString::to_string);
        let each = [(texts::EXCLUDED, excluded.collect::<Vec<_>>()), (texts::LEFT_OUT, left_out.collect())];
        let each = each.into_iter().filter(|(_, each)| !each.is_empty());
        doc::fields(each.map(|(name, each)| (name, Words::Given(each.join("; ")), true)))
    }
}

/// A value with its standard uncertainty.
fn with_u(value: f64, u: f64, unit: Text) -> Words {
    let [value, u] = [Number::measured(value, u), Number::uncertainty(u)].map(|number| Words::Quantity(number, unit));
    doc::with(value, "u", Some(u))
}

/// Returns the unit of a parameter that refers to the g of a gyro type; that of one at local g has no zero.
pub(crate) fn unit_at_type(parameter: Parameter) -> Text {
    match unit(parameter) {
        units::DEG_PER_H_PER_G => units::DEG_PER_H_PER_G0,
        other => other,
    }
}

/// The coverage factor of several expanded uncertainties, or its range: 2, or that of Student's t.
fn coverage_factor(factors: impl Iterator<Item = f64>) -> Words {
    let printed = |k: f64| Number::fixed(k, 2);
    let range = doc::range(factors, printed);
    let is_usual = |k: &Number| k.text(Language::English) == printed(COVERAGE_FACTOR).text(Language::English);
    match range.last().is_some_and(is_usual) {
        true => Number::fixed(COVERAGE_FACTOR, 0).into(),
        false => texts::student(doc::joined(range, "–")),
    }
}

/// Least effect of a further visit that is worth the time, percent of the standard uncertainty.
const LEAST_EFFECT_PERCENT: f64 = 1.0;

/// Language of the text of a result, and what the text states about its inputs.
pub(crate) struct Said<'a> {
    pub language: Language,
    /// `true` if the meter of the paper was assumed, because no laboratory is stated.
    pub meter_assumed: bool,
    /// Checks of the passport.
    pub checks: &'a [Check],
}

/// Returns the result: the verdict with what is doubtful, the parameters, the fit, and what to do. With details the sections
/// of the report follow.
pub(crate) fn text(done: &Done, trials: Option<&MonteCarlo>, report: &Report, how: &Said) -> String {
    let answer = report.answer();
    let mut doc = vec![Block::Lines("", vec![vec![doc::marked(answer.outcome, answer.word), answer.in_a_line()]])];
    for (place, warning) in doubts(done, trials).into_iter().enumerate() {
        doc.push(doc::line(warning));
        if place == 0 && done.calibration.is_invalid() {
            doc.extend(causes(&done.calibration));
        }
    }
    let mut inputs: Vec<Words> = done.document.subject.as_ref().and_then(conditions).into_iter().collect();
    inputs.push(passport(&done.document, how.checks));
    inputs.extend(remarks::without_reading(&done.readings).map(|words| {
        let cost = done
            .cost_of_missing
            .map(|(parameter, ratio)| texts::cost_of_missing(doc::symbol(parameter.symbol()), Number::fixed(ratio, 2)));
        Words::All([words].into_iter().chain(cost).chain([".".into()]).collect())
    }));
    doc.extend(inputs.into_iter().map(|words| doc::line(Words::Capital(Box::new(words)))));
    if report.details {
        for (_, heading, blocks) in report.sections() {
            doc.push(doc::heading(heading));
            doc.extend(blocks);
        }
    } else {
        doc.push(Block::Gap);
        doc.extend(report.brief());
    }
    doc.extend(remedies(done, report, how).into_iter().map(doc::line));
    doc::typed(&doc, how.language)
}

/// Returns what to do about the uncertainty, and what was assumed or not compared.
fn remedies(done: &Done, report: &Report, how: &Said) -> Vec<Words> {
    let verdict = report.judged().map(|(_, verdict)| verdict);
    let further = done.further.map(|(parameter, FurtherVisit { index, ratio })| {
        let percent = 100.0 * (1.0 - ratio);
        let effect = match percent < LEAST_EFFECT_PERCENT {
            true => texts::no_further_visit(LEAST_EFFECT_PERCENT),
            false => texts::further_visit(index, Number::fixed(percent, 0)),
        };
        let row = verdict.and_then(|verdict| verdict.parameter(parameter));
        let share = row.map_or(f64::NAN, |row| 100.0 * row.expanded_uncertainty / row.tolerance);
        let least = texts::least_certain(doc::symbol(parameter.symbol()), Number::whole_or_two_digits(share));
        doc::joined([least, effect], " ")
    });
    let unchecked = done
        .unchecked_range_c
        .map(|[low, high]| texts::temperature_not_stated("--temperature-c", Number::exact(low), Number::exact(high)));
    // Parameters that are not valid have no uncertainty to complete.
    let needed = !report.details && done.calibration.consistent;
    let missing = needed.then(|| not_included(&done.missing)).flatten();
    let more = (!report.details).then(|| texts::more("--details"));
    let assumed = assumed(how.meter_assumed, report.gyro.is_some()).map(Words::from);
    further.into_iter().chain(change(done)).chain(missing).chain(unchecked).chain(assumed).chain(more).collect()
}

/// Returns which inputs no uncertainty includes, in English with their keys; `None` if there are none.
pub(super) fn not_included(missing: &[NotStated]) -> Option<Words> {
    let each = missing.iter().map(|what| with_key(*what));
    (!missing.is_empty()).then(|| texts::not_stated_short(doc::joined(each, "; ")))
}

/// Returns the name of an input, in English with its key.
pub(super) fn with_key(what: NotStated) -> Text {
    Text { en: what.words(), ru: not_stated(what).ru }
}

/// Returns that the meter was assumed, and which errors were not looked for without a gyro type.
pub(super) fn assumed(meter_assumed: bool, has_type: bool) -> impl Iterator<Item = Text> {
    meter_assumed.then_some(texts::METER_ASSUMED).into_iter().chain((!has_type).then_some(texts::NOT_TESTED))
}

/// Returns which gyro was measured, when, by whom and at which temperature, as far as this was stated.
fn conditions(Subject { gyro_serial, date, operator, temperature_c, .. }: &Subject) -> Option<Words> {
    let given = |words: &String| Words::Given(words.clone());
    let said = [
        gyro_serial.as_ref().map(|serial| texts::of_gyro(given(serial))),
        date.map(texts::measured_on),
        operator.as_ref().map(|operator| texts::readings_by(given(operator))),
        temperature_c.map(|celsius| texts::at_temperature(Number::exact(celsius))),
    ];
    let said: Vec<Words> = said.into_iter().flatten().collect();
    (!said.is_empty()).then(|| doc::listed(said))
}

/// Returns what makes the parameters or their uncertainties unusable or doubtful. Causes of a result that is not valid are not
/// included.
pub(crate) fn doubts(done: &Done, trials: Option<&MonteCarlo>) -> Vec<Words> {
    let Done { calibration, document, warning, earlier, .. } = done;
    let invalid = remarks::invalid(calibration);
    let why = earlier.as_ref().and_then(|(_, why)| Some(texts::no_change!(NoChange, (*why)?).into()));
    // The causes of a result that is not valid follow its first sentence.
    let of_scatter = if invalid.is_some() { Vec::new() } else { fit::warnings(calibration) };
    let outside = warning.as_ref().map(temperature_outside);
    let unexplained = earlier.as_ref().and_then(|(earlier, _)| document.unexplained_in_words(earlier));
    let factor =
        document.verdict.as_ref().filter(|verdict| !verdict.withheld).and_then(Verdict::common_factor_in_words);
    let all = invalid.into_iter().chain(why).chain(of_scatter).chain(outside).chain(unexplained).chain(factor);
    all.chain(trials.and_then(not_linear)).map(texts::warning).collect()
}

/// Returns the sentence on a temperature for which the deviations are not certified.
pub(crate) fn temperature_outside(found: &TemperatureOutside) -> Words {
    let [here, low, high] = [found.here_c, found.low_c, found.high_c].map(Number::exact);
    texts::temperature_outside(here, low, high)
}

/// Returns which parameters the linear approximation is not valid for (JCGM 101, clause 8) and what to use in its place, or
/// `None` if there are none.
pub(crate) fn not_linear(found: &MonteCarlo) -> Option<Words> {
    let lines = Parameter::in_paper_order(&found.parameters, |line| line.parameter);
    let invalid: Vec<_> = lines.into_iter().filter(|line| line.first_order_valid == Some(false)).collect();
    (!invalid.is_empty()).then(|| texts::not_linear(symbols(invalid.into_iter().map(|line| line.parameter))))
}

/// Returns which passport was used, and whether it was verified.
pub(super) fn passport(document: &CalibrationDocument, checks: &[Check]) -> Words {
    let id = Words::Given(document.passport_id.clone());
    let Some(time) = document.subject.as_ref().and_then(|subject| subject.passport_verified_as_of) else {
        return texts::passport_not_verified(id);
    };
    let checked = checks.iter().filter(|check| check.passed().is_some()).count();
    let names = checks.iter().filter(|check| check.code == Code::NotAsked).map(|check| check.name.as_str());
    let names: Vec<&str> = names.collect();
    let not_asked = (!names.is_empty()).then(|| texts::and_not_asked(names.len(), doc::listed(names)));
    let said = texts::passport_checked(texts::verified_as_of(id, time), checked);
    Words::All([said].into_iter().chain(not_asked).collect())
}

/// Returns the change since the earlier result in units of its uncertainty, if no type decides on it; and whether it is that of
/// this gyro.
fn change(done: &Done) -> Vec<Words> {
    let Done { document, earlier, unknown_gyro, .. } = done;
    let Some((earlier, _)) = earlier else { return Vec::new() };
    let Some([found, before]) = document.with_earlier(earlier) else { return Vec::new() };
    let change = change_in_uncertainties(&found, &before);
    let each = Parameter::in_paper_order(Parameter::EIGHT.into_iter().zip(change), |(parameter, _)| *parameter);
    let known = each.into_iter().filter(|(_, change)| change.is_finite());
    let each = known.map(|(parameter, change)| {
        doc::joined([doc::symbol(parameter.symbol()), Number::fixed(change, 1).into()], " ")
    });
    let of_no_type = document.change.is_none().then(|| texts::in_units_of_u(doc::listed(each)));
    let unknown = unknown_gyro.as_ref().map(|_| texts::warning(texts::SAME_GYRO_NOT_SHOWN));
    of_no_type.into_iter().chain(unknown).collect()
}
