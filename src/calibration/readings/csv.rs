//! Currents from CSV: `i,j,jx_ma,jy_ma`, and optionally `cycle`, `visit`, `time_s`, `theta_deg`, `phi_deg`.

use super::times::{
    doubtful_times, impossible_times, over_midnight, scattered_visit, times_in_another_unit, torn_visits,
};
use super::{PositionReadings, Reading, Readings};
use crate::calibration::recorded::Recorded;
use crate::coefficients::{Coefficients, EIGHT_POSITIONS, PositionIndex};
use crate::statistics::coincidences::{self, Coincidence};
use crate::text::advice::beyond_range;
use crate::text::problem::MOST_PROBLEMS;
use crate::text::table::{Row, Table};
use crate::text::{Printable, Problem, Unreadable};
use nalgebra::Vector2;
use std::collections::{BTreeMap, BTreeSet};

pub(crate) const COLUMNS: [&str; 4] = ["i", "j", "jx_ma", "jy_ma"];

/// Advice on a cell without a number.
const NOT_TAKEN: &str = "omit the whole row of a reading that was not taken";

/// Advice on a row without a time, whose currents are as good as those of the others.
const NOT_TIMED: &str = "add the time; if some times are unknown, remove the column";

pub(crate) const OPTIONAL_COLUMNS: [&str; 5] = ["cycle", "visit", "time_s", ANGLE_COLUMNS[0], ANGLE_COLUMNS[1]];

/// Columns of the nominal angles of a row, which must be those of its position.
pub(crate) const ANGLE_COLUMNS: [&str; 2] = ["theta_deg", "phi_deg"];

/// Difference from which the angle of a row is that of another position, degrees.
const ANOTHER_ANGLE_DEG: f64 = 5.0;

/// Position with its nominal angles θ and φ, degrees.
pub(crate) type Nominal = (PositionIndex, [f64; 2]);

impl Readings {
    /// Reads the CSV file `name` for the positions of `coefficients`; `range_ma` is the range of the meter, mA.
    ///
    /// # Errors
    /// Returns [`Unreadable`] with the line and column of every error: invalid form or number, missing or unknown
    /// position, current beyond the range, axis without current.
    pub fn from_csv(name: &str, bytes: &[u8], coefficients: &Coefficients, range_ma: f64) -> Result<Self, Unreadable> {
        let eight = EIGHT_POSITIONS.map(|(index, theta_deg, phi_deg)| (index, [theta_deg, phi_deg]));
        Self::from_csv_at(&eight, name, bytes, coefficients, range_ma)
    }

    /// Reads a CSV file as [`Readings::from_csv`] does, and compares the angles of its rows with the `nominal` ones.
    pub(crate) fn from_csv_at(
        nominal: &[Nominal],
        name: &str,
        bytes: &[u8],
        coefficients: &Coefficients,
        range_ma: f64,
    ) -> Result<Self, Unreadable> {
        let table = Table::read(name, bytes, [&COLUMNS[..2], &COLUMNS[2..], &OPTIONAL_COLUMNS])?;
        let [cycle, visit, time, ..] = OPTIONAL_COLUMNS.map(|column| table.place(column));
        let mut problems = Vec::new();
        let mut readings = Vec::new();
        for row in &table.rows {
            if problems.len() >= MOST_PROBLEMS {
                break;
            }
            let known = coefficients.positions.iter().map(|at| at.index);
            let advice = "check that this is the passport of this stand";
            let index = position(&table, row, known, ("a position of the passport", advice), &mut problems);
            compare_angles(&table, row, index, nominal.iter().copied(), &mut problems);
            let x = current(&table, row, 2, range_ma, &mut problems);
            let y = current(&table, row, 3, range_ma, &mut problems);
            let mut whole = |column: Option<usize>| column.and_then(|column| table.index(row, column, &mut problems));
            let (cycle, visit) = (whole(cycle).unwrap_or(1), whole(visit));
            let time_s = time.and_then(|column| table.number(row, column, NOT_TIMED, &mut problems));
            if let (Some(index), Some(x), Some(y)) = (index, x, y) {
                readings.push(Reading { index, current_ma: Vector2::new(x, y), cycle, visit, time_s });
            }
        }
        if problems.is_empty() {
            // Each kind of problem may be the cause of the next.
            let kinds = [
                if visit.is_none() { perhaps_mistaken(coefficients, &readings) } else { Vec::new() },
                over_midnight(&table, &readings),
                torn_visits(&table, &readings),
                lone_cycles(&readings),
                impossible_times(&table, &readings),
                times_in_another_unit(&readings),
                without_current(&readings),
            ];
            problems = kinds.into_iter().find(|found| !found.is_empty()).unwrap_or_default();
        }
        if !problems.is_empty() {
            return Err(table.refuse(problems));
        }
        let rows = readings;
        let mut readings = Self::of_rows(coefficients, &rows)
            .map_err(|error| Unreadable::whole(name, None, error.to_string(), "a reading of every position", ""))?;
        let recorded = Recorded::of(&mut readings.positions);
        problems = copies(&table, &rows, &readings.positions);
        if !problems.is_empty() {
            return Err(table.refuse(problems));
        }
        let doubts = doubtful_times(&rows)
            .into_iter()
            .chain(scattered_visit(&rows))
            .chain(saturated(&rows, recorded.last_digit_ma));
        let doubt = doubts.map(|doubt| format!("{}: {doubt}", Printable(name)));
        Ok(Self { recorded, remarks: table.remark().into_iter().chain(doubt).collect(), ..readings })
    }
}

