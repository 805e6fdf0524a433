//! Sites: the file `sites/<id>.yaml` (`dtg-site/1`), and the Earth parameters at a site.

mod consistency;

use crate::attitude::PAPER_FRAME_AXIS_AZIMUTH_DEG;
use crate::coefficients::EarthRate;
use crate::earth::{self, Place};
use crate::text::advice::without_full_turns;
use crate::text::{Advice, Document, Identifier, Path, Problems, RefusalCause, number, record};
use crate::units::radians_from_arcseconds;
use crate::units::{ARCSECONDS_PER_DEGREE, sin_cos_of_degrees};

/// Standard uncertainty of a deflection component that is unknown and taken as 0, arcsec.
pub(crate) const UNKNOWN_DEFLECTION_U_ARCSEC: f64 = 10.0;

/// Change of ω_Γ or ω_B that determines the validity radius if a site states none, °/h.
pub(crate) const DEFAULT_VALID_WITHIN_DEG_PER_H: f64 = 0.001;

/// Largest uncertainty of a deflection component, arcsec: one degree, at which the deflection is unknown. A larger
/// value could make the uncertainty of the azimuth infinite, which no file can contain.
const LARGEST_DEFLECTION_U_ARCSEC: f64 = 3600.0;

/// Largest uncertainty of a coordinate of pillar or mark, m: a thousand kilometres.
const LARGEST_POSITION_U_M: f64 = 1e6;

/// Gravity on the surface of the Earth, m/s².
const GRAVITY_M_PER_S2: std::ops::RangeInclusive<f64> = 9.7..=9.9;

/// Largest assumed difference between geodetic and astronomic latitude if the deflection is unknown, arcsec.
pub(crate) const LATITUDE_MARGIN_ARCSEC: f64 = 30.0;

record! {
    /// Deflection of the vertical: direction of the astronomic zenith relative to the geodetic zenith.
    pub struct Deflection {
        /// Component ξ, positive to the north.
        pub xi: f64,
        /// Component η, positive to the east.
        pub eta: f64,
        /// Standard uncertainty of each component.
        pub u: Option<f64>,
    }
}

record! {
    /// Azimuth mark, whose direction from the pillar defines north. Both points are geodetic (WGS 84).
    pub struct AzimuthMark {
        /// Name of the mark.
        pub name: Option<String>,
        /// Latitude of the mark.
        pub latitude_deg: f64,
        /// Longitude of the mark.
        pub longitude_deg: f64,
        /// Latitude of the pillar.
        pub pillar_latitude_deg: f64,
        /// Longitude of the pillar.
        pub pillar_longitude_deg: f64,
        /// Standard uncertainty of each coordinate.
        pub position_u_m: Option<f64>,
    }
}

record! {
    /// Standard uncertainties of the base of the stand, as set up at the site.
    pub struct SiteUncertainty {
        /// Uncertainty of the latitude.
        pub latitude_arcsec: Option<f64>,
        /// Uncertainty of the azimuth, relative to the mark.
        pub azimuth_arcsec: Option<f64>,
        /// Uncertainty of the level, per axis.
        pub level_arcsec: Option<f64>,
    }
}

record! {
    /// Site: the place where a stand is used (`dtg-site/1`).
    #[cfg_attr(feature = "generate", schemars(extend("oneOf" = [
        {"required": ["latitude_deg"]}, {"required": ["astronomic_latitude_deg"]}
    ])))]
    pub struct Site {
        /// Identifier; also the file name.
        pub id: Identifier,
        /// Free-text name.
        pub name: Option<String>,
        /// Geodetic latitude (WGS 84); alternatively `astronomic_latitude_deg`.
        pub latitude_deg: Option<f64>,
        /// Astronomic latitude, if measured.
        pub astronomic_latitude_deg: Option<f64>,
        /// Longitude, east positive.
        pub longitude_deg: Option<f64>,
        /// Height above the ellipsoid.
        pub height_m: Option<f64>,
        /// Deflection of the vertical.
        pub deflection_arcsec: Option<Deflection>,
        /// Measured gravity.
        pub gravity_m_per_s2: Option<f64>,
        /// Standard uncertainty of the measured gravity.
        pub gravity_u_m_per_s2: Option<f64>,
        /// Azimuth mark, which defines north.
        pub azimuth_mark: Option<AzimuthMark>,
        /// Azimuth of the frame's axis ξ, clockwise from north; 90 (east) if absent.
        pub frame_axis_azimuth_deg: Option<f64>,
        /// Change of ω_Γ or ω_B at the validity radius; 0.001 if absent.
        pub valid_within_deg_per_h: Option<f64>,
        /// Standard uncertainties of the base.
        pub uncertainty: Option<SiteUncertainty>,
        /// Source of the data.
        pub source: Option<String>,
    }
}

