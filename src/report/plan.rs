//! A plan: positions, order, uncertainties next to those of the paper's eight, and what it cannot see.

use super::calibration::with_key;
use super::doc::{Block, On, Rows, Words, code, given, heading, in_unit, joined, line, listed, marked, say, symbol};
use crate::calibration::Parameter;
use crate::calibration::parameter::{symbols, unit};
use crate::calibration::verdict::COVERAGE_FACTOR;
use crate::gyro::GyroType;
use crate::plan::criterion::Criterion;
use crate::plan::sensitivity::Effect;
use crate::plan::{Evaluation, Plan, Visited};
use crate::text::number::decimal;
use crate::uncertainty::dominant::unit_of;
use crate::wording::texts::{compass, plan as texts, units};
use crate::wording::{Number, Outcome, Text};

/// Rise of ω_0 during the run for which its effect is stated, °/h.
const DRIFT_DEG_PER_H: f64 = 0.01;

/// Share of the tolerance from which an uncertainty that no reading reduces is stated.
const LARGE_SHARE: f64 = 0.1;

/// Returns the plan. `site` is the identifier of the site, and `site_azimuth_deg` its azimuth of the frame's axis. `assumed`
/// says whether the gyro type and the laboratory were assumed.
pub(crate) fn document(
    plan: &Plan,
    (site, site_azimuth_deg): (&str, f64),
    gyro: &GyroType,
    assumed: [bool; 2],
) -> Vec<Block> {
    let failed = |words: Words| line(marked(Outcome::Failed, words));
    let gyro_type = gyro.r#type.as_str();
    // The guard band that the uncertainty of local g alone makes exceeds a tolerance.
    let prevented = COVERAGE_FACTOR * gyro.decision_rule().guard_band() * plan.gravity_over_tolerance > 1.0;
    let mut turn_ons = turn_ons(plan).map(line);
    let mut doc = Vec::new();
    if let Some(sentence) = no_gyro_can_pass(plan, gyro) {
        doc.push(failed(sentence));
        doc.extend(turn_ons.take());
    }
    if prevented {
        let share = percent(COVERAGE_FACTOR * plan.gravity_over_tolerance);
        doc.push(failed(texts::gravity_prevents(given(gyro_type), share)));
    }
    let readings: u32 = plan.readings.iter().map(|at| at.visits).sum();
    let azimuth_of_plan = azimuth(plan.frame_axis_azimuth_deg);
    doc.push(line(texts::plan_for(given(site), readings, plan.readings.len(), plan.candidates, azimuth_of_plan)));
    let [is_gyro_assumed, is_meter_assumed] = assumed;
    let mut inputs = given(gyro_type);
    if is_gyro_assumed {
        inputs = texts::type_assumed(inputs, code("--gyro"));
    }
    if is_meter_assumed {
        inputs = texts::meter_assumed(inputs, code("--laboratory"));
    }
    let value = plan.evaluation.value;
    let how = if plan.exhaustive { texts::BEST_OF_ALL } else { texts::BEST_FOUND };
    let criterion = texts::criterion(of_criterion(plan.criterion), Number::significant(value, 4), how);
    let of_paper = plan.paper.as_ref().map(|paper| {
        let ratio = Number::fixed(plan.criterion.ratio(value, paper.value), 3);
        texts::of_the_paper(Number::significant(paper.value, 4), ratio)
    });
    doc.extend([line(texts::for_type(inputs)), line(joined([criterion].into_iter().chain(of_paper), " "))]);
    doc.extend(positions(plan));
    doc.extend(uncertainties(plan));
    doc.extend(common_errors(plan));
    doc.push(Block::Gap);
    doc.extend(turn_ons.into_iter().chain(remarks(plan, prevented, site_azimuth_deg).into_iter().map(line)));
    doc
}

fn azimuth(azimuth_deg: f64) -> Words {
    let degrees = Number::exact(azimuth_deg);
    let direction = match azimuth_deg {
        0.0 => compass::NORTH,
        90.0 => compass::EAST,
        180.0 => compass::SOUTH,
        270.0 => compass::WEST,
        _ => return Words::Quantity(degrees, units::DEGREES),
    };
    texts::at(degrees, direction)
}

fn of_criterion(criterion: Criterion) -> Words {
    let words = match criterion {
        Criterion::A => texts::criterion_a,
        Criterion::D => texts::criterion_d,
        Criterion::Worst => texts::criterion_worst,
    };
    words(code(criterion.key()))
}

