//! Errors of whole runs: copies of other runs or of another angle, an angle that is constant, and angles in another unit, or in
//! other columns or rows, than those of the other runs.

use super::{Reading, averages};
use crate::attitude::ANGLES;
use crate::certification::found::{Found, Scope};
use crate::certification::kind::Kind;
use crate::certification::remark::in_english;
use crate::certification::transformation::{CLEARLY, Rows, Transformation, exchanged};
use crate::coefficients::PositionIndex;
use crate::stand::Stand;
use crate::statistics::coincidences::{self, Coincidence, step_of_meter};
use crate::text::problem::{MOST_PROBLEMS, Problem};
use crate::text::table::Table;
use crate::wording::Words;
use crate::wording::texts::transformations as texts;
use crate::wording::words::within_a_sentence;
use nalgebra::{DVector, Vector3};
use std::collections::{BTreeMap, BTreeSet};

/// Number of runs that are tried as the reference of the others; fewer than half of them may be wrong.
const REFERENCES: usize = 5;

/// What is wrong with a run, as the error of the file and as a finding.
pub(super) type Wrong = (Problem, Found);

/// Angles of a run by place, as far as it has them.
type Angles = Vec<Option<Vector3<f64>>>;

/// Runs of a file.
pub(super) struct Runs<'a> {
    table: &'a Table<'a>,
    rows: &'a [Reading<'a>],
    positions: Vec<PositionIndex>,
    numbers: Vec<u32>,
    each: Vec<Angles>,
    /// Angles of the certificate with which the file is compared.
    certified: Option<Angles>,
}

