//! Languages of a page, and texts in each of them as elements of the page.

use super::symbols::italic;
use maud::{Markup, html};

pub use crate::wording::Language;
pub(crate) use crate::wording::{Text, capital};

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
    pub(crate) fn sayings(&self, say: impl Fn(Language) -> String) -> Vec<(Language, String)> {
        let mut sayings: Vec<(Language, String)> = Vec::new();
        for language in self.iter() {
            let words = say(language);
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

    /// Returns plain text for places without markup, such as the words of a picture: `north / север`.
    pub(crate) fn plain(&self, text: Text) -> String {
        let sayings = self.sayings(|language| text.words(language));
        sayings.into_iter().map(|(_, words)| words).collect::<Vec<_>>().join(" / ")
    }

    /// Writes the text within a line, one language after the other.
    pub(crate) fn inline(&self, text: Text) -> Markup {
        self.inline_with(|language| text.words(language))
    }

    /// Writes words as `inline` does; `say` makes them for each language.
    pub(crate) fn inline_with(&self, say: impl Fn(Language) -> String) -> Markup {
        self.spans(say, [" / ", ""], None)
    }

    /// Writes a unit within a line, the second language in brackets: a solidus would be part of the unit.
    pub(crate) fn in_brackets(&self, unit: Text) -> Markup {
        self.spans(|language| unit.words(language), [" (", ")"], None)
    }

    /// Writes the name of a row or column, or a heading: the second language smaller, below the first.
    pub(crate) fn label(&self, text: Text) -> Markup {
        self.label_with(|language| text.words(language))
    }

    /// Writes a name as `label` does; `say` makes it for each language.
    pub(crate) fn label_with(&self, say: impl Fn(Language) -> String) -> Markup {
        self.spans(say, [" ", ""], Some("second"))
    }

    /// Writes the wordings within a line, the languages after the first between these strings and in this class.
    fn spans(&self, say: impl Fn(Language) -> String, [before, after]: [&str; 2], class: Option<&str>) -> Markup {
        let sayings = self.sayings(say);
        if let [(_, words)] = sayings.as_slice() {
            return italic(words);
        }
        html! {
            @for (index, (language, words)) in sayings.iter().enumerate() {
                @let other = index > 0;
                @if other { (before) }
                span class=[class.filter(|_| other)] lang=[self.marked(*language)] { (italic(words)) }
                @if other { (after) }
            }
        }
    }

    /// Writes a paragraph in each language, side by side if there is room.
    pub(crate) fn paragraph(&self, text: Text) -> Markup {
        self.paragraph_with(|language| italic(&text.words(language)))
    }

    /// Writes a paragraph as `paragraph` does; `say` makes it for each language.
    pub(crate) fn paragraph_with(&self, say: impl Fn(Language) -> Markup) -> Markup {
        html! {
            @if self.single() {
                p { (say(self.first)) }
            } @else {
                div.beside { @for language in self.iter() { p lang=(language.tag()) { (say(language)) } } }
            }
        }
    }

    /// Writes a paragraph in each language, one below the other; `say` makes it for each language.
    pub(crate) fn lines_with(&self, say: impl Fn(Language) -> Markup) -> Markup {
        html! {
            @for (index, language) in self.iter().enumerate() {
                p lang=(language.tag()) class=[(index > 0).then_some("second")] { (say(language)) }
            }
        }
    }

    /// Returns the language tag of a part, or `None` if it is the language of the page.
    fn marked(&self, language: Language) -> Option<&'static str> {
        (language != self.first).then(|| language.tag())
    }
}
