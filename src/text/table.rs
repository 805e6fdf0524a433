//! Tables of numbers (CSV): a header of column names in any order, `#` comments, and every error with its location.
//!
//! Tables come from a meter's software or a spreadsheet and are not signed. CR LF and a byte order mark, which such
//! programs write, are therefore accepted, and so are empty cells at the end of a line and a first line `sep=;`. An
//! unknown column is ignored and reported, unless its name looks like a misspelt one. Semicolons or tabs between the
//! columns are accepted and reported, and with them decimal commas if the whole file has them; anything in between is
//! refused, because its meaning depends on the country of the reader.

use super::kind::mistaken;
use super::node::{hand_written_text, odd, without_byte_order_mark};
use super::problem::{MOST_COUNTED, MOST_PROBLEMS, counted};
use super::{Advice, Kind, Location, Node, Problem, RefusalCause, Unreadable};
use super::{advice, misspelt};
use std::cmp::Reverse;
use std::ops::Range;

/// Table: rows of cells, in the order of the requested columns.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Table<'a> {
    name: &'a str,
    bytes: &'a [u8],
    columns: Vec<&'a str>,
    /// Rows in the order of the text.
    pub rows: Vec<Row>,
    left_out: Vec<String>,
    /// How a file with semicolons or tabs between the columns was read; `None` with commas between them.
    separated: Option<String>,
}

/// Cells, one for each requested column that is present.
pub(crate) type Row = Vec<Cell>;

/// Cell: its text without surrounding spaces, and its location.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Cell {
    /// Text, without the quotes of a quoted cell.
    pub text: String,
    pub location: Location,
}

