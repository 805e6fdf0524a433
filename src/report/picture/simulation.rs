//! The paper's Fig. 4 as a picture file: steps of the iterative method against the limit of the deviations.

use super::drawing::{Anchor, Field, Look, Point, Scale, Ticks, label, line, sample, symbols, words};
use super::file::{caption, file};
use crate::calibration::iterative::LARGEST_NUMBER_OF_STEPS;
use crate::report::simulation::not_converged;
use crate::simulation::{Convergence, ConvergenceRow};
use crate::wording::{Language, Number};
use maud::{Markup, html};

const SIZE: Point = [660.0, 492.0];
/// Left and right end of both plot areas; lower and upper end of each.
const ACROSS: Point = [46.0, 640.0];
const STEPS: Point = [290.0, 50.0];
const SHARE: Point = [452.0, 346.0];

/// Limit of applicability stated in the paper.
const PAPER_LIMIT_DEG: f64 = 15.0;

/// Numbers on the axis of steps.
const MARKED_STEPS: [u32; 8] = [1, 2, 5, 10, 20, 50, 100, 200];

const LOOKS: [Look; 3] = [(1, "series"), (2, "series dashed"), (3, "series dotted")];

/// A name, and the function that returns that number of a row.
type Steps = (&'static str, fn(&ConvergenceRow) -> Option<f64>);

const NUMBERS: [Steps; 3] = [
    ("most", |row| row.most.map(|most| most as f64)),
    ("95th percentile", |row| row.percentile_95.map(|steps| steps as f64)),
    ("mean of the converged", |row| row.mean),
];

/// Kinds of deviations, and their names.
const KINDS: [(&str, &str); 2] = [("uniform", "uniform within ±D"), ("corners", "every angle +D or −D")];

/// Draws Fig. 4 in black and white. Returns `None` if there is no row.
pub(crate) fn convergence(found: &Convergence) -> Option<String> {
    let farthest = found.rows.iter().map(|row| row.limit_deg).reduce(f64::max)?;
    let x = Scale { values: [0.0, farthest.max(1.0)], places: ACROSS };
    let trials = Number::exact(found.trials as f64).text(Language::English);
    let title = format!("Steps of the iterative method, {trials} stands at each limit D");
    let [left, right] = ACROSS;
    let drawing = [
        label([left, 18.0], Anchor::Start, "title", &symbols(&title)),
        html! { g { (steps(x, &found.rows)) } },
        html! { g { (share(x, &found.rows)) } },
        label([right, SHARE[0] + 32.0], Anchor::End, "small", &symbols("limit D of the deviations, degrees")),
    ];
    Some(file("steps", SIZE, &title, &in_words(&found.rows), &drawing))
}

fn steps(x: Scale, rows: &[ConvergenceRow]) -> Markup {
    let highest = libm::log10(1.1 * f64::from(LARGEST_NUMBER_OF_STEPS));
    let field = Field { x, y: Scale { values: [0.0, highest], places: STEPS } };
    let marks = MARKED_STEPS.map(|steps| (libm::log10(f64::from(steps)), steps.to_string()));
    let entries: Vec<_> = NUMBERS.into_iter().zip(LOOKS).map(|((name, _), look)| (sample(look), name)).collect();
    let points = |number: fn(&ConvergenceRow) -> Option<f64>| -> Vec<Point> {
        let rows = rows.iter().filter(|row| row.deviations == KINDS[0].0);
        rows.filter_map(|row| Some([row.limit_deg, libm::log10(number(row)?)])).collect()
    };
    html! {
        (caption([ACROSS[0], STEPS[1] - 10.0], &format!("steps, {}:", KINDS[0].1), &entries))
        (field.axes(&limits(&x), &marks))
        (paper_limit(&x))
        @for ((_, number), look) in NUMBERS.into_iter().zip(LOOKS) { (field.series(&points(number), look)) }
    }
}

fn share(x: Scale, rows: &[ConvergenceRow]) -> Markup {
    let most = rows.iter().map(|row| row.not_converged_percent).fold(1.0, f64::max);
    let field = Field { x, y: Scale { values: [0.0, 1.1 * most], places: SHARE } };
    let marks = Ticks::between(0.0, 1.1 * most, 5).marks(Language::English);
    let entries: Vec<_> = KINDS.into_iter().zip(LOOKS).map(|((_, name), look)| (sample(look), name)).collect();
    let points = |kind: &str| -> Vec<Point> {
        let rows = rows.iter().filter(|row| row.deviations == kind);
        rows.map(|row| [row.limit_deg, row.not_converged_percent]).collect()
    };
    let axis = format!("not converged in {LARGEST_NUMBER_OF_STEPS} steps, %:");
    html! {
        (caption([ACROSS[0], SHARE[1] - 10.0], &axis, &entries))
        (field.axes(&limits(&x), &marks))
        @for ((kind, _), look) in KINDS.into_iter().zip(LOOKS) { (field.series(&points(kind), look)) }
    }
}

fn limits(x: &Scale) -> Vec<(f64, String)> {
    Ticks::along(x, Language::English).marks(Language::English)
}

fn paper_limit(x: &Scale) -> Markup {
    const ROOM: f64 = 60.0;
    let ([_, farthest], [bottom, top], at) = (x.values, STEPS, x.place(PAPER_LIMIT_DEG));
    if farthest < PAPER_LIMIT_DEG {
        return html! {};
    }
    let (to_label, anchor) = if at + ROOM < ACROSS[1] { (5.0, Anchor::Start) } else { (-5.0, Anchor::End) };
    html! {
        (line([at, bottom], [at, top], "limit"))
        (words([at + to_label, bottom - 8.0], anchor, "small", &format!("paper: {PAPER_LIMIT_DEG}°")))
    }
}

fn in_words(rows: &[ConvergenceRow]) -> String {
    let row = |row: &ConvergenceRow| {
        let of = |(name, number): Steps| number(row).map(|steps| format!("{name} {steps:.1}, "));
        let numbers: String = NUMBERS.into_iter().filter_map(of).collect();
        format!("{}, {}°: {numbers}not converged, %: {}", row.deviations, row.limit_deg, not_converged(row))
    };
    rows.iter().map(row).collect::<Vec<_>>().join("; ") + "."
}
