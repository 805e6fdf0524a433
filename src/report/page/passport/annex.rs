//! Annex: the signed file verbatim, to read, to copy and to save.

use super::{PassportPage, checks};
use crate::report::page::language::Languages;
use crate::report::page::parts::{section as part, verbatim};
use crate::report::page::texts::passport as texts;
use maud::{Markup, html};

pub(super) fn section(page: &PassportPage, languages: &Languages) -> Markup {
    let name = page.file_name();
    let end = languages.label_with(|language| texts::END.filled(language, &[("id", &page.content.passport.id)]));
    let body = html! {
        (checks::table(page, languages))
        (languages.paragraph_with(|language| html! { (texts::ANNEX_NOTE.filled(language, &[("name", &name)])) }))
        (verbatim("en", page.text, &end))
    };
    part(languages, "annex", "", texts::ANNEX, &body)
}
