//! The result: every parameter with its expanded uncertainty, within the tolerance of the type if one was specified, its
//! change since an earlier result, and the terms of a larger model.

use super::{Report, history, unit_at_type, with_u};
use crate::calibration::document::ResultDocument;
use crate::calibration::parameter::{symbols, unit};
use crate::calibration::verdict::{Decision, ParameterVerdict, Verdict};
use crate::calibration::{NotStated, Parameter};
use crate::report::doc::{Block, On, Rows, Words, fields, heading, in_unit, listed, marked, probability, say, symbol};
use crate::report::picture::strips::{BESIDE_DECISIONS, Tolerances, decision};
use crate::wording::number::Probability;
use crate::wording::texts::{calibration as texts, units};
use crate::wording::{Number, Outcome, Text};

/// A brief section has a row for each parameter; what is doubtful has been said above it.
pub(super) fn section(of: &Report, is_brief: bool) -> Vec<Block> {
    let compared_with = [texts::NOMINAL, texts::DEVIATION];
    let mut doc = vec![of.left_out()];
    match of.judged() {
        None => doc.extend(alone(of)),
        Some((_, verdict)) if is_brief => {
            doc.push(compared(verdict, texts::brief_caption, compared_with, Extent::Brief));
            let largest = verdict.parameters.iter().filter_map(|row| row.specific_risk).reduce(f64::max);
            let largest = largest.map(|risk| texts::largest_risk(probability(risk)));
            // The column says the usual rule.
            let is_usual = verdict.rule.guard_band() == 1.0;
            doc.push(notes(verdict, [rule(verdict)].into_iter().chain(largest).filter(|_| !is_usual)));
            doc.extend(from_gravity(of, verdict));
        }
        Some((name, verdict)) => {
            doc.push(heading(texts::conformity(name)));
            doc.push(compared(verdict, texts::verdict_caption, compared_with, Extent::Values));
            doc.push(Block::Key(Tolerances::key([verdict].into_iter())));
            doc.push(say((!verdict.withheld).then(|| rule(verdict))).only(On::Terminal));
            doc.push(simple(verdict, Some(texts::RISK_NOTE), of.details));
            doc.extend(from_gravity(of, verdict));
            let u = of.calibration.mostly_from_turn_ons();
            doc.push(say(u.map(|u| texts::from_turn_ons(Words::Quantity(Number::uncertainty(u), units::DEG_PER_H)))));
        }
    }
    doc.extend(of.adopted().into_iter().flat_map(|result| beyond_the_eight(result, !is_brief)));
    if let Some(change) = of.document.change.as_ref().filter(|_| !is_brief) {
        doc.push(heading(texts::CHANGE));
        doc.push(compared(change, texts::change_caption, [texts::EARLIER, texts::CHANGED_BY], Extent::Change));
        doc.push(simple(change, None, of.details));
        doc.push(previous(of));
    }
    doc.extend(history::table(of));
    doc
}

/// Columns of a comparison.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Extent {
    /// All of them.
    Values,
    /// All but the uncertainty of the value, which is not that of the change.
    Change,
    /// Those that a terminal of 80 columns has room for.
    Brief,
}

/// The unit of a line of a verdict: percent for scale factors, the parameter's own otherwise.
fn unit_of(row: &ParameterVerdict) -> Text {
    if row.unit == "%" { units::PERCENT } else { unit_at_type(row.parameter) }
}

/// Which calibration is the previous one, whether it is known to be that of this gyro, and the limits of the comparison.
fn previous(of: &Report) -> Block {
    let Some(earlier) = of.previous.last() else { return say::<Words>([]) };
    let day = earlier.date().map_or_else(|| texts::NO_DAY.into(), Words::Date);
    let sha256: String = earlier.currents_sha256().unwrap_or("–").chars().take(8).collect();
    let passport = Words::Given(earlier.passport_id.clone());
    let said = texts::previous(day, passport, Words::Code(sha256.clone()));
    let names = |inputs: Vec<NotStated>| listed(inputs.into_iter().map(super::fit::not_stated));
    let limits = of.document.limits_of_change(earlier).map(|(words, inputs)| words(names(inputs)));
    let same = (!of.is_same_gyro()).then(|| texts::SAME_GYRO_NOT_SHOWN.into());
    say([said].into_iter().chain(same).chain(limits))
}

/// How many parameters pass, in the words of `passed`, and which are undecided, fail or were not assessed.
pub(crate) fn counted(
    verdict: &Verdict,
    by: fn(&ParameterVerdict) -> Decision,
    passed: fn(usize, usize) -> Words,
) -> Words {
    let rows = Parameter::in_paper_order(&verdict.parameters, |row| row.parameter);
    let of = |decision| rows.iter().filter(move |row| by(row) == decision).map(|row| row.parameter);
    let mut all = vec![passed(of(Decision::Pass).count(), Parameter::EIGHT.len())];
    for (decision, text) in
        [(Decision::Fail, texts::fail as fn(Words) -> Words), (Decision::Undecided, texts::are_undecided)]
    {
        all.extend(names(text, of(decision)));
    }
    all.into()
}

