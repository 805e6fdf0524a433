//! Result of a recertification, also as JSON.

use crate::batch::recertification::Recertified;
use crate::register::Row;
use crate::report::certification::{self, change};
use crate::report::difference;
use crate::report::doc::{Block, Words, code, given, line, listed, marked, say};
use crate::report::issued::{self, Report, State};
use crate::report::register::state;
use crate::text::{name_of, shown};
use crate::wording::Outcome;
use crate::wording::texts::{calibration, issued as texts};
use serde_json::{Value, json};
use std::path::Path;

fn reports(found: &Recertified) -> impl Iterator<Item = Report> {
    let done = found.done.iter().map(|row| Report {
        file: row.file.clone(),
        sha256: Some(row.sha256.clone()),
        ..Report::new(row.id.clone(), State::Unchanged)
    });
    done.chain(found.passports.iter().map(Report::of))
}

/// Returns the result as JSON: `{dry_run, refused, certification, comparison, old_certificate, in_question, changes, passports,
/// remaining, stand_file, superseded_file}`.
pub(crate) fn to_json(found: &Recertified, dry_run: bool) -> Value {
    let certified = certification::to_json(Some(&found.certification), None, Some(&found.comparison));
    let passports =
        reports(found).map(|row| json!({"id": row.id, "state": row.state, "file": row.file, "sha256": row.sha256}));
    json!({
        "dry_run": dry_run,
        "refused": found.refused,
        "certification": certified["certification"],
        "comparison": certified["comparison"],
        "old_certificate": found.old_number,
        "in_question": found.in_question.iter().map(|(row, customer)| {
            json!({"id": row.id, "site": row.site, "customer": customer, "state": row.state, "since": row.since})
        }).collect::<Vec<_>>(),
        "changes": difference::numbers_json(&found.changes),
        "passports": passports.collect::<Vec<_>>(),
        "remaining": found.remaining,
        "stand_file": name_of(&found.stand_file),
        "superseded_file": found.superseded.as_deref().map(name_of),
    })
}

/// The new certificate, the check against the old one, what has changed, and the passports.
pub(crate) fn document(found: &Recertified, dry_run: bool) -> Vec<Block> {
    if found.refused {
        let nothing = issued::done(Some(false), texts::NOTHING_WRITTEN);
        let first = line(vec![nothing, "  ".into(), texts::not_accepted(code("--accept-change"))]);
        let compared = certification::comparison(&found.comparison, true);
        return [compared, in_question(found), vec![first]].concat();
    }
    let stand = &found.certification.stand;
    let [number, old] = [&stand.certificate.number, &found.old_number].map(given);
    let checked = certification::outcome_of(&found.comparison, found.comparison.same_stand);
    // The work is done even if the stand has changed: a cross would say that it failed.
    let outcome = match (checked, certification::outcome_of_certification(&found.certification)) {
        (Outcome::Passed, of_readings) => of_readings,
        _ => Outcome::Undecided,
    };
    let (outcome, work) = if dry_run { (Outcome::NotAsked, texts::IS_PLANNED) } else { (outcome, texts::RECERTIFIED) };
    let (of_check, count) = (change::word(checked), reports(found).count());
    let certificate = texts::new_certificate(number.clone(), old.clone(), of_check, count);
    let name = format!("{} {}: ", stand.stand.model, stand.stand.serial);
    let mut doc = vec![line(vec![marked(outcome, work), "  ".into(), given(name), certificate]), Block::Gap];
    doc.extend(certification::certification(&found.certification));
    doc.push(Block::Gap);
    doc.extend(certification::comparison(&found.comparison, false));
    doc.extend(in_question(found));
    doc.push(Block::Gap);
    doc.extend(change::deviations(&found.old_number, &found.changes));
    doc.push(Block::Gap);
    let done = |verb| match dry_run {
        true => issued::done(None, texts::PLANNED),
        false => issued::done(Some(true), verb),
    };
    let file = |number: &Words, path: &Path| {
        Words::All(vec![texts::certificate(number.clone()), "  ".into(), shown(path).to_string().into()])
    };
    let mut lines: Vec<Vec<Words>> = reports(found).flat_map(|report| issued::named(&report)).collect();
    lines.push(vec![done(texts::CERTIFIED), file(&number, &found.stand_file)]);
    lines.extend(found.superseded.iter().map(|path| vec![done(texts::KEPT), file(&old, path)]));
    doc.push(Block::Whole("", lines));
    if !found.remaining.is_empty() {
        let still = texts::still_in_force(old, listed(found.remaining.iter().map(given)), code("`revoke`"));
        doc.push(line(calibration::warning(still)));
    }
    doc
}

/// The passports by which results were obtained since the last good check, if the stand has changed.
fn in_question(found: &Recertified) -> Vec<Block> {
    if found.in_question.is_empty() {
        return Vec::new();
    }
    let of_passport = |(row, customer): &(Row, Option<String>)| {
        vec![given(&row.id), state(row).into(), customer.as_ref().map_or_else(|| "".into(), given)]
    };
    let rows = found.in_question.iter().map(of_passport).collect();
    vec![say([texts::in_question(found.measured, given(&found.old_number))]), Block::Lines("  ", rows)]
}
