//! Emphasis in a terminal: ANSI codes around whole words and lines. [`plain`] removes them for output without emphasis.

pub(crate) use crate::wording::words::Outcome;

use crate::calibration::Decision;
use crate::text::printable;
use anstyle::{AnsiColor, Style};

pub(crate) fn heading(words: &str) -> String {
    styled(Style::new().bold(), words)
}

/// Formats secondary words, such as the names of columns.
pub(crate) fn faint(words: &str) -> String {
    styled(Style::new().dimmed(), words)
}

impl From<bool> for Outcome {
    /// Converts the result of a check.
    fn from(passed: bool) -> Self {
        if passed { Self::Passed } else { Self::Failed }
    }
}

impl<T: Into<Self>> From<Option<T>> for Outcome {
    /// Converts the result of a check or a decision; `None` if it was not asked, or if no statement is made.
    fn from(result: Option<T>) -> Self {
        result.map_or(Self::NotAsked, Into::into)
    }
}

impl From<Decision> for Outcome {
    fn from(decision: Decision) -> Self {
        match decision {
            Decision::Pass => Self::Passed,
            Decision::Fail => Self::Failed,
            Decision::Undecided => Self::Undecided,
        }
    }
}

pub(crate) fn marked(outcome: impl Into<Outcome>, words: &str) -> String {
    let outcome = outcome.into();
    let words = format!("{} {words}", outcome.mark());
    match outcome {
        Outcome::Passed => styled(AnsiColor::Green.on_default().bold(), &words),
        Outcome::Failed => styled(AnsiColor::Red.on_default().bold(), &words),
        Outcome::Undecided | Outcome::NotAsked => words,
    }
}

/// ANSI codes used here, without the escape character; [`outgoing`] lets no other code pass.
const CODES: [&str; 5] = ["[0m", "[1m", "[2m", "[31m", "[32m"];

/// Returns the text as it may be written to a terminal: control characters are escaped, except line feeds and emphasis.
pub(crate) fn outgoing(text: &str) -> String {
    printable::outgoing(text, &CODES)
}

/// Returns the text without any emphasis.
pub(crate) fn plain(text: &str) -> String {
    anstream::adapter::strip_str(text).to_string()
}

fn styled(style: Style, words: &str) -> String {
    format!("{style}{words}{style:#}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_emphasis_goes_out() {
        for text in [heading("a"), faint("b"), marked(true, "e"), marked(false, "f")] {
            assert_eq!(outgoing(&text), text);
        }
    }
}
