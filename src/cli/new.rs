//! Verb `new`: templates of the hand-written files.

use super::trust_options::place;
use super::{Code, Failure, inputs, output};
use crate::earth::Place;
use crate::plan::document::Planned;
use crate::template::{self, Positions};
use crate::text::{Identifier, Printable, shown};
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

/// Write a commented template of a file
///
/// Lines with CHANGE have a value that only you know. Every template is accepted by its reader as it is.
#[derive(Args)]
pub(super) struct Options {
    /// Kind of file
    #[arg(value_enum)]
    kind: Kind,
    /// File to write [default: standard output]
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
    /// Number of positions of a stand, header, readings or currents: the paper's 8, four of them, or 16 more
    #[arg(long, value_enum, default_value = "8")]
    positions: Count,
    /// Plan whose positions a stand, header, readings or currents get, in its order (from `plan --format json`)
    #[arg(long, value_name = "PLAN.json", conflicts_with = "positions")]
    from_plan: Option<PathBuf>,
    /// Number of runs of readings
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=100))]
    runs: u32,
    /// Place of a site: latitude and longitude in degrees, north and east positive
    #[arg(long, value_name = "LAT,LON", value_parser = place, allow_hyphen_values = true)]
    at: Option<Place>,
    /// Height of a site above the ellipsoid, metres
    #[arg(long, value_name = "H", value_parser = height, allow_hyphen_values = true)]
    height_m: Option<f64>,
    /// Replace an existing file
    #[arg(long)]
    force: bool,
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

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Count {
    #[value(name = "4")]
    Four,
    #[value(name = "8")]
    Eight,
    #[value(name = "24")]
    TwentyFour,
}

impl From<Count> for Positions {
    fn from(count: Count) -> Self {
        match count {
            Count::Four => Self::Four,
            Count::Eight => Self::Eight,
            Count::TwentyFour => Self::TwentyFour,
        }
    }
}

fn height(text: &str) -> Result<f64, String> {
    let height = text.parse().ok().filter(|height| (-500.0..=9000.0).contains(height));
    height.ok_or_else(|| "a height from -500 to 9000 metres, with a decimal point".to_owned())
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let has_positions = matches!(options.kind, Kind::Stand | Kind::Header | Kind::Readings | Kind::Currents);
    if options.from_plan.is_some() && !has_positions {
        return Err(Failure::usage("--from-plan is for a stand, header, readings or currents; omit it"));
    }
    let positions = match &options.from_plan {
        None => options.positions.into(),
        Some(path) => Positions::Planned(inputs::document(path, Planned::from_json)?),
    };
    let text = match options.kind {
        Kind::Stand => template::stand(&positions),
        Kind::Header => template::header(&positions),
        Kind::Readings => template::readings(&positions, options.runs),
        Kind::Currents => template::currents(&positions).map_err(Failure::refused)?,
        Kind::Gyro => template::GYRO.to_owned(),
        Kind::Laboratory => template::LABORATORY.to_owned(),
        Kind::Dcc => template::DCC.to_owned(),
        Kind::Site => template::site(&site_id(options.file.as_deref())?, options.at, options.height_m),
    };
    let Some(path) = &options.file else { return output::own(&text).map(|()| 0) };
    output::file(path, &text, options.force)?;
    output::say(&format!("wrote {}; replace the values that its comments name", shown(path)));
    Ok(0)
}

/// Returns the identifier of a site: the name of its file.
fn site_id(file: Option<&Path>) -> Result<String, Failure> {
    let Some(stem) = file.and_then(Path::file_stem) else { return Ok("my-site".to_owned()) };
    let stem = stem.to_string_lossy();
    Identifier::new(&stem).map(|id| id.to_string()).map_err(|found| {
        let found = Printable(found);
        Failure::usage(format!("the name of the file is the identifier of the site: found {found}; use another name"))
    })
}
