//! Change of the stand since its last certificate.

use super::CertificationPage;
use crate::certification::comparison::{ComparedPosition, Comparison, Test};
use crate::certification::suspects::{AXES, OUTLIER};
use crate::passport::difference::NumberDifference;
use crate::report::certification::{outcome_of, outcome_of_certification};
use crate::report::page::language::{Languages, Text, values};
use crate::report::page::number::{Cell, Number, column, probability};
use crate::report::page::parts::{
    Column, Table, field, fields, heading, mark, marked, outcome_box, starts, symbol, symbol_and_unit,
};
use crate::report::page::spacing::BLANK;
use crate::report::page::symbols::italic;
use crate::report::page::texts::{calibration, certification as texts, checks, pictures, units};
use crate::report::picture::residuals::{Bars, key_of};
use crate::report::style::Outcome;
use crate::wording::number::LEAST_PROBABILITY;
use maud::{Markup, html};

/// Writes whether the stand has changed since its last certificate, and the reasons.
pub(super) fn verdict(page: &CertificationPage, languages: &Languages) -> Markup {
    let Some((comparison, _)) = &page.change else {
        let (positions, runs) = (page.certification.stand.positions.len(), page.certification.runs.len());
        let headline = languages.label_with(|language| texts::CERTIFIED.filled(language, values! { positions, runs }));
        let not_compared = |language| html! { (mark(Outcome::NotAsked)) " " (texts::NOT_COMPARED.words(language)) };
        let words = html! { (languages.paragraph_with(not_compared)) (warnings(page, languages)) };
        return outcome_box(outcome_of_certification(page.certification), &headline, words);
    };
    let outcome = outcome_of(comparison, comparison.same_stand);
    let (verdict, remedy) = match outcome {
        Outcome::Passed => (texts::SAME, None),
        Outcome::Failed => (texts::CHANGED, Some(texts::CHANGED_WORDS)),
        Outcome::Undecided | Outcome::NotAsked => (texts::UNDECIDED, Some(texts::UNDECIDED_WORDS)),
    };
    let headline =
        languages.label_with(|language| verdict.filled(language, values! { number: comparison.certificate }));
    let reasons = html! {
        @if !comparison.findings.is_empty() {
            ul {
                @for found in &comparison.findings {
                    li { (languages.label_with(|language| found.words(language))) }
                }
            }
        }
        @if let Some(remedy) = remedy { (languages.paragraph(remedy)) }
        (warnings(page, languages))
    };
    outcome_box(outcome, &headline, reasons)
}

/// Returns the headline of a stand that has changed, for the head of every sheet; otherwise nothing.
pub(super) fn running_head(page: &CertificationPage, languages: &Languages) -> String {
    let comparison = page.change.as_ref().map(|(comparison, _)| *comparison);
    let changed = comparison.filter(|found| outcome_of(found, found.same_stand) == Outcome::Failed);
    changed.map_or_else(String::new, |found| {
        texts::CHANGED.filled(languages.first(), values! { number: found.certificate })
    })
}

/// Writes how many warnings the section of the tests has.
fn warnings(page: &CertificationPage, languages: &Languages) -> Markup {
    let count = page.certification.remarks.len();
    languages.paragraph_with(|language| {
        let words = texts::WARNINGS_COUNTED.filled(language, values! { count, section: texts::TESTS });
        html! { (words) }
    })
}

/// Writes the comparison with the last certificate, if there is one.
pub(super) fn section(page: &CertificationPage, languages: &Languages) -> Option<Markup> {
    page.change.as_ref().map(|(comparison, changes)| compared(comparison, changes, languages))
}

fn compared(comparison: &Comparison, changes: &[NumberDifference], languages: &Languages) -> Markup {
    let caption = |language| texts::CHANGE_CAPTION.filled(language, values! { number: comparison.certificate });
    let common = comparison.common.test.as_ref();
    html! {
        (heading(languages, texts::ROTATIONS))
        (rotations(comparison, languages))
        (languages.paragraph_with(|language| {
            italic(&texts::TWO_CHANGES.filled(language, values! { limit: Number::exact(OUTLIER) }))
        }))
        (fields([
            field(languages, texts::ALL_TOGETHER, Some(test(&comparison.all, languages))),
            field(languages, texts::COMMON_TURN, Some(common.map_or_else(|| html! { "–" }, |of| test(of, languages)))),
        ]))
        (table(changes, languages.label_with(caption), languages))
    }
}

/// Writes F with its degrees of freedom and its probability.
fn test(test: &Test, languages: &Languages) -> Markup {
    html! {
        (Number::chi_square(test.f()).markup(languages)) " (" (test.degrees_of_freedom) "; "
        @if test.of_u.is_finite() { (Number::at_most(test.of_u, 1).markup(languages)) } @else { "∞" } "), "
        (symbol("p", "")) (BLANK) @if test.probability >= LEAST_PROBABILITY { "=" (BLANK) } (probability(languages, test.probability))
    }
}

