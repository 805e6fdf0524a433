//! Axes of a picture, read from their marks and the numbers next to these.

use super::{number, of_class, whole};
use maud::Markup;
use roxmltree::{Document, Node};

/// Marks of an axis: their places and the values of their numbers.
#[derive(Debug)]
pub struct Axis {
    marks: Vec<(f64, f64)>,
}

impl Axis {
    /// Reads the axis of a picture with vertical lines and their numbers below.
    pub fn along_x(svg: Node) -> Self {
        Self::of(svg, ["x1", "x2"], said, |text, at| {
            text.attribute("text-anchor") == Some("middle") && (number(text, "x") - at).abs() < 0.2
        })
    }

    /// Reads the axis along x of a drawing.
    pub fn drawn_along_x(picture: Markup) -> Self {
        Self::along_x(Document::parse(&whole(&[picture])).unwrap().root_element())
    }

    /// Reads the axis of a picture with horizontal lines and their numbers to the left.
    pub fn along_y(svg: Node) -> Self {
        Self::of(svg, ["y1", "y2"], said, level)
    }

    /// Reads an axis along y whose marks are at the logarithms of their numbers.
    pub fn of_logarithms(svg: Node) -> Self {
        Self::of(svg, ["y1", "y2"], |text| said(text).map(libm::log10), level)
    }

    fn of(svg: Node, ends: [&str; 2], said: impl Fn(Node) -> Option<f64>, beside: impl Fn(Node, f64) -> bool) -> Self {
        let factor = factor(svg);
        let lines = of_class(svg, "grid").into_iter().filter(|line| line.attribute(ends[0]) == line.attribute(ends[1]));
        let mark = |line: Node| {
            let at = number(line, ends[0]);
            let beside: Vec<f64> =
                of_class(svg, "small").into_iter().filter(|text| beside(*text, at)).filter_map(&said).collect();
            let [value] = beside.as_slice() else { panic!("{} numbers at the mark {at}", beside.len()) };
            (at, value * factor)
        };
        let marks: Vec<(f64, f64)> = lines.map(mark).collect();
        assert!(marks.len() > 1, "{marks:?}");
        let axis = Self { marks };
        for (at, value) in &axis.marks {
            let there = axis.value(*at);
            assert!((there - value).abs() <= axis.fineness(), "the mark {value} stands at {there}");
        }
        axis
    }

    /// Returns the value at a place on the drawing.
    pub fn value(&self, at: f64) -> f64 {
        let ((from, low), (to, high)) = (self.marks[0], self.marks[self.marks.len() - 1]);
        low + (at - from) / (to - from) * (high - low)
    }

    /// Returns the smallest difference of values that places on the drawing can show. Coordinates are written to a
    /// tenth of a unit; 0.15 units leave a margin.
    pub fn fineness(&self) -> f64 {
        (self.value(0.15) - self.value(0.0)).abs()
    }

    /// Asserts that the place `at` shows `value`.
    #[track_caller]
    pub fn says(&self, at: f64, value: f64) {
        let there = self.value(at);
        // The marks used for reading are rounded as well.
        assert!((there - value).abs() <= 2.0 * self.fineness(), "{value} stands at {there}");
    }
}

/// Returns `true` if the words end to the left of a horizontal line at `at`.
fn level(text: Node, at: f64) -> bool {
    text.attribute("text-anchor") == Some("end") && (number(text, "y") - 4.0 - at).abs() < 0.2
}

/// Returns the text of an element.
pub fn words(text: Node) -> String {
    text.descendants().filter(Node::is_text).filter_map(|node| node.text()).collect()
}

/// Returns the number of a mark; one in degrees in arcseconds, one in percent without its sign.
fn said(text: Node) -> Option<f64> {
    let words = words(text);
    let words = words.trim_end_matches(['″', '%', '\u{a0}']);
    let (words, factor) = words.strip_suffix('°').map_or((words, 1.0), |degrees| (degrees, 3600.0));
    let number: Option<f64> = words.replace('\u{2212}', "-").replace('\u{202f}', "").replace(',', ".").parse().ok();
    number.map(|number| factor * number)
}

/// Returns the power of ten that is factored out of the numbers of a picture's axes.
fn factor(svg: Node) -> f64 {
    // The factor stands before a unit, at the end of an axis or of the title. The numbers of decades are powers of ten
    // themselves.
    let units = svg.descendants().filter_map(|node| match (node.attribute("text-anchor"), node.attribute("class")) {
        (Some("end"), _) => Some(words(node)),
        (_, Some("title")) => words(node).rsplit_once(", ").map(|(_, unit)| unit.to_owned()),
        _ => None,
    });
    let mut units = units.filter(|words| words.starts_with("10") && words.contains('\u{a0}'));
    units.next().and_then(|words| power(&words)).map_or(1.0, |exponent| 10_f64.powi(exponent))
}

/// Returns the exponent of a power of ten.
fn power(words: &str) -> Option<i32> {
    let digits = |c: char| "⁻⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|s| s == c).map(|at| ("-0123456789").as_bytes()[at] as char);
    let exponent: String = words[words.find("10")? + 2..].chars().map_while(digits).collect();
    exponent.parse().ok()
}
