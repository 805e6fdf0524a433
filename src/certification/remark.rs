//! Remarks for the signatory of a certificate: values, and their words in each language.

use super::rotated_runs::{Pattern, RotatedRuns};
use super::shared_settings::SharedSetting;
use super::split_run::SplitRun;
use super::suspects::{AXES, OUTLIER, Outlier, Suspects, WorsePosition};
use super::unequal_axes::UnequalAxis;
use super::worse_groups::WorseGroup;
use crate::attitude::ANGLE_SYMBOLS;
use crate::calibration::recorded::rounding_of;
use crate::stand::remarks::Odd;
use crate::statistics::outlier::Bartlett;
use crate::text::number::decimals;
use crate::wording::number::{Number, Probability};
use crate::wording::texts::remarks as texts;
use crate::wording::words::code;
use crate::wording::{Language, Words, plain};
use jiff::civil::Date;
use std::fmt::{Display, Formatter};

/// A remark on readings or on the certificate made of them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Remark {
    Worse(WorsePosition),
    WorseGroup(WorseGroup),
    Outlier(Outlier),
    RotatedRuns(RotatedRuns),
    SplitRun(SplitRun),
    /// Two runs, of which either may be wrong.
    TwoRuns(u32, u32),
    NotCompared,
    /// Two runs that agree better than chance allows.
    Twins(u32, u32),
    /// Variances about x, y and z that differ, with the probability of Bartlett's test.
    AxesDiffer(f64),
    /// Variances of the positions that differ although no position is known to scatter more, with the probability of
    /// Bartlett's test.
    PositionsDiffer(f64),
    RunAxesDiffer(UnequalAxis),
    SharedSetting(SharedSetting),
    FewRuns {
        runs: usize,
        degrees_of_freedom: usize,
    },
    /// Number of axes of the base, 0 to 2, about which a rotation can be distinguished from one of the platform.
    BaseAxes(usize),
    /// Number of angles whose readings stay on one step, of how many, and the step, arcsec.
    Rounding {
        angles: usize,
        of: usize,
        step_arcsec: f64,
    },
    /// Largest angle, arcsec.
    SmallAngles(f64),
    /// Standard deviation of a visit that no stand has, arcsec.
    LittleScatter(f64),
    /// No day of the measurement.
    NotDated,
    /// Expiry date of the last certificate, if this one has none.
    NoExpiry(Date),
    Odd(Odd),
}

