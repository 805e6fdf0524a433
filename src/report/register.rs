//! Register as text for a terminal and as CSV.

use crate::register::{AlarmKind, Register, State};
use crate::report::style::Outcome;
use crate::report::{columns, style};
use crate::text::{Printable, printable};
use std::fmt::Write;

impl State {
    pub(crate) fn words(self) -> String {
        if self == Self::Broken { "BROKEN".to_owned() } else { self.key().replace('_', " ") }
    }

    /// Returns `true` for a passport without a successor that has expired, or will do so soon.
    pub(crate) fn is_running_out(self) -> bool {
        matches!(self, Self::Expired | Self::Expiring)
    }

    /// Returns whether the passport may be used.
    fn outcome(self) -> Outcome {
        match self {
            Self::InForce => Outcome::Passed,
            Self::Expiring | Self::Unknown => Outcome::Undecided,
            _ => Outcome::Failed,
        }
    }
}

/// Returns the number of passports in each state and of alarms, a line for each passport, and last the alarms, which a
/// terminal then shows however long the list is.
pub(crate) fn text(register: &Register) -> String {
    let counts = register.counts().into_iter().map(|(state, count)| (count, state.words()));
    let summary = match (columns::counts(counts), register.files) {
        (counts, _) if !counts.is_empty() => counts,
        (_, 0) => "no passports".to_owned(),
        (_, files) => format!("no passport is selected, of {files}"),
    };
    let is_good = !register.is_incomplete() && !register.needs_attention();
    let summary = format!("{summary}; alarms: {}", register.alarms.len());
    // A folder without passports may be the wrong one.
    let is_empty = register.files == 0 && register.alarms.is_empty();
    let outcome = match is_good {
        _ if is_empty => Outcome::NotAsked,
        true if register.passports.iter().any(|line| line.state.is_running_out()) => Outcome::Undecided,
        is_good => Some(is_good).into(),
    };
    let mut out = style::marked(outcome, &summary) + "\n";
    if is_empty {
        out.push_str("The folder contains no passport; check its path.\n");
    }
    for line in &register.passports {
        let id = line.id.as_deref().unwrap_or("(id not verified)");
        let state = style::marked(line.state.outcome(), &format!("{:<13}", line.state.words()));
        let _ = writeln!(out, "{state}  {id}  {}", Printable(&line.file));
        columns::paragraph(&mut out, "                 ", &printable(&line.why));
    }
    for alarm in &register.alarms {
        columns::paragraph(&mut out, "", &style::marked(Some(false), &alarm.to_string()));
    }
    if register.alarms.iter().any(|alarm| alarm.kind == AlarmKind::Damaged) {
        let advice =
            "Get damaged files from the issuer again. Move a file that is not a passport or a list out of the folder.";
        columns::paragraph(&mut out, "", advice);
    }
    out
}

/// Returns the passports as CSV with the header `state,id,stand,site,issuer,valid_until,sha256,file,why`.
pub(crate) fn csv(register: &Register) -> String {
    let mut out = String::from("state,id,stand,site,issuer,valid_until,sha256,file,why\n");
    for line in &register.passports {
        let valid_until = line.valid_until.map(|day| day.to_string());
        let texts = [line.id.as_deref(), line.stand.as_deref(), line.site.as_deref(), line.issuer.as_deref()];
        let cells = [Some(line.state.key())].into_iter().chain(texts);
        let cells = cells.chain([valid_until.as_deref(), Some(&line.sha256), Some(&line.file), Some(&line.why)]);
        out += &columns::csv_row(cells.map(|cell| cell.unwrap_or("")));
    }
    out
}
