//! Verb `plan`: the best positions to certify, or of a certified stand's positions to read, and their order.

use super::lang::Lang;
use super::{Code, Failure, Format, defaults, inputs, output};
use crate::gyro::GyroType;
use crate::plan::candidates::Angles;
use crate::plan::criterion::Criterion;
use crate::plan::{FEWEST_READINGS, MOST_READINGS, Question, plan};
use crate::report::picture::plan as picture;
use crate::report::plan as report;
use clap::{Args, ValueEnum};
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
    /// Gyro type (dtg-gyro/1) [default: the paper's GVK-6]
    #[arg(long, value_name = "FILE")]
    gyro: Option<PathBuf>,
    /// Laboratory (dtg-laboratory/1) [default: the paper's meter, 0.015 %]
    #[arg(long, value_name = "FILE")]
    laboratory: Option<PathBuf>,
    /// Number of readings; each is one visit to a position
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = readings())]
    readings: u32,
    /// Nominal angles to choose from: quadrants, or a step in degrees for theta and phi
    #[arg(long, value_name = "quadrants|DEG", default_value = "quadrants", value_parser = angles)]
    angles: Angles,
    /// Azimuths of the frame's axis to choose from [default: that of the site]
    #[arg(long, value_enum, value_name = "AXIS,...", value_delimiter = ',')]
    frame_axis: Vec<FrameAxis>,
    /// Criterion by which plans are compared: the sum of (u/tolerance)² (a), the determinant of the covariance (d), or the
    /// largest u/tolerance (worst)
    #[arg(long, value_enum, value_name = "WHICH", default_value = "a")]
    criterion: Criterion,
    #[command(flatten)]
    _lang: Lang,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Write a picture of the plan
    #[arg(short, long, value_name = "FILE.svg", value_parser = output::path_of(output::PICTURE))]
    output: Option<PathBuf>,
    /// Replace an existing picture
    #[arg(long)]
    force: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum FrameAxis {
    /// 90 degrees, as in the paper
    East,
    /// 0 degrees
    North,
}

fn readings() -> clap::builder::RangedI64ValueParser<u32> {
    clap::value_parser!(u32).range(i64::from(FEWEST_READINGS)..=i64::from(MOST_READINGS))
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
    let gyro = inputs::gyro(options.gyro.as_deref())?.unwrap_or_else(GyroType::gvk_6);
    let laboratory = inputs::laboratory(options.laboratory.as_deref())?;
    let azimuth_deg = |axis: &FrameAxis| match axis {
        FrameAxis::East => 90.0,
        FrameAxis::North => 0.0,
    };
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
    if let Some(path) = &options.output {
        output::saved_too(path, picture::plan(&found, site.id.as_str()), options.force)?;
    }
    let of_site = site.frame_axis_azimuth_deg();
    let assumed = [options.gyro.is_none(), options.laboratory.is_none()];
    let document = || report::document(&found, (site.id.as_str(), of_site), &gyro, assumed);
    options.format.show(|| &found, document)?;
    Ok(0)
}
