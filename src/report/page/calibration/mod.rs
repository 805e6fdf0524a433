//! Printable report of a gyro calibration: gyro, stand, passport, result, uncertainty, signature lines.
//!
//! The numbers are those of [`CalibrationDocument`], which `calibrate --format json` writes; the annex is that file.
//!
//! * `subject`: gyro, stand, passport and its verification, currents, laboratory.
//! * `closing`: signatures, and the annex.

mod closing;
mod subject;

use super::language::{Language, Languages};
use super::parts::{Section, boxed, contents, data_address, marked, numbered, outcome_box};
use super::passport::PassportPage;
use super::shell::{Margins, document};
use super::symbols::italic;
use crate::calibration::Calibration;
use crate::calibration::document::CalibrationDocument;
use crate::calibration::stated::NotStated;
use crate::calibration::verdict::{Decision, Verdict};
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::passport::Content;
use crate::report::calibration::{Report, causes, counted, symbols, why_no_change};
use crate::report::style::Outcome;
use crate::report::{doc, uncertainty};
use crate::uncertainty::{Budget, MonteCarlo};
use crate::wording::texts::calibration as texts;
use crate::wording::{Words, date_text};
use jiff::Timestamp;
use maud::{Markup, html};

/// Digits of the SHA-256 of the currents in the name of a report.
const NAMED_DIGITS: usize = 8;

/// The passport used for a calibration.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum UsedPassport<'a> {
    /// A passport that passed every requested check.
    Verified(Box<PassportPage<'a>>),
    /// A passport that was not verified; the report says so in large letters.
    NotVerified {
        /// Content of the passport.
        content: &'a Content,
        /// SHA-256 of the passport's file, lower-case hexadecimal.
        sha256: String,
    },
}

impl UsedPassport<'_> {
    fn content(&self) -> &Content {
        match self {
            Self::Verified(page) => &page.content,
            Self::NotVerified { content, .. } => content,
        }
    }

    fn sha256(&self) -> &str {
        match self {
            Self::Verified(page) => &page.sha256,
            Self::NotVerified { sha256, .. } => sha256,
        }
    }
}

/// A calibration of a gyro with everything that its report states.
#[derive(Debug, Clone)]
pub struct CalibrationPage<'a> {
    /// Passport used for the calibration.
    pub passport: UsedPassport<'a>,
    /// Time of the calibration: the time for which the passport was verified.
    pub time: Timestamp,
    /// Name of the currents file, and its SHA-256 in lower-case hexadecimal.
    pub currents: (&'a str, String),
    /// Type of the gyro, if specified.
    pub gyro: Option<&'a GyroType>,
    /// Laboratory. If it is `None`, [`Laboratory::paper`] was used, and the report says so.
    pub laboratory: Option<&'a Laboratory>,
    /// Calibration, with the diagnosis of possible mistakes and the methods that gave no result.
    pub calibration: &'a Calibration,
    /// Inputs whose uncertainty no file states.
    pub missing: &'a [NotStated],
    /// Result as the JSON document that programs read.
    pub document: &'a CalibrationDocument,
    /// Earlier results of the gyro, from the earliest to the latest.
    pub previous: &'a [CalibrationDocument],
    /// Uncertainty budget, if requested.
    pub budget: Option<&'a Budget>,
    /// Coverage intervals from a Monte Carlo run, if requested.
    pub monte_carlo: Option<&'a MonteCarlo>,
    /// `true` for residuals that fit, methods that agree, and the risk of simple acceptance too.
    pub details: bool,
}

