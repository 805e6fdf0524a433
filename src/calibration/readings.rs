//! The currents read in every position: CSV `i,j,jx_ma,jy_ma`, and if present `cycle`, `visit`, `time_s`.
//!
//! A visit is one return to a position with its rows, the readings taken there without leaving it. What errors a
//! further visit makes smaller, a further row does not.

use crate::coefficients::{Coefficients, PositionIndex};
use crate::text::Unreadable;
use crate::text::problem::{MOST_PROBLEMS, Problem};
use crate::text::table::{Row, Table};
use nalgebra::Vector2;
use std::collections::BTreeMap;

/// The columns that the file must have.
pub(crate) const COLUMNS: [&str; 4] = ["i", "j", "jx_ma", "jy_ma"];

/// The columns that it may have.
pub(crate) const OPTIONAL_COLUMNS: [&str; 3] = ["cycle", "visit", "time_s"];

/// One row: the currents read once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Position.
    pub index: PositionIndex,
    /// (J_x, J_y), mA.
    pub current_ma: Vector2<f64>,
    /// Turn-on of the gyro, from 1.
    pub cycle: u32,
    /// Return to the position, from 1; `None` where the order of the rows tells.
    pub visit: Option<u32>,
}

/// One return to a position.
#[derive(Debug, Clone, PartialEq)]
pub struct Visit {
    /// Turn-on of the gyro, from 1.
    pub cycle: u32,
    /// Number of the visit within its cycle and position.
    pub number: u32,
    /// Every reading (J_x, J_y), in the order of the file; at least one.
    pub each_ma: Vec<Vector2<f64>>,
    /// Mean of the readings, mA.
    pub mean_ma: Vector2<f64>,
}

/// Readings of one position.
#[derive(Debug, Clone, PartialEq)]
pub struct PositionReadings {
    /// Which position.
    pub index: PositionIndex,
    /// Visits, in the order of the file; at least one.
    pub visits: Vec<Visit>,
    /// Mean of the visits' means, mA.
    pub mean_ma: Vector2<f64>,
}

impl PositionReadings {
    /// Returns the share of its variance that an error of every visit keeps in the mean.
    pub(crate) fn visit_share(&self) -> f64 {
        1.0 / self.visits.len() as f64
    }

    /// Returns the share of its variance that an error of every reading keeps in the mean.
    pub(crate) fn reading_share(&self) -> f64 {
        let each: f64 = self.visits.iter().map(|visit| 1.0 / visit.each_ma.len() as f64).sum();
        each * self.visit_share() * self.visit_share()
    }
}

/// Readings of every position, in the order of the coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct Readings {
    positions: Vec<PositionReadings>,
    remark: Option<String>,
}

/// Why readings do not fit the positions.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoReadings {
    /// A position that has none.
    #[error("found no reading of position {0}")]
    Missing(PositionIndex),
    /// A position that the coefficients do not know.
    #[error("found a reading of position {0}, which is not in the passport")]
    Unknown(PositionIndex),
    /// A current that is no finite number.
    #[error("a current of position {0} is not finite")]
    NotFinite(PositionIndex),
}

impl Reading {
    /// Creates a reading of the first cycle, whose visit the order of the rows tells.
    pub fn new(index: PositionIndex, current_ma: Vector2<f64>) -> Self {
        Self { index, current_ma, cycle: 1, visit: None }
    }
}

impl Readings {
    /// Creates readings from currents of the positions in any order; those of one position that follow each other are one
    /// visit.
    ///
    /// # Errors
    /// See [`NoReadings`].
    pub fn new(coefficients: &Coefficients, readings: &[(PositionIndex, Vector2<f64>)]) -> Result<Self, NoReadings> {
        let rows: Vec<_> = readings.iter().map(|(index, current)| Reading::new(*index, *current)).collect();
        Self::of_rows(coefficients, &rows)
    }

