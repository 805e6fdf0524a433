//! Uncertainty budget and Monte Carlo with the test of linear propagation. Both appear only on request.

use super::CalibrationPage;
use super::parameters::name_of;
use crate::calibration::causes::Cause;
use crate::calibration::parameter::Parameter;
use crate::calibration::verdict::ParameterVerdict;
use crate::report::page::language::{Language, Languages, Text, capital, values};
use crate::report::page::number::{Cell, Number, column};
use crate::report::page::parts::{Column, Table, mark, marked, symbol, symbol_and_unit};
use crate::report::page::passport::numbers::parameters;
use crate::report::page::spacing::BLANK;
use crate::report::page::symbols::italic;
use crate::report::page::texts::{calibration as texts, units, words};
use crate::report::picture::accuracy::unit as parameter_unit;
use crate::report::picture::drawing::legend_with;
use crate::report::picture::shares as strips;
use crate::report::picture::tolerances::unit_at_type;
use crate::report::style::Outcome;
use crate::report::uncertainty::MANY;
use crate::uncertainty::budget::{Contribution, ParameterBudget};
use crate::uncertainty::dominant::{Dominant, Effect, Part, percent};
use crate::uncertainty::monte_carlo::Distribution;
use crate::uncertainty::{Budget, MonteCarlo};
use maud::{Markup, html};

/// Least share of a variance with which a kind of input has a part of the strips, and a row of the table.
const LEAST_NAMED: f64 = 0.02;
const LEAST_SHOWN: f64 = 1e-3;

pub(super) fn budget(page: &CalibrationPage, budget: &Budget, languages: &Languages) -> Markup {
    let tolerance = page.gyro.map(|gyro| &gyro.tolerance);
    let worst = match page.judged() {
        None => texts::BUDGET_WORST_OF_SIZE,
        Some((_, verdict)) if verdict.parameters.iter().any(ParameterVerdict::is_mostly_from_gravity) => {
            texts::BUDGET_WORST_BUT_GRAVITY
        }
        Some(_) => texts::BUDGET_WORST,
    };
    html! {
        @if let Some(remedy) = Dominant::of(budget, tolerance) { (sentences(&remedy, worst, languages)) }
        (shares(page, budget, languages))
        (budget_table(page, budget, languages))
    }
}

/// Writes the dominant contribution to the budget and the effect of reducing it.
fn sentences(remedy: &Dominant, worst: Text, languages: &Languages) -> Markup {
    let (line, first) = (remedy.worst, remedy.first);
    let share = match remedy.part() {
        Part::NearlyAll => texts::BUDGET_NEARLY_ALL,
        Part::Most => texts::BUDGET_MOST,
        Part::Largest => texts::BUDGET_LARGEST,
    };
    let amount = |u: f64, language: Language| {
        let (u, unit) = match percent(line, u) {
            Some(percent) => (percent, units::PERCENT),
            None => (u, parameter_unit(line.parameter)),
        };
        format!("{}{BLANK}{}", Number::scientific(u, 2).text(language), unit.of(language))
    };
    languages.paragraph_with(|language| {
        let percent = Number::fixed(100.0 * first.share, 0);
        let effect = match remedy.effect {
            Effect::HalvesAt(limit) => {
                texts::BUDGET_HALVES.filled(language, values! { limit: of_input(first.cause, limit, language) })
            }
            Effect::Leaves(rest) => texts::BUDGET_LEAVES.filled(language, values! { rest: amount(rest, language) }),
        };
        let u = html! { (amount(line.standard_uncertainty, language)) };
        let known = [("parameter", name_of(line.parameter.symbol())), ("u", u)];
        html! {
            (worst.marked_up(language, &known)) " "
            (italic(&share.filled(language, values! { share: percent, source: first.cause.kind_in(language) }))) " "
            (italic(&effect))
        }
    })
}

