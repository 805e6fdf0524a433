//! Register of a folder of passports: the state of each, verified and compared with the others.
//!
//! The register is a function of verified passports, trust and a time; [`crate::folder`] finds the files.

mod alarm;
mod certificates;
mod successors;

pub use alarm::{Alarm, AlarmKind, Concern};

use crate::document::sha256_hex;
use crate::passport::checks::ASK_THE_ISSUER;
use crate::passport::{Check, CheckName, Code, Content, Question, Trust, Verification, verify};
use crate::revocation::Series;
use crate::text::{first_few, words};
use alarm::{absent_predecessors, duplicate_ids, gaps, misplaced};
use certificates::{Certificates, fingerprint};
use jiff::Timestamp;
use jiff::civil::Date;
use serde::Serialize;
use std::collections::{BTreeMap, HashMap};
use successors::Successors;

words! {
    /// State of a passport in a register.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
    #[serde(rename_all = "snake_case")]
    #[non_exhaustive]
    pub enum State: pub key {
        /// Issued and not expired.
        InForce = "in_force",
        /// In force, but expires within the given number of days.
        Expiring = "expiring",
        /// Superseded by its successor at the same site.
        Superseded = "superseded",
        /// Superseded, because the stand has moved to another site.
        Moved = "moved",
        /// Past its expiry date.
        Expired = "expired",
        /// Issued later than the time of verification.
        NotYetValid = "not_yet_valid",
        /// Withdrawn, or signed with a revoked key.
        Revoked = "revoked",
        /// In force unless an unreadable or missing file in the register supersedes or withdraws the passport.
        Unknown = "unknown",
        /// Failed verification.
        Broken = "broken",
    }
}

/// Register entry of one file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Line {
    /// File name.
    pub file: String,
    /// State of the passport.
    pub state: State,
    /// Identifier of the passport; null unless its signature and its content are correct.
    pub id: Option<String>,
    /// SHA-256 of the file.
    pub sha256: String,
    /// Model and serial number of the stand.
    pub stand: Option<String>,
    /// Site.
    pub site: Option<String>,
    /// Issuer.
    pub issuer: Option<String>,
    /// Number of the certificate of the stand.
    pub certificate: Option<String>,
    /// Expiry date (inclusive).
    pub valid_until: Option<Date>,
    /// Reason for the state: the successor, the failed check, or the reason for the withdrawal.
    pub why: String,
}

/// Register of a folder.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Register {
    /// Entries that match the question, sorted by id, then by file name.
    pub passports: Vec<Line>,
    /// Findings that require attention, for all passports.
    pub alarms: Vec<Alarm>,
    /// Number of passports, whether they match the question or not.
    #[serde(skip)]
    pub(crate) files: usize,
    /// Alarms that make the state of passports unknown.
    #[serde(skip)]
    doubts: Vec<Alarm>,
    /// Alarms of lists above the folder that were issued after the time of verification: they concern who issues passports
    /// now, but not the register as of that time.
    #[serde(skip)]
    pub(crate) later: Vec<Alarm>,
    #[serde(skip)]
    successors: Successors,
    #[serde(skip)]
    originals: Originals,
    #[serde(skip)]
    certificates: Certificates,
}

/// Summary of one examined file: a few hundred bytes, whatever the passport's size.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Examined {
    line: Line,
    /// Model, serial number and site, within which revisions are counted.
    series: String,
    revision: u32,
    predecessor: Option<Predecessor>,
    /// Fingerprint of the certified angles.
    angles: u64,
    /// Whether the passport is authentic: text, signature, numbers and signer are correct, and its key is not revoked.
    counts: bool,
    issued_at: Option<Timestamp>,
    /// Whether the passport was issued by the time of verification.
    issued: bool,
    /// Whether issuer, stand and place match the question.
    asked: bool,
    /// First check that failed, or `None` if every check passed.
    failed: Option<CheckName>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Predecessor {
    id: String,
    sha256: String,
    superseded: bool,
}

/// SHA-256 and file name of each file that may be the passport with an id. None of several takes precedence.
type Originals = HashMap<String, Vec<(String, String)>>;

/// Question that a register answers.
#[derive(Debug, Clone, PartialEq)]
pub struct Asked {
    /// Time of verification, and the issuer, stand and place of the passports to list.
    pub question: Question,
    /// Number of days before the expiry date from which a passport is reported as expiring; never if `None`.
    pub within_days: Option<u32>,
}

impl Asked {
    /// Creates a question about every passport at `time`.
    pub fn at(time: Timestamp) -> Self {
        Self { question: Question::at(time), within_days: None }
    }
}

