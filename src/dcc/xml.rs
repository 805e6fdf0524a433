//! XML elements, and the text of a document of them. Names are literals of this program; every text is escaped.

use crate::report::{Language, Languages};
use crate::text::number::decimal;
use crate::wording::Words;
use std::fmt::Write;

/// An XML element: attributes, then either text or further elements, in the order in which they were added.
#[derive(Debug, Clone)]
pub(super) struct Element {
    name: &'static str,
    attributes: Vec<(&'static str, String)>,
    text: String,
    elements: Vec<Element>,
    /// Words that become one element for each language of the document; then there are no text and no other elements.
    words: Option<Words>,
}

impl Element {
    pub(super) fn new(name: &'static str) -> Self {
        Self { name, attributes: Vec::new(), text: String::new(), elements: Vec::new(), words: None }
    }

    /// Creates an element that contains text. Spaces at its ends are removed, because the schema does not allow them.
    pub(super) fn text(name: &'static str, text: impl std::fmt::Display) -> Self {
        Self { text: text.to_string().trim().to_owned(), ..Self::new(name) }
    }

    /// Creates an element with words in every language of the document.
    pub(super) fn said(name: &'static str, words: Words) -> Self {
        Self { words: Some(words), ..Self::new(name) }
    }

    /// Creates an element that begins with its name in every language of the document.
    pub(super) fn named(element: &'static str, name: impl Into<Words>) -> Self {
        Self::new(element).and(Self::said("dcc:name", name.into()))
    }

    /// Creates an element that contains a number, which reads back as the same binary64.
    pub(super) fn number(name: &'static str, value: f64) -> Self {
        Self::text(name, number(value))
    }

    /// Creates an element that contains a list of numbers, each as in [`Element::number`].
    pub(super) fn numbers(name: &'static str, values: impl IntoIterator<Item = f64>) -> Self {
        Self::text(name, values.into_iter().map(number).collect::<Vec<_>>().join(" "))
    }

    pub(super) fn with(mut self, name: &'static str, value: impl Into<String>) -> Self {
        self.attributes.push((name, value.into()));
        self
    }

    /// Adds elements after those already added: one, none ([`Option`]) or several.
    pub(super) fn and(mut self, elements: impl IntoIterator<Item = Element>) -> Self {
        self.elements.extend(elements);
        self
    }

    /// Returns the whole document with this element as its root, in UTF-8.
    pub(super) fn document(&self, languages: &Languages) -> String {
        let mut out = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
        self.write(0, languages, &mut out);
        out
    }

    fn write(&self, depth: usize, languages: &Languages, out: &mut String) {
        let (indent, name) = ("  ".repeat(depth), self.name);
        // Writing into a string cannot fail.
        let _ = write!(out, "{indent}<{name}");
        for (name, value) in &self.attributes {
            let _ = write!(out, " {name}=\"{}\"", escaped(value));
        }
        let content = |language: Language| {
            let text = self.words.as_ref().map(|words| words.plain(language));
            text.map(|text| Self::text("dcc:content", text).with("lang", language.tag()))
        };
        let said: Vec<Self> = languages.iter().filter_map(content).collect();
        if self.elements.is_empty() && said.is_empty() {
            let _ = writeln!(out, ">{}</{name}>", escaped(&self.text));
            return;
        }
        out.push_str(">\n");
        self.elements.iter().chain(&said).for_each(|element| element.write(depth + 1, languages, out));
        let _ = writeln!(out, "{indent}</{name}>");
    }
}

/// Yields the element itself, so that [`Element::and`] accepts a single element.
impl IntoIterator for Element {
    type Item = Self;
    type IntoIter = std::iter::Once<Self>;

    fn into_iter(self) -> Self::IntoIter {
        std::iter::once(self)
    }
}

/// Returns a number in the notation of `xs:double`; NaN stands for a value that is not stated.
fn number(value: f64) -> String {
    if value.is_finite() { decimal(value) } else { "NaN".to_owned() }
}

/// Returns a text with the characters escaped that have a meaning in XML. Control characters and others that XML 1.0
/// does not contain (section 2.2) become U+FFFD.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            // `]]>` may not be in text.
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') => out.push('\u{FFFD}'),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: what an independent reader of XML finds.
    #[test]
    fn every_text_reads_back() {
        let hostile = ["<!--", "]]>", "&lt;&#0;", "\"'", "\u{1F600}", "\u{202E}abc", "a\u{301}", "x]]>\u{FFFD}"];
        for text in hostile {
            let root =
                Element::new("a").with("b", text).and(Element::text("c", text)).and(None).and([Element::new("d")]);
            let document = root.document(&Language::English.into());
            let read = roxmltree::Document::parse(&document).unwrap();
            let c = read.root_element().first_element_child().unwrap();
            assert_eq!((c.text(), read.root_element().attribute("b")), (Some(text), Some(text)), "{document}");
        }
        let controls = Element::text("a", "x\0\u{1B}\u{85}\u{FFFE}y").document(&Language::English.into());
        let read = roxmltree::Document::parse(&controls).unwrap();
        assert_eq!(read.root_element().text(), Some("x\u{FFFD}\u{FFFD}\u{FFFD}\u{FFFD}y"));
    }
}
