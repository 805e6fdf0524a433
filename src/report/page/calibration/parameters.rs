//! Parameters by every method, and what the methods say besides: steps, matrices, drift in time.

use super::conformity::with_gravity;
use super::{CalibrationPage, method};
use crate::calibration::Method;
use crate::calibration::analytic::NoAnalyticSolution;
use crate::calibration::document::ResultDocument;
use crate::calibration::iterative::{LARGEST_NUMBER_OF_STEPS, NoIterativeSolution};
use crate::calibration::parameter::Parameter;
use crate::calibration::result::MethodRefusal;
use crate::report::page::language::{Language, Languages, Text, values};
use crate::report::page::number::{Cell, Number, column};
use crate::report::page::parts::{Column, Table, field, fields, figure, heading, quantity, symbol, symbol_and_unit};
use crate::report::page::passport::numbers::parameters;
use crate::report::page::symbols::italic;
use crate::report::page::texts::{calibration as texts, units};
use crate::report::picture::convergence::convergence;
use crate::wording::number::Probability;
use crate::wording::spacing::BLANK;
use maud::{Markup, html};

pub(super) fn section(page: &CalibrationPage, languages: &Languages) -> Markup {
    let results = &page.document.results;
    html! {
        (table(page, languages))
        @if has_least_squares(results) && results.iter().any(|result| result.from_least_squares.is_some()) {
            (languages.paragraph(texts::OFF_BY_NOTE))
        }
        @for result in results { (iteration(result, languages)) }
        @for (refused, refusal) in &page.calibration.refused {
            (languages.paragraph_with(|language| {
                let (method, why) = (method(refused.key()), reason(refusal, language));
                italic(&texts::NO_RESULT.filled(language, values! { method, why }))
            }))
        }
    }
}

/// Returns the reason why a method gave no result.
fn reason(refusal: &MethodRefusal, language: Language) -> String {
    match refusal {
        MethodRefusal::Analytic(NoAnalyticSolution::EightPositionsMissing)
        | MethodRefusal::Iterative(NoIterativeSolution::EightPositionsMissing) => texts::EIGHT_MISSING.words(language),
        MethodRefusal::Analytic(NoAnalyticSolution::SingularCurrents)
        | MethodRefusal::Iterative(NoIterativeSolution::SingularCurrents) => texts::SINGULAR.words(language),
        MethodRefusal::Iterative(NoIterativeSolution::Diverges(radius) | NoIterativeSolution::TooManySteps(radius)) => {
            texts::DIVERGES.filled(language, values! { radius: Number::significant(*radius, 2) })
        }
        MethodRefusal::NotThisModel => texts::NOT_THIS_MODEL.words(language),
        // Without least squares there is no report.
        MethodRefusal::LeastSquares(refusal) => refusal.to_string(),
    }
}

/// Returns `true` if the values from which the others differ are among the results.
fn has_least_squares(results: &[ResultDocument]) -> bool {
    results.iter().any(|result| result.method == Method::LeastSquares.key())
}

fn table(page: &CalibrationPage, languages: &Languages) -> Markup {
    let results = &page.document.results;
    let rows = results.iter().flat_map(|result| {
        let [values, u] = values(result);
        let cells = |number: &dyn Fn(Parameter) -> Number| {
            // The general model has no ω_g and ω_k.
            let found = |parameter: &Parameter| !values[parameter.place()].is_nan();
            Parameter::AS_IN_THE_PAPER.map(|parameter| Cell::from(Some(parameter).filter(found).map(number)))
        };
        let adopted = page.adopted().is_some_and(|adopted| adopted.method == result.method);
        let method = method(&result.method);
        let name = languages.label_with(|language| match adopted {
            true => texts::ADOPTED.filled(language, values! { method }),
            false => method.words(language),
        });
        let found = cells(&|parameter| Number::measured(values[parameter.place()], u[parameter.place()]));
        let uncertainty = cells(&|parameter| Number::uncertainty(u[parameter.place()]));
        let mut rows = vec![(html! { strong { (name) } }, found), (symbol("u", ""), uncertainty)];
        rows.extend(result.from_least_squares.filter(|_| has_least_squares(results)).map(|off| {
            let cells = cells(&|parameter| Number::fixed(off[parameter.place()], 1));
            (languages.label(texts::OFF_BY), cells)
        }));
        rows
    });
    let (g, u) = (page.document.gravity_m_per_s2, page.document.gravity_u_m_per_s2);
    let caption = with_gravity(languages, texts::PARAMETERS_CAPTION, &Number::measured(g, u.unwrap_or(0.0)));
    let table = Table { caption: Some(caption), ..parameters(languages, rows.collect()) };
    table.markup(languages.spoken(texts::METHODS))
}

/// Writes the terms of a model that goes beyond the eight parameters.
pub(super) fn beyond_the_eight(result: &ResultDocument, languages: &Languages) -> Markup {
    html! { (anisoelasticity(result, languages)) (general(result, languages)) (changing(result, languages)) }
}

/// Returns the eight parameters and their standard uncertainties in the order of [`Parameter::EIGHT`].
pub(super) fn values(result: &ResultDocument) -> [[f64; 8]; 2] {
    let found = result.found(1.0, None);
    [found.parameters.to_vector(), found.standard_uncertainty]
}

fn anisoelasticity(result: &ResultDocument, languages: &Languages) -> Markup {
    let u = result.standard_uncertainty.anisoelasticity_deg_per_h_per_g2;
    let Some((value, u)) = result.anisoelasticity_deg_per_h_per_g2.zip(u) else { return html! {} };
    let value = with_uncertainty(languages, value, u, units::DEG_PER_H_PER_G2);
    fields([field(languages, texts::ANISOELASTICITY, Some(value))])
}

