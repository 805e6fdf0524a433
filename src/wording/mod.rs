//! Words for people in each language: texts with values, numbers, non-breaking spaces.
//!
//! * `number`: numbers formatted for people.
//! * `spacing`: places of a text where no line ends.

pub(crate) mod number;
pub(crate) mod spacing;

use crate::text::words;
use jiff::civil::Date;
use number::Number;
use spacing::spaced;
use std::fmt::Display;

words! {
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

/// A text in every language. A new language is a new field, so the compiler reports every text that lacks it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Text {
    /// English.
    pub en: &'static str,
    /// Russian.
    pub ru: &'static str,
}

impl Text {
    /// Returns the text in `language` as the table has it.
    pub(crate) fn of(&self, language: Language) -> &'static str {
        match language {
            Language::English => self.en,
            Language::Russian => self.ru,
        }
    }

    /// Returns the text in `language` with its non-breaking spaces.
    pub(crate) fn words(&self, language: Language) -> String {
        spaced(self.of(language))
    }

    /// Returns the text in `language` with every `{name}` replaced by its value.
    pub(crate) fn filled(&self, language: Language, values: Values) -> String {
        let piece = |piece: Piece| match piece {
            Piece::Words(words) => Some(words.to_owned()),
            Piece::Name(name) => values.iter().find(|(key, _)| *key == name).map(|(_, value)| value.said(language)),
        };
        pieces(&self.words(language)).into_iter().filter_map(piece).collect()
    }
}

/// A value in a text.
pub(crate) trait Value {
    /// Returns the value as `language` writes it.
    fn said(&self, language: Language) -> String;
}

/// Names, words from the file and whole numbers are written alike in every language.
impl<T: Display> Value for T {
    fn said(&self, _: Language) -> String {
        self.to_string()
    }
}

impl Value for Text {
    fn said(&self, language: Language) -> String {
        self.words(language)
    }
}

impl Value for Number {
    fn said(&self, language: Language) -> String {
        self.text(language)
    }
}

/// Names of values in a text, and the values.
pub(crate) type Values<'a> = &'a [(&'a str, &'a dyn Value)];

/// Names the values of a text: `values! { run, index: at.index }`.
macro_rules! values {
    (@ $name:ident) => { &$name };
    (@ $name:ident $value:expr) => { &$value };
    ($($name:ident $(: $value:expr)?),*) => {
        &[$((stringify!($name), values!(@ $name $($value)?) as &dyn $crate::wording::Value)),*]
    };
}
pub(crate) use values;

/// Returns words with a capital first letter, as at the beginning of a row or a sentence.
pub(crate) fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect()
}

/// Returns words of a page with the spaces, the minus and the apostrophe of terminals and of signed files.
pub(crate) fn plain(words: &str) -> String {
    words.replace(spacing::BLANK, " ").replace(number::THIN_BLANK, "").replace('\u{2212}', "-").replace('’', "'")
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

/// Defines a table of texts: a constant for each, and a list of all by name for the tests.
macro_rules! texts {
    ($($name:ident { en: $en:literal, ru: $ru:literal })*) => {
        $(
            #[doc = $en]
            pub(crate) const $name: $crate::wording::Text =
                $crate::wording::Text { en: $en, ru: $ru };
        )*
        /// Every text of this table by its name.
        #[cfg(test)]
        pub(crate) const ALL: &[(&str, $crate::wording::Text)] = &[$((stringify!($name), $name)),*];
    };
}
pub(crate) use texts;

/// Directions at a site.
pub(crate) mod compass {
    super::texts! {
        NORTH { en: "north", ru: "север" }
        SOUTH { en: "south", ru: "юг" }
        EAST { en: "east", ru: "восток" }
        WEST { en: "west", ru: "запад" }
        UP { en: "up", ru: "верх" }
    }
}

/// Stated values that are possible, but usually in another unit, such as parts per million instead of percent.
pub(crate) mod implausible {
    super::texts! {
        OF_LABORATORY {
            en: "{key} of the laboratory is {value}, more than {largest}; check the unit, because no decision is possible \
                 with such an uncertainty",
            ru: "Значение {key} лаборатории равно {value}, что больше {largest}; следует проверить единицу: при такой \
                 неопределённости принять решение о соответствии невозможно"
        }
        OF_TYPE {
            en: "{key} of the gyro type is {value} % of the scale factor; check the unit, because no decision is \
                 meaningful with such a tolerance",
            ru: "Значение {key} типа гироскопа равно {value} % масштабного коэффициента; следует проверить единицу: при \
                 таком допуске заключение о соответствии не имеет смысла"
        }
        PERCENT { en: "%", ru: "%" }
        MILLIAMPERES { en: "mA", ru: "мА" }
        ARCSECONDS { en: "″", ru: "″" }
    }
}

/// Findings of a comparison that are warnings, not decisions.
pub(crate) mod comparison {
    super::texts! {
        COMMON_FACTOR {
            en: "All scale factors are the expected ones multiplied by {factor}, and no drift fails. Check the range, the gain \
                 and the unit of the meter.",
            ru: "Все масштабные коэффициенты равны ожидаемым, умноженным на {factor}, а дрейфы в допусках. Следует проверить \
                 предел и коэффициент преобразования измерителя и единицу тока."
        }
        NOISE_OF_ONE {
            en: "Only one of the two calibrations includes {names}; in the change it counts for both.",
            ru: "Только одна из двух калибровок учитывает {names}; в изменении это учтено для обеих."
        }
        LEFT_OUT_BEFORE {
            en: "Not included in the uncertainties of the previous calibration: {names}.",
            ru: "В неопределённостях предыдущей калибровки не учтено: {names}."
        }
        UNEXPLAINED {
            en: "Changed since the previous calibration by more than the uncertainties explain: {names}. Whether this is \
                 permissible can be decided only with the gyro type.",
            ru: "Изменение после предыдущей калибровки больше, чем объясняют неопределённости: {names}. Решить, допустимо \
                 ли оно, можно только по типу гироскопа."
        }
    }
}

/// Returns a date in the format of `language`.
pub(crate) fn date_text(language: Language, date: Date) -> String {
    match language {
        Language::English => date.to_string(),
        Language::Russian => date.strftime("%d.%m.%Y").to_string(),
    }
}
