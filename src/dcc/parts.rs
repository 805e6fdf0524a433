//! Elements that every DCC has: texts, quantities, and the administrative data.

use super::Dcc;
use super::administrative::{Contact, Location};
use super::facts::{Facts, stated};
use super::xml::Element;
use crate::wording::texts::dcc as words;
use crate::wording::{Text, Words};
use std::fmt::Display;

const SCHEMA_VERSION: &str = "3.3.0";

/// Publication of the symbols, the drift model and the equations.
pub(super) const PAPER: &str = "https://doi.org/10.18698/2308-6033-2017-10-1691";

/// Database of the vocabularies that `refType` uses.
const VOCABULARIES: &str = "https://digilab.ptb.de/dkd/refType/vocab/";

/// D-SI units (SI Brochure; "D-SI", doi 10.5281/zenodo.3522631).
pub(super) mod units {
    pub(in crate::dcc) const ONE: &str = r"\one";
    pub(in crate::dcc) const DEGREE: &str = r"\degree";
    pub(in crate::dcc) const ARCSECOND: &str = r"\arcsecond";
    pub(in crate::dcc) const CELSIUS: &str = r"\degreecelsius";
    pub(in crate::dcc) const M_PER_S2: &str = r"\metre\second\tothe{-2}";
    pub(in crate::dcc) const DEG_PER_H: &str = r"\degree\hour\tothe{-1}";
    pub(in crate::dcc) const DEG_PER_H_PER_MA: &str = r"\degree\hour\tothe{-1}\milli\ampere\tothe{-1}";
    /// There is no unit of the standard gravity, so drifts per g are converted to this.
    pub(in crate::dcc) const DEG_PER_H_PER_M_PER_S2: &str = r"\degree\hour\tothe{-1}\metre\tothe{-1}\second\tothe{2}";
}

/// Returns an element with words in every language of the DCC.
pub(super) fn in_words(name: &'static str, words: impl Into<Words>) -> Element {
    Element::said(name, words.into())
}

/// Returns an element with a text of others, whose language is not known. Allowed next to a `dcc:name`, and in one.
pub(super) fn plain(name: &'static str, text: &str) -> Element {
    Element::new(name).and(Element::text("dcc:content", text))
}

/// Returns a number with its unit and, if stated, its standard uncertainty.
pub(super) fn real(value: f64, unit: &str, standard_uncertainty: Option<f64>) -> Element {
    let uncertainty = standard_uncertainty.map(|u| {
        Element::new("si:measurementUncertaintyUnivariate")
            .and(Element::new("si:standardMU").and(Element::number("si:valueStandardMU", u)))
    });
    Element::new("si:real").and(Element::number("si:value", value)).and(Element::text("si:unit", unit)).and(uncertainty)
}

/// Returns numbers with their labels, separated by spaces, their unit and, if any is stated, their standard
/// uncertainties (NaN where one is not).
pub(super) fn reals(
    labels: Option<&str>,
    values: &[f64],
    unit: &str,
    standard_uncertainties: &[Option<f64>],
) -> Element {
    let stated = standard_uncertainties.iter().any(Option::is_some);
    let uncertainty = stated.then(|| {
        let each = standard_uncertainties.iter().map(|u| u.unwrap_or(f64::NAN));
        let list = Element::numbers("si:valueStandardMUXMLList", each);
        Element::new("si:measurementUncertaintyUnivariateXMLList").and(Element::new("si:standardMUXMLList").and(list))
    });
    Element::new("si:realListXMLList")
        .and(labels.map(|labels| Element::text("si:labelXMLList", labels)))
        .and(Element::numbers("si:valueXMLList", values.iter().copied()))
        .and(Element::text("si:unitXMLList", unit))
        .and(uncertainty)
}

/// Returns a quantity: its kinds in the vocabularies of PTB (`basic`, `math`) and of this program (`dtg`), its name and its
/// value.
pub(super) fn quantity(kinds: &str, name: Text, value: Element) -> Element {
    Element::named("dcc:quantity", name).with("refType", kinds).and(value)
}

/// Returns a statement: its name, its content as it is stated, and other elements that follow a declaration.
pub(super) fn statement(name: Text, declaration: Option<&str>) -> Element {
    Element::named("dcc:statement", name).and(stated(declaration).map(|text| plain("dcc:declaration", text)))
}

