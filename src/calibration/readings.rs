//! The currents of every position, from CSV: `i,j,jx_ma,jy_ma`, and optionally `cycle`, `visit`, `time_s`.
//!
//! A visit is one arrival at a position with its rows, which are the readings taken there without leaving the position.
//! Further visits reduce errors that further rows of the same visit do not reduce.

use crate::coefficients::{Coefficients, PositionIndex};
use crate::text::Unreadable;
use crate::text::problem::{MOST_PROBLEMS, Problem};
use crate::text::table::{Row, Table};
use nalgebra::Vector2;
use std::collections::{BTreeMap, BTreeSet};

/// Required columns of the file.
pub(crate) const COLUMNS: [&str; 4] = ["i", "j", "jx_ma", "jy_ma"];

/// Optional columns of the file.
pub(crate) const OPTIONAL_COLUMNS: [&str; 3] = ["cycle", "visit", "time_s"];

/// One row of the file: one reading of the two currents.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Index (i, j) of the position.
    pub index: PositionIndex,
    /// Currents (J_x, J_y), mA.
    pub current_ma: Vector2<f64>,
    /// Turn-on of the gyro, from 1.
    pub cycle: u32,
    /// Number of the visit to the position, from 1; `None` if it follows from the order of the rows.
    pub visit: Option<u32>,
    /// Time since the first reading, s; `None` if it is not known.
    pub time_s: Option<f64>,
}

/// One visit: one arrival at a position with its readings.
#[derive(Debug, Clone, PartialEq)]
pub struct Visit {
    /// Turn-on of the gyro, from 1.
    pub cycle: u32,
    /// Number of the visit within its cycle and position.
    pub number: u32,
    /// Readings (J_x, J_y) of the visit, mA, in the order of the file; at least one.
    pub each_ma: Vec<Vector2<f64>>,
    /// Mean (J_x, J_y) of the readings, mA.
    pub mean_ma: Vector2<f64>,
    /// Mean time of the readings, s; `None` if it is not known.
    pub time_s: Option<f64>,
}

/// Readings of one position, grouped by visit.
#[derive(Debug, Clone, PartialEq)]
pub struct PositionReadings {
    /// Index (i, j) of the position.
    pub index: PositionIndex,
    /// Visits, in the order of the file; at least one.
    pub visits: Vec<Visit>,
    /// Mean (J_x, J_y) of the visit means, mA.
    pub mean_ma: Vector2<f64>,
}

/// Visit that is left out of a calibration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Exclusion {
    /// Index (i, j) of the position.
    pub index: PositionIndex,
    /// Number of the visit within its cycle and position.
    pub visit: u32,
    /// Turn-on of the gyro; `None` if there is no other visit of that number to the position.
    pub cycle: Option<u32>,
    /// Reason.
    pub why: String,
}

/// Reason why a visit cannot be left out.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NotExcluded {
    /// No such visit.
    #[error("found no visit {visit} to position {index} to exclude")]
    Missing {
        /// Index (i, j) of the position.
        index: PositionIndex,
        /// Number of the visit.
        visit: u32,
    },
    /// Visits of that number in several cycles.
    #[error("position {index} has a visit {visit} in the cycles {cycles:?}; add the number of one as i,j,visit,cycle")]
    Ambiguous {
        /// Index (i, j) of the position.
        index: PositionIndex,
        /// Number of the visit.
        visit: u32,
        /// Cycles with that visit.
        cycles: Vec<u32>,
    },
    /// No other reading would be left.
    #[error("the last reading cannot be excluded")]
    Last,
}

impl PositionReadings {
    fn new(index: PositionIndex, visits: Vec<Visit>) -> Self {
        let mean_ma = mean(visits.iter().map(|visit| &visit.mean_ma));
        Self { index, visits, mean_ma }
    }

    /// Returns the fraction of its variance that an error of a single visit has in the mean of the position.
    pub(crate) fn visit_share(&self) -> f64 {
        1.0 / self.visits.len() as f64
    }

    /// Returns the fraction of its variance that an error of a single reading has in the mean of the position.
    pub(crate) fn reading_share(&self) -> f64 {
        let each: f64 = self.visits.iter().map(|visit| 1.0 / visit.each_ma.len() as f64).sum();
        each * self.visit_share() * self.visit_share()
    }
}

