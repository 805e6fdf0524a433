//! Positions of the stand, drawn one by one: base, frame, platform, gyro, and the actual case axes.
//!
//! The view is a parallel projection with east, north and up as its axes. The base is rotated so that its axis ξ, the
//! frame's axis, points to its azimuth: east in the paper. Rotations are those of [`attitude`]; the rows of a matrix are
//! axes of the case or the base by their components east, north and up. Source:
//! [the paper](crate::bibliography::Bibliography::Tang17), fig. 2 and 3.

use super::drawing::{Anchor, Point, arrow, label, line, panel, panels, polygon, power_of_ten, words};
use crate::attitude::{self, Deviation};
use crate::report::page::language::Languages;
use crate::stand::CertifiedPosition;
use crate::units::{ARCSECONDS_PER_DEGREE, degrees_from_radians, sin_cos_of_degrees};
use crate::wording::texts::{compass, pictures as texts};
use crate::wording::{Language, Number, Text, Words};
use maud::{Markup, html};
use nalgebra::{Matrix3, Vector3};

/// Pixels that a panel needs for readable letters.
const PANEL_PIXELS: u32 = 155;
const COLUMNS: u32 = 4;
const SIZE: Point = [210.0, 222.0];
/// Centre of the stand on a drawing, and length of its unit.
const CENTRE: Point = [106.0, 113.0];
const UNIT: f64 = 52.0;

/// Direction from which the stand is viewed: from −η towards ξ, and above the horizon. It turns with the frame's axis,
/// so that no azimuth hides a part.
const VIEW_TOWARDS_XI_DEG: f64 = 34.0;
const VIEW_ABOVE_DEG: f64 = 24.0;

/// Dimensions of the frame in units of the stand: half its length along ξ and across, half the thickness of its bars.
pub(super) const FRAME_HALF: [f64; 2] = [0.98, 0.86];
pub(super) const BAR_HALF: f64 = 0.07;
/// Radius of the platform, radius of the gyro, height of the gyro.
pub(super) const PLATFORM: f64 = 0.66;
pub(super) const GYRO: f64 = 0.34;
pub(super) const GYRO_HEIGHT: f64 = 0.46;
/// Distance of the posts from the centre, and height of the frame's axis above the base.
const POST: f64 = 1.16;
pub(super) const AXIS_HEIGHT: f64 = 1.32;
/// Length of the drawn axes.
pub(super) const AXIS: f64 = 1.27;

/// Draws `positions` of a stand or of a passport: any number of them, at any angles. The frame's axis points to the
/// azimuth `frame_axis_azimuth_deg`.
pub(crate) fn positions(languages: &Languages, positions: &[CertifiedPosition], frame_axis_azimuth_deg: f64) -> Markup {
    let base = attitude::base(frame_axis_azimuth_deg);
    let factor = exaggeration(positions);
    let view = View::new(CENTRE, UNIT, &base);
    // The base is the same in all of them: it is drawn once, with ids of their own for each language of a page.
    let tags = languages.iter().map(Language::tag).collect::<Vec<_>>().join("-");
    let parts = [
        ("behind", base_behind(&view, &base)),
        ("before", html! { (base_before(&view, &base)) (axles(&view, &base)) }),
    ];
    let [behind, before] = parts.map(|(part, drawing)| {
        let id = format!("{part}-{tags}");
        (html! { g id=(id) { (drawing) } }, html! { use href={ "#" (id) } {} })
    });
    let bases = std::iter::once((&behind.0, &before.0)).chain(std::iter::repeat((&behind.1, &before.1)));
    let drawings = positions.iter().zip(bases).map(|(at, around)| position(languages, at, &base, factor, around));
    let drawings: Vec<Markup> = drawings.collect();
    panels(COLUMNS, PANEL_PIXELS, &drawings, &languages.key(&key()))
}

