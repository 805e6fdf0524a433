//! Blocks as parts of a page.

use super::{Block, Cell, Column, On, Statement, Table, Words};
use crate::report::page::language::Languages;
use crate::report::page::parts::{self, given, mark};
use crate::report::page::symbols::italic;
use crate::wording::{BLANK, Language, Number, Piece, capital, pieces};
use maud::{Markup, html};

/// How words are written.
#[derive(Clone, Copy, PartialEq)]
enum How {
    /// In one language, as in a sentence.
    In(Language),
    /// Once for all languages of a page, as in a cell: numbers in the first, texts side by side.
    Cell,
    /// As a heading or a name: the second language smaller, below the first.
    Name,
}

impl Languages {
    /// Writes the words in one language of a page, as in a sentence.
    fn words(&self, words: &Words, language: Language) -> Markup {
        self.written(words, How::In(language))
    }

    /// Writes the words once for all languages of a page, as in a cell.
    pub(crate) fn cell(&self, words: &Words) -> Markup {
        self.written(words, How::Cell)
    }

    /// Writes a heading or a name.
    pub(crate) fn name(&self, words: &Words) -> Markup {
        self.written(words, How::Name)
    }

    fn written(&self, words: &Words, how: How) -> Markup {
        let same = |words: &Words| self.written(words, how);
        // What is emphasised is a name, also in a cell.
        let named = |words: &Words| self.written(words, if how == How::Cell { How::Name } else { how });
        match (words, how) {
            (Words::Text(text, values), How::In(language)) => html! {
                @for piece in pieces(text.of(language)) {
                    @match piece {
                        Piece::Words(words) => (italic(words)),
                        Piece::Name(name) => @for (_, value) in values.iter().filter(|(key, _)| *key == name) { (same(value)) },
                    }
                }
            },
            (Words::Capital(words), How::In(language)) => italic(&capital(&words.plain(language))),
            (Words::Told(words), How::In(language)) => italic(&words.plain(language)),
            (Words::Whole(words), How::In(_)) => same(words),
            (Words::Text(..) | Words::Capital(_) | Words::Whole(_), How::Cell) => self.said(words, [" / ", ""], None),
            (Words::Text(..) | Words::Capital(_) | Words::Whole(_), How::Name) | (Words::Told(_), _) => {
                self.said(words, [" ", ""], Some("second"))
            }
            (Words::First(words), How::In(_)) => same(words),
            (Words::First(words), _) => self.words(words, self.first()),
            (Words::Others(words), How::In(language)) if language != self.first() => same(words),
            (Words::Others(_), _) => html! {},
            (Words::Inline(words), How::Name) => self.written(words, How::Cell),
            (
                Words::Inline(words) | Words::Either(words, _) | Words::OfLibrary(_, words) | Words::Padded(words, _),
                _,
            ) => same(words),
            (Words::Marked(outcome, words), _) => html! { (mark(*outcome)) " " (same(words)) },
            (Words::Strong(words), _) => html! { strong { (named(words)) } },
            (Words::Styled(class, words), _) => html! { span class=(class) { (named(words)) } },
            (Words::All(all), _) => html! { @for one in all { (same(one)) } },
            (value, How::In(language)) => Self::from(language).value(value),
            (value, _) => self.value(value),
        }
    }

    /// Writes what has one form on a page.
    fn value(&self, value: &Words) -> Markup {
        match value {
            Words::Number(number) => self.number(number),
            Words::Below(limit) => self.below(limit),
            Words::Quantity(number, unit) => self.quantity(number, *unit),
            Words::Symbol(name) => parts::symbol(name),
            Words::Plain(words) => italic(words),
            Words::Given(words) => given(words),
            Words::Code(words) => html! { code { (words) } },
            Words::Date(date) => self.date(*date),
            Words::Time(time) => self.time(*time),
            Words::Coordinate(degrees, hemispheres) => self.in_hemisphere(degrees.clone(), *hemispheres),
            Words::Count(count) => self.number(&Number::fixed(*count as f64, 0)),
            Words::OnTelephones(outcome) => html! { span.narrow-only { (mark(*outcome)) (BLANK) } },
            // All others are written by `written`.
            _ => self.blank(),
        }
    }

    /// Writes the wordings of all languages, those after the first between these strings and in this class.
    pub(crate) fn said(&self, words: &Words, [before, after]: [&str; 2], class: Option<&str>) -> Markup {
        let sayings = self.sayings(words);
        if let [(language, _)] = sayings.as_slice() {
            return self.words(words, *language);
        }
        html! {
            @for (index, (language, _)) in sayings.into_iter().enumerate() {
                @let other = index > 0;
                @if other { (before) }
                span class=[class.filter(|_| other)] lang=[(language != self.first()).then(|| language.tag())] { (self.words(words, language)) }
                @if other { (after) }
            }
        }
    }

    pub(crate) fn blocks(&self, blocks: &[Block]) -> Markup {
        html! { @for block in blocks { (self.block(block)) } }
    }

    /// Writes a paragraph of sentences in each language, side by side if there is room.
    fn paragraph(&self, all: &[Words]) -> Markup {
        let said = |language| {
            html! { @for (place, one) in all.iter().enumerate() { @if place > 0 { " " } (self.words(one, language)) } }
        };
        html! {
            @if self.single() {
                p { (said(self.first())) }
            } @else {
                div.beside { @for language in self.iter() { p lang=(language.tag()) { (said(language)) } } }
            }
        }
    }

