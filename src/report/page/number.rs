//! Numbers as elements of a page, and columns of them with aligned decimal marks.

use super::language::Languages;
use super::spacing::BLANK;
use crate::text::number;
use maud::{Markup, html};

pub(crate) use crate::wording::number::{
    LARGEST_IN_ARCSEC, LATITUDES, LONGITUDES, Number, THIN_BLANK, localised, superscripts,
};

impl Languages {
    /// Writes the number as an element that carries the value itself for programs, in the notation of signed documents.
    pub(crate) fn number(&self, number: &Number) -> Markup {
        html! { data value=(number::decimal(number.value)) { (number.text(self.first())) } }
    }

    /// Writes that a value is below this one. It ends with the column: of a power of ten alone no decimal mark aligns.
    pub(crate) fn below(&self, limit: &Number) -> Markup {
        html! { "<" (BLANK) (limit.text(self.first())) }
    }

    /// Writes invisible characters that make the tail of a number as long as `longest`, so that the decimal marks of a column
    /// align.
    fn pad(&self, number: &Number, longest: &Tail) -> Markup {
        let missing = longest.beyond(&Tail::of(&number.text(self.first())));
        html! { @if !missing.is_empty() { span.pad aria-hidden="true" { (missing) } } }
    }

    /// Writes the cells of a column, its numbers with aligned decimal marks.
    pub(crate) fn column(&self, cells: impl IntoIterator<Item = impl Into<Cell>>) -> Vec<Markup> {
        let cells: Vec<Cell> = cells.into_iter().map(Into::into).collect();
        let tails = cells.iter().filter_map(|cell| match cell {
            Cell::Number(number) | Cell::WithUnit(number, _) => Some(Tail::of(&number.text(self.first()))),
            Cell::Below(_) | Cell::Words(_) => None,
        });
        let longest = tails.fold(Tail::default(), Tail::or_longer);
        let written = cells.into_iter().map(|cell| match cell {
            Cell::Number(number) => html! { (self.number(&number)) (self.pad(&number, &longest)) },
            Cell::Below(limit) => self.below(&limit),
            Cell::WithUnit(number, unit) => {
                // No space before the mark of an angle (SI Brochure, 5.4.3).
                let close = unit.0 == "″";
                html! { (self.number(&number)) span.unit { @if !close { (BLANK) } (unit) } (self.pad(&number, &longest)) }
            }
            Cell::Words(words) => words,
        });
        written.collect()
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

#[derive(Debug, Clone)]
pub(crate) enum Cell {
    /// A number; its decimal mark aligns with those of the column.
    Number(Number),
    /// A number that is only said to be below this limit, a power of ten.
    Below(Number),
    /// A number directly followed by its unit; all units of a column have one width.
    WithUnit(Number, Markup),
    /// Anything else.
    Words(Markup),
}

impl Cell {
    /// Returns the cell of a quantity that there is not.
    pub(crate) fn none() -> Self {
        Self::Words(html! { "–" })
    }
}

impl From<Number> for Cell {
    fn from(number: Number) -> Self {
        Self::Number(number)
    }
}

impl From<Option<Number>> for Cell {
    fn from(number: Option<Number>) -> Self {
        number.map_or_else(Self::none, Self::Number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: the longest tail has five decimals in two groups and a power of ten.
    #[test]
    fn tails_of_a_column_become_equally_long() {
        let longest = ["0,000\u{202f}12", "3,4\u{202f}·\u{202f}10⁻⁵", "7"].map(Tail::of);
        let longest = longest.into_iter().fold(Tail::default(), Tail::or_longer);
        let missing = |text: &str| longest.beyond(&Tail::of(text)).replace(THIN_BLANK, "_");
        assert_eq!(missing("0,000\u{202f}12"), "_·_10⁻⁵");
        assert_eq!(missing("0,0012"), "0__·_10⁻⁵");
        assert_eq!(missing("3,4\u{202f}·\u{202f}10⁻⁵"), "0000_");
        assert_eq!(missing("7"), ".00000__·_10⁻⁵");
    }
}
