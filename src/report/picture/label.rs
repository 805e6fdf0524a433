//! Placement of labels at arbitrary points. If there is room, no label covers another label or a point.

use super::drawing::{Anchor, Point, line, words};
use maud::{Markup, html};

/// Widths of letters (normal, narrow and wide) and height of a line, in class `small`, with some reserve.
const LETTER: f64 = 6.0;
const NARROW: f64 = 3.2;
const WIDE: f64 = 10.8;
const LINE: f64 = 12.4;

/// Distance within which points appear as one.
const SAME: f64 = 6.0;

/// Distances from the point at which a label is tried.
const DISTANCES: [f64; 6] = [8.0, 16.0, 26.0, 38.0, 52.0, 68.0];

/// Width of the rim of words, and of the frame around them.
const RIM: f64 = 3.0;

/// Cost of a label that could be taken for that of another point, and how much nearer its own point should be.
const MISTAKEN: f64 = 60.0;
const NEARER: f64 = 5.0;

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Label {
    at: Point,
    words: String,
}

/// A box on the drawing, given by its lowest and highest coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Area {
    /// Left and upper end.
    pub low: Point,
    /// Right and lower end.
    pub high: Point,
}

impl Area {
    /// Returns the area in which two boxes overlap.
    pub(crate) fn overlap(&self, other: &Self) -> f64 {
        let along =
            |axis: usize| (self.high[axis].min(other.high[axis]) - self.low[axis].max(other.low[axis])).max(0.0);
        along(0) * along(1)
    }

    fn about([x, y]: Point, half: f64) -> Self {
        Self { low: [x - half, y - half], high: [x + half, y + half] }
    }

    fn distance(&self, at: Point) -> f64 {
        let [x, y] = [0, 1].map(|axis| at[axis] - at[axis].clamp(self.low[axis], self.high[axis]));
        libm::hypot(x, y)
    }

    /// Returns the area of this box outside `other`.
    fn outside(&self, other: &Self) -> f64 {
        let size = (self.high[0] - self.low[0]) * (self.high[1] - self.low[1]);
        size - self.overlap(other)
    }
}

/// Groups points that appear as one and gives each group one label: "(1, 1)…(1, 4)" or "(1, 1), (2, 3)".
pub(crate) fn together(points: &[(Point, String)]) -> Vec<Label> {
    let mut groups: Vec<(Point, Vec<&str>)> = Vec::new();
    for (at, words) in points {
        let near = |place: &Point| libm::hypot(place[0] - at[0], place[1] - at[1]) < SAME;
        match groups.iter_mut().find(|(place, _)| near(place)) {
            Some((_, members)) => members.push(words),
            None => groups.push((*at, vec![words])),
        }
    }
    let label = |(at, members): (Point, Vec<&str>)| {
        let words = match members.as_slice() {
            [first, .., last] if members.len() > 2 => format!("{first}…{last}"),
            some => some.join(", "),
        };
        Label { at, words }
    };
    groups.into_iter().map(label).collect()
}

/// Draws the labels within `field`. If possible, they stay clear of `words` already drawn and of `obstacles` (points on
/// lines).
pub(crate) fn place(labels: &[Label], words: &[Area], obstacles: &[Point], field: &Area) -> Markup {
    // Words have a rim of the colour of the paper, which would break the frame of the field.
    let field = &Area { low: field.low.map(|at| at + RIM), high: field.high.map(|at| at - RIM) };
    let marks: Vec<Area> = labels.iter().map(|label| Area::about(label.at, 5.0)).collect();
    let lines: Vec<Area> = obstacles.iter().map(|at| Area::about(*at, 1.0)).collect();
    let mut taken = words.to_vec();
    let mut drawn = Vec::new();
    for label in labels {
        let cost = |area: &Area, distance: f64| {
            let over = |others: &[Area]| others.iter().map(|other| area.overlap(other)).sum::<f64>();
            // Words over other words are unreadable, so any distance costs less than an overlap.
            let crossed = 1000.0 * (area.outside(field) + over(&taken)) + 10.0 * over(&marks) + 10.0 * over(&lines);
            crossed + MISTAKEN * labels.iter().filter(|other| label.is_mistaken(other, area)).count() as f64 + distance
        };
        let candidates = DISTANCES.iter().flat_map(|distance| (0..16).map(move |turn| (*distance, turn)));
        let best = candidates
            .map(|(distance, turn)| {
                let (sin, cos) = crate::units::sin_cos_of_degrees(22.5 * f64::from(turn));
                let area = label.area([label.at[0] + distance * cos, label.at[1] - distance * sin], cos);
                (cost(&area, distance), distance, area)
            })
            .min_by(|(one, ..), (other, ..)| one.total_cmp(other));
        if let Some((_, distance, area)) = best {
            drawn.push(label.markup(&area, distance > 12.0));
            taken.push(area);
        }
    }
    html! { @for label in &drawn { (label) } }
}

/// Returns the largest possible width of words in class `small`.
pub(crate) fn width(words: &str) -> f64 {
    let letter = |c: char| match c {
        ',' | '.' | ' ' => NARROW,
        '…' => WIDE,
        _ => LETTER,
    };
    words.chars().map(letter).sum()
}

impl Label {
    /// Returns `true` if the label at `area` is hardly nearer to its own point than to that of another label.
    fn is_mistaken(&self, other: &Self, area: &Area) -> bool {
        other.at != self.at && area.distance(other.at) < area.distance(self.at) + NEARER
    }

    /// Returns the box of the label next to `at`: to the right of `at` if the label is to the right of its point, and
    /// so on.
    fn area(&self, [x, y]: Point, cos: f64) -> Area {
        let width = width(&self.words);
        let left = x - 0.5 * width * (1.0 - cos);
        Area { low: [left, y - 0.5 * LINE], high: [left + width, y + 0.5 * LINE] }
    }

    fn markup(&self, area: &Area, far: bool) -> Markup {
        let nearest = [0, 1].map(|axis| self.at[axis].clamp(area.low[axis], area.high[axis]));
        html! {
            @if far { (line(self.at, nearest, "leader")) }
            (words([area.low[0], area.high[1] - 2.6], Anchor::Start, "small", &self.words))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_that_coincide_share_a_label() {
        let at = |x: f64, words: &str| ([x, 0.0], words.to_owned());
        let labels = together(&[at(0.0, "(1)"), at(50.0, "(4)"), at(1.0, "(2)"), at(2.0, "(3)"), at(51.0, "(5)")]);
        let words: Vec<&str> = labels.iter().map(|label| label.words.as_str()).collect();
        assert_eq!(words, ["(1)…(3)", "(4), (5)"]);
    }
}
