//! Angles read in every position and run: CSV `i,j,run,alpha_arcsec,beta_arcsec,gamma_arcsec`.

mod whole_runs;

use super::found::Found;
use super::header::NominalPosition;
use crate::calibration::readings::csv::{ANGLE_COLUMNS, compare_angles, position};
use crate::calibration::recorded::{SPREAD_OVER_DIGITS, rounding_of};
use crate::coefficients::PositionIndex;
use crate::stand::{Excluded, Stand, beyond_largest_deviation};
use crate::statistics::coincidences::step_of_meter;
use crate::text::Unreadable;
use crate::text::problem::{MOST_PROBLEMS, Problem};
use crate::text::scalar::sha256_hex;
use crate::text::table::{Row, Table};
use crate::units::ARCSECONDS_PER_DEGREE;
use nalgebra::Vector3;
use std::collections::{BTreeMap, BTreeSet};
use whole_runs::Runs;

pub(crate) const COLUMNS: [&str; 6] = ["i", "j", "run", "alpha_arcsec", "beta_arcsec", "gamma_arcsec"];

/// Largest difference from the other runs that can be scatter; a stand that repeats only to 10′ cannot be certified.
pub(crate) const LARGEST_SCATTER_ARCSEC: f64 = 600.0;

/// Readings of every position in every run.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct AngleReadings {
    /// Numbers of the runs, ascending.
    pub(crate) runs: Vec<u32>,
    /// (α, β, γ) in arcseconds, `[position][run]`, with the positions in the order requested.
    pub(crate) each_arcsec: Vec<Vec<Vector3<f64>>>,
    /// Line of the first row of each reading, `[position][run]`; empty if the readings do not come from a file.
    lines: Vec<Vec<usize>>,
    /// Step of the angles in the file, such as their last digit, arcsec.
    pub(crate) step_arcsec: f64,
    /// Number of rows that repeat the reading of a visit.
    pub(crate) repeated_rows: usize,
    /// SHA-256 of the file in lower-case hexadecimal; `None` if the readings do not come from a file.
    pub(crate) sha256: Option<String>,
    /// Remark about ignored columns of the file.
    pub(crate) remark: Option<String>,
    pub(crate) excluded: Vec<Excluded>,
    /// Excluded readings, whose angles are predicted from the others: places of position and run.
    pub(crate) missing: Vec<(usize, usize)>,
}

/// Error for readings that do not contain every position in every run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("every position must have a reading in every run")]
pub struct NotBalanced;

/// Position and run of a reading.
type Place = (PositionIndex, u32);

/// Row of the file with its position, its run and its angles, arcsec.
type Reading<'t> = (Place, Vector3<f64>, &'t Row);

impl AngleReadings {
    /// Creates readings from `each_arcsec[position][run]`, (α, β, γ) in arcseconds, and the numbers of the `runs`.
    ///
    /// # Errors
    /// Returns [`NotBalanced`] if there are no runs or no positions, or if a position does not have one reading per
    /// run.
    pub fn new(runs: Vec<u32>, each_arcsec: Vec<Vec<Vector3<f64>>>) -> Result<Self, NotBalanced> {
        let balanced = !runs.is_empty() && !each_arcsec.is_empty();
        if balanced && each_arcsec.iter().all(|position| position.len() == runs.len()) {
            let step_arcsec = step_of_meter(each_arcsec.iter().flatten().flat_map(|angles| angles.iter().copied()));
            Ok(Self { runs, each_arcsec, step_arcsec, ..Self::default() })
        } else {
            Err(NotBalanced)
        }
    }

    /// Reads the CSV file `name` for `positions`. Rows with the same position and run are repeated readings of one
    /// visit, and are averaged.
    ///
    /// # Errors
    /// Returns [`Unreadable`] with every error at its line and column: form, numbers, positions unknown or missing from
    /// a run, angles beyond 45°, angles too far off to be scatter (another unit, another position).
    pub fn from_csv(name: &str, bytes: &[u8], positions: &[NominalPosition]) -> Result<Self, Unreadable> {
        Self::from_csv_without(name, bytes, positions, &[], None)
    }

