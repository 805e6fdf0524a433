//! A plan as text.

use super::style::Outcome;
use super::{columns, style};
use crate::calibration::Parameter;
use crate::calibration::verdict::COVERAGE_FACTOR;
use crate::plan::criterion::Criterion;
use crate::plan::sensitivity::{CommonError, Effect};
use crate::plan::{Plan, Visited};
use crate::text::number::decimal;
use crate::text::printable;
use crate::units::{printed, quantity};
use std::fmt::Write;

/// Rise of ω_0 during the run for which the text states its effect, °/h.
const DRIFT_DEG_PER_H: f64 = 0.01;

/// Share of the tolerance from which the text states an uncertainty that no reading reduces.
const LARGE_SHARE: f64 = 0.1;

/// Returns the plan: positions, order, uncertainties next to those of the paper's eight, and what it cannot see.
/// `site` is the identifier of the site, and `site_azimuth_deg` its azimuth of the frame's axis. `assumed` says whether the
/// gyro type and the laboratory were assumed.
pub(crate) fn text(plan: &Plan, (site, site_azimuth_deg): (&str, f64), gyro_type: &str, assumed: [bool; 2]) -> String {
    let gyro_type = printable(gyro_type);
    let mut out = String::new();
    let readings: u32 = plan.readings.iter().map(|at| at.visits).sum();
    let how = match plan.exhaustive {
        true => "the best of all choices",
        false => "the best found by exchanging positions (not all choices were compared)",
    };
    let mut turn_ons = turn_ons(plan);
    if let Some(sentence) = no_gyro_can_pass(plan, &gyro_type) {
        columns::paragraph(&mut out, "", &style::marked(Outcome::Failed, &sentence));
        turn_ons.take().iter().for_each(|sentence| columns::paragraph(&mut out, "", sentence));
    }
    if gravity_prevents_a_pass(plan) {
        let sentence = format!(
            "No gyro of type {gyro_type} can pass by guarded acceptance at this site: the uncertainty of local g alone makes \
             U (k = 2) of ω_g or ω_k {} % of the tolerance at the g of the type. To reduce it, state the height of the site, \
             or measure g.",
            percent(COVERAGE_FACTOR * plan.gravity_over_tolerance)
        );
        columns::paragraph(&mut out, "", &style::marked(Outcome::Failed, &sentence));
    }
    let _ = writeln!(
        out,
        "Plan for {site}: {readings} readings in {} of {} positions, frame's axis at {}",
        plan.readings.len(),
        plan.candidates,
        azimuth(plan.frame_axis_azimuth_deg)
    );
    let [gyro, meter] = assumed;
    let gyro = if gyro { " (assumed; --gyro states another)" } else { "" };
    let meter =
        if meter { ", and a meter with an error within ±0.015 % (assumed; --laboratory states another)" } else { "" };
    columns::paragraph(&mut out, "", &format!("For gyro type {gyro_type}{gyro}{meter}."));
    let value = plan.evaluation.value;
    let mut words = format!("Criterion {}: {}, {how}.", of_criterion(plan.criterion), significant(value));
    if let Some(paper) = &plan.paper {
        let ratio = plan.criterion.ratio(value, paper.value);
        let paper = significant(paper.value);
        let _ = write!(
            words,
            " The paper's eight positions with the axis east: {paper}. The overall uncertainty of the plan is {ratio:.3} times \
             that of the paper's eight."
        );
    }
    columns::paragraph(&mut out, "", &words);
    out.push('\n');
    positions(&mut out, plan);
    uncertainties(&mut out, plan);
    common_errors(&mut out, plan);
    out.push('\n');
    for sentence in turn_ons.into_iter().chain(remarks(plan, site_azimuth_deg)) {
        columns::paragraph(&mut out, "", &sentence);
    }
    out
}

fn azimuth(azimuth_deg: f64) -> String {
    let name = match azimuth_deg {
        0.0 => " (north)",
        90.0 => " (east)",
        180.0 => " (south)",
        270.0 => " (west)",
        _ => "",
    };
    format!("{azimuth_deg}°{name}")
}

fn of_criterion(criterion: Criterion) -> &'static str {
    match criterion {
        Criterion::A => "a, sum of (u/tolerance)²",
        Criterion::D => "d, ln det of the covariance in units of the tolerances",
        Criterion::Worst => "worst, largest u/tolerance",
    }
}

