//! Expected calibration uncertainty, and inputs that the passport does not state.

use super::numbers::numbers_of;
use crate::calibration::parameter::{Parameter, unit};
use crate::laboratory::Laboratory;
use crate::passport::Content;
use crate::passport::accuracy::Accuracy;
use crate::passport::annotations::{Absence, absent};
use crate::report::doc::{
    Block, Field, On, Rows, Words, field, given, heading, in_unit, listed, record, say, symbol, wide,
};
use crate::report::picture::strips::Accuracies;
use crate::site::{LATITUDE_MARGIN_ARCSEC, UNKNOWN_DEFLECTION_U_ARCSEC};
use crate::wording::Number;
use crate::wording::texts::{absences, passport as texts, units};

/// Decrease of normal gravity per metre of height, in m/s² per metre (free air), as in the signed comments.
const GRAVITY_SLOPE_M_PER_S2_PER_M: f64 = 3.1e-6;

pub(super) fn section(content: &Content) -> Vec<Block> {
    let mut doc = match &content.accuracy {
        Some(accuracy) => {
            let mut doc = vec![stated_for(accuracy)];
            doc.extend(uncertainties(accuracy, content.earth.gravity_m_per_s2));
            doc.push(say(own_uncertainty_of_gravity(content, accuracy)).only(On::Terminal));
            doc
        }
        None => vec![say([texts::ACCURACY_NONE])],
    };
    doc.push(heading(texts::ABSENCES));
    doc.extend(not_stated(content));
    doc
}