/// Returns a value with its standard uncertainty.
fn with_uncertainty(languages: &Languages, value: f64, u: f64, unit: Text) -> Markup {
    html! {
        (quantity(languages, &Number::measured(value, u), unit)) ", " (symbol("u", "")) (BLANK) "=" (BLANK)
        (quantity(languages, &Number::uncertainty(u), unit))
    }
}

/// Writes the matrix of the general model and the test of whether it is needed.
fn general(result: &ResultDocument, languages: &Languages) -> Markup {
    let u = result.standard_uncertainty.g_matrix_deg_per_h_per_g;
    let Some((matrix, u)) = result.g_matrix_deg_per_h_per_g.zip(u) else { return html! {} };
    let (elements, us) = (matrix.as_flattened(), u.as_flattened());
    let values = elements.iter().zip(us).map(|(value, u)| Number::measured(*value, *u));
    let columns = [
        Column::named(languages, texts::FOUND, column(languages, values)),
        Column::new(symbol("u", ""), column(languages, us.iter().map(|u| Number::uncertainty(*u)))),
    ];
    let name = |index| vec![symbol_and_unit(languages, &symbol("G", index), units::DEG_PER_H_PER_G)];
    let names = ["xx", "xy", "xz", "yx", "yy", "yz"].map(name).to_vec();
    let table = Table::of(vec![languages.label(texts::PARAMETER)], names, &columns);
    html! {
        (heading(languages, texts::G_MATRIX))
        (Table { class: "numbers narrow", ..table }.markup(languages.spoken(texts::G_MATRIX)))
        @if let Some(test) = &result.model_test {
            (languages.paragraph_with(|language| {
                let [further, rest] = &test.degrees_of_freedom;
                let (f, p) = (Number::significant(test.f, 3), Probability(test.probability));
                italic(&texts::MODEL_TEST.filled(language, values! { f, further, rest, p }))
            }))
        }
    }
}

/// Writes ω_0 of each turn-on and the drift in time.
fn changing(result: &ResultDocument, languages: &Languages) -> Markup {
    let drift = result.drift_deg_per_h_per_h.zip(result.standard_uncertainty.drift_deg_per_h_per_h);
    html! {
        @if result.method == "least-squares" && !result.cycles.is_empty() {
            (heading(languages, texts::CYCLES))
            (turn_ons(result, languages))
        }
        @if let Some((drift, u)) = drift {
            (fields([texts::DRIFT_X, texts::DRIFT_Y].into_iter().zip(drift.into_iter().zip(u)).map(|(name, (drift, u))| {
                field(languages, name, Some(with_uncertainty(languages, drift, u, units::DEG_PER_H2)))
            })))
        }
    }
}

/// Writes ω_0 of each turn-on, to the digits of their mean.
fn turn_ons(result: &ResultDocument, languages: &Languages) -> Markup {
    let us = result.standard_uncertainty.omega0_deg_per_h;
    let columns = [("0x", 0), ("0y", 1)].map(|(index, axis)| {
        let values = result.cycles.iter().map(|at| Number::measured(at.omega0_deg_per_h[axis], us[axis]));
        let heading = symbol_and_unit(languages, &symbol("ω", index), units::DEG_PER_H);
        Column::new(heading, column(languages, values))
    });
    let names = result.cycles.iter().map(|at| vec![html! { (at.cycle) }]).collect();
    let table = Table::of(vec![languages.label(texts::CYCLE)], names, &columns);
    Table { class: "numbers narrow", ..table }.markup(languages.spoken(texts::CYCLES))
}

/// Writes the spectral radius and the steps of the iterative method, or nothing for the other methods.
fn iteration(result: &ResultDocument, languages: &Languages) -> Markup {
    let Some((radius, steps)) = result.spectral_radius.zip(result.iterations) else { return html! {} };
    let errors = result.remaining_errors();
    let remaining = |place: usize, unit| {
        errors.map(|errors| match errors[place] {
            None => languages.inline(texts::NEGLIGIBLE),
            Some(most) => quantity(languages, &Number::scientific(most, 2), unit),
        })
    };
    let whole = |steps: u32| html! { data value=(steps) { (steps) } };
    let predicted = match result.iterations_predicted {
        Some(steps) => whole(steps),
        None => languages
            .inline_with(|language| texts::STEPS_OVER.filled(language, values! { most: LARGEST_NUMBER_OF_STEPS })),
    };
    let steps = fields([
        field(languages, texts::SPECTRAL_RADIUS, Some(Number::scientific(radius, 2).markup(languages))),
        field(languages, texts::STEPS, Some(whole(steps))),
        field(languages, texts::STEPS_PREDICTED, Some(predicted)),
        field(languages, texts::REMAINDER_K, remaining(0, units::DEG_PER_H_PER_MA)),
        field(languages, texts::REMAINDER_OMEGA, remaining(1, units::DEG_PER_H_PER_G)),
    ]);
    html! {
        (heading(languages, texts::ITERATIVE))
        @match convergence(languages, result) {
            Some(drawing) => div.with-figure {
                (steps)
                (figure(languages, "convergence", &drawing, texts::CONVERGENCE_CAPTION))
            },
            None => (steps),
        }
    }
}

/// Writes the name of a parameter as a symbol with its index.
pub(super) fn name_of(name: &str) -> Markup {
    let (letter, index) = name.split_once('_').unwrap_or((name, ""));
    symbol(letter, index)
}
