//! Convergence of the iterative method: the change in each step, relative to the stop limit.

use super::drawing::{Anchor, Field, Look, Panel, Point, Scale, Ticks, label, legend, line, power, sample};
use crate::calibration::document::ResultDocument;
use crate::calibration::iterative::{StepChange, StopRule};
use crate::report::page::Number;
use crate::report::page::language::{Language, Languages};
use crate::wording::texts::pictures as texts;
use maud::{Markup, html};

const PANEL_PIXELS: u32 = 240;
const SIZE: Point = [300.0, 142.0];
/// Plot area: left and upper, right and lower end.
const FIELD: [Point; 2] = [[40.0, 22.0], [290.0, 102.0]];

/// Largest number of decades of the axis below the limit. Smaller values, and zero, are drawn at its end.
const MOST_DECADES: i32 = 12;

/// A function that returns the change in a step as a share of its limit.
type Share = fn(&StepChange, &StopRule) -> f64;

/// The series: appearance, and values.
const SERIES: [(Look, Share); 2] = [
    ((1, "series"), |change, rule| change.main_scale_factors_percent / rule.delta1_percent),
    ((2, "series"), |change, rule| change.g_drifts_deg_per_h_per_g / rule.delta2_deg_per_h),
];

/// Draws the steps of a result by the iterative method. Returns `None` for other methods, and if a limit is 0, because
/// the axis is logarithmic.
pub(crate) fn convergence(languages: &Languages, result: &ResultDocument) -> Option<Markup> {
    let (changes, rule) = result.changes.as_deref().zip(result.stop_rule)?;
    if changes.is_empty() || rule.delta1_percent <= 0.0 || rule.delta2_deg_per_h <= 0.0 {
        return None;
    }
    let field = field(changes, &rule);
    let panel = Panel { name: "convergence", languages, size: SIZE };
    let limit = field.y.place(0.0);
    let [[left, _], [right, _]] = FIELD;
    let mut drawing = vec![axes(languages, &field), line([left, limit], [right, limit], "limit")];
    drawing.extend(SERIES.map(|(look, share)| {
        let point = |change: &StepChange| [f64::from(change.step), power_of(share(change, &rule))];
        field.series(&changes.iter().map(point).collect::<Vec<_>>(), look)
    }));
    let description = |language| in_words(language, changes, &rule);
    Some(panel.alone(PANEL_PIXELS, texts::CONVERGENCE_TITLE, description, &drawing, &key(languages)))
}

fn key(languages: &Languages) -> Markup {
    let [k, g] = SERIES;
    let entries = [
        (sample(k.0), texts::CONVERGENCE_K),
        (sample(g.0), texts::CONVERGENCE_G),
        (line([2.0, 7.0], [26.0, 7.0], "limit"), texts::CONVERGENCE_LIMIT),
    ];
    legend(languages, &entries)
}

/// Returns the plot area: steps to the right, the power of ten of change over limit upwards.
fn field(changes: &[StepChange], rule: &StopRule) -> Field {
    let powers = SERIES.iter().flat_map(|(_, share)| changes.iter().map(|change| power_of(share(change, rule))));
    let finite = powers.filter(|power| power.is_finite());
    let (low, high) = finite.fold((-1.0, 1.0), |(low, high), power| (f64::min(low, power), f64::max(high, power)));
    let low = libm::floor(low).max(-f64::from(MOST_DECADES));
    let mut high = libm::ceil(high);
    // The limit, 1, has a number.
    while !(high as usize).is_multiple_of(every(low as i32, high as i32)) {
        high += 1.0;
    }
    let steps = || changes.iter().map(|change| f64::from(change.step));
    let (first, last) = (steps().fold(2.0, f64::min), steps().fold(2.0, f64::max));
    let [[left, top], [right, bottom]] = FIELD;
    Field {
        x: Scale { values: [first - 0.5, last + 0.5], places: [left, right] },
        y: Scale { values: [low, high], places: [bottom, top] },
    }
}

/// Returns every how many decades have a number.
fn every(low: i32, high: i32) -> usize {
    usize::try_from((high - low) / 6 + 1).unwrap_or(1)
}

/// Returns the decimal logarithm of a share; that of 0 is drawn at the lower end of the axis, like other values too
/// small for it.
fn power_of(share: f64) -> f64 {
    libm::log10(share).max(f64::NEG_INFINITY)
}

fn axes(languages: &Languages, field: &Field) -> Markup {
    let language = languages.first();
    let steps = Ticks::along(&field.x, language).values.into_iter().filter(|step| libm::floor(*step) == *step);
    let steps: Vec<_> = steps.map(|step| (step, Number::fixed(step, 0).text(language))).collect();
    let [low, high] = field.y.values.map(|value| value as i32);
    let decades = (low..=high).rev().step_by(every(low, high));
    let decades: Vec<_> = decades.map(|exponent| (f64::from(exponent), decade(exponent, language))).collect();
    let [[_, top], [right, bottom]] = FIELD;
    html! {
        (field.axes(&steps, &decades))
        (label([2.0, top - 10.0], Anchor::Start, "small", &html! { (languages.plain(texts::CONVERGENCE_SHARE)) }))
        (label([right, bottom + 32.0], Anchor::End, "small", &html! { (languages.plain(texts::CONVERGENCE_STEP)) }))
    }
}

fn decade(exponent: i32, language: Language) -> String {
    match exponent {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        _ => power(exponent, language),
    }
}

fn in_words(language: Language, changes: &[StepChange], rule: &StopRule) -> String {
    let each = changes.iter().map(|change| {
        let [k, g] = [change.main_scale_factors_percent, change.g_drifts_deg_per_h_per_g]
            .map(|value| Number::scientific(value, 2));
        texts::convergence_in_words(change.step, k, g).plain(language)
    });
    let list = each.collect::<Vec<_>>().join("; ");
    let [k, g] = [rule.delta1_percent, rule.delta2_deg_per_h].map(Number::exact);
    texts::convergence_description(k, g, list).plain(language)
}