fn key() -> [(Markup, Words); 4] {
    let stroke = |class: &str| arrow([2.0, 7.0], [26.0, 7.0], class);
    let swatch = |class: &str| polygon(&[[4.0, 2.0], [24.0, 2.0], [24.0, 12.0], [4.0, 12.0]], class);
    [
        (stroke("axis"), texts::CASE_AXES.into()),
        (line([2.0, 7.0], [26.0, 7.0], "ideal"), texts::CASE_AXES_IDEAL.into()),
        (swatch("frame s2"), texts::FRAME.into()),
        (swatch("platform s1"), texts::PLATFORM.into()),
    ]
}

/// Returns the factor by which the deviations are exaggerated: the round one that shows the largest closest to 10°.
pub(crate) fn exaggeration(positions: &[CertifiedPosition]) -> f64 {
    const SHOWN_ARCSEC: f64 = 10.0 * ARCSECONDS_PER_DEGREE;
    const MOST: i32 = 4;
    let all = positions.iter().flat_map(CertifiedPosition::angles_arcsec);
    let largest = all.fold(0.0, |most, value: f64| f64::max(most, value.abs()));
    if largest == 0.0 {
        return 1.0;
    }
    let factors = (0..=MOST).flat_map(|exponent| [1.0, 2.0, 4.0, 5.0].map(|digit| digit * power_of_ten(exponent)));
    let off = |factor: f64| libm::log(factor * largest / SHOWN_ARCSEC).abs();
    factors.min_by(|one, other| off(*one).total_cmp(&off(*other))).unwrap_or(1.0)
}

/// The view: two directions of the drawing plane and the direction towards the viewer, each east, north, up.
pub(super) struct View {
    right: Vector3<f64>,
    up: Vector3<f64>,
    towards: Vector3<f64>,
    /// Place of the origin on the drawing, and length of its unit.
    centre: Point,
    unit: f64,
}

impl View {
    pub(super) fn new(centre: Point, unit: f64, base_axes: &Matrix3<f64>) -> Self {
        let (sa, ca) = sin_cos_of_degrees(VIEW_TOWARDS_XI_DEG);
        let (se, ce) = sin_cos_of_degrees(VIEW_ABOVE_DEG);
        let of_base = |xi: f64, eta: f64, zeta: f64| base_axes.tr_mul(&Vector3::new(xi, eta, zeta));
        let (right, up) = (of_base(ca, sa, 0.0), of_base(-sa * se, ca * se, ce));
        Self { right, up, towards: of_base(sa * ce, -ca * ce, se), centre, unit }
    }

    /// Returns the place on the drawing of a point, given east, north and up.
    pub(super) fn point(&self, at: &Vector3<f64>) -> Point {
        [self.centre[0] + self.unit * self.right.dot(at), self.centre[1] - self.unit * self.up.dot(at)]
    }

    /// Returns the end of an axis that is nearer to the viewer: 1 or −1.
    fn near_end(&self, axis: &Vector3<f64>) -> f64 {
        if axis.dot(&self.towards) < 0.0 { -1.0 } else { 1.0 }
    }

    /// Draws the visible faces of a box, given by its `centre` and three half edges. Each pair of faces has its shade,
    /// at any angle; the faces across the last half edge are the lightest.
    fn cuboid(&self, centre: &Vector3<f64>, half: &[Vector3<f64>; 3], class: &str) -> Markup {
        let faces = [(0, 1, 2), (1, 2, 0), (2, 0, 1)].map(|(normal, one, other)| {
            let out = half[normal] * self.near_end(&half[normal]);
            let (one, other) = (half[one], half[other]);
            let corners = [one + other, one - other, -one - other, other - one];
            let points = corners.map(|corner| self.point(&(centre + out + corner)));
            polygon(&points, &format!("{class} s{}", 3 - normal))
        });
        html! { @for face in faces { (face) } }
    }