/// The English sentences without the last full stop, with advice: the wording of terminals and of comments in a stand file.
impl Display for Remark {
    fn fmt(&self, to: &mut Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Odd(odd) => odd.fmt(to),
            _ => to.write_str(&in_english(&self.advised())),
        }
    }
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
        let differs = |test: &Option<Bartlett>| test.map(|test| test.probability).filter(|p| *p < OUTLIER);
        let no_position = suspects.worse.is_empty() && suspects.group.is_none();
        remarks.extend(differs(&suspects.positions).filter(|_| no_position).map(Self::PositionsDiffer));
        remarks.extend(differs(&suspects.axes).map(Self::AxesDiffer));
        remarks
    }

    /// Returns the relative standard uncertainty, in percent, of a standard deviation with `degrees_of_freedom`.
    ///
    /// GUM ([JCGM 100](crate::bibliography::Bibliography::Gum)), E.4.3: about 1/√(2ν).
    pub(crate) fn doubt_percent(degrees_of_freedom: usize) -> f64 {
        100.0 / (2.0 * degrees_of_freedom as f64).sqrt()
    }

    /// Returns the remark as sentences.
    pub(crate) fn words(&self) -> Words {
        let (fixed, exact) = (Number::fixed, Number::exact);
        // How suspect a value is, and its probability.
        let grade = |p: f64| (if p < OUTLIER { texts::OUTLIER } else { texts::STRAGGLER }, Probability(p));
        match self {
            Self::Worse(at) => {
                let (grade, p) = grade(at.probability);
                texts::worse(grade, at.index, fixed(at.ratio, 1), p)
            }
            Self::WorseGroup(at) => {
                let (theta, ratio) = (exact(at.theta_deg), fixed(at.ratio, 1));
                texts::worse_group(theta, ratio, Probability(at.probability))
            }
            Self::Outlier(out) => {
                let (grade, p) = grade(out.probability);
                let (index, run, residual, axis) = (out.index, out.run, arcsec(out.residual_arcsec), AXES[out.axis]);
                match out.line {
                    Some(line) => texts::outlier_in_line(grade, index, run, line, residual, axis, p),
                    None => texts::outlier_reading(grade, index, run, residual, axis, p),
                }
            }
            Self::RotatedRuns(at) => {
                let ([x, y, z], mean) = (together(at.turns_arcsec), arcsec(at.largest_effect_arcsec()));
                let ((grade, p), axes) = (grade(at.probability), at.axis.names());
                match at.pattern {
                    Pattern::One(run) => texts::bumped_run(grade, run, x, y, z, axes, p, mean),
                    Pattern::Move(run, after) => texts::moved(run, after, x, y, z, axes, p),
                    Pattern::Drift => texts::drifts(x, y, z, axes, p),
                }
            }
            Self::SplitRun(at) => at.words(false),
            Self::TwoRuns(one, other) => texts::two_runs(*one, *other),
            Self::NotCompared => texts::NOT_COMPARED.into(),
            Self::Twins(one, other) => texts::twins(*one, *other),
            Self::AxesDiffer(p) => texts::axes_differ(Probability(*p)),
            Self::PositionsDiffer(p) => texts::positions_differ(Probability(*p)),
            Self::RunAxesDiffer(at) => {
                let is_of_the_base = at.axis.is_of_the_base();
                let [own, others, missing] = [at.deviation_arcsec, at.others_arcsec, at.missing_arcsec].map(arcsec);
                let (p, freedom) = (Probability(at.probability), at.degrees_of_freedom);
                let axis = at.axis.word();
                match is_of_the_base {
                    true => texts::base_axes_differ(own, axis, others, p, missing, freedom),
                    false => texts::platform_axes_differ(own, axis, others, p, missing, freedom),
                }
            }
            Self::SharedSetting(at) => {
                let (angle, u) = (at.setting.symbol(), arcsec(at.deviation_arcsec));
                texts::shared_setting(angle, u, Probability(at.probability))
            }
            Self::FewRuns { runs, degrees_of_freedom: freedom } => {
                let doubt = fixed(Self::doubt_percent(*freedom), 0);
                texts::few_runs(*runs, *freedom, doubt)
            }
            Self::BaseAxes(0) => texts::BASE_NOT_SEEN.into(),
            Self::BaseAxes(axes) => texts::base_in_part(*axes),
            Self::Rounding { angles, of, step_arcsec } => {
                let (step, u) = (exact(*step_arcsec), arcsec(rounding_of(*step_arcsec)));
                texts::rounding(*angles, *of, step, u)
            }
            Self::SmallAngles(largest) => texts::small_angles(hundredths_above(*largest)),
            Self::LittleScatter(scatter) => texts::little_scatter(hundredths_above(*scatter)),
            Self::Odd(Odd::FarAngle { angle, index, arcsec, usual_arcsec }) => {
                let (angle, value, usual) = (ANGLE_SYMBOLS[*angle], fixed(*arcsec, 0), fixed(*usual_arcsec, 0));
                texts::far_angle(angle, *index, value, usual)
            }
            Self::NotDated => texts::NOT_DATED.into(),
            Self::NoExpiry(until) => texts::no_expiry(*until),
            Self::Odd(Odd::Temperature { celsius, .. }) => texts::temperature(exact(*celsius)),
            Self::Odd(Odd::OldMeasurement { performed, issued }) => texts::old_measurement(*performed, *issued),
            Self::Odd(Odd::LongValidity { valid_until, issued }) => texts::long_validity(*issued, *valid_until),
            Self::Odd(Odd::OutsideRange { celsius, range: [low, high] }) => {
                texts::outside_range(exact(*celsius), exact(*low), exact(*high))
            }
        }
    }

    /// Returns what to do at a terminal, with the keys and options of files and commands.
    fn advice(&self) -> Option<Words> {
        Some(match self {
            Self::WorseGroup(_) => texts::DO_FIND.into(),
            Self::Outlier(out) => {
                let Outlier { index, run, .. } = out;
                texts::do_exclude_reading(code(format!("--exclude {},{},{run}", index.i, index.j)), code("--why"))
            }
            Self::RotatedRuns(at) => match at.pattern {
                Pattern::One(run) => without_run(run),
                Pattern::Move(_, after) => texts::do_certify_later_runs(after, code("--exclude"), code("--why")),
                Pattern::Drift => texts::DO_FIND_AND_MEASURE.into(),
            },
            Self::SplitRun(at) => without_run(at.run),
            Self::RunAxesDiffer(at) => {
                let of_base = at.axis.is_of_the_base();
                let state = if of_base { texts::do_state_type_b_base } else { texts::do_state_type_b_platform };
                state(code("type_b"), arcsec(at.missing_arcsec))
            }
            Self::SharedSetting(_) => texts::DO_MEASURE.into(),
            Self::BaseAxes(0) => texts::do_without_base(code("common_base_arcsec")),
            Self::NotDated => texts::do_date(code("performed"), code("--performed"), code("`recertify`")),
            Self::NoExpiry(_) => texts::do_expiry(code("--valid-until")),
            Self::Rounding { .. } => texts::DO_DIGITS.into(),
            _ => return None,
        })
    }

    /// Returns the remark and what to do, as a terminal says it; an implausible value with its key in English.
    pub(crate) fn advised(&self) -> Words {
        let advised = advised(self.words(), self.advice());
        if let Self::Odd(_) = self { Words::OfLibrary(format!("{self}."), Box::new(advised)) } else { advised }
    }
}

/// Returns sentences and what to do.
pub(super) fn advised(words: Words, advice: Option<Words>) -> Words {
    let advice = advice.into_iter().flat_map(|advice| [" ".into(), advice]);
    Words::All([words].into_iter().chain(advice).collect())
}

/// Returns sentences in English without the last full stop.
pub(super) fn in_english(words: &Words) -> String {
    plain(&words.plain(Language::English)).trim_end_matches('.').to_owned()
}

fn without_run(run: u32) -> Words {
    texts::do_exclude_run(code(format!("--exclude {run}")), code("--why"))
}

/// Returns an angle in arcseconds, whole or with two significant digits.
pub(super) fn arcsec(angle: f64) -> Number {
    Number::fixed(angle, decimals_of_angle(angle))
}

/// Returns rotations about three axes to one place, the second digit of the largest if it is below 10.
pub(crate) fn together(turns: [f64; 3]) -> [Number; 3] {
    let decimals = decimals_of_angle(turns.iter().fold(0.0, |largest, turn| turn.abs().max(largest)));
    turns.map(|turn| Number::fixed(turn, decimals))
}

/// Returns a small angle, rounded up to hundredths of an arcsecond.
fn hundredths_above(arcsec: f64) -> Number {
    Number::fixed((arcsec * 100.0).ceil() / 100.0, 2)
}

/// Returns the decimals of an angle with two significant digits, at most hundredths of an arcsecond.
fn decimals_of_angle(arcsec: f64) -> usize {
    if arcsec == 0.0 { 0 } else { decimals(arcsec.abs()).min(2) }
}
