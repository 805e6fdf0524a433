//! The arguments: completed from the environment and the workspace, and parsed. What cannot be parsed is reported here.

use super::failure::Failure;
use super::{Cli, Format, UNUSABLE, defaults, help, lang, output};
use crate::text::{printable, shown};
use crate::workspace::WORKSPACE_FILE;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{FromArgMatches, ValueEnum};
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

/// The arguments as parsed, and the format in which a failure is also reported.
pub(super) struct Parsed {
    pub cli: Cli,
    pub format: Format,
    /// Options that the environment or the workspace added, in words.
    pub added: Vec<String>,
}

/// Parses the arguments, or prints the reason why they cannot be parsed.
///
/// clap repeats arguments verbatim in its messages. So the message printed is clap's message about a printable copy of
/// the arguments.
pub(super) fn parse(mut arguments: Vec<OsString>) -> Result<Parsed, ExitCode> {
    let added = match defaults::add(&mut arguments) {
        Ok(added) => added,
        Err(failure) => return Err(failure.report(format_of(&arguments))),
    };
    let parsed = |arguments: &[OsString]| {
        let matches = help::command().try_get_matches_from(arguments)?;
        lang::set(&matches);
        Cli::from_arg_matches(&matches)
    };
    let format = format_of(&arguments);
    let error: clap::Error = match parsed(&arguments) {
        Ok(cli) => match named_twice(&arguments) {
            None => return Ok(Parsed { cli, format, added }),
            Some(path) => {
                let words = format!(
                    "{}: is specified twice, so that with --force the new file could replace one that is read; give the \
                     new file another name",
                    shown(&path)
                );
                return Err(Failure::usage(words).report(format));
            }
        },
        Err(error) => error,
    };
    let printed: Vec<OsString> =
        arguments.iter().map(|argument| printable(argument.to_string_lossy()).into()).collect();
    let mut refused = parsed(&printed).err();
    if let Some(refused) = &mut refused {
        // That an argument may be meant as a file, after `--`, is hardly ever true.
        refused.remove(ContextKind::Suggested);
    }
    if let Some(help) = refused.as_ref().filter(|error| !error.use_stderr()) {
        let written = output::own(&help::fitted(&help.render().ansi().to_string()));
        return Err(written.map_or_else(|failure| ExitCode::from(failure.code), |()| ExitCode::SUCCESS));
    }
    let advice = refused.as_ref().map(advice).unwrap_or_default();
    Failure::usage(words(refused.as_ref().unwrap_or(&error)) + &advice).print(format);
    match refused {
        Some(refused) => {
            output::usage(&help::fitted(&clearer(&refused.render().ansi().to_string())));
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
    let words = clearer(&error.render().to_string());
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
    let here = |option: &str, words: &str| match defaults::workspace() {
        Some(workspace) => {
            let file = shown(&workspace.root.join(WORKSPACE_FILE)).to_string();
            words.replace("specify a workspace", &format!("state `{}` in {file}", option.trim_start_matches('-')))
        }
        None => words.to_owned(),
    };
    let missing = MISSING.iter().filter(|(option, _)| is_missing(option));
    missing.map(|(option, words)| format!("\n{}", here(option, words))).collect()
}

/// Returns clap's words with its descriptions of numbers replaced by those that users know.
fn clearer(words: &str) -> String {
    let range = |line: &str| {
        let (before, range) = line.trim_end().split_once(" is not in ")?;
        let (first, last) = range.split_once("..=").or(range.split_once(".."))?;
        let (option, _) = before.rsplit_once(": ")?;
        let numbers = match last == u64::MAX.to_string() {
            true => format!("of {first} or more"),
            false => format!("from {first} to {last}"),
        };
        Some(format!("{option}: expected a whole number {numbers}\n"))
    };
    let words: String =
        words.split_inclusive('\n').map(|line| range(line).unwrap_or_else(|| line.to_owned())).collect();
    words
        .replace(": invalid digit found in string", ": expected a whole number")
        .replace(": invalid float literal", ": expected a number with a decimal point")
}

/// Returns the format that the arguments ask for, parsed or not: that of failures too.
fn format_of(arguments: &[OsString]) -> Format {
    let joined = arguments.iter().filter_map(|argument| argument.to_str()?.strip_prefix("--format="));
    let apart = arguments.windows(2).filter(|pair| pair[0] == "--format").filter_map(|pair| pair[1].to_str());
    joined.chain(apart).find_map(|format| Format::from_str(format, false).ok()).unwrap_or(Format::Text)
}
