//! Words that no line breaks: dates, powers of ten, units with a solidus, ids.

use maud::{Markup, html};

/// Units in which browsers see a place for a line to end, after the solidus.
const WITH_SOLIDUS: [&str; 3] = ["m/s²", "м/с²", "°/"];

/// Length in bytes below which a word with a unit fits every line.
const LONGEST_QUANTITY: usize = 40;

/// The name of the program.
const PROGRAM: &str = "dtg-passport";

/// Number of solidi from which a word is the id of a passport.
const SOLIDI_OF_AN_ID: usize = 3;

/// Writes words so that no line ends at the hyphen of a date, of a designation or of an id, at the minus of a power of ten, where
/// browsers see a hyphen, after the solidus of a unit, or within the name of the program. A line may end after a solidus of an id
/// and after the @ of an address, none after the bars of an absolute value.
/// The text that a reader copies is unchanged.
pub(crate) fn unbroken(words: &str) -> Markup {
    let is_designation = |around: &[u8]| match around {
        [before, b'-', after] => before.is_ascii_alphanumeric() && after.is_ascii_digit(),
        _ => false,
    };
    let with_solidus = |word: &str| WITH_SOLIDUS.iter().any(|unit| word.contains(unit));
    // A block of its own would let a line end before a unit, even after a non-breaking space.
    let class = |word: &str| {
        if (with_solidus(word) || word.contains('|')) && word.len() < LONGEST_QUANTITY { "quantity" } else { "n" }
    };
    let whole = |word: &str| {
        word.as_bytes().windows(3).any(is_designation)
            || word.starts_with(PROGRAM)
            || with_solidus(word)
            || word.contains('|')
            || word.split_once(' ').is_some_and(|(first, _)| is_initial(first))
            || word.contains('-') && (is_id(word) || word.contains('@'))
    };
    html! {
        @for word in with_initials(words) {
            @let shown = word.trim_end();
            @if whole(shown) {
                @for (place, part) in parts(shown).enumerate() {
                    @if place > 0 { wbr; }
                    span class=(class(shown)) { (lowered(part)) }
                }
                (&word[shown.len()..])
            } @else {
                (word)
            }
        }
    }
}

/// Splits a text after its spaces, but for those between initials and a surname.
fn with_initials(text: &str) -> Vec<&str> {
    let mut words: Vec<&str> = Vec::new();
    let mut end = 0;
    for word in text.split_inclusive(' ') {
        end += word.len();
        let is_name = word.starts_with(char::is_uppercase);
        let of_name = |last: &str| is_name && last.split_whitespace().next_back().is_some_and(is_initial);
        match words.last_mut().filter(|last| of_name(last)) {
            Some(last) => *last = &text[end - word.len() - last.len()..end],
            None => words.push(word),
        }
    }
    words
}

/// Returns `true` for a capital letter with a point, as in «М. П.».
fn is_initial(word: &str) -> bool {
    let mut letters = word.chars();
    matches!((letters.next(), letters.next()), (Some(letter), Some('.')) if letter.is_uppercase())
}

/// Writes the index of a unit, °/(h·g₀), in a size that can be read.
fn lowered(unit: &str) -> Markup {
    html! {
        @match unit.split_once('₀') {
            Some((before, after)) => { (before) sub { "0" } (after) }
            None => (unit),
        }
    }
}

/// Returns `true` for the id of a passport. In quotes it is part of a file, which stays as it is.
fn is_id(word: &str) -> bool {
    word.matches('/').count() >= SOLIDI_OF_AN_ID && !word.contains('"')
}

/// Returns the parts of an id, each with the solidus at its end, and those of an address; of anything else the whole. The
/// revision does not leave the part before it.
fn parts(word: &str) -> impl Iterator<Item = &str> {
    let last = word.rfind('/').filter(|_| is_id(word)).unwrap_or(0);
    let mut at = 0;
    word.split_inclusive(move |c: char| {
        let is_end = c == '@' || c == '/' && at < last;
        at += c.len_utf8();
        is_end
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Between `[` and `]`: a date, a number with an exponent, a designation, the program, an id; between `{` and `}` a unit with a
    /// solidus. Hyphens of words and names are no part of a number.
    #[test]
    fn no_line_ends_within_a_number_or_a_name() {
        for due in [
            "until [2028-11-01] (inclusive)",
            "u: [3.2e-05,] [C-18,] g-sensitive",
            "[GVK-6] and [SPS-2] № 0017, [SHA-256]",
            "run [dtg-passport] verify or ssh-keygen",
            "(МГТУ им. [Н. Э. Баумана,] Москва) A. of",
            "by [name@]<wbr>[dtg-passport.test]",
            "passport [SPS-2/]<wbr>[0017/]<wbr>[moscow-bmstu/1] of",
            "id: \"XYZ/0017/moscow-bmstu/1\"",
            "[a-1-2]",
            "of {9.8\u{a0}м/с²,} and/or {°/(h·g<sub>0</sub>)}",
        ] {
            let plain = due.replace(['[', ']', '{', '}'], "").replace("<wbr>", "").replace("<sub>0</sub>", "₀");
            let written = unbroken(&plain).into_string().replace("&quot;", "\"");
            let due = due.replace('[', "<span class=\"n\">").replace('{', "<span class=\"quantity\">");
            assert_eq!(written, due.replace([']', '}'], "</span>"));
        }
    }
}
