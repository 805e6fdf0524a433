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
use std::fmt::{self, Display, Formatter};

/// A remark on readings or on the certificate made of them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Remark {
    /// Position that scatters more than the others.
    Worse(WorsePosition),
    /// Positions with the same θ that scatter more than the others.
    WorseGroup(WorseGroup),
    /// Reading that differs from those of the other runs.
    Outlier(Outlier),
    /// Runs that are rotated as a whole relative to the other runs.
    RotatedRuns(RotatedRuns),
    /// Run that changed within itself.
    SplitRun(SplitRun),
    /// Suspect reading in one of two runs, which do not show which one is wrong.
    TwoRuns(u32, u32),
    /// Single positions that were not compared, because a reading is suspect.
    NotCompared,
    /// Two runs that agree too well.
    Twins(u32, u32),
    /// Variances about x, y and z that differ, with the probability of Bartlett's test.
    AxesDiffer(f64),
    /// Axis about which whole runs rotate more than about the others.
    RunAxesDiffer(UnequalAxis),
    /// Setting of an angle that several positions of a run share.
    SharedSetting(SharedSetting),
    /// Number of runs that is small, and the degrees of freedom of the common part.
    FewRuns { runs: usize, degrees_of_freedom: usize },
    /// Number of axes of the base, 0 to 2, about which a rotation can be distinguished from one of the platform.
    BaseAxes(usize),
    /// Number of angles whose readings stay on one step, of how many, and the step, arcsec.
    Rounding { angles: usize, of: usize, step_arcsec: f64 },
    /// Largest angle, arcsec, if it is suspiciously small.
    SmallAngles(f64),
    /// Unusual value in the certificate.
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

