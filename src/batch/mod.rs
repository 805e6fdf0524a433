//! Many passports at once: stands × sites, or the re-issue of a folder of passports.
//!
//! The work is done stand by stand, some stands at a time. All CPUs work on these, and their results are reported in order
//! before the next ones begin. Memory therefore grows with the number of files, not of passports. Every reported passport is
//! in the folder under its name, and safe from a power failure as far as [`Durability`] says. A failure is one event; the
//! rest continues. The same batch, run again, completes the job and leaves finished passports untouched.
//!
//! * `paths`: arguments of the user: files, folders, patterns, lists.
//! * `catalogue`: stand and site files by their ids.
//! * `certificates`: one header for many stands.
//! * `deliveries`: which stand goes where.
//! * `shard`: a part of a job, for one of several machines.
//! * `once`: readings that are given twice under two names.
//! * `issue`: every stand at every site.
//! * `successors`: re-issue of passports.
//! * `recertification`: a new certificate of one stand, and the successors of its passports.

pub(crate) mod catalogue;
pub(crate) mod certificates;
pub(crate) mod deliveries;
pub(crate) mod issue;
pub(crate) mod once;
pub(crate) mod paths;
pub(crate) mod recertification;
pub(crate) mod shard;
pub(crate) mod successors;

use shard::Shard;

use crate::files::{Durability, FileError};
use crate::folder::{Authority, FolderRefused, Issued, Next, StandFolder};
use crate::parallel;
use crate::passport::issue::Remarks;
use crate::text::{Unreadable, name_of};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Kind of files that a folder is searched for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// Files `stand.yaml` or `stand.yml`, at any depth.
    Stands,
    /// Files `*.yaml` or `*.yml` in the folder itself.
    Sites,
    /// Files that claim to be passports, at any depth, whatever their names.
    Passports,
    /// Files `*.csv` in the folder itself.
    Tables,
}

#[derive(Clone, Copy)]
pub(crate) struct Batch<'a> {
    /// Durability of reported passports after a power failure.
    pub durability: Durability,
    /// Issuer; without a signer the batch is a dry run, which computes and checks everything and writes nothing.
    pub authority: Authority<'a>,
    /// Part of the job to do.
    pub shard: Shard,
    /// Number of threads; 0 and 1 have the same effect.
    pub threads: usize,
    /// Flag that cancels the batch: once it is `true`, no further passport is begun.
    pub cancel: Option<&'a AtomicBool>,
}

/// Event that a batch reports while it runs.
#[derive(Debug)]
pub(crate) enum Event {
    /// Number of additional orders.
    Planned(u64),
    /// Order that is finished, or input that cannot be used.
    Done(Outcome),
    Remark {
        file: String,
        /// Text of the remark, which may be the same for many files.
        words: String,
        is_warning: bool,
    },
}

/// Outcome of an order or of an input.
#[derive(Debug)]
pub(crate) enum Outcome {
    /// Passport that exists now, new or unchanged.
    There(Issued),
    /// Passport that would be issued without the dry run.
    Planned { id: String, path: PathBuf, remarks: Remarks },
    /// Passport of the folder that is not re-issued.
    Skipped { id: String, file: PathBuf, why: String },
    /// Failure of an order, or of an input and all passports that depend on it.
    Failed(Failure),
}

impl From<Next> for Outcome {
    fn from(next: Next) -> Self {
        let id = next.id().to_owned();
        match next {
            Next::There { issued, .. } => Self::There(issued),
            Next::New { path, draft, .. } => Self::Planned { id, path, remarks: draft.remarks() },
        }
    }
}

impl Outcome {
    /// Turns the outcome of a passport into the failure of its register: it exists, but does not count.
    fn not_listed(&mut self, failure: &Failure) {
        if let Self::There(issued) = self {
            let why = format!("{}: not listed in the register, so it does not count: {}", issued.id, failure.why);
            *self = Self::Failed(Failure { what: issued.id.clone(), why, ..failure.clone() });
        }
    }

    /// Returns the id of a passport that is new, or would be without the dry run, and the remarks on it. The remarks on an
    /// existing one were printed when it was issued.
    pub(crate) fn remarks(&self) -> Option<(&str, &Remarks)> {
        match self {
            Self::There(Issued { id, remarks, new: true, .. }) | Self::Planned { id, remarks, .. } => {
                Some((id, remarks))
            }
            _ => None,
        }
    }
}

