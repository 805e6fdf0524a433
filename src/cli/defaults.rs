//! Options that are not given: from the environment, then from the workspace.
//!
//! A workspace is used only if `--workspace` or the environment names it, never because it is the current folder: a
//! folder from elsewhere must not choose whom to trust.

use super::failure::Failure;
use super::open_workspace::workspace;
use super::{help, open_workspace};
use crate::files;
use crate::interface;
use crate::site::Site;
use crate::stand::Stand;
use crate::text::{LARGEST_DOCUMENT_BYTES, misspelt, name_of, printable, shown};
use crate::workspace::{NoWorkspace, WORKSPACE_FILE, Workspace};
use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::parser::ValueSource;
use clap::{ArgMatches, Command};
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

/// Environment variables; the names are part of the interface.
const WORKSPACE_VARIABLE: &str = "DTG_PASSPORT_WORKSPACE";
const KEY_VARIABLE: &str = "DTG_PASSPORT_KEY";
const IDENTITY_VARIABLE: &str = "DTG_PASSPORT_IDENTITY";
const TRUST_VARIABLE: &str = "DTG_PASSPORT_TRUST";

/// Verbs whose `--out` is the folder of passports.
const WRITE_PASSPORTS: [&str; 3] = ["issue", "reissue", "recertify"];

/// Adds the options that are not given, and returns them in words.
pub(super) fn add(arguments: &mut Vec<OsString>) -> Result<Vec<String>, Failure> {
    // What this pass cannot parse, the next one refuses.
    let command = help::command();
    let Ok(matches) = command.clone().ignore_errors(true).try_get_matches_from(&*arguments) else {
        return Ok(Vec::new());
    };
    let folder =
        matches.get_one::<PathBuf>("workspace").cloned().or_else(|| variable(WORKSPACE_VARIABLE).map(Into::into));
    if let Some(folder) = &folder {
        open_workspace::set_folder(folder.clone());
    }
    // `init` and `receive` make a workspace, so the one that the environment names need not be there yet.
    let folder = folder.filter(|folder| match matches.subcommand_name() {
        Some("init") => false,
        Some("receive") => folder.join(WORKSPACE_FILE).exists(),
        _ => true,
    });
    let workspace = folder.map(|folder| Workspace::read(&folder).map_err(|error| no_workspace(&folder, error)));
    let workspace = workspace.transpose()?;
    let mut added: Vec<Added> = Vec::new();
    if let Some((verb, of_verb)) = matches.subcommand()
        && let Some(of_command) = command.find_subcommand(verb)
    {
        added.extend(values(workspace.as_ref(), verb).filter(|(option, ..)| lacks(of_command, of_verb, option)));
        let given = |id: &str| of_verb.value_source(id).is_some();
        let paths = workspace.as_ref().map(|workspace| match verb {
            "register" if !given("folder") && !given("passports") => vec![("", &workspace.passports)],
            "keygen" if !given("key") => vec![("", &workspace.key), ("--allowed-signers", &workspace.trust)],
            _ => Vec::new(),
        });
        let paths =
            paths.into_iter().flatten().filter(|(option, _)| option.is_empty() || lacks(of_command, of_verb, option));
        added.extend(paths.filter_map(|(option, path)| Some((option, path.clone()?.into(), FILE))));
    }
    let end = arguments.iter().position(|argument| argument == "--").unwrap_or(arguments.len());
    let options: Vec<OsString> = added.iter().map(|(option, value, _)| argument(option, value)).collect();
    arguments.splice(end..end, options);
    if let Some(workspace) = workspace {
        open_workspace::set(workspace);
    }
    let words = |(option, value, source): &Added| {
        let option = if option.is_empty() { "DIR" } else { option };
        format!("{option} {} (from {source})", shown(Path::new(value)))
    };
    Ok(added.iter().map(words).collect())
}

fn no_workspace(folder: &Path, error: NoWorkspace) -> Failure {
    match error {
        NoWorkspace::File(_) if folder.is_file() => {
            let is_its_file = folder.file_name().is_some_and(|name| name == WORKSPACE_FILE);
            let meant = is_its_file.then(|| format!("; {}", misspelt::question(shown(files::folder_of(folder)))));
            let meant = meant.unwrap_or_else(|| "; `init` makes a workspace".to_owned());
            Failure::unusable(format!("{}: found a file, expected the folder of a workspace{meant}", shown(folder)))
        }
        NoWorkspace::File(error) if error.is_missing() => Failure::unusable(format!(
            "{}: is not a workspace, because it has no dtg-passport.toml; check --workspace or {WORKSPACE_VARIABLE}, \
             or make a workspace with `init`",
            shown(folder)
        )),
        NoWorkspace::File(error) => Failure::from(error),
        NoWorkspace::Unreadable(error) => Failure::from(error),
    }
}

/// Returns an option with its value as one argument; without an option, the value alone.
fn argument(option: &str, value: &OsStr) -> OsString {
    if option.is_empty() {
        return value.to_owned();
    }
    let mut argument = OsString::from(option);
    argument.push("=");
    argument.push(value);
    argument
}

const ENVIRONMENT: &str = "the environment";
const FILE: &str = "the workspace";

/// Option, its value, and where the value comes from.
type Added = (&'static str, OsString, &'static str);

