//! Reports of the orders of a batch.
//!
//! Reports are written one after the other, so that not all are held in memory. For a few orders the text is complete;
//! for many it contains only the failures, what a dry run plans, and a summary.

use super::columns::csv_row;
use super::doc::{Block, Words, given, line, listed, longest, marked, padded, said, typed};
use super::gyros::of_input;
use super::passport::accuracy;
use crate::batch::{Failure, Outcome};
use crate::calibration::prediction::NoiseGrowth;
use crate::folder::Issued;
use crate::interface::{self, Failed};
use crate::passport::annotations::Absence;
use crate::passport::issue::Remarks;
use crate::text::printable::{json, json_line};
use crate::text::{Printable, RefusalCause, name_of, printable, words};
use crate::wording::texts::{calibration, issued as texts};
use crate::wording::{Language, Number, Text};
use serde::Serialize;

/// Largest number of orders for which the text is complete.
const FEW: usize = 20;

/// Largest number of different remarks that are printed; further ones are only counted.
const REMARKS_TOLD: usize = 50;

words! {
    /// The result of an order, in one word.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "lowercase")]
    pub(crate) enum State: key {
        /// The passport is new.
        #[default]
        Issued = "issued",
        /// An equal passport was there, and was left.
        Unchanged = "unchanged",
        /// A dry run: it would be issued.
        Planned = "planned",
        /// The work was done before.
        Skipped = "skipped",
        /// Nothing was written.
        Refused = "refused",
    }
}

impl State {
    /// Returns whether the passport is there, or `None` if nothing was done.
    fn passed(self) -> Option<bool> {
        match self {
            Self::Issued | Self::Unchanged => Some(true),
            Self::Planned | Self::Skipped => None,
            Self::Refused => Some(false),
        }
    }

    fn text(self) -> Text {
        texts::state!(Self, self)
    }
}

#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub(crate) struct Report {
    /// Id of the passport; for a refused re-issue, the predecessor's file; for an input, its file.
    pub id: String,
    pub state: State,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sha256: Option<String>,
    /// Noise of a calibration on this stand relative to an ideal stand.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise_growth: Option<NoiseGrowth>,
    /// Inputs that the passport does not state, and the effect of each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub absences: Vec<String>,
    /// Reason why the order was refused or skipped.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Number of passports that an unusable input prevents.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub passports: Option<u64>,
    /// Word of the first recognised cause for which a file was refused.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cause: Option<&'static str>,
}

impl Report {
    pub(super) fn new(id: String, state: State) -> Self {
        Self { id, state, ..Self::default() }
    }

    /// Creates the report of an order of a batch.
    pub(crate) fn of(outcome: &Outcome) -> Self {
        match outcome {
            Outcome::There(Issued { id, path, sha256, new, remarks }) => Self {
                file: Some(name_of(path)),
                sha256: Some(sha256.clone()),
                ..Self::new(id.clone(), if *new { State::Issued } else { State::Unchanged }).with(remarks)
            },
            Outcome::Planned { id, path, remarks } => {
                Self { file: Some(name_of(path)), ..Self::new(id.clone(), State::Planned).with(remarks) }
            }
            Outcome::Skipped { id, file, why } => {
                Self { file: Some(name_of(file)), reason: Some(why.clone()), ..Self::new(id.clone(), State::Skipped) }
            }
            Outcome::Failed(Failure { what, why, passports, unreadable, .. }) => {
                let cause = unreadable.iter().flat_map(|refused| refused.problems()).find_map(|problem| problem.cause);
                let (reason, passports, cause) = (Some(why.clone()), *passports, cause.map(RefusalCause::code));
                Self { reason, passports, cause, ..Self::new(what.clone(), State::Refused) }
            }
        }
    }

    fn with(self, remarks: &Remarks) -> Self {
        Self { noise_growth: remarks.noise, absences: remarks.absences(), ..self }
    }
}

/// Returns a failure in words, with its number of passports not issued. The name comes first, unless the reason begins
/// with it.
pub(crate) fn failure(failure: &Failure) -> String {
    let Failure { what, why, passports, unreadable, .. } = failure;
    let cost = match passports {
        None | Some(0 | 1) => String::new(),
        Some(passports) => format!(" (passports not issued: {})", Words::Count(*passports).plain(Language::English)),
    };
    let what = Printable(what);
    match unreadable {
        Some(unreadable) => unreadable.with_lines(&cost),
        // On Windows a path may be written with either separator.
        None if why.replace('\\', "/").starts_with(&format!("{what}:").replace('\\', "/")) => format!("{why}{cost}"),
        None => format!("{what}: {why}{cost}"),
    }
}

