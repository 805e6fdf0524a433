//! Consistency of the data of a site: pillar with site, mark with pillar, gravity with latitude and height.
//!
//! Each of these states the place a second time, so a contradiction shows coordinates that are exchanged or have a
//! wrong sign.

use super::Site;
use crate::earth::{self, Place};
use crate::text::number::two_digits;
use crate::text::{Path, Problems};
use crate::units::{arcseconds_from_radians, distance, radians_from_degrees};

/// Largest distance of the pillar from the site, m.
const FARTHEST_PILLAR_M: f64 = 5_000.0;

/// Largest distance of the mark from the pillar, m.
const FARTHEST_MARK_M: f64 = 50_000.0;

/// Ratio of the distances from the site to the pillar and to the mark above which the two are taken to be exchanged.
const MARK_AT_THE_SITE: f64 = 5.0;

/// Largest difference between measured and normal gravity, m/s².
const LARGEST_ANOMALY_M_PER_S2: f64 = 5e-3;

/// Largest deficit of measured gravity relative to normal gravity at 0 m if the height is not stated, m/s².
const LARGEST_DEFICIT_WITHOUT_HEIGHT_M_PER_S2: f64 = 1.8e-2;

/// Usual errors in a pair of coordinates, each with the function that undoes it.
type Undo = fn(f64, f64) -> (f64, f64);
const USUAL_ERRORS: [(&str, Undo); 7] = [
    ("latitude and longitude exchanged", |latitude, longitude| (longitude, latitude)),
    ("the sign of the latitude reversed", |latitude, longitude| (-latitude, longitude)),
    ("the sign of the longitude reversed", |latitude, longitude| (latitude, -longitude)),
    ("the signs of both reversed", |latitude, longitude| (-latitude, -longitude)),
    ("latitude and longitude exchanged and the signs of both reversed", |latitude, longitude| (-longitude, -latitude)),
    ("latitude and longitude exchanged and the sign of the latitude reversed", |latitude, longitude| {
        (-longitude, latitude)
    }),
    ("latitude and longitude exchanged and the sign of the longitude reversed", |latitude, longitude| {
        (longitude, -latitude)
    }),
];

/// Returns the usual error that explains `given`, that is, whose correction `fits`, or `None` if there is none.
fn usual_error(given: Place, fits: impl Fn(Place) -> bool) -> Option<&'static str> {
    let undone = |undo: &Undo| {
        let (latitude_deg, longitude_deg) = undo(given.latitude_deg, given.longitude_deg);
        Place { latitude_deg, longitude_deg }
    };
    let explains = |(_, undo): &&(&str, Undo)| {
        let place = undone(undo);
        place.latitude_deg.abs() <= 90.0 && fits(place)
    };
    USUAL_ERRORS.iter().find(explains).map(|(name, _)| *name)
}

impl Site {
    /// Reports all data of the place that contradict other data; skips coordinates out of range.
    pub(crate) fn check_consistency(&self, at: &Path, problems: &mut Problems) {
        let latitude = self.latitude_deg.or(self.astronomic_latitude_deg).map(|_| self.geodetic_deg());
        let Some(latitude_deg) = latitude.filter(|latitude| latitude.abs() <= 90.0) else { return };
        self.check_pillar(latitude_deg, at, problems);
        self.check_gravity(latitude_deg, at, problems);
    }

