//! Agreement of the readings with the fit, possible causes of disagreement, and errors that the residuals do not show.

use super::CalibrationPage;
use crate::calibration::Calibration;
use crate::calibration::causes::names;
use crate::calibration::chi_square::FEW_DEGREES;
use crate::calibration::diagnosis::{ALARM, Explanation, Hint, numbering};
use crate::calibration::document::{ResidualDocument, ResultDocument};
use crate::calibration::noise::NoiseSource;
use crate::calibration::scatter::{Agreement, Scatter};
use crate::calibration::stated::NotStated;
use crate::calibration::suspect::Suspect;
use crate::report::page::language::{Language, Languages, Text, values};
use crate::report::page::number::{LARGEST_IN_ARCSEC, Number, column, probability};
use crate::report::page::parts::{Column, Table, field, fields, quantity, starts, symbol, symbol_and_unit};
use crate::report::page::symbols::italic;
use crate::report::page::texts::{calibration as texts, units};
use crate::report::picture::residuals::{AXES, Bars, key};
use crate::report::recorded;
use crate::report::scatter::{drift, too_small};
use crate::wording::spacing::spaced;
use maud::{Markup, html};

/// Uncertainty with which an angle is printed in whole arcseconds.
const WHOLE_ARCSECONDS: f64 = 10.0;

pub(super) fn section(page: &CalibrationPage, languages: &Languages) -> Markup {
    html! {
        @if let Some(result) = page.adopted() {
            @if result.chi_square.degrees_of_freedom == 0 {
                (languages.paragraph(texts::NOT_JUDGED))
                (scatter(page, languages))
            } @else {
                (chi_square(result, languages))
                @if page.calibration.adopted().is_some_and(|found| found.chi_square.is_changed_by_estimates()) {
                    (languages.paragraph(texts::OF_ESTIMATES))
                }
                @if let Some(why) = too_small(page.calibration) { (languages.paragraph(why)) }
                (scatter(page, languages))
                (table(result, languages))
                (key(languages))
            }
        }
    }
}

/// Writes which errors the residuals do not show.
pub(super) fn blind(page: &CalibrationPage, languages: &Languages) -> Markup {
    html! {
        (languages.paragraph(texts::CANNOT_TELL))
        @if page.missing.is_empty() {
            (languages.paragraph(texts::ALL_STATED))
        } @else {
            (languages.paragraph(texts::NOT_STATED))
            ul.absences { @for what in page.missing { li { (languages.label(not_stated(*what))) } } }
        }
    }
}

fn whole(count: usize) -> Markup {
    html! { data value=(count) { (count) } }
}

fn chi_square(result: &ResultDocument, languages: &Languages) -> Markup {
    let found = &result.chi_square;
    let value = Number::chi_square(found.value).markup(languages);
    let mut each = vec![
        field(languages, texts::CHI_SQUARE, Some(value)),
        field(languages, texts::FREEDOM, Some(whole(found.degrees_of_freedom))),
        field(
            languages,
            texts::PROBABILITY,
            found.probability.map(|p| {
                let limit = |language| texts::CONSISTENT.filled(language, values! { limit: Number::exact(ALARM) });
                html! { (probability(languages, p)) " (" (languages.inline_with(limit)) ")" }
            }),
        ),
    ];
    if let Some(of_uncertainties) = found.uncertainty_degrees_of_freedom.filter(|known| *known < FEW_DEGREES) {
        let value = Number::fixed(of_uncertainties, 0).markup(languages);
        each.push(field(languages, texts::OF_UNCERTAINTIES, Some(value)));
    }
    fields(each)
}

