//! Comments of a passport: units, equations, missing statements and their effects. The signature covers them; programs
//! ignore them.

use super::content::Content;
use crate::attitude::PAPER_FRAME_AXIS_AZIMUTH_DEG;
use crate::site::{LATITUDE_MARGIN_ARCSEC, SiteUncertainty, UNKNOWN_DEFLECTION_U_ARCSEC};
use crate::stand::{Certificate, CertifiedPosition, Datum, Stand};
use crate::text::{canonical, number};
use crate::{earth, units};

/// Writes the payload of a passport: its content in canonical form, with its comments.
#[cfg(any(test, feature = "fuzzing"))]
pub(crate) fn payload(content: &Content) -> String {
    canonical::write(content, &|path| comments(content, path))
}

/// Writes the part of the payload that is the same at every site: the keys of [`Stand`].
pub(crate) fn payload_of_stand(stand: &Stand, has_matrices: bool) -> String {
    let absent = absent_of_certificate(&stand.certificate, &stand.positions, stand.datum.as_ref(), has_matrices);
    let comments = |path: &str| lines(path, if path == "certificate" { sentences(&absent) } else { Vec::new() });
    canonical::write(stand, &comments)
}

/// Writes the payload of a passport, given the part that [`payload_of_stand`] wrote.
pub(crate) fn payload_with(content: &Content, of_stand: &str) -> String {
    let mut text = String::with_capacity(2 * of_stand.len() + 6000);
    let comments = |path: &str| comments(content, path);
    canonical::write_some(&mut text, content, &comments, &|key| matches!(key, "format" | "passport"));
    text.push_str(of_stand);
    let others = |key: &str| !matches!(key, "format" | "passport" | "stand" | "certificate" | "datum" | "positions");
    canonical::write_some(&mut text, content, &comments, &others);
    text
}

/// Statement that is missing in a passport because its input was not given. Displayed, it is a sentence in ASCII with the
/// effect.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub(crate) enum Absence {
    #[error("The certificate gives no uncertainty of the deviations (u_alpha_arcsec etc.); it cannot be stated.")]
    Uncertainty,
    #[error(
        "The certificate gives no uncertainty of {missing} of the {all} deviations (u_alpha_arcsec etc.), which count as \
         exact."
    )]
    SomeUncertainty {
        /// Number of deviations without an uncertainty.
        missing: usize,
        /// Number of all deviations.
        all: usize,
    },
    #[error("The certificate gives no repeatability; the uncertainty that positioning adds is unknown.")]
    Repeatability,
    #[error("The certificate does not give the uncertainty common to all positions for both platform and base.")]
    CommonPart,
    #[error("No traceability is stated; the deviations are not shown to be traceable to the SI.")]
    Traceability,
    /// Temperature, during the measurement or for use.
    #[error("The certificate gives no temperature; the validity of the deviations at other temperatures is unknown.")]
    Temperature,
    #[error("The certificate has no expiry date; the user sets the recertification interval.")]
    LastDay,
    #[error(
        "No datum surfaces are stated; the surfaces for levelling, for north alignment and for seating the gyro are \
         unknown."
    )]
    Datum,
    #[error(
        "Some of the eight standard positions are not certified; there are no matrices, and only least squares applies."
    )]
    EightPositions,
    #[error(
        "The deflection of the vertical is unknown; it is taken as 0 with u = {UNKNOWN_DEFLECTION_U_ARCSEC} arcsec, \
         which adds up to {cost_deg_per_h:.1e} deg/h to the Earth-rate components."
    )]
    Deflection {
        /// Largest change of the Earth-rate components for a deflection of `UNKNOWN_DEFLECTION_U_ARCSEC`, deg/h.
        cost_deg_per_h: f64,
    },
    #[error("The longitude is unknown; only the latitude of a place can be checked.")]
    Longitude,
    #[error("The geodetic latitude is unknown; the check of the place allows {LATITUDE_MARGIN_ARCSEC} arcsec for it.")]
    GeodeticLatitude,
    #[error(
        "The height is unknown; normal gravity is that at 0 m, which is 3.1e-6 m/s2 too large for each metre of height."
    )]
    Height,
    #[error("The uncertainties of the latitude, azimuth and level of the base are not stated for this site.")]
    BaseUncertainty,
    #[error("The uncertainty of the latitude is not stated for this site.")]
    LatitudeUncertainty,
    #[error("The uncertainty of the azimuth of the base is not stated for this site.")]
    AzimuthUncertainty,
    #[error("The uncertainty of the level of the base is not stated for this site.")]
    LevelUncertainty,
    #[error("No azimuth mark is given; the north direction must be determined in another way.")]
    AzimuthMark,
}

