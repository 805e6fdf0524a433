//! Printable report of a gyro calibration: gyro, stand, passport, result, uncertainty, signature lines.
//!
//! The numbers are those of [`CalibrationDocument`], which `calibrate --format json` writes; the annex is that file.
//!
//! * `conformity`: the result, compared with the gyro type and with an earlier result.
//! * `history`: all calibrations of the gyro, if there are several earlier results.
//! * `fit`: chi-square, residuals, possible causes of disagreement, errors that the residuals do not show.
//! * `uncertainty`: budget and Monte Carlo.
//! * `parameters`: parameters by every method.
//! * `subject`: gyro, stand, passport and its verification, currents, laboratory.
//! * `closing`: signatures, and the annex.

mod closing;
mod conformity;
mod fit;
mod history;
mod parameters;
mod subject;
mod uncertainty;

pub(crate) use fit::{not_stated, suspicion};

use self::parameters::name_of;
use super::language::{Language, Languages, Text, values};
use super::parts::{Section, boxed, contents, data_address, listed, marked, numbered, outcome_box};
use super::passport::PassportPage;
use super::shell::{Margins, document};
use super::symbols::italic;
use super::texts::calibration as texts;
use crate::calibration::document::{CalibrationDocument, NoChange, ResultDocument};
use crate::calibration::parameter::Parameter;
use crate::calibration::stated::NotStated;
use crate::calibration::verdict::{Decision, Verdict};
use crate::calibration::{Calibration, Method};
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::passport::Content;
use crate::report::mistake;
use crate::report::style::Outcome;
use crate::uncertainty::{Budget, MonteCarlo};
use crate::wording::{comparison, date_text};
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
}

