//! The angles read in every position and run: CSV `i,j,run,alpha_arcsec,beta_arcsec,gamma_arcsec`.

mod whole_runs;

use super::header::NominalPosition;
use crate::coefficients::PositionIndex;
use crate::stand::LARGEST_DEVIATION_DEG;
use crate::text::Unreadable;
use crate::text::problem::{MOST_PROBLEMS, Problem};
use crate::text::scalar::sha256_hex;
use crate::text::table::{Row, Table};
use crate::units::ARCSECONDS_PER_DEGREE;
use nalgebra::Vector3;
use std::collections::{BTreeMap, BTreeSet};

/// The columns of the file.
pub(crate) const COLUMNS: [&str; 6] = ["i", "j", "run", "alpha_arcsec", "beta_arcsec", "gamma_arcsec"];

/// Farther than this from the other runs a reading is a slip, not scatter: a stand that repeats to 10′ alone is none.
pub(crate) const LARGEST_SCATTER_ARCSEC: f64 = 600.0;

/// Readings of every position in every run.
#[derive(Debug, Clone, PartialEq)]
pub struct AngleReadings {
    runs: Vec<u32>,
    each_arcsec: Vec<Vec<Vector3<f64>>>,
    /// `[position][run]`, of the first row of each; empty when the readings come from no file.
    lines: Vec<Vec<usize>>,
    repeated_rows: usize,
    sha256: Option<String>,
    remark: Option<String>,
}

/// Readings that do not hold every position in every run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("every position must have a reading in every run")]
pub struct NotBalanced;

/// Where a reading stands: its position and its run.
type Place = (PositionIndex, u32);

/// A row of the file: where it stands, and the angles in arcsec.
type Reading<'t> = (Place, Vector3<f64>, &'t Row);

impl AngleReadings {
    /// `each_arcsec[position][run]` holds (α, β, γ) of a position in a run; `runs` are the runs' numbers.
    ///
    /// # Errors
    /// [`NotBalanced`] when a position has another number of readings than there are runs, or there is none.
    pub fn new(runs: Vec<u32>, each_arcsec: Vec<Vec<Vector3<f64>>>) -> Result<Self, NotBalanced> {
        let balanced = !runs.is_empty() && !each_arcsec.is_empty();
        if balanced && each_arcsec.iter().all(|position| position.len() == runs.len()) {
            Ok(Self { runs, each_arcsec, lines: Vec::new(), repeated_rows: 0, sha256: None, remark: None })
        } else {
            Err(NotBalanced)
        }
    }

    /// Reads the CSV file `name` for `positions`; rows of the same position and run are one return read several times,
    /// and are averaged.
    ///
    /// # Errors
    /// [`Unreadable`] with every mistake at its line and column: form, numbers, positions unknown or missing from a run,
    /// angles beyond 45°, angles that are no scatter (another unit, another position).
    pub fn from_csv(name: &str, bytes: &[u8], positions: &[NominalPosition]) -> Result<Self, Unreadable> {
        let table = Table::read(name, bytes, &COLUMNS, &[])?;
        let mut problems = Vec::new();
        let mut rows: Vec<Reading> = Vec::new();
        for row in &table.rows {
            if problems.len() >= MOST_PROBLEMS {
                break;
            }
            let index = position(&table, row, positions, &mut problems);
            let run = table.index(row, 2, &mut problems);
            let angles = [3, 4, 5].map(|column| angle(&table, row, column, &mut problems));
            if let (Some(index), Some(run), [Some(x), Some(y), Some(z)]) = (index, run, angles) {
                rows.push(((index, run), Vector3::new(x, y, z), row));
            }
        }
        if problems.is_empty() {
            problems = incomplete(positions, &rows);
        }
        if problems.is_empty() {
            let others = other_runs(&rows);
            problems = whole_runs::problems(&table, &rows, &others);
            if problems.is_empty() {
                problems = slips(&table, &rows, &others);
            }
        }
        if problems.is_empty() {
            Ok(Self { sha256: Some(sha256_hex(bytes)), remark: table.remark(), ..Self::averaged(positions, &rows) })
        } else {
            Err(table.refuse(problems))
        }
    }