    /// Creates readings from rows in any order.
    ///
    /// # Errors
    /// See [`NoReadings`].
    pub(crate) fn of_rows(coefficients: &Coefficients, rows: &[Reading]) -> Result<Self, NoReadings> {
        let known = |index: PositionIndex| coefficients.positions.iter().any(|at| at.index == index);
        if let Some(row) = rows.iter().find(|row| !known(row.index)) {
            return Err(NoReadings::Unknown(row.index));
        }
        if let Some(row) = rows.iter().find(|row| !row.current_ma.iter().all(|j| j.is_finite())) {
            return Err(NoReadings::NotFinite(row.index));
        }
        let mut visits = visits(rows);
        let positions = coefficients.positions.iter().map(|at| {
            let visits = visits.remove(&at.index).ok_or(NoReadings::Missing(at.index))?;
            let mean_ma = mean(visits.iter().map(|visit| &visit.mean_ma));
            Ok(PositionReadings { index: at.index, visits, mean_ma })
        });
        Ok(Self { positions: positions.collect::<Result<_, _>>()?, remark: None })
    }

    /// Reads the CSV file `name` for the positions of `coefficients`; `range_ma` is the meter's range.
    ///
    /// # Errors
    /// [`Unreadable`] with every mistake at its line and column: form, numbers, positions missing or unknown,
    /// currents beyond the range, an axis without current.
    pub fn from_csv(name: &str, bytes: &[u8], coefficients: &Coefficients, range_ma: f64) -> Result<Self, Unreadable> {
        let table = Table::read(name, bytes, &COLUMNS, &OPTIONAL_COLUMNS)?;
        let [cycle, visit, time] = OPTIONAL_COLUMNS.map(|column| table.place(column));
        let mut problems = Vec::new();
        let mut readings = Vec::new();
        for row in &table.rows {
            if problems.len() >= MOST_PROBLEMS {
                break;
            }
            let index = position(&table, row, coefficients, &mut problems);
            let x = current(&table, row, 2, range_ma, &mut problems);
            let y = current(&table, row, 3, range_ma, &mut problems);
            let mut whole = |column: Option<usize>| column.and_then(|column| table.index(row, column, &mut problems));
            let (cycle, visit) = (whole(cycle).unwrap_or(1), whole(visit));
            // The time says nothing here yet, but a cell that is none is a mistake.
            let _ = time.map(|column| table.number(row, column, &mut problems));
            if let (Some(index), Some(x), Some(y)) = (index, x, y) {
                readings.push(Reading { index, current_ma: Vector2::new(x, y), cycle, visit });
            }
        }
        if problems.is_empty() {
            problems = incomplete(coefficients, &readings);
        }
        if problems.is_empty() {
            problems = without_current(&readings);
        }
        if !problems.is_empty() {
            return Err(table.refuse(problems));
        }
        let readings = Self::of_rows(coefficients, &readings)
            .map_err(|error| Unreadable::whole(name, None, error.to_string(), "a reading of every position", ""))?;
        Ok(Self { remark: table.remark(), ..readings })
    }

    /// Returns the readings of every position, in the order of the coefficients.
    pub fn positions(&self) -> &[PositionReadings] {
        &self.positions
    }

    /// Returns the mean currents (J_x, J_y) in mA, in the order of the coefficients.
    pub fn means_ma(&self) -> Vec<Vector2<f64>> {
        self.positions.iter().map(|position| position.mean_ma).collect()
    }

    /// Returns what is to be said of the file: which of its columns were left out of account.
    pub(crate) fn remark(&self) -> Option<&str> {
        self.remark.as_deref()
    }
}

fn mean<'a>(each: impl ExactSizeIterator<Item = &'a Vector2<f64>>) -> Vector2<f64> {
    let count = each.len() as f64;
    each.sum::<Vector2<f64>>() / count
}

