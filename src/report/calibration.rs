//! Result of a calibration as text: the decision, the parameters and the fit come first, the evidence below.

use super::scatter::{Weight, correlated, scatter, too_small};
use super::tolerance::{coverage_factor, decided, from_gravity, headline, verdict_table};
use super::uncertainty::not_linear;
use crate::calibration::chi_square::FEW_DEGREES;
use crate::calibration::diagnosis::INCONSISTENT;
use crate::calibration::document::{CalibrationDocument, ResultDocument, Subject};
use crate::calibration::iterative::LARGEST_NUMBER_OF_STEPS;
use crate::calibration::prediction::FurtherVisit;
use crate::calibration::readings::Exclusion;
use crate::calibration::verdict::{BEYOND, change_in_uncertainties};
use crate::calibration::{Calibration, Hint, Method, MethodResult, Model, NotStated, Parameter, Readings, Verdict};
use crate::interface::calibrated::Done;
use crate::passport::Check;
use crate::report::page::calibration::why_no_change;
use crate::report::page::language::{Language, capital, values};
use crate::report::page::texts::calibration as texts;
use crate::report::picture::tolerances::unit_at_type;
use crate::report::verdict::counts_with_names;
use crate::report::{columns, mistake, recorded, style};
use crate::text::printable;
use crate::uncertainty::MonteCarlo;
use crate::units::{printed, quantity};
use crate::wording::plain;
use std::fmt::Write;

/// Sentence on a fit without degrees of freedom.
const UNTESTED: &str = "The fit cannot be tested: there are as many unknowns as readings (0 degrees of freedom), so any \
                        readings would fit. Measure more positions.";

/// Meaning of the columns `simple`, `risk` and `guarded` of a comparison.
const DECISIONS: &str = "simple: within the tolerance, whatever U is; risk: probability that this decision is wrong; \
                         guarded: pass or fail only if all of the interval ±U is within the tolerance or beyond it.";

/// Least effect of a further visit that is worth the time, percent of the standard uncertainty.
const LEAST_EFFECT_PERCENT: f64 = 1.0;

