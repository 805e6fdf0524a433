//! Area where a passport is valid: a schematic map around the site, north at the top.

use super::drawing::{Anchor, Panel, Point, arrow, coordinate, legend, line, number, rectangle, round_below, words};
use crate::passport::Content;
use crate::report::page::language::{Language, Languages, Text, values};
use crate::report::page::number::{LATITUDES, LONGITUDES, Number, localised};
use crate::report::page::spacing::BLANK;
use crate::report::page::texts::{pictures as texts, units};
use crate::units::{ARCSECONDS_PER_DEGREE, sin_cos_of_degrees};
use maud::{Markup, html};

const PANEL_PIXELS: u32 = 260;
const SIZE: Point = [300.0, 340.0];
const CENTRE: Point = [150.0, 146.0];
/// Drawn validity radius, length of the compass lines, and length of the line to the azimuth mark.
const RADIUS: f64 = 92.0;
const COMPASS: f64 = 120.0;
const MARK: f64 = 124.0;
/// First line below the map, and the distance between lines.
const BELOW: f64 = 304.0;
const LINE: f64 = 15.0;

/// Largest number of decimals of a coordinate: a tenth of a metre.
const MOST_DECIMALS: usize = 6;

/// Draws the validity radius of a passport, or a band of latitude if its site has no longitude.
pub(crate) fn place(languages: &Languages, content: &Content) -> Markup {
    let panel = Panel { name: "place", languages, size: SIZE };
    let band = content.site.longitude_deg.is_none();
    let area = if band { band_area() } else { circle_area() };
    let drawing = [
        html! { @if band { (panel.hatch("band")) } },
        area,
        compass(languages),
        mark(content),
        radius(languages, content),
        scale_bar(languages, content.earth.valid_radius_m),
        coordinates(languages, content),
    ];
    let description = |language| in_words(language, content);
    panel.alone(PANEL_PIXELS, texts::PLACE_TITLE, description, &drawing, &key(languages, content))
}

fn key(languages: &Languages, content: &Content) -> Markup {
    let mut entries =
        vec![(site([14.0, 7.0]), texts::PLACE_SITE), (line([2.0, 7.0], [26.0, 7.0], "limit"), texts::PLACE_LIMIT)];
    if content.earth.azimuth_deg.is_some() {
        entries.push((arrow([2.0, 7.0], [26.0, 7.0], "real"), texts::PLACE_MARK));
    }
    legend(languages, &entries)
}

/// Draws the site: a point within a ring.
fn site([x, y]: Point) -> Markup {
    let (x, y) = (coordinate(x), coordinate(y));
    html! {
        circle.site cx=(x) cy=(y) r="5" {}
        circle.pin cx=(x) cy=(y) r="1.8" {}
    }
}

fn circle_area() -> Markup {
    let [x, y] = CENTRE.map(coordinate);
    html! {
        circle.within cx=(x) cy=(y) r=(coordinate(RADIUS)) {}
        circle.limit cx=(x) cy=(y) r=(coordinate(RADIUS)) {}
    }
}

fn band_area() -> Markup {
    let [_, y] = CENTRE;
    let [left, right] = [8.0, SIZE[0] - 8.0];
    html! {
        (rectangle([left, y - RADIUS], [right, y + RADIUS], "within", None))
        (line([left, y - RADIUS], [right, y - RADIUS], "limit"))
        (line([left, y + RADIUS], [right, y + RADIUS], "limit"))
    }
}

fn compass(languages: &Languages) -> Markup {
    let [x, y] = CENTRE;
    let letter = |at: Point, anchor: Anchor, text: Text| words(at, anchor, "", &languages.plain(text));
    html! {
        (line([x - COMPASS, y], [x + COMPASS, y], "grid"))
        (line([x, y + COMPASS], [x, y], "grid"))
        (arrow([x, y], [x, y - COMPASS], "meridian"))
        (words([x, y - COMPASS - 6.0], Anchor::Middle, "", &languages.plain(texts::NORTH_LETTER)))
        (letter([x + COMPASS + 3.0, y - 5.0], Anchor::Middle, texts::EAST_LETTER))
        (letter([x - COMPASS - 3.0, y - 5.0], Anchor::Middle, texts::WEST_LETTER))
        (letter([x + 5.0, y + COMPASS], Anchor::Start, texts::SOUTH_LETTER))
        (site(CENTRE))
    }
}

/// Returns the point at `distance` units from the site, in a direction clockwise from north.
fn towards(azimuth_deg: f64, distance: f64) -> Point {
    let (sin, cos) = sin_cos_of_degrees(azimuth_deg);
    [CENTRE[0] + distance * sin, CENTRE[1] - distance * cos]
}

fn mark(content: &Content) -> Markup {
    let Some(azimuth_deg) = content.earth.azimuth_deg else { return html! {} };
    const ARC: f64 = 34.0;
    let (start, end) = (towards(0.0, ARC), towards(azimuth_deg, ARC));
    let large = if azimuth_deg > 180.0 { "1" } else { "0" };
    let [[x1, y1], [x2, y2]] = [start, end].map(|at| at.map(coordinate));
    let radius = coordinate(ARC);
    let tip = towards(azimuth_deg, MARK);
    html! {
        path.dimension d={ "M" (x1) "," (y1) "A" (radius) "," (radius) " 0 " (large) " 1 " (x2) "," (y2) } {}
        (arrow(CENTRE, tip, "real"))
    }
}

