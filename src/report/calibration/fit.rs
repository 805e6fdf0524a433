//! Agreement of the readings with the fit, possible causes of disagreement, and errors that the residuals do not show.

use super::Report;
use crate::calibration::chi_square::FEW_DEGREES;
use crate::calibration::diagnosis::{ALARM, Explanation, Hint, numbering};
use crate::calibration::document::{ResidualDocument, ResultDocument};
use crate::calibration::result::DriftTest;
use crate::calibration::{Agreement, Calibration, DriftNoise, NoiseSource, NotStated, Scatter, Suspect};
use crate::report::doc::{Block, On, Rows, Words, drawn, in_unit, joined, probability, say, symbol, told};
use crate::report::page::language::Text;
use crate::report::page::number::{LARGEST_IN_ARCSEC, Number};
use crate::report::page::parts::starts;
use crate::report::picture::residuals::{AXES, Bars, key};
use crate::report::recorded;
use crate::wording::number::Probability;
use crate::wording::spacing::spaced;
use crate::wording::texts::causes as names;
use crate::wording::texts::{calibration as texts, units};

/// Uncertainty with which an angle is printed in whole arcseconds.
const WHOLE_ARCSECONDS: f64 = 10.0;

pub(super) fn section(of: &Report) -> Vec<Block> {
    let Some(result) = of.adopted() else { return Vec::new() };
    let calibration = of.calibration;
    if result.chi_square.degrees_of_freedom == 0 {
        let scatter = scatter(calibration).into_iter().map(|(_, block)| block);
        return [say([texts::NOT_JUDGED])].into_iter().chain(scatter).collect();
    }
    let answer = calibration.adopted();
    let changed = answer.is_some_and(|found| found.chi_square.is_changed_by_estimates());
    let mut doc = vec![chi_square(result), say(changed.then_some(texts::OF_ESTIMATES)), say(too_small(calibration))];
    doc.extend(scatter(calibration).into_iter().map(|(_, block)| block));
    doc.push(say(super::methods::agreement(of)));
    if of.details || calibration.hint.is_some() {
        doc.extend([residuals(result), Block::Drawn(drawn(key))]);
    }
    doc
}

/// The fit with what is notable about it; the residuals of readings that do not fit.
pub(super) fn brief(of: &Report) -> Vec<Block> {
    let Some(result) = of.adopted() else { return Vec::new() };
    if result.chi_square.degrees_of_freedom == 0 {
        return vec![say([texts::NOT_JUDGED])];
    }
    let mut doc = vec![chi_square(result), say(too_small(of.calibration))];
    let notable = scatter(of.calibration).into_iter().filter(|(weight, _)| *weight == Remark);
    doc.extend(notable.map(|(_, block)| block));
    doc.extend(of.calibration.hint.as_ref().map(|_| residuals(result)));
    doc
}

/// Warnings about the scatter of the readings.
pub(super) fn warnings(calibration: &Calibration) -> Vec<Words> {
    let all = [(Warning, correlated(calibration))].into_iter().chain(scatter(calibration));
    let all = all.filter(|(weight, _)| *weight == Warning);
    let sentences = all.filter_map(|(_, block)| match block {
        Block::Paragraph(all) if !all.is_empty() => Some(joined(all, " ")),
        _ => None,
    });
    sentences.collect()
}

/// Errors that the residuals do not show.
pub(super) fn blind(of: &Report) -> Vec<Block> {
    let all = of.missing.iter().map(|what| Words::from(not_stated(*what))).collect::<Vec<_>>();
    let missing = match all.is_empty() {
        true => [say([texts::ALL_STATED])].into(),
        false => vec![say([texts::NOT_STATED]), Block::List(all)],
    };
    [say([texts::CANNOT_TELL])].into_iter().chain(missing).collect()
}