/// Verifies one file and summarises the result.
pub fn examine(file: &str, bytes: &[u8], trust: &Trust, asked: &Asked) -> Examined {
    let time = asked.question.time;
    let verification = verify(file, bytes, trust, &Question::at(time));
    let content = verification.content_from_anyone();
    let failed = verification.failed();
    let (state, why) = match failed.map(|check| (check.code, check)) {
        None => in_force(content, time, asked.within_days),
        Some((Code::Expired, check)) => (State::Expired, check.detail.clone()),
        Some((Code::NotYetValid, check)) => (State::NotYetValid, check.detail.clone()),
        Some((Code::KeyRevoked | Code::PassportRevoked, check)) => (State::Revoked, check.detail.clone()),
        Some((_, check)) => (State::Broken, format!("{}: {}", check.name.as_str(), check.detail)),
    };
    let predecessor = content.and_then(|content| {
        let from = content.passport.reissued_from.as_ref()?;
        let superseded = content.passport.supersedes == Some(true);
        Some(Predecessor { id: from.id.clone(), sha256: from.sha256.clone(), superseded })
    });
    let line = Line {
        file: file.to_owned(),
        state,
        id: content.map(|content| content.passport.id.clone()),
        sha256: sha256_hex(bytes),
        stand: content.map(|content| content.stand.id()),
        site: content.map(|content| content.site.id.to_string()),
        issuer: content.map(|content| content.passport.issuer.clone()),
        certificate: content.map(|content| content.certificate.number.clone()),
        valid_until: content.and_then(Content::last_day).map(|(day, _)| day),
        why,
    };
    Examined {
        line,
        series: content.map_or_else(String::new, |content| series_of(&content.passport.id).0.to_owned()),
        revision: content.map_or(0, |content| content.passport.revision),
        predecessor,
        angles: content.map_or(0, |content| fingerprint(&content.positions)),
        counts: verification.authentic().is_some(),
        issued_at: content.map(|content| content.passport.issued_at),
        issued: content.is_some_and(|content| content.passport.issued_at <= time),
        asked: asked.question.is_open() || content.is_some_and(|content| asked.question.concerns(content)),
        failed: failed.map(|check| check.name),
    }
}

/// Splits an id into the series within which revisions are counted, and the revision.
fn series_of(id: &str) -> (&str, u32) {
    let (series, revision) = id.rsplit_once('/').unwrap_or((id, ""));
    (series, revision.parse().unwrap_or(0))
}

fn in_force(content: Option<&Content>, time: Timestamp, within_days: Option<u32>) -> (State, String) {
    let Some((last, _)) = content.and_then(Content::last_day) else {
        return (State::InForce, "no expiry date".to_owned());
    };
    let today = time.to_zoned(jiff::tz::TimeZone::UTC).date();
    let days = today.until(last).map_or(i32::MAX, |span| span.get_days());
    match within_days {
        Some(within) if i64::from(days) <= i64::from(within) => {
            let plural = if days == 1 { "" } else { "s" };
            (State::Expiring, format!("valid until {last} (inclusive), {days} day{plural} left"))
        }
        _ => (State::InForce, format!("valid until {last} (inclusive)")),
    }
}

impl Line {
    /// Returns the reason for the state, to be read without the state; that of a superseded passport is its successor alone.
    pub(crate) fn reason(&self) -> String {
        let state = if self.why.starts_with("by ") { "superseded " } else { "" };
        format!("{state}{}", self.why)
    }

    /// Returns `true` if the passport is in force, or if this is unknown.
    fn may_be_in_force(&self) -> bool {
        self.is_usable() || self.state == State::Unknown
    }

    /// Returns `true` if only other files can prevent the use of the passport.
    pub(crate) fn is_usable(&self) -> bool {
        matches!(self.state, State::InForce | State::Expiring)
    }

    /// Returns an explanation if the file is not where the passport's id requires, otherwise `None`.
    pub(crate) fn misplaced(&self) -> Option<String> {
        misplaced(self).map(|alarm| alarm.words)
    }
}

impl Examined {
    /// Returns `true` if form, signature and content of the passport are correct, whoever signed it.
    pub(crate) fn is_readable(&self) -> bool {
        self.failed.is_none_or(|failed| failed > CheckName::Schema)
    }

    /// Returns the SHA-256 of the file that this passport supersedes, or `None` if it supersedes none or is not
    /// authentic. A passport that was later withdrawn or has expired still supersedes its predecessor.
    pub(crate) fn supersedes(&self) -> Option<&str> {
        self.superseding().map(|predecessor| predecessor.sha256.as_str())
    }

