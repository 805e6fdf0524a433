//! Result of a certification, and of a check run, also as JSON.
//!
//! * `change`: comparison with the last certificate.
//! * `evidence`: readings in doubt, components, tests.

pub(crate) mod change;
pub(crate) mod evidence;

use crate::certification::components::{Common, Variance};
use crate::certification::rotated_runs::Pattern;
use crate::certification::suspects::AXES;
use crate::certification::{Certification, Comparison, NotCertified};
use crate::report::doc::{self, Block, Words, given, heading, marked, say};
use crate::report::gyros::of_input;
use crate::report::passport::deviations;
use crate::report::style::Outcome;
use crate::text::record::File;
use crate::text::{Field, Node};
use crate::wording::texts::{calibration, certification as texts};
use serde_json::{Value, json};

/// Returns everything as JSON: `{certification, not_certified, comparison}`; parts that do not apply are null.
pub(crate) fn to_json(
    certification: Option<&Certification>,
    not_certified: Option<&NotCertified>,
    comparison: Option<&Comparison>,
) -> Value {
    json!({
        "certification": certification.map(certification_json),
        "not_certified": not_certified.map(ToString::to_string),
        "comparison": comparison,
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
    let out = found.suspects.outliers.iter().map(|out| {
        json!({
            "i": out.index.i, "j": out.index.j, "run": out.run, "line": out.line, "axis": AXES[out.axis],
            "residual_arcsec": out.residual_arcsec, "probability": out.probability,
        })
    });
    let bumped = found.rotated_runs.iter().filter_map(|at| {
        Some(json!({
            "run": at.run()?, "part": at.axis.part(), "axis": at.axis.name(), "turn_arcsec": at.turn_arcsec(),
            "turns_arcsec": at.turns_arcsec, "in_the_mean_arcsec": at.in_the_mean_arcsec()[at.axis.0 % 3],
            "probability": at.probability,
        }))
    });
    let moved = found.rotated_runs.iter().find(|at| at.run().is_none()).map(|at| {
        let runs = if let Pattern::Move(before, after) = at.pattern { Some([before, after]) } else { None };
        json!({
            "between_runs": runs, "part": at.axis.part(), "axis": at.axis.name(), "turn_arcsec": at.turn_arcsec(),
            "turns_arcsec": at.turns_arcsec, "probability": at.probability,
        })
    });
    let unequal = found.unequal_axes.iter().map(|at| {
        json!({
            "part": at.axis.part(), "axis": at.axis.name(), "between_runs_arcsec": at.deviation_arcsec,
            "other_axes_arcsec": at.others_arcsec, "missing_type_b_arcsec": at.missing_arcsec,
            "probability": at.probability,
        })
    });
    let shared = found.shared_settings.iter().map(|at| {
        json!({"angle": at.setting.key(), "between_runs_arcsec": at.deviation_arcsec, "probability": at.probability})
    });
    let split = found.suspects.split.map(|at| {
        json!({
            "run": at.run, "between_positions": at.between, "part": at.axis.part(), "turns_arcsec": at.turns_arcsec,
            "probability": at.probability,
        })
    });
    let group = found.suspects.group.as_ref();
    let group = group.map(|at| json!({"theta_deg": at.theta_deg, "ratio": at.ratio, "probability": at.probability}));
    json!({
        "stand": File(found.stand.clone()).write().unwrap_or(Node::Null),
        "runs": found.runs,
        "repeated_rows": found.repeated_rows,
        "own_arcsec": components.own_arcsec2.iter().map(variance).collect::<Vec<_>>(),
        "platform": common(&components.platform),
        "base": components.base.as_ref().map(common),
        "base_axes": components.base_axes,
        "run_turns": components.run_turns,
        "bartlett": {"positions": found.suspects.positions, "axes": found.suspects.axes},
        "worse_position": found.suspects.worse.first(),
        "worse_positions": found.suspects.worse,
        "worse_group": group,
        "outliers": out.collect::<Vec<_>>(),
        "bumped_runs": bumped.collect::<Vec<_>>(),
        "moved": moved,
        "split_run": split,
        "unequal_axes": unequal.collect::<Vec<_>>(),
        "shared_settings": shared.collect::<Vec<_>>(),
        "twins": found.suspects.twins,
        "warnings": found.warnings,
    })
}

/// The certification of one of several stands in one line; `file` is its stand file.
pub(crate) fn line(found: &Certification, file: &str) -> Vec<Block> {
    let stand = &found.stand;
    let certificate = texts::line(given(&stand.certificate.number), stand.positions.len(), found.runs.len());
    let certified = of_input(outcome_of_certification(found), texts::LINE_CERTIFIED);
    let words =
        vec![certified, "  ".into(), given(stand.stand.id()), "  ".into(), given(file), "  ".into(), certificate];
    let first = Block::Whole("", vec![vec![words.into()]]);
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
    doc.push(Block::Typed("\n".to_owned()));
    doc.extend(deviations::table(&stand.positions, "u").into_iter().take(1));
    doc.extend([
        deviations::note(&stand.positions, false),
        evidence::certified(&stand.certificate),
        doc::fields(repeated.into_iter().collect()),
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
    doc.extend(found.findings.iter().map(|finding| say([finding.advised()])));
    doc.push(say((is_final && outcome == Outcome::Failed).then_some(texts::DO_NOT_USE)));
    doc.extend(change::rotations(found));
    doc
}
