//! Parameters of a gyro within the tolerance of its type, as strips in their table: deviation, expanded uncertainty, and
//! the decision.

use super::drawing::{Point, Scale, arrow, coordinate, legend, line, polygon, rectangle, strip, strip_axis, whisker};
use crate::calibration::parameter::unit;
use crate::calibration::{Decision, Parameter, ParameterVerdict, Verdict};
use crate::report::page::Number;
use crate::report::page::language::{Languages, Text};
use crate::wording::texts::{pictures as texts, units};
use maud::{Markup, html};

const HEIGHT: f64 = 17.0;
/// Beside the ends of the axis, for the arrow from the mark of a value that is beyond one of them.
const ROOM_FOR_ARROW: f64 = 16.0;

/// The axis of every strip, in tolerances: to both limits and half as far again, so that strips of all reports compare. The
/// mark of a value beyond it stands at its end, with an arrow outwards.
const AXIS: [f64; 2] = [-1.5, 1.5];

/// Strips of a table, by their width.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Strips {
    width: f64,
}

/// Strips beside deviations and decisions, and wider ones beside values alone.
pub(crate) const BESIDE_DECISIONS: Strips = Strips { width: 140.0 };
pub(crate) const BESIDE_VALUES: Strips = Strips { width: 400.0 };

/// Returns the ends of the interval of a deviation with its expanded uncertainty.
fn ends(row: &ParameterVerdict) -> [f64; 2] {
    [-1.0, 1.0].map(|sign| row.deviation + sign * row.expanded_uncertainty)
}

/// Returns `true` if a deviation is within the axis.
fn reaches(row: &ParameterVerdict, deviation: f64) -> bool {
    let [low, high] = AXIS;
    (low..=high).contains(&(deviation / row.tolerance))
}

impl Strips {
    /// Returns the axis, in units of which the tolerance has `tolerance`.
    fn scale(self, tolerance: f64) -> Scale {
        Scale { values: AXIS.map(|value| tolerance * value), places: [ROOM_FOR_ARROW, self.width - ROOM_FOR_ARROW] }
    }

    /// Draws the axis of the strips, in percent of the tolerance.
    pub(crate) fn axis(self, languages: &Languages) -> Markup {
        strip_axis(languages, &self.scale(100.0), self.width)
    }

    /// Draws a parameter of a verdict: only the limits if its tolerance is 0.
    pub(crate) fn of_parameter(self, verdict: &Verdict, row: &ParameterVerdict) -> Markup {
        let scale = self.scale(1.0);
        let decision = verdict.decision(row);
        let (y, guarded) = (0.5 * HEIGHT, row.tolerance - verdict.guard_band(row));
        let share = |value: f64| scale.clamped(value / row.tolerance);
        let (x, outwards) = (share(row.deviation), row.deviation.signum() * (ROOM_FOR_ARROW - 1.0));
        let limits = [-1.0, 1.0].map(|limit| scale.place(limit));
        let drawing = html! {
            @if row.tolerance > 0.0 {
                @if guarded > 0.0 { (rectangle([share(-guarded), y - 6.0], [share(guarded), y + 6.0], "limits", None)) }
                (line([scale.place(0.0), 0.0], [scale.place(0.0), HEIGHT], "grid"))
            }
            // Below the marks: a value close to a limit is on one side of it.
            @for x in limits { (line([x, 0.0], [x, HEIGHT], "limit")) }
            @if row.tolerance > 0.0 {
                @let ends = ends(row);
                @let within = ends.map(|end| reaches(row, end));
                (whisker(ends.map(share), within, y, 4.0))
                @for end in ends.iter().zip(within).filter(|(_, within)| !within).map(|(end, _)| share(*end)) {
                    (arrow([x, y], [end, y], "meridian"))
                }
                @if !reaches(row, row.deviation) { (arrow([x, y], [x + outwards, y], "meridian")) }
                (decided([x, y], decision))
            }
        };
        strip([self.width, HEIGHT], &drawing)
    }
}

