//! Uncertainty budget and Monte Carlo with the test of linear propagation, both on request.

use crate::calibration::parameter::unit;
use crate::calibration::verdict::{ParameterVerdict, Verdict};
use crate::calibration::{CalibrationDocument, Parameter};
use crate::gyro::GyroType;
use crate::report::calibration::{parameters, unit_at_type};
use crate::report::doc::{self, Block, On, Rows, Words, either, heading, in_unit, joined, marked, say, symbol, told};
use crate::report::picture::strips::{self, Key};
use crate::uncertainty::dominant::{Dominant, of_input};
use crate::uncertainty::monte_carlo::Distribution;
use crate::uncertainty::{Budget, Contribution, MonteCarlo, ParameterBudget};
use crate::wording::texts::{calibration as texts, units, words};
use crate::wording::{Language, Number, Outcome};

/// Effective degrees of freedom above which ∞ is printed.
const MANY: f64 = 1e4;

/// Least share of a variance with which a kind of input has a part of the strips, and a row of the table.
const LEAST_NAMED: f64 = 0.02;
const LEAST_SHOWN: f64 = 1e-3;

/// A quantity of each of the eight parameters.
type Row = (Words, [Option<Words>; 8]);

/// Returns the requested parts as text.
pub(crate) fn text(
    budgeted: Option<&Budget>,
    trials: Option<&MonteCarlo>,
    (gyro, document): (Option<&GyroType>, &CalibrationDocument),
    language: Language,
) -> String {
    let mut out = String::new();
    let of_budget = budgeted.map(|found| (texts::BUDGET, budget(found, gyro, document)));
    for (name, blocks) in of_budget.into_iter().chain(trials.map(|found| (texts::MONTE_CARLO, monte_carlo(found)))) {
        doc::text(&mut out, &[vec![heading(name)], blocks].concat(), language);
    }
    out
}

/// The budget: what is most of it, the shares, the contributions.
pub(crate) fn budget(budget: &Budget, gyro: Option<&GyroType>, document: &CalibrationDocument) -> Vec<Block> {
    let verdict = gyro.and(document.verdict.as_ref());
    let worst = match verdict {
        None => texts::budget_worst_of_size,
        Some(verdict) if verdict.parameters.iter().any(ParameterVerdict::is_mostly_from_gravity) => {
            texts::budget_worst_but_gravity
        }
        Some(_) => texts::budget_worst,
    };
    let remedy = Dominant::of(budget, gyro.map(|gyro| &gyro.tolerance));
    let (large, small): (Vec<_>, Vec<_>) = kinds(budget).into_iter().partition(|kind| kind.share >= LEAST_SHOWN);
    let names = joined(small.iter().map(|kind| kind.cause.kind_words()), "; ");
    let notes = [
        Some(texts::BUDGET_DASH.into()),
        document.scatter.map(|_| texts::BUDGET_MEANS.into()),
        (!small.is_empty()).then(|| texts::budget_not_shown(names)),
    ];
    let mut doc = vec![say(remedy.iter().flat_map(|remedy| remedy.said(worst)))];
    doc.extend(shares(budget, verdict).map(|block| block.only(On::Page)));
    let u_of_gravity = document.gravity_u_m_per_s2.unwrap_or(0.0);
    doc.push(
        parameters(&rows(budget, large, verdict, u_of_gravity)).captioned(texts::BUDGET_CAPTION, texts::BUDGET_CAPTION),
    );
    doc.push(say(notes.into_iter().flatten().collect::<Vec<Words>>()));
    doc
}

