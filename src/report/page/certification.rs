//! Record of a certification, which the laboratory keeps ([ISO/IEC
//! 17025:2017](crate::bibliography::Bibliography::Iso17025), 7.5.1): readings, exclusions, tests, components and budget of
//! the uncertainty, the change since the previous certificate, and signature lines.

use super::language::{Language, Languages, Text};
use super::number::Number;
use super::parts::{
    self, Section, band, boxed, contents, data_address, date, file_name, given, not_stated, numbered, outcome_box,
    quantity, section, signatures, symbol, verbatim,
};
use super::shell::{Margins, document};
use crate::certification::finding::Finding;
use crate::certification::remark::Remark;
use crate::certification::{Certification, Comparison};
use crate::passport::difference::NumberDifference;
use crate::report::certification::{change, evidence, outcome_of, outcome_of_certification};
use crate::report::doc::{self, Block, Words, heading, marked, say};
use crate::report::passport::{deviations, general};
use crate::report::style::Outcome;
use crate::wording::texts::{
    calibration as calibration_texts, certification as texts, passport as passport_texts, units,
};
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
            top_left: texts::margin(number).plain(languages.first()),
            top_right: if self.dry_run { languages.plain(texts::DRAFT) } else { self.running_head(languages.first()) },
            bottom_left: texts::margin_sha256(self.sha256()).plain(languages.first()),
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
        let (outcome, headline, reasons) = self.verdict();
        let composed = |id, heading, words: Vec<Block>| (id, heading, doc::blocks(&words, languages));
        let mut sections = vec![("result", texts::RESULT, self.result(languages))];
        sections.extend(self.change.as_ref().map(|(found, changes)| {
            let of_deviations = change::deviations(&found.certificate, changes);
            composed("change", texts::CHANGE, [change::rotations(found), of_deviations.into()].concat())
        }));
        sections.extend([
            (UNCERTAINTY, texts::UNCERTAINTY, self.uncertainty(languages)),
            composed("tests", texts::TESTS, self.tests()),
            composed("readings", texts::READINGS, self.readings()),
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
                (outcome_box(outcome, &headline.label(languages), doc::blocks(&reasons, languages)))
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

    /// Returns whether the stand has changed since its last certificate, in a headline, and the reasons.
    fn verdict(&self) -> (Outcome, Words, Vec<Block>) {
        let warnings = say([texts::warnings_counted(self.certification.remarks.len(), texts::TESTS)]);
        let Some((found, _)) = &self.change else {
            let headline = texts::certified(self.certification.stand.positions.len(), self.certification.runs.len());
            let not_compared = say([marked(Outcome::NotAsked, texts::NOT_COMPARED)]);
            return (outcome_of_certification(self.certification), headline, vec![not_compared, warnings]);
        };
        let outcome = outcome_of(found, found.same_stand);
        let (verdict, remedy) = match outcome {
            Outcome::Passed => (texts::same(&found.certificate), None),
            Outcome::Failed => (texts::changed(&found.certificate), Some(texts::CHANGED_WORDS)),
            Outcome::Undecided | Outcome::NotAsked => {
                (texts::undecided(&found.certificate), Some(texts::UNDECIDED_WORDS))
            }
        };
        let findings = found.findings.iter().map(Finding::words).collect();
        (outcome, verdict, vec![Block::List(findings), say(remedy), warnings])
    }

    /// Returns the headline of a stand that has changed, for the head of every sheet; otherwise nothing.
    fn running_head(&self, language: Language) -> String {
        match self.verdict() {
            (Outcome::Failed, headline, _) => headline.plain(language),
            _ => String::new(),
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
                                " (" (languages.inline_with(|language| texts::few(number).plain(language))) ")"
                            }
                        }
                        @if is_zero { p { (languages.label_with(|language| texts::zero(number).plain(language))) } }
                    },
                ),
            ],
        )
    }

    fn subject(&self, languages: &Languages) -> Markup {
        let stand = &self.certification.stand;
        let mut all = general::stand(&stand.stand);
        all.extend([general::certificate(&stand.certificate), doc::heading(passport_texts::DATUM)]);
        all.push(deviations::datum(stand.datum.as_ref()));
        doc::blocks(&all, languages)
    }

    fn result(&self, languages: &Languages) -> Markup {
        let positions = &self.certification.stand.positions;
        html! {
            (doc::blocks(&deviations::table(positions, "u"), languages))
            (doc::blocks(&[deviations::note(positions, false)], languages))
            (doc::blocks(&[evidence::outliers(self.certification)], languages))
        }
    }

    fn uncertainty(&self, languages: &Languages) -> Markup {
        html! {
            (parts::heading(languages, texts::BUDGET))
            (doc::blocks(&[deviations::common(&self.certification.stand.certificate)], languages))
            (doc::blocks(&evidence::components(self.certification), languages))
        }
    }

    fn tests(&self) -> Vec<Block> {
        let remarks: Vec<Words> = self.certification.remarks.iter().map(Remark::words).collect();
        let warnings = if remarks.is_empty() { None } else { Some([heading(texts::WARNINGS), Block::List(remarks)]) };
        evidence::tests(self.certification).into_iter().chain(warnings.into_iter().flatten()).collect()
    }

    fn readings(&self) -> Vec<Block> {
        let Certification { runs, repeated_rows, stand, .. } = self.certification;
        let each = runs.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
        let fields = [
            (texts::FILE, Words::Given(file_name(self.readings.0).to_owned()), false),
            (texts::RUNS, format!("{} ({each})", runs.len()).into(), false),
            (texts::POSITIONS, stand.positions.len().into(), false),
            (texts::REPEATED, (*repeated_rows).into(), false),
            (texts::FILE_SHA256, Words::Code(self.sha256()), true),
        ];
        [vec![doc::fields(fields.into())], evidence::exclusions(self.certification)].concat()
    }

    /// Writes the file of readings verbatim.
    fn annex(&self, languages: &Languages) -> Markup {
        let (_, bytes) = self.readings;
        let number = &self.certification.stand.certificate.number;
        let text = String::from_utf8_lossy(bytes).replace("\r\n", "\n");
        let end = languages.label_with(|language| texts::end(number).plain(language));
        let body = html! { (languages.paragraph(texts::ANNEX_NOTE)) (verbatim("", &text, &end)) };
        section(languages, "annex", texts::ANNEX, body)
    }
}