/// The line of an order, and the SHA-256 of its passport below.
pub(super) fn named(report: &Report) -> Vec<Vec<Words>> {
    let sha256 = report.sha256.as_ref().map(|sha256| vec!["".into(), format!("SHA-256 {sha256}").into()]);
    [first(report)].into_iter().chain(sha256).collect()
}

/// The line of an order, and its details below.
fn detailed(report: &Report) -> Vec<Vec<Words>> {
    let noise = report.noise_growth.map(|NoiseGrowth { k, omega0, omega_g, omega_k }| {
        let [k, omega0, omega_g, omega_k] = [k, omega0, omega_g, omega_k].map(|growth| Number::fixed(growth, 2));
        vec!["".into(), texts::noise(k, omega0, omega_g, omega_k)]
    });
    let why = report.reason.as_ref().filter(|_| report.state == State::Skipped);
    named(report).into_iter().chain(noise).chain(why.map(|why| vec!["".into(), given(why)])).collect()
}

fn first(report: &Report) -> Vec<Words> {
    let file = report.file.as_ref().map_or_else(|| texts::NOTHING_WRITTEN.into(), given);
    vec![done(report.state.passed(), report.state.text()), Words::All(vec![given(&report.id), "  ".into(), file])]
}

/// The mark and the word of a [`State`], padded to the longest word.
pub(super) fn done(passed: Option<bool>, word: Text) -> Words {
    marked(passed, padded(word, |language| longest(State::ALL.map(State::text), language)))
}

/// Returns the line of an input without a result.
pub(crate) fn failed_line(file: &str, failed: &Failed, language: Language) -> String {
    format!("{}  {}\n", said(&of_input(Some(false), outcome(failed)), language), Printable(file))
}

/// Returns the word for an input without a result: refused, unless only its files could not be written.
pub(crate) fn outcome(failed: &Failed) -> Text {
    if matches!(failed.code, interface::EXISTS | interface::UNWRITABLE) {
        calibration::NOT_WRITTEN
    } else {
        calibration::REFUSED
    }
}

/// Number of orders for each outcome, in the order of [`State::ALL`], and of inputs that cannot be used.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Totals {
    orders: [u64; State::ALL.len()],
    inputs: u64,
}

impl Totals {
    fn add(&mut self, report: &Report) {
        self.orders[report.state as usize] += report.passports.unwrap_or(1);
        self.inputs += u64::from(report.passports.is_some());
    }

    fn summary(self) -> Words {
        let Self { orders: [issued, unchanged, planned, skipped, refused], inputs } = self;
        let mark = Some(refused == 0).filter(|passed| !passed || issued + unchanged > 0);
        let count = |words: fn(Words) -> Words, count: u64| words(Words::Count(count));
        let mut counts = vec![match planned {
            0 => count(texts::number_issued, issued),
            planned => count(texts::number_planned, planned),
        }];
        counts.push(count(texts::number_unchanged, unchanged));
        counts.extend((skipped > 0).then(|| count(texts::number_skipped, skipped)));
        counts.push(count(texts::number_refused, refused));
        let counts = listed(counts);
        marked(mark, if inputs > 0 { texts::inputs(counts, Words::Count(inputs)) } else { counts })
    }
}

/// The output form of a result that is a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub(crate) enum Form {
    /// Text for a terminal.
    Text,
    /// JSON for programs.
    Json,
    /// JSON on one line; of several results one line each.
    Ndjson,
    /// CSV for spreadsheets.
    Csv,
}

/// Formats the reports of a batch one after the other.
#[derive(Debug)]
pub(crate) struct Reports {
    form: Form,
    language: Language,
    count: usize,
    held: Vec<Report>,
    totals: Totals,
}

impl Reports {
    pub(crate) fn new(form: Form, language: Language) -> Self {
        Self { form, language, count: 0, held: Vec::new(), totals: Totals::default() }
    }

    /// Returns `true` if nothing was reported.
    pub(crate) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Returns `true` if reports are held back until the end, because there may be only a few.
    pub(crate) fn holds(&self) -> bool {
        self.form == Form::Text && self.count <= FEW
    }

