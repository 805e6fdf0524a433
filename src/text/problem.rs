//! Errors in documents: location, found content, expected content and advice.

use super::cause::{Advice, RefusalCause};
use super::characters::{is_sha256_hex, without_byte_order_mark};
use super::excerpt::{Excerpt, Location, Step};
#[cfg(feature = "yaml")]
use super::locate::locate;
use super::{Printable, without_secrets};
use std::collections::HashMap;
use std::fmt::{self, Display, Formatter};
use std::hash::Hash;

/// Advice for a text with a key or a format that this version does not know.
pub(crate) const UPDATE: &str = "update the program, because a later version wrote this file";

/// Path from the top of a document to one of its values, such as `positions[3].alpha_arcsec`.
///
/// A path borrows its parent, so that reading a correct document allocates no memory. Items of a list count from 0.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Path<'a> {
    Root,
    Key(&'a Path<'a>, &'a str),
    /// Item of a list, counted from 0.
    Item(&'a Path<'a>, usize),
    /// Key of a mapping, counted from 0, because a key may be there twice.
    Entry(&'a Path<'a>, usize),
}

impl<'a> Path<'a> {
    pub(crate) fn key(&'a self, key: &'a str) -> Path<'a> {
        Path::Key(self, key)
    }

    pub(crate) fn item(&'a self, index: usize) -> Path<'a> {
        Path::Item(self, index)
    }

    /// Returns the last key on the path, which carries the unit of a number.
    pub(crate) fn last_key(&self) -> &str {
        match self {
            Path::Root => "",
            Path::Key(_, key) => key,
            Path::Item(parent, _) | Path::Entry(parent, _) => parent.last_key(),
        }
    }

    fn steps(&self) -> Vec<Step> {
        let (parent, step) = match self {
            Path::Root => return Vec::new(),
            Path::Key(parent, key) => (parent, Step::Key((*key).to_owned())),
            Path::Item(parent, index) => (parent, Step::Item(*index)),
            Path::Entry(parent, index) => (parent, Step::Entry(*index)),
        };
        let mut steps = parent.steps();
        steps.push(step);
        steps
    }
}

impl Display for Path<'_> {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        match self {
            Path::Root => Ok(()),
            Path::Key(Path::Root, key) => write!(f, "{key}"),
            Path::Key(parent, key) => write!(f, "{parent}.{key}"),
            Path::Item(parent, index) => write!(f, "{parent}[{index}]"),
            Path::Entry(parent, _) => parent.fmt(f),
        }
    }
}

/// Error in a document.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// Location in the text, or `None` if unknown; a missing key is located at the mapping that lacks it.
    pub location: Option<Location>,
    /// Field, such as `positions[3].alpha_arcsec`; empty if the error is not in a field.
    pub field: String,
    /// Found content.
    pub found: String,
    /// Expected content.
    pub expected: String,
    /// Advice; empty if the remedy is obvious.
    pub advice: String,
    /// Cause, or `None` if it is not a recognised one.
    pub cause: Option<RefusalCause>,
    /// Known name that was found with another spelling or unit.
    meant: Option<String>,
}

impl Problem {
    pub(crate) fn new(
        location: Option<Location>,
        field: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<Advice>,
    ) -> Self {
        let Advice { cause, words, meant } = advice.into();
        let [field, found, advice] = [field.into(), found.into(), words].map(|words| without_secrets(&words));
        Self { location, field, found, expected: expected.into(), advice, cause, meant }
    }

    /// Returns `true` if what was found is `key` with another spelling or unit.
    pub(super) fn means(&self, key: &str) -> bool {
        self.meant.as_deref() == Some(key)
    }

    /// Creates the report of an error in a whole document.
    pub(crate) fn whole(found: impl Into<String>, expected: &str, advice: impl Into<Advice>) -> Self {
        Self::new(None, "", found, expected, advice)
    }
}

