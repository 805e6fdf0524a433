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
use crate::calibration::document::CalibrationDocument;
use crate::calibration::parameter::symbols;
use crate::calibration::stated::NotStated;
use crate::calibration::verdict::{Decision, Verdict};
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::passport::Content;
use crate::report::calibration::{Report, causes, counted, not_linear, rule, why_no_change};
use crate::report::doc::{Block, listed, marked, outcome_box, say, told};
use crate::report::style::Outcome;
use crate::report::uncertainty;
use crate::uncertainty::{Budget, MonteCarlo};
use crate::wording::Words;
use crate::wording::texts::calibration as texts;
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
        let warning = match (self.verified(), self.fits(), &self.document.mistake) {
            (false, ..) => texts::NOT_VERIFIED.into(),
            (true, false, _) => texts::DOES_NOT_FIT.into(),
            (true, true, Some(_)) => texts::MISTAKE.into(),
            (true, true, None) => self.reservation(),
        };
        let signatures =
            [vec![say([texts::ONLY_THIS_ONE])], signatures([texts::CALIBRATED_BY, texts::APPROVED_BY]).into()];
        let page = Page {
            margins: [first(texts::margin(self.name())), warning, first(texts::margin_sha256(&self.currents.1))],
            name: self.name(),
            title: (texts::TITLE, self.gyro_name(), texts::SUBTITLE.into()),
            head: [self.headlines(), vec![self.verdict(), subject::band(self)]].concat(),
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

    /// Returns the headline of parameters that fail, or of a temperature outside the certified range, for the head of every
    /// sheet.
    fn reservation(&self) -> Words {
        match self.judged().filter(|(_, verdict)| verdict.overall == Decision::Fail) {
            Some((gyro, _)) => first(texts::conforms_not(&gyro.r#type)),
            None if subject::outside(self).is_some() => texts::TEMPERATURE_IS_OUTSIDE.into(),
            None => "".into(),
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

    /// Returns the gyro type and the verdict against it, or `None` if no type was specified.
    fn judged(&self) -> Option<(&GyroType, &Verdict)> {
        self.gyro.zip(self.document.verdict.as_ref())
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

    fn fits(&self) -> bool {
        self.calibration.consistent
    }

    /// The warnings at the head of the report, the most serious first.
    fn headlines(&self) -> Vec<Block> {
        let not_verified = (!self.verified()).then(|| {
            let headline = marked(Outcome::NotAsked, texts::NOT_VERIFIED);
            Block::Boxed("verdict refused", headline, vec![say([texts::NOT_VERIFIED_WORDS])])
        });
        let invalid = self.calibration.is_invalid().then(|| {
            let [name, what] = match self.fits() {
                true => [texts::MISTAKE, texts::MISTAKE_WORDS],
                false => [texts::DOES_NOT_FIT, texts::DOES_NOT_FIT_WORDS],
            };
            outcome_box(Outcome::Failed, name, [vec![say([what])], causes(self.calibration)].concat())
        });
        let no_change = self.previous.iter().rev().find_map(|earlier| self.document.no_change(earlier));
        let no_change =
            no_change.map(|why| outcome_box(Outcome::Undecided, texts::NO_CHANGE, vec![say([why_no_change(why)])]));
        let doubts = [subject::temperature(self), subject::date_of_readings(self)];
        [not_verified, invalid, no_change].into_iter().chain(doubts).flatten().collect()
    }

    /// The stated values that are usually a mistake in the unit.
    fn implausible(&self) -> Block {
        let of_laboratory = self.laboratory.into_iter().flat_map(Laboratory::remarks);
        let all = of_laboratory.chain(self.gyro.into_iter().flat_map(GyroType::remarks));
        say(all.map(|words| vec![told(words), ".".into()]))
    }

    fn verdict(&self) -> Block {
        let Some((gyro, verdict)) = self.judged() else {
            let no_type = [texts::NO_TYPE_WORDS.into()].into_iter().chain(self.not_in_u());
            let words = vec![
                say(no_type),
                say([texts::NOT_TESTED]),
                self.unexplained_change(),
                self.not_linear(),
                self.implausible(),
            ];
            return outcome_box(Outcome::NotAsked, texts::NO_TYPE, words);
        };
        let kind = &gyro.r#type;
        if verdict.withheld {
            return outcome_box(Outcome::NotAsked, told(texts::no_statement(kind)), vec![self.implausible()]);
        }
        let change = self.document.stated_change();
        let name = match (verdict.overall, change.map(|change| change.overall)) {
            (Decision::Fail, _) => texts::conforms_not(kind),
            (_, Some(Decision::Fail)) => texts::changed_too_much(kind),
            (Decision::Undecided, _) => texts::undecided(kind),
            (Decision::Pass, Some(Decision::Undecided)) => texts::change_undecided(kind),
            (Decision::Pass, _) => texts::conforms(kind),
        };
        let of_change = change.map(|change| {
            let unknown = (!self.report().is_same_gyro()).then(|| texts::SAME_GYRO_NOT_SHOWN.into());
            counted_in_all(change, texts::change_passed, unknown)
        });
        let mut words = vec![counted_in_all(verdict, texts::passed, self.not_in_u())];
        words.extend(of_change);
        words.extend([self.not_linear(), self.implausible(), say([rule(verdict)])]);
        outcome_box(verdict.with_change(change), name, words)
    }

    /// How many inputs U does not include.
    fn not_in_u(&self) -> Vec<Words> {
        let count = self.missing.len();
        let more = subject::outside(self).map_or_else(|| "".into(), |_| Words::from(texts::AND_TEMPERATURE));
        let counted = (count > 0).then(|| told(texts::not_in_u(count, more)));
        counted.into_iter().chain(self.laboratory.is_none().then(|| texts::METER_IS_ASSUMED.into())).collect()
    }

    /// The parameters that have changed more than chance explains, if no type decides on the change.
    fn unexplained_change(&self) -> Block {
        say(self.previous.last().and_then(|earlier| self.document.unexplained_in_words(earlier)))
    }

    /// The parameters for which a Monte Carlo run shows that the linear approximation is not valid.
    fn not_linear(&self) -> Block {
        say(self.monte_carlo.and_then(not_linear))
    }
}

/// How many parameters pass, and which were not assessed; then what follows.
fn counted_in_all(
    verdict: &Verdict,
    passed: fn(usize, usize) -> Words,
    then: impl IntoIterator<Item = Words>,
) -> Block {
    let mut all = vec![counted(verdict, |row| row.decision, passed)];
    let not_found = verdict.not_found();
    if !not_found.is_empty() {
        all.extend(["; ".into(), texts::not_in_the_model(symbols(not_found))]);
    }
    all.push(".".into());
    say([Words::All(all)].into_iter().chain(then))
}
