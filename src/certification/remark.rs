//! Remarks for the signatory of a certificate, as values. Displayed, a remark is an English sentence without a full stop:
//! the wording of the comments in a stand file. `report` has the words of other languages.

use super::rotated_runs::{Pattern, RotatedRuns};
use super::shared_settings::SharedSetting;
use super::split_run::SplitRun;
use super::suspects::{AXES, OUTLIER, Outlier, Suspects, WorsePosition};
use super::unequal_axes::UnequalAxis;
use super::worse_groups::WorseGroup;
use crate::calibration::recorded::rounding_of;
use crate::stand::remarks::Odd;
use crate::text::number::{decimals, signed};

/// A remark on readings or on the certificate made of them.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum Remark {
    #[error(
        "{}: the standard deviation of position {} is {:.1} times the pooled one (Cochran's test: probability {}); its \
         uncertainty is computed from its own readings, that of the others without it",
        grade(.0.probability),
        .0.index,
        .0.ratio,
        probability(.0.probability)
    )]
    Worse(WorsePosition),
    #[error(
        "the standard deviation of the positions with θ = {}° is {:.1} times that of the others (F test: probability \
         {}); their uncertainty is computed from their own readings, that of the others without them; find the cause, \
         because repeatability_arcsec is pooled from all positions",
        .0.theta_deg,
        .0.ratio,
        probability(.0.probability)
    )]
    WorseGroup(WorseGroup),
    #[error(
        "{}: position {}, run {}{}, differs by {}″ from the other runs about {} (Grubbs' test: probability {}); it \
         was not excluded; measure it again, or omit the run",
        grade(.0.probability),
        .0.index,
        .0.run,
        line_of(.0),
        turned_by(.0.residual_arcsec),
        AXES[.0.axis],
        probability(.0.probability)
    )]
    Outlier(Outlier),
    #[error("{}", rotated(.0))]
    RotatedRuns(RotatedRuns),
    #[error(
        "run {run} seems to have changed within itself: {} (F test: probability {}); the run was not excluded, and \
         single readings and positions were not examined; find the cause, then measure the run again, or exclude it \
         with --exclude {run} and --why",
        .0.words(),
        probability(.0.probability),
        run = .0.run
    )]
    SplitRun(SplitRun),
    #[error("two runs do not show whether run {0} or run {1} is wrong; measure a third run")]
    TwoRuns(u32, u32),
    #[error(
        "because a reading is suspect, the scatter of single positions was not tested; all positions state the pooled \
         standard deviation"
    )]
    NotCompared,
    #[error(
        "runs {0} and {1} agree more than 30 times better than other runs; check whether one is a copy of the other, \
         or whether another run contains an error"
    )]
    Twins(u32, u32),
    /// Variances about x, y and z that differ, with the probability of Bartlett's test.
    #[error(
        "the variances about x, y and z differ (Bartlett's test: probability {}); repeatability_arcsec is pooled from \
         all three, which is too large for one axis and too small for another",
        probability(*.0)
    )]
    AxesDiffer(f64),
    #[error(
        "from run to run the {part} rotates by {}″ about {axis} and by {}″ about its other two axes (Cochran's \
         test: probability {}); common_{part}_arcsec is pooled from all three, which is too small about {axis}; state \
         a line of type_b that acts on the {part}, of {}″, or find the cause and measure again",
        size(.0.deviation_arcsec),
        size(.0.others_arcsec),
        probability(.0.probability),
        size(.0.missing_arcsec),
        part = .0.axis.part(),
        axis = .0.axis.name()
    )]
    RunAxesDiffer(UnequalAxis),
    #[error(
        "in each run the positions with the same {angle} share an error of {}″ (standard deviation; F test: \
         probability {}), as if {angle} were set once for all of them; the uncertainties take the errors of positions \
         as independent, and are too small; set both angles again before every position, and measure again",
        size(.0.deviation_arcsec),
        probability(.0.probability),
        angle = .0.setting.symbol()
    )]
    SharedSetting(SharedSetting),
    #[error(
        "{runs} runs are few: the common part of a run has only {degrees_of_freedom} degrees of freedom, so its \
         uncertainty has an uncertainty of {:.0} %; measure five runs or more",
        Self::doubt_percent(*degrees_of_freedom)
    )]
    FewRuns { runs: usize, degrees_of_freedom: usize },
    /// Number of axes of the base, 0 to 2, about which a rotation can be distinguished from one of the platform.
    #[error("{}", base_axes(*.0))]
    BaseAxes(usize),
    /// Number of angles whose readings stay on one step, of how many, and the step, arcsec.
    #[error(
        "the readings of {angles} of {of} angles vary by less than half their step of {step_arcsec}″, so their mean \
         does not reduce the rounding; its standard uncertainty of {}″ is included; record more digits",
        size(rounding_of(*step_arcsec))
    )]
    Rounding { angles: usize, of: usize, step_arcsec: f64 },
    #[error("no angle is larger than {0:.2}″; check that the angles are in arcseconds, not degrees")]
    SmallAngles(f64),
    #[error("{0}")]
    Odd(Odd),
}

