//! General data: the passport itself, the stand and its certificate
//! ([ISO/IEC 17025:2017](crate::bibliography::Bibliography::Iso17025), 7.8.2.1 and 7.8.4.1).

use crate::passport::Content;
use crate::passport::content::PassportHeader;
use crate::report::doc::{Block, On, Words, blank, field, given, heading, record, say, wide};
use crate::stand::{Certificate, Identity, Reference};
use crate::trust::PublicKey;
use crate::wording::Number;
use crate::wording::texts::{passport as texts, record as forms, units, words};

pub(super) fn section(content: &Content) -> Vec<Block> {
    let statement = Block::Within("statement", vec![say([texts::THIS_ITEM_ONLY])]);
    let mut doc = stand(&content.stand);
    doc.extend([certificate(&content.certificate), left_to_the_laboratory(), statement.only(On::Page)]);
    doc
}

/// The passport itself, the key that signed it, and the passport that it replaces.
pub(crate) fn of_the_passport(header: &PassportHeader, key: Option<&PublicKey>) -> Vec<Block> {
    let mut doc = vec![record([
        field(texts::ISSUED, Some(Words::Time(header.issued_at))),
        field(texts::ISSUER, Some(given(&header.issuer))),
        field(texts::VALID_UNTIL, header.valid_until),
        field(texts::ISSUED_WITH, header.issued_with.as_ref().map(given)),
        wide(texts::KEY, key.map(|key| Words::Code(key.fingerprint()))),
    ])];
    doc.extend(header.reissued_from.as_ref().map(|old| {
        let superseded = if header.supersedes == Some(true) { words::YES } else { words::NO };
        record([
            field(texts::REISSUED_FROM, Some(given(&old.id))),
            field(texts::REISSUE_SUPERSEDES, Some(superseded)),
            wide(texts::REISSUE_REASON, Some(given(&old.reason))),
            wide(texts::REISSUE_CHANGED, Some(given(&old.changed))),
            wide(texts::REISSUED_SHA256, Some(Words::Code(old.sha256.clone()))),
        ])
    }));
    doc
}

/// Most letters of a name that has half of the width.
const LONG: usize = 60;

pub(crate) fn stand(stand: &Identity) -> Vec<Block> {
    let named = |name, value: Option<&String>| value.map(|value| (name, given(value), value.chars().count() > LONG));
    let fields = [
        field(texts::MODEL, Some(given(stand.model.as_str()))),
        field(texts::SERIAL, Some(given(stand.serial.as_str()))),
        field(texts::NAME, stand.name.as_ref().map(given)),
        field(texts::CONFIGURATION, stand.configuration.as_ref().map(given)),
        named(texts::MANUFACTURER, stand.manufacturer.as_ref()),
        named(texts::CUSTOMER, stand.customer.as_ref()),
        blank(forms::CUSTOMER_CONTACT),
    ];
    vec![heading(texts::STAND), record(fields)]
}

pub(crate) fn certificate(certificate: &Certificate) -> Block {
    let celsius = |value| Words::Quantity(Number::exact(value), units::CELSIUS);
    let range = certificate.temperature_range_c.map(|[low, high]| texts::from_to(Number::exact(low), celsius(high)));
    let fields = [
        field(texts::CERTIFICATE_NUMBER, Some(given(&certificate.number))),
        field(texts::CERTIFICATE_ISSUED, Some(certificate.issued)),
        field(texts::PERFORMED, certificate.performed),
        field(texts::RECEIVED, certificate.received),
        field(texts::VALID_UNTIL, certificate.valid_until),
        field(texts::VALID_UNTIL_BASIS, certificate.valid_until_basis.as_ref().map(given)),
        field(texts::LABORATORY_OF_CERTIFICATE, Some(given(&certificate.laboratory))),
        field(texts::ADDRESS, certificate.address.as_ref().map(given)),
        field(texts::AUTHORISED_BY, certificate.authorized_by.as_ref().map(given)),
        field(texts::ACCREDITATION, certificate.accreditation.as_ref().map(given)),
        field(texts::TEMPERATURE, certificate.temperature_c.map(celsius)),
        field(texts::TEMPERATURE_RANGE, range),
        wide(texts::METHOD, certificate.method.as_ref().map(given)),
        wide(texts::TRACEABILITY, certificate.traceability.as_ref().map(given)),
        field(texts::CMC, certificate.cmc_arcsec.map(|cmc| Words::Quantity(Number::exact(cmc), units::ARCSEC))),
    ];
    let references = certificate.references.iter().flatten().map(|Reference { number, laboratory, issued, sha256 }| {
        let words = vec![given(number), ", ".into(), given(laboratory), ", ".into(), Words::Date(*issued)];
        let words = words.into_iter().chain([", SHA-256 ".into(), Words::Code(sha256.clone())]);
        wide(texts::REFERENCE, Some(Words::All(words.collect())))
    });
    Block::Within("titled", vec![heading(texts::CERTIFICATE), record(fields.into_iter().chain(references))])
}

fn left_to_the_laboratory() -> Block {
    let empty = [
        forms::PLACE_OF_MEASUREMENT,
        forms::CONDITION,
        forms::METHOD_CHANGES,
        forms::EXTERNAL,
        forms::ADJUSTMENT,
        forms::SIGNATURE,
    ];
    let doc = vec![heading(forms::LEFT_TO_THE_LABORATORY), record(empty.map(blank))];
    Block::Within("pen", doc).only(On::Page)
}
