//! Blocks as parts of a page.

use super::{Block, Cell, Column, On, Statement, Table, Words};
use crate::report::page::language::{Language, Languages};
use crate::report::page::number::{self, Number};
use crate::report::page::parts::{self, given, mark};
use crate::report::page::spacing::BLANK;
use crate::report::page::symbols::italic;
use crate::wording::{Piece, capital, pieces};
use maud::{Markup, html};

impl Languages {
    /// Writes the words in one language of a page, as in a sentence.
    pub(crate) fn words(&self, words: &Words, language: Language) -> Markup {
        match words {
            Words::Text(text, values) => html! {
                @for piece in pieces(&text.words(language)) {
                    @match piece {
                        Piece::Words(words) => (italic(words)),
                        Piece::Name(name) => @for (_, value) in values.iter().filter(|(key, _)| *key == name) { (self.words(value, language)) },
                    }
                }
            },
            Words::Either(page, _) => self.words(page, language),
            Words::Whole(words) => self.words(words, language),
            Words::Others(words) => html! { @if language != self.first() { (self.words(words, language)) } },
            Words::Marked(outcome, words) => html! { (mark(*outcome)) " " (self.words(words, language)) },
            Words::OfLibrary(_, words) | Words::Padded(words, _) => self.words(words, language),
            Words::Strong(words) => html! { strong { (self.words(words, language)) } },
            Words::Capital(words) => italic(&capital(&words.plain(language))),
            Words::Told(words) => italic(&words.plain(language)),
            Words::All(all) => html! { @for one in all { (self.words(one, language)) } },
            _ => Languages::from(language).cell(words),
        }
    }

    /// Writes the words once for all languages of a page, as in a cell: numbers in the first, texts side by side.
    pub(crate) fn cell(&self, words: &Words) -> Markup {
        match words {
            Words::Text(..) | Words::Capital(_) | Words::Whole(_) => self.said(words, [" / ", ""], None),
            Words::Styled(class, words) => html! { span class=(class) { (self.name(words)) } },
            Words::Inline(words) => self.cell(words),
            Words::Number(number) => self.number(number),
            Words::Below(limit) => self.below(limit),
            Words::Quantity(number, unit) => self.quantity(number, *unit),
            Words::Symbol(name) => {
                let (letter, index) = name.split_once('_').unwrap_or((name, ""));
                parts::symbol(letter, index)
            }
            Words::Plain(words) => italic(words),
            Words::Given(words) => given(words),
            Words::Code(words) => html! { code { (words) } },
            Words::Date(date) => self.date(*date),
            Words::Time(time) => self.time(*time),
            Words::Coordinate(degrees, hemispheres) => self.in_hemisphere(degrees.clone(), *hemispheres),
            Words::OfLibrary(_, words) | Words::Padded(words, _) => self.cell(words),
            Words::Count(count) => self.number(&Number::fixed(*count as f64, 0)),
            Words::Told(words) => self.label_with(|language| words.plain(language)),
            Words::Either(page, _) => self.cell(page),
            Words::Marked(outcome, words) => html! { (mark(*outcome)) " " (self.cell(words)) },
            Words::Strong(words) => html! { strong { (self.name(words)) } },
            Words::First(words) => self.words(words, self.first()),
            Words::Others(_) => html! {},
            Words::OnTelephones(outcome) => html! { span.narrow-only { (mark(*outcome)) (BLANK) } },
            Words::Unseen(words) => html! { span.unseen { (self.name(words)) } },
            Words::Blank => self.blank(),
            Words::All(all) => html! { @for one in all { (self.cell(one)) } },
        }
    }

    /// Writes a heading or a name: the second language smaller, below the first.
    pub(crate) fn name(&self, words: &Words) -> Markup {
        match words {
            Words::Text(..) | Words::Capital(_) | Words::Whole(_) => self.said(words, [" ", ""], Some("second")),
            Words::Marked(outcome, words) => html! { (mark(*outcome)) " " (self.name(words)) },
            Words::All(all) => html! { @for one in all { (self.name(one)) } },
            Words::Strong(words) => html! { strong { (self.name(words)) } },
            Words::Either(page, _) => self.name(page),
            _ => self.cell(words),
        }
    }

    /// Writes a paragraph of words in each language.
    pub(crate) fn said_in_paragraph(&self, words: &Words) -> Markup {
        self.paragraph_with(|language| self.words(words, language))
    }

