//! Stand and site files by their ids; all are read and checked before anything is signed, but only a limited number is
//! kept in memory.

use super::{Event, Failure, Listener, parallel};
use crate::files;
use crate::passport::issue::PreparedStand;
use crate::site::Site;
use crate::stand::Stand;
use crate::text::{LARGEST_DOCUMENT_BYTES, Unreadable, first_few, name_of, shown};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Number of files that are kept in memory once read; further files are read again when needed.
const KEPT: usize = 1024;

/// Number of files that are read at a time.
const READ_AT_ONCE: usize = 256;

/// Kind of document in a catalogue.
pub(crate) trait Listed: Clone + Send + Sync {
    /// Name of the kind in messages.
    const NAME: &str;

    /// Reads a file; `name` is its name in messages.
    fn parse(name: &str, bytes: &[u8]) -> Result<Self, Unreadable>;

    fn id(&self) -> String;

    /// Returns a remark on the name of the file, or `None` if it is as expected.
    fn remark(&self, path: &Path) -> Option<String>;
}

impl Listed for PreparedStand {
    const NAME: &str = "stand";

    fn parse(name: &str, bytes: &[u8]) -> Result<Self, Unreadable> {
        Stand::from_yaml(name, bytes).map(Self::new)
    }

    fn id(&self) -> String {
        self.stand().stand.id()
    }

    fn remark(&self, path: &Path) -> Option<String> {
        let name = path.file_name()?;
        let other = ["stand.yaml", "stand.yml"].iter().any(|usual| name.eq_ignore_ascii_case(usual));
        (other && name != "stand.yaml").then(|| "is read as stand.yaml; rename it to stand.yaml".to_owned())
    }
}

impl Listed for Site {
    const NAME: &str = "site";

    fn parse(name: &str, bytes: &[u8]) -> Result<Self, Unreadable> {
        Self::from_yaml(name, bytes)
    }

    fn id(&self) -> String {
        self.id.to_string()
    }

    fn remark(&self, path: &Path) -> Option<String> {
        let other_id = path.file_stem().is_some_and(|stem| stem != self.id.as_str());
        let other_kind = path.extension().is_some_and(|extension| extension != "yaml");
        (other_id || other_kind).then(|| format!("file name and id differ; expected {}.yaml", self.id))
    }
}

/// Files of a batch by their ids. Two files with one id and different content are both skipped, because the program
/// cannot tell which is right.
pub(crate) struct Catalogue<T> {
    files: Vec<File<T>>,
    by_id: BTreeMap<String, usize>,
    last: Mutex<Option<(usize, Arc<T>)>>,
}

struct File<T> {
    path: PathBuf,
    kept: Option<Arc<T>>,
}

impl<T: Listed> Catalogue<T> {
    /// Reads all files, and passes remarks on them to `tell`; also returns the failures.
    pub(crate) fn read(
        paths: impl Iterator<Item = Result<PathBuf, Failure>>,
        threads: usize,
        tell: Listener,
    ) -> (Self, Vec<Failure>) {
        let mut draft = Draft { listed: Vec::new(), names: BTreeMap::new(), failures: Vec::new() };
        let mut paths = paths.fuse();
        loop {
            let some: Vec<_> = paths.by_ref().take(READ_AT_ONCE).collect();
            if some.is_empty() {
                break;
            }
            let read = parallel::map(&some, threads, |path| read(path.as_ref().map_err(Failure::clone)?));
            for (path, read) in some.into_iter().zip(read) {
                match (path, read) {
                    (Ok(path), Ok((value, hash))) => draft.add(path, value, hash, tell),
                    (Ok(_), Err(failure)) => draft.failures.push(failure),
                    // An unreadable folder or pattern may contain any number of files.
                    (Err(failure), _) => draft.failures.push(Failure { passports: Some(0), ..failure }),
                }
            }
        }
        draft.finished()
    }

    pub(crate) fn ids(&self) -> impl Iterator<Item = &str> {
        self.by_id.keys().map(String::as_str)
    }

    pub(crate) fn len(&self) -> usize {
        self.files.len()
    }

    /// Loads the files at `places`, in the order in which they were given, with their present content.
    ///
    /// # Errors
    /// Returns a [`Failure`] for a file that cannot be read any more, because it was changed or removed.
    pub(crate) fn load(&self, places: Range<usize>, threads: usize) -> Vec<Result<Arc<T>, Failure>> {
        parallel::map(&self.files[places], threads, File::load)
    }

    /// Returns `true` if a file with this id was given.
    pub(crate) fn has(&self, id: &str) -> bool {
        self.by_id.contains_key(id)
    }