/// Which kinds of input each variance comes from; where a type is given, at its g, to which the decision refers.
fn shares(budget: &Budget, verdict: Option<&Verdict>) -> [Block; 2] {
    let lines = Parameter::AS_IN_THE_PAPER.into_iter().filter_map(|parameter| line_of(budget, parameter));
    let lines: Vec<&ParameterBudget> = lines.collect();
    let converted = |line: &ParameterBudget| {
        let row = verdict.and_then(|verdict| verdict.parameter(line.parameter));
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
    let table = Rows::of(&lines, "numbers shares")
        .named(texts::PARAMETER, |line| {
            let unit = if at_type { unit_at_type(line.parameter) } else { unit(line.parameter) };
            in_unit(symbol(line.parameter.symbol()), unit)
        })
        .column(symbol("u"), |line| {
            Number::uncertainty(converted(line).map_or(line.standard_uncertainty, |row| row.standard_uncertainty))
        })
        .strips(texts::SHARES, |line| strips::shares(&parts(line)), strips::axis_of_shares());
    let mut names: Vec<Words> = at_type.then(|| texts::SHARE_OF_GRAVITY.into()).into_iter().collect();
    names.extend(named.iter().map(|kind| kind.cause.kind_words()));
    let letters = names.len();
    names.extend((kinds.len() > named.len()).then(|| Words::from(texts::OTHER_INPUTS)));
    let sample = |place| strips::sample_of_share(Some(place).filter(|place| *place < letters));
    let key: Key = names.into_iter().enumerate().map(|(place, name)| (sample(place), name)).collect();
    let caption = if at_type { texts::SHARES_CAPTION_AT_TYPE } else { texts::SHARES_CAPTION };
    [table.captioned(caption, caption), Block::Key(key)]
}

fn line_of(budget: &Budget, parameter: Parameter) -> Option<&ParameterBudget> {
    budget.parameters.iter().find(|line| line.parameter == parameter)
}

/// The rows of the table: one for each kind of input, the largest first, then the totals; after them what the local g adds
/// in the decision.
fn rows(budget: &Budget, kinds: Vec<&Contribution>, verdict: Option<&Verdict>, u_of_gravity: f64) -> Vec<Row> {
    let each = |cell: &dyn Fn(&ParameterBudget) -> Option<Words>| {
        Parameter::AS_IN_THE_PAPER.map(|parameter| line_of(budget, parameter).and_then(cell))
    };
    let strong = |name: crate::wording::Text| Words::Strong(Box::new(name.into()));
    // The number stands once.
    let input = |name: Words, relation: &str, u: Words| {
        let u = vec![": ".into(), symbol("u"), format!("\u{a0}{relation}\u{a0}").into(), u];
        Words::All(vec![name, Words::First(Box::new(told(u)))])
    };
    let mut rows: Vec<Row> = kinds
        .into_iter()
        .map(|kind| {
            let contribution = |line: &ParameterBudget| {
                let part = line.contributions.iter().find(|part| part.cause.kind() == kind.cause.kind())?;
                // One digit more than u has, so that their squares add up to its square.
                let number = Number::to_place(part.contribution, Number::place_of(line.standard_uncertainty) - 1);
                Some(number).filter(|number| !number.is_printed_as_zero()).map(Words::from)
            };
            let largest = of_input(kind.cause, kind.cause.shown(kind.standard_uncertainty[1]));
            let name = Words::Capital(Box::new(kind.cause.kind_words()));
            (input(name, if kind.has_several_sizes() { "≤" } else { "=" }, largest), each(&contribution))
        })
        .collect();
    rows.push((strong(texts::COMBINED), each(&|line| Some(Number::uncertainty(line.standard_uncertainty).into()))));
    rows.push((
        texts::EFFECTIVE_FREEDOM.into(),
        each(&|line| {
            Some(match line.effective_degrees_of_freedom {
                known if known > MANY => "∞".into(),
                // Aligned with contributions of many decimals, its column would be too wide.
                known if known >= 1000.0 => "> 1000".into(),
                // Rounding to tens would print a number that differs from the one in the result.
                known => Number::whole_or_two_digits(known).into(),
            })
        }),
    ));
    if let Some(verdict) = verdict.filter(|all| all.parameters.iter().any(|row| row.u_from_gravity().is_some())) {
        let each = |cell: &dyn Fn(&ParameterVerdict) -> Option<Number>| {
            each(&|line| verdict.parameter(line.parameter).and_then(cell).map(Words::from))
        };
        let u = Words::Quantity(Number::uncertainty(u_of_gravity), units::M_PER_S2);
        let of_gravity = |row: &ParameterVerdict| {
            Some(Number::to_place(row.u_from_gravity()?, Number::place_of(row.standard_uncertainty) - 1))
        };
        rows.push((input(texts::BUDGET_GRAVITY.into(), "=", u), each(&of_gravity)));
        let combined = each(&|row| Some(Number::uncertainty(row.standard_uncertainty)));
        rows.push((strong(texts::COMBINED_AT_G0), combined));
    }
    rows
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

/// The coverage intervals, and for every parameter whether the linear approximation is valid.
pub(crate) fn monte_carlo(found: &MonteCarlo) -> Vec<Block> {
    let line = |parameter: Parameter| found.parameters.iter().find(|line| line.parameter == parameter);
    let each =
        |cell: &dyn Fn(&Distribution) -> Words| Parameter::AS_IN_THE_PAPER.map(|parameter| line(parameter).map(cell));
    let measured = |value: f64, line: &Distribution| Number::measured(value, line.standard_uncertainty).into();
    let mut rows: Vec<Row> = vec![
        (texts::MEAN.into(), each(&|line| measured(line.mean, line))),
        (symbol("u"), each(&|line| Number::uncertainty(line.standard_uncertainty).into())),
        (texts::LOWER.into(), each(&|line| measured(line.symmetric[0], line))),
        (texts::UPPER.into(), each(&|line| measured(line.symmetric[1], line))),
    ];
    // Too few trials decide nothing.
    let decided = found.parameters.iter().filter(|line| line.first_order_valid.is_some()).count();
    if decided > 0 {
        let valid = each(&|line| match line.first_order_valid {
            Some(valid) => {
                let word = if valid { words::YES } else { words::NO };
                marked(Some(valid), Words::First(Box::new(word.into())))
            }
            None => marked(Outcome::Undecided, ""),
        });
        rows.push((texts::FIRST_ORDER.into(), valid));
    }
    let caption = texts::monte_carlo_caption(told(Number::fixed(found.trials as f64, 0)), found.seed);
    let some = (1..found.parameters.len()).contains(&decided);
    let failed = told(Number::fixed(found.failed as f64, 0));
    let warning = |words: Words| vec![either("", "WARNING: "), words];
    vec![
        parameters(&rows).captioned(texts::MONTE_CARLO, caption),
        say(some.then_some(texts::FIRST_ORDER_UNDECIDED)),
        say((!found.stable).then(|| warning(texts::NOT_STABLE.into()))),
        say((found.failed > 0).then(|| warning(texts::failed_trials(failed)))),
    ]
}
