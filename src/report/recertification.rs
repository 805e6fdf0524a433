//! Result of a recertification, as text and as JSON.

use crate::batch::Planned;
use crate::batch::recertification::{NewPassport, Recertified};
use crate::report::{certification, columns, difference, style};
use crate::text::{Printable, name_of, shown};
use serde_json::{Value, json};
use std::fmt::Write;

/// Passport of a recertification, as it is reported.
struct Row<'a> {
    state: &'static str,
    id: &'a str,
    file: String,
    sha256: Option<&'a str>,
}

impl<'a> Row<'a> {
    fn of(passport: &'a NewPassport) -> Self {
        match passport {
            NewPassport::There(issued) => Self {
                state: if issued.new { "issued" } else { "unchanged" },
                id: &issued.id,
                file: name_of(&issued.path),
                sha256: Some(&issued.sha256),
            },
            NewPassport::Done(line) => Self {
                state: "unchanged",
                id: line.id.as_deref().unwrap_or_default(),
                file: line.file.clone(),
                sha256: Some(&line.sha256),
            },
            NewPassport::Planned(Planned { id, path, .. }) => {
                Self { state: "planned", id, file: name_of(path), sha256: None }
            }
        }
    }
}

/// Returns the result as JSON: `{dry_run, certification, comparison, old_certificate, changes, passports, remaining,
/// stand_file, superseded_file}`.
pub(crate) fn to_json(found: &Recertified, dry_run: bool) -> Value {
    let certified = certification::to_json(Some(&found.certification), None, Some(&found.comparison));
    let passports = found
        .passports
        .iter()
        .map(Row::of)
        .map(|row| json!({"id": row.id, "state": row.state, "file": row.file, "sha256": row.sha256}));
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
    let mut out = certification::certification(&found.certification);
    let _ = write!(out, "\n{}", certification::comparison(&found.comparison));
    let number = &found.certification.stand.certificate.number;
    let heading = format!("Change of the deviations from certificate {} (A) to {number} (B), arcsec", found.old_number);
    let _ = writeln!(out, "\n{}", style::heading(&heading));
    difference::numbers(&mut out, &found.changes);
    let _ = writeln!(out);
    for row in found.passports.iter().map(Row::of) {
        let _ = writeln!(out, "{:<9}  {}  {}", row.state, Printable(row.id), Printable(row.file));
        if let Some(sha256) = row.sha256 {
            let _ = writeln!(out, "           sha256 {sha256}");
        }
    }
    let verb = if dry_run { "planned" } else { "certified" };
    let _ = writeln!(out, "{verb:<9}  certificate {number}  {}", shown(&found.stand_file));
    if let Some(path) = &found.superseded {
        let _ = writeln!(
            out,
            "{:<9}  certificate {}  {}",
            if dry_run { "planned" } else { "kept" },
            found.old_number,
            shown(path)
        );
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
