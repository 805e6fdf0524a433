//! Where the uncertainty comes from, and whether first order is valid; only when asked for.

use super::CalibrationPage;
use super::parameters::COLUMNS;
use crate::calibration::causes::Cause;
use crate::calibration::parameter::Parameter;
use crate::report::page::language::{Language, Languages, Text};
use crate::report::page::number::Number;
use crate::report::page::parts::section as part;
use crate::report::page::passport::numbers::parameters;
use crate::report::page::texts::{calibration as texts, units, words};
use crate::uncertainty::budget::{Contribution, ParameterBudget};
use crate::uncertainty::monte_carlo::Distribution;
use crate::uncertainty::{Budget, MonteCarlo};
use maud::{Markup, html};

/// More effective degrees of freedom than this are as good as infinitely many.
const MANY: f64 = 1e4;

/// A share of a variance that rounding alone leaves.
const LEAST_SHARE: f64 = 1e-20;

pub fn sections(page: &CalibrationPage, languages: &Languages) -> Markup {
    html! {
        @if let Some((budget, sentence)) = &page.budget {
            (part(languages, "budget", "6", texts::BUDGET, &budget_table(budget, *sentence, languages)))
        }
        @if let Some(found) = page.monte_carlo {
            (part(languages, "monte-carlo", "7", texts::MONTE_CARLO, &monte_carlo(found, languages)))
        }
    }
}

/// All parameters in one table: a row for each kind of input, the largest first, and what they add up to.
fn budget_table(budget: &Budget, sentence: Option<&str>, languages: &Languages) -> Markup {
    let line = |parameter: Parameter| budget.parameters.iter().find(|line| line.parameter == parameter);
    let each = |cell: &dyn Fn(&ParameterBudget) -> Markup| {
        COLUMNS.map(|parameter| line(parameter).map(cell).unwrap_or_default())
    };
    let mut rows: Vec<(Markup, [Markup; 8])> = kinds(budget)
        .into_iter()
        .map(|kind| {
            let contribution = |line: &ParameterBudget| {
                let part = line.contributions.iter().find(|part| part.cause.kind() == kind.cause.kind());
                part.filter(|part| part.share > LEAST_SHARE)
                    .map_or_else(|| html! { "–" }, |part| Number::scientific(part.contribution, 2).markup(languages))
            };
            (input(kind, languages), each(&contribution))
        })
        .collect();
    rows.push((
        html! { strong { (languages.label(texts::COMBINED)) } },
        each(&|line| html! { strong { (Number::uncertainty(line.standard_uncertainty).markup(languages)) } }),
    ));
    rows.push((
        languages.label(texts::EFFECTIVE_FREEDOM),
        each(&|line| match line.effective_degrees_of_freedom {
            known if known > MANY => html! { "∞" },
            known => Number::significant(known, 2).markup(languages),
        }),
    ));
    rows.push((
        languages.label(texts::EXPANDED),
        each(&|line| Number::uncertainty(line.expanded_uncertainty()).markup(languages)),
    ));
    let caption = Some(languages.label(texts::BUDGET_CAPTION));
    let table = parameters(languages, caption, rows).markup(languages.spoken(texts::BUDGET_CAPTION));
    let english = languages.iter().any(|language| language == Language::English);
    html! {
        @if let Some(sentence) = sentence.filter(|_| english) { p lang="en" { (sentence) "." } }
        (table)
    }
}

/// A line for each kind of input that any parameter feels, the largest share of any variance first.
fn kinds(budget: &Budget) -> Vec<&Contribution> {
    let mut kinds: Vec<&Contribution> = Vec::new();
    for part in budget.parameters.iter().flat_map(|line| &line.contributions) {
        match kinds.iter_mut().find(|known| known.cause.kind() == part.cause.kind()) {
            Some(known) if part.share > known.share => *known = part,
            Some(_) => {}
            None => kinds.push(part),
        }
    }
    kinds.sort_by(|one, other| other.share.total_cmp(&one.share));
    kinds
}

