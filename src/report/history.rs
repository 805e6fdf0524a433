//! One stand over the years, as text and as JSON.

use crate::attitude::{ANGLE_SYMBOLS, ANGLES};
use crate::calibration::document::finite;
use crate::history::drift::{DRIFTS, Drift, Jump, SUSPECTED, Series};
use crate::history::{History, PastCertificate, PastPassport};
use crate::report::page::language::capital;
use crate::report::style::Outcome;
use crate::report::{columns, style};
use crate::text::printable;
use serde_json::{Value, json};
use std::fmt::Write;

/// Returns the history as JSON: `{stand, certificates, passports, places, withdrawals, drift, remarks}`.
pub(crate) fn to_json(history: &History) -> Value {
    json!({
        "stand": history.stand,
        "certificates": history.certificates.iter().map(certificate_json).collect::<Vec<_>>(),
        "passports": history.passports.iter().map(passport_json).collect::<Vec<_>>(),
        "places": history.places,
        "withdrawals": history.withdrawals().into_iter().map(|row| {
            json!({"id": row.id, "sha256": row.sha256, "revoked_at": row.since, "reason": row.reason})
        }).collect::<Vec<_>>(),
        "drift": drift_json(&history.drift),
        "remarks": history.remarks,
    })
}

fn passport_json(at: &PastPassport) -> Value {
    let row = &at.row;
    json!({
        "id": row.id,
        "file": row.file,
        "sha256": row.sha256,
        "state": row.state,
        "expired": row.expired,
        "site": row.site,
        "certificate": row.certificate,
        "valid_until": row.valid_until,
        "since": row.since,
        "by": row.by,
        "issued_at": row.issued_at,
        "ended_at": at.ended_at,
        "predecessor": at.predecessor,
        "reason": at.reason,
    })
}

fn certificate_json(at: &PastCertificate) -> Value {
    let certificate = &at.stand.certificate;
    json!({
        "number": certificate.number,
        "issued": certificate.issued,
        "performed": certificate.performed,
        "valid_until": certificate.valid_until,
        "laboratory": certificate.laboratory,
        "runs": certificate.evidence.as_ref().map(|evidence| evidence.runs),
        "readings_sha256": certificate.evidence.as_ref().map(|evidence| &evidence.readings_sha256),
        "passports": at.passports,
        "withdrawn": !at.counts,
    })
}

fn drift_json(drift: &Drift) -> Value {
    let worst = drift.most_significant();
    json!({
        "drifts": drift.drifts(),
        "tested": drift.tested(),
        "probability": worst.and_then(|series| series.corrected_probability),
        "detectable_arcsec_per_year": drift.detectable_arcsec_per_year(),
        "sentence": sentence(drift, ANGLES),
        "relative": drift.hidden_change().map(series_json),
        "deviations": drift.series.iter().map(series_json).collect::<Vec<_>>(),
    })
}

fn series_json(series: &Series) -> Value {
    let line = series.line.as_ref();
    json!({
        "i": series.index.i, "j": series.index.j, "angle": ANGLES[series.angle],
        "values": series.values,
        "slope_arcsec_per_year": line.map(|line| line.slope),
        "u_slope_arcsec_per_year": line.map(|line| line.u_slope),
        "degrees_of_freedom": line.and_then(|line| finite(line.slope_degrees_of_freedom)),
        "probability": line.map(|line| line.probability()),
        "corrected_probability": series.corrected_probability,
        "chi_square": line.or(series.jump.as_ref().map(|jump| &jump.line)).map(|line| {
            json!({"value": line.chi_square, "degrees_of_freedom": line.degrees_of_freedom})
        }),
        "jump": series.jump,
    })
}

/// Returns the result of the test for drift in words, with the given names of the angles α, β, γ.
pub(crate) fn sentence(drift: &Drift, angles: [&str; 3]) -> String {
    let of_each = match drift.worst_jump() {
        Some((series, jump)) if drift.most_significant().is_none() => jumped(drift, angles, series, jump),
        Some((series, jump)) => {
            format!("{}; of the other deviations: {}", jumped(drift, angles, series, jump), of_lines(drift, angles))
        }
        None => of_lines(drift, angles),
    };
    match drift.hidden_change() {
        Some(series) => format!("{of_each}; but {}", relative(drift, angles, series)),
        None => of_each,
    }
}

/// Formats a change with its unit and its standard uncertainty.
fn measured(value: f64, unit: &str, u: f64) -> String {
    let decimals = columns::decimals(u);
    format!("{}{unit} (u = {u:.decimals$})", columns::signed(value, decimals))
}