    fn superseding(&self) -> Option<&Predecessor> {
        self.predecessor.as_ref().filter(|predecessor| self.counts && predecessor.superseded)
    }

    /// Returns `true` if the passport was withdrawn or its key was revoked.
    pub(crate) fn is_withdrawn(&self) -> bool {
        self.line.state == State::Revoked
    }

    /// Returns `true` if the file may be the passport with its id.
    fn is_original(&self) -> bool {
        self.counts && self.issued && !self.is_withdrawn()
    }

    /// Applies lists that were not known when the file was verified.
    fn heed(&mut self, withdrawn: &Series) {
        let is_reached = self.failed.is_none_or(|failed| failed > CheckName::Revocation);
        if let Some(entry) = withdrawn.entry(&self.line.sha256).filter(|_| is_reached) {
            self.line.state = State::Revoked;
            self.line.why = entry.to_string();
        }
    }
}

impl Register {
    /// Creates the register of all examined files.
    ///
    /// A passport is superseded by an authentic one that was issued by the time of verification, states that it
    /// supersedes, and references the passport's SHA-256, its id, or a later revision; or by a later revision for its
    /// site. This also applies if the successor was later withdrawn or has expired, so that older numbers do not come
    /// back into force. If several files have one id, none is in force until all but one are withdrawn. If a file cannot
    /// be read, no passport that it may affect is in force.
    ///
    /// `withdrawn` applies to every file; `alarms` are those raised while searching for the files.
    pub fn of(mut files: Vec<Examined>, withdrawn: &Series, mut alarms: Vec<Alarm>) -> Self {
        files.iter_mut().for_each(|file| file.heed(withdrawn));
        files.sort_by(|a, b| (&a.line.id, a.revision, &a.line.file).cmp(&(&b.line.id, b.revision, &b.line.file)));
        let successors = Successors::of(&files);
        alarms.extend(successors.forks());
        alarms.extend(duplicate_ids(&files));
        let absent = absent_predecessors(&files);
        alarms.extend(gaps(&files, &absent));
        alarms.extend(absent);
        alarms.extend(files.iter().filter_map(|file| misplaced(&file.line)));
        let mut register = Self {
            passports: Vec::new(),
            doubts: alarms.iter().filter(|alarm| alarm.concern.is_some()).cloned().collect(),
            alarms,
            later: Vec::new(),
            files: files.len(),
            successors,
            originals: originals(&files),
            certificates: Certificates::default(),
        };
        files.iter_mut().for_each(|file| register.settle(file));
        register.certificates = Certificates::of(&files);
        register.alarms.extend(register.certificates.alarms());
        register.alarms.extend(certificates::shared(&files));
        register.passports = files.into_iter().filter(|file| file.asked).map(|file| file.line).collect();
        register
    }

    /// Sets the final state of a file from the other files.
    fn settle(&self, file: &mut Examined) {
        let line = &mut file.line;
        if !line.is_usable() && line.state != State::Expired {
            return;
        }
        if let Some(by) = self.successors.by(&line.sha256, &file.series, file.revision) {
            line.state = if by.series == file.series { State::Superseded } else { State::Moved };
            let what = if line.state == State::Moved { "superseded " } else { "" };
            // The next successor explains the state; the last one is the passport to use.
            let last = self.successors.last(&line.sha256, &file.series, file.revision).unwrap_or(by);
            line.why = format!("{what}by {} ({})", last.id, last.file);
        } else if let Some(other) = line.id.as_deref().and_then(|id| self.other_original(id, &line.sha256)) {
            line.state = State::Superseded;
            line.why = format!("another file has the same id ({other}); withdraw all but one");
        } else if line.is_usable()
            && let Some(alarm) = self.doubt(line.stand.as_deref().unwrap_or(""))
        {
            line.state = State::Unknown;
            line.why = alarm.reason();
        }
    }

    /// Returns another file with this id but a different SHA-256, or `None` if there is none.
    fn other_original(&self, id: &str, sha256: &str) -> Option<&str> {
        let others = self.originals.get(id)?;
        others.iter().find(|(other, _)| other != sha256).map(|(_, file)| file.as_str())
    }

    /// Returns the alarm that makes it unknown whether passports of a stand, `<model>/<serial>`, are superseded or
    /// withdrawn; `None` if there is no such alarm.
    pub(crate) fn doubt(&self, stand: &str) -> Option<&Alarm> {
        self.doubts.iter().find(|alarm| alarm.concerns(stand))
    }