    fn block(&self, block: &Block) -> Markup {
        match block {
            Block::Said(Statement::Sentences(all)) | Block::List(all) if all.is_empty() => html! {},
            Block::Said(Statement::Fields(all)) | Block::Record(all) if all.is_empty() => html! {},
            Block::Heading(words) => html! { h3 { (self.name(words)) } },
            Block::Said(Statement::Sentences(all)) => self.paragraph(all),
            Block::Line(words) => self.paragraph(std::slice::from_ref(words)),
            Block::Said(Statement::Fields(all)) | Block::Record(all) => html! {
                dl.fields { @for (name, value, wide) in all {
                    div class=[wide.then_some("wide")] { dt { (self.name(&(*name).into())) } dd { (self.cell(value)) } }
                } }
            },
            Block::Table(table) => self.table(table),
            Block::Within(class, all) => html! { div class=(class) { (self.blocks(all)) } },
            Block::Gap | Block::Lines(..) | Block::Whole(..) => html! {},
            Block::Drawn(draw) => draw(self),
            Block::Key(entries) => self.key(entries),
            Block::List(all) => html! { ul.absences { @for one in all { li { (self.name(one)) } } } },
            Block::Boxed(class, headline, all) => html! {
                div class=(class) { p.headline { (self.name(headline)) } (self.blocks(all)) }
            },
            Block::Band(all) => html! {
                dl.band { @for (name, value, about) in all {
                    div { dt { (self.name(&(*name).into())) } dd.large { (self.cell(value)) } dd { (self.blocks(about)) } }
                } }
            },
            Block::Note(class, words) => {
                html! { p class=[Some(class).filter(|class| !class.is_empty())] { (self.name(words)) } }
            }
            Block::Each(words) => html! {
                @for (index, language) in self.iter().enumerate() {
                    p lang=(language.tag()) class=[(index > 0).then_some("second")] { (self.words(words, language)) }
                }
            },
            Block::On(On::Terminal, _) => html! {},
            Block::On(_, block) => self.block(block),
        }
    }

    /// Writes a table with its row of headings, which print repeats on every sheet. It scrolls sideways on a narrow screen, and
    /// the keyboard can then focus it.
    fn table(&self, table: &Table) -> Markup {
        let columns: Vec<&Column> = table.columns.iter().filter(|column| column.on != On::Terminal).collect();
        let cells = columns.iter().enumerate().map(|(place, of)| match place < table.names {
            true => of.cells.iter().map(|cell| self.table_cell(cell, How::Name)).collect(),
            false => self.column(&of.cells),
        });
        let cells: Vec<Vec<Markup>> = cells.collect();
        let axis = |column: &&Column| column.foot.map(|axis| axis.drawn(self.first()));
        html! {
            div.scroll tabindex="0" role="group" aria-label=(table.name.map_or("", |name| self.spoken(name))) {
                table class=(table.class) {
                    @if let Some(caption) = &table.caption { caption { (self.name(caption)) } }
                    thead {
                        @if !table.groups.is_empty() {
                            tr.groups {
                                @for _ in 0..table.names { td {} }
                                @for (columns, heading) in &table.groups {
                                    @let heading = self.name(heading);
                                    @if heading.0.is_empty() {
                                        td colspan=(columns) {}
                                    } @else {
                                        th scope="colgroup" colspan=(columns) { (heading) }
                                    }
                                }
                            }
                        }
                        tr {
                            @for heading in columns.iter().map(|column| self.name(&column.heading)) {
                                @if heading.0.is_empty() { td {} } @else { th scope="col" { (heading) } }
                            }
                        }
                    }
                    tbody {
                        @for row in 0..cells.first().map_or(0, Vec::len) {
                            tr class=[table.starts.contains(&row).then_some("start")] {
                                @for (place, column) in cells.iter().enumerate() {
                                    @if place < table.names { th scope="row" { (column[row]) } } @else { td { (column[row]) } }
                                }
                            }
                        }
                    }
                    @if columns.iter().any(|column| column.foot.is_some()) {
                        tfoot aria-hidden="true" { tr { @for column in &columns { td { @if let Some(axis) = axis(column) { (axis) } } } } }
                    }
                }
            }
        }
    }

    fn table_cell(&self, cell: &Cell, how: How) -> Markup {
        match cell {
            Cell::Words(words) => self.written(words, how),
            Cell::Drawn(markup) => markup.clone(),
        }
    }

    /// Writes the cells of a column, its numbers with aligned decimal marks.
    fn column(&self, cells: &[Cell]) -> Vec<Markup> {
        let numbers = cells.iter().map(|cell| match cell {
            Cell::Words(Words::Number(number) | Words::Quantity(number, _)) => Some(number),
            _ => None,
        });
        let pads = self.pads(&numbers.collect::<Vec<_>>());
        let written = |cell: &Cell| match cell {
            // Directly followed by its unit in one language; all units of a column have one width.
            Cell::Words(Words::Quantity(number, unit)) => {
                html! { (self.number(number)) span.unit { (parts::gap(*unit)) (italic(self.spoken(*unit))) } }
            }
            cell => self.table_cell(cell, How::Cell),
        };
        cells.iter().zip(pads).map(|(cell, pad)| html! { (written(cell)) (pad) }).collect()
    }
}