/// Writes which kinds of input each variance comes from; where a type is given, at its g, to which the decision refers.
fn shares(page: &CalibrationPage, budget: &Budget, languages: &Languages) -> Markup {
    let lines = Parameter::AS_IN_THE_PAPER.into_iter().filter_map(|parameter| line_of(budget, parameter));
    let lines: Vec<&ParameterBudget> = lines.collect();
    let converted = |line: &ParameterBudget| {
        let row = page.judged().and_then(|(_, verdict)| verdict.parameter(line.parameter));
        row.filter(|row| row.share_of_gravity() > 0.0)
    };
    let at_type = lines.iter().any(|line| converted(line).is_some());
    let kinds = kinds(budget);
    let of_gravity = |line: &ParameterBudget| converted(line).map_or(0.0, ParameterVerdict::share_of_gravity);
    let share = |line: &ParameterBudget, kind: &Contribution| {
        let part = line.contributions.iter().find(|part| part.cause.kind() == kind.cause.kind());
        part.map_or(0.0, |part| (1.0 - of_gravity(line)) * part.share)
    };
    let largest = |kind: &Contribution| lines.iter().map(|line| share(line, kind)).fold(0.0, f64::max);
    let mut named: Vec<&Contribution> = kinds.iter().copied().filter(|kind| largest(kind) >= LEAST_NAMED).collect();
    named.sort_by(|one, other| largest(other).total_cmp(&largest(one)));
    named.truncate(strips::LETTERS.len() - usize::from(at_type));
    let parts = |line: &ParameterBudget| {
        let inputs = named.iter().map(|kind| share(line, kind));
        at_type.then(|| of_gravity(line)).into_iter().chain(inputs).collect::<Vec<f64>>()
    };
    let us = lines.iter().map(|line| converted(line).map_or(line.standard_uncertainty, |row| row.standard_uncertainty));
    let drawn = lines.iter().map(|line| strips::shares(&parts(line)));
    let drawn = Column::named(languages, texts::SHARES, drawn.collect());
    let columns = [
        Column::new(symbol("u", ""), column(languages, us.map(Number::uncertainty))),
        Column { foot: strips::axis(languages), ..drawn },
    ];
    let name = |line: &&ParameterBudget| {
        let unit = if at_type { unit_at_type(line.parameter) } else { parameter_unit(line.parameter) };
        vec![symbol_and_unit(languages, &name_of(line.parameter.symbol()), unit)]
    };
    let names = lines.iter().map(name).collect();
    let table = Table::of(vec![languages.label(texts::PARAMETER)], names, &columns);
    let table = Table { class: "numbers shares", ..table };
    let names = named.iter().map(|kind| languages.label_with(|language| kind.cause.kind_in(language)));
    let names: Vec<Markup> =
        at_type.then(|| languages.label(texts::SHARE_OF_GRAVITY)).into_iter().chain(names).collect();
    let samples: Vec<Markup> = (0..names.len()).map(|place| strips::sample(Some(place))).collect();
    let rest = (kinds.len() > named.len()).then(|| (strips::sample(None), languages.label(texts::OTHER_INPUTS)));
    let caption = if at_type { texts::SHARES_CAPTION_AT_TYPE } else { texts::SHARES_CAPTION };
    html! {
        (table.captioned(languages, caption))
        (legend_with(samples.iter().zip(names).chain(rest.iter().map(|(sample, name)| (sample, name.clone())))))
    }
}

fn line_of(budget: &Budget, parameter: Parameter) -> Option<&ParameterBudget> {
    budget.parameters.iter().find(|line| line.parameter == parameter)
}

/// Returns one table of all parameters: a row for each kind of input, the largest first, then the totals; after them
/// what the local g adds in the decision.
fn budget_table(page: &CalibrationPage, budget: &Budget, languages: &Languages) -> Markup {
    let each = |cell: &dyn Fn(&ParameterBudget) -> Cell| {
        Parameter::AS_IN_THE_PAPER.map(|parameter| line_of(budget, parameter).map_or_else(Cell::none, cell))
    };
    let (large, small): (Vec<_>, Vec<_>) = kinds(budget).into_iter().partition(|kind| kind.share >= LEAST_SHOWN);
    let mut rows: Vec<(Markup, [Cell; 8])> = large
        .into_iter()
        .map(|kind| {
            let contribution = |line: &ParameterBudget| {
                let part = line.contributions.iter().find(|part| part.cause.kind() == kind.cause.kind());
                // One digit more than u has, so that their squares add up to its square.
                let place = Number::place_of(line.standard_uncertainty) - 1;
                let number = part.map(|part| Number::to_place(part.contribution, place));
                number.filter(|number| !number.is_printed_as_zero()).into()
            };
            (input(kind, languages), each(&contribution))
        })
        .collect();
    rows.push((
        html! { strong { (languages.label(texts::COMBINED)) } },
        each(&|line| Cell::Number(Number::uncertainty(line.standard_uncertainty))),
    ));
    rows.push((
        languages.label(texts::EFFECTIVE_FREEDOM),
        each(&|line| match line.effective_degrees_of_freedom {
            known if known > MANY => Cell::Words(html! { "∞" }),
            // Aligned with contributions of many decimals, its column would be too wide.
            known if known >= 1000.0 => Cell::Words(html! { "> 1000" }),
            // Rounding to tens would print a number that differs from the one in the result.
            known => Cell::Number(Number::whole_or_two_digits(known)),
        }),
    ));
    if let Some((_, verdict)) = page.judged()
        && verdict.parameters.iter().any(|row| row.u_from_gravity().is_some())
    {
        let each = |cell: &dyn Fn(&ParameterVerdict) -> Option<Number>| {
            each(&|line| verdict.parameter(line.parameter).and_then(cell).into())
        };
        let name = |language: Language| {
            let u = Number::uncertainty(page.document.gravity_u_m_per_s2.unwrap_or(0.0)).text(language);
            let u = format!("{u}{BLANK}{}", units::M_PER_S2.of(language));
            texts::INPUT.filled(language, values! { input: texts::BUDGET_GRAVITY.of(language), u })
        };
        let of_gravity = |row: &ParameterVerdict| {
            Some(Number::to_place(row.u_from_gravity()?, Number::place_of(row.standard_uncertainty) - 1))
        };
        rows.push((languages.label_with(name), each(&of_gravity)));
        rows.push((
            html! { strong { (languages.label(texts::COMBINED_AT_G0)) } },
            each(&|row| Some(Number::uncertainty(row.standard_uncertainty))),
        ));
    }
    html! {
        (parameters(languages, rows).captioned(languages, texts::BUDGET_CAPTION))
        (languages.paragraph_with(|language| {
            let means = page.document.scatter.map(|_| texts::BUDGET_MEANS.words(language));
            let names: Vec<String> = small.iter().map(|kind| kind.cause.kind_in(language)).collect();
            let not_shown = texts::BUDGET_NOT_SHOWN.filled(language, values! { names: names.join("; ") });
            let not_shown = (!small.is_empty()).then_some(not_shown);
            let said = std::iter::once(texts::BUDGET_DASH.words(language)).chain(means).chain(not_shown);
            italic(&said.collect::<Vec<_>>().join(" "))
        }))
    }
}