/// Returns the sentence on a change of one deviation that the parts common to all positions hide.
fn relative(drift: &Drift, angles: [&str; 3], series: &Series) -> String {
    let name = format!("{} of position {}", angles[series.angle], series.index);
    let (what, probability) = match (&series.jump, &series.line) {
        (Some(Jump { certificates: [from, to], change_arcsec, u_arcsec, corrected_probability, .. }), _) => {
            let change = measured(*change_arcsec, "″", *u_arcsec);
            (format!("has jumped by {change} between certificates {from} and {to}"), *corrected_probability)
        }
        (None, line) => {
            let (slope, u) = line.map_or((0.0, 0.0), |line| (line.slope, line.u_slope));
            let slope = measured(slope, "″ per year", u);
            (format!("drifts by {slope}"), series.corrected_probability.unwrap_or(1.0))
        }
    };
    format!(
        "{name} {what} relative to the other positions, {}; the uncertainty common to all positions hides it",
        by_chance(probability, drift.relative.len())
    )
}

/// Returns a probability, what it is of, and for how many tests it is corrected.
fn by_chance(probability: f64, tests: usize) -> String {
    let p = columns::probability(probability);
    let equals = if p.starts_with('<') { "" } else { "= " };
    format!("p {equals}{p} (probability of a larger value by chance, corrected for {tests} tests)")
}

/// Returns the sentence on the deviations that are not on a line.
fn jumped(drift: &Drift, angles: [&str; 3], series: &Series, jump: &Jump) -> String {
    let [from, to] = &jump.certificates;
    format!(
        "the stand has jumped: {} of {} deviations are not on a straight line and have no rate of drift; the most significant \
         is {} of position {}, {} between certificates {from} and {to}, chi-square of the line {:.1} with {} degrees of \
         freedom, {}",
        drift.jumps().count(),
        drift.tested(),
        angles[series.angle],
        series.index,
        measured(jump.change_arcsec, "″", jump.u_arcsec),
        jump.line.chi_square,
        jump.line.degrees_of_freedom,
        by_chance(jump.corrected_probability, drift.tested())
    )
}

/// Returns the result of the test for drift of the deviations that are on a line.
fn of_lines(drift: &Drift, angles: [&str; 3]) -> String {
    let tested = drift.most_significant().and_then(|worst| Some((worst, worst.corrected_probability?)));
    let Some((worst, probability)) = tested else {
        let what = "two certificates from different dates that state the uncertainties of the deviations";
        return format!("drift was not tested: this needs {what}");
    };
    let name = format!("{} of position {}", angles[worst.angle], worst.index);
    let tested = drift.tested();
    let by = by_chance(probability, tested);
    let slope = worst.line.map_or_else(String::new, |line| measured(line.slope, "″ per year", line.u_slope));
    let drifting = drift.series.iter().filter(|at| at.corrected_probability.is_some_and(|p| p < DRIFTS)).count();
    let between_two = worst.line.filter(|line| line.degrees_of_freedom == 0).and_then(|_| worst.change());
    if let Some((change, u)) = between_two.filter(|_| probability < DRIFTS) {
        let change = measured(change, "″", u);
        format!(
            "the stand has changed: {drifting} of {tested} deviations; the most significant is {name}, {change}, {by}; two \
             certificates do not show whether this is a drift or a jump"
        )
    } else if probability < DRIFTS {
        format!("the stand drifts: {drifting} of {tested} deviations; the most significant is {name}, {slope}, {by}")
    } else if probability < SUSPECTED {
        format!("a drift is suspected: {name}, {slope}, {by}; recertify the stand earlier than planned")
    } else {
        let found = drift.detectable_arcsec_per_year().map_or_else(String::new, |smallest| {
            let smallest = columns::two_digits(smallest);
            format!("; a drift of any deviation by {smallest}″ per year would be detected with a probability of 95 %")
        });
        format!("no drift was found: the most significant is {name}, {slope}, {by}{found}")
    }
}

/// Returns the history as text: the time line, the drift of each deviation, and the result of the test.
pub(crate) fn text(history: &History) -> String {
    let mut out = String::new();
    let counts = [
        (history.certificates.len(), "certificate"),
        (history.passports.len(), "passport"),
        (history.sites().len(), "site"),
        (history.withdrawals().len(), "withdrawal"),
    ];
    let counts = counts.map(|(count, what)| format!("{count} {what}{}", if count == 1 { "" } else { "s" }));
    let answer = answer(&history.drift);
    let _ = writeln!(out, "{answer}  {}: {}", style::heading(&history.stand), counts.join(", "));
    columns::paragraph(&mut out, "  ", &format!("{}.\n", capital(&sentence(&history.drift, ANGLE_SYMBOLS))));
    for (when, what, words) in time_line(history) {
        columns::named(&mut out, &format!("{when}  {what}"), 25, &printable(words));
    }
    let _ = writeln!(out, "\n{}", style::heading("Sites with a passport"));
    for stay in &history.places {
        let from = day(stay.from);
        let time = stay.until.map_or_else(|| format!("from {from}"), |until| format!("{from} to {}", day(until)));
        columns::named(&mut out, &time, 26, &stay.site);
    }
    drift(&mut out, &history.drift);
    for remark in &history.remarks {
        columns::paragraph(&mut out, "", &printable(format!("Remark: {remark}.")));
    }
    out
}