impl Document for Site {
    const FORMAT: &'static str = "dtg-site/1";
}

record! {
    /// Earth parameters at the site, as stated in a passport.
    pub struct Earth {
        /// Earth rate Ω.
        pub rate_deg_per_h: f64,
        /// Astronomic latitude Φ.
        pub latitude_deg: f64,
        /// Horizontal Earth rate ω_Γ = Ω cos Φ.
        pub horizontal_deg_per_h: f64,
        /// Vertical Earth rate ω_B = Ω sin Φ.
        pub vertical_deg_per_h: f64,
        /// Local g, to which g-sensitive drifts refer.
        pub gravity_m_per_s2: f64,
        /// Distance along the meridian at which ω_Γ or ω_B has changed by
        /// `valid_within_deg_per_h`.
        pub valid_radius_m: f64,
        /// Change of ω_Γ or ω_B at the validity radius.
        pub valid_within_deg_per_h: f64,
        /// Astronomic azimuth from the pillar to the mark.
        pub azimuth_deg: Option<f64>,
        /// Standard uncertainty of the azimuth.
        pub azimuth_u_arcsec: Option<f64>,
    }
}

impl Earth {
    /// Returns the Earth rate, ω_Γ and ω_B, with the azimuth of the frame's axis at `site`, to which these Earth
    /// parameters belong.
    pub fn rate(&self, site: &Site) -> EarthRate {
        EarthRate {
            horizontal_deg_per_h: self.horizontal_deg_per_h,
            vertical_deg_per_h: self.vertical_deg_per_h,
            frame_axis_azimuth_deg: site.frame_axis_azimuth_deg(),
        }
    }

    /// Returns the standard uncertainties of ω_Γ and ω_B at `site`, °/h. They come from the latitude alone, by which the
    /// derivative of one component is the other one; the Earth rate is known.
    pub(crate) fn rate_u_deg_per_h(&self, site: &Site) -> [f64; 2] {
        let latitude_u = radians_from_arcseconds(site.astronomic_latitude_u_arcsec());
        [self.vertical_deg_per_h, self.horizontal_deg_per_h].map(|slope| slope.abs() * latitude_u)
    }
}

impl Site {
    /// Reads a `dtg-site/1` file; `name` is the file name in messages.
    ///
    /// # Errors
    /// Returns [`crate::text::Unreadable`] with the line, column and field of every error.
    #[cfg(feature = "yaml")]
    pub fn from_yaml(name: &str, bytes: &[u8]) -> Result<Self, crate::text::Unreadable> {
        crate::text::yaml::read_document(name, bytes, |site: &Self, problems| {
            site.check(&Path::Root, problems);
            site.check_consistency(&Path::Root, problems);
        })
    }

    /// Returns the standard uncertainty of the component ξ of the deflection of the vertical, which converts a geodetic
    /// latitude to the astronomic one; 0 if the latitude is astronomic, `None` if it is not stated.
    pub(crate) fn deflection_u_arcsec(&self) -> Option<f64> {
        match (self.latitude_deg, &self.deflection_arcsec) {
            (Some(_), Some(deflection)) => deflection.u,
            (Some(_), None) => Some(UNKNOWN_DEFLECTION_U_ARCSEC),
            (None, _) => Some(0.0),
        }
    }

    /// Returns the standard uncertainty of the astronomic latitude, as far as it is stated.
    pub(crate) fn astronomic_latitude_u_arcsec(&self) -> f64 {
        let latitude_u = self.uncertainty.as_ref().and_then(|base| base.latitude_arcsec);
        libm::hypot(latitude_u.unwrap_or(0.0), self.deflection_u_arcsec().unwrap_or(0.0))
    }

