//! The uncertainty of the inputs, as certificate, site and laboratory state it.

use super::inputs::{InputUncertainty, MeterUncertainty, NoSetup, Setup};
use crate::laboratory::{Base, Laboratory};
use crate::site::{Site, SiteUncertainty, UNKNOWN_DEFLECTION_U_ARCSEC};
use crate::stand::{ActsOn, Certificate, CertifiedPosition};
use crate::statistics::propagation::effective_degrees_of_freedom;
use crate::units::radians_from_arcseconds;

/// What nobody states: the uncertainty of a result is without it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum NotStated {
    /// The certified angles' own part.
    Angles,
    /// The return to a position.
    Return,
    /// What all positions share on the platform.
    Platform,
    /// What all positions share on the stand's base.
    Base,
    /// The latitude.
    Latitude,
    /// The deflection of the vertical, through which it becomes the astronomic one.
    Deflection,
    /// The azimuth of the base.
    Azimuth,
    /// The azimuth of the mark.
    Mark,
    /// The level of the base.
    Level,
    /// The gyro's seat.
    Seat,
    /// Gravity, which a verdict against a type needs.
    Gravity,
}

impl NotStated {
    /// In words, with the key of the file that would state it.
    pub fn words(self) -> &'static str {
        match self {
            Self::Angles => "certified angles (u_alpha_arcsec, u_beta_arcsec, u_gamma_arcsec)",
            Self::Return => "repeatability of positioning (repeatability_arcsec)",
            Self::Platform => "common part of the platform (common_platform_arcsec)",
            Self::Base => "common part of the base (common_base_arcsec)",
            Self::Latitude => "latitude (latitude_arcsec)",
            Self::Deflection => "deflection of the vertical (deflection_arcsec.u)",
            Self::Azimuth => "azimuth of the base (azimuth_arcsec)",
            Self::Mark => "azimuth of the mark (position_u_m, deflection_arcsec.u)",
            Self::Level => "level of the base (level_arcsec)",
            Self::Seat => "gyro seat (seating_arcsec)",
            Self::Gravity => "gravity (gravity_u_m_per_s2)",
        }
    }
}

/// What the files state, and what they do not.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stated {
    /// Standard uncertainties; what is not stated is taken as exact.
    pub uncertainty: InputUncertainty,
    /// What is not stated.
    pub missing: Vec<NotStated>,
}

impl Stated {
    /// From the certificate and its positions, the site, and the laboratory.
    pub(crate) fn new(
        certificate: &Certificate,
        positions: &[CertifiedPosition],
        site: &Site,
        laboratory: &Laboratory,
    ) -> Self {
        let mut missing = Vec::new();
        let mut angle = |arcsec: Option<f64>, what: NotStated| {
            if arcsec.is_none() && !missing.contains(&what) {
                missing.push(what);
            }
            radians_from_arcseconds(arcsec.unwrap_or(0.0))
        };
        let angles_rad = positions
            .iter()
            .map(|at| [at.u_alpha_arcsec, at.u_beta_arcsec, at.u_gamma_arcsec].map(|u| angle(u, NotStated::Angles)))
            .collect();
        let base = Known::new(site, laboratory);
        let seat = laboratory.seating_arcsec.as_ref();
        let seat = [seat.map(|seat| seat.about_x), seat.map(|seat| seat.about_y), seat.map(|seat| seat.about_z)];
        let degrees_of_freedom = |stated: Option<f64>| stated.unwrap_or(f64::INFINITY);
        let uncertainty = InputUncertainty {
            angles_rad,
            angles_degrees_of_freedom: positions.iter().map(|at| degrees_of_freedom(at.degrees_of_freedom)).collect(),
            repeatability_degrees_of_freedom: degrees_of_freedom(certificate.repeatability_degrees_of_freedom),
            repeatability_rad: angle(certificate.repeatability_arcsec, NotStated::Return),
            common_platform_degrees_of_freedom: of_common(
                certificate,
                ActsOn::Platform,
                certificate.common_platform_arcsec,
            ),
            common_base_degrees_of_freedom: of_common(certificate, ActsOn::Base, certificate.common_base_arcsec),
            common_platform_rad: angle(certificate.common_platform_arcsec, NotStated::Platform),
            common_base_rad: angle(certificate.common_base_arcsec, NotStated::Base),
            latitude_rad: angle(base.latitude_arcsec, NotStated::Latitude),
            deflection_rad: angle(base.deflection_arcsec, NotStated::Deflection),
            azimuth_rad: angle(base.azimuth_arcsec, NotStated::Azimuth),
            mark_rad: angle(base.mark_arcsec, NotStated::Mark),
            level_rad: angle(base.level_arcsec, NotStated::Level),
            seating_rad: seat.map(|u| angle(u, NotStated::Seat)),
            meter: MeterUncertainty::from(&laboratory.meter),
        };
        if site.gravity_u_m_per_s2().is_none() {
            missing.push(NotStated::Gravity);
        }
        Self { uncertainty, missing }
    }
}

