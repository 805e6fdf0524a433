//! Remarks on a certification, and findings of a comparison, in the language of the page.

use crate::attitude::ANGLES;
use crate::calibration::recorded::rounding_of;
use crate::certification::compared::ComparedPosition;
use crate::certification::finding::{Finding, Untested};
use crate::certification::misread::Misread;
use crate::certification::remark::Remark;
use crate::certification::rotated_runs::{CommonAxis, Pattern};
use crate::certification::split_run::SplitRun;
use crate::certification::suspects::{AXES, OUTLIER};
use crate::report::page::language::{Language, Text};
use crate::report::page::number::Number;
use crate::report::page::parts::date_text;
use crate::report::page::texts::{remarks as texts, words as compass};
use crate::report::picture::history::LETTERS;
use crate::stand::remarks::Odd;
use jiff::civil::Date;
use std::fmt::Display;

/// Returns a remark as a sentence.
pub(crate) fn words(remark: &Remark, language: Language) -> String {
    let fill = |text: Text, values: &[(&str, &dyn Display)]| text.filled(language, values);
    let fixed = |value: f64, decimals: usize| Number::fixed(value, decimals).text(language);
    let exact = |value: f64| Number::exact(value).text(language);
    let day = |date: Date| date_text(language, date);
    // A suspect value: how suspect, and its probability.
    let suspect = |text: Text, p: f64, values: &[(&str, &dyn Display)]| {
        let grade = if p < OUTLIER { texts::OUTLIER } else { texts::STRAGGLER }.words(language);
        let p = Number::scientific(p, 2).text(language);
        fill(text, &[values, &[("grade", &grade), ("p", &p)]].concat())
    };
    match remark {
        Remark::Worse(at) => {
            suspect(texts::WORSE, at.probability, &[("index", &at.index), ("ratio", &fixed(at.ratio, 1))])
        }
        Remark::WorseGroup(at) => {
            let (theta, ratio) = (exact(at.theta_deg), fixed(at.ratio, 1));
            let p = Number::scientific(at.probability, 2).text(language);
            fill(texts::WORSE_GROUP, &[("theta", &theta), ("ratio", &ratio), ("p", &p)])
        }
        Remark::Outlier(out) => {
            let (text, line) = match out.line {
                Some(line) => (texts::OUTLIER_IN_LINE, line),
                None => (texts::OUTLIER_READING, 0),
            };
            let (residual, axis) = (fixed(out.residual_arcsec, 2), AXES[out.axis]);
            suspect(
                text,
                out.probability,
                &[("index", &out.index), ("run", &out.run), ("residual", &residual), ("axis", &axis), ("line", &line)],
            )
        }
        Remark::RotatedRuns(at) => {
            let ([x, y, z], mean) = (at.turns_arcsec.map(|turn| fixed(turn, 2)), fixed(at.largest_effect_arcsec(), 2));
            let (text, run, after) = match at.pattern {
                Pattern::One(run) => (texts::BUMPED_RUN, run, 0),
                Pattern::Move(before, after) => (texts::MOVED, before, after),
                Pattern::Drift => (texts::DRIFTS, 0, 0),
            };
            let axes = axes_of(at.axis, language);
            let values: [(&str, &dyn Display); 7] =
                [("run", &run), ("after", &after), ("x", &x), ("y", &y), ("z", &z), ("axes", &axes), ("mean", &mean)];
            suspect(text, at.probability, &values)
        }
        Remark::SplitRun(at) => {
            let p = Number::scientific(at.probability, 2).text(language);
            split_words(texts::SPLIT_RUN, at, language, &p)
        }
        Remark::TwoRuns(one, other) => fill(texts::TWO_RUNS, &[("one", one), ("other", other)]),
        Remark::NotCompared => fill(texts::NOT_COMPARED, &[]),
        Remark::Twins(one, other) => fill(texts::TWINS, &[("one", one), ("other", other)]),
        Remark::AxesDiffer(p) => fill(texts::AXES_DIFFER, &[("p", &Number::scientific(*p, 2).text(language))]),
        Remark::RunAxesDiffer(at) => {
            let text = if at.axis.is_of_the_base() { texts::BASE_AXES_DIFFER } else { texts::PLATFORM_AXES_DIFFER };
            let [own, others, missing] =
                [at.deviation_arcsec, at.others_arcsec, at.missing_arcsec].map(|value| fixed(value, 2));
            let (axis, p) = (axis_name(at.axis, language), Number::scientific(at.probability, 2).text(language));
            fill(text, &[("axis", &axis), ("own", &own), ("others", &others), ("p", &p), ("missing", &missing)])
        }
        Remark::SharedSetting(at) => {
            let (angle, u) = (at.setting.symbol(), fixed(at.deviation_arcsec, 2));
            let p = Number::scientific(at.probability, 2).text(language);
            fill(texts::SHARED_SETTING, &[("angle", &angle), ("u", &u), ("p", &p)])
        }
        Remark::FewRuns { runs, degrees_of_freedom: freedom } => {
            let doubt = fixed(Remark::doubt_percent(*freedom), 0);
            fill(texts::FEW_RUNS, &[("runs", runs), ("freedom", freedom), ("doubt", &doubt)])
        }
        Remark::BaseAxes(0) => fill(texts::BASE_NOT_SEEN, &[]),
        Remark::BaseAxes(axes) => fill(texts::BASE_IN_PART, &[("axes", axes)]),
        Remark::Rounding { angles, of, step_arcsec } => {
            let (step, u) = (exact(*step_arcsec), fixed(rounding_of(*step_arcsec), 2));
            fill(texts::ROUNDING, &[("angles", angles), ("all", of), ("step", &step), ("u", &u)])
        }
        Remark::SmallAngles(largest) => fill(texts::SMALL_ANGLES, &[("largest", &fixed(*largest, 2))]),
        Remark::Odd(Odd::FarAngle { angle, index, arcsec, usual_arcsec }) => {
            let (angle, value, usual) = (LETTERS[*angle], exact(*arcsec), exact(*usual_arcsec));
            fill(texts::FAR_ANGLE, &[("angle", &angle), ("index", index), ("value", &value), ("usual", &usual)])
        }
        Remark::Odd(Odd::Temperature { celsius, .. }) => fill(texts::TEMPERATURE, &[("value", &exact(*celsius))]),
        Remark::Odd(Odd::OldMeasurement { performed, issued }) => {
            fill(texts::OLD_MEASUREMENT, &[("performed", &day(*performed)), ("issued", &day(*issued))])
        }
        Remark::Odd(Odd::LongValidity { valid_until, issued }) => {
            fill(texts::LONG_VALIDITY, &[("until", &day(*valid_until)), ("issued", &day(*issued))])
        }
        Remark::Odd(Odd::OutsideRange { celsius, range: [low, high] }) => {
            fill(texts::OUTSIDE_RANGE, &[("value", &exact(*celsius)), ("low", &exact(*low)), ("high", &exact(*high))])
        }
    }
}

