//! Stand and site files by their ids; all are read and checked before anything is signed.

use super::{Event, Failure, Listener, Purpose, parallel, paths};
use crate::files;
use crate::site::Site;
use crate::stand::Stand;
use crate::text::{LARGEST_DOCUMENT_BYTES, Unreadable, first_few, name_of, shown};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::io::BufRead;
use std::path::{Path, PathBuf};

/// Kind of document in a catalogue.
pub(crate) trait Listed: Sized + Send {
    /// Name of the kind in messages.
    const NAME: &str;

    /// Kind of files that a folder is searched for.
    const PURPOSE: Purpose;

    /// Reads a file; `name` is its name in messages.
    fn parse(name: &str, bytes: &[u8]) -> Result<Self, Unreadable>;

    fn id(&self) -> String;

    /// Returns a remark on the name of the file, or `None` if it is as expected.
    fn remark(&self, path: &Path) -> Option<String>;
}

impl Listed for Stand {
    const NAME: &str = "stand";
    const PURPOSE: Purpose = Purpose::Stands;

    fn parse(name: &str, bytes: &[u8]) -> Result<Self, Unreadable> {
        Self::from_yaml(name, bytes)
    }

    fn id(&self) -> String {
        self.stand.id()
    }

    fn remark(&self, path: &Path) -> Option<String> {
        let name = path.file_name()?;
        let other = ["stand.yaml", "stand.yml"].iter().any(|usual| name.eq_ignore_ascii_case(usual));
        (other && name != "stand.yaml").then(|| "is read as stand.yaml; rename it to stand.yaml".to_owned())
    }
}

impl Listed for Site {
    const NAME: &str = "site";
    const PURPOSE: Purpose = Purpose::Sites;

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
    /// Documents in the order in which they were given.
    pub documents: Vec<T>,
    places: BTreeMap<String, usize>,
}

impl<T: Listed> Catalogue<T> {
    /// Reads the files that the arguments name, and passes remarks on them to `tell`; also returns the failures.
    pub(crate) fn read(
        arguments: &[PathBuf],
        list: &mut dyn BufRead,
        threads: usize,
        tell: Listener,
    ) -> (Self, Vec<Failure>) {
        let paths: Vec<_> = paths::files(arguments, list, T::PURPOSE).collect();
        let read = parallel::map(&paths, threads, |path| read(path.as_ref().map_err(Failure::clone)?));
        let mut draft = Draft { listed: Vec::new(), names: BTreeMap::new(), failures: Vec::new() };
        for (path, read) in paths.into_iter().zip(read) {
            match (path, read) {
                (Ok(path), Ok((value, hash))) => draft.add(path, value, hash, tell),
                (Ok(_), Err(failure)) => draft.failures.push(failure),
                // An unreadable folder or pattern may contain any number of files.
                (Err(failure), _) => draft.failures.push(Failure { passports: Some(0), ..failure }),
            }
        }
        draft.finished()
    }

    pub(crate) fn ids(&self) -> impl Iterator<Item = &str> {
        self.places.keys().map(String::as_str)
    }

    /// Returns the document with this id, or `None` if it was not given.
    pub(crate) fn get(&self, id: &str) -> Option<&T> {
        self.places.get(id).map(|&place| &self.documents[place])
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
    path: PathBuf,
    document: T,
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
                self.listed.push(Seen { path, document: value, id, hash, others: Vec::new() });
            }
        }
    }

    /// Returns the reason why an id is refused that differs from a known one only in case, or `None` if there is none.
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
        let mut catalogue = Catalogue { documents: Vec::new(), places: BTreeMap::new() };
        for Seen { path, document, id, others, .. } in self.listed {
            if others.is_empty() {
                catalogue.places.insert(id, catalogue.documents.len());
                catalogue.documents.push(document);
            } else {
                let others: Vec<_> = others.iter().map(|path| shown(path).to_string()).collect();
                let (file, others) = (shown(&path), first_few(&others));
                let why = format!("{file}: has the id {id}, like {others}, but different content; keep one file");
                self.failures.push(Failure::refused(&path, why));
            }
        }
        (catalogue, self.failures)
    }
}

/// Returns the names in an id that become folders or a file: for a stand `<model>` and `<model>/<serial>`.
fn names(id: &str) -> impl Iterator<Item = &str> {
    id.match_indices('/').map(|(end, _)| &id[..end]).chain([id])
}