impl<'a> Table<'a> {
    /// Reads the table `name` with the columns of indices and the measured ones, whose numbers may have decimals; those of the
    /// third list are optional. They may be in any order.
    ///
    /// # Errors
    /// Returns [`Unreadable`] with every error in the form. The caller checks the content of the cells.
    pub(crate) fn read(name: &'a str, bytes: &'a [u8], columns: [&[&'a str]; 3]) -> Result<Self, Unreadable> {
        Self::parse(name, bytes, columns).map_err(|unreadable| {
            let expected = if columns[1].contains(&"jx_ma") { Kind::Currents } else { Kind::Angles };
            let other = mistaken(name, bytes, expected.words(), |kind| kind == expected);
            other.unwrap_or_else(|| unreadable.in_text(bytes))
        })
    }

    fn parse(name: &'a str, bytes: &'a [u8], columns: [&[&'a str]; 3]) -> Result<Self, Unreadable> {
        let [indices, measured, _] = columns;
        let known = &columns.concat()[..];
        let range = indices.len()..indices.len() + measured.len();
        let required = &known[..range.end];
        let header = || format!("a table with the header {}", required.join(","));
        if without_byte_order_mark(bytes).is_empty() {
            let advice = "the file may be truncated; copy it again";
            return Err(Unreadable::whole(name, None, "an empty file", header(), advice));
        }
        let text = hand_written_text(name, bytes)?;
        let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line)).filter(|(_, line)| {
            let line = line.trim();
            !line.is_empty() && !is_comment(line)
        });
        let mut first = lines.next();
        let declared = first.and_then(|(_, line)| declared_separator(line));
        if declared.is_some() {
            first = lines.next();
        }
        let Some(first) = first else {
            return Err(Unreadable::whole(name, None, "only spaces and comments", header(), ""));
        };
        let separator = declared.unwrap_or_else(|| separator_of(first.1, known));
        let header = Header::read(name, first, separator, known, range.clone())?;
        let (mut problems, mut rows) = (Vec::new(), Vec::new());
        for line in lines {
            match header.examined(line) {
                Ok(row) => rows.extend(row),
                Err(problem) => problems.push(problem),
            }
            if problems.len() >= MOST_COUNTED {
                break;
            }
        }
        if problems.is_empty() && separator == ',' && !measured.is_empty() {
            problems.extend(split_numbers(&rows, range));
        }
        let mut rows: Vec<Row> = rows.into_iter().map(|(row, _)| row).collect();
        let Header { columns, left_out, .. } = header;
        let mut separated = None;
        if problems.is_empty() && separator != ',' {
            match with_decimal_points(&mut rows, &columns) {
                Ok(and) => separated = Some(format!("read with {} between columns{and}", in_words(separator))),
                Err(problem) => problems.push(problem),
            }
        }
        let table = Self { name, bytes, columns, rows, left_out, separated };
        if problems.is_empty() {
            problems.extend(table.with_thousands(measured));
        }
        if problems.is_empty() { Ok(table) } else { Err(Unreadable::of(name, counted(problems, kind))) }
    }

    /// Returns a remark on how the table was understood, if it has decimal commas or ignored columns, otherwise `None`.
    pub(crate) fn remark(&self) -> Option<String> {
        let names: Vec<String> = self.left_out.iter().map(|name| format!("{name:?}")).collect();
        let (words, are) = if names.len() == 1 { ("column", "is") } else { ("columns", "are") };
        let ignored = (!names.is_empty()).then(|| format!("the {words} {} {are} ignored", names.join(", ")));
        let remarks: Vec<String> = self.separated.clone().into_iter().chain(ignored).collect();
        (!remarks.is_empty()).then(|| format!("{}: {}", self.name, remarks.join("; ")))
    }

    /// Returns the index of a column in the cells of a row, or `None` for an optional column that is absent.
    pub(crate) fn place(&self, column: &str) -> Option<usize> {
        self.columns.iter().position(|name| *name == column)
    }

    /// Returns the finite number in a cell, or adds an error to `problems` and returns `None`. `not_taken` is the advice on
    /// a reading that was not taken, for which instruments and spreadsheets write many words.
    pub(crate) fn number(&self, row: &Row, column: usize, not_taken: &str, problems: &mut Vec<Problem>) -> Option<f64> {
        let cell = &row[column];
        let value = cell.text.parse::<f64>().ok().filter(|value| value.is_finite());
        if value.is_none() {
            let advice = advice::on_cell(&cell.text, not_taken);
            problems.push(self.problem(cell, column, described(&cell.text), "a number", advice));
        }
        value
    }

    /// Returns the whole number, 1 or larger, in a cell, or adds an error to `problems` and returns `None`. Some programs
    /// write it as 1.000.
    pub(crate) fn index(&self, row: &Row, column: usize, problems: &mut Vec<Problem>) -> Option<u32> {
        let cell = &row[column];
        let is_index = |value: &f64| value.fract() == 0.0 && (1.0..=f64::from(u32::MAX)).contains(value);
        let index = cell.text.parse::<f64>().ok().filter(is_index).map(|index| index as u32);
        if index.is_none() {
            let advice = match cell.text.parse::<f64>() {
                Ok(0.0) => "count from 1".into(),
                Ok(_) => Advice::default(),
                Err(_) => advice::on_cell(&cell.text, ""),
            };
            problems.push(self.problem(cell, column, described(&cell.text), "a whole number of 1 or more", advice));
        }
        index
    }

    /// Creates the report of an error in a cell.
    pub(crate) fn problem(
        &self,
        cell: &Cell,
        column: usize,
        found: String,
        expected: &str,
        advice: impl Into<Advice>,
    ) -> Problem {
        Problem::new(Some(cell.location), column_name(&self.columns, column), found, expected, advice)
    }

    /// Returns the problem of a table in which the points in `columns` seem to be thousands separators, as in 1.064 for 1064:
    /// each is before exactly three digits, no number is below 1, and other numbers are whole.
    fn with_thousands(&self, columns: &[&str]) -> Option<Problem> {
        let places: Vec<usize> = columns.iter().filter_map(|column| self.place(column)).collect();
        let cells = || self.rows.iter().flat_map(|row| places.iter().map(move |&place| (place, &row[place])));
        let is_grouped = |cell: &Cell| {
            cell.text.trim_start_matches(['+', '-']).split_once('.').is_some_and(|(before, after)| {
                let has_digits = |part: &str| part.bytes().all(|digit| digit.is_ascii_digit());
                let is_group = (1..=3).contains(&before.len()) && !before.starts_with('0') && after.len() == 3;
                is_group && has_digits(before) && has_digits(after)
            })
        };
        let is_small_and_whole =
            |cell: &Cell| cell.text.parse::<i32>().is_ok_and(|number| (1..1000).contains(&number.abs()));
        let mut with_point = cells().filter(|(_, cell)| cell.text.contains('.'));
        let (place, first) = with_point.next().filter(|(_, cell)| is_grouped(cell))?;
        if !with_point.all(|(_, cell)| is_grouped(cell)) || !cells().any(|(_, cell)| is_small_and_whole(cell)) {
            return None;
        }
        let advice = "every point is before exactly three digits, and other numbers are whole: save the table again without \
                      thousands separators, or, if the points are decimal, with all decimals in every number";
        let expected = "a number that can be read in one way";
        Some(self.problem(first, place, described(&first.text), expected, (RefusalCause::Thousands, advice)))
    }

    /// Returns the refusal of this table. If many cells need the same advice, only the first is shown, with the number
    /// of others.
    pub(crate) fn refuse(&self, problems: Vec<Problem>) -> Unreadable {
        Unreadable::of(self.name, counted(problems, kind)).in_text(self.bytes)
    }
}

fn column_name<'a>(columns: &[&'a str], place: usize) -> &'a str {
    columns.get(place).copied().unwrap_or_default()
}

