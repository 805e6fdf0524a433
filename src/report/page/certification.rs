//! Record of a certification, which the laboratory keeps ([ISO/IEC
//! 17025:2017](crate::bibliography::Bibliography::Iso17025), 7.5.1): readings, exclusions, tests, components and budget of
//! the uncertainty, the change since the previous certificate, and signature lines.
//!
//! * `evidence`: readings, exclusions, components, tests.
//! * `change`: comparison with the last certificate.

mod change;
mod evidence;

use super::language::{Languages, Text, values};
use super::number::Number;
use super::parts::{
    Section, band, boxed, contents, data_address, date, file_name, given, heading, marked, not_stated, numbered,
    quantity, section, signatures, symbol, verbatim,
};
use super::passport::{characteristics, general};
use super::shell::{Margins, document};
use super::texts::{calibration as calibration_texts, certification as texts, passport as passport_texts, units};
use crate::certification::{Certification, Comparison};
use crate::passport::difference::NumberDifference;
use maud::{Markup, html};

/// Id of the section of the uncertainty.
const UNCERTAINTY: &str = "uncertainty";

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

impl CertificationPage<'_> {
    /// Returns the record as one self-contained HTML document.
    pub(crate) fn html(&self, languages: &Languages) -> String {
        let number = &self.certification.stand.certificate.number;
        let margins = Margins {
            top_left: texts::MARGIN.filled(languages.first(), values! { number }),
            top_right: if self.dry_run { languages.plain(texts::DRAFT) } else { change::running_head(self, languages) },
            bottom_left: texts::MARGIN_SHA256.filled(languages.first(), values! { sha256: self.sha256() }),
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
        let address = data_address("text/csv", self.readings.1);
        let mut sections = vec![("result", texts::RESULT, self.result(languages))];
        sections.extend(change::section(self, languages).map(|change| ("change", texts::CHANGE, change)));
        sections.extend([
            (UNCERTAINTY, texts::UNCERTAINTY, evidence::uncertainty(self, languages)),
            ("tests", texts::TESTS, evidence::tests(self, languages)),
            ("readings", texts::READINGS, evidence::readings(self, languages)),
            ("subject", texts::SUBJECT, self.subject(languages)),
        ]);
        html! {
            header.title {
                p.kind { (languages.label(texts::TITLE)) }
                h1 { (given(stand.stand.model.as_str())) " №\u{a0}" (given(stand.stand.serial.as_str())) ", " (given(&stand.certificate.number)) }
                p.subject { (languages.label(texts::SUBTITLE)) }
            }
            main {
                @if self.dry_run {
                    (boxed("verdict refused", languages.label(texts::DRAFT), languages.paragraph(texts::DRAFT_WORDS)))
                }
                (change::verdict(self, languages))
                (self.band(languages, &sections))
                (contents(languages, texts::SAVE, (&address, file_name(self.readings.0)), &sections, texts::ANNEX))
                (numbered(languages, &sections))
                @if !self.dry_run {
                    (section(languages, "signatures", calibration_texts::SIGNATURES, signatures(languages, who)))
                }
                (self.annex(languages))
            }
        }
    }

    /// Writes who measured the stand and when, until when the certificate is valid, and the uncertainties that all positions
    /// have in common.
    fn band(&self, languages: &Languages, sections: &[Section]) -> Markup {
        let certificate = &self.certification.stand.certificate;
        let arcsec = |u| quantity(languages, &Number::uncertainty(u), units::ARCSEC);
        let u = |value: Option<f64>| value.map_or_else(|| not_stated(languages), arcsec);
        let [of_platform, of_base] = self.certification.freedom_of_common_parts();
        let freedom =
            certificate.repeatability_degrees_of_freedom.map(|number| Number::exact(number).markup(languages));
        let of_part = |freedom: Option<f64>| {
            freedom.map_or_else(|| html! { "–" }, |freedom| Number::at_most(freedom, 1).markup(languages))
        };
        // The limits stand in the section of the uncertainty.
        let number = 1 + sections.iter().position(|(id, ..)| *id == UNCERTAINTY).unwrap_or_default();
        let is_few = [of_platform, of_base].into_iter().flatten().any(|freedom| freedom < evidence::FEW_DEGREES);
        let common = [certificate.common_platform_arcsec, certificate.common_base_arcsec];
        // An estimate of 0 is no proof that there is nothing.
        let is_zero = common.contains(&Some(0.0));
        let common = common.map(u);
        let on = |name: Text, day| html! { p { (languages.inline(name)) ": " (date(languages, day)) } };
        band(
            languages,
            [
                (
                    passport_texts::LABORATORY,
                    given(&certificate.laboratory),
                    certificate.performed.map_or_else(|| html! {}, |day| on(passport_texts::PERFORMED, day)),
                ),
                (
                    passport_texts::VALID_UNTIL,
                    certificate.valid_until.map_or_else(|| not_stated(languages), |day| date(languages, day)),
                    on(passport_texts::CERTIFICATE_ISSUED, certificate.issued),
                ),
                (
                    passport_texts::REPEATABILITY,
                    u(certificate.repeatability_arcsec),
                    html! { p { (languages.label(texts::OF_A_VISIT)) } @if let Some(freedom) = freedom { p { (symbol("ν", "")) "\u{a0}=\u{a0}" (freedom) } } },
                ),
                (
                    texts::COMMON_PARTS,
                    html! { (common[0]) "; " (common[1]) },
                    html! {
                        p { (languages.label(texts::STANDARD)) }
                        p {
                            (symbol("ν", "")) "\u{a0}=\u{a0}" (of_part(of_platform)) "; " (of_part(of_base))
                            @if is_few {
                                " (" (languages.inline_with(|language| texts::FEW.filled(language, values! { number }))) ")"
                            }
                        }
                        @if is_zero { p { (languages.label_with(|language| texts::ZERO.filled(language, values! { number }))) } }
                    },
                ),
            ],
        )
    }

    fn subject(&self, languages: &Languages) -> Markup {
        let stand = &self.certification.stand;
        html! {
            (general::stand(&stand.stand, languages))
            (general::certificate(&stand.certificate, languages))
            (heading(languages, passport_texts::DATUM))
            (characteristics::datum(stand.datum.as_ref(), languages))
        }
    }

    fn result(&self, languages: &Languages) -> Markup {
        html! {
            (characteristics::positions(&self.certification.stand.positions, languages))
            (characteristics::deviations_note(&self.certification.stand.positions, false, languages))
            (self.outliers(languages))
        }
    }

    /// Writes which readings in the means the tests name.
    fn outliers(&self, languages: &Languages) -> Markup {
        let mut named: Vec<_> =
            self.certification.suspects.outliers.iter().map(|out| (out.index, out.run, out.probability)).collect();
        named.dedup_by_key(|(index, run, _)| (*index, *run));
        let Some(worst) = named.iter().map(|(.., p)| *p).reduce(f64::min) else { return html! {} };
        languages.paragraph_with(|language| {
            let readings: Vec<String> = named
                .iter()
                .map(|(index, run, _)| texts::READING_OF.filled(language, values! { index, run }))
                .collect();
            let (readings, section) = (readings.join(", "), texts::TESTS);
            marked(
                evidence::graded(worst),
                &html! { (texts::WITH_OUTLIERS.filled(language, values! { readings, section })) },
            )
        })
    }

    /// Writes the file of readings verbatim.
    fn annex(&self, languages: &Languages) -> Markup {
        let (_, bytes) = self.readings;
        let number = &self.certification.stand.certificate.number;
        let text = String::from_utf8_lossy(bytes).replace("\r\n", "\n");
        let end = languages.label_with(|language| texts::END.filled(language, values! { number }));
        let body = html! { (languages.paragraph(texts::ANNEX_NOTE)) (verbatim("", &text, &end)) };
        section(languages, "annex", texts::ANNEX, body)
    }
}