impl Display for Remark {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        match self {
            Self::Worse(WorsePosition { index, ratio, probability: p, .. }) => write!(
                f,
                "{}: the standard deviation of position {index} is {ratio:.1} times the pooled one (Cochran's test: \
                 probability {}); its uncertainty is computed from its own readings, that of the others without it",
                grade(*p),
                probability(*p)
            ),
            Self::WorseGroup(WorseGroup { theta_deg, ratio, probability: p, .. }) => write!(
                f,
                "the standard deviation of the positions with θ = {theta_deg}° is {ratio:.1} times that of the others (F \
                 test: probability {}); their uncertainty is computed from their own readings, that of the others without \
                 them; find the cause, because repeatability_arcsec is pooled from all positions",
                probability(*p)
            ),
            Self::Outlier(out) => {
                let line = out.line.map_or_else(String::new, |line| format!(" (line {line} of the readings)"));
                write!(
                    f,
                    "{}: position {}, run {}{line}, differs by {:+.2}″ from the other runs about {} (Grubbs' test: \
                     probability {}); it was not excluded; measure it again, or omit the run",
                    grade(out.probability),
                    out.index,
                    out.run,
                    out.residual_arcsec,
                    AXES[out.axis],
                    probability(out.probability)
                )
            }
            Self::RotatedRuns(at) => {
                let ([x, y, z], axes, p) = (at.turns_arcsec, at.axis.names(), probability(at.probability));
                match at.pattern {
                    Pattern::One(run) => write!(
                        f,
                        "{}: all positions of run {run} are rotated by {x:+.2}″, {y:+.2}″, {z:+.2}″ about {axes} \
                         relative to the other runs (Grubbs' test: probability {p}); it was not excluded, and changes \
                         certified angles by up to {:.2}″; find the cause, then measure the run again, or \
                         exclude it with --exclude {run} and --why",
                        grade(at.probability),
                        at.largest_effect_arcsec()
                    ),
                    Pattern::Move(before, after) => write!(
                        f,
                        "the stand seems to have moved between runs {before} and {after}: all positions are rotated by \
                         {x:+.2}″, {y:+.2}″, {z:+.2}″ about {axes} (Student's test of a step: probability {p}); no \
                         run was excluded, and the certified angles are a mean of both states; find the cause and \
                         measure again, or certify the runs from {after} on by themselves: exclude each earlier one \
                         with --exclude and --why"
                    ),
                    Pattern::Drift => write!(
                        f,
                        "the stand seems to drift: from run to run all positions rotate by {x:+.2}, {y:+.2}, {z:+.2} \
                         arcsec about {axes} (Student's test of a straight line: probability {p}); no run was \
                         excluded, and the certified angles are those of the middle of the measurement; find the cause \
                         and measure again"
                    ),
                }
            }
            Self::SplitRun(at) => {
                let ([x, y, z], [before, after]) = (at.turns_arcsec, at.between);
                write!(
                    f,
                    "run {run} seems to have changed within itself: from position {after} on, its positions are rotated by \
                     {x:+.2}″, {y:+.2}″, {z:+.2}″ about {} relative to those up to {before}, in the order of the rows \
                     (F test: probability {}); the run was not excluded, and single readings and positions were not \
                     examined; find the cause, then measure the run again, or exclude it with --exclude {run} and --why",
                    at.axis.names(),
                    probability(at.probability),
                    run = at.run
                )
            }
            Self::TwoRuns(one, other) => {
                write!(f, "two runs do not show whether run {one} or run {other} is wrong; measure a third run")
            }
            Self::NotCompared => f.write_str(
                "because a reading is suspect, the scatter of single positions was not tested; all positions state the \
                 pooled standard deviation",
            ),
            Self::Twins(one, other) => write!(
                f,
                "runs {one} and {other} agree more than 30 times better than other runs; check whether one is a copy of \
                 the other, or whether another run contains an error"
            ),
            Self::AxesDiffer(p) => write!(
                f,
                "the variances about x, y and z differ (Bartlett's test: probability {}); repeatability_arcsec is \
                 pooled from all three, which is too large for one axis and too small for another",
                probability(*p)
            ),
            Self::RunAxesDiffer(at) => {
                let (part, axis) = (at.axis.part(), at.axis.name());
                write!(
                    f,
                    "from run to run the {part} rotates by {:.2}″ about {axis} and by {:.2}″ about its \
                     other two axes (Cochran's test: probability {}); common_{part}_arcsec is pooled from all three, \
                     which is too small about {axis}; state a line of type_b that acts on the {part}, of {:.2}″, \
                     or find the cause and measure again",
                    at.deviation_arcsec,
                    at.others_arcsec,
                    probability(at.probability),
                    at.missing_arcsec
                )
            }
            Self::SharedSetting(SharedSetting { setting, deviation_arcsec, probability: p }) => write!(
                f,
                "in each run the positions with the same {0} share an error of {deviation_arcsec:.2}″ (standard \
                 deviation; F test: probability {1}), as if {0} were set once for all of them; the uncertainties take \
                 the errors of positions as independent, and are too small; set both angles again before every position, \
                 and measure again",
                setting.symbol(),
                probability(*p)
            ),
            Self::FewRuns { runs, degrees_of_freedom } => write!(
                f,
                "{runs} runs are few: the common part of a run has only {degrees_of_freedom} degrees of freedom, so its \
                 uncertainty has an uncertainty of {:.0} %; measure five runs or more",
                Self::doubt_percent(*degrees_of_freedom)
            ),
            Self::BaseAxes(0) => f.write_str(
                "in these positions a rotation of the base cannot be distinguished from one of the platform; \
                 common_base_arcsec is absent, and common_platform_arcsec includes both",
            ),
            Self::BaseAxes(axes) => write!(
                f,
                "in these positions only {axes} of the three axes of the base can be distinguished from the platform; \
                 common_platform_arcsec includes the rest"
            ),
            Self::Rounding { angles, of, step_arcsec } => write!(
                f,
                "the readings of {angles} of {of} angles vary by less than half their step of {step_arcsec}″, so their \
                 mean does not reduce the rounding; its standard uncertainty of {:.2}″ is included; record more digits",
                rounding_of(*step_arcsec)
            ),
            Self::SmallAngles(largest_arcsec) => write!(
                f,
                "no angle is larger than {largest_arcsec:.2}″; check that the angles are in arcseconds, not degrees"
            ),
            Self::Odd(odd) => odd.fmt(f),
        }
    }
}

pub(super) fn probability(p: f64) -> String {
    if p < 1e-99 { "below 1e-99".to_owned() } else { format!("{p:.2e}") }
}

fn grade(probability: f64) -> &'static str {
    if probability < OUTLIER { "outlier" } else { "straggler" }
}
