//! Annex: the signed file verbatim, to read, to copy and to save.

use super::PassportPage;
use crate::report::page::language::Languages;
use crate::report::page::parts::section as part;
use crate::report::page::texts::passport as texts;
use base64ct::{Base64, Encoding};
use maud::{Markup, html};

pub(super) fn section(page: &PassportPage, languages: &Languages) -> Markup {
    let name = page.file_name();
    let address = format!("data:application/yaml;base64,{}", Base64::encode_string(page.text.as_bytes()));
    let body = html! {
        (languages.paragraph_with(|language| html! { (texts::ANNEX_NOTE.filled(language, &[("name", &name)])) }))
        p.save { a href=(address) download=(name) { (languages.inline(texts::SAVE)) } }
        pre lang="en" translate="no" tabindex="0" aria-labelledby="annex-heading" { (page.text) }
        p.end {
            (languages.label_with(|language| {
                texts::END.filled(language, &[("id", &page.content.passport.id)])
            }))
        }
    };
    part(languages, "annex", "", texts::ANNEX, &body)
}