    /// Checks the content of a site. The rules of [`Site::check_consistency`] are separate because they apply only to
    /// site files and new passports: earlier passports of sites that break them stay valid.
    pub(crate) fn check(&self, at: &Path, problems: &mut Problems) {
        self.check_latitude(at, problems);
        if let Some(longitude) = self.longitude_deg.filter(|longitude| !(-180.0..=180.0).contains(longitude)) {
            let advice = beyond_180(longitude).map(|words| Advice::from((RefusalCause::FullTurn, words)));
            let advice = advice.or_else(|| Some(decimal_degrees(longitude, 180.0)?.into())).unwrap_or_default();
            problems.at(&at.key("longitude_deg"), format!("{longitude}"), "a number from -180 to 180", advice);
        }
        problems.within(&at.key("height_m"), self.height_m, -500.0, 9000.0);
        if let Some(gravity) = self.gravity_m_per_s2.filter(|gravity| !GRAVITY_M_PER_S2.contains(gravity)) {
            let advice = gravity_in_another_unit(gravity);
            problems.at(&at.key("gravity_m_per_s2"), format!("{gravity}"), "a number from 9.7 to 9.9", advice);
        }
        problems.within(&at.key("gravity_u_m_per_s2"), self.gravity_u_m_per_s2, 0.0, f64::MAX);
        problems.within(&at.key("valid_within_deg_per_h"), self.valid_within_deg_per_h, 1e-6, 1.0);
        if self.gravity_u_m_per_s2.is_some() && self.gravity_m_per_s2.is_none() {
            let advice = "state gravity_m_per_s2, or omit both";
            problems.at(&at.key("gravity_u_m_per_s2"), "an uncertainty without its value", "both or neither", advice);
        }
        if let Some(deflection) = &self.deflection_arcsec {
            let at = at.key("deflection_arcsec");
            problems.within(&at.key("xi"), Some(deflection.xi), -150.0, 150.0);
            problems.within(&at.key("eta"), Some(deflection.eta), -150.0, 150.0);
            problems.within(&at.key("u"), deflection.u, 0.0, LARGEST_DEFLECTION_U_ARCSEC);
        }
        if let Some(mark) = &self.azimuth_mark {
            mark.check(&at.key("azimuth_mark"), problems);
        }
        if let Some(azimuth) = self.frame_axis_azimuth_deg.filter(|azimuth| !(0.0..360.0).contains(azimuth)) {
            let at = at.key("frame_axis_azimuth_deg");
            let meant = without_full_turns(azimuth, 360.0, 0.0).unwrap_or_default();
            let advice = (
                RefusalCause::FullTurn,
                format!("count clockwise from north: 0 is north, 90 east; this one is {meant}"),
            );
            problems.at(&at, number::decimal(azimuth), "degrees from 0 to less than 360", advice);
        }
        if let Some(uncertainty) = &self.uncertainty {
            let at = at.key("uncertainty");
            problems.within(&at.key("latitude_arcsec"), uncertainty.latitude_arcsec, 0.0, f64::MAX);
            problems.within(&at.key("azimuth_arcsec"), uncertainty.azimuth_arcsec, 0.0, f64::MAX);
            problems.within(&at.key("level_arcsec"), uncertainty.level_arcsec, 0.0, f64::MAX);
        }
    }

    fn check_latitude(&self, at: &Path, problems: &mut Problems) {
        for (key, latitude) in
            [("latitude_deg", self.latitude_deg), ("astronomic_latitude_deg", self.astronomic_latitude_deg)]
        {
            check_latitude_range(&at.key(key), latitude, self.longitude_deg, problems);
        }
        match (self.latitude_deg, self.astronomic_latitude_deg) {
            (Some(_), Some(_)) => {
                let advice = "keep the geodetic latitude, with deflection_arcsec, or the astronomic latitude";
                problems.at(&at.key("astronomic_latitude_deg"), "both latitudes", "one of them", advice);
            }
            (None, None) if problems.mean("latitude_deg") => {}
            (None, None) => {
                let expected = "latitude_deg (geodetic) or astronomic_latitude_deg";
                problems.at(at, "no latitude", expected, "add the known latitude");
            }
            // A value that is not a latitude has been refused above.
            (Some(given), None) | (None, Some(given)) if given.abs() <= 90.0 => {
                let key = if self.latitude_deg.is_some() { "latitude_deg" } else { "astronomic_latitude_deg" };
                let (geodetic, latitude) = (self.geodetic_deg(), self.astronomic_deg());
                // Beyond the pole there is no place, and therefore no distance and no radius.
                if geodetic.abs() > 90.0 {
                    let found = format!("the geodetic latitude {geodetic}, computed with the deflection");
                    let advice = "check the sign of deflection_arcsec.xi";
                    problems.at(&at.key(key), found, "a latitude from -90 to 90 degrees", advice);
                }
                if latitude.abs() >= 90.0 {
                    let found = format!("the astronomic latitude {latitude}");
                    let advice = "at a pole the horizontal component of the Earth rate is zero, so K cannot be \
                                  determined";
                    problems.at(&at.key(key), found, "a latitude between -90 and 90 degrees", advice);
                }
            }
            _ => {}
        }
    }

