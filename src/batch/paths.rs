//! What a user names: files, folders, patterns, a list on standard input.

use super::{Failure, Purpose};
use crate::files::walk::{Entry, Walk};
use crate::files::{FileError, reason};
use crate::text::{Printable, shown};
use glob::MatchOptions;
use std::ffi::OsStr;
use std::io::{self, BufRead};
use std::path::{Path, PathBuf};

/// The longest path that a list may hold, in bytes; no system has a longer one.
const LONGEST_PATH: usize = 1 << 16;

/// Something that the user named.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Named {
    /// A file, or what will turn out not to be there.
    File(PathBuf),
    /// A folder.
    Folder(PathBuf),
}

impl Named {
    fn of(path: PathBuf) -> Self {
        if path.is_dir() { Self::Folder(path) } else { Self::File(path) }
    }
}

/// What the user named, one after the other and none held: `-` is the list, with a path on each line or a zero byte
/// between them; a pattern that is no file stands for what it matches, in the order of names.
pub(crate) fn named<'a>(
    arguments: &'a [PathBuf],
    list: &'a mut dyn BufRead,
) -> impl Iterator<Item = Result<Named, Failure>> + 'a {
    let mut list = Some(list);
    arguments.iter().flat_map(move |argument| -> Box<dyn Iterator<Item = Result<Named, Failure>> + 'a> {
        if argument.as_os_str() == "-"
            && let Some(list) = list.take()
        {
            return Box::new(List { list: Some(list), separator: None }.map(|path| path.map(Named::of)));
        }
        match pattern(argument) {
            Some(pattern) => matches(pattern),
            None => Box::new(std::iter::once(Ok(Named::of(argument.clone())))),
        }
    })
}

/// The files that the user named; of a folder those that serve the purpose.
pub(crate) fn files<'a>(
    arguments: &'a [PathBuf],
    list: &'a mut dyn BufRead,
    purpose: Purpose,
) -> impl Iterator<Item = Result<PathBuf, Failure>> + 'a {
    named(arguments, list).flat_map(move |named| -> Box<dyn Iterator<Item = Result<PathBuf, Failure>>> {
        match named {
            Err(failure) => Box::new(std::iter::once(Err(failure))),
            Ok(Named::File(path)) => Box::new(std::iter::once(Ok(path))),
            Ok(Named::Folder(folder)) => in_folder(folder, purpose),
        }
    })
}

fn in_folder(folder: PathBuf, purpose: Purpose) -> Box<dyn Iterator<Item = Result<PathBuf, Failure>>> {
    let (walk, what) = match purpose {
        Purpose::Stands => (Walk::deep(&folder, is_stand), "stand.yaml"),
        Purpose::Sites => (Walk::flat(&folder, is_yaml), "*.yaml"),
    };
    let mut found = walk.map(found).peekable();
    if found.peek().is_none() {
        let what = format!("{}: this folder contains no {what}", shown(&folder));
        return Box::new(std::iter::once(Err(Failure::unusable(&folder, what))));
    }
    Box::new(found)
}

/// A file of a walk; a link and what cannot be read are failures.
pub(crate) fn found(entry: Result<Entry, FileError>) -> Result<PathBuf, Failure> {
    match entry {
        Ok(Entry::File(path)) => Ok(path),
        Ok(Entry::Special(path)) => {
            Err(Failure::unusable(&path, format!("{}: not read: it is a pipe, a device or a socket", shown(&path))))
        }
        Ok(Entry::Link(path)) => {
            let why =
                format!("{}: not read: links are not followed, because they may lead out of the folder", shown(&path));
            Err(Failure::refused(&path, why))
        }
        Err(error) => Err(Failure::file(error)),
    }
}

/// Whether a file is a stand's by its name. Other spellings than `stand.yaml` are read, and remarked upon: a file that was
/// passed over would be missed late.
fn is_stand(name: &OsStr) -> bool {
    is_yaml(name) && Path::new(name).file_stem().is_some_and(|stem| stem.eq_ignore_ascii_case("stand"))
}

