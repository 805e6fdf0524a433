//! Text in columns that fits the terminal. Where there is none, lines have at most 100 characters. In a wider one, tables
//! use the width that they need, and sentences still have at most 100 characters.

use super::style;
use crate::text::excerpt::columns_of;
pub(crate) use crate::text::number::decimals;
use crate::text::printable;
use crate::wording::number::THIN_BLANK;
use std::fmt::Write;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Largest width of sentences, in however wide a terminal, because longer lines are hard to read; clap wraps help there too.
pub(crate) const TEXT_COLUMNS: usize = 100;

/// Width of a terminal on which nothing is made narrower still.
const LEAST_COLUMNS: usize = 40;

/// Width of the terminal, characters.
static COLUMNS: AtomicUsize = AtomicUsize::new(TEXT_COLUMNS);

/// Sets the width of the terminal, once, before anything is written.
pub(crate) fn set_width(columns: usize) {
    COLUMNS.store(columns.max(LEAST_COLUMNS), Ordering::Relaxed);
}

pub(crate) fn width() -> usize {
    COLUMNS.load(Ordering::Relaxed)
}

/// Appends a sentence or a paragraph after `indent`; further lines begin a hang further, so that each remark of several is
/// seen to begin.
pub(crate) fn paragraph(out: &mut String, indent: &str, words: &str) {
    out.push_str(indent);
    let indent = indent.chars().count();
    wrapped(out, indent, indent + HANG, words, width().min(TEXT_COLUMNS));
}

/// Appends lines in columns after `indent`. The last cell of a line goes on below its beginning; the cells before it are as wide
/// as the widest in their column. It is broken before `most` columns, if the terminal has the room, and never if that is the
/// largest number.
pub(crate) fn lines(out: &mut String, indent: &str, most: usize, lines: impl IntoIterator<Item = Vec<String>>) {
    let lines: Vec<Vec<String>> = lines.into_iter().collect();
    let before =
        |line: &Vec<String>, place: usize| Some(shown_columns(line.get(place)?)).filter(|_| place + 1 < line.len());
    let widest = |place: usize| lines.iter().filter_map(|line| before(line, place)).max().unwrap_or_default();
    let columns: Vec<usize> = (0..lines.iter().map(Vec::len).max().unwrap_or_default()).map(widest).collect();
    for line in &lines {
        let Some((last, names)) = line.split_last() else { continue };
        let mut text = indent.to_owned();
        for (name, columns) in names.iter().zip(&columns) {
            text += name;
            text.extend(std::iter::repeat_n(' ', columns + 2 - shown_columns(name)));
        }
        if last.is_empty() {
            text.truncate(text.trim_end().len());
        }
        let column = shown_columns(&text);
        out.push_str(&text);
        let most = if most == usize::MAX { most } else { width().min(column + most) };
        wrapped(out, column, column, last, most);
    }
}

/// Indent of the further lines of a sentence, relative to its first. A continued line keeps it in any case, so that no text
/// from elsewhere can look like a line of the program.
const HANG: usize = 2;

/// Beginning of a command that is printed to be run.
const COMMAND: &str = "dtg-passport ";

/// Returns the text with every line broken that is wider than `columns`. A line continues below its last column, a
/// sentence as in [`paragraph`]; either further left if a word needs the room. A command stays one line, to be copied.
pub(crate) fn fitted(text: &str, columns: usize) -> String {
    broken(text, 0, columns)
}

/// Returns a message as [`fitted`] does, with no line wider than a sentence; its lines continue at least `indent` characters
/// from the left.
pub(crate) fn hanging(text: &str, indent: usize, columns: usize) -> String {
    broken(text, indent, columns.min(TEXT_COLUMNS))
}

