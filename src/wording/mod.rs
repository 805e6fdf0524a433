//! Words for people in each language: texts with values, numbers, non-breaking spaces.
//!
//! * `number`: numbers formatted for people.
//! * `texts`: the texts.
//! * `words`: texts with values, in every language at once.

pub(crate) mod number;
pub(crate) mod texts;
pub(crate) mod words;

pub(crate) use number::Number;
pub(crate) use words::{Outcome, Words};

use jiff::tz::TimeZone;
use jiff::{Timestamp, civil::Date};

crate::text::words! {
    /// A language of the pages and of a DCC; its word is its code in ISO 639-1.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
    #[cfg_attr(feature = "generate", derive(schemars::JsonSchema))]
    #[non_exhaustive]
    pub enum Language: pub tag {
        /// English.
        #[cfg_attr(feature = "cli", value(name = "en"))]
        #[cfg_attr(feature = "generate", schemars(rename = "en"))]
        English = "en",
        /// Russian.
        #[cfg_attr(feature = "cli", value(name = "ru"))]
        #[cfg_attr(feature = "generate", schemars(rename = "ru"))]
        Russian = "ru",
    }
}

/// Non-breaking space.
pub(crate) const BLANK: char = '\u{00A0}';

/// A text in every language. A new language is a new field, so the compiler reports every text that lacks it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Text {
    /// English.
    pub en: &'static str,
    /// Russian.
    pub ru: &'static str,
}

impl Text {
    /// Returns the text in `language`.
    pub(crate) fn of(&self, language: Language) -> &'static str {
        match language {
            Language::English => self.en,
            Language::Russian => self.ru,
        }
    }
}

/// Returns words with a capital first letter, as at the beginning of a row or a sentence.
pub(crate) fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect()
}

/// Returns words of a page with the spaces, the minus and the apostrophe of terminals and of signed files.
pub(crate) fn plain(words: &str) -> String {
    words.replace(BLANK, " ").replace(number::THIN_BLANK, "").replace('\u{2212}', "-").replace('’', "'")
}

/// A part of a text.
pub(crate) enum Piece<'a> {
    Words(&'a str),
    /// The name of a value to insert.
    Name(&'a str),
}

/// Splits a text into words and names. Values are inserted afterwards, so braces in a value are never read as a name.
pub(crate) fn pieces(mut rest: &str) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    while let Some((before, after)) = rest.split_once('{') {
        let (name, after) = after.split_once('}').unwrap_or((after, ""));
        pieces.extend([Piece::Words(before), Piece::Name(name)]);
        rest = after;
    }
    pieces.push(Piece::Words(rest));
    pieces
}

/// Returns a date in the format of `language`.
pub(crate) fn date_text(language: Language, date: Date) -> String {
    match language {
        Language::English => date.to_string(),
        Language::Russian => date.strftime("%d.%m.%Y").to_string(),
    }
}

/// Returns a time in UTC in the format of `language`.
pub(crate) fn time_text(language: Language, time: Timestamp) -> String {
    let at = time.to_zoned(TimeZone::UTC);
    format!("{} {}{}UTC", date_text(language, at.date()), at.strftime("%H:%M:%S"), BLANK)
}
