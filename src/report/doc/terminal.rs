//! Blocks as text for a terminal, in one language.

use super::{Block, Cell, Field, On, Table, Words};
use crate::report::{columns, style};
use crate::wording::Language;
use std::fmt::Write;

/// Returns words as those of a terminal.
pub(crate) fn said(words: &Words, language: Language) -> String {
    crate::wording::plain(&words.written(language, &|outcome, words| {
        outcome.map_or_else(|| style::heading(words), |outcome| style::marked(outcome, words))
    }))
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
            Block::Line(words) => columns::paragraph(out, "", &said(words, language)),
            Block::Lines(indent, lines) | Block::Whole(indent, lines) => {
                let cells = |line: &Vec<Words>| line.iter().map(|words| said(words, language)).collect();
                let most = if matches!(block, Block::Whole(..)) { usize::MAX } else { columns::TEXT_COLUMNS };
                columns::lines(out, indent, most, lines.iter().map(cells));
            }
            Block::Record(all) => record(out, all, language),
            Block::Table(of) => table(out, of, language),
            Block::Within(_, all) => text(out, all, language),
            Block::Gap => out.push('\n'),
            Block::List(all) => {
                let each = all.iter().map(|words| said(words, language)).collect::<Vec<_>>();
                columns::paragraph(out, "  ", &(each.join("; ") + "."));
            }
            Block::Boxed(..) | Block::Band(_) | Block::Note(..) | Block::Each(_) => {}
            Block::On(On::Page, _) | Block::Drawn(_) | Block::Key(_) => {}
            Block::On(_, block) => text(out, std::slice::from_ref(block), language),
        }
    }
}

/// Writes a line for each field; those to fill in by hand are for paper.
fn record(out: &mut String, all: &[Field], language: Language) {
    let lines = all.iter().map(|(name, value, _)| (said(&Words::from(*name), language), said(value, language)));
    columns::lines(
        out,
        "  ",
        columns::TEXT_COLUMNS,
        lines.filter(|(_, value)| !value.is_empty()).map(|(name, value)| vec![name, value]),
    );
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
    let rows: Vec<Vec<String>> = rows.collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    columns::table(out, table.names.max(1), &names, rows);
}
