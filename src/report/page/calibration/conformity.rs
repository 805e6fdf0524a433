//! The result: every parameter with its expanded uncertainty, within the tolerance of the type if one was specified, and
//! its change since an earlier result.

use super::parameters::{self, name_of};
use super::{CalibrationPage, history, not_stated, subject};
use crate::calibration::NotStated;
use crate::calibration::document::CalibrationDocument;
use crate::calibration::parameter::Parameter;
use crate::calibration::verdict::{Decision, ParameterVerdict, Verdict};
use crate::gyro::GyroType;
use crate::report::page::language::{Language, Languages, Text, values};
use crate::report::page::number::{Number, column, column_with_units, probability};
use crate::report::page::parts::{Column, Table, given, heading, listed, mark, marked, quantity, symbol_and_unit};
use crate::report::page::spacing::BLANK;
use crate::report::page::symbols::italic;
use crate::report::page::texts::{calibration as texts, units};
use crate::report::picture::accuracy::unit;
use crate::report::picture::tolerances::{BESIDE_DECISIONS, decision, key, printed, unit_at_type, unit_of};
use crate::report::style::Outcome;
use crate::report::tolerance::{coverage_factor, gravity_contributes};
use crate::wording::{comparison, date_text};
use maud::{Markup, html};

pub(super) fn section(page: &CalibrationPage, languages: &Languages) -> Markup {
    let adopted = page.adopted();
    html! {
        (subject::left_out(page, languages))
        @match page.judged() {
            Some((gyro, verdict)) => (compared(page, gyro, verdict, languages)),
            None => (alone(page, languages)),
        }
        @if let Some(result) = adopted { (parameters::beyond_the_eight(result, languages)) }
        @if let Some(change) = &page.document.change {
            (heading(languages, texts::CHANGE))
            (table(languages, change, texts::CHANGE_CAPTION, [texts::EARLIER, texts::CHANGED_BY], false))
            // With two languages the two tables are seldom on one sheet.
            @if !languages.single() { (key(languages, &[change])) }
            @if !change.withheld { (simple(change, None, languages)) }
            @if let Some(earlier) = page.previous.last() {
                (languages.paragraph_with(|language| previous(page, earlier, language)))
            }
        }
        (history::table(page, languages))
    }
}