    /// Returns the document with this id as [`Self::load`] does, or `None` if it was not given.
    pub(crate) fn get(&self, id: &str) -> Result<Option<Arc<T>>, Failure> {
        let Some(&place) = self.by_id.get(id) else { return Ok(None) };
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        match &*last {
            Some((known, value)) if *known == place => Ok(Some(Arc::clone(value))),
            _ => {
                let value = self.files[place].load()?;
                *last = Some((place, Arc::clone(&value)));
                Ok(Some(value))
            }
        }
    }
}

impl<T: Listed> File<T> {
    fn load(&self) -> Result<Arc<T>, Failure> {
        match &self.kept {
            Some(value) => Ok(Arc::clone(value)),
            None => read(&self.path).map(|(value, _)| Arc::new(value)),
        }
    }
}

/// Reads a file; returns its document and its SHA-256.
pub(super) fn read<T: Listed>(path: &Path) -> Result<(T, [u8; 32]), Failure> {
    let bytes = files::read(path, LARGEST_DOCUMENT_BYTES).map_err(Failure::file)?;
    let value = T::parse(&name_of(path), &bytes);
    let value = value.map_err(|error| Failure::unreadable(path, error))?;
    Ok((value, Sha256::digest(&bytes).into()))
}

/// Catalogue under construction.
struct Draft<T> {
    listed: Vec<Seen<T>>,
    /// Names that become a folder or a file, in lower case, each with its first spelling and the place of its first
    /// file.
    names: BTreeMap<String, (String, usize)>,
    failures: Vec<Failure>,
}

struct Seen<T> {
    file: File<T>,
    id: String,
    hash: [u8; 32],
    others: Vec<PathBuf>,
}

impl<T: Listed> Draft<T> {
    fn add(&mut self, path: PathBuf, value: T, hash: [u8; 32], tell: Listener) {
        let file = name_of(&path);
        let id = value.id();
        if let Some(why) = self.differs_in_case(&path, &id) {
            return self.failures.push(Failure::refused(&path, why));
        }
        match self.names.get(&id.to_ascii_lowercase()) {
            Some(&(_, first)) if self.listed[first].hash == hash => {
                let words = format!("duplicate of {} {id}, used once", T::NAME);
                tell(Event::Remark { file, words, is_warning: false });
            }
            Some(&(_, first)) => self.listed[first].others.push(path),
            None => {
                if let Some(words) = value.remark(&path) {
                    tell(Event::Remark { file, words, is_warning: false });
                }
                for name in names(&id) {
                    self.names.entry(name.to_ascii_lowercase()).or_insert((name.to_owned(), self.listed.len()));
                }
                let kept = (self.listed.len() < KEPT).then(|| Arc::new(value));
                self.listed.push(Seen { file: File { path, kept }, id, hash, others: Vec::new() });
            }
        }
    }

    /// Returns the reason why an id is refused that differs from a known one only in case, or `None` if there is none.
    fn differs_in_case(&self, path: &Path, id: &str) -> Option<String> {
        let known = |name: &str| self.names.get(&name.to_ascii_lowercase()).cloned();
        let (name, (other, first)) =
            names(id).find_map(|name| Some((name, known(name).filter(|(other, _)| other != name)?)))?;
        let (path, first, what) = (shown(path), shown(&self.listed[first].file.path), T::NAME);
        Some(format!(
            "{path}: {what} {id}: found {name}, but {other} in {first}; use the same spelling, or rename one, because \
             Windows and macOS do not distinguish them"
        ))
    }

    fn finished(mut self) -> (Catalogue<T>, Vec<Failure>) {
        let mut catalogue = Catalogue { files: Vec::new(), by_id: BTreeMap::new(), last: Mutex::new(None) };
        for seen in self.listed {
            if seen.others.is_empty() {
                catalogue.by_id.insert(seen.id, catalogue.files.len());
                catalogue.files.push(seen.file);
            } else {
                let others: Vec<_> = seen.others.iter().map(|path| shown(path).to_string()).collect();
                let (id, others, path) = (seen.id, first_few(&others), shown(&seen.file.path));
                let why = format!("{path}: has the id {id}, like {others}, but different content; keep one file");
                self.failures.push(Failure::refused(&seen.file.path, why));
            }
        }
        (catalogue, self.failures)
    }
}

/// Returns the names in an id that become folders or a file: for a stand `<model>` and `<model>/<serial>`.
fn names(id: &str) -> impl Iterator<Item = &str> {
    id.match_indices('/').map(|(end, _)| &id[..end]).chain([id])
}
