//! Agreement of the readings with the fit, possible causes of disagreement, and errors that the residuals do not show.

use super::Report;
use crate::calibration::chi_square::FEW_DEGREES;
use crate::calibration::diagnosis::{ALARM, Explanation, Hint, numbering};
use crate::calibration::document::{ResidualDocument, ResultDocument};
use crate::calibration::remarks::{Weight, correlated, scatter};
use crate::calibration::result::DriftTest;
use crate::calibration::{Calibration, NotStated};
use crate::report::doc::{
    Block, On, Rows, Statement, Words, drawn, fields, in_unit, joined, probability, say, symbol, told,
};
use crate::report::page::language::Text;
use crate::report::page::number::{LARGEST_IN_ARCSEC, Number};
use crate::report::page::parts::starts;
use crate::report::picture::residuals::{AXES, Bars, key};
use crate::wording::spacing::spaced;
use crate::wording::texts::causes as names;
use crate::wording::texts::{calibration as texts, units};

/// Uncertainty with which an angle is printed in whole arcseconds.
const WHOLE_ARCSECONDS: f64 = 10.0;

pub(super) fn section(of: &Report) -> Vec<Block> {
    let Some(result) = of.adopted() else { return Vec::new() };
    let calibration = of.calibration;
    if result.chi_square.degrees_of_freedom == 0 {
        let scatter = scatter(calibration).into_iter().map(|(_, statement)| statement.into());
        return [say([texts::NOT_JUDGED])].into_iter().chain(scatter).collect();
    }
    let answer = calibration.adopted();
    let changed = answer.is_some_and(|found| found.chi_square.is_changed_by_estimates());
    let mut doc = vec![chi_square(result), say(changed.then_some(texts::OF_ESTIMATES)), say(too_small(calibration))];
    doc.extend(scatter(calibration).into_iter().map(|(_, statement)| statement.into()));
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
    let notable = scatter(of.calibration).into_iter().filter(|(weight, _)| *weight == Weight::Remark);
    doc.extend(notable.map(|(_, statement)| statement.into()));
    doc.extend(of.calibration.hint.as_ref().map(|_| residuals(result)));
    doc
}

/// Warnings about the scatter of the readings.
pub(super) fn warnings(calibration: &Calibration) -> Vec<Words> {
    let all = [(Weight::Warning, correlated(calibration))].into_iter().chain(scatter(calibration));
    let all = all.filter(|(weight, _)| *weight == Weight::Warning);
    let sentences = all.filter_map(|(_, statement)| match statement {
        Statement::Sentences(all) if !all.is_empty() => Some(joined(all, " ")),
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
    fields(each)
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