impl Setup {
    /// The stand of a certificate at a site, with what certificate, site and laboratory state; and what they do not.
    ///
    /// # Errors
    /// See [`NoSetup`].
    pub fn stated(
        certificate: &Certificate,
        positions: &[CertifiedPosition],
        site: &Site,
        laboratory: &Laboratory,
    ) -> Result<(Self, Vec<NotStated>), NoSetup> {
        let Stated { uncertainty, missing } = Stated::new(certificate, positions, site, laboratory);
        let positions: Vec<_> = positions.iter().map(CertifiedPosition::to_model).collect();
        Ok((Self::new(&positions, site.earth().rate(), uncertainty)?, missing))
    }
}

/// The degrees of freedom of what all positions share: of what R runs showed, 3 (R − 1); of a line of type B its own.
fn of_common(certificate: &Certificate, on: ActsOn, common_arcsec: Option<f64>) -> f64 {
    let Some((evidence, common_arcsec)) = certificate.evidence.as_ref().zip(common_arcsec) else {
        return f64::INFINITY;
    };
    let shown = (common_arcsec * common_arcsec - certificate.type_b_arcsec2(on)).max(0.0).sqrt();
    let mut parts = vec![(shown, 3.0 * (f64::from(evidence.runs) - 1.0))];
    let type_b = certificate.type_b_on(on);
    parts.extend(type_b.map(|line| (line.u_arcsec, line.degrees_of_freedom.unwrap_or(f64::INFINITY))));
    effective_degrees_of_freedom(&parts)
}

/// Words, when the laboratory's temperature is outside the range for which the deviations are certified.
pub(crate) fn temperature_remark(certificate: &Certificate, laboratory: &Laboratory) -> Option<String> {
    let here = laboratory.temperature_c?;
    let [low, high] = certificate.temperature_range_c?;
    (!(low..=high).contains(&here)).then(|| {
        format!(
            "the temperature in the laboratory is {here} deg C; the deviations are certified from {low} \
             to {high} deg C"
        )
    })
}

/// The base at its place. Parts that are independent are kept apart; what does not enter is known exactly.
struct Known {
    latitude_arcsec: Option<f64>,
    deflection_arcsec: Option<f64>,
    azimuth_arcsec: Option<f64>,
    mark_arcsec: Option<f64>,
    level_arcsec: Option<f64>,
}

impl Known {
    fn new(site: &Site, laboratory: &Laboratory) -> Self {
        let none = SiteUncertainty { latitude_arcsec: None, azimuth_arcsec: None, level_arcsec: None };
        let of_site = site.uncertainty.as_ref().unwrap_or(&none);
        let none = Base { azimuth_arcsec: None, level_arcsec: None };
        let measured = laboratory.base.as_ref().unwrap_or(&none);
        // A geodetic latitude becomes the astronomic one through ξ.
        let deflection = match (site.latitude_deg, &site.deflection_arcsec) {
            (Some(_), Some(deflection)) => deflection.u,
            (Some(_), None) => Some(UNKNOWN_DEFLECTION_U_ARCSEC),
            (None, _) => Some(0.0),
        };
        Self {
            latitude_arcsec: of_site.latitude_arcsec,
            deflection_arcsec: deflection,
            // From the mark to the base as stated or measured; from the pillar to the mark as computed.
            azimuth_arcsec: measured.azimuth_arcsec.or(of_site.azimuth_arcsec),
            mark_arcsec: if site.azimuth_mark.is_some() { site.earth().azimuth_u_arcsec } else { Some(0.0) },
            level_arcsec: measured.level_arcsec.or(of_site.level_arcsec),
        }
    }
}
