//! The gyro over several calibrations: every parameter from the earliest to the latest, within the tolerance of the type.

use super::parameters::name_of;
use super::{CalibrationPage, NAMED_DIGITS};
use crate::calibration::CalibrationDocument;
use crate::calibration::parameter::Parameter;
use crate::calibration::verdict::{COVERAGE_FACTOR, Found, Verdict};
use crate::gyro::GyroType;
use crate::report::page::language::{Languages, values};
use crate::report::page::number::{Number, column};
use crate::report::page::parts::{Column, Table, date, heading, starts, symbol_and_unit};
use crate::report::page::texts::calibration as texts;
use crate::report::picture::accuracy::unit;
use crate::report::picture::tolerances::{BESIDE_VALUES, key, unit_at_type};
use maud::{Markup, html};

/// A calibration of the gyro, with its result at the g of the report and its comparison with the gyro type.
struct Past<'a> {
    document: &'a CalibrationDocument,
    found: Found,
    verdict: Option<Verdict>,
}

/// Writes all calibrations if there are several earlier results; with a type, a single one is in the table of changes.
pub(super) fn table(page: &CalibrationPage, languages: &Languages) -> Markup {
    if page.previous.len() < if page.gyro.is_some() { 2 } else { 1 } {
        return html! {};
    }
    let results = page.previous.iter().chain([page.document]);
    let all: Vec<Past> = results
        .filter_map(|document| {
            let found = document.found()?;
            let verdict = page.gyro.and_then(|gyro| document.judged(gyro));
            Some(Past { document, found, verdict })
        })
        .collect();
    html! {
        (heading(languages, texts::HISTORY))
        (rows(page, &all, languages))
    }
}

fn rows(page: &CalibrationPage, all: &[Past], languages: &Languages) -> Markup {
    let gravity = page.gyro.map_or(page.document.gravity_m_per_s2, GyroType::gravity);
    let (unit_of, of): (fn(_) -> _, _) =
        if page.gyro.is_some() { (unit_at_type, texts::OF_TYPE) } else { (unit, texts::OF_PLACE) };
    // The calibrations of a parameter stand below one another, so that its strips show what has changed.
    let each = Parameter::AS_IN_THE_PAPER.into_iter().flat_map(|parameter| {
        (1..).zip(all).filter_map(move |(number, past)| {
            let found = past.found.at_gravity(gravity);
            let place = parameter.place();
            let (value, u) = (found.parameters.to_vector()[place], found.standard_uncertainty[place]);
            (!value.is_nan()).then_some((parameter, number, past, value, u))
        })
    });
    let each: Vec<_> = each.collect();
    let numbers =
        |number: &dyn Fn(f64, f64) -> Number| column(languages, each.iter().map(|(.., value, u)| number(*value, *u)));
    let values = numbers(&|value, u| Number::measured(value, COVERAGE_FACTOR * u));
    let us = numbers(&|_, u| Number::uncertainty(COVERAGE_FACTOR * u));
    let starts = starts(each.iter().map(|(parameter, ..)| *parameter));
    let names = each.iter().enumerate().map(|(place, (parameter, number, past, ..))| {
        // The name is shown once for its calibrations; screen readers say it in each row.
        let name = symbol_and_unit(languages, &name_of(parameter.symbol()), unit_of(*parameter));
        let first = place == 0 || starts.contains(&place);
        let sha256 = past.document.currents_sha256().unwrap_or("–").chars().take(NAMED_DIGITS).collect::<String>();
        let without_day = |language| texts::NO_DAY_BUT_CURRENTS.filled(language, values! { number, sha256 });
        let day = past.document.date().map_or_else(|| languages.inline_with(without_day), |day| date(languages, day));
        vec![html! { @if first { (name) } @else { span.unseen { (name) } } }, day]
    });
    let names = names.collect();
    let drawn = each.iter().map(|(parameter, _, past, ..)| {
        let Some(verdict) = &past.verdict else { return Markup::default() };
        let row = verdict.parameter(*parameter);
        row.map_or_else(Markup::default, |row| BESIDE_VALUES.of_parameter(verdict, row))
    });
    let mut columns =
        vec![Column::named(languages, texts::FOUND, values), Column::named(languages, texts::PLUS_MINUS, us)];
    if page.gyro.is_some() {
        let drawn = Column::named(languages, texts::IN_TOLERANCE, drawn.collect());
        columns.push(Column { foot: BESIDE_VALUES.axis(languages), ..drawn });
    }
    let headings = [texts::PARAMETER, texts::CALIBRATED].map(|text| languages.label(text));
    let table = Table::of(headings.into(), names, &columns);
    let caption = languages.label_with(|language| {
        let g = Number::measured(
            gravity,
            if page.gyro.is_some() { 0.0 } else { page.document.gravity_u_m_per_s2.unwrap_or(0.0) },
        );
        let marks = page.gyro.map(|_| texts::HISTORY_MARKS.words(language)).unwrap_or_default();
        texts::HISTORY_CAPTION.filled(language, values! { of, g, marks })
    });
    let table = Table { caption: Some(caption), starts, class: "numbers result past", ..table };
    let verdicts: Vec<&Verdict> = all.iter().filter_map(|past| past.verdict.as_ref()).collect();
    html! { (table.markup(languages.spoken(texts::HISTORY))) @if !verdicts.is_empty() { (key(languages, &verdicts)) } }
}
