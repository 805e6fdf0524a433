//! Paths in the arguments of a user: files, folders, patterns, and a list on standard input.

use super::{Failure, Purpose};
use crate::files;
use crate::files::leftovers::is_lasting;
use crate::files::walk::{Entry, LINK, SPECIAL, Walk};
use crate::files::{FileError, reason};
use crate::folder::place::numbered;
use crate::text::node::{is_utf16, without_byte_order_mark};
use crate::text::{Kind, Printable, RefusalCause, Unreadable, shown, without_secrets};
use std::ffi::OsStr;
use std::io::{self, BufRead, Read as _};
use std::path::{Path, PathBuf};

/// Number of first bytes by which a file is recognised as a passport.
const BEGINNING_BYTES: usize = 4096;

/// Longest path in a list, in bytes; no system allows a longer one.
const LONGEST_PATH: usize = 1 << 16;

/// Most bytes of a list of paths: millions of them.
const LARGEST_LIST: usize = 1 << 29;

type Paths<'a> = Box<dyn Iterator<Item = Result<PathBuf, Failure>> + 'a>;

fn failed<'a>(failure: Failure) -> Paths<'a> {
    Box::new(std::iter::once(Err(failure)))
}

/// Returns the files and folders specified by the user; a file may not exist.
///
/// The argument `-` is the list, with one path per line or with NUL between paths. A pattern that is not a file name
/// is replaced by its matches in the order of their names.
pub(crate) fn named<'a>(
    arguments: &'a [PathBuf],
    list: &'a mut dyn BufRead,
) -> impl Iterator<Item = Result<PathBuf, Failure>> + 'a {
    let mut list = Some(list);
    arguments.iter().flat_map(move |argument| -> Paths<'a> {
        if argument.as_os_str() == "-"
            && let Some(list) = list.take()
        {
            return match listed(list) {
                Ok(paths) => Box::new(paths.into_iter()),
                Err(failure) => failed(failure),
            };
        }
        match pattern(argument) {
            Some(pattern) => matches(pattern),
            None => Box::new(std::iter::once(Ok(argument.clone()))),
        }
    })
}

/// Returns `true` if a line is not a path, but the first line of a file of this project or of a key.
fn is_of_a_file(line: &Path) -> bool {
    let text = line.to_string_lossy();
    let is_content = ["# ", "format: ", "i,j,", "-----BEGIN"].iter().any(|begin| text.starts_with(begin));
    (is_content || without_secrets(&text) != text) && !line.exists()
}

/// Returns the files specified by the user, and those in specified folders that fit the purpose.
pub(crate) fn files<'a>(
    arguments: &'a [PathBuf],
    list: &'a mut dyn BufRead,
    purpose: Purpose,
) -> impl Iterator<Item = Result<PathBuf, Failure>> + 'a {
    named(arguments, list).flat_map(move |named| match named {
        Ok(folder) if folder.is_dir() => in_folder(&folder, purpose),
        file => Box::new(std::iter::once(file)),
    })
}

fn in_folder(folder: &Path, purpose: Purpose) -> Paths<'static> {
    let (found, what): (Paths, _) = match purpose {
        Purpose::Stands => (Box::new(Walk::deep(folder, is_stand).map(found)), "stand.yaml"),
        Purpose::Sites => (Box::new(Walk::flat(folder, is_yaml).map(found)), "*.yaml"),
        Purpose::Tables => (Box::new(Walk::flat(folder, |name| has_extension(name, &["csv"])).map(found)), "*.csv"),
        Purpose::Passports => (Box::new(Walk::deep(folder, is_lasting).filter_map(passport)), "passport"),
    };
    let mut found = found.peekable();
    if found.peek().is_none() { failed(contains_no(folder, what)) } else { Box::new(found) }
}

/// Returns the entry of a walk if it is named like a passport, or has the content of one, or cannot be read.
fn passport(entry: Result<Entry, FileError>) -> Option<Result<PathBuf, Failure>> {
    let is_named = |path: &Path| path.file_name().and_then(numbered).is_some();
    match entry {
        Ok(Entry::File(path)) => match files::read_first(&path, BEGINNING_BYTES) {
            Ok(bytes) => (is_named(&path) || Kind::of(&bytes) == Some(Kind::Passport)).then_some(Ok(path)),
            Err(error) => Some(Err(Failure::file(error))),
        },
        Ok(Entry::Link(path) | Entry::Special(path)) if !is_named(&path) => None,
        entry => Some(found(entry)),
    }
}

/// Returns the failure of a folder without a file of the kind `what`.
pub(super) fn contains_no(folder: &Path, what: &str) -> Failure {
    Failure::unusable(folder, format!("{}: this folder contains no {what}; check the path", shown(folder)))
}