    /// Reads a CSV file as [`AngleReadings::from_csv`] does, without the `excluded` readings and runs, whose angles are
    /// not examined. Where half of the runs disagree, the certificate that the file is compared `against` decides.
    ///
    /// # Errors
    /// Returns the errors of [`AngleReadings::from_csv`], and one for each exclusion that is not in the file or leaves
    /// fewer than two readings of a position.
    pub(crate) fn from_csv_without(
        name: &str,
        bytes: &[u8],
        positions: &[NominalPosition],
        excluded: &[Excluded],
        against: Option<&Stand>,
    ) -> Result<Self, Unreadable> {
        let table = Table::read(name, bytes, [&COLUMNS[..3], &COLUMNS[3..], &ANGLE_COLUMNS])?;
        let mut problems = Vec::new();
        let mut rows: Vec<Reading> = Vec::new();
        let is_out = |place| excluded.iter().any(|excluded| is_excluded(excluded, place));
        for row in &table.rows {
            if problems.len() >= MOST_PROBLEMS {
                break;
            }
            let known = positions.iter().map(NominalPosition::index);
            let advice = "check that these are the readings of this stand";
            let index = position(&table, row, known, ("a position of the stand file", advice), &mut problems);
            let nominal = positions.iter().map(|at| (at.index(), [at.theta_deg, at.phi_deg]));
            compare_angles(&table, row, index, nominal, &mut problems);
            let run = table.index(row, 2, &mut problems);
            // The angles of an excluded reading are not examined; its cells may be empty.
            if let Some(place) = index.zip(run).filter(|place| is_out(*place)) {
                rows.push((place, Vector3::zeros(), row));
                continue;
            }
            let angles = [3, 4, 5].map(|column| angle(&table, row, column, index.zip(run), &mut problems));
            if let (Some(index), Some(run), [Some(x), Some(y), Some(z)]) = (index, run, angles) {
                rows.push(((index, run), Vector3::new(x, y, z), row));
            }
        }
        let refuse_any =
            |problems: Vec<Problem>| if problems.is_empty() { Ok(()) } else { Err(table.refuse(problems)) };
        refuse_any(problems)?;
        refuse_any(torn(&table, &rows))?;
        refuse_any(not_there(&rows, excluded))?;
        rows.retain(|(place, ..)| !is_out(*place));
        refuse_any(incomplete(&table, positions, &rows, excluded))?;
        let indices = positions.iter().map(NominalPosition::index).collect();
        let (problems, findings): (Vec<_>, Vec<_>) =
            Runs::new(&table, &rows, indices, against).wrong().into_iter().unzip();
        refuse_any(problems).map_err(|refusal| refusal.because_of(findings.iter().map(Found::to_json)))?;
        refuse_any(slips(&table, &rows))?;
        let (sha256, excluded) = (Some(sha256_hex(bytes)), excluded.to_vec());
        Ok(Self { sha256, remark: table.remark(), excluded, ..Self::averaged(positions, &rows) })
    }

    fn averaged(positions: &[NominalPosition], rows: &[Reading]) -> Self {
        let averages = averages(rows);
        let runs: BTreeSet<u32> = rows.iter().map(|((_, run), ..)| *run).collect();
        let mut missing = Vec::new();
        let (mut each_arcsec, mut lines) = (Vec::new(), Vec::new());
        for (place, at) in positions.iter().enumerate() {
            let of_runs: Vec<_> = runs.iter().map(|run| averages.get(&(at.index(), *run))).collect();
            let there: Vec<_> = of_runs.iter().flatten().map(|(angles, _)| angles).collect();
            // The mean of the other runs, until the angles can be predicted from all other readings.
            let middle = there.iter().copied().sum::<Vector3<f64>>() / there.len().max(1) as f64;
            missing.extend((0..of_runs.len()).filter(|run| of_runs[*run].is_none()).map(|run| (place, run)));
            each_arcsec.push(of_runs.iter().map(|of_run| of_run.map_or(middle, |(angles, _)| *angles)).collect());
            lines.push(of_runs.iter().map(|of_run| of_run.map_or(0, |(_, line)| *line)).collect());
        }
        Self {
            runs: runs.into_iter().collect(),
            each_arcsec,
            lines,
            step_arcsec: step_of_meter(rows.iter().flat_map(|(_, angles, _)| angles.iter().copied())),
            repeated_rows: rows.len() - averages.len(),
            missing,
            ..Self::default()
        }
    }

    /// Returns the line of the file with the reading of a position (by its place in the order requested) in a run (by
    /// its place among the runs), or `None` if the readings do not come from a file.
    pub(crate) fn line(&self, position: usize, run: usize) -> Option<usize> {
        self.lines.get(position)?.get(run).copied()
    }

    /// Returns the standard uncertainty of the rounding of α, β or γ (`angle` 0, 1, 2) of a position, arcsec, by its place in
    /// the order requested; 0 if its readings vary over the steps, because their mean is then free of the rounding.
    ///
    /// Readings that stay on one step are rounded alike in every run, and their mean by as much as each of them.
    pub(crate) fn rounding_arcsec(&self, position: usize, angle: usize) -> f64 {
        let is_read = |run: &usize| !self.missing.contains(&(position, *run));
        let values: Vec<f64> =
            (0..self.runs.len()).filter(is_read).map(|run| self.each_arcsec[position][run][angle]).collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>();
        let spread = (squares / (count - 1.0)).sqrt();
        if spread < SPREAD_OVER_DIGITS * self.step_arcsec { rounding_of(self.step_arcsec) } else { 0.0 }
    }

