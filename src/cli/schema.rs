//! `schema`: JSON Schemas of the formats, for editors.

use super::{Code, Failure, output};
use clap::{Args, ValueEnum};
use dtg_passport::schema;

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    Stand,
    Site,
    Gyro,
    Laboratory,
    Passport,
}

/// Print the JSON Schema of a format; of several, an object of them by name
#[derive(Args)]
pub struct Options {
    /// Formats
    #[arg(required = true, value_enum, value_delimiter = ',', value_name = "FORMAT")]
    formats: Vec<Kind>,
}

pub fn run(options: &Options) -> Result<Code, Failure> {
    let of = |kind: &Kind| match kind {
        Kind::Stand => ("stand", schema::stand()),
        Kind::Site => ("site", schema::site()),
        Kind::Gyro => ("gyro", schema::gyro()),
        Kind::Laboratory => ("laboratory", schema::laboratory()),
        Kind::Passport => ("passport", schema::passport()),
    };
    match options.formats.as_slice() {
        [one] => output::json(&of(one).1)?,
        several => {
            let all: std::collections::BTreeMap<_, _> = several.iter().map(of).collect();
            output::json(&all)?;
        }
    }
    Ok(0)
}
