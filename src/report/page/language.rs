//! Languages of a page.

pub use crate::wording::Language;

use crate::wording::{Text, Words};

/// The languages of one page, in order. The first one sets the format of numbers and dates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Languages(Vec<Language>);

impl From<Language> for Languages {
    fn from(language: Language) -> Self {
        Self(vec![language])
    }
}

impl Languages {
    /// Creates the list of `first` and `others`; a repeated language counts once.
    pub fn new(first: Language, others: impl IntoIterator<Item = Language>) -> Self {
        let Self(mut languages) = first.into();
        for other in others {
            if !languages.contains(&other) {
                languages.push(other);
            }
        }
        Self(languages)
    }

    /// Returns the first language: the language of the page and of its numbers.
    pub(crate) fn first(&self) -> Language {
        self.0[0]
    }

    /// Returns all languages in their order.
    pub fn iter(&self) -> impl Iterator<Item = Language> {
        self.0.iter().copied()
    }

    /// Returns `true` if the page has only one language.
    pub fn single(&self) -> bool {
        self.0.len() == 1
    }

    /// Returns the distinct wordings, each with the first language that uses it. So a unit that is written alike in two
    /// languages appears once.
    pub(crate) fn sayings(&self, words: &Words) -> Vec<(Language, String)> {
        let mut sayings: Vec<(Language, String)> = Vec::new();
        for language in self.iter() {
            let words = words.plain(language);
            if sayings.iter().all(|(_, said)| *said != words) {
                sayings.push((language, words));
            }
        }
        sayings
    }

    /// Returns words for screen readers, in the first language only.
    pub(crate) fn spoken(&self, text: Text) -> &'static str {
        text.of(self.first())
    }

    /// Returns plain text for places without markup, such as the margins of a sheet: `north / север`.
    pub(crate) fn plain(&self, words: &Words) -> String {
        match words {
            Words::First(words) => words.plain(self.first()),
            words => self.sayings(words).into_iter().map(|(_, words)| words).collect::<Vec<_>>().join(" / "),
        }
    }
}