    /// Returns the standard uncertainty of the rounding in the mean of an angle, arcsec, where the scatter of visits is known
    /// from finer readings, which do not contain it.
    pub(crate) fn rounding_of_mean_arcsec(&self, position: usize, angle: usize) -> f64 {
        let independent = rounding_of(self.step_arcsec) / (self.runs.len() as f64).sqrt();
        self.rounding_arcsec(position, angle).max(independent)
    }

    /// Returns `true` if visits scatter by less than half a step of the readings, with this standard deviation: which
    /// readings differ is then a matter of rounding.
    pub(crate) fn is_coarse(&self, scatter_arcsec: f64) -> bool {
        scatter_arcsec < SPREAD_OVER_DIGITS * self.step_arcsec
    }

    /// Returns the means (α, β, γ) of each position over the runs, arcsec.
    pub(crate) fn means_arcsec(&self) -> Vec<Vector3<f64>> {
        let runs = self.runs.len() as f64;
        self.each_arcsec.iter().map(|position| position.iter().sum::<Vector3<f64>>() / runs).collect()
    }
}

/// Returns the mean of the rows of each visit, arcsec, and the line of the first.
fn averages(rows: &[Reading]) -> BTreeMap<Place, (Vector3<f64>, usize)> {
    let mut sums: BTreeMap<Place, (Vector3<f64>, f64, usize)> = BTreeMap::new();
    for (place, angles, row) in rows {
        let first = row[0].location.line;
        let (sum, count, _) = sums.entry(*place).or_insert((Vector3::zeros(), 0.0, first));
        *sum += angles;
        *count += 1.0;
    }
    sums.into_iter().map(|(place, (sum, count, line))| (place, (sum / count, line))).collect()
}

fn angle(table: &Table, row: &Row, column: usize, place: Option<Place>, problems: &mut Vec<Problem>) -> Option<f64> {
    // Without its row the run would be incomplete.
    let not_taken = place.map_or_else(String::new, |(PositionIndex { i, j }, run)| {
        format!("measure it, or keep the row and exclude it with --exclude {i},{j},{run} and --why")
    });
    let value = table.number(row, column, &not_taken, problems)?;
    let Some((expected, advice)) = beyond_largest_deviation(value, &not_taken) else { return Some(value) };
    problems.push(table.problem(&row[column], column, row[column].text.clone(), &expected, advice));
    None
}

/// Returns `true` if the reading at a place is excluded.
fn is_excluded(excluded: &Excluded, (index, run): Place) -> bool {
    excluded.run == run && excluded.index().is_none_or(|of| of == index)
}

/// Returns a problem for the first row that continues a run at a position after another position: the platform has moved
/// away, so it is not a repeated reading of the same visit.
fn torn(table: &Table, rows: &[Reading]) -> Vec<Problem> {
    let mut ended = BTreeSet::new();
    for pair in rows.windows(2) {
        let [(before, ..), (place, _, row)] = pair else { continue };
        if before != place {
            ended.insert(*before);
            if ended.contains(place) {
                let (index, run) = place;
                let found = format!("run {run} of position {index} again, after another position");
                let expected = "the rows of a position and run one after the other";
                let advice =
                    "give the second visit the number of another run, or put the readings of one visit together";
                return vec![table.problem(&row[2], 2, found, expected, advice)];
            }
        }
    }
    Vec::new()
}

/// Returns a problem for each exclusion that concerns no reading of the file.
fn not_there(rows: &[Reading], excluded: &[Excluded]) -> Vec<Problem> {
    let missing = excluded.iter().filter(|excluded| !rows.iter().any(|(place, ..)| is_excluded(excluded, *place)));
    let problem = |excluded: &Excluded| {
        let found = format!("no reading of {} to exclude", excluded.describe());
        Problem::whole(found, "its row in the file, with or without angles", "add the row, or check --exclude")
    };
    missing.map(problem).collect()
}

