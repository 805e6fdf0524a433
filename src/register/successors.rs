//! Which passport supersedes which.

use super::{Examined, Line, State};
use std::collections::BTreeMap;

/// A passport that supersedes others.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Successor {
    pub(super) id: String,
    pub(super) file: String,
    sha256: String,
    pub(super) series: String,
    pub(super) withdrawn: bool,
}

/// What is superseded, and by what.
///
/// A successor names one passport by the SHA-256 of its file. By its id it names it too, and with it every earlier
/// revision for that site: they do not come back when a file between them is taken away.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Successors {
    of_file: BTreeMap<String, Vec<Successor>>,
    of_series: BTreeMap<String, (u32, Successor)>,
}

impl Successors {
    pub(super) fn of(files: &[Examined]) -> Self {
        let mut successors = Self::default();
        for file in files.iter().filter(|file| file.counts) {
            let (Some(from), Some(id)) = (file.predecessor.as_ref().filter(|from| from.superseded), &file.line.id)
            else {
                continue;
            };
            let Line { file: name, sha256, state, .. } = file.line.clone();
            let (series, withdrawn) = (file.series.clone(), state == State::Revoked);
            let successor = Successor { id: id.clone(), file: name, sha256, series, withdrawn };
            let last = successors.of_series.get(&from.series).map_or(0, |(revision, _)| *revision);
            if from.revision > last {
                successors.of_series.insert(from.series.clone(), (from.revision, successor.clone()));
            }
            let known = successors.of_file.entry(from.sha256.clone()).or_default();
            // A copy of the same file is one successor, not two.
            if known.iter().all(|other| other.sha256 != successor.sha256) {
                known.push(successor);
            }
        }
        successors
    }

    /// All that supersede a file, known by its SHA-256.
    pub(super) fn of_file(&self, sha256: &str) -> &[Successor] {
        self.of_file.get(sha256).map_or(&[], Vec::as_slice)
    }

    /// What supersedes a file, known by its SHA-256, or a revision of a series.
    pub(super) fn by(&self, sha256: &str, series: &str, revision: u32) -> Option<&Successor> {
        // Of a fork the branch that was not withdrawn.
        let of_file = self.of_file(sha256).iter().min_by_key(|successor| successor.withdrawn);
        let of_series = || {
            let (last, successor) = self.of_series.get(series)?;
            (revision < *last).then_some(successor)
        };
        of_file.or_else(of_series)
    }
}
