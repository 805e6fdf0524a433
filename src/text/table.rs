//! Tables of numbers (CSV): a header of column names in any order, `#` comments, every mistake with its place.
//!
//! A table comes from a meter's software or a spreadsheet and is signed by nobody: CR LF and a byte order mark, which
//! those write, are taken as they are. Semicolons and decimal commas are refused and named, for what they mean depends
//! on the reader's country.

use super::node::plain_text;
use super::problem::{Location, MOST_PROBLEMS, Problem, Unreadable};
use std::collections::BTreeMap;

/// A table: its rows of cells, in the order of the columns asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Table<'a> {
    name: &'a str,
    columns: &'a [&'a str],
    /// Rows in the order of the text.
    pub rows: Vec<Row>,
}

/// A row of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// One cell for each column asked for.
    pub cells: Vec<Cell>,
}

/// A cell: its text, blanks around it removed, and its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cell {
    /// What stands there.
    pub text: String,
    /// Where.
    pub location: Location,
}

impl<'a> Table<'a> {
    /// Reads the table `name` that must have exactly the `columns`, in any order.
    ///
    /// # Errors
    /// [`Unreadable`] with every mistake in form; what the cells mean is the caller's.
    pub fn read(name: &'a str, bytes: &[u8], columns: &'a [&'a str]) -> Result<Self, Unreadable> {
        let text = decoded(name, bytes)?;
        let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line)).filter(|(_, line)| {
            let line = line.trim();
            !line.is_empty() && !line.starts_with('#')
        });
        let Some((line, header)) = lines.next() else {
            let expected = format!("the header {}", columns.join(","));
            return Err(Unreadable::whole(name, None, "nothing but blanks and comments", expected, ""));
        };
        let order = order_of_columns(name, line, header, columns)?;
        let mut problems = Vec::new();
        let mut rows = Vec::new();
        for (line, text) in lines {
            let found = text.split(',').count();
            if found == columns.len() {
                let cells = cells(line, text);
                rows.push(Row { cells: order.iter().map(|&place| cells[place].clone()).collect() });
            } else {
                problems.push(wrong_number_of_cells(line, text, found, columns.len()));
            }
            if problems.len() >= MOST_PROBLEMS {
                break;
            }
        }
        if problems.is_empty() { Ok(Self { name, columns, rows }) } else { Err(Unreadable::of(name, problems)) }
    }

    /// A finite number in a cell; a mistake is added to `problems`.
    pub fn number(&self, row: &Row, column: usize, problems: &mut Vec<Problem>) -> Option<f64> {
        let cell = &row.cells[column];
        match cell.text.parse::<f64>() {
            Ok(value) if value.is_finite() => Some(value),
            Ok(_) => {
                let found = format!("{:?}", cell.text);
                problems.push(self.problem(cell, column, found, "a finite number", "leave the row out"));
                None
            }
            Err(_) => {
                let advice = advice_for_number(&cell.text);
                problems.push(self.problem(cell, column, described(&cell.text), "a number", advice));
                None
            }
        }
    }

    /// A whole number from 1 in a cell; a mistake is added to `problems`.
    pub fn index(&self, row: &Row, column: usize, problems: &mut Vec<Problem>) -> Option<u32> {
        let cell = &row.cells[column];
        let index = cell.text.parse::<u32>().ok().filter(|&index| index > 0);
        if index.is_none() {
            problems.push(self.problem(cell, column, described(&cell.text), "a whole number from 1", ""));
        }
        index
    }

    /// A mistake at a cell.
    pub fn problem(&self, cell: &Cell, column: usize, found: String, expected: &str, advice: &str) -> Problem {
        Problem {
            location: Some(cell.location),
            field: self.columns.get(column).copied().unwrap_or_default().to_owned(),
            found,
            expected: expected.to_owned(),
            advice: advice.to_owned(),
        }
    }

    /// The refusal of this table. Of many cells that want the same advice the first is shown, the others are counted.
    pub fn refuse(&self, problems: Vec<Problem>) -> Unreadable {
        Unreadable::of(self.name, counted(problems))
    }
}

