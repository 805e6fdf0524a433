//! Tables of numbers (CSV): a header of column names in any order, `#` comments, and every error with its location.
//!
//! Tables come from a meter's software or a spreadsheet and are not signed. CR LF and a byte order mark, which such
//! programs write, are therefore accepted. An unknown column is ignored and reported, unless its name looks like a
//! misspelt one. Semicolons and decimal commas are refused with an explanation, because their meaning depends on the
//! country of the reader.

use super::node::plain_text;
use super::problem::{Location, MOST_PROBLEMS, Problem, Unreadable};
use std::collections::BTreeMap;

/// Table: rows of cells, in the order of the requested columns.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Table<'a> {
    name: &'a str,
    bytes: &'a [u8],
    columns: Vec<&'a str>,
    /// Rows in the order of the text.
    pub rows: Vec<Row>,
    left_out: Vec<String>,
}

/// Row of a table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    /// Cells, one for each requested column that is present.
    pub cells: Vec<Cell>,
}

/// Cell: its text without surrounding spaces, and its location.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Cell {
    /// Text, without the quotes of a quoted cell.
    pub text: String,
    /// Location of the cell.
    pub location: Location,
}

impl<'a> Table<'a> {
    /// Reads the table `name`, which must have the `required` columns and may have the `optional` ones, in any order.
    ///
    /// # Errors
    /// Returns [`Unreadable`] with every error in the form. The caller checks the content of the cells.
    pub(crate) fn read(
        name: &'a str,
        bytes: &'a [u8],
        required: &[&'a str],
        optional: &[&'a str],
    ) -> Result<Self, Unreadable> {
        Self::parse(name, bytes, required, optional).map_err(|unreadable| unreadable.in_text(bytes))
    }

    fn parse(name: &'a str, bytes: &'a [u8], required: &[&'a str], optional: &[&'a str]) -> Result<Self, Unreadable> {
        let text = decoded(name, bytes)?;
        let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line)).filter(|(_, line)| {
            let line = line.trim();
            !line.is_empty() && !line.starts_with('#')
        });
        let Some((line, header)) = lines.next() else {
            let expected = format!("the header {}", required.join(","));
            return Err(Unreadable::whole(name, None, "only spaces and comments", expected, ""));
        };
        let header = Header::read(name, line, header, required, optional)?;
        let mut problems = Vec::new();
        let mut rows = Vec::new();
        for (line, text) in lines {
            match cells(line, text) {
                Ok(cells) if cells.len() == header.width => {
                    rows.push(Row { cells: header.order.iter().map(|&place| cells[place].clone()).collect() });
                }
                Ok(cells) => problems.push(wrong_number_of_cells(line, text, cells.len(), header.width)),
                Err(problem) => problems.push(problem),
            }
            if problems.len() >= MOST_PROBLEMS {
                break;
            }
        }
        let Header { columns, left_out, .. } = header;
        if problems.is_empty() {
            Ok(Self { name, bytes, columns, rows, left_out })
        } else {
            Err(Unreadable::of(name, problems))
        }
    }

    /// Returns a remark that lists the ignored columns, or `None` if there are none.
    pub(crate) fn remark(&self) -> Option<String> {
        let names: Vec<String> = self.left_out.iter().map(|name| format!("{name:?}")).collect();
        let (words, are) = if names.len() == 1 { ("column", "is") } else { ("columns", "are") };
        let name = self.name;
        (!names.is_empty()).then(|| format!("{name}: the {words} {} {are} ignored", names.join(", ")))
    }

    /// Returns the index of a column in the cells of a row, or `None` for an optional column that is absent.
    pub(crate) fn place(&self, column: &str) -> Option<usize> {
        self.columns.iter().position(|name| *name == column)
    }

    /// Returns the finite number in a cell, or adds an error to `problems` and returns `None`.
    pub(crate) fn number(&self, row: &Row, column: usize, problems: &mut Vec<Problem>) -> Option<f64> {
        let cell = &row.cells[column];
        match cell.text.parse::<f64>() {
            Ok(value) if value.is_finite() => Some(value),
            Ok(_) => {
                let found = format!("{:?}", cell.text);
                problems.push(self.problem(cell, column, found, "a finite number", "omit the row"));
                None
            }
            Err(_) => {
                let advice = advice_for_number(&cell.text);
                problems.push(self.problem(cell, column, described(&cell.text), "a number", advice));
                None
            }
        }
    }

    /// Returns the whole number, 1 or larger, in a cell, or adds an error to `problems` and returns `None`.
    pub(crate) fn index(&self, row: &Row, column: usize, problems: &mut Vec<Problem>) -> Option<u32> {
        let cell = &row.cells[column];
        let index = cell.text.parse::<u32>().ok().filter(|&index| index > 0);
        if index.is_none() {
            problems.push(self.problem(cell, column, described(&cell.text), "a whole number from 1", ""));
        }
        index
    }

