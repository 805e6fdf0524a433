//! What is in force in a folder of passports: every one verified, the chains followed.
//!
//! It is a function of verified passports, trust and a time; [`crate::folder`] finds the files.

use crate::document::sha256_hex;
use crate::passport::checks::{Check, CheckName, Code};
use crate::passport::content::Content;
use crate::passport::verification::{Question, Trust, Verification, verify};
use jiff::Timestamp;
use jiff::civil::Date;
use serde::Serialize;
use std::collections::BTreeMap;

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

/// What needs a person to look at it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Alarm {
    /// "forked", "duplicate_id", "misplaced", "link", "too_large" or "revocation".
    pub kind: &'static str,
    /// In words.
    pub words: String,
    /// The files.
    pub files: Vec<String>,
}

impl Alarm {
    /// A link, which may lead out of the folder.
    pub fn link(file: &str) -> Self {
        Self { kind: "link", words: "a link is not followed".to_owned(), files: vec![file.to_owned()] }
    }

    /// A file larger than any passport.
    pub fn too_large(file: &str) -> Self {
        Self { kind: "too_large", words: "larger than any passport".to_owned(), files: vec![file.to_owned()] }
    }

    /// Something about the lists of withdrawn passports; `file` is empty when it is about several.
    pub fn revocation(words: String, file: &str) -> Self {
        let files = if file.is_empty() { Vec::new() } else { vec![file.to_owned()] };
        Self { kind: "revocation", words, files }
    }
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
}

/// What a register keeps of one file: a few hundred bytes, whatever the passport's size.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Examined {
    line: Line,
    revision: u32,
    predecessor: Option<Predecessor>,
    /// Whether its word counts: text, signature, numbers and signer hold, and its key is not revoked.
    counts: bool,
}

/// The passport that one was made from.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Predecessor {
    sha256: String,
    superseded: bool,
}

/// Verifies one file; `within_days` sets from when on it counts as expiring.
pub fn examine(file: &str, bytes: &[u8], trust: &Trust, question: &Question, within_days: Option<u32>) -> Examined {
    let verification = verify(file, bytes, trust, &Question::at(question.time));
    examined(file, bytes, &verification, question.time, within_days)
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
        Some(Predecessor { sha256: from.sha256.clone(), superseded: content.passport.supersedes == Some(true) })
    });
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
    Examined { line, revision: content.map_or(0, |content| content.passport.revision), predecessor, counts }
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
    /// A passport is superseded by one that names its file's SHA-256 and says so, when that one's word counts; also by
    /// one that has itself been withdrawn or has expired since: the older numbers do not come back.
    ///
    /// `alarms` are those that were raised while the files were found.
    pub fn of(mut files: Vec<Examined>, mut alarms: Vec<Alarm>) -> Self {
        files.sort_by(|a, b| (&a.line.id, a.revision, &a.line.file).cmp(&(&b.line.id, b.revision, &b.line.file)));
        let successors = successors(&files);
        let mut passports: Vec<Line> = Vec::with_capacity(files.len());
        for file in &files {
            let mut line = file.line.clone();
            let followed_by = successors.get(line.sha256.as_str()).map_or(&[][..], Vec::as_slice);
            if let (Some(by), State::InForce | State::Expiring | State::Expired) = (followed_by.first(), line.state) {
                let same_site = by.line.site == line.site;
                line.state = if same_site { State::Superseded } else { State::Moved };
                line.why = format!("by {} ({})", by.line.id.as_deref().unwrap_or("?"), by.line.file);
            }
            if followed_by.len() > 1 {
                alarms.push(forked(&line, followed_by));
            }
            passports.push(line);
        }
        alarms.extend(duplicate_ids(&passports));
        alarms.extend(passports.iter().filter_map(misplaced));
        Self { passports, alarms }
    }

    /// The successor of the file with this SHA-256, when there is one that supersedes it.
    pub fn successor_of(&self, sha256: &str) -> Option<&Line> {
        self.passports
            .iter()
            .find(|line| line.sha256 == sha256 && matches!(line.state, State::Superseded | State::Moved))
    }

    /// Adds to the answer about a passport whether a successor counts in its place; `bytes` is its whole file.
    pub fn asked(&self, verification: Verification, bytes: &[u8]) -> Verification {
        let (code, detail) = match (verification.content(), self.successor_of(&sha256_hex(bytes))) {
            (None, _) => (Code::NotRun, "not run: an earlier check failed".to_owned()),
            (_, Some(line)) => (Code::Superseded, format!("superseded {}: use that one", line.why)),
            (_, None) => (Code::Ok, format!("not superseded by any of {} files", self.passports.len())),
        };
        verification.with(Check { name: CheckName::Register, code, detail })
    }

    /// Whether a person must look at it: an alarm, or a passport that does not verify.
    pub fn needs_attention(&self) -> bool {
        !self.alarms.is_empty() || self.passports.iter().any(|line| line.state == State::Broken)
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

/// For every SHA-256 the passports that say they supersede it, each once.
fn successors(files: &[Examined]) -> BTreeMap<&str, Vec<&Examined>> {
    let mut successors: BTreeMap<&str, Vec<&Examined>> = BTreeMap::new();
    for file in files {
        if let Some(superseded) = file.supersedes() {
            let known = successors.entry(superseded).or_default();
            // A copy of the same file is one successor, not two.
            if known.iter().all(|other| other.line.sha256 != file.line.sha256) {
                known.push(file);
            }
        }
    }
    successors
}

fn forked(line: &Line, by: &[&Examined]) -> Alarm {
    let ids: Vec<&str> = by.iter().filter_map(|file| file.line.id.as_deref()).collect();
    let id = line.id.as_deref().unwrap_or("?");
    let words = format!("{id} has {} successors that all supersede it: {}", by.len(), ids.join(", "));
    Alarm { kind: "forked", words, files: by.iter().map(|file| file.line.file.clone()).collect() }
}

fn duplicate_ids(passports: &[Line]) -> Vec<Alarm> {
    let mut by_id: BTreeMap<&str, Vec<&Line>> = BTreeMap::new();
    for line in passports {
        if let Some(id) = &line.id {
            by_id.entry(id).or_default().push(line);
        }
    }
    let several = by_id.into_iter().filter(|(_, lines)| lines.len() > 1);
    several
        .map(|(id, lines)| {
            let alike = lines.windows(2).all(|pair| pair[0].sha256 == pair[1].sha256);
            let what = if alike { "the same file, copied" } else { "different files" };
            let words = format!("{id} is there {} times: {what}", lines.len());
            Alarm { kind: "duplicate_id", words, files: lines.iter().map(|line| line.file.clone()).collect() }
        })
        .collect()
}

/// A passport whose file is not where its id says.
fn misplaced(line: &Line) -> Option<Alarm> {
    let id = line.id.as_deref()?;
    let (folder, revision) = id.rsplit_once('/')?;
    let due = format!("{folder}-{revision}.yaml");
    let file = line.file.replace('\\', "/");
    let there = file == due || file.ends_with(&format!("/{due}"));
    (!there).then(|| Alarm {
        kind: "misplaced",
        words: format!("{id} belongs into {due}"),
        files: vec![line.file.clone()],
    })
}