/// Returns the result of the test for drift in a word.
fn answer(drift: &Drift) -> String {
    let least = drift.most_significant().and_then(|worst| worst.corrected_probability);
    let (outcome, word) = match drift.drifts() {
        None => (Outcome::NotAsked, "NOT TESTED"),
        Some(true) if drift.jumps().next().is_none() && drift.series.iter().any(is_steady) => {
            (Outcome::Failed, "DRIFTS")
        }
        Some(_) if drift.has_changed() => (Outcome::Failed, "CHANGED"),
        Some(_) if least.is_some_and(|p| p < SUSPECTED) => (Outcome::Undecided, "SUSPECTED"),
        Some(_) => (Outcome::Passed, "NO DRIFT"),
    };
    style::marked(outcome, word)
}

/// Returns `true` if more than two certificates show a drift of a deviation; two do not show whether it is a jump.
fn is_steady(series: &Series) -> bool {
    series.is_drift() && series.line.as_ref().is_some_and(|line| line.degrees_of_freedom > 0)
}

/// Returns the date of an instant, in UTC.
fn day(time: jiff::Timestamp) -> String {
    time.to_string().chars().take(10).collect()
}

/// Returns the events in the order of time: date, kind, words.
fn time_line(history: &History) -> Vec<(String, &'static str, String)> {
    let mut events = Vec::new();
    for at in &history.certificates {
        let certificate = &at.stand.certificate;
        let runs =
            certificate.evidence.as_ref().map_or_else(String::new, |evidence| format!(", {} runs", evidence.runs));
        let withdrawn = if at.counts { "" } else { "; all of its passports were withdrawn" };
        let words = format!(
            "{}, {}{runs}, issued {}{withdrawn}",
            certificate.number, certificate.laboratory, certificate.issued
        );
        let kind = if certificate.performed.is_some() { "measured" } else { "certified" };
        events.push((certificate.measured().to_string(), kind, words));
    }
    for passport in &history.passports {
        events.push((day(passport.row.issued_at), "issued", issued_words(passport)));
    }
    for row in history.withdrawals() {
        let reason = row.reason.as_deref().unwrap_or_default();
        events.push((row.since.map(day).unwrap_or_default(), "withdrawn", format!("{}: {reason}", row.id)));
    }
    // The sort is stable: on one day the measurement comes before the passports, and these before a withdrawal.
    events.sort_by(|a, b| a.0.cmp(&b.0));
    events
}

fn issued_words(passport: &PastPassport) -> String {
    let row = &passport.row;
    let reason = match (&passport.predecessor, &passport.reason) {
        (Some(from), Some(reason)) => format!(", re-issued from {from}: {reason}"),
        _ => String::new(),
    };
    let until = match row.valid_until {
        Some(day) if row.is_in_force() => format!(", valid until {day}, inclusive"),
        _ => String::new(),
    };
    format!("{}, certificate {} ({}{until}){reason}", row.id, row.certificate, row.words())
}

/// Returns the row of a tested deviation, or `None` if it was not tested. One that has jumped has no rate.
fn row(series: &Series) -> Option<Vec<String>> {
    let rest = match (&series.jump, &series.line) {
        (Some(_), _) => ["-", "-", "-", "-", &style::marked(Outcome::Failed, "JUMP")].map(str::to_owned),
        (None, Some(line)) => {
            let decimals = columns::decimals(line.u_slope);
            let p = series.corrected_probability?;
            let mark = if p < DRIFTS {
                style::marked(Outcome::Failed, if is_steady(series) { "DRIFTS" } else { "CHANGED" })
            } else if p < SUSPECTED {
                style::marked(Outcome::Undecided, "suspected")
            } else {
                String::new()
            };
            [
                columns::signed(line.slope, decimals),
                format!("{:.decimals$}", line.u_slope),
                columns::probability(line.probability()),
                columns::probability(p),
                mark,
            ]
        }
        (None, None) => return None,
    };
    let (change, u_of_change) = series.change()?;
    let mut row = vec![
        series.index.i.to_string(),
        series.index.j.to_string(),
        ANGLE_SYMBOLS[series.angle].to_owned(),
        series.tested_values().count().to_string(),
        columns::signed(change, columns::decimals(u_of_change)),
    ];
    row.extend(rest);
    Some(row)
}

fn drift(out: &mut String, drift: &Drift) {
    let rows: Vec<_> = drift.series.iter().filter_map(row).collect();
    if !rows.is_empty() {
        let _ = writeln!(out, "\n{}", style::heading("Drift of the deviations (u: standard uncertainty, k = 1)"));
        let names = ["i", "j", "angle", "values", "change, ″", "″/year", "u", "probability", "corrected", ""];
        columns::table(out, &names, rows);
    }
}
