//! Findings of a comparison: reasons for its result and its limits, and their words in each language.

use super::Certification;
use super::comparison::{CommonTurn, ComparedPosition, Test};
use super::misread::Misread;
use super::remark::{advised, arcsec, in_english, together};
use super::rotated_runs::{Pattern, RotatedRuns};
use super::shared_settings::Setting;
use super::split_run::SplitRun;
use super::suspects::{AXES, OUTLIER, Outlier, STRAGGLER};
use crate::coefficients::PositionIndex;
use crate::wording::Words;
use crate::wording::number::{Number, Probability};
use crate::wording::texts::remarks as texts;
use crate::wording::words::code;
use std::fmt::{Display, Formatter};

/// Ratio of the scatter of a check to the certified one above which nothing is decided.
const MUCH_MORE: f64 = 2.0;

/// Reason for the result of a comparison, or a limit of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Finding {
    /// Change of a setting, which explains all differences.
    Setting(ChangedSetting),
    /// Half of the positions or more have changed, to angles that still resemble the certified ones; their correlation.
    Worn(f64),
    /// Half of the positions or more have changed, and the angles do not resemble the certified ones.
    AnotherStand,
    /// Two positions, each with the angles that the certificate states for the other.
    Exchanged([PositionIndex; 2]),
    Misread(Misread),
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
    RotatedRuns(RotatedRuns),
    SplitRun(SplitRun),
    /// Outlier among the readings of the check.
    Outlier {
        out: Outlier,
        /// Part of the outlier in the mean of the position.
        of_mean_arcsec: f64,
        /// Standard uncertainty of the change of the position about the axis of the outlier.
        u_arcsec: f64,
    },
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

/// Value of an angle at which the stand stops elsewhere than when it was certified.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ChangedSetting {
    /// Angle whose setting has changed.
    pub setting: Setting,
    /// Nominal value of the angle, degrees.
    pub angle_deg: f64,
    /// Rotation about the axis of the angle relative to the positions with other values, arcsec.
    pub turn_arcsec: f64,
}

