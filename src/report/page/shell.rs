//! Common parts of every page: the enclosing document, the style, the running heads in print.

use super::language::Languages;
use crate::report::picture;
use crate::text::printable;
use maud::{DOCTYPE, Markup, PreEscaped, html};
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
                style { (PreEscaped(STYLE.as_str())) (PreEscaped(margins.css())) }
            }
            body { (body) }
        }
    };
    printable::page(&short_shapes(page.into_string())) + "\n"
}

/// Returns a page with the shapes of its pictures as empty elements, which makes it shorter by a fiftieth.
fn short_shapes(page: String) -> String {
    let shapes = ["></polygon>", "></line>", "></path>", "></rect>", "></ellipse>", "></circle>"];
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
    let shorter = [(" { ", "{"), (" {", "{"), ("; }", "}"), (" }", "}"), ("; ", ";")];
    shorter.into_iter().fold(css.join("\n") + "\n", |css, (long, short)| css.replace(long, short))
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
        assert_eq!(compact(css), "a b{c: d e;f: \"g\" h}\n@media x{\ni,\nj{k: l}\n}\n");
    }

    #[test]
    fn nothing_ends_a_string_of_css() {
        assert_eq!(quoted("SPS-2/0017"), "\"SPS-2/0017\"");
        assert_eq!(quoted("\"</style>\\\n"), "\"\\22 \\3c /style\\3e \\5c \\a \"");
    }
}
