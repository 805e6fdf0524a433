//! Building blocks of pages: sections, fields, tables, figures, forms to fill in by hand.

use super::language::{Language, Languages, Text};
use super::number::Number;
use super::spacing::{BLANK, unbroken};
use super::symbols::index;
use crate::report::style::Outcome;
use crate::wording::texts::{calibration, record, units, words};
use crate::wording::{date_text, time_text};
use base64ct::{Base64, Encoding};
use jiff::Timestamp;
use jiff::civil::Date;
use maud::{Markup, html};
use std::path::Path;

/// Anchor, heading and content of a section.
pub(crate) type Section = (&'static str, Text, Markup);

pub(crate) fn numbered(languages: &Languages, sections: &[Section]) -> Markup {
    html! { @for (number, section) in (1..).zip(sections) { (section_of(languages, Some(number), section)) } }
}

/// Writes a section without a number.
pub(crate) fn section(languages: &Languages, id: &'static str, heading: Text, body: Markup) -> Markup {
    section_of(languages, None, &(id, heading, body))
}

fn section_of(languages: &Languages, number: Option<usize>, (id, heading, body): &Section) -> Markup {
    let heading_id = format!("{id}-heading");
    html! {
        section id=(id) aria-labelledby=(heading_id) {
            h2 id=(heading_id) {
                (number_of(number))
                (languages.label(*heading))
            }
            (body)
        }
    }
}

/// Writes the number of a section, if it has one.
fn number_of(number: Option<usize>) -> Markup {
    html! { @if let Some(number) = number { span.number { (number) } " " } }
}

pub(crate) fn heading(languages: &Languages, text: Text) -> Markup {
    html! { h3 { (languages.label(text)) } }
}

/// Writes words from the file, whose language is unknown; designations and the parts of an id stay whole.
pub(crate) fn given(words: &str) -> Markup {
    html! { span.given lang="" { (unbroken(words)) } }
}

/// Writes an empty space to fill in by hand.
pub(crate) fn blank(languages: &Languages) -> Markup {
    html! { span.blank role="img" aria-label=(languages.spoken(words::EMPTY)) {} }
}

/// Writes a name and its value, or a space to fill in by hand if the value is `None`.
pub(crate) fn field(languages: &Languages, name: Text, value: Option<Markup>) -> Markup {
    field_of(None, languages, name, value)
}

/// Writes a field over the full width, for long texts.
pub(crate) fn wide_field(languages: &Languages, name: Text, value: Option<Markup>) -> Markup {
    field_of(Some("wide"), languages, name, value)
}

fn field_of(class: Option<&str>, languages: &Languages, name: Text, value: Option<Markup>) -> Markup {
    html! {
        div class=[class] {
            dt { (languages.label(name)) }
            dd { (value.unwrap_or_else(|| blank(languages))) }
        }
    }
}

/// Writes a field over the full width, or that the file does not state its value: it is not to be completed by hand.
pub(crate) fn wide_stated(languages: &Languages, name: Text, value: Option<Markup>) -> Markup {
    wide_field(languages, name, Some(value.unwrap_or_else(|| not_stated(languages))))
}

/// Writes that the signed file does not state a value.
pub(crate) fn not_stated(languages: &Languages) -> Markup {
    html! { span.absent { (languages.inline(words::NOT_STATED)) } }
}

/// Writes the mark of an outcome; words beside it say the same.
pub(crate) fn mark(outcome: impl Into<Outcome>) -> Markup {
    let outcome = outcome.into();
    let class = match outcome {
        Outcome::Passed => "state passed",
        Outcome::Failed => "state failed",
        Outcome::Undecided | Outcome::NotAsked => "state",
    };
    html! { span class=(class) aria-hidden="true" { (outcome.mark()) } }
}

/// Writes words with the mark of their outcome before them.
pub(crate) fn marked(outcome: impl Into<Outcome>, words: &Markup) -> Markup {
    html! { (mark(outcome)) " " (words) }
}

/// Writes a headline with the mark of an outcome, and words about it, in the box of that outcome.
pub(crate) fn outcome_box(outcome: impl Into<Outcome>, headline: &Markup, words: Markup) -> Markup {
    let outcome = outcome.into();
    let class = match outcome {
        Outcome::Passed => "verdict",
        Outcome::Failed => "verdict refused",
        Outcome::Undecided | Outcome::NotAsked => "verdict neutral",
    };
    boxed(class, marked(outcome, headline), words)
}

/// Writes a headline and words about it in a box.
pub(crate) fn boxed(class: &str, headline: Markup, words: Markup) -> Markup {
    html! { div class=(class) { p.headline { (headline) } (words) } }
}

/// Writes the fields of a signature; `who` asks for the person.
pub(crate) fn signature(languages: &Languages, who: Text) -> Markup {
    let names = [who, record::SIGNATURE, record::DATE, record::STAMP];
    fields(names.map(|name| field(languages, name, None)))
}

/// Writes forms for the signatures of some persons.
pub(crate) fn signatures<const N: usize>(languages: &Languages, who: [Text; N]) -> Markup {
    html! {
        div.pair { @for who in who { div.part.pen { (heading(languages, who)) (signature(languages, record::POST_AND_NAME)) } } }
        div.statement { (languages.paragraph(calibration::VALID_WHEN_SIGNED)) }
    }
}

/// Writes fields in as many columns as fit.
pub(crate) fn fields(fields: impl IntoIterator<Item = Markup>) -> Markup {
    html! { dl.fields { @for field in fields { (field) } } }
}

/// Writes a band of cells, each a name, a value in large letters, and words about it.
pub(crate) fn band(languages: &Languages, cells: [(Text, Markup, Markup); 4]) -> Markup {
    html! {
        dl.band {
            @for (name, value, words) in cells {
                div {
                    dt { (languages.label(name)) }
                    dd.large { (value) }
                    dd { (words) }
                }
            }
        }
    }
}

/// Writes a coordinate in degrees, with its hemisphere instead of a sign.
pub(crate) fn coordinate(languages: &Languages, degrees: f64, hemispheres: [Text; 2]) -> Markup {
    in_hemisphere(languages, Number::exact(degrees), hemispheres)
}

/// Writes a number of degrees as [`coordinate`] does.
pub(crate) fn in_hemisphere(languages: &Languages, degrees: Number, hemispheres: [Text; 2]) -> Markup {
    let (number, hemisphere) = degrees.in_hemisphere(hemispheres);
    html! { span.quantity { (number.markup(languages)) "°" (BLANK) (languages.inline(hemisphere)) } }
}

/// Writes a number and its unit without a line break between them.
pub(crate) fn quantity(languages: &Languages, number: &Number, unit: Text) -> Markup {
    // No space before the marks of angles (SI Brochure, 5.4.3).
    let close = unit == units::ARCSEC || unit == units::DEGREES;
    html! { span.quantity { (number.markup(languages)) @if !close { (BLANK) } (languages.in_brackets(unit)) } }
}

/// Returns the language in whose format the readers of all languages understand a date: year, month, day.
fn of_dates(languages: &Languages) -> Language {
    if languages.single() { languages.first() } else { Language::English }
}

/// Writes a date.
pub(crate) fn date(languages: &Languages, date: Date) -> Markup {
    html! { time datetime=(date) { (date_text(of_dates(languages), date)) } }
}

/// Writes a time in UTC.
pub(crate) fn time(languages: &Languages, time: Timestamp) -> Markup {
    html! { time datetime=(time) { (unbroken(&time_text(of_dates(languages), time))) } }
}

pub(crate) fn symbol(letter: &str, subscript: &str) -> Markup {
    html! { span.symbol { i { (letter) } @if !subscript.is_empty() { (index(subscript)) } } }
}

/// Writes a picture with its caption, which the style sheet numbers; `id` is its name there. The picture contains its own description for
/// screen readers.
pub(crate) fn figure(languages: &Languages, id: &str, drawing: &Markup, caption: Text) -> Markup {
    figure_with(languages, id, drawing, |language| caption.words(language))
}

/// Writes a picture as `figure` does; `caption` gives its words in each language.
pub(crate) fn figure_with(
    languages: &Languages,
    id: &str,
    drawing: &Markup,
    caption: impl Fn(Language) -> String,
) -> Markup {
    let second = languages.iter().nth(1).map(|language| format!("--second:\"{}\"", words::FIGURE.of(language)));
    html! {
        figure id={ "figure-" (id) } style=[second] {
            (drawing)
            figcaption data-word=(languages.spoken(words::FIGURE)) { (languages.label_with(caption)) }
        }
    }
}

/// Writes a text verbatim, and the words at its end; the style sheet numbers its lines, and marks where a line goes on.
pub(crate) fn verbatim(lang: &str, text: &str, end: &Markup) -> Markup {
    // Bytes of a line that a telephone shows whole: it never goes on.
    const LONGEST: usize = 40;
    // One word alone, such as a line of a signature, is broken anywhere.
    let kind = |line: &str| match (line.len() > LONGEST, line.trim().contains(' ')) {
        (true, true) => Some("c"),
        (true, false) => Some("c w"),
        (false, _) => None,
    };
    html! {
        div.file {
            pre lang=(lang) translate="no" tabindex="0" aria-labelledby="annex-heading" {
                @for line in text.split_inclusive('\n') {
                    span class=[kind(line)] { span { (line) } }
                }
            }
            p.end { (end) }
        }
    }
}

/// Returns the name of a file without its folder.
pub(crate) fn file_name(path: &str) -> &str {
    Path::new(path).file_name().and_then(|name| name.to_str()).unwrap_or(path)
}

/// Returns the address of a file that the page itself contains.
pub(crate) fn data_address(kind: &str, bytes: &[u8]) -> String {
    format!("data:{kind};base64,{}", Base64::encode_string(bytes))
}

/// Writes what only a screen needs: the file to save, and links to the sections and to the annex.
pub(crate) fn contents(
    languages: &Languages,
    save: Text,
    (address, name): (&str, &str),
    sections: &[Section],
    annex: Text,
) -> Markup {
    let numbered = (1..).zip(sections).map(|(number, (id, heading, _))| (Some(number), *id, *heading));
    let headings = numbered.chain([(None, "annex", annex)]);
    html! {
        nav.screen aria-label=(languages.spoken(words::CONTENTS)) {
            ol { @for (number, id, heading) in headings { li { (number_of(number)) a href={ "#" (id) } { (languages.inline(heading)) } } } }
            a.button href=(address) download=(name) { (languages.inline(save)) }
        }
    }
}

/// A table with its caption, its row of headings (repeated on every sheet) and its rows.
#[derive(Debug, Clone, Default)]
pub(crate) struct Table {
    pub caption: Option<Markup>,
    /// Headings over several columns: number of columns, and heading, empty over columns that have none. Most tables have
    /// no groups.
    pub groups: Vec<(usize, Markup)>,
    pub headings: Vec<Markup>,
    pub rows: Vec<Vec<Markup>>,
    /// Rows with which a group begins; a rule separates them from the row before.
    pub starts: Vec<usize>,
    /// Cells below the rows, such as the axes of strips. Most tables have none.
    pub foot: Vec<Markup>,
    /// Number of cells at the beginning of a row that are row headings.
    pub row_headings: usize,
    /// CSS class: `numbers` for columns of numbers, `form` for rows to fill in by hand.
    pub class: &'static str,
}

/// Returns the rows with which a group of equal values begins, after the first.
pub(crate) fn starts<T: PartialEq>(values: impl IntoIterator<Item = T>) -> Vec<usize> {
    let values: Vec<T> = values.into_iter().collect();
    (1..values.len()).filter(|row| values[*row] != values[row - 1]).collect()
}

impl Table {
    /// Writes the table. It scrolls sideways on a narrow screen, and the keyboard can then focus it.
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
                                    @if heading.0.is_empty() {
                                        td colspan=(columns) {}
                                    } @else {
                                        th scope="colgroup" colspan=(columns) { (heading) }
                                    }
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
                        @for (place, row) in self.rows.iter().enumerate() {
                            tr class=[self.starts.contains(&place).then_some("start")] {
                                @for (index, cell) in row.iter().enumerate() {
                                    @if index < self.row_headings { th scope="row" { (cell) } } @else { td { (cell) } }
                                }
                            }
                        }
                    }
                    @if !self.foot.is_empty() {
                        tfoot aria-hidden="true" { tr { @for cell in &self.foot { td { (cell) } } } }
                    }
                }
            }
        }
    }
}