/// Returns a statement with words of the program.
pub(super) fn said(name: Text, declaration: impl Into<Words>) -> Element {
    statement(name, None).and(in_words("dcc:declaration", declaration))
}

pub(super) fn serial(value: &str) -> Element {
    identification(value, words::SERIAL).with("refType", "basic_serialNumber")
}

pub(super) fn manufacturer(name: Option<&str>) -> Option<Element> {
    stated(name).map(|name| Element::new("dcc:manufacturer").and(plain("dcc:name", name)))
}

/// Returns an identification that the manufacturer assigned: its value and its name.
pub(super) fn identification(value: &str, name: Text) -> Element {
    Element::new("dcc:identification")
        .and(Element::text("dcc:issuer", "manufacturer"))
        .and(Element::text("dcc:value", value))
        .and(in_words("dcc:name", name))
}

/// Returns the content of `dcc:hashType`: a document by its name, identifier and SHA-256.
pub(super) fn hashed(name: &'static str, what: Text, id: &str, sha256: &str) -> Element {
    Element::new(name)
        .and(in_words("dcc:referral", what))
        .and(Element::text("dcc:referralID", id))
        .and(Element::text("dcc:procedure", "SHA-256"))
        .and(Element::text("dcc:value", sha256))
}

/// Returns this program. The release has a letter before the numbers, as PTB's rules demand.
pub(super) fn software(name: &'static str) -> Element {
    let version = env!("CARGO_PKG_VERSION").split(['-', '+']).next().unwrap_or_default();
    let program = Element::new("dcc:software")
        .and(plain("dcc:name", "dtg-passport"))
        .and(Element::text("dcc:release", format!("v{version}")))
        .and(Element::text("dcc:type", "application"));
    Element::new(name).and(program)
}

pub(super) fn method(name: Element, description: Element, link: Option<&str>) -> Element {
    Element::new("dcc:usedMethod")
        .with("refType", "basic_calibrationMethod")
        .and(name)
        .and(description)
        .and(link.map(|link| Element::text("dcc:link", link)))
}

pub(super) fn stated_method(facts: &Facts) -> Option<Element> {
    let of = |text: &String| method(in_words("dcc:name", words::METHOD), plain("dcc:description", text), None);
    facts.file.method.as_ref().map(of)
}

pub(super) fn results(name: Text, note: Text, quantities: Vec<Element>) -> Element {
    let list = Element::new("dcc:list").and(quantities);
    let result = Element::named("dcc:result", name)
        .with("refType", "basic_measurementResult")
        .and(in_words("dcc:description", note))
        .and(Element::new("dcc:data").and(list));
    Element::new("dcc:results").and(result)
}

pub(super) fn temperature(facts: &Facts) -> Option<Element> {
    let of = |celsius| condition(words::TEMPERATURE, real(celsius, units::CELSIUS, None));
    facts.file.temperature_c.map(|celsius| of(celsius).with("refType", "basic_temperature"))
}

pub(super) fn condition(name: Text, value: Element) -> Element {
    let value = quantity("basic_measuredValue", name, value);
    Element::named("dcc:influenceCondition", name).and(Element::new("dcc:data").and(value))
}

/// Parts that differ between a stand and a gyro.
pub(super) struct Subject<'a> {
    /// Identification of the certificate besides its number.
    pub identification: Option<Element>,
    pub previous_report: Option<Element>,
    pub item: Element,
    pub accreditation: Option<&'a str>,
    /// Statements on the whole certificate.
    pub statements: Vec<Element>,
    pub result: Element,
    pub document: Option<Element>,
}

