//! Certified deviations as bars in their table: a column for each of α, β, γ, all to one scale.

use super::drawing::{Scale, Ticks, legend, line, rectangle, strip, strip_axis, whisker};
use crate::calibration::verdict::COVERAGE_FACTOR;
use crate::report::page::language::{Language, Languages, Text};
use crate::report::page::number::LARGEST_IN_ARCSEC;
use crate::stand::CertifiedPosition;
use crate::units::ARCSECONDS_PER_DEGREE;
use crate::wording::texts::pictures as texts;
use crate::wording::texts::units;
use maud::{Markup, html};

const WIDTH: f64 = 116.0;
const HEIGHT: f64 = 13.0;
/// Left and right end of the bars, with room for the outer numbers of the axis.
const BARS: [f64; 2] = [13.0, 103.0];
const BAR_HALF: f64 = 4.0;
/// Length of a whisker from which its ends have marks.
const SHORTEST_WITH_MARKS: f64 = 5.0;
/// Length from which a whisker is seen beside the end of its bar.
const SHORTEST_SEEN: f64 = 2.0;

/// Largest value on an axis, arcsec: 180°. The uncertainties themselves have no limit.
const LARGEST_ARCSEC: f64 = 648_000.0;

/// Returns a scale whose longer bars have a number on their own side of 0: an end not far from one moves out to it.
fn widened([low, high]: [f64; 2]) -> Scale {
    let scale = Scale { values: [low, high], places: BARS };
    let step = Ticks::along(&scale, Language::English).step;
    let end = |end: f64| if end >= 0.5 * step && end < step { step } else { end };
    Scale { values: [-end(-low), end(high)], ..scale }
}

/// Bars of all deviations of a stand or of a passport, with their uncertainties if stated.
#[derive(Clone, Copy)]
pub(crate) struct Bars {
    scale: Scale,
    /// Largest uncertainty, if one is stated.
    largest_u: Option<f64>,
}

impl Bars {
    /// Creates bars to the scale of the largest deviation of `positions`.
    pub(crate) fn of(positions: &[CertifiedPosition]) -> Self {
        let all = positions.iter().flat_map(|at| at.angles_arcsec().into_iter().zip(at.u_arcsec()));
        let ends = all.clone().flat_map(|(value, u)| {
            let half = COVERAGE_FACTOR * u.unwrap_or(0.0);
            [value - half, value + half]
        });
        let (low, high) = ends.fold((0.0, 0.0), |(low, high), end| (f64::min(low, end), f64::max(high, end)));
        let (low, high) = (low.max(-LARGEST_ARCSEC), high.min(LARGEST_ARCSEC));
        let high = if high > low { high } else { 1.0 };
        Self { scale: widened([low, high]), largest_u: all.filter_map(|(_, u)| u).reduce(f64::max) }
    }

    /// Draws a deviation.
    pub(crate) fn bar(&self, (value, u): (f64, Option<f64>)) -> Markup {
        let (scale, y) = (&self.scale, 0.5 * HEIGHT);
        let (zero, half) = (scale.place(0.0), COVERAGE_FACTOR * u.unwrap_or(0.0));
        let drawing = html! {
            (rectangle([zero, y - BAR_HALF], [scale.clamped(value), y + BAR_HALF], "bar", None))
            @if u.is_some() {
                @let ends = [value - half, value + half].map(|end| scale.clamped(end));
                // The marks of short ends would run together.
                (whisker(ends, [ends[1] - ends[0] >= SHORTEST_WITH_MARKS; 2], y, 3.0))
            }
            (line([zero, 0.0], [zero, HEIGHT], "zero"))
        };
        strip([WIDTH, HEIGHT], &drawing)
    }

    /// Draws the axis of a column, in degrees if there would be no room for the numbers in arcseconds.
    pub(crate) fn axis(&self, languages: &Languages) -> Markup {
        let unit_arcsec = if self.is_in_degrees() { ARCSECONDS_PER_DEGREE } else { 1.0 };
        let values = self.scale.values.map(|arcsec| arcsec / unit_arcsec);
        strip_axis(languages, &Scale { values, ..self.scale }, WIDTH)
    }

    /// Returns the unit of the axis.
    pub(crate) fn unit(&self) -> Text {
        if self.is_in_degrees() { units::DEGREES } else { units::ARCSEC }
    }

    /// Returns `true` if an uncertainty is stated.
    pub(crate) fn has_u(&self) -> bool {
        self.largest_u.is_some()
    }

    fn is_in_degrees(&self) -> bool {
        self.scale.values[1].max(-self.scale.values[0]) > LARGEST_IN_ARCSEC
    }

    /// Draws what bars and whiskers mean, the whiskers expanded uncertainties or twice an own part.
    pub(crate) fn key(&self, languages: &Languages, is_expanded: bool) -> Markup {
        let bar = rectangle([2.0, 2.5], [26.0, 11.5], "bar", None);
        let whisker = whisker([2.0, 26.0], [true; 2], 7.0, 3.0);
        let length = |u: f64| self.scale.place(COVERAGE_FACTOR * u) - self.scale.place(-COVERAGE_FACTOR * u);
        let second = match self.largest_u.map(length) {
            None => (html! {}, texts::DEVIATION_NO_U),
            Some(length) if length < SHORTEST_SEEN => {
                (html! {}, if is_expanded { texts::DEVIATION_EXPANDED_UNSEEN } else { texts::DEVIATION_WHISKER_UNSEEN })
            }
            Some(_) if is_expanded => (whisker, texts::DEVIATION_WHISKER_EXPANDED),
            Some(_) => (whisker, texts::DEVIATION_WHISKER),
        };
        legend(languages, &[(bar, texts::DEVIATION_BAR), second])
    }
}
