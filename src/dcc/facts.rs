//! Facts that every DCC states: from what is signed or calculated, and from the administrative file. What is missing is
//! named all at once, and what contradicts the signed passport is refused.

use super::administrative::{Administrative, Contact, Location, Performed};
use crate::report::{Language, Languages};
use crate::text::{Path, Problems};
use jiff::civil::Date;
use std::fmt::Display;

/// Facts that a passport or a calibration states.
#[derive(Debug, Clone, Default)]
pub(super) struct Known<'a> {
    /// Source of these facts, as named in messages.
    pub source: &'static str,
    /// Serial number of the item, if an option must state it.
    pub serial: Option<Option<&'a str>>,
    pub number: Option<&'a str>,
    /// Day on which the item was received.
    pub received: Option<Date>,
    /// Day of the measurements.
    pub performed: Option<Date>,
    pub issued: Option<Date>,
    pub laboratory: Option<&'a str>,
    pub address: Option<&'a str>,
    /// Person who authorised the certificate.
    pub authorized_by: Option<&'a str>,
    pub customer: Option<&'a str>,
    pub method: Option<&'a str>,
    /// `true` if the method needs no statement, because it is a calculation of this program.
    pub method_is_known: bool,
    pub traceability: Option<&'a str>,
    /// Temperature during the measurements, °C.
    pub temperature_c: Option<f64>,
    /// Keys that options of the command line state too, with the options.
    pub options: &'static [(&'static str, &'static str)],
}

/// Complete facts of a DCC.
#[derive(Debug)]
pub(super) struct Facts {
    pub country: String,
    /// Languages of the program's words.
    pub languages: Languages,
    pub mandatory: Language,
    pub number: String,
    pub received: Option<Date>,
    /// First and last day of the measurements.
    pub performed: [Date; 2],
    pub location: Location,
    pub issued: Option<Date>,
    /// Laboratory, with a name.
    pub laboratory: Contact,
    pub address: Option<String>,
    /// Customer, with a name.
    pub customer: Contact,
    /// Person who authorised the certificate.
    pub main_signer: Option<String>,
    /// Other responsible persons.
    pub responsible: Vec<String>,
    pub method: Option<String>,
    pub temperature_c: f64,
    pub traceable: Option<bool>,
}

impl Facts {
    /// Collects the facts. `lang` are the languages that were asked for.
    ///
    /// # Errors
    /// Returns every missing key and every contradiction to `known`, by their paths in the administrative file.
    pub(super) fn collect(
        known: &Known,
        file: Option<&Administrative>,
        lang: Option<&Languages>,
    ) -> Result<Self, Problems> {
        let advice = match file {
            Some(_) => "add it",
            None => "add it to a file for --administrative",
        };
        let none = Administrative::default();
        let file = file.unwrap_or(&none);
        let options = known.options;
        let mut collector = Collector { source: known.source, advice, options, problems: Problems::default() };
        let facts = collector.facts(known, file, lang);
        facts.filter(|_| collector.problems.is_empty()).ok_or(collector.problems)
    }
}

/// Returns a text without the spaces around it, or `None` if nothing is left: the schema has no empty texts.
pub(super) fn stated(text: Option<&str>) -> Option<&str> {
    text.map(str::trim).filter(|text| !text.is_empty())
}

struct Collector {
    source: &'static str,
    /// Advice for a missing key.
    advice: &'static str,
    options: &'static [(&'static str, &'static str)],
    problems: Problems,
}

