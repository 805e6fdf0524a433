//! Comparison of a place with the site that a passport was issued for.

use super::{Code, Content};
use crate::earth::{self, Place};
use crate::site::LATITUDE_MARGIN_ARCSEC;
use crate::site::Site;
use crate::units::{distance, radians_from_arcseconds};

/// Distance of a place from a passport's site, and the limit for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Nearness {
    /// Geodesic distance; along the meridian if the site has no longitude.
    pub distance_m: f64,
    /// Validity radius, including the allowance.
    pub radius_m: f64,
    /// Allowance for an unknown deflection of the vertical; 0 if it is known.
    pub allowance_m: f64,
}

impl Nearness {
    /// Computes the distance of `place` from the site of `content`.
    pub(crate) fn of(content: &Content, place: Place) -> Self {
        let site = &content.site;
        let latitude_deg = site.geodetic_deg();
        let known = Place { latitude_deg, longitude_deg: site.longitude_deg.unwrap_or(place.longitude_deg) };
        let allowance_m = if site.geodetic_is_uncertain() {
            radians_from_arcseconds(LATITUDE_MARGIN_ARCSEC) * earth::MEAN_RADIUS_M
        } else {
            0.0
        };
        let radius_m = content.earth.valid_radius_m + allowance_m;
        Self { distance_m: earth::distance_m(known, place), radius_m, allowance_m }
    }

    /// Returns `true` if the place is within the validity radius.
    pub(crate) fn within(self) -> bool {
        self.distance_m <= self.radius_m
    }
}

/// Returns the result code for a place, with an explanation.
pub(super) fn verdict(content: &Content, place: Place) -> (Code, String) {
    let site = &content.site;
    let nearness = Nearness::of(content, place);
    let Nearness { distance_m, radius_m, allowance_m } = nearness;
    let how = if site.longitude_deg.is_some() { "" } else { " in latitude (the longitude of the site is unknown)" };
    let unknown = format!("the unknown deflection of the vertical ({LATITUDE_MARGIN_ARCSEC}″)");
    let allowance = (allowance_m > 0.0).then(|| format!(", of which {} allow for {unknown}", distance(allowance_m)));
    let allowance = allowance.unwrap_or_default();
    let words =
        format!("{} from {}{how}; validity radius {}{allowance}", distance(distance_m), site.id, distance(radius_m));
    if nearness.within() {
        return (Code::Ok, words);
    }
    let advice = mistaken(content, place).unwrap_or("request a re-issue for this place from the factory");
    (Code::WrongPlace, format!("{words}; {advice}"))
}

/// Returns the advice on coordinates that are those of the site once they are exchanged or have another sign, or `None`.
fn mistaken(content: &Content, place: Place) -> Option<&'static str> {
    let Place { latitude_deg, longitude_deg } = place;
    let within = |latitude_deg, longitude_deg| Nearness::of(content, Place { latitude_deg, longitude_deg }).within();
    let may_be_exchanged = content.site.longitude_deg.is_some() && longitude_deg.abs() <= 90.0;
    if may_be_exchanged && within(longitude_deg, latitude_deg) {
        Some("check whether latitude and longitude are exchanged")
    } else if within(latitude_deg, -longitude_deg) {
        Some("check the sign of the longitude; it is negative in the west")
    } else if within(-latitude_deg, longitude_deg) {
        Some("check the sign of the latitude; it is negative in the south")
    } else if within(-latitude_deg, -longitude_deg) {
        Some("check the signs of latitude and longitude; they are negative in the south and in the west")
    } else {
        None
    }
}

/// Largest distance by which the coordinates of a site are usually corrected, m.
const LARGEST_CORRECTION_M: f64 = 10_000.0;

/// Returns a warning if `site`, which has the identifier of the site of a passport, is so far from it that it is another
/// place, or its coordinates are wrong; otherwise `None`.
pub(crate) fn distant_correction(content: &Content, site: &Site) -> Option<String> {
    let old = &content.site;
    let longitude_deg = site.longitude_deg.or(old.longitude_deg).unwrap_or_default();
    let place = Place { latitude_deg: site.geodetic_deg(), longitude_deg };
    let Nearness { distance_m, .. } = Nearness::of(content, place);
    (site.id == old.id && distance_m > LARGEST_CORRECTION_M).then(|| {
        let another = "for another site, use another id";
        format!(
            "the coordinates of {} are {} from those in the predecessor; {}",
            site.id,
            distance(distance_m),
            mistaken(content, place).unwrap_or(another)
        )
    })
}