fn chi_square(result: &ResultDocument) -> Block {
    let found = &result.chi_square;
    let of_fit = found
        .probability
        .map(|p| vec![probability(p), " (".into(), texts::consistent(Number::exact(ALARM)), ")".into()].into());
    let few = found.uncertainty_degrees_of_freedom.filter(|known| *known < FEW_DEGREES);
    let mut each = vec![
        (texts::CHI_SQUARE, Number::chi_square(found.value).into(), false),
        (texts::FREEDOM, found.degrees_of_freedom.into(), false),
        (texts::PROBABILITY, of_fit.unwrap_or(Words::Blank), false),
    ];
    each.extend(few.map(|known| (texts::OF_UNCERTAINTIES, Number::fixed(known, 0).into(), false)));
    Block::Fields(each)
}

/// Weight of what is said: programs show remarks and warnings with the parameters.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Weight {
    Usual,
    Remark,
    Warning,
}
use Weight::{Remark, Usual, Warning};

/// Statements about the scatter of the readings, each with its weight.
pub(crate) fn scatter(calibration: &Calibration) -> Vec<(Weight, Block)> {
    let mut doc = vec![(Remark, say(calibration.digits.iter().flat_map(recorded::said)))];
    if let Some(rows) = &calibration.row_scatter {
        let s = Words::Quantity(Number::scientific(rows.standard_deviation_ma, 2), units::MILLIAMPERES);
        doc.extend(match &rows.against_stated {
            Some(stated) => agreement(stated, texts::ROW_SCATTER, texts::ROWS_LESS_THAN_STATED),
            None => {
                let freedom = (texts::FREEDOM, rows.degrees_of_freedom.into(), false);
                vec![(Usual, Block::Fields(vec![(texts::ROW_DEVIATION, s, false), freedom]))]
            }
        });
    }
    if let Some(visits) = &calibration.scatter {
        // Of several turn-ons the visits are those that were meant to be.
        let has_turn_ons = calibration.adopted().is_some_and(|answer| answer.cycles.len() > 1);
        let less = if has_turn_ons { texts::NOISE_LESS_THAN_STATED } else { texts::LESS_THAN_STATED };
        doc.extend(agreement(visits, texts::SCATTER, less));
        let is_more = visits.agreement() == Agreement::More && calibration.visit_noise.source == NoiseSource::Estimated;
        doc.push((Remark, say(is_more.then_some(texts::NOISE_ADDED))));
    }
    doc.extend(
        calibration
            .turn_on_scatter
            .iter()
            .flat_map(|turn_ons| agreement(turn_ons, texts::TURN_ON_SCATTER, texts::NOISE_LESS_THAN_STATED)),
    );
    doc.extend(calibration.suspects.iter().map(|suspect| (Warning, say(with_advice(suspect)))));
    let noises = [(texts::VISIT_NOISE, &calibration.visit_noise), (texts::TURN_ON_NOISE, &calibration.turn_on_noise)];
    let is_estimated = noises.iter().any(|(_, noise)| noise.source == NoiseSource::Estimated);
    doc.push((if is_estimated { Remark } else { Usual }, noise(noises)));
    for (test, in_order) in [(calibration.drift_test, false), (calibration.drift_in_order, true)] {
        doc.push((Warning, say(test.filter(|test| test.is_significant()).map(|test| drift(in_order, &test)))));
    }
    doc.push((
        Remark,
        say(calibration.drift_or_noise.then(|| {
            let advice = Words::All(vec![" ".into(), texts::drift_or_noise_advice("noise.visit_deg_per_h")]);
            Words::All(vec![texts::DRIFT_OR_NOISE.into(), Words::Either(Box::new("".into()), Box::new(advice))])
        })),
    ));
    doc
}

/// The sentence on readings of a visit that are correlated; it may be why they do not fit.
pub(super) fn correlated(calibration: &Calibration) -> Block {
    say(calibration.row_correlation.map(|r| texts::rows_correlated(Number::fixed(r, 2))))
}

fn drift(in_order: bool, test: &DriftTest) -> Words {
    let [x, y] =
        [test.drift_deg_per_h_per_h.x, test.drift_deg_per_h_per_h.y].map(|drift| told(Number::scientific(drift, 2)));
    let p = Probability(test.probability);
    if in_order { texts::drifts_in_order(x, y, p, "--drift") } else { texts::drifts(x, y, p, "--drift") }
}