fn rotations(comparison: &Comparison, languages: &Languages) -> Markup {
    let positions = &comparison.positions;
    let mut columns = Vec::new();
    for (axis, name) in AXES.into_iter().enumerate() {
        let values = positions.iter().map(|at| Number::measured(at.turn_arcsec[axis], at.u_arcsec[axis]));
        let us = positions.iter().map(|at| Number::uncertainty(at.u_arcsec[axis]));
        let heading = symbol_and_unit(languages, &symbol(name, ""), units::ARCSEC);
        columns.push(Column::new(heading, column(languages, values)));
        let of_axis = html! { (symbol("u", "")) "(" (symbol(name, "")) ")" };
        columns.push(Column::new(symbol_and_unit(languages, &of_axis, units::ARCSEC), column(languages, us)));
    }
    let p = positions.iter().map(|at| Cell::probability(at.test.probability));
    columns.push(Column::named(languages, texts::PROBABILITY, column(languages, p)));
    let found = |at: &ComparedPosition| {
        let outcome = outcome_of(comparison, at.repeats);
        let word = match outcome {
            Outcome::Passed => texts::REPEATS,
            Outcome::Failed => texts::REPEATS_NOT,
            Outcome::Undecided | Outcome::NotAsked => pictures::DECISION_UNDECIDED,
        };
        marked(outcome, &languages.inline(word))
    };
    columns.push(Column::named(languages, checks::RESULT, positions.iter().map(found).collect()));
    // A telephone shows the first column and few others: the result is there too.
    let name = |at: &ComparedPosition| {
        html! { span.narrow-only { (mark(outcome_of(comparison, at.repeats))) (BLANK) } (at.index.to_string()) }
    };
    let names = positions.iter().map(|at| vec![name(at)]).collect();
    let table = Table::of(vec![languages.label(texts::POSITION)], names, &columns);
    Table { class: "numbers rotations", ..table }.markup(languages.spoken(texts::ROTATIONS))
}

/// Writes the deviations of both certificates, and their change as a number and as a bar.
fn table(changes: &[NumberDifference], caption: Markup, languages: &Languages) -> Markup {
    let of = |heading: Text, number: fn(&NumberDifference) -> Option<f64>| {
        let each = changes.iter().map(|at| Some(Number::measured(number(at)?, at.standard_uncertainty.unwrap_or(0.0))));
        // The unit belongs to the heading of each language.
        let heading = |language| format!("{},{BLANK}{}", heading.words(language), units::ARCSEC.words(language));
        Column::new(languages.label_with(heading), column(languages, each))
    };
    let us = changes.iter().map(|at| at.standard_uncertainty.map(Number::uncertainty));
    let ratios = changes.iter().map(|at| at.ratio().map(|ratio| Number::fixed(ratio, 1)));
    let change = |at: &NumberDifference| Some((at.difference()?, at.standard_uncertainty));
    let bars = Bars::over(changes.iter().filter_map(change));
    let drawn = changes.iter().map(|at| change(at).map_or_else(|| html! { "–" }, |change| bars.bar(change)));
    let drawn_within =
        languages.label_with(|language| format!("{}{BLANK}± 2u,{BLANK}″", calibration::CHANGED_BY.words(language)));
    let columns = [
        of(texts::OLD, |at| at.a),
        of(texts::NEW, |at| at.b),
        of(calibration::CHANGED_BY, NumberDifference::difference),
        Column::new(symbol_and_unit(languages, &symbol("u", ""), units::ARCSEC), column(languages, us)),
        Column::named(languages, texts::DIFFERENCE_IN_U, column(languages, ratios)),
        Column { heading: drawn_within, cells: drawn.collect(), foot: bars.axis(languages, None) },
    ];
    let names = changes.iter().map(|at| {
        let (index, angle) = of_key(&at.key);
        vec![html! { "(" (index.replace(',', ", ")) ")" }, symbol(angle, "")]
    });
    let table = Table {
        caption: Some(caption),
        starts: starts(changes.iter().map(|at| of_key(&at.key).0)),
        class: "numbers residuals changes",
        ..Table::of(vec![languages.label(texts::POSITION), languages.label(texts::ANGLE)], names.collect(), &columns)
    };
    html! {
        (table.markup(languages.spoken(texts::CHANGE)))
        (key_of(languages, pictures::CHANGE_BAR, pictures::CHANGE_LIMITS))
    }
}

/// Returns the indices and the letter of a deviation from its key, `positions[1,2].alpha_arcsec`.
fn of_key(key: &str) -> (&str, &'static str) {
    let (index, angle) = key.trim_start_matches("positions[").split_once("].").unwrap_or_default();
    let letter = match angle {
        "alpha_arcsec" => "α",
        "beta_arcsec" => "β",
        _ => "γ",
    };
    (index, letter)
}