    fn check_pillar(&self, latitude_deg: f64, at: &Path, problems: &mut Problems) {
        let Some(mark) = &self.azimuth_mark else { return };
        let (pillar, mark) = (mark.pillar(), mark.mark());
        let at = at.key("azimuth_mark");
        let longitude_deg = self.longitude_deg.unwrap_or(pillar.longitude_deg);
        let site = Place { latitude_deg, longitude_deg };
        let in_latitude = if self.longitude_deg.is_some() { "" } else { " in latitude" };
        if let Some(metres) = farther_than(FARTHEST_PILLAR_M, site, pillar) {
            let of_site = self.longitude_deg.map_or(format!("latitude {latitude_deg}"), |_| coordinates(site));
            let found = format!("{}, {metres:.0} m{in_latitude} from the site at {of_site}", coordinates(pillar));
            let advice = advice("site and pillar", site, |place| earth::distance_m(place, pillar) <= FARTHEST_PILLAR_M);
            let expected = format!("a pillar within {FARTHEST_PILLAR_M} m of the site");
            problems.at(&at.key("pillar_latitude_deg"), found, expected, advice);
        }
        let [to_pillar, to_mark] = [pillar, mark].map(|to| earth::distance_m(site, to));
        if self.longitude_deg.is_some() && to_pillar <= FARTHEST_PILLAR_M && to_pillar > MARK_AT_THE_SITE * to_mark {
            let found =
                format!("{}, {to_pillar:.0} m from the site, but the mark {to_mark:.0} m from it", coordinates(pillar));
            let (expected, advice) = ("a pillar at the site", "check whether pillar and mark are exchanged");
            problems.at(&at.key("pillar_latitude_deg"), found, expected, advice);
        }
        if let Some(metres) = farther_than(FARTHEST_MARK_M, pillar, mark) {
            let found = format!("{}, {metres:.0} m from the pillar at {}", coordinates(mark), coordinates(pillar));
            let advice = advice("pillar and mark", mark, |place| earth::distance_m(place, pillar) <= FARTHEST_MARK_M);
            let expected = format!("a mark within {FARTHEST_MARK_M} m of the pillar");
            problems.at(&at.key("latitude_deg"), found, expected, advice);
        }
    }

    fn check_gravity(&self, latitude_deg: f64, at: &Path, problems: &mut Problems) {
        // Gravity beyond the range has been refused already.
        let Some(gravity) = self.gravity_m_per_s2.filter(|gravity| super::GRAVITY_M_PER_S2.contains(gravity)) else {
            return;
        };
        let deficit = match self.height_m {
            Some(_) => LARGEST_ANOMALY_M_PER_S2,
            None => LARGEST_DEFICIT_WITHOUT_HEIGHT_M_PER_S2,
        };
        let height_m = self.height_m.unwrap_or(0.0);
        let normal = |latitude_deg| earth::normal_gravity_m_per_s2(latitude_deg, height_m);
        let fits = |latitude_deg| (-deficit..=LARGEST_ANOMALY_M_PER_S2).contains(&(gravity - normal(latitude_deg)));
        if fits(latitude_deg) {
            return;
        }
        let here = normal(latitude_deg);
        let expected = format!(
            "{:.5} to {:.5}: normal gravity at latitude {latitude_deg} and {height_m} m{} is {here:.5}",
            here - deficit,
            here + LARGEST_ANOMALY_M_PER_S2,
            if self.height_m.is_some() { "" } else { " (no height is stated)" },
        );
        let exchanged = self.longitude_deg.is_some_and(|longitude| longitude.abs() <= 90.0 && fits(longitude));
        let advice = match exchanged {
            true => "check latitude, height and gravity; the value would agree with latitude and longitude exchanged",
            false => "check latitude, height and gravity",
        };
        problems.at(&at.key("gravity_m_per_s2"), format!("{gravity}"), expected, advice);
    }
}

impl Site {
    /// Returns what is possible, and therefore not refused, but usually an error: a sentence each, without a full stop.
    pub(crate) fn odd(&self) -> Vec<String> {
        let mut odd = Vec::new();
        if let (Some(gravity), None) = (self.gravity_m_per_s2, self.gravity_u_m_per_s2) {
            odd.push(if gravity == earth::STANDARD_GRAVITY_M_PER_S2 {
                let normal = Self { gravity_m_per_s2: None, ..self.clone() };
                format!(
                    "gravity_m_per_s2 is {gravity}, the standard acceleration and not that of a place, and counts as exact; \
                     without it the passport would state {:.4} with u = {}; remove it, or state a measured value",
                    normal.earth().gravity_m_per_s2,
                    normal.gravity_u_m_per_s2().unwrap_or_default()
                )
            } else {
                "gravity_m_per_s2 counts as exact, because no uncertainty is stated; state gravity_u_m_per_s2".to_owned()
            });
        }
        if self.deflection_arcsec.as_ref().is_some_and(|deflection| deflection.u.is_none()) {
            odd.push("deflection_arcsec counts as exact, because no uncertainty is stated; state its u".to_owned());
        }
        odd.extend(self.doubtful_mark());
        odd
    }

