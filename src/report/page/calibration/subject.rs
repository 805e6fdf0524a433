//! Object of the calibration: gyro, stand, passport and readings.

use super::{CalibrationPage, UsedPassport};
use crate::calibration::stated::{TemperatureOutside, temperature_c};
use crate::laboratory::Laboratory;
use crate::report::calibration::temperature_outside;
use crate::report::doc::{
    Block, Words, blank, code, field, given, heading, marked, note, outcome_box, record, say, stated, told, wide,
};
use crate::report::page::parts::file_name;
use crate::report::page::passport::checks;
use crate::report::page::passport::checks::withdrawal_not_checked;
use crate::report::passport::{accuracy, site};
use crate::wording::texts::{calibration as texts, passport as passport_texts, record as forms, units};
use crate::wording::{Number, Outcome};

pub(super) fn section(page: &CalibrationPage) -> Vec<Block> {
    let (of_passport, of_laboratory) = (heading(texts::PASSPORT), heading(passport_texts::LABORATORY));
    [vec![gyro(page), of_passport], passport(page), vec![of_laboratory], laboratory(page)].concat()
}

fn stand_of(page: &CalibrationPage) -> [Words; 2] {
    let content = page.content();
    let stand = format!("{} №\u{a0}{}", content.stand.model, content.stand.serial);
    [stand, content.site.name.clone().unwrap_or_else(|| content.site.id.to_string())].map(given)
}

/// Which gyro was calibrated, by whom and when, on which stand, and on whose word.
pub(super) fn band(page: &CalibrationPage) -> Block {
    let content = page.content();
    // A pen completes it on paper.
    let or_not = |value: Option<Words>| {
        let pen = || {
            Words::All(vec![
                Words::Styled("save", Box::new(stated::<Words>(None))),
                Words::Styled("pen", Box::new(Words::Blank)),
            ])
        };
        value.unwrap_or_else(pen)
    };
    let laboratory = page.laboratory.and_then(|laboratory| laboratory.name.as_ref()).map(given);
    let day = page.document.date().map(Words::Date);
    let number = Block::Note("pen name", vec![texts::REPORT_NUMBER.into(), Words::Blank].into());
    // The title names the serial number if it was stated. Without it a report is of no gyro.
    let gyro = match page.serial() {
        Some(_) => (texts::MEASURED, or_not(day), vec![number]),
        None => {
            let measured = day.map(|day| note(vec![texts::MEASURED.into(), " ".into(), day]));
            (texts::SERIAL, or_not(None), measured.into_iter().chain([number]).collect())
        }
    };
    let [stand, site] = stand_of(page);
    let id = given(&content.passport.id);
    let certificate = match &page.passport {
        UsedPassport::Verified(passport) => {
            let verified =
                if withdrawal_not_checked(passport) { texts::verified_not_withdrawal } else { texts::verified_as_of };
            vec![Block::Each(verified(id, told(Words::Time(page.time))))]
        }
        UsedPassport::NotVerified { .. } => {
            vec![note(id), Block::Note("failed", Words::Inline(Box::new(texts::NOT_VERIFIED.into())))]
        }
    };
    Block::Band(vec![
        gyro,
        (passport_texts::LABORATORY, or_not(laboratory), Vec::new()),
        (texts::STAND, stand, vec![note(site)]),
        (passport_texts::WORD, given(&content.certificate.number), certificate),
    ])
}

