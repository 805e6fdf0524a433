//! Results to standard output, words to standard error; a closed pipe ends quietly.

use super::Failure;
use crate::files;
use crate::report::style;
use crate::text::printable::{self, printable};
use clap::ValueEnum;
use std::io::{self, Write};
use std::path::Path;

/// The form of a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// Text for a terminal
    Text,
    /// JSON for programs
    Json,
}

/// The form of a result that is a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum TableFormat {
    /// Text for a terminal
    Text,
    /// JSON for programs
    Json,
    /// CSV for spreadsheets
    Csv,
}

/// Writes a result: nothing of what a terminal obeys but its line feeds and emphasis.
pub(super) fn result(text: &str) -> Result<(), Failure> {
    own(&style::outgoing(text))
}

/// Writes to the byte what holds nobody's words but the program's.
pub(super) fn own(text: &str) -> Result<(), Failure> {
    // Emphasis goes to a terminal alone, and never where NO_COLOR is set.
    let mut stdout = anstream::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        // Whoever reads has read enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(Failure::unusable(format!("standard output: {}", files::reason(&error)))),
        Ok(()) => Ok(()),
    }
}

/// Writes a result as JSON.
pub(super) fn json(value: &impl serde::Serialize) -> Result<(), Failure> {
    let text = printable::json(value).map_err(Failure::unusable)?;
    result(&(text + "\n"))
}

/// Writes a result's file. One that exists is replaced on request alone.
pub(super) fn file(path: &Path, text: &str, force: bool) -> Result<(), Failure> {
    files::write_replaceable(path, text.as_bytes(), force).map_err(Failure::file)
}

/// Writes words about a result. Nothing is to be done when even standard error is closed.
pub(super) fn say(words: &str) {
    let lines: Vec<String> = words.trim_end().split('\n').map(printable).collect();
    let _ = writeln!(io::stderr().lock(), "dtg-passport: {}", lines.join("\n              "));
}
