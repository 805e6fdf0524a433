//! Alarms of a register: findings that require attention.

use super::successors::Successor;
use super::{Examined, Line, series_of};
use crate::revocation::{ListRefused, RevocationList, SeriesAlarm};
use crate::text::{Printable, first_few, words};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{self, Display};

/// Finding in a folder of passports that requires attention.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Alarm {
    /// Kind of the alarm.
    pub kind: AlarmKind,
    /// Explanation in words.
    pub words: String,
    /// Affected files.
    pub files: Vec<String>,
    /// Passports that an unreadable or missing file may supersede or withdraw; `None` if nothing is in doubt.
    #[serde(skip)]
    pub concern: Option<Concern>,
}

/// Passports whose state is unknown.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Concern {
    /// All passports.
    Everything,
    /// Passports of one stand, `<model>/<serial>`.
    Stand(String),
}

words! {
    /// Kind of an [`Alarm`].
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "snake_case")]
    #[non_exhaustive]
    pub enum AlarmKind: pub(crate) key {
        /// Two or more successors of one passport.
        Forked = "forked",
        /// Two or more files with one id.
        DuplicateId = "duplicate_id",
        /// Missing predecessor of a passport, or missing revision between two others.
        Missing = "missing",
        /// Stand in force under two certificates, or under one that was replaced.
        Certificates = "certificates",
        /// File of a passport or of a list that is altered, truncated, empty or in another encoding.
        Damaged = "damaged",
        /// File in another place than its content requires.
        Misplaced = "misplaced",
        /// Link, which may lead out of the folder.
        Link = "link",
        /// Pipe, device or socket.
        Special = "special",
        /// File larger than any document.
        TooLarge = "too_large",
        /// File or folder that cannot be read.
        Unreadable = "unreadable",
        /// Refused or irregular lists of withdrawn passports.
        Revocation = "revocation",
    }
}

impl Alarm {
    /// Creates the alarm of a list that is not accepted. A damaged list might withdraw any passport.
    pub(crate) fn refused_list(error: &ListRefused, file: &str) -> Self {
        let alarm = Self::of_file(AlarmKind::Revocation, &error.to_string(), file);
        if error.is_damage() { alarm.concerning(Concern::Everything) } else { alarm }
    }

    /// Creates the alarm of an accepted list in a file with the wrong name.
    pub(crate) fn misnamed_list(list: &RevocationList, file: &str) -> Self {
        let words = format!("list {} must be named {}", list.sequence, list.file_name());
        Self::of_file(AlarmKind::Misplaced, &words, file)
    }

    /// Creates the alarm of an irregular series of lists. A missing list might withdraw any passport.
    pub(crate) fn series(alarm: SeriesAlarm) -> Self {
        let raised = Self::of_files(AlarmKind::Revocation, alarm.to_string(), Vec::new());
        if alarm.is_unknown() { raised.concerning(Concern::Everything) } else { raised }
    }

    /// Returns `true` if the missing or unreadable file may supersede or withdraw passports of a stand,
    /// `<model>/<serial>`.
    pub(crate) fn concerns(&self, stand: &str) -> bool {
        match &self.concern {
            None => false,
            Some(Concern::Everything) => true,
            // Compare without case, because some file systems do not preserve the case of names.
            Some(Concern::Stand(concerned)) => concerned.eq_ignore_ascii_case(stand),
        }
    }

    /// Returns the explanation, with the names of the files before it unless it begins with the first one.
    pub(crate) fn reason(&self) -> String {
        match self.files.first() {
            Some(first) if !self.words.starts_with(first.as_str()) => {
                format!("{}: {}", first_few(&self.files), self.words)
            }
            _ => self.words.clone(),
        }
    }

    /// Returns the alarm with the passports that the file may supersede or withdraw.
    pub(crate) fn concerning(self, concern: Concern) -> Self {
        Self { concern: Some(concern), ..self }
    }

    pub(crate) fn of_file(kind: AlarmKind, words: &str, file: &str) -> Self {
        Self::of_files(kind, words.to_owned(), vec![file.to_owned()])
    }

    pub(super) fn of_files(kind: AlarmKind, words: String, files: Vec<String>) -> Self {
        Self { kind, words, files, concern: None }
    }
}

impl Display for Alarm {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let files = match self.files.as_slice() {
            [] => String::new(),
            // The words of a file that was refused begin with its name.
            [one] if self.words.starts_with(one.as_str()) => String::new(),
            files => format!(": {}", first_few(files)),
        };
        Printable(format_args!("ALARM ({}): {}{files}", self.kind.key(), self.words)).fmt(f)
    }
}