    fn said(&self, words: &Words, [before, after]: [&str; 2], class: Option<&str>) -> Markup {
        let sayings = self.sayings(|language| words.plain(language));
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

    fn block(&self, block: &Block) -> Markup {
        match block {
            Block::Heading(words) => html! { h3 { (self.name(words)) } },
            Block::Said(Statement::Sentences(all)) if all.is_empty() => html! {},
            Block::Line(words) => self.said_in_paragraph(words),
            Block::Said(Statement::Sentences(all)) => self.paragraph_with(|language| {
                html! { @for (place, one) in all.iter().enumerate() { @if place > 0 { " " } (self.words(one, language)) } }
            }),
            Block::Said(Statement::Fields(all)) | Block::Record(all) if all.is_empty() => html! {},
            Block::Said(Statement::Fields(all)) | Block::Record(all) => html! {
                dl.fields { @for (name, value, wide) in all {
                    div class=[wide.then_some("wide")] { dt { (self.label(*name)) } dd { (self.cell(value)) } }
                } }
            },
            Block::Table(table) => self.table(table),
            Block::Within(class, all) => html! { div class=(class) { (self.blocks(all)) } },
            Block::Typed(_) | Block::Lines(..) | Block::Whole(..) => html! {},
            Block::Drawn(draw) => draw(self),
            Block::Beside(block, None) => self.block(block),
            Block::Beside(block, Some(draw)) => html! { div.with-figure { (self.block(block)) (draw(self)) } },
            Block::List(all) if all.is_empty() => html! {},
            Block::List(all) => html! { ul.absences { @for one in all { li { (self.name(one)) } } } },
            Block::Boxed(class, headline, all) => html! {
                div class=(class) { p.headline { (self.name(headline)) } (self.blocks(all)) }
            },
            Block::Band(all) => html! {
                dl.band { @for (name, value, about) in all {
                    div { dt { (self.label(*name)) } dd.large { (self.cell(value)) } dd { (self.blocks(about)) } }
                } }
            },
            Block::Note(class, words) => {
                html! { p class=[Some(class).filter(|class| !class.is_empty())] { (self.name(words)) } }
            }
            Block::Each(words) => self.lines_with(|language| self.words(words, language)),
            Block::On(On::Terminal, _) => html! {},
            Block::On(_, block) => self.block(block),
        }
    }

    fn table(&self, table: &Table) -> Markup {
        let columns: Vec<&Column> = table.columns.iter().filter(|column| column.on != On::Terminal).collect();
        let cells = columns.iter().enumerate().map(|(place, of)| match place < table.names {
            true => of.cells.iter().map(|cell| self.table_cell(cell, true)).collect(),
            false => self.column(of.cells.iter().map(|cell| match cell {
                Cell::Words(Words::Number(number)) => number::Cell::Number(number.clone()),
                Cell::Words(Words::Below(limit)) => number::Cell::Below(limit.clone()),
                Cell::Words(Words::Quantity(number, unit)) => {
                    number::Cell::WithUnit(number.clone(), italic(self.spoken(*unit)))
                }
                other => number::Cell::Words(self.table_cell(other, false)),
            })),
        });
        let cells: Vec<Vec<Markup>> = cells.collect();
        let rows =
            (0..cells.first().map_or(0, Vec::len)).map(|row| cells.iter().map(|column| column[row].clone()).collect());
        let foot = |column: &&Column| column.foot.as_ref().map_or_else(Markup::default, |foot| foot(self));
        let has_foot = columns.iter().any(|column| column.foot.is_some());
        let written = parts::Table {
            caption: table.caption.as_ref().map(|caption| self.name(caption)),
            groups: table.groups.iter().map(|(count, words)| (*count, self.name(words))).collect(),
            headings: columns.iter().map(|column| self.name(&column.heading)).collect(),
            rows: rows.collect(),
            starts: table.starts.clone(),
            foot: if has_foot { columns.iter().map(foot).collect() } else { Vec::new() },
            row_headings: table.names,
            class: table.class,
        };
        written.markup(table.name.map_or("", |name| self.spoken(name)))
    }

    fn table_cell(&self, cell: &Cell, is_name: bool) -> Markup {
        match cell {
            Cell::Words(words) if is_name => self.name(words),
            Cell::Words(words) => self.cell(words),
            Cell::Drawn(markup) => markup.clone(),
        }
    }
}
