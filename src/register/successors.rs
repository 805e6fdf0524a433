//! Which passport supersedes which.

use super::alarm::forked;
use super::{Alarm, Examined, Line, State, series_of};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// A passport that supersedes others.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Successor {
    pub(super) id: String,
    pub(super) file: String,
    sha256: String,
    pub(super) series: String,
    withdrawn: bool,
    /// Whether it was issued by the time asked about: nothing supersedes before that.
    issued: bool,
}

/// What is superseded, and by what.
///
/// A successor names one passport by the SHA-256 of its file. By its id it names it too, and with it every other file of
/// that id and every earlier revision for that site: they do not come back when a file between them is taken away.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Successors {
    of_file: BTreeMap<String, Superseded>,
    of_series: HashMap<String, (u32, Successor)>,
    /// The SHA-256 that each successor supersedes, by its own.
    predecessors: HashMap<String, String>,
}

/// A passport that others supersede; it need not be there.
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
        for file in files {
            let (Some(from), Some(id)) = (file.superseding(), &file.line.id) else { continue };
            let Line { file: name, sha256, state, .. } = file.line.clone();
            successors.predecessors.insert(sha256.clone(), from.sha256.clone());
            let (series, withdrawn) = (file.series.clone(), state == State::Revoked);
            let successor = Successor { id: id.clone(), file: name, sha256, series, withdrawn, issued: file.issued };
            let (old_series, old_revision) = series_of(&from.id);
            let last = successors.of_series.get(old_series).map_or(0, |(revision, _)| *revision);
            if file.issued && old_revision > last {
                successors.of_series.insert(old_series.to_owned(), (old_revision, successor.clone()));
            }
            let new = || Superseded { id: from.id.clone(), by: Vec::new() };
            let known = &mut successors.of_file.entry(from.sha256.clone()).or_insert_with(new).by;
            // A copy of the same file is one successor, not two.
            if known.iter().all(|other| other.sha256 != successor.sha256) {
                known.push(successor);
            }
        }
        successors
    }

    /// An alarm for each passport with several successors, until all but one have been withdrawn. The passport itself need
    /// not be there.
    pub(super) fn forks(&self) -> Vec<Alarm> {
        let forks = self.of_file.values().filter(|superseded| superseded.is_forked());
        let mut alarms: Vec<Alarm> = forks.map(|superseded| forked(&superseded.id, &superseded.by)).collect();
        alarms.sort_by(|a, b| a.words.cmp(&b.words));
        alarms
    }

    /// Whether several supersede an ancestor of the passport of this SHA-256.
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

    /// Whether a file, known by its SHA-256, is superseded.
    pub(super) fn has(&self, sha256: &str) -> bool {
        self.of_file.get(sha256).is_some_and(|superseded| superseded.by.iter().any(|successor| successor.issued))
    }

    /// What supersedes a file, known by its SHA-256, or a revision of a series.
    pub(super) fn by(&self, sha256: &str, series: &str, revision: u32) -> Option<&Successor> {
        let of_file = self.of_file.get(sha256).into_iter().flat_map(|superseded| &superseded.by);
        // Of a fork the branch that was not withdrawn.
        let of_file = of_file.filter(|successor| successor.issued).min_by_key(|successor| successor.withdrawn);
        let of_series = || {
            let (last, successor) = self.of_series.get(series)?;
            (revision <= *last && successor.sha256 != sha256).then_some(successor)
        };
        of_file.or_else(of_series)
    }
}
