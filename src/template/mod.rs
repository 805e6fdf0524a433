//! Commented templates of the hand-written files, which their own readers accept as they are.
//!
//! A line with `CHANGE` has a value that the program cannot know.

mod positions;

use crate::certification::NominalPosition;
use crate::coefficients::{EarthRate, PositionIndex, SingularPositions, StandGeometry};
use crate::earth::{
    NORMAL_GRAVITY_U_M_PER_S2, NORMAL_GRAVITY_WITHOUT_HEIGHT_U_M_PER_S2, Place, normal_gravity_m_per_s2,
};
use crate::gyro::GyroType;
pub(crate) use positions::Positions;
use std::fmt::Write;

/// First lines of a stand file and of a header, up to the measured numbers.
const STAND: &str = r#"format: "dtg-stand/1"
stand:
  manufacturer: "CHANGE"
  model: "MODEL"                     # CHANGE
  serial: "0000"                     # CHANGE; both are names of folders too: letters, digits, '.', '_' and '-'
  configuration: "A"
  # name: "Two-axis test stand"
  # customer: "…"
certificate:
  number: "C-0000"                   # CHANGE; a number is never used for other angles
  issued: "2026-01-01"               # CHANGE; UTC date, as year, month, day
  # performed: "2025-12-20"
  # valid_until: "2027-12-31"        # inclusive; without it the user decides when to recertify
  # valid_until_basis: "agreed with the customer"
  laboratory: "CHANGE"
  # address: "…"
  # authorized_by: "…"
  # accreditation: "…"
  method: "CHANGE: instruments, set-up, number of runs"
  traceability: "CHANGE: certificates of the instruments"
  # temperature_c: 20.0
  # temperature_range_c: [18.0, 22.0]
"#;

/// Type B components and datum of both.
const TYPE_B_AND_DATUM: &str = r#"  # type_b:                          # what repeating cannot show; each line is also part of u_* or common_*
  #   - {source: "autocollimator, calibration C-17", acts_on: "position", u_arcsec: 0.3}
datum:                               # CHANGE; the surfaces that realise the axes on this stand
  level: "CHANGE: surface that is levelled"
  azimuth: "CHANGE: surface or mirror that faces north"
  gyro_seat: "CHANGE: surface and pins that locate the gyro"
"#;

