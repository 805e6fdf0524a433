//! Findings of a comparison: reasons for its result and its limits, and their words in each language.

use super::Certification;
use super::compared::{CommonTurn, ComparedPosition, Test, Untested};
use super::found::{Found, Scope};
use super::kind::{Kind, OUTLIER, STRAGGLER};
use super::remark::{advised, in_english};
use crate::wording::Words;
use crate::wording::number::{Number, Probability};
use crate::wording::texts::remarks as texts;
use crate::wording::words::code;
use nalgebra::Vector3;
use std::fmt::{Display, Formatter};

/// Probability by chance below which a check agrees better with the certificate than a new measurement can.
pub(super) const TOO_CLOSE: f64 = 1e-6;

/// Ratio of the scatter of a check to the certified one above which nothing is decided.
const MUCH_MORE: f64 = 2.0;

/// Reason for the result of a comparison, or a limit of it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Finding {
    /// Change of a setting, which explains all differences.
    Setting(Found),
    /// Half of the positions or more have changed, to angles that still resemble the certified ones; their correlation.
    Worn(f64),
    /// Half of the positions or more have changed, and the angles do not resemble the certified ones.
    AnotherStand,
    /// Angles of the certificate in other places or in another unit.
    Misplaced(Found),
    /// Standard deviations of one visit, and the probability that the first is so much larger by chance.
    ScattersMore {
        of_check_arcsec: f64,
        certified_arcsec: f64,
        probability: f64,
    },
    Changed(ComparedPosition),
    /// Significant differences of all positions together, of none alone.
    ChangedTogether,
    Slightly,
    /// Position that repeats, but differs from the others by more than chance explains in most checks.
    Straggler(ComparedPosition),
    Rotated,
    RotatedSlightly,
    /// What is wrong with the readings of the check themselves.
    Suspect(Found),
    NotTested(Untested),
    /// Smallest rotations about an axis of the case that the check finds with a probability of 95 %: of one position and,
    /// if it was tested, of the platform, arcsec.
    Detects {
        position_arcsec: f64,
        platform_arcsec: Option<f64>,
    },
    /// Angles without uncertainty in the certificate.
    TreatedAsExact,
    SameReadings,
    TooClose,
}

/// The English sentences without the last full stop, with advice: the wording of terminals.
impl Display for Finding {
    fn fmt(&self, to: &mut Formatter<'_>) -> std::fmt::Result {
        to.write_str(&in_english(&self.advised()))
    }
}

impl Finding {
    /// Returns the finding as sentences.
    pub(crate) fn words(&self) -> Words {
        match self {
            Self::Changed(ComparedPosition { index, turn_arcsec, u_arcsec, .. })
            | Self::Straggler(ComparedPosition { index, turn_arcsec, u_arcsec, .. }) => {
                let [x, y, z] = std::array::from_fn(|axis| Number::measured(turn_arcsec[axis], u_arcsec[axis]));
                match self.is_change() {
                    true => texts::position_changed(*index, x, y, z),
                    false => texts::position_straggles(*index, x, y, z),
                }
            }
            Self::ScattersMore { of_check_arcsec, certified_arcsec, probability } => {
                let [found, certified] =
                    [of_check_arcsec, certified_arcsec].map(|value| Number::significant(*value, 2));
                texts::scatters_more(found, certified, Probability(*probability))
            }
            Self::Suspect(found) | Self::Misplaced(found) | Self::Setting(found) => found.words.clone(),
            Self::Worn(correlation) => texts::worn(Number::fixed(*correlation, 2)),
            Self::AnotherStand => texts::ANOTHER_STAND.into(),
            Self::ChangedTogether => texts::CHANGED_TOGETHER.into(),
            Self::Slightly => texts::CHANGED_SLIGHTLY.into(),
            Self::Rotated => texts::ROTATED.into(),
            Self::RotatedSlightly => texts::ROTATED_SLIGHTLY.into(),
            Self::NotTested(Untested::Variation) => texts::NOT_TESTED_VARIATION.into(),
            Self::NotTested(Untested::NumberOfRuns) => texts::NOT_TESTED_RUNS.into(),
            Self::NotTested(Untested::CommonParts) => texts::NOT_TESTED_COMMON_PARTS.into(),
            Self::Detects { position_arcsec, platform_arcsec } => {
                let position = Number::significant(*position_arcsec, 2);
                match platform_arcsec.map(|turn| Number::significant(turn, 2)) {
                    Some(platform) => texts::detects(position, platform),
                    None => texts::detects_of_position(position),
                }
            }
            Self::TreatedAsExact => texts::TREATED_AS_EXACT.into(),
            Self::SameReadings => texts::SAME_READINGS.into(),
            Self::TooClose => texts::TOO_CLOSE.into(),
        }
    }

