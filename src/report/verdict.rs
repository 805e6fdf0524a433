//! Answer of `verify` as text.

use super::style;
pub(crate) use crate::interface::Verdict;
use crate::passport::{Check, CheckName, Code};
use crate::text::Printable;
use std::fmt::Write;

/// Returns the answer for a file, what it is based on, and a line for each of its checks.
pub(crate) fn text(verdict: &Verdict) -> String {
    let mut text = first_line(verdict);
    if let Some(check) = verdict.checks.iter().find(|check| check.code == Code::Unreadable) {
        let _ = writeln!(text, "  {}", check.detail);
        return text;
    }
    let _ = writeln!(text, "  {}", counts(&verdict.checks));
    for check in &verdict.checks {
        let (passed, word) = match check.passed() {
            Some(true) if !check.was_asked() => (None, "not asked"),
            Some(true) => (Some(true), "passed"),
            Some(false) => (Some(false), "FAILED"),
            None => (None, "not run"),
        };
        let result = style::marked(passed, &format!("{word:<9}"));
        let detail = check.detail.replace('\n', "\n                           ");
        let _ = writeln!(text, "  {result}  {:<10}  {detail}", check.name.as_str());
    }
    text
}

/// Returns the answer for a file that could not be read, if a message has said why.
pub(crate) fn not_read(verdict: &Verdict) -> String {
    first_line(verdict) + "  not read; nothing was checked\n"
}

fn first_line(verdict: &Verdict) -> String {
    let id = verdict.id.as_deref().unwrap_or("(id not verified)");
    format!("{}  {id}  {}\n", answer(verdict.valid), Printable(&verdict.file))
}

/// Returns the answer in a word.
pub(crate) fn answer(valid: bool) -> String {
    style::marked(Some(valid), if valid { "VALID" } else { "REFUSED" })
}

/// Returns how many checks were made, how many were not run, and which were not asked for.
pub(crate) fn counts(checks: &[Check]) -> String {
    let checked = checks.iter().filter(|check| check.was_asked() && check.passed().is_some()).count();
    let not_run = checks.iter().filter(|check| check.passed().is_none()).count();
    let idle = checks.iter().filter(|check| !check.was_asked()).map(|check| check.name);
    // Only those that are made on request.
    let absent = CheckName::ALL.into_iter().filter(|name| checks.iter().all(|check| check.name != *name));
    let not_asked: Vec<&str> = idle.chain(absent).map(CheckName::as_str).collect();
    let failed = checks.iter().filter(|check| check.passed() == Some(false)).map(|check| check.name.as_str());
    let failed: Vec<&str> = failed.collect();
    let mut words = format!("{checked} checked");
    if !failed.is_empty() {
        words = format!("failed: {}; {words}", failed.join(", "));
    }
    if not_run > 0 {
        let _ = write!(words, ", {not_run} not run");
    }
    if !not_asked.is_empty() {
        let _ = write!(words, ", {} not asked: {}", not_asked.len(), not_asked.join(", "));
    }
    words
}
