//! Errors of a run: copies from another run, all zeros, another unit, the opposite sign, exchanged or reversed axes, rows
//! of other positions.

use super::{OtherRuns, Reading, averages};
use crate::attitude::ANGLES;
use crate::coefficients::PositionIndex;
use crate::statistics::coincidences::{self, Coincidence};
use crate::text::problem::{MOST_PROBLEMS, Problem};
use crate::text::table::Table;
use nalgebra::Vector3;
use std::collections::{BTreeMap, BTreeSet};

/// Factors by which the angles of a run in another unit are too small, with the name of the unit.
pub(in crate::certification) const UNITS: [(f64, &str); 3] =
    [(60.0, "arcminutes"), (crate::units::ARCSECONDS_PER_DEGREE, "degrees"), (206.264_806, "milliradians")];

/// Tolerance of such a factor, as a factor itself.
const FACTOR_MARGIN: f64 = 1.5;

/// Smallest correlation at which a run is taken to have the angles of the others up to a factor.
const SAME_ANGLES: f64 = 0.9;

/// Returns a problem for every run that is a copy or has another scale or other axes, at the line on which it begins.
pub(super) fn problems(table: &Table, rows: &[Reading], others: &OtherRuns) -> Vec<Problem> {
    let each: [&dyn Fn() -> Vec<Problem>; 6] = [
        &|| zeros(table, rows),
        &|| copies(table, rows),
        &|| single_copies(table, rows),
        &|| other_scales(table, rows, others),
        &|| other_axes(table, rows, others),
        &|| other_rows(table, rows, others),
    ];
    each.iter().map(|problems| problems()).find(|problems| !problems.is_empty()).unwrap_or_default()
}

/// Returns a problem with the `run`, at its first row.
fn at_run(table: &Table, rows: &[Reading], run: u32, found: String, expected: &str, advice: &str) -> Option<Problem> {
    let (.., row) = rows.iter().find(|((_, of), ..)| *of == run)?;
    Some(table.problem(&row[2], 2, found, expected, advice))
}

/// Returns a problem for each run whose angles are all 0, unless those of all runs are.
fn zeros(table: &Table, rows: &[Reading]) -> Vec<Problem> {
    let measured: BTreeSet<u32> =
        rows.iter().filter(|(_, angles, _)| *angles != Vector3::zeros()).map(|((_, run), ..)| *run).collect();
    let runs: BTreeSet<u32> = rows.iter().map(|((_, run), ..)| *run).collect();
    let zeros = runs.difference(&measured).filter(|_| !measured.is_empty());
    let problem = |run: &u32| {
        let found = format!("run {run}, whose angles are all 0");
        at_run(table, rows, *run, found, "measured angles", "fill in the readings, or delete the run")
    };
    zeros.filter_map(problem).collect()
}

/// Returns a problem for each reading that is a copy of that of an earlier run, if there are more than chance explains.
fn single_copies(table: &Table, rows: &[Reading]) -> Vec<Problem> {
    let mut of_position: BTreeMap<PositionIndex, Vec<(u32, Vector3<f64>)>> = BTreeMap::new();
    for ((index, run), (angles, _)) in averages(rows) {
        of_position.entry(index).or_default().push((run, angles));
    }
    let numbers: Vec<Vec<[f64; 3]>> =
        of_position.values().map(|readings| readings.iter().map(|(_, angles)| (*angles).into()).collect()).collect();
    let places: Vec<_> = of_position.iter().collect();
    let problem = |copy: Coincidence| {
        let (index, readings) = places[copy.quantity];
        let [(run, _), (earlier, _)] = [readings[copy.reading], readings[copy.earlier]];
        let (.., row) = rows.iter().find(|(place, ..)| *place == (*index, run))?;
        let found = format!("the angles of run {earlier} again in run {run} of position {index}");
        let advice = "measure the copied readings, or, if all were measured, record more digits";
        Some(table.problem(&row[3], 3, found, "independent readings", advice))
    };
    coincidences::copies(&numbers).into_iter().filter_map(problem).take(MOST_PROBLEMS).collect()
}

