//! Contents of a workspace: stands, sites, passports in force, passports that expire soon, alarms, keys.

use super::due::{self, Due, Horizon, What};
use super::{WORKSPACE_FILE, Workspace};
use crate::batch::paths::{is_stand, is_yaml};
use crate::files::walk::{Entry, Walk};
use crate::files::{self, FileError};
use crate::folder::overview::{Overview, StandRows};
use crate::passport::{Question, Trust};
use crate::register::{Row, State, days_until};
use crate::report::doc::{Block, Counted, Words, code, given, joined, line, listed, marked};
use crate::report::register::alarm;
use crate::report::style::Outcome;
use crate::signing::{self, KeyFileError};
use crate::site::Site;
use crate::stand::Stand;
use crate::text::{LARGEST_DOCUMENT_BYTES, Unreadable, name_of, printable, shown};
use crate::trust::PublicKey;
use crate::wording::Text;
use crate::wording::texts::{checks, register as register_texts, status as texts};
use jiff::Timestamp;
use jiff::civil::Date;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Number of days before the expiry date from which a passport or certificate is listed as expiring.
pub(crate) const SOON_DAYS: i32 = 90;

/// Most lines of one kind in the text; the rest is counted.
const MOST_LINES: usize = 20;

#[derive(Debug, Serialize)]
pub(crate) struct Status {
    workspace: String,
    time: Timestamp,
    stands: Vec<StandLine>,
    sites: Vec<SiteLine>,
    passports: Option<Passports>,
    keys: Vec<KeyLine>,
    signing_key: Option<SigningKeyLine>,
    /// What will expire or stop being fresh, by date.
    pub(crate) due: Vec<Due>,
    /// Files that cannot be read, and parts that the workspace does not state, in words.
    remarks: Vec<String>,
    /// Whether the register could not be read completely.
    #[serde(skip)]
    pub(crate) incomplete: bool,
}

#[derive(Debug, Serialize)]
struct StandLine {
    id: String,
    file: String,
    certificate: String,
    valid_until: Option<Date>,
    expired: bool,
    #[serde(skip)]
    customer: Option<String>,
}

#[derive(Debug, Serialize)]
struct SiteLine {
    id: String,
    file: String,
    latitude_deg: f64,
}

#[derive(Debug, Serialize)]
struct Passports {
    /// Number of passports in each state, and of those that have expired or will soon.
    counts: BTreeMap<&'static str, usize>,
    expiring: Vec<Row>,
    /// Current passports that have expired, for the text.
    #[serde(skip)]
    expired: Vec<Row>,
    /// The registers of a laboratory's stands, and what is in force by them, for the text.
    #[serde(skip)]
    in_force: Vec<Words>,
    /// Registers that will soon no longer be fresh: stand and last day, for the text.
    #[serde(skip)]
    aging: Vec<(String, Date)>,
    alarms: Vec<String>,
    /// The alarms in every language.
    #[serde(skip)]
    found: Vec<Words>,
}

/// A trusted key, as a line of allowed_signers states it.
#[derive(Debug, Serialize)]
struct KeyLine {
    principals: String,
    namespaces: Option<String>,
    fingerprint: String,
    valid_after: Option<Timestamp>,
    valid_before: Option<Timestamp>,
    valid: bool,
}

#[derive(Debug, Serialize)]
struct SigningKeyLine {
    file: String,
    identity: Option<String>,
    fingerprint: Option<String>,
    /// Whether passports that it signs now would be trusted; null without key, identity or trust.
    trusted: Option<bool>,
    why: Option<String>,
}

