//! Tables of numbers (CSV): a header of column names in any order, `#` comments, and every error with its location.
//!
//! Tables come from a meter's software or a spreadsheet and are not signed. CR LF and a byte order mark, which such
//! programs write, are therefore accepted, and so are empty cells at the end of a line and a first line `sep=;`. An
//! unknown column is ignored and reported, unless its name looks like a misspelt one. Semicolons or tabs between the
//! columns are accepted and reported, and with them decimal commas if the whole file has them; anything in between is
//! refused, because its meaning depends on the country of the reader.

use super::advice::{self, unquoted};
use super::kind::mistaken;
use super::node::{hand_written_text, without_byte_order_mark};
use super::problem::{MOST_COUNTED, MOST_PROBLEMS, counted};
use super::{Kind, Location, Problem, Unreadable};

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
        Self::parse(name, bytes, required, optional).map_err(|unreadable| {
            let expected = if required.contains(&"jx_ma") { Kind::Currents } else { Kind::Angles };
            let other = mistaken(name, bytes, expected.words(), |kind| kind == expected);
            other.unwrap_or_else(|| unreadable.in_text(bytes))
        })
    }

    fn parse(name: &'a str, bytes: &'a [u8], required: &[&'a str], optional: &[&'a str]) -> Result<Self, Unreadable> {
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
        let Some((line, header)) = first else {
            return Err(Unreadable::whole(name, None, "only spaces and comments", header(), ""));
        };
        let separator = declared
            .or_else(|| SEPARATORS.into_iter().map(|(separator, _)| separator).find(|it| header.contains(*it)))
            .unwrap_or(',');
        let header = Header::read(name, (line, header), separator, required, optional)?;
        let mut problems = Vec::new();
        let mut rows = Vec::new();
        for (line, text) in lines {
            match cells(line, text, separator).map(|cells| without_trailing(cells, header.names.len())) {
                Ok(cells) if cells.iter().all(|cell| cell.text.is_empty()) => {}
                Ok(cells) if header.fits(text, separator, cells.len()) => {
                    rows.push(header.order.iter().map(|&place| cells[place].clone()).collect());
                }
                Ok(cells) => problems.push(header.wrong_number_of_cells((line, text), separator, cells.len())),
                Err(problem) => problems.push(problem),
            }
            if problems.len() >= MOST_COUNTED {
                break;
            }
        }
        let Header { columns, left_out, .. } = header;
        let mut separated = None;
        if problems.is_empty() && separator != ',' {
            let separators = if separator == ';' { "semicolons" } else { "tabs" };
            match with_decimal_points(&mut rows, &columns) {
                Ok(commas) => {
                    let and = if commas { " and decimal commas" } else { "" };
                    separated = Some(format!("read with {separators} between columns{and}"));
                }
                Err(problem) => problems.push(problem),
            }
        }
        if problems.is_empty() {
            Ok(Self { name, bytes, columns, rows, left_out, separated })
        } else {
            Err(Unreadable::of(name, counted(problems, kind)))
        }
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
            let advice = advice::on_cell(&cell.text, self.columns[column]).unwrap_or(not_taken);
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
            let advice = advice_for_index(&cell.text);
            problems.push(self.problem(cell, column, described(&cell.text), "a whole number of 1 or more", advice));
        }
        index
    }

    /// Creates the report of an error in a cell.
    pub(crate) fn problem(&self, cell: &Cell, column: usize, found: String, expected: &str, advice: &str) -> Problem {
        Problem::new(Some(cell.location), column_name(&self.columns, column), found, expected, advice)
    }

    /// Refuses a table in which the points in `columns` seem to be thousands separators, as in 1.064 for 1064: each is before
    /// exactly three digits, no number is below 1, and other numbers are whole.
    pub(crate) fn check_marks(&self, columns: &[&str]) -> Result<(), Unreadable> {
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
        let Some((place, first)) = with_point.next().filter(|(_, cell)| is_grouped(cell)) else { return Ok(()) };
        if !with_point.all(|(_, cell)| is_grouped(cell)) || !cells().any(|(_, cell)| is_small_and_whole(cell)) {
            return Ok(());
        }
        let advice = "every point is before exactly three digits, and other numbers are whole: save the table again without \
                      thousands separators, or, if the points are decimal, with all decimals in every number";
        let expected = "a number that can be read in one way";
        Err(self.refuse(vec![self.problem(first, place, described(&first.text), expected, advice)]))
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

/// Returns the kind of an error in a cell, or of a row with too few or too many; `None` for errors of which each is
/// shown.
fn kind(problem: &Problem) -> Option<(String, String)> {
    let is_cell = !problem.field.is_empty() && (!problem.advice.is_empty() || problem.expected.contains("number"));
    let is_row = problem.field.is_empty() && problem.found.contains(" value");
    let counts = problem.location.is_some() && (is_cell || is_row);
    counts.then(|| (problem.expected.clone(), problem.advice.clone()))
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

/// Replaces the decimal commas of a table that has no commas between its columns, and returns `true` if there were
/// any. Commas are decimal marks only if the whole table has no decimal point.
fn with_decimal_points(rows: &mut [Row], columns: &[&str]) -> Result<bool, Problem> {
    let comma = rows.iter().flatten().find(|cell| cell.text.contains(',')).cloned();
    let Some(comma) = comma else { return Ok(false) };
    for (place, cell) in rows.iter().flat_map(|row| row.iter().enumerate()) {
        if cell.text.contains('.') {
            let found = format!("{:?}, with decimal commas from line {} on", cell.text, comma.location.line);
            let expected = "decimal commas or decimal points in the whole file";
            let advice = match cell.text.contains(',') {
                true => "save the table again without thousands separators",
                false => "save the table again with decimal points",
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
    Ok(true)
}

/// Returns the cells of a line. A quoted cell may contain separators, and quotes written twice (RFC 4180).
fn cells(line: usize, text: &str, separator: char) -> Result<Vec<Cell>, Problem> {
    let mut cells = Vec::new();
    let mut rest = Some(text);
    let blank = |c: char| c.is_whitespace() && c != separator;
    while let Some(here) = rest {
        let start = here.trim_start_matches(blank);
        let column = text[..text.len() - start.len()].chars().count() + 1;
        let location = Location { line, column };
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

struct Header<'a> {
    /// Requested columns that are present.
    columns: Vec<&'a str>,
    /// Index of each of these columns in a line.
    order: Vec<usize>,
    left_out: Vec<String>,
    /// Names of all columns, in the order of a line.
    names: Vec<String>,
}

impl<'a> Header<'a> {
    fn read(
        name: &str,
        (line, header): (usize, &str),
        separator: char,
        required: &[&'a str],
        optional: &[&'a str],
    ) -> Result<Self, Unreadable> {
        let at = Location { line, column: 1 };
        let expected = || format!("the header {} (columns in any order)", required.join(","));
        let known: Vec<&str> = required.iter().chain(optional).copied().collect();
        let is_known = |cell: &str| known.contains(&cell.trim().trim_matches('"'));
        // Decimal commas in a row of numbers, or commas in a title, do not separate columns.
        let parts = || header.split([',', ';', '\t']);
        if parts().all(|part| part.trim().is_empty() || part.trim().parse::<f64>().is_ok()) {
            let found = "numbers instead of the header";
            return Err(Unreadable::whole(name, Some(at), found, expected(), "add the header"));
        }
        let words = |sought: char| SEPARATORS.iter().find(|(it, _)| *it == sought).map_or("", |(_, words)| words);
        let other = SEPARATORS.iter().find(|(other, _)| *other != separator && header.contains(*other));
        if let Some((_, and)) = other.filter(|_| parts().any(is_known)) {
            let found = format!("columns separated by {} and {and}", words(separator));
            let advice = "save as CSV with commas between columns and decimal points in numbers";
            return Err(Unreadable::whole(name, Some(at), found, expected(), advice));
        }
        if header.split(separator).nth(MOST_PROBLEMS).is_some() {
            let found = format!("{} columns", header.split(separator).count());
            return Err(Unreadable::whole(name, Some(at), found, expected(), "check that this is the right file"));
        }
        let cells = cells(line, header, separator).map_err(|problem| Unreadable::of(name, vec![problem]))?;
        let cells = without_trailing(cells, 1);
        let mut problems = Vec::new();
        let mut left_out = Vec::new();
        for (index, cell) in cells.iter().enumerate() {
            let mut problem = |found: String, advice: String| {
                problems.push(Problem::new(Some(cell.location), "", found, expected(), advice));
            };
            if known.contains(&cell.text.as_str()) {
                if cells[..index].iter().any(|earlier| earlier.text == cell.text) {
                    problem(format!("duplicate column {:?}", cell.text), String::new());
                }
            } else if let Some(advice) = advice::on_name(&known, &cell.text) {
                problem(format!("column {:?}", cell.text), advice);
            } else if let Some(column) = meant(&known, &cell.text) {
                problem(format!("column {:?}", cell.text), format!("did you mean {column}?"));
            } else {
                left_out.push(cell.text.clone());
            }
        }
        let place = |column: &&str| cells.iter().position(|cell| cell.text == *column);
        // A column that only has another name is named there.
        let is_named = |column: &&&str| problems.iter().any(|problem| problem.names(column));
        let missing = required.iter().filter(|column| place(column).is_none() && !is_named(column));
        let missing: Vec<&str> = missing.copied().collect();
        if !missing.is_empty() {
            let plural = if missing.len() > 1 { "s" } else { "" };
            let found = format!("no column{plural} {}", missing.join(", "));
            let advice = match left_out.is_empty() {
                true => String::new(),
                false if cells.len() == 1 && cells[0].text.split(',').filter(|word| is_known(word)).count() > 1 => {
                    "each row is one quoted cell; import the table again with commas between columns, and save it"
                        .to_owned()
                }
                false if header.split_whitespace().filter(|word| is_known(word)).count() > 1 => {
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
        let (columns, order) = known.into_iter().filter_map(|column| Some((column, place(&column)?))).unzip();
        Ok(Self { columns, order, left_out, names: cells.into_iter().map(|cell| cell.text).collect() })
    }

    /// Returns `true` if a row with this number of cells has those of all columns that are used. Spreadsheet programs omit
    /// separators at the end of a row, so cells of other columns may be missing there.
    fn fits(&self, row: &str, separator: char, found: usize) -> bool {
        let is_short = found < self.names.len();
        found <= self.names.len() && self.has_used(found) && !(is_short && separator == ',' && has_decimal_commas(row))
    }

    /// Returns `true` if the first `found` cells are those of all columns that are used.
    fn has_used(&self, found: usize) -> bool {
        self.order.iter().all(|place| *place < found)
    }

    /// Creates the report of a row that has another number of cells than the header.
    fn wrong_number_of_cells(&self, (line, text): (usize, &str), separator: char, found: usize) -> Problem {
        let names = &self.names;
        let has_other = SEPARATORS.iter().any(|(other, _)| *other != separator && text.contains(*other));
        let advice = if separator == ',' && text.contains(';') {
            "separate columns by commas, and use decimal points"
        } else if !text.contains(separator) && has_other {
            "separate columns as in the header"
        } else if self.has_used(found) && separator == ',' && has_decimal_commas(text) {
            "use decimal points; a decimal comma splits a number in two"
        } else if found > names.len() {
            "name each column in the header, or delete what goes beyond it"
        } else {
            "add the values that are missing; if the reading was not taken, omit the whole row"
        };
        let plural = if found == 1 { "" } else { "s" };
        let expected = format!("{}, for {}", names.len(), names.join(", "));
        Problem::new(Some(Location { line, column: 1 }), "", format!("{found} value{plural}"), expected, advice)
    }
}

/// Returns `true` if a whole number is followed by digits beyond the first two cells, which are the indices of a position.
fn has_decimal_commas(row: &str) -> bool {
    let cells: Vec<&str> = row.split(',').map(str::trim).skip(2).collect();
    let is_digits = |cell: &str| !cell.is_empty() && cell.bytes().all(|byte| byte.is_ascii_digit());
    cells.windows(2).any(|pair| is_digits(pair[0].trim_start_matches(['+', '-'])) && is_digits(pair[1]))
}

/// Returns the known column that `found` misspells: at most two letters differ, or the unit is missing.
fn meant<'a>(known: &[&'a str], found: &str) -> Option<&'a str> {
    let found = found.to_lowercase();
    let distance = |column: &str| strsim::damerau_levenshtein(column, &found);
    let nearest = known.iter().map(|&column| (distance(column), column)).min()?;
    let without_unit = known.iter().find(|column| column.rsplit_once('_').is_some_and(|(known, _)| known == found));
    // Any two letters are as near to a short column as this.
    let is_near = nearest.0 <= 2 && nearest.0 < nearest.1.len();
    if is_near { Some(nearest.1) } else { without_unit.copied() }
}

fn described(text: &str) -> String {
    if text.is_empty() { "nothing".to_owned() } else { format!("{text:?}") }
}

fn advice_for_index(text: &str) -> &'static str {
    if unquoted(text) != text {
        "write the number without quotes"
    } else if text.parse() == Ok(0.0) {
        "count from 1"
    } else {
        ""
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whole arcseconds as spreadsheets of two countries write them are refused. Decimals are read, even if a single number shows
    /// that they are decimals.
    #[test]
    fn separators_of_thousands_are_not_decimal_marks() {
        let checked = |rows: &str| {
            let text = format!("i;j;a;b\n{rows}");
            let table = Table::read("t.csv", text.as_bytes(), &["i", "j", "a", "b"], &[]).unwrap();
            table.check_marks(&["a", "b"]).map_err(|refused| refused.to_string())
        };
        for rows in ["1;1;-622;-1.064\n1;2;12.345;17", "1;1;2,697;-2,136\n1;2;-459;63"] {
            let words = checked(rows).unwrap_err();
            assert!(words.contains("without thousands separators"), "{words}");
        }
        for rows in [
            "1;1;-622.5;-1.064\n1;2;12.345;17",
            "1;1;0.622;-1.064\n1;2;12.345;17",
            "1;1;-622.001;-1.064\n1;2;12.345;17.000",
            "1;1;-622;1064\n1;2;12345;17",
            "1;1;1234.567;-1.064\n1;2;12.345;17",
        ] {
            assert_eq!(checked(rows), Ok(()), "{rows}");
        }
    }

    /// Expected: of equal errors in cells, and of rows of a wrong length, one is shown; of all others each.
    #[test]
    fn equal_errors_in_cells_are_counted() {
        let at = Some(Location { line: 2, column: 1 });
        for (location, field, found, expected, advice, counts) in [
            (at, "jx_ma", "\"1;5\"", "a current", "separate columns by commas", true),
            (at, "jx_ma", "\"a lot\"", "a number", "", true),
            (at, "jx_ma", "3 values", "text", "", false),
            (at, "", "3 values", "4", "", true),
            (at, "", "3 rows", "4", "add one", false),
            (None, "jx_ma", "\"1;5\"", "a current", "separate columns by commas", false),
            (None, "", "3 values", "4", "", false),
        ] {
            let due = counts.then(|| (expected.to_owned(), advice.to_owned()));
            let problem = Problem::new(location, field, found, expected, advice);
            assert_eq!(kind(&problem), due, "{problem:?}");
        }
    }

    #[test]
    fn a_spreadsheet_declares_its_separator_in_one_line() {
        for (line, due) in [
            ("sep=;", Some(';')),
            ("\"SEP=,\"", Some(',')),
            ("sep=;;", None),
            ("sep=x", None),
            ("sep=", None),
            ("i,j", None),
        ] {
            assert_eq!(declared_separator(line), due, "{line}");
        }
    }

    /// Expected: as Excel writes the rows whose last cells are empty; what may be a decimal comma is refused.
    #[test]
    fn cells_of_other_columns_may_be_missing_at_the_end() {
        let table = |rows: &str| {
            let text = format!("i,j,jx_ma,remark,by\n{rows}");
            let table = Table::parse("f", text.as_bytes(), &["i", "j", "jx_ma"], &[]);
            table.map(|table| table.rows.len()).map_err(|error| error.problems()[0].advice.clone())
        };
        assert_eq!(table("1,1,0.5,ok,me\n1,2,0.6,ok\n1,3,0.7\n"), Ok(3));
        let advice = "use decimal points; a decimal comma splits a number in two";
        assert_eq!(table("1,1,0,25\n"), Err(advice.to_owned()));
    }

    #[test]
    fn the_advice_on_a_row_fits_its_number_of_cells() {
        const INCOMPLETE: &str = "add the values that are missing; if the reading was not taken, omit the whole row";
        const TOO_MANY: &str = "name each column in the header, or delete what goes beyond it";
        let names = ["i", "j", "jx_ma", "remark"].map(str::to_owned).to_vec();
        let header = Header { columns: vec!["i", "j", "jx_ma"], order: vec![0, 1, 2], left_out: Vec::new(), names };
        for (separator, text, due) in [
            (',', "1,2", INCOMPLETE),
            (',', "1,2,0,1,x", "use decimal points; a decimal comma splits a number in two"),
            (',', "1,2,0.1,0,25,x", "use decimal points; a decimal comma splits a number in two"),
            (',', "1,2,0.1,x,y", TOO_MANY),
            (',', "1;2;0,1;x", "separate columns by commas, and use decimal points"),
            (';', "1;2", INCOMPLETE),
            (';', "1;2;0,1;x;y", TOO_MANY),
            (';', "1,2,0.1,x", "separate columns as in the header"),
            ('\t', "1\t2", INCOMPLETE),
            ('\t', "1", INCOMPLETE),
            ('\t', "1;2;0,1;x", "separate columns as in the header"),
        ] {
            let found = cells(2, text, separator).unwrap().len();
            assert_eq!(header.wrong_number_of_cells((2, text), separator, found).advice, due, "{text:?}");
        }
    }

    #[test]
    fn the_advice_on_an_index_fits_what_was_written() {
        for (written, due) in [
            ("'1'", "write the number without quotes"),
            ("0", "count from 1"),
            ("0.0", "count from 1"),
            ("1.5", ""),
            ("-1.0", ""),
            ("one", ""),
        ] {
            assert_eq!(advice_for_index(written), due, "{written}");
        }
        assert_eq!((described(""), described("a")), ("nothing".to_owned(), "\"a\"".to_owned()));
    }

    #[test]
    fn a_misspelt_column_is_told_from_another() {
        let known = ["i", "j", "jx_ma", "time_s"];
        for (found, due) in [
            ("jx_mA", Some("jx_ma")),
            ("jy_m", Some("jx_ma")),
            ("time_x", Some("time_s")),
            ("time", Some("time_s")),
            ("time_of_day", None),
            ("jx_turns", None),
            ("k", None),
            ("remark", None),
        ] {
            assert_eq!(meant(&known, found), due, "{found}");
        }
    }

    /// Expected: RFC 4180, sections 2.5 to 2.7.
    #[test]
    fn quoted_cells_are_those_of_rfc_4180() {
        let texts = |line: &str| cells(1, line, ',').map(|cells| cells.into_iter().map(|cell| cell.text).collect());
        let due = |cells: &[&str]| Ok(cells.iter().map(|cell| (*cell).to_owned()).collect::<Vec<String>>());
        assert_eq!(texts("\"aaa\",\"b,bb\",ccc"), due(&["aaa", "b,bb", "ccc"]));
        assert_eq!(texts("\"b\"\"bb\" , c"), due(&["b\"bb", "c"]));
        assert!(texts("\"aaa").is_err() && texts("\"aaa\"b").is_err());
        let columns: Vec<usize> = cells(1, "µ, \"b\",c", ',').unwrap().iter().map(|at| at.location.column).collect();
        assert_eq!(columns, [1, 4, 8]);
    }
}