/// Returns the whole result: decision, parameters, fit; then methods, residuals, comparisons, and errors that the
/// residuals do not show. `gyro_type` is the name of the type that the verdict is for; without a laboratory the meter of
/// the paper was assumed. `checks` are those of the passport.
pub(crate) fn text(
    done: &Done,
    trials: Option<&MonteCarlo>,
    gyro_type: Option<&str>,
    meter_assumed: bool,
    checks: &[Check],
) -> String {
    let Done { calibration, document, readings, .. } = done;
    let verdict = gyro_type.zip(document.verdict.as_ref());
    let mut out = String::new();
    let ((outcome, word), reasons) = headline(document, gyro_type);
    let _ = writeln!(out, "{}  {reasons}", style::marked(outcome, &word));
    for warning in warnings(done, trials) {
        for line in warning.lines() {
            let words = line.trim_start_matches(' ');
            columns::paragraph(&mut out, &line[..line.len() - words.len()], words);
        }
    }
    let subject = document.subject.as_ref();
    if let Some(words) = subject.and_then(conditions) {
        columns::paragraph(&mut out, "", &words);
    }
    columns::paragraph(&mut out, "", &passport(document, checks));
    let gravity = match (document.gravity_m_per_s2, document.gravity_u_m_per_s2) {
        (gravity, Some(u)) => format!("{gravity:.0$} m/s² (u = {u:.0$} m/s²)", columns::decimals(u)),
        (gravity, None) => format!("{gravity} m/s²"),
    };
    // The matrix of the general model is at local g: only ω_g and ω_k are compared with the type.
    let of_type = verdict.map(|(_, verdict)| verdict.gravity_m_per_s2).filter(|of_type| {
        *of_type != document.gravity_m_per_s2 && calibration.adopted().is_none_or(|answer| answer.model == Model::Paper)
    });
    let refer_to = of_type.map_or_else(
        || format!("local g, {gravity}"),
        |of_type| format!("the g of the type, g₀ = {of_type} m/s²; local g: {gravity}"),
    );
    let words = format!("g-sensitive drifts refer to {refer_to}. u: standard uncertainty (k = 1).");
    columns::paragraph(&mut out, "", &words);
    left_out(&mut out, readings, done.cost_of_missing);
    parameters(&mut out, calibration, verdict.map(|(_, verdict)| verdict));
    fit(&mut out, calibration, &done.missing);
    if let Some([low, high]) = done.unchecked_range_c {
        let words = format!(
            "The temperature is not stated (--temperature-c), and was not compared with the certified range, {low}\u{a0}to\u{a0}\
             {high}\u{a0}°C."
        );
        columns::paragraph(&mut out, "", &words);
    }
    for words in assumed(meter_assumed, gyro_type) {
        columns::paragraph(&mut out, "", words);
    }
    methods(&mut out, calibration, &document.results, of_type.is_some());
    residuals(&mut out, calibration);
    if let Some((name, verdict)) = verdict {
        let words = format!(
            "Comparison with gyro type {name}; deviation and U in the unit of the tolerance; U = k u, k = {}; coverage \
             probability {:.2} %{}:",
            plain(&coverage_factor(verdict.parameters.iter().map(|row| row.coverage_factor), Language::English)),
            100.0 * (1.0 - BEYOND),
            match verdict.not_found().is_empty() {
                true =>
                    format!("; g-sensitive drifts refer to the g of the type, g₀ = {} m/s²", verdict.gravity_m_per_s2),
                false => String::new(),
            }
        );
        let _ = writeln!(out);
        columns::paragraph(&mut out, "", &words);
        verdict_table(&mut out, verdict, "deviation");
        if verdict.has_simple() {
            columns::paragraph(&mut out, "  ", DECISIONS);
        }
        let gravity = from_gravity(verdict, document.gravity_u_m_per_s2, done.without_height);
        let turn_ons = calibration.mostly_from_turn_ons().map(|u| {
            let u = quantity(&columns::two_digits(u), "deg/h");
            texts::FROM_TURN_ONS.filled(Language::English, values! { u })
        });
        gravity.iter().chain(&turn_ons).for_each(|words| columns::paragraph(&mut out, "  ", words));
    }
    if let Some((parameter, FurtherVisit { index, ratio })) = done.further {
        let percent = 100.0 * (1.0 - ratio);
        let effect = match percent < LEAST_EFFECT_PERCENT {
            true => format!("No single further visit would reduce it by {LEAST_EFFECT_PERCENT} % or more."),
            false => format!("A further visit to position {index} would reduce it most, by {percent:.0} %."),
        };
        let row = verdict.and_then(|(_, verdict)| verdict.parameter(parameter));
        let share = row.map_or(f64::NAN, |row| 100.0 * row.expanded_uncertainty / row.tolerance);
        let (symbol, share) = (parameter.symbol(), columns::two_digits(share));
        columns::paragraph(
            &mut out,
            "  ",
            &format!("Largest U relative to its tolerance: {symbol}, {share} %. {effect}"),
        );
    }
    change(&mut out, done);
    let _ = writeln!(out);
    columns::paragraph(&mut out, "", texts::CANNOT_TELL.of(Language::English));
    out
}

/// Returns that the meter was assumed, and which errors were not looked for without a gyro type.
pub(super) fn assumed(meter_assumed: bool, gyro_type: Option<&str>) -> impl Iterator<Item = &'static str> {
    let meter = meter_assumed.then_some(texts::METER_ASSUMED);
    let untested = gyro_type.is_none().then_some(texts::NOT_TESTED);
    meter.into_iter().chain(untested).map(|text| text.of(Language::English))
}

/// Returns which gyro was measured, when, by whom and at which temperature, as far as this was stated.
fn conditions(Subject { gyro_serial, date, operator, temperature_c, .. }: &Subject) -> Option<String> {
    let said = [
        gyro_serial.as_ref().map(|serial| format!("gyro {}", printable(serial))),
        date.map(|day| format!("measured on {day}")),
        operator.as_ref().map(|operator| format!("readings by {}", printable(operator))),
        temperature_c.map(|celsius| format!("at {celsius} °C")),
    ];
    let said: Vec<String> = said.into_iter().flatten().collect();
    (!said.is_empty()).then(|| capital(&said.join(", ")))
}