    /// Returns what to do at a terminal, with the keys and options of files and commands.
    fn advice(&self) -> Option<Words> {
        Some(match self {
            Self::Suspect(found) | Self::Misplaced(found) | Self::Setting(found) => return found.advice.clone(),
            Self::Worn(_) => texts::DO_RECERTIFY.into(),
            Self::ScattersMore { .. } => texts::DO_TELL_WHICH.into(),
            Self::NotTested(Untested::NumberOfRuns) => texts::DO_TWO_RUNS.into(),
            Self::NotTested(Untested::CommonParts) => {
                texts::do_common_parts(code("common_platform_arcsec"), code("common_base_arcsec"))
            }
            Self::TreatedAsExact => {
                let [alpha, beta, gamma] = ["u_alpha_arcsec", "u_beta_arcsec", "u_gamma_arcsec"].map(code);
                texts::do_state_u(alpha, beta, gamma)
            }
            Self::TooClose => texts::DO_CHECK_AND_MEASURE.into(),
            _ => return None,
        })
    }

    /// Returns the finding and what to do, as a terminal says it.
    pub(crate) fn advised(&self) -> Words {
        advised(self.words(), self.advice())
    }

    /// Returns `true` for readings that are not a new measurement, with which nothing is decided.
    pub(crate) fn is_of_the_certificate(&self) -> bool {
        matches!(self, Self::SameReadings | Self::TooClose)
    }

    /// Returns `true` for readings that scatter so much more than the certificate states, by the fault of the stand or of the
    /// instrument, that nothing is decided with them.
    pub(crate) fn is_large_scatter(&self) -> bool {
        matches!(self, Self::ScattersMore { of_check_arcsec, certified_arcsec, .. }
            if *of_check_arcsec > MUCH_MORE * certified_arcsec)
    }

    /// Returns `true` for an outlier among the readings or the runs of a check, with which nothing is decided.
    pub(crate) fn is_outlier(&self) -> bool {
        matches!(self, Self::Suspect(found) if found.accuses())
    }

    pub(crate) fn is_change(&self) -> bool {
        matches!(
            self,
            Self::Setting(_)
                | Self::Worn(_)
                | Self::AnotherStand
                | Self::Misplaced(_)
                | Self::Changed(_)
                | Self::ChangedTogether
                | Self::Rotated
        )
    }

    /// Returns `true` for readings of which the angles stand in other places or in another unit.
    pub(crate) fn is_misplaced(&self) -> bool {
        matches!(self, Self::Misplaced(_))
    }

    fn is_of(&self, kinds: &[Kind]) -> bool {
        matches!(self, Self::Suspect(found) if kinds.contains(&found.kind))
    }

    /// Returns `true` if exchanged readings explain the change of the position, or an outlier among them: the rest is within
    /// 3 u.
    fn explains(&self, at: &ComparedPosition, runs: usize) -> bool {
        match self {
            Self::Misplaced(Found { scope: Scope { between: Some(pair), .. }, .. }) => {
                pair.contains(&[at.index.i, at.index.j])
            }
            Self::Suspect(found) if found.accuses() && found.scope.position == Some(at.index) => {
                let part = |axis: usize| found.turns_arcsec[axis] / runs as f64;
                (0..3).all(|axis| (at.turn_arcsec[axis] - part(axis)).abs() <= 3.0 * at.u_arcsec[axis])
            }
            _ => false,
        }
    }