/// Returns the missing statements of this passport.
pub(crate) fn absent(content: &Content) -> Vec<Absence> {
    [of_the_certificate(content), of_the_site(content)].concat()
}

fn of_the_certificate(content: &Content) -> Vec<Absence> {
    let Content { certificate, positions, datum, matrices, .. } = content;
    absent_of_certificate(certificate, positions, datum.as_ref(), matrices.is_some())
}

fn absent_of_certificate(
    certificate: &Certificate,
    positions: &[CertifiedPosition],
    datum: Option<&Datum>,
    has_matrices: bool,
) -> Vec<Absence> {
    let all = 3 * positions.len();
    let missing = positions.iter().flat_map(CertifiedPosition::u_arcsec).filter(Option::is_none).count();
    let common = certificate.common_platform_arcsec.is_none() || certificate.common_base_arcsec.is_none();
    let temperature = certificate.temperature_c.is_none() && certificate.temperature_range_c.is_none();
    let absences = [
        (missing == all, Absence::Uncertainty),
        (missing > 0 && missing < all, Absence::SomeUncertainty { missing, all }),
        (certificate.repeatability_arcsec.is_none(), Absence::Repeatability),
        (common, Absence::CommonPart),
        (certificate.traceability.is_none(), Absence::Traceability),
        (temperature, Absence::Temperature),
        (certificate.valid_until.is_none(), Absence::LastDay),
        (datum.is_none(), Absence::Datum),
        (!has_matrices, Absence::EightPositions),
    ];
    those_that_are(absences)
}

fn of_the_site(content: &Content) -> Vec<Absence> {
    let site = &content.site;
    let u_deg = UNKNOWN_DEFLECTION_U_ARCSEC / units::ARCSECONDS_PER_DEGREE;
    let cost_deg_per_h = earth::rotation_deg_per_h() * units::radians_from_degrees(u_deg);
    let no_deflection = site.deflection_arcsec.is_none() && site.astronomic_latitude_deg.is_none();
    let of_base =
        |part: fn(&SiteUncertainty) -> Option<f64>| site.uncertainty.as_ref().is_some_and(|u| part(u).is_none());
    let absences = [
        (no_deflection, Absence::Deflection { cost_deg_per_h }),
        (site.longitude_deg.is_none(), Absence::Longitude),
        (site.geodetic_is_uncertain(), Absence::GeodeticLatitude),
        (site.gravity_m_per_s2.is_none() && site.height_m.is_none(), Absence::Height),
        (site.uncertainty.is_none(), Absence::BaseUncertainty),
        (of_base(|u| u.latitude_arcsec), Absence::LatitudeUncertainty),
        (of_base(|u| u.azimuth_arcsec), Absence::AzimuthUncertainty),
        (of_base(|u| u.level_arcsec), Absence::LevelUncertainty),
        (site.azimuth_mark.is_none(), Absence::AzimuthMark),
    ];
    those_that_are(absences)
}

fn those_that_are(absences: impl IntoIterator<Item = (bool, Absence)>) -> Vec<Absence> {
    absences.into_iter().filter_map(|(is, absence)| is.then_some(absence)).collect()
}

/// Returns the comments above a key that are the same in every passport.
fn fixed(path: &str) -> &'static [&'static str] {
    match path {
        "certificate" => &["Certified measurement of the stand, with its uncertainty."],
        "positions" => &[
            "Nominal frame angle theta and platform angle phi; deviation of the actual orientation from the nominal:",
            "E = Rz(gamma) Ry(beta) Rx(alpha) transforms coordinates from the nominal to the actual platform, eq. (4).",
        ],
        "matrices" => &[
            "With J1 = (J11 - J13, J12 - J14), J2 = (J21 - J23, J22 - J24) as columns, in mA:",
            "K = B (J1 - J2 Delta)^-1, eq. (13); omega_n = C - K J2 n2^-1, eq. (15);",
            "omega_g = (omega_n11 + omega_n22)/2, omega_k = (omega_n21 - omega_n12)/2, eq. (16);",
            "omega_0 = mean over all positions of (omega - K J - omega_n n), eq. (8), with n and omega from `vectors`.",
        ],
        "vectors" => &["Specific force n = (c, d) in g and Earth rate omega_3 in deg/h along x and y, eq. (5)."],
        "self_check" => {
            &["From these currents laboratory software should obtain each number below: |result/stated - 1| <= 1e-9."]
        }
        "accuracy" => &[
            "Expected calibration uncertainty: a gyro of this type, calibrated once in all positions at this site \
             with this",
            "meter by weighted least squares. Standard uncertainties (k = 1), linear approximation, drifts per local \
             g.",
        ],
        _ => &[],
    }
}