fn compared(page: &CalibrationPage, gyro: &GyroType, verdict: &Verdict, languages: &Languages) -> Markup {
    html! {
        h3 { (languages.label_with(|language| texts::CONFORMITY.filled(language, values! { type: gyro.r#type }))) }
        (table(languages, verdict, texts::VERDICT_CAPTION, [texts::NOMINAL, texts::DEVIATION], true))
        (key(languages, &[verdict]))
        @if !verdict.withheld { (simple(verdict, Some(texts::RISK_NOTE), languages)) }
        (from_gravity(page, verdict, languages))
        @if let Some(u) = page.calibration.mostly_from_turn_ons() {
            (languages.paragraph_with(|language| {
                let u = quantity(&language.into(), &Number::uncertainty(u), units::DEG_PER_H);
                texts::FROM_TURN_ONS.marked_up(language, &[("u", u)])
            }))
        }
    }
}

/// Writes which calibration is the previous one, and whether it is known to be that of this gyro.
fn previous(page: &CalibrationPage, earlier: &CalibrationDocument, language: Language) -> Markup {
    let day = earlier.date().map_or_else(|| texts::NO_DAY.words(language), |day| date_text(language, day));
    let beginning = |sha256: &str| html! { code { (sha256.chars().take(8).collect::<String>()) } };
    let sha256 = earlier.currents_sha256().map_or_else(|| html! { "–" }, beginning);
    let values = [("day", html! { (day) }), ("passport", given(&earlier.passport_id)), ("sha256", sha256)];
    let names =
        |inputs: Vec<NotStated>| listed(inputs.into_iter().map(|what| html! { (not_stated(what).words(language)) }));
    html! {
        (texts::PREVIOUS.marked_up(language, &values)) (gyro_not_confirmed(page, language))
        @for (words, inputs) in page.document.limits_of_change(earlier) {
            " " (words.marked_up(language, &[("names", names(inputs))]))
        }
    }
}

/// Writes, after a sentence, that no serial number shows the previous calibration to be that of this gyro; nothing if one does.
pub(super) fn gyro_not_confirmed(page: &CalibrationPage, language: Language) -> Markup {
    let serial = page.previous.last().and_then(CalibrationDocument::gyro_serial);
    let is_same = serial.is_some() && serial == page.document.gyro_serial();
    html! { @if !is_same { " " (texts::SAME_GYRO_NOT_SHOWN.words(language)) } }
}

/// Writes how many parameters pass by guarded acceptance, in the words of `passed`, and which are undecided or fail; `then`
/// is what follows.
pub(super) fn counted(
    verdict: &Verdict,
    passed: Text,
    then: impl Fn(Language) -> Markup,
    languages: &Languages,
) -> Markup {
    let not_found = verdict.not_found();
    let not_found_names = listed(not_found.iter().map(|one| name_of(one.symbol())));
    languages.paragraph_with(|language| {
        html! {
            (counts(verdict, |row| row.guarded, passed, language))
            @if !not_found.is_empty() {
                "; " (texts::NOT_IN_THE_MODEL.marked_up(language, &[("names", not_found_names.clone())]))
            }
            "." (then(language))
        }
    })
}

/// Writes the outcome of simple acceptance, a note on the risks in the table, which parameters no gyro could pass, which
/// would pass with the other sign, and on which the decision depends on a suspect reading.
fn simple(verdict: &Verdict, note: Option<Text>, languages: &Languages) -> Markup {
    let about = |text: Text, which: &[Parameter], language: Language| {
        let names = listed(which.iter().map(|one| name_of(one.symbol())));
        html! { @if !which.is_empty() { " " (text.marked_up(language, &[("names", names)])) } }
    };
    languages.paragraph_with(|language| {
        html! {
            @if verdict.has_simple() {
                (counts(verdict, |row| row.simple, texts::PASSED_BY_SIMPLE, language)) "."
                @if let Some(note) = note { " " (italic(&note.words(language))) }
            }
            (about(texts::TOO_UNCERTAIN, &verdict.too_uncertain(), language))
            @if !verdict.has_simple() { " " (italic(&texts::NO_RISK.words(language))) }
            (about(texts::OPPOSITE, &verdict.opposite(), language))
            @if let Some(factor) = verdict.common_factor() {
                " " (italic(&comparison::COMMON_FACTOR.filled(language, values! { factor: Number::significant(factor, 3) })))
            }
            (about(texts::DEPENDENT, &verdict.dependent(), language))
        }
    })
}

/// Writes how many parameters pass, in the words of `passed`, and which are undecided or fail.
fn counts(verdict: &Verdict, by: fn(&ParameterVerdict) -> Decision, passed: Text, language: Language) -> Markup {
    let of = |decision: Decision| verdict.parameters.iter().filter(move |row| by(row) == decision);
    let names = |decision: Decision| listed(of(decision).map(parameter));
    let values = [("passed", html! { (of(Decision::Pass).count()) }), ("all", html! { (Parameter::EIGHT.len()) })];
    let rest = [(Decision::Undecided, texts::ARE_UNDECIDED), (Decision::Fail, texts::FAIL)];
    html! {
        (passed.marked_up(language, &values))
        @for (decision, text) in rest.iter().filter(|(decision, _)| of(*decision).count() > 0) {
            (text.marked_up(language, &[("names", names(*decision))]))
        }
    }
}

/// Writes the parameters without a type: values and expanded uncertainties.
fn alone(page: &CalibrationPage, languages: &Languages) -> Markup {
    let Some(found) = page.document.found() else { return html! {} };
    let values = found.parameters.to_vector();
    let rows = Parameter::AS_IN_THE_PAPER.into_iter().filter(|parameter| !values[parameter.place()].is_nan());
    let rows: Vec<(Parameter, f64)> =
        rows.map(|parameter| (parameter, found.expanded_uncertainty(parameter))).collect();
    let each = rows.iter().map(|(parameter, expanded)| Number::measured(values[parameter.place()], *expanded));
    let expanded = rows.iter().map(|(_, expanded)| Number::uncertainty(*expanded));
    let columns = [
        Column::named(languages, texts::FOUND, column(languages, each)),
        Column::named(languages, texts::PLUS_MINUS, column(languages, expanded)),
    ];
    let with_unit = |parameter: Parameter| symbol_and_unit(languages, &name_of(parameter.symbol()), unit(parameter));
    let names = rows.iter().map(|(parameter, _)| vec![with_unit(*parameter)]).collect();
    let caption = languages.label_with(|language| {
        let factors = rows.iter().map(|(parameter, _)| found.coverage_factor(*parameter));
        texts::RESULT_CAPTION.filled(language, values! { k: coverage_factor(factors, language) })
    });
    let table = Table::of(vec![languages.label(texts::PARAMETER)], names, &columns);
    Table { caption: Some(caption), class: "numbers narrow", ..table }.markup(languages.spoken(texts::RESULT))
}

/// Writes a comparison; `with_u` says whether the standard uncertainty of a row is that of its value.
fn table(
    languages: &Languages,
    verdict: &Verdict,
    caption: Text,
    [reference, deviation]: [Text; 2],
    with_u: bool,
) -> Markup {
    let rows = &verdict.parameters;
    let expanded = ParameterVerdict::expanded_uncertainty_of_value;
    let numbers = |heading, number: &dyn Fn(&ParameterVerdict) -> Number| {
        Column::named(languages, heading, column(languages, rows.iter().map(number)))
    };
    let each = |heading, cell: &dyn Fn(&ParameterVerdict) -> Markup| {
        Column::named(languages, heading, rows.iter().map(cell).collect())
    };
    let with_unit = |row: &ParameterVerdict| {
        // A telephone shows the first column and few others: the decision is there too.
        html! {
            span.narrow-only { (mark(Outcome::of(verdict.decision(row)))) (BLANK) }
            (parameter(row)) ", " (italic(languages.spoken(unit_at_type(row.parameter))))
        }
    };
    // One digit stands before every decimal mark, so that these align where the numbers begin at one place.
    let risk = |row: &ParameterVerdict| match row.specific_risk.filter(|_| verdict.has_simple()) {
        Some(risk) => probability(languages, risk),
        None => html! { "–" },
    };
    let tolerance = |row: &ParameterVerdict| (Number::exact(row.tolerance), italic(languages.spoken(unit_of(row))));
    let tolerances = column_with_units(languages, rows.iter().map(tolerance));
    let mut columns = vec![
        numbers(texts::FOUND, &|row| Number::measured(row.value, expanded(row))),
        numbers(texts::PLUS_MINUS, &|row| Number::uncertainty(expanded(row))),
        numbers(reference, &|row| Number::measured(row.reference_value, expanded(row))),
        numbers(deviation, &|row| printed(row).0),
        numbers(texts::PLUS_MINUS, &|row| printed(row).1),
        Column::named(languages, texts::TOLERANCE, tolerances),
        Column {
            foot: BESIDE_DECISIONS.axis(languages),
            ..each(texts::IN_TOLERANCE, &|row| BESIDE_DECISIONS.of_parameter(verdict, row))
        },
        each(texts::GUARDED, &|row| decided(languages, verdict.decision(row))),
        each(texts::RISK, &risk),
    ];
    if !with_u {
        columns.remove(1);
    }
    // Values and deviations of a scale factor have different units, and so have their U.
    let (strip_and_decisions, deviations) = (3, 3);
    let values = columns.len() - deviations - strip_and_decisions;
    let groups = vec![
        (values, languages.label(texts::IN_UNIT_OF_PARAMETER)),
        (deviations, languages.label(texts::IN_UNIT_OF_TOLERANCE)),
        (strip_and_decisions, html! {}),
    ];
    let names = rows.iter().map(|row| vec![with_unit(row)]).collect();
    let table = Table {
        caption: Some(languages.label_with(|language| {
            let k = coverage_factor(rows.iter().map(|row| row.coverage_factor), language);
            let words = caption.filled(language, values! { k, g: Number::exact(verdict.gravity_m_per_s2) });
            // The rows have no room for the units of a second language.
            if language == languages.first() { words } else { words + &units_of(rows, language) }
        })),
        groups,
        class: "numbers result",
        ..Table::of(vec![languages.label(texts::PARAMETER)], names, &columns)
    };
    table.markup(languages.spoken(texts::RESULT))
}

/// Returns the units of the rows in words that go on a caption.
fn units_of(rows: &[ParameterVerdict], language: Language) -> String {
    let mut units: Vec<&str> = rows.iter().map(|row| unit_at_type(row.parameter).of(language)).collect();
    units.dedup();
    texts::UNITS.filled(language, values! { units: units.join(", ") })
}

/// Writes the caption of a table whose drifts refer to this g.
pub(super) fn with_gravity(languages: &Languages, caption: Text, gravity_m_per_s2: &Number) -> Markup {
    languages.label_with(|language| caption.filled(language, values! { g: *gravity_m_per_s2 }))
}

/// Writes the part of the deviations that comes from converting the drifts to the type's g, and the expanded uncertainty that
/// the local g adds to them, where it is most of it.
fn from_gravity(page: &CalibrationPage, verdict: &Verdict, languages: &Languages) -> Markup {
    let u = Number::uncertainty(page.document.gravity_u_m_per_s2.unwrap_or(0.0));
    let part = |&(row, part): &(&ParameterVerdict, f64), language: Language| {
        let gravity = quantity(&language.into(), &Number::significant(part, 2), unit_of(row));
        texts::FROM_GRAVITY_PART.marked_up(language, &[("gravity", gravity), ("parameter", parameter(row))])
    };
    let texts = gravity_contributes(page.content().site.is_gravity_without_height());
    html! {
        @for (text, parts) in texts.into_iter().zip(verdict.parts_from_gravity()).filter(|(_, parts)| !parts.is_empty()) {
            (languages.paragraph_with(|language| {
                let parts = listed(parts.iter().map(|one| part(one, language)));
                let u = quantity(&language.into(), &u, units::M_PER_S2);
                text.marked_up(language, &[("parts", parts), ("u", u)])
            }))
        }
    }
}

/// Returns the symbol of the parameter of `row`.
fn parameter(row: &ParameterVerdict) -> Markup {
    name_of(row.parameter.symbol())
}

/// Writes a decision with its mark, in the first language only: the key below the table has the mark in all of them.
fn decided(languages: &Languages, found: Option<Decision>) -> Markup {
    marked(Outcome::of(found), &html! { (languages.spoken(decision(found))) })
}
