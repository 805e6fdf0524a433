//! What is in force in a folder of passports: every one verified, the chains followed.
//!
//! It is a function of verified passports, trust and a time; [`crate::folder`] finds the files.

mod alarm;
mod successors;

pub use alarm::{Alarm, AlarmKind};

use crate::document::sha256_hex;
use crate::passport::checks::{Check, CheckName, Code};
use crate::passport::content::Content;
use crate::passport::verification::{Question, Trust, Verification, verify};
use alarm::{duplicate_ids, forked, misplaced, missing};
use jiff::Timestamp;
use jiff::civil::Date;
use serde::Serialize;
use std::collections::BTreeMap;
use successors::Successors;

/// What is to be said of a passport.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// It may be used.
    InForce,
    /// It may be used, and ends within the days asked about.
    Expiring,
    /// Its successor at the same site counts.
    Superseded,
    /// The stand has gone to another site.
    Moved,
    /// Past its last day.
    Expired,
    /// Issued later than the time asked about.
    NotYetValid,
    /// It was withdrawn, or its key was revoked.
    Revoked,
    /// It does not verify.
    Broken,
}

/// One file of a register.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Line {
    /// The file.
    pub file: String,
    /// Its state.
    pub state: State,
    /// The passport's id; null until its signature holds and its content is good.
    pub id: Option<String>,
    /// SHA-256 of the file.
    pub sha256: String,
    /// Model and serial number.
    pub stand: Option<String>,
    /// Site.
    pub site: Option<String>,
    /// Issuer.
    pub issuer: Option<String>,
    /// Last day of validity.
    pub valid_until: Option<Date>,
    /// Why it is in this state: the successor, the failed check, the reason of withdrawal.
    pub why: String,
}

impl State {
    /// Its name for programs.
    pub fn key(self) -> &'static str {
        match self {
            Self::InForce => "in_force",
            Self::Expiring => "expiring",
            Self::Superseded => "superseded",
            Self::Moved => "moved",
            Self::Expired => "expired",
            Self::NotYetValid => "not_yet_valid",
            Self::Revoked => "revoked",
            Self::Broken => "broken",
        }
    }
}

/// The register of a folder.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Register {
    /// Every file, sorted by id, then by name.
    pub passports: Vec<Line>,
    /// What needs a person.
    pub alarms: Vec<Alarm>,
    #[serde(skip)]
    successors: Successors,
}

/// What a register keeps of one file: a few hundred bytes, whatever the passport's size.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Examined {
    line: Line,
    /// Model, serial number and site: what revisions are counted for.
    series: String,
    revision: u32,
    predecessor: Option<Predecessor>,
    /// Whether its word counts: text, signature, numbers and signer hold, and its key is not revoked.
    counts: bool,
}

/// The passport that one was made from.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Predecessor {
    sha256: String,
    series: String,
    revision: u32,
    superseded: bool,
}

/// Verifies one file; `within_days` sets from when on it counts as expiring.
pub fn examine(file: &str, bytes: &[u8], trust: &Trust, time: Timestamp, within_days: Option<u32>) -> Examined {
    let verification = verify(file, bytes, trust, &Question::at(time));
    examined(file, bytes, &verification, time, within_days)
}

/// What a register keeps of a file that was verified at `time`.
pub fn examined(
    file: &str,
    bytes: &[u8],
    verification: &Verification,
    time: Timestamp,
    within_days: Option<u32>,
) -> Examined {
    let content = verification.content();
    let failed = verification.checks().iter().find(|check| check.passed() == Some(false));
    let (state, why) = match failed.map(|check| (check.code, check)) {
        None => in_force(content, time, within_days),
        Some((Code::Expired, check)) => (State::Expired, check.detail.clone()),
        Some((Code::NotYetValid, check)) => (State::NotYetValid, check.detail.clone()),
        Some((Code::KeyRevoked | Code::PassportRevoked, check)) => (State::Revoked, check.detail.clone()),
        Some((_, check)) => (State::Broken, format!("{}: {}", check.name.as_str(), check.detail)),
    };
    let counts = verification.authentic().is_some();
    let predecessor = content.and_then(|content| {
        let from = content.passport.reissued_from.as_ref()?;
        let (series, revision) = series_of(&from.id);
        let superseded = content.passport.supersedes == Some(true);
        Some(Predecessor { sha256: from.sha256.clone(), series, revision, superseded })
    });
    let series = content.map_or_else(String::new, |content| series_of(&content.passport.id).0);
    let line = Line {
        file: file.to_owned(),
        state,
        id: content.map(|content| content.passport.id.clone()),
        sha256: sha256_hex(bytes),
        stand: content.map(|content| format!("{}/{}", content.stand.model, content.stand.serial)),
        site: content.map(|content| content.site.id.to_string()),
        issuer: content.map(|content| content.passport.issuer.clone()),
        valid_until: content.and_then(Content::last_day).map(|(day, _)| day),
        why,
    };
    Examined { line, series, revision: content.map_or(0, |content| content.passport.revision), predecessor, counts }
}