impl Collector {
    fn facts(&mut self, known: &Known, file: &Administrative, lang: Option<&Languages>) -> Option<Facts> {
        let at = Path::Root;
        let (country, expected) = (file.country.clone(), "a country code of ISO 3166-1 such as \"DE\"");
        let country = self.need(&at, "country", country, expected, "coreData/countryCodeISO3166_1");
        let number = self.agreed(&at, "number", stated(known.number), stated(file.number.as_deref()));
        let number = self.need(&at, "number", number, "the number of the certificate", "coreData/uniqueIdentifier");
        let issued = self.agreed(&at, "issued", known.issued, file.issued);
        let performed = self.performed(known, file.performed.as_ref(), issued);
        let expected = "the place of the measurements, such as \"laboratory\"";
        let location = self.need(&at, "location", file.location, expected, "coreData/performanceLocation");
        let address = stated(known.address);
        let place = "calibrationLaboratory/contact";
        let laboratory =
            self.contact("laboratory", known.laboratory, file.laboratory.as_ref(), place, address.is_none());
        let customer = self.contact("customer", known.customer, file.customer.as_ref(), "customer", true);
        let main_signer = stated(known.authorized_by).map(str::to_owned);
        let mut responsible: Vec<String> = Vec::new();
        for name in file.responsible.iter().flatten().map(|name| name.trim()) {
            if main_signer.as_deref() != Some(name) && !responsible.iter().any(|there| there == name) {
                responsible.push(name.to_owned());
            }
        }
        let persons = (main_signer.is_some() || !responsible.is_empty()).then_some(());
        let persons = self.need(&at, "responsible", persons, "a list of names", "respPersons/respPerson/person/name");
        let method = self.agreed(&at, "method", stated(known.method), stated(file.method.as_deref()));
        let needed = if known.method_is_known { Some(method) } else { method.map(Some) };
        let method = self.need(&at, "method", needed, "the method of measurement", "measurementResult/usedMethods");
        let temperature = self.agreed(&at, "temperature_c", known.temperature_c, file.temperature_c);
        let expected = "the temperature during the measurements, in degrees Celsius";
        let element = "measurementResult/influenceConditions";
        let temperature = self.need(&at, "temperature_c", temperature, expected, element);
        if known.serial.is_some_and(|serial| stated(serial).is_none()) {
            let expected = "the serial number of the gyro, for item/identifications";
            self.problems.missing(&at, "--gyro-serial", expected, "use the option");
        }
        if file.traceable == Some(true) && stated(known.traceability).is_none() {
            let expected = "absent, because the certificate states no traceability";
            self.problems.at(&at.key("traceable"), "true", expected, "delete it");
        }
        let first = lang.map(Languages::first).or(file.language).unwrap_or(Language::English);
        let others = lang.into_iter().flat_map(Languages::iter).chain(file.language);
        persons?;
        Some(Facts {
            country: country?,
            languages: Languages::new(first, others),
            mandatory: file.language.unwrap_or(first),
            number: number?.to_owned(),
            received: known.received,
            performed: performed?,
            location: location?,
            issued,
            laboratory: laboratory?,
            address: address.map(str::to_owned),
            customer: customer?,
            main_signer,
            responsible,
            method: method?.map(str::to_owned),
            temperature_c: temperature?,
            traceable: file.traceable,
        })
    }

    /// Returns a required value, or records that its key is missing and the element of the DCC that needs it.
    fn need<T>(&mut self, at: &Path, key: &str, value: Option<T>, expected: &str, element: &str) -> Option<T> {
        if value.is_none() {
            let option = self.options.iter().find(|(of, _)| *of == key);
            let advice = option.map_or_else(String::new, |(_, option)| format!(", or use {option}"));
            self.problems.missing(at, key, format!("{expected}, for {element}"), self.advice.to_owned() + &advice);
        }
        value
    }

    /// Returns the value that is stated, and refuses one in the file that differs from the signed or calculated one.
    fn agreed<T: PartialEq + Display>(&mut self, at: &Path, key: &str, known: Option<T>, file: Option<T>) -> Option<T> {
        match (known, file) {
            (Some(known), Some(file)) if known != file => {
                let expected = format!("{known}, as {} states", self.source);
                self.problems.at(&at.key(key), file.to_string(), expected, "delete it");
                Some(known)
            }
            (known, file) => known.or(file),
        }
    }

    /// Returns the first and the last day: those of the file, which must include the known one, or else the known one.
    fn performed(&mut self, known: &Known, file: Option<&Performed>, issued: Option<Date>) -> Option<[Date; 2]> {
        let at = Path::Root.key("performed");
        let day = |date: Option<Date>| date.or(known.performed);
        let from = day(file.and_then(|file| file.from));
        let to = day(file.and_then(|file| file.to));
        let from = self.need(&at, "from", from, "the first day of the measurements", "coreData/beginPerformanceDate");
        let to = self.need(&at, "to", to, "the last day of the measurements", "coreData/endPerformanceDate");
        let (from, to) = (from?, to?);
        let includes = known.performed.is_none_or(|day| (from..=to).contains(&day));
        if let Some(day) = known.performed.filter(|_| !includes) {
            let expected = format!("days that include {day}, the day of measurement that {} states", self.source);
            self.problems.at(&at, format!("{from} to {to}"), expected, "");
        }
        if let Some(received) = known.received.filter(|received| from < *received) {
            let expected = format!("a date on or after {received}, when the item was received");
            self.problems.at(&at.key("from"), from.to_string(), expected, "");
        }
        if let Some(issued) = issued.filter(|issued| to > *issued) {
            let expected = format!("a date on or before {issued}, when the certificate was issued");
            self.problems.at(&at.key("to"), to.to_string(), expected, "");
        }
        Some([from, to])
    }

    /// Returns name and address of the laboratory or of the customer.
    fn contact(
        &mut self,
        key: &str,
        known: Option<&str>,
        file: Option<&Contact>,
        element: &str,
        needs_city: bool,
    ) -> Option<Contact> {
        let root = Path::Root;
        let at = root.key(key);
        let name = self.agreed(&at, "name", stated(known), file.and_then(|file| stated(file.name.as_deref())));
        let name = self.need(&at, "name", name, "the name", &format!("{element}/name"));
        let city = file.and_then(|file| file.city.as_deref());
        if needs_city {
            self.need(&at, "city", city, "the city", &format!("{element}/location/city"))?;
        }
        Some(Contact {
            name: Some(name?.to_owned()),
            city: city.map(str::to_owned),
            ..file.cloned().unwrap_or_default()
        })
    }
}
