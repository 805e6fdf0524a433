//! Result of a certification, and of a check run, also as JSON.
//!
//! * `change`: comparison with the last certificate.
//! * `evidence`: readings in doubt, components, tests.

pub(crate) mod change;
pub(crate) mod evidence;

use crate::certification::components::{Common, Variance};
use crate::certification::{Certification, Comparison, NotCertified, found};
use crate::report::doc::{self, Block, Words, given, heading, marked, say};
use crate::report::gyros::of_input;
use crate::report::passport::deviations;
use crate::text::record::File;
use crate::text::{Field, Node};
use crate::wording::Outcome;
use crate::wording::texts::{calibration, certification as texts};
use serde_json::{Value, json};

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

/// The certification of one of several stands in one line; `file` is its stand file.
pub(crate) fn line(found: &Certification, file: &str) -> Vec<Block> {
    let stand = &found.stand;
    let certificate = texts::line(given(&stand.certificate.number), stand.positions.len(), found.runs.len());
    let certified = of_input(outcome_of_certification(found), texts::LINE_CERTIFIED);
    let words = doc::joined([certified, given(stand.stand.id()), given(file), certificate], "  ");
    let first = Block::Whole("", vec![vec![words]]);
    [first].into_iter().chain(warnings(found).map(|warning| say([warning]))).collect()
}

/// A certification: warnings, deviations, evidence.
pub(crate) fn certification(found: &Certification) -> Vec<Block> {
    let (stand, identity) = (&found.stand, &found.stand.stand);
    let warned = match found.remarks.len() {
        0 => texts::NO_WARNINGS.into(),
        count => texts::number_of_warnings(count),
    };
    let counted = texts::stand_counted(stand.positions.len(), found.runs.len(), warned);
    let certified = marked(outcome_of_certification(found), texts::IS_CERTIFIED);
    let name = format!("{} {}: ", identity.model, identity.serial);
    let repeated = Some(found.repeated_rows).filter(|rows| *rows > 0);
    let repeated = repeated.map(|rows| (texts::REPEATED, rows.into(), false));
    let mut doc = vec![doc::line(vec![certified, "  ".into(), given(name), counted])];
    doc.extend(warnings(found).map(doc::line));
    doc.push(Block::Gap);
    doc.extend(deviations::table(&stand.positions, "u").into_iter().take(1));
    doc.extend([
        deviations::note(&stand.positions, false),
        evidence::certified(&stand.certificate),
        doc::fields(repeated),
        evidence::outliers(found),
    ]);
    doc.extend(evidence::components(found));
    doc.push(heading(texts::TESTS));
    doc.extend(evidence::tests(found));
    doc.extend(evidence::exclusions(found));
    doc
}

/// Returns the mark of a certification: with warnings, someone must decide whether it can be used.
pub(crate) fn outcome_of_certification(found: &Certification) -> Outcome {
    if found.remarks.is_empty() { Outcome::Passed } else { Outcome::Undecided }
}

fn warnings(found: &Certification) -> impl Iterator<Item = Words> {
    found.remarks.iter().map(|remark| calibration::warning(remark.advised()))
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

/// A check run. `is_final` if the stand is not recertified from it: then it says what to do if the stand has changed.
pub(crate) fn comparison(found: &Comparison, is_final: bool) -> Vec<Block> {
    let outcome = outcome_of(found, found.same_stand);
    let answer = match outcome {
        // Rotation of the stand as a whole was not tested.
        Outcome::Passed if found.common.test.is_none() => texts::POSITIONS_UNCHANGED,
        Outcome::Passed => texts::IS_UNCHANGED,
        Outcome::Failed => texts::HAS_CHANGED,
        Outcome::Undecided | Outcome::NotAsked => calibration::IS_UNDECIDED,
    };
    let check = texts::check_against(given(&found.certificate), found.runs);
    let mut doc = vec![doc::line(vec![marked(outcome, answer), "  ".into(), check])];
    doc.extend(found.findings.iter().map(|finding| say([finding.remark.advised()])));
    doc.push(say((is_final && outcome == Outcome::Failed).then_some(texts::DO_NOT_USE)));
    doc.extend(change::rotations(found));
    doc
}