/// Returns the kind of an error in a cell or a row; `None` for errors of the whole table, of which each is shown.
fn kind(problem: &Problem) -> Option<(bool, String, String)> {
    problem.location?;
    Some((problem.field.is_empty(), problem.expected.clone(), problem.advice.clone()))
}

/// Returns `true` for a line that begins with `#`, also in quotes, which spreadsheet programs put around a cell with a comma.
fn is_comment(line: &str) -> bool {
    let quoted = line.strip_prefix('"').filter(|rest| !rest.starts_with("#\""));
    quoted.unwrap_or(line).starts_with('#')
}

/// Returns the separator that a line `sep=;` of a spreadsheet program declares, or `None` for any other line.
fn declared_separator(line: &str) -> Option<char> {
    let line = line.trim().trim_matches('"');
    let declared = line.get(..4).filter(|start| start.eq_ignore_ascii_case("sep=")).map(|_| line[4..].chars());
    let mut characters = declared?;
    characters.next().filter(|separator| ",;\t".contains(*separator) && characters.next().is_none())
}

/// Returns the cells without the empty ones beyond the columns of the header, which spreadsheet programs add.
fn without_trailing(mut cells: Vec<Cell>, columns: usize) -> Vec<Cell> {
    while cells.len() > columns && cells.last().is_some_and(|cell| cell.text.is_empty()) {
        cells.pop();
    }
    cells
}

/// Replaces the decimal commas of a table that has no commas between its columns, and returns the end of the remark on it.
/// Commas are decimal marks only if the whole table has no decimal point.
fn with_decimal_points(rows: &mut [Row], columns: &[&str]) -> Result<&'static str, Problem> {
    let comma = rows.iter().flatten().find(|cell| cell.text.contains(',')).cloned();
    let Some(comma) = comma else { return Ok("") };
    for (place, cell) in rows.iter().flat_map(|row| row.iter().enumerate()) {
        if cell.text.contains('.') {
            let found = format!("{:?}, with decimal commas from line {} on", cell.text, comma.location.line);
            let expected = "decimal commas or decimal points in the whole file";
            let advice = match cell.text.contains(',') {
                true => (RefusalCause::Thousands, "save the table again without thousands separators"),
                false => (RefusalCause::DecimalComma, "save the table again with decimal points"),
            };
            return Err(Problem::new(Some(cell.location), column_name(columns, place), found, expected, advice));
        }
    }
    // What is not a number is quoted as it was written.
    for cell in rows.iter_mut().flatten() {
        let number = cell.text.replacen(',', ".", 1);
        if number.parse::<f64>().is_ok() {
            cell.text = number;
        }
    }
    Ok(" and decimal commas")
}

