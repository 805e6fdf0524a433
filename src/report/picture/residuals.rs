//! Residuals of each equation after the fit, and changes of deviations, as bars in their table with limits from their
//! uncertainty.

use super::drawing::{Anchor, Scale, Ticks, crowding, legend, line, power_of_ten, rectangle, strip, with_power, words};
use crate::calibration::document::{ResidualDocument, ResultDocument};
use crate::report::page::language::{Languages, Text};
use crate::wording::texts::pictures as texts;
use maud::{Markup, html};

const WIDTH: f64 = 170.0;
const HEIGHT: f64 = 13.0;
/// Left and right end of the bars; the unit of the axis is to their right.
const BARS: [f64; 2] = [8.0, 118.0];

/// Limits, in standard uncertainties of the residual on either side.
pub(crate) const LIMIT: f64 = 2.0;

/// A function that returns a residual along one axis and its standard uncertainty, deg/h.
pub(crate) type Along = fn(&ResidualDocument) -> (f64, Option<f64>);

/// Axes of the case, and the functions that return the residuals along them.
pub(crate) const AXES: [(&str, Along); 2] = [("x", |at| (at.x, at.u_x)), ("y", |at| (at.y, at.u_y))];

/// Bars of values that are 0 but for their uncertainty, to one scale.
#[derive(Clone, Copy)]
pub(crate) struct Bars(Scale);

impl Bars {
    /// Creates bars to the scale of the largest residual or limit.
    pub(crate) fn of(result: &ResultDocument) -> Self {
        Self::over(result.residuals_deg_per_h.iter().flat_map(|at| AXES.map(|(_, along)| along(at))))
    }

    /// Creates bars to the scale of the largest value or limit; a value comes with its standard uncertainty, if known.
    pub(crate) fn over(values: impl Iterator<Item = (f64, Option<f64>)>) -> Self {
        let reach = values.fold(0.0, |most, (value, u)| f64::max(most, value.abs().max(LIMIT * u.unwrap_or(0.0))));
        let reach = if reach > 0.0 && reach.is_finite() { 1.05 * reach } else { 1.0 };
        Self(Scale { values: [-reach, reach], places: BARS })
    }

    /// Draws a value within its limits.
    pub(crate) fn bar(&self, (value, u): (f64, Option<f64>)) -> Markup {
        let (Self(scale), y) = (self, 0.5 * HEIGHT);
        let band =
            |u: f64| rectangle([scale.place(-LIMIT * u), y - 5.5], [scale.place(LIMIT * u), y + 5.5], "limits", None);
        let zero = scale.place(0.0);
        let drawing = html! {
            (u.map_or_else(Markup::default, band))
            (rectangle([zero, y - 2.5], [scale.place(value), y + 2.5], "bar", None))
            (line([zero, 0.0], [zero, HEIGHT], "zero"))
        };
        strip([WIDTH, HEIGHT], &drawing)
    }

    /// Draws the axis of a column, with the factor of its unit, and with the unit if the heading does not have it.
    pub(crate) fn axis(&self, languages: &Languages, unit: Option<Text>) -> Markup {
        let Self(scale) = self;
        let exponent = crowding(scale.values[1]);
        let factor = power_of_ten(exponent);
        let shown = Scale { values: scale.values.map(|value| value / factor), ..*scale };
        let language = languages.first();
        let unit = with_power(exponent, unit.map_or("", |unit| unit.of(language)), language);
        let drawing = html! {
            (words([WIDTH, 14.0], Anchor::End, "small", &unit))
            @for (value, text) in Ticks::along(&shown, language).marks(language) {
                @let x = shown.place(value);
                (line([x, 0.0], [x, 4.0], "grid"))
                (words([x, 14.0], Anchor::Middle, "small", &text))
            }
        };
        strip([WIDTH, 17.0], &drawing)
    }
}

/// Draws what bars and limits of residuals mean.
pub(crate) fn key(languages: &Languages) -> Markup {
    key_of(languages, texts::RESIDUAL, texts::RESIDUAL_LIMITS)
}

/// Draws what bars and limits mean.
pub(crate) fn key_of(languages: &Languages, bar: Text, limits: Text) -> Markup {
    let entries = [
        (rectangle([2.0, 4.0], [26.0, 10.0], "bar", None), bar),
        (rectangle([2.0, 1.0], [26.0, 13.0], "limits", None), limits),
    ];
    legend(languages, &entries)
}
