//! Commented templates of the hand-written files, which their own readers accept but for `CHANGE`: a value that the program
//! cannot know.

mod positions;

use crate::certification::NominalPosition;
use crate::coefficients::PositionIndex;
use crate::earth::{
    NORMAL_GRAVITY_U_M_PER_S2, NORMAL_GRAVITY_WITHOUT_HEIGHT_U_M_PER_S2, Place, STANDARD_GRAVITY_M_PER_S2,
    normal_gravity_m_per_s2,
};
pub(crate) use positions::Positions;
use std::fmt::Write;

/// First lines of a stand file and of a header, up to the measured numbers.
const STAND: &str = include_str!("certificate.yaml");

/// Type B components and datum of both.
const TYPE_B_AND_DATUM: &str = include_str!("datum.yaml");

/// Returns a stand file, whose deviations are to be entered.
pub(crate) fn stand(positions: &Positions) -> String {
    let rest = ", alpha_arcsec: CHANGE, beta_arcsec: CHANGE, gamma_arcsec: CHANGE";
    format!(
        "# Certified stand (dtg-stand/1). `certify` writes such a file from readings; write one by hand only if the\n\
         # deviations were found otherwise. Replace every CHANGE; delete the lines that do not apply.\n\
         {STAND}  \
         # repeatability_arcsec: 1.5        # standard deviation of one visit to a position, per axis\n  \
         # common_platform_arcsec: 0.8      # uncertainty shared by all positions, per axis of the platform\n  \
         # common_base_arcsec: 0.8          # the same, per axis of the base\n\
         {TYPE_B_AND_DATUM}\
         # Deviations of the actual from the nominal orientation. Add to each position, if known, its own standard\n\
         # uncertainty: u_alpha_arcsec: 1.2, u_beta_arcsec: 1.2, u_gamma_arcsec: 2.0\n\
         {}positions:\n{}",
        positions.remark(),
        positions.rows(rest)
    )
}

/// Returns a header for `certify`: a stand file whose positions have no deviations yet.
pub(crate) fn header(positions: &Positions) -> String {
    format!(
        "# Header of a certification (dtg-stand/1): the stand and its certificate, before the deviations are measured.\n\
         # Replace every CHANGE; delete the lines that do not apply. `certify` adds all measured numbers.\n\
         {STAND}{TYPE_B_AND_DATUM}{}positions:\n{}",
        positions.remark(),
        positions.rows("")
    )
}

/// Returns a table of angles for `certify`.
pub(crate) fn readings(positions: &Positions, runs: u32) -> String {
    let mut text = String::from(
        "# Angles for `certify`: deviation of the actual from the nominal orientation, in arcseconds. Replace every CHANGE.\n\
         # Measure every position in every run, and move the platform away and back between the runs.\n\
         i,j,run,alpha_arcsec,beta_arcsec,gamma_arcsec\n",
    );
    let mut order: Vec<PositionIndex> = Vec::new();
    for index in positions.visits().iter().map(NominalPosition::index) {
        if !order.contains(&index) {
            order.push(index);
        }
    }
    for run in 1..=runs {
        for PositionIndex { i, j } in &order {
            // Writing into a string cannot fail.
            let _ = writeln!(text, "{i},{j},{run},CHANGE,CHANGE,CHANGE");
        }
    }
    text
}

/// Returns a table of currents for `calibrate`.
pub(crate) fn currents(positions: &Positions) -> String {
    let mut text = String::from(
        "# Currents for `calibrate`, in milliamperes: mean of each axis in each position. Replace every CHANGE.\n\
         # Further columns, if you have them: cycle (turn-on of the gyro), visit (arrival at the position), time_s.\n\
         # Read a position again in further rows; give them another visit if the stand was moved in between.\n",
    );
    let azimuth_deg = positions.frame_axis_azimuth_deg();
    if let Some(azimuth_deg) = azimuth_deg {
        let _ = writeln!(
            text,
            "# The rows are in the order of the plan, which is for a frame's axis at azimuth {azimuth_deg} degrees."
        );
    }
    text.push_str(if azimuth_deg.is_some() { "i,j,visit,jx_ma,jy_ma\n" } else { "i,j,jx_ma,jy_ma\n" });
    let mut visited: Vec<PositionIndex> = Vec::new();
    for index in positions.visits().iter().map(NominalPosition::index) {
        visited.push(index);
        let visit = visited.iter().filter(|at| **at == index).count();
        let visit = if azimuth_deg.is_some() { format!("{visit},") } else { String::new() };
        let PositionIndex { i, j } = index;
        let _ = writeln!(text, "{i},{j},{visit}CHANGE,CHANGE");
    }
    text
}

/// Returns a site file with the identifier `id`; `place` and `height_m` (above the ellipsoid) are filled in if known.
pub(crate) fn site(id: &str, place: Option<Place>, height_m: Option<f64>) -> String {
    let coordinate =
        |of: fn(Place) -> f64| place.map_or_else(|| "CHANGE".to_owned(), |place| format!("{:?}", of(place)));
    let (height, u, at_height) = match height_m {
        Some(height) => (format!("height_m: {height:?}"), NORMAL_GRAVITY_U_M_PER_S2, "this height"),
        None => ("# height_m: 150.0".to_owned(), NORMAL_GRAVITY_WITHOUT_HEIGHT_U_M_PER_S2, "0 m"),
    };
    let gravity = place.map_or(STANDARD_GRAVITY_M_PER_S2, |place| {
        normal_gravity_m_per_s2(place.latitude_deg, height_m.unwrap_or(0.0))
    });
    let values = [
        ("{id}", id.to_owned()),
        ("{latitude_deg}", coordinate(|place| place.latitude_deg)),
        ("{longitude_deg}", coordinate(|place| place.longitude_deg)),
        ("{height}", height),
        ("{at_height}", at_height.to_owned()),
        ("{gravity}", format!("{gravity:.5}")),
        ("{u}", u.to_string()),
    ];
    let line = |line: &str| {
        let filled = values.iter().fold(line.to_owned(), |filled, (name, value)| filled.replace(name, value));
        match filled.split_once(" # ").filter(|_| filled != line) {
            Some((value, comment)) => format!("{value:<36} # {comment}\n"),
            None => filled + "\n",
        }
    };
    SITE.lines().map(line).collect()
}

/// Site file with names of values in braces.
const SITE: &str = include_str!("site.yaml");

pub(crate) const GYRO: &str = include_str!("gyro.yaml");

pub(crate) const LABORATORY: &str = include_str!("laboratory.yaml");

pub(crate) const DCC: &str = include_str!("dcc.yaml");
