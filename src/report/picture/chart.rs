//! A field between two axes, and lines with marks within it.

use super::drawing::{Anchor, Point, Scale, line, list, mark, words};
use maud::{Markup, html};

/// How a series looks: the frame index whose mark it borrows, and the class of its line.
pub(crate) type Look = (u32, &'static str);

/// A field: values to the right along `x`, upwards along `y`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Field {
    /// From its left end to its right end.
    pub x: Scale,
    /// From its lower end to its upper end.
    pub y: Scale,
}

impl Field {
    /// Both axes, and a faint line with its number at each of their marks.
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

    /// A line through `values`, with the mark of `index` at each; what is beyond an axis is at its end.
    pub(crate) fn series(&self, values: &[Point], (index, class): Look) -> Markup {
        let points: Vec<Point> = values.iter().map(|[x, y]| [self.x.clamped(*x), self.y.clamped(*y)]).collect();
        html! {
            polyline class=(class) points=(list(&points)) {}
            @for at in &points { (mark(*at, index, "mark")) }
        }
    }
}

/// A series as a legend shows it.
pub(crate) fn sample((index, class): Look) -> Markup {
    html! { (line([1.0, 7.0], [27.0, 7.0], class)) (mark([14.0, 7.0], index, "mark")) }
}