/// Largest number of cells in a row: that of spreadsheet programs.
const MOST_CELLS: usize = 16_384;

/// Returns the cells of a line. A quoted cell may contain separators, and quotes written twice (RFC 4180).
fn cells(line: usize, text: &str, separator: char) -> Result<Vec<Cell>, Problem> {
    let mut cells = Vec::new();
    let mut rest = Some(text);
    // Counted from cell to cell: counted from the beginning of the line, a long row would take the square of its length.
    let mut column = 1;
    let blank = |c: char| c.is_whitespace() && c != separator;
    while let Some(here) = rest {
        let start = here.trim_start_matches(blank);
        column += here[..here.len() - start.len()].chars().count();
        let location = Location { line, column };
        if cells.len() == MOST_CELLS {
            let (found, expected) = (format!("more than {MOST_CELLS} values in a row"), "a row of a table");
            return Err(Problem::new(Some(location), "", found, expected, "check that this is the right file"));
        }
        let (cell, after) = match start.strip_prefix('"') {
            Some(quoted) => quoted_cell(quoted, separator).ok_or_else(|| {
                let found = "a quoted cell without a closing quote before a comma or the end of the line";
                let advice = "write the cell on one line, because a line break in it ends the row";
                Problem::new(Some(location), "", found, "\"…\", with each inner quote doubled", advice)
            })?,
            None => {
                let end = start.find(separator).unwrap_or(start.len());
                (start[..end].trim_end_matches(blank).to_owned(), &start[end..])
            }
        };
        cells.push(Cell { text: cell, location });
        column += start[..start.len() - after.len()].chars().count() + 1;
        rest = after.strip_prefix(separator);
    }
    Ok(cells)
}

/// Returns the text of a quoted cell, given from after its first quote, and the rest of the line: nothing, or a
/// separator and more. Returns `None` if the last quote is missing or something else follows it.
fn quoted_cell(quoted: &str, separator: char) -> Option<(String, &str)> {
    let (mut text, mut rest) = (String::new(), quoted);
    loop {
        let end = rest.find('"')?;
        text.push_str(&rest[..end]);
        rest = &rest[end + 1..];
        match rest.strip_prefix('"') {
            Some(more) => rest = more,
            None => break,
        }
        text.push('"');
    }
    let after = rest.trim_start_matches(|c: char| c.is_whitespace() && c != separator);
    (after.is_empty() || after.starts_with(separator)).then(|| (text.trim().to_owned(), after))
}

/// Separators of columns with their names, in the order in which a header is searched for them.
const SEPARATORS: [(char, &str); 3] = [(',', "commas"), (';', "semicolons"), ('\t', "tabs")];

fn in_words(separator: char) -> &'static str {
    SEPARATORS.iter().find(|(known, _)| *known == separator).map_or("", |(_, words)| words)
}

/// Returns the separator that gives the most known columns, the first of equal ones.
fn separator_of(header: &str, known: &[&str]) -> char {
    let found = SEPARATORS.iter().map(|(separator, _)| *separator).filter(|it| header.contains(*it));
    found.min_by_key(|it| Reverse(count_known(header.split(*it), known))).unwrap_or(',')
}

fn count_known<'h>(cells: impl Iterator<Item = &'h str>, known: &[&str]) -> usize {
    cells.filter(|cell| known.contains(&cell.trim().trim_matches('"'))).count()
}

/// Cells of a row that are used, and the count of numbers in further columns that decimal commas may have put there.
type Examined = (Row, usize);

/// Returns the problem of a table in which decimal commas seem to have split the numbers: every measured number is whole, and
/// further columns contain as many numbers as there are channels, or at least one where a channel has single digits alone.
fn split_numbers(rows: &[Examined], measured: Range<usize>) -> Option<Problem> {
    let is_digit = |cell: &Cell| matches!(cell.text.as_bytes(), [b'0'..=b'9']);
    let has_digits_alone = |&column: &usize| rows.iter().all(|(row, further)| *further > 0 && is_digit(&row[column]));
    let first = rows.iter().find(|(_, further)| *further >= measured.len());
    let (row, further) =
        first.or_else(|| rows.first().filter(|_| measured.clone().skip(1).any(|at| has_digits_alone(&at))))?;
    let is_whole = rows.iter().all(|(row, _)| is_without_point(&row[measured.clone()]));
    is_whole.then(|| split_row(row[0].location.line, *further))
}

