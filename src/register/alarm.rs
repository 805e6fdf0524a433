//! What in a folder of passports needs a person to look at it.

use super::successors::Successor;
use super::{Examined, Line};
use crate::revocation::{ListRefused, RevocationList, SeriesAlarm};
use crate::text::Printable;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::{self, Display};

/// What needs a person to look at it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Alarm {
    /// Which kind: its key.
    pub kind: AlarmKind,
    /// In words.
    pub words: String,
    /// The files.
    pub files: Vec<String>,
}

/// Kinds of alarm.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum AlarmKind {
    /// Two successors of one passport.
    Forked,
    /// Two files with one id.
    DuplicateId,
    /// A revision is missing from a chain whose ends are there.
    Missing,
    /// A file is not where its content belongs.
    Misplaced,
    /// A link, which may lead out of the folder.
    Link,
    /// A pipe, a device or a socket.
    Special,
    /// A file larger than any document.
    TooLarge,
    /// A file or a folder that cannot be read.
    Unreadable,
    /// Lists of withdrawn passports.
    Revocation,
}

impl AlarmKind {
    /// Its name for programs.
    pub fn key(self) -> &'static str {
        match self {
            Self::Forked => "forked",
            Self::DuplicateId => "duplicate_id",
            Self::Missing => "missing",
            Self::Misplaced => "misplaced",
            Self::Link => "link",
            Self::Special => "special",
            Self::TooLarge => "too_large",
            Self::Unreadable => "unreadable",
            Self::Revocation => "revocation",
        }
    }
}

impl Alarm {
    /// A link, which may lead out of the folder.
    pub fn link(file: &str) -> Self {
        Self::of_file(AlarmKind::Link, "a link is not followed", file)
    }

    /// A file that only looks like one.
    pub fn special(file: &str) -> Self {
        Self::of_file(AlarmKind::Special, "a pipe, a device or a socket is not read", file)
    }

    /// A file larger than any passport.
    pub fn too_large(file: &str) -> Self {
        Self::of_file(AlarmKind::TooLarge, "larger than any passport", file)
    }

    /// A file or a folder that cannot be read, and why.
    pub fn unreadable(why: &str, file: &str) -> Self {
        Self::of_file(AlarmKind::Unreadable, why, file)
    }

    /// A list of withdrawn passports that does not count.
    pub fn refused_list(error: &ListRefused, file: &str) -> Self {
        Self::of_file(AlarmKind::Revocation, &error.to_string(), file)
    }

    /// A good list of withdrawn passports in a file of another name than its own.
    pub fn misnamed_list(list: &RevocationList, file: &str) -> Self {
        let words = format!("list {} belongs into {}", list.sequence, list.file_name());
        Self::of_file(AlarmKind::Misplaced, &words, file)
    }

    /// Something about several lists.
    pub fn series(alarm: SeriesAlarm) -> Self {
        Self { kind: AlarmKind::Revocation, words: alarm.to_string(), files: Vec::new() }
    }

    fn of_file(kind: AlarmKind, words: &str, file: &str) -> Self {
        Self { kind, words: words.to_owned(), files: vec![file.to_owned()] }
    }
}

impl Display for Alarm {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let files = if self.files.is_empty() { String::new() } else { format!(": {}", self.files.join(", ")) };
        Printable(format_args!("ALARM ({}): {}{files}", self.kind.key(), self.words)).fmt(f)
    }
}

/// An alarm until all successors but one have been withdrawn.
pub(super) fn forked(line: &Line, by: &[Successor]) -> Option<Alarm> {
    if by.iter().filter(|successor| !successor.withdrawn).count() < 2 {
        return None;
    }
    let ids: Vec<&str> = by.iter().map(|successor| successor.id.as_str()).collect();
    let id = line.id.as_deref().unwrap_or("?");
    let words = format!("{id} has {} successors that all supersede it: {}", by.len(), ids.join(", "));
    let files = by.iter().map(|successor| successor.file.clone()).collect();
    Some(Alarm { kind: AlarmKind::Forked, words, files })
}

/// Revisions between two that are there: somebody took them away, or did not pass them on.
pub(super) fn missing(files: &[Examined]) -> Vec<Alarm> {
    let mut of_series: BTreeMap<&str, BTreeMap<u32, &str>> = BTreeMap::new();
    for file in files.iter().filter(|file| file.counts) {
        of_series.entry(&file.series).or_default().insert(file.revision, &file.line.file);
    }
    let mut alarms = Vec::new();
    for (series, revisions) in of_series {
        let revisions: Vec<(u32, &str)> = revisions.into_iter().collect();
        for pair in revisions.windows(2) {
            let [(from, before), (to, after)] = pair else { continue };
            if to - from > 1 {
                let words = format!("between {series}/{from} and {series}/{to} a revision is missing");
                let files = vec![(*before).to_owned(), (*after).to_owned()];
                alarms.push(Alarm { kind: AlarmKind::Missing, words, files });
            }
        }
    }
    alarms
}

/// Of lines sorted by id.
pub(super) fn duplicate_ids(passports: &[Line]) -> Vec<Alarm> {
    let several = passports.chunk_by(|a, b| a.id.is_some() && a.id == b.id).filter(|lines| lines.len() > 1);
    several
        .map(|lines| {
            let id = lines[0].id.as_deref().unwrap_or("?");
            let alike = lines.windows(2).all(|pair| pair[0].sha256 == pair[1].sha256);
            let what = if alike { "the same file, copied" } else { "different files" };
            let words = format!("{id} is there {} times: {what}", lines.len());
            Alarm { kind: AlarmKind::DuplicateId, words, files: lines.iter().map(|line| line.file.clone()).collect() }
        })
        .collect()
}

/// A passport whose file is not where its id says.
pub(super) fn misplaced(line: &Line) -> Option<Alarm> {
    let id = line.id.as_deref()?;
    let (folder, revision) = id.rsplit_once('/')?;
    let file = line.file.replace('\\', "/");
    let before = file.strip_suffix(".yaml").and_then(|name| name.strip_suffix(revision)?.strip_suffix('-'));
    let above = before.and_then(|name| name.strip_suffix(folder));
    let there = above.is_some_and(|above| above.is_empty() || above.ends_with('/'));
    (!there).then(|| Alarm {
        kind: AlarmKind::Misplaced,
        words: format!("{id} belongs into {folder}-{revision}.yaml"),
        files: vec![line.file.clone()],
    })
}
