//! A document before it has a medium or a language: blocks of words, numbers and tables, composed once.
//!
//! * `html`: the document as part of a page.
//! * `terminal`: the document as text.

mod html;
mod terminal;

pub(crate) use crate::wording::words::{
    Counted, Field, Statement, Words, code, either, given, in_unit, joined, listed, longest, marked, padded,
    probability, range, strong, symbol, told, with,
};
pub(crate) use terminal::{said, sentence, text};

use super::page::language::Languages;
use super::picture::strips::{Axis, Key};
use crate::wording::texts::words;
use crate::wording::{Language, Outcome, Text};
use maud::Markup;

/// Medium that shows a block or a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum On {
    #[default]
    Both,
    Page,
    Terminal,
}

#[derive(Clone)]
pub(crate) enum Block {
    Heading(Words),
    /// A paragraph, or names and values; without any, nothing is written.
    Said(Statement),
    /// Names and values, in a terminal a line each.
    Record(Vec<Field>),
    Table(Table),
    /// Blocks in an element of this class.
    Within(&'static str, Vec<Block>),
    /// A sentence at the margin of a terminal, or the first line of a document; on a page a paragraph.
    Line(Words),
    /// Lines of a terminal in columns, each after the indent. The last cell of a line goes on below itself, and the cells
    /// before it are as wide as their column.
    Lines(&'static str, Vec<Vec<Words>>),
    /// As [`Block::Lines`], but broken only at a terminal: programs that read the output find whole ids and file names.
    Whole(&'static str, Vec<Vec<Words>>),
    /// An empty line of a terminal.
    Gap,
    /// Elements of a page alone, such as a figure, in its languages.
    Drawn(Drawn),
    /// On pages alone: what the marks of a picture mean.
    Key(Key),
    List(Vec<Words>),
    /// On pages alone: a headline and blocks about it in a box of this class.
    Boxed(&'static str, Words, Vec<Block>),
    /// On pages alone: a band of names, values in large letters, and blocks about them.
    Band(Vec<(Text, Words, Vec<Block>)>),
    /// On pages alone: a paragraph of this class, its second language smaller and below the first.
    Note(&'static str, Words),
    /// On pages alone: a paragraph in each language, one below the other.
    Each(Words),
    On(On, Box<Block>),
}

pub(crate) type Drawn = std::rc::Rc<dyn Fn(&Languages) -> Markup>;

pub(crate) fn heading(words: impl Into<Words>) -> Block {
    Block::Heading(words.into())
}

/// A paragraph of one text, of several, or of none.
pub(crate) fn say<W: Into<Words>>(all: impl IntoIterator<Item = W>) -> Block {
    Block::Said(Statement::of(all))
}

/// Names and values, in a terminal one sentence.
pub(crate) fn fields(all: impl IntoIterator<Item = Field>) -> Block {
    Block::Said(Statement::Fields(all.into_iter().collect()))
}

impl From<Statement> for Block {
    fn from(statement: Statement) -> Self {
        Self::Said(statement)
    }
}

pub(crate) fn line(words: impl Into<Words>) -> Block {
    Block::Line(words.into())
}

/// Returns the blocks as the text of a terminal.
pub(crate) fn typed(blocks: &[Block], language: Language) -> String {
    let mut out = String::new();
    text(&mut out, blocks, language);
    out
}

/// A field; what is not stated is left out.
pub(crate) fn field(name: Text, value: Option<impl Into<Words>>) -> Option<Field> {
    value.map(|value| (name, value.into(), false))
}

/// A field over the full width, for long texts.
pub(crate) fn wide(name: Text, value: Option<impl Into<Words>>) -> Option<Field> {
    value.map(|value| (name, value.into(), true))
}

pub(crate) fn record(fields: impl IntoIterator<Item = Option<Field>>) -> Block {
    Block::Record(fields.into_iter().flatten().collect())
}

/// An empty space to fill in by hand.
pub(crate) fn blank(name: Text) -> Option<Field> {
    Some((name, Words::Blank, false))
}

pub(crate) fn note(words: impl Into<Words>) -> Block {
    Block::Note("", words.into())
}

/// A headline with the mark of an outcome, and words about it, in the box of that outcome.
pub(crate) fn outcome_box(outcome: impl Into<Outcome>, headline: impl Into<Words>, words: Vec<Block>) -> Block {
    let outcome = outcome.into();
    let class = match outcome {
        Outcome::Passed => "verdict",
        Outcome::Failed => "verdict refused",
        Outcome::Undecided | Outcome::NotAsked => "verdict neutral",
    };
    Block::Boxed(class, marked(outcome, headline), words)
}

/// A value, or that the file does not state it: it is not to be completed by hand.
pub(crate) fn stated<W: Into<Words>>(value: Option<W>) -> Words {
    let not_stated = || Words::Inline(Box::new(words::NOT_STATED.into()));
    value.map_or_else(|| Words::Styled("absent", Box::new(not_stated())), Into::into)
}

pub(crate) fn drawn(draw: impl Fn(&Languages) -> Markup + 'static) -> Drawn {
    std::rc::Rc::new(draw)
}

impl Block {
    pub(crate) fn only(self, on: On) -> Self {
        Self::On(on, Box::new(self))
    }
}

#[derive(Clone, Default)]
pub(crate) struct Table {
    /// Name for screen readers; the caption, if there is no other.
    pub name: Option<Text>,
    pub caption: Option<Words>,
    pub class: &'static str,
    /// Number of columns with the names of the rows.
    pub names: usize,
    pub columns: Vec<Column>,
    /// Headings over several columns after the names: number of columns, and heading, empty over columns that have none.
    pub groups: Vec<(usize, Words)>,
    /// Rows with which a group begins.
    pub starts: Vec<usize>,
}

#[derive(Clone)]
pub(crate) struct Column {
    pub heading: Words,
    pub cells: Vec<Cell>,
    /// Axis below the cells.
    pub foot: Option<Axis>,
    pub on: On,
}

#[derive(Clone)]
pub(crate) enum Cell {
    Words(Words),
    Drawn(Markup),
}

/// A table that is built column by column from its rows.
pub(crate) struct Rows<'a, T> {
    rows: &'a [T],
    pub table: Table,
}

impl<'a, T> Rows<'a, T> {
    pub(crate) fn of(rows: &'a [T], class: &'static str) -> Self {
        Self { rows, table: Table { class, ..Table::default() } }
    }

    pub(crate) fn named<W: Into<Words>>(mut self, heading: impl Into<Words>, name: impl Fn(&T) -> W) -> Self {
        self.table.names += 1;
        self.column(heading, name)
    }

    pub(crate) fn column<W: Into<Words>>(mut self, heading: impl Into<Words>, cell: impl Fn(&T) -> W) -> Self {
        let cells = self.rows.iter().map(|row| Cell::Words(cell(row).into())).collect();
        self.table.columns.push(Column { heading: heading.into(), cells, foot: None, on: On::Both });
        self
    }

    /// Adds a column of strips with their axis.
    pub(crate) fn strips(mut self, heading: impl Into<Words>, strip: impl Fn(&T) -> Markup, axis: Axis) -> Self {
        let cells = self.rows.iter().map(|row| Cell::Drawn(strip(row))).collect();
        self.table.columns.push(Column { heading: heading.into(), cells, foot: Some(axis), on: On::Page });
        self
    }

    /// Begins a group with each row whose value differs from that of the row before.
    pub(crate) fn grouped_by<K: PartialEq>(mut self, value: impl Fn(&T) -> K) -> Self {
        let differs = |row: &usize| value(&self.rows[*row]) != value(&self.rows[row - 1]);
        self.table.starts = (1..self.rows.len()).filter(differs).collect();
        self
    }

    /// Leaves the last column out unless `is`.
    pub(crate) fn only_if(mut self, is: bool) -> Self {
        if !is {
            self.table.columns.pop();
        }
        self
    }

    /// Shows the last column in one medium only.
    pub(crate) fn on(mut self, on: On) -> Self {
        self.table.columns.last_mut().into_iter().for_each(|column| column.on = on);
        self
    }

    /// Returns the table without a caption.
    pub(crate) fn called(self, name: Text) -> Block {
        Block::Table(Table { name: Some(name), ..self.table })
    }

    pub(crate) fn captioned(self, name: Text, caption: impl Into<Words>) -> Block {
        Block::Table(Table { name: Some(name), caption: Some(caption.into()), ..self.table })
    }
}