/// Returns a problem for each run with less than half of the positions, for each position without any reading, and for each
/// position missing from another run.
fn incomplete(table: &Table, positions: &[NominalPosition], rows: &[Reading], excluded: &[Excluded]) -> Vec<Problem> {
    let mut runs: BTreeSet<u32> = rows.iter().map(|((_, run), ..)| *run).collect();
    let there: BTreeSet<Place> = rows.iter().map(|(place, ..)| *place).collect();
    let mut problems = Vec::new();
    let is_excluded = |place: Place| excluded.iter().any(|excluded| is_excluded(excluded, place));
    let missing = |run: u32| {
        let places = positions.iter().map(move |at| (at.index(), run));
        places.filter(|place| !there.contains(place) && !is_excluded(*place)).count()
    };
    let is_begun = |run: u32| 2 * missing(run) > positions.len();
    // Most of these are one number mistyped. Its position is named below, where it is missing.
    if !runs.iter().all(|run| is_begun(*run)) {
        for run in runs.iter().copied().filter(|run| is_begun(*run)).take(MOST_PROBLEMS) {
            let Some((.., row)) = rows.iter().find(|((_, of), ..)| *of == run) else { continue };
            let found = format!("run {run}, in which {} of {} positions are missing", missing(run), positions.len());
            let advice = "correct the number of the run, measure the other positions, or omit the run";
            problems.push(table.problem(&row[2], 2, found, "every position in every run", advice));
        }
        runs.retain(|run| !is_begun(*run));
    }
    for at in positions {
        if problems.len() >= MOST_PROBLEMS {
            break;
        }
        let mut missing: Vec<u32> = runs.iter().copied().filter(|run| !there.contains(&(at.index(), *run))).collect();
        let of_exclusions = |run: u32| is_excluded((at.index(), run));
        let left = runs.len() - missing.len();
        if left < 2 && missing.iter().any(|run| of_exclusions(*run)) {
            let found = format!("{left} readings of position {} after the exclusions", at.index());
            problems.push(Problem::whole(found, "at least two", "measure the position again"));
            continue;
        }
        if missing.len() == runs.len() {
            let advice = "check that these are the readings of this stand";
            problems.push(Problem::whole(
                format!("no reading of position {}", at.index()),
                "a reading of every position",
                advice,
            ));
            continue;
        }
        missing.retain(|run| !of_exclusions(*run));
        let advice = "measure it, or omit the whole run, because only complete runs show their common part; to exclude it, \
                      add its row with empty cells, and give --exclude and --why";
        for run in missing.into_iter().take(MOST_PROBLEMS - problems.len()) {
            let found = format!("no reading of position {} in run {run}", at.index());
            problems.push(Problem::whole(found, "every position in every run", advice));
        }
    }
    problems
}

/// Returns a problem for each angle that cannot be scatter: too far from the other runs, or in another unit.
fn slips(table: &Table, rows: &[Reading]) -> Vec<Problem> {
    // Sorted once for each position and axis: sorting for each row would take minutes for a file of 10,000 runs.
    let mut of_position: BTreeMap<(PositionIndex, usize), Vec<f64>> = BTreeMap::new();
    let averages = averages(rows);
    for ((index, _), (angles, _)) in &averages {
        (0..3).for_each(|axis| of_position.entry((*index, axis)).or_default().push(angles[axis]));
    }
    of_position.values_mut().for_each(|values| values.sort_by(f64::total_cmp));
    let mut problems = Vec::new();
    for (place @ (index, _), angles, row) in rows {
        for axis in 0..3 {
            let own = averages[place].0[axis];
            let Some(values) = of_position.get(&(*index, axis)).filter(|values| values.len() > 1) else { continue };
            let last = values.len() - 1;
            // Of two runs either may be right; with more, the reading may agree with either of the middle ones.
            let usual = match last {
                1 => values[usize::from(own == values[0])],
                _ => angles[axis].clamp(values[last / 2], values[last.div_ceil(2)]),
            };
            let (least, most) =
                (values[usize::from(own == values[0])], values[last - usize::from(own == values[last])]);
            let Some(advice) = slip(angles[axis], usual, most - least) else { continue };
            if problems.len() >= MOST_PROBLEMS {
                return problems;
            }
            let column = 3 + axis;
            let expected = format!("about {usual}, as in the other runs of position {index}");
            problems.push(table.problem(&row[column], column, format!("{}", angles[axis]), &expected, advice));
        }
    }
    problems
}

/// Returns the advice for an erroneous `value`, where the other runs have about `usual` within `spread`, all arcsec;
/// `None` if it can be scatter.
fn slip(value: f64, usual: f64, spread: f64) -> Option<&'static str> {
    let factor_of_degree = |ratio: f64| (ARCSECONDS_PER_DEGREE / 2.0..=ARCSECONDS_PER_DEGREE * 2.0).contains(&ratio);
    // A reading may be near zero by chance, so the factor counts only if the usual value is clearly not zero.
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
