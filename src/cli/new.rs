//! Verb `new`: templates of the hand-written files.

use super::options::{Force, Formatted};
use super::{Code, Failure, inputs, output};
use crate::earth::Place;
use crate::files;
use crate::interface::enquiry::place_of;
use crate::plan::document::Planned;
use crate::template::{self, Positions};
use crate::text::{Identifier, Printable, name_of, shown};
use clap::{Args, ValueEnum};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Write a commented template of a file
///
/// CHANGE stands for a value that only you know. No command accepts a value that is still CHANGE.
#[derive(Args)]
pub(super) struct Options {
    /// Kind of file
    #[arg(value_enum)]
    kind: Kind,
    /// Write the template to this file [default: standard output]
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
    /// Take the positions of a stand, header, readings or currents, and their order, from this plan (`plan --format json`)
    /// [default: the paper's eight]
    #[arg(long, value_name = "PLAN.json")]
    from_plan: Option<PathBuf>,
    /// Number of runs of readings [default: 5]
    #[arg(long, value_name = "N", value_parser = inputs::whole::<u32>(1..=100))]
    runs: Option<u32>,
    /// Place of a site: latitude and longitude in degrees, north and east positive
    #[arg(long, value_name = "LAT,LON", value_parser = place_of, allow_hyphen_values = true)]
    at: Option<Place>,
    /// Height of a site above the ellipsoid, metres
    #[arg(long, value_name = "H", value_parser = inputs::number("a height in metres", -500.0..=9000.0), allow_hyphen_values = true)]
    height_m: Option<f64>,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    _format: Formatted,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Certified stand (dtg-stand/1)
    Stand,
    /// Site (dtg-site/1)
    Site,
    /// Gyro type (dtg-gyro/1)
    Gyro,
    /// Laboratory (dtg-laboratory/1)
    Laboratory,
    /// Stand without angles, for `certify` (dtg-stand/1)
    Header,
    /// Angles for `certify` (CSV)
    Readings,
    /// Currents for `calibrate` (CSV)
    Currents,
    /// Administrative data of a Digital Calibration Certificate (dtg-dcc/1)
    Dcc,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    options.check()?;
    let expected = "the JSON of a plan, from `plan --format json`";
    let plan = options.from_plan.as_ref().map(|path| inputs::document(path, expected, Planned::from_json));
    let positions = Positions(plan.transpose()?);
    let text = match options.kind {
        Kind::Stand => template::stand(&positions),
        Kind::Header => template::header(&positions),
        Kind::Readings => template::readings(&positions, options.runs.unwrap_or(5)),
        Kind::Currents => template::currents(&positions),
        Kind::Gyro => template::GYRO.to_owned(),
        Kind::Laboratory => template::LABORATORY.to_owned(),
        Kind::Dcc => template::DCC.to_owned(),
        Kind::Site => template::site(&site_id(options.file.as_deref())?, options.at, options.height_m),
    };
    if let Some(path) = &options.file {
        files::write_replaceable(path, text.as_bytes(), options.force.replace)?;
        output::say(&format!("wrote {}; replace the values that its comments describe", shown(path)));
    }
    match (output::is_json(), &options.file) {
        (false, Some(_)) => {}
        (false, None) => output::own(&text)?,
        (true, Some(file)) => output::value(&json!({ "file": name_of(file) }))?,
        (true, None) => output::value(&json!({ "file": null, "template": text }))?,
    }
    Ok(0)
}

impl Options {
    /// Refuses options that the kind of file has no use for: their value would be lost without a word.
    fn check(&self) -> Result<(), Failure> {
        let has_positions = matches!(self.kind, Kind::Stand | Kind::Header | Kind::Readings | Kind::Currents);
        let is_site = self.kind == Kind::Site;
        let given = [
            ("--from-plan", "a stand, header, readings or currents", self.from_plan.is_some() && !has_positions),
            ("--runs", "readings", self.runs.is_some() && self.kind != Kind::Readings),
            ("--at", "a site", self.at.is_some() && !is_site),
            ("--height-m", "a site", self.height_m.is_some() && !is_site),
        ];
        match given.into_iter().find(|(_, _, wrong)| *wrong) {
            Some((option, kinds, _)) => Err(Failure::usage(format!("{option} is for {kinds}; omit it"))),
            None => Ok(()),
        }
    }
}

/// Returns the identifier of a site: the name of its file.
fn site_id(file: Option<&Path>) -> Result<String, Failure> {
    let Some(stem) = file.and_then(Path::file_stem) else { return Ok("my-site".to_owned()) };
    let stem = stem.to_string_lossy();
    Identifier::new(&stem).map(|id| id.to_string()).map_err(|found| {
        let found = Printable(found);
        Failure::usage(format!(
            "the name of the file is the identifier of the site: found {found}, expected ASCII letters, digits, '.', \
             '_' and '-'; use another name, such as moscow-bmstu.yaml"
        ))
    })
}
