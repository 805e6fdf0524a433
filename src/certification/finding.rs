//! Findings of a comparison: reasons for its result, and its limits.

use super::Certification;
use super::comparison::{CommonTurn, ComparedPosition, Test};
use super::misread::Misread;
use super::remark;
use super::rotated_runs::{Pattern, RotatedRuns};
use super::shared_settings::Setting;
use super::split_run::SplitRun;
use super::suspects::{AXES, OUTLIER, Outlier, STRAGGLER};
use crate::coefficients::PositionIndex;
use crate::text::number::{decimals, signed, two_digits};
use crate::text::words;

/// Ratio of the scatter of a check to the certified one above which nothing is decided.
const MUCH_MORE: f64 = 2.0;

/// Reason for the result of a comparison, or a limit of it. Displayed, it is an English sentence without a full stop;
/// `report` has the words of other languages.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub(crate) enum Finding {
    /// Change of a setting, which explains all differences.
    #[error(
        "the positions with {symbol} = {}° have rotated by {}″ about the axis of {symbol} relative to the others; no other \
         change was found; check how this angle is set",
        .0.angle_deg,
        remark::turned_by(.0.turn_arcsec),
        symbol = .0.setting.symbol()
    )]
    Setting(ChangedSetting),
    /// Half of the positions or more have changed, to angles that still resemble the certified ones; their correlation.
    #[error(
        "no more than half of the positions agree with each other, but the angles resemble the certificate (correlation \
         {0:.2}): the stand has changed in most positions; check the serial number, and have the stand recertified"
    )]
    Worn(f64),
    /// Half of the positions or more have changed, and the angles do not resemble the certified ones.
    #[error(
        "no more than half of the positions agree with each other, and the angles do not resemble the certificate: this is \
         another stand or another certificate, or the stand was rebuilt or damaged"
    )]
    AnotherStand,
    #[error(
        "positions {} and {} are exchanged: each has the angles that the certificate states for the other; check the \
         rows of the readings, and the directions in which theta and phi increase",
        .0[0],
        .0[1]
    )]
    Exchanged([PositionIndex; 2]),
    #[error("{0}")]
    Misread(Misread),
    #[error(
        "the visits of the check scatter by {}″, the certificate states {}″ (probability {}): the stand repeats worse, \
         so that uncertainties from its certificate are too small, or the instrument of the check reads worse; read \
         one position several times without moving the stand to tell which",
        two_digits(*of_check_arcsec),
        two_digits(*certified_arcsec),
        remark::probability(*probability)
    )]
    ScattersMore { of_check_arcsec: f64, certified_arcsec: f64, probability: f64 },
    #[error(
        "position {} has changed: {} about x, y, z relative to the other positions",
        .0.index,
        turned(.0)
    )]
    Changed(ComparedPosition),
    #[error("the positions have changed by more than stated; no single position stands out")]
    ChangedTogether,
    #[error("the differences of the positions are slightly larger than chance explains; measure another run")]
    Slightly,
    #[error(
        "all positions have rotated together; a datum surface has changed (gyro seat, level or azimuth), not single \
         positions"
    )]
    Rotated,
    #[error("the common rotation of all positions is slightly larger than chance explains; measure more runs")]
    RotatedSlightly,
    #[error("{}", rotated(.0))]
    RotatedRuns(RotatedRuns),
    #[error(
        "run {run} of the check seems to have changed within itself: {}; measure the run again, or exclude it with \
         --exclude {run} and --why",
        .0.words(),
        run = .0.run
    )]
    SplitRun(SplitRun),
    /// Outlier among the readings of the check, and its part in the mean of the position, arcsec.
    #[error(
        "the reading of position {} in run {run} of the check differs by {}″ about {} from its other runs; the \
         change of the position includes {mean}″ of it; measure the run again, or exclude the reading with \
         --exclude {},{},{run} and --why",
        .0.index,
        remark::turned_by(.0.residual_arcsec),
        AXES[.0.axis],
        .0.index.i,
        .0.index.j,
        run = .0.run,
        mean = remark::turned_by(*.1)
    )]
    Outlier(Outlier, f64),
    #[error("rotation of the stand as a whole was not tested: {}", .0.words())]
    NotTested(Untested),
    #[error(
        "the certificate does not state the uncertainty of all angles (u_alpha_arcsec etc.); these angles were treated \
         as exact, so differences appear more significant than they are"
    )]
    TreatedAsExact,
    #[error("the certificate was computed from these readings, so they do not show the present state of the stand")]
    SameReadings,
    #[error(
        "the readings agree with the certificate better than the repeatability of the stand allows; check whether they \
         are those of the certificate, and measure the stand again"
    )]
    TooClose,
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

words! {
    /// Reason why the rotation of the stand as a whole was not tested.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub(crate) enum Untested: pub(crate) words {
        Variation = "the variation between the check runs is unknown",
        NumberOfRuns = "one run does not show the variation between set-ups, and the certificate does not state the \
                        number of runs behind its common_*; measure two runs or more",
        CommonParts = "the certificate does not state common_platform_arcsec and common_base_arcsec",
    }
}

/// Returns the rotation of a position about x, y and z with the digits of its uncertainty.
fn turned(at: &ComparedPosition) -> String {
    let turn = |axis: usize| format!("{}″", signed(at.turn_arcsec[axis], decimals(at.u_arcsec[axis])));
    [0, 1, 2].map(turn).join(", ")
}

fn rotated(at: &RotatedRuns) -> String {
    let (turns, axes) = (remark::turns(at.turns_arcsec), at.axis.names());
    match at.pattern {
        Pattern::One(run) => format!(
            "all positions of run {run} of the check are rotated by {turns} about {axes} relative to its other runs; \
             the common rotation includes {} of it; measure the run again, or exclude it with --exclude {run} and \
             --why",
            remark::turns(at.in_the_mean_arcsec())
        ),
        Pattern::Move(before, after) => format!(
            "the stand seems to have moved between runs {before} and {after} of the check: all positions are rotated \
             by {turns} about {axes}; the common rotation is a mean of both states; find the cause and measure again"
        ),
        Pattern::Drift => format!(
            "the stand seems to drift: from run to run of the check all positions rotate by {turns} about {axes}; the \
             common rotation is that of the middle of the check; find the cause and measure again"
        ),
    }
}

impl Finding {
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
        matches!(self, Self::Outlier(..) | Self::SplitRun(_))
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
        let Self::Outlier(out, mean) = self else { return false };
        let part = |axis: usize| if axis == out.axis { *mean } else { 0.0 };
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
    let suspect: Vec<Finding> = again.map_or_else(Vec::new, suspect);
    let explained = |at: &ComparedPosition| suspect.iter().chain(&misplaced).any(|found| found.explains(at));
    findings.retain(|found| !matches!(found, Finding::Changed(at) if explained(at)));
    // A run that changed within itself changes all positions of the check.
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
fn suspect(check: &Certification) -> Vec<Finding> {
    let runs = check.runs.len() as f64;
    let outliers = check.suspects.outliers.iter().filter(|out| out.probability < OUTLIER);
    let outliers = outliers.map(|out| Finding::Outlier(*out, out.residual_arcsec / runs));
    let split = check.suspects.split.into_iter().map(Finding::SplitRun);
    split.chain(check.rotated_runs.iter().copied().map(Finding::RotatedRuns)).chain(outliers).collect()
}