/// Why chi-square is much smaller than expected, if it is.
fn too_small(calibration: &Calibration) -> Option<Text> {
    let drifts = [calibration.drift_test, calibration.drift_in_order];
    let turn_ons = calibration.adopted().map_or(1, |answer| answer.cycles.len());
    let is_multiplied = calibration.scatter.is_some_and(|scatter| scatter.variance_factor > 1.0);
    let is_enlarged = is_multiplied || calibration.visit_noise.is_estimated();
    let why = match is_enlarged {
        true if drifts.iter().flatten().any(DriftTest::is_significant) => texts::TOO_SMALL_BY_TREND,
        true if turn_ons < 2 || is_multiplied => texts::TOO_SMALL_OR_TURN_ONS,
        _ => texts::TOO_SMALL,
    };
    calibration.fits_too_well().then_some(why)
}

/// The sentences on a reading that differs from the others, and at a terminal how to leave it out.
fn with_advice(suspect: &Suspect) -> Vec<Words> {
    let Suspect { i, j, cycle, visit, .. } = *suspect;
    let how = format!(
        "Look for the cause; if there is one, leave the visit out with --exclude {i},{j},{visit},{cycle} and --why."
    );
    let advice = Words::Either(Box::new("".into()), Box::new(how.into()));
    suspicion(suspect).into_iter().chain([advice]).collect()
}

/// The sentences on a reading that differs from the others.
pub(crate) fn suspicion(suspect: &Suspect) -> Vec<Words> {
    let difference_ua = suspect.difference_ma.map(|difference| 1000.0 * difference);
    let place = Number::place_of(difference_ua[0].abs().max(difference_ua[1].abs()));
    let [jx, jy] = difference_ua.map(|difference| Number::to_place(difference, place));
    let Suspect { cycle, visit, .. } = *suspect;
    let index = suspect.index();
    let what = match suspect.row {
        Some(row) => texts::suspect_row(row, visit, index, cycle, jx, jy),
        None => texts::suspect_visit(visit, index, cycle, jx, jy),
    };
    let several = suspect.one_of_several.then(|| texts::ONE_OF_SEVERAL.into());
    [what].into_iter().chain(several).collect()
}

/// The noise of the gyro that the uncertainties contain.
fn noise(each: [(Text, &DriftNoise); 2]) -> Block {
    let stated = each.into_iter().filter(|(_, noise)| noise.source != NoiseSource::NotStated);
    Block::Fields(
        stated
            .map(|(name, noise)| {
                let deg_per_h = Words::Quantity(Number::scientific(noise.deg_per_h, 2), units::DEG_PER_H);
                let source = match noise.source {
                    NoiseSource::Estimated => texts::noise_estimated(Number::fixed(noise.degrees_of_freedom, 0)),
                    _ => texts::NOISE_STATED.into(),
                };
                (name, vec![deg_per_h, " (".into(), source, ")".into()].into(), false)
            })
            .collect(),
    )
}

/// The comparison of an observed scatter with the stated uncertainty; `less` says what to check if it is smaller.
fn agreement(found: &Scatter, what: Text, less: Text) -> Vec<(Weight, Block)> {
    let weight = if found.agreement() == Agreement::AsStated { Usual } else { Remark };
    // A factor of 1 changes nothing.
    let factor = (found.variance_factor > 1.0).then(|| Number::significant(found.variance_factor, 2).into());
    let mut each = vec![
        (what, Number::chi_square(found.chi_square).into(), false),
        (texts::FREEDOM, found.degrees_of_freedom.into(), false),
        (texts::PROBABILITY, probability(found.probability), false),
    ];
    each.extend(factor.map(|factor| (texts::ENLARGED, factor, false)));
    let less = (found.agreement() == Agreement::Less).then_some(less);
    vec![(weight, Block::Fields(each)), (weight, say(less))]
}

