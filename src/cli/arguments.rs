//! The arguments: completed from the environment and the workspace, and parsed. What cannot be parsed is reported here.

use super::failure::Failure;
use super::output::{Format, set_languages};
use super::{Cli, UNUSABLE, defaults, help, open_workspace, output};
use crate::text::{printable, shown};
use crate::workspace::WORKSPACE_FILE;
use clap::error::{ContextKind, ContextValue, ErrorKind};
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
    let advice = refused.as_ref().map(advice).unwrap_or_default();
    Failure::usage(words(refused.as_ref().unwrap_or(&error)) + &advice).print();
    match refused {
        Some(refused) => {
            output::usage(&refused.render().ansi().to_string());
            if !advice.is_empty() {
                output::complain(advice.trim_start());
            }
        }
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

/// Meaning and source of each option that is often missing.
const MISSING: [(&str, &str); 4] = [
    (
        "--trust",
        "--trust lists the keys that you trust: the allowed_signers file that the factory gave you, or that `keygen` \
         printed a line for. Give the file, set DTG_PASSPORT_TRUST, or specify a workspace.",
    ),
    (
        "--key",
        "--key is the private key that signs: `dtg-passport keygen KEY` creates one. Give the file, set \
         DTG_PASSPORT_KEY, or specify a workspace.",
    ),
    (
        "--identity",
        "--identity is the issuer: the name before your key in allowed_signers. Give it, set DTG_PASSPORT_IDENTITY, or \
         specify a workspace.",
    ),
    ("--site", "--site describes the site: `dtg-passport new site FILE` writes a template."),
];

/// Returns, for missing options, what they are; otherwise an empty text.
fn advice(error: &clap::Error) -> String {
    if error.kind() != ErrorKind::MissingRequiredArgument {
        return String::new();
    }
    let Some(ContextValue::Strings(missing)) = error.get(ContextKind::InvalidArg) else { return String::new() };
    let is_missing = |option: &str| {
        let mut words = missing.iter().flat_map(|argument| argument.split(|c: char| " <>|".contains(c)));
        words.any(|word| word == option)
    };
    // Where a workspace is specified, it lacks the value.
    let here = |option: &str, words: &str| match open_workspace::workspace() {
        Some(workspace) => {
            let file = shown(&workspace.root.join(WORKSPACE_FILE)).to_string();
            words.replace("specify a workspace", &format!("state `{}` in {file}", option.trim_start_matches('-')))
        }
        None => words.to_owned(),
    };
    let missing = MISSING.iter().filter(|(option, _)| is_missing(option));
    missing.map(|(option, words)| format!("\n{}", here(option, words))).collect()
}

/// Returns the format that the arguments ask for, parsed or not: that of failures too.
fn format_of(arguments: &[OsString]) -> Format {
    let joined = arguments.iter().filter_map(|argument| argument.to_str()?.strip_prefix("--format="));
    let apart = arguments.windows(2).filter(|pair| pair[0] == "--format").filter_map(|pair| pair[1].to_str());
    joined.chain(apart).find_map(|format| Format::from_str(format, false).ok()).unwrap_or(Format::Text)
}
