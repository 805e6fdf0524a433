//! Answer of `verify`, as text and as the JSON that programs use.

use super::style;
use crate::passport::Verification;
use crate::text::Printable;
use serde::Serialize;
use std::fmt::Write;

/// The verdict on one file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Verdict {
    /// Path of the file.
    pub file: String,
    /// `true` if every check passed.
    pub valid: bool,
    /// Id of the passport; null until the signature passes.
    pub id: Option<String>,
    /// All checks.
    pub checks: Vec<CheckLine>,
}

/// The result of one check.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct CheckLine {
    /// Name of the check.
    pub name: &'static str,
    /// `true` if the check passed, `false` if it failed; null if it was not run.
    pub passed: Option<bool>,
    /// Result of the check as a code, for programs.
    pub code: &'static str,
    /// Result of the check as a sentence, for people.
    pub detail: String,
}

impl Verdict {
    /// Creates the verdict of `verification` on the file `file`.
    pub(crate) fn of(file: &str, verification: &Verification) -> Self {
        let checks = verification.checks().iter().map(|check| CheckLine {
            name: check.name.as_str(),
            passed: check.passed(),
            code: check.code.as_str(),
            detail: check.detail.clone(),
        });
        let id = verification.id_from_anyone().map(str::to_owned);
        Self { file: file.to_owned(), valid: verification.valid(), id, checks: checks.collect() }
    }
}

/// Returns a line for each file, and below it a line for each of its checks.
pub(crate) fn text(verdicts: &[Verdict]) -> String {
    let mut text = String::new();
    for verdict in verdicts {
        let answer = if verdict.valid { style::good("VALID") } else { style::bad("REFUSED") };
        let id = verdict.id.as_deref().unwrap_or("(id not verified)");
        let _ = writeln!(text, "{answer}  {id}  {}", Printable(&verdict.file));
        for check in &verdict.checks {
            let mark = match check.passed {
                Some(true) => style::good("ok    "),
                Some(false) => style::bad("FAILED"),
                None => "-     ".to_owned(),
            };
            let _ = writeln!(
                text,
                "  {mark}  {:<10}  {}",
                check.name,
                check.detail.replace('\n', "\n                      ")
            );
        }
    }
    text
}
