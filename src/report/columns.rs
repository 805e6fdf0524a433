//! Text in columns, at most 100 characters wide.

use super::style;
use crate::text::printable;
use std::fmt::Write;

/// Width of the terminal. Only a word or a row that cannot be broken is wider.
pub(crate) const COLUMNS: usize = 100;

/// Appends a paragraph with `indent` before every line.
pub(crate) fn paragraph(out: &mut String, indent: &str, words: &str) {
    out.push_str(indent);
    wrapped(out, indent.chars().count(), words);
}

/// Appends a name padded to `name_columns` and its value. Further lines of the value align with its beginning.
pub(crate) fn named(out: &mut String, name: &str, name_columns: usize, value: &str) {
    let _ = write!(out, "  {name:<name_columns$}");
    wrapped(out, 2 + name_columns, value);
}

/// Appends words from column `indent` on, broken at spaces, but not between a number and its unit.
fn wrapped(out: &mut String, indent: usize, words: &str) {
    let mut column = indent;
    for (index, word) in unbroken(words).iter().enumerate() {
        let width = word.chars().count();
        if index > 0 && column + 1 + width > COLUMNS {
            let _ = write!(out, "\n{:indent$}", "");
            column = indent;
        } else if index > 0 {
            out.push(' ');
            column += 1;
        }
        out.push_str(word);
        column += width;
    }
    out.push('\n');
}

/// Splits a text into words; a unit belongs to the word of its number.
fn unbroken(text: &str) -> Vec<String> {
    const UNITS: [&str; 9] = ["%", "arcsec", "deg", "°/h", "mA", "uA", "m", "m/s2", "m/s²"];
    let mut words: Vec<String> = Vec::new();
    for word in text.split(' ') {
        let is_unit = UNITS.contains(&word.trim_end_matches([',', ';', '.', ':', ')'])) || word.starts_with("°/(");
        match words.last_mut().filter(|last| is_unit && last.ends_with(|c: char| c.is_ascii_digit())) {
            Some(number) => *number += &format!(" {word}"),
            None => words.push(word.to_owned()),
        }
    }
    words
}

/// Appends a table. Columns are as wide as their widest cell, numbers are right-aligned.
pub(crate) fn table(out: &mut String, names: &[&str], rows: &[Vec<String>]) {
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count());
        cells.chain([names[column].chars().count()]).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..names.len()).map(width).collect();
    let line = |cells: &mut dyn Iterator<Item = &str>| {
        let padded: Vec<String> = cells.zip(&widths).map(|(cell, &width)| format!("{cell:>width$}")).collect();
        format!("  {}", padded.join("  ")).trim_end().to_owned()
    };
    let _ = writeln!(out, "{}", style::faint(&line(&mut names.iter().copied())));
    for row in rows {
        let _ = writeln!(out, "{}", line(&mut row.iter().map(String::as_str)));
    }
}

/// Returns a row of CSV according to RFC 4180, but with a line feed as its end; every cell is text on one line.
///
/// Spreadsheets recognise a formula by its first character, and a signer may choose that character. An apostrophe
/// before it makes the cell text. The same applies after a semicolon, because in many countries spreadsheets begin a
/// new cell there, even within quotes.
pub(crate) fn csv_row<'a>(cells: impl Iterator<Item = &'a str>) -> String {
    let quoted = |cell: &str| {
        let cell = neutral(&printable(cell));
        if cell.contains([',', '"', ';']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell }
    };
    cells.map(quoted).collect::<Vec<_>>().join(",") + "\n"
}

/// Inserts an apostrophe wherever a spreadsheet would begin a formula; full-width signs can begin one too.
fn neutral(cell: &str) -> String {
    const FORMULA: [char; 10] = ['=', '+', '-', '@', '"', ';', '＝', '＋', '－', '＠'];
    let parts =
        cell.split(';').map(|part| if part.starts_with(FORMULA) { format!("'{part}") } else { part.to_owned() });
    let neutral = parts.collect::<Vec<_>>().join(";");
    if cell.starts_with(';') { format!("'{neutral}") } else { neutral }
}

/// Returns the number of decimals, at most 12, that show the standard uncertainty `u` with two significant digits (GUM,
/// 7.2.6).
pub(crate) fn decimals(u: f64) -> usize {
    if !(u.is_finite() && u > 0.0) {
        return 6;
    }
    usize::try_from(1 - crate::text::number::exponent_as_printed(u, 2)).unwrap_or(0).min(12)
}

/// Formats a value with its sign; a value that rounds to zero has none.
pub(crate) fn signed(value: f64, decimals: usize) -> String {
    let printed = format!("{value:+.decimals$}");
    let is_zero = printed.chars().all(|c| matches!(c, '+' | '-' | '0' | '.'));
    if is_zero { format!("{:.decimals$}", 0.0) } else { printed }
}

/// Formats a probability with two digits, or as `< 1e-6`.
pub(crate) fn probability(p: f64) -> String {
    if p < 1e-6 {
        "< 1e-6".to_owned()
    } else if p < 0.01 {
        format!("{p:.1e}")
    } else {
        format!("{p:.2}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_uncertainty_has_two_digits() {
        for (u, decimals_due) in [(0.0123, 3), (0.0996, 2), (1.5, 1), (15.0, 0), (150.0, 0), (2.0e-5, 6)] {
            assert_eq!(decimals(u), decimals_due, "{u}");
        }
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
            assert_eq!(csv_row([cell].into_iter()), format!("{written}\n"));
        }
    }

    #[test]
    fn a_number_stays_with_its_unit() {
        assert_eq!(unbroken("is 2 °/(h·mA); a 5 % b"), ["is", "2 °/(h·mA);", "a", "5 %", "b"]);
        let mut out = String::new();
        paragraph(&mut out, "", &format!("{}0.13 %", "word ".repeat(19)));
        assert_eq!(out.lines().last(), Some("0.13 %"));
    }

    #[test]
    fn nothing_is_wider_than_a_terminal() {
        let mut out = String::new();
        paragraph(&mut out, "  ", &"word ".repeat(100));
        assert!(out.lines().all(|line| line.chars().count() <= COLUMNS && line.starts_with("  ")));
    }
}
