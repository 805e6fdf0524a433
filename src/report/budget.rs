//! Uncertainty budget as text.

use crate::report::columns;
use crate::uncertainty::Budget;
use crate::uncertainty::budget::{COVERAGE, Contribution, ParameterBudget};
use crate::units::printed;
use std::fmt::Write;

/// Share of the variance below which contributions are combined into one line.
const SHARE_SHOWN: f64 = 1e-4;

/// Returns `sentence` and the budget of every parameter, the largest contribution first.
pub(crate) fn text(budget: &Budget, sentence: Option<&str>) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "\nUncertainty budget ({}), linear approximation", budget.method.key());
    if let Some(sentence) = sentence {
        columns::paragraph(&mut out, "", &columns::powers(&format!("{sentence}.")));
    }
    for line in &budget.parameters {
        parameter(&mut out, line);
    }
    out
}

fn parameter(out: &mut String, line: &ParameterBudget) {
    let u = line.standard_uncertainty;
    let digits = columns::decimals(u);
    let freedom = match line.effective_degrees_of_freedom {
        known if known.is_infinite() => "infinite".to_owned(),
        known if known > 1e4 => "more than 10,000".to_owned(),
        known => format!("{known:.1}"),
    };
    let _ = writeln!(
        out,
        "\n{} = {:.digits$} {}, u = {u:.digits$}; degrees of freedom: {freedom}; U = {:.2} u = {:.digits$} ({:.0} %)",
        line.parameter.symbol(),
        line.value,
        printed(line.parameter.unit()),
        line.coverage_factor,
        line.expanded_uncertainty(),
        100.0 * COVERAGE,
    );
    let large = line.contributions.iter().filter(|part| part.share >= SHARE_SHOWN).count();
    // A single small contribution is printed as it is.
    let shown = if large + 1 == line.contributions.len() { large + 1 } else { large };
    let (shown, rest) = line.contributions.split_at(shown);
    // One digit more than u has: the small ones can be told from 0.
    let digits = digits + 1;
    let mut rows: Vec<Vec<String>> = shown.iter().map(|part| row(part, digits)).collect();
    if !rest.is_empty() {
        let sum: f64 = rest.iter().map(|part| part.contribution * part.contribution).sum();
        let name = format!("{} others", rest.len());
        rows.push(vec![name, String::new(), String::new(), format!("{:.digits$}", sum.sqrt()), "< 0.1".to_owned()]);
    }
    columns::table(out, &["input", "u of input", "inputs", "contribution", "share, %"], rows);
}

fn row(part: &Contribution, digits: usize) -> Vec<String> {
    let [low, high] = part.standard_uncertainty.map(|u| part.cause.shown(u));
    let size = if low < 0.99 * high { format!("{low:.2}–{high:.2}") } else { short(high) };
    vec![
        part.cause.kind(),
        format!("{size} {}", printed(part.cause.unit())),
        part.inputs.to_string(),
        format!("{:.digits$}", part.contribution),
        format!("{:.2}", 100.0 * part.share),
    ]
}

fn short(value: f64) -> String {
    if value < 1e-3 { columns::two_digits(value) } else { format!("{:.*}", columns::decimals(value).max(1), value) }
}