/// Returns what `workspace` holds at `time`; without `trust`, passports are not examined.
///
/// Freshness is judged at the later of `time` and `now`. What is due is listed for `days` days.
pub(crate) fn status(
    workspace: &Workspace,
    trust: Option<&Trust>,
    (time, now): (Timestamp, Timestamp),
    days: i32,
) -> Result<Status, FileError> {
    let mut remarks = Vec::new();
    let stands = stands(workspace, time, &mut remarks)?;
    let sites = sites(workspace, &mut remarks)?;
    let register = match (&workspace.passports, trust) {
        (Some(folder), Some(trust)) => {
            let question = Question { now, ..Question::at(time) };
            Some(Overview::of(folder, Workspace::query(Some(workspace), trust, &question))?)
        }
        (None, _) => {
            remarks.push("no folder of passports is stated (passports)".to_owned());
            None
        }
        (_, None) => {
            remarks.push("the passports were not examined, because no trusted keys are stated (trust)".to_owned());
            None
        }
    };
    let incomplete = register.as_ref().is_some_and(Overview::is_incomplete);
    remarks.extend(register.iter().flat_map(|overview| overview.remarks.clone()));
    let keys = trust.map_or_else(Vec::new, |trust| keys(trust, time));
    let due = due(workspace, register.as_ref(), (&stands, &keys), &Horizon { time, days });
    Ok(Status {
        workspace: name_of(&workspace.root),
        time,
        stands,
        sites,
        passports: register.as_ref().map(|overview| passports(overview, time, workspace.is_of_a_laboratory())),
        keys,
        signing_key: workspace.key.as_deref().map(|key| signing_key(key, workspace, trust, time)),
        due,
        remarks,
        incomplete,
    })
}

/// Returns what is due, by date.
fn due(
    workspace: &Workspace,
    overview: Option<&Overview>,
    (stands, keys): (&[StandLine], &[KeyLine]),
    horizon: &Horizon,
) -> Vec<Due> {
    let certificates = stands.iter().filter_map(|stand| {
        let found = horizon.ends(What::CertificateExpires, &stand.id, stand.valid_until?)?;
        Some(Due { certificate: Some(stand.certificate.clone()), customer: stand.customer.clone(), ..found })
    });
    let ends = |key: &KeyLine| horizon.ends(What::KeyExpires, &key.principals, due::day(key.valid_before?));
    let of_passports = overview.map_or_else(Vec::new, |overview| due::of_passports(workspace, overview, horizon));
    let mut all: Vec<Due> = of_passports.into_iter().chain(certificates).chain(keys.iter().filter_map(ends)).collect();
    all.sort();
    all
}

fn stands(workspace: &Workspace, time: Timestamp, remarks: &mut Vec<String>) -> Result<Vec<StandLine>, FileError> {
    let Some(folder) = &workspace.stands else { return Ok(Vec::new()) };
    let line = |file: String, stand: Stand| StandLine {
        id: stand.stand.id(),
        file,
        customer: stand.stand.customer,
        certificate: stand.certificate.number,
        valid_until: stand.certificate.valid_until,
        expired: stand.certificate.valid_until.is_some_and(|last| days_until(time, last) < 0),
    };
    let place = |stand: &Stand| (stand.stand.id(), workspace.stand(&stand.stand.id()));
    read_each(Walk::deep(folder, is_stand), Stand::from_yaml, place, line, remarks)
}

fn sites(workspace: &Workspace, remarks: &mut Vec<String>) -> Result<Vec<SiteLine>, FileError> {
    let Some(folder) = &workspace.sites else { return Ok(Vec::new()) };
    let line = |file, site: Site| SiteLine { id: site.id.to_string(), file, latitude_deg: site.geodetic_deg() };
    let place = |site: &Site| (site.id.to_string(), workspace.site(site.id.as_str()));
    read_each(Walk::flat(folder, is_yaml), Site::from_yaml, place, line, remarks)
}