/// Number of a position from which it is more likely an angle in degrees.
const SMALLEST_ANGLE: u32 = 45;

/// Returns the position of a row, from its first two columns, if it is `known`; otherwise adds a problem.
pub(crate) fn position(
    table: &Table,
    row: &Row,
    known: impl Iterator<Item = PositionIndex> + Clone,
    (expected, advice): (&str, &str),
    problems: &mut Vec<Problem>,
) -> Option<PositionIndex> {
    let i = table.index(row, 0, problems);
    let j = table.index(row, 1, problems);
    let index = PositionIndex { i: i?, j: j? };
    let is_known = |index: PositionIndex| known.clone().any(|known| known == index);
    let found = is_known(index).then_some(index);
    if found.is_none() {
        let advice = if index.i.max(index.j) >= SMALLEST_ANGLE {
            "i and j are the numbers of θ and φ in the list of positions, not degrees".to_owned()
        } else if is_known(PositionIndex { i: index.j, j: index.i }) {
            format!("{advice}, and that i and j are not exchanged")
        } else {
            advice.to_owned()
        };
        problems.push(table.problem(&row[0], 0, format!("position {index}"), expected, advice));
    }
    found
}

/// Adds a problem for each angle of a row that is not the `nominal` one of its position.
pub(crate) fn compare_angles(
    table: &Table,
    row: &Row,
    index: Option<PositionIndex>,
    mut nominal: impl Iterator<Item = Nominal>,
    problems: &mut Vec<Problem>,
) {
    let Some((index, angles_deg)) = nominal.find(|(known, _)| Some(*known) == index) else { return };
    for (name, nominal_deg) in ANGLE_COLUMNS.into_iter().zip(angles_deg) {
        let Some(column) = table.place(name) else { continue };
        let Some(angle_deg) = table.number(row, column, "state the nominal angle, or delete the column", problems)
        else {
            continue;
        };
        let difference_deg = libm::remainder(angle_deg - nominal_deg, 360.0);
        if difference_deg.abs() > ANOTHER_ANGLE_DEG {
            let expected = format!("{nominal_deg}, the nominal angle of position {index}");
            let advice = "check i and j of this row, and how the stand counts its angles";
            problems.push(table.problem(&row[column], column, format!("{angle_deg}"), &expected, advice));
        }
    }
}

fn current(table: &Table, row: &Row, column: usize, range_ma: f64, problems: &mut Vec<Problem>) -> Option<f64> {
    let value = table.number(row, column, NOT_TAKEN, problems)?;
    if value.abs() <= range_ma {
        return Some(value);
    }
    let usual = if (1e-3..=1e3).contains(&(value.abs() / range_ma)) && value.abs() > 10.0 * range_ma {
        "convert it to milliamperes; it may be in microamperes"
    } else {
        "check the value, or the range of the meter in the laboratory file"
    };
    let advice =
        beyond_range(value, "omit the whole row, or measure it in a larger range").unwrap_or_else(|| usual.into());
    let expected = format!("at most {range_ma} mA in either direction, the range of the meter");
    problems.push(table.problem(&row[column], column, row[column].text.clone(), &expected, advice));
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
        .map(|at| {
            Problem::whole(
                format!("no reading of position {}", at.index),
                "a reading of every position",
                advice.as_str(),
            )
        })
        .collect()
}