fn stated_for(accuracy: &Accuracy) -> Block {
    let (gyro, laboratory) = (&accuracy.gyro, &accuracy.laboratory);
    let exactly = |value, unit| Words::Quantity(Number::exact(value), unit);
    let each = [
        field(texts::GYRO_TYPE, Some(given(&gyro.r#type))),
        field(texts::GYRO_GRAVITY, Some(exactly(gyro.gravity(), units::M_PER_S2))),
        field(texts::CALIBRATING_LABORATORY, laboratory.name.as_ref().map(given)),
        field(texts::LABORATORY_TEMPERATURE, laboratory.temperature_c.map(|t| exactly(t, units::CELSIUS))),
    ];
    record(each.into_iter().chain(angles(laboratory)).chain([wide(texts::METER, Some(meter(laboratory)))]))
}

/// The standard uncertainties of the angles of gyro and base in a laboratory, as far as they are stated.
pub(crate) fn angles(laboratory: &Laboratory) -> [Option<Field>; 3] {
    let arcsec = |u: f64| Words::Quantity(Number::exact(u), units::ARCSEC);
    let seat = laboratory.seating_arcsec.as_ref();
    let base = laboratory.base.as_ref();
    [
        field(texts::SEATING, seat.map(|seat| listed([seat.about_x, seat.about_y, seat.about_z].map(arcsec)))),
        field(texts::BASE_AZIMUTH_U, base.and_then(|base| base.azimuth_arcsec).map(arcsec)),
        field(texts::BASE_LEVEL_U, base.and_then(|base| base.level_arcsec).map(arcsec)),
    ]
}

/// The current meter.
pub(crate) fn meter(laboratory: &Laboratory) -> Words {
    let meter = &laboratory.meter;
    let parts = [
        (texts::meter_reading as fn(Number) -> Words, meter.reading_percent),
        (texts::meter_gain, meter.gain_percent),
        (texts::meter_offset, meter.offset_ma),
        (texts::meter_floor, meter.floor_ma),
        (texts::meter_noise, meter.noise_ma.unwrap_or(0.0)),
        (texts::meter_range, meter.range_ma),
    ];
    // A part that is 0 may not have been stated, and no instrument has it.
    let stated = parts.into_iter().filter(|(_, value)| *value > 0.0);
    texts::meter_parts(listed(stated.map(|(text, value)| text(Number::exact(value)))))
}

fn uncertainties(accuracy: &Accuracy, gravity_m_per_s2: f64) -> Vec<Block> {
    let (nominal, us) = (numbers_of(&accuracy.gyro.nominal), numbers_of(&accuracy.standard_uncertainty));
    let (tolerance, shares) = (&accuracy.gyro.tolerance, Accuracies::of(accuracy, gravity_m_per_s2));
    let rows: Vec<(usize, Parameter)> = Parameter::AS_IN_THE_PAPER.into_iter().enumerate().collect();
    let percent = |(place, parameter): &(usize, Parameter)| {
        let percent = 100.0 * us[*place] / nominal[*place].abs();
        (parameter.is_scale_factor() && percent.is_finite()).then(|| Number::uncertainty(percent))
    };
    let table = Rows::of(&rows, "numbers shares-of-tolerance")
        .named(texts::PARAMETER, |(_, parameter)| in_unit(symbol(parameter.symbol()), unit(*parameter)))
        .column(texts::NOMINAL, |(place, _)| Number::exact(nominal[*place]))
        .column(symbol("u"), |(place, _)| Number::uncertainty(us[*place]))
        .column(in_unit(symbol("u"), units::PERCENT), percent)
        .on(On::Terminal)
        .column(texts::TOLERANCE, |(_, parameter)| {
            let is_in_percent = tolerance.is_in_percent(*parameter);
            let unit = if is_in_percent { units::PERCENT } else { unit(*parameter) };
            Words::Quantity(Number::exact(tolerance.of(*parameter)), unit)
        })
        .strips(texts::SHARES, |(place, _)| shares.strip(*place), shares.axis());
    let caption = texts::ACCURACY_CAPTION;
    vec![table.captioned(caption, caption), Block::Key(Accuracies::key())]
}

/// What the local g adds to a comparison of the drifts with their tolerances, at the g of the type.
fn own_uncertainty_of_gravity(content: &Content, accuracy: &Accuracy) -> Option<Words> {
    let (gravity, gyro) = (content.earth.gravity_m_per_s2, &accuracy.gyro);
    let u_gravity = content.site.gravity_u_m_per_s2().filter(|_| gravity != gyro.gravity())?;
    let nominal = gyro.nominal.to_model().to_vector();
    let [of_g, of_k] = [Parameter::OmegaG, Parameter::OmegaK].map(|parameter| {
        let u = nominal[parameter.place()].abs() * u_gravity / gravity;
        Words::Quantity(Number::uncertainty(u), units::DEG_PER_H_PER_G)
    });
    Some(texts::gravity_of_drifts(of_g, of_k))
}

fn not_stated(content: &Content) -> Vec<Block> {
    let absent: Vec<Words> = absent(content).into_iter().map(sentence).collect();
    if absent.is_empty() {
        return vec![say([texts::ABSENCES_NONE])];
    }
    let each = absent.iter().map(|words| say([words.clone()]).only(On::Terminal));
    each.chain([Block::List(absent.clone()).only(On::Page)]).collect()
}

/// Returns the sentence on what is missing.
pub(crate) fn sentence(absence: Absence) -> Words {
    match absence {
        Absence::Uncertainty => absences::UNCERTAINTY.into(),
        Absence::SomeUncertainty { missing, all } => absences::some_uncertainty(missing, all),
        Absence::Repeatability => absences::REPEATABILITY.into(),
        Absence::CommonPart => absences::COMMON_PART.into(),
        Absence::Traceability => absences::TRACEABILITY.into(),
        Absence::Temperature => absences::TEMPERATURE.into(),
        Absence::LastDay => absences::LAST_DAY.into(),
        Absence::Datum => absences::DATUM.into(),
        Absence::EightPositions => absences::EIGHT_POSITIONS.into(),
        Absence::Deflection { cost_deg_per_h } => {
            let (u, cost) = (Number::exact(UNKNOWN_DEFLECTION_U_ARCSEC), Number::uncertainty(cost_deg_per_h));
            absences::deflection(u, cost)
        }
        Absence::Longitude => absences::LONGITUDE.into(),
        Absence::GeodeticLatitude => absences::geodetic_latitude(Number::exact(LATITUDE_MARGIN_ARCSEC)),
        Absence::Height => absences::height(Number::exact(GRAVITY_SLOPE_M_PER_S2_PER_M)),
        Absence::BaseUncertainty => absences::BASE_UNCERTAINTY.into(),
        Absence::LatitudeUncertainty => absences::LATITUDE_UNCERTAINTY.into(),
        Absence::AzimuthUncertainty => absences::AZIMUTH_UNCERTAINTY.into(),
        Absence::LevelUncertainty => absences::LEVEL_UNCERTAINTY.into(),
        Absence::AzimuthMark => absences::AZIMUTH_MARK.into(),
    }
}
