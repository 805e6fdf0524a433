//! Object of the calibration: gyro, stand, passport and readings.

use super::{CalibrationPage, UsedPassport};
use crate::calibration::stated::{TemperatureOutside, temperature_c};
use crate::laboratory::Laboratory;
use crate::report::calibration::temperature_outside;
use crate::report::doc;
use crate::report::page::language::Languages;
use crate::report::page::number::Number;
use crate::report::page::parts::{
    self, blank, boxed, date, field, fields, file_name, given, heading, marked, not_stated, outcome_box, quantity,
    time, wide_field, wide_stated,
};
use crate::report::page::passport::checks;
use crate::report::page::passport::checks::withdrawal_not_checked;
use crate::report::passport::{accuracy, site};
use crate::report::style::Outcome;
use crate::wording::texts::{calibration as texts, passport as passport_texts, record, units};
use crate::wording::{Words, date_text, time_text};
use maud::{Markup, html};

pub(super) fn section(page: &CalibrationPage, languages: &Languages) -> Markup {
    html! {
        (gyro(page, languages))
        (heading(languages, texts::PASSPORT))
        (passport(page, languages))
        (heading(languages, passport_texts::LABORATORY))
        (laboratory(page, languages))
    }
}

/// Writes which gyro was calibrated, by whom and when, on which stand, and on whose word.
pub(super) fn band(page: &CalibrationPage, languages: &Languages) -> Markup {
    let content = page.content();
    // A pen completes it on paper.
    let or_not = |value: Option<Markup>| {
        value.unwrap_or_else(|| html! { span.save { (not_stated(languages)) } span.pen { (blank(languages)) } })
    };
    let laboratory = page.laboratory.and_then(|laboratory| laboratory.name.as_deref()).map(given);
    let day = page.document.date().map(|day| date(languages, day));
    let number = html! { p.pen.name { (languages.label(texts::REPORT_NUMBER)) (blank(languages)) } };
    // The title names the serial number if it was stated. Without it a report is of no gyro.
    let gyro = match page.serial() {
        Some(_) => (texts::MEASURED, or_not(day), number),
        None => (
            texts::SERIAL,
            or_not(None),
            html! { @if let Some(day) = day { p { (languages.label(texts::MEASURED)) " " (day) } } (number) },
        ),
    };
    let stand = html! { (given(content.stand.model.as_str())) " №\u{a0}" (given(content.stand.serial.as_str())) };
    let site = content.site.name.as_deref().unwrap_or(content.site.id.as_str());
    let id = || given(&content.passport.id);
    let certificate = match &page.passport {
        UsedPassport::Verified(passport) => languages.lines_with(|language| {
            let (id, time) = (Words::Given(content.passport.id.clone()), time_text(language, page.time));
            let words = match withdrawal_not_checked(passport) {
                true => texts::verified_not_withdrawal(id, time),
                false => texts::verified_as_of(id, time),
            };
            words.html(language, languages)
        }),
        UsedPassport::NotVerified { .. } => html! { p { (id()) } p.failed { (languages.inline(texts::NOT_VERIFIED)) } },
    };
    parts::band(
        languages,
        [
            gyro,
            (passport_texts::LABORATORY, or_not(laboratory), html! {}),
            (texts::STAND, stand, html! { p { (given(site)) } }),
            (passport_texts::WORD, given(&content.certificate.number), certificate),
        ],
    )
}