impl Display for Problem {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let Self { field, found, expected, advice, .. } = self;
        let (colon, semicolon) = (if field.is_empty() { "" } else { ": " }, if advice.is_empty() { "" } else { "; " });
        let verb = if found.starts_with(MISSING) { "" } else { "found " };
        Printable(format_args!("{field}{colon}{verb}{found}, expected {expected}{semicolon}{advice}")).fmt(f)
    }
}

/// Maximum number of errors reported for a document, each with its location.
pub(crate) const MOST_PROBLEMS: usize = 50;

/// Maximum number of bytes read again to locate errors. Each location needs the text once more, so fewer errors are
/// reported for large texts. A hostile text with a hundred thousand errors must not occupy the program for hours.
const READ_AGAIN_BYTES: usize = 1 << 22;

/// Maximum number of errors displayed for a document.
const SHOWN: usize = 20;

/// Found content of a missing key.
pub(crate) const MISSING: &str = "missing";

/// Found content that represents all errors that are not reported separately.
const FURTHER: &str = "further errors";
const CORRECT_FIRST: &str = "correct the errors above first";

/// Errors collected while a document is read; [`Problems::refuse`] finds their lines and columns.
#[derive(Debug, Default)]
pub(crate) struct Problems {
    found: Vec<(Vec<Step>, Problem)>,
    more: bool,
}

impl Problems {
    pub(crate) fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// Returns `true` if `key` was found with another spelling or unit.
    pub(crate) fn mean(&self, key: &str) -> bool {
        self.found.iter().any(|(_, problem)| problem.means(key))
    }

    /// Returns `true` if more than [`MOST_PROBLEMS`] errors were found; further ones are not recorded.
    pub(crate) fn is_full(&self) -> bool {
        self.more
    }

    /// Gives another advice on the error in the value at `at` itself; returns `false` if none was recorded.
    #[cfg(feature = "yaml")]
    pub(crate) fn advise(&mut self, at: &Path, advice: &str) -> bool {
        let steps = at.steps();
        let recorded = self.found.iter_mut().find(|(of, _)| *of == steps);
        recorded.map(|(_, problem)| problem.advice = advice.to_owned()).is_some()
    }

    /// Records that the value at `at` is `found` instead of `expected`.
    pub(crate) fn at(
        &mut self,
        at: &Path,
        found: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<Advice>,
    ) {
        self.push(at, at, found.into(), expected.into(), advice.into());
    }

    /// Records that the mapping at `at` lacks `key`; the location is that of the mapping.
    pub(crate) fn missing(&mut self, at: &Path, key: &str, expected: impl Into<String>, advice: impl Into<Advice>) {
        let key = at.key(key);
        self.push(at, &key, MISSING.to_owned(), expected.into(), advice.into());
    }

    /// Records an error if a text does not have the form of a SHA-256.
    pub(crate) fn sha256(&mut self, at: &Path, text: &str) {
        if !is_sha256_hex(text) {
            self.at(at, format!("{text:?}"), "64 lower-case hexadecimal digits", "");
        }
    }

    pub(crate) fn within(&mut self, at: &Path, value: Option<f64>, low: f64, high: f64) {
        let Some(value) = value else { return };
        if !(low..=high).contains(&value) {
            let expected = match (low, high) {
                (0.0, f64::MAX) => "a non-negative number".to_owned(),
                (low, high) => format!("a number from {low} to {high}"),
            };
            self.at(at, format!("{value}"), expected, "");
        }
    }

    fn push(&mut self, at: &Path, field: &Path, found: String, expected: String, advice: Advice) {
        // Further errors in a document with many errors must cost no more than a comparison.
        if self.found.len() == MOST_PROBLEMS {
            self.more = true;
            return;
        }
        self.found.push((at.steps(), Problem::new(None, field.to_string(), found, expected, advice)));
    }

