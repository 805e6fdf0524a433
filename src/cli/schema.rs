//! Verb `schema`: JSON Schemas of the formats, for editors.

use super::{Code, Failure, output};
use crate::dcc::Administrative;
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::schema::{self, of_file};
use crate::site::Site;
use crate::stand::Stand;
use clap::{Args, ValueEnum};
use schemars::Schema;
use std::collections::BTreeMap;

/// Name of a format, and its schema.
type Format = (&'static str, fn() -> Schema);

const FORMATS: [Format; 7] = [
    ("stand", of_file::<Stand>),
    ("site", of_file::<Site>),
    ("gyro", of_file::<GyroType>),
    ("laboratory", of_file::<Laboratory>),
    ("dcc", of_file::<Administrative>),
    ("passport", schema::passport),
    ("register-file", schema::register_file),
];

/// Print the JSON Schema of a format (for several, an object with one for each name), or tables of its keys
#[derive(Args)]
pub(super) struct Options {
    /// Formats
    #[arg(required = true, value_parser = FORMATS.map(|(name, _)| name), value_delimiter = ',', value_name = "FORMAT")]
    formats: Vec<String>,
    /// Form of the description: JSON Schema for editors, or tables for reading
    #[arg(long, value_enum, default_value = "json")]
    format: Form,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Form {
    /// JSON Schema
    Json,
    /// Tables of keys in Markdown
    Markdown,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let of = |name: &String| FORMATS.iter().find(|(known, _)| known == name).map(|(_, schema)| schema());
    let schemas: Vec<Schema> = options.formats.iter().filter_map(of).collect();
    match (options.format, schemas.as_slice()) {
        (Form::Markdown, schemas) => output::result(&schema::tables(schemas))?,
        (Form::Json, [one]) => output::json(one)?,
        (Form::Json, several) => output::json(&options.formats.iter().zip(several).collect::<BTreeMap<_, _>>())?,
    }
    Ok(0)
}
