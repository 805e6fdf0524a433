//! The stand in one large drawing with its parts, axes and angles named; the small pictures of the positions leave the
//! names out. The frame's axis points to its azimuth at the site.

use super::drawing::{Anchor, Point, arrow, coordinate, label, line, list, panel, panels, symbols, width, words};
use super::positions::{AXIS, AXIS_HEIGHT, GYRO, GYRO_HEIGHT, View, base_before, base_behind, rows, stand as parts};
use crate::attitude;
use crate::report::page::language::Languages;
use crate::wording::texts::{compass, pictures as texts};
use crate::wording::{Number, Words};
use maud::{Markup, html};
use nalgebra::{Matrix3, Vector3};

const PANEL_PIXELS: u32 = 300;
const SIZE: Point = [500.0, 282.0];
const CENTRE: Point = [262.0, 114.0];
const UNIT: f64 = 86.0;

/// Places and unit of the three directions east, north and up: clear of the plate, and where a name on the left has room.
const COMPASS: Point = [46.0, 250.0];
const COMPASS_TO_THE_LEFT: Point = [92.0, 250.0];
const COMPASS_UNIT: f64 = 36.0;

/// Angles of the drawing: large enough for their arcs, and no position of a stand.
const THETA_DEG: f64 = 40.0;
const PHI_DEG: f64 = 35.0;

/// Radius of the arc of θ and its distance from the centre; radius of the arc of φ, between platform and frame.
const THETA_ARC: f64 = 0.62;
const THETA_AT: f64 = 1.32;
const PHI_ARC: f64 = 0.75;

/// Draws the stand; its frame's axis ξ points to the azimuth `frame_axis_azimuth_deg`.
pub(crate) fn stand(languages: &Languages, frame_axis_azimuth_deg: f64) -> Markup {
    let base = attitude::base(frame_axis_azimuth_deg);
    let view = View::new(CENTRE, UNIT, &base);
    let turned = |theta_deg: f64, phi_deg: f64| attitude::nominal(theta_deg, phi_deg) * base;
    let (frame, platform) = (turned(THETA_DEG, 0.0), turned(THETA_DEG, PHI_DEG));
    let ([xi, across, _], [x, y, z]) = (rows(&frame), rows(&platform));
    let axle = xi * -THETA_AT;
    let theta = |share: f64| axle + rows(&turned(share * THETA_DEG, 0.0))[1] * THETA_ARC;
    let phi = |share: f64| rows(&turned(THETA_DEG, share * PHI_DEG))[0] * PHI_ARC;
    // Outside the middle of its arc.
    let theta_letter = theta(0.5) + (theta(0.5) - 0.5 * (theta(0.0) + theta(1.0))).normalize() * 0.14;
    let axis = |direction: &Vector3<f64>, from: f64| {
        arrow(view.point(&(direction * from)), view.point(&(direction * AXIS)), "axis")
    };
    let azimuth = Number::exact(frame_axis_azimuth_deg);
    let named = [
        (texts::PART_FRAME.into(), across * 0.8 + xi * 0.4, true),
        (texts::PART_PLATFORM.into(), x * -0.12 - y * 0.5, true),
        (texts::PART_PINS.into(), x * -0.5, true),
        (texts::PART_GYRO.into(), z * GYRO_HEIGHT, true),
        (texts::PART_BASE.into(), near_the_right_corner(&view, &base), true),
        (texts::part_axis(&azimuth), xi * 1.5, false),
    ];
    let named = named.map(|(text, at, within): (Words, _, _)| {
        let name = |language| text.plain(language);
        Part { names: languages.iter().map(name).collect(), at: view.point(&at), within }
    });
    let letters = [("x", x * 1.37), ("y", y * 1.37), ("z", z * 1.37), ("θ", theta_letter), ("φ", phi(0.5) * 1.11)];
    let letters = letters.map(|(name, at)| (name, view.point(&at)));
    let drawing = [
        parts(&view, &frame, &platform, (&base_behind(&view, &base), &base_before(&view, &base))),
        line(view.point(&(xi * -1.1)), view.point(&(xi * -1.6)), "axle"),
        arrow(view.point(&(xi * 1.1)), view.point(&(xi * 1.5)), "base-axis"),
        axis(&x, GYRO),
        axis(&y, GYRO),
        axis(&z, GYRO_HEIGHT),
        arc(&view, &theta, Some(axle)),
        arc(&view, &phi, None),
        html! { @for (name, at) in letters { (words([at[0], at[1] + 4.0], Anchor::Middle, "letter", name)) } },
        compass_rose(languages, &base),
        leaders(&named),
    ];
    let description = |language| texts::stand_description(&azimuth).plain(language);
    let title = |language| texts::STAND_TITLE.of(language).to_owned();
    let svg = panel(("stand", languages), SIZE, title, description, &drawing);
    panels(1, PANEL_PIXELS, &[svg], &html! {})
}