fn broken(text: &str, indent: usize, columns: usize) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.lines() {
        let words = line.trim_start_matches(' ');
        let (margin, shown) = (line.len() - words.len(), shown_columns(words));
        let from = line.char_indices().nth(indent).map_or(line.len(), |(at, _)| at);
        let at = from + last_column(&line[from..], columns.saturating_sub(indent));
        if margin + shown <= columns || words.starts_with(COMMAND) {
            out += &with_plain_spaces(line);
            out.push('\n');
        } else if HANG + shown <= columns && at == margin && !words.contains(' ') {
            let _ = writeln!(out, "{:HANG$}{words}", "");
        } else {
            out.push_str(&line[..at]);
            let column = shown_columns(&line[..at]);
            // An item goes on after its number, as in `3. Words`.
            let ordinal = words.split_once(". ").filter(|(number, _)| number.parse::<u8>().is_ok());
            let after = ordinal.map_or(HANG, |(number, _)| number.len() + ". ".len());
            let hang = if indent == 0 && at == margin { after } else { 0 };
            wrapped(&mut out, column, (column + hang).max(indent).max(HANG), &line[at..], columns);
        }
    }
    out
}

/// Returns the place in bytes after the last gap of two spaces or more behind which half of the `columns` remain, and
/// room for every word; or the line's indent.
fn last_column(line: &str, columns: usize) -> usize {
    let room =
        |words: &str| unbroken(words).iter().map(|word| shown_columns(word)).fold(columns.div_ceil(2), usize::max);
    // Spaces in what is quoted from a file are no gap.
    let after_gap = |at: &usize| {
        let before = &line[..*at];
        before.ends_with("  ") && !is_quoting(before) && shown_columns(before) + room(&line[*at..]) <= columns
    };
    let indent = line.len() - line.trim_start_matches(' ').len();
    line.match_indices(|c| c != ' ').map(|(at, _)| at).rfind(after_gap).unwrap_or(indent)
}

/// Returns `true` if a quotation between backquotes begins in a text and does not end in it.
fn is_quoting(text: &str) -> bool {
    text.matches('`').count() % 2 == 1
}

/// Returns the columns that a text takes in a terminal, in which emphasis takes none.
fn shown_columns(text: &str) -> usize {
    columns_of(&style::plain(text))
}

/// Returns words of a page without its non-breaking spaces; a terminal groups no digits.
pub(crate) fn with_plain_spaces(words: &str) -> String {
    words.replace('\u{A0}', " ").replace(THIN_BLANK, "")
}

/// Appends words from `column` on, broken at spaces before `columns`, but not between a number and its unit. Further lines
/// begin at `indent`, or further left if a word needs the room.
fn wrapped(out: &mut String, mut column: usize, indent: usize, words: &str, columns: usize) {
    for (index, word) in unbroken(words).iter().enumerate() {
        let width = shown_columns(word);
        let below = indent.min(columns.saturating_sub(width).max(HANG));
        if column + usize::from(index > 0) + width > columns && (index > 0 || below < column) {
            column = below;
            out.truncate(out.trim_end_matches(' ').len());
            let _ = write!(out, "\n{:column$}", "");
        } else if index > 0 {
            out.push(' ');
            column += 1;
        }
        // The non-breaking spaces have done their work in `unbroken`.
        out.push_str(&with_plain_spaces(word));
        column += width;
    }
    out.push('\n');
}