fn is_yaml(name: &OsStr) -> bool {
    let extension = Path::new(name).extension();
    let is_yaml =
        ["yaml", "yml"].iter().any(|yaml| extension.is_some_and(|extension| extension.eq_ignore_ascii_case(yaml)));
    is_yaml && !name.as_encoded_bytes().starts_with(b".")
}

/// An argument that is a pattern, unless a file has just this name.
fn pattern(argument: &Path) -> Option<&str> {
    let text = argument.to_str().filter(|text| text.contains(['*', '?', '[']))?;
    argument.symlink_metadata().is_err().then_some(text)
}

/// As the shell would have done it: what begins with a dot must be asked for.
fn matches(pattern: &str) -> Box<dyn Iterator<Item = Result<Named, Failure>>> {
    let failed = |why: String| -> Box<dyn Iterator<Item = Result<Named, Failure>>> {
        Box::new(std::iter::once(Err(Failure::unusable(Path::new(pattern), format!("{}: {why}", Printable(pattern))))))
    };
    let options = MatchOptions { require_literal_leading_dot: true, ..MatchOptions::new() };
    let paths = match glob::glob_with(pattern, options) {
        Err(error) => return failed(format!("invalid pattern: {error}")),
        Ok(paths) => paths,
    };
    let mut paths = paths.peekable();
    if paths.peek().is_none() {
        return failed("no file matches this pattern".to_owned());
    }
    Box::new(paths.map(|path| {
        path.map(Named::of).map_err(|error| {
            Failure::file(FileError::Read { path: error.path().to_owned(), error: io::Error::other(error.to_string()) })
        })
    }))
}

/// Paths on standard input. Whichever of line feed and zero byte comes first separates them all.
struct List<'a> {
    list: Option<&'a mut dyn BufRead>,
    separator: Option<u8>,
}

impl List<'_> {
    /// The bytes before the next separator; `None` at the end.
    fn next_bytes(&mut self) -> io::Result<Option<Vec<u8>>> {
        let Some(list) = &mut self.list else { return Ok(None) };
        let mut bytes = Vec::new();
        loop {
            let buffer = list.fill_buf()?;
            if buffer.is_empty() {
                return Ok((!bytes.is_empty()).then_some(bytes));
            }
            let ends = |byte: &u8| self.separator.map_or(matches!(byte, b'\n' | 0), |separator| *byte == separator);
            let end = buffer.iter().position(ends);
            bytes.extend_from_slice(&buffer[..end.unwrap_or(buffer.len())]);
            let read = end.map_or(buffer.len(), |end| end + 1);
            if let Some(end) = end {
                self.separator = Some(buffer[end]);
            }
            list.consume(read);
            if bytes.len() > LONGEST_PATH {
                return Err(io::Error::other("this is not a list of paths"));
            }
            // Two separators in a row, or one at the beginning, have no path between them.
            if end.is_some() && !bytes.is_empty() {
                return Ok(Some(bytes));
            }
        }
    }
}

impl Iterator for List<'_> {
    type Item = Result<PathBuf, Failure>;

    fn next(&mut self) -> Option<Self::Item> {
        match self.next_bytes() {
            Ok(bytes) => bytes.map(path_of),
            Err(error) => {
                self.list = None;
                let why = format!("standard input: {}", reason(&error));
                Some(Err(Failure::unusable(Path::new("-"), why)))
            }
        }
    }
}

#[cfg(unix)]
fn path_of(bytes: Vec<u8>) -> Result<PathBuf, Failure> {
    use std::os::unix::ffi::OsStringExt;
    Ok(PathBuf::from(std::ffi::OsString::from_vec(bytes)))
}

#[cfg(not(unix))]
fn path_of(bytes: Vec<u8>) -> Result<PathBuf, Failure> {
    let no_text = |_| Failure::unusable(Path::new("-"), "standard input: a path is not valid UTF-8".to_owned());
    String::from_utf8(bytes).map(|path| PathBuf::from(path.trim_end_matches('\r'))).map_err(no_text)
}
