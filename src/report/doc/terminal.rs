//! Blocks as text for a terminal, in one language.

use super::{Block, Cell, Field, On, Table, Words};
use crate::report::page::language::Language;
use crate::report::{columns, style};
use std::fmt::Write;

fn said(words: &Words, language: Language) -> String {
    crate::wording::plain(&words.written(language, &style::marked))
}

/// Returns a statement as a sentence; `None` if nothing is said.
pub(crate) fn sentence(block: &Block, language: Language) -> Option<String> {
    match block {
        Block::Said(statement) => statement.sentence(language, &|words| said(words, language)),
        _ => None,
    }
}

/// Returns the blocks as text.
pub(crate) fn text(out: &mut String, blocks: &[Block], language: Language) {
    for block in blocks {
        match block {
            Block::Heading(words) => {
                let _ = writeln!(out, "\n{}", style::heading(&said(words, language)));
            }
            Block::Said(_) => {
                sentence(block, language).iter().for_each(|words| columns::paragraph(out, "  ", words));
            }
            Block::Record(all) => record(out, all, language),
            Block::Table(of) => table(out, of, language),
            Block::Within(_, all) => text(out, all, language),
            Block::Typed(lines) => out.push_str(lines),
            Block::Beside(block, _) => text(out, std::slice::from_ref(block), language),
            Block::List(all) => {
                let each = all.iter().map(|words| said(words, language)).collect::<Vec<_>>();
                columns::paragraph(out, "  ", &(each.join("; ") + "."));
            }
            Block::On(On::Page, _) | Block::Drawn(_) => {}
            Block::On(_, block) => text(out, std::slice::from_ref(block), language),
        }
    }
}

/// Writes a line for each field; those to fill in by hand are for paper.
fn record(out: &mut String, all: &[Field], language: Language) {
    let lines = all.iter().map(|(name, value, _)| (said(&Words::from(*name), language), said(value, language)));
    let lines: Vec<_> = lines.filter(|(_, value)| !value.is_empty()).collect();
    let longest = lines.iter().map(|(name, _)| name.chars().count()).max().unwrap_or_default();
    lines.iter().for_each(|(name, value)| columns::named(out, name, longest + 2, value));
}

fn table(out: &mut String, table: &Table, language: Language) {
    if let Some(caption) = &table.caption {
        columns::paragraph(out, "  ", &format!("{}:", said(caption, language)));
    }
    let shown: Vec<_> = table.columns.iter().filter(|column| column.on != On::Page).collect();
    let names: Vec<String> = shown.iter().map(|column| said(&column.heading, language)).collect();
    // A hyphen aligns with the numbers of its column.
    let cell = |cell: &Cell| match cell {
        Cell::Words(words) => Some(said(words, language)).filter(|said| said != "–").unwrap_or_else(|| "-".to_owned()),
        Cell::Drawn(_) => String::new(),
    };
    let rows = (0..shown.first().map_or(0, |column| column.cells.len()))
        .map(|row| shown.iter().map(|column| cell(&column.cells[row])).collect());
    columns::table(out, &names.iter().map(String::as_str).collect::<Vec<_>>(), rows);
}
