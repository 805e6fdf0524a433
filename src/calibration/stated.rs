//! Standard uncertainties of the inputs, as stated by certificate, site and laboratory.

use super::document::Subject;
use super::inputs::{InputUncertainty, MeterUncertainty, NoSetup, Setup};
use crate::laboratory::Laboratory;
use crate::site::Site;
use crate::stand::{ActsOn, Certificate, CertifiedPosition};
use crate::statistics::student::effective_degrees_of_freedom;
use crate::text::words;
use crate::units::radians_from_arcseconds;

words! {
    /// Input whose uncertainty no file states, or one states as 0; the result does not include it. Its words are its name,
    /// with the key under which a file would state the uncertainty.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[non_exhaustive]
    pub enum NotStated: pub words {
        /// Certified angles, own part.
        Angles = "certified angles (u_alpha_arcsec, u_beta_arcsec, u_gamma_arcsec)",
        /// Own part of some of the certified angles.
        SomeAngles = "some of the certified angles (u_alpha_arcsec, u_beta_arcsec, u_gamma_arcsec)",
        /// Repeatability of positioning.
        Return = "repeatability of positioning (repeatability_arcsec)",
        /// Common part of the platform.
        Platform = "common part of the platform (common_platform_arcsec)",
        /// Common part of the base of the stand.
        Base = "common part of the base (common_base_arcsec)",
        /// Latitude as stated.
        Latitude = "latitude (latitude_arcsec)",
        /// Deflection of the vertical, which converts a geodetic latitude to the astronomic one.
        Deflection = "deflection of the vertical (deflection_arcsec.u)",
        /// Azimuth of the base.
        Azimuth = "azimuth of the base (azimuth_arcsec)",
        /// Azimuth of the mark.
        Mark = "azimuth of the mark (position_u_m, deflection_arcsec.u)",
        /// Level of the base.
        Level = "level of the base (level_arcsec)",
        /// Gyro seat.
        Seat = "gyro seat (seating_arcsec)",
        /// Gain of the meter.
        Gain = "gain of the meter (meter.gain_percent)",
        /// Offset of the meter.
        Offset = "offset of the meter (meter.offset_ma)",
        /// Noise of the gyro from visit to visit.
        Visits = "gyro noise from visit to visit (noise.visit_deg_per_h, or repeated visits)",
        /// Noise of the gyro from turn-on to turn-on.
        TurnOns = "gyro noise from turn-on to turn-on (noise.turn_on_deg_per_h, or repeated turn-ons)",
        /// Gravity, required for a comparison with a gyro type.
        Gravity = "gravity (gravity_u_m_per_s2)",
    }
}