fn split_row(line: usize, further: usize) -> Problem {
    let plural = if further == 1 { "" } else { "s" };
    let found = format!("measured numbers without a decimal point, and {further} number{plural} in further columns");
    let advice = "use decimal points, because a decimal comma splits a number in two; write a whole number as 12.0";
    let at = Location { line, column: 1 };
    Problem::new(Some(at), "", found, "decimal points in the measured numbers", (RefusalCause::DecimalComma, advice))
}

fn is_without_point(cells: &[Cell]) -> bool {
    cells.iter().all(|cell| !cell.text.contains('.'))
}

/// Beginnings of the names of statistics: English, Russian, German.
const STATISTICS: &str = "mean average avg std stdev sd median total sum min max rms средн ско сумм мин макс mittel";

struct Header<'a> {
    /// Requested columns that are present.
    columns: Vec<&'a str>,
    /// Index of each of these columns in a line.
    order: Vec<usize>,
    left_out: Vec<String>,
    /// Names of all columns, in the order of a line.
    names: Vec<String>,
    /// Number of cells of the header, with the empty ones at its end.
    written: usize,
    /// Range of the measured columns in `columns` and `order`.
    measured: Range<usize>,
    separator: char,
}

impl<'a> Header<'a> {
    fn read(
        name: &str,
        (line, header): (usize, &str),
        separator: char,
        known: &[&'a str],
        measured: Range<usize>,
    ) -> Result<Self, Unreadable> {
        let required = &known[..measured.end];
        let at = Location { line, column: 1 };
        let expected = || format!("the header {} (columns in any order)", required.join(","));
        // Decimal commas in a row of numbers, or commas in a title, do not separate columns.
        let parts = || header.split([',', ';', '\t']);
        if parts().all(|part| part.trim().is_empty() || part.trim().parse::<f64>().is_ok()) {
            let found = "numbers instead of the header";
            return Err(Unreadable::whole(name, Some(at), found, expected(), "add the header"));
        }
        let other = SEPARATORS.iter().find(|(other, _)| *other != separator && header.contains(*other));
        if let Some((_, and)) =
            other.filter(|_| count_known(parts(), known) > count_known(header.split(separator), known))
        {
            let found = format!("columns separated by {} and {and}", in_words(separator));
            let advice = "save as CSV with commas between columns and decimal points in numbers";
            return Err(Unreadable::whole(name, Some(at), found, expected(), advice));
        }
        if header.split(separator).nth(MOST_PROBLEMS).is_some() {
            let found = format!("{} columns", header.split(separator).count());
            return Err(Unreadable::whole(name, Some(at), found, expected(), "check that this is the right file"));
        }
        let cells = cells(line, header, separator).map_err(|problem| Unreadable::of(name, vec![problem]))?;
        let written = cells.len();
        let cells = without_trailing(cells, 1);
        let mut problems = Vec::new();
        let mut left_out = Vec::new();
        // A comma before the unit, as in `Jx, mA`, makes two cells of a name.
        let with_unit = |index: usize| {
            let [name, unit] = cells.get(index..index + 2)? else { return None };
            advice::on_name(known, &format!("{}, {}", name.text, unit.text))
        };
        for (index, cell) in cells.iter().enumerate() {
            let mut problem = |found: String, advice: Advice| {
                problems.push(Problem::new(Some(cell.location), "", found, expected(), advice));
            };
            if known.contains(&cell.text.as_str()) {
                if cells[..index].iter().any(|earlier| earlier.text == cell.text) {
                    problem(format!("duplicate column {:?}", cell.text), Advice::default());
                }
            } else if let Some(advice) = advice::on_name(known, &cell.text).or_else(|| with_unit(index)) {
                problem(format!("column {:?}", cell.text), advice);
            } else if let Some(column) = meant(known, &cell.text) {
                let advice = Advice::from(misspelt::question(column)).meaning(column);
                problem(format!("column {:?}", cell.text), advice);
            } else {
                left_out.push(cell.text.clone());
            }
        }
        let place = |column: &&str| cells.iter().position(|cell| cell.text == *column);
        // A column that only has another name is named there.
        let is_named = |column: &&&str| problems.iter().any(|problem| problem.means(column));
        let missing = required.iter().filter(|column| place(column).is_none() && !is_named(column));
        let missing: Vec<&str> = missing.copied().collect();
        if !missing.is_empty() {
            let plural = if missing.len() > 1 { "s" } else { "" };
            let found = format!("no column{plural} {}", missing.join(", "));
            let advice = match left_out.is_empty() {
                true => String::new(),
                false if cells.len() == 1 && count_known(cells[0].text.split(','), known) > 1 => {
                    "each row is one quoted cell; import the table again with commas between columns, and save it"
                        .to_owned()
                }
                false if count_known(header.split_whitespace(), known) > 1 => {
                    "separate columns by commas, semicolons or tabs, not by spaces".to_owned()
                }
                false if missing.len() == required.len() => "put # before the lines above the header".to_owned(),
                false => {
                    let others: Vec<String> = left_out.iter().map(|name| format!("{name:?}")).collect();
                    format!("if one of the columns {} is meant, rename it and convert its numbers", others.join(", "))
                }
            };
            problems.push(Problem::new(Some(at), "", found, expected(), advice));
        }
        if !problems.is_empty() {
            return Err(Unreadable::of(name, problems));
        }
        let (columns, order) = known.iter().filter_map(|column| Some((*column, place(column)?))).unzip();
        let names = cells.into_iter().map(|cell| cell.text).collect();
        Ok(Self { columns, order, left_out, names, written, measured, separator })
    }

    /// Returns the cells of a row that are used; `None` for an empty row. Spreadsheet programs omit separators at the end of a
    /// row, so cells of other columns may be missing there.
    fn examined(&self, (line, text): (usize, &str)) -> Result<Option<Examined>, Problem> {
        let cells = cells(line, text, self.separator)?;
        let written = cells.len();
        let cells = without_trailing(cells, self.names.len());
        if cells.iter().all(|cell| cell.text.is_empty()) {
            return Ok(None);
        }
        if let Some((found, cause)) = self.not_readings(&cells) {
            return Err(Problem::new(Some(Location { line, column: 1 }), "", found, "readings", cause));
        }
        if cells.len() > self.names.len() || !self.has_used(cells.len()) {
            return Err(self.wrong_number_of_cells((line, text), &cells));
        }
        let is_further = |place: &usize| !self.order.contains(place) && cells[*place].text.parse::<f64>().is_ok();
        let from_measured = self.first_measured()..cells.len();
        let further = match self.separator == ',' && has_split_number(&cells[from_measured.clone()]) {
            true => from_measured.clone().filter(is_further).count(),
            false => 0,
        };
        let row: Row = self.order.iter().map(|&place| cells[place].clone()).collect();
        let has_rest = || cells[from_measured].iter().any(|cell| cell.text.len() > 1 && is_rest(&cell.text, "0"));
        if further > 0 && is_without_point(&row[self.measured.clone()]) && (written != self.written || has_rest()) {
            return Err(split_row(line, further));
        }
        Ok(Some((row, further)))
    }

    /// Describes a row of names, units or statistics instead of readings, with its cause; `None` for any other row.
    fn not_readings(&self, cells: &[Cell]) -> Option<(&'static str, RefusalCause)> {
        let is_name = |name: &&str| cells.iter().any(|cell| cell.text.trim_start_matches('\u{FEFF}') == *name);
        let measured = self.order[self.measured.clone()].iter().filter_map(|place| cells.get(*place));
        let indices = self.order[..self.measured.start].iter().filter_map(|place| cells.get(*place));
        let mut left = cells.iter().take(self.first_measured());
        let is_number = |cell: &Cell| cell.text.parse::<f64>().is_ok();
        let is_blank = |cell: &Cell| cell.text.chars().all(|c| "-–—".contains(c));
        let is_unit = |cell: &Cell| advice::unit(&cell.text).is_some();
        let is_statistic = |cell: &Cell| {
            let word = cell.text.to_lowercase();
            STATISTICS.split_whitespace().any(|statistic| word.starts_with(statistic))
        };
        if self.columns[..self.measured.end].iter().all(is_name) {
            Some(("the header again", RefusalCause::RepeatedHeader))
        } else if measured.clone().any(is_unit) && measured.clone().all(|cell| is_unit(cell) || is_blank(cell)) {
            Some(("a row of units", RefusalCause::UnitsRow))
        } else if indices.clone().any(is_statistic) || !indices.clone().any(is_number) && left.any(is_statistic) {
            Some(("a row of a statistic", RefusalCause::SummaryRow))
        } else {
            None
        }
    }

    /// Returns the first place of a measured column in a line.
    fn first_measured(&self) -> usize {
        self.order[self.measured.clone()].iter().copied().min().unwrap_or_default()
    }

    /// Returns `true` if the first `found` cells are those of all columns that are used.
    fn has_used(&self, found: usize) -> bool {
        self.order.iter().all(|place| *place < found)
    }

    /// Creates the report of a row that has another number of cells than the header.
    fn wrong_number_of_cells(&self, (line, text): (usize, &str), cells: &[Cell]) -> Problem {
        let separator = self.separator;
        let (names, found, at) = (&self.names, cells.len(), Some(Location { line, column: 1 }));
        if let Some((found, cause)) =
            text.chars().find_map(odd).filter(|(_, cause)| *cause == RefusalCause::ControlCharacter)
        {
            return Problem::new(at, "", found, "a row of values", cause);
        }
        let has_other = SEPARATORS.iter().any(|(other, _)| *other != separator && text.contains(*other));
        let advice = if separator == ',' && text.contains(';') {
            "separate columns by commas, and use decimal points".into()
        } else if !text.contains(separator) && has_other {
            "separate columns as in the header".into()
        } else if self.has_used(found) && separator == ',' && has_split_number(&cells[self.first_measured()..]) {
            Advice::from((RefusalCause::DecimalComma, "use decimal points; a decimal comma splits a number in two"))
        } else if found > names.len() {
            "name each column in the header, or delete what goes beyond it".into()
        } else {
            "add the values that are missing; if the reading was not taken, omit the whole row".into()
        };
        let plural = if found == 1 { "" } else { "s" };
        let expected = format!("{}, for {}", names.len(), names.join(", "));
        Problem::new(at, "", format!("{found} value{plural}"), expected, advice)
    }
}

/// Returns `true` if a whole number is followed by what may be its decimals.
fn has_split_number(cells: &[Cell]) -> bool {
    let is_whole = |text: &str| {
        let digits = text.trim_start_matches(['+', '-', '\u{2212}']);
        !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
    };
    cells.windows(2).any(|pair| is_whole(&pair[0].text) && is_rest(&pair[1].text, ""))
}

/// Returns `true` for digits that begin with `beginning`, and perhaps an exponent, as after a decimal mark.
fn is_rest(text: &str, beginning: &str) -> bool {
    let digits = text.split(['e', 'E']).next().unwrap_or_default();
    !digits.is_empty()
        && text.starts_with(beginning)
        && digits.bytes().all(|byte| byte.is_ascii_digit())
        && text.parse::<f64>().is_ok()
}

/// Returns the known column that `found` misspells: at most two letters differ, or the unit is missing.
fn meant<'a>(known: &[&'a str], found: &str) -> Option<&'a str> {
    let found = found.to_lowercase();
    let without_unit = |column: &&str| column.rsplit_once('_').is_some_and(|(known, _)| known == found);
    misspelt::name(known.iter().copied(), &found, 2).or_else(|| known.iter().copied().find(without_unit))
}

fn described(text: &str) -> String {
    if text.is_empty() { "nothing".to_owned() } else { Node::Text(text.to_owned()).describe() }
}