/// Returns the whole DCC.
pub(super) fn certificate(facts: &Facts, subject: Subject) -> Dcc {
    let number = facts.file.number.clone().unwrap_or_default();
    let statements = (!subject.statements.is_empty()).then(|| Element::new("dcc:statements").and(subject.statements));
    let laboratory = Element::new("dcc:calibrationLaboratory")
        .and(text("dcc:calibrationLaboratoryCode", stated(subject.accreditation)))
        .and(contact("dcc:contact", facts.file.laboratory.as_ref(), facts.address));
    let administrative_data = Element::new("dcc:administrativeData")
        .and(software("dcc:dccSoftware"))
        .and(vocabularies())
        .and(core_data(facts, subject.identification, subject.previous_report))
        .and(Element::new("dcc:items").and(subject.item))
        .and(laboratory)
        .and(persons(facts))
        .and(contact("dcc:customer", facts.file.customer.as_ref(), None))
        .and(statements);
    let xml = Element::new("dcc:digitalCalibrationCertificate")
        .with("xmlns:dcc", "https://ptb.de/dcc")
        .with("xmlns:si", "https://ptb.de/si")
        .with("xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance")
        .with("xsi:schemaLocation", format!("https://ptb.de/dcc https://ptb.de/dcc/v{SCHEMA_VERSION}/dcc.xsd"))
        .with("schemaVersion", SCHEMA_VERSION)
        .and(administrative_data)
        .and(Element::new("dcc:measurementResults").and(subject.result))
        .and(subject.document)
        .document(&facts.languages);
    Dcc { number, xml }
}

fn vocabularies() -> Element {
    let vocabulary = |name, namespace, link| {
        Element::named("dcc:refTypeDefinition", name)
            .and(Element::text("dcc:namespace", namespace))
            .and(Element::text("dcc:link", link))
    };
    Element::new("dcc:refTypeDefinitions")
        .and(vocabulary(words::BASIC_TERMS, "basic", VOCABULARIES))
        .and(vocabulary(words::MATH_TERMS, "math", VOCABULARIES))
        .and(vocabulary(words::DTG_TERMS, "dtg", PAPER))
}

fn core_data(facts: &Facts, identification: Option<Element>, previous_report: Option<Element>) -> Element {
    let ([begin, end], file) = (facts.performed, &facts.file);
    let used = facts.languages.iter().map(|language| Element::text("dcc:usedLangCodeISO639_1", language.tag()));
    Element::new("dcc:coreData")
        .and(text("dcc:countryCodeISO3166_1", file.country.as_deref()))
        .and(used)
        .and(Element::text("dcc:mandatoryLangCodeISO639_1", facts.mandatory.tag()))
        .and(text("dcc:uniqueIdentifier", file.number.as_deref()))
        .and(identification.map(|one| Element::new("dcc:identifications").and(one)))
        .and(text("dcc:receiptDate", facts.received))
        .and(Element::text("dcc:beginPerformanceDate", begin))
        .and(Element::text("dcc:endPerformanceDate", end))
        .and(text("dcc:performanceLocation", file.location.map(Location::word)))
        .and(text("dcc:issueDate", file.issued))
        .and(previous_report)
}

/// Returns an element with a text, or none without one.
fn text(name: &'static str, text: Option<impl Display>) -> Option<Element> {
    text.map(|text| Element::text(name, text))
}

/// Returns name and address; `further` is an address in free text.
fn contact(name: &'static str, contact: Option<&Contact>, further: Option<&str>) -> Option<Element> {
    let contact = contact?;
    let text = |element, of: &Option<String>| text(element, stated(of.as_deref()));
    let location = Element::new("dcc:location")
        .and(text("dcc:street", &contact.street))
        .and(text("dcc:streetNo", &contact.street_no))
        .and(text("dcc:postOfficeBox", &contact.post_office_box))
        .and(text("dcc:postCode", &contact.post_code))
        .and(text("dcc:city", &contact.city))
        .and(text("dcc:state", &contact.state))
        .and(text("dcc:countryCode", &contact.country))
        .and(further.map(|further| plain("dcc:further", further)));
    let element = Element::new(name)
        .and(contact.name.as_deref().map(|name| plain("dcc:name", name)))
        .and(text("dcc:eMail", &contact.email))
        .and(text("dcc:phone", &contact.phone))
        .and(location);
    Some(element)
}

fn persons(facts: &Facts) -> Element {
    let person =
        |name: &str| Element::new("dcc:respPerson").and(Element::new("dcc:person").and(plain("dcc:name", name)));
    let signer = facts.main_signer.iter().map(|name| person(name).and(Element::text("dcc:mainSigner", "true")));
    let others = facts.file.responsible.iter().flatten().map(|name| person(name));
    Element::new("dcc:respPersons").and(signer.chain(others))
}