fn residuals(result: &ResultDocument) -> Block {
    let residuals = &result.residuals_deg_per_h;
    let has_limits = |of: fn(&ResidualDocument) -> (f64, Option<f64>)| residuals.iter().any(|at| of(at).1.is_some());
    let mut rows = Rows::of(residuals, "numbers residuals").named(symbol("i"), |at| at.i).named(symbol("j"), |at| at.j);
    for (axis, of) in AXES {
        let bars = Bars::of(result);
        let (own, u) = (|| symbol(axis), || symbol(&format!("u_{axis}")));
        let limits = has_limits(of).then(|| Words::All(vec![own(), ", ±2".into(), u()]));
        rows = rows
            .column(in_unit(own(), units::DEG_PER_H), |at| Number::measured(of(at).0, of(at).1.unwrap_or(0.0)))
            .column(in_unit(u(), units::DEG_PER_H), |at| of(at).1.map(Number::uncertainty))
            .strips(
                limits.unwrap_or_else(own),
                |at| bars.bar(of(at)),
                move |languages| bars.axis(languages, Some(units::DEG_PER_H)),
            )
            .column(Words::All(vec![own(), "/".into(), u()]), |at| of(at).1.map(|u| Number::fixed(of(at).0 / u, 1)))
            .on(On::Terminal);
    }
    rows.table.starts = starts(residuals.iter().map(|at| at.i));
    rows.captioned(texts::RESIDUALS_CAPTION, texts::RESIDUALS_CAPTION)
}

/// The possible causes of readings that do not fit, a paragraph each.
pub(crate) fn what_may_be_wrong(hint: &Hint) -> Vec<Block> {
    let nothing =
        hint.explanations.is_empty().then(|| texts::hint_nothing(told(Number::significant(hint.size_arcsec, 2))));
    let other = hint.may_be_another_stand().then(|| texts::HINT_OTHER_STAND.into());
    nothing.into_iter().chain(hint.explanations.iter().map(explained)).chain(other).map(|words| say([words])).collect()
}

fn explained(explanation: &Explanation) -> Words {
    match explanation {
        Explanation::Exchanged(one, other) => texts::hint_exchanged(*one, *other),
        Explanation::Sign { index, axis } => texts::hint_sign(["J_x", "J_y"][*axis], *index),
        Explanation::ExchangedCurrents(index) => texts::hint_exchanged_currents(*index),
        Explanation::Renumbered { i, j } => texts::hint_renumbered(spaced(&numbering(i, j))),
        Explanation::OtherModel => texts::HINT_OTHER_MODEL.into(),
        Explanation::OtherAxis { frame_axis_azimuth_deg } => texts::hint_other_axis(told(*frame_axis_azimuth_deg)),
        Explanation::DidNotRepeat { index, angle_arcsec, current_ua } => {
            let angle = if *angle_arcsec > LARGEST_IN_ARCSEC {
                Number::angle(*angle_arcsec, WHOLE_ARCSECONDS)
            } else {
                Number::significant(*angle_arcsec, 2)
            };
            let place = Number::place_of(current_ua.amax());
            let [jx, jy] = [current_ua.x, current_ua.y].map(|error| Number::to_place(error, place));
            texts::hint_did_not_repeat(*index, told(angle), told(jx), told(jy))
        }
    }
}

/// The name of an input without a stated uncertainty.
pub(crate) fn not_stated(what: NotStated) -> Text {
    match what {
        NotStated::Angles => names::ANGLE,
        NotStated::SomeAngles => texts::NOT_STATED_SOME_ANGLES,
        NotStated::Return => names::RETURN,
        NotStated::Platform => texts::NOT_STATED_PLATFORM,
        NotStated::Base => texts::NOT_STATED_BASE,
        NotStated::Latitude => names::LATITUDE,
        NotStated::Deflection => names::DEFLECTION,
        NotStated::Azimuth => names::AZIMUTH,
        NotStated::Mark => names::MARK,
        NotStated::Level => texts::NOT_STATED_LEVEL,
        NotStated::Seat => texts::NOT_STATED_SEAT,
        NotStated::Gain => texts::NOT_STATED_GAIN,
        NotStated::Offset => texts::NOT_STATED_OFFSET,
        NotStated::Visits => texts::NOT_STATED_VISITS,
        NotStated::TurnOns => texts::NOT_STATED_TURN_ONS,
        NotStated::Gravity => texts::NOT_STATED_GRAVITY,
    }
}