/// Splits a text into words; a short quotation between backquotes is one, such as a command to run. A unit belongs to the
/// word of its number, signs of equality and of uncertainty to both their sides, a symbol to its number, and a mark to
/// what it marks.
fn unbroken(text: &str) -> Vec<String> {
    const LONGEST_QUOTATION: usize = 48;
    const UNITS: [&str; 9] = ["%", "arcsec", "deg", "°/h", "mA", "µA", "m", "m/s2", "m/s²"];
    let mut words: Vec<String> = Vec::new();
    for word in text.split(' ') {
        let is_unit = UNITS.contains(&word.trim_end_matches([',', ';', '.', ':', ')'])) || word.starts_with("°/(");
        let is_number = word.starts_with(|c: char| c.is_ascii_digit() || "+-".contains(c));
        let belongs = |last: &str| {
            let plain = style::plain(last);
            let before = plain.rsplit([' ', '(']).next().unwrap_or_default();
            // An index of a position, such as (4, 3).
            let is_open = plain.rsplit(' ').next().is_some_and(|last| {
                last.strip_prefix('(').and_then(|last| last.strip_suffix(',')).is_some_and(|i| i.parse::<u32>().is_ok())
            });
            let is_symbol = before == "u" || before.starts_with("K_") || before.starts_with("ω_");
            matches!(word, "=" | "±")
                || before.ends_with(['=', '±', '●', '◐', '✕', '○'])
                || is_unit && before.ends_with(|c: char| c.is_numeric())
                || is_symbol && is_number
                || is_open && is_number
                || is_quoting(last) && shown_columns(last) + shown_columns(word) < LONGEST_QUOTATION
        };
        match words.last_mut().filter(|last| belongs(last)) {
            Some(last) => *last += &format!(" {word}"),
            None => words.push(word.to_owned()),
        }
    }
    words
}

/// Appends a table. Columns are as wide as their widest cell; numbers are aligned at their decimal points, words on the
/// left. If the terminal is too narrow, headings take several lines; columns that still have no room follow below, with
/// the first `heads` again.
pub(crate) fn table(out: &mut String, heads: usize, names: &[&str], rows: impl IntoIterator<Item = Vec<String>>) {
    let rows: Vec<Vec<String>> = rows.into_iter().collect();
    let all: Vec<Vec<String>> = (0..names.len())
        .map(|place| aligned(rows.iter().map(|row| row.get(place).map_or("", String::as_str)).collect()))
        .collect();
    let mut headings: Vec<Vec<String>> = names.iter().map(|name| vec![(*name).to_owned()]).collect();
    let needed = |headings: &[Vec<String>]| {
        headings.iter().zip(&all).map(|(heading, cells)| 2 + widest(heading).max(widest(cells))).sum::<usize>()
    };
    if needed(&headings) > width() {
        headings = names.iter().zip(&all).map(|(name, cells)| stacked(name, widest(cells))).collect();
    }
    let lines = headings.iter().map(Vec::len).max().unwrap_or(0);
    let columns: Vec<Vec<String>> =
        headings.into_iter().zip(all).map(|(heading, cells)| column(heading, lines, cells)).collect();
    let mut next = heads.min(columns.len());
    loop {
        let end = end_of_part(names, &columns, heads, next);
        let part: Vec<&Vec<String>> = columns.iter().take(heads).chain(&columns[next..end]).collect();
        for line in 0..lines + rows.len() {
            let cells: Vec<&str> = part.iter().map(|column| column[line].as_str()).collect();
            // A row that has nothing in the columns below is not repeated there.
            if line >= lines && next > heads && cells[heads..].iter().all(|cell| cell.trim().is_empty()) {
                continue;
            }
            let words = format!("  {}", cells.join("  ")).trim_end().to_owned();
            if line >= lines {
                let _ = writeln!(out, "{words}");
            } else if !words.is_empty() {
                let _ = writeln!(out, "{}", style::faint(&with_plain_spaces(&words)));
            }
        }
        next = end;
        if next >= columns.len() {
            break;
        }
    }
}

/// Returns the end of the columns from `next` on that fit next to the first `heads`; at least one does. A column `u` is
/// never parted from its value.
fn end_of_part(names: &[&str], columns: &[Vec<String>], heads: usize, next: usize) -> usize {
    let needed = |column: &Vec<String>| 2 + widest(column);
    let mut free = width().saturating_sub(columns.iter().take(heads).map(needed).sum());
    let mut end = next;
    while let Some(needed) = columns.get(end).map(needed).filter(|needed| *needed <= free || end == next) {
        free = free.saturating_sub(needed);
        end += 1;
    }
    // A difference in units of its uncertainty has its heading on one line.
    let belongs = |name: &&str| matches!(*name, "u" | "U" | "diff.\u{A0}/\u{A0}u");
    if names.get(end).is_some_and(belongs) && end > next + 1 { end - 1 } else { end }
}

