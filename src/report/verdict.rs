//! The answer of `verify`, as text and as the JSON that programs rely on.

use super::style;
use crate::passport::Verification;
use crate::text::Printable;
use serde::Serialize;
use std::fmt::Write;

/// The verdict on one file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Verdict {
    /// The file.
    pub file: String,
    /// Whether every check passed.
    pub valid: bool,
    /// The passport's id; null until the signature holds.
    pub id: Option<String>,
    /// Every check.
    pub checks: Vec<CheckLine>,
}

/// One check.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct CheckLine {
    /// Its name.
    pub name: &'static str,
    /// Whether it passed; null when not run.
    pub passed: Option<bool>,
    /// The verdict, for programs.
    pub code: &'static str,
    /// The verdict, for people.
    pub detail: String,
}

impl Verdict {
    /// The verdict of `verification` on the file `file`.
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

/// A line for each check, under a line for each file.
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
