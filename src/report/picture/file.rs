//! Picture files: SVG with its own style, which other pictures get from their page.

use super::drawing::{Anchor, Point, coordinate, label, panel, symbols, width};
use crate::wording::Language;
use maud::{Markup, PreEscaped, html};

/// Style in black and grey on a white ground. Its rules are plain, because not only browsers draw these files.
const STYLE: &str = include_str!("file.css");

/// Returns the file of a picture with a single panel, in English.
pub(crate) fn file(name: &str, size: Point, title: &str, description: &str, drawing: &[Markup]) -> String {
    let [width, height] = size.map(coordinate);
    let english = Language::English.into();
    let picture = panel((name, &english), size, |_| title.to_owned(), |_| description.to_owned(), drawing);
    let file = html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(width) height=(height) viewBox={ "0 0 " (width) " " (height) } {
            style { (PreEscaped(STYLE)) }
            rect.ground width=(width) height=(height) {}
            (picture)
        }
    };
    file.into_string() + "\n"
}

/// Draws one line above a plot area: the name of the vertical axis, and the legend.
pub(crate) fn caption([x, y]: Point, axis: &str, entries: &[(Markup, &str)]) -> Markup {
    const GAP: f64 = 16.0;
    const SAMPLE: f64 = 34.0;
    // `width` has some reserve for labels, which would leave wide gaps here.
    let width = |words: &str| 0.9 * width(words);
    let mut end = if axis.is_empty() { x } else { x + width(axis) + GAP };
    let entry = |(sample, name): &(Markup, &str)| {
        let at = end;
        end += SAMPLE + width(name) + GAP;
        html! {
            g transform={ "translate(" (coordinate(at)) " " (coordinate(y - 11.0)) ")" } { (sample) }
            (label([at + SAMPLE, y], Anchor::Start, "small", &symbols(name)))
        }
    };
    let entries: Vec<Markup> = entries.iter().map(entry).collect();
    html! {
        (label([x, y], Anchor::Start, "small", &symbols(axis)))
        @for entry in &entries { (entry) }
    }
}