/// From so many cells that want the same advice on, the first stands for all.
const ALIKE: usize = 4;

fn counted(problems: Vec<Problem>) -> Vec<Problem> {
    // Of every advice: the place of its first cell, how many cells there are, the line of the last one.
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
                problem.found += &format!(" (and {} more like it, down to line {last})", count - 1)
            }
            None => {}
        }
        Some(problem)
    });
    shown.collect()
}

/// The bytes as text, byte order mark and CR LF taken away.
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

fn cells(line: usize, text: &str) -> Vec<Cell> {
    let mut column = 1;
    text.split(',')
        .map(|cell| {
            let blanks = cell.chars().take_while(|c| c.is_whitespace()).count();
            let location = Location { line, column: column + blanks };
            column += cell.chars().count() + 1;
            Cell { text: cell.trim().to_owned(), location }
        })
        .collect()
}

/// Where each of the `columns` stands in the header.
fn order_of_columns(name: &str, line: usize, header: &str, columns: &[&str]) -> Result<Vec<usize>, Unreadable> {
    let at = Location { line, column: 1 };
    let expected = || format!("the header {}, its columns in any order", columns.join(","));
    for (separator, words) in [(';', "semicolons"), ('\t', "tabs")] {
        if header.contains(separator) {
            let found = format!("columns separated by {words}");
            let advice = "save as CSV with commas between the columns and points in the numbers";
            return Err(Unreadable::whole(name, Some(at), found, expected(), advice));
        }
    }
    if header.split(',').nth(MOST_PROBLEMS).is_some() {
        let found = format!("{} columns", header.split(',').count());
        return Err(Unreadable::whole(name, Some(at), found, expected(), "is this the right file?"));
    }
    let cells = cells(line, header);
    if cells.iter().all(|cell| cell.text.parse::<f64>().is_ok()) {
        return Err(Unreadable::whole(name, Some(at), "numbers where the header is due", expected(), "add the header"));
    }
    let mut problems = Vec::new();
    for (index, cell) in cells.iter().enumerate() {
        let problem = |found: String, advice: String| Problem {
            location: Some(cell.location),
            field: String::new(),
            found,
            expected: expected(),
            advice,
        };
        if !columns.contains(&cell.text.as_str()) {
            let nearest = columns.iter().map(|column| (strsim::damerau_levenshtein(column, &cell.text), column)).min();
            let advice = match nearest {
                Some((distance, column)) if distance <= 3 => format!("did you mean {column}?"),
                _ => String::new(),
            };
            problems.push(problem(format!("the column {:?}", cell.text), advice));
        } else if cells[..index].iter().any(|earlier| earlier.text == cell.text) {
            problems.push(problem(format!("the column {:?} a second time", cell.text), String::new()));
        }
    }
    let place = |column: &&str| cells.iter().position(|cell| cell.text == **column);
    for column in columns.iter().filter(|column| place(column).is_none()) {
        problems.push(Problem {
            location: Some(at),
            field: String::new(),
            found: format!("no column {column}"),
            expected: expected(),
            advice: String::new(),
        });
    }
    if problems.is_empty() {
        Ok(columns.iter().filter_map(place).collect())
    } else {
        Err(Unreadable::of(name, problems))
    }
}

fn wrong_number_of_cells(line: usize, text: &str, found: usize, columns: usize) -> Problem {
    let advice = if text.contains(';') {
        "separate columns by commas, and write numbers with a point"
    } else if found > columns {
        "a decimal comma makes one number two: write numbers with a point"
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
        "leave out the whole row of a reading that was not taken"
    } else if text.contains(';') {
        "separate columns by commas"
    } else if !text.is_ascii() {
        "write it with ASCII digits, point and minus"
    } else if text.ends_with(|c: char| c.is_ascii_alphabetic())
        && text.starts_with(|c: char| c.is_ascii_digit() || c == '-')
    {
        "the unit is in the column's name"
    } else {
        ""
    }
}