impl CalibrationPage<'_> {
    /// Returns the report as one self-contained HTML document.
    pub fn html(&self, languages: &Languages) -> String {
        let name = self.name(languages.first());
        let margins = Margins {
            top_left: texts::MARGIN.filled(languages.first(), values! { name }),
            top_right: match (self.verified(), self.fits(), &self.document.mistake) {
                (false, ..) => languages.plain(texts::NOT_VERIFIED),
                (true, false, _) => languages.plain(texts::DOES_NOT_FIT),
                (true, true, Some(_)) => languages.plain(texts::MISTAKE),
                (true, true, None) => self.reservation(languages),
            },
            bottom_left: texts::MARGIN_SHA256.filled(languages.first(), values! { sha256: self.currents.1 }),
        };
        let title = format!("{}: {name}", languages.plain(texts::TITLE));
        document(languages, &title, &margins, &self.body(languages))
    }

    /// Returns the headline of parameters that fail, or of a temperature outside the certified range, for the head of every
    /// sheet.
    fn reservation(&self, languages: &Languages) -> String {
        match self.judged().filter(|(_, verdict)| verdict.overall == Decision::Fail) {
            Some((gyro, _)) => texts::CONFORMS_NOT.filled(languages.first(), values! { type: gyro.r#type }),
            None if subject::outside(self).is_some() => languages.plain(texts::TEMPERATURE_IS_OUTSIDE),
            None => String::new(),
        }
    }

    fn content(&self) -> &Content {
        self.passport.content()
    }

    /// Returns the numbered sections: those on request only if they were requested.
    fn sections(&self, languages: &Languages) -> Vec<Section> {
        let mut sections = vec![
            ("result", texts::RESULT, conformity::section(self, languages)),
            ("fit", texts::FIT, fit::section(self, languages)),
            ("blind", texts::BLIND, fit::blind(self, languages)),
        ];
        if let Some(budget) = self.budget {
            sections.push(("budget", texts::BUDGET, uncertainty::budget(self, budget, languages)));
        }
        if let Some(found) = self.monte_carlo {
            sections.push(("monte-carlo", texts::MONTE_CARLO, uncertainty::monte_carlo(found, languages)));
        }
        sections.push(("methods", texts::METHODS, parameters::section(self, languages)));
        sections.push(("subject", texts::SUBJECT, subject::section(self, languages)));
        sections
    }

    /// Returns the gyro type and the verdict against it, or `None` if no type was specified.
    fn judged(&self) -> Option<(&GyroType, &Verdict)> {
        self.gyro.zip(self.document.verdict.as_ref())
    }

    fn adopted(&self) -> Option<&ResultDocument> {
        self.document.best()
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
        texts::NAME.filled(language, values! { gyro, sha256 })
    }

    fn verified(&self) -> bool {
        matches!(self.passport, UsedPassport::Verified(_))
    }

    fn fits(&self) -> bool {
        self.calibration.hint.is_none()
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
            @if let Some(hint) = &self.calibration.hint {
                @let words = html! { (languages.paragraph(texts::DOES_NOT_FIT_WORDS)) (fit::what_may_be_wrong(hint, languages)) };
                (outcome_box(Outcome::Failed, &languages.label(texts::DOES_NOT_FIT), words))
            }
            @if let Some(mistake) = &self.document.mistake {
                @let words = languages.paragraph_with(|language| italic(&mistake::words(mistake, language)));
                (outcome_box(Outcome::Failed, &languages.label(texts::MISTAKE), words))
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
            let name = |language: Language| texts::NO_STATEMENT.filled(language, values! { type: gyro.r#type });
            return outcome_box(Outcome::NotAsked, &languages.label_with(name), self.implausible(languages));
        }
        let change = self.document.stated_change();
        let text = match (verdict.overall, change.map(|change| change.overall)) {
            (Decision::Fail, _) => texts::CONFORMS_NOT,
            (_, Some(Decision::Fail)) => texts::CHANGED_TOO_MUCH,
            (Decision::Undecided, _) => texts::UNDECIDED,
            (Decision::Pass, Some(Decision::Undecided)) => texts::CHANGE_UNDECIDED,
            (Decision::Pass, _) => texts::CONFORMS,
        };
        let worst = verdict.with_change(change);
        let name = |language: Language| text.filled(language, values! { type: gyro.r#type });
        let words = html! {
            (conformity::counted(verdict, texts::PASSED, |language| self.not_in_u(language), languages))
            @if let Some(change) = change {
                @let then = |language| conformity::gyro_not_confirmed(self, language);
                (conformity::counted(change, texts::CHANGE_PASSED, then, languages))
            }
            (self.not_linear(languages))
            (self.implausible(languages))
            (languages.paragraph(texts::RULE))
        };
        outcome_box(worst, &languages.label_with(name), words)
    }

    /// Writes how many inputs U does not include, after a sentence; nothing if there are none.
    fn not_in_u(&self, language: Language) -> Markup {
        let count = self.missing.len();
        let more = subject::outside(self).map(|_| texts::AND_TEMPERATURE.words(language)).unwrap_or_default();
        html! {
            @if count > 0 { " " (italic(&texts::NOT_IN_U.filled(language, values! { count, more }))) }
            @if self.laboratory.is_none() { " " (texts::METER_IS_ASSUMED.words(language)) }
        }
    }

    /// Writes the parameters that have changed more than chance explains, if no type decides on the change.
    fn unexplained_change(&self, languages: &Languages) -> Markup {
        let changed = self.previous.last().map_or_else(Vec::new, |earlier| self.document.unexplained_change(earlier));
        if changed.is_empty() {
            return html! {};
        }
        let names = listed(changed.iter().map(|parameter| name_of(parameter.symbol())));
        languages.paragraph_with(|language| comparison::UNEXPLAINED.marked_up(language, &[("names", names.clone())]))
    }

    /// Writes the parameters for which a Monte Carlo run shows that the linear approximation is not valid.
    fn not_linear(&self, languages: &Languages) -> Markup {
        let lines = self.monte_carlo.iter().flat_map(|found| &found.parameters);
        let refuted = lines.filter(|line| line.first_order.valid == Some(false));
        let refuted = Parameter::in_paper_order(refuted, |line| line.parameter);
        if refuted.is_empty() {
            return html! {};
        }
        let names = listed(refuted.iter().map(|line| name_of(line.parameter.symbol())));
        languages.paragraph_with(|language| texts::NOT_LINEAR.marked_up(language, &[("names", names.clone())]))
    }
}

/// Returns the sentence why a difference from an earlier result is no change.
pub(crate) fn why_no_change(why: NoChange) -> Text {
    match why {
        NoChange::SameReadings => texts::SAME_READINGS,
        NoChange::EarlierNotValid => texts::EARLIER_NOT_VALID,
        NoChange::EarlierSuspect => texts::EARLIER_SUSPECT,
        NoChange::EarlierNotVerified => texts::EARLIER_NOT_VERIFIED,
    }
}

/// Returns the name of a method from its key in results.
fn method(key: &str) -> Text {
    let is = |method: Method| method.key() == key;
    match () {
        () if is(Method::LeastSquares) => texts::LEAST_SQUARES_NAME,
        () if is(Method::Analytic) => texts::ANALYTIC,
        () => texts::ITERATIVE,
    }
}
