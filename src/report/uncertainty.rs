//! Uncertainty budget as text and as JSON, and result of a Monte Carlo run as text.

use crate::calibration::CalibrationDocument;
use crate::calibration::Parameter;
use crate::calibration::document::finite;
use crate::calibration::verdict::ParameterVerdict;
use crate::report::columns::{self, grouped};
use crate::report::page::Language;
use crate::report::page::texts::calibration as texts;
use crate::report::style::{self, Outcome};
use crate::uncertainty::budget::COVERAGE;
use crate::uncertainty::monte_carlo::Distribution;
use crate::uncertainty::{Budget, Contribution, MonteCarlo, ParameterBudget};
use crate::units::{printed, quantity};
use serde_json::{Value, json};
use std::fmt::Write;

/// Effective degrees of freedom above which ∞ is printed.
pub(crate) const MANY: f64 = 1e4;

/// Share of the variance below which contributions are combined into one line.
const SHARE_SHOWN: f64 = 5e-4;

/// Returns `sentence` and the budget of every parameter, the largest contribution first; below those of the drifts that
/// the verdict of `document` refers to another g, what the local g adds.
pub(crate) fn budget(budget: &Budget, sentence: Option<&str>, document: &CalibrationDocument) -> String {
    let verdict = document.verdict.as_ref();
    let mut out = String::new();
    let _ = writeln!(out, "\nUncertainty budget ({}), linear approximation, drifts at local g", budget.method.key());
    if let Some(sentence) = sentence {
        let relative = match verdict {
            None => "its value",
            Some(verdict) if verdict.parameters.iter().any(ParameterVerdict::is_mostly_from_gravity) => {
                "its tolerance, excluding local g"
            }
            Some(_) => "its tolerance",
        };
        columns::paragraph(
            &mut out,
            "",
            &columns::powers(&format!("Largest uncertainty relative to {relative}: {sentence}.")),
        );
    }
    if document.scatter.is_some() {
        columns::paragraph(&mut out, "", texts::BUDGET_MEANS.of(Language::English));
    }
    for line in Parameter::in_paper_order(&budget.parameters, |line| line.parameter) {
        parameter(&mut out, line);
        if let Some(verdict) = verdict
            && let Some(row) = verdict.parameter(line.parameter)
            && let Some(part) = row.u_from_gravity()
        {
            let (g, u) = (verdict.gravity_m_per_s2, row.standard_uncertainty);
            let digits = columns::decimals(u);
            let more = digits + 1;
            let words = format!("at g₀ = {g} m/s²: contribution of local g {part:.more$}; combined u = {u:.digits$}.");
            columns::paragraph(&mut out, "  ", &words);
        }
    }
    out
}

/// Width of a terminal that has room for the number of inputs of each kind.
const WITH_COUNTS: usize = 80;

fn parameter(out: &mut String, line: &ParameterBudget) {
    let u = line.standard_uncertainty;
    let digits = columns::decimals(u);
    let freedom = match line.effective_degrees_of_freedom {
        known if known > MANY => "∞".to_owned(),
        known => columns::degrees_of_freedom(known),
    };
    let _ = writeln!(
        out,
        "\n{} = {:.digits$} {}, u = {u:.digits$}; degrees of freedom: {freedom}",
        line.parameter.symbol(),
        line.value,
        printed(line.parameter.unit()),
    );
    let large = line.contributions.iter().filter(|part| part.share >= SHARE_SHOWN).count();
    // A single small contribution is printed as it is.
    let shown = if large + 1 == line.contributions.len() { large + 1 } else { large };
    let (shown, rest) = line.contributions.split_at(shown);
    // One digit more than u has: the small ones can be told from 0.
    let digits = digits + 1;
    let mut rows: Vec<Vec<String>> = shown.iter().map(|part| contribution(part, digits)).collect();
    if !rest.is_empty() {
        let sum: f64 = rest.iter().map(|part| part.contribution * part.contribution).sum();
        let share: f64 = rest.iter().map(|part| part.share).sum();
        let share = if share < SHARE_SHOWN { "< 0.1".to_owned() } else { format!("{:.1}", 100.0 * share) };
        let name = format!("{} others", rest.len());
        rows.push(vec![name, String::new(), String::new(), format!("{:.digits$}", sum.sqrt()), share]);
    }
    let mut names = vec!["input", "u of input", "inputs", "contribution", "share, %"];
    if columns::width() < WITH_COUNTS {
        names.remove(2);
        rows.iter_mut().for_each(|row| {
            row.remove(2);
        });
    }
    columns::table(out, &names, rows);
}

fn contribution(part: &Contribution, digits: usize) -> Vec<String> {
    let [low, high] = part.standard_uncertainty.map(|u| part.cause.shown(u));
    let size = if part.has_several_sizes() { format!("{}–{}", short(low), short(high)) } else { short(high) };
    vec![
        part.cause.kind(),
        match part.cause.unit() {
            "1" => size,
            unit => quantity(&size, unit),
        },
        part.inputs.to_string(),
        format!("{:.digits$}", part.contribution),
        format!("{:.1}", 100.0 * part.share),
    ]
}

