//! Result of a recertification, as text and as JSON.

use crate::batch::recertification::Recertified;
use crate::report::certification::{self, change};
use crate::report::issued::{self, Report, State};
use crate::report::style::Outcome;
use crate::report::{columns, difference, doc, style};
use crate::text::{name_of, shown};
use crate::wording::Language;
use serde_json::{Value, json};
use std::fmt::Write;

fn reports(found: &Recertified) -> impl Iterator<Item = Report> {
    let done = found.done.iter().map(|row| Report {
        file: row.file.clone(),
        sha256: Some(row.sha256.clone()),
        ..Report::new(row.id.clone(), State::Unchanged)
    });
    done.chain(found.passports.iter().map(Report::of))
}

/// Returns the result as JSON: `{dry_run, certification, comparison, old_certificate, changes, passports, remaining,
/// stand_file, superseded_file}`.
pub(crate) fn to_json(found: &Recertified, dry_run: bool) -> Value {
    let certified = certification::to_json(Some(&found.certification), None, Some(&found.comparison));
    let passports =
        reports(found).map(|row| json!({"id": row.id, "state": row.state, "file": row.file, "sha256": row.sha256}));
    json!({
        "dry_run": dry_run,
        "certification": certified["certification"],
        "comparison": certified["comparison"],
        "old_certificate": found.old_number,
        "changes": difference::numbers_json(&found.changes),
        "passports": passports.collect::<Vec<_>>(),
        "remaining": found.remaining,
        "stand_file": name_of(&found.stand_file),
        "superseded_file": found.superseded.as_deref().map(name_of),
    })
}

/// Returns the result as text: the new certificate, the check against the old one, what has changed, and the passports.
pub(crate) fn text(found: &Recertified, dry_run: bool) -> String {
    let mut out = String::new();
    let stand = &found.certification.stand;
    let number = &stand.certificate.number;
    let (outcome, answer) = certification::answer(&found.comparison);
    // The work is done even if the stand has changed: a cross would say that it failed.
    let outcome = match (outcome, certification::outcome_of_certification(&found.certification)) {
        (Outcome::Passed, of_readings) => of_readings,
        _ => Outcome::Undecided,
    };
    let (outcome, work) = if dry_run { (Outcome::NotAsked, "PLANNED") } else { (outcome, "RECERTIFIED") };
    let _ = writeln!(
        out,
        "{}  {} {}: certificate {number}; check against certificate {}: {answer}; passports: {}\n",
        style::marked(outcome, work),
        stand.stand.model,
        stand.stand.serial,
        found.old_number,
        reports(found).count()
    );
    out += &certification::certification(&found.certification);
    let _ = write!(out, "\n{}", certification::comparison(&found.comparison, None));
    let _ = writeln!(out);
    doc::text(&mut out, &change::deviations(&found.old_number, &found.changes), Language::English);
    let _ = writeln!(out);
    out.extend(reports(found).map(|report| issued::named(&report)));
    let done = |verb| if dry_run { issued::marked(None, "planned") } else { issued::marked(Some(true), verb) };
    let _ = writeln!(out, "{}  certificate {number}  {}", done("certified"), shown(&found.stand_file));
    if let Some(path) = &found.superseded {
        let _ = writeln!(out, "{}  certificate {}  {}", done("kept"), found.old_number, shown(path));
    }
    if !found.remaining.is_empty() {
        let words = format!(
            "WARNING: in force under certificate {} still: {}; recertify them too, or withdraw them with `revoke`.",
            found.old_number,
            found.remaining.join(", ")
        );
        columns::paragraph(&mut out, "", &words);
    }
    out
}
