//! Reference cases as text for a terminal and as JSON.

use crate::report::columns::decimals;
use crate::report::doc::{Block, Rows, line, marked, say, typed};
use crate::selftest::Case;
use crate::wording::number::localised;
use crate::wording::{Language, Number, plain};
use serde_json::{Value, json};

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
    let mut doc = vec![line(vec![marked(Some(failed == 0), word), format!("  {words} their references.").into()])];
    for group in cases.chunk_by(|one, other| one.example == other.example) {
        doc.extend([Block::Gap, line(group[0].example), table(group), say([format!("Source: {}.", sources(group))])]);
    }
    typed(&doc, Language::English)
}

fn table(group: &[Case]) -> Block {
    let has_digits = group.iter().any(|case| case.digits.is_some());
    let two_digits = |value: f64| plain(&Number::scientific(value, 2).text(Language::English));
    let number = |case: &Case, value: f64| match has_digits {
        true => plain(&localised(&format!("{value:.14e}"), Language::English)),
        false if case.expected == 0.0 => two_digits(value),
        // One digit more than the tolerance affects.
        false => format!("{value:.*}", decimals(case.tolerance)),
    };
    let precision =
        |case: &Case| case.digits.map_or_else(|| two_digits(case.tolerance), |digits| format!("{digits:.1}"));
    let rows = Rows::of(group, "")
        .named("", |case| case.quantity.clone())
        // As printed in the source: its digits show its precision.
        .column("expected", |case| if has_digits { number(case, case.expected) } else { case.expected.to_string() })
        .column("found", |case| number(case, case.found))
        .column(if has_digits { "digits" } else { "tolerance" }, precision)
        .column("", |case| marked(Some(case.passed()), if case.passed() { "ok" } else { "FAILED" }));
    Block::Table(rows.table)
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
