//! Axes as a reader takes them: by their marks and the numbers that stand beside these.

use super::{number, of_class};
use roxmltree::Node;

/// Marks of an axis: where they are, and what their numbers say.
#[derive(Debug)]
pub struct Axis {
    marks: Vec<(f64, f64)>,
}

impl Axis {
    /// Of a picture with upright lines and their numbers beneath.
    pub fn along_x(svg: Node) -> Self {
        Self::of(svg, ["x1", "x2"], said, |text, at| {
            text.attribute("text-anchor") == Some("middle") && (number(text, "x") - at).abs() < 0.2
        })
    }

    /// Of a picture with level lines and their numbers to the left.
    pub fn along_y(svg: Node) -> Self {
        Self::of(svg, ["y1", "y2"], said, level)
    }

    /// The same of one that is numbered by powers of ten: of their exponents.
    pub fn of_decades(svg: Node) -> Self {
        let exponent = |text: Node| match words(text).as_str() {
            "1" => Some(0.0),
            other => power(other).map(f64::from),
        };
        Self::of(svg, ["y1", "y2"], exponent, level)
    }

    /// The same of one whose marks are logarithms of their numbers.
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

    /// What a place on the drawing means.
    pub fn value(&self, at: f64) -> f64 {
        let ((from, low), (to, high)) = (self.marks[0], self.marks[self.marks.len() - 1]);
        low + (at - from) / (to - from) * (high - low)
    }

    /// What two places mean that can be told apart: a tenth of a unit of the drawing, which its coordinates are written to.
    pub fn fineness(&self) -> f64 {
        (self.value(0.15) - self.value(0.0)).abs()
    }

    /// The place `at` means `value`.
    #[track_caller]
    pub fn says(&self, at: f64, value: f64) {
        let there = self.value(at);
        // The marks that it is read from are rounded as well.
        assert!((there - value).abs() <= 2.0 * self.fineness(), "{value} stands at {there}");
    }
}

/// Words that end left of a level line.
fn level(text: Node, at: f64) -> bool {
    text.attribute("text-anchor") == Some("end") && (number(text, "y") - 4.0 - at).abs() < 0.2
}

/// What an element of words says.
pub fn words(text: Node) -> String {
    text.descendants().filter(Node::is_text).filter_map(|node| node.text()).collect()
}

fn said(text: Node) -> Option<f64> {
    words(text).replace('\u{2212}', "-").replace('\u{202f}', "").replace(',', ".").parse().ok()
}

/// The power of ten that the numbers of a picture's axes are in.
fn factor(svg: Node) -> f64 {
    // Of a unit, or alone; the numbers of decades are powers of ten themselves.
    let units =
        svg.descendants().filter(|node| node.has_tag_name("text") && node.attribute("text-anchor") == Some("end"));
    let unit = units.map(words).find(|words| words.starts_with("x, ") || words.starts_with("× "));
    unit.and_then(|words| power(&words)).map_or(1.0, |exponent| 10_f64.powi(exponent))
}

/// The exponent of a power of ten.
fn power(words: &str) -> Option<i32> {
    let digits = |c: char| "⁻⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|s| s == c).map(|at| ("-0123456789").as_bytes()[at] as char);
    let exponent: String = words[words.find("10")? + 2..].chars().map_while(digits).collect();
    exponent.parse().ok()
}
