//! Record of a certification, which the laboratory keeps ([ISO/IEC
//! 17025:2017](crate::bibliography::Bibliography::Iso17025), 7.5.1): readings, exclusions, tests, components and budget of
//! the uncertainty, the change since the previous certificate, and signature lines.

use super::language::Languages;
use super::parts::{file_name, signatures};
use super::shell::{Annex, Page, Section, first};
use crate::certification::{Certification, Comparison};
use crate::passport::difference::NumberDifference;
use crate::report::certification::{change, evidence, outcome_of, outcome_of_certification};
use crate::report::doc::{self, Block, Words, heading, joined, marked, note, outcome_box, say, stated, symbol, told};
use crate::report::passport::{deviations, general};
use crate::wording::texts::{certification as texts, passport as passport_texts, units};
use crate::wording::{Number, Outcome, Text};

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
        let stand = &self.certification.stand;
        let number = &stand.certificate.number;
        let (outcome, headline, reasons) = self.verdict();
        // A headline of a stand that has changed stands at the head of every sheet.
        let warning = match outcome {
            _ if self.dry_run => texts::DRAFT.into(),
            Outcome::Failed => first(headline.clone()),
            _ => "".into(),
        };
        let draft =
            self.dry_run.then(|| Block::Boxed("verdict refused", texts::DRAFT.into(), vec![say([texts::DRAFT_WORDS])]));
        let sections = self.sections();
        // The limits stand in the section of the uncertainty.
        let uncertainty = 1 + sections.iter().position(|(id, ..)| *id == UNCERTAINTY).unwrap_or_default();
        let head = draft.into_iter().chain([outcome_box(outcome, headline, reasons), self.band(uncertainty)]);
        let who = [texts::MEASURED_BY, texts::CHECKED_BY, passport_texts::AUTHORISED_BY];
        let [model, serial] = [stand.stand.model.as_str(), stand.stand.serial.as_str()].map(doc::given);
        let page = Page {
            margins: [first(texts::margin(number)), warning, first(texts::margin_sha256(self.sha256()))],
            name: doc::given(number),
            title: (
                texts::TITLE,
                vec![model, " №\u{a0}".into(), serial, ", ".into(), doc::given(number)].into(),
                texts::SUBTITLE.into(),
            ),
            head: head.collect(),
            front: None,
            sections,
            signatures: if self.dry_run { Vec::new() } else { signatures(who).into() },
            annex: Annex {
                heading: texts::ANNEX,
                note: texts::ANNEX_NOTE.into(),
                save: texts::SAVE,
                name: file_name(self.readings.0),
                media: "text/csv",
                tag: "",
                bytes: self.readings.1.into(),
                end: told(texts::end(number)),
                is_printed: true,
            },
        };
        page.html(languages)
    }

    /// Returns the SHA-256 of the file of readings.
    fn sha256(&self) -> String {
        crate::document::sha256_hex(self.readings.1)
    }

    fn sections(&self) -> Vec<Section> {
        let (certificate, positions) = (&self.certification.stand.certificate, &self.certification.stand.positions);
        let mut result = deviations::certified(certificate, positions);
        result.push(evidence::outliers(self.certification));
        let mut sections = vec![("result", texts::RESULT, result)];
        sections.extend(self.change.as_ref().map(|(found, changes)| {
            let of_deviations = change::deviations(&found.certificate, changes);
            ("change", texts::CHANGE, [change::rotations(found), of_deviations.into()].concat())
        }));
        let mut uncertainty = vec![heading(texts::BUDGET), deviations::budget(certificate, positions)];
        uncertainty.extend(evidence::components(self.certification));
        sections.extend([
            (UNCERTAINTY, texts::UNCERTAINTY, uncertainty),
            ("tests", texts::TESTS, self.tests()),
            ("readings", texts::READINGS, self.readings()),
            ("subject", texts::SUBJECT, self.subject()),
        ]);
        sections
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
        let findings = found.findings.iter().map(|finding| finding.remark.words.clone()).collect();
        (outcome, verdict, vec![Block::List(findings), say(remedy), warnings])
    }

    /// The band below the title: measurement, expiry date, and the uncertainties that all positions have in common.
    /// `uncertainty` is the number of the section with their limits.
    fn band(&self, uncertainty: usize) -> Block {
        let certificate = &self.certification.stand.certificate;
        let u = |value: Option<f64>| stated(value.map(|u| Words::Quantity(Number::uncertainty(u), units::ARCSEC)));
        let nu = |freedom: Words| Words::All(vec![symbol("ν"), "\u{a0}=\u{a0}".into(), freedom]);
        let of_parts = self.certification.freedom_of_common_parts();
        let is_few = of_parts.into_iter().flatten().any(|freedom| freedom < evidence::FEW_DEGREES);
        let common = [certificate.common_platform_arcsec, certificate.common_base_arcsec];
        let [of_platform, of_base] = of_parts.map(|freedom| freedom.map(|freedom| Number::at_most(freedom, 1)).into());
        let mut freedom = vec![nu(of_platform), "; ".into(), of_base];
        if is_few {
            freedom.extend([" (".into(), texts::few(uncertainty), ")".into()]);
        }
        let inline = |words: Vec<Words>| note(Words::Inline(Box::new(words.into())));
        let mut of_common = vec![note(texts::STANDARD), inline(freedom)];
        // An estimate of 0 is no proof that there is nothing.
        of_common.extend(common.contains(&Some(0.0)).then(|| note(told(texts::zero(uncertainty)))));
        let on = |name: Text, day| inline(vec![name.into(), ": ".into(), Words::Date(day)]);
        let of_visits =
            certificate.repeatability_degrees_of_freedom.map(|number| note(nu(Number::exact(number).into())));
        let performed = certificate.performed.map(|day| on(passport_texts::PERFORMED, day));
        Block::Band(vec![
            (passport_texts::LABORATORY, doc::given(&certificate.laboratory), performed.into_iter().collect()),
            (
                passport_texts::VALID_UNTIL,
                stated(certificate.valid_until),
                vec![on(passport_texts::CERTIFICATE_ISSUED, certificate.issued)],
            ),
            (
                passport_texts::REPEATABILITY,
                u(certificate.repeatability_arcsec),
                [note(texts::OF_A_VISIT)].into_iter().chain(of_visits).collect(),
            ),
            (texts::COMMON_PARTS, joined(common.map(u), "; "), of_common),
        ])
    }

    fn subject(&self) -> Vec<Block> {
        let stand = &self.certification.stand;
        let mut all = general::stand(&stand.stand);
        all.extend([general::certificate(&stand.certificate), heading(passport_texts::DATUM)]);
        all.push(deviations::datum(stand.datum.as_ref()));
        all
    }

    fn tests(&self) -> Vec<Block> {
        let remarks: Vec<Words> = self.certification.remarks.iter().map(|remark| remark.words.clone()).collect();
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
        [vec![doc::fields(fields)], evidence::exclusions(self.certification)].concat()
    }
}
