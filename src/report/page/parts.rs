//! The parts that pages are put together from: sections, fields, tables, figures, forms to fill in with a pen.

use super::language::{Language, Languages, Text};
use super::number::{BLANK, Number};
use super::texts::{units, words};
use jiff::Timestamp;
use jiff::civil::Date;
use jiff::tz::TimeZone;
use maud::{Markup, html};

/// A section with its number and heading; `id` is its anchor.
pub(crate) fn section(languages: &Languages, id: &str, number: &str, heading: Text, body: &Markup) -> Markup {
    let heading_id = format!("{id}-heading");
    html! {
        section id=(id) aria-labelledby=(heading_id) {
            h2 id=(heading_id) {
                @if !number.is_empty() { span.number { (number) } " " }
                (languages.label(heading))
            }
            (body)
        }
    }
}

/// A heading within a section.
pub(crate) fn heading(languages: &Languages, text: Text) -> Markup {
    html! { h3 { (languages.label(text)) } }
}

/// Words of the file, in whatever language they are.
pub(crate) fn given(words: &str) -> Markup {
    html! { span.given lang="" { (words) } }
}

/// A place for a pen.
pub(crate) fn blank(languages: &Languages) -> Markup {
    html! { span.blank role="img" aria-label=(languages.spoken(words::EMPTY)) {} }
}

/// A name and what it names: a place for a pen when it is not known.
pub(crate) fn field(languages: &Languages, name: Text, value: Option<Markup>) -> Markup {
    html! {
        div {
            dt { (languages.label(name)) }
            dd { @match value { Some(value) => (value), None => (blank(languages)) } }
        }
    }
}

/// The same over the whole width: for long texts.
pub(crate) fn wide_field(languages: &Languages, name: Text, value: Option<Markup>) -> Markup {
    html! {
        div.wide {
            dt { (languages.label(name)) }
            dd { @match value { Some(value) => (value), None => (blank(languages)) } }
        }
    }
}

/// Fields, in as many columns as there is room for.
pub(crate) fn fields(fields: impl IntoIterator<Item = Markup>) -> Markup {
    html! { dl.fields { @for field in fields { (field) } } }
}

/// A number and its unit, which no line break parts.
pub(crate) fn quantity(languages: &Languages, number: &Number, unit: Text) -> Markup {
    html! { span.quantity { (number.markup(languages)) (unit_after(languages, unit)) } }
}

/// A unit behind its number: marks of angles stand close to it (SI Brochure, 5.4.3).
fn unit_after(languages: &Languages, unit: Text) -> Markup {
    let close = unit == units::ARCSEC || unit == units::DEGREES;
    html! { @if !close { (BLANK) } (languages.inline(unit)) }
}

/// A day, as the page's language writes it.
pub(crate) fn date(languages: &Languages, date: Date) -> Markup {
    html! { time datetime=(date) { (date_text(languages.first(), date)) } }
}

/// A day as `language` writes it: ISO 8601, or day, month and year with points.
pub(crate) fn date_text(language: Language, date: Date) -> String {
    match language {
        Language::English => date.to_string(),
        Language::Russian => format!("{:02}.{:02}.{:04}", date.day(), date.month(), date.year()),
    }
}

/// A time in UTC.
pub(crate) fn time(languages: &Languages, time: Timestamp) -> Markup {
    html! { time datetime=(time) { (time_text(languages.first(), time)) } }
}

/// A time in UTC as `language` writes it.
pub(crate) fn time_text(language: Language, time: Timestamp) -> String {
    let at = time.to_zoned(TimeZone::UTC);
    let clock = at.time();
    let (hour, minute, second) = (clock.hour(), clock.minute(), clock.second());
    format!("{}{BLANK}{hour:02}:{minute:02}:{second:02}{BLANK}UTC", date_text(language, at.date()))
}

/// A symbol with its subscript.
pub(crate) fn symbol(letter: &str, subscript: &str) -> Markup {
    html! { span.symbol { i { (letter) } @if !subscript.is_empty() { sub { (subscript) } } } }
}

/// A symbol in the head of a column, with its unit; another language's unit stands below.
pub(crate) fn symbol_and_unit(languages: &Languages, symbol: &Markup, unit: Text) -> Markup {
    html! { (symbol) "," (BLANK) (languages.label(unit)) }
}

/// A picture with its caption; `id` names it for the style. The picture says for itself what it shows to those who do not see
/// it.
pub(crate) fn figure(languages: &Languages, id: &str, drawing: &Markup, caption: Text) -> Markup {
    html! {
        figure id={ "figure-" (id) } {
            (drawing)
            figcaption { (languages.label(caption)) }
        }
    }
}

/// A table: its caption, its row of headings, which every sheet repeats, and its rows.
#[derive(Debug, Clone, Default)]
pub(crate) struct Table {
    /// What it shows.
    pub caption: Option<Markup>,
    /// Headings over several columns: how many, and what they say; none in most tables.
    pub groups: Vec<(usize, Markup)>,
    /// A heading for each column.
    pub headings: Vec<Markup>,
    /// The cells of each row.
    pub rows: Vec<Vec<Markup>>,
    /// How many cells at the beginning of a row name the row.
    pub row_headings: usize,
    /// Its class: `numbers` for columns of numbers, `form` for rows to fill in with a pen.
    pub class: &'static str,
}

impl Table {
    /// As markup; it scrolls sideways where the screen is too narrow, and a keyboard reaches it then.
    pub(crate) fn markup(&self, name: &str) -> Markup {
        html! {
            div.scroll tabindex="0" role="group" aria-label=(name) {
                table class=(self.class) {
                    @if let Some(caption) = &self.caption { caption { (caption) } }
                    thead {
                        @if !self.groups.is_empty() {
                            tr.groups {
                                @for _ in 0..self.row_headings { td {} }
                                @for (columns, heading) in &self.groups {
                                    th scope="colgroup" colspan=(columns) { (heading) }
                                }
                            }
                        }
                        tr {
                            @for heading in &self.headings {
                                @if heading.0.is_empty() { td {} } @else { th scope="col" { (heading) } }
                            }
                        }
                    }
                    tbody {
                        @for row in &self.rows {
                            tr {
                                @for (index, cell) in row.iter().enumerate() {
                                    @if index < self.row_headings { th scope="row" { (cell) } } @else { td { (cell) } }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}
