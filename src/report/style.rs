//! Emphasis in a terminal: ANSI codes around whole words and lines. [`plain`] removes them for output without emphasis.

use crate::text::printable;
use anstyle::{AnsiColor, Style};

pub(crate) fn heading(words: &str) -> String {
    styled(Style::new().bold(), words)
}

/// Formats secondary words, such as the names of columns.
pub(crate) fn faint(words: &str) -> String {
    styled(Style::new().dimmed(), words)
}

pub(crate) fn good(words: &str) -> String {
    styled(AnsiColor::Green.on_default().bold(), words)
}

/// Formats a bad result or a warning.
pub(crate) fn bad(words: &str) -> String {
    styled(AnsiColor::Red.on_default().bold(), words)
}

/// Returns the mark of a result, in a terminal and on paper; `None` if it was not asked, or is undecided. The mark only
/// repeats the words beside it, so that they can be read without it.
pub(crate) fn mark(passed: Option<bool>) -> &'static str {
    match passed {
        Some(true) => "●",
        None => "○",
        Some(false) => "✕",
    }
}

/// Formats a result with its mark.
pub(crate) fn marked(passed: Option<bool>, words: &str) -> String {
    let words = format!("{} {words}", mark(passed));
    match passed {
        Some(true) => good(&words),
        None => words,
        Some(false) => bad(&words),
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
        for text in [heading("a"), faint("b"), good("c"), bad("d"), marked(Some(true), "e"), marked(Some(false), "f")] {
            assert_eq!(outgoing(&text), text);
        }
    }

    /// Expected: the marks of the printed pages.
    #[test]
    fn a_result_has_one_of_three_marks() {
        let marks = [(Some(true), "● a"), (None, "○ a"), (Some(false), "✕ a")];
        for (passed, due) in marks {
            assert_eq!(plain(&marked(passed, "a")), due);
        }
    }
}
