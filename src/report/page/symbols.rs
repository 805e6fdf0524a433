//! Symbols of quantities within texts: italic, with their subscripts. Units stay upright (SI Brochure, 5.4.1).

use super::spacing::unbroken;
use maud::{Markup, html};

/// Latin letters that are symbols wherever they stand alone.
const LATIN: &str = "DFJKRUgijknpsuxyz";

#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Piece<'a> {
    /// Upright words.
    Words(&'a str),
    /// A symbol and its subscript.
    Symbol(&'a str, &'a str),
}

/// Splits a text into words and symbols; `ω_g` is a symbol with a subscript.
pub(crate) fn pieces(text: &str) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    // The symbol of g is a unit too.
    if text.chars().count() == 1 {
        return vec![Piece::Words(text)];
    }
    let mut from = 0;
    for (at, letter) in text.char_indices() {
        let after = &text[at + letter.len_utf8()..];
        if at >= from && is_symbol(&text[..at], letter, after) {
            let rest = after.strip_prefix('_').unwrap_or("");
            let index = &rest[..rest.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(rest.len())];
            pieces.push(Piece::Words(&text[from..at]));
            pieces.push(Piece::Symbol(&text[at..at + letter.len_utf8()], index));
            from = text.len() - after.len() + if index.is_empty() { 0 } else { 1 + index.len() };
        }
    }
    pieces.push(Piece::Words(&text[from..]));
    pieces.retain(|piece| *piece != Piece::Words(""));
    pieces
}

/// Returns `true` if a letter between others is a symbol, not part of a word, a unit or a name of a file.
fn is_symbol(before: &str, letter: char, after: &str) -> bool {
    let greek = ('Α'..='Ω').contains(&letter) || ('α'..='ω').contains(&letter);
    if !greek && !LATIN.contains(letter) {
        return false;
    }
    let mut next = after.chars();
    let (next, second) = (next.next(), next.next());
    // In 2u, u is a symbol.
    let factor = |c: char| c.is_ascii_digit() && matches!(letter, 'u' | 'U');
    // In 1/g and 10⁻⁴ g, g is the unit.
    let number = || before.trim_end().ends_with(|c: char| c.is_numeric()) && before.ends_with(char::is_whitespace);
    let unit = letter == 'g' && (before.ends_with('/') || number());
    let begins = !unit
        && before.chars().next_back().is_none_or(|c| factor(c) || !c.is_alphanumeric() && !"·°'’.-_@".contains(c));
    let subscript = |c: char| c == '_' || ('₀'..='₉').contains(&c);
    let squared = |c: char| letter == 'u' && c == '²';
    let ends = next.is_none_or(|c| {
        (greek || letter == 'g') && subscript(c) || squared(c) || !c.is_alphanumeric() && !"'’_@".contains(c)
    });
    let abbreviated = next == Some('.') && second.is_some_and(char::is_alphanumeric);
    begins && ends && !abbreviated
}

/// Returns the letters of an index with `true` for those that are italic: names of axes and running numbers. Words are
/// upright (ISO 80000-1, 7.1.2).
pub(crate) fn index_letters(index: &str) -> impl Iterator<Item = (char, bool)> {
    let running = index.chars().all(|c| c.is_ascii_digit() || "ijxyz".contains(c));
    index.chars().map(move |c| (c, running && c.is_ascii_alphabetic()))
}

pub(crate) fn index(index: &str) -> Markup {
    html! { sub { @for (c, italic) in index_letters(index) { @if italic { i { (c) } } @else { (c) } } } }
}

/// Writes a text with its symbols.
pub(crate) fn italic(text: &str) -> Markup {
    html! {
        @for piece in pieces(text) {
            @match piece {
                Piece::Words(words) => (unbroken(words)),
                Piece::Symbol(letter, "") => i { (letter) },
                Piece::Symbol(letter, below) => { i { (letter) } (index(below)) },
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Symbols between `*`, as SI Brochure, 5.4.1, sets them: quantities italic; units, words and names upright.
    #[test]
    fn quantities_are_italic_and_units_are_not() {
        for due in [
            "*u*(*α*), *k* = 1, ±2*u*, *U* = 2*u*",
            "5 m/s², 3 °/(h·g), 1/g, 2 g, 10⁻⁴\u{a0}g, °/h, 20 °C, 5 mA, µA; *x*/*u*",
            "the frame’s axis *ξ*, the platform's; a file.s, a-u, i.e. a text",
            "*g*-sensitive drift, отнесены к *g*; в осях *x*, *y*, *z*",
            "test whether *ω*_g and *ω*_k; *ω*₃; position (*i*, *j*); labels are *i*,*j*",
            "Type B, part C, xyz, u_level, dtg-passport verify",
        ] {
            let said: String = pieces(&due.replace('*', ""))
                .iter()
                .map(|piece| match piece {
                    Piece::Words(words) => (*words).to_owned(),
                    Piece::Symbol(letter, "") => format!("*{letter}*"),
                    Piece::Symbol(letter, index) => format!("*{letter}*_{index}"),
                })
                .collect();
            assert_eq!(said, due);
        }
        assert_eq!(pieces("g"), [Piece::Words("g")]);
    }
}
