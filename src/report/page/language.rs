//! The languages of a page, and a text in each of them.

use maud::{Markup, html};

/// A language that pages are written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Language {
    /// English, with decimal points.
    English,
    /// Russian, with decimal commas.
    Russian,
}

impl Language {
    /// Every one.
    pub const ALL: [Self; 2] = [Self::English, Self::Russian];

    /// Its tag in HTML and on the command line (BCP 47).
    pub fn tag(self) -> &'static str {
        match self {
            Self::English => "en",
            Self::Russian => "ru",
        }
    }
}

/// A text in every language: another language is another field, which the compiler then asks of every text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Text {
    /// English.
    pub en: &'static str,
    /// Russian.
    pub ru: &'static str,
}

impl Text {
    /// What it says in `language`.
    pub(crate) fn of(&self, language: Language) -> &'static str {
        match language {
            Language::English => self.en,
            Language::Russian => self.ru,
        }
    }

    /// The same with every `{name}` replaced by its value.
    pub(crate) fn filled(&self, language: Language, values: &[(&str, &str)]) -> String {
        let piece = |piece| match piece {
            Piece::Words(words) => words,
            Piece::Name(name) => values.iter().find(|(key, _)| *key == name).map_or("", |(_, value)| value),
        };
        pieces(self.of(language)).into_iter().map(piece).collect()
    }

    /// The same with values that are elements of the page.
    pub(crate) fn marked_up(&self, language: Language, values: &[(&str, Markup)]) -> Markup {
        let value = |name: &str| values.iter().find(|(key, _)| *key == name).map(|(_, value)| value);
        html! {
            @for piece in pieces(self.of(language)) {
                @match piece {
                    Piece::Words(words) => (words),
                    Piece::Name(name) => @if let Some(value) = value(name) { (value) },
                }
            }
        }
    }
}

/// A part of a text.
enum Piece<'a> {
    Words(&'a str),
    /// The name of a value that stands here.
    Name(&'a str),
}

/// The parts of a text. A value that holds braces is never read as a name: it is put in afterwards.
fn pieces(mut rest: &str) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    while let Some((before, after)) = rest.split_once('{') {
        let (name, after) = after.split_once('}').unwrap_or((after, ""));
        pieces.extend([Piece::Words(before), Piece::Name(name)]);
        rest = after;
    }
    pieces.push(Piece::Words(rest));
    pieces
}

/// A table of texts: a constant for each, and all of them by name for whoever checks them.
macro_rules! texts {
    ($($name:ident { en: $en:literal, ru: $ru:literal })*) => {
        $(
            #[doc = $en]
            pub(crate) const $name: $crate::report::page::language::Text =
                $crate::report::page::language::Text { en: $en, ru: $ru };
        )*
        /// Every text of this table by its name.
        #[cfg(test)]
        pub(crate) const ALL: &[(&str, $crate::report::page::language::Text)] = &[$((stringify!($name), $name)),*];
    };
}
pub(crate) use texts;

/// The languages of one page: one, or several side by side. The first one writes numbers and dates.
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
    /// `first`, and the `others` beside it; a language named twice counts once.
    pub fn new(first: Language, others: impl IntoIterator<Item = Language>) -> Self {
        let mut languages = Self::from(first);
        for other in others {
            if other != first && !languages.others.contains(&other) {
                languages.others.push(other);
            }
        }
        languages
    }

    /// The one that the page is in, and that writes its numbers.
    pub fn first(&self) -> Language {
        self.first
    }

    /// All of them in their order.
    pub fn iter(&self) -> impl Iterator<Item = Language> {
        std::iter::once(self.first).chain(self.others.iter().copied())
    }

    /// Whether there is one alone.
    pub fn single(&self) -> bool {
        self.others.is_empty()
    }

    /// The different sayings, each with the first language that says so: a unit that both write alike stands once.
    fn sayings(&self, say: impl Fn(Language) -> String) -> Vec<(Language, String)> {
        let mut sayings: Vec<(Language, String)> = Vec::new();
        for language in self.iter() {
            let words = say(language);
            if sayings.iter().all(|(_, said)| *said != words) {
                sayings.push((language, words));
            }
        }
        sayings
    }

    /// Words that are heard and not seen: one voice, one language.
    pub(crate) fn spoken(&self, text: Text) -> &'static str {
        text.of(self.first)
    }

    /// Plain text for places that hold no markup, such as the words of a picture: `north / север`.
    pub(crate) fn plain(&self, text: Text) -> String {
        self.plain_with(|language| text.of(language).to_owned())
    }

    /// The same of words that are made.
    pub(crate) fn plain_with(&self, say: impl Fn(Language) -> String) -> String {
        let words: Vec<String> = self.sayings(say).into_iter().map(|(_, words)| words).collect();
        words.join(" / ")
    }

    /// Within a line: one beside the other.
    pub(crate) fn inline(&self, text: Text) -> Markup {
        self.inline_with(|language| text.of(language).to_owned())
    }

    /// The same of words that are made.
    pub(crate) fn inline_with(&self, say: impl Fn(Language) -> String) -> Markup {
        let sayings = self.sayings(say);
        html! {
            @for (index, (language, words)) in sayings.iter().enumerate() {
                @if index > 0 { " / " }
                span lang=[self.marked(*language)] { (words) }
            }
        }
    }

    /// A name of a row, a column or a heading: the second language smaller, beneath the first.
    pub(crate) fn label(&self, text: Text) -> Markup {
        self.label_with(|language| text.of(language).to_owned())
    }

    /// The same of words that are made.
    pub(crate) fn label_with(&self, say: impl Fn(Language) -> String) -> Markup {
        let sayings = self.sayings(say);
        html! {
            @for (index, (language, words)) in sayings.iter().enumerate() {
                @if index > 0 { " " }
                span class=[(index > 0).then_some("second")] lang=[self.marked(*language)] { (words) }
            }
        }
    }

    /// A paragraph in each language, side by side where there is room.
    pub(crate) fn paragraph(&self, text: Text) -> Markup {
        self.paragraph_with(|language| html! { (text.of(language)) })
    }

    /// The same of words that are made.
    pub(crate) fn paragraph_with(&self, say: impl Fn(Language) -> Markup) -> Markup {
        html! {
            @if self.single() {
                p { (say(self.first)) }
            } @else {
                div.beside { @for language in self.iter() { p lang=(language.tag()) { (say(language)) } } }
            }
        }
    }

    /// The language to mark a part with: none where the page has but one.
    fn marked(&self, language: Language) -> Option<&'static str> {
        (!self.single()).then(|| language.tag())
    }
}
