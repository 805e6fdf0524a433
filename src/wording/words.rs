//! What is said, in every language at once, before it has a medium.

use super::number::{LEAST_PROBABILITY, Number, Probability};
use super::texts::units::{ARCSEC, DEGREES};
use super::{Language, Piece, Text, capital, date_text, pieces, time_text};
use crate::coefficients::PositionIndex;
use crate::text::{Identifier, printable};
use crate::units::quantity;
use jiff::{Timestamp, civil::Date};

/// Outcome of a check, a test or a decision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    Passed,
    Failed,
    /// Asked, but not decided.
    Undecided,
    NotAsked,
}

impl Outcome {
    /// Returns the mark of the outcome, in a terminal and on paper. The mark only repeats the words next to it, so that
    /// they can be read without it.
    pub(crate) fn mark(self) -> &'static str {
        match self {
            Self::Passed => "●",
            Self::Failed => "✕",
            Self::Undecided => "◐",
            Self::NotAsked => "○",
        }
    }
}

/// A text about a number of things.
pub(crate) type Counted = fn(usize) -> Words;

/// What is said, in every language at once.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Words {
    /// A text of a table, with its values.
    Text(Text, Vec<(&'static str, Words)>),
    Number(Number),
    /// A number that a value is only known to be below.
    Below(Number),
    Quantity(Number, Text),
    /// A symbol of the paper with its index: `K_x`.
    Symbol(String),
    /// Words that are alike in every language.
    Plain(String),
    /// Words from a file.
    Given(String),
    Code(String),
    Date(Date),
    Time(Timestamp),
    /// Degrees with one of two hemispheres instead of their sign.
    Coordinate(Number, [Text; 2]),
    /// Words whose numbers and days are not those of a signed file, so that they carry no value for programs.
    Told(Box<Words>),
    Marked(Outcome, Box<Words>),
    Strong(Box<Words>),
    /// Words with a capital first letter.
    Capital(Box<Words>),
    /// Words in the first language of a page only, and in the others only.
    First(Box<Words>),
    Others(Box<Words>),
    /// The mark of an outcome on telephones, which show the first column and few others.
    OnTelephones(Outcome),
    /// Words in an element of this class.
    Styled(&'static str, Box<Words>),
    /// Words as in a cell, also where a page has the name of something: the languages side by side.
    Inline(Box<Words>),
    /// Words that are said whole in one language after the other, not part by part.
    Whole(Box<Words>),
    /// A sentence of the library, which programs get too and a terminal shows in English, and what is said in its place on
    /// pages and in other languages.
    OfLibrary(String, Box<Words>),
    /// A number of things, in a terminal with its thousands apart.
    Count(u64),
    /// Words and blanks, as many characters as there are in the longest word of each language.
    Padded(Box<Words>, [usize; Language::ALL.len()]),
    /// An empty space to fill in by hand.
    Blank,
    /// Words on a page only, and words in a terminal only.
    Either(Box<Words>, Box<Words>),
    All(Vec<Words>),
}

macro_rules! into_words {
    ($($from:ty: $value:ident => $words:expr),* $(,)?) => {
        $(impl From<$from> for Words { fn from($value: $from) -> Self { $words } })*
    };
}
into_words! {
    Text: text => Self::Text(text, Vec::new()),
    Number: number => Self::Number(number),
    &Number: number => Self::Number(number.clone()),
    &str: words => Self::Plain(words.to_owned()),
    String: words => Self::Plain(words),
    &String: words => Self::Plain(words.clone()),
    usize: count => Self::Plain(count.to_string()),
    u32: count => Self::Plain(count.to_string()),
    u64: count => Self::Plain(count.to_string()),
    f64: value => Self::Plain(value.to_string()),
    u16: count => Self::Plain(count.to_string()),
    &u32: count => Self::Plain(count.to_string()),
    &Identifier: words => Self::Given(words.as_str().to_owned()),
    &PositionIndex: index => Self::Plain(index.to_string()),
    PositionIndex: index => Self::Plain(index.to_string()),
    Date: date => Self::Date(date),
    Timestamp: time => Self::Plain(time.to_string()),
    Vec<Words>: all => Self::All(all),
}
impl<T: Into<Words>> From<Option<T>> for Words {
    fn from(words: Option<T>) -> Self {
        words.map_or_else(|| "–".into(), Into::into)
    }
}

impl From<Probability> for Words {
    /// A probability with its relation: `p = 0.012`.
    fn from(Probability(p): Probability) -> Self {
        let relation = if p < LEAST_PROBABILITY { "p\u{a0}" } else { "p\u{a0}=\u{a0}" };
        vec![relation.into(), probability(p)].into()
    }
}

/// A probability with two digits, or below the least that is printed.
pub(crate) fn probability(p: f64) -> Words {
    let number = Number::probability(p);
    if p < LEAST_PROBABILITY { Words::Below(number) } else { Words::Number(number) }
}

/// Words from a file.
pub(crate) fn given(words: impl Into<String>) -> Words {
    Words::Given(words.into())
}

pub(crate) fn told(words: impl Into<Words>) -> Words {
    Words::Told(Box::new(words.into()))
}

/// Words of the program as they are written in it: an option, a key of a file.
pub(crate) fn code(words: impl Into<String>) -> Words {
    Words::Code(words.into())
}

pub(crate) fn strong(words: impl Into<Words>) -> Words {
    Words::Strong(Box::new(words.into()))
}

/// Words on a page only, and words in a terminal only.
pub(crate) fn either(page: impl Into<Words>, terminal: impl Into<Words>) -> Words {
    Words::Either(Box::new(page.into()), Box::new(terminal.into()))
}

/// A value, and after it another quantity that belongs to it, if that is known: `12.4, u = 1.2`.
pub(crate) fn with(value: impl Into<Words>, name: &str, other: Option<impl Into<Words>>) -> Words {
    let other = other.map(|other| [", ".into(), symbol(name), "\u{a0}=\u{a0}".into(), other.into()]);
    [value.into()].into_iter().chain(other.into_iter().flatten()).collect::<Vec<_>>().into()
}

/// The least and the largest of some values as they are printed; one of them if both are printed alike.
pub(crate) fn range(values: impl Iterator<Item = f64>, printed: impl Fn(f64) -> Number) -> Vec<Number> {
    let [least, most] = values.fold([f64::INFINITY, 0.0], |[least, most], value| [value.min(least), value.max(most)]);
    let range = [least, most].map(printed);
    let [least, most] = range.each_ref().map(|number| number.text(Language::English));
    range.into_iter().skip(usize::from(least == most)).collect()
}

/// A word as wide as the longest of these.
pub(crate) fn padded(word: impl Into<Words>, longest: fn(Language) -> Option<usize>) -> Words {
    Words::Padded(Box::new(word.into()), Language::ALL.map(|language| longest(language).unwrap_or_default()))
}

/// Returns the length of the longest of some words in a language.
pub(crate) fn longest<const N: usize>(words: [Text; N], language: Language) -> Option<usize> {
    words.map(|word| word.of(language).chars().count()).into_iter().max()
}

pub(crate) fn symbol(name: &str) -> Words {
    Words::Symbol(name.to_owned())
}

/// Symbol and unit, as in the head of a column.
pub(crate) fn in_unit(symbol: Words, unit: Text) -> Words {
    vec![symbol, ",\u{a0}".into(), unit.into()].into()
}

pub(crate) fn listed(all: impl IntoIterator<Item = impl Into<Words>>) -> Words {
    joined(all, ", ")
}

pub(crate) fn joined(all: impl IntoIterator<Item = impl Into<Words>>, between: &str) -> Words {
    let each = all.into_iter().enumerate();
    each.flat_map(|(place, one)| (place > 0).then(|| between.into()).into_iter().chain([one.into()]))
        .collect::<Vec<_>>()
        .into()
}

pub(crate) fn marked(outcome: impl Into<Outcome>, words: impl Into<Words>) -> Words {
    Words::Marked(outcome.into(), Box::new(words.into()))
}

/// Returns a whole number with `between` before every group of three digits.
pub(crate) fn grouped(number: u64, between: &str) -> String {
    let digits = number.to_string();
    let groups = digits.as_bytes().rchunks(3).rev().map(String::from_utf8_lossy);
    groups.collect::<Vec<_>>().join(between)
}

/// Name, value, and whether it has the full width.
pub(crate) type Field = (Text, Words, bool);

/// What is said in a sentence or a few, or as names and values.
#[derive(Debug, Clone)]
pub(crate) enum Statement {
    Sentences(Vec<Words>),
    Fields(Vec<Field>),
}

impl Statement {
    /// Creates the statement of one text, of several, or of none.
    pub(crate) fn of<W: Into<Words>>(all: impl IntoIterator<Item = W>) -> Self {
        Self::Sentences(all.into_iter().map(Into::into).collect())
    }

    /// Returns the statement as a sentence, its words written by `said`; `None` if nothing is said.
    pub(crate) fn sentence(&self, language: Language, said: &dyn Fn(&Words) -> String) -> Option<String> {
        match self {
            Self::Sentences(all) => (!all.is_empty()).then(|| all.iter().map(said).collect::<Vec<_>>().join(" ")),
            Self::Fields(all) => {
                let each = all.iter().enumerate().map(|(place, (name, value, _))| {
                    let name = name.of(language);
                    let name = if place == 0 { capital(name) } else { within_a_sentence(name) };
                    format!("{name}: {}", said(value))
                });
                (!all.is_empty()).then(|| each.collect::<Vec<_>>().join("; "))
            }
        }
    }
}

/// Returns a name or a sentence without its first capital letter; a symbol keeps its letters.
pub(crate) fn within_a_sentence(name: &str) -> String {
    let mut letters = name.chars();
    match (letters.next(), letters.clone().next()) {
        (Some(first), Some(next)) if next.is_lowercase() => first.to_lowercase().chain(letters).collect(),
        _ => name.to_owned(),
    }
}

impl Words {
    /// Returns the words as plain text in one language.
    pub(crate) fn plain(&self, language: Language) -> String {
        self.written(language, &|outcome, words| {
            outcome.map_or_else(|| words.to_owned(), |of| format!("{} {words}", of.mark()))
        })
    }

    /// Returns the words as text in one language; `emphasised` writes those with the mark of an outcome, and strong ones.
    pub(crate) fn written(&self, language: Language, emphasised: &dyn Fn(Option<Outcome>, &str) -> String) -> String {
        let written = |words: &Self| words.written(language, emphasised);
        match self {
            Self::Text(text, values) => {
                let piece = |piece| match piece {
                    Piece::Words(words) => words.to_owned(),
                    Piece::Name(name) => {
                        values.iter().filter(|(key, _)| *key == name).map(|(_, value)| written(value)).collect()
                    }
                };
                pieces(text.of(language)).into_iter().map(piece).collect()
            }
            Self::Number(number) => number.text(language),
            Self::Below(limit) => format!("<\u{a0}{}", limit.text(language)),
            Self::Quantity(number, unit) => match *unit == ARCSEC || *unit == DEGREES {
                true => number.text(language) + unit.of(language),
                false => quantity(&number.text(language), unit.of(language)),
            },
            Self::Symbol(name) | Self::Plain(name) | Self::Code(name) => name.clone(),
            Self::Given(words) => printable(words),
            Self::Date(date) => date_text(language, *date),
            Self::Time(time) => time_text(language, *time),
            Self::Coordinate(degrees, hemispheres) => {
                let (degrees, hemisphere) = degrees.clone().in_hemisphere(*hemispheres);
                format!("{}°\u{a0}{}", degrees.text(language), hemisphere.of(language))
            }
            Self::Told(words) => written(words),
            Self::Either(_, terminal) => written(terminal),
            Self::Marked(outcome, words) => emphasised(Some(*outcome), &written(words)),
            Self::Styled(_, words) | Self::Inline(words) | Self::Whole(words) => written(words),
            Self::Strong(words) => emphasised(None, &written(words)),
            Self::First(words) => written(words),
            Self::OfLibrary(words, _) if language == Language::English => printable(words),
            Self::OfLibrary(_, words) => written(words),
            Self::Padded(words, longest) => {
                format!("{:1$}", written(words), longest[language as usize])
            }
            Self::Count(count) => match language {
                Language::English => grouped(*count, ","),
                Language::Russian => grouped(*count, "\u{a0}"),
            },
            Self::Capital(words) => super::capital(&written(words)),
            Self::Others(_) | Self::OnTelephones(_) | Self::Blank => String::new(),
            Self::All(all) => all.iter().map(written).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wording::plain;

    #[test]
    fn a_probability_has_two_digits_or_a_limit() {
        for (p, due) in [(0.45, "0.45"), (0.0036, "0.0036"), (1.3e-4, "1.3×10⁻⁴"), (1e-7, "< 10⁻⁶")] {
            assert_eq!(plain(&probability(p).plain(Language::English)), due, "{p}");
        }
    }

    #[test]
    fn thousands_are_apart() {
        for (number, words) in [(0, "0"), (999, "999"), (1000, "1,000"), (9998, "9,998"), (1_234_567, "1,234,567")] {
            assert_eq!(Words::Count(number).plain(Language::English), words);
            assert_eq!(plain(&Words::Count(number).plain(Language::Russian)), words.replace(',', " "));
        }
    }
}
