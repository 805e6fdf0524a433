//! Many passports at once: stands × sites, or the re-issue of a folder of passports.
//!
//! The work is done in chunks. All CPUs work on a chunk, and its results are reported in order before the next one
//! begins. Memory therefore does not grow with the number of passports. Every reported passport is in the folder under
//! its name, and safe from a power failure as far as [`Durability`] says. A failure is one event; the rest continues.
//! The same batch, run again, completes the job and leaves finished passports untouched.
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

use crate::files::walk::Visited;
use crate::files::{Durability, FileError, leftovers};
use crate::folder::{self, Authority, FolderRefused, Issued, Next, StandFolder};
use crate::parallel;
use crate::passport::issue::Remarks;
use crate::text::{Unreadable, name_of};
use std::convert::Infallible;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Number of orders per thread in a chunk.
const CHUNK_PER_THREAD: usize = 128;

/// Largest number of orders in a chunk, for any number of threads, because a chunk is kept in memory.
const LARGEST_CHUNK: usize = 4096;

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
    /// Flag that cancels the batch: once it is `true`, the batch ends after the current chunk.
    pub cancel: Option<&'a AtomicBool>,
}

/// Event that a batch reports while it runs.
#[derive(Debug)]
pub(crate) enum Event {
    /// Number of additional orders, which is approximate for a part of the job.
    Planned(u64),
    /// Order that is finished. Passports of other stands in a folder are not orders, and have no outcome.
    Done(Option<Outcome>),
    /// Number of orders that cannot be done, for a reason that was reported as a failure.
    Lost(u64),
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

pub(crate) type Listener<'a> = &'a mut dyn FnMut(Event);

impl Batch<'_> {
    fn cancelled(&self) -> bool {
        self.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed))
    }

    fn chunk(&self) -> usize {
        (CHUNK_PER_THREAD * self.threads.max(1)).min(LARGEST_CHUNK)
    }

    fn is_dry(&self) -> bool {
        self.authority.signer.is_none()
    }

    /// Syncs the names of all written passports to disk, before a register lists them.
    fn sync(&self, outcomes: Vec<&Outcome>) -> Result<(), Failure> {
        let written = outcomes.into_iter().filter_map(|outcome| match outcome {
            Outcome::There(issued) if issued.new => Some(issued.path.as_path()),
            _ => None,
        });
        folder::sync_names(self.durability, written).map_err(Failure::file)
    }

    /// Writes the register of a stand, once its passports are `synced`.
    fn list(&self, folder: &StandFolder, synced: &Result<(), Failure>) -> Result<(), Failure> {
        synced.clone()?;
        if self.is_dry() {
            return Ok(());
        }
        folder.list().map_err(|why| Failure::folder(folder.stand().to_owned(), &why))
    }
}

/// Reports inputs that cannot be used; each costs `passports` passports unless it states another number.
fn fail(failures: Vec<Failure>, passports: u64, tell: Listener) {
    for failure in failures {
        let passports = failure.passports.or(Some(passports));
        tell(Event::Done(Some(Outcome::Failed(Failure { passports, ..failure }))));
    }
}

/// Removes the leftovers of killed runs from a folder that is not among those already `swept`.
fn sweep(swept: &Visited, folder: &Path) {
    let Ok(()) = swept.visit(folder, || {
        leftovers::remove(folder);
        Ok::<_, Infallible>(true)
    });
}