impl Setup {
    /// Creates the setup of a certified stand at a site, with the uncertainties stated by certificate, site and
    /// laboratory; also returns the inputs without a stated uncertainty, which are treated as exact.
    ///
    /// # Errors
    /// Returns [`NoSetup`] if n_2 of the eight positions has no inverse, or an uncertainty or its degrees of freedom
    /// are invalid.
    pub fn stated(
        certificate: &Certificate,
        positions: &[CertifiedPosition],
        site: &Site,
        laboratory: &Laboratory,
    ) -> Result<(Self, Vec<NotStated>), NoSetup> {
        let mut missing = Vec::new();
        let mut angle = |arcsec: Option<f64>, what: NotStated| {
            // A 0 that `certify` writes is an estimate from readings.
            let estimated = certificate.evidence.is_some()
                && matches!(what, NotStated::Angles | NotStated::Return | NotStated::Platform | NotStated::Base);
            if !arcsec.is_some_and(|u| u > 0.0 || estimated) && !missing.contains(&what) {
                missing.push(what);
            }
            radians_from_arcseconds(arcsec.unwrap_or(0.0))
        };
        let angles_rad = positions.iter().map(|at| at.u_arcsec().map(|u| angle(u, NotStated::Angles))).collect();
        let (of_site, measured) = (site.uncertainty.as_ref(), laboratory.base.as_ref());
        let azimuth_mark = site.azimuth_mark.as_ref();
        // From the mark to the base, stated or measured. From the pillar to the mark it is computed.
        let azimuth = measured.and_then(|base| base.azimuth_arcsec).or(of_site.and_then(|u| u.azimuth_arcsec));
        let level = measured.and_then(|base| base.level_arcsec).or(of_site.and_then(|u| u.level_arcsec));
        let seat = laboratory.seating_arcsec.as_ref();
        let seat = [seat.map(|seat| seat.about_x), seat.map(|seat| seat.about_y), seat.map(|seat| seat.about_z)];
        let degrees_of_freedom = |stated: Option<f64>| stated.unwrap_or(f64::INFINITY);
        let (common_platform, common_base) = (certificate.common_platform_arcsec, certificate.common_base_arcsec);
        let uncertainty = InputUncertainty {
            angles_rad,
            angles_degrees_of_freedom: positions.iter().map(|at| degrees_of_freedom(at.degrees_of_freedom)).collect(),
            repeatability_degrees_of_freedom: degrees_of_freedom(certificate.repeatability_degrees_of_freedom),
            repeatability_rad: angle(certificate.repeatability_arcsec, NotStated::Return),
            common_platform_degrees_of_freedom: of_common(certificate, ActsOn::Platform, common_platform),
            common_base_degrees_of_freedom: of_common(certificate, ActsOn::Base, common_base),
            common_platform_rad: angle(common_platform, NotStated::Platform),
            common_base_rad: angle(common_base, NotStated::Base),
            latitude_rad: angle(of_site.and_then(|u| u.latitude_arcsec), NotStated::Latitude),
            deflection_rad: site.latitude_deg.map_or(0.0, |_| angle(site.deflection_u_arcsec(), NotStated::Deflection)),
            azimuth_rad: angle(azimuth, NotStated::Azimuth),
            mark_rad: azimuth_mark.map_or(0.0, |_| angle(site.earth().azimuth_u_arcsec, NotStated::Mark)),
            level_rad: angle(level, NotStated::Level),
            seating_rad: seat.map(|u| angle(u, NotStated::Seat)),
            meter: MeterUncertainty::from(&laboratory.meter),
            visit_deg_per_h: None,
            turn_on_deg_per_h: None,
        };
        if uncertainty.angles_rad.iter().flatten().any(|u| *u > 0.0) {
            missing
                .iter_mut()
                .filter(|what| **what == NotStated::Angles)
                .for_each(|what| *what = NotStated::SomeAngles);
        }
        let others = [
            (uncertainty.meter.gain, NotStated::Gain),
            (uncertainty.meter.offset_ma, NotStated::Offset),
            (site.gravity_u_m_per_s2().unwrap_or(0.0), NotStated::Gravity),
        ];
        missing.extend(others.into_iter().filter(|(u, _)| *u == 0.0).map(|(_, what)| what));
        let positions: Vec<_> = positions.iter().map(CertifiedPosition::to_model).collect();
        Ok((Self::new(&positions, site.earth().rate(site), uncertainty)?, missing))
    }
}

/// Returns the effective degrees of freedom of a common part: 3 (R − 1) for the part from R runs, and those stated for
/// each contribution of type B.
fn of_common(certificate: &Certificate, on: ActsOn, common_arcsec: Option<f64>) -> f64 {
    let Some(common_arcsec) = common_arcsec.filter(|_| certificate.evidence.is_some()) else { return f64::INFINITY };
    let shown = (common_arcsec * common_arcsec - certificate.type_b_arcsec2(on)).max(0.0).sqrt();
    let mut parts = vec![(shown, certificate.freedom_of_runs())];
    let type_b = certificate.type_b_on(on);
    parts.extend(type_b.map(|line| (line.u_arcsec, line.degrees_of_freedom.unwrap_or(f64::INFINITY))));
    effective_degrees_of_freedom(&parts)
}

/// Returns the temperature during the readings, °C. What was read then comes before what the laboratory states.
pub(crate) fn temperature_c(subject: &Subject, laboratory: Option<&Laboratory>) -> Option<f64> {
    subject.temperature_c.or(laboratory.and_then(|laboratory| laboratory.temperature_c))
}

/// Temperature in the laboratory outside the range for which the deviations are certified, °C. Displayed, it is an
/// English sentence without a full stop; `report` has the words of other languages.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "the temperature in the laboratory is {here_c} °C; the deviations are certified from {low_c} to {high_c} °C, and no \
     uncertainty includes the effect of this"
)]
pub(crate) struct TemperatureOutside {
    pub here_c: f64,
    pub low_c: f64,
    pub high_c: f64,
}

impl TemperatureOutside {
    /// Returns `None` if the temperature is within the range, or if one of them is not stated.
    pub(crate) fn of(certificate: &Certificate, subject: &Subject, laboratory: Option<&Laboratory>) -> Option<Self> {
        let here_c = temperature_c(subject, laboratory)?;
        let [low_c, high_c] = certificate.temperature_range_c?;
        (!(low_c..=high_c).contains(&here_c)).then_some(Self { here_c, low_c, high_c })
    }
}
