//! Registers of a folder, also as CSV, and their renewal.

use crate::folder::overview::{Alarm, AlarmCode, Overview};
use crate::folder::renewal::{Renewed, Withdrawn};
use crate::register::{Row, State};
use crate::report::columns;
use crate::report::doc::{Block, Words, given, joined, line, listed, longest, marked, padded};
use crate::text::shown;
use crate::wording::texts::{checks, register as texts};
use crate::wording::{Outcome, Text};
use serde_json::{Value, json};

/// The states of passports, in the order in which they are counted.
const STATES: [Text; 5] = [texts::EXPIRED, texts::IN_FORCE, texts::MOVED, texts::SUPERSEDED, texts::WITHDRAWN];

/// Returns the state of a passport, with the expiry of a current one.
pub(crate) fn state(row: &Row) -> Text {
    match row.state {
        State::Current if row.expired => texts::EXPIRED,
        State::Current => texts::IN_FORCE,
        State::Superseded => texts::SUPERSEDED,
        State::Moved => texts::MOVED,
        State::Withdrawn => texts::WITHDRAWN,
    }
}

/// The reason for the state; empty for a passport that never expires.
fn why(row: &Row) -> Words {
    match (&row.by, &row.reason) {
        (Some(by), _) => texts::since_by(row.since, given(by)),
        (None, Some(reason)) => texts::since(row.since, given(reason)),
        (None, None) => row.valid_until.map_or_else(|| "".into(), texts::valid_until),
    }
}

/// The alarm with its code and its file; the detail of the library is English.
pub(crate) fn alarm(alarm: &Alarm) -> Words {
    let file = alarm.file.as_ref().map_or_else(|| "".into(), |file| Words::All(vec![given(file), ": ".into()]));
    let detail = Words::OfLibrary(alarm.detail.clone(), Box::new(texts::alarm_code!(AlarmCode, alarm.code).into()));
    marked(Outcome::Failed, texts::alarm(alarm.code.key(), file, detail))
}

/// The number of passports in each state and of alarms, the register and the passports of each stand, and the alarms last,
/// where a terminal shows them however long the list is. `listed_rows` is the number of passports before any was filtered
/// out.
pub(crate) fn document(overview: &Overview, listed_rows: usize) -> Vec<Block> {
    let count = |wanted: Text| overview.rows().filter(|row| state(row) == wanted).count();
    let counts = STATES.into_iter().map(|state| (state, count(state))).filter(|(_, count)| *count > 0);
    let counts: Vec<Words> = counts.map(|(state, count)| texts::counted(count, state)).collect();
    let passports = match listed_rows {
        _ if !counts.is_empty() => listed(counts),
        0 => texts::NO_PASSPORTS.into(),
        all => texts::none_selected(all),
    };
    let is_empty = listed_rows == 0 && overview.alarms.is_empty();
    let outcome = match overview.needs_attention() {
        // A folder without passports may be the wrong one.
        _ if is_empty => Outcome::NotAsked,
        needs_attention => Some(!needs_attention).into(),
    };
    let mut lines = Vec::new();
    for stand in overview.stands.iter().filter(|stand| !stand.rows.is_empty()) {
        let fresh = stand.fresh_until.map_or_else(|| "".into(), checks::register_fresh);
        let register = texts::register_of(stand.sequence, stand.issued_at, fresh);
        lines.push(vec![Words::All(vec![given(&stand.stand), "  ".into(), register])]);
        for row in &stand.rows {
            let is_used = Some(row.is_in_force());
            let file = row.file.as_ref().map_or_else(|| texts::NO_FILE.into(), given);
            let state = marked(is_used, padded(state(row), |language| longest(STATES, language)));
            lines.push(vec![Words::All(vec!["  ".into(), state]), joined([given(&row.id), file], "  ")]);
            if row.by.is_some() || row.reason.is_some() || row.valid_until.is_some() {
                lines.push(vec!["".into(), why(row)]);
            }
        }
    }
    let mut doc = vec![line(marked(outcome, texts::summary(passports, overview.alarms.len())))];
    doc.extend(is_empty.then(|| line(texts::EMPTY_FOLDER)));
    doc.push(Block::Whole("", lines));
    doc.extend(overview.alarms.iter().map(|one| line(alarm(one))));
    doc
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
            out += &columns::csv_row(",", cells.into_iter().map(|cell| cell.unwrap_or("")));
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

/// The renewed registers, with what was concluded for each.
pub(crate) fn renewed(renewed: &[Renewed], dry_run: bool) -> Block {
    let done = || done(dry_run, texts::RENEWED);
    let lines = renewed.iter().flat_map(|one| {
        let register = texts::renewed_as(one.sequence, one.entries.len());
        let first = vec![done(), Words::All(vec![given(&one.stand), "  ".into(), register])];
        [first].into_iter().chain(one.conclusions.iter().map(|words| vec!["".into(), given(words)]))
    });
    Block::Whole("", lines.collect())
}

fn done(dry_run: bool, what: Text) -> Words {
    if dry_run { marked(Outcome::NotAsked, texts::PLANNED) } else { marked(Some(true), what) }
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

/// The withdrawn passports, one line each.
pub(crate) fn withdrawn(withdrawn: &[Withdrawn], dry_run: bool) -> Block {
    let lines = withdrawn.iter().flat_map(|one| {
        let register = || texts::in_register(one.sequence);
        let file = || shown(&one.register).to_string();
        one.ids
            .iter()
            .map(move |id| vec![done(dry_run, texts::WITHDRAWN), joined([given(id), register(), file().into()], "  ")])
    });
    Block::Whole("", lines.collect())
}