/// Returns a stand file with all deviations 0.
pub(crate) fn stand(positions: &Positions) -> String {
    let rest = ", alpha_arcsec: 0.0, beta_arcsec: 0.0, gamma_arcsec: 0.0";
    format!(
        "# Certified stand (dtg-stand/1). `certify` writes such a file from readings; write one by hand only if the\n\
         # deviations were found otherwise. Replace every CHANGE and every 0.0; delete the lines that do not apply.\n\
         {STAND}  \
         # repeatability_arcsec: 1.5        # standard deviation of one return to a position, per axis\n  \
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

/// Returns a table of angles for `certify`. They are arbitrary and scatter from run to run far more than any stand, so
/// that `certify` reports one that was not replaced as an outlier.
pub(crate) fn readings(positions: &Positions, runs: u32) -> String {
    let mut text = String::from(
        "# Angles for `certify`: deviation of the actual from the nominal orientation, in arcseconds.\n\
         # Replace every angle: these are arbitrary, and scatter so much that a forgotten one is found.\n\
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
        for (place, PositionIndex { i, j }) in (0..).zip(&order) {
            let [x, y, z] = [0, 1, 2].map(|axis: u32| (37 * run + 17 * place + 29 * axis) % 101);
            // Writing into a string cannot fail.
            let _ = writeln!(text, "{i},{j},{run},{x},{y},{z}");
        }
    }
    text
}

/// Latitude at which the currents of the template are computed, degrees.
const EXAMPLE_LATITUDE_DEG: f64 = 45.0;

/// Returns a table of currents for `calibrate`, with those of the paper's gyro on an ideal stand at 45° latitude.
///
/// # Errors
/// Returns [`SingularPositions`] if the positions have no coefficients; those of [`Positions`] have.
pub(crate) fn currents(positions: &Positions) -> Result<String, SingularPositions> {
    let all: Vec<_> = positions.nominal().iter().map(|at| at.with_angles([0.0; 3]).to_model()).collect();
    let mut earth = EarthRate::at_astronomic_latitude(EXAMPLE_LATITUDE_DEG);
    let azimuth_deg = positions.frame_axis_azimuth_deg();
    earth.frame_axis_azimuth_deg = azimuth_deg.unwrap_or(earth.frame_axis_azimuth_deg);
    let gyro = GyroType::gvk_6().nominal.to_model();
    let mut text = String::from(
        "# Currents for `calibrate`, in milliamperes: mean of each axis in each position.\n\
         # Replace every current: these are the exact ones of the paper's gyro on an ideal stand at 45 degrees.\n\
         # Further columns, if you have them: cycle (turn-on of the gyro), visit (arrival at the position), time_s.\n\
         # Read a position again in further rows; give them another visit if the stand was moved in between.\n",
    );
    if let Some(azimuth_deg) = azimuth_deg {
        let _ = writeln!(
            text,
            "# The rows are in the order of the plan, which is for a frame's axis at azimuth {azimuth_deg} degrees."
        );
    }
    text.push_str(if azimuth_deg.is_some() { "i,j,visit,jx_ma,jy_ma\n" } else { "i,j,jx_ma,jy_ma\n" });
    let coefficients = StandGeometry::new(&all)?.at(earth);
    let mut visited: Vec<PositionIndex> = Vec::new();
    for index in positions.visits().iter().map(NominalPosition::index) {
        visited.push(index);
        let visit = visited.iter().filter(|at| **at == index).count();
        let visit = if azimuth_deg.is_some() { format!("{visit},") } else { String::new() };
        let current = coefficients.positions.iter().find(|at| at.index == index).and_then(|at| gyro.currents_ma(at));
        if let Some(current) = current {
            let PositionIndex { i, j } = index;
            let _ = writeln!(text, "{i},{j},{visit}{:.7},{:.7}", current.x, current.y);
        }
    }
    Ok(text)
}

/// Place of the example site, if none is given: that of the paper.
const EXAMPLE: Place = Place { latitude_deg: 55.7658, longitude_deg: 37.6856 };

/// Returns a site file with the identifier `id`; `place` and `height_m` (above the ellipsoid) are filled in if known.
pub(crate) fn site(id: &str, place: Option<Place>, height_m: Option<f64>) -> String {
    let change = if place.is_some() { "" } else { "CHANGE; " };
    let Place { latitude_deg, longitude_deg } = place.unwrap_or(EXAMPLE);
    let gravity = normal_gravity_m_per_s2(latitude_deg, height_m.unwrap_or(0.0));
    let (height, u, at_height) = match height_m {
        Some(height) => (format!("height_m: {height:?}"), NORMAL_GRAVITY_U_M_PER_S2, "this height"),
        None => ("# height_m: 150.0".to_owned(), NORMAL_GRAVITY_WITHOUT_HEIGHT_U_M_PER_S2, "0 m"),
    };
    let number = |text: &str| format!("{text:<36} ");
    let lines = [
        "# Site (dtg-site/1). Replace every CHANGE, and survey what you can: what is absent is taken as stated here,\n\
         # and the passport lists its effect.\n\
         format: \"dtg-site/1\"\n"
            .to_owned(),
        number(&format!("id: \"{id}\"")) + "# also the name of the file\n",
        "# name: \"…\"\n".to_owned(),
        number(&format!("latitude_deg: {latitude_deg:?}")) + "# " + change + "geodetic, WGS 84, north positive\n",
        number(&format!("longitude_deg: {longitude_deg:?}")) + "# " + change + "east positive\n",
        number(&height) + "# above the ellipsoid (a satellite receiver shows it; a map shows another)\n",
        "# Survey: deflection of the vertical, from the national geodetic service. Unknown: 0 with u = 10 arcsec.\n\
         # deflection_arcsec: {xi: -3.2, eta: 4.1, u: 1.0}\n"
            .to_owned(),
        format!(
            "# Survey: gravity. As long as this is a comment, normal gravity applies: {gravity:.5} m/s2 for this\n\
             # latitude and {at_height}, with a standard uncertainty of {u} m/s2.\n\
             # gravity_m_per_s2: {gravity:.5}\n\
             # gravity_u_m_per_s2: {u}\n"
        ),
        "# Survey: azimuth mark, which defines north; both points geodetic. Or another reference, in `uncertainty`.\n\
         # azimuth_mark: {name: \"…\", latitude_deg: …, longitude_deg: …, pillar_latitude_deg: …, \
         pillar_longitude_deg: …, position_u_m: 0.02}\n\
         # Standard uncertainties of the base as set up here: latitude; from the mark to the base; level per axis.\n\
         # uncertainty: {latitude_arcsec: 1.0, azimuth_arcsec: 30.0, level_arcsec: 5.0}\n\
         # Azimuth of the frame's axis, clockwise from north, if it does not point east:\n\
         # frame_axis_azimuth_deg: 90.0\n\
         # Change of the Earth-rate components that limits the distance from here at which the passport may be used:\n\
         # valid_within_deg_per_h: 0.001\n"
            .to_owned(),
        "source: \"CHANGE: where the numbers come from\"\n".to_owned(),
    ];
    lines.concat()
}

pub(crate) const GYRO: &str = r#"# Gyro type (dtg-gyro/1). The numbers are those of the paper's gyro; replace them by those of the type.
format: "dtg-gyro/1"
type: "GVK-6"                        # CHANGE
nominal:
  k_deg_per_h_per_ma: [[95, 9.5], [9.5, 95]]    # [[K_x, K_xy], [K_yx, K_y]]
  omega0_deg_per_h: [20, 20]         # constant drift, x and y
  omega_g_deg_per_h_per_g: 10        # g-sensitive drift
  omega_k_deg_per_h_per_g: 10
tolerance:                           # largest permitted deviations from the nominal values
  k_main_percent: 0.05               # of K_x and K_y
  k_cross_percent: 0.5               # of K_xy and K_yx
  omega0_deg_per_h: 0.01
  omega_g_deg_per_h_per_g: 0.01
  omega_k_deg_per_h_per_g: 0.01
# gravity_m_per_s2: 9.80665          # the g to which the drifts refer
# noise: {visit_deg_per_h: 0.001, turn_on_deg_per_h: 0.005}    # of the drift, from visit to visit and between turn-ons
"#;

pub(crate) const LABORATORY: &str = r#"# Laboratory (dtg-laboratory/1). All numbers but the range are standard uncertainties (k = 1): divide the limits of a
# data sheet by 1.73. Replace them by those of your meter, gyro seat and base.
format: "dtg-laboratory/1"
name: "CHANGE"
meter:
  range_ma: 1.0                      # largest current in either direction
  reading_percent: 0.0087            # of the reading; own of every position and channel
  gain_percent: 0.0                  # of the reading; common to all readings
  offset_ma: 0.0                     # common to all readings
  floor_ma: 1.0e-06                  # independent of the reading
  # noise_ma: 0.0                    # own of every reading; absent: estimated from repeated rows, else 0
seating_arcsec:                      # of the gyro on the platform
  about_x: 5.0
  about_y: 5.0
  about_z: 10.0
# base: {azimuth_arcsec: 10.0, level_arcsec: 3.0}    # replaces the site's, if you measured it
# temperature_c: 21.0
"#;

pub(crate) const DCC: &str = r#"# Administrative data of a Digital Calibration Certificate (dtg-dcc/1): what PTB's format demands and no passport states.
# Replace every CHANGE; delete the lines that do not apply. What the passport states is not repeated here.
format: "dtg-dcc/1"
# country: "DE"                      # CHANGE; where the certificate is issued: two letters of ISO 3166-1
language: "en"                       # the mandatory language: en or ru
# location: "laboratory"             # CHANGE; of the measurements: laboratory, customer, laboratoryBranch, customerBranch, other
laboratory:
  city: "CHANGE"
  # name: "CHANGE"                   # for a gyro, unless its laboratory file states it
  # street: "CHANGE"
  # street_no: "1"
  # post_code: "00000"
  # country: "DE"
  # email: "laboratory@example.org"
  # phone: "+00 000 0000"
customer:
  name: "CHANGE"
  city: "CHANGE"
responsible: ["CHANGE"]              # besides the person who authorised the certificate
# performed: {from: "2026-01-01", to: "2026-01-02"}    # if the passport does not state the day, or it was several
# method: "CHANGE"                   # if the passport states none
# temperature_c: 20.0                # if the passport states none
# traceable: true                    # the certificate's traceability is a chain of calibrations to the SI
# number: "G-0000"                   # of the certificate of a gyro; that of a stand is in its passport
# issued: "2026-01-03"
"#;
