//! Failure of a verb: a message and an exit code for people, and the same as JSON for programs.

use super::{Code, REFUSED, UNUSABLE};
use crate::files::FileError;
use crate::passport::Verification;
use crate::report::{style, verdict};
use crate::text::{Unreadable, name_of};
use serde::Serialize;

/// Codes of failures in JSON, besides those of a passport's checks.
const USAGE: &str = "usage";
const UNREADABLE: &str = "unreadable";
const UNWRITABLE: &str = "unwritable";
const EXISTS: &str = "exists";
const REFUSAL: &str = "refused";
const UNUSABLE_INPUT: &str = "unusable";

/// A failure that ends a verb at once: a message and an exit code.
#[derive(Debug)]
pub(super) struct Failure {
    /// Message for people, with the lines of the files concerned.
    pub message: String,
    /// Exit code.
    pub code: Code,
    /// The kind of failure in one word, for programs.
    kind: &'static str,
    /// Message without the lines of the files, if they are part of it.
    summary: Option<String>,
    problems: Vec<Place>,
}

/// One mistake in a file, for programs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
struct Place {
    file: String,
    line: Option<usize>,
    column: Option<usize>,
    message: String,
}

/// The JSON of a failure that ends a verb.
#[derive(Serialize)]
pub(super) struct Document {
    error: Body,
}

/// A failure as programs read it.
#[derive(Serialize)]
pub(super) struct Body {
    code: &'static str,
    message: String,
    problems: Vec<Place>,
}

impl Failure {
    fn new(message: String, code: Code, kind: &'static str) -> Self {
        Self { message, code, kind, summary: None, problems: Vec::new() }
    }

    pub(super) fn refused(error: impl std::fmt::Display) -> Self {
        Self::new(error.to_string(), REFUSED, REFUSAL)
    }

    pub(super) fn unusable(error: impl std::fmt::Display) -> Self {
        Self::new(error.to_string(), UNUSABLE, UNUSABLE_INPUT)
    }

    /// Creates the failure for arguments that cannot be used.
    pub(super) fn usage(error: impl std::fmt::Display) -> Self {
        Self::new(error.to_string(), UNUSABLE, USAGE)
    }

    /// Converts an error of a file: an existing file is a refusal, any other error is not.
    pub(super) fn file(error: FileError) -> Self {
        let (code, kind) = match error {
            FileError::Exists { .. } => (REFUSED, EXISTS),
            FileError::Write { .. } => (UNUSABLE, UNWRITABLE),
            _ => (UNUSABLE, UNREADABLE),
        };
        let message = error.with_nearest();
        let place = Place { file: name_of(error.path()), line: None, column: None, message: message.clone() };
        Self { problems: vec![place], ..Self::new(message, code, kind) }
    }

    /// Creates the failure for a file with mistakes; the message includes their lines.
    pub(super) fn unreadable(error: Unreadable) -> Self {
        let place = |problem: &crate::text::Problem| Place {
            file: error.name().to_owned(),
            line: problem.location.map(|at| at.line),
            column: problem.location.map(|at| at.column),
            message: problem.to_string(),
        };
        let problems = error.problems().iter().map(place).collect();
        Self { problems, summary: Some(error.to_string()), ..Self::new(error.with_lines(""), UNUSABLE, UNREADABLE) }
    }

    /// Creates the failure for the passport `name`, which did not pass every check; `words` precede its verdict.
    pub(super) fn verdict(words: &str, name: &str, verification: &Verification) -> Self {
        let verdict = verdict::Verdict::of(name, verification);
        let failed: Vec<_> = verdict.checks.iter().filter(|check| check.passed == Some(false)).collect();
        let kind = failed.first().map_or(REFUSAL, |check| check.code);
        let place = |check: &&crate::interface::CheckLine| Place {
            file: name.to_owned(),
            line: None,
            column: None,
            message: format!("{}: {}", check.name, check.detail),
        };
        let problems = failed.iter().map(place).collect();
        let message = format!("{words}{}", style::plain(&verdict::text(&[verdict])));
        Self { problems, ..Self::new(message, REFUSED, kind) }
    }

    /// Returns the failure as programs read it.
    pub(super) fn into_body(self) -> Body {
        let message = self.summary.unwrap_or(self.message).trim_end().to_owned();
        Body { code: self.kind, message, problems: self.problems }
    }

    /// Returns the failure as the JSON of a verb that it ends.
    pub(super) fn into_document(self) -> Document {
        Document { error: self.into_body() }
    }
}
