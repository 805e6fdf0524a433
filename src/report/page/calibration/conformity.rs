//! Comparison of the parameters with the type's tolerance, and their change since an earlier result.

use super::{CalibrationPage, Section};
use crate::calibration::parameter::Parameter;
use crate::calibration::verdict::{Decision, ParameterVerdict, Verdict};
use crate::report::page::language::{Languages, Text};
use crate::report::page::number::Number;
use crate::report::page::parts::{Table, figure, heading, quantity, symbol};
use crate::report::page::texts::{calibration as texts, units};
use crate::report::picture::tolerances::{decision, parameter_of, printed, tolerances, unit_of};
use maud::{Markup, html};

/// Limit below which a risk is not printed as a number.
const LEAST_RISK: f64 = 1e-6;

pub(super) fn sections(page: &CalibrationPage, languages: &Languages) -> Markup {
    let Some((gyro, verdict)) = page.judged() else { return html! {} };
    let body = html! {
        p { (languages.inline_with(|language| texts::CONFORMITY.filled(language, &[("type", &gyro.r#type)]))) }
        (table(languages, verdict, texts::VERDICT_CAPTION, [texts::NOMINAL, texts::DEVIATION]))
        (languages.paragraph(texts::RISK_NOTE))
        @for row in verdict.parameters.iter().filter(|row| row.is_mostly_from_gravity()) {
            (from_gravity(page, row, languages))
        }
        (figure(languages, "tolerances", &tolerances(languages, "tolerances", verdict), texts::TOLERANCES_CAPTION))
        @if let Some(change) = &page.result().change {
            (heading(languages, texts::CHANGE))
            (table(languages, change, texts::CHANGE_CAPTION, [texts::EARLIER, texts::CHANGED_BY]))
            (figure(languages, "changes", &tolerances(languages, "changes", change), texts::CHANGES_CAPTION))
        }
    };
    page.section(languages, Section::Conformity, texts::TOLERANCES, &body)
}

fn table(languages: &Languages, verdict: &Verdict, caption: Text, [reference, deviation]: [Text; 2]) -> Markup {
    let headings = [
        texts::PARAMETER,
        reference,
        texts::FOUND,
        deviation,
        texts::EXPANDED_SHORT,
        texts::TOLERANCE,
        texts::UNIT,
        texts::SIMPLE,
        texts::RISK,
        texts::GUARDED,
    ];
    let table = Table {
        caption: Some(languages.label(caption)),
        headings: headings.map(|text| languages.label(text)).into(),
        rows: verdict.parameters.iter().map(|row| cells(languages, row)).collect(),
        row_headings: 1,
        class: "numbers",
        ..Table::default()
    };
    table.markup(languages.spoken(caption))
}

/// Writes the expanded uncertainty that the local g adds to a drift converted to the type's g.
fn from_gravity(page: &CalibrationPage, row: &ParameterVerdict, languages: &Languages) -> Markup {
    let part = Number::uncertainty(row.expanded_uncertainty_from_gravity.unwrap_or(0.0));
    let u = Number::uncertainty(page.result().gravity_u_m_per_s2.unwrap_or(0.0));
    let values = [
        ("parameter", parameter(row)),
        ("gravity", quantity(languages, &part, unit_of(row))),
        ("u", quantity(languages, &u, units::M_PER_S2)),
    ];
    languages.paragraph_with(|language| texts::FROM_GRAVITY.marked_up(language, &values))
}

/// Returns the symbol of the parameter of `row`.
fn parameter(row: &ParameterVerdict) -> Markup {
    let name = parameter_of(row).map_or(row.parameter, Parameter::symbol);
    let (letter, index) = name.split_once('_').unwrap_or((name, ""));
    symbol(letter, index)
}

fn cells(languages: &Languages, row: &ParameterVerdict) -> Vec<Markup> {
    let (deviation, expanded) = printed(row);
    let decided = |found: Decision| {
        let words = languages.label(decision(found));
        match found {
            Decision::Pass => html! { span.passed { (words) } },
            Decision::Undecided => words,
            Decision::Fail => html! { strong.failed { (words) } },
        }
    };
    vec![
        parameter(row),
        Number::measured(row.reference_value, row.standard_uncertainty).markup(languages),
        Number::measured(row.value, row.standard_uncertainty).markup(languages),
        deviation.markup(languages),
        expanded.markup(languages),
        Number::exact(row.tolerance).markup(languages),
        languages.inline(unit_of(row)),
        decided(row.simple),
        probability(languages, row.specific_risk),
        decided(row.guarded),
    ]
}

/// Writes a probability with two digits, or as less than `LEAST_RISK`.
pub(super) fn probability(languages: &Languages, p: f64) -> Markup {
    if p < LEAST_RISK {
        let limit = Number::scientific(LEAST_RISK, 1);
        return languages
            .inline_with(|language| texts::BELOW.filled(language, &[("limit", &limit.text(languages.first()))]));
    }
    let number = if p < 0.01 { Number::scientific(p, 2) } else { Number::fixed(p, 2) };
    number.markup(languages)
}
