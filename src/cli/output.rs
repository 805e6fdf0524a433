//! Output: results to standard output, messages to standard error. A closed pipe is not an error.

use super::{Failure, interrupt, lang};
use crate::files::{self, FileError};
use crate::pdf;
use crate::report::doc::{self, Block};
use crate::report::{columns, style};
use crate::text::{excerpt, printable, shown};
use clap::ValueEnum;
use clap::builder::{PathBufValueParser, TypedValueParser};
use serde::Serialize;
use serde_json::Value;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use terminal_size::{Height, Width, terminal_size_of};

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// Text for a terminal
    Text,
    /// JSON for programs
    Json,
    /// JSON on one line; of several results one line each
    Ndjson,
}

impl Format {
    /// Writes JSON, or a line for each element of a list.
    pub(super) fn json(self, value: &impl Serialize) -> Result<(), Failure> {
        if self != Self::Ndjson {
            return json(value);
        }
        match serde_json::to_value(value).map_err(Failure::unusable)? {
            Value::Array(each) => each.iter().try_for_each(json_line),
            one => json_line(&one),
        }
    }

    pub(super) fn write<T: Serialize>(
        self,
        as_json: impl FnOnce() -> T,
        as_text: impl FnOnce() -> String,
    ) -> Result<(), Failure> {
        match self {
            Self::Text => text(&as_text()),
            _ => self.json(&as_json()),
        }
    }

    /// Writes a document for people, or its JSON.
    pub(super) fn show<T: Serialize>(
        self,
        as_json: impl FnOnce() -> T,
        composed: impl FnOnce() -> Vec<Block>,
    ) -> Result<(), Failure> {
        self.write(as_json, || doc::typed(&composed(), lang::of_text()))
    }
}

/// Writes a document for people.
pub(super) fn document(blocks: &[Block]) -> Result<(), Failure> {
    text(&doc::typed(blocks, lang::of_text()))
}

/// Names of formats that are not written: a viewer would not open such a file.
const OTHER_FORMATS: [&str; 10] = ["pdf", "png", "jpg", "jpeg", "gif", "eps", "doc", "docx", "svg", "html"];

/// Formats of pages, and of pictures.
pub(super) const PAGE: &[&str] = &["html", "pdf"];
pub(super) const PICTURE: &[&str] = &["svg"];

/// Parser of the path of a page or a picture to write; the name of another format is refused.
pub(super) fn path_of(formats: &'static [&'static str]) -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(move |path| {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        match extension.filter(|named| !formats.contains(&named.as_str()) && OTHER_FORMATS.contains(&named.as_str())) {
            None => Ok(path),
            Some(_) => {
                let example = path.with_extension(formats[0]);
                Err(format!("expected a name ending in .{}, such as {}", formats.join(" or ."), shown(&example)))
            }
        }
    })
}

/// Extensions of files that this program reads or writes: no folder is to be made with such a name.
const FILES: [&str; 7] = ["json", "html", "pdf", "csv", "yaml", "xml", "svg"];

/// Parser of the path of a folder to write to; the name of a file is refused, with `advice` on how to write one file.
pub(super) fn folder(advice: &'static str) -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(move |path| {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        let is_file = extension.is_some_and(|named| FILES.contains(&named.as_str())) && !path.is_dir();
        if is_file { Err(format!("expected the name of a folder, not of a file{advice}")) } else { Ok(path) }
    })
}

/// Parser of the path of a folder of passports.
pub(super) fn folder_of_passports() -> impl TypedValueParser<Value = PathBuf> {
    folder("; the passports in it are <model>/<serial>/<site>-<revision>.yaml")
}

/// Returns the columns of a terminal or, where there is none, those that the user sets in `COLUMNS`.
fn columns_of(terminal: Option<(Width, Height)>) -> Option<usize> {
    let wish = || std::env::var("COLUMNS").ok()?.parse().ok().filter(|columns| *columns > 0);
    terminal.map(|(Width(columns), _)| columns.into()).or_else(wish)
}

/// Writes a result for people; no line is wider than the terminal or `COLUMNS`.
pub(super) fn text(text: &str) -> Result<(), Failure> {
    match columns_of(terminal_size_of(io::stdout())) {
        Some(_) => result(&columns::fitted(text, columns::width())),
        None => result(text),
    }
}

/// Makes the texts for people as wide as the terminal or `COLUMNS`.
pub(super) fn fit_to_terminal() {
    if let Some(columns) = columns_of(terminal_size_of(io::stdout())) {
        columns::set_width(columns);
    }
}

/// Writes a result. Control characters are escaped, except line feeds and emphasis.
pub(super) fn result(text: &str) -> Result<(), Failure> {
    own(&style::outgoing(text))
}

