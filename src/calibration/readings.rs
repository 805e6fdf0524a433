//! The currents of positions, grouped by visit.
//!
//! A visit is one arrival at a position with its rows, which are the readings taken there without leaving the position.
//! Further visits reduce errors that further rows of the same visit do not reduce.
//!
//! * `csv`: reading a file of currents.
//! * `times`: checks of the order and the times of its rows.

pub(crate) mod csv;
mod times;

use super::recorded::Recorded;
use crate::coefficients::{Coefficients, PositionIndex};
use crate::text::record;
use crate::units::SECONDS_PER_HOUR;
use nalgebra::{Matrix2, Vector2};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};

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
    /// Number of visits before this one, if the order of the rows tells it; not if each position was visited once, because
    /// the rows may then be in the order of the positions.
    pub(crate) before: Option<usize>,
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

record! {
    /// Visit that is left out of a calibration.
    #[derive(Eq, Deserialize)]
    #[serde(deny_unknown_fields, expecting = "struct ExclusionDocument")]
    pub(crate) struct Exclusion {
        /// Frame index.
        pub i: u32,
        /// Platform index.
        pub j: u32,
        /// Number of the visit within its cycle and position.
        pub visit: u32,
        /// Turn-on of the gyro; `None` if there is no other visit of that number to the position.
        pub cycle: Option<u32>,
        /// Reason.
        pub why: String,
    }
}

impl PositionReadings {
    pub(super) fn new(index: PositionIndex, visits: Vec<Visit>) -> Self {
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
    /// Positions of the coefficients without a reading.
    pub(crate) left_out: Vec<PositionIndex>,
    /// Visits that were left out, with their reasons.
    pub(crate) exclusions: Vec<Exclusion>,
    /// Last digit and scatter of the recorded currents; the default if they were not read from a file.
    pub(crate) recorded: Recorded,
    /// Remarks on how the file was read, on columns that were not used, on times that may be in another unit, and on
    /// currents at a limit.
    pub(crate) remarks: Vec<String>,
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
        Ok(Self { positions, left_out, exclusions: Vec::new(), recorded: Recorded::default(), remarks: Vec::new() })
    }

    /// Leaves a visit out, with the reason on record.
    ///
    /// # Errors
    /// Returns the reason if there is no such visit, or one in several cycles, or no other reading would be left.
    pub(crate) fn exclude(&mut self, exclusion: Exclusion) -> Result<(), String> {
        let Exclusion { i, j, visit: number, cycle, .. } = exclusion;
        let index = PositionIndex { i, j };
        let is_it = |visit: &&Visit| visit.number == number && cycle.is_none_or(|cycle| visit.cycle == cycle);
        let missing = |there: &str| format!("found no visit {number} to position {index} to exclude; {there}");
        let place = self.positions.iter().position(|at| at.index == index);
        let place = place.ok_or_else(|| missing("the position has no readings"))?;
        let at = &self.positions[place];
        let found: Vec<u32> = at.visits.iter().filter(is_it).map(|visit| visit.cycle).collect();
        match found.as_slice() {
            [] => {
                let there: BTreeSet<u32> = at.visits.iter().map(|visit| visit.number).collect();
                let there: Vec<String> = there.iter().map(u32::to_string).collect();
                return Err(missing(&format!("the position has visit {}", there.join(", "))));
            }
            [_] => {}
            cycles => {
                return Err(format!(
                    "position {index} has a visit {number} in the turn-ons {}; add the turn-on, as in {},{},{number},{}",
                    cycles.iter().map(u32::to_string).collect::<Vec<_>>().join(", "),
                    index.i,
                    index.j,
                    cycles[0]
                ));
            }
        }
        let rest: Vec<Visit> = at.visits.iter().filter(|visit| !is_it(visit)).cloned().collect();
        if rest.is_empty() {
            if self.positions.len() == 1 {
                return Err("the last reading cannot be excluded".to_owned());
            }
            self.positions.remove(place);
            self.left_out.push(index);
        } else {
            self.positions[place] = PositionReadings::new(index, rest);
        }
        self.exclusions.push(Exclusion { cycle: Some(found[0]), ..exclusion });
        Ok(())
    }

