//! Table of the parameters by every method.

use super::{CalibrationPage, Section, method};
use crate::calibration::document::{ResultDocument, UncertaintyDocument};
use crate::calibration::iterative::LARGEST_NUMBER_OF_STEPS;
use crate::calibration::parameter::Parameter;
use crate::report::page::language::Languages;
use crate::report::page::number::Number;
use crate::report::page::parts::{field, fields, figure, heading, quantity, symbol};
use crate::report::page::passport::numbers::parameters;
use crate::report::page::texts::{calibration as texts, units};
use crate::report::picture::convergence::convergence;
use maud::{Markup, html};

pub(super) fn section(page: &CalibrationPage, languages: &Languages) -> Markup {
    let results = &page.result().results;
    let body = html! {
        (table(page, languages))
        @if results.iter().any(|result| result.from_least_squares.is_some()) { (languages.paragraph(texts::OFF_BY_NOTE)) }
        @for result in results {
            (anisoelasticity(result, languages))
            (iteration(result, languages))
        }
        @for (refused, _) in &page.calibration.refused {
            (languages.paragraph_with(|language| {
                let name = method(refused.key()).of(language);
                html! { (texts::NO_RESULT.filled(language, &[("method", name)])) }
            }))
        }
    };
    page.section(languages, Section::Parameters, texts::PARAMETERS, &body)
}

fn table(page: &CalibrationPage, languages: &Languages) -> Markup {
    let results = &page.result().results;
    // The adopted result comes first: it is the last of the methods.
    let rows = results.iter().rev().flat_map(|result| {
        let (values, u) = (values(result), uncertainties(&result.standard_uncertainty));
        let cells = |number: &dyn Fn(Parameter) -> Number| {
            Parameter::AS_IN_THE_PAPER.map(|parameter| number(parameter).markup(languages))
        };
        let name = match result.method.as_str() {
            "least-squares" => texts::LEAST_SQUARES,
            other => method(other),
        };
        let found = cells(&|parameter| Number::measured(values[parameter.place()], u[parameter.place()]));
        let uncertainty = cells(&|parameter| Number::uncertainty(u[parameter.place()]));
        let mut rows = vec![(html! { strong { (languages.label(name)) } }, found), (symbol("u", ""), uncertainty)];
        rows.extend(result.from_least_squares.map(|off| {
            let cells = cells(&|parameter| Number::fixed(off[parameter.place()], 1));
            (languages.label(texts::OFF_BY), cells)
        }));
        rows
    });
    let caption = Some(languages.label(texts::PARAMETERS_CAPTION));
    parameters(languages, caption, rows.collect()).markup(languages.spoken(texts::PARAMETERS_CAPTION))
}

/// Returns the eight parameters in the order of [`Parameter::EIGHT`].
fn values(result: &ResultDocument) -> [f64; 8] {
    let [[kx, kxy], [kyx, ky]] = result.k_deg_per_h_per_ma;
    let [w0x, w0y] = result.omega0_deg_per_h;
    [kx, kxy, kyx, ky, w0x, w0y, result.omega_g_deg_per_h_per_g, result.omega_k_deg_per_h_per_g]
}

/// Returns the standard uncertainties of the eight parameters in the order of `Parameter::EIGHT`.
fn uncertainties(u: &UncertaintyDocument) -> [f64; 8] {
    let [[kx, kxy], [kyx, ky]] = u.k_deg_per_h_per_ma;
    let [w0x, w0y] = u.omega0_deg_per_h;
    [kx, kxy, kyx, ky, w0x, w0y, u.omega_g_deg_per_h_per_g, u.omega_k_deg_per_h_per_g]
}

fn anisoelasticity(result: &ResultDocument, languages: &Languages) -> Markup {
    let u = result.standard_uncertainty.anisoelasticity_deg_per_h_per_g2;
    let Some((value, u)) = result.anisoelasticity_deg_per_h_per_g2.zip(u) else { return html! {} };
    let value = html! {
        (quantity(languages, &Number::measured(value, u), units::DEG_PER_H_PER_G2)) ", " (symbol("u", "")) " = "
        (quantity(languages, &Number::uncertainty(u), units::DEG_PER_H_PER_G2))
    };
    fields([field(languages, texts::ANISOELASTICITY, Some(value))])
}

/// Writes the spectral radius and the steps of the iterative method, or nothing for the other methods.
fn iteration(result: &ResultDocument, languages: &Languages) -> Markup {
    let Some((radius, steps)) = result.spectral_radius.zip(result.iterations) else { return html! {} };
    let largest = |rows: [[f64; 2]; 2]| rows.into_iter().flatten().fold(0.0, |most, x: f64| f64::max(most, x.abs()));
    let missing = |rows: Option<[[f64; 2]; 2]>, unit| {
        rows.map(|rows| quantity(languages, &Number::scientific(largest(rows), 2), unit))
    };
    let whole = |steps: u32| html! { data value=(steps) { (steps) } };
    let predicted = match result.iterations_predicted {
        Some(steps) => whole(steps),
        None => {
            let most = LARGEST_NUMBER_OF_STEPS.to_string();
            languages.inline_with(|language| texts::STEPS_OVER.filled(language, &[("most", &most)]))
        }
    };
    html! {
        (heading(languages, texts::ITERATION))
        (fields([
            field(languages, texts::SPECTRAL_RADIUS, Some(Number::scientific(radius, 2).markup(languages))),
            field(languages, texts::STEPS, Some(whole(steps))),
            field(languages, texts::STEPS_PREDICTED, Some(predicted)),
            field(
                languages,
                texts::REMAINDER_K,
                missing(result.remainder_k_deg_per_h_per_ma, units::DEG_PER_H_PER_MA),
            ),
            field(
                languages,
                texts::REMAINDER_OMEGA,
                missing(result.remainder_omega_n_deg_per_h_per_g, units::DEG_PER_H_PER_G),
            ),
        ]))
        @if let Some(drawing) = convergence(languages, result) {
            (figure(languages, "convergence", &drawing, texts::CONVERGENCE_CAPTION))
        }
    }
}
