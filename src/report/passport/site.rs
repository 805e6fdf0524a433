//! The site, and the Earth there.

use crate::passport::Content;
use crate::report::doc::{Block, Words, field, given, heading, record, symbol, wide, with};
use crate::site::{Earth, Site};
use crate::units::{ARCSECONDS_PER_DEGREE, sin_cos_of_degrees};
use crate::wording::number::{LATITUDES, LONGITUDES};
use crate::wording::texts::{passport as texts, units};
use crate::wording::{Number, Text};

/// Length of a degree on the ground, in metres, for the number of printed digits.
const METRES_PER_DEGREE: f64 = 111e3;

pub(super) fn section(content: &Content) -> Vec<Block> {
    let place = vec![heading(texts::SITE), site(&content.site), mark(&content.site)];
    vec![Block::Within("titled", place), heading(texts::EARTH), earth(&content.site, &content.earth)]
}

fn exactly(value: f64, unit: Text) -> Words {
    Words::Quantity(Number::exact(value), unit)
}

fn site(site: &Site) -> Block {
    let arcsec = |value| exactly(value, units::ARCSEC);
    let measured = |value: f64, u: f64| Words::Quantity(Number::measured(value, u), units::ARCSEC);
    let deflection = site.deflection_arcsec.as_ref().map(|deflection| {
        let [xi, eta] = [deflection.xi, deflection.eta].map(|value| match deflection.u {
            Some(u) => measured(value, u),
            None => arcsec(value),
        });
        let mut all = vec![symbol("ξ"), "\u{a0}".into(), xi, ", ".into(), symbol("η"), "\u{a0}".into(), eta];
        if let Some(u) = deflection.u {
            all.extend([", ".into(), symbol("u"), "\u{a0}".into(), arcsec(u)]);
        }
        all
    });
    let latitude = |degrees| Words::Coordinate(Number::exact(degrees), LATITUDES);
    let longitude = |degrees| Words::Coordinate(Number::exact(degrees), LONGITUDES);
    let base = site.uncertainty.as_ref();
    record([
        wide(texts::NAME, site.name.as_ref().map(given)),
        field(texts::SITE_ID, Some(given(site.id.as_str()))),
        field(texts::ASTRONOMIC_LATITUDE, site.astronomic_latitude_deg.map(latitude)),
        field(texts::LATITUDE, site.latitude_deg.map(latitude)),
        field(texts::LONGITUDE, site.longitude_deg.map(longitude)),
        field(texts::HEIGHT, site.height_m.map(|height| exactly(height, units::METRES))),
        field(texts::DEFLECTION, deflection),
        field(texts::GRAVITY_MEASURED, site.gravity_m_per_s2.map(|value| gravity(value, site.gravity_u_m_per_s2))),
        field(texts::FRAME_AXIS, site.frame_axis_azimuth_deg.map(|azimuth| exactly(azimuth, units::DEGREES))),
        field(texts::LATITUDE_U, base.and_then(|base| base.latitude_arcsec).map(arcsec)),
        field(texts::AZIMUTH_U, base.and_then(|base| base.azimuth_arcsec).map(arcsec)),
        field(texts::LEVEL_U, base.and_then(|base| base.level_arcsec).map(arcsec)),
        wide(texts::SOURCE, site.source.as_ref().map(given)),
    ])
}

/// The azimuth mark, to the digits of the uncertainty of its place on the ground.
fn mark(site: &Site) -> Block {
    let Some(mark) = &site.azimuth_mark else { return record([]) };
    let u_deg = mark.position_u_m.unwrap_or(0.0) / METRES_PER_DEGREE;
    let pair = |latitude: f64, longitude: f64| {
        let cosine = sin_cos_of_degrees(latitude).1;
        let [latitude, longitude] =
            [Number::measured(latitude, u_deg), Number::measured(longitude, u_deg / cosine.max(f64::MIN_POSITIVE))];
        vec![Words::Coordinate(latitude, LATITUDES), ", ".into(), Words::Coordinate(longitude, LONGITUDES)]
    };
    record([
        field(texts::MARK, mark.name.as_ref().map(given)),
        field(texts::MARK_POSITION, Some(pair(mark.latitude_deg, mark.longitude_deg))),
        field(texts::PILLAR_POSITION, Some(pair(mark.pillar_latitude_deg, mark.pillar_longitude_deg))),
        field(texts::POSITION_U, mark.position_u_m.map(|u| exactly(u, units::METRES))),
    ])
}

/// Returns an angle in degrees to the digits of its uncertainty, or to a tenth of a metre on the ground.
fn angle(degrees: f64, u_arcsec: f64) -> Number {
    match u_arcsec {
        u if u > 0.0 => Number::measured(degrees, u / ARCSECONDS_PER_DEGREE),
        _ => Number::at_most(degrees, 6),
    }
}

/// Returns a value with its standard uncertainty, if that is known.
fn with_u(value: impl Into<Words>, u: Option<f64>, unit: Text) -> Words {
    with(value, "u", u.filter(|u| *u > 0.0).map(|u| Words::Quantity(Number::uncertainty(u), unit)))
}

/// Returns g, with its uncertainty if that is known.
pub(crate) fn gravity(value: f64, u: Option<f64>) -> Words {
    let number = u.map_or_else(|| Number::exact(value), |u| Number::measured(value, u));
    with_u(Words::Quantity(number, units::M_PER_S2), u, units::M_PER_S2)
}

fn earth(site: &Site, earth: &Earth) -> Block {
    let rate = |value: f64, u: f64| {
        // To the place that a usual latitude determines, if the uncertainty is not known.
        let number = if u > 0.0 { Number::measured(value, u) } else { Number::fixed(value, 5) };
        with_u(Words::Quantity(number, units::DEG_PER_H), Some(u), units::DEG_PER_H)
    };
    let radius = Words::Quantity(Number::fixed(earth.valid_radius_m, 0), units::METRES);
    let within = exactly(earth.valid_within_deg_per_h, units::DEG_PER_H);
    let azimuth = earth.azimuth_deg.map(|azimuth| {
        let number = angle(azimuth, earth.azimuth_u_arcsec.unwrap_or(0.0));
        with_u(Words::Quantity(number, units::DEGREES), earth.azimuth_u_arcsec, units::ARCSEC)
    });
    let latitude_u = site.astronomic_latitude_u_arcsec();
    let latitude = Words::Coordinate(angle(earth.latitude_deg, latitude_u), LATITUDES);
    let [horizontal_u, vertical_u] = earth.rate_u_deg_per_h(site);
    let earth_rate = Words::Quantity(Number::fixed(earth.rate_deg_per_h, 9), units::DEG_PER_H);
    record([
        field(texts::EARTH_RATE, Some(earth_rate)),
        field(texts::EARTH_LATITUDE, Some(with_u(latitude, Some(latitude_u), units::ARCSEC))),
        field(texts::HORIZONTAL, Some(rate(earth.horizontal_deg_per_h, horizontal_u))),
        field(texts::VERTICAL, Some(rate(earth.vertical_deg_per_h, vertical_u))),
        field(texts::GRAVITY, Some(gravity(earth.gravity_m_per_s2, site.gravity_u_m_per_s2()))),
        field(texts::AZIMUTH, azimuth),
        wide(texts::RADIUS, Some(texts::radius_within(radius, within))),
    ])
}