/// Readings of positions, in the order of the coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct Readings {
    positions: Vec<PositionReadings>,
    left_out: Vec<PositionIndex>,
    exclusions: Vec<Exclusion>,
    remark: Option<String>,
}

/// Reason why readings do not match the positions of the coefficients.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoReadings {
    /// No reading at all.
    #[error("found no reading")]
    None,
    /// A reading of a position that the coefficients do not contain.
    #[error("found a reading of position {0}, which is not in the passport")]
    Unknown(PositionIndex),
    /// A current that is not a finite number.
    #[error("a current of position {0} is not finite")]
    NotFinite(PositionIndex),
}

impl Reading {
    /// Creates a reading of the first cycle; its visit follows from the order of the rows.
    pub fn new(index: PositionIndex, current_ma: Vector2<f64>) -> Self {
        Self { index, current_ma, cycle: 1, visit: None, time_s: None }
    }
}

impl Readings {
    /// Creates readings from currents (J_x, J_y), mA, with their positions, in any order. Consecutive readings of one
    /// position form one visit.
    ///
    /// # Errors
    /// Returns [`NoReadings`] if there are none, a position is unknown, or a current is not finite.
    pub fn new(coefficients: &Coefficients, readings: &[(PositionIndex, Vector2<f64>)]) -> Result<Self, NoReadings> {
        let rows: Vec<_> = readings.iter().map(|(index, current)| Reading::new(*index, *current)).collect();
        Self::of_rows(coefficients, &rows)
    }

    /// Creates readings from rows in any order.
    ///
    /// # Errors
    /// Returns [`NoReadings`] if there are none, a position is unknown, or a current is not finite.
    pub(crate) fn of_rows(coefficients: &Coefficients, rows: &[Reading]) -> Result<Self, NoReadings> {
        let known = |index: PositionIndex| coefficients.positions.iter().any(|at| at.index == index);
        if let Some(row) = rows.iter().find(|row| !known(row.index)) {
            return Err(NoReadings::Unknown(row.index));
        }
        if let Some(row) = rows.iter().find(|row| !row.current_ma.iter().all(|j| j.is_finite())) {
            return Err(NoReadings::NotFinite(row.index));
        }
        if rows.is_empty() {
            return Err(NoReadings::None);
        }
        let mut visits = visits(rows);
        let (mut positions, mut left_out) = (Vec::new(), Vec::new());
        for at in &coefficients.positions {
            match visits.remove(&at.index) {
                Some(visits) => positions.push(PositionReadings::new(at.index, visits)),
                None => left_out.push(at.index),
            }
        }
        Ok(Self { positions, left_out, exclusions: Vec::new(), remark: None })
    }

    /// Leaves a visit out, with the reason on record.
    ///
    /// # Errors
    /// Returns [`NotExcluded`] if there is no such visit, or one in several cycles, or no other reading would be left.
    pub fn exclude(&mut self, exclusion: Exclusion) -> Result<(), NotExcluded> {
        let Exclusion { index, visit, cycle, .. } = &exclusion;
        let (index, number, cycle) = (*index, *visit, *cycle);
        let is_it = |visit: &&Visit| visit.number == number && cycle.is_none_or(|cycle| visit.cycle == cycle);
        let missing = NotExcluded::Missing { index, visit: number };
        let place = self.positions.iter().position(|at| at.index == index).ok_or(missing)?;
        let at = &self.positions[place];
        let found: Vec<u32> = at.visits.iter().filter(is_it).map(|visit| visit.cycle).collect();
        match found.as_slice() {
            [] => return Err(NotExcluded::Missing { index, visit: number }),
            [_] => {}
            _ => return Err(NotExcluded::Ambiguous { index, visit: number, cycles: found }),
        }
        let rest: Vec<Visit> = at.visits.iter().filter(|visit| !is_it(visit)).cloned().collect();
        if rest.is_empty() {
            if self.positions.len() == 1 {
                return Err(NotExcluded::Last);
            }
            self.positions.remove(place);
            self.left_out.push(index);
        } else {
            self.positions[place] = PositionReadings::new(index, rest);
        }
        self.exclusions.push(Exclusion { cycle: Some(found[0]), ..exclusion });
        Ok(())
    }

    /// Returns the visits that were left out, with their reasons.
    pub fn exclusions(&self) -> &[Exclusion] {
        &self.exclusions
    }

