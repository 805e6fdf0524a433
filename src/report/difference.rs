//! Differences of two passports, as text and as JSON.

use crate::passport::Content;
use crate::passport::difference::{Differences, NumberDifference, OtherDifference};
use crate::report::passport::numbers::DECIMALS;
use crate::report::{columns, style};
use crate::text::{Node, Printable, number};
use serde_json::{Value, json};
use std::fmt::Write;

/// Passport that is compared: its file, the SHA-256 of the file, and its content.
pub(crate) struct Side {
    pub(crate) file: String,
    pub(crate) sha256: String,
    pub(crate) content: Content,
}

impl Side {
    fn json(&self) -> Value {
        let header = &self.content.passport;
        json!({
            "file": self.file, "id": header.id, "sha256": self.sha256, "issued_at": header.issued_at.to_string(),
            "certificate": self.content.certificate.number,
        })
    }
}

/// Returns the differences as JSON: `{a, b, compared, numbers, others}`.
pub(crate) fn to_json(a: &Side, b: &Side, found: &Differences) -> Value {
    json!({
        "a": a.json(),
        "b": b.json(),
        "compared": found.compared,
        "numbers": numbers_json(&found.numbers),
        "others": found.others,
    })
}

/// Returns numbers that differ as JSON: a list of `{key, a, b, difference, standard_uncertainty, ratio}`.
pub(crate) fn numbers_json(numbers: &[NumberDifference]) -> Value {
    let of = |number: &NumberDifference| {
        json!({
            "key": number.key, "a": number.a, "b": number.b, "difference": number.difference(),
            "standard_uncertainty": number.standard_uncertainty, "ratio": number.ratio(),
        })
    };
    numbers.iter().map(of).collect()
}

/// Returns the differences as text: a table of the numbers, then the other values in words.
pub(crate) fn text(a: &Side, b: &Side, found: &Differences) -> String {
    let (differ, all) = (found.numbers.len(), found.compared);
    let mut out = match differ {
        0 if found.others.is_empty() => format!("The contents are equal: {all} numbers and all texts.\n\n"),
        _ => format!("{differ} of {all} numbers differ{}.\n\n", largest(&found.numbers)),
    };
    let [one, other] = [a, b].map(|side| side.content.stand.id());
    if one != other {
        out.insert_str(0, &format!("The passports are for different stands, {one} and {other}.\n"));
    }
    for (name, side) in [("A", a), ("B", b)] {
        let (header, certificate) = (&side.content.passport, &side.content.certificate);
        let _ = writeln!(out, "{name}  {}  {}", style::heading(&header.id), Printable(&side.file));
        let issued =
            format!("issued {}, certificate {} of {}", header.issued_at, certificate.number, certificate.issued);
        columns::paragraph(&mut out, "   ", &issued);
    }
    if !found.numbers.is_empty() {
        let _ = writeln!(out, "\nu: standard uncertainty (k = 1) of B - A");
        // Computed numbers say nothing beyond those from which they were computed, if these differ.
        let given: Vec<_> = found.numbers.iter().filter(|at| !is_computed(&at.key)).cloned().collect();
        let shown = if given.is_empty() { &found.numbers } else { &given };
        numbers(&mut out, shown);
        if shown.len() < differ {
            let words = format!(
                "Not shown: {} computed numbers (matrices, vectors, self-check), which --format json has.",
                differ - shown.len()
            );
            columns::paragraph(&mut out, "  ", &words);
        }
    }
    if !found.others.is_empty() {
        let _ = writeln!(out, "\n{}", style::heading("Other differences, A -> B"));
        for OtherDifference { key, a, b } in &found.others {
            columns::paragraph(&mut out, "  ", &format!("{key}: {} -> {}", shown(a.as_ref()), shown(b.as_ref())));
        }
    }
    out
}

/// Returns the number with the largest difference in units of its uncertainty, in words that go on a sentence; nothing if none
/// has one.
fn largest(numbers: &[NumberDifference]) -> String {
    let ratios = numbers.iter().filter_map(|at| Some((at.ratio()?, &at.key)));
    let largest = ratios.max_by(|(a, _), (b, _)| a.abs().total_cmp(&b.abs()));
    largest.map_or_else(String::new, |(ratio, key)| format!("; the largest difference is {:.1} u: {key}", ratio.abs()))
}