/// A kind of input and its uncertainty; of several inputs the largest.
fn input(part: &Contribution, languages: &Languages) -> Markup {
    // Marks of angles stand close to their number.
    let (unit, blank) = match part.cause.unit() {
        "%" => (units::PERCENT, "\u{a0}"),
        "mA" => (units::MILLIAMPERES, "\u{a0}"),
        _ => (units::ARCSEC, ""),
    };
    let u = Number::scientific(part.cause.shown(part.standard_uncertainty[1]), 2).text(languages.first());
    languages.label_with(|language| {
        let name = cause(part.cause, language);
        texts::INPUT.filled(language, &[("input", &name), ("u", &format!("{u}{blank}{}", unit.of(language)))])
    })
}

fn cause(cause: Cause, language: Language) -> String {
    let about = |text: Text, axis: &str| text.filled(language, &[("axis", axis)]);
    let case = |axis: usize| ["x", "y", "z"].get(axis).copied().unwrap_or_default();
    // The base's axes by the paper's letters: ξ east, η north, ζ up.
    let base = |axis: usize| ["ξ", "η", "ζ"].get(axis).copied().unwrap_or_default();
    let plain = |text: Text| text.of(language).to_owned();
    match cause {
        Cause::Angle(..) => plain(texts::CAUSE_ANGLE),
        Cause::Return(..) => plain(texts::CAUSE_RETURN),
        Cause::Reading(..) => plain(texts::CAUSE_READING),
        Cause::Floor(..) => plain(texts::CAUSE_FLOOR),
        Cause::Platform(axis) => about(texts::CAUSE_PLATFORM, case(axis)),
        Cause::Seat(axis) => about(texts::CAUSE_SEAT, case(axis)),
        Cause::Base(axis) => about(texts::CAUSE_BASE, base(axis)),
        Cause::Level(axis) => about(texts::CAUSE_LEVEL, base(axis)),
        Cause::Azimuth => plain(texts::CAUSE_AZIMUTH),
        Cause::Mark => plain(texts::CAUSE_MARK),
        Cause::Latitude => plain(texts::CAUSE_LATITUDE),
        Cause::Deflection => plain(texts::CAUSE_DEFLECTION),
        Cause::Gain => plain(texts::CAUSE_GAIN),
        Cause::Offset => plain(texts::CAUSE_OFFSET),
    }
}

fn monte_carlo(found: &MonteCarlo, languages: &Languages) -> Markup {
    let line = |parameter: Parameter| found.parameters.iter().find(|line| line.parameter == parameter);
    let each =
        |cell: &dyn Fn(&Distribution) -> Markup| COLUMNS.map(|parameter| line(parameter).map(cell).unwrap_or_default());
    let measured =
        |value: f64, line: &Distribution| Number::measured(value, line.standard_uncertainty).markup(languages);
    let rows = vec![
        (languages.label(texts::MEAN), each(&|line| measured(line.mean, line))),
        (
            languages.label(texts::COMBINED),
            each(&|line| Number::uncertainty(line.standard_uncertainty).markup(languages)),
        ),
        (languages.label(texts::LOWER), each(&|line| measured(line.symmetric[0], line))),
        (languages.label(texts::UPPER), each(&|line| measured(line.symmetric[1], line))),
        (
            languages.label(texts::FIRST_ORDER),
            each(&|line| match line.first_order.valid {
                Some(true) => languages.label(words::YES),
                Some(false) => languages.label(words::NO),
                // Too few trials to tell.
                None => html! { "–" },
            }),
        ),
    ];
    let (trials, seed) = (found.trials.to_string(), found.seed.to_string());
    let values = [("trials", trials.as_str()), ("seed", &seed)];
    let caption = Some(languages.label_with(|language| texts::MONTE_CARLO_CAPTION.filled(language, &values)));
    html! {
        (parameters(languages, caption, rows).markup(languages.spoken(texts::MONTE_CARLO)))
        @if !found.stable { (languages.paragraph(texts::NOT_STABLE)) }
    }
}