    /// Returns the positions of the coefficients without a reading.
    pub fn left_out(&self) -> &[PositionIndex] {
        &self.left_out
    }

    /// Reads the CSV file `name` for the positions of `coefficients`; `range_ma` is the range of the meter, mA.
    ///
    /// # Errors
    /// Returns [`Unreadable`] with the line and column of every error: invalid form or number, missing or unknown
    /// position, current beyond the range, axis without current.
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
            let time_s = time.and_then(|column| table.number(row, column, &mut problems));
            if let (Some(index), Some(x), Some(y)) = (index, x, y) {
                readings.push(Reading { index, current_ma: Vector2::new(x, y), cycle, visit, time_s });
            }
        }
        if problems.is_empty() && visit.is_none() {
            problems = perhaps_mistaken(coefficients, &readings);
        }
        if problems.is_empty() {
            problems = torn_visits(&table, &readings);
        }
        if problems.is_empty() {
            problems = lone_cycles(&readings);
        }
        if problems.is_empty() {
            problems = impossible_times(&table, &readings);
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

    /// Returns the mean currents (J_x, J_y), mA, in the order of the coefficients.
    pub fn means_ma(&self) -> Vec<Vector2<f64>> {
        self.positions.iter().map(|position| position.mean_ma).collect()
    }

    /// Returns the turn-ons of the gyro, in ascending order.
    pub(crate) fn cycles(&self) -> Vec<u32> {
        let cycles: BTreeSet<u32> = self.visits().map(|visit| visit.cycle).collect();
        cycles.into_iter().collect()
    }

    /// Returns the mean time of all readings, s, or `None` if a time is not known.
    pub(crate) fn mean_time_s(&self) -> Option<f64> {
        let (mut sum, mut count) = (0.0, 0.0);
        for visit in self.visits() {
            let rows = visit.each_ma.len() as f64;
            sum += visit.time_s? * rows;
            count += rows;
        }
        Some(sum / count)
    }

    fn visits(&self) -> impl Iterator<Item = &Visit> {
        self.positions.iter().flat_map(|at| &at.visits)
    }

    /// Returns a remark that lists the columns which were not used, or `None` if there is nothing to report.
    pub(crate) fn remark(&self) -> Option<&str> {
        self.remark.as_deref()
    }
}

fn mean<'a>(each: impl ExactSizeIterator<Item = &'a Vector2<f64>>) -> Vector2<f64> {
    let count = each.len() as f64;
    each.sum::<Vector2<f64>>() / count
}

