//! Expected calibration uncertainty, and inputs that the passport does not state.

use super::PassportPage;
use super::numbers::{numbers_of, parameters};
use crate::calibration::parameter::Parameter;
use crate::laboratory::Laboratory;
use crate::passport::accuracy::Accuracy;
use crate::passport::annotations::{Absence, absent};
use crate::report::page::language::{Language, Languages, Text};
use crate::report::page::number::{Cell, Number};
use crate::report::page::parts::{fields, figure, given, heading, listed, quantity, stated, symbol, wide_stated};
use crate::report::page::texts::{absences, passport as texts, units};
use crate::report::picture::accuracy::accuracy as picture;
use crate::site::{LATITUDE_MARGIN_ARCSEC, UNKNOWN_DEFLECTION_U_ARCSEC};
use crate::wording::Value;
use maud::{Markup, html};

/// Decrease of normal gravity per metre of height, in m/s² per metre (free air), as in the signed comments.
const GRAVITY_SLOPE_M_PER_S2_PER_M: f64 = 3.1e-6;

pub(crate) fn section(page: &PassportPage, languages: &Languages) -> Markup {
    let content = &page.content;
    html! {
        @match &content.accuracy {
            Some(accuracy) => {
                (stated_for(accuracy, languages))
                (uncertainties(accuracy, languages))
                (figure(languages, "tolerance", &picture(languages, accuracy, content.earth.gravity_m_per_s2), texts::FIGURE_ACCURACY))
            }
            None => (languages.paragraph(texts::ACCURACY_NONE)),
        }
        (heading(languages, texts::ABSENCES))
        (not_stated(page, languages))
    }
}