/// Returns a problem for each run whose angles are exactly those of an earlier run, if there are more than chance explains.
fn copies(table: &Table, rows: &[Reading]) -> Vec<Problem> {
    let mut of_run: BTreeMap<u32, Vec<u64>> = BTreeMap::new();
    for ((_, run), (angles, _)) in averages(rows) {
        of_run.entry(run).or_default().extend(angles.iter().map(|angle| angle.to_bits()));
    }
    let mut first: BTreeMap<&[u64], u32> = BTreeMap::new();
    let mut copies = Vec::new();
    for (run, angles) in &of_run {
        let earlier = *first.entry(angles).or_insert(*run);
        if earlier != *run {
            copies.push((*run, earlier));
        }
    }
    // Angles of coarse readings agree by themselves. How often they do is seen in runs that follow each other and differ.
    let (mut same, mut all, mut number) = (0.0, 0.0, 0.0);
    for (one, other) in of_run.values().zip(of_run.values().skip(1)).filter(|(one, other)| one != other) {
        number = one.len() as f64;
        all += number;
        same += one.iter().zip(other).filter(|(one, other)| one == other).count() as f64;
    }
    let pairs = of_run.len() as f64 * (of_run.len() as f64 - 1.0) / 2.0;
    if copies.is_empty() || all > 0.0 && coincidences::is_chance(pairs * libm::pow(same / all, number), copies.len()) {
        return Vec::new();
    }
    let problem = |(run, earlier): (u32, u32)| {
        let found = format!("run {run} with the same angles as run {earlier}");
        let advice = "delete the copy, or, if both were measured, record more digits than the readings vary by";
        at_run(table, rows, run, found, "independent readings", advice)
    };
    copies.into_iter().filter_map(problem).collect()
}

/// Returns a problem for each run whose angles are those of the others times a factor.
fn other_scales(table: &Table, rows: &[Reading], others: &OtherRuns) -> Vec<Problem> {
    // For each run: the sums of squares of its angles, of the others' angles, and of the products.
    let mut sums: BTreeMap<u32, [f64; 3]> = BTreeMap::new();
    for ((index, run), angles, _) in rows {
        for axis in 0..3 {
            let Some(others) = others.get(&((*index, *run), axis)) else { continue };
            let usual = others.nearest_middle(angles[axis]);
            let sums = sums.entry(*run).or_default();
            sums[0] += angles[axis] * angles[axis];
            sums[1] += usual * usual;
            sums[2] += angles[axis] * usual;
        }
    }
    let (mut small, mut large) = (Vec::new(), Vec::new());
    for (run, [own, usual, both]) in sums {
        let correlation = both / (own * usual).sqrt();
        if correlation.is_nan() || correlation.abs() < SAME_ANGLES {
            continue;
        }
        let ratio = (own / usual).sqrt();
        let near = |factor: f64| (1.0 / FACTOR_MARGIN..FACTOR_MARGIN).contains(&(ratio * factor));
        let problem = |words: String, advice: &str| {
            let found = format!("run {run}, whose angles are {words}");
            at_run(table, rows, run, found, "angles close to those of the other runs", advice)
        };
        let too_small = UNITS.into_iter().find(|(factor, _)| near(*factor));
        let too_large = UNITS.into_iter().find(|(factor, _)| near(1.0 / factor));
        if let Some((factor, unit)) = too_small {
            let words = format!("those of the other runs divided by {factor:.0}");
            small.extend(problem(words, &format!("the run is in {unit}; convert it to arcseconds")));
        } else if let Some((factor, unit)) = too_large {
            let words = format!("{factor:.0} times those of the other runs");
            let advice = format!("convert it only once, or check whether the other runs are in {unit}");
            large.extend(problem(words, &advice));
        } else if correlation < 0.0 && near(1.0) {
            small.extend(problem("those of the other runs with the opposite sign".to_owned(), "correct the sign"));
        }
    }
    // If one run is too small, all others look too large compared with it.
    if small.is_empty() { large } else { small }
}

/// Column of the file for each angle, with its sign.
pub(in crate::certification) type Axes = [(usize, f64); 3];

/// Factor by which other axes must reduce the sum of the squared differences from the other runs, a fifth of the
/// difference. By chance they do not, not even with three positions and angles that are all scatter.
pub(in crate::certification) const CLEARLY: f64 = 25.0;

/// Returns every order of the three columns with every choice of signs, those that change the fewest columns first; the
/// first changes none. All signs reversed is a matter of scale.
pub(in crate::certification) fn axes_of_runs() -> Vec<Axes> {
    let orders = [[0, 1, 2], [1, 0, 2], [2, 1, 0], [0, 2, 1], [1, 2, 0], [2, 0, 1]];
    let signed = orders.into_iter().flat_map(|order| {
        (0..8_u8)
            .map(move |signs| [0, 1, 2].map(|axis| (order[axis], if signs & (1 << axis) == 0 { 1.0 } else { -1.0 })))
    });
    let mut all: Vec<Axes> = signed.collect();
    all.sort_by_key(|axes| (0..3).filter(|axis| axes[*axis] != (*axis, 1.0)).count());
    all
}