    /// Draws a circle around `centre`, seen as an ellipse; its long axis is perpendicular to the circle's normal.
    fn circle(&self, centre: &Vector3<f64>, normal: &Vector3<f64>, radius: f64, class: &str) -> Markup {
        let ([x, y], across) = (self.point(centre), self.across(normal));
        let tilt = -degrees_from_radians(libm::atan2(across.dot(&self.up), across.dot(&self.right)));
        let (major, minor) = (radius * self.unit, radius * self.unit * normal.dot(&self.towards).abs());
        html! {
            ellipse class=(class) rx={ (format!("{major:.1}")) } ry={ (format!("{minor:.1}")) }
                transform={ (format!("translate({x:.1} {y:.1}) rotate({tilt:.1})")) } {}
        }
    }

    /// Returns the unit vector in the plane of a circle that is seen at full length.
    fn across(&self, normal: &Vector3<f64>) -> Vector3<f64> {
        normal.cross(&self.towards).try_normalize(1e-9).unwrap_or(self.right)
    }

    /// Draws a cylinder from `foot` along `along`; the end facing the viewer is drawn last.
    fn cylinder(&self, foot: &Vector3<f64>, along: &Vector3<f64>, radius: f64, class: &str) -> Markup {
        let axis = along.normalize();
        let (far, near) = if along.dot(&self.towards) > 0.0 { (*foot, foot + along) } else { (foot + along, *foot) };
        let side = self.across(&axis) * radius;
        let edge = [far + side, near + side, near - side, far - side].map(|at| self.point(&at));
        html! {
            (self.circle(&far, &axis, radius, &format!("{class} s3")))
            (polygon(&edge, &format!("{class} s3 inner")))
            (line(edge[0], edge[1], "edge"))
            (line(edge[2], edge[3], "edge"))
            (self.circle(&near, &axis, radius, &format!("{class} s1")))
        }
    }
}

fn position(
    languages: &Languages,
    at: &CertifiedPosition,
    base_axes: &Matrix3<f64>,
    factor: f64,
    around: (&Markup, &Markup),
) -> Markup {
    let name = format!("at-{}-{}", at.i, at.j);
    let position = at.to_model();
    let designed = attitude::nominal(at.theta_deg, at.phi_deg) * base_axes;
    let turned = |deviation: &Deviation| attitude::actual(at.theta_deg, at.phi_deg, deviation) * base_axes;
    let Deviation { alpha_rad, beta_rad, gamma_rad } = position.deviation;
    let drawn = Deviation { alpha_rad: factor * alpha_rad, beta_rad: factor * beta_rad, gamma_rad: factor * gamma_rad };
    let (true_axes, real) = (turned(&position.deviation), turned(&drawn));
    let frame = attitude::nominal(at.theta_deg, 0.0) * base_axes;
    let view = View::new(CENTRE, UNIT, base_axes);
    let drawing = [heading(at, languages), stand(&view, &frame, &real, around), axes(&view, &designed, &real)];
    panel(
        (&name, languages),
        SIZE,
        |language| texts::position_title(position.index).plain(language),
        |language| in_words(language, at, &true_axes),
        &drawing,
    )
}

fn heading(at: &CertifiedPosition, languages: &Languages) -> Markup {
    let degrees = |value: f64| format!("{}°", Number::exact(value).text(languages.first()));
    let words = html! {
        tspan.title { (at.index().to_string()) } "\u{2002}"
        tspan.letter { "θ" } " " (degrees(at.theta_deg)) "\u{2002}" tspan.letter { "φ" } " " (degrees(at.phi_deg))
    };
    label([4.0, 16.0], Anchor::Start, "", &words)
}

/// Draws the part of the base that is behind the frame: the plate, with its upper side at the foot of the axes, and a post.
pub(super) fn base_behind(view: &View, base_axes: &Matrix3<f64>) -> Markup {
    const HALF: f64 = 0.045;
    let [xi, eta, _] = rows(base_axes);
    let half = [xi * 1.56, eta * 0.9, Vector3::new(0.0, 0.0, HALF)];
    let plate = view.cuboid(&Vector3::new(0.0, 0.0, -AXIS_HEIGHT - HALF), &half, "base");
    html! { (plate) (post(view, base_axes, -view.near_end(&xi))) }
}