    /// Adds a report and returns the text to write now.
    pub(crate) fn add(&mut self, report: Report) -> String {
        self.totals.add(&report);
        if self.form == Form::Text && report.passports.is_some() {
            // An unusable input is not a passport, and the message of its failure is sufficient.
            return String::new();
        }
        self.count += 1;
        match self.form {
            Form::Json => {
                let json = json(&report).unwrap_or_default().replace('\n', "\n  ");
                format!("{}\n  {json}", if self.count == 1 { "[" } else { "," })
            }
            Form::Ndjson => json_line(&report).unwrap_or_default() + "\n",
            Form::Csv => self.csv(&report),
            Form::Text if self.holds() => {
                self.held.push(report);
                String::new()
            }
            Form::Text => {
                let told = |report: &Report| [State::Refused, State::Planned].contains(&report.state);
                let told = self.held.drain(..).chain([report]).filter(told);
                let told: Vec<_> = told.map(|report| first(&report)).collect();
                typed(&[Block::Whole("", told)], self.language)
            }
        }
    }

    fn csv(&self, report: &Report) -> String {
        let head = if self.count == 1 { CSV_HEADER } else { "" };
        let texts = [&report.file, &report.sha256, &report.reason].map(|text| text.as_deref().unwrap_or_default());
        head.to_owned() + &csv_row(",", [report.state.key(), &report.id].into_iter().chain(texts))
    }

    /// Returns the text to write at the end.
    pub(crate) fn end(&self) -> String {
        match self.form {
            Form::Json if self.count == 0 => "[]\n".to_owned(),
            Form::Json => "\n]\n".to_owned(),
            Form::Csv if self.count == 0 => CSV_HEADER.to_owned(),
            Form::Csv | Form::Ndjson => String::new(),
            // There were no orders and no unusable inputs, so the text says that there was nothing to do.
            Form::Text if self.totals != Totals::default() && self.count <= FEW => {
                let lines = self.held.iter().flat_map(detailed).collect();
                typed(&[Block::Whole("", lines)], self.language)
            }
            Form::Text => typed(&[line(self.totals.summary())], self.language),
        }
    }
}

const CSV_HEADER: &str = "state,id,file,sha256,reason\n";

/// Remarks, each printed once with the number of passports that it applies to.
#[derive(Debug)]
pub(crate) struct Told {
    language: Language,
    /// Words, whether they are a warning, and what they were first said about, and how often.
    remarks: Vec<(String, bool, String, u64)>,
    others: u64,
}

impl Told {
    pub(crate) fn new(language: Language) -> Self {
        Self { language, remarks: Vec::new(), others: 0 }
    }

    /// Adds a remark about a passport or a file; a warning begins with that word.
    pub(crate) fn add(&mut self, about: &str, words: impl Into<Words>, is_warning: bool) {
        let words = words.into();
        let words = said(&if is_warning { calibration::warning(words) } else { words }, self.language);
        match self.remarks.iter().position(|(known, ..)| *known == words) {
            Some(known) => self.remarks[known].3 += 1,
            None if self.remarks.len() == REMARKS_TOLD => self.others += 1,
            None => self.remarks.push((words, is_warning, about.to_owned(), 1)),
        }
    }

    /// Adds the remarks on a new passport.
    pub(crate) fn add_all(&mut self, id: &str, remarks: &Remarks) {
        remarks.warnings().into_iter().for_each(|words| self.add(id, words, true));
        remarks.missing.iter().for_each(|absence: &Absence| self.add(id, accuracy::sentence(*absence), false));
    }

    /// Returns the remarks, one line each, or only the warnings among them.
    pub(crate) fn lines(&self, only_warnings: bool) -> Vec<String> {
        let told = self.remarks.iter().filter(|(_, is_warning, ..)| !only_warnings || *is_warning);
        let told = told.map(|(words, _, first, count)| {
            let about = match count {
                1 => given(first),
                count => texts::and_more(given(first), Words::Count(count - 1)),
            };
            format!("{}: {words}", said(&about, self.language))
        });
        let others = (self.others > 0 && !only_warnings).then(|| texts::other_remarks(Words::Count(self.others)));
        told.chain(others.map(|words| said(&words, self.language))).map(printable).collect()
    }
}
