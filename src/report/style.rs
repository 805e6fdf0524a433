//! Emphasis in a terminal: ANSI codes about whole words and lines, which whoever prints takes out again where nobody
//! wants them ([`plain`]).

use anstyle::{AnsiColor, Style};

/// A heading.
pub fn heading(words: &str) -> String {
    styled(Style::new().bold(), words)
}

/// What only names the columns.
pub fn faint(words: &str) -> String {
    styled(Style::new().dimmed(), words)
}

/// What is as it should be.
pub fn good(words: &str) -> String {
    styled(AnsiColor::Green.on_default().bold(), words)
}

/// What must not be overlooked.
pub fn bad(words: &str) -> String {
    styled(AnsiColor::Red.on_default().bold(), words)
}

/// The text without any emphasis.
pub fn plain(text: &str) -> String {
    anstream::adapter::strip_str(text).to_string()
}

fn styled(style: Style, words: &str) -> String {
    format!("{style}{words}{style:#}")
}
