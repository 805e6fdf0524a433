//! Command line, with one file for each verb: read, call the library, write. It contains no formulas and no rules.
//!
//! Rules of the user interface: results go to standard output, messages to standard error. Exit code 0: success, or a
//! valid document. 1: a document or a result was refused. 2: wrong usage, or a file that cannot be read in the expected
//! format. With several files, every one is reported and the highest code is returned.

mod arguments;
mod batch;
mod built_in;
mod calibrate;
mod certify;
mod defaults;
mod deliver;
mod demo;
mod diff;
mod export;
mod failure;
mod help;
mod history;
mod init;
mod inputs;
mod interrupt;
mod issue;
mod key_options;
mod keygen;
mod long_run;
mod new;
mod open_workspace;
mod options;
mod output;
mod plan;
mod receive;
mod recertify;
mod register;
mod reissue;
mod render;
mod revoke;
mod show;
mod simulate;
mod status;
mod trust_options;
mod uncertainty;
mod verify;

use crate::text::printable;
use clap::{Parser, Subcommand};
use failure::Failure;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// Signed passports that let a low-cost test stand calibrate a dynamically tuned gyro as well as an expensive one.
#[derive(Parser)]
#[command(name = "dtg-passport", bin_name = "dtg-passport", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
    /// Folder of the workspace; its dtg-passport.toml supplies missing options [env: DTG_PASSPORT_WORKSPACE]
    #[arg(long, global = true, help_heading = "General options", value_name = "DIR")]
    // It is read before the other arguments are parsed.
    #[allow(dead_code)]
    workspace: Option<PathBuf>,
    /// Suppress remarks; results, failures and warnings are still printed
    #[arg(short, long, global = true, help_heading = "General options", conflicts_with = "verbose")]
    quiet: bool,
    /// Also print where options come from, and the duration
    #[arg(short, long, global = true, help_heading = "General options")]
    verbose: bool,
}

/// Declares the verbs, each with its options and the function that runs it.
macro_rules! verbs {
    ($($verb:ident($options:path, $run:path),)*) => {
        #[derive(Subcommand)]
        enum Verb { $($verb(Box<$options>),)* }

        impl Verb {
            fn run(&self) -> Result<Code, Failure> {
                match self { $(Self::$verb(options) => $run(options),)* }
            }
        }
    };
}

// Those of a factory's day, then those of a laboratory's, then the rest.
verbs! {
    Certify(certify::Options, certify::run),
    Issue(issue::Options, issue::run),
    Deliver(deliver::Options, deliver::run),
    Reissue(reissue::Options, reissue::run),
    Recertify(recertify::Options, recertify::run),
    Register(register::Options, register::run),
    Revoke(revoke::Options, revoke::run),
    Receive(receive::Options, receive::run),
    Verify(verify::Options, verify::run),
    Calibrate(calibrate::Options, calibrate::run),
    Status(status::Options, status::run),
    Show(show::Options, show::run),
    Render(render::Options, render::run),
    Export(export::Options, export::run),
    Diff(diff::Options, diff::run),
    History(history::Options, history::run),
    Plan(plan::Options, plan::run),
    Init(init::Options, init::run),
    New(new::Options, new::run),
    Keygen(keygen::Options, keygen::run),
    Demo(demo::Options, demo::run),
    Simulate(simulate::Options, simulate::run),
    Selftest(built_in::Selftest, built_in::selftest),
    Schema(built_in::Schema, built_in::schema),
    Completions(built_in::Completions, built_in::completions),
    Man(built_in::Man, built_in::man),
}

/// Exit code of a verb that ran to its end: 0, or the highest code that it reported.
type Code = u8;

/// Exit code for a refused document or result.
const REFUSED: Code = 1;

/// Exit code for wrong usage, or for a file that cannot be read in the expected format.
const UNUSABLE: Code = 2;

/// Returns the exit code of an answer that is unknown or that refuses something.
fn code(is_unknown: bool, refuses: bool) -> Code {
    if is_unknown { UNUSABLE } else { Code::from(refuses) }
}

/// Returns the command line as declared and the JSON Schemas of the formats, from which tests/generated.rs makes files.
#[cfg(feature = "generate")]
#[doc(hidden)]
pub fn declared() -> (clap::Command, serde_json::Map<String, serde_json::Value>) {
    (help::command(), crate::schema::generate::schemas())
}

/// Parses the arguments and runs the verb.
pub fn main() -> ExitCode {
    // The message of a broken invariant may quote untrusted text.
    std::panic::set_hook(Box::new(|panic| output::complain(&format!("internal error: {}", printable(panic)))));
    let start = Instant::now();
    let (cli, added) = match arguments::parse(std::env::args_os().collect()) {
        Ok(parsed) => parsed,
        Err(code) => return code,
    };
    output::set_quiet(cli.quiet);
    output::fit_to_terminal();
    if cli.verbose {
        added.iter().for_each(|option| output::say(&format!("uses {option}")));
    }
    let result = cli.verb.run();
    output::complain_of_the_rest();
    if cli.verbose {
        output::say(&format!("took {:.3} s", start.elapsed().as_secs_f64()));
    }
    match result {
        Ok(code) => ExitCode::from(code),
        Err(failure) => failure.report(),
    }
}