    /// Returns the refusal of the hand-written document `name` with the given `text`: the first errors with their lines
    /// and columns, in the order of the text, and a note if there are more.
    #[cfg(feature = "yaml")]
    pub(crate) fn refuse(self, name: &str, text: &str) -> Unreadable {
        let affordable = (READ_AGAIN_BYTES / text.len().max(1)).max(1);
        self.refused(name, affordable, |steps| locate(text, steps))
    }

    /// Returns the refusal of the signed document `name`, with its errors by field.
    pub(crate) fn refuse_by_field(self, name: &str) -> Unreadable {
        self.refused(name, MOST_PROBLEMS, |_| None)
    }

    fn refused(self, name: &str, affordable: usize, locate: impl Fn(&[Step]) -> Option<Location>) -> Unreadable {
        let groups = grouped(self.found, |(_, problem)| {
            // The advice on a recognised cause may repeat the value.
            let advice = problem.cause.is_none().then(|| problem.advice.clone());
            let field: String = problem.field.chars().filter(|c| !c.is_ascii_digit()).collect();
            let kind = (field, problem.found == MISSING, problem.expected.clone(), problem.cause, advice);
            problem.field.contains('[').then_some(kind)
        });
        let more = self.more || groups.len() > affordable;
        let located = groups.into_iter().take(affordable).map(|((steps, problem), others)| {
            let last = others.last().and_then(|(steps, _)| locate(steps)).map(|at| at.line);
            let found = problem.found + &more_of_this_kind(others.len(), last, !self.more);
            Problem { location: locate(&steps), found, ..problem }
        });
        let mut problems: Vec<Problem> = located.collect();
        problems.sort_by_key(|problem| problem.location.map(|at| (at.line, at.column)));
        if more {
            problems.push(Problem::whole(FURTHER, "none", CORRECT_FIRST));
        }
        Unreadable::of(name, problems)
    }
}

/// Number of errors of one kind from which only the first is shown.
const ALIKE: usize = 4;

/// Number of errors in the lines of a list or a table from which no more are counted.
pub(crate) const MOST_COUNTED: usize = 1_000;

/// Returns the words after what was found first, if there are `others` of this kind, the last of them in line `last`.
/// Without `all` the errors were not counted to the end.
fn more_of_this_kind(others: usize, last: Option<usize>, all: bool) -> String {
    if others == 0 {
        return String::new();
    }
    let (least, beyond) = if all { ("", "") } else { ("at least ", " or beyond") };
    let up_to = last.map_or_else(String::new, |line| format!(", up to line {line}{beyond}"));
    format!(" (and {least}{others} more of this kind{up_to})")
}

/// Returns the errors in the lines of a list or a table, without those after the first of each kind that has many. Its
/// first error states how many more there are: at least that many if there are [`MOST_COUNTED`] in all.
///
/// Errors without a `kind` remain.
pub(crate) fn counted<K: Eq + Hash>(problems: Vec<Problem>, kind: impl Fn(&Problem) -> Option<K>) -> Vec<Problem> {
    let all = problems.len() < MOST_COUNTED;
    let line = |problem: &Problem| problem.location.map_or(0, |at| at.line);
    let shown = grouped(problems, kind).into_iter().map(|(first, others)| {
        let last = others.iter().map(line).chain([line(&first)]).max();
        Problem { found: first.found + &more_of_this_kind(others.len(), last, all), ..first }
    });
    shown.take(MOST_PROBLEMS).collect()
}

/// Groups errors of one kind, if there are many of it, at the place of the first; returns the first and the others.
fn grouped<T, K: Eq + Hash>(found: Vec<T>, kind: impl Fn(&T) -> Option<K>) -> Vec<(T, Vec<T>)> {
    let mut counts = HashMap::new();
    for kind in found.iter().filter_map(&kind) {
        *counts.entry(kind).or_insert(0_usize) += 1;
    }
    let mut groups: Vec<(T, Vec<T>)> = Vec::new();
    let mut places = HashMap::new();
    for error in found {
        let one_of_many = kind(&error).filter(|kind| counts.get(kind).is_some_and(|count| *count >= ALIKE));
        let next = groups.len();
        match one_of_many.map(|kind| *places.entry(kind).or_insert(next)).and_then(|place| groups.get_mut(place)) {
            Some((_, others)) => others.push(error),
            None => groups.push((error, Vec::new())),
        }
    }
    groups
}