    /// Returns a sentence if the uncertainty of mark and pillar is not stated, or they were written with fewer digits than it
    /// needs.
    fn doubtful_mark(&self) -> Option<String> {
        let mark = self.azimuth_mark.as_ref()?;
        let coordinates = [mark.latitude_deg, mark.longitude_deg, mark.pillar_latitude_deg, mark.pillar_longitude_deg];
        let step_deg = coordinates.map(last_digit_deg).into_iter().fold(1.0, f64::min);
        // GUM, F.2.2.1.
        let rounding_m = radians_from_degrees(step_deg) * earth::MEAN_RADIUS_M / 12_f64.sqrt();
        let Some(stated_m) = mark.position_u_m else {
            let across_rad = rounding_m * std::f64::consts::SQRT_2 / earth::distance_m(mark.pillar(), mark.mark());
            return Some(format!(
                "azimuth_mark: position_u_m is not stated, so the azimuth of the mark counts as exact; mark and pillar are rounded \
                 to {step_deg} degrees, which alone gives the azimuth u = {}″; state position_u_m",
                two_digits(arcseconds_from_radians(across_rad))
            ));
        };
        (stated_m < rounding_m).then(|| {
            format!(
                "azimuth_mark: mark and pillar are rounded to {step_deg} degrees, which alone gives u = {rounding_m:.2} m, but \
                 position_u_m is {stated_m}; state all digits of the survey, or a larger position_u_m"
            )
        })
    }
}

/// Distance from every other known place from which coordinates may be wrong, and largest distance from one of them at which a
/// correction is taken to be right, m.
const ANOTHER_REGION_M: f64 = 1e6;
const SAME_REGION_M: f64 = 1e5;

/// Coordinates of towns, with the names by which a site may mention them.
const TOWNS: &str = include_str!("towns.txt");

impl Site {
    /// Returns the geodetic coordinates, or `None` if the site has no longitude.
    pub(crate) fn place(&self) -> Option<Place> {
        Some(Place { latitude_deg: self.geodetic_deg(), longitude_deg: self.longitude_deg? })
    }

    /// Returns a warning if the coordinates are far from the `others`, sites of the same stand, and from the towns that the
    /// site names, but near one of them after the correction of a usual error; otherwise `None`.
    pub(crate) fn misplaced(&self, others: &[(String, Place)]) -> Option<String> {
        let here = self.place()?;
        let text = format!("{} {}", self.id, self.name.as_deref().unwrap_or_default()).to_lowercase();
        let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric()).collect();
        let town = |line: &str| {
            let (latitude, rest) = line.split_once(' ')?;
            let (longitude, names) = rest.split_once(' ')?;
            let name = names.split(' ').find(|name| words.contains(name))?;
            let place = Place { latitude_deg: latitude.parse().ok()?, longitude_deg: longitude.parse().ok()? };
            Some((format!("the town {name:?} of its name"), place))
        };
        let known: Vec<(String, Place)> = TOWNS.lines().filter_map(town).chain(others.iter().cloned()).collect();
        if known.iter().any(|(_, place)| farther_than(ANOTHER_REGION_M, here, *place).is_none()) {
            return None;
        }
        known.iter().find_map(|(name, place)| {
            let error = usual_error(here, |meant| earth::distance_m(meant, *place) <= SAME_REGION_M)?;
            let away = distance(earth::distance_m(here, *place));
            Some(format!(
                "the coordinates {} are {away} from {name}; with {error} they would be near it; check them",
                coordinates(here)
            ))
        })
    }
}

/// Returns the place value of the last digit of a coordinate, degrees.
fn last_digit_deg(coordinate_deg: f64) -> f64 {
    let text = coordinate_deg.to_string();
    let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    format!("1e-{decimals}").parse().unwrap_or(1.0)
}

/// Returns the distance in metres, or `None` if it is within the limit or a place has coordinates out of range.
fn farther_than(limit_m: f64, from: Place, to: Place) -> Option<f64> {
    let is_place = |place: Place| place.latitude_deg.abs() <= 90.0 && place.longitude_deg.abs() <= 180.0;
    let known = is_place(from) && is_place(to);
    known.then(|| earth::distance_m(from, to)).filter(|metres| *metres > limit_m)
}

/// Returns the advice for two places that are too far from each other.
fn advice(both: &str, given: Place, fits: impl Fn(Place) -> bool) -> String {
    match usual_error(given, fits) {
        Some(error) => format!("check {both}: they agree with {error} in one of them"),
        None => "check both".to_owned(),
    }
}

fn coordinates(place: Place) -> String {
    format!("{}, {}", place.latitude_deg, place.longitude_deg)
}
