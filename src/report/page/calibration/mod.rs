//! The report of a calibration: what was calibrated on which stand with which passport, what was found, how far it can be
//! believed, and a line to sign.
//!
//! Its numbers are those of [`CalibrationDocument`], which `calibrate --format json` writes; the annex is that file.
//!
//! * `subject`: gyro, stand, passport and its verification, currents, laboratory.
//! * `parameters`: what every method found.
//! * `conformity`: against the type, and against an earlier result.
//! * `fit`: chi-square, residuals, what may be wrong, what the fit cannot see.
//! * `uncertainty`: budget and Monte Carlo.
//! * `closing`: signatures, and the annex.

mod closing;
mod conformity;
mod fit;
mod parameters;
mod subject;
mod uncertainty;

use super::language::{Language, Languages, Text};
use super::parts;
use super::passport::PassportPage;
use super::shell::{Margins, document};
use super::texts::calibration as texts;
use crate::calibration::document::CalibrationDocument;
use crate::calibration::stated::NotStated;
use crate::calibration::verdict::{Decision, Verdict};
use crate::calibration::{Calibration, Method};
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::passport::Content;
use crate::report::mistake;
use crate::uncertainty::{Budget, MonteCarlo};
use jiff::Timestamp;
use maud::{Markup, html};

/// The passport that a calibration was made with.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum UsedPassport<'a> {
    /// It passed every check that was asked for.
    Verified(Box<PassportPage<'a>>),
    /// Nobody checked it: the report says so large.
    NotVerified {
        /// What it says.
        content: &'a Content,
        /// SHA-256 of its file, lower-case hexadecimal.
        sha256: String,
    },
}

impl UsedPassport<'_> {
    fn content(&self) -> &Content {
        match self {
            Self::Verified(page) => page.content(),
            Self::NotVerified { content, .. } => content,
        }
    }

    fn sha256(&self) -> &str {
        match self {
            Self::Verified(page) => page.sha256(),
            Self::NotVerified { sha256, .. } => sha256,
        }
    }
}

/// The numbered sections.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Section {
    Subject,
    Parameters,
    Conformity,
    Fit,
    Blind,
    Budget,
    MonteCarlo,
}

impl Section {
    /// In the order of the page.
    const ALL: [Self; 7] =
        [Self::Subject, Self::Parameters, Self::Conformity, Self::Fit, Self::Blind, Self::Budget, Self::MonteCarlo];

    /// Its anchor.
    fn id(self) -> &'static str {
        match self {
            Self::Subject => "subject",
            Self::Parameters => "parameters",
            Self::Conformity => "conformity",
            Self::Fit => "fit",
            Self::Blind => "blind",
            Self::Budget => "budget",
            Self::MonteCarlo => "monte-carlo",
        }
    }
}

/// A calibration and everything that a report of it says.
#[derive(Debug, Clone)]
pub struct CalibrationPage<'a> {
    /// With which passport.
    pub passport: UsedPassport<'a>,
    /// When it counts as made: the time that the passport was verified for.
    pub time: Timestamp,
    /// The file of the currents: its name, and its SHA-256 in lower-case hexadecimal.
    pub currents: (&'a str, String),
    /// The gyro's type, when one was named.
    pub gyro: Option<&'a GyroType>,
    /// The laboratory; without one [`Laboratory::paper`] was assumed, and the report says so.
    pub laboratory: Option<&'a Laboratory>,
    /// The calibration: what may be wrong with it, and which methods gave nothing.
    pub calibration: &'a Calibration,
    /// What nobody stated.
    pub missing: &'a [NotStated],
    /// The result as programs get it.
    pub document: &'a CalibrationDocument,
    /// Where the uncertainty comes from, when asked for.
    pub budget: Option<&'a Budget>,
    /// Intervals, when asked for.
    pub monte_carlo: Option<&'a MonteCarlo>,
}

