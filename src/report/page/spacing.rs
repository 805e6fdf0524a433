//! Words that no line breaks: dates, powers of ten, units with a solidus.

use maud::{Markup, html};

pub(crate) use crate::wording::spacing::BLANK;

/// Units in which browsers see a place for a line to end, after the solidus.
const WITH_SOLIDUS: [&str; 3] = ["m/s²", "м/с²", "°/"];

/// Commands, which stand on one line.
const COMMANDS: [&str; 1] = ["dtg-passport verify"];

/// Number of solidi from which a word is the id of a passport.
const SOLIDI_OF_AN_ID: usize = 3;

/// Writes words so that no line ends at the hyphen of a date, of a designation or of an id, at the minus of a power of ten, where
/// browsers see a hyphen, after the solidus of a unit, or within a command. An id may end a line after its solidi. What is
/// copied has the characters of the text.
pub(crate) fn unbroken(words: &str) -> Markup {
    let is_designation = |around: &[u8]| match around {
        [before, b'-', after] => before.is_ascii_alphanumeric() && after.is_ascii_digit(),
        _ => false,
    };
    let whole = |word: &str| {
        let (solidi, hyphen) = (word.matches('/').count(), word.contains('-'));
        word.as_bytes().windows(3).any(is_designation)
            || WITH_SOLIDUS.iter().any(|unit| word.contains(unit))
            || COMMANDS.iter().any(|command| word.contains(command))
            || hyphen && (solidi >= SOLIDI_OF_AN_ID || word.contains('@'))
    };
    html! {
        @for word in split_after_blanks(words) {
            @let shown = word.trim_end_matches([' ', '\n']);
            @if whole(shown) {
                @for (place, part) in parts_of_id(shown).enumerate() {
                    @if place > 0 { wbr; }
                    span.n { (part) }
                }
                (&word[shown.len()..])
            } @else {
                (word)
            }
        }
    }
}

/// Splits words after each space, but for those within a command.
fn split_after_blanks(words: &str) -> impl Iterator<Item = &str> {
    let mut rest = words;
    std::iter::from_fn(move || {
        let command = COMMANDS.iter().find(|command| rest.starts_with(*command));
        let from = command.map_or(0, |command| command.len());
        let end = rest[from..].find(' ').map_or(rest.len(), |at| from + at + 1);
        let (word, after) = rest.split_at(end);
        rest = after;
        (!word.is_empty()).then_some(word)
    })
}

/// Returns the parts of an id, each with the solidus at its end; of anything else the whole.
fn parts_of_id(word: &str) -> impl Iterator<Item = &str> {
    let id = word.matches('/').count() >= SOLIDI_OF_AN_ID;
    word.split_inclusive(move |c| id && c == '/')
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Between `[` and `]`: a date, a number with an exponent, a unit with a solidus, a designation, a command, the parts of an
    /// id. Hyphens of words and names are no part of a number.
    #[test]
    fn no_line_ends_within_a_number_a_designation_or_a_command() {
        for due in [
            "until [2028-11-01] (inclusive)",
            "u: [3.2e-05,] [C-18,] g-sensitive",
            "[GVK-6] and [SPS-2] № 0017, [SHA-256]",
            "run [dtg-passport verify,] or ssh-keygen",
            "[dtg-passport verify.]",
            "by [name@dtg-passport.test]",
            "passport [SPS-2/]<wbr>[0017/]<wbr>[moscow-bmstu/]<wbr>[1] of",
            "[a-1-2]",
            "of [9.8\u{a0}м/с²,] and/or",
        ] {
            let written = unbroken(&due.replace(['[', ']'], "").replace("<wbr>", "")).into_string();
            assert_eq!(written.replace("<span class=\"n\">", "[").replace("</span>", "]"), due);
        }
    }
}
