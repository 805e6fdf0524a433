//! Record of a certification, which the laboratory keeps ([ISO/IEC
//! 17025:2017](crate::bibliography::Bibliography::Iso17025), 7.5.1): readings, exclusions, tests, components and budget of
//! the uncertainty, the change since the previous certificate, and signature lines.
//!
//! * `evidence`: readings, exclusions, components, tests.
//! * `change`: comparison with the last certificate.

mod change;
mod evidence;
pub(crate) mod remarks;

use super::language::{Languages, Text};
use super::parts::{boxed, contents, data_address, file_name, given, heading, section as part, signatures, verbatim};
use super::passport::{characteristics, general};
use super::shell::{Margins, document};
use super::texts::{calibration as calibration_texts, certification as texts, passport as passport_texts};
use crate::certification::{Certification, Comparison};
use crate::passport::difference::NumberDifference;
use maud::{Markup, html};

/// Certification with everything that its record states.
#[derive(Debug, Clone)]
pub(crate) struct CertificationPage<'a> {
    /// Certification, with the evidence for its numbers.
    pub certification: &'a Certification,
    /// Name and content of the file of readings.
    pub readings: (&'a str, &'a [u8]),
    /// Comparison with the last certificate, and the deviations of both; `None` without an earlier one.
    pub change: Option<(&'a Comparison, Vec<NumberDifference>)>,
    /// `true` if the certificate was not written, only computed.
    pub dry_run: bool,
}

/// Anchor and heading of each section of the record.
const SECTIONS: [(&str, Text); 7] = [
    ("subject", texts::SUBJECT),
    ("readings", texts::READINGS),
    ("result", texts::RESULT),
    ("uncertainty", texts::UNCERTAINTY),
    ("tests", texts::TESTS),
    ("change", texts::CHANGE),
    ("annex", texts::ANNEX),
];

impl CertificationPage<'_> {
    /// Returns the record as one self-contained HTML document.
    pub(crate) fn html(&self, languages: &Languages) -> String {
        let number = &self.certification.stand.certificate.number;
        let margins = Margins {
            top_left: texts::MARGIN.filled(languages.first(), &[("number", number)]),
            top_right: if self.dry_run { languages.plain(texts::DRAFT) } else { String::new() },
            bottom_left: texts::MARGIN_SHA256.filled(languages.first(), &[("sha256", &self.sha256())]),
        };
        let title = format!("{} {number}", languages.plain(texts::TITLE));
        document(languages, &title, &margins, &self.body(languages))
    }

    /// Returns the SHA-256 of the file of readings.
    fn sha256(&self) -> String {
        crate::document::sha256_hex(self.readings.1)
    }

    fn body(&self, languages: &Languages) -> Markup {
        let stand = &self.certification.stand;
        let who = [texts::MEASURED_BY, texts::CHECKED_BY, passport_texts::AUTHORISED_BY];
        html! {
            header.title {
                p.kind { (languages.label(texts::TITLE)) }
                h1 { (given(stand.stand.model.as_str())) " №\u{a0}" (given(stand.stand.serial.as_str())) ", " (given(&stand.certificate.number)) }
                p.subject { (languages.label(texts::SUBTITLE)) }
            }
            (contents(languages, texts::SAVE, (&data_address("text/csv", self.readings.1), file_name(self.readings.0)), &SECTIONS))
            main {
                @if self.dry_run {
                    (boxed("verdict refused", languages.label(texts::DRAFT), languages.paragraph(texts::DRAFT_WORDS)))
                }
                (change::verdict(self, languages))
                (part(languages, "subject", "1", texts::SUBJECT, &html! {
                    (general::stand(&stand.stand, languages))
                    (general::certificate(&stand.certificate, languages))
                    (heading(languages, passport_texts::DATUM))
                    (characteristics::datum(stand.datum.as_ref(), languages))
                }))
                (evidence::readings(self, languages))
                (self.result(languages))
                (evidence::uncertainty(self, languages))
                (evidence::tests(self, languages))
                (change::section(self, languages))
                @if !self.dry_run {
                    (part(languages, "signatures", "", calibration_texts::SIGNATURES, &signatures(languages, who)))
                }
                (self.annex(languages))
            }
        }
    }

    fn result(&self, languages: &Languages) -> Markup {
        let positions = &self.certification.stand.positions;
        let body = html! {
            (characteristics::positions(positions, languages))
            (languages.paragraph(passport_texts::DEVIATIONS_NOTE))
        };
        part(languages, "result", "3", texts::RESULT, &body)
    }

    /// Writes the file of readings verbatim.
    fn annex(&self, languages: &Languages) -> Markup {
        let (_, bytes) = self.readings;
        let number = &self.certification.stand.certificate.number;
        let text = String::from_utf8_lossy(bytes).replace("\r\n", "\n");
        let end = languages.label_with(|language| texts::END.filled(language, &[("number", number)]));
        let body = html! { (languages.paragraph(texts::ANNEX_NOTE)) (verbatim("", &text, &end)) };
        part(languages, "annex", "", texts::ANNEX, &body)
    }
}