/// A sentence about some parameters; `None` if there are none.
fn names(text: fn(Words) -> Words, which: impl IntoIterator<Item = Parameter>) -> Option<Words> {
    let which: Vec<Parameter> = which.into_iter().collect();
    (!which.is_empty()).then(|| text(symbols(which)))
}

/// The decision rule.
pub(crate) fn rule(verdict: &Verdict) -> Words {
    match verdict.rule.guard_band_of_u {
        None => texts::RULE_SIMPLE.into(),
        Some(band) => texts::rule_guarded(band_of_u(band)),
    }
}

/// A guard band as a multiple of U.
pub(crate) fn band_of_u(band: f64) -> Words {
    if band == 1.0 { symbol("U") } else { Words::All(vec![Number::exact(band).into(), "\u{a0}".into(), symbol("U")]) }
}

/// Simple acceptance, a note on the risks, and notes on parameters.
fn simple(verdict: &Verdict, note: Option<Text>, details: bool) -> Block {
    let by_simple = (verdict.rule.guard_band() > 0.0 && details)
        .then(|| vec![counted(verdict, |row| row.simple, texts::passed_by_simple), ".".into()].into());
    notes(verdict, [by_simple, note.map(Words::from), verdict.common_factor_in_words()].into_iter().flatten())
}

/// The sentences `first`, and the parameters that no gyro could pass, would pass with the other sign, or are not decided.
fn notes(verdict: &Verdict, first: impl Iterator<Item = Words>) -> Block {
    let names = [
        names(texts::too_uncertain, verdict.too_uncertain()),
        names(texts::opposite, verdict.opposite()),
        names(texts::dependent, verdict.dependent()),
    ];
    say(first.chain(names.into_iter().flatten()).filter(|_| !verdict.withheld))
}

/// The parameters without a type: values and expanded uncertainties.
fn alone(of: &Report) -> Option<Block> {
    let found = of.document.found()?;
    let values = found.parameters.to_vector();
    let is_found = |parameter: &Parameter| !values[parameter.place()].is_nan();
    let rows: Vec<Parameter> = Parameter::AS_IN_THE_PAPER.into_iter().filter(is_found).collect();
    let u = |parameter: &Parameter| found.expanded_uncertainty(*parameter);
    let k = super::coverage_factor(rows.iter().map(|parameter| found.coverage_factor(*parameter)));
    let table = Rows::of(&rows, "numbers narrow")
        .named(texts::PARAMETER, |parameter| in_unit(symbol(parameter.symbol()), unit(*parameter)))
        .column(texts::FOUND, |parameter| Number::measured(values[parameter.place()], u(parameter)))
        .column(texts::PLUS_MINUS, |parameter| Number::uncertainty(u(parameter)));
    Some(table.captioned(texts::RESULT, texts::result_caption(k)))
}

/// A comparison of values with the tolerances.
fn compared(
    verdict: &Verdict,
    caption: fn(Words, Words) -> Words,
    [reference, deviation]: [Text; 2],
    extent: Extent,
) -> Block {
    let rows = Parameter::in_paper_order(verdict.parameters.clone(), |row| row.parameter);
    let u = ParameterVerdict::expanded_uncertainty_of_value;
    // One digit stands before every decimal mark, so that these align where the numbers begin at one place.
    let risk = |row: &ParameterVerdict| vec![Words::from(row.specific_risk.map(probability))];
    let by = if verdict.rule.guard_band() > 0.0 { texts::GUARDED } else { texts::SIMPLE };
    let outcome = |row: &ParameterVerdict| Outcome::from(verdict.decision(row));
    let mut table = Rows::of(&rows, "numbers result")
        .named(texts::PARAMETER, |row| {
            let unit = Words::First(Box::new(unit_at_type(row.parameter).into()));
            vec![Words::OnTelephones(outcome(row)), symbol(row.parameter.symbol()), ", ".into(), unit]
        })
        .column(texts::FOUND, |row| Number::measured(row.value, u(row)))
        .column(texts::PLUS_MINUS, |row| Number::uncertainty(u(row)))
        .only_if(extent == Extent::Values)
        .column(reference, |row| Number::measured(row.reference_value, u(row)))
        .only_if(extent != Extent::Brief)
        .column(deviation, |row| Number::measured(row.deviation, row.expanded_uncertainty))
        .column(texts::PLUS_MINUS, |row| Number::uncertainty(row.expanded_uncertainty))
        .column(texts::TOLERANCE, |row| Words::Quantity(Number::exact(row.tolerance), unit_of(row)))
        .strips(texts::IN_TOLERANCE, |row| BESIDE_DECISIONS.of_parameter(verdict, row), BESIDE_DECISIONS.axis())
        .column(by, |row| {
            // In the first language: the key below the table has the mark in all of them.
            Words::First(Box::new(marked(outcome(row), decision(verdict.decision(row)))))
        })
        .column(texts::RISK, risk)
        .only_if(extent != Extent::Brief);
    // Values and deviations of a scale factor have different units, and so have their U.
    table.table.groups = vec![
        (if extent == Extent::Values { 3 } else { 2 }, texts::IN_UNIT_OF_PARAMETER.into()),
        (3, texts::IN_UNIT_OF_TOLERANCE.into()),
        (3, Words::Plain(String::new())),
    ];
    let k = super::coverage_factor(rows.iter().map(|row| row.coverage_factor));
    let caption = caption(k, Number::exact(verdict.gravity_m_per_s2).into());
    // The rows have no room for the units of a second language.
    let mut units: Vec<Text> = rows.iter().map(|row| unit_at_type(row.parameter)).collect();
    units.dedup();
    let units = Words::Others(Box::new(texts::units(listed(units))));
    table.captioned(texts::RESULT, vec![caption, units])
}

