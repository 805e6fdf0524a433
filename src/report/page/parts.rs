//! The parts that pages are put together from: tables, fields, figures, forms to fill in with a pen.

use super::language::{Languages, Text};
use maud::{Markup, html};

/// A picture with its caption. The picture says for itself what it shows to those who do not see it: an `svg` with
/// `role="img"`, and `aria-label` or `title`.
pub fn figure(languages: &Languages, drawing: &Markup, caption: Text) -> Markup {
    html! {
        figure {
            (drawing)
            figcaption { (languages.paragraph(caption)) }
        }
    }
}

/// A table with its caption, its row of headings, which every sheet repeats, and its rows.
pub fn table(caption: &Markup, headings: &[Markup], rows: &[Markup]) -> Markup {
    html! {
        div.scroll {
            table {
                caption { (caption) }
                thead { tr { @for heading in headings { th scope="col" { (heading) } } } }
                tbody { @for row in rows { (row) } }
            }
        }
    }
}