    /// Returns the astronomic latitude Φ, degrees: as measured, or the geodetic one plus ξ (0 if unknown).
    fn astronomic_deg(&self) -> f64 {
        let xi = self.deflection_arcsec.as_ref().map_or(0.0, |deflection| deflection.xi);
        match (self.astronomic_latitude_deg, self.latitude_deg) {
            (Some(astronomic), _) => astronomic,
            (None, geodetic) => earth::astronomic_latitude_deg(geodetic.unwrap_or(0.0), xi),
        }
    }

    /// Returns the geodetic latitude φ, degrees: as stated, or the astronomic one minus ξ (0 if unknown).
    pub fn geodetic_deg(&self) -> f64 {
        let xi = self.deflection_arcsec.as_ref().map_or(0.0, |deflection| deflection.xi);
        match (self.latitude_deg, self.astronomic_latitude_deg) {
            (Some(geodetic), _) => geodetic,
            (None, astronomic) => astronomic.unwrap_or(0.0) - xi / ARCSECONDS_PER_DEGREE,
        }
    }

    /// Returns `true` if the geodetic latitude is computed from an astronomic one without a known deflection.
    pub(crate) fn geodetic_is_uncertain(&self) -> bool {
        self.latitude_deg.is_none() && self.deflection_arcsec.is_none()
    }

    /// Returns the azimuth of the frame's axis, degrees clockwise from north: as stated, or the paper's 90.
    pub(crate) fn frame_axis_azimuth_deg(&self) -> f64 {
        self.frame_axis_azimuth_deg.unwrap_or(PAPER_FRAME_AXIS_AZIMUTH_DEG)
    }

    /// Returns the Earth parameters at the site.
    pub fn earth(&self) -> Earth {
        let latitude_deg = self.astronomic_deg();
        let rate = EarthRate::at_astronomic_latitude(latitude_deg);
        let geodetic_deg = self.geodetic_deg();
        let valid_within_deg_per_h = self.valid_within_deg_per_h.unwrap_or(DEFAULT_VALID_WITHIN_DEG_PER_H);
        // The meridian has the same length at every longitude.
        let place = Place { latitude_deg: geodetic_deg, longitude_deg: self.longitude_deg.unwrap_or(0.0) };
        let normal_gravity = || earth::normal_gravity_m_per_s2(geodetic_deg, self.height_m.unwrap_or(0.0));
        let azimuth = self.azimuth(latitude_deg);
        Earth {
            rate_deg_per_h: earth::rotation_deg_per_h(),
            latitude_deg,
            horizontal_deg_per_h: rate.horizontal_deg_per_h,
            vertical_deg_per_h: rate.vertical_deg_per_h,
            gravity_m_per_s2: self.gravity_m_per_s2.unwrap_or_else(normal_gravity),
            valid_radius_m: earth::validity_radius_m(latitude_deg, place, valid_within_deg_per_h),
            valid_within_deg_per_h,
            azimuth_deg: azimuth.map(|azimuth| azimuth.azimuth_deg),
            azimuth_u_arcsec: azimuth.and_then(|azimuth| azimuth.u_arcsec),
        }
    }

    fn azimuth(&self, astronomic_latitude_deg: f64) -> Option<earth::Azimuth> {
        let mark = self.azimuth_mark.as_ref()?;
        let unknown = (0.0, Some(UNKNOWN_DEFLECTION_U_ARCSEC));
        let eta = self.deflection_arcsec.as_ref().map_or(unknown, |deflection| (deflection.eta, deflection.u));
        let points = [mark.pillar(), mark.mark()];
        Some(earth::astronomic_azimuth(points, eta, astronomic_latitude_deg, mark.position_u_m))
    }

    /// Returns the standard uncertainty of the gravity in [`Site::earth`], m/s²: that of the measured value, or that of
    /// normal gravity, which is larger if the height is unknown. Returns `None` if gravity was measured and its
    /// uncertainty is not stated.
    pub(crate) fn gravity_u_m_per_s2(&self) -> Option<f64> {
        match self.gravity_m_per_s2 {
            Some(_) => self.gravity_u_m_per_s2,
            None if self.is_gravity_without_height() => Some(earth::NORMAL_GRAVITY_WITHOUT_HEIGHT_U_M_PER_S2),
            None => Some(earth::NORMAL_GRAVITY_U_M_PER_S2),
        }
    }