    /// Creates the report of an error in a cell.
    pub(crate) fn problem(&self, cell: &Cell, column: usize, found: String, expected: &str, advice: &str) -> Problem {
        Problem {
            location: Some(cell.location),
            field: self.columns.get(column).copied().unwrap_or_default().to_owned(),
            found,
            expected: expected.to_owned(),
            advice: advice.to_owned(),
        }
    }

    /// Returns the refusal of this table. If many cells need the same advice, only the first is shown, with the number
    /// of others.
    pub(crate) fn refuse(&self, problems: Vec<Problem>) -> Unreadable {
        Unreadable::of(self.name, counted(problems)).in_text(self.bytes)
    }
}

/// Number of cells with the same advice from which only the first is shown.
const ALIKE: usize = 4;

fn counted(problems: Vec<Problem>) -> Vec<Problem> {
    // For each advice: the index of its first cell, the number of cells, and the line of the last one.
    let mut alike: BTreeMap<String, (usize, usize, usize)> = BTreeMap::new();
    let cell = |problem: &Problem| problem.location.filter(|_| !problem.field.is_empty() && !problem.advice.is_empty());
    for (place, problem) in problems.iter().enumerate() {
        if let Some(location) = cell(problem) {
            let (_, count, last) = alike.entry(problem.advice.clone()).or_insert((place, 0, 0));
            *count += 1;
            *last = location.line.max(*last);
        }
    }
    let shown = problems.into_iter().enumerate().filter_map(|(place, mut problem)| {
        let of_all = cell(&problem).and_then(|_| alike.get(&problem.advice)).filter(|(_, count, _)| *count >= ALIKE);
        match of_all {
            Some((first, ..)) if *first != place => return None,
            Some((_, count, last)) => {
                problem.found += &format!(" (and {} more of this kind, up to line {last})", count - 1)
            }
            None => {}
        }
        Some(problem)
    });
    shown.collect()
}

/// Returns the bytes as text, without byte order mark and with LF line endings.
fn decoded(name: &str, bytes: &[u8]) -> Result<String, Unreadable> {
    let bytes = bytes.strip_prefix(&[0xEF, 0xBB, 0xBF]).unwrap_or(bytes);
    let mut plain = Vec::with_capacity(bytes.len());
    for (index, &byte) in bytes.iter().enumerate() {
        if byte != b'\r' || bytes.get(index + 1) != Some(&b'\n') {
            plain.push(byte);
        }
    }
    plain_text(name, &plain).map(str::to_owned)
}

/// Returns the cells of a line. A quoted cell may contain commas, and quotes written twice (RFC 4180).
fn cells(line: usize, text: &str) -> Result<Vec<Cell>, Problem> {
    let mut cells = Vec::new();
    let mut rest = Some(text);
    while let Some(here) = rest {
        let start = here.trim_start();
        let column = text[..text.len() - start.len()].chars().count() + 1;
        let location = Location { line, column };
        let (cell, after) = match start.strip_prefix('"') {
            Some(quoted) => unquoted(quoted).ok_or_else(|| bad_quotes(location))?,
            None => {
                let end = start.find(',').unwrap_or(start.len());
                (start[..end].trim_end().to_owned(), &start[end..])
            }
        };
        cells.push(Cell { text: cell, location });
        rest = after.strip_prefix(',');
    }
    Ok(cells)
}

/// Returns the text of a quoted cell, given from after its first quote, and the rest of the line: nothing, or a comma
/// and more. Returns `None` if the last quote is missing or something else follows it.
fn unquoted(quoted: &str) -> Option<(String, &str)> {
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
    let after = rest.trim_start();
    (after.is_empty() || after.starts_with(',')).then(|| (text.trim().to_owned(), after))
}

fn bad_quotes(location: Location) -> Problem {
    Problem {
        location: Some(location),
        field: String::new(),
        found: "a quoted cell without a closing quote before a comma or the end of the line".to_owned(),
        expected: "\"…\", with each inner quote doubled".to_owned(),
        advice: String::new(),
    }
}

/// Header of a table.
struct Header<'a> {
    /// Requested columns that are present.
    columns: Vec<&'a str>,
    /// Index of each of these columns in a line.
    order: Vec<usize>,
    left_out: Vec<String>,
    /// Number of cells in a line.
    width: usize,
}

