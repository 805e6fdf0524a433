//! Plot area between two axes, and lines with marks within it.

use super::drawing::{Anchor, Point, Scale, line, list, mark, words};
use maud::{Markup, html};

/// The appearance of a series: the frame index whose mark it uses, and the class of its line.
pub(crate) type Look = (u32, &'static str);

/// A plot area: values increase to the right along `x`, upwards along `y`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Field {
    /// Horizontal scale, from the left end to the right end.
    pub x: Scale,
    /// Vertical scale, from the lower end to the upper end.
    pub y: Scale,
}

impl Field {
    /// Draws both axes, and at each axis mark a faint line with its number.
    pub(crate) fn axes(&self, x_marks: &[(f64, String)], y_marks: &[(f64, String)]) -> Markup {
        let ([left, right], [bottom, top]) = (self.x.places, self.y.places);
        html! {
            @for (value, printed) in x_marks {
                @let x = self.x.place(*value);
                (line([x, top], [x, bottom + 4.0], "grid"))
                (words([x, bottom + 16.0], Anchor::Middle, "small", printed))
            }
            @for (value, printed) in y_marks {
                @let y = self.y.place(*value);
                (line([left - 4.0, y], [right, y], "grid"))
                (words([left - 7.0, y + 4.0], Anchor::End, "small", printed))
            }
            (line([left, top], [left, bottom], "zero"))
            (line([left, bottom], [right, bottom], "zero"))
        }
    }

    /// Draws a line through `values`, with the mark of `index` at each. Values beyond an axis are drawn at its end.
    pub(crate) fn series(&self, values: &[Point], (index, class): Look) -> Markup {
        let points: Vec<Point> = values.iter().map(|[x, y]| [self.x.clamped(*x), self.y.clamped(*y)]).collect();
        html! {
            polyline class=(class) points=(list(&points)) {}
            @for at in &points { (mark(*at, index, "mark")) }
        }
    }
}

/// Draws the sample of a series for a legend.
pub(crate) fn sample((index, class): Look) -> Markup {
    html! { (line([1.0, 7.0], [27.0, 7.0], class)) (mark([14.0, 7.0], index, "mark")) }
}