impl CalibrationPage<'_> {
    /// Returns the report as one self-contained HTML document.
    pub fn html(&self, languages: &Languages) -> String {
        let name = self.name(languages.first());
        let margins = Margins {
            top_left: texts::margin(&name).plain(languages.first()),
            top_right: match (self.verified(), self.fits(), &self.document.mistake) {
                (false, ..) => languages.plain(texts::NOT_VERIFIED),
                (true, false, _) => languages.plain(texts::DOES_NOT_FIT),
                (true, true, Some(_)) => languages.plain(texts::MISTAKE),
                (true, true, None) => self.reservation(languages),
            },
            bottom_left: texts::margin_sha256(&self.currents.1).plain(languages.first()),
        };
        let title = format!("{}: {name}", languages.plain(texts::TITLE));
        document(languages, &title, &margins, &self.body(languages))
    }

    /// Returns the headline of parameters that fail, or of a temperature outside the certified range, for the head of every
    /// sheet.
    fn reservation(&self, languages: &Languages) -> String {
        match self.judged().filter(|(_, verdict)| verdict.overall == Decision::Fail) {
            Some((gyro, _)) => texts::conforms_not(&gyro.r#type).plain(languages.first()),
            None if subject::outside(self).is_some() => languages.plain(texts::TEMPERATURE_IS_OUTSIDE),
            None => String::new(),
        }
    }

    fn content(&self) -> &Content {
        self.passport.content()
    }

    fn report(&self) -> Report<'_> {
        let (calibration, missing, document) = (self.calibration, self.missing, self.document);
        let without_height = self.content().site.is_gravity_without_height();
        Report {
            calibration,
            missing,
            document,
            gyro: self.gyro,
            previous: self.previous,
            without_height,
            details: self.details,
        }
    }

    /// Returns the numbered sections: those on request only if they were requested.
    fn sections(&self, languages: &Languages) -> Vec<Section> {
        let report = self.report();
        let mut sections: Vec<Section> = report
            .sections()
            .into_iter()
            .map(|(id, heading, blocks)| (id, heading, doc::blocks(&blocks, languages)))
            .collect();
        let methods = (sections.len() > 3).then(|| sections.pop()).flatten();
        if let Some(budget) = self.budget {
            let blocks = uncertainty::budget(budget, self.gyro, self.document);
            sections.push(("budget", texts::BUDGET, doc::blocks(&blocks, languages)));
        }
        if let Some(found) = self.monte_carlo {
            let blocks = uncertainty::monte_carlo(found);
            sections.push(("monte-carlo", texts::MONTE_CARLO, doc::blocks(&blocks, languages)));
        }
        sections.extend(methods);
        sections.push(("subject", texts::SUBJECT, subject::section(self, languages)));
        sections
    }

    /// Returns the gyro type and the verdict against it, or `None` if no type was specified.
    fn judged(&self) -> Option<(&GyroType, &Verdict)> {
        self.gyro.zip(self.document.verdict.as_ref())
    }

    /// Returns the serial number of the gyro, if it was stated.
    fn serial(&self) -> Option<&str> {
        self.document.subject.as_ref().and_then(|subject| subject.gyro_serial.as_deref())
    }

    /// Returns the type and the serial number of the gyro, as far as they were stated.
    fn gyro_name(&self, language: Language) -> String {
        let of_type = self.gyro.map(|gyro| gyro.r#type.clone());
        let name: Vec<_> = of_type.into_iter().chain(self.serial().map(|serial| format!("№\u{a0}{serial}"))).collect();
        if name.is_empty() { texts::GYRO_NOT_STATED.words(language) } else { name.join(" ") }
    }

    /// Returns the name of the report: the gyro, the day of the readings if it was stated, and the first digits of the
    /// SHA-256 of the currents.
    fn name(&self, language: Language) -> String {
        let day = self.document.date().map(|day| date_text(language, day));
        let gyro = [self.gyro_name(language)].into_iter().chain(day).collect::<Vec<_>>().join(", ");
        let sha256 = self.currents.1.get(..NAMED_DIGITS).unwrap_or(&self.currents.1);
        texts::name(gyro, sha256).plain(language)
    }

    fn verified(&self) -> bool {
        matches!(self.passport, UsedPassport::Verified(_))
    }

    fn fits(&self) -> bool {
        self.calibration.consistent
    }

    fn body(&self, languages: &Languages) -> Markup {
        let address = data_address("application/json", closing::json(self).as_bytes());
        let sections = self.sections(languages);
        html! {
            header.title {
                p.kind { (languages.label(texts::TITLE)) }
                h1 { (languages.label_with(|language| self.gyro_name(language))) }
                p.subject { (languages.label(texts::SUBTITLE)) }
            }
            main {
                (self.headlines(languages))
                (subject::band(self, languages))
                (contents(languages, texts::SAVE, (&address, "calibration.json"), &sections, texts::ANNEX))
                (numbered(languages, &sections))
                (closing::sections(self, languages))
            }
        }
    }

    /// Writes the warnings at the head of the report, the most serious first.
    fn headlines(&self, languages: &Languages) -> Markup {
        html! {
            @if !self.verified() {
                @let headline = marked(Outcome::NotAsked, &languages.label(texts::NOT_VERIFIED));
                (boxed("verdict refused", headline, languages.paragraph(texts::NOT_VERIFIED_WORDS)))
            }
            @if self.calibration.is_invalid() {
                @let [name, what] = if self.fits() { [texts::MISTAKE, texts::MISTAKE_WORDS] } else { [texts::DOES_NOT_FIT, texts::DOES_NOT_FIT_WORDS] };
                @let words = html! { (languages.paragraph(what)) (doc::blocks(&causes(self.calibration), languages)) };
                (outcome_box(Outcome::Failed, &languages.label(name), words))
            }
            @if let Some(why) = self.previous.iter().rev().find_map(|earlier| self.document.no_change(earlier)) {
                (outcome_box(Outcome::Undecided, &languages.label(texts::NO_CHANGE), languages.paragraph(why_no_change(why))))
            }
            (subject::temperature(self, languages))
            (subject::date_of_readings(self, languages))
            (self.verdict(languages))
        }
    }

    /// Writes which stated values are usually a mistake in the unit.
    fn implausible(&self, languages: &Languages) -> Markup {
        let remarks = |language: Language| {
            let of_laboratory = self.laboratory.into_iter().flat_map(move |laboratory| laboratory.remarks(language));
            of_laboratory.chain(self.gyro.into_iter().flat_map(move |gyro| gyro.remarks(language))).collect::<Vec<_>>()
        };
        let words =
            |language: Language| remarks(language).into_iter().map(|words| words + ".").collect::<Vec<_>>().join(" ");
        html! {
            @if !remarks(languages.first()).is_empty() { (languages.paragraph_with(|language| italic(&words(language)))) }
        }
    }

    fn verdict(&self, languages: &Languages) -> Markup {
        let Some((gyro, verdict)) = self.judged() else {
            let words = html! {
                (languages.paragraph_with(|language| html! { (texts::NO_TYPE_WORDS.words(language)) (self.not_in_u(language)) }))
                (languages.paragraph(texts::NOT_TESTED))
                (self.unexplained_change(languages))
                (self.not_linear(languages))
                (self.implausible(languages))
            };
            return outcome_box(Outcome::NotAsked, &languages.label(texts::NO_TYPE), words);
        };
        if verdict.withheld {
            let name = |language: Language| texts::no_statement(&gyro.r#type).plain(language);
            return outcome_box(Outcome::NotAsked, &languages.label_with(name), self.implausible(languages));
        }
        let change = self.document.stated_change();
        let kind = &gyro.r#type;
        let name = match (verdict.overall, change.map(|change| change.overall)) {
            (Decision::Fail, _) => texts::conforms_not(kind),
            (_, Some(Decision::Fail)) => texts::changed_too_much(kind),
            (Decision::Undecided, _) => texts::undecided(kind),
            (Decision::Pass, Some(Decision::Undecided)) => texts::change_undecided(kind),
            (Decision::Pass, _) => texts::conforms(kind),
        };
        let worst = verdict.with_change(change);
        let words = html! {
            (self.counted(verdict, texts::passed, |language| self.not_in_u(language), languages))
            @if let Some(change) = change {
                @let then = |language| html! { @if !self.report().is_same_gyro() { " " (texts::SAME_GYRO_NOT_SHOWN.words(language)) } };
                (self.counted(change, texts::change_passed, then, languages))
            }
            (self.not_linear(languages))
            (self.implausible(languages))
            (languages.paragraph(texts::RULE))
        };
        outcome_box(worst, &name.label(languages), words)
    }

    /// Writes how many parameters pass, and which were not assessed; `then` is what follows.
    fn counted(
        &self,
        verdict: &Verdict,
        passed: fn(usize, usize) -> Words,
        then: impl Fn(Language) -> Markup,
        languages: &Languages,
    ) -> Markup {
        let counted = counted(verdict, |row| row.guarded, passed);
        let not_found = symbols(verdict.not_found());
        languages.paragraph_with(|language| {
            html! {
                (counted.html(language, languages))
                @if !verdict.not_found().is_empty() {
                    "; " (texts::not_in_the_model(not_found.clone()).html(language, languages))
                }
                "." (then(language))
            }
        })
    }

    /// Writes how many inputs U does not include, after a sentence; nothing if there are none.
    fn not_in_u(&self, language: Language) -> Markup {
        let count = self.missing.len();
        let more = subject::outside(self).map(|_| texts::AND_TEMPERATURE.words(language)).unwrap_or_default();
        html! {
            @if count > 0 { " " (italic(&texts::not_in_u(count, more).plain(language))) }
            @if self.laboratory.is_none() { " " (texts::METER_IS_ASSUMED.words(language)) }
        }
    }

    /// Writes the parameters that have changed more than chance explains, if no type decides on the change.
    fn unexplained_change(&self, languages: &Languages) -> Markup {
        let words = self.previous.last().and_then(|earlier| self.document.unexplained_in_words(earlier));
        html! { @if let Some(words) = words { (languages.said_in_paragraph(&words)) } }
    }

    /// Writes the parameters for which a Monte Carlo run shows that the linear approximation is not valid.
    fn not_linear(&self, languages: &Languages) -> Markup {
        let words = self.monte_carlo.and_then(uncertainty::not_linear);
        html! { @if let Some(words) = words { (languages.said_in_paragraph(&words)) } }
    }
}
