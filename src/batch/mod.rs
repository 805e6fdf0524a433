//! Many passports at once: stands × sites, or a folder of passports issued anew.
//!
//! The work is done in chunks, each by all processors and reported in order before the next one begins. So what is held
//! does not grow with the number of passports, and what was reported is in the folder: under its name, and safe from a
//! loss of power as far as [`Durability`] says. A failure is one event; the rest goes on. Run
//! again, a batch leaves what is done and does what is not.
//!
//! * `paths`: what a user names: files, folders, patterns, lists.
//! * `catalogue`: stand and site files by their ids.
//! * `shard`: a part of a job, for one of several machines.
//! * `issue`: every stand at every site.
//! * `successors`: passports issued anew.

pub(crate) mod catalogue;
pub(crate) mod issue;
pub(crate) mod paths;
pub(crate) mod shard;
pub(crate) mod successors;

use shard::Shard;

use crate::files::{Durability, FileError, leftovers};
use crate::folder::{self, FolderRefused, Issued, Next, Seal, Visited};
use crate::parallel;
use crate::passport::issue::Remarks;
use crate::text::{Unreadable, name_of};
use std::convert::Infallible;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Orders that a thread has in a chunk.
const CHUNK_PER_THREAD: usize = 128;

/// Orders in a chunk at most, however many the threads: what a chunk holds is held in memory.
const LARGEST_CHUNK: usize = 4096;

/// What a folder is searched for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// Files `stand.yaml` or `stand.yml`, at any depth.
    Stands,
    /// Files `*.yaml` or `*.yml` in the folder itself.
    Sites,
}

/// How a batch is done.
#[derive(Clone, Copy)]
pub(crate) struct Batch<'a> {
    /// How safe from a loss of power what was told of is.
    pub durability: Durability,
    /// Who signs; `None` for a dry run, which computes and checks everything and writes nothing.
    pub seal: Option<Seal<'a>>,
    /// Which part of the job.
    pub shard: Shard,
    /// Threads; 0 and 1 are the same.
    pub threads: usize,
    /// Once true, the batch ends after the chunk that has begun.
    pub cancel: Option<&'a AtomicBool>,
}

/// What a batch tells while it goes on.
#[derive(Debug)]
pub(crate) enum Event {
    /// So many more orders are known of; roughly, when this is a part of the job.
    Planned(u64),
    /// An order is done with. Of the passports in a folder those of other stands are no orders, and have no outcome.
    Done(Option<Outcome>),
    /// So many orders will not come, for a reason that was told as a failure.
    Lost(u64),
    /// Something to know about an input.
    Remark {
        /// The file.
        file: String,
        /// The words, which may be the same for many.
        words: String,
    },
}

/// What became of an order, or of an input.
#[derive(Debug)]
pub(crate) enum Outcome {
    /// The passport is there, new or as before.
    There(Issued),
    /// It would be issued, were this no dry run.
    Planned(Planned),
    /// A passport of the folder is not to be issued anew.
    Skipped {
        /// Its id.
        id: String,
        /// Its file.
        file: PathBuf,
        /// Why.
        why: String,
    },
    /// An order, or an input with all that hangs on it, has failed.
    Failed(Failure),
}

/// A passport that would be issued.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Planned {
    /// Its id.
    pub id: String,
    /// Its file.
    pub path: PathBuf,
    /// What the factory should know about it.
    pub remarks: Remarks,
}

/// Why something is not there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Failure {
    /// The passport's id, or the file that it hangs on.
    pub what: String,
    /// Why, in words.
    pub why: String,
    /// Whether this is no verdict on a document, but a file that cannot be read as what it should be, or written.
    pub unusable: bool,
    /// How many passports it costs, where that is another number than one.
    pub passports: Option<u64>,
    /// The mistakes of a file that cannot be read, with its lines.
    pub unreadable: Option<Box<Unreadable>>,
}

impl Failure {
    /// A verdict on a document.
    pub(crate) fn refused(path: &Path, why: String) -> Self {
        Self { what: name_of(path), why, unusable: false, passports: None, unreadable: None }
    }

    /// A file that cannot be used.
    pub(crate) fn unusable(path: &Path, why: String) -> Self {
        Self { unusable: true, ..Self::refused(path, why) }
    }

    /// A file that cannot be read as what it should be.
    pub(crate) fn unreadable(path: &Path, error: Unreadable) -> Self {
        let why = error.to_string();
        Self { unreadable: Some(Box::new(error)), ..Self::unusable(path, why) }
    }

    /// A file that cannot be read.
    pub(crate) fn file(error: FileError) -> Self {
        Self::unusable(error.path(), error.to_string())
    }

    /// An order that the folder refused.
    pub(crate) fn of_order(what: String, refused: &FolderRefused) -> Self {
        Self { what, why: refused.to_string(), unusable: refused.is_unusable(), passports: None, unreadable: None }
    }
}

/// What listens to a batch.
pub(crate) type Listener<'a> = &'a mut dyn FnMut(Event);

impl Batch<'_> {
    fn cancelled(&self) -> bool {
        self.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed))
    }

    fn chunk(&self) -> usize {
        (CHUNK_PER_THREAD * self.threads.max(1)).min(LARGEST_CHUNK)
    }

    /// Signs and writes what is next, or says that it would; `again` asks anew what is next when another run is faster.
    fn settle(
        &self,
        id: impl Fn() -> String,
        next: impl Fn() -> Result<Next, FolderRefused>,
        issue: impl Fn(Seal) -> Result<Issued, FolderRefused>,
    ) -> Outcome {
        let there = match self.seal {
            Some(seal) => issue(seal).map(Outcome::There),
            None => next().map(|next| match next {
                Next::There(issued) => Outcome::There(issued),
                Next::New(new) => Outcome::Planned(Planned {
                    id: new.id().to_owned(),
                    path: new.path().to_owned(),
                    remarks: new.remarks(),
                }),
            }),
        };
        there.unwrap_or_else(|refused| Outcome::Failed(Failure::of_order(id(), &refused)))
    }

    /// Makes the names of what was written safe, and only then tells of it.
    fn tell(&self, mut outcomes: Vec<Option<Outcome>>, tell: Listener) {
        let written = outcomes.iter().flatten().filter_map(|outcome| match outcome {
            Outcome::There(issued) => Some(issued.path.as_path()),
            _ => None,
        });
        if let Err(error) = folder::sync_names(self.durability, written) {
            let why = error.to_string();
            for outcome in outcomes.iter_mut().flatten() {
                if let Outcome::There(issued) = outcome {
                    let what = issued.id.clone();
                    let why = why.clone();
                    *outcome =
                        Outcome::Failed(Failure { what, why, unusable: true, passports: None, unreadable: None });
                }
            }
        }
        outcomes.into_iter().for_each(|outcome| tell(Event::Done(outcome)));
    }
}

/// The folders of stands that were swept clean of what killed runs left behind, each once.
#[derive(Default)]
struct Sweeper {
    swept: Visited,
}

impl Sweeper {
    fn sweep(&self, folder: &Path) {
        let Ok(()) = self.swept.visit(folder, || {
            leftovers::remove(folder);
            Ok::<_, Infallible>(true)
        });
    }
}