/// Returns a point of the plate near its rightmost corner, beside the posts.
fn near_the_right_corner(view: &View, base: &Matrix3<f64>) -> Vector3<f64> {
    let [xi, eta, _] = rows(base);
    let corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]
        .map(|(along, across)| xi * (1.4 * along) + eta * (0.6 * across) - Vector3::z() * AXIS_HEIGHT);
    let right = |at: &Vector3<f64>| view.point(at)[0];
    corners.into_iter().max_by(|one, other| right(one).total_cmp(&right(other))).unwrap_or_default()
}

/// Draws the arc of an angle with a head at its end, and from `corner` the two sides of the angle.
fn arc(view: &View, at: &impl Fn(f64) -> Vector3<f64>, corner: Option<Vector3<f64>>) -> Markup {
    const STEPS: u32 = 14;
    let points: Vec<Point> = (0..STEPS).map(|step| view.point(&at(f64::from(step) / f64::from(STEPS)))).collect();
    let last = points.last().copied().unwrap_or_default();
    html! {
        @if let Some(corner) = corner {
            @for end in [at(0.0), at(1.0)] { (line(view.point(&corner), view.point(&end), "ideal")) }
        }
        polyline.dimension points=(list(&points)) {}
        (arrow(last, view.point(&at(1.0)), "dimension-arrow"))
    }
}

/// Draws east, north and up, as the view shows them. Names stand on the outer side of the heads, each language on its own
/// line.
fn compass_rose(languages: &Languages, base: &Matrix3<f64>) -> Markup {
    const LINE: f64 = 16.0;
    let [east, north, up] = [Vector3::x(), Vector3::y(), Vector3::z()];
    let to_the_left = |direction| View::new([0.0; 2], COMPASS_UNIT, base).point(direction)[0] < 0.0;
    let centre = if [east, north].iter().any(to_the_left) { COMPASS_TO_THE_LEFT } else { COMPASS };
    let view = View::new(centre, COMPASS_UNIT, base);
    let directions = [(east, compass::EAST), (north, compass::NORTH), (up, compass::UP)];
    html! {
        @for (direction, name) in directions {
            @let ([x, y], vertical) = (view.point(&(direction * 1.1)), direction.z > 0.0);
            @let names: Vec<&str> = languages.iter().map(|language| name.of(language)).collect();
            @let anchor = if vertical { Anchor::Middle } else if x < centre[0] { Anchor::End } else { Anchor::Start };
            // Above an upward head, around a downward one.
            @let share = if vertical || y < centre[1] { 1.0 } else { 0.5 };
            @let first = y + 12.0 * (1.0 - share) - share * LINE * (names.len() - 1) as f64;
            (arrow(centre, view.point(&direction), "meridian"))
            @for (row, name) in names.iter().enumerate() {
                (words([x, first + LINE * row as f64], anchor, if row == 0 { "" } else { "soft" }, name))
            }
        }
    }
}

/// Part of the stand with a name.
struct Part {
    /// Names in the languages of the page.
    names: Vec<String>,
    /// Point to which the line from the name leads.
    at: Point,
    /// `true` if this point is inside the outline of the part.
    within: bool,
}

/// Writes the names of parts in a column on either side, each language on its own line, with a line from each name to its part.
fn leaders(named: &[Part]) -> Markup {
    const GAP: f64 = 3.0;
    const LINE: f64 = 17.0;
    const TOP: f64 = 30.0;
    const EDGE: f64 = 4.0;
    /// Width of a name, in widths of the same name in class `small`.
    const RESERVE: f64 = 1.17;
    let mut sorted: Vec<&Part> = named.iter().collect();
    sorted.sort_by(|one, other| one.at[1].total_cmp(&other.at[1]));
    let mut next = [TOP, TOP];
    let places = sorted.into_iter().map(|Part { names, at, within }| {
        let side = usize::from(at[0] > CENTRE[0]);
        // Two lines begin higher, so that the last stays above the directions.
        let y = (at[1] - LINE * (names.len() - 1) as f64).max(next[side]);
        next[side] = y + LINE * names.len() as f64 + GAP;
        // A name begins or ends at its line, so that the gap does not depend on the font.
        let inner = EDGE + RESERVE * names.iter().map(|name| width(name)).fold(0.0, f64::max);
        let (x, anchor, end) = match side {
            0 => (inner, Anchor::End, inner + GAP),
            _ => (SIZE[0] - inner, Anchor::Start, SIZE[0] - inner - GAP),
        };
        html! {
            (line([end, y], *at, "leader"))
            // ISO 128-2: a leader that ends within the outline of a part ends with a dot.
            @if *within { circle.leader-end cx=(coordinate(at[0])) cy=(coordinate(at[1])) r="1.6" {} }
            @for (row, name) in names.iter().enumerate() {
                (label([x, y + 4.0 + LINE * row as f64], anchor, if row == 0 { "" } else { "soft" }, &symbols(name)))
            }
        }
    });
    let places: Vec<Markup> = places.collect();
    html! { @for place in &places { (place) } }
}