/// Returns the comments above a key: the fixed ones, then those of this passport.
fn lines(path: &str, more: Vec<String>) -> Vec<String> {
    fixed(path).iter().map(|line| (*line).to_owned()).chain(more).collect()
}

fn comments(content: &Content, path: &str) -> Vec<String> {
    let more = match path {
        "format" => of_the_format(content.site.frame_axis_azimuth_deg()),
        "certificate" => sentences(&of_the_certificate(content)),
        "site" => sentences(&of_the_site(content)),
        "earth" => of_the_earth(content),
        _ => Vec::new(),
    };
    lines(path, more)
}

fn sentences(absences: &[Absence]) -> Vec<String> {
    absences.iter().map(Absence::to_string).collect()
}

/// Returns the comments above the first key, with the azimuth of the frame's axis if that does not point east as in the
/// paper.
fn of_the_format(azimuth_deg: f64) -> Vec<String> {
    let axes = if azimuth_deg == PAPER_FRAME_AXIS_AZIMUTH_DEG {
        "Axes: base xi east, eta north, zeta up; case x, y, z with z along the spin axis. i and j count from 1."
            .to_owned()
    } else {
        format!(
            "Axes: base xi (axis of the frame) at the azimuth {} deg, clockwise from north; zeta up, eta 90 deg \
             counterclockwise\n\
             from xi. Case x, y, z with z along the spin axis. i and j count from 1.\n\
             Orientation, from east, north, up to case: E A Rz(90 deg - azimuth), with A and E as in eq. (3) and (4).",
            number::decimal(azimuth_deg)
        )
    };
    let text = format!(
        "Passport of a two-axis test stand for dynamically tuned gyros.\n\
         Signed verbatim: any change, even of a space or of this comment, makes the signature invalid.\n\
         {axes}\n\
         Equations: Tang and Podchezertsev 2017, doi 10.18698/2308-6033-2017-10-1691.\n\
         Standard uncertainties (k = 1). Matrices are lists of rows."
    );
    text.lines().map(str::to_owned).collect()
}

fn of_the_earth(content: &Content) -> Vec<String> {
    let site = &content.site;
    let gravity = match (site.gravity_m_per_s2, site.gravity_u_m_per_s2()) {
        (Some(_), Some(u)) => format!("Gravity was measured; standard uncertainty {u} m/s2."),
        (None, Some(u)) => format!(
            "Gravity is normal gravity (WGS 84) at {} m; standard uncertainty {u} m/s2.",
            site.height_m.unwrap_or(0.0),
        ),
        (_, None) => "Gravity was measured; its uncertainty is not stated.".to_owned(),
    };
    let mut lines = vec![
        "Earth rate at the astronomic latitude: horizontal = rate cos(latitude), vertical = rate sin(latitude), eq. \
         (5)."
            .to_owned(),
        format!(
            "The uncertainty of K grows towards the poles as 1/cos(latitude); here it is {:.3} times that at the \
             equator.",
            site.uncertainty_growth()
        ),
        gravity,
        "g-sensitive drifts refer to this local g.".to_owned(),
        format!(
            "Validity radius {:.0} m: farther north or south a component changes by more than valid_within_deg_per_h.",
            content.earth.valid_radius_m
        ),
    ];
    if content.earth.azimuth_deg.is_some() {
        let azimuth = "Astronomic azimuth from pillar to mark, clockwise from north: geodetic + eta tan(latitude).";
        let u = "The uncertainty of the azimuth is not stated: position_u_m or u of the deflection is unknown.";
        lines.push(azimuth.to_owned());
        lines.extend(content.earth.azimuth_u_arcsec.is_none().then(|| u.to_owned()));
    }
    lines
}
