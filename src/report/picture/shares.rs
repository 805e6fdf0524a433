//! Shares of the inputs in the variance of each parameter, as strips in their table, all as long as the whole variance.

use super::drawing::{Anchor, Scale, rectangle, strip, strip_axis, words};
use super::label::width;
use crate::report::page::Languages;
use maud::{Markup, html};

const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 19.0;
const BARS: [f64; 2] = [8.0, 548.0];
const BAR_HALF: f64 = 8.0;

/// Length of a part that its name leaves free.
const MARGIN: f64 = 4.0;

/// Share below which a part is one of the others: its outline would be all that is seen.
const LEAST: f64 = 0.01;

/// Names of the parts: not A and B, which are types of evaluation. What remains of a variance has none.
pub(crate) const LETTERS: [&str; 5] = ["P", "Q", "R", "S", "T"];

/// The axis: percent of the variance.
const PERCENT: Scale = Scale { values: [0.0, 100.0], places: BARS };

/// Draws the shares of one variance in the order of `LETTERS`; they are at most 1 together.
pub(crate) fn shares(shares: &[f64]) -> Markup {
    let mut end = 0.0;
    let large = shares.iter().enumerate().filter(|(_, share)| **share >= LEAST);
    let parts = large.map(|(place, share)| {
        let from = end;
        end += share;
        part(place, [from, end].map(|at| PERCENT.clamped(100.0 * at)), 100.0 * share)
    });
    let parts: Vec<Markup> = parts.collect();
    let y = 0.5 * HEIGHT;
    let rest = PERCENT.clamped(100.0 * end);
    let drawing = html! {
        @if rest < BARS[1] { (rectangle([rest, y - BAR_HALF], [BARS[1], y + BAR_HALF], "share rest", None)) }
        @for part in &parts { (part) }
    };
    strip([WIDTH, HEIGHT], &drawing)
}

fn part(place: usize, [from, to]: [f64; 2], percent: f64) -> Markup {
    let y = 0.5 * HEIGHT;
    let letter = LETTERS.get(place).copied().unwrap_or_default();
    let names = [format!("{letter}\u{a0}{percent:.0}"), letter.to_owned()];
    let name = names.into_iter().find(|name| width(name) + MARGIN <= to - from);
    html! {
        (rectangle([from, y - BAR_HALF], [to, y + BAR_HALF], &class(Some(place)), None))
        @if let Some(name) = name { (words([0.5 * (from + to), y + 4.0], Anchor::Middle, "small", &name)) }
    }
}

/// Draws the axis of the strips, in percent of the variance.
pub(crate) fn axis(languages: &Languages) -> Markup {
    strip_axis(languages, &PERCENT, WIDTH)
}

/// Draws the sample of a part for a legend; `None` for the remainder.
pub(crate) fn sample(place: Option<usize>) -> Markup {
    html! {
        (rectangle([2.0, 1.0], [26.0, 13.0], &class(place), None))
        @if let Some(letter) = place.and_then(|place| LETTERS.get(place)) {
            (words([14.0, 11.0], Anchor::Middle, "small", letter))
        }
    }
}

fn class(place: Option<usize>) -> String {
    place.map_or_else(|| "share rest".to_owned(), |place| format!("share part-{}", place + 1))
}