/// Draws the post in front of the frame.
pub(super) fn base_before(view: &View, base_axes: &Matrix3<f64>) -> Markup {
    post(view, base_axes, view.near_end(&rows(base_axes)[0]))
}

fn post(view: &View, base_axes: &Matrix3<f64>, end: f64) -> Markup {
    let [xi, eta, _] = rows(base_axes);
    let height = 0.5 * (AXIS_HEIGHT + 0.12);
    let centre = xi * (end * POST) + Vector3::new(0.0, 0.0, height - AXIS_HEIGHT);
    view.cuboid(&centre, &[xi * 0.06, eta * 0.13, Vector3::new(0.0, 0.0, height)], "base")
}

fn axles(view: &View, base_axes: &Matrix3<f64>) -> Markup {
    let [xi, _, _] = rows(base_axes);
    let axle = |end: f64| line(view.point(&(xi * (end * 1.1))), view.point(&(xi * (end * 1.42))), "axle");
    html! { (axle(-1.0)) (axle(1.0)) }
}

/// Draws frame, platform and gyro from back to front, between the two parts of the base `around` them; planes across ξ
/// separate them.
pub(super) fn stand(
    view: &View,
    frame: &Matrix3<f64>,
    real: &Matrix3<f64>,
    (behind, before): (&Markup, &Markup),
) -> Markup {
    let [xi, across, out] = rows(frame);
    let [x, _, spin] = rows(real);
    let bar = |centre: Vector3<f64>, along: Vector3<f64>, thick: Vector3<f64>| {
        view.cuboid(&centre, &[along, thick, out * BAR_HALF], "frame")
    };
    let side = |end: f64| {
        let centre = xi * (end * (FRAME_HALF[0] - BAR_HALF));
        bar(centre, across * FRAME_HALF[1], xi * BAR_HALF)
    };
    let crossbar = |end: f64| {
        let centre = across * (end * (FRAME_HALF[1] - BAR_HALF));
        bar(centre, xi * (FRAME_HALF[0] - 2.0 * BAR_HALF), across * BAR_HALF)
    };
    let (near_end, nearer) = (view.near_end(&xi), view.near_end(&across));
    let centre = Vector3::zeros();
    let gyro_is_near = spin.dot(&view.towards) > 0.0;
    let gyro = view.cylinder(&centre, &(spin * GYRO_HEIGHT), GYRO, "gyro");
    html! {
        (behind) (side(-near_end)) (crossbar(-nearer))
        @if !gyro_is_near { (gyro) }
        (view.circle(&centre, &spin, PLATFORM, "platform s1"))
        // The two pins of the gyro seat, which are along x.
        @for sign in [-1.0, 1.0] { (view.circle(&(x * (sign * 0.5)), &spin, 0.055, "pin")) }
        (crossbar(nearer)) (side(near_end)) (before)
        @if gyro_is_near { (gyro) }
    }
}

/// A box on the drawing: its corner at the upper left, and the one at the lower right.
type Area = [Point; 2];

/// Draws the case axes: nominal (thin) and actual, z from the end of the gyro. Their letters avoid each other.
fn axes(view: &View, designed: &Matrix3<f64>, real: &Matrix3<f64>) -> Markup {
    let one = |direction: &Vector3<f64>, designed: &Vector3<f64>, from: f64| {
        html! {
            (line(view.point(&(designed * from)), view.point(&(designed * AXIS)), "ideal"))
            (arrow(view.point(&(direction * from)), view.point(&(direction * AXIS)), "axis"))
        }
    };
    let (directions, [x0, y0, z0]) = (rows(real), rows(designed));
    let [x, y, z] = &directions;
    // The heading of the drawing, which print sets larger.
    let mut taken = vec![[[0.0, 0.0], [SIZE[0], 28.0]]];
    let letters = ["x", "y", "z"].into_iter().zip(&directions).map(|(name, direction)| {
        let [x, y] = letter(view, direction, &taken);
        taken.push(about_letter([x, y]));
        words([x, y + 4.0], Anchor::Middle, "letter", name)
    });
    let letters: Vec<Markup> = letters.collect();
    html! {
        (one(x, &x0, GYRO)) (one(y, &y0, GYRO)) (one(z, &z0, GYRO_HEIGHT))
        @for letter in &letters { (letter) }
    }
}

