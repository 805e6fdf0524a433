//! Languages of a page.

pub use crate::wording::Language;
pub(crate) use crate::wording::Text;

use crate::wording::Words;

/// The languages of one page, in order. The first one sets the format of numbers and dates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Languages {
    first: Language,
    others: Vec<Language>,
}

impl From<Language> for Languages {
    fn from(language: Language) -> Self {
        Self { first: language, others: Vec::new() }
    }
}

impl Languages {
    /// Creates the list of `first` and `others`; a repeated language counts once.
    pub fn new(first: Language, others: impl IntoIterator<Item = Language>) -> Self {
        let mut languages = Self::from(first);
        for other in others {
            if other != first && !languages.others.contains(&other) {
                languages.others.push(other);
            }
        }
        languages
    }

    /// Returns the first language: the language of the page and of its numbers.
    pub(crate) fn first(&self) -> Language {
        self.first
    }

    /// Returns all languages in their order.
    pub fn iter(&self) -> impl Iterator<Item = Language> {
        std::iter::once(self.first).chain(self.others.iter().copied())
    }

    /// Returns `true` if the page has only one language.
    pub fn single(&self) -> bool {
        self.others.is_empty()
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
        text.of(self.first)
    }

    /// Returns plain text for places without markup, such as the margins of a sheet: `north / север`.
    pub(crate) fn plain(&self, words: &Words) -> String {
        match words {
            Words::First(words) => words.plain(self.first),
            words => self.sayings(words).into_iter().map(|(_, words)| words).collect::<Vec<_>>().join(" / "),
        }
    }
}