fn positions(plan: &Plan) -> [Block; 3] {
    let is_certified = plan.readings.iter().any(|at| at.index.is_some());
    let table = Rows::of(&plan.readings, "numbers")
        .named(symbol("i"), |at| at.index.map(|index| index.i))
        .only_if(is_certified)
        .named(symbol("j"), |at| at.index.map(|index| index.j))
        .only_if(is_certified)
        .column(in_unit(symbol("θ"), units::DEGREES), |at| Number::exact(at.theta_deg))
        .column(in_unit(symbol("φ"), units::DEGREES), |at| Number::exact(at.phi_deg))
        .column(texts::VISITS, |at| at.visits);
    // Without a space, so that both numbers stay on one line.
    let visit = |place: &usize| match &plan.readings[*place] {
        Visited { index: Some(index), .. } => format!("({},{})", index.i, index.j),
        Visited { theta_deg, phi_deg, .. } => format!("({theta_deg},{phi_deg})"),
    };
    let names = if is_certified { "(i,j)" } else { "(θ,φ)" };
    let order = line(texts::order(names, listed(plan.order.places.iter().map(visit))));
    [Block::Within("", vec![Block::Gap, table.called(texts::VISITS), Block::Gap]), order, Block::Gap]
}

fn uncertainties(plan: &Plan) -> [Block; 2] {
    let u = |of: &Evaluation, parameter: &Parameter| of.standard_uncertainty[parameter.place()];
    let own = |parameter: &Parameter| u(&plan.evaluation, parameter);
    let of_paper = |parameter: &Parameter| plan.paper.as_ref().map(|paper| u(paper, parameter));
    let table = Rows::of(&Parameter::AS_IN_THE_PAPER, "numbers")
        .named("", |parameter| symbol(parameter.symbol()))
        .column(texts::UNIT, |parameter| unit(*parameter))
        .column(symbol("u"), |parameter| Number::uncertainty(own(parameter)))
        .column(texts::OF_TOLERANCE, |parameter| {
            percent_of_tolerance(own(parameter) / plan.tolerance[parameter.place()])
        })
        .column(texts::U_OF_THE_PAPER, |parameter| of_paper(parameter).map(Number::uncertainty))
        .only_if(plan.paper.is_some())
        .column(texts::RATIO, |parameter| of_paper(parameter).map(|paper| Number::fixed(own(parameter) / paper, 2)))
        .only_if(plan.paper.is_some());
    let note = if plan.turn_on_over_tolerance > 0.0 { texts::u_note_turn_on } else { texts::u_note };
    [table.called(texts::OF_TOLERANCE), say([note(code("`calibrate`"))])]
}

fn common_errors(plan: &Plan) -> [Block; 2] {
    let rows: Vec<(usize, &Effect)> = plan.evaluation.effects.iter().enumerate().collect();
    let residual = |effect: &Effect| match effect.largest_residual_deg_per_h {
        // Rounding leaves about 1e-15.
        rounding if rounding < 1e-12 => Number::fixed(0.0, 0),
        residual => Number::scientific(residual, 2),
    };
    let of_paper = |place: usize| plan.paper.as_ref().map(|paper| &paper.effects[place]);
    let table = Rows::of(&rows, "numbers")
        .named(texts::ERROR, |(_, effect)| effect.error.cause.kind_words())
        .column(texts::SIZE, |(_, effect)| {
            Words::Quantity(Number::exact(effect.error.size), unit_of(effect.error.cause))
        })
        .column(texts::CHANGE, |(_, effect)| percent(effect.largest_over_tolerance))
        .column(texts::RESIDUAL, |(_, effect)| residual(effect))
        .column(texts::PAPER_CHANGE, |(place, _)| of_paper(*place).map(|effect| percent(effect.largest_over_tolerance)))
        .only_if(plan.paper.is_some())
        .column(texts::PAPER_RESIDUAL, |(place, _)| of_paper(*place).map(residual))
        .only_if(plan.paper.is_some());
    [heading(texts::COMMON_ERRORS).only(On::Terminal), table.called(texts::COMMON_ERRORS)]
}

/// Returns a standard uncertainty as a share of the tolerance, in percent.
pub(crate) fn percent_of_tolerance(share: f64) -> Number {
    Number::fixed(100.0 * share, 1)
}

/// Returns a share in percent: two digits, or 0 where only rounding is left.
pub(crate) fn percent(share: f64) -> Number {
    match 100.0 * share {
        small if small < 1e-6 => Number::fixed(0.0, 0),
        small if small < 0.095 => Number::scientific(small, 2),
        small if small < 9.5 => Number::fixed(small, 1),
        large => Number::fixed(large, 0),
    }
}