/// What an id counts revisions for, and the revision.
fn series_of(id: &str) -> (String, u32) {
    let (series, revision) = id.rsplit_once('/').unwrap_or((id, ""));
    (series.to_owned(), revision.parse().unwrap_or(0))
}

fn in_force(content: Option<&Content>, time: Timestamp, within_days: Option<u32>) -> (State, String) {
    let Some((last, _)) = content.and_then(Content::last_day) else {
        return (State::InForce, "no last day".to_owned());
    };
    let today = time.to_zoned(jiff::tz::TimeZone::UTC).date();
    let days = today.until(last).map_or(i32::MAX, |span| span.get_days());
    match within_days {
        Some(within) if i64::from(days) <= i64::from(within) => {
            (State::Expiring, format!("the last day is {last}, in {days} days"))
        }
        _ => (State::InForce, format!("to {last}")),
    }
}

impl Examined {
    /// What the register says of the file while no other file is known.
    pub fn line(&self) -> &Line {
        &self.line
    }

    /// The SHA-256 of the file that it supersedes, when it says so and its word counts: also when it has itself been
    /// withdrawn or has expired since.
    pub fn supersedes(&self) -> Option<&str> {
        let predecessor = self.predecessor.as_ref().filter(|predecessor| self.counts && predecessor.superseded);
        predecessor.map(|predecessor| predecessor.sha256.as_str())
    }

    /// Where the file belongs by the passport's id, when it is not there.
    pub fn misplaced(&self) -> Option<String> {
        misplaced(&self.line).map(|alarm| alarm.words)
    }
}

impl Register {
    /// Follows the chains of all files examined.
    ///
    /// A passport is superseded by one that names its file's SHA-256 and says so, or says so of a later revision, when
    /// that one's word counts; also by one that has itself been withdrawn or has expired since: the older numbers do not
    /// come back.
    ///
    /// `alarms` are those that were raised while the files were found.
    pub fn of(mut files: Vec<Examined>, mut alarms: Vec<Alarm>) -> Self {
        files.sort_by(|a, b| (&a.line.id, a.revision, &a.line.file).cmp(&(&b.line.id, b.revision, &b.line.file)));
        let successors = Successors::of(&files);
        for file in &mut files {
            let line = &mut file.line;
            let by = successors.by(&line.sha256, &file.series, file.revision);
            if let (Some(by), State::InForce | State::Expiring | State::Expired) = (by, line.state) {
                line.state = if by.series == file.series { State::Superseded } else { State::Moved };
                line.why = format!("by {} ({})", by.id, by.file);
            }
            alarms.extend(forked(line, successors.of_file(&line.sha256)));
        }
        let missing = missing(&files);
        let passports: Vec<Line> = files.into_iter().map(|file| file.line).collect();
        alarms.extend(duplicate_ids(&passports));
        alarms.extend(missing);
        alarms.extend(passports.iter().filter_map(misplaced));
        Self { passports, alarms, successors }
    }

    /// Adds to the answer about a passport whether a successor counts in its place; `bytes` is its whole file, which need
    /// not be one of the register's.
    pub fn asked(&self, verification: Verification, bytes: &[u8]) -> Verification {
        let by = verification.content().map(|content| {
            let (series, revision) = series_of(&content.passport.id);
            self.successors.by(&sha256_hex(bytes), &series, revision)
        });
        let (code, detail) = match by {
            None => (Code::NotRun, "not run: an earlier check failed".to_owned()),
            Some(Some(by)) => (Code::Superseded, format!("superseded by {} ({}): use that one", by.id, by.file)),
            Some(None) => (Code::Ok, format!("not superseded by any of {} files", self.passports.len())),
        };
        verification.with(Check::new(CheckName::Register, code, detail))
    }

    /// Whether a person must look at it: an alarm, or a passport that does not verify.
    pub fn needs_attention(&self) -> bool {
        !self.alarms.is_empty() || self.passports.iter().any(|line| line.state == State::Broken)
    }

    /// Whether something could not be read at all: then more may be wrong than the register says.
    pub fn is_incomplete(&self) -> bool {
        self.alarms.iter().any(|alarm| alarm.kind == AlarmKind::Unreadable)
    }

    /// How many are in each state.
    pub fn counts(&self) -> BTreeMap<State, usize> {
        let mut counts = BTreeMap::new();
        for line in &self.passports {
            *counts.entry(line.state).or_insert(0) += 1;
        }
        counts
    }
}