fn scatter(page: &CalibrationPage, languages: &Languages) -> Markup {
    let calibration = page.calibration;
    html! {
        @if let Some(digits) = &calibration.digits {
            (languages.paragraph_with(|language| html! { (recorded::words(digits, language).join(" ")) }))
        }
        @if let Some(rows) = &calibration.row_scatter {
            @if let Some(stated) = &rows.against_stated { (agreement(stated, texts::ROW_SCATTER, languages)) }
            @else {
                @let s = quantity(languages, &Number::scientific(rows.standard_deviation_ma, 2), units::MILLIAMPERES);
                (fields([
                    field(languages, texts::ROW_DEVIATION, Some(s)),
                    field(languages, texts::FREEDOM, Some(whole(rows.degrees_of_freedom))),
                ]))
            }
        }
        @if let Some(r) = calibration.row_correlation {
            (languages.paragraph_with(|language| texts::ROWS_CORRELATED.with_numbers(language, &[("r", Number::fixed(r, 2))])))
        }
        @if let Some(visits) = &calibration.scatter {
            (agreement(visits, texts::SCATTER, languages))
            @if visits.agreement() == Agreement::More && calibration.visit_noise.source == NoiseSource::Estimated {
                (languages.paragraph(texts::NOISE_ADDED))
            }
        }
        @if let Some(turn_ons) = &calibration.turn_on_scatter {
            (agreement(turn_ons, texts::TURN_ON_SCATTER, languages))
        }
        @for suspect in &calibration.suspects {
            (languages.paragraph_with(|language| html! { (suspicion(suspect, language)) }))
        }
        (noise(calibration, languages))
        @for (text, test) in [(texts::DRIFTS, calibration.drift_test), (texts::DRIFTS_IN_ORDER, calibration.drift_in_order)] {
            @if let Some(test) = test.filter(|test| test.is_significant()) {
                (languages.paragraph_with(|language| italic(&drift(text, &test, language))))
            }
        }
        @if calibration.drift_or_noise { (languages.paragraph(texts::DRIFT_OR_NOISE)) }
    }
}

/// Returns the sentences on a reading that differs from the others.
pub(crate) fn suspicion(suspect: &Suspect, language: Language) -> String {
    let difference_ua = suspect.difference_ma.map(|difference| 1000.0 * difference);
    let place = Number::place_of(difference_ua[0].abs().max(difference_ua[1].abs()));
    let [jx, jy] = difference_ua.map(|difference| Number::to_place(difference, place));
    let Suspect { cycle, visit, .. } = *suspect;
    let (index, row) = (suspect.index(), suspect.row.unwrap_or(0));
    let text = if suspect.row.is_some() { texts::SUSPECT_ROW } else { texts::SUSPECT_VISIT };
    let words = text.filled(language, values! { row, visit, cycle, index, jx, jy });
    match suspect.one_of_several {
        true => format!("{words} {}", texts::ONE_OF_SEVERAL.words(language)),
        false => words,
    }
}

/// Writes the noise of the gyro that the uncertainties contain.
fn noise(calibration: &Calibration, languages: &Languages) -> Markup {
    let each = [(texts::VISIT_NOISE, &calibration.visit_noise), (texts::TURN_ON_NOISE, &calibration.turn_on_noise)];
    fields(each.into_iter().filter(|(_, noise)| noise.source != NoiseSource::NotStated).map(|(name, noise)| {
        let estimated = noise.source == NoiseSource::Estimated;
        let value = html! {
            (quantity(languages, &Number::scientific(noise.deg_per_h, 2), units::DEG_PER_H)) " ("
            (languages.label_with(|language| {
                let text = if estimated { texts::NOISE_ESTIMATED } else { texts::NOISE_STATED };
                text.filled(language, values! { known: Number::fixed(noise.degrees_of_freedom, 0) })
            }))
            ")"
        };
        field(languages, name, Some(value))
    }))
}

/// Writes the comparison of an observed scatter with the stated uncertainty.
fn agreement(found: &Scatter, what: Text, languages: &Languages) -> Markup {
    // A factor of 1 changes nothing.
    let factor = (found.variance_factor > 1.0).then(|| Number::significant(found.variance_factor, 2).markup(languages));
    html! {
        (fields([
            field(languages, what, Some(Number::chi_square(found.chi_square).markup(languages))),
            field(languages, texts::FREEDOM, Some(whole(found.degrees_of_freedom))),
            field(languages, texts::PROBABILITY, Some(probability(languages, found.probability))),
            factor.map(|factor| field(languages, texts::ENLARGED, Some(factor))).unwrap_or_default(),
        ]))
        @if found.agreement() == Agreement::Less { (languages.paragraph(texts::LESS_THAN_STATED)) }
    }
}

