//! Result of a certification, and of a check run, as text and as JSON.

use crate::certification::components::{Common, Variance};
use crate::certification::remark::together;
use crate::certification::rotated_runs::{FEWEST_RUNS, FEWEST_RUNS_OF_A_MOVE, Pattern, RotatedRuns};
use crate::certification::suspects::{AXES, OUTLIER};
use crate::certification::{Certification, Comparison, NotCertified, Test};
use crate::report::style::Outcome;
use crate::report::{columns, deviations, style};
use crate::stand::ActsOn;
use crate::text::record::File;
use crate::text::{Field, Node, Printable};
use crate::wording::Language;
use crate::wording::plain;
use serde_json::{Value, json};
use std::fmt::Write;

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
    columns::paragraph(&mut out, "", "u: standard uncertainty (k = 1) of the mean, own part of the position.");
    if found.repeated_rows > 0 {
        let _ = writeln!(out, "Rows averaged with another row of the same visit: {}.", found.repeated_rows);
    }
    for excluded in stand.certificate.evidence.iter().filter_map(|evidence| evidence.excluded.as_ref()).flatten() {
        columns::paragraph(&mut out, "", &format!("Excluded: {}: {}.", excluded.describe(), excluded.why));
    }
    let (headings, deviations) = deviations::columns(&stand.positions);
    let names = [&["i", "j"], headings.as_slice(), &["deg. of freedom"]].concat();
    let rows = stand.positions.iter().zip(deviations).map(|(at, deviations)| {
        let freedom = columns::degrees_of_freedom(at.degrees_of_freedom.unwrap_or(f64::INFINITY));
        [vec![at.i.to_string(), at.j.to_string()], deviations, vec![freedom]].concat()
    });
    let _ = writeln!(out);
    columns::table(&mut out, &names, rows);
    components(&mut out, found);
    if stand.certificate.type_b.iter().flatten().next().is_none() {
        let words = "Not stated in the header (type_b), and not included in any u: errors that are the same in every run, such as the \
                     calibration of the instruments.";
        columns::paragraph(&mut out, "", words);
    }
    tests(&mut out, found);
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

fn components(out: &mut String, found: &Certification) {
    let components = &found.components;
    let own = components.own_arcsec2.map(|variance| columns::two_digits(variance.value.sqrt()) + "″");
    let words = format!(
        "Repeatability of one visit: {}″ per axis ({}); about x, y, z: {}",
        columns::two_digits(components.pooled_arcsec2.value.sqrt()),
        columns::freedom(columns::degrees_of_freedom(components.pooled_arcsec2.degrees_of_freedom)),
        own.join(", ")
    );
    let _ = writeln!(out);
    columns::paragraph(out, "", &words);
    let root = (found.runs.len() as f64).sqrt();
    let certificate = &found.stand.certificate;
    let parts = [
        ("platform", ActsOn::Platform, Some(&components.platform), certificate.common_platform_arcsec),
        ("base", ActsOn::Base, components.base.as_ref(), certificate.common_base_arcsec),
    ];
    for (what, on, common, certified) in parts {
        let Some(common) = common else { continue };
        let type_b = certificate.type_b_arcsec2(on);
        let seen = common.between_runs_arcsec2.sqrt();
        let certified = certified.filter(|_| type_b > 0.0).map_or_else(String::new, |certified| {
            format!("; {}″ with its type B uncertainty, as certified", columns::two_digits(certified))
        });
        let limit = match common.upper_limit_arcsec2.sqrt() {
            limit if limit > 0.0 => format!("at most {}″ at 95 %", columns::two_digits(limit)),
            _ => "no upper limit, because the runs agree better than the scatter of the visits explains".to_owned(),
        };
        let words = format!(
            "Common part of the {what}: {}″ per axis from run to run ({limit}), {}″ in the mean{certified}",
            columns::two_digits(seen),
            columns::two_digits(seen / root)
        );
        columns::paragraph(out, "", &words);
    }
    let rows = components.run_turns.iter().map(|turn| {
        let numbers = turn.platform_arcsec.iter().chain(&turn.base_arcsec).map(|value| columns::signed(*value, 2));
        std::iter::once(turn.run.to_string()).chain(numbers).collect()
    });
    out.push_str("Rotation in each run relative to the mean of the runs, ″\n");
    columns::table(out, &["run", "platform x", "y", "z", "base east", "north", "up"], rows);
}

