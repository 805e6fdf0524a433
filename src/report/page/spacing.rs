//! Words that no line breaks: dates, powers of ten, units with a solidus.

use maud::{Markup, html};

pub(crate) use crate::wording::spacing::BLANK;

/// Units in which browsers see a place for a line to end, after the solidus.
const WITH_SOLIDUS: [&str; 3] = ["m/s²", "м/с²", "°/"];

/// Writes words so that no line ends at the hyphen of a date, at the minus of a power of ten, where browsers see a hyphen, or
/// after the solidus of a unit.
pub(crate) fn unbroken(words: &str) -> Markup {
    let is_within_number = |around: &[u8]| match around {
        [before, b'-', after] => (before.is_ascii_digit() || *before == b'e') && after.is_ascii_digit(),
        _ => false,
    };
    html! {
        @for word in words.split_inclusive(' ') {
            @if word.as_bytes().windows(3).any(is_within_number) || WITH_SOLIDUS.iter().any(|unit| word.contains(unit)) {
                span.n { (word.trim_end()) } (&word[word.trim_end().len()..])
            } @else {
                (word)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Between `[` and `]`: a date, a number with an exponent, a unit with a solidus. Hyphens of words and names are no part of
    /// a number.
    #[test]
    fn no_line_ends_within_a_number() {
        for due in [
            "until [2028-11-01] (inclusive)",
            "u: [3.2e-05,] C-18, g-sensitive",
            "[a-1-2]",
            "of [9.8\u{a0}м/с²,] and/or",
        ] {
            let written = unbroken(&due.replace(['[', ']'], "")).into_string();
            assert_eq!(written.replace("<span class=\"n\">", "[").replace("</span>", "]"), due);
        }
    }
}