/// Returns what makes the parameters or their uncertainties unusable or doubtful. Several possible causes are a line each.
pub(crate) fn warnings(done: &Done, trials: Option<&MonteCarlo>) -> Vec<String> {
    let causes = done.calibration.hint.as_ref().map(Hint::each_cause).filter(|causes| causes.len() > 1);
    let each = |causes: Vec<String>| causes.iter().map(|cause| format!("\n  - {}", capital(cause))).collect::<String>();
    let first = causes.map(|causes| format!("WARNING: {}. Possible causes:{}", capital(INCONSISTENT), each(causes)));
    let said = first.iter().len();
    first.into_iter().chain(doubts(done, trials).skip(said)).collect()
}

/// Returns what makes the parameters or their uncertainties unusable or doubtful, a line each.
pub(super) fn doubts(done: &Done, trials: Option<&MonteCarlo>) -> impl Iterator<Item = String> {
    let Done { calibration, warning, earlier, unexplained, common_factor, .. } = done;
    let of_scatter = scatter(calibration).into_iter().filter(|(weight, _)| *weight == Weight::Warning);
    let others = of_scatter.map(|(_, words)| words).chain(warning.as_ref().map(|warning| format!("{warning}.")));
    let why = earlier.as_ref().and_then(|(_, why)| Some(why_no_change((*why)?).of(Language::English).to_owned()));
    let all = unusable(calibration)
        .chain(why)
        .chain(others)
        .chain(unexplained.iter().chain(common_factor).cloned())
        .chain(trials.and_then(not_linear));
    all.map(|words| format!("WARNING: {}", capital(&words)))
}

/// Returns what makes the parameters unusable: readings that do not fit, or those of another gyro.
fn unusable(calibration: &Calibration) -> impl Iterator<Item = String> {
    let inconsistent = calibration.hint.iter().map(|hint| format!("{INCONSISTENT}. {}.", capital(&hint.causes())));
    let correlated = calibration.hint.as_ref().and_then(|_| correlated(calibration));
    let mistake = calibration.mistake.as_ref().map(|mistake| plain(&mistake::words(mistake, Language::English)));
    inconsistent.chain(correlated).chain(mistake)
}

/// Returns what a program should show with the parameters, a sentence each: what makes them unusable, what the readings
/// cannot tell, and a scatter that is not the stated one.
pub(crate) fn remarks(calibration: &Calibration, readings: &Readings) -> Vec<String> {
    let mut remarks: Vec<String> = unusable(calibration).collect();
    let tested = calibration.adopted().is_some_and(|answer| answer.chi_square.judges());
    remarks.extend((!tested).then(|| UNTESTED.to_owned()));
    remarks.extend(calibration.digits.iter().flat_map(|digits| recorded::words(digits, Language::English)));
    remarks.extend(
        scatter(calibration).into_iter().filter(|(weight, _)| *weight != Weight::Usual).map(|(_, words)| plain(&words)),
    );
    remarks.extend(without_reading(readings).map(|words| words + "."));
    remarks
}

/// Writes which visits and positions were left out, and what that cost.
fn left_out(out: &mut String, readings: &Readings, cost: Option<(Parameter, f64)>) {
    for Exclusion { i, j, visit, cycle, why } in &readings.exclusions {
        let cycle = cycle.map_or_else(String::new, |cycle| format!(" in turn-on {cycle}"));
        let words = format!("Excluded: visit {visit} to position ({i}, {j}){cycle}: {}.", printable(why));
        columns::paragraph(out, "", &words);
    }
    if let Some(words) = without_reading(readings) {
        let cost = cost.map_or_else(String::new, |(parameter, ratio)| {
            format!("; u({}) is {ratio:.2} times as large as with all positions", parameter.symbol())
        });
        columns::paragraph(out, "", &format!("{words}{cost}."));
    }
}