/// The part of the deviations that comes from converting the drifts to the type's g, and the expanded uncertainty that the
/// local g adds to them, where it is most of it. On normal gravity without a height: what it assumes.
fn from_gravity(of: &Report, verdict: &Verdict) -> Vec<Block> {
    let part = |(row, part): (&ParameterVerdict, f64)| {
        let gravity = Words::Quantity(Number::significant(part, 2), unit_of(row));
        texts::from_gravity_part(gravity, symbol(row.parameter.symbol()))
    };
    let u = Words::Quantity(Number::uncertainty(of.document.gravity_u_m_per_s2.unwrap_or(0.0)), units::M_PER_S2);
    let [converted, of_gravity] =
        verdict.parts_from_gravity().map(|parts| (!parts.is_empty()).then(|| listed(parts.into_iter().map(part))));
    let of_gravity = of_gravity.map(|parts| match of.without_height {
        true => texts::from_unknown_height(parts, u),
        false => texts::from_gravity(u, parts),
    });
    vec![say(converted.map(texts::conversion_of_g)), say(of_gravity)]
}

/// The terms of a model that goes beyond the eight parameters.
fn beyond_the_eight(result: &ResultDocument, with_turn_ons: bool) -> Vec<Block> {
    let of_u = &result.standard_uncertainty;
    let mut doc = Vec::new();
    let pair = result.anisoelasticity_deg_per_h_per_g2.zip(of_u.anisoelasticity_deg_per_h_per_g2);
    doc.push(fields(pair.map(|(value, u)| (texts::ANISOELASTICITY, with_u(value, u, units::DEG_PER_H_PER_G2), false))));
    if let Some((matrix, u)) = result.g_matrix_deg_per_h_per_g.zip(of_u.g_matrix_deg_per_h_per_g) {
        let values = matrix.as_flattened().iter().zip(u.as_flattened()).zip(["xx", "xy", "xz", "yx", "yy", "yz"]);
        let rows: Vec<_> = values.collect();
        let table = Rows::of(&rows, "numbers narrow")
            .named(texts::PARAMETER, |(_, index)| in_unit(symbol(&format!("G_{index}")), units::DEG_PER_H_PER_G))
            .column(texts::FOUND, |((value, u), _)| Number::measured(**value, **u))
            .column(symbol("u"), |((_, u), _)| Number::uncertainty(**u));
        doc.extend([heading(texts::G_MATRIX), table.called(texts::G_MATRIX)]);
        doc.push(say(result.model_test.iter().flat_map(|test| {
            let [further, rest] = test.degrees_of_freedom;
            let found = texts::model_test(Number::significant(test.f, 3), further, rest, Probability(test.probability));
            let answer = match (test.only_larger_fits, test.is_significant()) {
                (true, _) => texts::ONLY_LARGER_FITS,
                (false, true) => texts::FURTHER_NEEDED,
                (false, false) => texts::FURTHER_NOT_NEEDED,
            };
            [found, answer.into()]
        })));
    }
    if with_turn_ons && result.method == "least-squares" && !result.cycles.is_empty() {
        let us = of_u.omega0_deg_per_h;
        let table = [("ω_0x", 0), ("ω_0y", 1)].into_iter().fold(
            Rows::of(&result.cycles, "numbers narrow").named(texts::CYCLE, |at| at.cycle),
            |table, (name, axis)| {
                let heading = in_unit(symbol(name), units::DEG_PER_H);
                table.column(heading, |at| Number::measured(at.omega0_deg_per_h[axis], us[axis]))
            },
        );
        doc.extend([heading(texts::CYCLES), table.called(texts::CYCLES)]);
    }
    let drift = result.drift_deg_per_h_per_h.zip(of_u.drift_deg_per_h_per_h);
    doc.push(fields(drift.into_iter().flat_map(|(drift, u)| {
        let each = |name, axis: usize| (name, with_u(drift[axis], u[axis], units::DEG_PER_H2), false);
        [each(texts::DRIFT_X, 0), each(texts::DRIFT_Y, 1)]
    })));
    doc
}
