//! Administrative file (`dtg-dcc/1`): what a DCC must state and neither a passport nor a calibration contains.
// `record!` declares public types.
#![allow(unreachable_pub)]

use crate::report::Language;
use crate::stand::check_not_empty;
use crate::text::{Document, Field, Node, Path, Problems, Unreadable, record, word_of_a_key, words, yaml};
use jiff::civil::Date;

words! {
    /// Place of the measurements, in the words of the DCC.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[cfg_attr(feature = "generate", derive(schemars::JsonSchema), schemars(rename_all = "camelCase"))]
    pub enum Location: pub(super) word {
        /// Permanent laboratory.
        Laboratory = "laboratory",
        /// Premises of the customer.
        Customer = "customer",
        /// Branch of the laboratory.
        LaboratoryBranch = "laboratoryBranch",
        /// Branch of the customer.
        CustomerBranch = "customerBranch",
        /// Another place.
        Other = "other",
    }
}

word_of_a_key!(Location, word, "");
word_of_a_key!(Language, tag, " (ISO 639-1), the languages in which this program writes");

record! {
    /// Name and address of the laboratory or of the customer.
    #[derive(Default)]
    pub struct Contact {
        /// Name; omit it if the passport states it.
        pub name: Option<String>,
        /// City; required for the customer, and for the laboratory unless the passport has its address.
        pub city: Option<String>,
        /// Street.
        pub street: Option<String>,
        /// House number.
        pub street_no: Option<String>,
        /// Postcode.
        pub post_code: Option<String>,
        /// Post office box.
        pub post_office_box: Option<String>,
        /// State or region.
        pub state: Option<String>,
        /// Country: two capital letters of ISO 3166-1.
        pub country: Option<String>,
        /// E-mail address.
        pub email: Option<String>,
        /// Telephone number.
        pub phone: Option<String>,
    }
}

record! {
    /// Days of the measurements.
    pub struct Performed {
        /// First day.
        pub from: Option<Date>,
        /// Last day.
        pub to: Option<Date>,
    }
}

record! {
    /// Administrative data of a Digital Calibration Certificate (`dtg-dcc/1`). What passport or calibration
    /// states may be omitted; the program lists what is missing.
    #[derive(Default)]
    pub struct Administrative {
        /// Country of issue: two capital letters of ISO 3166-1.
        pub country: Option<String>,
        /// Mandatory language; the first of `--lang` if absent.
        pub language: Option<Language>,
        /// Place of the measurements.
        pub location: Option<Location>,
        /// Calibration laboratory.
        pub laboratory: Option<Contact>,
        /// Customer.
        pub customer: Option<Contact>,
        /// Further responsible persons.
        pub responsible: Option<Vec<String>>,
        /// Days of the measurements, unless the passport states the day.
        pub performed: Option<Performed>,
        /// Number of the certificate of a gyro.
        pub number: Option<String>,
        /// Date of issue of the certificate of a gyro.
        pub issued: Option<Date>,
        /// Method, if the passport states none.
        pub method: Option<String>,
        /// Temperature, if the passport states none.
        pub temperature_c: Option<f64>,
        /// Whether the stated traceability is a chain of calibrations to the SI.
        pub traceable: Option<bool>,
    }
}

impl Document for Administrative {
    const FORMAT: &'static str = "dtg-dcc/1";
}

impl Administrative {
    pub(crate) fn from_yaml(name: &str, bytes: &[u8]) -> Result<Self, Unreadable> {
        yaml::read_document(name, bytes, |file: &Self, problems| file.check(problems))
    }

    fn check(&self, problems: &mut Problems) {
        let at = Path::Root;
        check_country(self.country.as_deref(), &at, problems);
        for (key, contact) in [("laboratory", &self.laboratory), ("customer", &self.customer)] {
            let country = contact.as_ref().and_then(|contact| contact.country.as_deref());
            check_country(country, &at.key(key), problems);
        }
        check_not_empty(self.responsible.as_ref(), &at.key("responsible"), "at least one name", problems);
        // The schema of the DCC has no empty texts. A country without a code is already reported.
        let mut check_text = |at: &Path, scalar: &Node| {
            if matches!(scalar, Node::Text(text) if text.trim().is_empty()) && at.last_key() != "country" {
                problems.at(at, "only spaces", "text", "enter text, or omit the key");
            }
        };
        self.write().iter().for_each(|node| node.each_scalar(&at, &mut check_text));
        problems.within(&at.key("temperature_c"), self.temperature_c, -90.0, 100.0);
        if let Some(Performed { from: Some(from), to: Some(to) }) = self.performed
            && to < from
        {
            let expected = format!("a date on or after from, {from}");
            problems.at(&at.key("performed").key("to"), to.to_string(), expected, "");
        }
    }
}

fn check_country(code: Option<&str>, at: &Path, problems: &mut Problems) {
    if let Some(code) = code.filter(|code| !is_country(code)) {
        let expected = "a country code of ISO 3166-1, two capital letters such as \"DE\"";
        problems.at(&at.key("country"), format!("{code:?}"), expected, "");
    }
}

/// Country codes of ISO 3166-1 (alpha-2), as officially assigned, in alphabetical order.
const COUNTRY_CODES: &str = include_str!("countries.txt");

fn is_country(text: &str) -> bool {
    COUNTRY_CODES.split_ascii_whitespace().any(|code| code == text)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: ISO 3166-1 assigns 249 codes.
    #[test]
    fn there_are_249_codes_in_order() {
        let codes: Vec<&str> = COUNTRY_CODES.split_ascii_whitespace().collect();
        assert_eq!(codes.len(), 249);
        assert!(codes.is_sorted() && codes.iter().all(|code| code.len() == 2));
        assert!(is_country("DE") && !is_country("de") && !is_country("XX") && !is_country("DE FR") && !is_country(""));
    }
}