/// Smallest size of a current, in steps of the meter, at which two positions do not have it by chance.
const NOT_BY_CHANCE: f64 = 1000.0;

/// Returns a remark if the largest current of an axis was read in several positions to the last digit: that of a meter, or of a
/// feedback loop, at its limit.
fn saturated(readings: &[Reading], step_ma: f64) -> Option<String> {
    let of_axis = |axis: usize| {
        let current = |row: &Reading| row.current_ma[axis];
        let largest = readings.iter().map(current).max_by(|one, other| one.abs().total_cmp(&other.abs()))?;
        let at: BTreeSet<PositionIndex> =
            readings.iter().filter(|row| current(row) == largest).map(|row| row.index).collect();
        (at.len() > 1 && largest.abs() > NOT_BY_CHANCE * step_ma).then(|| {
            let at: Vec<String> = at.iter().map(ToString::to_string).collect();
            format!(
                "{}: exactly {largest}, the largest current, in positions {}; check whether the meter or the feedback loop \
                 was at its limit",
                COLUMNS[2 + axis],
                at.join(", ")
            )
        })
    };
    of_axis(0).or_else(|| of_axis(1))
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
    let advice = "leave this turn-on out, or check the column cycle, which counts the turn-ons";
    lone.map(|cycle| {
        Problem::whole(
            format!("one position alone in turn-on {cycle}"),
            "at least two positions in every turn-on",
            advice,
        )
    })
    .collect()
}

/// Returns a problem for each reading of `kept` that is a copy of an earlier one of its position, if there are more than
/// chance explains.
fn copies(table: &Table, readings: &[Reading], kept: &[PositionReadings]) -> Vec<Problem> {
    let each = |at: &PositionReadings| -> Vec<[f64; 2]> {
        at.visits.iter().flat_map(|visit| &visit.each_ma).map(|row| (*row).into()).collect()
    };
    let numbers: Vec<Vec<[f64; 2]>> = kept.iter().map(each).collect();
    let problem = |Coincidence { quantity, reading, .. }: Coincidence| {
        let alike = |(row, _): &(&Reading, _)| {
            row.index == kept[quantity].index && <[f64; 2]>::from(row.current_ma) == numbers[quantity][reading]
        };
        let mut rows = readings.iter().zip(&table.rows).filter(alike).map(|(_, row)| row);
        let (earlier, row) = (rows.next()?, rows.next_back()?);
        let found = format!("the currents of line {} again", earlier[0].location.line);
        let advice = "delete the copy and measure again, or, if both were measured, record more digits";
        Some(table.problem(&row[2], 2, found, "independent readings", advice))
    };
    coincidences::copies(&numbers).into_iter().filter_map(problem).take(MOST_PROBLEMS).collect()
}

/// Returns a problem if an axis has the same current in all positions, or both axes have the same currents, or opposite ones.
fn without_current(readings: &[Reading]) -> Vec<Problem> {
    let Some(first) = readings.first() else {
        let (expected, advice) = ("a row for every reading", "add the rows with i, j, jx_ma and jy_ma");
        return vec![Problem::whole("no readings".to_owned(), expected, advice)];
    };
    let of_several = readings.iter().any(|row| row.index != first.index);
    let all = |is_so: &dyn Fn(Vector2<f64>) -> bool| of_several && readings.iter().all(|row| is_so(row.current_ma));
    let constant = |axis: usize| all(&|current| current[axis] == first.current_ma[axis]);
    let channels = "check that each axis was recorded from its own channel in every position";
    let of_axis =
        |axis: usize, symbol: &str| format!("a current {symbol} of {} mA in every position", first.current_ma[axis]);
    let (found, advice) = match (constant(0), constant(1)) {
        (true, true) if first.current_ma == Vector2::zeros() => {
            ("currents that are all zero".to_owned(), "check that the gyro was running with its feedback loop closed")
        }
        (true, _) => (of_axis(0, "J_x"), channels),
        (_, true) => (of_axis(1, "J_y"), channels),
        _ if all(&|current| current.x == current.y) => ("a current J_y that always equals J_x".to_owned(), channels),
        _ if all(&|current| current.x == -current.y) => ("a current J_y that always equals −J_x".to_owned(), channels),
        _ => return Vec::new(),
    };
    vec![Problem::whole(found, "currents of both axes", advice)]
}