/// Returns the values that a verb's options have if they are not given.
fn values(workspace: Option<&Workspace>, verb: &str) -> impl Iterator<Item = Added> {
    let stated = |value: fn(&Workspace) -> Option<OsString>| workspace.and_then(value);
    let passports = || stated(|workspace| workspace.passports.clone().map(Into::into));
    let of_any_verb = [
        ("--key", KEY_VARIABLE, stated(|workspace| workspace.key.clone().map(Into::into))),
        ("--identity", IDENTITY_VARIABLE, stated(|workspace| workspace.identity.clone().map(Into::into))),
        ("--trust", TRUST_VARIABLE, stated(|workspace| workspace.trust.clone().map(Into::into))),
    ];
    let of_any_verb = of_any_verb.map(|(option, name, stated)| {
        let named = variable(name).map(|value| (option, value, ENVIRONMENT));
        named.or(stated.map(|value| (option, value, FILE)))
    });
    let calibrates = verb == "calibrate";
    let of_this_verb = [
        ("--at", calibrates || verb == "verify", stated(|workspace| workspace.at.clone().map(Into::into))),
        ("--laboratory", calibrates, stated(|workspace| workspace.laboratory.clone().map(Into::into))),
        ("--gyro", calibrates, stated(|workspace| workspace.gyro.clone().map(Into::into))),
        ("--out", WRITE_PASSPORTS.contains(&verb), passports()),
        ("--register-key", true, stated(|workspace| workspace.register_key.clone().map(Into::into))),
        // `register` has its folder without an option.
        ("--passports", verb != "register", passports()),
        // The file of a DCC states its language.
        ("--lang", verb != "export", stated(|workspace| workspace.lang.map(|language| language.tag().into()))),
        // Otherwise a passport that the workspace itself withdrew could be used in it.
        ("--register", true, passports()),
    ];
    let of_this_verb = of_this_verb.map(|(option, applies, value)| Some((option, value.filter(|_| applies)?, FILE)));
    of_any_verb.into_iter().chain(of_this_verb).flatten()
}

fn variable(name: &str) -> Option<OsString> {
    std::env::var_os(name).filter(|value| !value.is_empty())
}

/// Returns `true` if the verb has an option that is neither given nor excluded by another one.
fn lacks(command: &Command, matches: &ArgMatches, option: &str) -> bool {
    let found = command
        .get_arguments()
        .find(|argument| argument.get_long().is_some_and(|long| option.strip_prefix("--") == Some(long)));
    let given =
        |id: &str| matches.try_contains_id(id).is_ok() && matches.value_source(id) == Some(ValueSource::CommandLine);
    let excluded = ["--trust", "--register", "--at"].contains(&option) && given("no_verify")
        || option == "--register-key" && given("without_register");
    found.is_some_and(|argument| !given(argument.get_id().as_str()) && !excluded)
}

/// Parser of the path of a stand file; in a workspace also `MODEL/SERIAL`.
pub(super) fn stand() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| named(path, |workspace, name| workspace.stand(name), id_of_stand))
}

/// Parser of the path of a site file; in a workspace also the identifier of the site, or `*` for all of its sites.
pub(super) fn site() -> impl TypedValueParser<Value = PathBuf> {
    let find = |workspace: &Workspace, name: &str| match name {
        "*" => workspace.sites.clone(),
        _ => workspace.site(name),
    };
    let id = |name: &str, bytes: &[u8]| Some(Site::from_yaml(name, bytes).ok()?.id.to_string());
    PathBufValueParser::new().try_map(move |path| named(path, find, id))
}

/// Parser of the path of a passport; in a workspace also its identifier.
pub(super) fn passport() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(path_of_passport)
}

/// Returns the file that is meant as a passport.
///
/// # Errors
/// As of [`named`].
pub(super) fn path_of_passport(path: PathBuf) -> Result<PathBuf, String> {
    named(path, |workspace, name| workspace.passport(name), id_of_passport)
}

/// Parser of the path of a stand file or of a passport; in a workspace also what names one of them.
pub(super) fn certified() -> impl TypedValueParser<Value = PathBuf> {
    let find = |workspace: &Workspace, name: &str| workspace.stand(name).or_else(|| workspace.passport(name));
    let id = |name: &str, bytes: &[u8]| id_of_stand(name, bytes).or_else(|| id_of_passport(name, bytes));
    PathBufValueParser::new().try_map(move |path| named(path, find, id))
}

fn id_of_stand(name: &str, bytes: &[u8]) -> Option<String> {
    Some(Stand::from_yaml(name, bytes).ok()?.stand.id())
}

fn id_of_passport(name: &str, bytes: &[u8]) -> Option<String> {
    Some(interface::unverified(name, bytes).ok()?.0.passport.id)
}

/// Returns the file that a name means in the workspace, or the name as a path if that exists or the name means none.
///
/// The file need not exist: the message then names the nearest one of the workspace.
///
/// # Errors
/// Returns a message if the file, whose identifier is that of `id_of`, is for something else than its name says.
fn named(
    path: PathBuf,
    find: fn(&Workspace, &str) -> Option<PathBuf>,
    id_of: fn(&str, &[u8]) -> Option<String>,
) -> Result<PathBuf, String> {
    let begins_here = path.components().next().is_some_and(|first| Path::new(&first).symlink_metadata().is_ok());
    let found = || find(workspace()?, path.to_str()?).filter(|found| found.exists() || !begins_here);
    if path == Path::new("-") || path.symlink_metadata().is_ok() {
        return Ok(path);
    }
    let Some(found) = found() else { return Ok(path) };
    // What cannot be read is refused where it is used.
    let bytes = files::read(&found, LARGEST_DOCUMENT_BYTES).unwrap_or_default();
    match id_of(&name_of(&found), &bytes).filter(|id| path.as_os_str() != OsStr::new(id)) {
        Some(id) => Err(format!("found {} in {}; correct the file or its name", printable(&id), shown(&found))),
        None => Ok(found),
    }
}
