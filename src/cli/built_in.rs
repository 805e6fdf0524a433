//! Verbs that print or write what the program contains: reference cases, JSON Schemas, completions, manual pages.

use super::options::{Force, Formatted};
use super::{Code, Failure, REFUSED, output};
use crate::files::together::write_replaceable_together;
use crate::report::selftest as report;
use crate::schema::{FORMATS, lists, schemas};
use crate::selftest;
use crate::text::{name_of, shown};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Compare the computations on this machine with published reference cases
#[derive(Args)]
pub(super) struct Selftest {
    #[command(flatten)]
    _format: Formatted,
}

pub(super) fn selftest(_: &Selftest) -> Result<Code, Failure> {
    let cases = selftest::run();
    output::write(|| report::to_json(&cases), || report::text(&cases))?;
    Ok(if cases.iter().all(selftest::Case::passed) { 0 } else { REFUSED })
}

/// Print the JSON Schema of a format, or of the result that a verb prints as JSON (for several, an object with one for
/// each name), or lists of its keys
#[derive(Args)]
pub(super) struct Schema {
    /// Formats, or verbs
    #[arg(required = true, value_parser = FORMATS, value_delimiter = ',', value_name = "FORMAT")]
    formats: Vec<String>,
    /// Form of the description: JSON Schema for editors, or lists for reading
    #[arg(long, value_enum, default_value = "json")]
    format: Form,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Form {
    /// JSON Schema
    Json,
    /// Lists of keys in Markdown
    Markdown,
}

pub(super) fn schema(options: &Schema) -> Result<Code, Failure> {
    let schemas = schemas().map_err(Failure::unusable)?;
    let asked: Vec<&Value> = options.formats.iter().filter_map(|name| schemas.get(name)).collect();
    match (options.format, asked.as_slice()) {
        (Form::Markdown, asked) => output::result(&lists(asked))?,
        (Form::Json, [one]) => output::json(one)?,
        (Form::Json, several) => output::json(&options.formats.iter().zip(several).collect::<BTreeMap<_, _>>())?,
    }
    Ok(0)
}

/// Name of each shell, and its script, as tests/generated.rs makes it.
const SCRIPTS: [(&str, &str); 5] = [
    ("bash", include_str!("generated/bash")),
    ("elvish", include_str!("generated/elvish")),
    ("fish", include_str!("generated/fish")),
    ("powershell", include_str!("generated/powershell")),
    ("zsh", include_str!("generated/zsh")),
];

/// Print the completion script for a shell
#[derive(Args)]
pub(super) struct Completions {
    /// Shell
    #[arg(value_parser = SCRIPTS.map(|(name, _)| name))]
    shell: String,
}

pub(super) fn completions(options: &Completions) -> Result<Code, Failure> {
    let script = SCRIPTS.iter().find(|(name, _)| *name == options.shell);
    output::own(script.map_or("", |(_, script)| script))?;
    Ok(0)
}

/// Manual pages, as tests/generated.rs makes them: each after a comment with its name.
const PAGES: &str = include_str!("generated/man");

/// Write the manual pages, one for each command, into a folder
#[derive(Args)]
pub(super) struct Man {
    /// Folder for the pages, such as ~/.local/share/man/man1
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    _format: Formatted,
}

pub(super) fn man(options: &Man) -> Result<Code, Failure> {
    let pages = PAGES.split(".\\\" ").filter_map(|page| page.split_once('\n'));
    let file = |(name, page)| (options.folder.join(format!("{name}.1")), page);
    let pages: Vec<(PathBuf, &str)> = pages.map(file).collect();
    // All or none: the page of an older version would contradict the others.
    write_replaceable_together(&pages, options.force.replace)?;
    output::say(&format!("wrote {} pages to {}", pages.len(), shown(&options.folder)));
    if output::is_json() {
        output::value(&json!({ "pages": pages.iter().map(|(path, _)| name_of(path)).collect::<Vec<_>>() }))?;
    }
    Ok(0)
}
