//! Verb `schema`: JSON Schemas of the formats, for editors.

use super::{Code, Failure, output};
use crate::dcc::Administrative;
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::schema::{self, of_file};
use crate::site::Site;
use crate::stand::Stand;
use clap::{Args, ValueEnum};

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    Stand,
    Site,
    Gyro,
    Laboratory,
    Dcc,
    Passport,
    Revocation,
}

/// Print the JSON Schema of a format (for several, an object with one for each name), or tables of its keys
#[derive(Args)]
pub(super) struct Options {
    /// Formats
    #[arg(required = true, value_enum, value_delimiter = ',', value_name = "FORMAT")]
    formats: Vec<Kind>,
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
    let of = |kind: &Kind| match kind {
        Kind::Stand => ("stand", of_file::<Stand>()),
        Kind::Site => ("site", of_file::<Site>()),
        Kind::Gyro => ("gyro", of_file::<GyroType>()),
        Kind::Laboratory => ("laboratory", of_file::<Laboratory>()),
        Kind::Dcc => ("dcc", of_file::<Administrative>()),
        Kind::Passport => ("passport", schema::passport()),
        Kind::Revocation => ("revocation", schema::revocation()),
    };
    if options.format == Form::Markdown {
        let schemas: Vec<_> = options.formats.iter().map(|kind| of(kind).1).collect();
        return output::result(&schema::tables(&schemas)).map(|()| 0);
    }
    match options.formats.as_slice() {
        [one] => output::json(&of(one).1)?,
        several => {
            let all: std::collections::BTreeMap<_, _> = several.iter().map(of).collect();
            output::json(&all)?;
        }
    }
    Ok(0)
}
