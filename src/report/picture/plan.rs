//! A plan next to the paper's eight positions as a picture file: the uncertainty of each parameter, and what errors
//! cost that all positions share.

use super::drawing::{Anchor, Point, Scale, label, number, plain_symbol, rectangle, symbol, symbols, words};
use super::file::{caption, file};
use crate::calibration::Parameter;
use crate::plan::{Evaluation, Plan};
use crate::report::plan::{percent, percent_of_tolerance};
use crate::units::quantity;
use crate::wording::{Language, Number, plain};
use maud::{Markup, html};

/// Left and right end of the bars of both panels. Names are to their left, numbers to their right.
const BARS: [Point; 2] = [[52.0, 262.0], [520.0, 730.0]];
const WIDTH: f64 = 790.0;
const TOP: f64 = 82.0;
const ROW: f64 = 30.0;
const BAR: f64 = 12.0;

/// A panel: its rows, and how the terminal's table prints their shares.
struct Panel {
    rows: Vec<Row>,
    printed: fn(f64) -> String,
}

/// A row of a panel: its name as drawn and in words, and the values of the plan and of the paper's eight as shares of
/// the tolerance.
struct Row {
    drawn: Markup,
    name: String,
    plan: f64,
    paper: Option<f64>,
}

fn in_english(number: &Number) -> String {
    plain(&number.text(Language::English))
}

/// Draws a plan for `site`, in black and white.
pub(crate) fn plan(plan: &Plan, site: &str) -> String {
    let uncertainties = Parameter::AS_IN_THE_PAPER.map(|parameter| {
        let (name, place) = (parameter.symbol(), parameter.place());
        let share = |of: &Evaluation| of.standard_uncertainty[place] / plan.tolerance[place];
        let (drawn, paper) = (symbol(name), plan.paper.as_ref().map(share));
        Row { drawn, name: plain_symbol(name), plan: share(&plan.evaluation), paper }
    });
    let errors = plan.evaluation.effects.iter().enumerate().map(|(place, effect)| {
        let paper = plan.paper.as_ref().map(|paper| paper.effects[place].largest_over_tolerance);
        let error = effect.error;
        let size = quantity(&error.size.to_string(), error.cause.unit());
        let name = format!("{} {}", error.name, size.replace(' ', "\u{a0}"));
        Row { drawn: symbols(&name), name, plan: effect.largest_over_tolerance, paper }
    });
    let panels = [
        Panel { rows: uncertainties.into(), printed: |share| in_english(&percent_of_tolerance(share)) },
        Panel { rows: errors.collect(), printed: |share| in_english(&percent(share)) },
    ];
    let rows = panels.iter().map(|panel| panel.rows.len()).max().unwrap_or(0);
    // One scale, so that bars of both panels can be compared.
    let shares = panels.iter().flat_map(|panel| &panel.rows).flat_map(|row| [row.plan, row.paper.unwrap_or(0.0)]);
    let longest = shares.fold(0.0, f64::max);
    let readings: u32 = plan.readings.iter().map(|visited| visited.visits).sum();
    let title = format!("Plan for {site}: {readings} readings in {} positions", plan.readings.len());
    let drawing = [
        words([14.0, 18.0], Anchor::Start, "title", &title),
        key(plan),
        words([14.0, TOP - 12.0], Anchor::Start, "title", "Standard uncertainty, % of the tolerance"),
        words([400.0, TOP - 12.0], Anchor::Start, "title", "Largest change by a common error, % of the tolerance"),
        panel(&panels[0], longest, BARS[0]),
        panel(&panels[1], longest, BARS[1]),
    ];
    let size = [WIDTH, TOP + ROW * rows as f64 + 10.0];
    file("plan", size, &title, &in_words(&panels), &drawing)
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

fn panel(panel: &Panel, longest: f64, [left, right]: Point) -> Markup {
    // Without any length any scale will do.
    let scale = Scale { values: [0.0, if longest > 0.0 { longest } else { 1.0 }], places: [left, right] };
    let bar = |share: f64, top: f64, class: &str| {
        // A bar of no visible length has no outline either.
        let width = scale.place(share) - left;
        let (percent, printed) = (100.0 * share, (panel.printed)(share));
        html! {
            @if width >= 0.3 { (rectangle([left, top], [left + width, top + BAR - 1.0], class, None)) }
            (number([left + width + 5.0, top + BAR - 2.0], Anchor::Start, "small", percent, &printed))
        }
    };
    html! {
        @for (place, row) in panel.rows.iter().enumerate() {
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

fn in_words(panels: &[Panel; 2]) -> String {
    let [uncertainties, errors] = panels.each_ref().map(|Panel { rows, printed }| {
        let each = rows.iter().map(|Row { name, plan, paper, .. }| {
            let paper = paper.map_or_else(String::new, |paper| format!(" (paper’s eight: {} %)", printed(paper)));
            format!("{name} {} %{paper}", printed(*plan))
        });
        each.collect::<Vec<_>>().join("; ")
    });
    format!(
        "Standard uncertainty in % of the tolerance: {uncertainties}. Largest change of a parameter in % of its tolerance: \
         {errors}."
    )
}
