//! Agreement of the readings with the fit, possible causes of disagreement, and errors that the residuals do not show.

use super::Report;
use crate::calibration::chi_square::{ALARM, FEW_DEGREES};
use crate::calibration::document::{ResidualDocument, ResultDocument};
use crate::calibration::remarks::{Weight, scatter};
use crate::calibration::{Calibration, Finding, NotStated};
use crate::report::doc::{Block, On, Rows, Words, either, fields, in_unit, joined, probability, say, symbol};
use crate::report::picture::strips::{AXES, Residuals};
use crate::wording::texts::{calibration as texts, finding as words, pictures, units};
use crate::wording::{Number, Text};

/// A brief section has what is notable about the fit, and the residuals of readings that do not fit.
pub(super) fn section(of: &Report, is_brief: bool) -> Vec<Block> {
    let Some(result) = of.adopted() else { return Vec::new() };
    let calibration = of.calibration;
    let scatter = scatter(calibration).into_iter().filter(|(weight, _)| !is_brief || *weight == Weight::Remark);
    let scatter = scatter.map(|(_, statement)| statement.into());
    if result.chi_square.degrees_of_freedom == 0 {
        return [say([texts::NOT_JUDGED])].into_iter().chain(scatter).collect();
    }
    let mut doc: Vec<Block> = [chi_square(result)].into_iter().chain(scatter).collect();
    if !is_brief {
        let changed = calibration.adopted().is_some_and(|found| found.chi_square.is_changed_by_estimates());
        doc.insert(1, say(changed.then_some(texts::OF_ESTIMATES)));
        doc.extend((!calibration.is_invalid()).then(|| causes(calibration)).into_iter().flatten());
        doc.push(say(super::methods::agreement(of)));
    }
    if of.details || !calibration.consistent {
        let key = Residuals::key(pictures::RESIDUAL, pictures::RESIDUAL_LIMITS);
        doc.extend([residuals(result), Block::Key(key)]);
    }
    doc
}

/// The causes that explain the readings or the parameters, a paragraph each; at a terminal with how to leave a visit out.
pub(crate) fn causes(calibration: &Calibration) -> Vec<Block> {
    let several = calibration.is_invalid() && calibration.causes.len() > 1;
    let each = calibration.causes.iter().map(|cause| say([cause.said()].into_iter().chain(advice(cause))));
    several.then(|| say([words::POSSIBLE])).into_iter().chain(each).collect()
}

/// How to leave out a visit that is suspect, at a terminal only.
fn advice(cause: &Finding) -> Option<Words> {
    let scope = cause.scope.index().filter(|_| cause.is_reading()).zip(cause.scope.visit).zip(cause.scope.cycle);
    scope.map(|((index, visit), cycle)| {
        let how = format!("Option: --exclude {},{},{visit},{cycle} and --why.", index.i, index.j);
        either("", how)
    })
}

/// Causes that make a result doubtful, not invalid.
pub(super) fn warnings(calibration: &Calibration) -> Vec<Words> {
    let all = calibration.causes.iter().filter(|cause| !cause.invalidates());
    all.map(|cause| joined([cause.said()].into_iter().chain(advice(cause)), " ")).collect()
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

fn residuals(result: &ResultDocument) -> Block {
    let residuals = &result.residuals_deg_per_h;
    let has_limits = |of: fn(&ResidualDocument) -> (f64, Option<f64>)| residuals.iter().any(|at| of(at).1.is_some());
    let mut rows = Rows::of(residuals, "numbers residuals").named(symbol("i"), |at| at.i).named(symbol("j"), |at| at.j);
    for (axis, of) in AXES {
        let bars = Residuals::of(result);
        let (own, u) = (|| symbol(axis), || symbol(&format!("u_{axis}")));
        let limits = has_limits(of).then(|| Words::All(vec![own(), ", ±2".into(), u()]));
        rows = rows
            .column(in_unit(own(), units::DEG_PER_H), |at| Number::measured(of(at).0, of(at).1.unwrap_or(0.0)))
            .column(in_unit(u(), units::DEG_PER_H), |at| of(at).1.map(Number::uncertainty))
            .strips(limits.unwrap_or_else(own), |at| bars.bar(of(at)), bars.axis(Some(units::DEG_PER_H)))
            .column(Words::All(vec![own(), "/".into(), u()]), |at| of(at).1.map(|u| Number::fixed(of(at).0 / u, 1)))
            .on(On::Terminal);
    }
    rows.grouped_by(|at| at.i).captioned(texts::RESIDUALS_CAPTION, texts::RESIDUALS_CAPTION)
}

/// The name of an input without a stated uncertainty.
pub(crate) fn not_stated(what: NotStated) -> Text {
    texts::not_stated!(NotStated, what)
}