/// Returns the name of the axis of a common rotation, without platform or base.
pub(super) fn axis_name(axis: CommonAxis, language: Language) -> String {
    match axis.0 {
        axis @ 0..3 => AXES[axis].to_owned(),
        axis => [compass::EAST, compass::NORTH, compass::UP][axis - 3].words(language),
    }
}

/// Returns a run that changed within itself as a sentence, with the probability `p`.
fn split_words(text: Text, at: &SplitRun, language: Language, p: &str) -> String {
    let ([before, after], axes) = (at.between, axes_of(at.axis, language));
    let [x, y, z] = at.turns_arcsec.map(|turn| Number::fixed(turn, 2).text(language));
    let values: [(&str, &dyn Display); 8] = [
        ("run", &at.run),
        ("before", &before),
        ("after", &after),
        ("axes", &axes),
        ("x", &x),
        ("y", &y),
        ("z", &z),
        ("p", &p),
    ];
    text.filled(language, &values)
}

/// Returns the error of a whole file as a sentence.
fn misread_words(misread: &Misread, language: Language) -> String {
    let factor = |value: f64| Number::fixed(value, 0).text(language);
    match misread {
        Misread::Smaller(by, _) => texts::SMALLER_UNIT.filled(language, &[("factor", &factor(*by))]),
        Misread::Larger(by, _) => texts::LARGER_UNIT.filled(language, &[("factor", &factor(*by))]),
        Misread::Sign => texts::OPPOSITE_SIGN.words(language),
        Misread::Axes(axes) => {
            let letter = |name: &str| ANGLES.iter().position(|angle| *angle == name).map_or("", |at| LETTERS[at]);
            let each = Misread::columns(axes).into_iter().map(|(found, due)| {
                let sign = if found.starts_with('-') { "−" } else { "" };
                format!("{sign}{} → {}", letter(found.trim_start_matches('-')), letter(due))
            });
            texts::OTHER_AXES.filled(language, &[("columns", &each.collect::<Vec<_>>().join(", "))])
        }
    }
}

/// Returns the names of the three axes with platform or base.
fn axes_of(axis: CommonAxis, language: Language) -> String {
    if axis.is_of_the_base() { texts::AXES_OF_BASE } else { texts::AXES_OF_PLATFORM }.words(language)
}

/// Returns a finding of a comparison with the last certificate as a sentence.
pub(crate) fn finding(finding: &Finding, language: Language) -> String {
    let arcsec = |value: f64| Number::fixed(value, 2).text(language);
    let text = match finding {
        Finding::Changed(ComparedPosition { index, turn_arcsec, .. }) => {
            let [x, y, z] = turn_arcsec.map(arcsec);
            let values: [(&str, &dyn Display); 4] = [("index", index), ("x", &x), ("y", &y), ("z", &z)];
            return texts::POSITION_CHANGED.filled(language, &values);
        }
        Finding::RotatedRuns(at) => {
            let [x, y, z] = at.turns_arcsec.map(arcsec);
            let [of_x, of_y, of_z] = at.in_the_mean_arcsec().map(arcsec);
            let (text, run, after) = match at.pattern {
                Pattern::One(run) => (texts::CHECK_BUMPED, run, 0),
                Pattern::Move(before, after) => (texts::CHECK_MOVED, before, after),
                Pattern::Drift => (texts::CHECK_DRIFTS, 0, 0),
            };
            let axes = axes_of(at.axis, language);
            let values: [(&str, &dyn Display); 9] = [
                ("run", &run),
                ("after", &after),
                ("axes", &axes),
                ("x", &x),
                ("y", &y),
                ("z", &z),
                ("of_x", &of_x),
                ("of_y", &of_y),
                ("of_z", &of_z),
            ];
            return text.filled(language, &values);
        }
        Finding::SplitRun(at) => return split_words(texts::CHECK_SPLIT, at, language, ""),
        Finding::Outlier(out, mean) => {
            let ([residual, mean], axis) = ([out.residual_arcsec, *mean].map(arcsec), AXES[out.axis]);
            let (index, run) = (&out.index, &out.run);
            return texts::CHECK_OUTLIER.filled(
                language,
                &[("index", index), ("run", run), ("residual", &residual), ("axis", &axis), ("mean", &mean)],
            );
        }
        Finding::Exchanged([one, other]) => {
            return texts::EXCHANGED.filled(language, &[("one", one), ("other", other)]);
        }
        Finding::Misread(misread) => return misread_words(misread, language),
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