/// Returns a sentence on the positions without a reading, without a full stop.
pub(super) fn without_reading(readings: &Readings) -> Option<String> {
    let positions: Vec<String> = readings.left_out.iter().map(ToString::to_string).collect();
    (!positions.is_empty()).then(|| format!("Positions without a reading: {}", positions.join(", ")))
}

fn in_paper_order(answer: &MethodResult) -> Vec<Parameter> {
    Parameter::in_paper_order(answer.model.parameters().iter().copied(), |parameter| *parameter)
}

/// Writes the adopted values with their uncertainties; if there is a type, as they are decided, at its g, with the decision.
fn parameters(out: &mut String, calibration: &Calibration, verdict: Option<&Verdict>) {
    let Some(answer) = calibration.adopted() else { return };
    let mut names = vec!["", "unit", answer.method.key(), "u"];
    names.extend(verdict.map(|_| "decision"));
    let rows = in_paper_order(answer).into_iter().filter_map(|parameter| {
        let judged = verdict.and_then(|verdict| Some((verdict, verdict.parameter(parameter)?)));
        let (value, u, unit) = match judged {
            Some((_, at)) => {
                (at.value, at.standard_uncertainty, unit_at_type(parameter).of(Language::English).to_owned())
            }
            None => (answer.value(parameter)?, answer.standard_uncertainty(parameter)?, printed(parameter.unit())),
        };
        let digits = columns::decimals(u);
        let mut row = vec![parameter.symbol().to_owned(), unit];
        row.extend([columns::fixed(value, digits), format!("{u:.digits$}")]);
        row.extend(judged.map(|(verdict, at)| decided(verdict.decision(at))));
        Some(row)
    });
    let _ = writeln!(out);
    columns::table(out, &names, rows);
}

/// Writes the values of the other methods next to the adopted ones.
fn comparison(out: &mut String, answer: &MethodResult, others: &[&MethodResult]) {
    let mut names = vec!["", answer.method.key()];
    let compares = answer.method == Method::LeastSquares;
    for other in others {
        names.push(other.method.key());
        names.extend(compares.then_some(columns::OFF));
    }
    let row = |parameter: Parameter| {
        let (value, u) = (answer.value(parameter)?, answer.standard_uncertainty(parameter)?);
        let digits = columns::decimals(u);
        let mut row = vec![parameter.symbol().to_owned(), columns::fixed(value, digits)];
        for other in others {
            row.push(other.value(parameter).map_or_else(String::new, |value| columns::fixed(value, digits)));
            let off = other.from_least_squares.and_then(|all| all.get(parameter.place()).copied());
            row.extend(compares.then(|| off.map_or_else(String::new, |off| columns::signed(off, 1))));
        }
        Some(row)
    };
    columns::table(out, &names, in_paper_order(answer).into_iter().filter_map(row));
    if compares {
        let words =
            "diff. / u: difference from least squares, in units of the standard uncertainty of that difference.";
        columns::paragraph(out, "  ", words);
    }
}

/// Writes ω_0 of each turn-on, the drift in time, and the test of whether a larger model is needed.
fn beyond_the_paper(out: &mut String, answer: &MethodResult) {
    for at in &answer.cycles {
        let u = answer.standard_uncertainty(Parameter::Omega0x).unwrap_or(0.0);
        let digits = columns::decimals(u);
        let ([x, y], cycle) = (at.omega0_deg_per_h.map(|value| columns::fixed(value, digits)), at.cycle);
        let _ = writeln!(out, "  turn-on {cycle}: ω_0 = ({x}, {y}) °/h");
    }
    if !answer.cycles.is_empty() {
        columns::paragraph(out, "  ", "ω_0 is the mean of the turn-ons; u is that of the long-term mean.");
    }
    if let Some(drift) = &answer.drift {
        for (axis, name) in ["x", "y"].into_iter().enumerate() {
            let (value, u) = (drift.deg_per_h_per_h[axis], drift.standard_uncertainty_deg_per_h_per_h[axis]);
            let digits = columns::decimals(u);
            let value = columns::fixed(value, digits);
            let _ = writeln!(out, "  drift in time about {name}: {value} °/h², u = {u:.digits$} °/h²");
        }
        columns::paragraph(out, "  ", "ω_0 is that at the mean time of the readings.");
    }
    if let Some(test) = &answer.model_test {
        let [further, rest] = test.degrees_of_freedom;
        let verdict = match (test.only_larger_fits, test.is_significant()) {
            (true, _) => "the paper's model does not fit the readings, and this model does",
            (false, true) => "the paper's model is not enough for this gyro",
            (false, false) => "the further parameters are not significant",
        };
        let words = format!(
            "Test of the further parameters: F = {:.2} with {further} and {rest} degrees of freedom (probability of a \
             larger value: {}): {verdict}.",
            test.f,
            columns::probability(test.probability)
        );
        columns::paragraph(out, "  ", &words);
    }
}

