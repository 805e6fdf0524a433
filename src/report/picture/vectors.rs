//! Earth rate and specific force in the case axes at every position, as differences from those of an ideal stand, in the
//! gyro's x-y plane ([the paper](crate::bibliography::Bibliography::Tang17), eq. (5)).

use super::drawing::{
    Anchor, Panel, Point, Scale, Ticks, arrow, crowding, heading_with, legend_with, line, mark, panels, plain_symbol,
    power_of_ten, rectangle, with_power, words,
};
use super::label as labels;
use crate::attitude;
use crate::coefficients::PositionIndex;
use crate::passport::Content;
use crate::report::page::Number;
use crate::report::page::language::{Language, Languages, Text, values};
use crate::report::page::texts::{pictures as texts, units};
use maud::{Markup, html};
use std::collections::BTreeSet;

/// Largest number of positions in a panel; of more there is a panel for each frame index.
const MOST_IN_A_PANEL: usize = 12;

/// Measures of a panel.
#[derive(Debug, Clone, Copy)]
struct Layout {
    pixels: u32,
    columns: u32,
    size: Point,
    /// Plot area: left and upper, right and lower end.
    field: [Point; 2],
    /// Largest number of marks on an axis.
    ticks: usize,
}

/// All positions of a quantity in one panel.
const WHOLE: Layout =
    Layout { pixels: 235, columns: 2, size: [262.0, 268.0], field: [[38.0, 22.0], [254.0, 238.0]], ticks: 5 };

/// A panel for the positions of one frame index.
const SMALL: Layout =
    Layout { pixels: 170, columns: 4, size: [204.0, 216.0], field: [[36.0, 22.0], [200.0, 186.0]], ticks: 4 };

/// A vector of one position in the x-y plane: with and without the deviations.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pair {
    index: PositionIndex,
    real: [f64; 2],
    ideal: [f64; 2],
}

impl Pair {
    fn difference(&self) -> [f64; 2] {
        [self.real[0] - self.ideal[0], self.real[1] - self.ideal[1]]
    }
}

/// The quantity shown in a picture.
struct Subject {
    name: &'static str,
    title: Text,
    /// Title of a panel of one frame index.
    of_frame: Text,
    unit: Text,
    pairs: Vec<Pair>,
}

/// Draws ω_3 and n of every position, as the passport states them, minus those at the nominal angles.
pub(crate) fn vectors(languages: &Languages, content: &Content) -> Markup {
    let subjects = subjects(content);
    if content.positions.len() > MOST_IN_A_PANEL {
        let each = subjects.map(|subject| small_multiples(languages, &subject));
        return html! { @for row in &each { (row) } (key(languages, None)) };
    }
    let whole = |subject: &Subject| {
        let plane = Plane::about(WHOLE, &subject.pairs);
        differences_of(languages, subject, &plane, &subject.pairs, None)
    };
    let drawings: Vec<Markup> = subjects.iter().map(whole).collect();
    panels(WHOLE.columns, WHOLE.pixels, &drawings, &key(languages, Some(content)))
}

/// Draws a panel for each frame index, all to one scale.
fn small_multiples(languages: &Languages, subject: &Subject) -> Markup {
    let plane = Plane::about(SMALL, &subject.pairs);
    let same_frame = subject.pairs.chunk_by(|one, other| one.index.i == other.index.i);
    let parts = same_frame.flat_map(|frame| {
        let most = frame.len().div_ceil(frame.len().div_ceil(MOST_IN_A_PANEL));
        frame.chunks(most)
    });
    let drawings: Vec<Markup> =
        parts.enumerate().map(|(place, part)| differences_of(languages, subject, &plane, part, Some(place))).collect();
    panels(SMALL.columns, SMALL.pixels, &drawings, &html! {})
}

/// Draws what the marks mean. With a panel for each frame index, its title says what the marks of positions `together` say.
fn key(languages: &Languages, together: Option<&Content>) -> Markup {
    let sample = |frame: u32| mark([14.0, 7.0], frame, "mark");
    let marks = match together {
        None => vec![(sample(1), languages.label(texts::VECTOR_LABEL))],
        Some(content) => {
            let frames: BTreeSet<u32> = content.positions.iter().map(|at| at.i).collect();
            // There are four marks: the frame indices 1 and 5 share one.
            let of_kind = |kind: u32| {
                let same = || frames.iter().filter(|frame| **frame % 4 == kind % 4);
                let positions = same().map(|frame| format!("({frame}, j)")).collect::<Vec<_>>().join(", ");
                let words = |language| texts::VECTOR_MARK.filled(language, values! { positions });
                Some((sample(*same().next()?), languages.label_with(words)))
            };
            (1..=4).filter_map(of_kind).collect()
        }
    };
    let difference = (arrow([2.0, 7.0], [26.0, 7.0], "real"), languages.label(texts::VECTOR_DIFFERENCE));
    let entries = [vec![difference], marks].concat();
    legend_with(entries.iter().map(|(sample, words)| (sample, words.clone())))
}

fn subjects(content: &Content) -> [Subject; 2] {
    let earth = content.earth.rate(&content.site);
    let base = attitude::base(earth.frame_axis_azimuth_deg);
    // The vectors have the order of the positions: both are sorted by (i, j).
    let each = content.positions.iter().zip(&content.vectors).map(|(at, vectors)| {
        let nominal = attitude::nominal(at.theta_deg, at.phi_deg) * base;
        let rate =
            |row: usize| nominal[(row, 1)] * earth.horizontal_deg_per_h + nominal[(row, 2)] * earth.vertical_deg_per_h;
        let index = at.index();
        let omega = Pair { index, real: vectors.omega_deg_per_h, ideal: [rate(0), rate(1)] };
        (omega, Pair { index, real: vectors.specific_force_g, ideal: [nominal[(0, 2)], nominal[(1, 2)]] })
    });
    let (rates, forces) = each.unzip();
    [
        Subject {
            name: "earth-rate",
            title: texts::EARTH_RATE_DIFFERENCE,
            of_frame: texts::EARTH_RATE_OF_FRAME,
            unit: units::DEG_PER_H,
            pairs: rates,
        },
        Subject {
            name: "specific-force",
            title: texts::SPECIFIC_FORCE_DIFFERENCE,
            of_frame: texts::SPECIFIC_FORCE_OF_FRAME,
            unit: units::G,
            pairs: forces,
        },
    ]
}

