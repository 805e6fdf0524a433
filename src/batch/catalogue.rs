//! Stand and site files by their ids: each read and checked before anything is signed, held only while few.

use super::parallel;
use super::{Event, Failure, Listener};
use crate::files;
use crate::passport::issue::PreparedStand;
use crate::site::Site;
use crate::stand::Stand;
use crate::text::{LARGEST_DOCUMENT_BYTES, Unreadable, name_of, shown};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// So many files are kept in memory once read; of more, as many at a time.
const KEPT: usize = 1024;

/// Files that are read at a time.
const READ_AT_ONCE: usize = 256;

/// What a catalogue is of.
pub(crate) trait Listed: Clone + Send + Sync {
    /// What one is called.
    const NAME: &str;

    /// Reads a file; `name` is its name in messages.
    ///
    /// # Errors
    /// Every mistake with its line, column and field: see [`Unreadable`].
    fn parse(name: &str, bytes: &[u8]) -> Result<Self, Unreadable>;

    /// Its id.
    fn id(&self) -> String;

    /// Something to know about a file of this name.
    fn remark(&self, _path: &Path) -> Option<String> {
        None
    }
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

/// The files of a batch. Two with one id and other content are both left out: which of them counts, nobody said.
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
    /// Reads all files, and tells what is to be known of them; gives also the failures.
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
                    // What a folder or a pattern hides, nobody knows.
                    (Err(failure), _) => draft.failures.push(Failure { passports: Some(0), ..failure }),
                }
            }
        }
        draft.finished()
    }

    /// No files.
    pub(crate) fn empty() -> Self {
        Self { files: Vec::new(), by_id: BTreeMap::new(), last: Mutex::new(None) }
    }

    /// How many ids.
    pub(crate) fn len(&self) -> usize {
        self.files.len()
    }

    /// The files in some places of the order in which they were given, as they are now.
    ///
    /// # Errors
    /// A file that was changed or removed since.
    pub(crate) fn load(&self, places: Range<usize>, threads: usize) -> Vec<Result<Arc<T>, Failure>> {
        parallel::map(&self.files[places], threads, File::load)
    }

    /// Whether one with this id was given.
    pub(crate) fn has(&self, id: &str) -> bool {
        self.by_id.contains_key(id)
    }

    /// The one with this id.
    ///
    /// # Errors
    /// A file that was changed or removed since.
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

/// A file and its hash.
fn read<T: Listed>(path: &Path) -> Result<(T, [u8; 32]), Failure> {
    let bytes = files::read(path, LARGEST_DOCUMENT_BYTES).map_err(Failure::file)?;
    let value = T::parse(&name_of(path), &bytes);
    let value = value.map_err(|error| Failure::unreadable(path, error))?;
    Ok((value, Sha256::digest(&bytes).into()))
}

/// A catalogue in the making.
struct Draft<T> {
    listed: Vec<Seen<T>>,
    /// By every name that becomes a folder or a file, in lower case: the name as it was first spelled, and by which file.
    names: BTreeMap<String, (String, usize)>,
    failures: Vec<Failure>,
}

struct Seen<T> {
    path: PathBuf,
    id: String,
    kept: Option<Arc<T>>,
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
                tell(Event::Remark { file, words: format!("duplicate of {} {id}, used once", T::NAME) });
            }
            Some(&(_, first)) => self.listed[first].others.push(path),
            None => {
                if let Some(words) = value.remark(&path) {
                    tell(Event::Remark { file, words });
                }
                for name in names(&id) {
                    self.names.entry(name.to_ascii_lowercase()).or_insert((name.to_owned(), self.listed.len()));
                }
                let kept = (self.listed.len() < KEPT).then(|| Arc::new(value));
                self.listed.push(Seen { path, id, kept, hash, others: Vec::new() });
            }
        }
    }

    /// Why an id cannot stand beside another one that is equal to it but for case.
    fn differs_in_case(&self, path: &Path, id: &str) -> Option<String> {
        let known = |name: &str| self.names.get(&name.to_ascii_lowercase()).cloned();
        let (name, (other, first)) =
            names(id).find_map(|name| Some((name, known(name).filter(|(other, _)| other != name)?)))?;
        let (path, first, what) = (shown(path), shown(&self.listed[first].path), T::NAME);
        Some(format!(
            "{path}: {what} {id}: found {name}, but {other} in {first}; use the same spelling, or rename one, because \
             Windows and macOS do not distinguish them"
        ))
    }

    fn finished(mut self) -> (Catalogue<T>, Vec<Failure>) {
        let mut catalogue = Catalogue::empty();
        for seen in self.listed {
            if seen.others.is_empty() {
                catalogue.by_id.insert(seen.id, catalogue.files.len());
                catalogue.files.push(File { path: seen.path, kept: seen.kept });
            } else {
                let others: Vec<_> = seen.others.iter().map(|path| shown(path).to_string()).collect();
                let (what, id, others) = (T::NAME, seen.id, others.join(", "));
                let why = format!(
                    "{}: is {what} {id}, like {others}, but with other content; keep one file",
                    shown(&seen.path)
                );
                self.failures.push(Failure::refused(&seen.path, why));
            }
        }
        (catalogue, self.failures)
    }
}

/// The names that become folders, or a file, each with those above it: of a stand `<model>` and `<model>/<serial>`.
fn names(id: &str) -> impl Iterator<Item = &str> {
    id.match_indices('/').map(|(end, _)| &id[..end]).chain([id])
}