/// Appends a table of numbers that differ.
pub(crate) fn numbers(out: &mut String, numbers: &[NumberDifference]) {
    let row = |at: &NumberDifference| {
        let difference = at.difference();
        let on_the_page = decimals_on_the_page(&at.key);
        let decimals = match (at.standard_uncertainty.map(columns::decimals).or(on_the_page), at.a.zip(at.b)) {
            (Some(decimals), _) => decimals,
            // The difference of two numbers as people write them is exact.
            (None, Some((a, b))) if is_short(a) && is_short(b) => decimals_of(a).max(decimals_of(b)),
            (None, _) => difference.map_or(6, decimals_of_a_difference),
        };
        let plain = |value: Option<f64>| match value {
            None => "-".to_owned(),
            Some(value) if at.standard_uncertainty.is_some() || on_the_page.is_some() => {
                columns::fixed(value, decimals)
            }
            Some(value) => stated(value, decimals),
        };
        let signed = |value: Option<f64>| value.map_or_else(String::new, |value| columns::signed(value, decimals));
        vec![
            at.key.clone(),
            plain(at.a),
            plain(at.b),
            signed(difference),
            at.standard_uncertainty.map_or_else(String::new, |u| format!("{u:.decimals$}")),
            at.ratio().map_or_else(String::new, |ratio| columns::signed(ratio, 1)),
        ]
    };
    let rows: Vec<Vec<String>> = numbers.iter().map(row).collect();
    // Non-breaking spaces keep each heading on one line.
    let names = ["", "A", "B", "B\u{A0}-\u{A0}A", "u", "(B\u{A0}-\u{A0}A)/u"];
    let table = |names: &[&str], rows: Vec<Vec<String>>| {
        let mut table = String::new();
        columns::table(&mut table, names, rows);
        table
    };
    let lines = 1 + rows.len();
    let wide = table(&names, rows.clone());
    let narrow = table(&names[1..], rows.iter().map(|row| row[1..].to_vec()).collect());
    if wide.lines().count() == lines || narrow.lines().count() != lines {
        out.push_str(&wide);
        return;
    }
    // Each key on a line of its own leaves room for its numbers below.
    for (line, key) in narrow.lines().zip(std::iter::once("").chain(rows.iter().map(|row| row[0].as_str()))) {
        if !key.is_empty() {
            let _ = writeln!(out, "  {key}");
        }
        let _ = writeln!(out, "  {line}");
    }
}

/// Returns the decimals with which a page prints a computed number without an uncertainty, by its key, or `None` for a
/// number that people write.
fn decimals_on_the_page(key: &str) -> Option<usize> {
    match key {
        "earth.valid_radius_m" => Some(0),
        _ => is_computed(key).then_some(DECIMALS),
    }
}

/// Returns `true` for a number that is computed from the deviations and the site, and used without an uncertainty.
fn is_computed(key: &str) -> bool {
    ["matrices.", "vectors[", "self_check.currents["].iter().any(|part| key.starts_with(part))
}

/// Formats a number as it is in the file if it is short, as those are that people write, and else with `decimals`.
fn stated(value: f64, decimals: usize) -> String {
    if is_short(value) {
        number::decimal(value).trim_end_matches(".0").to_owned()
    } else {
        format!("{value:.decimals$}")
    }
}

fn is_short(value: f64) -> bool {
    const SHORT: usize = 12;
    number::decimal(value).len() <= SHORT
}

fn decimals_of(value: f64) -> usize {
    number::decimal(value).split_once('.').map_or(0, |(_, decimals)| decimals.len())
}

/// Returns the number of decimals, at most 15, that show a difference with three significant digits.
fn decimals_of_a_difference(difference: f64) -> usize {
    let magnitude = difference.abs();
    if !(magnitude.is_finite() && magnitude > 0.0) {
        return 6;
    }
    let exponent = libm::floor(libm::log10(magnitude)) as i32;
    usize::try_from(2 - exponent).unwrap_or(0).min(15)
}

fn shown(value: Option<&Node>) -> String {
    match value {
        None => "absent".to_owned(),
        Some(Node::Text(text)) => format!("\"{}\"", Printable(text)),
        Some(Node::Number(value)) => number::decimal(*value),
        Some(other) => other.describe(),
    }
}