/// A plane with equal scales along x and y.
struct Plane {
    layout: Layout,
    x: Scale,
    y: Scale,
    /// Power of ten factored out of the numbers on the axes.
    exponent: i32,
}

impl Plane {
    /// Creates a plane wide enough for all differences, with room for labels around them.
    fn about(layout: Layout, pairs: &[Pair]) -> Self {
        let largest = pairs.iter().flat_map(Pair::difference).fold(0.0, |most, value: f64| f64::max(most, value.abs()));
        let reach = if largest > 0.0 { 1.16 * largest } else { 1.0 };
        let [[left, top], [right, bottom]] = layout.field;
        let values = [-reach, reach];
        // There is no room for numbers with many zeros, so a factor of the unit replaces them.
        let exponent = crowding(reach);
        let (x, y) = (Scale { values, places: [left, right] }, Scale { values, places: [bottom, top] });
        Self { layout, x, y, exponent }
    }

    fn point(&self, [x, y]: [f64; 2]) -> Point {
        [self.x.place(x), self.y.place(y)]
    }

    fn grid(&self, languages: &Languages) -> Markup {
        let [[left, top], [right, bottom]] = self.layout.field;
        let factor = power_of_ten(self.exponent);
        let reach = self.x.values[1] / factor;
        let ticks = Ticks::between(-0.93 * reach, 0.93 * reach, self.layout.ticks);
        html! {
            @for (value, text) in ticks.marks(languages.first()) {
                @let (x, y) = (self.x.place(value * factor), self.y.place(value * factor));
                (line([x, top], [x, bottom], "grid"))
                (line([left, y], [right, y], "grid"))
                (words([x, bottom + 12.0], Anchor::Middle, "small", &text))
                (words([left - 4.0, y + 4.0], Anchor::End, "small", &text))
            }
            (rectangle([left, top], [right, bottom], "frame-line", None))
            (words([right, bottom + 26.0], Anchor::End, "letter", "x"))
            (words([left + 5.0, top + 13.0], Anchor::Start, "letter", "y"))
        }
    }
}

/// Draws some of the vectors of `subject`; `part` is the place of the panel if there are several.
fn differences_of(
    languages: &Languages,
    subject: &Subject,
    plane: &Plane,
    pairs: &[Pair],
    part: Option<usize>,
) -> Markup {
    let origin = plane.point([0.0, 0.0]);
    let tips: Vec<(Point, PositionIndex)> =
        pairs.iter().map(|pair| (plane.point(pair.difference()), pair.index)).collect();
    let lines: Vec<Point> = tips.iter().flat_map(|(tip, _)| along(origin, *tip)).collect();
    let named: Vec<(Point, String)> = tips.iter().map(|(at, index)| (*at, index.to_string())).collect();
    let [[left, top], [right, bottom]] = plane.layout.field;
    let axis = labels::Area { low: [left, top], high: [left + 18.0, top + 18.0] };
    let field = labels::Area { low: [left, top], high: [right, bottom] };
    let title = |language: Language| {
        let unit = with_power(plane.exponent, subject.unit.of(language), language);
        match pairs.first().filter(|_| part.is_some()) {
            Some(pair) => subject.of_frame.filled(language, values! { i: pair.index.i, unit }),
            None => subject.title.filled(language, values! { unit }),
        }
    };
    let (title_lines, more) = heading_with(languages, [2.0, 13.0], title);
    let moved = html! {
        g transform={ "translate(0 " (more) ")" } {
            (plane.grid(languages))
            @for (tip, _) in &tips { (arrow(origin, *tip, "real")) }
            @for (tip, index) in &tips { (mark(*tip, if part.is_some() { 1 } else { index.i }, "mark")) }
            (labels::place(&labels::together(&named), &[axis], &lines, &field))
        }
    };
    let part = part.map_or_else(String::new, |place| format!("-{}", place + 1));
    let name = format!("{}-differences{part}", subject.name);
    let [width, height] = plane.layout.size;
    let panel = Panel { name: &name, languages, size: [width, height + more] };
    let spoken = |language| plain_symbol(&title(language));
    panel.svg(spoken, |language| in_words(language, subject.unit, pairs), &[title_lines, moved])
}

/// Returns points along a line for labels to avoid. Its ends are omitted, because they have marks.
fn along(from: Point, to: Point) -> Vec<Point> {
    let length = libm::hypot(to[0] - from[0], to[1] - from[1]);
    let steps = (length / 4.0) as u32;
    let at = |step: u32| {
        let share = f64::from(step) / f64::from(steps);
        [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])]
    };
    (1..steps).map(at).collect()
}

fn in_words(language: Language, unit: Text, pairs: &[Pair]) -> String {
    let each = pairs.iter().map(|pair| {
        let [x, y] = pair.difference().map(|value| Number::significant(value, 5));
        texts::VECTOR_IN_WORDS.filled(language, values! { index: pair.index, x, y })
    });
    let list = each.collect::<Vec<_>>().join("; ");
    texts::VECTORS_DESCRIPTION.filled(language, values! { unit, list })
}