fn gyro(page: &CalibrationPage, languages: &Languages) -> Markup {
    let content = page.content();
    let stand = format!("{} №\u{a0}{}", content.stand.model, content.stand.serial);
    let certificate = &content.certificate;
    let laboratory = html! { (given(&certificate.laboratory)) ", " (date(languages, certificate.issued)) };
    let result = page.document;
    let subject = result.subject.as_ref();
    let celsius = |value: f64| quantity(languages, &Number::exact(value), units::CELSIUS);
    let temperature = subject.and_then(|subject| temperature_c(subject, page.laboratory)).map(celsius);
    let site = content.site.name.as_deref().unwrap_or(content.site.id.as_str());
    // What the band leaves blank has its only blank there.
    let serial = page.serial().map(given);
    let day = result.date().map(|day| date(languages, day));
    let day_is_in_the_band = serial.is_some() && day.is_none();
    fields([
        field(languages, texts::TYPE, page.gyro.map(|gyro| given(&gyro.r#type))),
        serial.map(|serial| field(languages, texts::SERIAL, Some(serial))).unwrap_or_default(),
        field(languages, texts::CONDITION, None),
        field(languages, passport_texts::CUSTOMER, None),
        field(languages, record::CUSTOMER_CONTACT, None),
        field(languages, texts::RECEIVED, None),
        (if day_is_in_the_band {
            html! {}
        } else {
            field(languages, texts::MEASURED, day)
        }),
        field(languages, texts::OPERATOR, subject.and_then(|subject| subject.operator.as_deref()).map(given)),
        field(languages, texts::MEASURED_TEMPERATURE, temperature),
        field(languages, texts::STAND, Some(given(&stand))),
        field(languages, texts::CURRENTS, Some(given(file_name(page.currents.0)))),
        wide_field(languages, record::SITE, Some(given(site))),
        wide_field(languages, texts::CERTIFIED_BY, Some(laboratory)),
        wide_stated(languages, passport_texts::TRACEABILITY, certificate.traceability.as_deref().map(given)),
        wide_field(languages, texts::CURRENTS_SHA256, Some(html! { code { (page.currents.1) } })),
    ])
}

fn passport(page: &CalibrationPage, languages: &Languages) -> Markup {
    let header = &page.content().passport;
    let signed = match &page.passport {
        UsedPassport::Verified(passport) => Some(passport),
        UsedPassport::NotVerified { .. } => None,
    };
    // The signer of an unverified passport is unknown. So these fields are left out, not printed empty.
    let signer = signed.into_iter().flat_map(|passport| {
        [
            field(languages, passport_texts::ISSUER, Some(given(&header.issuer))),
            wide_field(languages, passport_texts::KEY, Some(html! { code { (passport.key.fingerprint()) } })),
        ]
    });
    html! {
        (fields([
            field(languages, passport_texts::ID, Some(given(&header.id))),
            field(languages, passport_texts::ISSUED, Some(time(languages, header.issued_at))),
            wide_field(languages, texts::PASSPORT_SHA256, Some(html! { code { (page.passport.sha256()) } })),
        ].into_iter().chain(signer)))
        @if let Some(passport) = signed { (doc::blocks(&[checks::table(passport)], languages)) }
    }
}

fn laboratory(page: &CalibrationPage, languages: &Languages) -> Markup {
    let laboratory = page.laboratory.cloned().unwrap_or_else(Laboratory::paper);
    let (g, u) = (page.document.gravity_m_per_s2, page.document.gravity_u_m_per_s2);
    // Section 3 names those that are not stated.
    let angles = accuracy::angles(&laboratory).into_iter().flatten();
    let angles = angles.map(|(name, value, _)| field(languages, name, Some(value.cell(languages))));
    let meter = wide_field(languages, passport_texts::METER, Some(accuracy::meter(&laboratory).cell(languages)));
    html! {
        (fields([
            laboratory.name.as_deref().map(|name| field(languages, passport_texts::NAME, Some(given(name)))).unwrap_or_default(),
            field(languages, passport_texts::ADDRESS, None),
            field(languages, texts::PROCEDURE, None),
            field(languages, passport_texts::GRAVITY, Some(site::gravity(g, u).cell(languages))),
        ].into_iter().chain(angles).chain([field(languages, texts::METER_IDENTITY, None), meter])))
        @if page.laboratory.is_none() { div.statement { (languages.paragraph(texts::METER_ASSUMED)) } }
    }
}

/// Writes a warning if the readings are older than the measurement of the stand.
pub(super) fn date_of_readings(page: &CalibrationPage, languages: &Languages) -> Markup {
    let subject = page.document.subject.as_ref();
    let Some(days) = subject.and_then(|subject| subject.day_before_certification(&page.content().certificate)) else {
        return html! {};
    };
    let words = languages.paragraph_with(|language| {
        let [date, performed] = days.map(|day| date_text(language, day));
        html! { (texts::readings_older(date, performed).plain(language)) }
    });
    outcome_box(Outcome::Undecided, &languages.label(texts::READINGS_ARE_OLDER), words)
}

/// Returns the temperature if it is outside the range for which the deviations are certified.
pub(super) fn outside(page: &CalibrationPage) -> Option<TemperatureOutside> {
    TemperatureOutside::of(&page.content().certificate, page.document.subject.as_ref()?, page.laboratory)
}

/// Writes a warning if the deviations are certified for other temperatures.
pub(super) fn temperature(page: &CalibrationPage, languages: &Languages) -> Markup {
    let Some(found) = outside(page) else { return html! {} };
    let words = languages.said_in_paragraph(&temperature_outside(&found));
    boxed("verdict warned", marked(Outcome::Failed, &languages.label(texts::TEMPERATURE_IS_OUTSIDE)), words)
}