fn methods(out: &mut String, calibration: &Calibration, results: &[ResultDocument], at_local_g: bool) {
    let Some(answer) = calibration.adopted() else { return };
    let others: Vec<&MethodResult> =
        calibration.results.iter().filter(|result| result.method != answer.method).collect();
    if !(others.is_empty() && calibration.refused.is_empty()) {
        let _ = writeln!(out, "\nMethods{}:", if at_local_g { ", at local g" } else { "" });
    }
    if !others.is_empty() {
        comparison(out, answer, &others);
    }
    for result in results {
        let (Some(radius), Some(steps)) = (result.spectral_radius, result.iterations) else { continue };
        let predicted = result.iterations_predicted.map(|steps| steps.to_string());
        let predicted = predicted.unwrap_or_else(|| format!("more than {LARGEST_NUMBER_OF_STEPS}"));
        let radius = columns::powers(&format!("{radius:.1e}"));
        let negligible = format!("at most {}", texts::NEGLIGIBLE.of(Language::English));
        let remaining = match result.remaining_errors() {
            Some([None, None]) | None => negligible,
            Some(errors) => {
                let words = |error: Option<f64>, unit: &str| {
                    error.map_or_else(
                        || negligible.clone(),
                        |most| format!("at most {} {unit}", columns::two_digits(most)),
                    )
                };
                format!(
                    "in K {}, in the g-sensitive drifts {}",
                    words(errors[0], "°/(h·mA)"),
                    words(errors[1], "°/(h·g)")
                )
            }
        };
        let words = format!(
            "iterative: spectral radius {radius}; {predicted} steps predicted, {steps} taken; remaining error {remaining}."
        );
        columns::paragraph(out, "  ", &words);
    }
    for (method, refusal) in &calibration.refused {
        columns::paragraph(out, "  ", &format!("{}: no result: {refusal}", method.key()));
    }
}

fn fit(out: &mut String, calibration: &Calibration, missing: &[NotStated]) {
    let Some(answer) = calibration.adopted() else { return };
    if answer.chi_square.judges() {
        chi_square(out, answer);
    } else {
        let _ = writeln!(out);
        columns::paragraph(out, "", UNTESTED);
    }
    if let Some(why) = too_small(calibration) {
        columns::paragraph(out, "  ", why.of(Language::English));
    }
    beyond_the_paper(out, answer);
    for words in calibration.digits.iter().flat_map(|digits| recorded::words(digits, Language::English)) {
        columns::paragraph(out, "  ", &plain(&words));
    }
    for (_, words) in scatter(calibration).into_iter().filter(|(weight, _)| *weight != Weight::Warning) {
        columns::paragraph(out, "  ", &words);
    }
    not_stated(out, NOT_STATED, missing);
}

/// Returns which passport was used, and whether it was verified.
pub(super) fn passport(document: &CalibrationDocument, checks: &[Check]) -> String {
    let verified_as_of = document.subject.as_ref().and_then(|subject| subject.passport_verified_as_of);
    let state = verified_as_of.map_or_else(
        || "NOT VERIFIED".to_owned(),
        |time| format!("verified as of {time}: {}", counts_with_names(checks)),
    );
    format!("Passport {}, {state}", document.passport_id)
}

/// Beginning of the list of inputs that no uncertainty includes.
pub(super) const NOT_STATED: &str = "u not stated, or stated as 0, and not included in any uncertainty";

