//! Findings of a comparison: what its readings show, or leave open, in words, and what it says in the list of causes.

use super::Certification;
use super::compared::{CommonTurn, ComparedPosition, Test};
use super::found::{Found, Scope};
use super::kind::{Kind, OUTLIER, STRAGGLER};
use super::remark::Remark;
use crate::wording::Words;
use crate::wording::number::Number;
use crate::wording::texts::remarks as texts;
use nalgebra::Vector3;
use std::fmt::{Display, Formatter};

/// Effect of a finding on the result of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// The stand has changed.
    Change,
    /// The angles stand in other places or in another unit.
    Misplaced,
    /// Outlier among the readings or the runs of a check, with which nothing is decided.
    Outlier,
    /// Readings that scatter so much more than the certificate states, by the fault of the stand or of the instrument, that
    /// nothing is decided with them.
    LargeScatter,
    /// Readings that are not a new measurement, with which nothing is decided.
    OfCertificate,
    /// A limit of the result, or what does not change it.
    Limit,
}

/// Reason for the result of a comparison, or a limit of it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Finding {
    pub role: Role,
    pub remark: Remark,
    /// Entry of the finding in the list of causes; `None` if the finding is not a cause.
    pub cause: Option<Found>,
}

impl Display for Finding {
    fn fmt(&self, to: &mut Formatter<'_>) -> std::fmt::Result {
        self.remark.fmt(to)
    }
}

impl Finding {
    pub(super) fn new(role: Role, remark: impl Into<Remark>) -> Self {
        Self { role, remark: remark.into(), cause: None }
    }

    /// Returns a finding that is a cause.
    pub(super) fn of(role: Role, cause: Found) -> Self {
        Self { role, remark: Remark::of(&cause), cause: Some(cause) }
    }

    /// Returns the finding that the whole stand has changed, with the probability of chance.
    pub(super) fn of_stand(role: Role, probability: f64, words: impl Into<Words>) -> Self {
        Self::of(role, Found::new(Kind::StandChanged, Scope::default(), probability, words))
    }

    pub(crate) fn is_change(&self) -> bool {
        matches!(self.role, Role::Change | Role::Misplaced)
    }

    /// Returns the finding on a position that does not repeat; or that repeats, but differs from the others by more than chance
    /// explains in most checks.
    fn of_position(at: &ComparedPosition) -> Self {
        let [x, y, z] = std::array::from_fn(|axis| Number::measured(at.turn_arcsec[axis], at.u_arcsec[axis]));
        let (role, words) = match at.repeats {
            false => (Role::Change, texts::position_changed(at.index, x, y, z)),
            true => (Role::Limit, texts::position_straggles(at.index, x, y, z)),
        };
        let scope = Scope { position: Some(at.index), ..Scope::default() };
        let found = Found::new(Kind::StandChanged, scope, at.test.probability, words);
        Self::of(role, found.sized(Vector3::from(at.turn_arcsec).norm()))
    }
}

/// Runs, or rotations between them, that are suspect.
const OF_RUNS: [Kind; 4] = [Kind::Bump, Kind::RunTurned, Kind::StandMoved, Kind::StandDrift];

/// Returns the findings of a comparison: of `all` positions relative to each other, of each of the `positions`, and of
/// their `common` rotation, where `moved` states that it is significant. An outlier among the readings of the check,
/// whose certification is `again`, or among its runs does not show that the position, or the stand, has changed, and
/// neither do `misplaced` readings. `every` says what it means that no more than half of the positions repeat.
pub(super) fn findings(
    all: Test,
    positions: &[ComparedPosition],
    common: &CommonTurn,
    again: Option<&Certification>,
    moved: bool,
    misplaced: Vec<Found>,
    every: impl FnOnce() -> Finding,
) -> Vec<Finding> {
    let suspect: Vec<&Found> = again.map_or_else(Vec::new, suspect);
    let runs = again.map_or(1, |again| again.runs.len());
    // Exchanged readings explain the change of a position, and so does an outlier among them: the rest is within 3 u.
    let explained = |at: &ComparedPosition| {
        let is_exchanged = |pair: &[[u32; 2]; 2]| pair.contains(&[at.index.i, at.index.j]);
        let part = |found: &Found, axis: usize| found.turns_arcsec[axis] / runs as f64;
        let is_within = |found: &Found| {
            (0..3).all(|axis| (at.turn_arcsec[axis] - part(found, axis)).abs() <= 3.0 * at.u_arcsec[axis])
        };
        misplaced.iter().filter_map(|found| found.scope.between.as_ref()).any(is_exchanged)
            || suspect.iter().any(|found| found.accuses() && found.scope.position == Some(at.index) && is_within(found))
    };
    // A run during which the stand moved changes all positions of the check, as another unit does.
    let is_whole = misplaced.iter().any(|found| found.scope.between.is_none());
    let is_bumped = suspect.iter().any(|found| found.kind == Kind::Bump);
    let changed: Vec<_> = positions.iter().filter(|at| !at.repeats).collect();
    let mut findings = if is_whole || is_bumped {
        Vec::new()
    } else if !changed.is_empty() && changed.len() == positions.len() {
        if misplaced.is_empty() { vec![every()] } else { Vec::new() }
    } else if !changed.is_empty() {
        changed.into_iter().filter(|at| !explained(at)).map(Finding::of_position).collect()
    } else if all.probability < OUTLIER {
        vec![Finding::of_stand(Role::Change, all.probability, texts::CHANGED_TOGETHER)]
    } else if all.probability < STRAGGLER {
        vec![Finding::of_stand(Role::Limit, all.probability, texts::CHANGED_SLIGHTLY)]
    } else {
        let straggles = |at: &&ComparedPosition| at.test.probability * (positions.len() as f64) < STRAGGLER;
        let is_sound = suspect.is_empty() && misplaced.is_empty();
        positions.iter().filter(straggles).filter(|_| is_sound).map(Finding::of_position).collect()
    };
    let is_turned = suspect.iter().any(|found| OF_RUNS.contains(&found.kind) && found.accuses());
    // If no positions agree, there is no rotation that is common to them.
    if positions.iter().any(|at| at.repeats) && !is_whole {
        let probability = common.test.map_or(1.0, |test| test.probability);
        if moved && !is_turned {
            findings.push(Finding::of_stand(Role::Change, probability, texts::ROTATED));
        } else if !moved && probability < STRAGGLER {
            findings.push(Finding::of_stand(Role::Limit, probability, texts::ROTATED_SLIGHTLY));
        }
    }
    let suspect = suspect.into_iter().map(|found| {
        let role = if found.accuses() { Role::Outlier } else { Role::Limit };
        Finding::new(role, Remark::of(found))
    });
    let misplaced = misplaced.into_iter().map(|found| Finding::of(Role::Misplaced, found));
    misplaced.chain(suspect).chain(findings).collect()
}

/// Returns what is suspect in the readings of a check itself.
fn suspect(check: &Certification) -> Vec<&Found> {
    let of_readings = [Kind::Angle, Kind::Reading, Kind::PositionMoved];
    let is_suspect =
        |found: &&Found| OF_RUNS.contains(&found.kind) || of_readings.contains(&found.kind) && found.accuses();
    check.findings.iter().filter(is_suspect).collect()
}
