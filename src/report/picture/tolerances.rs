//! Parameters of a gyro against the tolerance of its type: deviation, expanded uncertainty, and both decision rules.

use super::accuracy::unit;
use super::drawing::{
    Anchor, Panel, Point, Scale, Ticks, arrow, coordinate, label, legend, line, number, panels, plain_symbol, polygon,
    rectangle, symbol, words,
};
use crate::calibration::parameter::Parameter;
use crate::calibration::verdict::{COVERAGE_FACTOR, Decision, ParameterVerdict, Verdict};
use crate::report::page::language::{Language, Languages, Text};
use crate::report::page::number::Number;
use crate::report::page::texts::{pictures as texts, units};
use maud::{Markup, html};

const PANEL_PIXELS: u32 = 330;
const WIDTH: f64 = 470.0;
const FIELD: [f64; 2] = [44.0, 300.0];
const TOP: f64 = 12.0;
const ROW: f64 = 24.0;
const AXIS_HEIGHT: f64 = 36.0;

/// Smallest and largest end of the axis, in tolerances. An arrow points to values beyond.
const REACH: [f64; 2] = [1.3, 4.0];
const ROOM_FOR_ARROW: f64 = 22.0;

/// Draws a verdict against a type, or on a change since an earlier result. `name` distinguishes two such pictures on a
/// page.
pub(crate) fn tolerances(languages: &Languages, name: &str, verdict: &Verdict) -> Markup {
    let ends = verdict.parameters.iter().filter(|row| row.tolerance > 0.0);
    let farthest = ends.map(|row| (row.deviation.abs() + row.expanded_uncertainty) / row.tolerance).fold(0.0, f64::max);
    let reach = (1.1 * farthest).clamp(REACH[0], REACH[1]);
    let scale = Scale { values: [-reach, reach], places: FIELD };
    let bottom = TOP + ROW * verdict.parameters.len() as f64;
    let panel = Panel { name, languages, size: [WIDTH, bottom + AXIS_HEIGHT] };
    let beyond = |from: f64, to: f64| {
        rectangle([scale.place(from), TOP], [scale.place(to), bottom], "beyond", Some(&panel.filled_with("beyond")))
    };
    let rows = verdict.parameters.iter().enumerate();
    let drawing = [
        panel.hatch("beyond"),
        beyond(-reach, -1.0),
        beyond(1.0, reach),
        grid(languages, &scale, bottom),
        html! { @for (place, row) in rows { (parameter(languages, row, &scale, TOP + ROW * (place as f64 + 0.5))) } },
        limit(scale.place(-1.0), bottom),
        limit(scale.place(1.0), bottom),
    ];
    let svg = panel.svg(
        |language| texts::TOLERANCES_TITLE.of(language).to_owned(),
        |language| in_words(language, verdict),
        &drawing,
    );
    panels(1, PANEL_PIXELS, &[svg], &key(languages))
}

fn limit(x: f64, bottom: f64) -> Markup {
    line([x, TOP - 5.0], [x, bottom + 5.0], "limit")
}

fn key(languages: &Languages) -> Markup {
    let entry = |decision: Decision, text: Text| (decided([14.0, 7.0], decision), text);
    let whisker = html! { (whisker(2.0, 26.0, 7.0)) };
    let entries = [
        entry(Decision::Pass, texts::DECISION_PASS),
        entry(Decision::Undecided, texts::DECISION_UNDECIDED),
        entry(Decision::Fail, texts::DECISION_FAIL),
        (whisker, texts::TOLERANCES_WHISKER),
        (rectangle([2.0, 2.0], [26.0, 12.0], "limits", None), texts::TOLERANCES_GUARDED),
        (line([14.0, 0.0], [14.0, 14.0], "limit"), texts::TOLERANCES_LIMIT),
    ];
    legend(languages, &entries)
}

/// Draws the mark of a decision: a disc, a ring, or a cross.
fn decided([x, y]: Point, decision: Decision) -> Markup {
    let (cx, cy) = (coordinate(x), coordinate(y));
    match decision {
        Decision::Pass => html! { circle.mark cx=(cx) cy=(cy) r="4.4" {} },
        Decision::Undecided => html! { circle.site cx=(cx) cy=(cy) r="4.2" {} },
        Decision::Fail => {
            let (a, b) = (5.2, 1.7);
            let arms = [[-a, -a + b], [-b, 0.0], [-a, a - b], [-a + b, a], [0.0, b], [a - b, a], [a, a - b], [b, 0.0]];
            let rest = [[a, -a + b], [a - b, -a], [0.0, -b], [-a + b, -a]];
            let points: Vec<Point> = arms.iter().chain(&rest).map(|[dx, dy]| [x + dx, y + dy]).collect();
            polygon(&points, "mark")
        }
    }
}