/// Writes text verbatim; it must contain only the program's own words.
pub(super) fn own(text: &str) -> Result<(), Failure> {
    // Emphasis goes only to a terminal, and never if NO_COLOR is set.
    let mut stdout = anstream::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        // The reader closed the pipe; that is not an error.
        Err(error) if files::is_closed_pipe(&error) => Ok(()),
        Err(error) => Err(Failure::unusable(format!("standard output: {}", files::reason(&error)))),
        Ok(()) => Ok(()),
    }
}

pub(super) fn json(value: &impl Serialize) -> Result<(), Failure> {
    let text = printable::json(value).map_err(Failure::unusable)?;
    result(&(text + "\n"))
}

pub(super) fn json_line(value: &impl Serialize) -> Result<(), Failure> {
    result(&(printable::json_line(value).map_err(Failure::unusable)? + "\n"))
}

/// Writes a result to a file. An existing file is replaced only on request.
pub(super) fn file(path: &Path, bytes: impl AsRef<[u8]>, force: bool) -> Result<(), Failure> {
    files::write_replaceable(path, bytes.as_ref(), force).map_err(Failure::from)
}

/// Returns a page in the format that the suffix of its path states: HTML, or PDF.
pub(super) fn page(path: &Path, html: String, force: bool) -> Result<Vec<u8>, FileError> {
    if !path.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("pdf")) {
        return Ok(html.into_bytes());
    }
    // Before a browser starts, which takes seconds.
    files::check_replaceable([path], force)?;
    // Ctrl-C then ends the browser, but not this program, which has to remove the browser's folder.
    let _ = interrupt::cancelled_by_ctrl_c();
    pdf::print(&html, path, std::env::var(pdf::BROWSER_VARIABLE).ok().as_deref())
}

/// Writes a file in addition to the result of a verb as [`file`] does, and says so after the result.
pub(super) fn saved_too(path: &Path, bytes: impl AsRef<[u8]>, force: bool) -> Result<(), Failure> {
    file(path, bytes, force)?;
    say_after(&format!("wrote {}", shown(path)));
    Ok(())
}

/// Messages that follow the result.
static AFTER: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Writes a message as [`say`] does, but after the result of the verb, whose verdict comes first.
pub(super) fn say_after(words: &str) {
    if !is_quiet() {
        complain_after(words);
    }
}

/// Writes a message as [`complain`] does, but after the result of the verb.
pub(super) fn complain_after(words: &str) {
    after().push(words.to_owned());
}

pub(super) fn complain_of_the_rest() {
    std::mem::take(&mut *after()).iter().for_each(|words| complain(words));
}

fn after() -> MutexGuard<'static, Vec<String>> {
    AFTER.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Whether only failures are reported.
static QUIET: AtomicBool = AtomicBool::new(false);

/// Suppresses the messages of [`say`].
pub(super) fn set_quiet(quiet: bool) {
    QUIET.store(quiet, Ordering::Relaxed);
}

/// Returns `true` if only failures are reported.
pub(super) fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Writes a message about a result, unless only failures are reported.
pub(super) fn say(words: &str) {
    if !is_quiet() {
        complain(words);
    }
}

/// Writes a verdict about a result as [`say`] does.
pub(super) fn say_verdict(words: &str) {
    if !is_quiet() {
        verdict(words);
    }
}

/// Beginning of every message that does not begin with a verdict.
const NAME: &str = "dtg-passport: ";

/// Writes clap's message about arguments. Errors are ignored, because there is nowhere left to report them.
pub(super) fn usage(words: &str) {
    let words = match columns_of(terminal_size_of(io::stderr())) {
        Some(columns) => &columns::sentences(words, columns),
        None => words,
    };
    let _ = anstream::stderr().lock().write_all(words.as_bytes());
}

/// Writes a warning next to the output.
pub(super) fn warn(words: &str) {
    complain(&format!("WARNING: {words}"));
}

/// Writes a message about a failure. Errors are ignored, because there is nowhere left to report them.
pub(super) fn complain(words: &str) {
    message(NAME, words);
}

/// Writes a message that begins with a verdict. Whether it does is not read from its text: that may be the name of a file.
pub(super) fn verdict(words: &str) {
    message("", words);
}

fn message(name: &str, words: &str) {
    let mut lines: Vec<String> = words.trim_end().split('\n').map(printable).collect();
    let columns = columns_of(terminal_size_of(io::stderr()));
    if let Some(columns) = columns {
        excerpt::cut(&mut lines, columns.saturating_sub(name.len()));
    }
    let text = format!("{name}{}\n", lines.join(&format!("\n{:1$}", "", name.len())));
    let text = match columns {
        Some(columns) => columns::hanging(&text, name.len(), columns),
        None => text,
    };
    let _ = io::stderr().lock().write_all(text.as_bytes());
}