/// Failure of an order or of an input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Failure {
    /// Id of the passport, or the file that it depends on.
    pub what: String,
    pub why: String,
    /// `true` if a file cannot be read or written, `false` if a readable document was refused.
    pub unusable: bool,
    /// Number of passports that it costs, if not one.
    pub passports: Option<u64>,
    /// Errors in a file that cannot be read, with their lines.
    pub unreadable: Option<Box<Unreadable>>,
}

impl Failure {
    pub(crate) fn refused(path: &Path, why: String) -> Self {
        Self::of(name_of(path), why, false)
    }

    pub(crate) fn unusable(path: &Path, why: String) -> Self {
        Self { unusable: true, ..Self::refused(path, why) }
    }

    pub(crate) fn unreadable(path: &Path, error: Unreadable) -> Self {
        let why = error.to_string();
        Self { unreadable: Some(Box::new(error)), ..Self::unusable(path, why) }
    }

    pub(crate) fn file(error: FileError) -> Self {
        Self::unusable(error.path(), error.with_nearest())
    }

    fn folder(what: String, why: &FolderRefused) -> Self {
        Self::of(what, why.to_string(), why.is_unusable())
    }

    fn of(what: String, why: String, unusable: bool) -> Self {
        Self { what, why, unusable, passports: None, unreadable: None }
    }
}

/// Outcome of an order, and the remarks for the case that a passport exists then.
struct Settled {
    outcome: Outcome,
    remarks: Vec<Event>,
}

impl From<Outcome> for Settled {
    fn from(outcome: Outcome) -> Self {
        Self { outcome, remarks: Vec::new() }
    }
}

pub(crate) type Listener<'a> = &'a mut dyn FnMut(Event);

impl Batch<'_> {
    fn cancelled(&self) -> bool {
        self.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed))
    }

    fn is_dry(&self) -> bool {
        self.authority.signer.is_none()
    }

    /// Issues the passport that `next` determines, or in a dry run only determines it; every passport of a batch is made here.
    /// `id` names it in a failure.
    fn settled(
        &self,
        folder: &StandFolder,
        id: impl FnOnce() -> String,
        next: impl Fn() -> Result<Next, FolderRefused>,
    ) -> Outcome {
        let settled = match self.is_dry() {
            false => folder.settle(next).map(Outcome::There),
            true => next().map(Outcome::from),
        };
        settled.unwrap_or_else(|why| Outcome::Failed(Failure::folder(id(), &why)))
    }

    /// Does the work of stands, `at_once` of them side by side, or of few ones passport by passport with the number of threads
    /// that `work` gets; tells the events in the order of the stands.
    fn each_stand<T: Sync>(
        &self,
        stands: &[T],
        at_once: usize,
        work: impl Fn(&T, usize) -> Vec<Event> + Sync,
        tell: Listener,
    ) {
        let threads = self.threads.max(1);
        for some in stands.chunks(at_once).take_while(|_| !self.cancelled()) {
            let each = threads.div_ceil(some.len());
            let events = parallel::map(some, threads, |stand| work(stand, each));
            events.into_iter().flatten().for_each(&mut *tell);
        }
    }

    /// Writes the register of a stand; returns the outcomes, each after its remarks.
    fn finish(&self, folder: &StandFolder, settled: Vec<Settled>) -> Vec<Event> {
        let listed = if self.is_dry() { Ok(()) } else { folder.list() };
        let listed = listed.map_err(|why| Failure::folder(folder.stand.clone(), &why));
        let events = settled.into_iter().flat_map(|Settled { mut outcome, mut remarks }| {
            if let Err(failure) = &listed {
                outcome.not_listed(failure);
            }
            if !matches!(outcome, Outcome::There(_) | Outcome::Planned { .. }) {
                remarks.clear();
            }
            remarks.into_iter().chain([Event::Done(outcome)])
        });
        events.collect()
    }
}

/// Reports inputs that cannot be used; each costs `passports` passports unless it states another number.
fn fail(failures: Vec<Failure>, passports: u64, tell: Listener) {
    for failure in failures {
        let passports = failure.passports.or(Some(passports));
        tell(Event::Done(Outcome::Failed(Failure { passports, ..failure })));
    }
}
