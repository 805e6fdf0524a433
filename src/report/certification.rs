//! Result of a certification, and of a check run, as text and as JSON.
//!
//! * `change`: comparison with the last certificate.
//! * `evidence`: readings in doubt, components, tests.

pub(crate) mod change;
pub(crate) mod evidence;

use crate::certification::components::{Common, Variance};
use crate::certification::found;
use crate::certification::{Certification, Comparison, NotCertified};
use crate::report::doc::{self, Block, heading, say};
use crate::report::page::language::Text;
use crate::report::style::Outcome;
use crate::report::{columns, deviations, style};
use crate::text::record::File;
use crate::text::{Field, Node, Printable};
use crate::wording::Language;
use crate::wording::texts::{certification as texts, passport};
use serde_json::{Value, json};
use std::fmt::Write;

/// Returns everything as JSON: `{certification, not_certified, comparison, findings}`; parts that do not apply are null.
pub(crate) fn to_json(
    certification: Option<&Certification>,
    not_certified: Option<&NotCertified>,
    comparison: Option<&Comparison>,
) -> Value {
    let causes: Vec<_> = comparison.into_iter().flat_map(Comparison::causes).collect();
    let of_readings = certification.into_iter().flat_map(|certified| &certified.findings);
    json!({
        "certification": certification.map(certification_json),
        "not_certified": not_certified.map(ToString::to_string),
        "comparison": comparison,
        "findings": found::to_json(causes.iter().chain(of_readings)),
    })
}

fn certification_json(found: &Certification) -> Value {
    let components = &found.components;
    let variance =
        |v: &Variance| json!({"standard_deviation": v.value.sqrt(), "degrees_of_freedom": v.degrees_of_freedom});
    let common = |c: &Common| {
        json!({
            "between_runs_arcsec": c.between_runs_arcsec2.sqrt(),
            "degrees_of_freedom": c.degrees_of_freedom,
            "upper_limit_arcsec": c.upper_limit_arcsec2.sqrt(),
        })
    };
    json!({
        "stand": File(found.stand.clone()).write().unwrap_or(Node::Null),
        "runs": found.runs,
        "repeated_rows": found.repeated_rows,
        "own_arcsec": components.own_arcsec2.iter().map(variance).collect::<Vec<_>>(),
        "platform": common(&components.platform),
        "base": components.base.as_ref().map(common),
        "base_axes": components.base_axes,
        "run_turns": components.run_turns,
        "warnings": found.warnings,
    })
}

/// Returns the certification of one of several stands in one line; `file` is its stand file.
pub(crate) fn line(found: &Certification, file: &str) -> String {
    let (stand, runs) = (&found.stand, found.runs.len());
    let certificate = Printable(&stand.certificate.number);
    let certified = style::of_input(outcome_of_certification(found), "certified");
    let mut out = format!(
        "{certified}  {}  {}  certificate {certificate}, {} positions, {runs} runs\n",
        stand.stand.id(),
        Printable(file),
        stand.positions.len()
    );
    every_warning(&mut out, "  ", found);
    out
}

/// Returns a certification as text.
pub(crate) fn certification(found: &Certification) -> String {
    let mut out = String::new();
    let (stand, runs) = (&found.stand, found.runs.len());
    let warnings = match found.remarks.len() {
        0 => "no warnings".to_owned(),
        count => format!("warnings: {count}"),
    };
    let _ = writeln!(
        out,
        "{}  {} {}: {} positions, {runs} runs; {warnings}",
        style::marked(outcome_of_certification(found), "CERTIFIED"),
        stand.stand.model,
        stand.stand.serial,
        stand.positions.len()
    );
    every_warning(&mut out, "", found);
    let (headings, deviations) = deviations::columns(&stand.positions);
    let names = [&["i", "j"], headings.as_slice(), &["ν"]].concat();
    let rows = stand.positions.iter().zip(deviations).map(|(at, deviations)| {
        let freedom = columns::degrees_of_freedom(at.degrees_of_freedom.unwrap_or(f64::INFINITY));
        [vec![at.i.to_string(), at.j.to_string()], deviations, vec![freedom]].concat()
    });
    let _ = writeln!(out);
    columns::table(&mut out, &names, rows);
    let repeated = Some(found.repeated_rows).filter(|rows| *rows > 0);
    let repeated = repeated.map(|rows| (texts::REPEATED, rows.into(), false));
    let mut blocks = vec![
        say([passport::DEVIATIONS_U_NOTE]),
        evidence::certified(&stand.certificate),
        Block::Fields(repeated.into_iter().collect()),
        evidence::outliers(found),
    ];
    blocks.extend(evidence::components(found));
    blocks.push(heading(texts::TESTS));
    blocks.extend(evidence::tests(found));
    blocks.extend(evidence::exclusions(found));
    doc::text(&mut out, &blocks, Language::English);
    out
}

/// Returns the mark of a certification: with warnings, someone must decide whether it can be used.
pub(crate) fn outcome_of_certification(found: &Certification) -> Outcome {
    if found.remarks.is_empty() { Outcome::Passed } else { Outcome::Undecided }
}

fn every_warning(out: &mut String, indent: &str, found: &Certification) {
    for warning in &found.remarks {
        columns::paragraph(out, indent, &columns::powers(&format!("WARNING: {warning}.")));
    }
}

/// Returns the outcome of a check run, or of one of its positions, that repeats or does not. If the readings do not show
/// whether the stand has changed, or are in other places or units, neither does a position.
pub(crate) fn outcome_of(found: &Comparison, repeats: bool) -> Outcome {
    match repeats {
        true => Outcome::Passed,
        false if found.is_undecided() || found.is_misread() => Outcome::Undecided,
        false => Outcome::Failed,
    }
}

/// Returns the result of a comparison with the last certificate, in a word.
pub(super) fn answer(found: &Comparison) -> (Outcome, &'static str) {
    let outcome = outcome_of(found, found.same_stand);
    (outcome, change::word(outcome).of(Language::English))
}

/// Returns a check run as text, with what to do if the stand has changed and is not recertified from it.
pub(crate) fn check(found: &Comparison) -> String {
    comparison(found, Some(texts::DO_NOT_USE))
}

/// Returns a check run as text; `advice` is for a stand that has changed.
pub(super) fn comparison(found: &Comparison, advice: Option<Text>) -> String {
    let mut out = String::new();
    let (outcome, answer) = answer(found);
    let mut answer = answer.to_uppercase();
    if outcome == Outcome::Passed && found.common.test.is_none() {
        // Rotation of the stand as a whole was not tested.
        answer.insert_str(0, "POSITIONS ");
    }
    let answer = style::marked(outcome, &answer);
    let runs = if found.runs == 1 { "run" } else { "runs" };
    let _ = writeln!(out, "{answer}  check against certificate {}, {} {runs}", found.certificate, found.runs);
    for words in &found.findings {
        columns::paragraph(&mut out, "  ", &format!("{words}."));
    }
    let advice = say(advice.filter(|_| outcome == Outcome::Failed));
    doc::text(&mut out, &[vec![advice], change::rotations(found)].concat(), Language::English);
    out
}
