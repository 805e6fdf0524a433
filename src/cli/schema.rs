//! Verb `schema`: JSON Schemas of the formats and of results.

use super::{Code, Failure, output};
use crate::schema::{FORMATS, lists, schemas};
use clap::{Args, ValueEnum};
use serde_json::Value;
use std::collections::BTreeMap;

/// Print the JSON Schema of a format, or of the result that a verb prints as JSON (for several, an object with one for
/// each name), or lists of its keys
#[derive(Args)]
pub(super) struct Options {
    /// Formats, or verbs
    #[arg(required = true, value_parser = FORMATS, value_delimiter = ',', value_name = "FORMAT")]
    formats: Vec<String>,
    /// Form of the description: JSON Schema for editors, or lists for reading
    #[arg(long, value_enum, default_value = "json")]
    format: Form,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Form {
    /// JSON Schema
    Json,
    /// Lists of keys in Markdown
    Markdown,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let schemas = schemas().map_err(Failure::unusable)?;
    let asked: Vec<&Value> = options.formats.iter().filter_map(|name| schemas.get(name)).collect();
    match (options.format, asked.as_slice()) {
        (Form::Markdown, asked) => output::result(&lists(asked))?,
        (Form::Json, [one]) => output::json(one)?,
        (Form::Json, several) => output::json(&options.formats.iter().zip(several).collect::<BTreeMap<_, _>>())?,
    }
    Ok(0)
}