fn short(value: f64) -> String {
    if value < 1e-3 { columns::two_digits(value) } else { format!("{:.*}", columns::decimals(value).max(1), value) }
}

/// Returns a budget as JSON, `{method, sentence, parameters, covariance, inputs}`: the key `budget` of `calibrate`. The
/// parameters have their `contributions`; `changes` of an input are those of the parameters, for one standard uncertainty.
pub(crate) fn budget_json(budget: &Budget, sentence: Option<&str>) -> Value {
    let contribution = |part: &Contribution| {
        json!({
            "input": part.cause.kind(), "inputs": part.inputs, "source": part.cause.source(),
            "input_unit": part.cause.unit(),
            "input_standard_uncertainty": part.cause.shown(part.standard_uncertainty[1]),
            "contribution": part.contribution, "share": part.share,
        })
    };
    let parameters = budget.parameters.iter().map(|line| {
        stated(json!({
            "parameter": line.parameter.key(), "unit": line.parameter.unit(), "value": line.value,
            "standard_uncertainty": line.standard_uncertainty,
            "effective_degrees_of_freedom": finite(line.effective_degrees_of_freedom),
            "coverage_probability": COVERAGE, "coverage_factor": line.coverage_factor,
            "expanded_uncertainty": line.expanded_uncertainty(),
            "contributions": line.contributions.iter().map(contribution).collect::<Vec<_>>(),
        }))
    });
    let inputs = budget.inputs.iter().zip(budget.spread.column_iter()).map(|(input, changes)| {
        stated(json!({
            "input": input.cause.name(), "unit": input.cause.unit(),
            "standard_uncertainty": input.cause.shown(input.standard_uncertainty),
            "degrees_of_freedom": finite(input.degrees_of_freedom), "changes": changes.as_slice(),
        }))
    });
    let covariance = budget.covariance();
    stated(json!({
        "method": budget.method.key(),
        "sentence": sentence,
        "parameters": parameters.collect::<Vec<_>>(),
        "covariance": covariance.row_iter().map(|row| row.iter().copied().collect()).collect::<Vec<Vec<f64>>>(),
        "inputs": inputs.collect::<Vec<_>>(),
    }))
}

/// Returns an object without the keys that have no value: infinite degrees of freedom, no sentence.
fn stated(mut object: Value) -> Value {
    if let Value::Object(keys) = &mut object {
        keys.retain(|_, value| !value.is_null());
    }
    object
}

/// Returns which parameters the linear approximation is not valid for (JCGM 101, clause 8) and what to use in its place, or
/// `None` if there are none.
pub(crate) fn not_linear(found: &MonteCarlo) -> Option<String> {
    let lines = Parameter::in_paper_order(&found.parameters, |line| line.parameter);
    let invalid = lines.into_iter().filter(|line| line.first_order.valid == Some(false));
    let names: Vec<&str> = invalid.map(|line| line.parameter.symbol()).collect();
    let names = (!names.is_empty()).then(|| names.join(", "))?;
    Some(texts::NOT_LINEAR.of(Language::English).replace("{names}", &names))
}

/// Returns uncertainties and coverage intervals, and for every parameter whether the linear approximation is valid.
pub(crate) fn monte_carlo(found: &MonteCarlo) -> String {
    let mut out = String::new();
    let _ = writeln!(
        out,
        "\nMonte Carlo ({}), {} trials, seed {}; {:.0} % coverage intervals, drifts at local g",
        found.method.key(),
        grouped(found.trials),
        found.seed,
        100.0 * COVERAGE
    );
    let names = ["", "mean", "u", "symmetric", "shortest", "difference", "allowed", "linear"];
    let rows = Parameter::in_paper_order(&found.parameters, |line| line.parameter);
    columns::table(&mut out, &names, rows.into_iter().map(distribution));
    let words = "difference: of the ends of the interval by linear approximation from those of the symmetric one (the \
                 larger of the two); allowed: half a unit of the second digit of u (JCGM 101, clause 8); linear: \
                 whether the linear approximation is valid (undecided: too few trials).";
    columns::paragraph(&mut out, "  ", words);
    if !found.stable {
        columns::paragraph(&mut out, "  ", &format!("WARNING: {}", texts::NOT_STABLE.of(Language::English)));
    }
    if found.failed > 0 {
        let words = format!("WARNING: {} trials gave no finite parameters and were excluded.", grouped(found.failed));
        columns::paragraph(&mut out, "  ", &words);
    }
    out
}

fn distribution(line: &Distribution) -> Vec<String> {
    let digits = columns::decimals(line.standard_uncertainty);
    let interval = |[low, high]: [f64; 2]| format!("{low:.digits$} to {high:.digits$}");
    let first = &line.first_order;
    vec![
        line.parameter.symbol().to_owned(),
        format!("{:.digits$}", line.mean),
        format!("{:.digits$}", line.standard_uncertainty),
        interval(line.symmetric),
        interval(line.shortest),
        format!("{:.*}", digits + 2, first.differences[0].max(first.differences[1])),
        format!("{:.*}", digits + 1, first.tolerance),
        match first.valid {
            None => style::marked(Outcome::Undecided, "undecided"),
            valid => style::marked(valid, if valid == Some(true) { "valid" } else { "NOT VALID" }),
        },
    ]
}
