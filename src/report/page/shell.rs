//! Common parts of every page: the enclosing document, the style, the running heads in print, contents, sections, annex.

use super::language::Languages;
use crate::report::doc::{Block, Words, say};
use crate::report::picture;
use crate::text::printable;
use crate::wording::Text;
use crate::wording::texts::{calibration, words as texts};
use base64ct::{Base64, Encoding};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use std::borrow::Cow;
use std::collections::HashSet;
use std::fmt::Write;
use std::sync::LazyLock;

/// Style of the page and of its pictures, without what only its reader needs.
static STYLE: LazyLock<String> = LazyLock::new(|| compact(include_str!("style.css")) + &compact(picture::STYLE));

/// Anchor, heading and content of a section.
pub(crate) type Section = (&'static str, Text, Vec<Block>);

/// A page before it has a language.
pub(crate) struct Page<'a> {
    /// Words in the margins of every printed sheet: the document at the upper left, a warning at the upper right, and the
    /// file that the sheets belong to at the lower left. The page number is at the lower right.
    pub margins: [Words; 3],
    /// Name of the document in a list of open pages, after its kind.
    pub name: Words,
    /// Kind of the document, its subject, and what more is said about that.
    pub title: (Text, Words, Words),
    /// What stands above the list of contents.
    pub head: Vec<Block>,
    /// What stands below it, where both are a section with this heading for screen readers.
    pub front: Option<(Text, Vec<Block>)>,
    pub sections: Vec<Section>,
    pub signatures: Vec<Block>,
    pub annex: Annex<'a>,
}

/// The file that a page has verbatim, and to save.
pub(crate) struct Annex<'a> {
    pub heading: Text,
    pub note: Words,
    /// What saves it, the name of the copy, its media type, and the language tag of its text.
    pub save: Text,
    pub name: &'a str,
    pub media: &'static str,
    pub tag: &'static str,
    pub bytes: Cow<'a, [u8]>,
    pub end: Words,
    /// `true` to print it; otherwise paper has its end alone.
    pub is_printed: bool,
}

impl Page<'_> {
    /// Returns the page as one self-contained HTML document.
    pub(crate) fn html(&self, languages: &Languages) -> String {
        let (kind, heading, about) = &self.title;
        let title = format!("{}: {}", languages.plain(&(*kind).into()), self.name.plain(languages.first()));
        let contents = self.contents(languages);
        let head = html! { (languages.blocks(&self.head)) (contents) };
        let body = html! {
            header.title {
                p.kind { (languages.name(&(*kind).into())) }
                h1 { (languages.name(heading)) }
                p.subject { (languages.name(about)) }
            }
            main {
                @match &self.front {
                    None => (head),
                    Some((heading, blocks)) => section id="verification" aria-labelledby="verification-heading" {
                        h2.unseen id="verification-heading" { (languages.name(&(*heading).into())) }
                        (head)
                        (languages.blocks(blocks))
                    }
                }
                @for (number, (id, heading, blocks)) in (1..).zip(&self.sections) {
                    (languages.section(Some(number), id, *heading, &languages.blocks(blocks)))
                }
                @if !self.signatures.is_empty() {
                    (languages.section(None, "signatures", calibration::SIGNATURES, &languages.blocks(&self.signatures)))
                }
                (self.annex.written(languages))
            }
        };
        document(languages, &title, self.margins.each_ref().map(|words| languages.plain(words)), &body)
    }

    /// Writes what only a screen needs: links to the sections and to the annex, and the file to save.
    fn contents(&self, languages: &Languages) -> Markup {
        let Annex { heading, save, name, media, bytes, .. } = &self.annex;
        let numbered = (1..).zip(&self.sections).map(|(number, (id, heading, _))| (Some(number), *id, *heading));
        let headings = numbered.chain([(None, "annex", *heading)]);
        let address = format!("data:{media};base64,{}", Base64::encode_string(bytes));
        html! {
            nav.screen aria-label=(languages.spoken(texts::CONTENTS)) {
                ol { @for (number, id, heading) in headings {
                    li { (number_of(number)) a href={ "#" (id) } { (languages.cell(&heading.into())) } }
                } }
                a.button href=(address) download=(name) { (languages.cell(&(*save).into())) }
            }
        }
    }
}

impl Annex<'_> {
    /// Writes the note, the file verbatim, and the words at its end; the style sheet numbers its lines, and marks where a line
    /// goes on.
    fn written(&self, languages: &Languages) -> Markup {
        // Bytes of a line that a telephone shows whole: it never goes on.
        const LONGEST: usize = 40;
        // One word alone, such as a line of a signature, is broken anywhere.
        let class = |line: &str| match (line.len() > LONGEST, line.trim().contains(' ')) {
            (true, true) => Some("c"),
            (true, false) => Some("c w"),
            (false, _) => None,
        };
        let end = languages.name(&self.end);
        let text = String::from_utf8_lossy(&self.bytes).replace("\r\n", "\n");
        let body = html! {
            (languages.blocks(&[say([self.note.clone()])]))
            div.file {
                pre lang=(self.tag) translate="no" tabindex="0" aria-labelledby="annex-heading" {
                    @for line in text.split_inclusive('\n') {
                        span class=[class(line)] { span { (line) } }
                    }
                }
                p.end { (end) }
            }
        };
        let annex = languages.section(None, "annex", self.heading, &body);
        html! { @if self.is_printed { (annex) } @else { p.end { (end) } div.save { (annex) } } }
    }
}

impl Languages {
    fn section(&self, number: Option<usize>, id: &str, heading: Text, body: &Markup) -> Markup {
        let heading_id = format!("{id}-heading");
        html! {
            section id=(id) aria-labelledby=(heading_id) {
                h2 id=(heading_id) { (number_of(number)) (self.name(&heading.into())) }
                (body)
            }
        }
    }
}

