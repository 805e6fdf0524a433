//! Registers of a folder as text for a terminal and as CSV, and their renewal.

use crate::folder::overview::Overview;
use crate::folder::renewal::{Renewed, Withdrawn};
use crate::register::{Row, State};
use crate::report::style::Outcome;
use crate::report::{columns, style};
use crate::text::{Printable, printable, shown};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Returns whether the passport of a row may be used.
fn outcome(row: &Row) -> Outcome {
    match (row.state, row.expired) {
        (State::Current, false) => Outcome::Passed,
        _ => Outcome::Failed,
    }
}

/// Returns the number of passports in each state and of alarms, the register and the passports of each stand, and last the
/// alarms, which a terminal then shows however long the list is. `listed` is the number of passports before any was
/// filtered out.
pub(crate) fn text(overview: &Overview, listed: usize) -> String {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    overview.rows().for_each(|row| *counts.entry(row.words()).or_insert(0) += 1);
    let counts = columns::counts(counts.into_iter().map(|(words, count)| (count, words.to_owned())));
    let summary = match listed {
        _ if !counts.is_empty() => counts,
        0 => "no passports".to_owned(),
        listed => format!("no passport is selected, of {listed}"),
    };
    let is_empty = listed == 0 && overview.alarms.is_empty();
    let outcome_of_all = match overview.needs_attention() {
        // A folder without passports may be the wrong one.
        _ if is_empty => Outcome::NotAsked,
        needs_attention => Some(!needs_attention).into(),
    };
    let mut out = style::marked(outcome_of_all, &format!("{summary}; alarms: {}", overview.alarms.len())) + "\n";
    if is_empty {
        out.push_str("The folder contains no passport; check its path.\n");
    }
    for stand in overview.stands.iter().filter(|stand| !stand.rows.is_empty()) {
        let fresh = stand.fresh_until.map_or_else(String::new, |last| format!(", fresh until {last} (inclusive)"));
        let _ = writeln!(out, "{}  register {} of {}{fresh}", stand.stand, stand.sequence, stand.issued_at);
        for row in &stand.rows {
            let state = style::marked(outcome(row), &format!("{:<10}", row.words()));
            let file = row.file.as_deref().unwrap_or("(no file)");
            let _ = writeln!(out, "  {state}  {}  {}", row.id, Printable(file));
            let why = row.why();
            if !why.is_empty() {
                columns::paragraph(&mut out, "                ", &printable(&why));
            }
        }
    }
    for alarm in &overview.alarms {
        columns::paragraph(&mut out, "", &style::marked(Some(false), &alarm.to_string()));
    }
    out
}

/// Returns the passports as CSV with the header
/// `state,expired,id,stand,site,issuer,certificate,valid_until,since,by,reason,sha256,file`.
pub(crate) fn csv(overview: &Overview) -> String {
    let mut out =
        String::from("state,expired,id,stand,site,issuer,certificate,valid_until,since,by,reason,sha256,file\n");
    for stand in &overview.stands {
        for row in &stand.rows {
            let [valid_until, since] = [row.valid_until.map(|day| day.to_string()), row.since.map(|at| at.to_string())];
            let cells = [
                Some(row.state.key()),
                Some(if row.expired { "true" } else { "false" }),
                Some(&row.id),
                Some(&stand.stand),
                Some(&row.site),
                Some(&stand.issuer),
                Some(&row.certificate),
                valid_until.as_deref(),
                since.as_deref(),
                row.by.as_deref(),
                row.reason.as_deref(),
                Some(&row.sha256),
                row.file.as_deref(),
            ];
            out += &columns::csv_row(cells.into_iter().map(|cell| cell.unwrap_or("")));
        }
    }
    out
}

/// Returns the renewed registers as JSON: `[{stand, sequence, passports, conclusions}]`.
pub(crate) fn renewed_json(renewed: &[Renewed]) -> Value {
    let of = |one: &Renewed| {
        json!({
            "stand": one.stand, "sequence": one.sequence, "passports": one.entries.len(), "conclusions": one.conclusions,
        })
    };
    renewed.iter().map(of).collect()
}

/// Returns the renewed registers as text, with what was concluded for each.
pub(crate) fn renewed(renewed: &[Renewed], dry_run: bool) -> String {
    let mut out = String::new();
    for one in renewed {
        let mark = if dry_run { style::marked(None, "planned") } else { style::marked(Some(true), "renewed") };
        let _ = writeln!(out, "{mark}  {}  register {}, passports: {}", one.stand, one.sequence, one.entries.len());
        for conclusion in &one.conclusions {
            columns::paragraph(&mut out, "           ", &printable(conclusion));
        }
    }
    out
}

/// Returns the withdrawn passports as JSON: `[{register, sequence, revoked, alarms}]`.
pub(crate) fn withdrawn_json(withdrawn: &[Withdrawn]) -> Value {
    let of = |one: &Withdrawn| {
        json!({
            "register": shown(&one.register).to_string(), "sequence": one.sequence, "revoked": one.ids, "alarms": one.alarms,
        })
    };
    withdrawn.iter().map(of).collect()
}

/// Returns the withdrawn passports as text, one line each.
pub(crate) fn withdrawn(withdrawn: &[Withdrawn], dry_run: bool) -> String {
    let mut out = String::new();
    for one in withdrawn {
        let mark = if dry_run { style::marked(None, "planned") } else { style::marked(Some(true), "withdrawn") };
        for id in &one.ids {
            let _ = writeln!(out, "{mark}  {id}  register {}  {}", one.sequence, shown(&one.register));
        }
    }
    out
}