/// Returns a line for each file; `place` returns the identifier in it, and the file that this name means in the workspace.
/// Next to that file, another one with the same identifier does not count.
fn read_each<T, L>(
    walk: Walk,
    read: impl Fn(&str, &[u8]) -> Result<T, Unreadable>,
    place: impl Fn(&T) -> (String, Option<PathBuf>),
    line: impl Fn(String, T) -> L,
    remarks: &mut Vec<String>,
) -> Result<Vec<L>, FileError> {
    let mut lines = Vec::new();
    for entry in walk {
        let Entry::File(path) = entry? else { continue };
        let name = name_of(&path);
        let found = match read(&name, &files::read(&path, LARGEST_DOCUMENT_BYTES)?) {
            Ok(found) => found,
            Err(refused) => {
                remarks.push(refused.to_string());
                continue;
            }
        };
        let (id, expected) = place(&found);
        let expected = expected.filter(|expected| *expected != path);
        let is_copy = expected.as_ref().is_some_and(|expected| expected.exists());
        // A folder may be ordered in another way, with other levels.
        let levels = |path: &Path| path.components().count();
        if let Some(expected) = expected.filter(|expected| is_copy || levels(expected) == levels(&path)) {
            let (path, id, expected) = (shown(&path), printable(&id), shown(&expected));
            remarks.push(format!("{path}: found {id}, expected in {expected}; correct the file or its name"));
        }
        if !is_copy {
            lines.push(line(name, found));
        }
    }
    Ok(lines)
}

/// Returns the passports of a folder; a laboratory counts only those that it has.
fn passports(overview: &Overview, time: Timestamp, is_of_a_laboratory: bool) -> Passports {
    let counts_here = |row: &&Row| row.file.is_some() || !is_of_a_laboratory;
    let all = || overview.rows().filter(counts_here);
    let rows = |wanted: &dyn Fn(&Row) -> bool| all().filter(|row| wanted(row)).cloned().collect::<Vec<_>>();
    let expired = rows(&|row| row.state == State::Current && row.expired);
    let expiring = rows(&|row| row.is_in_force() && row.days_left(time).is_some_and(|days| days <= SOON_DAYS));
    let mut counts = BTreeMap::from([("expired", expired.len()), ("expiring", expiring.len())]);
    for state in State::ALL {
        let number = all().filter(|row| row.state == state && !(state == State::Current && row.expired)).count();
        counts.insert(state.key(), number);
    }
    let is_soon = |last: &Date| (0..=SOON_DAYS).contains(&days_until(time, *last));
    let aging = overview.stands.iter().filter_map(|one| Some((one.stand.clone(), one.fresh_until.filter(is_soon)?)));
    let of_stand = |stand: &StandRows| {
        let fresh = stand.fresh_until.map_or_else(|| "".into(), checks::register_fresh);
        let register = register_texts::register_of(stand.sequence, stand.issued_at, fresh);
        let in_force = stand.rows.iter().filter(|row| row.is_in_force() && row.file.is_some()).map(|row| {
            let until = row.valid_until.map(|last| Words::All(vec!["  ".into(), register_texts::valid_until(last)]));
            Words::All([given(&row.id)].into_iter().chain(until).collect())
        });
        [vec![given(&stand.stand), "  ".into(), register].into()].into_iter().chain(in_force).collect::<Vec<Words>>()
    };
    let in_force = overview.stands.iter().filter(|_| is_of_a_laboratory).flat_map(of_stand).collect();
    let alarms = overview.alarms.iter().map(ToString::to_string).collect();
    let found = overview.alarms.iter().map(alarm).collect();
    Passports { counts, expiring, expired, in_force, aging: aging.collect(), alarms, found }
}

fn keys(trust: &Trust, time: Timestamp) -> Vec<KeyLine> {
    let lines = trust.signers.lines().iter().map(|line| {
        let (principals, namespaces) = (line.principals.clone(), line.options.namespaces.clone());
        let (valid_after, valid_before) = (line.options.valid_after, line.options.valid_before);
        let valid = valid_after.is_none_or(|from| from <= time) && valid_before.is_none_or(|until| time <= until);
        KeyLine { principals, namespaces, fingerprint: line.key.fingerprint(), valid_after, valid_before, valid }
    });
    lines.collect()
}

/// Describes the signing key by its public half, which is in both files of a key and never encrypted.
fn signing_key(key: &Path, workspace: &Workspace, trust: Option<&Trust>, time: Timestamp) -> SigningKeyLine {
    let found = signing::key_to_sign_with(key);
    let mut why = found.as_ref().err().map(|error| match error {
        KeyFileError::File(file) if file.is_missing() => format!(
            "{}: missing; create the key with `keygen`, or state the path of yours as `key` in {WORKSPACE_FILE}",
            shown(key)
        ),
        _ => error.to_string(),
    });
    let fingerprint = found.as_ref().ok().map(PublicKey::fingerprint);
    let asked = found.ok().zip(workspace.identity.as_deref()).zip(trust);
    let trusted = asked.map(|((key, identity), trust)| {
        let refused = signing::distrust(trust, &key, identity, time);
        let trusted = refused.is_none();
        why = why.take().or(refused);
        trusted
    });
    SigningKeyLine { file: name_of(key), identity: workspace.identity.clone(), fingerprint, trusted, why }
}

