//! Answer of `verify` as text.

use super::{columns, style};
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
    let checks = &verdict.checks;
    let _ = writeln!(text, "  {}", counts(checks));
    let mut row = |passed, word: &str, name: &str, words: &str| {
        let result = style::marked(passed, &format!("{word:<9}"));
        let words = words.replace('\n', "\n                           ");
        let _ = writeln!(text, "{}", format!("  {result}  {name:<10}  {words}").trim_end());
    };
    let run = checks.iter().filter(|check| check.was_asked());
    for (check, passed) in run.filter_map(|check| Some((check, check.passed()?))) {
        row(Some(passed), if passed { "passed" } else { "FAILED" }, check.name.as_str(), &check.detail);
    }
    if let not_run @ [_, ..] = &*not_run(checks) {
        row(None, "not run", &format!("{}: an earlier check failed", not_run.join(", ")), "");
    }
    let with_option = |name: CheckName| Some(format!("{} ({})", name.as_str(), option(name)?));
    let not_asked: Vec<String> = not_asked(checks).filter_map(with_option).collect();
    if !not_asked.is_empty() {
        row(None, "not asked", &not_asked.join(", "), "");
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

/// Returns the counts of the answers for several files, of which `unread` could not be read; nothing for a single file.
pub(crate) fn summary(verdicts: &[Verdict], unread: usize) -> String {
    let all = verdicts.len();
    if all < 2 {
        return String::new();
    }
    let valid = verdicts.iter().filter(|verdict| verdict.valid).count();
    let counts = columns::counts([(valid, "valid"), (all - valid - unread, "refused"), (unread, "not read")]);
    style::marked(Some(valid == all), &format!("{all} files: {counts}")) + "\n"
}

/// Returns the answer in a word.
pub(crate) fn answer(valid: bool) -> String {
    style::marked(Some(valid), if valid { "VALID" } else { "REFUSED" })
}

/// Returns the names of the checks that an earlier failure prevented.
fn not_run(checks: &[Check]) -> Vec<&'static str> {
    checks
        .iter()
        .filter(|check| check.was_asked() && check.passed().is_none())
        .map(|check| check.name.as_str())
        .collect()
}

/// Returns the checks for which there was no question: those on request are absent.
fn not_asked(checks: &[Check]) -> impl Iterator<Item = CheckName> {
    let asked = |name: &CheckName| checks.iter().any(|check| check.name == *name && check.was_asked());
    CheckName::ALL.into_iter().filter(move |name| !asked(name))
}

/// Returns the option that asks for a check, or `None` for one that is always made.
fn option(name: CheckName) -> Option<&'static str> {
    Some(match name {
        CheckName::Revocation => "--revoked",
        CheckName::Issuer => "--issuer",
        CheckName::Stand => "--serial",
        CheckName::Place => "--at",
        CheckName::Register => "--register",
        _ => return None,
    })
}

/// Returns which checks failed, and how many were made, were not run, or were not asked for.
fn counts(checks: &[Check]) -> String {
    let failed: Vec<&str> =
        checks.iter().filter(|check| check.passed() == Some(false)).map(|check| check.name.as_str()).collect();
    let failed = if failed.is_empty() { String::new() } else { format!("failed: {}; ", failed.join(", ")) };
    let checked = checks.iter().filter(|check| check.was_asked() && check.passed().is_some()).count();
    let others = [(not_run(checks).len(), "not run"), (not_asked(checks).count(), "not asked")];
    let others = others.into_iter().filter(|(count, _)| *count > 0).map(|(count, word)| format!(", {count} {word}"));
    format!("{failed}{checked} checked{}", others.collect::<String>())
}

/// Returns the counts of the checks, with the names of those that were not asked for.
pub(crate) fn counts_with_names(checks: &[Check]) -> String {
    let names: Vec<&str> = not_asked(checks).map(CheckName::as_str).collect();
    let names = if names.is_empty() { String::new() } else { format!(": {}", names.join(", ")) };
    counts(checks) + &names
}
