//! Certified deviations as bars: a panel for each of α, β, γ, all to one scale.

use super::drawing::{
    Anchor, Panel, Scale, Ticks, coordinate, legend, line, nothing, number, panels, rectangle, words,
};
use crate::report::page::language::{Language, Languages};
use crate::report::page::number::Number;
use crate::report::page::texts::pictures as texts;
use crate::stand::CertifiedPosition;
use maud::{Markup, html};

const PANEL_PIXELS: u32 = 205;
const COLUMNS: u32 = 3;
const WIDTH: f64 = 226.0;
/// Left and right end of the bars, between the indices on the left and the numbers on the right.
const BARS: [f64; 2] = [40.0, 156.0];
const TOP: f64 = 26.0;
const ROW: f64 = 17.0;
const BAR_HALF: f64 = 4.5;
const AXIS_HEIGHT: f64 = 24.0;

/// Half-length of the whiskers, in standard uncertainties.
const COVERAGE_FACTOR: f64 = 2.0;

/// Largest value on an axis, arcsec: 180°. The uncertainties themselves have no limit.
const LARGEST_ARCSEC: f64 = 648_000.0;

/// A function that returns one deviation of a position and its standard uncertainty, arcsec.
type OfPosition = fn(&CertifiedPosition) -> (f64, Option<f64>);

/// Letter and axis of each angle, and the function that returns it.
const ANGLES: [(&str, &str, OfPosition); 3] = [
    ("α", "x", |at| (at.alpha_arcsec, at.u_alpha_arcsec)),
    ("β", "y", |at| (at.beta_arcsec, at.u_beta_arcsec)),
    ("γ", "z", |at| (at.gamma_arcsec, at.u_gamma_arcsec)),
];

/// Draws the deviations of `positions`, of a stand or of a passport, with their uncertainties if stated.
pub(crate) fn deviations(languages: &Languages, positions: &[CertifiedPosition]) -> Markup {
    let all = positions.iter().flat_map(|at| ANGLES.map(|(_, _, of)| of(at)));
    let ends = all.clone().flat_map(|(value, u)| {
        let half = COVERAGE_FACTOR * u.unwrap_or(0.0);
        [value - half, value + half]
    });
    let (low, high) = ends.fold((0.0, 0.0), |(low, high), end| (f64::min(low, end), f64::max(high, end)));
    let (low, high) = (low.max(-LARGEST_ARCSEC), high.min(LARGEST_ARCSEC));
    let high = if high > low { high } else { 1.0 };
    let scale = Scale { values: [low, high], places: BARS };
    let drawings = ANGLES.map(|angle| panel(languages, positions, angle, &scale));
    panels(COLUMNS, PANEL_PIXELS, &drawings, &key(languages, all.clone().any(|(_, u)| u.is_some())))
}

fn key(languages: &Languages, stated: bool) -> Markup {
    let bar = rectangle([2.0, 2.5], [26.0, 11.5], "bar", None);
    let whisker = whisker(2.0, 26.0, 7.0);
    let second = if stated { (whisker, texts::DEVIATION_WHISKER) } else { (nothing(), texts::DEVIATION_NO_U) };
    legend(languages, &[(bar, texts::DEVIATION_BAR), second])
}

fn panel(
    languages: &Languages,
    positions: &[CertifiedPosition],
    (angle, axis, of): (&str, &str, OfPosition),
    scale: &Scale,
) -> Markup {
    let bottom = TOP + ROW * positions.len() as f64;
    let name = format!("deviations-{axis}");
    let panel = Panel { name: &name, languages, size: [WIDTH, bottom + AXIS_HEIGHT] };
    let values = [("angle", angle), ("axis", axis)];
    let heading = format!("{angle} ({axis}), ″");
    let mut drawing = vec![words([BARS[0], 14.0], Anchor::Start, "title", &heading), grid(languages, scale, bottom)];
    let mut group = None;
    for (row, at) in positions.iter().enumerate() {
        let y = TOP + ROW * (row as f64 + 0.5);
        if group.replace(at.i).is_some_and(|before| before != at.i) {
            drawing.push(line([0.0, y - 0.5 * ROW], [WIDTH, y - 0.5 * ROW], "part"));
        }
        drawing.push(bar(languages, at, of(at), scale, y));
    }
    let zero = scale.place(0.0);
    drawing.push(line([zero, TOP], [zero, bottom], "zero"));
    panel.svg(
        |language| texts::DEVIATIONS_TITLE.filled(language, &values),
        |language| in_words(language, positions, of),
        &drawing,
    )
}

/// Draws round values as faint lines, with their numbers at the lower end.
fn grid(languages: &Languages, scale: &Scale, bottom: f64) -> Markup {
    let ticks = Ticks::along(scale, languages.first());
    html! {
        @for value in &ticks.values {
            @let x = scale.place(*value);
            (line([x, TOP], [x, bottom + 4.0], "grid"))
            (words([x, bottom + 16.0], Anchor::Middle, "small", &ticks.text(*value, languages.first())))
        }
    }
}

fn bar(languages: &Languages, at: &CertifiedPosition, (value, u): (f64, Option<f64>), scale: &Scale, y: f64) -> Markup {
    let printed = Number::measured(value, u.unwrap_or(0.0)).text(languages.first());
    let half = COVERAGE_FACTOR * u.unwrap_or(0.0);
    html! {
        (words([32.0, y + 4.0], Anchor::End, "", &at.index().to_string()))
        (rectangle([scale.place(0.0), y - BAR_HALF], [scale.clamped(value), y + BAR_HALF], "bar", None))
        @if u.is_some() { (whisker(scale.clamped(value - half), scale.clamped(value + half), y)) }
        (number([WIDTH - 2.0, y + 4.0], Anchor::End, value, &printed))
    }
}

fn whisker(from: f64, to: f64, y: f64) -> Markup {
    let [x1, x2, above, below] = [from, to, y - 3.0, y + 3.0].map(coordinate);
    let middle = coordinate(y);
    html! { path.whisker d={ "M" (x1) "," (middle) "H" (x2) "M" (x1) "," (above) "V" (below) "M" (x2) "," (above) "V" (below) } {} }
}

fn in_words(language: Language, positions: &[CertifiedPosition], of: OfPosition) -> String {
    let each = positions.iter().map(|at| {
        let (value, u) = of(at);
        let index = at.index().to_string();
        let value = Number::measured(value, u.unwrap_or(0.0)).text(language);
        match u {
            Some(u) => {
                let u = Number::uncertainty(u).text(language);
                texts::DEVIATION_WITH_U_IN_WORDS.filled(language, &[("index", &index), ("value", &value), ("u", &u)])
            }
            None => texts::DEVIATION_IN_WORDS.filled(language, &[("index", &index), ("value", &value)]),
        }
    });
    each.collect::<Vec<_>>().join("; ") + "."
}
