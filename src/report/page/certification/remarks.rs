//! Remarks on a certification, and findings of a comparison, in the language of the page.

use crate::attitude::ANGLES;
use crate::calibration::recorded::rounding_of;
use crate::certification::comparison::ComparedPosition;
use crate::certification::finding::{ChangedSetting, Finding, Untested};
use crate::certification::misread::Misread;
use crate::certification::remark::{Remark, decimals_of_angle};
use crate::certification::rotated_runs::{CommonAxis, Pattern};
use crate::certification::split_run::SplitRun;
use crate::certification::suspects::{AXES, OUTLIER};
use crate::report::page::language::{Language, Text, Values, values};
use crate::report::page::number::Number;
use crate::report::page::parts::date_text;
use crate::report::page::texts::{remarks as texts, words as compass};
use crate::report::picture::history::LETTERS;
use crate::stand::remarks::Odd;
use jiff::civil::Date;

/// Returns a remark as a sentence.
pub(crate) fn words(remark: &Remark, language: Language) -> String {
    let fill = |text: Text, values: Values| text.filled(language, values);
    let (fixed, exact) = (Number::fixed, Number::exact);
    let probability = |p: f64| Number::scientific(p, 2);
    let day = |date: Date| date_text(language, date);
    // A suspect value: how suspect, and its probability.
    let suspect = |text: Text, p: f64, values: Values| {
        let grade = if p < OUTLIER { texts::OUTLIER } else { texts::STRAGGLER };
        fill(text, &[values, values! { grade, p: probability(p) }].concat())
    };
    match remark {
        Remark::Worse(at) => {
            suspect(texts::WORSE, at.probability, values! { index: at.index, ratio: fixed(at.ratio, 1) })
        }
        Remark::WorseGroup(at) => {
            let (theta, ratio) = (exact(at.theta_deg), fixed(at.ratio, 1));
            fill(texts::WORSE_GROUP, values! { theta, ratio, p: probability(at.probability) })
        }
        Remark::Outlier(out) => {
            let (text, line) = match out.line {
                Some(line) => (texts::OUTLIER_IN_LINE, line),
                None => (texts::OUTLIER_READING, 0),
            };
            let (residual, axis) = (arcsec(out.residual_arcsec), AXES[out.axis]);
            let values = values! { index: out.index, run: out.run, residual, axis, line };
            suspect(text, out.probability, values)
        }
        Remark::RotatedRuns(at) => {
            let ([x, y, z], mean) = (together(at.turns_arcsec), arcsec(at.largest_effect_arcsec()));
            let (text, run, after) = match at.pattern {
                Pattern::One(run) => (texts::BUMPED_RUN, run, 0),
                Pattern::Move(before, after) => (texts::MOVED, before, after),
                Pattern::Drift => (texts::DRIFTS, 0, 0),
            };
            suspect(text, at.probability, values! { run, after, x, y, z, axes: axes_of(at.axis), mean })
        }
        Remark::SplitRun(at) => split_words(texts::SPLIT_RUN, at, language),
        Remark::TwoRuns(one, other) => fill(texts::TWO_RUNS, values! { one, other }),
        Remark::NotCompared => fill(texts::NOT_COMPARED, &[]),
        Remark::Twins(one, other) => fill(texts::TWINS, values! { one, other }),
        Remark::AxesDiffer(p) => fill(texts::AXES_DIFFER, values! { p: probability(*p) }),
        Remark::RunAxesDiffer(at) => {
            let text = if at.axis.is_of_the_base() { texts::BASE_AXES_DIFFER } else { texts::PLATFORM_AXES_DIFFER };
            let [own, others, missing] = [at.deviation_arcsec, at.others_arcsec, at.missing_arcsec].map(arcsec);
            fill(text, values! { axis: axis_name(at.axis), own, others, p: probability(at.probability), missing })
        }
        Remark::SharedSetting(at) => {
            let (angle, u) = (at.setting.symbol(), arcsec(at.deviation_arcsec));
            fill(texts::SHARED_SETTING, values! { angle, u, p: probability(at.probability) })
        }
        Remark::FewRuns { runs, degrees_of_freedom: freedom } => {
            let doubt = fixed(Remark::doubt_percent(*freedom), 0);
            fill(texts::FEW_RUNS, values! { runs, freedom, doubt })
        }
        Remark::BaseAxes(0) => fill(texts::BASE_NOT_SEEN, &[]),
        Remark::BaseAxes(axes) => fill(texts::BASE_IN_PART, values! { axes }),
        Remark::Rounding { angles, of, step_arcsec } => {
            let (step, u) = (exact(*step_arcsec), arcsec(rounding_of(*step_arcsec)));
            fill(texts::ROUNDING, values! { angles, all: of, step, u })
        }
        Remark::SmallAngles(largest) => fill(texts::SMALL_ANGLES, values! { largest: fixed(*largest, 2) }),
        Remark::Odd(Odd::FarAngle { angle, index, arcsec, usual_arcsec }) => {
            let (angle, value, usual) = (LETTERS[*angle], fixed(*arcsec, 0), fixed(*usual_arcsec, 0));
            fill(texts::FAR_ANGLE, values! { angle, index, value, usual })
        }
        Remark::Odd(Odd::Temperature { celsius, .. }) => fill(texts::TEMPERATURE, values! { value: exact(*celsius) }),
        Remark::Odd(Odd::OldMeasurement { performed, issued }) => {
            fill(texts::OLD_MEASUREMENT, values! { performed: day(*performed), issued: day(*issued) })
        }
        Remark::Odd(Odd::LongValidity { valid_until, issued }) => {
            fill(texts::LONG_VALIDITY, values! { until: day(*valid_until), issued: day(*issued) })
        }
        Remark::Odd(Odd::OutsideRange { celsius, range: [low, high] }) => {
            fill(texts::OUTSIDE_RANGE, values! { value: exact(*celsius), low: exact(*low), high: exact(*high) })
        }
    }
}

