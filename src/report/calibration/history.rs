//! The gyro over several calibrations: every parameter from the earliest to the latest, within the tolerance of the type.

use super::{Report, unit_at_type};
use crate::calibration::parameter::unit;
use crate::calibration::verdict::{COVERAGE_FACTOR, Verdict};
use crate::calibration::{CalibrationDocument, Parameter};
use crate::gyro::GyroType;
use crate::report::doc::{Block, On, Rows, Words, heading, in_unit, symbol};
use crate::report::picture::strips::{BESIDE_VALUES, Tolerances};
use crate::wording::Number;
use crate::wording::texts::calibration as texts;

/// A parameter of one calibration of the gyro, at the g of the report.
struct Past<'a> {
    parameter: Parameter,
    number: usize,
    document: &'a CalibrationDocument,
    value: f64,
    u: f64,
    verdict: Option<Verdict>,
}

/// All calibrations if there are several earlier results; with a type, a single one is in the table of changes.
pub(super) fn table(of: &Report) -> Vec<Block> {
    if of.previous.len() < if of.gyro.is_some() { 2 } else { 1 } {
        return Vec::new();
    }
    let gravity = of.gyro.map_or(of.document.gravity_m_per_s2, GyroType::gravity);
    let (unit_of, refers): (fn(_) -> _, _) =
        if of.gyro.is_some() { (unit_at_type, texts::OF_TYPE) } else { (unit, texts::OF_PLACE) };
    let all: Vec<_> = of.previous.iter().chain([of.document]).filter_map(|one| Some((one, one.found()?))).collect();
    // The calibrations of a parameter stand below one another, so that its strips show what has changed.
    let each = Parameter::AS_IN_THE_PAPER.into_iter().flat_map(|parameter| {
        (1..).zip(&all).filter_map(move |(number, (document, found))| {
            let (found, place) = (found.at_gravity(gravity), parameter.place());
            let (value, u) = (found.parameters.to_vector()[place], COVERAGE_FACTOR * found.standard_uncertainty[place]);
            let verdict = of.gyro.and_then(|gyro| document.judged(gyro));
            (!value.is_nan()).then_some(Past { parameter, number, document, value, u, verdict })
        })
    });
    let each: Vec<Past> = each.collect();
    let strip = |past: &Past| {
        let row = past.verdict.as_ref().and_then(|verdict| Some((verdict, verdict.parameter(past.parameter)?)));
        row.map(|(verdict, row)| BESIDE_VALUES.of_parameter(verdict, row)).unwrap_or_default()
    };
    let rows = Rows::of(&each, "numbers result past")
        .named(texts::PARAMETER, |past| {
            // The name is shown once for its calibrations; screen readers say it in each row.
            let name = in_unit(symbol(past.parameter.symbol()), unit_of(past.parameter));
            if past.number == 1 { name } else { Words::Styled("unseen", Box::new(name)) }
        })
        .named(texts::CALIBRATED, |Past { document, number, .. }| {
            let sha256: String = document.currents_sha256().unwrap_or("–").chars().take(8).collect();
            document.date().map_or_else(|| texts::no_day_but_currents(*number as u32, sha256), Words::Date)
        })
        .column(texts::FOUND, |past| Number::measured(past.value, past.u))
        .column(texts::PLUS_MINUS, |past| Number::uncertainty(past.u))
        .strips(texts::IN_TOLERANCE, strip, BESIDE_VALUES.axis())
        .only_if(of.gyro.is_some())
        .grouped_by(|past| past.parameter);
    let u = if of.gyro.is_some() { 0.0 } else { of.document.gravity_u_m_per_s2.unwrap_or(0.0) };
    let marks = if of.gyro.is_some() { Words::from(texts::HISTORY_MARKS) } else { "".into() };
    let caption = texts::history_caption(marks, refers, Number::measured(gravity, u));
    let table = rows.captioned(texts::HISTORY, caption);
    let verdicts: Vec<Verdict> = all.iter().filter_map(|(document, _)| document.judged(of.gyro?)).collect();
    let key = of.gyro.map(|_| Block::Key(Tolerances::key(verdicts.iter())));
    [heading(texts::HISTORY), table].into_iter().chain(key).map(|block| block.only(On::Page)).collect()
}
