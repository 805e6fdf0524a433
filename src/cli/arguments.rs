//! The arguments: completed from the environment and the workspace, and parsed. What cannot be parsed is reported here.

use super::failure::Failure;
use super::output::{Format, set_languages};
use super::{Cli, UNUSABLE, defaults, help, output};
use crate::text::{printable, shown};
use clap::error::ContextKind;
use clap::{FromArgMatches, ValueEnum};
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

/// Returns the parsed arguments, and in words the options that the environment or the workspace added; or prints the reason
/// why they cannot be parsed.
///
/// clap repeats arguments verbatim in its messages. So the message printed is clap's message about a printable copy of
/// the arguments.
pub(super) fn parse(mut arguments: Vec<OsString>) -> Result<(Cli, Vec<String>), ExitCode> {
    output::set_format(format_of(&arguments));
    let added = defaults::add(&mut arguments).map_err(|failure| failure.report())?;
    let parsed = |arguments: &[OsString]| {
        let matches = help::command().try_get_matches_from(arguments)?;
        set_languages(&matches);
        Cli::from_arg_matches(&matches)
    };
    let error = match (parsed(&arguments), named_twice(&arguments)) {
        (Ok(cli), None) => return Ok((cli, added)),
        (Ok(_), Some(path)) => {
            let words = "is specified twice, so that with --force the new file could replace one that is read; give the new \
                         file another name";
            return Err(Failure::usage(format!("{}: {words}", shown(&path))).report());
        }
        (Err(error), _) => error,
    };
    let printed: Vec<OsString> =
        arguments.iter().map(|argument| printable(argument.to_string_lossy()).into()).collect();
    let mut refused = parsed(&printed).err();
    if let Some(refused) = &mut refused {
        // That an argument may be meant as a file, after `--`, is hardly ever true.
        refused.remove(ContextKind::Suggested);
    }
    if let Some(help) = refused.as_ref().filter(|error| !error.use_stderr()) {
        let written = output::own(&help.render().ansi().to_string());
        return Err(written.map_or_else(|failure| ExitCode::from(failure.code), |()| ExitCode::SUCCESS));
    }
    Failure::usage(words(refused.as_ref().unwrap_or(&error))).print();
    match refused {
        Some(refused) => output::usage(&refused.render().ansi().to_string()),
        None => output::complain(&printable(error)),
    }
    Err(ExitCode::from(UNUSABLE))
}

/// Returns an existing file that two arguments name, if `--force` permits that one of them replaces it.
fn named_twice(arguments: &[OsString]) -> Option<PathBuf> {
    if !arguments.iter().any(|argument| argument == "--force") {
        return None;
    }
    let path = |argument: &OsString| {
        let value = argument.to_str().filter(|text| text.starts_with("--")).and_then(|text| text.split_once('='));
        let path = value.map_or_else(|| PathBuf::from(argument), |(_, value)| PathBuf::from(value));
        Some((path.canonicalize().ok().filter(|path| path.is_file())?, path))
    };
    let mut seen = BTreeSet::new();
    arguments.iter().skip(1).filter_map(path).find_map(|(file, path)| (!seen.insert(file)).then_some(path))
}

/// Returns clap's message without its mark and its last line feed.
fn words(error: &clap::Error) -> String {
    let words = error.render().to_string();
    let words = words.trim_end();
    words.strip_prefix("error: ").unwrap_or(words).split('\n').map(printable).collect::<Vec<_>>().join("\n")
}

/// Returns the format that the arguments ask for, parsed or not: that of failures too.
fn format_of(arguments: &[OsString]) -> Format {
    let joined = arguments.iter().filter_map(|argument| argument.to_str()?.strip_prefix("--format="));
    let apart = arguments.windows(2).filter(|pair| pair[0] == "--format").filter_map(|pair| pair[1].to_str());
    joined.chain(apart).find_map(|format| Format::from_str(format, false).ok()).unwrap_or(Format::Text)
}
