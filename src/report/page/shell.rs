//! Common parts of every page: the enclosing document, the style, the running heads in print.

use super::language::Languages;
use crate::report::picture;
use crate::text::printable;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use std::collections::HashSet;
use std::fmt::Write;
use std::sync::LazyLock;

/// Style of the page and of its pictures, without what only its reader needs.
static STYLE: LazyLock<String> = LazyLock::new(|| compact(include_str!("style.css")) + &compact(picture::STYLE));

/// Words in the margins of every printed sheet. The page number is at the lower right.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Margins {
    /// Upper left: name of the document.
    pub top_left: String,
    /// Upper right: a warning for every sheet.
    pub top_right: String,
    /// Lower left: the file that the sheets belong to.
    pub bottom_left: String,
}

/// Returns a whole page as one HTML file, without scripts and without external resources.
pub(crate) fn document(languages: &Languages, title: &str, margins: &Margins, body: &Markup) -> String {
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
                style { (PreEscaped(used(&STYLE, &body.0))) (PreEscaped(margins.css())) }
            }
            body { (body) }
        }
    };
    printable::page(&short_shapes(page.into_string())) + "\n"
}

/// Returns a page with the shapes of its pictures as empty elements, which makes it shorter by a fiftieth.
fn short_shapes(page: String) -> String {
    let shapes = ["></polygon>", "></line>", "></path>", "></rect>", "></ellipse>", "></circle>", "></use>"];
    shapes.into_iter().fold(page, |page, ends| page.replace(ends, "/>"))
}

impl Margins {
    fn css(&self) -> String {
        let (left, right, below) = (quoted(&self.top_left), quoted(&self.top_right), quoted(&self.bottom_left));
        // Without a warning the name has the whole width; a long one then takes one line.
        let [left_percent, right_percent] = if self.top_right.is_empty() { [97, 3] } else { [45, 55] };
        format!(
            "@page {{ @top-left {{ content: {left}; width: {left_percent}%; }} \
             @top-right {{ content: {right}; width: {right_percent}%; }} \
             @bottom-left {{ content: {below}; }} }}\n"
        )
    }
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