fn whisker(from: f64, to: f64, y: f64) -> Markup {
    let [x1, x2, above, below] = [from, to, y - 4.0, y + 4.0].map(coordinate);
    let middle = coordinate(y);
    html! { path.whisker d={ "M" (x1) "," (middle) "H" (x2) "M" (x1) "," (above) "V" (below) "M" (x2) "," (above) "V" (below) } {} }
}

fn grid(languages: &Languages, scale: &Scale, bottom: f64) -> Markup {
    let percent = Scale { values: scale.values.map(|value| 100.0 * value), places: scale.places };
    let ticks = Ticks::along(&percent, languages.first());
    html! {
        @for value in &ticks.values {
            @let x = percent.place(*value);
            (line([x, TOP], [x, bottom + 4.0], "grid"))
            (words([x, bottom + 16.0], Anchor::Middle, "small", &ticks.text(*value, languages.first())))
        }
        (words([FIELD[0], bottom + 31.0], Anchor::Start, "small", &languages.plain(texts::ACCURACY_AXIS)))
    }
}

fn parameter(languages: &Languages, row: &ParameterVerdict, scale: &Scale, y: f64) -> Markup {
    let (deviation, expanded) = printed(row);
    let name = parameter_of(row).map_or(row.parameter, Parameter::symbol);
    let guarded = row.tolerance - row.expanded_uncertainty;
    let share = |value: f64| scale.clamped(value / row.tolerance);
    // An arrow marks a value beyond the axis, because a mark at its end would be misplaced.
    let [low, high] = scale.values;
    let beyond = match row.deviation / row.tolerance {
        share if share < low => Some((FIELD[0], 1.0)),
        share if share > high => Some((FIELD[1], -1.0)),
        _ => None,
    };
    html! {
        (label([36.0, y + 4.0], Anchor::End, "", &symbol(name)))
        @if row.tolerance > 0.0 {
            @if guarded > 0.0 { (rectangle([share(-guarded), y - 8.0], [share(guarded), y + 8.0], "limits", None)) }
            @if let Some((end, inwards)) = beyond {
                (arrow([end + inwards * ROOM_FOR_ARROW, y], [end, y], "meridian"))
                (decided([end + inwards * ROOM_FOR_ARROW, y], row.guarded))
            } @else {
                (whisker(share(row.deviation - row.expanded_uncertainty), share(row.deviation + row.expanded_uncertainty), y))
                (decided([share(row.deviation), y], row.guarded))
            }
        }
        (number([352.0, y + 4.0], Anchor::End, row.deviation, &deviation.text(languages.first())))
        (words([356.0, y + 4.0], Anchor::Start, "", "±"))
        (number([406.0, y + 4.0], Anchor::End, row.expanded_uncertainty, &expanded.text(languages.first())))
        (words([411.0, y + 4.0], Anchor::Start, "small", unit_of(row).of(languages.first())))
    }
}

/// Returns deviation and expanded uncertainty, rounded to the second digit of the standard uncertainty.
pub(crate) fn printed(row: &ParameterVerdict) -> (Number, Number) {
    let u = row.expanded_uncertainty / COVERAGE_FACTOR;
    (Number::measured(row.deviation, u), Number::measured(row.expanded_uncertainty, u))
}

/// Returns the parameter of a line of a verdict, or `None` if its key is unknown.
pub(crate) fn parameter_of(row: &ParameterVerdict) -> Option<Parameter> {
    Parameter::NINE.into_iter().find(|parameter| parameter.key() == row.parameter)
}

/// Returns the unit of a line of a verdict: percent for scale factors, the parameter's own otherwise.
pub(crate) fn unit_of(row: &ParameterVerdict) -> Text {
    match (row.unit, parameter_of(row)) {
        ("%", _) | (_, None) => units::PERCENT,
        (_, Some(parameter)) => unit(parameter),
    }
}

/// Returns a decision as a text for pages.
pub(crate) fn decision(decision: Decision) -> Text {
    match decision {
        Decision::Pass => texts::DECISION_PASS,
        Decision::Fail => texts::DECISION_FAIL,
        Decision::Undecided => texts::DECISION_UNDECIDED,
    }
}

fn in_words(language: Language, verdict: &Verdict) -> String {
    let each = verdict.parameters.iter().map(|row| {
        let (deviation, expanded) = printed(row);
        let name = plain_symbol(parameter_of(row).map_or(row.parameter, Parameter::symbol));
        let values = [
            ("parameter", name.as_str()),
            ("deviation", &deviation.text(language)),
            ("expanded", &expanded.text(language)),
            ("tolerance", &Number::exact(row.tolerance).text(language)),
            ("unit", unit_of(row).of(language)),
            ("decision", decision(row.guarded).of(language)),
        ];
        texts::TOLERANCE_IN_WORDS.filled(language, &values)
    });
    each.collect::<Vec<_>>().join("; ") + "."
}