impl Status {
    /// Returns the number of passports of a kind.
    fn count(&self, kind: &str) -> usize {
        self.passports.as_ref().and_then(|passports| passports.counts.get(kind)).copied().unwrap_or_default()
    }

    fn signing_key_is_unusable(&self) -> bool {
        self.signing_key.as_ref().is_some_and(|key| key.trusted != Some(true) && key.why.is_some())
    }

    /// Returns `true` if there is an alarm, an expired current passport, a file that cannot be read, or a signing key that
    /// cannot be used.
    pub(crate) fn needs_attention(&self) -> bool {
        let alarms = self.passports.as_ref().is_some_and(|passports| !passports.alarms.is_empty());
        alarms || self.count("expired") > 0 || !self.remarks.is_empty() || self.signing_key_is_unusable()
    }

    /// Returns the status: one line for each number, and below it what needs attention.
    pub(crate) fn document(&self) -> Vec<Block> {
        let of_stands = self.stands.iter().filter(|stand| stand.expired).count();
        let [expired, expiring] = ["expired", "expiring"].map(|kind| self.count(kind));
        let (outcome, verdict) = match self.needs_attention() {
            true => (Outcome::Failed, texts::NEEDS_ATTENTION),
            false if expiring + of_stands > 0 => (Outcome::Undecided, texts::NO_ALARMS),
            false => (Outcome::Passed, texts::NO_ALARMS),
        };
        let alarms = self.passports.as_ref().map_or(0, |passports| passports.alarms.len());
        let others: [(Counted, usize); 4] = [
            (texts::number_of_alarms, alarms),
            (texts::number_of_certificates, of_stands),
            (texts::number_of_keys, self.signing_key_is_unusable().into()),
            (texts::number_of_remarks, self.remarks.len()),
        ];
        let others = others.into_iter().filter(|(_, number)| *number > 0).map(|(words, number)| words(number));
        let counts = joined([texts::number_of_passports(expired, expiring)].into_iter().chain(others), "; ");
        let mut lines = Vec::new();
        let of_workspace = vec![given(&self.workspace), ", ".into(), self.time.into()];
        lines.push(vec![texts::WORKSPACE.into(), of_workspace.into()]);
        // A laboratory certifies no stands, and has no files of sites.
        let (stands, is_of_a_laboratory) = (self.stands.len(), self.signing_key.is_none());
        if !is_of_a_laboratory {
            let stands = if of_stands > 0 { texts::with_expired(stands, of_stands) } else { stands.into() };
            lines.push(vec![texts::STANDS.into(), stands]);
        }
        let expired = self.stands.iter().filter(|stand| stand.expired).map(|stand| {
            let certificate = texts::expired_certificate(given(&stand.certificate), stand.valid_until);
            vec![given(&stand.id), "  ".into(), certificate].into()
        });
        below(&mut lines, expired);
        lines.extend((!is_of_a_laboratory).then(|| vec![texts::SITES.into(), self.sites.len().into()]));
        if let Some(passports) = &self.passports {
            lines.extend(passports.lines());
        }
        lines.extend(self.of_keys());
        let mut doc = vec![line(vec![marked(outcome, verdict), "  ".into(), counts])];
        doc.push(Block::Whole("", lines));
        doc.extend(self.remarks.iter().map(|remark| {
            let mut each = remark.split('\n').map(given);
            let first = each.next().map(|first| vec![marked(Outcome::Failed, first)]);
            let others = each.map(|words| vec![Words::All(vec!["  ".into(), words])]);
            Block::Whole("", first.into_iter().chain(others).collect())
        }));
        doc
    }

