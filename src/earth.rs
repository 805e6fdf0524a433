//! Earth parameters at a site: Earth rate, gravity, deflection of the vertical and geodesics, with the source of each
//! constant.
//!
//! The latitude of a levelled stand is astronomic, because the stand follows the plumb line; the latitude of a place on
//! the ellipsoid is geodetic. Every name here says which one is meant.

use crate::attitude::PAPER_FRAME_AXIS_AZIMUTH_DEG;
use crate::coefficients::EarthRate;
use crate::units::{
    ARCSECONDS_PER_DEGREE, arcseconds_from_radians, degrees_from_radians, degrees_per_hour_from_radians_per_second,
    radians_from_degrees, sin_cos_of_degrees,
};
#[cfg(test)]
use geographiclib_rs::DirectGeodesic;
use geographiclib_rs::{Geodesic, InverseGeodesic};

/// Earth rate Ω, rad/s: 7.292115e-5 ([IERS](crate::bibliography::Bibliography::Iers10),
/// [WGS 84](crate::bibliography::Bibliography::Wgs84)).
pub(crate) const ROTATION_RAD_PER_S: f64 = 7.292115e-5;

/// Returns the Earth rate Ω, °/h.
pub(crate) fn rotation_deg_per_h() -> f64 {
    degrees_per_hour_from_radians_per_second(ROTATION_RAD_PER_S)
}

impl EarthRate {
    /// Creates the Earth rate at the astronomic latitude Φ, degrees: ω_Γ = Ω cos Φ and ω_B = Ω sin Φ (paper, eq. (5)).
    /// The frame's axis points east, as in the paper.
    pub fn at_astronomic_latitude(latitude_deg: f64) -> Self {
        let (sin, cos) = sin_cos_of_degrees(latitude_deg);
        let rotation = rotation_deg_per_h();
        Self {
            horizontal_deg_per_h: rotation * cos,
            vertical_deg_per_h: rotation * sin,
            frame_axis_azimuth_deg: PAPER_FRAME_AXIS_AZIMUTH_DEG,
        }
    }

    /// Returns the astronomic latitude Φ, degrees, without the last digits, which are those of the rounded components.
    pub(crate) fn astronomic_latitude_deg(&self) -> f64 {
        let latitude_deg = degrees_from_radians(libm::atan2(self.vertical_deg_per_h, self.horizontal_deg_per_h));
        (1e9 * latitude_deg).round() / 1e9
    }
}

/// Returns the astronomic latitude Φ = φ + ξ, degrees, where ξ is positive if the astronomic zenith is north of the
/// geodetic zenith ([Heiskanen and Moritz](crate::bibliography::Bibliography::HeiskanenMoritz67), section 2-20).
pub(crate) fn astronomic_latitude_deg(geodetic_latitude_deg: f64, xi_arcsec: f64) -> f64 {
    geodetic_latitude_deg + xi_arcsec / ARCSECONDS_PER_DEGREE
}

/// Point on the WGS 84 ellipsoid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Geodetic latitude, degrees.
    pub latitude_deg: f64,
    /// Longitude, degrees, positive to the east.
    pub longitude_deg: f64,
}

/// Rounding unit of lengths before signing, m; geographiclib-rs uses the platform's trigonometry.
pub(crate) const LENGTH_QUANTUM_M: f64 = 1e-6;

/// Rounding unit of azimuths before signing, degrees.
pub(crate) const AZIMUTH_QUANTUM_DEG: f64 = 1e-10;

/// Rounds to a multiple of 1/`per_unit`, for example metres to micrometres with 1e6.
fn rounded(value: f64, per_unit: f64) -> f64 {
    (value * per_unit).round() / per_unit
}

