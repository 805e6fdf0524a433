//! Output: results to standard output, messages to standard error. A closed pipe is not an error.

use super::{Failure, interrupt};
use crate::files::{self, FileError};
use crate::pdf;
use crate::report::doc::{self, Block};
pub(super) use crate::report::issued::Form as Format;
use crate::report::{Language, Languages, columns, style};
use crate::text::{excerpt, printable, shown};
use clap::ArgMatches;
use serde::Serialize;
use serde_json::Value;
use std::io::{self, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};
use terminal_size::{Height, Width, terminal_size_of};

/// Format of the results of this process, and of its failures.
static FORMAT: OnceLock<Format> = OnceLock::new();

/// Takes the format from the arguments, once, before anything is written.
pub(super) fn set_format(format: Format) {
    let _ = FORMAT.set(format);
}

pub(super) fn format() -> Format {
    FORMAT.get().copied().unwrap_or(Format::Text)
}

/// Languages of this process.
static LANGUAGES: OnceLock<Languages> = OnceLock::new();

/// Takes the languages from the arguments, once, before anything is written.
pub(super) fn set_languages(matches: &ArgMatches) {
    let stated = matches.subcommand().and_then(|(_, verb)| verb.try_get_many::<Language>("lang").ok().flatten());
    if let Some(mut stated) = stated
        && let Some(first) = stated.next()
    {
        let _ = LANGUAGES.set(Languages::new(*first, stated.copied()));
    }
}

/// Returns the languages, or `None` if neither the option nor the workspace states any.
pub(super) fn stated_languages() -> Option<&'static Languages> {
    LANGUAGES.get()
}

/// Returns the languages of pages.
pub(super) fn languages() -> Languages {
    stated_languages().cloned().unwrap_or_else(|| Language::English.into())
}

/// Returns the language of the text.
pub(super) fn language() -> Language {
    languages().first()
}

/// Returns `true` if results are JSON.
pub(super) fn is_json() -> bool {
    matches!(format(), Format::Json | Format::Ndjson)
}

/// Writes JSON, or a line for each element of a list.
pub(super) fn value(value: &impl Serialize) -> Result<(), Failure> {
    if format() != Format::Ndjson {
        return json(value);
    }
    match serde_json::to_value(value).map_err(Failure::unusable)? {
        Value::Array(each) => each.iter().try_for_each(json_line),
        one => json_line(&one),
    }
}

/// Writes a result as text, or as JSON.
pub(super) fn write<T: Serialize>(
    as_json: impl FnOnce() -> T,
    as_text: impl FnOnce() -> String,
) -> Result<(), Failure> {
    if is_json() { value(&as_json()) } else { text(&as_text()) }
}

/// Writes a document for people, or its JSON.
pub(super) fn show<T: Serialize>(
    as_json: impl FnOnce() -> T,
    composed: impl FnOnce() -> Vec<Block>,
) -> Result<(), Failure> {
    write(as_json, || typed(&composed()))
}

/// Returns a document for people as text.
pub(super) fn typed(blocks: &[Block]) -> String {
    doc::typed(blocks, language())
}

/// Writes a document for people.
pub(super) fn document(blocks: &[Block]) -> Result<(), Failure> {
    text(&typed(blocks))
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

/// Writes a file in addition to the result of a verb, and says so after the result. An existing file is replaced only on
/// request.
pub(super) fn saved_too(path: &Path, bytes: impl AsRef<[u8]>, force: bool) -> Result<(), Failure> {
    files::write_replaceable(path, bytes.as_ref(), force)?;
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
        Some(columns) => &columns::hanging(words, 0, columns),
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
