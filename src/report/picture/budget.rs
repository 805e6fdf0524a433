//! Uncertainty budget as a picture file: one panel for each parameter, its largest contributions as bars.

use super::drawing::{Anchor, Point, Scale, label, number, plain_symbol, rectangle, symbol, symbols};
use super::file::file;
use crate::calibration::Parameter;
use crate::calibration::parameter::unit;
use crate::report::page::spacing::BLANK;
use crate::report::page::{Language, Number};
use crate::uncertainty::{Budget, ParameterBudget};
use maud::{Markup, html};

/// Largest number of bars of a panel; one more bar combines the rest.
const MOST_BARS: usize = 6;
const COLUMNS: usize = 2;

/// Width of a panel; left and right end of its bars. Names are to their left, numbers to their right.
const WIDTH: f64 = 430.0;
const BARS: Point = [176.0, 356.0];
const TOP: f64 = 34.0;
const ROW: f64 = 17.0;
const BAR_HALF: f64 = 5.5;
const HEIGHT: f64 = TOP + ROW * (MOST_BARS + 1) as f64 + 16.0;
const WORDS_HEIGHT: f64 = 28.0;

const WORDS: &str = "Bars: contribution of each kind of input to the standard uncertainty. The width of the frame is u, the \
                     root sum of squares of the bars.";

/// Draws a budget, in black and white. Returns `None` if no input has an uncertainty.
pub(crate) fn budget(budget: &Budget) -> Option<String> {
    if budget.parameters.is_empty() || budget.inputs.is_empty() {
        return None;
    }
    let height = HEIGHT * budget.parameters.len().div_ceil(COLUMNS) as f64;
    let corner = |place: usize| [WIDTH * (place % COLUMNS) as f64, HEIGHT * (place / COLUMNS) as f64];
    let lines = Parameter::in_paper_order(&budget.parameters, |line| line.parameter);
    let drawing = [
        html! { @for (place, line) in lines.iter().enumerate() { g { (parameter(line, corner(place))) } } },
        label([14.0, height + 10.0], Anchor::Start, "", &symbols(WORDS)),
    ];
    let size = [WIDTH * COLUMNS as f64, height + WORDS_HEIGHT];
    Some(file("budget", size, "Uncertainty budget", &in_words(&lines), &drawing))
}

fn parameter(line: &ParameterBudget, [left, top]: Point) -> Markup {
    let u = line.standard_uncertainty;
    let bars = bars(line);
    // One digit more than u has: the small ones can be told from 0, and the decimal points are in one line.
    let place = Number::place_of(u) - 1;
    let digits = |contribution: f64| Number::to_place(contribution, place).text(Language::English);
    // Without any uncertainty the bars have no length, so any scale will do.
    let reach = if u > 0.0 { u } else { 1.0 };
    let scale = Scale { values: [0.0, reach], places: BARS.map(|x| left + x) };
    let [start, end] = scale.places;
    let bottom = top + TOP + ROW * bars.len() as f64;
    let bar = |place: usize, (name, contribution): &(String, f64)| {
        let y = top + TOP + ROW * (place as f64 + 0.5);
        html! {
            (label([start - 6.0, y + 4.0], Anchor::End, "", &symbols(name)))
            (rectangle([start, y - BAR_HALF], [scale.clamped(*contribution), y + BAR_HALF], "bar", None))
            (number([end + 6.0, y + 4.0], Anchor::Start, "", *contribution, &digits(*contribution)))
        }
    };
    let title = html! { (symbol(line.parameter.symbol())) tspan dy="-3" { ": " (symbols("u = ")) (with_unit(line)) } };
    html! {
        (label([left + 14.0, top + 20.0], Anchor::Start, "title", &title))
        @for (place, named) in bars.iter().enumerate() { (bar(place, named)) }
        (rectangle([start, top + TOP - 2.0], [end, bottom + 2.0], "frame-line", None))
    }
}

/// Returns the kinds of input and their contributions; the smallest are combined.
fn bars(line: &ParameterBudget) -> Vec<(String, f64)> {
    let mut bars: Vec<(String, f64)> =
        line.contributions.iter().map(|part| (part.cause.kind(), part.contribution)).collect();
    // A single remaining contribution is drawn as it is.
    if bars.len() > MOST_BARS + 1 {
        let rest = bars.split_off(MOST_BARS);
        let sum: f64 = rest.iter().map(|(_, part)| part * part).sum();
        bars.push((format!("{} others", rest.len()), sum.sqrt()));
    }
    bars
}

fn with_unit(line: &ParameterBudget) -> String {
    let u = Number::scientific(line.standard_uncertainty, 2).text(Language::English);
    format!("{u}{BLANK}{}", unit(line.parameter).of(Language::English))
}

fn in_words(lines: &[&ParameterBudget]) -> String {
    let line = |line: &&ParameterBudget| {
        let most = line.contributions.first().map_or_else(String::new, |first| {
            format!(", {:.0} % of its variance from {}", 100.0 * first.share, first.cause.kind())
        });
        format!("{}: u = {}{most}", plain_symbol(line.parameter.symbol()), with_unit(line))
    };
    lines.iter().map(line).collect::<Vec<_>>().join("; ") + "."
}