fn stated_for(accuracy: &Accuracy, languages: &Languages) -> Markup {
    let (gyro, laboratory) = (&accuracy.gyro, &accuracy.laboratory);
    let gravity = Some(quantity(languages, &Number::exact(gyro.gravity()), units::M_PER_S2));
    let temperature = laboratory.temperature_c.map(|t| quantity(languages, &Number::exact(t), units::CELSIUS));
    let each = [
        (texts::GYRO_TYPE, Some(given(&gyro.r#type))),
        (texts::GYRO_GRAVITY, gravity),
        (texts::CALIBRATING_LABORATORY, laboratory.name.as_deref().map(given)),
        (texts::LABORATORY_TEMPERATURE, temperature),
    ];
    let each = each.into_iter().chain(angles(laboratory, languages));
    let meter = wide_stated(languages, texts::METER, Some(meter(laboratory, languages)));
    fields(each.map(|(name, value)| stated(languages, name, value)).chain([meter]))
}

/// Returns the standard uncertainties of the angles of gyro and base in a laboratory, as far as they are stated.
pub(crate) fn angles(laboratory: &Laboratory, languages: &Languages) -> [(Text, Option<Markup>); 3] {
    let arcsec = |u: f64| quantity(languages, &Number::exact(u), units::ARCSEC);
    let seat = laboratory.seating_arcsec.as_ref();
    let seat =
        seat.map(|seat| html! { (arcsec(seat.about_x)) ", " (arcsec(seat.about_y)) ", " (arcsec(seat.about_z)) });
    let base = laboratory.base.as_ref();
    [
        (texts::SEATING, seat),
        (texts::BASE_AZIMUTH_U, base.and_then(|base| base.azimuth_arcsec).map(arcsec)),
        (texts::BASE_LEVEL_U, base.and_then(|base| base.level_arcsec).map(arcsec)),
    ]
}

/// Writes one sentence about the current meter.
pub(crate) fn meter(laboratory: &Laboratory, languages: &Languages) -> Markup {
    let meter = &laboratory.meter;
    let parts = [
        (texts::METER_READING, meter.reading_percent),
        (texts::METER_GAIN, meter.gain_percent),
        (texts::METER_OFFSET, meter.offset_ma),
        (texts::METER_FLOOR, meter.floor_ma),
        (texts::METER_NOISE, meter.noise_ma.unwrap_or(0.0)),
        (texts::METER_RANGE, meter.range_ma),
    ];
    // A part that is 0 may not have been stated, and no instrument has it.
    let stated = || parts.into_iter().filter(|(_, value)| *value > 0.0);
    let words = |text: Text, value: f64, language| text.with_numbers(language, &[("n", Number::exact(value))]);
    html! {
        @for (index, language) in languages.iter().enumerate() {
            @if index > 0 { br; }
            span lang=(language.tag()) { (listed(stated().map(|(text, value)| words(text, value, language)))) }
        }
    }
}

fn uncertainties(accuracy: &Accuracy, languages: &Languages) -> Markup {
    let tolerance = &accuracy.gyro.tolerance;
    let limits = Parameter::AS_IN_THE_PAPER.map(|parameter| {
        let limit = Number::exact(tolerance.of(parameter));
        match tolerance.is_in_percent(parameter) {
            true => Cell::WithUnit(limit, languages.inline(units::PERCENT)),
            false => Cell::Number(limit),
        }
    });
    let nominal = numbers_of(&accuracy.gyro.nominal).map(|value| Cell::Number(Number::exact(value)));
    let us = numbers_of(&accuracy.standard_uncertainty).map(|u| Cell::Number(Number::uncertainty(u)));
    let rows = vec![
        (languages.label(texts::NOMINAL), nominal),
        (symbol("u", ""), us),
        (languages.label(texts::TOLERANCE), limits),
    ];
    parameters(languages, rows).captioned(languages, texts::ACCURACY_CAPTION)
}

fn not_stated(page: &PassportPage, languages: &Languages) -> Markup {
    let absent = absent(&page.content);
    if absent.is_empty() {
        return languages.paragraph(texts::ABSENCES_NONE);
    }
    let sentences = absent.into_iter().map(sentence);
    html! {
        ul.absences {
            @for (text, numbers) in sentences { li { (languages.paragraph_with(|language| text.with_numbers(language, &numbers))) } }
        }
    }
}

/// Returns what is missing as a sentence of plain text.
pub(crate) fn plain(absence: Absence, language: Language) -> String {
    let (text, numbers) = sentence(absence);
    let values: Vec<(&str, &dyn Value)> = numbers.iter().map(|(name, number)| (*name, number as &dyn Value)).collect();
    text.filled(language, &values)
}

/// Returns the sentence on what is missing, and its numbers.
fn sentence(absence: Absence) -> (Text, Vec<(&'static str, Number)>) {
    match absence {
        Absence::Uncertainty => (absences::UNCERTAINTY, vec![]),
        Absence::SomeUncertainty { missing, all } => (
            absences::SOME_UNCERTAINTY,
            vec![("missing", Number::exact(missing as f64)), ("all", Number::exact(all as f64))],
        ),
        Absence::Repeatability => (absences::REPEATABILITY, vec![]),
        Absence::CommonPart => (absences::COMMON_PART, vec![]),
        Absence::Traceability => (absences::TRACEABILITY, vec![]),
        Absence::Temperature => (absences::TEMPERATURE, vec![]),
        Absence::LastDay => (absences::LAST_DAY, vec![]),
        Absence::Datum => (absences::DATUM, vec![]),
        Absence::EightPositions => (absences::EIGHT_POSITIONS, vec![]),
        Absence::Deflection { cost_deg_per_h } => {
            let (u, cost) = (Number::exact(UNKNOWN_DEFLECTION_U_ARCSEC), Number::uncertainty(cost_deg_per_h));
            (absences::DEFLECTION, vec![("u", u), ("cost", cost)])
        }
        Absence::Longitude => (absences::LONGITUDE, vec![]),
        Absence::GeodeticLatitude => {
            (absences::GEODETIC_LATITUDE, vec![("margin", Number::exact(LATITUDE_MARGIN_ARCSEC))])
        }
        Absence::Height => (absences::HEIGHT, vec![("slope", Number::exact(GRAVITY_SLOPE_M_PER_S2_PER_M))]),
        Absence::BaseUncertainty => (absences::BASE_UNCERTAINTY, vec![]),
        Absence::LatitudeUncertainty => (absences::LATITUDE_UNCERTAINTY, vec![]),
        Absence::AzimuthUncertainty => (absences::AZIMUTH_UNCERTAINTY, vec![]),
        Absence::LevelUncertainty => (absences::LEVEL_UNCERTAINTY, vec![]),
        Absence::AzimuthMark => (absences::AZIMUTH_MARK, vec![]),
    }
}