/// The parameters of which no value can be found within the tolerance, if there are any.
fn no_gyro_can_pass(plan: &Plan, gyro: &GyroType) -> Option<Words> {
    let of_tolerance = |parameter: &Parameter| {
        plan.evaluation.standard_uncertainty[parameter.place()] / plan.tolerance[parameter.place()]
    };
    let band = COVERAGE_FACTOR * gyro.decision_rule().guard_band();
    let beyond = Parameter::AS_IN_THE_PAPER.into_iter().filter(|parameter| band * of_tolerance(parameter) > 1.0);
    let beyond: Vec<Parameter> = beyond.collect();
    let no_other = if plan.exhaustive { Words::from(texts::NO_OTHER) } else { "".into() };
    (!beyond.is_empty()).then(|| texts::no_gyro_can_pass(given(gyro.r#type.as_str()), symbols(beyond), no_other))
}

/// What the noise between turn-ons contributes, if it is much.
fn turn_ons(plan: &Plan) -> Option<Words> {
    (plan.turn_on_over_tolerance > LARGE_SHARE).then(|| texts::turn_ons(percent(plan.turn_on_over_tolerance)))
}

/// What a user of the plan must know besides the numbers.
fn remarks(plan: &Plan, prevented: bool, site_azimuth_deg: f64) -> Vec<Words> {
    let mut remarks = Vec::new();
    if plan.gravity_over_tolerance > LARGE_SHARE && !prevented {
        remarks.push(texts::gravity(percent(plan.gravity_over_tolerance)));
    }
    if plan.beyond_range > 0 {
        remarks.push(texts::beyond_range(code("meter.range_ma"), plan.beyond_range));
    }
    type Kind = (fn(Words) -> Words, fn(&Effect) -> bool);
    let kinds: [Kind; 3] = [
        (texts::hidden, |effect| effect.matters() && effect.is_hidden()),
        (texts::shown, |effect| effect.matters() && !effect.is_hidden()),
        (texts::no_effect, |effect| !effect.matters()),
    ];
    for (words, is) in kinds {
        let effects = plan.evaluation.effects.iter().filter(|effect| is(effect));
        // The names of some inputs have commas.
        let names: Vec<Words> = effects.map(|effect| effect.error.cause.kind_words()).collect();
        remarks.extend((!names.is_empty()).then(|| words(joined(names, "; "))));
    }
    let worse = plan.worse().into_iter();
    let worse: Vec<Words> =
        worse.map(|(parameter, ratio)| texts::times(symbol(parameter.symbol()), Number::fixed(ratio, 2))).collect();
    remarks.extend(plan.paper.as_ref().map(|_| match worse.is_empty() {
        true => texts::NONE_WORSE.into(),
        false => texts::worse(listed(worse)),
    }));
    let may_be_said: [(bool, Text); 3] = [
        (!plan.has_matrices, texts::NO_MATRICES),
        (!plan.has_general_model, texts::NO_GENERAL_MODEL),
        (2 * plan.readings.len() == Parameter::EIGHT.len(), texts::NO_FREEDOM),
    ];
    remarks.extend(may_be_said.into_iter().filter(|(is, _)| *is).map(|(_, text)| text.into()));
    let change = percent(DRIFT_DEG_PER_H * plan.order.largest_over_tolerance);
    remarks.push(texts::if_drifts(Number::exact(DRIFT_DEG_PER_H), change));
    if plan.frame_axis_azimuth_deg != site_azimuth_deg {
        let key = format!("frame_axis_azimuth_deg: {}", decimal(plan.frame_axis_azimuth_deg));
        let [of_site, of_plan] = [site_azimuth_deg, plan.frame_axis_azimuth_deg].map(azimuth);
        remarks.push(texts::other_azimuth(of_site, of_plan, code(key)));
    }
    if !plan.has_matrices && plan.readings.iter().all(|at| at.index.is_none()) {
        remarks.push(texts::TO_BE_CERTIFIED.into());
    }
    let noise = plan.noise_not_stated.then(|| texts::noise(code("noise.visit_deg_per_h")));
    let of_positions = plan.of_positions_not_stated.iter().map(|what| with_key(*what).into());
    let not_stated: Vec<Words> = noise.into_iter().chain(of_positions).collect();
    remarks.extend((!not_stated.is_empty()).then(|| texts::not_stated(joined(not_stated, "; "))));
    remarks
}
