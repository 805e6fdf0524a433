//! Printable report of a gyro calibration: gyro, stand, passport, result, uncertainty, signature lines.
//!
//! The numbers are those of [`CalibrationDocument`], which `calibrate --format json` writes; the annex is that file.
//!
//! * `subject`: gyro, stand, passport and its verification, currents, laboratory.
//! * `json`: the result as it is printed.

mod json;
mod subject;

use super::language::Languages;
use super::parts::signatures;
use super::passport::PassportPage;
use super::shell::{Annex, Page, Section, first};
use crate::calibration::Calibration;
use crate::calibration::document::{CalibrationDocument, NoChange};
use crate::calibration::stated::NotStated;
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::passport::Content;
use crate::report::calibration::{Answer, Report, causes, not_linear, rule};
use crate::report::doc::{Block, listed, marked, outcome_box, say, told};
use crate::report::uncertainty;
use crate::uncertainty::{Budget, MonteCarlo};
use crate::wording::texts::calibration as texts;
use crate::wording::{Outcome, Words};
use jiff::Timestamp;

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
    /// Returns the content, and the SHA-256 of the file.
    fn file(&self) -> (&Content, &str) {
        match self {
            Self::Verified(page) => (&page.content, &page.sha256),
            Self::NotVerified { content, sha256 } => (content, sha256),
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
        let answer = self.report().answer();
        // What stands at the head of every sheet.
        let warning = match answer.invalid {
            _ if !self.verified() => texts::NOT_VERIFIED.into(),
            Some([why, _]) => why.into(),
            None if answer.outcome == Outcome::Failed => first(answer.statement.clone()),
            None if subject::outside(self).is_some() => texts::TEMPERATURE_IS_OUTSIDE.into(),
            None => "".into(),
        };
        let signatures =
            [vec![say([texts::ONLY_THIS_ONE])], signatures([texts::CALIBRATED_BY, texts::APPROVED_BY]).into()];
        let page = Page {
            margins: [first(texts::margin(self.name())), warning, first(texts::margin_sha256(&self.currents.1))],
            name: self.name(),
            title: (texts::TITLE, self.gyro_name(), texts::SUBTITLE.into()),
            head: [self.headlines(&answer), vec![self.verdict(answer), subject::band(self)]].concat(),
            front: None,
            sections: self.sections(),
            signatures: signatures.concat(),
            annex: Annex {
                heading: texts::ANNEX,
                note: texts::ANNEX_NOTE.into(),
                save: texts::SAVE,
                name: "calibration.json",
                media: "application/json",
                tag: "en",
                bytes: json::lines(self.document).into_bytes().into(),
                end: told(texts::end(self.name())),
                is_printed: self.details,
            },
        };
        page.html(languages)
    }

    fn content(&self) -> &Content {
        self.passport.file().0
    }

    fn report(&self) -> Report<'_> {
        let Self { calibration, missing, document, gyro, previous, details, .. } = *self;
        let without_height = self.content().site.is_gravity_without_height();
        Report { calibration, missing, document, gyro, previous, without_height, details }
    }

    /// Returns the numbered sections: those on request only if they were requested.
    fn sections(&self) -> Vec<Section> {
        let mut sections = self.report().sections();
        let methods = (sections.len() > 3).then(|| sections.pop()).flatten();
        let budget = self.budget.map(|budget| uncertainty::budget(budget, self.gyro, self.document));
        sections.extend(budget.map(|blocks| ("budget", texts::BUDGET, blocks)));
        let monte_carlo = self.monte_carlo.map(uncertainty::monte_carlo);
        sections.extend(monte_carlo.map(|blocks| ("monte-carlo", texts::MONTE_CARLO, blocks)));
        sections.extend(methods);
        sections.push(("subject", texts::SUBJECT, subject::section(self)));
        sections
    }

    /// Returns the serial number of the gyro, if it was stated.
    fn serial(&self) -> Option<&str> {
        self.document.subject.as_ref().and_then(|subject| subject.gyro_serial.as_deref())
    }

    /// Returns the type and the serial number of the gyro, as far as they were stated.
    fn gyro_name(&self) -> Words {
        let of_type = self.gyro.map(|gyro| gyro.r#type.clone());
        let name: Vec<_> = of_type.into_iter().chain(self.serial().map(|serial| format!("№\u{a0}{serial}"))).collect();
        if name.is_empty() { texts::GYRO_NOT_STATED.into() } else { name.join(" ").into() }
    }

    /// Returns the name of the report: the gyro, the day of the readings if it was stated, and the first digits of the
    /// SHA-256 of the currents.
    fn name(&self) -> Words {
        let day = self.document.date().map(Words::Date);
        let sha256 = self.currents.1.get(..NAMED_DIGITS).unwrap_or(&self.currents.1);
        texts::name(listed([self.gyro_name()].into_iter().chain(day)), sha256)
    }

    fn verified(&self) -> bool {
        matches!(self.passport, UsedPassport::Verified(_))
    }

    /// The warnings at the head of the report, the most serious first.
    fn headlines(&self, answer: &Answer) -> Vec<Block> {
        let not_verified = (!self.verified()).then(|| {
            let headline = marked(Outcome::NotAsked, texts::NOT_VERIFIED);
            Block::Boxed("verdict refused", headline, vec![say([texts::NOT_VERIFIED_WORDS])])
        });
        let invalid = answer.invalid.map(|[name, what]| {
            outcome_box(Outcome::Failed, name, [vec![say([what])], causes(self.calibration)].concat())
        });
        let no_change = self.previous.iter().rev().find_map(|earlier| self.document.no_change(earlier));
        let no_change = no_change.map(|why| {
            outcome_box(Outcome::Undecided, texts::NO_CHANGE, vec![say([texts::no_change!(NoChange, why)])])
        });
        let doubts = [subject::temperature(self), subject::date_of_readings(self)];
        [not_verified, invalid, no_change].into_iter().chain(doubts).flatten().collect()
    }

    /// The stated values that are usually a mistake in the unit.
    fn implausible(&self) -> Block {
        let of_laboratory = self.laboratory.into_iter().flat_map(Laboratory::remarks);
        let all = of_laboratory.chain(self.gyro.into_iter().flat_map(GyroType::remarks));
        say(all.map(|words| vec![told(words), ".".into()]))
    }

    /// The statement of conformity with its reasons, and what they depend on.
    fn verdict(&self, answer: Answer) -> Block {
        let report = self.report();
        let mut reasons = answer.reasons.into_iter();
        let of_values = say(reasons.next().into_iter().chain(self.not_in_u().filter(|_| !answer.withheld)));
        let unknown = self.document.stated_change().filter(|_| !report.is_same_gyro());
        let of_change = say(reasons.chain(unknown.map(|_| texts::SAME_GYRO_NOT_SHOWN.into())));
        let last = self.previous.last();
        let words = vec![
            of_values,
            of_change,
            say(report.gyro.is_none().then_some(texts::NOT_TESTED)),
            say(last.and_then(|earlier| self.document.unexplained_in_words(earlier))),
            say(self.monte_carlo.and_then(not_linear)),
            self.implausible(),
            say(answer.decision.and(self.document.verdict.as_ref()).map(rule)),
        ];
        outcome_box(answer.decision, answer.statement, words)
    }

    /// How many inputs U does not include.
    fn not_in_u(&self) -> impl Iterator<Item = Words> {
        let count = self.missing.len();
        let more = subject::outside(self).map_or_else(|| "".into(), |_| Words::from(texts::AND_TEMPERATURE));
        let counted = (count > 0).then(|| told(texts::not_in_u(count, more)));
        counted.into_iter().chain(self.laboratory.is_none().then(|| texts::METER_IS_ASSUMED.into()))
    }
}