/// Creates the alarm of several successors of the passport `id`.
pub(super) fn forked(id: &str, by: &[Successor]) -> Alarm {
    let ids: Vec<&str> = by.iter().map(|successor| successor.id.as_str()).collect();
    let words = format!("{id} has {} successors, each of which supersedes it: {}", by.len(), ids.join(", "));
    let files = by.iter().map(|successor| successor.file.clone()).collect();
    Alarm::of_files(AlarmKind::Forked, words, files)
}

/// Returns an alarm for each passport whose predecessor has no file. Other passports that the predecessor supersedes,
/// and other passports that supersede it, are unknown.
pub(super) fn absent_predecessors(files: &[Examined]) -> Vec<Alarm> {
    let made_from = |file: &&Examined| file.counts && file.predecessor.is_some();
    if !files.iter().any(|file| made_from(&file)) {
        return Vec::new();
    }
    let present: BTreeSet<&str> = files.iter().map(|file| file.line.sha256.as_str()).collect();
    let absent = files.iter().filter(made_from).filter_map(|file| {
        let from = file.predecessor.as_ref().filter(|from| !present.contains(from.sha256.as_str()))?;
        let id = file.line.id.as_deref().unwrap_or("?");
        let words = format!("{id} was re-issued from {}, which is missing (SHA-256 {})", from.id, from.sha256);
        let alarm = Alarm::of_file(AlarmKind::Missing, &words, &file.line.file);
        Some(alarm.concerning(Concern::Stand(file.line.stand.clone().unwrap_or_default())))
    });
    absent.collect()
}

/// Returns an alarm for each gap between two revisions, which may have been removed or not passed on. Gaps before a
/// passport whose predecessor is `absent` are omitted, because they are already reported.
pub(super) fn gaps(files: &[Examined], absent: &[Alarm]) -> Vec<Alarm> {
    let named: BTreeSet<&str> = absent.iter().flat_map(|alarm| &alarm.files).map(String::as_str).collect();
    let mut of_series: BTreeMap<&str, BTreeMap<u32, &str>> = BTreeMap::new();
    for file in files.iter().filter(|file| file.counts) {
        of_series.entry(&file.series).or_default().insert(file.revision, &file.line.file);
    }
    let mut alarms = Vec::new();
    for (series, revisions) in of_series {
        let revisions: Vec<(u32, &str)> = revisions.into_iter().collect();
        for pair in revisions.windows(2) {
            let [(from, before), (to, after)] = pair else { continue };
            if to - from > 1 && !named.contains(after) {
                let words = format!("a revision between {series}/{from} and {series}/{to} is missing");
                let files = vec![(*before).to_owned(), (*after).to_owned()];
                alarms.push(Alarm::of_files(AlarmKind::Missing, words, files));
            }
        }
    }
    alarms
}

/// Returns an alarm for each id with several copies of a file, or several files not withdrawn; `files` are sorted by
/// id.
pub(super) fn duplicate_ids(files: &[Examined]) -> Vec<Alarm> {
    let files: Vec<&Examined> = files.iter().filter(|file| file.counts).collect();
    let several = files.chunk_by(|a, b| a.line.id == b.line.id).filter(|files| files.len() > 1);
    several
        .filter_map(|files| {
            let originals: BTreeSet<&str> =
                files.iter().filter(|file| !file.is_withdrawn()).map(|file| file.line.sha256.as_str()).collect();
            let alike = files.windows(2).all(|pair| pair[0].line.sha256 == pair[1].line.sha256);
            let what = match (alike, originals.len()) {
                (true, _) => "copies of the same file",
                (false, 0 | 1) => return None,
                (false, _) => "different files; none is in force until all but one have been withdrawn",
            };
            let id = files[0].line.id.as_deref().unwrap_or("?");
            let words = format!("{} files have the id {id}: {what}", files.len());
            let names = files.iter().map(|file| file.line.file.clone()).collect();
            Some(Alarm::of_files(AlarmKind::DuplicateId, words, names))
        })
        .collect()
}

/// Returns an alarm if the file of a passport is not where its id requires, otherwise `None`.
pub(super) fn misplaced(line: &Line) -> Option<Alarm> {
    let id = line.id.as_deref()?;
    let (folder, revision) = series_of(id);
    let file = line.file.replace('\\', "/");
    let before = file.strip_suffix(&format!("-{revision}.yaml"));
    let above = before.and_then(|name| name.strip_suffix(folder));
    let there = above.is_some_and(|above| above.is_empty() || above.ends_with('/'));
    let words = || format!("the file of {id} must be {folder}-{revision}.yaml");
    (!there).then(|| Alarm::of_file(AlarmKind::Misplaced, &words(), &line.file))
}