/// The visits of each position, in the order of their first rows.
fn visits(rows: &[Reading]) -> BTreeMap<PositionIndex, Vec<Visit>> {
    let mut visits: BTreeMap<PositionIndex, Vec<Visit>> = BTreeMap::new();
    // Where a visit stands among those of its position; the last number given by the order of the rows.
    let mut places: BTreeMap<(PositionIndex, u32, u32), usize> = BTreeMap::new();
    let mut counted: BTreeMap<(PositionIndex, u32), u32> = BTreeMap::new();
    let mut before = None;
    for row in rows {
        let (index, cycle, stretch) = (row.index, row.cycle, Some((row.index, row.cycle)));
        let last = counted.entry((index, cycle)).or_default();
        // Without a number of its own a row goes on with the visit of the row before it, or begins a new one.
        *last += u32::from(before != stretch);
        before = stretch;
        let number = row.visit.unwrap_or(*last);
        let here = visits.entry(index).or_default();
        let place = *places.entry((index, cycle, number)).or_insert(here.len());
        if place == here.len() {
            here.push(Visit { cycle, number, each_ma: Vec::new(), mean_ma: Vector2::zeros() });
        }
        here[place].each_ma.push(row.current_ma);
    }
    for visit in visits.values_mut().flatten() {
        visit.mean_ma = mean(visit.each_ma.iter());
    }
    visits
}

fn position(
    table: &Table,
    row: &Row,
    coefficients: &Coefficients,
    problems: &mut Vec<Problem>,
) -> Option<PositionIndex> {
    let i = table.index(row, 0, problems);
    let j = table.index(row, 1, problems);
    let index = PositionIndex { i: i?, j: j? };
    if coefficients.positions.iter().any(|at| at.index == index) {
        return Some(index);
    }
    let advice = "check that this is the passport of this stand";
    let found = format!("position {index}");
    problems.push(table.problem(&row.cells[0], 0, found, "a position of the passport", advice));
    None
}

fn current(table: &Table, row: &Row, column: usize, range_ma: f64, problems: &mut Vec<Problem>) -> Option<f64> {
    let value = table.number(row, column, problems)?;
    if value.abs() <= range_ma {
        return Some(value);
    }
    let advice = if (1e-3..=1e3).contains(&(value.abs() / range_ma)) && value.abs() > 10.0 * range_ma {
        "convert it to milliamperes; it may be in microamperes"
    } else {
        "check the value, or the range of the meter in the laboratory file"
    };
    let expected = format!("at most {range_ma} mA in either direction, the range of the meter");
    problems.push(table.problem(&row.cells[column], column, format!("{value}"), &expected, advice));
    None
}

/// Positions without a reading.
fn incomplete(coefficients: &Coefficients, readings: &[Reading]) -> Vec<Problem> {
    let count = |wanted: PositionIndex| readings.iter().filter(|row| row.index == wanted).count();
    let most = coefficients.positions.iter().max_by_key(|at| count(at.index));
    let double = most
        .filter(|at| coefficients.positions.iter().filter(|other| count(other.index) == count(at.index)).count() == 1);
    let advice = match double {
        Some(at) if count(at.index) > 1 => {
            format!(
                "position {} occurs {} times; check whether one of these rows belongs to this position",
                at.index,
                count(at.index)
            )
        }
        _ => String::new(),
    };
    let missing = coefficients.positions.iter().filter(|at| count(at.index) == 0);
    missing
        .map(|at| whole_file(format!("no reading of position {}", at.index), "a reading of every position", &advice))
        .collect()
}

/// Axes whose currents are all zero.
fn without_current(readings: &[Reading]) -> Vec<Problem> {
    let zero = |axis: usize| readings.iter().all(|row| row.current_ma[axis] == 0.0);
    let (found, advice) = match (zero(0), zero(1)) {
        (true, true) => ("currents that are all zero", "check that the gyro was running with its feedback loop closed"),
        (true, false) => ("a current J_x that is zero in every position", "add the readings of both axes"),
        (false, true) => ("a current J_y that is zero in every position", "add the readings of both axes"),
        (false, false) => return Vec::new(),
    };
    vec![whole_file(found.to_owned(), "currents of both axes", advice)]
}

fn whole_file(found: String, expected: &str, advice: &str) -> Problem {
    let (expected, advice) = (expected.to_owned(), advice.to_owned());
    Problem { location: None, field: String::new(), found, expected, advice }
}