    /// Returns `true` if the gravity in [`Site::earth`] is normal gravity at 0 m, because the height is unknown.
    pub(crate) fn is_gravity_without_height(&self) -> bool {
        self.gravity_m_per_s2.is_none() && self.height_m.is_none()
    }

    /// Returns 1/cos Φ, the ratio of the uncertainty of K to its value at the equator.
    pub(crate) fn uncertainty_growth(&self) -> f64 {
        1.0 / sin_cos_of_degrees(self.astronomic_deg()).1
    }
}

impl AzimuthMark {
    fn pillar(&self) -> Place {
        Place { latitude_deg: self.pillar_latitude_deg, longitude_deg: self.pillar_longitude_deg }
    }

    fn mark(&self) -> Place {
        Place { latitude_deg: self.latitude_deg, longitude_deg: self.longitude_deg }
    }

    fn check(&self, at: &Path, problems: &mut Problems) {
        for (latitude_key, latitude, longitude_key, longitude) in [
            ("latitude_deg", self.latitude_deg, "longitude_deg", self.longitude_deg),
            ("pillar_latitude_deg", self.pillar_latitude_deg, "pillar_longitude_deg", self.pillar_longitude_deg),
        ] {
            check_latitude_range(&at.key(latitude_key), Some(latitude), Some(longitude), problems);
            problems.within(&at.key(longitude_key), Some(longitude), -180.0, 180.0);
        }
        problems.within(&at.key("position_u_m"), self.position_u_m, 0.0, LARGEST_POSITION_U_M);
        let inside = |latitude: f64, longitude: f64| latitude.abs() <= 90.0 && longitude.abs() <= 180.0;
        let known = inside(self.latitude_deg, self.longitude_deg)
            && inside(self.pillar_latitude_deg, self.pillar_longitude_deg);
        if known && earth::distance_m(self.pillar(), self.mark()) < 1.0 {
            problems.at(at, "pillar and mark less than 1 m apart", "two points that define a direction", "");
        }
    }
}

/// Reports a latitude beyond ±90°, and advises if it may be a longitude.
fn check_latitude_range(at: &Path, latitude_deg: Option<f64>, longitude_deg: Option<f64>, problems: &mut Problems) {
    let Some(latitude) = latitude_deg.filter(|latitude| !(-90.0..=90.0).contains(latitude)) else { return };
    let exchanged = latitude.abs() <= 180.0 && longitude_deg.is_some_and(|longitude| longitude.abs() <= 90.0);
    let exchange = || exchanged.then(|| "check whether latitude and longitude are exchanged".to_owned());
    let advice = exchange().or_else(|| decimal_degrees(latitude, 90.0)).unwrap_or_default();
    problems.at(at, format!("{latitude}"), "a number from -90 to 90", advice);
}

/// Returns the advice for a longitude that is counted up to 360 degrees, or `None` for any other.
pub(crate) fn beyond_180(longitude: f64) -> Option<String> {
    (longitude.abs() <= 360.0).then(|| {
        let meant = without_full_turns(longitude, 360.0, -180.0).unwrap_or_default();
        format!("count from -180 to 180, negative in the west; this longitude is {meant}")
    })
}

/// Returns the advice for an angle beyond `largest` degrees that may be in degrees and minutes, `dddmm.m`, as
/// satellite receivers write it; otherwise `None`.
fn decimal_degrees(angle: f64, largest: f64) -> Option<String> {
    let (degrees, minutes) = ((angle.abs() / 100.0).trunc(), angle.abs() % 100.0);
    let decimal = (degrees + minutes / 60.0).copysign(angle);
    (minutes < 60.0 && decimal.abs() <= largest)
        .then(|| format!("write decimal degrees; {degrees} degrees {minutes:.1} minutes would be {decimal:.5}"))
}

/// Returns the advice for gravity that may be in another unit; empty if none explains it.
fn gravity_in_another_unit(gravity: f64) -> String {
    const UNITS: [(&str, f64); 3] = [("Gal (cm/s²)", 1e-2), ("mGal", 1e-5), ("µm/s²", 1e-6)];
    let explains = |(_, factor): &&(&str, f64)| GRAVITY_M_PER_S2.contains(&(gravity * factor));
    UNITS.iter().find(explains).map_or_else(String::new, |(unit, factor)| {
        format!("write m/s²; if it is in {unit}, it is {:.5} m/s²", gravity * factor)
    })
}
