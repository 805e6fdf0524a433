//! General data: the stand and its certificate ([ISO/IEC 17025:2017](crate::bibliography::Bibliography::Iso17025),
//! 7.8.2.1 and 7.8.4.1).

use super::PassportPage;
use crate::report::page::language::{Language, Languages};
use crate::report::page::number::Number;
use crate::report::page::parts::{date, field, fields, given, heading, quantity, stated, wide_stated};
use crate::report::page::texts::{passport as texts, record, units};
use crate::stand::{Certificate, Identity};
use maud::{Markup, html};

pub(super) fn section(page: &PassportPage, languages: &Languages) -> Markup {
    html! {
        (stand(&page.content.stand, languages))
        (certificate(&page.content.certificate, languages))
        (left_to_the_laboratory(languages))
        div.statement { (languages.paragraph(texts::THIS_ITEM_ONLY)) }
    }
}

pub(crate) fn stand(stand: &Identity, languages: &Languages) -> Markup {
    html! {
        (heading(languages, texts::STAND))
        (fields([
            stated(languages, texts::MODEL, Some(given(stand.model.as_str()))),
            stated(languages, texts::SERIAL, Some(given(stand.serial.as_str()))),
            stated(languages, texts::NAME, stand.name.as_deref().map(given)),
            stated(languages, texts::CONFIGURATION, stand.configuration.as_deref().map(given)),
            stated(languages, texts::MANUFACTURER, stand.manufacturer.as_deref().map(given)),
            stated(languages, texts::CUSTOMER, stand.customer.as_deref().map(given)),
            field(languages, record::MANUFACTURED, None),
            field(languages, record::CUSTOMER_CONTACT, None),
        ]))
    }
}

pub(crate) fn certificate(certificate: &Certificate, languages: &Languages) -> Markup {
    let day = |day| date(languages, day);
    let celsius = |value| quantity(languages, &Number::exact(value), units::CELSIUS);
    let range = certificate.temperature_range_c.map(|[low, high]| {
        let from_to = |language: Language| {
            let alone = language.into();
            let high = quantity(&alone, &Number::exact(high), units::CELSIUS);
            texts::FROM_TO.marked_up(language, &[("low", Number::exact(low).markup(&alone)), ("high", high)])
        };
        html! {
            @for (index, language) in languages.iter().enumerate() {
                @if index > 0 { " / " }
                span lang=(language.tag()) { (from_to(language)) }
            }
        }
    });
    let fields = fields([
        stated(languages, texts::CERTIFICATE_NUMBER, Some(given(&certificate.number))),
        stated(languages, texts::CERTIFICATE_ISSUED, Some(day(certificate.issued))),
        stated(languages, texts::PERFORMED, certificate.performed.map(day)),
        stated(languages, texts::RECEIVED, certificate.received.map(day)),
        stated(languages, texts::VALID_UNTIL, certificate.valid_until.map(day)),
        stated(languages, texts::VALID_UNTIL_BASIS, certificate.valid_until_basis.as_deref().map(given)),
        stated(languages, texts::LABORATORY_OF_CERTIFICATE, Some(given(&certificate.laboratory))),
        stated(languages, texts::ADDRESS, certificate.address.as_deref().map(given)),
        stated(languages, texts::AUTHORISED_BY, certificate.authorized_by.as_deref().map(given)),
        stated(languages, texts::ACCREDITATION, certificate.accreditation.as_deref().map(given)),
        stated(languages, texts::TEMPERATURE, certificate.temperature_c.map(celsius)),
        stated(languages, texts::TEMPERATURE_RANGE, range),
        wide_stated(languages, texts::METHOD, certificate.method.as_deref().map(given)),
        wide_stated(languages, texts::TRACEABILITY, certificate.traceability.as_deref().map(given)),
    ]);
    html! { div.titled { (heading(languages, texts::CERTIFICATE)) (fields) } }
}

fn left_to_the_laboratory(languages: &Languages) -> Markup {
    let empty = [
        record::PLACE_OF_MEASUREMENT,
        record::CONDITION,
        record::METHOD_CHANGES,
        record::EXTERNAL,
        record::ADJUSTMENT,
        record::SIGNATURE,
    ];
    html! {
        div.pen {
            (heading(languages, record::LEFT_TO_THE_LABORATORY))
            (fields(empty.map(|name| field(languages, name, None))))
        }
    }
}