    fn of_keys(&self) -> Vec<Vec<Words>> {
        let invalid = self.keys.iter().filter(|key| !key.valid).count();
        let trusted = texts::trusted_keys(self.keys.len());
        let trusted = if invalid > 0 { texts::not_valid_keys(trusted, invalid) } else { trusted };
        let mut lines = vec![vec![texts::KEYS.into(), trusted]];
        let of_key = |key: &KeyLine| {
            let mut words = vec![given(&key.principals), "  ".into(), given(&key.fingerprint)];
            words.extend(key.valid_after.map(texts::from));
            words.extend(key.valid_before.map(texts::until));
            if !key.valid {
                words.extend(["  ".into(), marked(Outcome::Failed, texts::NOT_VALID_NOW)]);
            }
            words.into()
        };
        below(&mut lines, self.keys.iter().map(of_key));
        lines.extend(self.signing_key.as_ref().map(|key| {
            let trusted: Words = match (key.trusted, &key.why) {
                (Some(true), _) => marked(Outcome::Passed, texts::TRUSTED),
                (_, Some(why)) => vec![marked(Outcome::Failed, texts::NOT_USABLE), ": ".into(), given(why)].into(),
                _ => {
                    let missing = [("`identity`", key.identity.is_none()), ("`trust`", self.keys.is_empty())];
                    let missing = missing.into_iter().filter(|(_, is)| *is).map(|(name, _)| name);
                    marked(Outcome::NotAsked, texts::not_checked(listed(missing), code(WORKSPACE_FILE)))
                }
            };
            let identity = key.identity.as_ref().map_or_else(|| texts::NO_IDENTITY.into(), given);
            let words = vec![texts::signs_with(given(&key.file)), "  ".into(), identity, "  ".into(), trusted];
            vec![words.into()]
        }));
        lines
    }
}

impl Passports {
    fn lines(&self) -> Vec<Vec<Words>> {
        let counted: [(&str, Text); 5] = [
            ("current", register_texts::IN_FORCE),
            ("expired", register_texts::EXPIRED),
            ("moved", register_texts::MOVED),
            ("superseded", register_texts::SUPERSEDED),
            ("withdrawn", register_texts::WITHDRAWN),
        ];
        let count = |kind: &str| self.counts.get(kind).copied().unwrap_or_default();
        let counts = counted.into_iter().map(|(kind, state)| (count(kind), state)).filter(|(count, _)| *count > 0);
        let counts: Vec<Words> = counts.map(|(count, state)| register_texts::counted(count, state)).collect();
        let counts = if counts.is_empty() { texts::NONE.into() } else { listed(counts) };
        let mut lines = vec![vec![texts::PASSPORTS.into(), counts]];
        below(&mut lines, self.in_force.iter().cloned());
        let of_row = |row: &Row, words: Words| Words::All(vec![given(&row.id), "  ".into(), words]);
        below(&mut lines, self.expiring.iter().map(|row| of_row(row, register_texts::valid_until(row.valid_until))));
        let was_valid = |row: &Row| texts::was_valid(marked(Outcome::Failed, texts::EXPIRED), row.valid_until);
        below(&mut lines, self.expired.iter().map(|row| of_row(row, was_valid(row))));
        let aging = self.aging.iter().map(|(stand, last)| {
            vec![given(stand), "  ".into(), texts::fresh_until(*last, code("`register --renew`"))].into()
        });
        below(&mut lines, aging);
        lines.push(vec![texts::ALARMS.into(), self.alarms.len().into()]);
        below(&mut lines, self.found.iter().cloned());
        lines
    }
}

/// Adds the lines below a number, the first [`MOST_LINES`] of them.
fn below(lines: &mut Vec<Vec<Words>>, more: impl Iterator<Item = Words>) {
    let more: Vec<Words> = more.collect();
    let others = more.len().saturating_sub(MOST_LINES);
    lines.extend(more.into_iter().take(MOST_LINES).map(|words| vec!["".into(), words]));
    lines.extend((others > 0).then(|| vec!["".into(), texts::more(others, code("--format json"))]));
}