    fn averaged(positions: &[NominalPosition], rows: &[Reading]) -> Self {
        let averages = averages(rows);
        let runs: BTreeSet<u32> = rows.iter().map(|((_, run), ..)| *run).collect();
        let of_position = |at: &NominalPosition| -> Vec<_> {
            runs.iter().filter_map(|run| averages.get(&(at.index(), *run))).collect()
        };
        let each: Vec<_> = positions.iter().map(of_position).collect();
        let angles = |runs: &Vec<&(Vector3<f64>, usize)>| runs.iter().map(|(angles, _)| *angles).collect();
        let lines = |runs: &Vec<&(Vector3<f64>, usize)>| runs.iter().map(|(_, line)| *line).collect();
        Self {
            runs: runs.into_iter().collect(),
            each_arcsec: each.iter().map(angles).collect(),
            lines: each.iter().map(lines).collect(),
            repeated_rows: rows.len() - averages.len(),
            sha256: None,
            remark: None,
        }
    }

    /// Returns what is to be said of the file: which of its columns were left out of account.
    pub(crate) fn remark(&self) -> Option<&str> {
        self.remark.as_deref()
    }

    /// The runs' numbers, ascending.
    pub(crate) fn runs(&self) -> &[u32] {
        &self.runs
    }

    /// (α, β, γ) in arcseconds: `[position][run]`, positions in the order they were asked for.
    pub(crate) fn each_arcsec(&self) -> &[Vec<Vector3<f64>>] {
        &self.each_arcsec
    }

    /// Returns the line of the file on which a position (by its place in the order asked for) is read in a run (by its place
    /// among the runs), or `None` if the readings come from no file.
    pub(crate) fn line(&self, position: usize, run: usize) -> Option<usize> {
        self.lines.get(position)?.get(run).copied()
    }

    /// How many rows read a return again that had been read already.
    pub(crate) fn repeated_rows(&self) -> usize {
        self.repeated_rows
    }

    /// Returns the SHA-256 of the file in lower-case hexadecimal, or `None` if the readings come from no file.
    pub(crate) fn sha256(&self) -> Option<&str> {
        self.sha256.as_deref()
    }

    /// Means over the runs, arcseconds.
    pub(crate) fn means_arcsec(&self) -> Vec<Vector3<f64>> {
        let runs = self.runs.len() as f64;
        self.each_arcsec.iter().map(|position| position.iter().sum::<Vector3<f64>>() / runs).collect()
    }
}

/// The means of rows that read one return again, arcsec, and the line of the first.
fn averages(rows: &[Reading]) -> BTreeMap<Place, (Vector3<f64>, usize)> {
    let mut sums: BTreeMap<Place, (Vector3<f64>, f64, usize)> = BTreeMap::new();
    for (place, angles, row) in rows {
        let first = row.cells[0].location.line;
        let (sum, count, _) = sums.entry(*place).or_insert((Vector3::zeros(), 0.0, first));
        *sum += angles;
        *count += 1.0;
    }
    sums.into_iter().map(|(place, (sum, count, line))| (place, (sum / count, line))).collect()
}

fn position(
    table: &Table,
    row: &Row,
    positions: &[NominalPosition],
    problems: &mut Vec<Problem>,
) -> Option<PositionIndex> {
    let i = table.index(row, 0, problems);
    let j = table.index(row, 1, problems);
    let index = PositionIndex { i: i?, j: j? };
    if positions.iter().any(|at| at.index() == index) {
        return Some(index);
    }
    let advice = "check that these are the readings of this stand";
    let found = format!("position {index}");
    problems.push(table.problem(&row.cells[0], 0, found, "a position of the stand file", advice));
    None
}

fn angle(table: &Table, row: &Row, column: usize, problems: &mut Vec<Problem>) -> Option<f64> {
    let value = table.number(row, column, problems)?;
    let largest = LARGEST_DEVIATION_DEG * ARCSECONDS_PER_DEGREE;
    if value.abs() <= largest {
        return Some(value);
    }
    let advice = "state deviations from the nominal position, in arcseconds";
    let expected = format!("at most {LARGEST_DEVIATION_DEG} degrees ({largest} arcseconds) in either direction");
    problems.push(table.problem(&row.cells[column], column, format!("{value}"), &expected, advice));
    None
}

