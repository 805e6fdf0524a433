//! Blocks as parts of a page.

use super::{Block, Cell, Column, On, Statement, Table, Words};
use crate::report::page::language::{Language, Languages};
use crate::report::page::number::{self, Number, column};
use crate::report::page::parts::{self, given, mark};
use crate::report::page::spacing::BLANK;
use crate::report::page::symbols::italic;
use crate::wording::{Piece, capital, pieces};
use maud::{Markup, html};

impl Words {
    /// Writes the words in one language of a page, as in a sentence.
    pub(crate) fn html(&self, language: Language, languages: &Languages) -> Markup {
        match self {
            Self::Text(text, values) => html! {
                @for piece in pieces(&text.words(language)) {
                    @match piece {
                        Piece::Words(words) => (italic(words)),
                        Piece::Name(name) => @for (_, value) in values.iter().filter(|(key, _)| *key == name) { (value.html(language, languages)) },
                    }
                }
            },
            Self::Either(page, _) => page.html(language, languages),
            Self::Whole(words) => words.html(language, languages),
            Self::Others(words) => html! { @if language != languages.first() { (words.html(language, languages)) } },
            Self::Marked(outcome, words) => html! { (mark(*outcome)) " " (words.html(language, languages)) },
            Self::OfLibrary(_, words) | Self::Padded(words, _) => words.html(language, languages),
            Self::Strong(words) => html! { strong { (words.html(language, languages)) } },
            Self::Capital(words) => italic(&capital(&words.plain(language))),
            Self::Told(words) => italic(&words.plain(language)),
            Self::All(all) => html! { @for one in all { (one.html(language, languages)) } },
            _ => self.cell(&language.into()),
        }
    }

    /// Writes the words once for all languages of a page, as in a cell: numbers in the first, texts side by side.
    pub(crate) fn cell(&self, languages: &Languages) -> Markup {
        match self {
            Self::Text(..) | Self::Capital(_) | Self::Whole(_) => languages.said(self, [" / ", ""], None),
            Self::Styled(class, words) => html! { span class=(class) { (words.label(languages)) } },
            Self::Inline(words) => words.cell(languages),
            Self::Number(number) => number.markup(languages),
            Self::Below(limit) => number::Cell::below(limit, languages),
            Self::Quantity(number, unit) => languages.quantity(number, *unit),
            Self::Symbol(name) => {
                let (letter, index) = name.split_once('_').unwrap_or((name, ""));
                parts::symbol(letter, index)
            }
            Self::Plain(words) => italic(words),
            Self::Given(words) => given(words),
            Self::Code(words) => html! { code { (words) } },
            Self::Date(date) => languages.date(*date),
            Self::Time(time) => languages.time(*time),
            Self::Coordinate(degrees, hemispheres) => languages.in_hemisphere(degrees.clone(), *hemispheres),
            Self::OfLibrary(_, words) | Self::Padded(words, _) => words.cell(languages),
            Self::Count(count) => Number::fixed(*count as f64, 0).markup(languages),
            Self::Told(words) => languages.label_with(|language| words.plain(language)),
            Self::Either(page, _) => page.cell(languages),
            Self::Marked(outcome, words) => html! { (mark(*outcome)) " " (words.cell(languages)) },
            Self::Strong(words) => html! { strong { (words.label(languages)) } },
            Self::First(words) => words.html(languages.first(), languages),
            Self::Others(_) => html! {},
            Self::OnTelephones(outcome) => html! { span.narrow-only { (mark(*outcome)) (BLANK) } },
            Self::Unseen(words) => html! { span.unseen { (words.label(languages)) } },
            Self::Blank => languages.blank(),
            Self::All(all) => html! { @for one in all { (one.cell(languages)) } },
        }
    }

    /// Writes a heading or a name: the second language smaller, below the first.
    pub(crate) fn label(&self, languages: &Languages) -> Markup {
        match self {
            Self::Text(..) | Self::Capital(_) | Self::Whole(_) => languages.said(self, [" ", ""], Some("second")),
            Self::Marked(outcome, words) => html! { (mark(*outcome)) " " (words.label(languages)) },
            Self::All(all) => html! { @for one in all { (one.label(languages)) } },
            Self::Strong(words) => html! { strong { (words.label(languages)) } },
            Self::Either(page, _) => page.label(languages),
            _ => self.cell(languages),
        }
    }
}

impl Languages {
    /// Writes a paragraph of words in each language.
    pub(crate) fn said_in_paragraph(&self, words: &Words) -> Markup {
        self.paragraph_with(|language| words.html(language, self))
    }

    fn said(&self, words: &Words, [before, after]: [&str; 2], class: Option<&str>) -> Markup {
        let sayings = self.sayings(|language| words.plain(language));
        html! {
            @for (index, (language, _)) in sayings.into_iter().enumerate() {
                @let other = index > 0;
                @if other { (before) }
                span class=[class.filter(|_| other)] lang=[(language != self.first()).then(|| language.tag())] { (words.html(language, self)) }
                @if other { (after) }
            }
        }
    }
}