/// Returns the angles whose column or sign differs: the angle, the column in its place and the sign, "-" or nothing.
pub(in crate::certification) fn differing(axes: &Axes) -> impl Iterator<Item = (usize, usize, &'static str)> {
    let changed = axes.iter().enumerate().filter(|(axis, of)| **of != (*axis, 1.0));
    changed.map(|(axis, (column, sign))| (axis, *column, if *sign < 0.0 { "-" } else { "" }))
}

/// Returns a problem for each run whose angles are those of the others once columns are exchanged or signs reversed.
///
/// With two runs, the readings show neither which one is wrong nor whether both merely scatter; they give no problem.
fn other_axes(table: &Table, rows: &[Reading], others: &OtherRuns) -> Vec<Problem> {
    let candidates = axes_of_runs();
    // For each run: the sums of the squared differences from the other runs, for each choice of axes, and the sum of the
    // squared ranges of the others.
    let mut sums: BTreeMap<u32, (Vec<f64>, f64)> = BTreeMap::new();
    for (place, angles, _) in rows {
        let (sums, ranges) = sums.entry(place.1).or_insert_with(|| (vec![0.0; candidates.len()], 0.0));
        for axis in 0..3 {
            let Some(others) = others.get(&(*place, axis)) else { continue };
            *ranges += (others.most - others.least).powi(2);
            for (sum, axes) in sums.iter_mut().zip(&candidates) {
                let (column, sign) = axes[axis];
                let value = sign * angles[column];
                *sum += (value - others.nearest_middle(value)).powi(2);
            }
        }
    }
    if sums.len() < 3 {
        return Vec::new();
    }
    let problem = |(run, (sums, ranges)): (u32, (Vec<f64>, f64))| {
        let least = sums.iter().copied().fold(f64::INFINITY, f64::min);
        // Angles that are all scatter agree with nothing; nor do runs of which several have other axes.
        if CLEARLY * f64::max(least, ranges) >= sums[0] {
            return None;
        }
        // An angle near zero does not show its sign: of about equal candidates the one with the fewest changes.
        let at = sums.iter().position(|sum| *sum <= 2.0 * least)?;
        let words: Vec<String> = differing(&candidates[at])
            .map(|(axis, column, sign)| format!("{sign}{} where the other runs have {}", ANGLES[column], ANGLES[axis]))
            .collect();
        let found = format!("run {run}, which has {}", words.join(", "));
        let advice = "put the angles into the columns of the other runs, with their signs";
        at_run(table, rows, run, found, "the axes of the other runs", advice)
    };
    sums.into_iter().filter_map(problem).collect()
}

/// Returns a problem for each run whose angles are those that the other runs have one row further up or down.
///
/// With two runs, the readings do not show which one is wrong; they give no problem.
fn other_rows(table: &Table, rows: &[Reading], others: &OtherRuns) -> Vec<Problem> {
    let mut of_run: BTreeMap<u32, Vec<&Reading>> = BTreeMap::new();
    for row in rows {
        of_run.entry(row.0.1).or_default().push(row);
    }
    if of_run.len() < 3 {
        return Vec::new();
    }
    // Squared difference of angles from the other runs at the position of another row, and the squared range of those.
    let difference = |angles: &Vector3<f64>, (at, ..): &Reading| -> Option<[f64; 2]> {
        (0..3).try_fold([0.0; 2], |[sum, ranges], axis| {
            let others = others.get(&(*at, axis))?;
            let range = others.most - others.least;
            Some([sum + (angles[axis] - others.nearest_middle(angles[axis])).powi(2), ranges + range * range])
        })
    };
    let problem = |(run, readings): (u32, Vec<&Reading>)| {
        let fits = |by: &isize| {
            let (mut now, mut shifted, mut ranges, mut rows) = (0.0, 0.0, 0.0, 0);
            for (place, reading) in readings.iter().enumerate() {
                let Some(other) = place.checked_add_signed(*by).and_then(|place| readings.get(place)) else { continue };
                let own = difference(&reading.1, reading).zip(difference(&reading.1, other));
                let Some(([here, _], [there, range])) = own else { continue };
                (now, shifted, ranges, rows) = (now + here, shifted + there, ranges + range, rows + 1);
            }
            rows > 2 && CLEARLY * f64::max(shifted, ranges) < now
        };
        let way = if [1, -1].into_iter().find(fits)? > 0 { "below" } else { "above" };
        let found = format!("run {run}, whose angles the other runs have in the row {way}");
        let advice = "the rows of the run are shifted; put the angles into the rows of their positions";
        at_run(table, rows, run, found, "the angles of each position in its own row", advice)
    };
    of_run.into_iter().filter_map(problem).collect()
}