/// Positions without any reading, and positions missing from a run.
fn incomplete(positions: &[NominalPosition], rows: &[Reading]) -> Vec<Problem> {
    let runs: BTreeSet<u32> = rows.iter().map(|((_, run), ..)| *run).collect();
    let there: BTreeSet<Place> = rows.iter().map(|(place, ..)| *place).collect();
    let mut problems = Vec::new();
    for at in positions {
        if problems.len() >= MOST_PROBLEMS {
            break;
        }
        let missing: Vec<u32> = runs.iter().copied().filter(|run| !there.contains(&(at.index(), *run))).collect();
        if missing.len() == runs.len() {
            let advice = "check that these are the readings of this stand";
            problems.push(whole_file(
                format!("no reading of position {}", at.index()),
                "a reading of every position",
                advice,
            ));
            continue;
        }
        let advice = "measure it, or omit the whole run, because only complete runs show their common part";
        for run in missing.into_iter().take(MOST_PROBLEMS - problems.len()) {
            let found = format!("no reading of position {} in run {run}", at.index());
            problems.push(whole_file(found, "every position in every run", advice));
        }
    }
    problems
}

/// Readings that are no scatter: too far from the other runs, or of another unit.
fn slips(table: &Table, rows: &[Reading], others: &OtherRuns) -> Vec<Problem> {
    let mut problems = Vec::new();
    for ((index, run), angles, row) in rows {
        for axis in 0..3 {
            let Some(others) = others.get(&((*index, *run), axis)) else { continue };
            let usual = others.nearest_middle(angles[axis]);
            let Some(advice) = slip(angles[axis], usual, others.most - others.least) else { continue };
            if problems.len() >= MOST_PROBLEMS {
                return problems;
            }
            let column = 3 + axis;
            let expected = format!("about {usual}, as in the other runs of position {index}");
            problems.push(table.problem(&row.cells[column], column, format!("{}", angles[axis]), &expected, advice));
        }
    }
    problems
}

/// By place and axis.
type OtherRuns = BTreeMap<(Place, usize), Others>;

/// The angle that the other runs have at a position, arcsec.
struct Others {
    least: f64,
    middle: [f64; 2],
    most: f64,
}

impl Others {
    /// Returns what of their middle is nearest to `value`. Of two other runs that differ each may be right, so neither is held
    /// against it.
    fn nearest_middle(&self, value: f64) -> f64 {
        value.clamp(self.middle[0], self.middle[1])
    }
}

/// For every place and axis the angles that other runs have at its position.
///
/// Sorted once for each position and axis: sorting for each row anew would take minutes for a file of 10,000 runs.
fn other_runs(rows: &[Reading]) -> OtherRuns {
    let mut of_position: BTreeMap<(PositionIndex, usize), Vec<(f64, u32)>> = BTreeMap::new();
    for ((index, run), angles, _) in rows {
        for axis in 0..3 {
            of_position.entry((*index, axis)).or_default().push((angles[axis], *run));
        }
    }
    let mut others = BTreeMap::new();
    for ((index, axis), mut values) in of_position {
        values.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let mut places_of_run: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (place, (_, run)) in values.iter().enumerate() {
            places_of_run.entry(*run).or_default().push(place);
        }
        for (run, own) in places_of_run {
            let count = values.len() - own.len();
            if count == 0 {
                continue;
            }
            // The n-th of the others: the run's own up to there are passed over.
            let nth = |n: usize| values[own.iter().fold(n, |at, place| at + usize::from(*place <= at))].0;
            let middle = [nth((count - 1) / 2), nth(count / 2)];
            others.insert(((index, run), axis), Others { least: nth(0), middle, most: nth(count - 1) });
        }
    }
    others
}

/// What is wrong with `value` where the other runs have about `usual` within `spread`, all arcseconds.
fn slip(value: f64, usual: f64, spread: f64) -> Option<&'static str> {
    let factor_of_degree = |ratio: f64| (ARCSECONDS_PER_DEGREE / 2.0..=ARCSECONDS_PER_DEGREE * 2.0).contains(&ratio);
    // A reading near zero by chance is no slip: the usual one must stand clear of zero.
    let clear = |angle: f64| angle.abs() > f64::max(1.0, 3.0 * spread);
    if clear(usual) && factor_of_degree((usual / value).abs()) {
        Some("convert it from degrees to arcseconds; it is too small by a factor of 3,600")
    } else if (value - usual).abs() <= LARGEST_SCATTER_ARCSEC {
        None
    } else if factor_of_degree((value / usual).abs()) {
        Some(
            "convert it to arcseconds only once, or check whether the other runs are in degrees; it is too large by \
              a factor of 3,600",
        )
    } else {
        Some("check the digits, the sign and the position")
    }
}

fn whole_file(found: String, expected: &str, advice: &str) -> Problem {
    let (expected, advice) = (expected.to_owned(), advice.to_owned());
    Problem { location: None, field: String::new(), found, expected, advice }
}
