//! Command line, with one file for each verb: read, call the library, write. It contains no formulas and no rules.
//!
//! Rules of the user interface: results go to standard output, messages to standard error. Exit code 0: success, or a
//! valid document. 1: a document or a result was refused. 2: wrong usage, or a file that cannot be read in the expected
//! format. With several files, every one is reported and the highest code is returned.

mod batch;
mod calibrate;
mod certify;
mod completions;
mod demo;
mod diff;
mod export;
mod history;
mod issue;
mod key_options;
mod keygen;
mod output;
mod plan;
mod recertify;
mod register;
mod reissue;
mod render;
mod revoke;
mod schema;
mod selftest;
mod show;
mod simulate;
mod trust_options;
mod uncertainty;
mod verify;

use crate::files::FileError;
use crate::text::{Unreadable, printable};
use clap::{Parser, Subcommand};
use std::ffi::OsString;
use std::process::ExitCode;

/// Signed passports that let a low-cost test stand calibrate a dynamically tuned gyro as well as an expensive one.
#[derive(Parser)]
#[command(name = "dtg-passport", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    Demo(demo::Options),
    Keygen(keygen::Options),
    Certify(certify::Options),
    Issue(issue::Options),
    Reissue(reissue::Options),
    Recertify(recertify::Options),
    Verify(verify::Options),
    Show(show::Options),
    Export(export::Options),
    Diff(diff::Options),
    History(history::Options),
    Render(render::Options),
    Calibrate(calibrate::Options),
    Register(register::Options),
    Revoke(revoke::Options),
    Plan(plan::Options),
    Simulate(simulate::Options),
    Selftest(selftest::Options),
    Schema(schema::Options),
    Completions(completions::Options),
}

/// Exit code of a verb that ran to its end: 0, or the highest code that it reported.
type Code = u8;

/// Exit code for a refused document or result.
const REFUSED: Code = 1;

/// Exit code for wrong usage, or for a file that cannot be read in the expected format.
const UNUSABLE: Code = 2;

/// A failure that ends a verb at once: a message and an exit code.
#[derive(Debug)]
struct Failure {
    message: String,
    code: Code,
}

impl Failure {
    fn refused(error: impl std::fmt::Display) -> Self {
        Self { message: error.to_string(), code: REFUSED }
    }

    /// Converts a write error: an existing file is a refusal, any other error is not.
    fn file(error: FileError) -> Self {
        match error {
            FileError::Exists { .. } => Self::refused(error),
            _ => Self::unusable(error),
        }
    }

    /// Creates the failure for a file with mistakes; the message includes their lines.
    fn unreadable(error: Unreadable) -> Self {
        Self::unusable(error.with_lines(""))
    }

    fn unusable(error: impl std::fmt::Display) -> Self {
        Self { message: error.to_string(), code: UNUSABLE }
    }
}

/// Parses the arguments, or prints the reason why they cannot be parsed.
///
/// clap repeats arguments verbatim in its messages. So the message printed is clap's message about a printable copy of
/// the arguments.
fn parse(arguments: Vec<OsString>) -> Result<Cli, ExitCode> {
    let error = match Cli::try_parse_from(&arguments) {
        Ok(cli) => return Ok(cli),
        Err(error) => error,
    };
    match Cli::try_parse_from(arguments.iter().map(|argument| printable(argument.to_string_lossy()))) {
        Err(error) => error.exit(),
        Ok(_) => output::say(&printable(error)),
    }
    Err(ExitCode::from(UNUSABLE))
}

/// Parses the arguments and runs the verb.
pub fn main() -> ExitCode {
    // The message of a broken invariant may quote untrusted text.
    std::panic::set_hook(Box::new(|panic| output::say(&format!("internal error: {}", printable(panic)))));
    let cli = match parse(std::env::args_os().collect()) {
        Ok(cli) => cli,
        Err(code) => return code,
    };
    let result = match cli.verb {
        Verb::Demo(options) => demo::run(&options),
        Verb::Keygen(options) => keygen::run(&options),
        Verb::Certify(options) => certify::run(&options),
        Verb::Issue(options) => issue::run(&options),
        Verb::Reissue(options) => reissue::run(&options),
        Verb::Recertify(options) => recertify::run(&options),
        Verb::Verify(options) => verify::run(&options),
        Verb::Show(options) => show::run(&options),
        Verb::Export(options) => export::run(&options),
        Verb::Diff(options) => diff::run(&options),
        Verb::History(options) => history::run(&options),
        Verb::Render(options) => render::run(&options),
        Verb::Calibrate(options) => calibrate::run(&options),
        Verb::Register(options) => register::run(&options),
        Verb::Revoke(options) => revoke::run(&options),
        Verb::Plan(options) => plan::run(&options),
        Verb::Simulate(options) => simulate::run(&options),
        Verb::Selftest(options) => selftest::run(&options),
        Verb::Schema(options) => schema::run(&options),
        Verb::Completions(options) => completions::run(&options),
    };
    match result {
        Ok(code) => ExitCode::from(code),
        Err(failure) => {
            output::say(&failure.message);
            ExitCode::from(failure.code)
        }
    }
}