/// Refused document: its name and the errors found.
///
/// The refusal is displayed with one line per error, in the form
/// `name:line:column: field: found …, expected …; advice`. Foreign text in it is escaped. If there are very many
/// errors, which mostly means that it is another file, only the first ones are displayed, with a note that there are
/// more.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unreadable {
    name: String,
    problems: Vec<Problem>,
    /// Lines of the first errors, if the text is known: see [`Unreadable::in_text`].
    excerpts: Vec<Option<Excerpt>>,
    /// Findings that are the reason, as JSON.
    findings: Vec<serde_json::Value>,
}

impl Unreadable {
    /// Creates the refusal of a whole document, or of one place in it.
    pub(crate) fn whole(
        name: &str,
        location: Option<Location>,
        found: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<Advice>,
    ) -> Self {
        Self::of(name, vec![Problem::new(location, "", found, expected, advice)])
    }

    /// Creates a refusal with several errors whose locations are already known.
    pub(crate) fn of(name: &str, problems: Vec<Problem>) -> Self {
        Self { name: name.to_owned(), problems, excerpts: Vec::new(), findings: Vec::new() }
    }

    /// Returns the refusal with the lines of `bytes`, the document, for [`Unreadable::with_lines`].
    ///
    /// Lines of a private key are left out, because messages end up in logs.
    pub(crate) fn in_text(mut self, bytes: &[u8]) -> Self {
        // A byte order mark is not part of the first line.
        let text = without_byte_order_mark(bytes);
        if memchr::memmem::find(text, b"PRIVATE KEY").is_none() {
            let excerpt = |problem: &Problem| problem.location.and_then(|at| Excerpt::new(text, at));
            self.excerpts = self.problems.iter().take(SHOWN).map(excerpt).collect();
        }
        self
    }

    /// Returns the messages as displayed, followed by `remark`, each with the line of the file below it.
    pub(crate) fn with_lines(&self, remark: &str) -> String {
        let messages = format!("{self}{remark}");
        let mut excerpts = self.excerpts.iter().map(Option::as_ref).peekable();
        let mut text = String::new();
        for message in messages.split('\n') {
            text += if text.is_empty() { "" } else { "\n" };
            text += message;
            // Errors at the same place share one line.
            let excerpt = excerpts.next().flatten().filter(|own| excerpts.peek() != Some(&Some(*own)));
            text += &excerpt.map_or_else(String::new, |excerpt| format!("\n{excerpt}"));
        }
        text
    }

    /// Returns the refusal with the findings that are its reason.
    #[cfg(feature = "factory")]
    pub(crate) fn because_of(self, findings: impl IntoIterator<Item = serde_json::Value>) -> Self {
        Self { findings: findings.into_iter().collect(), ..self }
    }

    pub(crate) fn findings(&self) -> &[serde_json::Value] {
        &self.findings
    }

    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// Returns the errors, in the order of the text as far as their locations are known.
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }

    /// Returns `true` if a later version of the program wrote the document.
    pub(crate) fn is_of_a_later_version(&self) -> bool {
        self.problems.iter().any(|problem| problem.advice == UPDATE)
    }
}

impl Display for Unreadable {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let name = Printable(&self.name);
        for (index, problem) in self.problems.iter().take(SHOWN).enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            match problem.location {
                Some(at) => write!(f, "{name}:{}:{}: {problem}", at.line, at.column)?,
                None => write!(f, "{name}: {problem}")?,
            }
        }
        if self.problems.len() > SHOWN {
            write!(f, "\n{name}: found {FURTHER}, expected none; {CORRECT_FIRST}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Unreadable {}
