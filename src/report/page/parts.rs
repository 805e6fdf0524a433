//! Building blocks of pages: sections, fields, tables, figures, forms to fill in by hand.

use super::language::{Language, Languages, Text};
use super::number::Number;
use super::spacing::{BLANK, unbroken};
use super::symbols::index;
use crate::report::doc::{Block, Words, blank, heading, record, say};
use crate::report::style::Outcome;
use crate::wording::texts::{calibration, record as forms, units, words};
use crate::wording::{date_text, time_text};
use base64ct::{Base64, Encoding};
use jiff::Timestamp;
use jiff::civil::Date;
use maud::{Markup, html};
use std::path::Path;

/// Anchor, heading and content of a section.
pub(crate) type Section = (&'static str, Text, Vec<Block>);

impl Languages {
    pub(crate) fn numbered(&self, sections: &[Section]) -> Markup {
        html! {
            @for (number, (id, heading, blocks)) in (1..).zip(sections) {
                (self.section_of(Some(number), id, *heading, &self.blocks(blocks)))
            }
        }
    }

    /// Writes a section without a number.
    pub(crate) fn section(&self, id: &str, heading: Text, body: &Markup) -> Markup {
        self.section_of(None, id, heading, body)
    }

    fn section_of(&self, number: Option<usize>, id: &str, heading: Text, body: &Markup) -> Markup {
        let heading_id = format!("{id}-heading");
        html! {
            section id=(id) aria-labelledby=(heading_id) {
                h2 id=(heading_id) { (number_of(number)) (self.label(heading)) }
                (body)
            }
        }
    }

    /// Writes the annex: a note, a file verbatim in the language `lang`, and the words at its end. If it is not `printed`, the
    /// screen has it, and paper its end.
    pub(crate) fn annex(
        &self,
        (heading, note): (Text, Words),
        (lang, text): (&str, &str),
        end: &Words,
        printed: bool,
    ) -> Markup {
        let end = self.name(end);
        let body = html! { (self.said_in_paragraph(&note)) (verbatim(lang, text, &end)) };
        let annex = self.section("annex", heading, &body);
        html! { @if printed { (annex) } @else { p.end { (end) } div.save { (annex) } } }
    }
}

/// Writes the number of a section, if it has one.
fn number_of(number: Option<usize>) -> Markup {
    html! { @if let Some(number) = number { span.number { (number) } " " } }
}

/// Writes words from the file, whose language is unknown; designations and the parts of an id stay whole.
pub(crate) fn given(words: &str) -> Markup {
    html! { span.given lang="" { (unbroken(words)) } }
}

impl Languages {
    /// Writes an empty space to fill in by hand.
    pub(crate) fn blank(&self) -> Markup {
        html! { span.blank role="img" aria-label=(self.spoken(words::EMPTY)) {} }
    }
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

/// The fields of a signature; `who` asks for the person.
pub(crate) fn signature(who: Text) -> Block {
    record([who, forms::SIGNATURE, forms::DATE, forms::STAMP].map(blank))
}

/// Forms for the signatures of some persons.
pub(crate) fn signatures<const N: usize>(who: [Text; N]) -> [Block; 2] {
    let form = |who| Block::Within("part pen", vec![heading(who), signature(forms::POST_AND_NAME)]);
    let forms = Block::Within("pair", who.map(form).into());
    [forms, Block::Within("statement", vec![say([calibration::VALID_WHEN_SIGNED])])]
}

impl Languages {
    /// Writes a coordinate in degrees, with its hemisphere instead of a sign.
    pub(crate) fn in_hemisphere(&self, degrees: Number, hemispheres: [Text; 2]) -> Markup {
        let (number, hemisphere) = degrees.in_hemisphere(hemispheres);
        html! { span.quantity { (self.number(&number)) "°" (BLANK) (self.inline(hemisphere)) } }
    }

    /// Writes a number and its unit without a line break between them.
    pub(crate) fn quantity(&self, number: &Number, unit: Text) -> Markup {
        // No space before the marks of angles (SI Brochure, 5.4.3).
        let close = unit == units::ARCSEC || unit == units::DEGREES;
        html! { span.quantity { (self.number(number)) @if !close { (BLANK) } (self.in_brackets(unit)) } }
    }

    /// Returns the language in whose format the readers of all languages understand a date: year, month, day.
    fn of_dates(&self) -> Language {
        if self.single() { self.first() } else { Language::English }
    }

    /// Writes a date.
    pub(crate) fn date(&self, date: Date) -> Markup {
        html! { time datetime=(date) { (date_text(self.of_dates(), date)) } }
    }

    /// Writes a time in UTC.
    pub(crate) fn time(&self, time: Timestamp) -> Markup {
        html! { time datetime=(time) { (unbroken(&time_text(self.of_dates(), time))) } }
    }
}

pub(crate) fn symbol(letter: &str, subscript: &str) -> Markup {
    html! { @if subscript.is_empty() { i { (letter) } } @else { span.symbol { i { (letter) } (index(subscript)) } } }
}

impl Languages {
    /// Writes a picture with its caption, which the style sheet numbers; `id` is its name there. The picture contains its own description for
    /// screen readers.
    pub(crate) fn figure(&self, id: &str, drawing: &Markup, caption: Text) -> Markup {
        self.figure_with(id, drawing, |language| caption.words(language))
    }

    /// Writes a picture as `figure` does; `caption` gives its words in each language.
    pub(crate) fn figure_with(&self, id: &str, drawing: &Markup, caption: impl Fn(Language) -> String) -> Markup {
        let second = self.iter().nth(1).map(|language| format!("--second:\"{}\"", words::FIGURE.of(language)));
        html! {
            figure id={ "figure-" (id) } style=[second] {
                (drawing)
                figcaption data-word=(self.spoken(words::FIGURE)) { (self.label_with(caption)) }
            }
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

impl Languages {
    /// Writes what only a screen needs: the file to save, and links to the sections and to the annex.
    pub(crate) fn contents(
        &self,
        save: Text,
        (address, name): (&str, &str),
        sections: &[Section],
        annex: Text,
    ) -> Markup {
        let numbered = (1..).zip(sections).map(|(number, (id, heading, _))| (Some(number), *id, *heading));
        let headings = numbered.chain([(None, "annex", annex)]);
        html! {
            nav.screen aria-label=(self.spoken(words::CONTENTS)) {
                ol { @for (number, id, heading) in headings { li { (number_of(number)) a href={ "#" (id) } { (self.inline(heading)) } } } }
                a.button href=(address) download=(name) { (self.inline(save)) }
            }
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