/// Returns the name of the axis of a common rotation, without platform or base.
pub(super) fn axis_name(axis: CommonAxis) -> Text {
    let alike = |name| Text { en: name, ru: name };
    let [x, y, z] = AXES.map(alike);
    [x, y, z, compass::EAST, compass::NORTH, compass::UP][axis.0]
}

/// Returns a run that changed within itself as a sentence.
fn split_words(text: Text, at: &SplitRun, language: Language) -> String {
    let ([before, after], axes) = (at.between, axes_of(at.axis));
    let [x, y, z] = together(at.turns_arcsec);
    let p = Number::scientific(at.probability, 2);
    text.filled(language, values! { run: at.run, before, after, axes, x, y, z, p })
}

/// Returns the error of a whole file as a sentence.
fn misread_words(misread: &Misread, language: Language) -> String {
    match misread {
        Misread::Smaller(by, _) => texts::SMALLER_UNIT.filled(language, values! { factor: Number::fixed(*by, 0) }),
        Misread::Larger(by, _) => texts::LARGER_UNIT.filled(language, values! { factor: Number::fixed(*by, 0) }),
        Misread::Sign => texts::OPPOSITE_SIGN.words(language),
        Misread::Axes(axes) => {
            let letter = |name: &str| ANGLES.iter().position(|angle| *angle == name).map_or("", |at| LETTERS[at]);
            let each = Misread::columns(axes).into_iter().map(|(found, due)| {
                let sign = if found.starts_with('-') { "−" } else { "" };
                format!("{sign}{} → {}", letter(found.trim_start_matches('-')), letter(due))
            });
            texts::OTHER_AXES.filled(language, values! { columns: each.collect::<Vec<_>>().join(", ") })
        }
    }
}

/// Returns an angle in arcseconds, whole or with two significant digits.
fn arcsec(angle: f64) -> Number {
    Number::fixed(angle, decimals_of_angle(angle))
}

