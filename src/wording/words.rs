//! What is said, in every language at once, before it has a medium.

use super::number::{LEAST_PROBABILITY, Number, Probability};
use super::texts::units::{ARCSEC, DEGREES};
use super::{Language, Piece, Text, date_text, pieces, time_text};
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
    /// Words for screen readers only.
    Unseen(Box<Words>),
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

impl Words {
    /// Returns the words as plain text in one language.
    pub(crate) fn plain(&self, language: Language) -> String {
        self.written(language, &|outcome, words| format!("{} {words}", outcome.mark()))
    }

    /// Returns the words as text in one language; `marked` writes those with the mark of an outcome.
    pub(crate) fn written(&self, language: Language, marked: &dyn Fn(Outcome, &str) -> String) -> String {
        let written = |words: &Self| words.written(language, marked);
        match self {
            Self::Text(text, values) => {
                let piece = |piece| match piece {
                    Piece::Words(words) => words.to_owned(),
                    Piece::Name(name) => {
                        values.iter().filter(|(key, _)| *key == name).map(|(_, value)| written(value)).collect()
                    }
                };
                pieces(&text.words(language)).into_iter().map(piece).collect()
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
            Self::Marked(outcome, words) => marked(*outcome, &written(words)),
            Self::Strong(words) | Self::First(words) => written(words),
            Self::Capital(words) => super::capital(&written(words)),
            Self::Others(_) | Self::OnTelephones(_) | Self::Unseen(_) | Self::Blank => String::new(),
            Self::All(all) => all.iter().map(written).collect(),
        }
    }
}
