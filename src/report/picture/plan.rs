//! A plan next to the paper's eight positions as a picture file: the uncertainty of each parameter, and what errors
//! cost that all positions share.

use super::drawing::{Anchor, Point, Scale, label, number, plain_symbol, rectangle, symbol, symbols, words};
use super::file::{caption, file};
use crate::calibration::parameter::Parameter;
use crate::plan::sensitivity::{CommonError, Effect};
use crate::plan::{Evaluation, Plan};
use crate::report::page::language::Language;
use crate::report::page::number::Number;
use maud::{Markup, html};

/// Left and right end of the bars of both panels. Names are to their left, numbers to their right.
const BARS: [Point; 2] = [[52.0, 262.0], [520.0, 730.0]];
const WIDTH: f64 = 790.0;
const TOP: f64 = 82.0;
const ROW: f64 = 30.0;
const BAR: f64 = 12.0;

/// A row of a panel: its name as drawn and in words, and the values of the plan and of the paper's eight, % of the
/// tolerance.
struct Row {
    drawn: Markup,
    name: String,
    plan: f64,
    paper: Option<f64>,
}

/// Draws a plan for `site`, in black and white.
pub(crate) fn plan(plan: &Plan, site: &str) -> String {
    let uncertainties = Parameter::AS_IN_THE_PAPER.map(|parameter| {
        let (name, place) = (parameter.symbol(), parameter.place());
        let share = |of: &Evaluation| 100.0 * of.standard_uncertainty[place] / plan.tolerance[place];
        let (drawn, paper) = (symbol(name), plan.paper.as_ref().map(share));
        Row { drawn, name: plain_symbol(name), plan: share(&plan.evaluation), paper }
    });
    let errors = plan.evaluation.effects.iter().enumerate().map(|(place, effect)| {
        let percent = |effect: &Effect| 100.0 * effect.largest_over_tolerance;
        let (name, paper) = (name_of(effect), plan.paper.as_ref().map(|paper| percent(&paper.effects[place])));
        Row { drawn: symbols(&name), name, plan: percent(effect), paper }
    });
    let errors: Vec<Row> = errors.collect();
    let rows = uncertainties.len().max(errors.len());
    let readings: u32 = plan.readings.iter().map(|visited| visited.visits).sum();
    let title = format!("Plan for {site}: {readings} readings in {} positions", plan.readings.len());
    let drawing = [
        words([14.0, 18.0], Anchor::Start, "title", &title),
        key(plan),
        words([14.0, TOP - 12.0], Anchor::Start, "title", "Standard uncertainty, % of the tolerance"),
        words([400.0, TOP - 12.0], Anchor::Start, "title", "Largest change by a common error, % of the tolerance"),
        panel(&uncertainties, BARS[0]),
        panel(&errors, BARS[1]),
    ];
    let size = [WIDTH, TOP + ROW * rows as f64 + 10.0];
    file("plan", size, &title, &in_words(&uncertainties, &errors), &drawing)
}

fn name_of(effect: &Effect) -> String {
    let CommonError { name, size, cause } = effect.error;
    let unit = match cause.unit() {
        "arcsec" => "″".to_owned(),
        unit => format!("\u{a0}{unit}"),
    };
    format!("{name} {size}{unit}")
}

fn key(plan: &Plan) -> Markup {
    let sample = |class: &str| rectangle([2.0, 3.0], [28.0, 13.0], class, None);
    let axis = format!("plan, frame’s axis at {}°", plan.frame_axis_azimuth_deg);
    let mut entries = vec![(sample("bar"), axis.as_str())];
    if plan.paper.is_some() {
        entries.push((sample("bar open"), "paper’s eight positions, axis at 90°"));
    }
    caption([14.0, 40.0], "", &entries)
}

fn panel(rows: &[Row], [left, right]: Point) -> Markup {
    let longest = rows.iter().flat_map(|row| [row.plan, row.paper.unwrap_or(0.0)]).fold(0.0, f64::max);
    // Without any length any scale will do.
    let scale = Scale { values: [0.0, if longest > 0.0 { longest } else { 1.0 }], places: [left, right] };
    let bar = |value: f64, top: f64, class: &str| {
        // A bar of no visible length has no outline either.
        let width = scale.place(value) - left;
        html! {
            @if width >= 0.3 { (rectangle([left, top], [left + width, top + BAR - 1.0], class, None)) }
            (number([left + width + 5.0, top + BAR - 2.0], Anchor::Start, "small", value, &percent(value)))
        }
    };
    html! {
        @for (place, row) in rows.iter().enumerate() {
            @let top = TOP + ROW * place as f64;
            (label([left - 7.0, top + BAR + 3.0], Anchor::End, "", &row.drawn))
            @if let Some(paper) = row.paper {
                (bar(row.plan, top, "bar"))
                (bar(paper, top + BAR, "bar open"))
            } @else {
                (bar(row.plan, top + 0.5 * BAR, "bar"))
            }
        }
    }
}

/// Formats a percentage, as 0 where only rounding is left.
fn percent(value: f64) -> String {
    if value < 1e-6 { "0".to_owned() } else { Number::whole_or_two_digits(value).text(Language::English) }
}

fn in_words(uncertainties: &[Row], errors: &[Row]) -> String {
    let listed = |rows: &[Row]| {
        let each = rows.iter().map(|Row { name, plan, paper, .. }| {
            let paper = paper.map_or_else(String::new, |paper| format!(" (paper’s eight: {} %)", percent(paper)));
            format!("{name} {} %{paper}", percent(*plan))
        });
        each.collect::<Vec<_>>().join("; ")
    };
    format!(
        "Standard uncertainty in % of the tolerance: {}. Largest change of a parameter in % of its tolerance: {}.",
        listed(uncertainties),
        listed(errors)
    )
}