impl Remark {
    pub(crate) fn of_suspects(suspects: &Suspects, runs: &[u32]) -> Vec<Self> {
        let mut remarks: Vec<Self> = suspects.split.iter().copied().map(Self::SplitRun).collect();
        remarks.extend(suspects.group.iter().cloned().map(Self::WorseGroup));
        remarks.extend(suspects.worse.iter().copied().map(Self::Worse));
        remarks.extend(suspects.outliers.iter().copied().map(Self::Outlier));
        if let ([one, other], false) = (runs, suspects.outliers.is_empty()) {
            remarks.push(Self::TwoRuns(*one, *other));
        }
        if !suspects.outliers.is_empty() && suspects.worse.is_empty() {
            remarks.push(Self::NotCompared);
        }
        remarks.extend(suspects.twins.iter().map(|(one, other)| Self::Twins(*one, *other)));
        let axes = suspects.axes.filter(|test| test.probability < OUTLIER);
        remarks.extend(axes.map(|test| Self::AxesDiffer(test.probability)));
        remarks
    }

    /// Returns the relative standard uncertainty, in percent, of a standard deviation with `degrees_of_freedom`.
    ///
    /// GUM ([JCGM 100](crate::bibliography::Bibliography::Gum)), E.4.3: about 1/√(2ν).
    pub(crate) fn doubt_percent(degrees_of_freedom: usize) -> f64 {
        100.0 / (2.0 * degrees_of_freedom as f64).sqrt()
    }
}

/// Returns rotations about three axes as words have them, whole or the largest with two significant digits.
pub(crate) fn turns(of: [f64; 3]) -> String {
    let decimals = decimals_of_angle(of.iter().fold(0.0, |largest, turn| turn.abs().max(largest)));
    of.map(|turn| format!("{}″", signed(turn, decimals))).join(", ")
}

/// Returns an angle with its sign, whole or with two significant digits.
pub(super) fn turned_by(arcsec: f64) -> String {
    signed(arcsec, decimals_of_angle(arcsec))
}

/// Returns a standard deviation or the size of an angle, whole or with two significant digits.
fn size(arcsec: f64) -> String {
    format!("{arcsec:.*}", decimals_of_angle(arcsec))
}

/// Returns the decimals of an angle with two significant digits, at most hundredths of an arcsecond.
pub(crate) fn decimals_of_angle(arcsec: f64) -> usize {
    if arcsec == 0.0 { 0 } else { decimals(arcsec.abs()).min(2) }
}

fn line_of(out: &Outlier) -> String {
    out.line.map_or_else(String::new, |line| format!(" (line {line} of the readings)"))
}

fn rotated(at: &RotatedRuns) -> String {
    let (turns, axes, p) = (turns(at.turns_arcsec), at.axis.names(), probability(at.probability));
    match at.pattern {
        Pattern::One(run) => format!(
            "{}: all positions of run {run} are rotated by {turns} about {axes} relative to the other runs (Grubbs' \
             test: probability {p}); it was not excluded, and changes certified angles by up to {}″; find the \
             cause, then measure the run again, or exclude it with --exclude {run} and --why",
            grade(at.probability),
            size(at.largest_effect_arcsec())
        ),
        Pattern::Move(before, after) => format!(
            "the stand seems to have moved between runs {before} and {after}: all positions are rotated by {turns} \
             about {axes} (Student's test of a step: probability {p}); no run was excluded, and the certified angles \
             are a mean of both states; find the cause and measure again, or certify the runs from {after} on by \
             themselves: exclude each earlier one with --exclude and --why"
        ),
        Pattern::Drift => format!(
            "the stand seems to drift: from run to run all positions rotate by {turns} about {axes} (Student's test of \
             a straight line: probability {p}); no run was excluded, and the certified angles are those of the middle \
             of the measurement; find the cause and measure again"
        ),
    }
}

fn base_axes(number: usize) -> String {
    if number == 0 {
        return "in these positions a rotation of the base cannot be distinguished from one of the platform; \
                common_base_arcsec is absent, and common_platform_arcsec includes both"
            .to_owned();
    }
    format!(
        "in these positions only {number} of the three axes of the base can be distinguished from the platform; \
         common_platform_arcsec includes the rest"
    )
}

pub(super) fn probability(p: f64) -> String {
    if p < 1e-99 { "below 1e-99".to_owned() } else { format!("{p:.2e}") }
}

fn grade(probability: f64) -> &'static str {
    if probability < OUTLIER { "outlier" } else { "straggler" }
}
