//! Passports of a folder that supersede others, independent of any register.

use crate::files;
use crate::files::leftovers::is_lasting;
use crate::files::walk::Walk;
use crate::passport::Trust;
use crate::register::{Asked, examine};
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Line that every superseding passport contains; the canonical form puts it on a separate line.
const SUPERSEDES: &[u8] = b"\n  supersedes: true\n";

/// Successors by the SHA-256 of the file that they supersede.
type BySha256 = HashMap<String, Vec<PathBuf>>;

/// Successors in folders of stands; each folder is read once.
#[derive(Debug, Default)]
pub(crate) struct Superseding(Mutex<HashMap<PathBuf, Arc<BySha256>>>);

impl Superseding {
    /// Returns a passport in `folder`, other than `own`, that supersedes the file with this SHA-256, is authentic by
    /// `trust` and has not been withdrawn, or `None` if there is none.
    pub(crate) fn of(&self, folder: &Path, sha256: &str, own: &Path, trust: &Trust, asked: &Asked) -> Option<PathBuf> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let read = || Arc::new(read(folder, trust, asked));
        let successors = Arc::clone(known.entry(folder.to_owned()).or_insert_with(read));
        drop(known);
        successors.get(sha256)?.iter().find(|path| *path != own).cloned()
    }
}

/// Returns `true` if a file in the folder of a stand supersedes another one, or states the stand and its certificate
/// otherwise than the text `of_stand`.
///
/// This quick test avoids a full search in the usual case that all passports are from one certificate.
pub(super) fn may_contradict(folder: &Path, of_stand: &str) -> bool {
    let has = |bytes: &[u8], text: &[u8]| memchr::memmem::find(bytes, text).is_some();
    let mut bytes = Vec::new();
    Walk::flat(folder, is_lasting).files().any(|path| {
        let read = files::read_into(&mut bytes, &path, LARGEST_DOCUMENT_BYTES);
        read.is_ok() && (has(&bytes, SUPERSEDES) || !has(&bytes, of_stand.as_bytes()))
    })
}

/// Reads the successors in a folder; files that cannot be read are ignored.
fn read(folder: &Path, trust: &Trust, asked: &Asked) -> BySha256 {
    let (mut successors, mut bytes) = (BySha256::new(), Vec::new());
    for path in Walk::flat(folder, is_lasting).files() {
        let read = files::read_into(&mut bytes, &path, LARGEST_DOCUMENT_BYTES);
        if read.is_err() || memchr::memmem::find(&bytes, SUPERSEDES).is_none() {
            continue;
        }
        let examined = examine(&name_of(&path), &bytes, trust, asked);
        if let Some(superseded) = examined.supersedes().filter(|_| !examined.is_withdrawn()) {
            successors.entry(superseded.to_owned()).or_default().push(path);
        }
    }
    successors
}