/// Returns the visits of each position, in the order of their first rows.
fn visits(rows: &[Reading]) -> BTreeMap<PositionIndex, Vec<Visit>> {
    let mut visits: BTreeMap<PositionIndex, Vec<Visit>> = BTreeMap::new();
    // `places`: index of a visit among those of its position. `counted`: last visit number given by the row order.
    let mut places: BTreeMap<(PositionIndex, u32, u32), usize> = BTreeMap::new();
    let mut counted: BTreeMap<(PositionIndex, u32), u32> = BTreeMap::new();
    let mut before = None;
    for row in rows {
        let (index, cycle, stretch) = (row.index, row.cycle, Some((row.index, row.cycle)));
        let last = counted.entry((index, cycle)).or_default();
        // A row without a visit number continues the visit of the previous row, or begins a new one.
        *last += u32::from(before != stretch);
        before = stretch;
        let number = row.visit.unwrap_or(*last);
        let here = visits.entry(index).or_default();
        let place = *places.entry((index, cycle, number)).or_insert(here.len());
        if place == here.len() {
            here.push(Visit { cycle, number, each_ma: Vec::new(), mean_ma: Vector2::zeros(), time_s: Some(0.0) });
        }
        here[place].each_ma.push(row.current_ma);
        // The sum; its mean is taken after the last row.
        here[place].time_s = here[place].time_s.zip(row.time_s).map(|(sum, time_s)| sum + time_s);
    }
    for visit in visits.values_mut().flatten() {
        visit.mean_ma = mean(visit.each_ma.iter());
        visit.time_s = visit.time_s.map(|sum| sum / visit.each_ma.len() as f64);
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

/// Returns a problem for each position without a reading if one other position has more rows than all others: its row may
/// belong there. A column of visits would say that it does not.
fn perhaps_mistaken(coefficients: &Coefficients, readings: &[Reading]) -> Vec<Problem> {
    let count = |wanted: PositionIndex| readings.iter().filter(|row| row.index == wanted).count();
    let most = coefficients.positions.iter().max_by_key(|at| count(at.index));
    let most = most
        .filter(|at| coefficients.positions.iter().filter(|other| count(other.index) == count(at.index)).count() == 1)
        .filter(|at| count(at.index) > 1);
    let Some(most) = most else { return Vec::new() };
    let advice = format!(
        "position {} occurs {} times; check whether one of these rows belongs to this position, or add the column visit",
        most.index,
        count(most.index)
    );
    let missing = coefficients.positions.iter().filter(|at| count(at.index) == 0);
    missing
        .map(|at| whole_file(format!("no reading of position {}", at.index), "a reading of every position", &advice))
        .collect()
}

/// Returns a problem for the first row, in the order of time, that continues a visit after another position was visited.
/// Without times the rows of a visit may stand in any order.
fn torn_visits(table: &Table, readings: &[Reading]) -> Vec<Problem> {
    let timed = |(reading, row): (&Reading, _)| Some((reading.time_s?, *reading, row));
    let Some(mut rows) = readings.iter().zip(&table.rows).map(timed).collect::<Option<Vec<_>>>() else {
        return Vec::new();
    };
    rows.sort_by(|(one, ..), (other, ..)| one.total_cmp(other));
    let mut ended = BTreeSet::new();
    let mut before: Option<(PositionIndex, u32, u32)> = None;
    for (_, reading, row) in rows {
        let Some(visit) = reading.visit else { continue };
        let here = (reading.index, reading.cycle, visit);
        if before.is_some_and(|before| before != here) {
            ended.extend(before);
        }
        before = Some(here);
        if ended.contains(&here) {
            let found = format!("visit {visit} of position {} again, later than another visit", reading.index);
            let advice = "give a return to the position the next number, or check the times";
            let column = table.place("visit").unwrap_or(0);
            return vec![table.problem(&row.cells[column], column, found, "a visit that is not interrupted", advice)];
        }
    }
    Vec::new()
}

/// Returns a problem for the first row whose time cannot be: earlier than the row before it where the order of rows tells
/// the visits, or in a cycle that begins before an earlier one ends.
fn impossible_times(table: &Table, readings: &[Reading]) -> Vec<Problem> {
    let Some(column) = table.place("time_s") else { return Vec::new() };
    let mut last: BTreeMap<u32, f64> = BTreeMap::new();
    for reading in readings {
        let end = last.entry(reading.cycle).or_insert(f64::NEG_INFINITY);
        *end = end.max(reading.time_s.unwrap_or(f64::NEG_INFINITY));
    }
    let mut before = f64::NEG_INFINITY;
    for (reading, row) in readings.iter().zip(&table.rows) {
        let time_s = reading.time_s.unwrap_or(before);
        let refuse = |expected: &str, advice: &str| {
            vec![table.problem(&row.cells[column], column, format!("{time_s} s"), expected, advice)]
        };
        if let Some((cycle, end)) = last.range(..reading.cycle).find(|(_, end)| **end > time_s) {
            let expected = format!("a time after the last one of cycle {cycle}, {end} s");
            return refuse(&expected, "count the time from the first reading of the run, not of each cycle");
        }
        if reading.visit.is_none() && time_s < before {
            let expected = format!("a time not before that of the row above, {before} s");
            return refuse(&expected, "sort the rows by time, or number the visits in the column visit");
        }
        before = time_s;
    }
    Vec::new()
}

/// Returns a problem for each cycle that has readings of one position alone: its own ω_0 would take up all of them.
fn lone_cycles(readings: &[Reading]) -> Vec<Problem> {
    let mut positions: BTreeMap<u32, BTreeSet<PositionIndex>> = BTreeMap::new();
    for reading in readings {
        positions.entry(reading.cycle).or_default().insert(reading.index);
    }
    if positions.len() < 2 {
        return Vec::new();
    }
    let lone = positions.iter().filter(|(_, at)| at.len() == 1).map(|(cycle, _)| *cycle);
    let advice = "leave this cycle out, or check the column cycle: it counts the turn-ons of the gyro";
    lone.map(|cycle| {
        whole_file(format!("one position alone in cycle {cycle}"), "at least two positions in every cycle", advice)
    })
    .collect()
}

/// Returns a problem if the currents of an axis are all zero.
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