pub(crate) fn blocks(blocks: &[Block], languages: &Languages) -> Markup {
    html! { @for block in blocks { (block.html(languages)) } }
}

impl Block {
    fn html(&self, languages: &Languages) -> Markup {
        match self {
            Self::Heading(words) => html! { h3 { (words.label(languages)) } },
            Self::Line(words) => languages.said_in_paragraph(words),
            Self::Said(Statement::Sentences(all)) if all.is_empty() => html! {},
            Self::Said(Statement::Sentences(all)) => languages.paragraph_with(|language| {
                html! { @for (place, one) in all.iter().enumerate() { @if place > 0 { " " } (one.html(language, languages)) } }
            }),
            Self::Said(Statement::Fields(all)) | Self::Record(all) if all.is_empty() => html! {},
            Self::Said(Statement::Fields(all)) | Self::Record(all) => html! {
                dl.fields { @for (name, value, wide) in all {
                    div class=[wide.then_some("wide")] { dt { (languages.label(*name)) } dd { (value.cell(languages)) } }
                } }
            },
            Self::Table(table) => table.html(languages),
            Self::Within(class, all) => html! { div class=(class) { (blocks(all, languages)) } },
            Self::Typed(_) | Self::Lines(..) | Self::Whole(..) => html! {},
            Self::Drawn(draw) => draw(languages),
            Self::Beside(block, None) => block.html(languages),
            Self::Beside(block, Some(draw)) => html! { div.with-figure { (block.html(languages)) (draw(languages)) } },
            Self::List(all) if all.is_empty() => html! {},
            Self::List(all) => html! { ul.absences { @for one in all { li { (one.label(languages)) } } } },
            Self::Boxed(class, headline, all) => html! {
                div class=(class) { p.headline { (headline.label(languages)) } (blocks(all, languages)) }
            },
            Self::Band(all) => html! {
                dl.band { @for (name, value, about) in all {
                    div { dt { (languages.label(*name)) } dd.large { (value.cell(languages)) } dd { (blocks(about, languages)) } }
                } }
            },
            Self::Note(class, words) => {
                html! { p class=[Some(class).filter(|class| !class.is_empty())] { (words.label(languages)) } }
            }
            Self::Each(words) => languages.lines_with(|language| words.html(language, languages)),
            Self::On(On::Terminal, _) => html! {},
            Self::On(_, block) => block.html(languages),
        }
    }
}

impl Table {
    fn html(&self, languages: &Languages) -> Markup {
        let columns: Vec<&Column> = self.columns.iter().filter(|column| column.on != On::Terminal).collect();
        let cells = columns.iter().enumerate().map(|(place, of)| match place < self.names {
            true => of.cells.iter().map(|cell| cell.html(languages, true)).collect(),
            false => column(
                languages,
                of.cells.iter().map(|cell| match cell {
                    Cell::Words(Words::Number(number)) => number::Cell::Number(number.clone()),
                    Cell::Words(Words::Below(limit)) => number::Cell::Below(limit.clone()),
                    Cell::Words(Words::Quantity(number, unit)) => {
                        number::Cell::WithUnit(number.clone(), italic(languages.spoken(*unit)))
                    }
                    other => number::Cell::Words(other.html(languages, false)),
                }),
            ),
        });
        let cells: Vec<Vec<Markup>> = cells.collect();
        let rows =
            (0..cells.first().map_or(0, Vec::len)).map(|row| cells.iter().map(|column| column[row].clone()).collect());
        let foot = |column: &&Column| column.foot.as_ref().map_or_else(Markup::default, |foot| foot(languages));
        let has_foot = columns.iter().any(|column| column.foot.is_some());
        let table = parts::Table {
            caption: self.caption.as_ref().map(|caption| caption.label(languages)),
            groups: self.groups.iter().map(|(count, words)| (*count, words.label(languages))).collect(),
            headings: columns.iter().map(|column| column.heading.label(languages)).collect(),
            rows: rows.collect(),
            starts: self.starts.clone(),
            foot: if has_foot { columns.iter().map(foot).collect() } else { Vec::new() },
            row_headings: self.names,
            class: self.class,
        };
        table.markup(self.name.map_or("", |name| languages.spoken(name)))
    }
}

impl Cell {
    fn html(&self, languages: &Languages, is_name: bool) -> Markup {
        match self {
            Self::Words(words) if is_name => words.label(languages),
            Self::Words(words) => words.cell(languages),
            Self::Drawn(markup) => markup.clone(),
        }
    }
}

impl number::Cell {
    fn below(limit: &number::Number, languages: &Languages) -> Markup {
        html! { "<" (BLANK) (limit.text(languages.first())) }
    }
}
