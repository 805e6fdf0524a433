//! Numbers as elements of a page, and what aligns the decimal marks of a column.

use super::language::Languages;
use crate::text::number;
use crate::wording::number::THIN_BLANK;
use crate::wording::{BLANK, Number};
use maud::{Markup, html};

impl Languages {
    /// Writes the number as an element that carries the value itself for programs, in the notation of signed documents.
    pub(crate) fn number(&self, number: &Number) -> Markup {
        html! { data value=(number::decimal(number.value)) { (number.text(self.first())) } }
    }

    /// Writes that a value is below this one. It ends with the column: of a power of ten alone no decimal mark aligns.
    pub(crate) fn below(&self, limit: &Number) -> Markup {
        html! { "<" (BLANK) (limit.text(self.first())) }
    }

    /// Writes after each number invisible characters that make its tail as long as the longest, so that the decimal marks of
    /// a column align.
    pub(crate) fn pads(&self, numbers: &[Option<&Number>]) -> Vec<Markup> {
        let tail = |number: &Option<&Number>| number.map(|number| Tail::of(&number.text(self.first())));
        let tails: Vec<Option<Tail>> = numbers.iter().map(tail).collect();
        let longest = tails.iter().flatten().cloned().fold(Tail::default(), Tail::or_longer);
        let missing = tails.iter().map(|tail| tail.as_ref().map(|tail| longest.beyond(tail)).unwrap_or_default());
        missing.map(|missing| html! { @if !missing.is_empty() { span.pad aria-hidden="true" { (missing) } } }).collect()
    }
}

/// Part of a printed number from its decimal mark on: the mark, digits, spaces between their groups, and a power of ten.
#[derive(Debug, Clone, Default)]
struct Tail {
    /// Number of characters of each of the `KINDS`.
    counts: [usize; 3],
    power: String,
}

impl Tail {
    /// A mark, a digit and a space: digits have one width, and so have both marks.
    const KINDS: [char; 3] = ['.', '0', THIN_BLANK];

    fn of(text: &str) -> Self {
        let power = text.find(['\u{00D7}', '\u{00B7}']).map_or(text.len(), |at| at - THIN_BLANK.len_utf8());
        let (mantissa, power) = text.split_at(power);
        let decimals = mantissa.split_once(['.', ',']).map(|(_, decimals)| decimals);
        let count = |of: fn(char) -> bool| decimals.map_or(0, |decimals| decimals.chars().filter(|c| of(*c)).count());
        let counts = [usize::from(decimals.is_some()), count(|c| c.is_ascii_digit()), count(|c| c == THIN_BLANK)];
        Self { counts, power: power.to_owned() }
    }

    /// Returns the longest of each part.
    fn or_longer(self, other: Self) -> Self {
        let longer = if other.power.chars().count() > self.power.chars().count() { other.power } else { self.power };
        Self { counts: [0, 1, 2].map(|kind| self.counts[kind].max(other.counts[kind])), power: longer }
    }

    /// Returns characters as wide as what this tail has beyond `own`.
    fn beyond(&self, own: &Self) -> String {
        let counts = self.counts.iter().zip(own.counts).zip(Self::KINDS);
        let missing = counts.flat_map(|((longest, own), kind)| std::iter::repeat_n(kind, longest - own));
        missing.chain(self.power.chars().skip(own.power.chars().count())).collect()
    }
}