/// Returns the geodesic distance between two places, m, rounded to 1 µm
/// ([Karney](crate::bibliography::Bibliography::Karney13)).
pub(crate) fn distance_m(from: Place, to: Place) -> f64 {
    let metres: f64 =
        Geodesic::wgs84().inverse(from.latitude_deg, from.longitude_deg, to.latitude_deg, to.longitude_deg);
    rounded(metres, 1e6)
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Azimuth {
    /// Azimuth, degrees, clockwise from north, 0 ≤ azimuth < 360.
    pub azimuth_deg: f64,
    /// Standard uncertainty, arcsec; `None` if that of the coordinates or of η is not stated.
    pub u_arcsec: Option<f64>,
}

/// Returns the astronomic azimuth from `pillar` to `mark`, geodetic azimuth + η tan Φ, rounded to 1e-10°
/// ([Heiskanen and Moritz](crate::bibliography::Bibliography::HeiskanenMoritz67), section 5-4).
///
/// η, the component of the deflection of the vertical that is positive if the astronomic zenith is east of the geodetic
/// zenith, and its standard uncertainty are in arcsec, and Φ, the astronomic latitude of the pillar, in degrees.
/// `position_u_m` is the standard uncertainty of each coordinate of both points, m; both points contribute across the
/// line of sight. Without it, or without the uncertainty of η, the azimuth has no stated uncertainty.
pub(crate) fn astronomic_azimuth(
    [pillar, mark]: [Place; 2],
    (eta_arcsec, eta_u_arcsec): (f64, Option<f64>),
    latitude_deg: f64,
    position_u_m: Option<f64>,
) -> Azimuth {
    // The type of the tuple selects the values: distance, azimuth at 1, azimuth at 2, arc length.
    let (metres, geodetic_deg, _, _): (f64, f64, f64, f64) =
        Geodesic::wgs84().inverse(pillar.latitude_deg, pillar.longitude_deg, mark.latitude_deg, mark.longitude_deg);
    let (sin, cos) = sin_cos_of_degrees(latitude_deg);
    let tan = sin / cos;
    let astronomic = geodetic_deg + eta_arcsec * tan / ARCSECONDS_PER_DEGREE;
    let azimuth_deg = rounded(astronomic, 1e10).rem_euclid(360.0);
    let u_arcsec = position_u_m.zip(eta_u_arcsec).map(|(u_m, eta_u)| {
        let sight = arcseconds_from_radians(u_m * std::f64::consts::SQRT_2 / metres);
        libm::hypot(sight, eta_u * tan)
    });
    Azimuth { azimuth_deg, u_arcsec: u_arcsec.map(|u| rounded(u, 1e6)) }
}

/// Returns the validity radius, m, rounded to 1 µm: the shorter distance along the meridian, north or south, at which
/// ω_Γ or ω_B has changed by `within_deg_per_h`.
///
/// `latitude_deg` is the astronomic latitude of the passport's Earth rate, and `from` is the place on the ellipsoid.
/// `within_deg_per_h` must be positive and at most 1.
pub(crate) fn validity_radius_m(latitude_deg: f64, from: Place, within_deg_per_h: f64) -> f64 {
    let share = within_deg_per_h / rotation_deg_per_h();
    let towards = |north: f64| {
        let change_deg = north * latitude_change_deg(latitude_deg, north, share);
        let latitude_deg = from.latitude_deg + change_deg;
        // Up to the pole the rates change by less than the limit, so the other direction determines the radius.
        if latitude_deg.abs() > 90.0 {
            return f64::INFINITY;
        }
        let metres: f64 =
            Geodesic::wgs84().inverse(from.latitude_deg, from.longitude_deg, latitude_deg, from.longitude_deg);
        metres
    };
    rounded(towards(1.0).min(towards(-1.0)), 1e6)
}

/// Returns the smallest change of latitude, degrees, positive, that changes its cosine or its sine by `share`,
/// northwards (`north` = 1) or southwards (`north` = −1).
///
/// The larger of |cos(Φ + δ) − cos Φ| and |sin(Φ + δ) − sin Φ| is 2 sin(δ/2) times the larger of |sin(Φ + δ/2)| and
/// |cos(Φ + δ/2)|, which is never below 1/√2. The equation δ = 2 asin(share / (2 larger)) can therefore be iterated;
/// each step gains a factor of about 1/`share`.
fn latitude_change_deg(latitude_deg: f64, north: f64, share: f64) -> f64 {
    const STEPS: usize = 60;
    let latitude = radians_from_degrees(latitude_deg);
    let mut delta = share;
    for _ in 0..STEPS {
        let (sin, cos) = libm::sincos(latitude + north * delta / 2.0);
        let next = 2.0 * libm::asin(share / (2.0 * sin.abs().max(cos.abs())));
        if (next - delta).abs() <= f64::EPSILON * next {
            return degrees_from_radians(next);
        }
        delta = next;
    }
    degrees_from_radians(delta)
}

/// WGS 84: semi-major axis, m.
const A_M: f64 = 6_378_137.0;
/// WGS 84: flattening.
const F: f64 = 1.0 / 298.257_223_563;
/// WGS 84: first eccentricity squared.
const E2: f64 = 0.006_694_379_990_14;
/// WGS 84: normal gravity at the equator, m/s².
const GAMMA_E: f64 = 9.780_325_335_9;
/// WGS 84: Somigliana's constant.
const K: f64 = 0.001_931_852_652_41;
/// WGS 84: m = ω² a² b / GM.
const M: f64 = 0.003_449_786_506_84;

/// Standard uncertainty of normal gravity at a known height as an estimate of gravity, m/s²: 50 mGal, the size of
/// gravity anomalies outside high mountains
/// ([Heiskanen and Moritz](crate::bibliography::Bibliography::HeiskanenMoritz67), chapter 7).
pub(crate) const NORMAL_GRAVITY_U_M_PER_S2: f64 = 5e-4;

/// Standard uncertainty of normal gravity at 0 m as an estimate of gravity at an unknown height, m/s².
///
/// Gravity decreases by 3.086e-6 m/s² per metre of height, which is 1.23e-2 at 4,000 m. If all heights from 0 m to
/// 4,000 m are equally probable, the root mean square error of the value at 0 m is 1.23e-2/√3.
pub(crate) const NORMAL_GRAVITY_WITHOUT_HEIGHT_U_M_PER_S2: f64 = 7.1e-3;

/// Standard gravity, m/s²: the g of a gyro type that states none.
pub(crate) const STANDARD_GRAVITY_M_PER_S2: f64 = 9.80665;

/// Mean radius of the Earth, m, (2a + b)/3, for limits that need few digits.
pub(crate) const MEAN_RADIUS_M: f64 = 6_371_008.8;

/// Returns normal gravity, m/s², at a geodetic latitude, degrees, and a height above the ellipsoid, m
/// ([WGS 84](crate::bibliography::Bibliography::Wgs84), eq. 4-1 and 4-3).
pub fn normal_gravity_m_per_s2(geodetic_latitude_deg: f64, height_m: f64) -> f64 {
    let (sin, _) = sin_cos_of_degrees(geodetic_latitude_deg);
    let sin2 = sin * sin;
    let on_ellipsoid = GAMMA_E * (1.0 + K * sin2) / (1.0 - E2 * sin2).sqrt();
    let h = height_m / A_M;
    on_ellipsoid * (1.0 - 2.0 * (1.0 + F + M - 2.0 * F * sin2) * h + 3.0 * h * h)
}

/// Returns the place at the distance `metres` from `from` in the direction `azimuth_deg`, for tests.
#[cfg(test)]
pub(crate) fn place_at(from: Place, azimuth_deg: f64, metres: f64) -> Place {
    let (latitude_deg, longitude_deg): (f64, f64) =
        Geodesic::wgs84().direct(from.latitude_deg, from.longitude_deg, azimuth_deg, metres);
    Place { latitude_deg, longitude_deg }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: published WGS 84 values at 0°, 45°, 90° (see docs/model.md), to the printed digit.
    #[test]
    fn normal_gravity_on_the_ellipsoid() {
        for (latitude, gravity) in [(0.0, 9.7803253359), (45.0, 9.8061977694), (90.0, 9.8321849379)] {
            assert!((normal_gravity_m_per_s2(latitude, 0.0) - gravity).abs() < 6e-11, "{latitude}");
        }
        // The free-air gradient at 45° is 0.3086 mGal/m (Heiskanen and Moritz, eq. 2-123).
        let gradient = (normal_gravity_m_per_s2(45.0, 0.0) - normal_gravity_m_per_s2(45.0, 1.0)) * 1e5;
        assert!((gradient - 0.3086).abs() < 2e-4, "{gradient}");
    }

    /// Expected: the reference vectors give 15.04106687606545 °/h.
    #[test]
    fn rotation_in_degrees_per_hour() {
        assert_eq!(rotation_deg_per_h(), 15.041_066_876_065_45);
    }

    /// Expected: 0.001 °/h is 513 m in Moscow (docs/model.md); at the equator Ω alone counts: 0.001/15.041 rad over
    /// the meridian's radius of curvature there, a(1−e²) = 6,335,439.3 m.
    #[test]
    fn validity_radius() {
        let moscow = Place { latitude_deg: 55.7658, longitude_deg: 37.6856 };
        assert_eq!(validity_radius_m(55.7658, moscow, 0.001).round(), 513.0);
        let equator = Place { latitude_deg: 0.0, longitude_deg: 9.0 };
        let expected = 0.001 / 15.041_066_876_065_45 * 6_335_439.327;
        assert!((validity_radius_m(0.0, equator, 0.001) - expected).abs() < 1e-3);
        // At the pole only the horizontal rate changes, over a/sqrt(1−e²) = 6,399,593.6 m.
        let near_pole = Place { latitude_deg: 89.0, longitude_deg: 0.0 };
        let expected = 0.001 / (15.041_066_876_065_45 * 0.999_847_695) * 6_399_593.6;
        assert!((validity_radius_m(89.0, near_pole, 0.001) - expected).abs() < 0.1);
    }

    /// Expected: at the radius one of the two rates has changed by the limit, and none has before.
    #[test]
    fn at_the_radius_a_rate_has_changed_by_the_limit() {
        for latitude in [-77.85, -33.78, -0.18, 0.0, 12.3, 45.0, 55.7658, 78.93, 89.5] {
            for within in [1e-6, 1e-3, 0.5] {
                let from = Place { latitude_deg: latitude, longitude_deg: 10.0 };
                let radius = validity_radius_m(latitude, from, within);
                let change = |metres: f64| {
                    [0.0, 180.0].map(|azimuth| {
                        let there = EarthRate::at_astronomic_latitude(place_at(from, azimuth, metres).latitude_deg);
                        let here = EarthRate::at_astronomic_latitude(latitude);
                        let horizontal = (there.horizontal_deg_per_h - here.horizontal_deg_per_h).abs();
                        horizontal.max((there.vertical_deg_per_h - here.vertical_deg_per_h).abs())
                    })
                };
                let reached = change(radius).into_iter().fold(0.0, f64::max);
                // Half a rounding unit of the radius, and the digits that a difference of latitudes loses.
                let tolerance = 0.5 * LENGTH_QUANTUM_M / radius + 1e-8;
                assert!((reached / within - 1.0).abs() < tolerance, "{latitude} {within}: {reached}");
                assert!(change(radius * 0.999).into_iter().all(|change| change < within));
            }
        }
    }

    /// Expected: Karney's published example, JFK to LHR (geographiclib documentation): 5,551.76 km.
    #[test]
    fn geodesic_distance() {
        let jfk = Place { latitude_deg: 40.6, longitude_deg: -73.8 };
        let lhr = Place { latitude_deg: 51.6, longitude_deg: -0.5 };
        assert!((distance_m(jfk, lhr) / 1000.0 - 5551.759).abs() < 0.001);
    }

    /// Expected: due east at the equator is 90° exactly; a plumb line 10″ east at 45° adds 10″ tan 45°; 2 cm at both
    /// ends over 2 km is 0.02·√2/2000 rad = 2.917″.
    #[test]
    fn azimuth_of_a_mark() {
        let pillar = Place { latitude_deg: 0.0, longitude_deg: 0.0 };
        let east = Place { latitude_deg: 0.0, longitude_deg: 1.0 };
        assert_eq!(astronomic_azimuth([pillar, east], (10.0, None), 0.0, None).azimuth_deg, 90.0);
        let pillar = Place { latitude_deg: 45.0, longitude_deg: 0.0 };
        let north = place_at(pillar, 0.0, 2000.0);
        let found = astronomic_azimuth([pillar, north], (10.0, Some(0.0)), 45.0, Some(0.02));
        assert!((found.azimuth_deg - 10.0 / 3600.0).abs() < 1e-9, "{found:?}");
        assert!((found.u_arcsec.unwrap() - 2.917).abs() < 1e-3, "{found:?}");
        let west_of_north = astronomic_azimuth([pillar, north], (-10.0, Some(0.0)), 45.0, Some(0.02));
        assert!((west_of_north.azimuth_deg - (360.0 - 10.0 / 3600.0)).abs() < 1e-9);
    }
}
