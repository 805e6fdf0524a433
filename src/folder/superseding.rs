//! Which passports of a folder supersede others, whatever a register says of them.

use crate::files;
use crate::files::leftovers::is_lasting;
use crate::files::walk::{Entry, Walk};
use crate::passport::Trust;
use crate::register::{Asked, examine};
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The line without which a passport supersedes none. Its one form makes it stand on a line of its own.
const SUPERSEDES: &[u8] = b"\n  supersedes: true\n";

/// Successors by the SHA-256 of what they supersede.
type BySha256 = HashMap<String, Vec<PathBuf>>;

/// The successors in folders of stands, each folder read once.
#[derive(Debug, Default)]
pub(crate) struct Superseding(Mutex<HashMap<PathBuf, Arc<BySha256>>>);

impl Superseding {
    /// Returns a passport in `folder`, but for `own`, that supersedes the file of this SHA-256 and counts by `trust`.
    pub(crate) fn of(&self, folder: &Path, sha256: &str, own: &Path, trust: &Trust, asked: &Asked) -> Option<PathBuf> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let read = || Arc::new(read(folder, trust, asked));
        let successors = Arc::clone(known.entry(folder.to_owned()).or_insert_with(read));
        drop(known);
        successors.get(sha256)?.iter().find(|path| *path != own).cloned()
    }
}

/// Whether a file of a stand's folder supersedes another one, or is not of the certificate `number`. It is a quick look:
/// most often all are of the one certificate.
pub(super) fn has_other_certificate(folder: &Path, number: &str) -> bool {
    let own = format!("\n  number: \"{number}\"\n");
    let has = |bytes: &[u8], text: &[u8]| memchr::memmem::find(bytes, text).is_some();
    let mut bytes = Vec::new();
    files_of(folder).any(|path| {
        let read = files::read_into(&mut bytes, &path, LARGEST_DOCUMENT_BYTES);
        read.is_ok() && (has(&bytes, SUPERSEDES) || !has(&bytes, own.as_bytes()))
    })
}

fn files_of(folder: &Path) -> impl Iterator<Item = PathBuf> {
    Walk::flat(folder, is_lasting).flatten().filter_map(|entry| match entry {
        Entry::File(path) => Some(path),
        _ => None,
    })
}

/// What cannot be read supersedes nothing that it could be asked about.
fn read(folder: &Path, trust: &Trust, asked: &Asked) -> BySha256 {
    let (mut successors, mut bytes) = (BySha256::new(), Vec::new());
    for path in files_of(folder) {
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