    /// Leaves a row of a visit out, or returns `None` if there is no such row, or no other one.
    pub(crate) fn leave_out_row(&mut self, index: PositionIndex, visit: (u32, u32), row: usize) -> Option<()> {
        let at = self.positions.iter_mut().find(|at| at.index == index)?;
        let found = at.visits.iter_mut().find(|found| (found.cycle, found.number) == visit)?;
        if found.each_ma.len() < 2 || row >= found.each_ma.len() {
            return None;
        }
        found.each_ma.remove(row);
        found.mean_ma = mean(found.each_ma.iter());
        *at = PositionReadings::new(index, std::mem::take(&mut at.visits));
        Some(())
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

    /// Returns the readings with other times, s.
    pub(crate) fn timed_by(&self, time_s: impl Fn(&Visit) -> f64) -> Self {
        let mut timed = self.clone();
        for visit in timed.positions.iter_mut().flat_map(|at| &mut at.visits) {
            visit.time_s = Some(time_s(visit));
        }
        timed
    }

    /// Returns the readings of one turn-on.
    pub(crate) fn of_cycle(&self, cycle: u32) -> Self {
        let mut alone = self.clone();
        for mut at in std::mem::take(&mut alone.positions) {
            at.visits.retain(|visit| visit.cycle == cycle);
            match at.visits.is_empty() {
                true => alone.left_out.push(at.index),
                false => alone.positions.push(PositionReadings::new(at.index, at.visits)),
            }
        }
        alone
    }

    /// Returns the readings with the currents of a turn-on multiplied by a matrix.
    pub(crate) fn mapped(&self, cycle: u32, map: &Matrix2<f64>) -> Self {
        let mut mapped = self.clone();
        for at in &mut mapped.positions {
            for visit in at.visits.iter_mut().filter(|visit| visit.cycle == cycle) {
                visit.each_ma.iter_mut().chain([&mut visit.mean_ma]).for_each(|current| *current = map * *current);
            }
            *at = PositionReadings::new(at.index, std::mem::take(&mut at.visits));
        }
        mapped
    }

    /// Returns the readings with the number of earlier visits as the time, one hour for each, if they have no times and the
    /// order of their rows tells the visits; otherwise `None`.
    pub(crate) fn timed_by_order(&self) -> Option<Self> {
        let by_order = self.visits().all(|visit| visit.time_s.is_none() && visit.before.is_some());
        by_order.then(|| self.timed_by(|visit| visit.before.unwrap_or(0) as f64 * SECONDS_PER_HOUR))
    }

    pub(crate) fn visits(&self) -> impl Iterator<Item = &Visit> {
        self.positions.iter().flat_map(|at| &at.visits)
    }
}

fn mean<'a>(each: impl ExactSizeIterator<Item = &'a Vector2<f64>>) -> Vector2<f64> {
    let count = each.len() as f64;
    each.sum::<Vector2<f64>>() / count
}

/// Returns `true` if numbered visits seem to be in the order in which they were made: those of a position are, and the rows
/// are not sorted by position.
fn rise_with_the_rows(rows: &[Reading], visits: &BTreeMap<PositionIndex, Vec<Visit>>) -> bool {
    let stretches = rows.chunk_by(|one, next| one.index == next.index).count();
    stretches > visits.len() && visits.values().all(|each| each.is_sorted_by_key(|visit| (visit.cycle, visit.number)))
}

/// Returns the visits of each position, in the order of their first rows.
fn visits(rows: &[Reading]) -> BTreeMap<PositionIndex, Vec<Visit>> {
    let mut visits: BTreeMap<PositionIndex, Vec<Visit>> = BTreeMap::new();
    // `places`: index of a visit among those of its position. `counted`: last visit number given by the row order.
    let mut places: BTreeMap<(PositionIndex, u32, u32), usize> = BTreeMap::new();
    let mut counted: BTreeMap<(PositionIndex, u32), u32> = BTreeMap::new();
    let mut before = None;
    let mut total = 0;
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
            let (each_ma, mean_ma, time_s) = (Vec::new(), Vector2::zeros(), Some(0.0));
            here.push(Visit { cycle, number, each_ma, mean_ma, time_s, before: Some(total) });
            total += 1;
        }
        here[place].each_ma.push(row.current_ma);
        // The sum; its mean is taken after the last row.
        here[place].time_s = here[place].time_s.zip(row.time_s).map(|(sum, time_s)| sum + time_s);
    }
    let once = total == visits.len();
    let told = rows.iter().all(|row| row.visit.is_none()) || rise_with_the_rows(rows, &visits);
    for visit in visits.values_mut().flatten() {
        visit.before = visit.before.filter(|_| !once && told);
        visit.mean_ma = mean(visit.each_ma.iter());
        visit.time_s = visit.time_s.map(|sum| sum / visit.each_ma.len() as f64);
    }
    visits
}