/// Reason why the rotation of the stand as a whole was not tested.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Untested {
    /// Variation between the check runs that is unknown.
    Variation,
    /// The check has one run, and the certificate does not state its number of runs.
    NumberOfRuns,
    /// Certificate without common parts of the uncertainty.
    CommonParts,
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
            Self::RotatedRuns(at) => {
                let [x, y, z] = together(at.turns_arcsec);
                let [of_x, of_y, of_z] = together(at.in_the_mean_arcsec());
                let axes = at.axis.names();
                match at.pattern {
                    Pattern::One(run) => texts::check_bumped(run, x, y, z, axes, of_x, of_y, of_z),
                    Pattern::Move(run, after) => texts::check_moved(run, after, x, y, z, axes),
                    Pattern::Drift => texts::check_drifts(x, y, z, axes),
                }
            }
            Self::SplitRun(at) => at.words(true),
            Self::Outlier { out, of_mean_arcsec, u_arcsec } => {
                let (residual, mean) = (arcsec(out.residual_arcsec), Number::measured(*of_mean_arcsec, *u_arcsec));
                let (index, run, axis) = (out.index, out.run, AXES[out.axis]);
                texts::check_outlier(index, run, residual, axis, mean)
            }
            Self::Exchanged([one, other]) => texts::exchanged(*one, *other),
            Self::Misread(misread) => misread.words(),
            Self::Setting(ChangedSetting { setting, angle_deg, turn_arcsec }) => {
                let (symbol, angle, turn) = (setting.symbol(), Number::exact(*angle_deg), arcsec(*turn_arcsec));
                texts::setting_changed(symbol, angle, turn)
            }
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
        let without = |run: u32| texts::do_run_again(code(format!("--exclude {run}")), code("--why"));
        Some(match self {
            Self::RotatedRuns(RotatedRuns { pattern: Pattern::One(run), .. }) => without(*run),
            Self::SplitRun(at) => without(at.run),
            Self::Outlier { out: Outlier { index, run, .. }, .. } => {
                texts::do_exclude_of_run(code(format!("--exclude {},{},{run}", index.i, index.j)), code("--why"))
            }
            Self::Misread(misread) => misread.advice(),
            Self::Setting(_) => texts::DO_CHECK_SETTING.into(),
            Self::Worn(_) => texts::DO_RECERTIFY.into(),
            Self::Exchanged(_) => texts::DO_CHECK_ROWS.into(),
            Self::ScattersMore { .. } => texts::DO_TELL_WHICH.into(),
            Self::RotatedRuns(_) => texts::DO_FIND_AND_MEASURE.into(),
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
        matches!(self, Self::Outlier { .. } | Self::SplitRun(_))
            || matches!(self, Self::RotatedRuns(run) if run.probability < OUTLIER)
    }

    pub(crate) fn is_change(&self) -> bool {
        matches!(
            self,
            Self::Setting(_)
                | Self::Worn(_)
                | Self::AnotherStand
                | Self::Exchanged(_)
                | Self::Misread(_)
                | Self::Changed(_)
                | Self::ChangedTogether
                | Self::Rotated
        )
    }

    /// Returns `true` for readings of which the angles stand in other places or in another unit.
    pub(crate) fn is_misplaced(&self) -> bool {
        matches!(self, Self::Exchanged(_) | Self::Misread(_))
    }

    /// Returns `true` if exchanged readings explain the change of the position, or an outlier among them: the rest is within
    /// 3 u.
    fn explains(&self, at: &ComparedPosition) -> bool {
        if let Self::Exchanged(pair) = self {
            return pair.contains(&at.index);
        }
        let Self::Outlier { out, of_mean_arcsec, .. } = self else { return false };
        let part = |axis: usize| if axis == out.axis { *of_mean_arcsec } else { 0.0 };
        out.index == at.index && (0..3).all(|axis| (at.turn_arcsec[axis] - part(axis)).abs() <= 3.0 * at.u_arcsec[axis])
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
    let suspect: Vec<Finding> = again.map_or_else(Vec::new, |again| suspect(again, positions));
    let explained = |at: &ComparedPosition| suspect.iter().chain(&misplaced).any(|found| found.explains(at));
    findings.retain(|found| !matches!(found, Finding::Changed(at) if explained(at)));
    let all_repeat = positions.iter().all(|at| at.repeats);
    if all_repeat && findings.is_empty() && suspect.is_empty() && misplaced.is_empty() {
        let straggles = |at: &&ComparedPosition| at.test.probability * (positions.len() as f64) < STRAGGLER;
        findings.extend(positions.iter().filter(straggles).copied().map(Finding::Straggler));
    }
    // A run during which the stand moved changes all positions of the check.
    if suspect.iter().any(|found| matches!(found, Finding::SplitRun(_))) {
        findings.clear();
    }
    let bumped = suspect
        .iter()
        .any(|found| matches!(found, Finding::RotatedRuns(_) | Finding::SplitRun(_)) && found.is_outlier());
    // If no positions agree, there is no rotation that is common to them.
    let agree = positions.iter().any(|at| at.repeats);
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
fn suspect(check: &Certification, positions: &[ComparedPosition]) -> Vec<Finding> {
    let runs = check.runs.len() as f64;
    let outliers = check.suspects.outliers.iter().filter(|out| out.probability < OUTLIER);
    let u = |out: &Outlier| positions.iter().find(|at| at.index == out.index).map_or(0.0, |at| at.u_arcsec[out.axis]);
    let outliers = outliers.map(|out| Finding::Outlier {
        out: *out,
        of_mean_arcsec: out.residual_arcsec / runs,
        u_arcsec: u(out),
    });
    let split = check.suspects.split.into_iter().map(Finding::SplitRun);
    split.chain(check.rotated_runs.iter().copied().map(Finding::RotatedRuns)).chain(outliers).collect()
}