/// Returns the place of an axis letter: beyond the arrow head, even if the axis points at the viewer, or next to it if
/// words are there.
fn letter(view: &View, direction: &Vector3<f64>, taken: &[Area]) -> Point {
    const GAPS: [f64; 3] = [10.0, 15.0, 20.0];
    const TURNS_DEG: [f64; 7] = [0.0, 45.0, -45.0, 90.0, -90.0, 135.0, -135.0];
    let ([cx, cy], [x, y]) = (CENTRE, view.point(&(direction * AXIS)));
    let length = libm::hypot(x - cx, y - cy);
    // Up and to the right if the axis has no direction on the drawing.
    let [dx, dy] = if length < 1.0 { [0.7, -0.7] } else { [(x - cx) / length, (y - cy) / length] };
    let at = |gap: f64, turn_deg: f64| {
        let (sin, cos) = sin_cos_of_degrees(turn_deg);
        [x + gap * (dx * cos - dy * sin), y + gap * (dx * sin + dy * cos)]
    };
    let places = GAPS.iter().flat_map(|gap| TURNS_DEG.map(|turn_deg| at(*gap, turn_deg)));
    let covered = |place: &Point| taken.iter().map(|other| overlap(about_letter(*place), *other)).sum::<f64>();
    // The first place with the smallest overlap, usually none.
    places.min_by(|one, other| covered(one).total_cmp(&covered(other))).unwrap_or([x, y])
}

/// Returns the area that the letter of an axis covers.
fn about_letter([x, y]: Point) -> Area {
    [[x - 7.0, y - 16.0], [x + 7.0, y + 9.0]]
}

/// Returns the area in which two boxes overlap.
fn overlap([low, high]: Area, [other_low, other_high]: Area) -> f64 {
    let along = |axis: usize| (high[axis].min(other_high[axis]) - low[axis].max(other_low[axis])).max(0.0);
    along(0) * along(1)
}

/// Returns the axes of the case or of the base, each east, north, up: the rows of the matrix.
pub(super) fn rows(matrix: &Matrix3<f64>) -> [Vector3<f64>; 3] {
    [0, 1, 2].map(|row| matrix.row(row).transpose())
}

/// Describes the direction of every axis: the nearest of east, west, north, south, up, down, and the angle from it.
fn in_words(language: Language, at: &CertifiedPosition, real: &Matrix3<f64>) -> String {
    let [theta, phi] = [at.theta_deg, at.phi_deg].map(Number::exact);
    let [(x, x_angle), (y, y_angle), (z, z_angle)] = rows(real).map(|axis| nearest(&axis));
    texts::position_description(theta, phi, x, x_angle, y, y_angle, z, z_angle).plain(language)
}

/// Returns the nearest of six directions, and the angle from it in degrees.
fn nearest(axis: &Vector3<f64>) -> (Text, Number) {
    let names = [(compass::EAST, compass::WEST), (compass::NORTH, compass::SOUTH), (compass::UP, texts::DOWNWARDS)];
    let largest = axis.iamax();
    let (positive, negative) = names[largest];
    let name = if axis[largest] < 0.0 { negative } else { positive };
    let mut rest = *axis;
    rest[largest] = 0.0;
    // From sine and cosine, because an arc cosine is inaccurate for small angles.
    let angle_deg = degrees_from_radians(libm::atan2(rest.norm(), axis[largest].abs()));
    (name, Number::significant(angle_deg, 2))
}
