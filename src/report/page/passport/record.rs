//! Record of the stand: the parts of a product's passport according to [GOST R
//! 2.610-2019](crate::bibliography::Bibliography::GostR2610) that are filled in by hand. Fields unknown to the file
//! stay empty.

use super::PassportPage;
use crate::report::page::language::{Languages, Text};
use crate::report::page::parts::{Table, blank, field, fields, given, heading};
use crate::report::page::texts::{passport, record as texts};
use maud::{Markup, html};

pub(super) fn section(page: &PassportPage, languages: &Languages) -> Markup {
    let form = |heading, class, headings: &[Text], rows| table(languages, heading, class, headings, rows);
    let words = |heading_text, names: &[Text]| {
        html! {
            div.part.pen {
                (heading(languages, heading_text))
                (fields(names.iter().map(|name| field(languages, *name, None))))
            }
        }
    };
    html! {
        p.save { (languages.inline(texts::ON_PAPER)) }
        (completeness(page, languages))
        (words(texts::WARRANTY, &[
            texts::SERVICE_LIFE, texts::STORAGE_LIFE, texts::WARRANTY_PERIOD, texts::WARRANTY_TERMS,
        ]))
        (form(texts::PRESERVATION, "form dated third", &[texts::DATE, texts::WORK, texts::PERIOD, texts::WHO], empty(1, 4)))
        div.pair {
            (certificate(page, languages, texts::PACKING, texts::PACKING_WORDS))
            (certificate(page, languages, texts::ACCEPTANCE, texts::ACCEPTANCE_WORDS))
        }
        div.statement.pen { (languages.paragraph(texts::VALID_WHEN_SIGNED)) }
        (words(texts::STORAGE, &[texts::STORAGE_CONDITIONS, texts::TRANSPORT_CONDITIONS]))
        (form(
            texts::MOVEMENT,
            "form dated third",
            &[texts::INSTALLED, texts::SITE, texts::REMOVED, texts::WHY_REMOVED, texts::WHO],
            empty(2, 5),
        ))
        (form(
            texts::REPAIRS,
            "form dated",
            &[texts::DATE, texts::REPAIR, texts::CERTIFIED_AGAIN, texts::WHO],
            empty(2, 4),
        ))
        div.statement { (languages.paragraph(texts::AFTER_A_MOVE)) }
        (form(texts::NOTES, "form dated", &[texts::DATE, texts::NOTE, texts::WHO], empty(2, 3)))
        div.pair {
            div.part.pen { (heading(languages, texts::DISPOSAL)) (lines(languages)) }
            div.part.pen { (heading(languages, texts::SPECIAL)) (lines(languages)) }
        }
    }
}

fn empty(rows: usize, columns: usize) -> Vec<Vec<Markup>> {
    vec![vec![html! {}; columns]; rows]
}

fn lines(languages: &Languages) -> Markup {
    html! { p.lines { (blank(languages)) } }
}

/// Writes a form. Its class has the widths of its columns: `dated` begins with a date, whose width the `third` column has
/// too.
fn table(languages: &Languages, name: Text, class: &'static str, headings: &[Text], rows: Vec<Vec<Markup>>) -> Markup {
    let headings = headings.iter().map(|text| languages.label(*text)).collect();
    let table = Table { headings, rows, class, ..Table::default() };
    html! { div.part.pen { (heading(languages, name)) (table.markup(languages.spoken(name))) } }
}

fn completeness(page: &PassportPage, languages: &Languages) -> Markup {
    let stand = &page.content.stand;
    let name = stand.name.as_deref().map_or_else(|| languages.label(texts::TEST_STAND), given);
    let rows = vec![
        vec![given(stand.model.as_str()), name, html! {}, given(stand.serial.as_str()), html! {}],
        vec![given(&page.content.passport.id), languages.label(texts::THIS_PASSPORT), html! {}, html! {}, html! {}],
        vec![html! {}; 5],
    ];
    let headings = [texts::DESIGNATION, texts::ITEM, texts::QUANTITY, passport::SERIAL, texts::NOTE];
    table(languages, texts::COMPLETENESS, "form complete", &headings, rows)
}

fn certificate(page: &PassportPage, languages: &Languages, name: Text, words: Text) -> Markup {
    let stand = &page.content.stand;
    let values = [("model", given(stand.model.as_str())), ("serial", given(stand.serial.as_str()))];
    let names = [texts::ORGANISATION, texts::WHO, texts::DATE, texts::STAMP];
    html! {
        div.part.pen {
            (heading(languages, name))
            (languages.paragraph_with(|language| words.marked_up(language, &values)))
            (fields(names.map(|name| field(languages, name, None))))
        }
    }
}
