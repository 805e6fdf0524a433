//! Answer of `verify` as text.

use super::style;
pub(crate) use crate::interface::Verdict;
use crate::text::Printable;
use std::fmt::Write;

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