impl<'a> Header<'a> {
    fn read(
        name: &str,
        line: usize,
        header: &str,
        required: &[&'a str],
        optional: &[&'a str],
    ) -> Result<Self, Unreadable> {
        let at = Location { line, column: 1 };
        let expected = || format!("the header {} (columns in any order)", required.join(","));
        for (separator, words) in [(';', "semicolons"), ('\t', "tabs")] {
            if header.contains(separator) {
                let found = format!("columns separated by {words}");
                let advice = "save as CSV with commas between columns and decimal points in numbers";
                return Err(Unreadable::whole(name, Some(at), found, expected(), advice));
            }
        }
        if header.split(',').nth(MOST_PROBLEMS).is_some() {
            let found = format!("{} columns", header.split(',').count());
            return Err(Unreadable::whole(name, Some(at), found, expected(), "check that this is the right file"));
        }
        let cells = cells(line, header).map_err(|problem| Unreadable::of(name, vec![problem]))?;
        if cells.iter().all(|cell| cell.text.parse::<f64>().is_ok()) {
            let found = "numbers instead of the header";
            return Err(Unreadable::whole(name, Some(at), found, expected(), "add the header"));
        }
        let known: Vec<&str> = required.iter().chain(optional).copied().collect();
        let mut problems = Vec::new();
        let mut left_out = Vec::new();
        for (index, cell) in cells.iter().enumerate() {
            let mut problem = |found: String, advice: String| {
                let (location, field, expected) = (Some(cell.location), String::new(), expected());
                problems.push(Problem { location, field, found, expected, advice });
            };
            if known.contains(&cell.text.as_str()) {
                if cells[..index].iter().any(|earlier| earlier.text == cell.text) {
                    problem(format!("duplicate column {:?}", cell.text), String::new());
                }
            } else if let Some(column) = meant(&known, &cell.text) {
                problem(format!("column {:?}", cell.text), format!("did you mean {column}?"));
            } else {
                left_out.push(cell.text.clone());
            }
        }
        let place = |column: &&str| cells.iter().position(|cell| cell.text == *column);
        for column in required.iter().filter(|column| place(column).is_none()) {
            problems.push(Problem {
                location: Some(at),
                field: String::new(),
                found: format!("no column {column}"),
                expected: expected(),
                advice: String::new(),
            });
        }
        if !problems.is_empty() {
            return Err(Unreadable::of(name, problems));
        }
        let (columns, order) = known.into_iter().filter_map(|column| Some((column, place(&column)?))).unzip();
        Ok(Self { columns, order, left_out, width: cells.len() })
    }
}

/// Units that the name of a column may end with.
const UNITS: [&str; 22] = [
    "s", "ms", "us", "ns", "min", "h", "a", "ma", "ua", "na", "v", "mv", "uv", "deg", "rad", "mrad", "urad", "arcsec",
    "arcmin", "gon", "ppm", "percent",
];

/// Returns the known column that `found` misspells: at most two letters differ, or the unit is different or missing.
fn meant<'a>(known: &[&'a str], found: &str) -> Option<&'a str> {
    let found = found.to_lowercase();
    let distance = |column: &str| strsim::damerau_levenshtein(column, &found);
    let nearest = known.iter().map(|&column| (distance(column), column)).min()?;
    let stem = match found.rsplit_once('_') {
        Some((stem, unit)) if UNITS.contains(&unit) => stem,
        _ => found.as_str(),
    };
    let other_unit = known.iter().find(|column| column.rsplit_once('_').is_some_and(|(known, _)| known == stem));
    if nearest.0 <= 2 { Some(nearest.1) } else { other_unit.copied() }
}

fn wrong_number_of_cells(line: usize, text: &str, found: usize, columns: usize) -> Problem {
    let advice = if text.contains(';') {
        "separate columns by commas, and use decimal points"
    } else if found > columns {
        "use decimal points; a decimal comma splits a number in two"
    } else {
        ""
    };
    Problem {
        location: Some(Location { line, column: 1 }),
        field: String::new(),
        found: format!("{found} values"),
        expected: format!("{columns}"),
        advice: advice.to_owned(),
    }
}

fn described(text: &str) -> String {
    if text.is_empty() { "nothing".to_owned() } else { format!("{text:?}") }
}

fn advice_for_number(text: &str) -> &'static str {
    if text.is_empty() {
        "omit the whole row of a reading that was not taken"
    } else if text.contains(';') {
        "separate columns by commas"
    } else if !text.is_ascii() {
        "use ASCII digits, a decimal point and an ASCII minus"
    } else if text.ends_with(|c: char| c.is_ascii_alphabetic())
        && text.starts_with(|c: char| c.is_ascii_digit() || c == '-')
    {
        "write the number without a unit; the column name states it"
    } else {
        ""
    }
}