/// Words in the first language of a page only.
pub(crate) fn first(words: Words) -> Words {
    Words::First(Box::new(words))
}

/// Writes the number of a section, if it has one.
fn number_of(number: Option<usize>) -> Markup {
    html! { @if let Some(number) = number { span.number { (number) } " " } }
}

/// Returns a whole page as one HTML file, without scripts and without external resources.
pub(crate) fn document(languages: &Languages, title: &str, margins: [String; 3], body: &Markup) -> String {
    // This policy makes the browser load nothing, so markup injected through a text has no effect.
    let policy = "default-src 'none'; style-src 'unsafe-inline'; img-src data:";
    let page = html! {
        (DOCTYPE)
        html lang=(languages.first().tag()) {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(policy);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta name="generator" content=(concat!("dtg-passport ", env!("CARGO_PKG_VERSION")));
                title { (title) }
                style { (PreEscaped(used(&STYLE, &body.0))) (PreEscaped(css_of_margins(&margins))) }
            }
            body { (body) }
        }
    };
    // Empty elements make a page with pictures shorter by a fiftieth.
    let shapes = ["></polygon>", "></line>", "></path>", "></rect>", "></ellipse>", "></circle>", "></use>"];
    let page = shapes.into_iter().fold(page.into_string(), |page, ends| page.replace(ends, "/>"));
    printable::page(&page) + "\n"
}

/// Returns the style of the margins with these words: upper left, upper right, lower left.
fn css_of_margins(margins: &[String; 3]) -> String {
    let [left, right, below] = margins.each_ref().map(|words| quoted(words));
    // Without a warning the name has the whole width; a long one then takes one line.
    let [left_percent, right_percent] = if margins[1].is_empty() { [97, 3] } else { [45, 55] };
    format!(
        "@page {{ @top-left {{ content: {left}; width: {left_percent}%; }} \
         @top-right {{ content: {right}; width: {right_percent}%; }} \
         @bottom-left {{ content: {below}; }} }}\n"
    )
}

/// Returns a style sheet without its comments, indents, and spaces at the ends of declarations.
fn compact(css: &str) -> String {
    let without = |part: &str| part.split_once("*/").map_or(part, |(_, rest)| rest).to_owned();
    let css: String = css.split("/*").map(without).collect();
    let css: Vec<&str> = css.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    let shorter = [(" { ", "{"), (" {", "{"), ("; }", "}"), (" }", "}"), ("; ", ";"), (": ", ":")];
    shorter.into_iter().fold(css.join("\n") + "\n", |css, (long, short)| css.replace(long, short))
}

/// Returns a style sheet without the rules for classes and ids that nothing on the page has.
fn used(style: &str, body: &str) -> String {
    let of = |key: &'static str| body.split(key).skip(1).filter_map(|rest| rest.split_once('"'));
    let names: HashSet<&str> = of(" class=\"").chain(of(" id=\"")).flat_map(|(names, _)| names.split(' ')).collect();
    let is_letter = |c: char| c.is_ascii_alphanumeric() || c == '-';
    // What stands before any function or state of a selector.
    let matches = |selector: &str| {
        let simple = selector.split(['(', ':']).next().unwrap_or_default();
        simple
            .split(['.', '#'])
            .skip(1)
            .all(|name| names.contains(name.split(|c| !is_letter(c)).next().unwrap_or(name)))
    };
    let mut goes_on = false;
    let is_used = |line: &&str| {
        let (begins, ends) = (!std::mem::replace(&mut goes_on, line.ends_with(',')), line.ends_with('}'));
        let Some((selectors, _)) =
            line.split_once('{').filter(|(selectors, _)| begins && ends && !selectors.starts_with('@'))
        else {
            return true;
        };
        let mut depth = 0;
        let between = |c| {
            depth += i32::from(c == '(') - i32::from(c == ')');
            c == ',' && depth == 0
        };
        selectors.split(between).any(matches)
    };
    style.lines().filter(is_used).collect::<Vec<_>>().join("\n") + "\n"
}

/// Returns a CSS string. Characters that could end it, or the style element, are written as escapes (CSS Syntax,
/// 4.3.7).
fn quoted(text: &str) -> String {
    let mut quoted = "\"".to_owned();
    for c in text.chars() {
        if c.is_control() || "\"\\<>&".contains(c) {
            let _ = write!(quoted, "\\{:x} ", u32::from(c));
        } else {
            quoted.push(c);
        }
    }
    quoted + "\""
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_style_sheet_loses_only_what_nothing_shows() {
        let css = "/* Why. */\na b { c: d e; f: \"g\" h; }\n\n@media x {\n  /* And why. */\n  i,\n  j { k: l }\n}\n";
        assert_eq!(compact(css), "a b{c:d e;f:\"g\" h}\n@media x{\ni,\nj{k:l}\n}\n");
    }

    #[test]
    fn a_style_sheet_has_the_rules_that_a_page_uses() {
        let css = "p{a:b}\n.x,.y:is(.z, u){c:d}\n#w .x{e:f}\n.x:has(.q){g:h}\n.q,\n.x{i:j}\n.q:not(.x, .y){k:l}\n";
        let expected = "p{a:b}\n.x,.y:is(.z, u){c:d}\n.x:has(.q){g:h}\n.q,\n.x{i:j}\n";
        assert_eq!(used(css, "<p class=\"r x\" id=\"v\">.q</p>"), expected);
    }

    #[test]
    fn nothing_ends_a_string_of_css() {
        assert_eq!(quoted("SPS-2/0017"), "\"SPS-2/0017\"");
        assert_eq!(quoted("\"</style>\\\n"), "\"\\22 \\3c /style\\3e \\5c \\a \"");
    }
}
