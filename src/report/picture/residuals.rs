//! Residuals of each equation after the fit, with limits from their uncertainty.

use super::drawing::{
    Anchor, Panel, Scale, Ticks, crowding, legend, line, nothing, number, panels, power, power_of_ten, rectangle, words,
};
use crate::calibration::document::{ResidualDocument, ResultDocument};
use crate::report::page::language::{Language, Languages};
use crate::report::page::number::Number;
use crate::report::page::texts::{pictures as texts, units};
use maud::{Markup, html};

const PANEL_PIXELS: u32 = 235;
const COLUMNS: u32 = 2;
const WIDTH: f64 = 270.0;
/// Left and right end of the bars, between the indices on the left and the numbers on the right.
const BARS: [f64; 2] = [40.0, 196.0];
const TOP: f64 = 26.0;
const ROW: f64 = 17.0;
const AXIS_HEIGHT: f64 = 24.0;

/// Limits, in standard uncertainties of the residual on either side.
pub(crate) const LIMIT: f64 = 2.0;

/// A function that returns a residual along one axis and its standard uncertainty, deg/h.
type Along = fn(&ResidualDocument) -> (f64, Option<f64>);

const AXES: [(&str, Along); 2] = [("x", |at| (at.x, at.u_x)), ("y", |at| (at.y, at.u_y))];

/// Draws the residuals of the result of one method with their limits.
pub(crate) fn residuals(languages: &Languages, result: &ResultDocument) -> Markup {
    let all = result.residuals_deg_per_h.iter().flat_map(|at| AXES.map(|(_, along)| along(at)));
    let reach = all.fold(0.0, |most, (value, u)| f64::max(most, value.abs().max(LIMIT * u.unwrap_or(0.0))));
    let reach = if reach > 0.0 && reach.is_finite() { 1.05 * reach } else { 1.0 };
    let scale = Scale { values: [-reach, reach], places: BARS };
    let drawings = AXES.map(|axis| panel(languages, &result.residuals_deg_per_h, axis, &scale));
    panels(COLUMNS, PANEL_PIXELS, &drawings, &key(languages))
}

fn key(languages: &Languages) -> Markup {
    let entries = [
        (rectangle([2.0, 4.0], [26.0, 10.0], "bar", None), texts::RESIDUAL),
        (rectangle([2.0, 1.0], [26.0, 13.0], "limits", None), texts::RESIDUAL_LIMITS),
    ];
    legend(languages, &entries)
}

fn panel(languages: &Languages, residuals: &[ResidualDocument], (axis, along): (&str, Along), scale: &Scale) -> Markup {
    let bottom = TOP + ROW * residuals.len() as f64;
    let name = format!("residuals-{axis}");
    let panel = Panel { name: &name, languages, size: [WIDTH, bottom + AXIS_HEIGHT] };
    let row = |place: usize, at: &ResidualDocument| {
        let (y, (value, u)) = (TOP + ROW * (place as f64 + 0.5), along(at));
        let printed = Number::measured(value, u.unwrap_or(0.0)).text(languages.first());
        let band =
            |u: f64| rectangle([scale.place(-LIMIT * u), y - 6.5], [scale.place(LIMIT * u), y + 6.5], "limits", None);
        html! {
            (words([32.0, y + 4.0], Anchor::End, "", &format!("({}, {})", at.i, at.j)))
            (u.map_or_else(nothing, band))
            (rectangle([scale.place(0.0), y - 3.0], [scale.place(value), y + 3.0], "bar", None))
            (number([WIDTH - 2.0, y + 4.0], Anchor::End, value, &printed))
        }
    };
    let rows: Vec<Markup> = residuals.iter().enumerate().map(|(place, at)| row(place, at)).collect();
    let zero = scale.place(0.0);
    let drawing = [
        words([BARS[0], 14.0], Anchor::Start, "title letter", axis),
        words([WIDTH - 2.0, 14.0], Anchor::End, "small", &languages.plain(units::DEG_PER_H)),
        grid(languages, scale, bottom),
        html! { @for row in &rows { (row) } },
        line([zero, TOP], [zero, bottom], "zero"),
    ];
    panel.svg(
        |language| texts::RESIDUALS_TITLE.filled(language, &[("axis", axis)]),
        |language| in_words(language, residuals, along),
        &drawing,
    )
}

fn grid(languages: &Languages, scale: &Scale, bottom: f64) -> Markup {
    let exponent = crowding(scale.values[1]);
    let factor = power_of_ten(exponent);
    let ticks = Ticks::along(&Scale { values: scale.values.map(|value| value / factor), ..*scale }, languages.first());
    html! {
        @if exponent != 0 {
            (words([WIDTH - 2.0, bottom + 16.0], Anchor::End, "small", &format!("× {}", power(exponent, languages.first()))))
        }
        @for value in &ticks.values {
            @let x = scale.place(value * factor);
            (line([x, TOP], [x, bottom + 4.0], "grid"))
            (words([x, bottom + 16.0], Anchor::Middle, "small", &ticks.text(*value, languages.first())))
        }
    }
}

fn in_words(language: Language, residuals: &[ResidualDocument], along: Along) -> String {
    let each = residuals.iter().map(|at| {
        let (value, u) = along(at);
        let index = format!("({}, {})", at.i, at.j);
        let [value, u] = [Number::measured(value, u.unwrap_or(0.0)), Number::uncertainty(u.unwrap_or(0.0))]
            .map(|number| number.text(language));
        texts::RESIDUAL_IN_WORDS.filled(language, &[("index", &index), ("value", &value), ("u", &u)])
    });
    let list = each.collect::<Vec<_>>().join("; ");
    texts::VECTORS_DESCRIPTION.filled(language, &[("unit", units::DEG_PER_H.of(language)), ("list", &list)])
}
