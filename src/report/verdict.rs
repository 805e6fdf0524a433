//! Answer of `verify` as text.

use super::{columns, style, style::Outcome};
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
    for (check, passed) in checks.iter().filter_map(|check| Some((check, check.passed()?))) {
        row(Some(passed), if passed { "passed" } else { "FAILED" }, check.name.as_str(), &check.detail);
    }
    if let not_run @ [_, ..] = &*named(checks, Code::NotRun) {
        row(None, "not run", &format!("{}: an earlier check failed", not_run.join(", ")), "");
    }
    let with_option = |check: &Check| Some(format!("{} ({})", check.name.as_str(), check.name.option()?));
    let not_asked: Vec<_> = checks.iter().filter(|check| !check.was_asked()).filter_map(with_option).collect();
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
    format!("{}  {id}  {}\n", answer(verdict.valid, &verdict.checks), Printable(&verdict.file))
}

/// Returns the counts of the answers for several files, of which `unread` could not be read; nothing for a single file.
pub(crate) fn summary(verdicts: &[Verdict], unread: usize) -> String {
    let all = verdicts.len();
    if all < 2 {
        return String::new();
    }
    let outcomes: Vec<_> = verdicts.iter().map(|verdict| outcome(verdict.valid, &verdict.checks)).collect();
    let count = |outcome| outcomes.iter().filter(|(found, _)| *found == outcome).count();
    let [valid, so_far, failed] = [Outcome::Passed, Outcome::Undecided, Outcome::Failed].map(count);
    let counts = [(valid, "valid"), (so_far, "valid so far"), (failed - unread, "refused"), (unread, "not read")];
    let worst = match (failed, so_far) {
        (0, 0) => Outcome::Passed,
        (0, _) => Outcome::Undecided,
        _ => Outcome::Failed,
    };
    style::marked(worst, &format!("{all} files: {}", columns::counts(counts))) + "\n"
}

/// Returns the answer in words.
pub(crate) fn answer(valid: bool, checks: &[Check]) -> String {
    let (outcome, words) = outcome(valid, checks);
    style::marked(outcome, words)
}

/// Returns the answer of a verification: undecided if everything passed, but a question on which it depends whether the
/// passport may be used on this stand, here and now was not asked.
fn outcome(valid: bool, checks: &[Check]) -> (Outcome, &'static str) {
    let needed = [CheckName::Stand, CheckName::Place, CheckName::Register];
    match checks.iter().any(|check| !check.was_asked() && needed.contains(&check.name)) {
        _ if !valid => (Outcome::Failed, "REFUSED"),
        true => (Outcome::Undecided, "VALID SO FAR"),
        false => (Outcome::Passed, "VALID"),
    }
}

/// Returns the names of the checks with this result: not run, because of an earlier failure, or not requested.
fn named(checks: &[Check], code: Code) -> Vec<&'static str> {
    checks.iter().filter(|check| check.code == code).map(|check| check.name.as_str()).collect()
}

/// Returns which checks failed, and how many were made, were not run, or were not asked for.
fn counts(checks: &[Check]) -> String {
    let failed: Vec<&str> =
        checks.iter().filter(|check| check.passed() == Some(false)).map(|check| check.name.as_str()).collect();
    let failed = if failed.is_empty() { String::new() } else { format!("failed: {}; ", failed.join(", ")) };
    let checked = checks.iter().filter(|check| check.passed().is_some()).count();
    let others = [(Code::NotRun, "not run"), (Code::NotAsked, "not asked")];
    let others = others.map(|(code, word)| (named(checks, code).len(), word)).into_iter();
    let others = others.filter(|(count, _)| *count > 0).map(|(count, word)| format!(", {count} {word}"));
    format!("{failed}{checked} checked{}", others.collect::<String>())
}

/// Returns the counts of the checks, with the names of those that were not asked for.
pub(crate) fn counts_with_names(checks: &[Check]) -> String {
    let names = named(checks, Code::NotAsked);
    counts(checks) + &if names.is_empty() { String::new() } else { format!(": {}", names.join(", ")) }
}