impl<'a> Runs<'a> {
    pub(super) fn new(
        table: &'a Table<'a>,
        rows: &'a [Reading<'a>],
        positions: Vec<PositionIndex>,
        against: Option<&Stand>,
    ) -> Self {
        let numbers: BTreeSet<u32> = rows.iter().map(|((_, run), ..)| *run).collect();
        let averages = averages(rows);
        let of_run = |run: &u32| {
            positions.iter().map(|index| averages.get(&(*index, *run)).map(|(angles, _)| *angles)).collect()
        };
        let each = numbers.iter().map(of_run).collect();
        let of_stand = |stand: &Stand, index: &PositionIndex| {
            let at = stand.positions.iter().find(|at| at.index() == *index)?;
            Some(Vector3::from(at.angles_arcsec()))
        };
        let certified = against.map(|stand| positions.iter().map(|index| of_stand(stand, index)).collect());
        Self { table, rows, positions, numbers: numbers.into_iter().collect(), each, certified }
    }

    /// Returns what is wrong with whole runs, of the first kind of error that there is.
    pub(super) fn wrong(&self) -> Vec<Wrong> {
        let each: [&dyn Fn() -> Vec<Wrong>; 4] =
            [&|| self.channels(), &|| self.copies(), &|| self.single_copies(), &|| self.transformed()];
        each.iter().map(|wrong| wrong()).find(|wrong| !wrong.is_empty()).unwrap_or_default()
    }

    /// Returns an error at the first row of a run: what was found, what is expected, and advice.
    fn at_run(&self, run: usize, [found, expected, advice]: [&str; 3], finding: Found) -> Option<Wrong> {
        let (.., row) = self.rows.iter().find(|((_, of), ..)| *of == self.numbers[run])?;
        Some((self.table.problem(&row[2], 2, found.to_owned(), expected, advice), finding))
    }

    /// Returns an error for each run in which an angle is the same in all positions, or a copy of another one, if chance does
    /// not explain it: what should vary does so by many steps in other runs, or in the certificate.
    fn channels(&self) -> Vec<Wrong> {
        let step = step_of_meter(self.each.iter().flatten().flatten().flat_map(|angles| angles.iter().copied()));
        let mut wrong: Vec<Wrong> = Vec::new();
        for [one, other] in [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]] {
            let is_copy = one != other;
            let of = |at: &Vector3<f64>| if is_copy { at[other] - at[one] } else { at[one] };
            let values = |run: &Angles| run.iter().flatten().map(of).collect::<Vec<_>>();
            let is_wrong = |run: &Angles| {
                let values = values(run);
                values.len() > 2 && values.iter().all(|value| *value == if is_copy { 0.0 } else { values[0] })
            };
            let runs: Vec<usize> = (0..self.each.len()).filter(|run| is_wrong(&self.each[*run])).collect();
            let is_all = runs.len() == self.each.len();
            let right = self.each.iter().chain(&self.certified).filter(|run| !is_wrong(run)).map(values);
            // If all are copies, they would differ by as much as they vary.
            let copies = self.each.iter().filter(|_| is_all && is_copy);
            let copies = copies.map(|run| run.iter().flatten().map(|at| at[one]).collect());
            let spread = right.chain(copies).map(|values| spread(&values)).fold(0.0, f64::max);
            for run in runs {
                let alike = values(&self.each[run]).len() as f64 - if is_copy { 0.0 } else { 1.0 };
                let by_chance = if step < spread { step / spread } else { 1.0 };
                let p = coincidences::by_chance(6.0 * self.each.len() as f64 * libm::pow(by_chance, alike), 1);
                let scope = Scope { run: (!is_all).then_some(self.numbers[run]), ..Scope::default() };
                let place = if is_all { "every run".to_owned() } else { format!("run {}", self.numbers[run]) };
                let [one, other] = [one, other].map(|angle| ANGLES[angle]);
                let (kind, scope, found, advised) = if is_copy {
                    let scope = Scope { angles: vec![one, other], ..scope };
                    let found = format!("{other} equal to {one} in every position of {place}");
                    let advice = "measure both angles, or write each into its column";
                    (Kind::ChannelCopied, scope, found, ["angles measured independently", advice])
                } else {
                    let scope = Scope { angle: Some(one), ..scope };
                    let found = format!("{one} the same in every position of {place}");
                    let advice = "fill in the readings, or delete the run";
                    (Kind::ChannelConstant, scope, found, ["measured angles", advice])
                };
                let error = self.at_run(run, [&found, advised[0], advised[1]], in_file(kind, scope, p, &found));
                wrong.extend(error.filter(|_| p < coincidences::COPIED));
                if is_all {
                    break;
                }
            }
        }
        // Constant angles may equal each other.
        let is_constant = wrong.iter().any(|(_, found)| found.kind == Kind::ChannelConstant);
        wrong.retain(|(_, found)| !is_constant || found.kind == Kind::ChannelConstant);
        wrong
    }

    /// Returns an error for each reading that is a copy of that of an earlier run, if there are more than chance explains.
    fn single_copies(&self) -> Vec<Wrong> {
        let readings = |place: usize| {
            let runs = self.each.iter().zip(&self.numbers);
            runs.filter_map(|(run, number)| Some((*number, run[place]?))).collect::<Vec<_>>()
        };
        let all: Vec<_> = (0..self.positions.len()).map(readings).collect();
        let numbers: Vec<Vec<[f64; 3]>> =
            all.iter().map(|readings| readings.iter().map(|(_, angles)| (*angles).into()).collect()).collect();
        let copies = coincidences::copies(&numbers);
        let wrong = |copy: Coincidence| {
            let (index, readings) = (self.positions[copy.quantity], &all[copy.quantity]);
            let [(run, _), (earlier, _)] = [readings[copy.reading], readings[copy.earlier]];
            let (.., row) = self.rows.iter().find(|(place, ..)| *place == (index, run))?;
            let found = format!("the angles of run {earlier} again in run {run} of position {index}");
            let advice = "measure the copied readings, or, if all were measured, record more digits";
            let scope = Scope { position: Some(index), runs: vec![earlier, run], ..Scope::default() };
            let finding = in_file(Kind::RunsCopied, scope, coincidences::COPIED, &found);
            Some((self.table.problem(&row[3], 3, found, "independent readings", advice), finding))
        };
        copies.into_iter().filter_map(wrong).take(MOST_PROBLEMS).collect()
    }

    /// Returns an error for each run whose angles are exactly those of an earlier run, if there are more than chance explains.
    fn copies(&self) -> Vec<Wrong> {
        let bits = |run: &Angles| -> Vec<u64> {
            run.iter()
                .flatten()
                .flat_map(|angles| angles.iter().map(|angle| angle.to_bits()).collect::<Vec<_>>())
                .collect()
        };
        let of_run: Vec<Vec<u64>> = self.each.iter().map(bits).collect();
        let mut first: BTreeMap<&[u64], usize> = BTreeMap::new();
        let mut copies = Vec::new();
        for (run, angles) in of_run.iter().enumerate() {
            let earlier = *first.entry(angles).or_insert(run);
            if earlier != run {
                copies.push((run, earlier));
            }
        }
        // Angles of coarse readings agree by themselves. How often they do is seen in runs that follow each other and differ.
        let (mut same, mut all, mut number) = (0.0, 0.0, 0.0);
        for (one, other) in of_run.iter().zip(of_run.iter().skip(1)).filter(|(one, other)| one != other) {
            number = one.len() as f64;
            all += number;
            same += one.iter().zip(other).filter(|(one, other)| one == other).count() as f64;
        }
        let pairs = of_run.len() as f64 * (of_run.len() as f64 - 1.0) / 2.0;
        let expected = if all > 0.0 { pairs * libm::pow(same / all, number) } else { 0.0 };
        let p = coincidences::by_chance(expected, copies.len());
        if copies.is_empty() || p > coincidences::COPIED {
            return Vec::new();
        }
        let wrong = |(run, earlier): (usize, usize)| {
            let runs = [earlier, run].map(|run| self.numbers[run]);
            let found = format!("run {} with the same angles as run {}", runs[1], runs[0]);
            let advice = "delete the copy, or, if both were measured, record more digits than the readings vary by";
            let scope = Scope { runs: runs.to_vec(), ..Scope::default() };
            let finding = in_file(Kind::RunsCopied, scope, p, &found);
            self.at_run(run, [&found, "independent readings", advice], finding)
        };
        copies.into_iter().filter_map(wrong).collect()
    }

    /// Returns an error for each run whose angles are those of the other runs in another unit, or in other columns or rows.
    ///
    /// The reference is the run to which half of the others are nearest. If half of the runs disagree with it, the
    /// certificate decides which are wrong; without one both are named.
    fn transformed(&self) -> Vec<Wrong> {
        let count = self.each.len();
        let usual = |reference: usize| {
            let mut apart: Vec<f64> =
                (0..count).filter(|run| *run != reference).map(|run| self.apart(run, reference)).collect();
            apart.sort_by(f64::total_cmp);
            // Fewer than half of the others may be wrong; of two runs, either.
            if count > 2 { apart[count.div_ceil(2) - 2] } else { 0.0 }
        };
        let references = (0..count.min(REFERENCES)).map(|reference| (usual(reference), reference));
        let Some((usual, reference)) = references.min_by(|(one, _), (other, _)| one.total_cmp(other)) else {
            return Vec::new();
        };
        let explained = |run: usize, reference: &Angles| {
            let nearest = self.nearest(run, reference)?;
            nearest.explains(CLEARLY, usual).then_some(nearest)
        };
        let is_far = |run: &usize| *run != reference && self.apart(*run, reference) > CLEARLY * usual;
        let far = (0..count).filter(is_far).filter_map(|run| Some((run, explained(run, &self.each[reference])?)));
        let mut wrong: Vec<(usize, Transformation)> = far.collect();
        let is_open = 2 * wrong.len() == count;
        let mut decided = false;
        if let (true, Some(certified)) = (is_open, &self.certified) {
            let against: Vec<_> = (0..count).filter_map(|run| Some((run, explained(run, certified)?))).collect();
            if 2 * against.len() == count {
                (wrong, decided) = (against, true);
            }
        }
        let others: Vec<u32> =
            (0..count).filter(|run| wrong.iter().all(|(of, _)| of != run)).map(|run| self.numbers[run]).collect();
        let error = |(run, change): (usize, Transformation)| {
            let number = self.numbers[run];
            let open = is_open && !decided;
            let scope = match open {
                true => Scope { runs: others.iter().copied().chain([number]).collect(), ..Scope::default() },
                false => Scope { run: Some(number), ..Scope::default() },
            };
            let other: Words = match others[..] {
                _ if decided => texts::OF_CERTIFICATE.into(),
                [only] => texts::of_run(only),
                _ => texts::OF_OTHERS.into(),
            };
            let found = change.of(other, &self.shared(run, &self.each[reference]).1, scope);
            let advice = within_a_sentence(&found.advice.as_ref().map_or_else(String::new, in_english));
            let disagree = if open {
                "the runs disagree, and either may be wrong: compare them with a certificate (--against), or measure a third run; "
            } else {
                ""
            };
            let what = in_english(&found.words);
            let words = [
                &format!("run {number}, in which {what}"),
                "the angles of the other runs",
                &(disagree.to_owned() + &advice),
            ];
            self.at_run(run, words, Found { words: format!("In run {number} {what}.").into(), ..found })
        };
        wrong.into_iter().filter_map(error).collect()
    }

    /// Returns the places that a run and a reference share, with their positions.
    fn shared(&self, run: usize, reference: &Angles) -> (Vec<usize>, Vec<PositionIndex>) {
        let is_shared = |place: &usize| self.each[run][*place].is_some() && reference[*place].is_some();
        let places: Vec<usize> = (0..self.positions.len()).filter(is_shared).collect();
        let positions = places.iter().map(|place| self.positions[*place]).collect();
        (places, positions)
    }

    /// Returns the sum of the squared differences of two runs.
    fn apart(&self, run: usize, other: usize) -> f64 {
        let both = self.each[run].iter().zip(&self.each[other]).filter_map(|(one, other)| Some((*one)? - (*other)?));
        both.map(|difference| difference.norm_squared()).sum()
    }

    fn nearest(&self, run: usize, reference: &Angles) -> Option<Transformation> {
        let (places, positions) = self.shared(run, reference);
        let angles = |of: &Angles| places.iter().filter_map(|place| of[*place]).collect::<Vec<_>>();
        let (read, due) = (angles(&self.each[run]), angles(reference));
        // Places in the order of the rows.
        let of_run = self.rows.iter().filter(|((_, of), ..)| *of == self.numbers[run]);
        let mut order: Vec<usize> =
            of_run.filter_map(|((index, _), ..)| positions.iter().position(|at| at == index)).collect();
        order.dedup();
        let shifted = |by: isize| -> Rows {
            let mut rows = vec![None; order.len()];
            for (row, place) in order.iter().enumerate() {
                rows[*place] = row.checked_add_signed(by).and_then(|row| order.get(row)).copied();
            }
            rows
        };
        let enough = order.len() > 3 && order.len() == positions.len();
        let rows =
            exchanged(&read, &due).into_iter().chain(enough.then(|| [shifted(1), shifted(-1)]).into_iter().flatten());
        let flat = |angles: &[Vector3<f64>]| {
            DVector::from_iterator(3 * angles.len(), angles.iter().flat_map(|at| at.iter().copied()))
        };
        Transformation::nearest(&read, &due, rows, &flat)
    }
}

/// Returns the finding that a file contains something.
fn in_file(kind: Kind, scope: Scope, probability: f64, what: &str) -> Found {
    Found::new(kind, scope, probability, format!("The file contains {what}."))
}

/// Returns the standard deviation of values.
fn spread(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count - 1.0)).sqrt()
}
