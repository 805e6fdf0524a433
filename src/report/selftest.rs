//! Reference cases as text for a terminal and as JSON.

use crate::report::{columns, style};
use crate::selftest::Case;
use crate::wording::number::{Number, localised};
use crate::wording::{Language, plain};
use serde_json::{Value, json};
use std::fmt::Write;

/// Returns the cases as JSON:
/// `{passed, failed, cases: [{example, quantity, source, expected, tolerance, found, digits, passed}]}`.
pub(crate) fn to_json(cases: &[Case]) -> Value {
    let each = cases.iter().map(|case| {
        json!({
            "example": case.example, "quantity": case.quantity, "source": case.source, "expected": case.expected,
            "tolerance": case.tolerance, "found": case.found, "digits": case.digits, "passed": case.passed(),
        })
    });
    let passed = cases.iter().filter(|case| case.passed()).count();
    json!({ "passed": passed, "failed": cases.len() - passed, "cases": each.collect::<Vec<_>>() })
}

/// Returns a table for each example.
pub(crate) fn text(cases: &[Case]) -> String {
    let failed = cases.iter().filter(|case| !case.passed()).count();
    let (word, words) = match failed {
        0 => ("PASSED", format!("All {} values agree with", cases.len())),
        failed => ("FAILED", format!("{failed} of {} values differ from", cases.len())),
    };
    let mut out = format!("{}  {words} their references.\n", style::marked(Some(failed == 0), word));
    for group in cases.chunk_by(|one, other| one.example == other.example) {
        let Some(first) = group.first() else { continue };
        let _ = writeln!(out, "\n{}", first.example);
        let digits = group.iter().any(|case| case.digits.is_some());
        let last = if digits { "digits" } else { "tolerance" };
        let rows = group.iter().map(|case| row(case, digits));
        columns::table(&mut out, 1, &["", "expected", "found", last, ""], rows);
        columns::paragraph(&mut out, "  ", &format!("Source: {}.", sources(group)));
    }
    out
}

/// Returns every source once. Several places in one document follow one mention of the document.
fn sources(group: &[Case]) -> String {
    let mut all: Vec<&str> = group.iter().map(|case| case.source).collect();
    all.dedup();
    let document = |source: &&str| source.split_once(", ").map(|(document, _)| document.to_owned());
    let documents = all.chunk_by(|one, other| document(one).is_some() && document(one) == document(other));
    let words = documents.map(|same| {
        let rest = same.iter().skip(1).filter_map(|source| source.split_once(", "));
        same.iter().take(1).copied().chain(rest.map(|(_, place)| place)).collect::<Vec<_>>().join(", ")
    });
    words.collect::<Vec<_>>().join("; ")
}

fn row(case: &Case, digits: bool) -> Vec<String> {
    let two_digits = |value: f64| plain(&Number::scientific(value, 2).text(Language::English));
    let number = |value: f64| match digits {
        true => plain(&localised(&format!("{value:.14e}"), Language::English)),
        false if case.expected == 0.0 => two_digits(value),
        // One digit more than the tolerance affects.
        false => format!("{value:.*}", columns::decimals(case.tolerance)),
    };
    // As printed in the source: its digits show its precision.
    let expected = if digits { number(case.expected) } else { format!("{}", case.expected) };
    let last = case.digits.map_or_else(|| two_digits(case.tolerance), |digits| format!("{digits:.1}"));
    let verdict = style::marked(Some(case.passed()), if case.passed() { "ok" } else { "FAILED" });
    vec![case.quantity.clone(), expected, number(case.found), last, verdict]
}
