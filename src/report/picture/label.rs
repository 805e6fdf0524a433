//! Width of words on a drawing, and boxes that overlap.

use super::drawing::Point;

/// Widths of letters (normal, narrow and wide), in class `small`, with some reserve.
const LETTER: f64 = 6.0;
const NARROW: f64 = 3.2;
const WIDE: f64 = 10.8;

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