impl CalibrationPage<'_> {
    /// The report, one self-contained HTML document.
    pub fn html(&self, languages: &Languages) -> String {
        let id = &self.content().passport.id;
        let margins = Margins {
            top_left: texts::MARGIN.filled(languages.first(), &[("id", id)]),
            top_right: if self.verified() { String::new() } else { languages.plain(texts::NOT_VERIFIED) },
            bottom_left: texts::MARGIN_SHA256.filled(languages.first(), &[("sha256", &self.currents.1)]),
        };
        let title = format!("{} {id}", languages.plain(texts::TITLE));
        document(languages, &title, &margins, &self.body(languages))
    }

    fn content(&self) -> &Content {
        self.passport.content()
    }

    fn result(&self) -> &CalibrationDocument {
        self.document
    }

    /// A section with its number: those that there are, are counted.
    fn section(&self, languages: &Languages, section: Section, heading: Text, body: &Markup) -> Markup {
        let there = Section::ALL.into_iter().filter(|one| match one {
            Section::Conformity => self.judged().is_some(),
            Section::Budget => self.budget.is_some(),
            Section::MonteCarlo => self.monte_carlo.is_some(),
            Section::Subject | Section::Parameters | Section::Fit | Section::Blind => true,
        });
        let number = 1 + there.take_while(|one| *one != section).count();
        parts::section(languages, section.id(), &number.to_string(), heading, body)
    }

    /// The type and the verdict against it, when one was named.
    fn judged(&self) -> Option<(&GyroType, &Verdict)> {
        self.gyro.zip(self.result().verdict.as_ref())
    }

    fn verified(&self) -> bool {
        matches!(self.passport, UsedPassport::Verified(_))
    }

    fn fits(&self) -> bool {
        self.calibration.hint.is_none() && self.calibration.settled
    }

    fn body(&self, languages: &Languages) -> Markup {
        html! {
            header.title {
                p.kind { (languages.label(texts::TITLE)) }
                h1 { (self.gyro.map_or(self.content().passport.id.as_str(), |gyro| gyro.r#type.as_str())) }
                p.subject { (languages.label(texts::SUBTITLE)) }
            }
            main {
                (self.headlines(languages))
                (subject::section(self, languages))
                (parameters::section(self, languages))
                (conformity::sections(self, languages))
                (fit::sections(self, languages))
                (uncertainty::sections(self, languages))
                (closing::sections(self, languages))
            }
        }
    }

    /// What must not be overlooked, the worst first.
    fn headlines(&self, languages: &Languages) -> Markup {
        html! {
            @if !self.verified() { (warning(languages, texts::NOT_VERIFIED, texts::NOT_VERIFIED_WORDS)) }
            @if !self.fits() { (warning(languages, texts::DOES_NOT_FIT, texts::DOES_NOT_FIT_WORDS)) }
            @if let Some(mistake) = &self.result().mistake {
                @let words = languages.paragraph_with(|language| html! { (mistake::words(mistake, language)) });
                (boxed("verdict refused", languages.label(texts::MISTAKE), words))
            }
            (self.verdict(languages))
        }
    }

    fn verdict(&self, languages: &Languages) -> Markup {
        let Some((gyro, verdict)) = self.judged() else {
            return boxed(
                "verdict neutral",
                languages.label(texts::NO_TYPE),
                languages.paragraph(texts::NO_TYPE_WORDS),
            );
        };
        let (class, text) = match verdict.overall {
            Decision::Pass => ("verdict", texts::CONFORMS),
            Decision::Undecided => ("verdict neutral", texts::UNDECIDED),
            Decision::Fail => ("verdict refused", texts::CONFORMS_NOT),
        };
        let name = |language: Language| text.filled(language, &[("type", &gyro.r#type)]);
        boxed(class, languages.label_with(name), languages.paragraph(texts::RULE))
    }
}

fn warning(languages: &Languages, headline: Text, words: Text) -> Markup {
    boxed("verdict refused", languages.label(headline), languages.paragraph(words))
}

fn boxed(class: &str, headline: Markup, words: Markup) -> Markup {
    html! { div class=(class) { p.headline { (headline) } (words) } }
}

/// A method's name by its key in results.
fn method(key: &str) -> Text {
    let is = |method: Method| method.key() == key;
    match () {
        () if is(Method::LeastSquares) => texts::LEAST_SQUARES_NAME,
        () if is(Method::Analytic) => texts::ANALYTIC,
        () => texts::ITERATIVE,
    }
}