/// Returns one contribution for each kind of input, the largest of that kind, sorted by descending share of a variance.
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

/// Writes a kind of input and its uncertainty: the largest if there are several inputs.
fn input(part: &Contribution, languages: &Languages) -> Markup {
    languages.label_with(|language| {
        let name = capital(&part.cause.kind_in(language));
        // The number stands once.
        if language != languages.first() {
            return name;
        }
        let text = if part.has_several_sizes() { texts::INPUTS } else { texts::INPUT };
        let u = of_input(part.cause, part.cause.shown(part.standard_uncertainty[1]), language);
        text.filled(language, values! { input: name, u })
    })
}

/// Returns the uncertainty of an input with its unit.
fn of_input(cause: Cause, u: f64, language: Language) -> String {
    // No space before angle marks.
    let (unit, blank) = match cause.unit() {
        "%" => (units::PERCENT, "\u{a0}"),
        "mA" => (units::MILLIAMPERES, "\u{a0}"),
        "deg/h" => (units::DEG_PER_H, "\u{a0}"),
        "1" => return Number::scientific(u, 2).text(language),
        _ => (units::ARCSEC, ""),
    };
    format!("{}{blank}{}", Number::scientific(u, 2).text(language), unit.of(language))
}

pub(super) fn monte_carlo(found: &MonteCarlo, languages: &Languages) -> Markup {
    let line = |parameter: Parameter| found.parameters.iter().find(|line| line.parameter == parameter);
    let each = |cell: &dyn Fn(&Distribution) -> Cell| {
        Parameter::AS_IN_THE_PAPER.map(|parameter| line(parameter).map_or_else(Cell::none, cell))
    };
    let measured = |value: f64, line: &Distribution| Cell::Number(Number::measured(value, line.standard_uncertainty));
    let mut rows = vec![
        (languages.label(texts::MEAN), each(&|line| measured(line.mean, line))),
        (symbol("u", ""), each(&|line| Cell::Number(Number::uncertainty(line.standard_uncertainty)))),
        (languages.label(texts::LOWER), each(&|line| measured(line.symmetric[0], line))),
        (languages.label(texts::UPPER), each(&|line| measured(line.symmetric[1], line))),
    ];
    // Too few trials decide nothing.
    let decided = found.parameters.iter().filter(|line| line.first_order.valid.is_some()).count();
    if decided > 0 {
        let valid = each(&|line| match line.first_order.valid {
            Some(valid) => {
                Cell::Words(marked(Some(valid), &languages.label(if valid { words::YES } else { words::NO })))
            }
            None => Cell::Words(mark(Outcome::Undecided)),
        });
        rows.push((languages.label(texts::FIRST_ORDER), valid));
    }
    let caption = Some(languages.label_with(|language| {
        let trials = Number::fixed(found.trials as f64, 0);
        texts::MONTE_CARLO_CAPTION.filled(language, values! { trials, seed: found.seed })
    }));
    let table = Table { caption, ..parameters(languages, rows) };
    html! {
        (table.markup(languages.spoken(texts::MONTE_CARLO)))
        @if (1..found.parameters.len()).contains(&decided) { (languages.paragraph(texts::FIRST_ORDER_UNDECIDED)) }
        @if !found.stable { (languages.paragraph(texts::NOT_STABLE)) }
    }
}
