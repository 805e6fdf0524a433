//! From a passport and a laboratory to what a calibration takes for known, and what nobody stated.

use super::content::Content;
use crate::calibration::{InputUncertainty, Setup};
use crate::coefficients::SingularPositions;
use crate::laboratory::Laboratory;
use crate::site::UNKNOWN_DEFLECTION_U_ARCSEC;
use crate::stand::CertifiedPosition;
use crate::units::radians_from_arcseconds;

/// The stand at its site as a calibration takes it, with every uncertainty that passport, site and laboratory state.
///
/// # Errors
/// [`SingularPositions`]; never for a verified passport.
pub fn setup(content: &Content, laboratory: &Laboratory) -> Result<Setup, SingularPositions> {
    let positions: Vec<_> = content.positions.iter().map(CertifiedPosition::to_model).collect();
    Setup::new(&positions, content.earth.rate(), uncertainty(content, laboratory))
}

/// What is stated, in radians; what is not is 0 here and named by [`unstated`].
fn uncertainty(content: &Content, laboratory: &Laboratory) -> InputUncertainty {
    let radians = |arcseconds: Option<f64>| radians_from_arcseconds(arcseconds.unwrap_or(0.0));
    let certificate = &content.certificate;
    let angles = |at: &CertifiedPosition| [at.u_alpha_arcsec, at.u_beta_arcsec, at.u_gamma_arcsec].map(radians);
    let seating = laboratory.seating_arcsec.as_ref();
    InputUncertainty {
        angles_rad: content.positions.iter().map(angles).collect(),
        repeatability_rad: radians(certificate.repeatability_arcsec),
        common_platform_rad: radians(certificate.common_platform_arcsec),
        common_base_rad: radians(certificate.common_base_arcsec),
        latitude_rad: radians(latitude_u_arcsec(content)),
        azimuth_rad: radians(azimuth_u_arcsec(content, laboratory)),
        level_rad: radians(level_u_arcsec(content, laboratory)),
        seating_rad: seating
            .map_or([0.0; 3], |seat| [seat.about_x, seat.about_y, seat.about_z].map(radians_from_arcseconds)),
        ..InputUncertainty::of_meter((&laboratory.meter).into())
    }
}

/// The site's, and that of ξ where the latitude is geodetic.
fn latitude_u_arcsec(content: &Content) -> Option<f64> {
    let site = &content.site;
    let own = site.uncertainty.as_ref().and_then(|uncertainty| uncertainty.latitude_arcsec);
    let deflection = match (&site.deflection_arcsec, site.astronomic_latitude_deg) {
        (_, Some(_)) => None,
        (Some(deflection), None) => deflection.u,
        (None, None) => Some(UNKNOWN_DEFLECTION_U_ARCSEC),
    };
    in_quadrature(own, deflection)
}

/// The laboratory's own of its base, else the site's from mark to base with that of the mark.
fn azimuth_u_arcsec(content: &Content, laboratory: &Laboratory) -> Option<f64> {
    let measured = laboratory.base.as_ref().and_then(|base| base.azimuth_arcsec);
    let from_mark = content.site.uncertainty.as_ref().and_then(|uncertainty| uncertainty.azimuth_arcsec);
    measured.or_else(|| in_quadrature(from_mark, content.earth.azimuth_u_arcsec))
}

fn level_u_arcsec(content: &Content, laboratory: &Laboratory) -> Option<f64> {
    let measured = laboratory.base.as_ref().and_then(|base| base.level_arcsec);
    measured.or_else(|| content.site.uncertainty.as_ref().and_then(|uncertainty| uncertainty.level_arcsec))
}

fn in_quadrature(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    match (a, b) {
        (None, None) => None,
        (a, b) => Some(libm::hypot(a.unwrap_or(0.0), b.unwrap_or(0.0))),
    }
}

/// Uncertainties that neither passport nor laboratory states, and that are therefore missing from every result.
pub fn unstated(content: &Content, laboratory: &Laboratory) -> Vec<&'static str> {
    let certificate = &content.certificate;
    let angles = content
        .positions
        .iter()
        .all(|at| at.u_alpha_arcsec.is_some() && at.u_beta_arcsec.is_some() && at.u_gamma_arcsec.is_some());
    let latitude = content.site.uncertainty.as_ref().and_then(|uncertainty| uncertainty.latitude_arcsec);
    [
        (angles, "the certified angles"),
        (certificate.repeatability_arcsec.is_some(), "the repeatability of positions"),
        (certificate.common_platform_arcsec.is_some(), "the part common to the platform"),
        (certificate.common_base_arcsec.is_some(), "the part common to the base"),
        (latitude.is_some(), "the latitude of the site"),
        (azimuth_u_arcsec(content, laboratory).is_some(), "the azimuth of the base"),
        (level_u_arcsec(content, laboratory).is_some(), "the level of the base"),
        (laboratory.seating_arcsec.is_some(), "the gyro's seat"),
    ]
    .into_iter()
    .filter_map(|(stated, what)| (!stated).then_some(what))
    .collect()
}

/// The same laboratory temperature as on the certificate? Words about it when not, or when that cannot be told.
pub fn temperature_remark(content: &Content, laboratory: &Laboratory) -> Option<String> {
    let here = laboratory.temperature_c?;
    match content.certificate.temperature_range_c {
        Some([low, high]) if !(low..=high).contains(&here) => Some(format!(
            "the laboratory's {here} deg C are outside the {low} to {high} deg C for which the deviations are certified"
        )),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 3″ and 4″ are 5″ together.
    #[test]
    fn independent_parts_add_in_quadrature() {
        assert_eq!(in_quadrature(Some(3.0), Some(4.0)), Some(5.0));
        assert_eq!(in_quadrature(None, Some(4.0)), Some(4.0));
        assert_eq!(in_quadrature(None, None), None);
    }
}