fn gyro(page: &CalibrationPage) -> Block {
    let certificate = &page.content().certificate;
    let (result, subject) = (page.document, page.document.subject.as_ref());
    let celsius = |value: f64| Words::Quantity(Number::exact(value), units::CELSIUS);
    let temperature = subject.and_then(|subject| temperature_c(subject, page.laboratory)).map(celsius);
    // What the band leaves blank has its only blank there.
    let (serial, day) = (page.serial(), result.date());
    let is_in_the_band = serial.is_some() && day.is_none();
    let or_blank = |name, value: Option<Words>| Some((name, value.unwrap_or(Words::Blank), false));
    let [stand, site] = stand_of(page);
    record([
        or_blank(texts::TYPE, page.gyro.map(|gyro| given(&gyro.r#type))),
        field(texts::SERIAL, serial.map(given)),
        blank(texts::CONDITION),
        blank(passport_texts::CUSTOMER),
        blank(forms::CUSTOMER_CONTACT),
        blank(texts::RECEIVED),
        or_blank(texts::MEASURED, day.map(Words::Date)).filter(|_| !is_in_the_band),
        or_blank(texts::OPERATOR, subject.and_then(|subject| subject.operator.as_ref()).map(given)),
        or_blank(texts::MEASURED_TEMPERATURE, temperature),
        field(texts::STAND, Some(stand)),
        field(texts::CURRENTS, Some(given(file_name(page.currents.0)))),
        wide(forms::SITE, Some(site)),
        wide(texts::CERTIFIED_BY, Some(vec![given(&certificate.laboratory), ", ".into(), certificate.issued.into()])),
        wide(passport_texts::TRACEABILITY, Some(stated(certificate.traceability.as_ref().map(given)))),
        wide(texts::CURRENTS_SHA256, Some(code(&page.currents.1))),
    ])
}

fn passport(page: &CalibrationPage) -> Vec<Block> {
    let header = &page.content().passport;
    // The signer of an unverified passport is unknown. So these fields are left out, not printed empty.
    let signed = match &page.passport {
        UsedPassport::Verified(passport) => Some(passport),
        UsedPassport::NotVerified { .. } => None,
    };
    let fields = record([
        field(passport_texts::ID, Some(given(&header.id))),
        field(passport_texts::ISSUED, Some(Words::Time(header.issued_at))),
        wide(texts::PASSPORT_SHA256, Some(code(page.passport.file().1))),
        field(passport_texts::ISSUER, signed.map(|_| given(&header.issuer))),
        wide(passport_texts::KEY, signed.map(|passport| code(passport.key.fingerprint()))),
    ]);
    [fields].into_iter().chain(signed.map(|passport| checks::table(passport))).collect()
}

fn laboratory(page: &CalibrationPage) -> Vec<Block> {
    let laboratory = page.laboratory.cloned().unwrap_or_else(Laboratory::paper);
    let (g, u) = (page.document.gravity_m_per_s2, page.document.gravity_u_m_per_s2);
    let fields = [
        field(passport_texts::NAME, laboratory.name.as_ref().map(given)),
        blank(passport_texts::ADDRESS),
        blank(texts::PROCEDURE),
        field(passport_texts::GRAVITY, Some(site::gravity(g, u))),
    ];
    // Section 3 names those that are not stated.
    let fields = fields.into_iter().chain(accuracy::angles(&laboratory));
    let meter = [blank(texts::METER_IDENTITY), wide(passport_texts::METER, Some(accuracy::meter(&laboratory)))];
    let assumed = page.laboratory.is_none().then(|| Block::Within("statement", vec![say([texts::METER_ASSUMED])]));
    [record(fields.chain(meter))].into_iter().chain(assumed).collect()
}

/// A warning if the readings are older than the measurement of the stand.
pub(super) fn date_of_readings(page: &CalibrationPage) -> Option<Block> {
    let subject = page.document.subject.as_ref();
    let days = subject.and_then(|subject| subject.day_before_certification(&page.content().certificate))?;
    let [date, performed] = days.map(Words::Date);
    let words = vec![say([told(texts::readings_older(date, performed))])];
    Some(outcome_box(Outcome::Undecided, texts::READINGS_ARE_OLDER, words))
}

/// Returns the temperature if it is outside the range for which the deviations are certified.
pub(super) fn outside(page: &CalibrationPage) -> Option<TemperatureOutside> {
    TemperatureOutside::of(&page.content().certificate, page.document.subject.as_ref()?, page.laboratory)
}

/// A warning if the deviations are certified for other temperatures.
pub(super) fn temperature(page: &CalibrationPage) -> Option<Block> {
    let words = vec![say([temperature_outside(&outside(page)?)])];
    Some(Block::Boxed("verdict warned", marked(Outcome::Failed, texts::TEMPERATURE_IS_OUTSIDE), words))
}
