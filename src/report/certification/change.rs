//! Change of a stand since its last certificate.

use super::outcome_of;
use crate::certification::found::together;
use crate::certification::kind::{AXES, OUTLIER};
use crate::certification::{ComparedPosition, Comparison, Test};
use crate::passport::difference::NumberDifference;
use crate::report::doc::{Block, Rows, Words, fields, heading, in_unit, listed, marked, probability, say, symbol};
use crate::report::picture::strips::Residuals;
use crate::wording::number::Probability;
use crate::wording::texts::{calibration, certification as texts, checks, pictures, units};
use crate::wording::{Number, Outcome, Text};
use maud::html;

/// Returns the result in a word.
pub(crate) fn word(outcome: Outcome) -> Text {
    texts::repeats!(Outcome, outcome)
}

/// The rotations of a check relative to the certificate, and how they decide.
pub(crate) fn rotations(found: &Comparison) -> Vec<Block> {
    let outcome = |at: &ComparedPosition| outcome_of(found, at.repeats);
    let mut rows = Rows::of(&found.positions, "numbers rotations")
        .named(texts::POSITION, |at| vec![Words::OnTelephones(outcome(at)), at.index.into()]);
    for (axis, name) in AXES.into_iter().enumerate() {
        let u = Words::All(vec![symbol("u"), "(".into(), symbol(name), ")".into()]);
        rows = rows
            .column(in_unit(symbol(name), units::ARCSEC), |at| {
                Number::measured(at.turn_arcsec[axis], at.u_arcsec[axis])
            })
            .column(in_unit(u, units::ARCSEC), |at| Number::uncertainty(at.u_arcsec[axis]));
    }
    let table = rows
        .column(symbol("p"), |at| probability(at.test.probability))
        .column(checks::RESULT, |at| marked(outcome(at), word(outcome(at))));
    let common = &found.common;
    let named = [
        (texts::ALL_TOGETHER, test(&found.all)),
        (texts::COMMON_TURN, common.test.as_ref().map_or_else(|| texts::NOT_MADE.into(), test)),
        (texts::PLATFORM_TURN, listed(together(common.platform_arcsec))),
        (texts::BASE_TURN, listed(together(common.base_arcsec))),
    ];
    vec![
        heading(texts::ROTATIONS),
        table.called(texts::ROTATIONS),
        say([texts::decision(Number::exact(OUTLIER))]),
        fields(named.map(|(name, value)| (name, value, false))),
    ]
}

/// F with its degrees of freedom and its probability.
fn test(test: &Test) -> Words {
    let of_u = if test.of_u.is_finite() { Number::at_most(test.of_u, 1).into() } else { "∞".into() };
    let f = Number::chi_square(test.f()).into();
    let p = Probability(test.probability).into();
    vec![f, " (".into(), test.degrees_of_freedom.into(), "; ".into(), of_u, "), ".into(), p].into()
}

/// The deviations of the certificate `number` and of its successor, and their change as a number and as a bar.
pub(crate) fn deviations(number: &str, changes: &[NumberDifference]) -> [Block; 2] {
    let printed = |at: &NumberDifference, value: Option<f64>| {
        value.map(|value| Number::measured(value, at.standard_uncertainty.unwrap_or(0.0)))
    };
    let change = |at: &NumberDifference| Some((at.difference()?, at.standard_uncertainty));
    let bars = Residuals::over(changes.iter().filter_map(change));
    let bar = |at: &NumberDifference| change(at).map_or_else(|| html! { "–" }, |change| bars.bar(change));
    let rows = Rows::of(changes, "numbers residuals changes")
        .named(texts::POSITION, |at| format!("({})", of_key(&at.key).0.replace(',', ", ")))
        .named(texts::ANGLE, |at| symbol(of_key(&at.key).1))
        .column(texts::in_arcsec(texts::OLD), |at| printed(at, at.a))
        .column(texts::in_arcsec(texts::NEW), |at| printed(at, at.b))
        .column(texts::in_arcsec(calibration::CHANGED_BY), |at| printed(at, at.difference()))
        .column(in_unit(symbol("u"), units::ARCSEC), |at| at.standard_uncertainty.map(Number::uncertainty))
        .column(texts::DIFFERENCE_IN_U, |at| at.ratio().map(|ratio| Number::fixed(ratio, 1)))
        .strips(texts::within(calibration::CHANGED_BY), bar, bars.axis(None))
        .grouped_by(|at| of_key(&at.key).0.to_owned());
    let key = Residuals::key(pictures::CHANGE_BAR, pictures::CHANGE_LIMITS);
    [rows.captioned(texts::CHANGE, texts::change_caption(number)), Block::Key(key)]
}

/// Returns the indices and the letter of a deviation from its key, `positions[1,2].alpha_arcsec`.
fn of_key(key: &str) -> (&str, &'static str) {
    let (index, angle) = key.trim_start_matches("positions[").split_once("].").unwrap_or_default();
    let letter = match angle {
        "alpha_arcsec" => "α",
        "beta_arcsec" => "β",
        _ => "γ",
    };
    (index, letter)
}