fn positions(out: &mut String, plan: &Plan) {
    let certified = plan.readings.iter().any(|at| at.index.is_some());
    let mut names = vec!["θ, °", "φ, °", "visits"];
    if certified {
        names.splice(0..0, ["i", "j"]);
    }
    let row = |at: &Visited| {
        let mut row: Vec<String> =
            at.index.iter().flat_map(|index| [index.i.to_string(), index.j.to_string()]).collect();
        row.extend([at.theta_deg.to_string(), at.phi_deg.to_string(), at.visits.to_string()]);
        row
    };
    columns::table(out, &names, plan.readings.iter().map(row));
    let visit = |place: &usize| {
        let at = &plan.readings[*place];
        match at.index {
            // Without a space, so that both numbers stay on one line.
            Some(index) => format!("({},{})", index.i, index.j),
            None => format!("({},{})", at.theta_deg, at.phi_deg),
        }
    };
    let order: Vec<String> = plan.order.places.iter().map(visit).collect();
    let names = if certified { "(i,j)" } else { "(θ,φ)" };
    out.push('\n');
    columns::paragraph(out, "", &format!("Order of the visits {names}: {}", order.join(", ")));
    out.push('\n');
}

fn uncertainties(out: &mut String, plan: &Plan) {
    let mut names = vec!["", "unit", "u", "% of tolerance"];
    if plan.paper.is_some() {
        names.extend(["u, paper's eight", "ratio"]);
    }
    let row = |parameter: Parameter| {
        let place = parameter.place();
        let u = plan.evaluation.standard_uncertainty[place];
        let shown = |u: f64| format!("{u:.*}", columns::decimals(u));
        let mut row = vec![
            parameter.symbol().to_owned(),
            printed(parameter.unit()),
            shown(u),
            percent_of_tolerance(u / plan.tolerance[place]),
        ];
        if let Some(paper) = &plan.paper {
            let other = paper.standard_uncertainty[place];
            row.extend([shown(other), format!("{:.2}", u / other)]);
        }
        row
    };
    columns::table(out, &names, Parameter::AS_IN_THE_PAPER.map(row));
    let turn_on = if plan.turn_on_over_tolerance > 0.0 { " and of a single turn-on" } else { "" };
    let words = format!(
        "u: standard uncertainty (k = 1) from errors of single readings{turn_on}, drifts at local g; `calibrate` adds the \
         errors below, as far as they are stated."
    );
    columns::paragraph(out, "  ", &words);
}

/// Formats a value with four significant digits.
fn significant(value: f64) -> String {
    let digits = if value == 0.0 { 0.0 } else { 3.0 - libm::floor(libm::log10(value.abs())) };
    format!("{value:.*}", digits.clamp(0.0, 12.0) as usize)
}

fn common_errors(out: &mut String, plan: &Plan) {
    out.push_str(
        "\nErrors common to all positions: largest change of a parameter in % of its tolerance, largest residual\n",
    );
    let mut names = vec!["error", "size", "change, %", "residual, °/h"];
    if plan.paper.is_some() {
        names.extend(["paper: change, %", "paper: residual, °/h"]);
    }
    let cells = |effect: &Effect| {
        // Rounding leaves about 1e-15.
        let residual = effect.largest_residual_deg_per_h;
        let residual = if residual < 1e-12 { "0".to_owned() } else { columns::two_digits(residual) };
        [percent(effect.largest_over_tolerance), residual]
    };
    let rows = plan.evaluation.effects.iter().enumerate().map(|(place, effect)| {
        let mut row = vec![effect.error.name.to_owned(), size(effect)];
        row.extend(cells(effect));
        row.extend(plan.paper.iter().flat_map(|paper| cells(&paper.effects[place])));
        row
    });
    columns::table(out, &names, rows);
}

/// Returns the size of an error with its unit.
pub(crate) fn size(effect: &Effect) -> String {
    let CommonError { size, cause, .. } = effect.error;
    quantity(&size.to_string(), cause.unit())
}

/// Formats a standard uncertainty as a share of the tolerance, in percent.
pub(crate) fn percent_of_tolerance(share: f64) -> String {
    format!("{:.1}", 100.0 * share)
}

/// Formats a share in percent: two digits, or 0 where only rounding is left.
pub(crate) fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    match percent {
        small if small < 1e-6 => "0".to_owned(),
        small if small < 0.095 => columns::two_digits(small),
        small if small < 9.5 => format!("{small:.1}"),
        large => format!("{large:.0}"),
    }
}

/// Which effects a sentence names.
type Named = fn(&Effect) -> bool;

/// Returns the parameters of which no value can be found within the tolerance, in a sentence, if there are any.
fn no_gyro_can_pass(plan: &Plan, gyro_type: &str) -> Option<String> {
    let of_tolerance = |parameter: &Parameter| {
        plan.evaluation.standard_uncertainty[parameter.place()] / plan.tolerance[parameter.place()]
    };
    let beyond =
        Parameter::AS_IN_THE_PAPER.into_iter().filter(|parameter| COVERAGE_FACTOR * of_tolerance(parameter) > 1.0);
    let beyond: Vec<&str> = beyond.map(Parameter::symbol).collect();
    let no_other = if plan.exhaustive { "; no other choice of as many readings is better" } else { "" };
    (!beyond.is_empty()).then(|| {
        format!(
            "No gyro of type {gyro_type} can pass by guarded acceptance with these readings, because 2 u is larger than the \
             tolerance of {}{no_other}.",
            beyond.join(", ")
        )
    })
}

