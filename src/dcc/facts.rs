//! Facts that every DCC states: from what is signed or calculated, and from the administrative file. What is missing is
//! named all at once, and what contradicts the signed passport is refused.

use super::administrative::{Administrative, Contact};
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
pub(super) struct Facts<'a> {
    /// Languages of the program's words.
    pub languages: Languages,
    pub mandatory: Language,
    pub received: Option<Date>,
    pub address: Option<&'a str>,
    /// Person who authorised the certificate.
    pub main_signer: Option<&'a str>,
    /// First and last day of the measurements.
    pub performed: [Date; 2],
    /// The administrative file, completed by the known facts; `responsible` has only the persons besides the main signer.
    pub file: Administrative,
}

impl<'a> Facts<'a> {
    /// Collects the facts. `lang` are the languages that were asked for.
    ///
    /// # Errors
    /// Returns every missing key and every contradiction to `known`, by their paths in the administrative file.
    pub(super) fn collect(
        known: &Known<'a>,
        file: Option<&Administrative>,
        lang: Option<&Languages>,
    ) -> Result<Self, Problems> {
        let advice = match file {
            Some(_) => "add it",
            None => "add it to a file for --administrative",
        };
        let Known { source, options, .. } = *known;
        let mut collector = Collector { source, advice, options, problems: Problems::default() };
        let facts = collector.facts(known, file.cloned().unwrap_or_default(), lang);
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
    fn facts<'a>(
        &mut self,
        known: &Known<'a>,
        mut file: Administrative,
        lang: Option<&Languages>,
    ) -> Option<Facts<'a>> {
        let at = Path::Root;
        let expected = "a country code of ISO 3166-1 such as \"DE\"";
        self.need(&at, "country", &file.country, expected, "coreData/countryCodeISO3166_1");
        file.number = self.agreed_text(&at, "number", known.number, file.number.as_deref());
        self.need(&at, "number", &file.number, "the number of the certificate", "coreData/uniqueIdentifier");
        file.issued = self.agreed(&at, "issued", known.issued, file.issued);
        let performed = self.performed(known, &file);
        let expected = "the place of the measurements, such as \"laboratory\"";
        self.need(&at, "location", &file.location, expected, "coreData/performanceLocation");
        let address = stated(known.address);
        let place = "calibrationLaboratory/contact";
        file.laboratory = self.contact("laboratory", known.laboratory, file.laboratory, place, address.is_none());
        file.customer = self.contact("customer", known.customer, file.customer, "customer", true);
        let main_signer = stated(known.authorized_by);
        let mut responsible: Vec<String> = Vec::new();
        for name in file.responsible.iter().flatten().map(|name| name.trim()) {
            if main_signer != Some(name) && !responsible.iter().any(|there| there == name) {
                responsible.push(name.to_owned());
            }
        }
        let persons = main_signer.or(responsible.first().map(String::as_str));
        self.need(&at, "responsible", &persons, "a list of names", "respPersons/respPerson/person/name");
        file.responsible = Some(responsible);
        file.method = self.agreed_text(&at, "method", known.method, file.method.as_deref());
        if !known.method_is_known {
            self.need(&at, "method", &file.method, "the method of measurement", "measurementResult/usedMethods");
        }
        file.temperature_c = self.agreed(&at, "temperature_c", known.temperature_c, file.temperature_c);
        let expected = "the temperature during the measurements, in degrees Celsius";
        self.need(&at, "temperature_c", &file.temperature_c, expected, "measurementResult/influenceConditions");
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
        Some(Facts {
            languages: Languages::new(first, others),
            mandatory: file.language.unwrap_or(first),
            received: known.received,
            address,
            main_signer,
            performed: performed?,
            file,
        })
    }

    /// Records that a required key is missing, with the element of the DCC that needs it.
    fn need<T>(&mut self, at: &Path, key: &str, value: &Option<T>, expected: &str, element: &str) {
        if value.is_none() {
            let option = self.options.iter().find(|(of, _)| *of == key);
            let advice = option.map_or_else(String::new, |(_, option)| format!(", or use {option}"));
            self.problems.missing(at, key, format!("{expected}, for {element}"), self.advice.to_owned() + &advice);
        }
    }

    /// Returns the value that is stated, and refuses one in the file that differs from the signed or calculated one.
    fn agreed<T: PartialEq + Display>(&mut self, at: &Path, key: &str, known: Option<T>, file: Option<T>) -> Option<T> {
        if let (Some(known), Some(file)) = (&known, &file)
            && known != file
        {
            let expected = format!("{known}, as {} states", self.source);
            self.problems.at(&at.key(key), file.to_string(), expected, "delete it");
        }
        known.or(file)
    }

    fn agreed_text(&mut self, at: &Path, key: &str, known: Option<&str>, file: Option<&str>) -> Option<String> {
        self.agreed(at, key, stated(known), stated(file)).map(str::to_owned)
    }

    /// Returns the first and the last day: those of the file, which must include the known one, or else the known one.
    fn performed(&mut self, known: &Known, file: &Administrative) -> Option<[Date; 2]> {
        let at = Path::Root.key("performed");
        let [from, to] = file.performed.as_ref().map_or([None; 2], |days| [days.from, days.to]);
        let (from, to) = (from.or(known.performed), to.or(known.performed));
        self.need(&at, "from", &from, "the first day of the measurements", "coreData/beginPerformanceDate");
        self.need(&at, "to", &to, "the last day of the measurements", "coreData/endPerformanceDate");
        let (from, to) = (from?, to?);
        if let Some(day) = known.performed.filter(|day| !(from..=to).contains(day)) {
            let expected = format!("days that include {day}, the day of measurement that {} states", self.source);
            self.problems.at(&at, format!("{from} to {to}"), expected, "");
        }
        if let Some(received) = known.received.filter(|received| from < *received) {
            let expected = format!("a date on or after {received}, when the item was received");
            self.problems.at(&at.key("from"), from.to_string(), expected, "");
        }
        if let Some(issued) = file.issued.filter(|issued| to > *issued) {
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
        file: Option<Contact>,
        element: &str,
        needs_city: bool,
    ) -> Option<Contact> {
        let root = Path::Root;
        let (at, file) = (root.key(key), file.unwrap_or_default());
        let name = self.agreed_text(&at, "name", known, file.name.as_deref());
        self.need(&at, "name", &name, "the name", &format!("{element}/name"));
        if needs_city {
            self.need(&at, "city", &file.city, "the city", &format!("{element}/location/city"));
        }
        Some(Contact { name, ..file })
    }
}