fn table(result: &ResultDocument, languages: &Languages) -> Markup {
    let residuals = &result.residuals_deg_per_h;
    let bars = Bars::of(result);
    let columns = AXES.into_iter().flat_map(|(axis, of)| {
        let value = |at: &ResidualDocument| Number::measured(of(at).0, of(at).1.unwrap_or(0.0));
        let u = |at: &ResidualDocument| of(at).1.map(Number::uncertainty);
        let heading = |symbol: Markup| symbol_and_unit(languages, &symbol, units::DEG_PER_H);
        let cells = residuals.iter().map(|at| bars.bar(of(at))).collect();
        let has_limits = residuals.iter().any(|at| of(at).1.is_some());
        let drawn = html! { (symbol(axis, "")) @if has_limits { ", ±2" (symbol("u", axis)) } };
        [
            Column::new(heading(symbol(axis, "")), column(languages, residuals.iter().map(value))),
            Column::new(heading(symbol("u", axis)), column(languages, residuals.iter().map(u))),
            Column { heading: drawn, cells, foot: bars.axis(languages, Some(units::DEG_PER_H)) },
        ]
    });
    let names = residuals.iter().map(|at| vec![html! { (at.i) }, html! { (at.j) }]).collect();
    let table = Table {
        starts: starts(residuals.iter().map(|at| at.i)),
        class: "numbers residuals",
        ..Table::of(vec![symbol("i", ""), symbol("j", "")], names, &columns.collect::<Vec<_>>())
    };
    table.captioned(languages, texts::RESIDUALS_CAPTION)
}

/// Writes the possible causes of readings that do not fit.
pub(super) fn what_may_be_wrong(hint: &Hint, languages: &Languages) -> Markup {
    html! {
        @if hint.explanations.is_empty() {
            (languages.paragraph_with(|language| {
                italic(&texts::HINT_NOTHING.filled(language, values! { size: Number::significant(hint.size_arcsec, 2) }))
            }))
        }
        @for explanation in &hint.explanations {
            (languages.paragraph_with(|language| italic(&explained(explanation, language))))
        }
        @if hint.may_be_another_stand() { (languages.paragraph_with(|language| italic(&texts::HINT_OTHER_STAND.words(language)))) }
    }
}

fn explained(explanation: &Explanation, language: Language) -> String {
    match explanation {
        Explanation::Exchanged(one, other) => texts::HINT_EXCHANGED.filled(language, values! { one, other }),
        Explanation::Sign { index, axis } => {
            texts::HINT_SIGN.filled(language, values! { index, current: ["J_x", "J_y"][*axis] })
        }
        Explanation::ExchangedCurrents(index) => texts::HINT_EXCHANGED_CURRENTS.filled(language, values! { index }),
        Explanation::Renumbered { i, j } => {
            texts::HINT_RENUMBERED.filled(language, values! { numbers: spaced(&numbering(i, j)) })
        }
        Explanation::OtherModel => texts::HINT_OTHER_MODEL.words(language),
        Explanation::OtherAxis { frame_axis_azimuth_deg } => {
            texts::HINT_OTHER_AXIS.filled(language, &[("azimuth", frame_axis_azimuth_deg)])
        }
        Explanation::DidNotRepeat { index, angle_arcsec, current_ua } => {
            let angle = if *angle_arcsec > LARGEST_IN_ARCSEC {
                Number::angle(*angle_arcsec, WHOLE_ARCSECONDS)
            } else {
                Number::significant(*angle_arcsec, 2)
            };
            let place = Number::place_of(current_ua.amax());
            let [jx, jy] = [current_ua.x, current_ua.y].map(|error| Number::to_place(error, place));
            texts::HINT_DID_NOT_REPEAT.filled(language, values! { index, angle, jx, jy })
        }
    }
}

/// Returns the name of an input without a stated uncertainty.
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