fn widest(cells: &[String]) -> usize {
    cells.iter().map(|cell| shown_columns(cell)).max().unwrap_or(0)
}

/// Returns words in lines that are as narrow as `columns`, or as the longest word.
pub(crate) fn stacked(words: &str, columns: usize) -> Vec<String> {
    let columns = words.split(' ').map(shown_columns).max().unwrap_or(0).max(columns);
    let mut lines: Vec<String> = Vec::new();
    for word in words.split(' ') {
        match lines.last_mut().filter(|line| shown_columns(line) + 1 + shown_columns(word) <= columns) {
            Some(line) => *line += &format!(" {word}"),
            None => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Returns the cells of a column; plain numbers end with spaces so that their decimal points are in one line.
fn aligned(cells: Vec<&str>) -> Vec<String> {
    let decimals = |cell: &str| cell.find(['.', ',']).map_or(0, |point| cell.len() - point);
    let plain = |cell: &&str| cell.chars().all(|c| c.is_ascii_digit() || "+-.,".contains(c));
    let most = if cells.iter().all(plain) { cells.iter().map(|cell| decimals(cell)).max().unwrap_or(0) } else { 0 };
    let missing = |cell: &str| if cell.is_empty() { 0 } else { most.saturating_sub(decimals(cell)) };
    cells.iter().map(|cell| format!("{cell}{:1$}", "", missing(cell))).collect()
}

/// Returns a column, padded to one width: its heading in `lines` lines, then its cells; numbers are on the right.
fn column(heading: Vec<String>, lines: usize, cells: Vec<String>) -> Vec<String> {
    let is_word =
        |cell: &String| !cell.is_empty() && !cell.starts_with(|c: char| c.is_ascii_digit() || "+-<.".contains(c));
    let words = cells.iter().any(is_word);
    let above = std::iter::repeat_n(String::new(), lines - heading.len());
    let column: Vec<String> = above.chain(heading).chain(cells).collect();
    let width = widest(&column);
    let padded = column.into_iter().map(|cell| {
        let space = " ".repeat(width - shown_columns(&cell));
        if words { cell + &space } else { space + &cell }
    });
    padded.collect()
}

/// Returns a row of CSV according to RFC 4180, but with a line feed as its end; every cell is text on one line.
///
/// Spreadsheets recognise a formula by its first character, and a signer may choose that character. An apostrophe
/// before it makes the cell text. The same applies after a semicolon, because in many countries spreadsheets begin a
/// new cell there, even within quotes.
pub(crate) fn csv_row<'a>(separator: &str, cells: impl Iterator<Item = &'a str>) -> String {
    let quoted = |cell: &str| {
        let cell = neutral(&printable(cell));
        if cell.contains([',', '"', ';']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell }
    };
    cells.map(quoted).collect::<Vec<_>>().join(separator) + "\n"
}

/// Inserts an apostrophe wherever a spreadsheet would begin a formula; full-width signs can begin one too.
fn neutral(cell: &str) -> String {
    const FORMULA: [char; 10] = ['=', '+', '-', '@', '"', ';', '＝', '＋', '－', '＠'];
    let parts =
        cell.split(';').map(|part| if part.starts_with(FORMULA) { format!("'{part}") } else { part.to_owned() });
    let neutral = parts.collect::<Vec<_>>().join(";");
    if cell.starts_with(';') { format!("'{neutral}") } else { neutral }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand, with 40 columns: the gap in the quotation is no column of a table, and no line ends within it.
    #[test]
    fn a_quotation_stays_whole() {
        let words = "name: found `   model: \"SPS-2\"`, expected the next key of the passport";
        let due = "name: found `   model: \"SPS-2\"`,\n      expected the next key of the\n      passport\n";
        assert_eq!(hanging(words, 6, 40), due);
        assert_eq!(
            fitted("First run `keygen KEY --trust FILE` here", 24),
            "First run\n  `keygen KEY --trust FILE`\n  here\n"
        );
    }

    #[test]
    fn no_cell_is_a_formula() {
        for (cell, written) in [
            ("=1+1", "'=1+1"),
            ("-1", "'-1"),
            ("@a, b", "\"'@a, b\""),
            (";=1", "\"';'=1\""),
            ("a; b", "\"a; b\""),
            ("a;\"=1", "\"a;'\"\"=1\""),
            ("\t=1", "\\t=1"),
            ("＝1", "'＝1"),
            ("a-b", "a-b"),
        ] {
            assert_eq!(csv_row(",", [cell].into_iter()), format!("{written}\n"));
        }
    }

    #[test]
    fn a_number_stays_with_its_unit() {
        assert_eq!(unbroken("is 2 °/(h·mA); a 5 % b"), ["is", "2 °/(h·mA);", "a", "5 %", "b"]);
        assert_eq!(unbroken("of 4.6×10⁻⁹ °/(h·mA)"), ["of", "4.6×10⁻⁹ °/(h·mA)"]);
        assert_eq!(unbroken("U = 1.96 u = 0.022 °/h; a"), ["U = 1.96", "u = 0.022 °/h;", "a"]);
        let mut out = String::new();
        paragraph(&mut out, "", &format!("{}0.13 %", "word ".repeat(19)));
        assert_eq!(out.lines().last(), Some("  0.13 %"));
    }

    #[test]
    fn a_line_continues_below_its_last_column() {
        let due = "  ok  name  some words\n            and more\nshort\n";
        assert_eq!(fitted("  ok  name  some words and more\nshort\n", 25), due);
        // A word that needs the room begins further left, and a line that fits without its indent is moved.
        assert_eq!(fitted("  a  b 0123456789abcdef\n", 18), "  a  b\n  0123456789abcdef\n");
        assert_eq!(fitted("  a   b   0123456789abcdef\n", 18), "  a   b\n  0123456789abcdef\n");
        assert_eq!(fitted("        0123456789abcdef\n", 18), "  0123456789abcdef\n");
        // So does one that has no room below the last column, but below the one before.
        assert_eq!(fitted("● ok  id  0123456789abcdef\n", 25), "● ok  id\n      0123456789abcdef\n");
        // A command that is copied from a terminal would end at a line break.
        assert_eq!(fitted("  dtg-passport verify a.yaml\n", 10), "  dtg-passport verify a.yaml\n");
        // However long, no word begins a line.
        assert_eq!(fitted("a 0123456789abcdef\n", 10), "a\n  0123456789abcdef\n");
        let bold = style::heading("two words");
        assert_eq!(fitted(&format!("{bold} more"), 9), format!("{bold}\n  more\n"));
    }

    #[test]
    fn a_message_continues_below_its_last_column() {
        let due = "name: a ok  words and\n            more\n        short\n";
        assert_eq!(hanging("name: a ok  words and more\n        short\n", 6, 22), due);
    }

    #[test]
    fn what_has_no_room_follows_below() {
        let names = ["i", "j", "a", "u", "b", "u"];
        let columns: Vec<Vec<String>> = names.iter().map(|name| vec![(*name).to_owned(), "1".repeat(15)]).collect();
        // 100 columns hold five of 17; the fifth would be b without its u.
        assert_eq!(end_of_part(&names, &columns, 2, 2), 4);
        assert_eq!(end_of_part(&names, &columns, 2, 4), 6);
        // A row that has nothing there is not repeated.
        let row = |last: &str| vec!["n".repeat(66), "1".repeat(30), last.to_owned()];
        let mut out = String::new();
        table(&mut out, 1, &["", "a", "b"], [row(""), row("2.5")]);
        let ends: Vec<String> =
            style::plain(&out).lines().filter_map(|line| line.split(' ').next_back().map(str::to_owned)).collect();
        let ones = "1".repeat(30);
        assert_eq!(ends, ["a", &ones, &ones, "b", "2.5"]);
        assert_eq!(stacked("paper: change, %", 9), ["paper:", "change, %"]);
        assert_eq!(stacked("u", 9), ["u"]);
    }
}