/// Returns the path of a file found by a walk, or a failure for a link and for an entry that cannot be read.
pub(crate) fn found(entry: Result<Entry, FileError>) -> Result<PathBuf, Failure> {
    match entry {
        Ok(Entry::File(path)) => Ok(path),
        Ok(Entry::Special(path)) => Err(Failure::unusable(&path, format!("{}: {SPECIAL}", shown(&path)))),
        Ok(Entry::Link(path)) => Err(Failure::refused(&path, format!("{}: {LINK}", shown(&path)))),
        Err(error) => Err(Failure::file(error)),
    }
}

/// Returns `true` if the file name is that of a stand. Other spellings than `stand.yaml` are also read, with a remark,
/// because a silently skipped file would be noticed late.
pub(crate) fn is_stand(name: &OsStr) -> bool {
    is_yaml(name) && Path::new(name).file_stem().is_some_and(|stem| stem.eq_ignore_ascii_case("stand"))
}

pub(crate) fn is_yaml(name: &OsStr) -> bool {
    has_extension(name, &["yaml", "yml"])
}

/// Returns `true` if a file name has one of the extensions and is not hidden.
pub(crate) fn has_extension(name: &OsStr, extensions: &[&str]) -> bool {
    let found = Path::new(name).extension();
    let has = extensions.iter().any(|due| found.is_some_and(|found| found.eq_ignore_ascii_case(due)));
    has && !name.as_encoded_bytes().starts_with(b".")
}

/// Returns the path if the arguments are exactly one that names a file: not a list, a pattern or a folder.
pub(crate) fn one_file(arguments: &[PathBuf]) -> Option<&Path> {
    let [path] = arguments else { return None };
    (path.as_os_str() != "-" && pattern(path).is_none() && !path.is_dir()).then_some(path)
}

/// Returns the argument if it is a pattern, or `None` if it is not or if a file has exactly this name.
fn pattern(argument: &Path) -> Option<&str> {
    let text = argument.to_str().filter(|text| text.contains(['*', '?', '[']))?;
    argument.symlink_metadata().is_err().then_some(text)
}

/// Returns the files and folders that match, as in a shell: a leading dot must be in the pattern. Names that are not UTF-8
/// do not match.
fn matches(pattern: &str) -> Paths<'static> {
    let failed = |why: String| failed(Failure::unusable(Path::new(pattern), format!("{}: {why}", Printable(pattern))));
    // With its own option for a leading dot, `glob` panics at a name that is not UTF-8.
    let hidden = |path: &Path| {
        let dots = |name: &[u8]| name.starts_with(b".") && name.iter().any(|byte| *byte != b'.');
        path.iter().filter(|name| dots(name.as_encoded_bytes())).count()
    };
    let most = hidden(Path::new(pattern));
    let paths = match glob::glob(pattern) {
        Err(error) => return failed(format!("invalid pattern: {error}")),
        Ok(paths) => paths.filter(move |path| path.as_ref().map_or(true, |path| hidden(path) <= most)),
    };
    let mut paths = paths.peekable();
    if paths.peek().is_none() {
        return failed("no file matches this pattern".to_owned());
    }
    Box::new(paths.map(|path| {
        path.map_err(|error| {
            Failure::file(FileError::Read(error.path().to_owned(), io::Error::other(error.to_string())))
        })
    }))
}

/// Reads the list of paths on standard input, separated by line feeds or NUL, whichever comes first.
fn listed(list: &mut dyn BufRead) -> Result<Vec<Result<PathBuf, Failure>>, Failure> {
    let failed = |why: String| Failure::unusable(Path::new("-"), format!("standard input: {why}"));
    let mut bytes = Vec::new();
    list.take(LARGEST_LIST as u64 + 1).read_to_end(&mut bytes).map_err(|error| failed(reason(&error)))?;
    if bytes.len() > LARGEST_LIST {
        return Err(failed(format!("larger than {LARGEST_LIST} bytes; split the list")));
    }
    if is_utf16(&bytes) {
        let refused = Unreadable::whole("-", None, "UTF-16", "one path per line, in UTF-8", RefusalCause::Utf16);
        return Err(Failure::unreadable(Path::new("-"), refused));
    }
    let bytes = without_byte_order_mark(&bytes);
    let separator = bytes.iter().find(|byte| matches!(byte, b'\n' | 0));
    // There is no path before a leading separator or between two adjacent ones.
    let paths = bytes.split(|byte| Some(byte) == separator).filter(|path| !path.is_empty());
    if paths.clone().any(|path| path.len() > LONGEST_PATH) {
        return Err(failed("this is not a list of paths".to_owned()));
    }
    let paths: Vec<_> = paths.map(|path| path_of(path.to_owned())).collect();
    let (found, advice) = match paths.first() {
        None => ("no path", "check the command that writes the list"),
        Some(Ok(first)) if is_of_a_file(first) => ("the content of a file", "specify the file by its path"),
        Some(_) => return Ok(paths),
    };
    let words = format!("-: found {found} on standard input, expected one path per line; {advice}");
    Err(Failure::unusable(Path::new("-"), words))
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
