//! Emphasis in a terminal: ANSI codes about whole words and lines, which whoever prints takes out again where nobody
//! wants them ([`plain`]).

use crate::text::printable;
use anstyle::{AnsiColor, Style};

/// A heading.
pub(crate) fn heading(words: &str) -> String {
    styled(Style::new().bold(), words)
}

/// What only names the columns.
pub(crate) fn faint(words: &str) -> String {
    styled(Style::new().dimmed(), words)
}

/// What is as it should be.
pub(crate) fn good(words: &str) -> String {
    styled(AnsiColor::Green.on_default().bold(), words)
}

/// What must not be overlooked.
pub(crate) fn bad(words: &str) -> String {
    styled(AnsiColor::Red.on_default().bold(), words)
}

/// What stands behind the escape character in every code of these; and [`outgoing`] lets no other out.
const CODES: [&str; 5] = ["[0m", "[1m", "[2m", "[31m", "[32m"];

/// The text as it may go to a terminal.
pub(crate) fn outgoing(text: &str) -> String {
    printable::outgoing(text, &CODES)
}

/// The text without any emphasis.
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
        for text in [heading("a"), faint("b"), good("c"), bad("d")] {
            assert_eq!(outgoing(&text), text);
        }
    }
}