/// Draws the radius with its length, on the side away from the azimuth mark.
fn radius(languages: &Languages, content: &Content) -> Markup {
    let metres = content.earth.valid_radius_m;
    let printed =
        format!("{}\u{a0}{}", Number::fixed(metres, 0).text(languages.first()), units::METRES.of(languages.first()));
    let band = content.site.longitude_deg.is_none();
    let mark_is_east = content.earth.azimuth_deg.is_some_and(|azimuth_deg| azimuth_deg < 180.0);
    let side = if mark_is_east { -1.0 } else { 1.0 };
    let tip = if band { [CENTRE[0] + side * 70.0, CENTRE[1] + RADIUS] } else { towards(side * 135.0, RADIUS) };
    let from = if band { [tip[0], CENTRE[1]] } else { CENTRE };
    let middle = [0.5 * (from[0] + tip[0]), 0.5 * (from[1] + tip[1])];
    let (at, anchor) = match (band, side > 0.0) {
        (true, true) => ([middle[0] + 6.0, middle[1] + 4.0], Anchor::Start),
        (true, false) => ([middle[0] - 6.0, middle[1] + 4.0], Anchor::End),
        (false, true) => ([middle[0], middle[1] - 8.0], Anchor::Start),
        (false, false) => ([middle[0], middle[1] - 8.0], Anchor::End),
    };
    html! { (arrow(from, tip, "dimension-arrow")) (number(at, anchor, "", metres, &printed)) }
}

fn scale_bar(languages: &Languages, radius_m: f64) -> Markup {
    let metres = round_below(radius_m);
    let length = metres / radius_m * RADIUS;
    let (left, y) = (12.0, 284.0);
    let kilometres = metres >= 1000.0;
    let (shown, unit) = if kilometres { (metres / 1000.0, units::KILOMETRES) } else { (metres, units::METRES) };
    let printed = localised(&format!("{shown}"), languages.first());
    html! {
        (rectangle([left, y - 4.0], [left + 0.5 * length, y], "pin", None))
        (rectangle([left, y - 4.0], [left + length, y], "frame-line", None))
        (words([left + length + 6.0, y + 1.0], Anchor::Start, "small", &format!("{printed}\u{a0}{}", languages.plain(unit))))
    }
}

/// Writes the coordinates below the map, where they cover nothing.
fn coordinates(languages: &Languages, content: &Content) -> Markup {
    let earth = &content.earth;
    let latitude = latitude_deg(content);
    let of = |value, hemispheres| in_hemisphere(languages, value, hemispheres);
    let mut rows = vec![(texts::LATITUDE, latitude, of(latitude, LATITUDES))];
    rows.extend(content.site.longitude_deg.map(|value| (texts::LONGITUDE, value, of(value, LONGITUDES))));
    let azimuth = |value| azimuth(content, value).text(languages.first()) + "°";
    rows.extend(earth.azimuth_deg.map(|value| (texts::AZIMUTH, value, azimuth(value))));
    html! {
        @for (row, (name, value, printed)) in rows.iter().enumerate() {
            @let y = BELOW + LINE * row as f64;
            (words([150.0, y], Anchor::End, "small", &languages.plain(*name)))
            (number([158.0, y], Anchor::Start, "", *value, printed))
        }
    }
}

/// Returns the azimuth, rounded to the second digit of its uncertainty.
fn azimuth(content: &Content, azimuth_deg: f64) -> Number {
    let u_arcsec = content.earth.azimuth_u_arcsec.unwrap_or(0.0);
    Number::measured(azimuth_deg, u_arcsec / ARCSECONDS_PER_DEGREE)
}

/// Returns the latitude that the site states: geodetic, otherwise astronomic.
fn latitude_deg(content: &Content) -> f64 {
    let site = &content.site;
    site.latitude_deg.or(site.astronomic_latitude_deg).unwrap_or(content.earth.latitude_deg)
}

/// Returns a coordinate with its hemisphere.
fn in_hemisphere(languages: &Languages, value: f64, hemispheres: [Text; 2]) -> String {
    let (number, hemisphere) = Number::at_most(value, MOST_DECIMALS).in_hemisphere(hemispheres);
    format!("{}°{BLANK}{}", number.text(languages.first()), languages.plain(hemisphere))
}

fn in_words(language: Language, content: &Content) -> String {
    let earth = &content.earth;
    let of = |value, hemispheres| in_hemisphere(&language.into(), value, hemispheres);
    let (radius, latitude) = (Number::fixed(earth.valid_radius_m, 0), of(latitude_deg(content), LATITUDES));
    let area = match content.site.longitude_deg.map(|value| of(value, LONGITUDES)) {
        Some(longitude) => texts::PLACE_CIRCLE.filled(language, values! { radius, latitude, longitude }),
        None => texts::PLACE_BAND.filled(language, values! { radius, latitude }),
    };
    let mark = match earth.azimuth_deg.map(|value| azimuth(content, value)) {
        Some(azimuth) => texts::PLACE_MARK_IN_WORDS.filled(language, values! { azimuth }),
        None => texts::PLACE_NO_MARK_IN_WORDS.of(language).to_owned(),
    };
    area + " " + &mark
}
