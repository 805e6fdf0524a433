//! The gyro over several calibrations: every parameter from the earliest to the latest, within the tolerance of the type.

use super::CalibrationPage;
use super::parameters::name_of;
use crate::calibration::parameter::Parameter;
use crate::calibration::verdict::{COVERAGE_FACTOR, Found, Verdict};
use crate::gyro::GyroType;
use crate::report::page::language::Languages;
use crate::report::page::number::{Number, column};
use crate::report::page::parts::{Table, date, heading};
use crate::report::page::texts::calibration as texts;
use crate::report::picture::accuracy::unit;
use crate::report::picture::tolerances::Strips;
use jiff::civil::Date;
use maud::{Markup, html};

/// One calibration: the day of its readings, its result, and the comparison with the type.
struct Past {
    date: Option<Date>,
    found: Found,
    verdict: Option<Verdict>,
}

/// Writes all calibrations if there are several earlier results; a single one is in the table of changes.
pub(super) fn table(page: &CalibrationPage, languages: &Languages) -> Markup {
    if page.previous.len() < 2 {
        return html! {};
    }
    let results = page.previous.iter().chain([page.result()]);
    let all: Vec<Past> = results
        .filter_map(|result| {
            let found = result.answer()?;
            let verdict = page.gyro.and_then(|gyro| result.judged(gyro));
            Some(Past { date: result.date(), found, verdict })
        })
        .collect();
    html! {
        (heading(languages, texts::HISTORY))
        (rows(page, &all, languages))
    }
}

fn rows(page: &CalibrationPage, all: &[Past], languages: &Languages) -> Markup {
    let gravity = page.gyro.map_or(page.result().gravity_m_per_s2, GyroType::gravity);
    let strips = Strips::of(all.iter().filter_map(|past| past.verdict.as_ref()));
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
    let numbers = |number: &dyn Fn(f64, f64) -> Number| {
        column(languages, each.iter().map(|(.., value, u)| Some(number(*value, *u))))
    };
    let values = numbers(&|value, u| Number::measured(value, COVERAGE_FACTOR * u));
    let us = numbers(&|_, u| Number::uncertainty(COVERAGE_FACTOR * u));
    let mut cells = Vec::with_capacity(each.len());
    let starts: Vec<usize> = (1..each.len()).filter(|place| each[*place].0 != each[*place - 1].0).collect();
    for (place, ((parameter, number, past, ..), (value, u))) in each.iter().zip(values.into_iter().zip(us)).enumerate()
    {
        // The name is shown once for its calibrations; screen readers say it in each row.
        let name = html! { (name_of(parameter.symbol())) ", " (languages.spoken(unit(*parameter))) };
        let first = place == 0 || starts.contains(&place);
        let row = past
            .verdict
            .as_ref()
            .and_then(|found| found.parameters.iter().find(|row| row.parameter == parameter.key()));
        cells.push(vec![
            if first {
                name
            } else {
                html! { span.unseen { (name) } }
            },
            past.date.map_or_else(|| html! { (number) }, |day| date(languages, day)),
            value.unwrap_or_default(),
            u.unwrap_or_default(),
            row.map_or_else(Markup::default, |row| strips.strip(row)),
        ]);
    }
    let headings = [texts::PARAMETER, texts::CALIBRATED, texts::FOUND, texts::PLUS_MINUS, texts::IN_TOLERANCE];
    let columns = if page.gyro.is_some() { headings.len() } else { headings.len() - 1 };
    cells.iter_mut().for_each(|row| row.truncate(columns));
    let foot = (0..columns).map(|place| {
        if place == 4 {
            strips.axis(languages)
        } else {
            html! {}
        }
    });
    let table = Table {
        caption: Some(languages.label(texts::HISTORY_CAPTION)),
        headings: headings.iter().take(columns).map(|text| languages.label(*text)).collect(),
        starts,
        foot: if page.gyro.is_some() { foot.collect() } else { Vec::new() },
        rows: cells,
        row_headings: 2,
        class: "numbers result past",
        ..Table::default()
    };
    table.markup(languages.spoken(texts::HISTORY_CAPTION))
}
