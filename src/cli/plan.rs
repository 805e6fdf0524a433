//! Verb `plan`: the best positions to certify, or of a certified stand's positions to read, and their order.

use super::options::{Instruments, Picture, Printed};
use super::{Code, Failure, defaults, inputs, output};
use crate::plan::candidates::Angles;
use crate::plan::criterion::Criterion;
use crate::plan::{FEWEST_READINGS, MOST_READINGS, Question, plan};
use crate::report::picture::plan as picture;
use crate::report::plan as report;
use clap::Args;
use std::path::PathBuf;

/// Find the best positions to certify or read, the number and order of visits, and the best azimuth of the frame's axis
#[derive(Args)]
pub(super) struct Options {
    /// Site file (dtg-site/1); in a workspace also the identifier of the site
    #[arg(long, value_name = "SITE", value_parser = defaults::site())]
    site: PathBuf,
    /// Certified stand (dtg-stand/1) from whose positions to choose; in a workspace also MODEL/SERIAL [default: the positions of --angles, without deviations]
    #[arg(long, value_name = "STAND", conflicts_with = "angles", value_parser = defaults::stand())]
    stand: Option<PathBuf>,
    #[command(flatten)]
    instruments: Instruments,
    /// Number of readings; each is one visit to a position
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = inputs::whole::<u32>(FEWEST_READINGS.into()..=MOST_READINGS.into()))]
    readings: u32,
    /// Nominal angles to choose from: quadrants, or a step in degrees for theta and phi
    #[arg(long, value_name = "quadrants|DEG", default_value = "quadrants", value_parser = angles)]
    angles: Angles,
    /// Azimuths of the frame's axis to choose from: east (90 degrees, as in the paper), north (0) [default: that of the site]
    #[arg(long, value_parser = ["east", "north"], value_name = "AXIS,...", value_delimiter = ',')]
    frame_axis: Vec<String>,
    /// Criterion by which plans are compared: the sum of (u/tolerance)² (a), the determinant of the covariance (d), or the
    /// largest u/tolerance (worst)
    #[arg(long, value_enum, value_name = "WHICH", default_value = "a")]
    criterion: Criterion,
    #[command(flatten)]
    _printed: Printed,
    #[command(flatten)]
    picture: Picture,
}

fn angles(text: &str) -> Result<Angles, String> {
    if text == "quadrants" {
        return Ok(Angles::QUADRANTS);
    }
    let step = text.parse().ok().and_then(Angles::every);
    step.ok_or_else(|| format!("expected quadrants, or {}", Angles::EXPECTED))
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let site = inputs::site(&options.site)?;
    let stand = options.stand.as_deref().map(inputs::stand).transpose()?;
    let (gyro, laboratory) = (options.instruments.gyro_or_usual()?, options.instruments.laboratory()?);
    let azimuth_deg = |axis: &String| if axis == "east" { 90.0 } else { 0.0 };
    let question = Question {
        site: &site,
        stand: stand.as_ref(),
        angles: options.angles,
        gyro: &gyro,
        laboratory: &laboratory,
        readings: options.readings,
        azimuths_deg: options.frame_axis.iter().map(azimuth_deg).collect(),
        criterion: options.criterion,
    };
    let found = plan(&question).map_err(Failure::refused)?;
    options.picture.save(|| Ok(picture::plan(&found, site.id.as_str())))?;
    let of_site = site.frame_axis_azimuth_deg();
    let assumed = options.instruments.assumed();
    let document = || report::document(&found, (site.id.as_str(), of_site), &gyro, assumed);
    output::show(|| &found, document)?;
    Ok(0)
}