    /// Adds the check [`CheckName::Register`] to the verification of a passport; `bytes` is its whole file, which need
    /// not be in the register.
    pub(crate) fn asked(&self, verification: Verification, bytes: &[u8]) -> Verification {
        let not_run = || (Code::NotRun, "not run: an earlier check failed".to_owned());
        let (code, detail) = verification.content_from_anyone().map_or_else(not_run, |content| {
            let (id, sha256) = (content.passport.id.as_str(), sha256_hex(bytes));
            let (series, revision) = series_of(id);
            if let Some(by) = self.successors.last(&sha256, series, revision) {
                let advice = if by.withdrawn {
                    &format!(", which was withdrawn later; neither is in force; {ASK_THE_ISSUER}")
                } else if by.series != series {
                    "; the stand has left this site, and that passport is for the new one"
                } else {
                    "; use that passport"
                };
                (Code::Superseded, format!("superseded by {} ({}){advice}", by.id, by.file))
            } else if let Some(other) = self.other_original(id, &sha256) {
                let advice = "neither is in force until all but one have been withdrawn";
                (Code::Superseded, format!("another file has the same id ({other}); {advice}"))
            } else if let Some(alarm) = self.doubt(&content.stand.id()) {
                let advice = "get the damaged or missing file from the issuer again; move a file that is not a passport out of the folder";
                (Code::RegisterUnknown, format!("it is unknown whether the passport was superseded or withdrawn: {}; {advice}", alarm.reason()))
            } else {
                (Code::Ok, format!("not superseded by another passport in the register (files read: {})", self.files))
            }
        });
        verification.with(Check::new(CheckName::Register, code, detail))
    }

    /// Returns `true` if the file of this entry is one of several with the same id, none of which is in force.
    pub(crate) fn has_several(&self, line: &Line) -> bool {
        let superseded = self.successors.has(&line.sha256);
        !superseded && line.id.as_deref().is_some_and(|id| self.other_original(id, &line.sha256).is_some())
    }

    /// Returns `true` if an ancestor of the passport with this SHA-256 has several successors.
    pub(crate) fn is_of_a_fork(&self, sha256: &str) -> bool {
        self.successors.is_of_a_fork(sha256)
    }

    /// Returns the alarm that makes it uncertain which passports were withdrawn, or `None` if there is none.
    pub(crate) fn uncertain(&self) -> Option<&Alarm> {
        let uncertain = |alarm: &&Alarm| alarm.kind == AlarmKind::Revocation || alarm.concerns("");
        self.alarms.iter().chain(&self.later).find(uncertain)
    }

    /// Returns the objections to issuing from the certificate `number` of a stand: that it was replaced, or that the
    /// stand is in force under another one.
    pub(crate) fn against_certificate(&self, stand: &str, number: &str) -> Vec<String> {
        let mut others: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        let of_stand = |line: &&Line| line.may_be_in_force() && line.stand.as_deref() == Some(stand);
        for line in self.passports.iter().filter(of_stand) {
            let other = line.certificate.as_deref().filter(|other| *other != number);
            if let Some((other, id)) = other.zip(line.id.as_deref()) {
                others.entry(other).or_default().push(id);
            }
        }
        let others = others
            .into_iter()
            .map(|(other, ids)| format!("the stand is also in force under certificate {other}: {}", first_few(&ids)));
        self.certificates.replacement(stand, number).into_iter().chain(others).collect()
    }

    /// Returns `true` if the register needs attention: it has an alarm, or a passport that failed verification.
    pub fn needs_attention(&self) -> bool {
        !self.alarms.is_empty() || self.passports.iter().any(|line| line.state == State::Broken)
    }

    /// Returns `true` if the system refused to read a file or folder; the register may then be incomplete.
    pub(crate) fn is_incomplete(&self) -> bool {
        self.alarms.iter().any(|alarm| alarm.kind == AlarmKind::Unreadable)
    }

    /// Returns the number of listed passports in each state.
    pub fn counts(&self) -> BTreeMap<State, usize> {
        let mut counts = BTreeMap::new();
        for line in &self.passports {
            *counts.entry(line.state).or_insert(0) += 1;
        }
        counts
    }
}

/// Collects the files that may be the passport with each id; of copies of one file, only the first.
fn originals(files: &[Examined]) -> Originals {
    let mut originals = Originals::with_capacity(files.len());
    for file in files.iter().filter(|file| file.is_original()) {
        let known = originals.entry(file.line.id.clone().unwrap_or_default()).or_default();
        if known.iter().all(|(sha256, _)| *sha256 != file.line.sha256) {
            known.push((file.line.sha256.clone(), file.line.file.clone()));
        }
    }
    originals
}