/// Returns rotations about three axes to one place, the second digit of the largest if it is below 10.
fn together(turns: [f64; 3]) -> [Number; 3] {
    let decimals = decimals_of_angle(turns.iter().fold(0.0, |largest, turn| turn.abs().max(largest)));
    turns.map(|turn| Number::fixed(turn, decimals))
}

/// Returns the names of the three axes with platform or base.
fn axes_of(axis: CommonAxis) -> Text {
    if axis.is_of_the_base() { texts::AXES_OF_BASE } else { texts::AXES_OF_PLATFORM }
}

/// Returns a finding of a comparison with the last certificate as a sentence.
pub(crate) fn finding(finding: &Finding, language: Language) -> String {
    let text = match finding {
        Finding::Changed(ComparedPosition { index, turn_arcsec, u_arcsec, .. }) => {
            let [x, y, z] = std::array::from_fn(|axis| Number::measured(turn_arcsec[axis], u_arcsec[axis]));
            return texts::POSITION_CHANGED.filled(language, values! { index, x, y, z });
        }
        Finding::ScattersMore { of_check_arcsec, certified_arcsec, probability } => {
            let [found, certified] = [of_check_arcsec, certified_arcsec].map(|value| Number::significant(*value, 2));
            let p = Number::scientific(*probability, 2);
            return texts::SCATTERS_MORE.filled(language, values! { found, certified, p });
        }
        Finding::RotatedRuns(at) => {
            let [x, y, z] = together(at.turns_arcsec);
            let [of_x, of_y, of_z] = together(at.in_the_mean_arcsec());
            let (text, run, after) = match at.pattern {
                Pattern::One(run) => (texts::CHECK_BUMPED, run, 0),
                Pattern::Move(before, after) => (texts::CHECK_MOVED, before, after),
                Pattern::Drift => (texts::CHECK_DRIFTS, 0, 0),
            };
            let axes = axes_of(at.axis);
            return text.filled(language, values! { run, after, axes, x, y, z, of_x, of_y, of_z });
        }
        Finding::SplitRun(at) => return split_words(texts::CHECK_SPLIT, at, language),
        Finding::Outlier(out, mean) => {
            let [residual, mean] = [out.residual_arcsec, *mean].map(arcsec);
            let (index, run, axis) = (&out.index, &out.run, AXES[out.axis]);
            return texts::CHECK_OUTLIER.filled(language, values! { index, run, residual, axis, mean });
        }
        Finding::Exchanged([one, other]) => {
            return texts::EXCHANGED.filled(language, values! { one, other });
        }
        Finding::Misread(misread) => return misread_words(misread, language),
        Finding::Setting(ChangedSetting { setting, angle_deg, turn_arcsec }) => {
            let (symbol, angle) = (setting.symbol(), Number::exact(*angle_deg));
            let turn = arcsec(*turn_arcsec);
            return texts::SETTING_CHANGED.filled(language, values! { symbol, angle, turn });
        }
        Finding::Worn(correlation) => {
            return texts::WORN.filled(language, values! { r: Number::fixed(*correlation, 2) });
        }
        Finding::AnotherStand => texts::ANOTHER_STAND,
        Finding::ChangedTogether => texts::CHANGED_TOGETHER,
        Finding::Slightly => texts::CHANGED_SLIGHTLY,
        Finding::Rotated => texts::ROTATED,
        Finding::RotatedSlightly => texts::ROTATED_SLIGHTLY,
        Finding::NotTested(Untested::Variation) => texts::NOT_TESTED_VARIATION,
        Finding::NotTested(Untested::NumberOfRuns) => texts::NOT_TESTED_RUNS,
        Finding::NotTested(Untested::CommonParts) => texts::NOT_TESTED_COMMON_PARTS,
        Finding::TreatedAsExact => texts::TREATED_AS_EXACT,
        Finding::SameReadings => texts::SAME_READINGS,
        Finding::TooClose => texts::TOO_CLOSE,
    };
    text.words(language)
}