fn tests(out: &mut String, found: &Certification) {
    let _ = writeln!(out);
    for (what, test) in [("positions", &found.suspects.positions), ("axes", &found.suspects.axes)] {
        let Some(test) = test else { continue };
        let words = format!(
            "Bartlett's test for equal variances of {what}: {:.2} with {}, probability {}",
            test.statistic,
            columns::freedom(test.degrees_of_freedom),
            columns::probability(test.probability)
        );
        columns::paragraph(out, "", &words);
    }
    let readings = found.tested_angles();
    let named = graded(found.suspects.outliers.iter().map(|out| out.probability));
    if found.suspects.split.is_none() {
        let _ = writeln!(out, "Grubbs' test of {readings} angles: {named}");
    }
    if found.runs.len() >= FEWEST_RUNS {
        let axes = 3 + found.components.base_axes;
        let (bumped, moved): (Vec<&RotatedRuns>, Vec<_>) = found.rotated_runs.iter().partition(|at| at.run().is_some());
        let named = graded(bumped.iter().map(|at| at.probability));
        let runs = found.runs.len();
        let _ = writeln!(out, "Grubbs' test of {runs} runs about {axes} axes: {named}");
        if runs >= FEWEST_RUNS_OF_A_MOVE {
            let none = "none (below 5 %)".to_owned();
            let named =
                moved.first().map_or(none, |at| format!("probability {}", columns::probability(at.probability)));
            let _ = writeln!(out, "Student's test of {runs} runs for a shift or a drift of the stand: {named}");
        }
    }
}

/// Returns the numbers of stragglers and outliers among the `probabilities` of what a test names.
fn graded(probabilities: impl Iterator<Item = f64>) -> String {
    let (outliers, stragglers): (Vec<f64>, Vec<f64>) = probabilities.partition(|p| *p < OUTLIER);
    let named = |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
    format!("{} (below 1 %), {} (1 % to 5 %)", named(outliers.len(), "outlier"), named(stragglers.len(), "straggler"))
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

fn word(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Passed => "unchanged",
        Outcome::Failed => "CHANGED",
        Outcome::Undecided | Outcome::NotAsked => "undecided",
    }
}

/// Returns the result of a comparison with the last certificate, in a word.
pub(super) fn answer(found: &Comparison) -> (Outcome, &'static str) {
    let outcome = outcome_of(found, found.same_stand);
    (outcome, word(outcome))
}

/// Returns a check run as text, with what to do if the stand has changed and is not recertified from it.
pub(crate) fn check(found: &Comparison) -> String {
    comparison(found, Some("Do not use the stand until it has been recertified."))
}

/// Returns a check run as text; `advice` is for a stand that has changed.
pub(super) fn comparison(found: &Comparison, advice: Option<&str>) -> String {
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
    if let Some(advice) = advice.filter(|_| outcome == Outcome::Failed) {
        columns::paragraph(&mut out, "  ", advice);
    }
    let line = |test: &Test| {
        format!(
            "F = {} with {} and {} degrees of freedom, probability {}",
            columns::chi_square(test.f()),
            test.degrees_of_freedom,
            if test.of_u.is_finite() { columns::degrees_of_freedom(test.of_u) } else { "∞".to_owned() },
            columns::probability(test.probability)
        )
    };
    let _ = writeln!(out);
    columns::paragraph(
        &mut out,
        "",
        &format!("Positions relative to each other (p: probability of a larger F): {}", line(&found.all)),
    );
    let rows = found.positions.iter().map(|at| {
        let mut row = vec![at.index.i.to_string(), at.index.j.to_string()];
        for (turn, u) in at.turn_arcsec.iter().zip(&at.u_arcsec) {
            let digits = columns::decimals(*u);
            row.extend([columns::signed(*turn, digits), format!("{u:.digits$}")]);
        }
        row.push(columns::chi_square(at.test.f()));
        row.push(columns::probability(at.test.probability));
        let outcome = outcome_of(found, at.repeats);
        row.push(style::marked(outcome, word(outcome)));
        row
    });
    let names = ["i", "j", "x, ″", "u", "y, ″", "u", "z, ″", "u", "F", "p", ""];
    columns::table(&mut out, &names, rows);
    let positions = found.positions.len();
    let words = format!(
        "A position has changed if p < {OUTLIER} / {positions}, which happens by chance in at most {} % of the checks. If no \
         more than half of the positions repeat, all are CHANGED.",
        100.0 * OUTLIER
    );
    columns::paragraph(&mut out, "", &words);
    let judged = found.common.test.as_ref().map_or_else(|| "not tested".to_owned(), line);
    let turns = |of| plain(&together(of).map(|turn| turn.text(Language::English) + "″").join(", "));
    let words = format!(
        "Common rotation of the platform about x, y, z: {}; of the base about east, north, up: {}; {judged}",
        turns(found.common.platform_arcsec),
        turns(found.common.base_arcsec)
    );
    columns::paragraph(&mut out, "", &words);
    out
}