/// Returns `true` if the uncertainty of local g alone exceeds a tolerance.
fn gravity_prevents_a_pass(plan: &Plan) -> bool {
    COVERAGE_FACTOR * plan.gravity_over_tolerance > 1.0
}

/// Returns what the uncertainty of local g contributes.
fn gravity(plan: &Plan) -> String {
    format!(
        "The standard uncertainty of local g alone makes u of ω_g or ω_k {} % of the tolerance at the g of the type; to \
         reduce it, state the height of the site, or measure g.",
        percent(plan.gravity_over_tolerance)
    )
}

/// Returns what the noise between turn-ons contributes, if it is much.
fn turn_ons(plan: &Plan) -> Option<String> {
    (plan.turn_on_over_tolerance > LARGE_SHARE).then(|| {
        format!(
            "The gyro noise between turn-ons alone makes u of ω_0 {} % of the tolerance. More readings do not reduce it; \
             several turn-ons do.",
            percent(plan.turn_on_over_tolerance)
        )
    })
}

/// Returns what a user of the plan must know besides the numbers.
fn remarks(plan: &Plan, site_azimuth_deg: f64) -> Vec<String> {
    let mut remarks = Vec::new();
    if plan.gravity_over_tolerance > LARGE_SHARE && !gravity_prevents_a_pass(plan) {
        remarks.push(gravity(plan));
    }
    if plan.beyond_range > 0 {
        let positions = match plan.beyond_range {
            1 => "One position is".to_owned(),
            some => format!("{some} positions are"),
        };
        remarks.push(format!("{positions} left out: the gyro needs more current there than meter.range_ma."));
    }
    let kinds: [(&str, Named); 3] = [
        (
            "The residuals of the following errors are too small to be seen next to the noise of the readings",
            |effect| effect.matters() && effect.is_hidden(),
        ),
        ("The residuals show errors of this size", |effect| effect.matters() && !effect.is_hidden()),
        ("These errors have almost no effect (below 0.1 % of every tolerance)", |effect| !effect.matters()),
    ];
    for (words, is) in kinds {
        let effects = plan.evaluation.effects.iter().filter(|effect| is(effect));
        let names: Vec<&str> = effects.map(|effect| effect.error.name).collect();
        if !names.is_empty() {
            remarks.push(format!("{words}: {}.", names.join(", ")));
        }
    }
    let worse: Vec<String> =
        plan.worse().iter().map(|(parameter, ratio)| format!("{} ({ratio:.2} times)", parameter.symbol())).collect();
    match (&plan.paper, worse.as_slice()) {
        (None, _) => {}
        (Some(_), []) => remarks.push("No parameter is more uncertain than with the paper's eight.".to_owned()),
        (Some(_), worse) => {
            remarks.push(format!("Uncertainties larger than with the paper's eight: {}.", worse.join(", ")));
        }
    }
    if !plan.has_matrices {
        remarks.push(
            "The plan lacks some of the paper's eight positions: without them a passport has no matrices, and only least \
             squares applies."
                .to_owned(),
        );
    }
    if !plan.has_general_model {
        remarks.push("It does not determine the general model, the full matrix of g-sensitive drift.".to_owned());
    }
    if 2 * plan.readings.len() == Parameter::EIGHT.len() {
        remarks.push("Four positions leave no degrees of freedom: the fit cannot be tested.".to_owned());
    }
    remarks.push(format!(
        "In this order an ω_0 that rises or falls by {DRIFT_DEG_PER_H} °/h on each axis during the run changes no parameter by \
         more than {} % of its tolerance.",
        percent(DRIFT_DEG_PER_H * plan.order.largest_over_tolerance)
    ));
    if plan.frame_axis_azimuth_deg != site_azimuth_deg {
        remarks.push(format!(
            "The site file has the frame's axis at {}; for this plan set up the base so that the axis points to {}, and state \
             frame_axis_azimuth_deg: {}.",
            azimuth(site_azimuth_deg),
            azimuth(plan.frame_axis_azimuth_deg),
            decimal(plan.frame_axis_azimuth_deg)
        ));
    }
    if !plan.has_matrices && plan.readings.iter().all(|at| at.index.is_none()) {
        remarks.push("The stand must have these positions certified; the paper's eight are not enough.".to_owned());
    }
    let not_stated: Vec<&str> = plan.not_stated().collect();
    if !not_stated.is_empty() {
        remarks.push(format!("Not stated, and taken as 0: {}.", not_stated.join("; ")));
    }
    remarks
}