pub(super) fn not_stated(out: &mut String, what: &str, missing: &[NotStated]) {
    if !missing.is_empty() {
        let missing: Vec<&str> = missing.iter().map(|what| what.words()).collect();
        columns::paragraph(out, "", &format!("{what}: {}.", missing.join("; ")));
    }
}

fn chi_square(out: &mut String, answer: &MethodResult) {
    let chi_square = &answer.chi_square;
    let _ = writeln!(
        out,
        "\nFit: chi-square {} with {}; the probability of a larger value is {}",
        columns::chi_square(chi_square.value),
        columns::freedom(chi_square.degrees_of_freedom),
        columns::probability(chi_square.probability)
    );
    if chi_square.of_uncertainties < FEW_DEGREES {
        let words = format!(
            "The input uncertainties have {}, which the probability takes into account.",
            columns::freedom(format!("{:.0}", chi_square.of_uncertainties))
        );
        columns::paragraph(out, "  ", &words);
    } else if chi_square.is_changed_by_estimates() {
        columns::paragraph(out, "  ", texts::OF_ESTIMATES.of(Language::English));
    }
}

/// Writes the residuals of the adopted result, if there are more readings than unknowns.
fn residuals(out: &mut String, calibration: &Calibration) {
    let Some(answer) = calibration.adopted().filter(|answer| answer.chi_square.judges()) else { return };
    let _ = writeln!(out, "\nResiduals:");
    let rows = answer.residuals.iter().map(|residual| {
        let (value, normalised) = (residual.residual_deg_per_h, residual.normalised);
        let u = residual.standard_uncertainty_deg_per_h;
        let mut row = vec![residual.index.i.to_string(), residual.index.j.to_string()];
        row.extend([(value.x, u.x), (value.y, u.y)].map(|(x, u)| columns::signed(x, columns::decimals(u))));
        row.extend([normalised.x, normalised.y].map(|x| columns::signed(x, 1)));
        row
    });
    columns::table(out, &["i", "j", "x, °/h", "y, °/h", "x / u", "y / u"], rows);
}

/// Writes the change since the earlier result, and the verdict on it, if there is one.
fn change(out: &mut String, Done { document, earlier, unknown_gyro, .. }: &Done) {
    let Some((earlier, _)) = earlier else { return };
    let Some([found, before]) = document.with_earlier(earlier) else { return };
    let change = change_in_uncertainties(&found, &before);
    let each = Parameter::in_paper_order(Parameter::EIGHT.into_iter().zip(change), |(parameter, _)| *parameter);
    let words: Vec<String> = each
        .into_iter()
        .filter(|(_, change)| change.is_finite())
        .map(|(parameter, change)| format!("{} {}", parameter.symbol(), columns::signed(change, 1)))
        .collect();
    let _ = writeln!(
        out,
        "\nChange since the previous calibration, in units of its standard uncertainty (drifts at the same g):"
    );
    columns::paragraph(out, "  ", &(words.join(", ") + "."));
    if let Some(words) = unknown_gyro {
        columns::paragraph(out, "  ", &format!("WARNING: {}.", capital(words)));
    } else if document.gyro_serial().is_none() {
        columns::paragraph(out, "  ", texts::SAME_GYRO_NOT_SHOWN.of(Language::English));
    }
    let day = earlier.date().map_or_else(|| texts::NO_DAY.of(Language::English).to_owned(), |day| day.to_string());
    let sha256 = earlier.currents_sha256().map_or("–", |sha256| sha256.get(..8).unwrap_or(sha256));
    let values = values! { day, passport: printable(&earlier.passport_id), sha256 };
    columns::paragraph(out, "  ", &texts::PREVIOUS.filled(Language::English, values));
    document.limits_in_words(earlier).iter().for_each(|words| columns::paragraph(out, "  ", words));
    if let Some(verdict) = &document.change {
        let _ =
            writeln!(out, "Change compared with the tolerance of the type, which the paper states as an instability:");
        verdict_table(out, verdict, "minus previous");
    }
}