/// Draws what the parts of the strips of verdicts mean.
pub(crate) fn key(languages: &Languages, verdicts: &[&Verdict]) -> Markup {
    let entry = |found: Option<Decision>| (decided([21.0, 7.0], found), decision(found));
    let decisions = match verdicts.iter().all(|verdict| verdict.withheld) {
        true => vec![entry(None)],
        false => [Decision::Pass, Decision::Undecided, Decision::Fail].map(|found| entry(Some(found))).to_vec(),
    };
    let is_cut = |row: &ParameterVerdict| row.tolerance > 0.0 && !ends(row).iter().all(|end| reaches(row, *end));
    let beyond = verdicts.iter().flat_map(|verdict| &verdict.parameters).any(is_cut);
    let arrow = beyond.then(|| (arrow([2.0, 7.0], [26.0, 7.0], "meridian"), texts::TOLERANCES_BEYOND));
    let parts = [
        (whisker([2.0, 26.0], [true; 2], 7.0, 4.0), texts::TOLERANCES_WHISKER),
        (line([21.0, 0.0], [21.0, 14.0], "limit"), texts::TOLERANCES_LIMIT),
        (rectangle([2.0, 2.0], [26.0, 12.0], "limits", None), texts::TOLERANCES_GUARDED),
    ];
    let entries: Vec<(Markup, Text)> = decisions.into_iter().chain(arrow).chain(parts).collect();
    legend(languages, &entries)
}

/// Draws the mark of a decision: a disc, a disc half filled, or a cross; a circle if there is none.
fn decided([x, y]: Point, decision: Option<Decision>) -> Markup {
    let (cx, cy) = (coordinate(x), coordinate(y));
    let found = match decision {
        None => html! { circle.site cx=(cx) cy=(cy) r="4.2" {} },
        Some(Decision::Pass) => html! { circle.mark cx=(cx) cy=(cy) r="4.4" {} },
        Some(Decision::Undecided) => {
            let [top, bottom] = [y - 4.2, y + 4.2].map(coordinate);
            html! {
                circle.site cx=(cx) cy=(cy) r="4.2" {}
                path.half d={ "M" (cx) " " (top) "A4.2 4.2 0 0 0 " (cx) " " (bottom) "Z" } {}
            }
        }
        Some(Decision::Fail) => {
            let (a, b) = (5.2, 1.7);
            let arms = [[-a, -a + b], [-b, 0.0], [-a, a - b], [-a + b, a], [0.0, b], [a - b, a], [a, a - b], [b, 0.0]];
            let rest = [[a, -a + b], [a - b, -a], [0.0, -b], [-a + b, -a]];
            let points: Vec<Point> = arms.iter().chain(&rest).map(|[dx, dy]| [x + dx, y + dy]).collect();
            polygon(&points, "mark")
        }
    };
    html! { circle.ground cx=(cx) cy=(cy) r="5.8" {} (found) }
}

/// Returns deviation and expanded uncertainty, rounded to the second digit of the latter.
pub(crate) fn printed(row: &ParameterVerdict) -> (Number, Number) {
    let u = row.expanded_uncertainty;
    (Number::measured(row.deviation, u), Number::uncertainty(u))
}

/// Returns the unit of a line of a verdict: percent for scale factors, the parameter's own otherwise.
pub(crate) fn unit_of(row: &ParameterVerdict) -> Text {
    if row.unit == "%" { units::PERCENT } else { unit_at_type(row.parameter) }
}

/// Returns the unit of a parameter that refers to the g of a gyro type; that of one at local g has no zero.
pub(crate) fn unit_at_type(parameter: Parameter) -> Text {
    match unit(parameter) {
        units::DEG_PER_H_PER_G => units::DEG_PER_H_PER_G0,
        other => other,
    }
}

/// Returns a decision as a text for pages.
pub(crate) fn decision(decision: Option<Decision>) -> Text {
    match decision {
        None => texts::NOT_ASSESSED,
        Some(Decision::Pass) => texts::DECISION_PASS,
        Some(Decision::Fail) => texts::DECISION_FAIL,
        Some(Decision::Undecided) => texts::DECISION_UNDECIDED,
    }
}