    /// Returns what the finding says in the list of causes, if it is one of them.
    pub(crate) fn cause(&self, all: Test, common: &CommonTurn) -> Option<Found> {
        let changed = |scope, probability, words: Words| Found::new(Kind::StandChanged, scope, probability, words);
        let whole = |probability| Some(changed(Scope::default(), probability, self.words()));
        match self {
            Self::Misplaced(found) | Self::Setting(found) => Some(found.clone()),
            Self::Changed(at) | Self::Straggler(at) => {
                let scope = Scope { position: Some(at.index), ..Scope::default() };
                let size = Vector3::from(at.turn_arcsec).norm();
                Some(changed(scope, at.test.probability, self.words()).sized(size))
            }
            Self::Worn(_) | Self::AnotherStand | Self::ChangedTogether | Self::Slightly => whole(all.probability),
            Self::Rotated | Self::RotatedSlightly => whole(common.test.map_or(1.0, |test| test.probability)),
            Self::TooClose => Some(Found::new(Kind::Computed, Scope::default(), TOO_CLOSE, self.words())),
            _ => None,
        }
    }
}

/// Returns the findings of a comparison: of `all` positions relative to each other, of each of the `positions`, and of
/// their `common` rotation, where `moved` states that it is significant. An outlier among the readings of the check,
/// whose certification is `again`, or among its runs does not show that the position, or the stand, has changed, and
/// neither do `misplaced` readings.
pub(super) fn findings(
    all: Test,
    positions: &[ComparedPosition],
    common: &CommonTurn,
    again: Option<&Certification>,
    moved: bool,
    untested: Option<Untested>,
    misplaced: Vec<Finding>,
) -> Vec<Finding> {
    let mut findings: Vec<Finding> = positions.iter().filter(|at| !at.repeats).copied().map(Finding::Changed).collect();
    if !findings.is_empty() && findings.len() == positions.len() {
        findings = if misplaced.is_empty() { vec![Finding::AnotherStand] } else { Vec::new() };
    } else if findings.is_empty() && all.probability < OUTLIER {
        findings.push(Finding::ChangedTogether);
    } else if findings.is_empty() && all.probability < STRAGGLER {
        findings.push(Finding::Slightly);
    }
    let suspect: Vec<Finding> = again.map_or_else(Vec::new, suspect);
    let explained = |at: &ComparedPosition| {
        suspect.iter().chain(&misplaced).any(|found| found.explains(at, again.map_or(1, |again| again.runs.len())))
    };
    findings.retain(|found| !matches!(found, Finding::Changed(at) if explained(at)));
    let all_repeat = positions.iter().all(|at| at.repeats);
    if all_repeat && findings.is_empty() && suspect.is_empty() && misplaced.is_empty() {
        let straggles = |at: &&ComparedPosition| at.test.probability * (positions.len() as f64) < STRAGGLER;
        findings.extend(positions.iter().filter(straggles).copied().map(Finding::Straggler));
    }
    // A run during which the stand moved changes all positions of the check, as another unit does.
    let is_whole =
        misplaced.iter().any(|found| matches!(found, Finding::Misplaced(found) if found.scope.between.is_none()));
    if is_whole || suspect.iter().any(|found| found.is_of(&[Kind::Bump])) {
        findings.clear();
    }
    let of_runs = [Kind::Bump, Kind::RunTurned, Kind::StandMoved, Kind::StandDrift];
    let bumped = suspect.iter().any(|found| found.is_of(&of_runs) && found.is_outlier());
    // If no positions agree, there is no rotation that is common to them.
    let agree = positions.iter().any(|at| at.repeats) && !is_whole;
    if agree && moved && !bumped {
        findings.push(Finding::Rotated);
    } else if agree && !moved && common.test.is_some_and(|test| test.probability < STRAGGLER) {
        findings.push(Finding::RotatedSlightly);
    }
    findings.splice(0..0, misplaced.into_iter().chain(suspect));
    findings.extend(untested.map(Finding::NotTested));
    findings
}

/// Returns what is suspect in the readings of a check itself.
fn suspect(check: &Certification) -> Vec<Finding> {
    let of_readings = [Kind::Angle, Kind::Reading, Kind::PositionMoved];
    let of_runs = [Kind::Bump, Kind::RunTurned, Kind::StandMoved, Kind::StandDrift];
    let is_suspect =
        |found: &&Found| of_runs.contains(&found.kind) || of_readings.contains(&found.kind) && found.accuses();
    check.findings.iter().filter(is_suspect).cloned().map(Finding::Suspect).collect()
}
