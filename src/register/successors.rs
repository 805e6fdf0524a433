//! Relations between passports and their successors.

use super::alarm::forked;
use super::{Alarm, Examined, Line, State, series_of};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Passport that supersedes others.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Successor {
    pub(super) id: String,
    pub(super) file: String,
    sha256: String,
    pub(super) series: String,
    pub(super) withdrawn: bool,
    /// Whether the passport was issued by the time of verification; before that, it supersedes nothing.
    issued: bool,
}

/// Superseded passports and their successors.
///
/// A successor references its predecessor by the SHA-256 of its file and by its id. By the id it also supersedes every
/// other file with that id and every earlier revision for that site. These do not come back into force if a file in
/// between is removed. A later revision supersedes the earlier ones for its site, also if it was re-issued from a passport
/// for another site.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Successors {
    of_file: BTreeMap<String, Superseded>,
    of_series: HashMap<String, (u32, Successor)>,
    /// SHA-256 of the superseded passport, by the SHA-256 of each successor.
    predecessors: HashMap<String, String>,
}

/// Passport that others supersede; its own file may be missing.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Superseded {
    id: String,
    by: Vec<Successor>,
}

impl Superseded {
    fn is_forked(&self) -> bool {
        self.by.iter().filter(|successor| !successor.withdrawn).count() > 1
    }
}

impl Successors {
    pub(super) fn of(files: &[Examined]) -> Self {
        let mut successors = Self::default();
        let counted = files.iter().filter(|file| file.counts && (file.revision > 1 || file.predecessor.is_some()));
        for file in counted {
            let Some(id) = &file.line.id else { continue };
            let Line { file: name, sha256, state, .. } = file.line.clone();
            let (series, withdrawn) = (file.series.clone(), state == State::Revoked);
            let successor = Successor { id: id.clone(), file: name, sha256, series, withdrawn, issued: file.issued };
            successors.supersede(&file.series, file.revision.saturating_sub(1), &successor);
            let Some(from) = file.superseding() else { continue };
            successors.predecessors.insert(successor.sha256.clone(), from.sha256.clone());
            let (old_series, old_revision) = series_of(&from.id);
            successors.supersede(old_series, old_revision, &successor);
            let new = || Superseded { id: from.id.clone(), by: Vec::new() };
            let known = &mut successors.of_file.entry(from.sha256.clone()).or_insert_with(new).by;
            // A copy of the same file is not a second successor.
            if known.iter().all(|other| other.sha256 != successor.sha256) {
                known.push(successor);
            }
        }
        successors
    }

    /// Notes that `by` supersedes a series up to a revision.
    fn supersede(&mut self, series: &str, revision: u32, by: &Successor) {
        let last = self.of_series.get(series).map_or(0, |(revision, _)| *revision);
        if by.issued && revision > last {
            self.of_series.insert(series.to_owned(), (revision, by.clone()));
        }
    }

    /// Returns an alarm for each passport with several successors that are not withdrawn. The file of the passport
    /// itself may be missing.
    pub(super) fn forks(&self) -> Vec<Alarm> {
        let forks = self.of_file.values().filter(|superseded| superseded.is_forked());
        let mut alarms: Vec<Alarm> = forks.map(|superseded| forked(&superseded.id, &superseded.by)).collect();
        alarms.sort_by(|a, b| a.words.cmp(&b.words));
        alarms
    }

    /// Returns `true` if an ancestor of the passport with this SHA-256 has several successors.
    pub(super) fn is_of_a_fork(&self, sha256: &str) -> bool {
        let mut seen = BTreeSet::new();
        let mut ancestor = self.predecessors.get(sha256);
        while let Some(sha256) = ancestor.filter(|sha256| seen.insert(sha256.as_str())) {
            if self.of_file.get(sha256).is_some_and(Superseded::is_forked) {
                return true;
            }
            ancestor = self.predecessors.get(sha256);
        }
        false
    }

    /// Returns `true` if the file with this SHA-256 is superseded.
    pub(super) fn has(&self, sha256: &str) -> bool {
        self.of_file.get(sha256).is_some_and(|superseded| superseded.by.iter().any(|successor| successor.issued))
    }

    /// Returns the successor of a file, found by its SHA-256 or by its revision in a series; `None` if it has none.
    pub(super) fn by(&self, sha256: &str, series: &str, revision: u32) -> Option<&Successor> {
        let of_file = self.of_file.get(sha256).into_iter().flat_map(|superseded| &superseded.by);
        // Of several successors, prefer one that is not withdrawn.
        let of_file = of_file.filter(|successor| successor.issued).min_by_key(|successor| successor.withdrawn);
        let of_series = || {
            let (last, successor) = self.of_series.get(series)?;
            (revision <= *last && successor.sha256 != sha256).then_some(successor)
        };
        of_file.or_else(of_series)
    }

    /// Returns the last of the successors that follow a file, as [`Self::by`] finds them; `None` if it has none.
    pub(super) fn last(&self, sha256: &str, series: &str, revision: u32) -> Option<&Successor> {
        let mut seen = BTreeSet::new();
        let mut last = self.by(sha256, series, revision)?;
        while seen.insert(last.sha256.as_str())
            && let Some(next) = self.by(&last.sha256, &last.series, series_of(&last.id).1)
        {
            last = next;
        }
        Some(last)
    }
}
