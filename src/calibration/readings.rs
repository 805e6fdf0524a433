//! The currents read in every position: CSV `i,j,jx_ma,jy_ma`, several rows for a position being repeated readings.

use crate::coefficients::{Coefficients, PositionIndex};
use crate::text::Unreadable;
use crate::text::problem::{MOST_PROBLEMS, Problem};
use crate::text::table::{Row, Table};
use nalgebra::Vector2;

/// The columns of the file.
pub const COLUMNS: [&str; 4] = ["i", "j", "jx_ma", "jy_ma"];

/// Readings of one position.
#[derive(Debug, Clone, PartialEq)]
pub struct PositionReadings {
    /// Which position.
    pub index: PositionIndex,
    /// Every reading (J_x, J_y), in the order of the file; at least one.
    pub each_ma: Vec<Vector2<f64>>,
    /// Their mean.
    pub mean_ma: Vector2<f64>,
}

impl PositionReadings {
    /// Standard deviations of one reading of J_x and J_y about the mean, mA; `None` of a single reading.
    pub fn standard_deviation_ma(&self) -> Option<Vector2<f64>> {
        let count = self.each_ma.len();
        let squares = self.each_ma.iter().map(|reading| (reading - self.mean_ma).map(|x| x * x)).sum::<Vector2<f64>>();
        (count > 1).then(|| (squares / (count - 1) as f64).map(f64::sqrt))
    }
}

/// Readings of every position, in the order of the coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct Readings {
    positions: Vec<PositionReadings>,
}

/// Why readings do not fit the positions.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoReadings {
    /// A position that has none.
    #[error("no reading of position {0}")]
    Missing(PositionIndex),
    /// A position that the coefficients do not know.
    #[error("a reading of position {0}, which the passport does not have")]
    Unknown(PositionIndex),
    /// A current that is no finite number.
    #[error("a current of position {0} is not a finite number")]
    NotFinite(PositionIndex),
}

impl Readings {
    /// Readings in any order, repeated ones too.
    ///
    /// # Errors
    /// See [`NoReadings`].
    pub fn new(coefficients: &Coefficients, readings: &[(PositionIndex, Vector2<f64>)]) -> Result<Self, NoReadings> {
        let known = |index: PositionIndex| coefficients.positions.iter().any(|at| at.index == index);
        if let Some((index, _)) = readings.iter().find(|(index, _)| !known(*index)) {
            return Err(NoReadings::Unknown(*index));
        }
        if let Some((index, _)) = readings.iter().find(|(_, current)| !current.iter().all(|j| j.is_finite())) {
            return Err(NoReadings::NotFinite(*index));
        }
        let positions = coefficients.positions.iter().map(|at| {
            let own = readings.iter().filter(|(index, _)| *index == at.index);
            let each_ma: Vec<_> = own.map(|(_, current)| *current).collect();
            if each_ma.is_empty() {
                return Err(NoReadings::Missing(at.index));
            }
            let mean_ma = each_ma.iter().sum::<Vector2<f64>>() / each_ma.len() as f64;
            Ok(PositionReadings { index: at.index, each_ma, mean_ma })
        });
        Ok(Self { positions: positions.collect::<Result<_, _>>()? })
    }

    /// Reads the CSV file `name` for the positions of `coefficients`; `range_ma` is the meter's range.
    ///
    /// # Errors
    /// [`Unreadable`] with every mistake at its line and column: form, numbers, positions missing or unknown,
    /// currents beyond the range, an axis without current.
    pub fn from_csv(name: &str, bytes: &[u8], coefficients: &Coefficients, range_ma: f64) -> Result<Self, Unreadable> {
        let table = Table::read(name, bytes, &COLUMNS)?;
        let mut problems = Vec::new();
        let mut readings = Vec::new();
        for row in &table.rows {
            if problems.len() >= MOST_PROBLEMS {
                break;
            }
            let index = position(&table, row, coefficients, &mut problems);
            let x = current(&table, row, 2, range_ma, &mut problems);
            let y = current(&table, row, 3, range_ma, &mut problems);
            if let (Some(index), Some(x), Some(y)) = (index, x, y) {
                readings.push((index, Vector2::new(x, y)));
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
        Self::new(coefficients, &readings)
            .map_err(|error| Unreadable::whole(name, None, error.to_string(), "a reading of every position", ""))
    }

    /// Readings of every position, in the order of the coefficients.
    pub fn positions(&self) -> &[PositionReadings] {
        &self.positions
    }

    /// Mean currents (J_x, J_y) in mA, in the order of the coefficients.
    pub fn means_ma(&self) -> Vec<Vector2<f64>> {
        self.positions.iter().map(|position| position.mean_ma).collect()
    }
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
    let advice = "is it the passport of this stand?";
    let found = format!("position {index}");
    problems.push(table.problem(&row.cells[0], 0, found, "a position that the passport has", advice));
    None
}

fn current(table: &Table, row: &Row, column: usize, range_ma: f64, problems: &mut Vec<Problem>) -> Option<f64> {
    let value = table.number(row, column, problems)?;
    if value.abs() <= range_ma {
        return Some(value);
    }
    let advice = if (1e-3..=1e3).contains(&(value.abs() / range_ma)) && value.abs() > 10.0 * range_ma {
        "is it in microamperes? The column is in milliamperes"
    } else {
        "the meter's range is in the laboratory file"
    };
    let expected = format!("at most {range_ma} mA either way, the meter's range");
    problems.push(table.problem(&row.cells[column], column, format!("{value}"), &expected, advice));
    None
}

/// Positions without a reading.
fn incomplete(coefficients: &Coefficients, readings: &[(PositionIndex, Vector2<f64>)]) -> Vec<Problem> {
    let count = |wanted: PositionIndex| readings.iter().filter(|(index, _)| *index == wanted).count();
    let most = coefficients.positions.iter().max_by_key(|at| count(at.index));
    let double = most
        .filter(|at| coefficients.positions.iter().filter(|other| count(other.index) == count(at.index)).count() == 1);
    let advice = match double {
        Some(at) if count(at.index) > 1 => {
            format!("position {} stands {} times: is one of them this one?", at.index, count(at.index))
        }
        _ => String::new(),
    };
    let missing = coefficients.positions.iter().filter(|at| count(at.index) == 0);
    missing
        .map(|at| whole_file(format!("no reading of position {}", at.index), "a reading of every position", &advice))
        .collect()
}

/// Axes whose currents are all zero.
fn without_current(readings: &[(PositionIndex, Vector2<f64>)]) -> Vec<Problem> {
    let zero = |axis: usize| readings.iter().all(|(_, current)| current[axis] == 0.0);
    let (found, advice) = match (zero(0), zero(1)) {
        (true, true) => ("currents that are all zero", "was the gyro running and its feedback closed?"),
        (true, false) => ("a current J_x that is zero in every position", "both axes are needed"),
        (false, true) => ("a current J_y that is zero in every position", "both axes are needed"),
        (false, false) => return Vec::new(),
    };
    vec![whole_file(found.to_owned(), "currents of both axes", advice)]
}

fn whole_file(found: String, expected: &str, advice: &str) -> Problem {
    let (expected, advice) = (expected.to_owned(), advice.to_owned());
    Problem { location: None, field: String::new(), found, expected, advice }
}
